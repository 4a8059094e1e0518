! uel: contact in a code that calls each user element once per iteration; the argument list is Abaqus' UEL.
!
! The law needs the gaps of all pairs of facets around a node, so a pair cannot be an element here (where a code makes
! two passes it can: elmt_contact.f90). The whole interface is ONE element. It keeps a handle of the library; the
! equation numbers that it gives to the library are the places in its own matrix.
!
! Nodes of the element: each of the n1 non-mortar nodes followed by its multiplier node (one more node at the same
! place, in no other element, not supported), then the n2 mortar nodes. All have the degrees of freedom 1, 2, 3; those
! of a multiplier node are the multiplier. Rotations, 4 to 6, would not do: with NLGEOM they are not added but composed.
!
!   *USER ELEMENT, TYPE=U1, NODES=20, COORDINATES=3, PROPERTIES=2, VARIABLES=1, UNSYMM        (NODES = 2 n1 + n2)
!   1, 2, 3
!   *UEL PROPERTY, ELSET=CONTACT
!   0.3, 1000.                             (coefficient of friction; Young's modulus of the softer body)
!
! Facets: no argument says which nodes make them. Fill in the module contact_interface before the first call; Abaqus
! offers UEXTERNALDB for that, which can read them from a file.
!
! Start: with zero multipliers a body that only touches has no support, and an element cannot write into u. So the
! multiplier is u plus a constant, `start`, a slight compression: add it to what the code prints.
!
! Time: an increment with another number than in the last call means that the one before was accepted; its end is
! u - du. An increment that is tried again, under the same number, finds the history as it was. The history is in the
! handle, not in svars; for a restart save it with stickslip_interface_history_export.
!
! Signs: rhs is minus the internal forces; amatrx is the derivative of the internal forces, exact, not symmetric.
module contact_interface
  use, intrinsic :: iso_c_binding, only: c_int32_t, c_int64_t, c_loc, c_null_ptr, dp => c_double
  use, intrinsic :: iso_fortran_env, only: error_unit
  use stickslip
  implicit none

  ! To be filled in: numbers of nodes, and the facets; 1 non-mortar, 2 mortar. Facet f has the nodes
  ! facets(offsets(f) + 1:offsets(f + 1)), counted from 1 in their surface, right-hand order seen from outside the body.
  integer :: n1 = 0, n2 = 0
  integer(c_int64_t), allocatable, target :: offsets1(:), facets1(:), offsets2(:), facets2(:)

  ! Kept from call to call.
  type(stickslip_interface) :: contact
  real(dp), allocatable :: start(:, :)              ! multipliers where u is zero [F/L^2]
  integer :: element = 0, last_step, last_increment ! element: its number, 0 before the first call

  ! Refusals within Newton's method that ask for a smaller increment; any other is a fault.
  integer(c_int32_t), parameter :: beyond_contact(4) = [STICKSLIP_NOT_FINITE, STICKSLIP_DEGENERATE_FACET, &
      STICKSLIP_UNDEFINED_NORMAL, STICKSLIP_PROJECTION_NOT_CONVEX]

contains

  ! The interface between the surfaces at x1, x2, the undeformed positions, which are t_0. Equations as the library's.
  subroutine create(x1, x2, equations1, equations2, multipliers, friction, young, interface)
    real(dp), intent(in), target :: x1(3, n1), x2(3, n2)
    integer(c_int64_t), intent(in), target :: equations1(3, n1), equations2(3, n2), multipliers(3, n1)
    real(dp), intent(in) :: friction, young
    type(stickslip_interface), intent(inout) :: interface
    type(stickslip_surface) :: nonmortar, mortar
    type(stickslip_options) :: options
    nonmortar = stickslip_surface(n_nodes=n1, n_facets=size(offsets1) - 1, coordinates=c_loc(x1), &
        facet_offsets=c_loc(offsets1), facet_nodes=c_loc(facets1), equations=c_loc(equations1), &
        multiplier_equations=c_loc(multipliers))
    mortar = stickslip_surface(n_nodes=n2, n_facets=size(offsets2) - 1, coordinates=c_loc(x2), &
        facet_offsets=c_loc(offsets2), facet_nodes=c_loc(facets2), equations=c_loc(equations2))
    call must(stickslip_options_init(options, stickslip_options_size))
    options%index_base = 1
    options%mu = friction
    options%modulus = young
    call must(stickslip_interface_create(nonmortar, mortar, options, interface))
  end subroutine

  subroutine first_call(coords, friction, young)
    real(dp), intent(in) :: coords(3, 2 * n1 + n2), friction, young
    integer(c_int64_t) :: places(3, 2 * n1 + n2), k
    places = reshape([(k, k = 1, size(places))], shape(places))
    call create(coords(:, 1:2 * n1:2), coords(:, 2 * n1 + 1:), places(:, 1:2 * n1:2), places(:, 2 * n1 + 1:), &
        places(:, 2:2 * n1:2), friction, young, contact)
    allocate (start(3, n1))
    call must(stickslip_interface_initial_multipliers(contact, start))
  end subroutine

  ! Positions and multipliers, as the library takes them.
  subroutine present_state(coords, u, x1, x2, lambda)
    real(dp), intent(in) :: coords(3, 2 * n1 + n2), u(3, 2 * n1 + n2)
    real(dp), intent(out) :: x1(3, n1), x2(3, n2), lambda(3, n1)
    x1 = coords(:, 1:2 * n1:2) + u(:, 1:2 * n1:2)
    lambda = start + u(:, 2:2 * n1:2)
    x2 = coords(:, 2 * n1 + 1:) + u(:, 2 * n1 + 1:)
  end subroutine

  subroutine must(status)
    integer(c_int32_t), intent(in) :: status
    character(300) :: text
    if (status == STICKSLIP_OK) return
    if (stickslip_last_error_padded(text, len(text, c_int64_t)) /= STICKSLIP_OK) text = 'no message'
    call stop_with(text)
  end subroutine

  ! In Abaqus: write to unit 7, the message file, and call xit.
  subroutine stop_with(why)
    character(*), intent(in) :: why
    write (error_unit, '(2a)') 'contact element: ', trim(why)
    stop 1
  end subroutine
end module

subroutine uel(rhs, amatrx, svars, energy, ndofel, nrhs, nsvars, props, nprops, coords, mcrd, nnode, u, du, v, a, &
    jtype, time, dtime, kstep, kinc, jelem, params, ndload, jdltyp, adlmag, predef, npredf, lflags, mlvarx, ddlmag, &
    mdload, pnewdt, jprops, njprop, period)
  use contact_interface
  implicit none
  integer, intent(in) :: ndofel, nrhs, nsvars, nprops, mcrd, nnode, jtype, kstep, kinc, jelem, ndload, npredf, mlvarx, &
      mdload, njprop, jdltyp(mdload, *), lflags(*), jprops(*)
  real(dp), intent(in) :: props(*), coords(mcrd, nnode), u(ndofel), du(mlvarx, *), v(ndofel), a(ndofel), time(2), &
      dtime, params(*), adlmag(mdload, *), predef(2, npredf, nnode), ddlmag(mdload, *), period
  real(dp), intent(inout) :: rhs(mlvarx, *), amatrx(ndofel, ndofel), svars(*), energy(8), pnewdt
  integer, parameter :: both = 1, matrix_only = 2, residual_only = 5 ! lflags(3)
  real(dp), parameter :: cut = 0.5_dp                                ! of the increment, where contact is refused
  real(dp) :: x1(3, n1), x2(3, n2), lambda(3, n1), force1(3, n1), force2(3, n2), rows(3, n1), internal(3, nnode)
  integer(c_int64_t), allocatable, target :: row(:), column(:)
  real(dp), allocatable, target :: entry(:)
  integer(c_int64_t) :: count, k
  integer(c_int32_t) :: status

  if (mcrd /= 3 .or. nnode /= 2 * n1 + n2 .or. ndofel /= 3 * nnode) &
      call stop_with('expected 2 n1 + n2 nodes with three coordinates and three degrees of freedom')
  if (all(lflags(1) /= [1, 2])) call stop_with('for static steps only')
  if (all(lflags(3) /= [both, matrix_only, residual_only])) call stop_with('has nothing but forces and stiffness')
  rhs(1:ndofel, 1:nrhs) = 0
  amatrx = 0

  if (element == 0) then
    call first_call(coords, props(1), props(2))
  else if (jelem /= element) then
    call stop_with('a second one needs a handle of its own')
  else if (kstep /= last_step .or. kinc /= last_increment) then
    call present_state(coords, u - du(1:ndofel, 1), x1, x2, lambda)
    call must(stickslip_interface_commit(contact, x1, x2, lambda, c_null_ptr))
  end if
  element = jelem
  last_step = kstep
  last_increment = kinc

  call present_state(coords, u, x1, x2, lambda)
  status = stickslip_interface_residual(contact, x1, x2, lambda, c_null_ptr, force1, force2, rows)
  if (status == STICKSLIP_OK) status = stickslip_interface_tangent_coo(contact, x1, x2, lambda, c_null_ptr, &
      0_c_int64_t, c_null_ptr, c_null_ptr, c_null_ptr, count)
  if (status == STICKSLIP_OK) then
    allocate (row(count), column(count), entry(count))
    status = stickslip_interface_tangent_coo(contact, x1, x2, lambda, c_null_ptr, count, c_loc(row), c_loc(column), &
        c_loc(entry), count)
  end if
  if (any(status == beyond_contact)) then
    pnewdt = min(pnewdt, cut)
    return
  end if
  call must(status)
  if (lflags(3) /= matrix_only) then
    internal(:, 1:2 * n1:2) = force1
    internal(:, 2:2 * n1:2) = rows
    internal(:, 2 * n1 + 1:) = force2
    rhs(1:ndofel, 1) = -reshape(internal, [ndofel])
  end if
  if (lflags(3) /= residual_only) then
    do k = 1, count ! each entry once
      amatrx(row(k), column(k)) = entry(k)
    end do
  end if
end subroutine
