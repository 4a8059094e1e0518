! Lines over a straight line and over a circle: the mortar side has a frame of three points and two numbers each.
#include "check.inc"
program t90_analytic_lines
  use, intrinsic :: iso_c_binding
  use check
  use stickslip
  implicit none
  integer, parameter :: N1 = 3, X1 = 2 * N1, ALL = 2 * X1
  ! Rounding of a dozen products.
  real(c_double), parameter :: ROUNDING = 1d-14
  ! The body of nonmortar is above: seen from outside, lines run with the body to their left.
  real(c_double), target, save :: place(2, N1), frame(2, 3)
  integer(c_int64_t), target, save :: offsets(3) = [0, 2, 4], nodes(4) = [1, 2, 2, 3], equations(ALL)
  integer(c_int64_t), save :: points = 3
  type(stickslip_interface), save :: contact
  integer(c_int32_t) :: basis

  place = reshape([0d0, 0d0, 0.1d0, 0d0, 0.2d0, 0d0], [2, N1])
  do basis = STICKSLIP_BASIS_STANDARD, STICKSLIP_BASIS_DUAL
    call press(basis)
  end do
  points = 4
  CHECK_REFUSED(created(0, STICKSLIP_SHAPE_PLANE, 0d0), STICKSLIP_INVALID_SIZE, 'an analytic surface has 3 nodes')
  points = 3
  CHECK_REFUSED(created(0, STICKSLIP_SHAPE_SPHERE, 0d0), STICKSLIP_INVALID_VALUE, 'options.radius is 0')
  call roll

contains

  integer(c_int32_t) function created(basis, shape, radius)
    integer(c_int32_t), intent(in) :: basis, shape
    real(c_double), intent(in) :: radius
    type(stickslip_surface) :: one, two
    type(stickslip_options) :: options
    type(stickslip_method), target :: method
    type(stickslip_method), pointer :: paper
    integer :: k
    equations = [(k, k = 1, ALL)]
    ! A point of the straight line or the circle's centre, the normal, one more.
    frame = reshape([5d0, 0d0, 5d0, 1d0, 6d0, 0d0], [2, 3])
    if (shape /= STICKSLIP_SHAPE_PLANE) frame = reshape([0.1d0, -1d0, 0.1d0, 0d0, 1.1d0, -1d0], [2, 3])
    one = stickslip_surface(n_nodes=N1, n_facets=2, coordinates=c_loc(place), facet_offsets=c_loc(offsets), &
        facet_nodes=c_loc(nodes), equations=c_loc(equations), multiplier_equations=c_loc(equations(X1 + 1)))
    two = stickslip_surface(n_nodes=points, n_facets=0, coordinates=c_loc(frame))
    CHECK_OK(stickslip_options_init(options, stickslip_options_size))
    CHECK_OK(stickslip_options_paper(options))
    call c_f_pointer(options%method, paper)
    method = paper
    options%method = c_loc(method)
    options%index_base = 1
    options%modulus = 1000
    options%mu = 0.3d0
    options%model = STICKSLIP_MODEL_PLANE
    method%multiplier_basis = basis
    options%mortar_side = STICKSLIP_MORTAR_ANALYTIC
    options%shape = shape
    options%radius = radius
    created = stickslip_interface_create(one, two, options, contact)
  end function

  ! A pressure of 1 gives its consistent loads; the sum of those on the frame is the same.
  subroutine press(basis)
    integer(c_int32_t), intent(in) :: basis
    real(c_double) :: lambda(2, N1), force1(2, N1), force2(2, 3), rows(2, N1)
    lambda = 0
    lambda(2, :) = -1
    CHECK_OK(created(basis, STICKSLIP_SHAPE_PLANE, 0d0))
    CHECK_OK(stickslip_interface_residual(contact, place, frame, lambda, c_null_ptr, force1, force2, rows))
    CHECK_NEAR(maxval(abs(force1(2, :) + [0.05d0, 0.1d0, 0.05d0])), 0d0, ROUNDING)
    CHECK_NEAR(maxval(abs(sum(force1, 2) + sum(force2, 2))), 0d0, ROUNDING)
    CHECK_NEAR(maxval(abs(rows)), 0d0, ROUNDING)
    CHECK_OK(stickslip_interface_destroy(contact))
  end subroutine

  ! A circle that turns about its centre drags the lines: they slip by its arc.
  subroutine roll
    real(c_double), parameter :: ANGLE = 1d-3
    real(c_double) :: lambda(2, N1), start(2, 3)
    real(c_double), target :: slip(2, N1)
    type(stickslip_states) :: states
    integer :: k
    CHECK_OK(created(0, STICKSLIP_SHAPE_CYLINDER, 1d0))
    lambda = 0
    lambda(2, :) = -1
    start = frame
    do k = 1, 3
      frame(:, k) = start(:, 1) + cos(ANGLE) * (start(:, k) - start(:, 1)) &
          + sin(ANGLE) * [-(start(2, k) - start(2, 1)), start(1, k) - start(1, 1)]
    end do
    states%slip = c_loc(slip)
    CHECK_OK(stickslip_interface_states(contact, place, frame, lambda, c_null_ptr, states))
    ! Node 2 is at the top of the circle, which moves there by - ANGLE along x: relative to it the node moves by ANGLE.
    CHECK_NEAR(slip(1, 2), ANGLE, 1d-2 * ANGLE)
    CHECK_OK(stickslip_interface_destroy(contact))
  end subroutine
end program
