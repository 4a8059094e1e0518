! Contact element for a code that calls each element once in an iteration, as FEAP does: a pair of facets. The interface handle is
! kept here and evaluated once; each element deals out the part of its residual and tangent that belongs to it.
!
! elmt_handle(isw, n, nodes, s, p), with FEAP's switch:
!    14  once, before the first step: the first element that is called makes the handle
!     3  tangent s and internal forces p;  6  the same without s
!    12  before each step, the first one included: commits the step that has ended, if there was one
! n: the element's number; nodes: of its non-mortar facet (1 to 4) and of its mortar facet (5 to 8), 0 where there is none.
! The whole surfaces are read from the code's own arrays, x and u. FEAP's p is minus this one.
!
! Which element an entry belongs to: the equation numbers that the library gets are not the code's. They are ndf (node - 1) + place,
! for all displacements, prescribed ones too, so that the code can drop rows or move columns to the right-hand side. An entry goes to the
! first element in the list that has both nodes. With standard multipliers in the multiplier form there always is one, if the list has
! all pairs of facets that meet.
!
! Refusals: an element has no way to say no. `refusal` is then not STICKSLIP_OK, and the elements go on handing out the numbers of the
! last good evaluation, which are finite. The code looks at `refusal` at the end of its loop and takes a smaller step.
module handle_elements
  use, intrinsic :: iso_c_binding, only: c_int32_t, c_int64_t, c_loc, c_null_ptr
  use, intrinsic :: iso_fortran_env, only: error_unit
  use block_model, only: dp, friction, ixc, ixf1, ixf2, nblock, ndf, nen, nf1, nf2, nst, numnp, numpair, u, x, young
  use stickslip, only: stickslip_equilibrium, stickslip_interface, stickslip_interface_commit, stickslip_interface_create, &
      stickslip_interface_destroy, stickslip_interface_equilibrium, stickslip_interface_initial_multipliers, &
      stickslip_interface_residual, stickslip_interface_states, stickslip_interface_tangent_coo, stickslip_last_error_padded, &
      STICKSLIP_OK, stickslip_options, stickslip_options_init, stickslip_options_paper, stickslip_options_size, &
      stickslip_states, stickslip_surface
  implicit none
  private
  public :: begin, elmt_handle, in_equilibrium, last_message, next_step, nodes_in_states, refusal, residual_only, &
      tangent_and_residual, the_end, small

  integer, parameter :: tangent_and_residual = 3, residual_only = 6, next_step = 12, begin = 14 ! isw
  logical :: small = .false.
  integer(c_int32_t) :: refusal = STICKSLIP_OK
  character(300) :: last_message = ''

  type(stickslip_interface) :: contact
  logical :: created = .false., evaluated = .false.       ! evaluated: since the last commit
  integer, allocatable :: nodes1(:), nodes2(:)            ! of the surfaces, in the library's order
  real(dp), allocatable :: start(:, :)                    ! multipliers where u is zero [F/L^2]; FEAP starts from there
  real(dp) :: u_evaluated(ndf, numnp)                     ! what the numbers below are of
  real(dp) :: forces(ndf, numnp) = 0                      ! internal forces and multiplier rows, at their nodes
  integer(c_int64_t), allocatable, target :: row(:), column(:)
  real(dp), allocatable, target :: entry(:)
  integer :: first_entry(numpair) = 0                     ! of each element; 0: none
  integer, allocatable :: next_entry(:)                   ! of the same element; 0: none
  integer :: first_element(numnp + 1), elements(nen * numpair) ! those of node n: first_element(n) to first_element(n + 1) - 1

contains

  subroutine elmt_handle(isw, n, nodes, s, p)
    integer, intent(in) :: isw, n, nodes(nen)
    real(dp), intent(out) :: s(nst, nst), p(ndf, nen)
    s = 0
    p = 0
    select case (isw)
    case (begin)
      if (.not. created) call create
    case (tangent_and_residual, residual_only)
      call evaluate
      call deal_forces(n, nodes, p)
      if (isw == tangent_and_residual) call deal_tangent(n, nodes, s)
    case (next_step)
      ! The first one comes before any step. A step that was given up commits the positions of t_n once more.
      if (evaluated) call must(stickslip_interface_commit(contact, positions(nodes1), positions(nodes2), multipliers(), c_null_ptr))
      evaluated = .false.
    end select
  end subroutine

  ! Once for all elements, and again where something has moved: another element, or isw 3 after 6, finds the numbers there.
  subroutine evaluate
    real(dp) :: force1(3, size(nodes1)), force2(3, size(nodes2)), rows(3, size(nodes1))
    integer(c_int64_t), allocatable, target :: i(:), j(:)
    real(dp), allocatable, target :: v(:)
    integer(c_int64_t) :: count
    if (evaluated .and. all(abs(u - u_evaluated) <= 0)) return
    if (refused(stickslip_interface_residual(contact, positions(nodes1), positions(nodes2), multipliers(), c_null_ptr, force1, &
        force2, rows))) return
    if (refused(stickslip_interface_tangent_coo(contact, positions(nodes1), positions(nodes2), multipliers(), c_null_ptr, &
        0_c_int64_t, c_null_ptr, c_null_ptr, c_null_ptr, count))) return
    allocate (i(count), j(count), v(count))
    if (refused(stickslip_interface_tangent_coo(contact, positions(nodes1), positions(nodes2), multipliers(), c_null_ptr, count, &
        c_loc(i), c_loc(j), c_loc(v), count))) return
    call move_alloc(i, row)
    call move_alloc(j, column)
    call move_alloc(v, entry)
    forces(1:3, nodes1) = force1
    forces(4:6, nodes1) = rows
    forces(1:3, nodes2) = force2
    call sort_entries
    u_evaluated = u
    evaluated = .true.
  end subroutine

  ! Hands each entry to its element.
  subroutine sort_entries
    integer :: k, e
    next_entry = [(0, k = 1, size(entry))]
    first_entry = 0
    do k = 1, size(entry)
      e = element_with(node(row(k)), node(column(k)))
      next_entry(k) = first_entry(e)
      first_entry(e) = k
    end do
  end subroutine

  ! The first element in the list that has both nodes.
  integer function element_with(a, b)
    integer, intent(in) :: a, b
    integer :: k
    do k = first_element(a), first_element(a + 1) - 1
      element_with = elements(k)
      if (any(ixc(:, element_with) == b)) return
    end do
    call stop_with('no contact element has both nodes of an entry: the list lacks a pair of facets')
  end function

  ! A node's forces and rows go to the first element that has it.
  subroutine deal_forces(n, nodes, p)
    integer, intent(in) :: n, nodes(nen)
    real(dp), intent(inout) :: p(ndf, nen)
    integer :: a
    do a = 1, nen
      if (nodes(a) == 0) cycle
      if (elements(first_element(nodes(a))) == n) p(:, a) = forces(:, nodes(a))
    end do
  end subroutine

  subroutine deal_tangent(n, nodes, s)
    integer, intent(in) :: n, nodes(nen)
    real(dp), intent(inout) :: s(nst, nst)
    integer :: k
    k = first_entry(n)
    do while (k > 0)
      s(place(row(k), nodes), place(column(k), nodes)) = entry(k) ! each entry comes once
      k = next_entry(k)
    end do
  end subroutine

  ! Node of an equation of the library, and its place in an element with these nodes.
  integer function node(equation)
    integer(c_int64_t), intent(in) :: equation
    node = int((equation - 1) / ndf) + 1
  end function

  integer function place(equation, nodes)
    integer(c_int64_t), intent(in) :: equation
    integer, intent(in) :: nodes(nen)
    place = ndf * (findloc(nodes, node(equation), dim=1) - 1) + int(mod(equation - 1, int(ndf, c_int64_t))) + 1
  end function

  ! Present positions of a surface, and the multipliers.
  function positions(nodes)
    integer, intent(in) :: nodes(:)
    real(dp) :: positions(3, size(nodes))
    positions = x(:, nodes) + u(1:3, nodes)
  end function

  function multipliers()
    real(dp) :: multipliers(3, size(nodes1))
    multipliers = start + u(4:6, nodes1)
  end function

  ! Facets and nodes of the contact elements become the surfaces of a handle.
  subroutine create
    type(stickslip_options) :: options
    type(stickslip_surface) :: nonmortar, mortar
    integer(c_int64_t), target :: offsets1(nf1 + 1), offsets2(nf2 + 1), facets1(4 * nf1), facets2(4 * nf2)
    integer(c_int64_t), allocatable, target :: equations1(:, :), equations2(:, :), numbers(:, :)
    real(dp), allocatable, target :: x1(:, :), x2(:, :)
    integer :: n
    call list_elements
    nodes1 = pack([(n, n = 1, numnp)], [(any(ixf1 == n), n = 1, numnp)])
    nodes2 = pack([(n, n = 1, numnp)], [(any(ixf2 == n), n = 1, numnp)])
    call facet_list(ixf1, nodes1, offsets1, facets1)
    call facet_list(ixf2, nodes2, offsets2, facets2)
    allocate (start(3, size(nodes1)))
    x1 = x(:, nodes1)
    x2 = x(:, nodes2)
    equations1 = equations(nodes1, 0)
    equations2 = equations(nodes2, 0)
    numbers = equations(nodes1, 3)
    numbers(2, :) = -1 ! y is prescribed on both sides: no multiplier along it
    nonmortar = stickslip_surface(n_nodes=size(nodes1), n_facets=nf1, coordinates=c_loc(x1), facet_offsets=c_loc(offsets1), &
        facet_nodes=c_loc(facets1), equations=c_loc(equations1), multiplier_equations=c_loc(numbers))
    mortar = stickslip_surface(n_nodes=size(nodes2), n_facets=nf2, coordinates=c_loc(x2), facet_offsets=c_loc(offsets2), &
        facet_nodes=c_loc(facets2), equations=c_loc(equations2))
    call must(stickslip_options_init(options, stickslip_options_size))
    ! An element here is a pair of facets. The paper's couples what belongs to a pair alone; dual multipliers and normals of
    ! now couple its neighbours, too.
    call must(stickslip_options_paper(options))
    options%index_base = 1
    options%mu = friction
    options%modulus = young ! gives the augmentation its unit; the answer does not depend on it
    options%small_displacements = merge(1, 0, small)
    call must(stickslip_interface_create(nonmortar, mortar, options, contact))
    call must(stickslip_interface_initial_multipliers(contact, start))
    created = .true.
  end subroutine

  subroutine facet_list(ixf, nodes, offsets, facets)
    integer, intent(in) :: ixf(:, :), nodes(:)
    integer(c_int64_t), intent(out) :: offsets(:), facets(:)
    integer :: f, k, local(numnp)
    local(nodes) = [(k, k = 1, size(nodes))]
    offsets(1) = 0
    do f = 1, size(ixf, 2)
      k = count(ixf(:, f) > 0) ! 3 or 4
      offsets(f + 1) = offsets(f) + k
      facets(offsets(f) + 1:offsets(f + 1)) = local(ixf(:k, f))
    end do
  end subroutine

  function equations(nodes, behind)
    integer, intent(in) :: nodes(:), behind
    integer(c_int64_t) :: equations(3, size(nodes))
    integer :: i, n
    equations = reshape([((ndf * (nodes(n) - 1) + behind + i, i = 1, 3), n = 1, size(nodes))], shape(equations))
  end function

  subroutine list_elements
    integer :: n, e, k
    k = 1
    do n = 1, numnp
      first_element(n) = k
      do e = 1, numpair
        if (all(ixc(:, e) /= n)) cycle
        elements(k) = e
        k = k + 1
      end do
    end do
    first_element(numnp + 1) = k
  end subroutine

  ! Of the last evaluation, to a part of the contact's own scales.
  logical function in_equilibrium(tolerance)
    real(dp), intent(in) :: tolerance
    type(stickslip_equilibrium) :: e
    e%modulus = young
    call must(stickslip_interface_equilibrium(contact, positions(nodes1), positions(nodes2), multipliers(), c_null_ptr, e))
    in_equilibrium = e%gap <= tolerance * e%gap_scale .and. e%traction <= tolerance * e%traction_scale .and. &
        e%slip <= tolerance * e%slip_scale
  end function

  ! How many nodes are in gap, stick and slip: what isw 4 prints.
  function nodes_in_states()
    integer :: nodes_in_states(0:2), k
    integer(c_int32_t), target :: state(size(nodes1))
    call must(stickslip_interface_states(contact, positions(nodes1), positions(nodes2), multipliers(), c_null_ptr, &
        stickslip_states(state=c_loc(state))))
    nodes_in_states = [(count(state == k), k = 0, 2)]
  end function

  subroutine the_end
    call must(stickslip_interface_destroy(contact))
  end subroutine

  ! Within Newton's method: the numbers of before stay, and `refusal` and `last_message` tell.
  logical function refused(status)
    integer(c_int32_t), intent(in) :: status
    refusal = status
    refused = status /= STICKSLIP_OK
    if (.not. refused) return
    if (stickslip_last_error_padded(last_message, len(last_message, c_int64_t)) /= STICKSLIP_OK) last_message = 'no message'
  end function

  ! Elsewhere a refusal is a mistake in the input: FEAP's plstop.
  subroutine must(status)
    integer(c_int32_t), intent(in) :: status
    if (refused(status)) call stop_with(last_message)
  end subroutine

  subroutine stop_with(why)
    character(*), intent(in) :: why
    write (error_unit, '(2a)') 'contact element: ', trim(why)
    stop 1
  end subroutine
end module
