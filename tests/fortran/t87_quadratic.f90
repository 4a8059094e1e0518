! Quadratic facets in a handle: one of eight nodes over a linear one, under a constant pressure.
#include "check.inc"
program t87_quadratic
  use, intrinsic :: iso_c_binding
  use check
  use stickslip
  implicit none
  integer, parameter :: NODES = 8, CORNERS = 4, X1 = 3 * NODES, X2 = 12
  ! Rounding of a dozen products.
  real(c_double), parameter :: ROUNDING = 1d-14
  real(c_double), target, save :: place1(3, NODES), place2(3, 4)
  integer(c_int64_t), target, save :: offsets1(2) = [0, NODES], offsets2(2) = [0, 4], nodes1(NODES), nodes2(4)
  integer(c_int64_t), target, save :: equations(X1 + X2 + X1)
  type(stickslip_interface), save :: contact
  integer :: k

  nodes1 = [(k, k = 1, NODES)]
  nodes2 = [(k, k = 1, 4)]
  place1 = reshape([0d0, 0d0, 0d0, 0d0, 1d0, 0d0, 1d0, 1d0, 0d0, 1d0, 0d0, 0d0, &
      0d0, 0.5d0, 0d0, 0.5d0, 1d0, 0d0, 1d0, 0.5d0, 0d0, 0.5d0, 0d0, 0d0], [3, NODES])
  place2 = reshape([-1d0, -1d0, 0d0, 2d0, -1d0, 0d0, 2d0, 2d0, 0d0, -1d0, 2d0, 0d0], [3, 4])
  call press(STICKSLIP_SPACE_CORNER, STICKSLIP_BASIS_STANDARD, CORNERS)
  call press(STICKSLIP_SPACE_CORNER, STICKSLIP_BASIS_DUAL, CORNERS)
  call press(STICKSLIP_SPACE_SUB, STICKSLIP_BASIS_STANDARD, NODES)
  CHECK_REFUSED(created(STICKSLIP_SPACE_CORNER, STICKSLIP_BASIS_DUAL, NODES), STICKSLIP_INVALID_VALUE, 'node 4')
  CHECK_REFUSED(created(STICKSLIP_SPACE_SUB, STICKSLIP_BASIS_DUAL, NODES), STICKSLIP_UNSUPPORTED, 'dual')
  CHECK_REFUSED(created(2_c_int32_t, STICKSLIP_BASIS_STANDARD, NODES), STICKSLIP_INVALID_VALUE, 'multiplier_space')

contains

  integer(c_int32_t) function created(space, basis, with_multipliers)
    integer(c_int32_t), intent(in) :: space, basis
    integer, intent(in) :: with_multipliers
    type(stickslip_surface) :: one, two
    type(stickslip_options) :: options
    type(stickslip_method), target :: method
    type(stickslip_method), pointer :: paper
    equations = [(k, k = 1, X1 + X2 + X1)]
    equations(X1 + X2 + 3 * with_multipliers + 1:) = -1
    one = stickslip_surface(n_nodes=NODES, n_facets=1, coordinates=c_loc(place1), facet_offsets=c_loc(offsets1), &
        facet_nodes=c_loc(nodes1), equations=c_loc(equations), multiplier_equations=c_loc(equations(X1 + X2 + 1)))
    two = stickslip_surface(n_nodes=4, n_facets=1, coordinates=c_loc(place2), facet_offsets=c_loc(offsets2), &
        facet_nodes=c_loc(nodes2), equations=c_loc(equations(X1 + 1)))
    CHECK_OK(stickslip_options_init(options, stickslip_options_size))
    CHECK_OK(stickslip_options_paper(options))
    call c_f_pointer(options%method, paper)
    method = paper
    options%method = c_loc(method)
    options%index_base = 1
    options%modulus = 1000
    options%mu = 0.3d0
    method%multiplier_space = space
    method%multiplier_basis = basis
    created = stickslip_interface_create(one, two, options, contact)
  end function

  ! A pressure of 1 gives the nodal forces of the quadratic functions, whatever the multipliers are.
  subroutine press(space, basis, multipliers)
    integer(c_int32_t), intent(in) :: space, basis
    integer, intent(in) :: multipliers
    real(c_double), target :: lambda(3, NODES), force1(3, NODES), force2(3, 4), rows(3, NODES), area(NODES), coverage(NODES)
    type(stickslip_states) :: states
    integer :: a
    lambda = 0
    lambda(3, :multipliers) = -1
    CHECK_OK(created(space, basis, multipliers))
    CHECK_OK(stickslip_interface_residual(contact, place1, place2, lambda, c_null_ptr, force1, force2, rows))
    do a = 1, NODES
      CHECK_NEAR(force1(3, a), merge(1d0 / 12, -1d0 / 3, a <= CORNERS), ROUNDING)
    end do
    CHECK_NEAR(sum(force2(3, :)), 1d0, ROUNDING)
    states%area = c_loc(area)
    states%coverage = c_loc(coverage)
    CHECK_OK(stickslip_interface_states(contact, place1, place2, lambda, c_null_ptr, states))
    do a = 1, NODES
      CHECK_NEAR(coverage(a), merge(area(a), 0d0, a <= multipliers), ROUNDING)
    end do
    CHECK_NEAR(sum(coverage), 1d0, ROUNDING)
    CHECK_OK(stickslip_interface_destroy(contact))
  end subroutine
end program
