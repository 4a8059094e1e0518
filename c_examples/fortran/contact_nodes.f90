! What the contact surface knows of its nodes: data of t_n, the sums over the pairs, and the answers of the contact law.
! Arrays run over all nodes of the mesh; those that carry no multiplier stay unused.
!
! The weights of t_n belong to the pairs and are kept by the elements (elmt_contact.f90).
module contact_nodes
  use, intrinsic :: iso_c_binding, only: c_char, c_int32_t, c_int64_t, c_loc
  use, intrinsic :: iso_fortran_env, only: error_unit
  use block_model, only: dp, friction, ixf1, model_size, nf1, numnp, young
  use stickslip
  implicit none

  ! Weights of the present positions, with their derivatives (large sliding); .false.: weights, normals and areas of the
  ! undeformed bodies for good (small displacements).
  logical :: current_weights = .false.

  ! Data of t_n.
  logical :: carries_multiplier(numnp) = .false.
  real(dp) :: normal(3, numnp)            ! nu, unit, into the block
  real(dp) :: area(numnp)                 ! M_A, covered or not [L^2]
  real(dp) :: coverage_previous(numnp)    ! covered area [L^2]
  real(dp) :: gap_committed(3, numnp)     ! g[n_n, x_n] [L^3]
  real(dp) :: augmentation(numnp)         ! r_A = rhat_A / M_A [F/L^5]
  real(dp) :: row_scale(numnp)            ! r_A M_A: makes forces of the multiplier rows

  ! Sums over the pairs, at the present positions.
  real(dp) :: coverage(numnp)             ! [L^2]
  real(dp) :: gap_now(3, numnp)           ! g[n_{n+1}, x_{n+1}] [L^3]
  real(dp) :: gap_previous(3, numnp)      ! g[n_n, x_{n+1}] [L^3]

  type(stickslip_node_response) :: response(numnp)
  ! How far a node is from contact equilibrium, whatever the augmentation: gap [L], traction [F/L^2], slip [L].
  real(dp), target :: violation(3, numnp) = 0

  ! A node is covered above this part of its area.
  real(dp), parameter :: coverage_min = 1e-8_dp
  ! The augmentation that the library's interface takes by default: rhat_A = 0.1 E / sqrt(M_A). The answer does not
  ! depend on it.
  real(dp), parameter :: augmentation_factor = 0.1_dp
  ! Without some compression at the start a body at zero gap has no support: lambda = -1e-6 rhat_A sqrt(M_A) nu_A where
  ! the gap, over sqrt(M_A), is below 1e-8, the rounding of a mesh.
  real(dp), parameter :: initial_traction = 1e-6_dp, closed = 1e-8_dp
  ! y is prescribed on both sides (plane strain): no traction along it, no part of it in the normal.
  real(dp), parameter :: prescribed(3) = [0, 1, 0]
  ! Contact is in equilibrium up to this part of its scales; what rounding makes of positions does not count.
  real(dp), parameter :: contact_tolerance = 1e-10_dp, rounding = 8 * epsilon(1.0_dp) * model_size

contains

  ! Normals and areas: sums over the facets around a node. They are data of a step and not differentiated.
  subroutine node_geometry(positions)
    real(dp), intent(in) :: positions(3, numnp)
    real(dp), target :: corner_normals(3, 4), corner_areas(4)
    real(dp) :: sums(3, numnp), free(3)
    integer :: f, a, n, n_corners
    sums = 0
    area = 0
    do f = 1, nf1
      n_corners = count(ixf1(:, f) /= 0)
      call must(stickslip_facet_geometry(int(n_corners, c_int32_t), positions(:, ixf1(1:n_corners, f)), &
          c_loc(corner_normals), c_loc(corner_areas)))
      do a = 1, n_corners
        n = ixf1(a, f)
        carries_multiplier(n) = .true.
        sums(:, n) = sums(:, n) + corner_normals(:, a)
        area(n) = area(n) + corner_areas(a)
      end do
    end do
    do n = 1, numnp
      if (.not. carries_multiplier(n)) cycle
      call must(stickslip_node_normal(sums(:, n), normal(:, n)))
      free = normal(:, n) - dot_product(normal(:, n), prescribed) * prescribed
      normal(:, n) = free / norm2(free)
      augmentation(n) = augmentation_factor * young / sqrt(area(n)) / area(n)
      row_scale(n) = augmentation(n) * area(n)
    end do
  end subroutine

  subroutine clear_sums
    coverage = 0
    gap_now = 0
    gap_previous = 0
  end subroutine

  ! The multipliers that the first step starts from.
  subroutine initial_multipliers(u)
    real(dp), intent(inout) :: u(:, :)
    integer :: n
    do n = 1, numnp
      if (.not. carries_multiplier(n) .or. coverage(n) <= coverage_min * area(n)) cycle
      if (dot_product(normal(:, n), gap_now(:, n)) > closed * sqrt(area(n)) * coverage(n)) cycle
      u(4:6, n) = -initial_traction * augmentation(n) * area(n) * sqrt(area(n)) * normal(:, n)
    end do
  end subroutine

  ! Stage 2, the contact law, from the gaps of all pairs: gap, stick or slip. Projecting pair by pair would make the
  ! answer depend on the augmentation.
  subroutine respond(n, lambda)
    integer, intent(in) :: n
    real(dp), intent(in) :: lambda(3)
    type(stickslip_node) :: node
    ! Frozen weights see no motion of their own, so the slip is the change of the gap since t_n.
    node%slip = merge(STICKSLIP_SLIP_OBJECTIVE, STICKSLIP_SLIP_INCREMENT, current_weights)
    node%n_directions = 1
    node%directions(:, 1) = prescribed
    node%lambda = lambda
    node%normal = normal(:, n)
    node%augmentation = augmentation(n)
    node%coverage = coverage(n)
    node%coverage_previous = coverage_previous(n)
    node%coverage_min = coverage_min * area(n)
    node%gap_now = gap_now(:, n)
    node%gap_previous = gap_previous(:, n)
    node%gap_committed = gap_committed(:, n)
    ! A node that touches for the first time has not slipped yet: it acts without friction for this one step.
    node%mu = merge(friction, 0.0_dp, coverage_previous(n) > node%coverage_min)
    call must(stickslip_node_respond(node, response(n)))
    call must(stickslip_node_equilibrium(node, young / sqrt(area(n)), rounding, c_loc(violation(1, n)), &
        c_loc(violation(2, n)), c_loc(violation(3, n))))
  end subroutine

  ! Of the nodes' last responses. A gap over the node's size is a strain, and times the modulus a traction.
  logical function in_equilibrium(lambda)
    real(dp), intent(in) :: lambda(3, numnp)
    real(dp) :: traction
    integer :: n
    traction = sqrt(maxval(sum(lambda**2, dim=1)))
    in_equilibrium = .true.
    do n = 1, numnp
      if (.not. carries_multiplier(n)) cycle
      if (violation(2, n) > contact_tolerance * traction .or. young / sqrt(area(n)) * &
          max(violation(1, n), violation(3, n)) > contact_tolerance * traction) in_equilibrium = .false.
    end do
  end function

  ! A step has converged: its last evaluation becomes t_n.
  subroutine commit_nodes(positions)
    real(dp), intent(in) :: positions(3, numnp)
    coverage_previous = coverage
    gap_committed = gap_now
    if (current_weights) call node_geometry(positions)
  end subroutine

  ! A refusal within Newton's method means: try a smaller load step. This little code has no other steps and stops.
  subroutine must(status)
    integer(c_int32_t), intent(in) :: status
    character(kind=c_char, len=300) :: text
    if (status == STICKSLIP_OK) return
    if (stickslip_last_error_padded(text, len(text, c_int64_t)) /= STICKSLIP_OK) text = 'no message'
    write (error_unit, '(2a)') 'block_fortran: ', trim(text)
    stop 1
  end subroutine
end module
