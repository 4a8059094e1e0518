! profile_host: frictional mortar contact in a code that has no place for multipliers, and a solver without pivoting.
!
! The block of block_model.f90 on the interface handle, with dual multipliers. The multipliers follow
! from the displacements in each evaluation: unknowns are displacements alone, and the matrix has no zeros on its diagonal.
! The solver is what old codes have, profile_matrix.f90. It is ../profile_host.c in Fortran's words.
!
!   cargo build --release
!   cd c_examples/fortran
!   gfortran -O2 -J../../target ../../include/stickslip.f90 block_model.f90 elmt_solid.f90 profile_matrix.f90 \
!     profile_host.f90 ../../target/release/libstickslip.a -lpthread -ldl -lm -o ../../target/profile_host_fortran
!   ../../target/profile_host_fortran [--current] [--mu MU] [--push P] [FILE]
!
! FILE receives the nodal displacements. --current: contact at the present positions (large sliding); else at those of
! the undeformed bodies. Friction is 0.2, or MU; the push on the left side is 60 per area, or P. At the end it tells the
! smallest pivot.
program profile_host
  use, intrinsic :: iso_c_binding
  use block_model
  use profile_matrix
  use solid_element
  use stickslip
  implicit none

  ! Converged: the block's |residual| <= rtol times its largest |loads| + |reactions| + |contact forces| so far, 2-norms of
  ! nodal forces, or below `noise`, the rounding of internal forces when a body moves as a whole; and the contact is in
  ! equilibrium, to `contact_tolerance` of its own scales.
  real(dp), parameter :: rtol = 2e-11_dp, noise = 1e-14_dp, smallest_reference = 1e-12_dp, contact_tolerance = 1e-10_dp
  integer, parameter :: steps = 20, max_iterations = 25, n2 = (fx + 1) * (fy + 1), n1 = (mx + 1) * (my + 1)

  type(stickslip_interface) :: contact
  integer :: node1(n1)                                        ! the nodes of surface 1; those of surface 2 follow the block's
  real(dp) :: lambda(3, n1), host(3, n1), rows1(3, n1), force2(3, n2)
  real(dp) :: f(3, numnp)                                     ! residual; where a value is prescribed, its reaction
  real(dp) :: mu = friction, reference, largest_reference, limit, residual
  logical :: small = .true.
  logical :: starting = .true.                                ! lambda is given: no force has followed from displacements yet
  character(200) :: file = ''
  integer :: step, iterations, all_iterations = 0

  call read_arguments
  call make_mesh
  call number_displacements
  u = 0
  call create_contact
  largest_reference = smallest_reference * young * model_size**2
  do step = 1, steps
    call set_loads(end_time * step / steps)
    call find_profile
    do iterations = 0, max_iterations
      call form
      if (residual <= limit) then
        if (in_equilibrium()) exit
      end if
      if (iterations == max_iterations) call stop_with('Newton''s method does not converge')
      call solve_and_update
    end do
    largest_reference = max(largest_reference, reference)
    all_iterations = all_iterations + iterations
    call print_step
    call must(stickslip_interface_commit(contact, x1(), x2(), lambda, c_null_ptr))
  end do
  call print_end
  if (file /= '') call write_displacements
  call must(stickslip_interface_destroy(contact))

contains

  subroutine read_arguments
    character(200) :: word
    integer :: i
    i = 0
    do while (i < command_argument_count())
      i = i + 1
      call get_command_argument(i, word)
      select case (word)
      case ('--current')
        small = .false.
      case ('--mu', '--push')
        if (word == '--mu') call read_number(i + 1, mu)
        if (word == '--push') call read_number(i + 1, push)
        i = i + 1
      case default
        if (word(1:1) == '-' .or. file /= '') call stop_with('usage: [--current] [--mu MU] [--push P] [FILE]')
        file = word
      end select
    end do
  end subroutine

  subroutine read_number(i, number)
    integer, intent(in) :: i
    real(dp), intent(out) :: number
    character(200) :: word
    integer :: status
    call get_command_argument(i, word)
    read (word, *, iostat=status) number
    if (status /= 0) call stop_with('--mu and --push take a number')
  end subroutine

  ! Plane by plane, as nodes are numbered: the profile is narrow. Along y both sides are held; the foundation is rigid.
  subroutine number_displacements
    integer :: n
    id = 0
    neq = 0
    do n = 1, nblock
      call number_place(1, n)
      call number_place(3, n)
    end do
  end subroutine

  ! Present positions of the surfaces.
  function x1()
    real(dp) :: x1(3, n1)
    x1 = x(:, node1) + u(1:3, node1)
  end function

  function x2()
    real(dp) :: x2(3, n2)
    x2 = x(:, nblock + 1:) + u(1:3, nblock + 1:)
  end function

  ! ---- all that concerns the library ----
  ! Within Newton's method a refusal means: try a smaller load step. This little code has no other steps and stops.
  subroutine must(status)
    integer(c_int32_t), intent(in) :: status
    character(500) :: message
    if (status == STICKSLIP_OK) return
    if (stickslip_last_error_padded(message, len(message, c_int64_t)) == STICKSLIP_OK) call stop_with(trim(message))
    call stop_with('the library refuses')
  end subroutine

  subroutine create_contact
    type(stickslip_options) :: options
    type(stickslip_surface) :: block_side, foundation
    integer(c_int64_t), target :: offsets1(nf1 + 1), offsets2(nf2 + 1), facets1(4 * nf1), facets2(4 * nf2)
    integer(c_int64_t), target :: equations1(3, n1), equations2(3, n2), multipliers(3, n1)
    real(dp), target :: positions1(3, n1), positions2(3, n2)
    integer :: n, f, local(numnp)
    node1 = pack([(n, n = 1, nblock)], [(any(ixf1 == n), n = 1, nblock)])
    local(node1) = [(n, n = 1, n1)]
    offsets1 = [(4 * f, f = 0, nf1)]
    facets1 = local(reshape(ixf1, [4 * nf1]))
    offsets2(1) = 0
    do f = 1, nf2
      n = count(ixf2(:, f) > 0) ! 3 or 4
      offsets2(f + 1) = offsets2(f) + n
      facets2(offsets2(f) + 1:offsets2(f + 1)) = ixf2(:n, f) - nblock
    end do
    equations1 = merge(id(1:3, node1), -1, id(1:3, node1) > 0)
    equations2 = -1
    ! y is fixed on both sides: no multiplier along it. The other numbers are those of no equation here.
    multipliers = reshape([(neq + n, n = 1, 3 * n1)], [3, n1])
    multipliers(2, :) = -1
    positions1 = x1()
    positions2 = x2()
    block_side = stickslip_surface(n_nodes=n1, n_facets=nf1, coordinates=c_loc(positions1), facet_offsets=c_loc(offsets1), &
        facet_nodes=c_loc(facets1), equations=c_loc(equations1), multiplier_equations=c_loc(multipliers))
    foundation = stickslip_surface(n_nodes=n2, n_facets=nf2, coordinates=c_loc(positions2), facet_offsets=c_loc(offsets2), &
        facet_nodes=c_loc(facets2), equations=c_loc(equations2))
    call must(stickslip_options_init(options, stickslip_options_size))
    options%index_base = 1
    options%mu = mu
    options%modulus = young ! gives the augmentation its unit; the answer does not depend on it
    options%small_displacements = merge(1, 0, small)
    call must(stickslip_interface_create(block_side, foundation, options, contact))
    call must(stickslip_interface_initial_multipliers(contact, lambda))
  end subroutine

  ! The profile of elements, then, since rows of mortar nodes gain columns, that of the condensed matrix. It suffices while
  ! the surfaces slide by less than a quarter of a facet.
  subroutine find_profile
    integer(c_int64_t), allocatable, target :: entry_rows(:), entry_columns(:)
    integer(c_int64_t) :: n, k
    integer :: e
    call clear_profile
    do e = 1, numel
      call widen_by_element(ix(:, e))
    end do
    call make_profile
    call must(stickslip_interface_condensed_pattern(contact, x1(), x2(), int(neq, c_int64_t), start, columns, &
        0_c_int64_t, c_null_ptr, c_null_ptr, n))
    allocate (entry_rows(n), entry_columns(n))
    call must(stickslip_interface_condensed_pattern(contact, x1(), x2(), int(neq, c_int64_t), start, columns, n, &
        c_loc(entry_rows), c_loc(entry_columns), n))
    do k = 1, n
      call widen(entry_rows(k), entry_columns(k))
    end do
    call make_profile
  end subroutine

  ! Bulk forces and matrix become those of the system without multipliers.
  subroutine condense
    host = f(:, node1)
    if (.not. starting) call must(stickslip_interface_condensed_multipliers(contact, x1(), x2(), host, lambda))
    call must(stickslip_interface_condensed_residual(contact, x1(), x2(), lambda, host, rows1, force2))
    call must(stickslip_interface_condensed_csr(contact, x1(), x2(), lambda, int(neq, c_int64_t), start, columns, entries))
    if (.not. starting) call add_scales
    starting = .false.
    where (id(1:3, node1) == 0) rows1 = host ! reactions stay
    f(:, node1) = rows1
    f(:, nblock + 1:) = f(:, nblock + 1:) + force2
  end subroutine

  ! The scale of the constraint rows changes with the covered areas, where the multipliers follow from the displacements.
  subroutine add_scales
    integer(c_int64_t), allocatable, target :: entry_rows(:), entry_columns(:)
    real(dp), allocatable, target :: values(:)
    integer(c_int64_t) :: n, k, place
    call must(stickslip_interface_condensed_coo(contact, x1(), x2(), lambda, STICKSLIP_CONDENSED_SCALES, 0_c_int64_t, &
        c_null_ptr, c_null_ptr, c_null_ptr, n))
    if (n == 0) return ! frozen weights
    allocate (entry_rows(n), entry_columns(n), values(n))
    call must(stickslip_interface_condensed_coo(contact, x1(), x2(), lambda, STICKSLIP_CONDENSED_SCALES, n, &
        c_loc(entry_rows), c_loc(entry_columns), c_loc(values), n))
    do k = 1, n
      place = start(entry_rows(k)) + entry_columns(k) - first(entry_rows(k))
      entries(place) = entries(place) + values(k)
    end do
  end subroutine

  logical function in_equilibrium()
    type(stickslip_equilibrium) :: e
    e%modulus = young
    call must(stickslip_interface_equilibrium(contact, x1(), x2(), lambda, c_null_ptr, e))
    in_equilibrium = e%gap <= contact_tolerance * e%gap_scale .and. &
        e%traction <= contact_tolerance * e%traction_scale .and. e%slip <= contact_tolerance * e%slip_scale
  end function

  ! ---- Newton ----
  ! Residual and matrix at u, and how large the forces that do not balance may be.
  subroutine form
    real(dp) :: xl(ndm, nen), ul(ndf, nen), s(nst, nst), p(ndf, nen)
    integer :: e
    entries = 0
    f = -load(1:3, :)
    do e = 1, numel
      xl = x(:, ix(:, e))
      ul = u(:, ix(:, e))
      call elmt_solid(xl, ul, s, p)
      call assemble(ix(:, e), s, p, f)
    end do
    call condense
    residual = norm2(pack(f, id(1:3, :) > 0))
    reference = norm2(load) + norm2(pack(f(:, :nblock), id(1:3, :nblock) == 0)) + norm2(force2)
    limit = max(rtol * max(reference, largest_reference), &
        noise * young * model_size * min(maxval(abs(u(1:3, :))), model_size))
  end subroutine

  subroutine solve_and_update
    real(dp) :: b(neq)
    integer :: i, n
    do n = 1, numnp
      do i = 1, ndm
        if (id(i, n) > 0) b(id(i, n)) = f(i, n)
      end do
    end do
    call solve(b)
    do n = 1, numnp
      do i = 1, ndm
        if (id(i, n) > 0) u(i, n) = u(i, n) - b(id(i, n))
      end do
    end do
  end subroutine

  subroutine print_step
    integer(c_int32_t), target :: state(n1)
    call must(stickslip_interface_states(contact, x1(), x2(), lambda, c_null_ptr, stickslip_states(state=c_loc(state))))
    print '(a, i2, a, f3.1, a, i2, a, es8.2, 3(a, i0))', 'step ', step, '  t ', end_time * step / steps, &
        '  iterations ', iterations, '  |r| ', residual, '  gap ', count(state == STICKSLIP_STATE_GAP), &
        '  stick ', count(state == STICKSLIP_STATE_STICK), '  slip ', count(state == STICKSLIP_STATE_SLIP)
  end subroutine

  ! Internal forces on the foundation are those of the foundation on the block.
  subroutine print_end
    print '(a, 3f15.9)', 'force on the block    ', sum(force2, dim=2)
    print '(a, 3f15.9)', 'displacement top left ', u(1:3, block_node(0, 0, mz))
    print '(a, 3f15.9)', 'displacement top right', u(1:3, block_node(mx, 0, mz))
    print '(i0, a, es7.1, a)', all_iterations, ' iterations, smallest pivot ', smallest_pivot, ' of the largest diagonal entry'
  end subroutine

  subroutine write_displacements
    integer :: unit, n, status
    open (newunit=unit, file=file, action='write', iostat=status)
    if (status /= 0) call stop_with('cannot write the file of displacements')
    write (unit, '(a)') '# X Y Z ux uy uz'
    do n = 1, nblock
      write (unit, '(6es25.16e3)') x(:, n), u(1:3, n)
    end do
    close (unit)
  end subroutine
end program
