! Derivatives of a residual by positions of t_n and by friction: the matrix, its products from the left and from the right, friction
! against differences; what is refused. Differences by everything else are in the C test.
#include "check.inc"
program t97_gradients
  use, intrinsic :: ieee_arithmetic
  use, intrinsic :: iso_c_binding
  use check
  use scenes
  use stickslip
  implicit none

  ! Sums of some hundred products, over their largest.
  real(c_double), parameter :: ROUNDING = 1d-13
  ! Differences with this step, over their largest: rounding 1e-16 / 1e-6; rows are linear in mu.
  real(c_double), parameter :: STEP = 1d-6, DIFFERENCES = 1d-9
  type(scene), target, save :: s
  type(triplets), target, save :: t
  type(stickslip_gradient) :: gradient
  type(stickslip_direction) :: direction
  real(c_double), save :: b(UNKNOWNS, POSITIONS)
  real(c_double) :: a(UNKNOWNS), r(UNKNOWNS), more(UNKNOWNS), less(UNKNOWNS), mu(NA)
  real(c_double), target :: previous1(SIZE1), previous2(SIZE2), friction(NA), v1(SIZE1), v2(SIZE2), dmu(NA)
  integer(c_int64_t) :: count, k
  integer(c_int32_t) :: status

  call scene_init(s)
  s%options%mu = 0.2d0
  call scene_create(s)

  ! The matrix, whose rows are equations of all unknowns and whose columns are those of the positions.
  status = previous_tangent(0_c_int64_t, c_null_ptr, c_null_ptr, c_null_ptr, count)
  CHECK_OK(status)
  CHECK(count > 0)
  call triplets_allocate(t, count)
  status = previous_tangent(count, c_loc(t%rows), c_loc(t%columns), c_loc(t%values), t%n)
  CHECK_OK(status)
  CHECK(t%n == count)
  CHECK(minval(t%rows) >= 1 .and. maxval(t%rows) <= UNKNOWNS .and. minval(t%columns) >= 1 .and. maxval(t%columns) <= POSITIONS)
  b = 0
  do k = 1, t%n
    b(t%rows(k), t%columns(k)) = b(t%rows(k), t%columns(k)) + t%values(k)
  end do
  CHECK(worst(b(:, :SIZE1)) > 0 .and. worst(b(:, SIZE1 + 1:)) > 0)
  status = previous_tangent(count - 1, c_loc(t%rows), c_loc(t%columns), c_loc(t%values), t%n)
  CHECK_REFUSED(status, STICKSLIP_BUFFER_TOO_SMALL, 'capacity')

  ! a^T B, with what friction has in the same pass; B v.
  a = [(real(mod(7 * k + 3, 11_c_int64_t) - 5, c_double), k = 1, UNKNOWNS)]
  gradient%previous1 = c_loc(previous1)
  gradient%previous2 = c_loc(previous2)
  gradient%friction = c_loc(friction)
  status = adjoint(a)
  CHECK_OK(status)
  CHECK(worst([previous1, previous2] - matmul(a, b)) <= ROUNDING * worst(matmul(abs(a), abs(b))))
  v1 = [(real(mod(5 * k + 2, 7_c_int64_t) - 3, c_double), k = 1, SIZE1)]
  v2 = [(real(mod(3 * k + 1, 5_c_int64_t) - 2, c_double), k = 1, SIZE2)]
  direction%previous1 = c_loc(v1)
  direction%previous2 = c_loc(v2)
  status = sensitivity(r)
  CHECK_OK(status)
  CHECK(worst(r - matmul(b, [v1, v2])) <= ROUNDING * worst(matmul(abs(b), abs([v1, v2]))))

  ! By friction, node after node.
  direction = stickslip_direction(friction=c_loc(dmu))
  CHECK(worst(friction) > 0)
  do k = 1, NA
    dmu = 0
    dmu(k) = 1
    status = sensitivity(r)
    CHECK_OK(status)
    mu = 0.2d0 + STEP * dmu
    CHECK_OK(stickslip_interface_set_friction(s%contact, mu))
    call scene_residual(s, more)
    mu = 0.2d0 - STEP * dmu
    CHECK_OK(stickslip_interface_set_friction(s%contact, mu))
    call scene_residual(s, less)
    CHECK(worst((more - less) / (2 * STEP) - r) <= DIFFERENCES)
    CHECK(abs(dot_product(a, r) - friction(k)) <= ROUNDING * worst(friction))
  end do

  dmu(3) = ieee_value(dmu(3), ieee_quiet_nan)
  status = sensitivity(r)
  CHECK_REFUSED(status, STICKSLIP_NOT_FINITE, 'friction')
  call scene_destroy(s)
  s%method%form = STICKSLIP_FORM_AUGMENTED
  call scene_create(s)
  status = adjoint(a)
  CHECK_REFUSED(status, STICKSLIP_UNSUPPORTED, 'STICKSLIP_FORM_MULTIPLIER')
  call scene_destroy(s)

contains

  integer(c_int32_t) function previous_tangent(capacity, rows, columns, values, n)
    integer(c_int64_t), intent(in) :: capacity
    type(c_ptr), intent(in) :: rows, columns, values
    integer(c_int64_t), intent(inout) :: n
    previous_tangent = stickslip_interface_previous_tangent_coo(s%contact, s%x1, s%x2, s%lambda, capacity, rows, columns, values, n)
  end function

  integer(c_int32_t) function adjoint(left)
    real(c_double), intent(in) :: left(UNKNOWNS)
    adjoint = stickslip_interface_adjoint(s%contact, s%x1, s%x2, s%lambda, left(:SIZE1), left(SIZE1 + 1:POSITIONS), &
        left(POSITIONS + 1:), gradient)
  end function

  integer(c_int32_t) function sensitivity(change)
    real(c_double), intent(inout) :: change(UNKNOWNS)
    sensitivity = stickslip_interface_sensitivity(s%contact, s%x1, s%x2, s%lambda, direction, change(:SIZE1), &
        change(SIZE1 + 1:POSITIONS), change(POSITIONS + 1:))
  end function
end program
