! Lines of plane and axisymmetric models in a handle: two components a node in every array. Two non-mortar lines over one with a node
! in the middle, under a constant pressure.
#include "check.inc"
program t89_lines_handle
  use, intrinsic :: iso_c_binding
  use check
  use stickslip
  implicit none
  integer, parameter :: N1 = 3, N2 = 3, X1 = 2 * N1, X2 = 2 * N2, ALL = 2 * X1 + X2
  ! Rounding of a dozen products.
  real(c_double), parameter :: ROUNDING = 1d-14, TWO_PI = 6.283185307179586d0
  ! The body of nonmortar is above, that of mortar below: seen from outside, lines run with the body to their left.
  real(c_double), target, save :: place1(2, N1), place2(2, N2), behind(2, N1)
  integer(c_int64_t), target, save :: offsets1(3) = [0, 2, 4], nodes1(4) = [1, 2, 2, 3], offsets2(2) = [0, 3], nodes2(3) = [1, 2, 3]
  integer(c_int64_t), target, save :: equations(ALL)
  type(stickslip_interface), save :: contact
  integer(c_int32_t) :: basis

  place1 = reshape([0d0, 0d0, 0.4d0, 0d0, 1d0, 0d0], [2, N1])
  place2 = reshape([2d0, 0d0, 0d0, 0d0, 1d0, 0d0], [2, N2])
  do basis = STICKSLIP_BASIS_STANDARD, STICKSLIP_BASIS_DUAL
    call press(STICKSLIP_MODEL_PLANE, 0d0, basis)
    call press(STICKSLIP_MODEL_PLANE, 0.7d0, basis)
    call press(STICKSLIP_MODEL_AXISYMMETRIC, 0d0, basis)
  end do
  behind = place1
  behind(1, 1) = -0.1d0
  CHECK_REFUSED(created(STICKSLIP_MODEL_AXISYMMETRIC, 0d0, 0, behind), STICKSLIP_INVALID_VALUE, 'node 0 has r = -1e-1')
  CHECK_REFUSED(created(STICKSLIP_MODEL_AXISYMMETRIC, 1d0, 0, place1), STICKSLIP_INVALID_VALUE, 'options.thickness')

contains

  integer(c_int32_t) function created(model, thickness, basis, x)
    integer(c_int32_t), intent(in) :: model, basis
    real(c_double), intent(in) :: thickness
    real(c_double), target, intent(in) :: x(2, N1)
    type(stickslip_surface) :: one, two
    type(stickslip_options) :: options
    type(stickslip_method), target :: method
    type(stickslip_method), pointer :: paper
    integer :: k
    equations = [(k, k = 1, ALL)]
    one = stickslip_surface(n_nodes=N1, n_facets=2, coordinates=c_loc(x), facet_offsets=c_loc(offsets1), &
        facet_nodes=c_loc(nodes1), equations=c_loc(equations), multiplier_equations=c_loc(equations(X1 + X2 + 1)))
    two = stickslip_surface(n_nodes=N2, n_facets=1, coordinates=c_loc(place2), facet_offsets=c_loc(offsets2), &
        facet_nodes=c_loc(nodes2), equations=c_loc(equations(X1 + 1)))
    CHECK_OK(stickslip_options_init(options, stickslip_options_size))
    CHECK_OK(stickslip_options_paper(options))
    call c_f_pointer(options%method, paper)
    method = paper
    options%method = c_loc(method)
    options%index_base = 1
    options%modulus = 1000
    options%mu = 0.3d0
    options%model = model
    options%thickness = thickness
    method%multiplier_basis = basis
    created = stickslip_interface_create(one, two, options, contact)
  end function

  ! A pressure of 1 gives its consistent loads on both sides.
  subroutine press(model, thickness, basis)
    integer(c_int32_t), intent(in) :: model, basis
    real(c_double), intent(in) :: thickness
    real(c_double), target :: lambda(2, N1), force1(2, N1), force2(2, N2), rows(2, N1), area(N1), normal(2, N1)
    real(c_double) :: expected(N1)
    type(stickslip_states) :: states
    lambda = 0
    lambda(2, :) = -1
    CHECK_OK(created(model, thickness, basis, place1))
    CHECK_OK(stickslip_interface_residual(contact, place1, place2, lambda, c_null_ptr, force1, force2, rows))
    states%area = c_loc(area)
    states%normal = c_loc(normal)
    CHECK_OK(stickslip_interface_states(contact, place1, place2, lambda, c_null_ptr, states))
    expected = merge(1d0, thickness, thickness == 0) * [0.2d0, 0.5d0, 0.3d0]
    if (model == STICKSLIP_MODEL_AXISYMMETRIC) expected = TWO_PI * [0.08d0 / 3, 0.7d0 / 3, 0.24d0]
    CHECK_NEAR(maxval(abs(area - expected)), 0d0, ROUNDING)
    CHECK_NEAR(maxval(abs(force1(2, :) + expected)), 0d0, ROUNDING)
    CHECK_NEAR(maxval(abs(normal(2, :) - 1)), 0d0, ROUNDING)
    CHECK_NEAR(sum(force2(2, :)), sum(expected), ROUNDING)
    CHECK_NEAR(maxval(abs(rows)), 0d0, ROUNDING)
    CHECK_OK(stickslip_interface_destroy(contact))
  end subroutine
end program
