! Lines of plane and axisymmetric models: weights, gap, forces and tangent of two of them, and what is refused.
#include "check.inc"
program t88_lines
  use, intrinsic :: iso_c_binding
  use check
  use stickslip
  implicit none
  ! Two nodes and two multipliers a line, two components each: x1, x2, lambda.
  integer, parameter :: NODES = 2, X = 2 * NODES, UNKNOWNS = 3 * X
  ! Rounding of a dozen products.
  real(c_double), parameter :: ROUNDING = 1d-14
  ! Central differences of numbers of some tens: rounding 1e-15 / STEP, and the step's square times a third derivative.
  real(c_double), parameter :: STEP = 1d-6, DIFFERENCES = 1d-6
  real(c_double), parameter :: PI = acos(-1d0)

  ! As Fortran arrays: ab(b, a), dab(column, b, a).
  type weights
    real(c_double) :: ab(NODES, NODES), ac(NODES, NODES), dab(2 * X, NODES, NODES), dac(2 * X, NODES, NODES)
  end type

  ! x1 along the first axis with its body above it, x2 below it with its body below: the middle three quarters overlap.
  real(c_double), target, save :: start(UNKNOWNS) = &
      [0d0, 0d0, 1d0, 0d0, 0.875d0, -0.1d0, 0.125d0, -0.1d0, 0.02d0, -1d0, 0.01d0, -0.9d0]
  real(c_double), target, save :: beyond(X) = [-0.5d0, 0d0, 1d0, 0d0]
  type(weights), target, save :: w
  type(stickslip_pair) :: pair
  real(c_double) :: gap(2, NODES), second, whole
  integer :: a

  ! The sums of both sides are those of int N_A over the overlap, three quarters of the line: 3/8 each, times the thickness.
  pair = pair_at(start, STICKSLIP_MODEL_PLANE)
  pair%thickness = 0.5d0
  CHECK_OK(stickslip_pair_weights(pair, c_loc(w%ab), c_loc(w%ac), c_null_ptr, c_null_ptr))
  do a = 1, NODES
    CHECK_NEAR(sum(w%ab(:, a)), 0.1875d0, ROUNDING)
    CHECK_NEAR(sum(w%ac(:, a)), 0.1875d0, ROUNDING)
  end do
  pair%thickness = 0
  CHECK_OK(stickslip_pair_weights(pair, c_loc(w%ab), c_loc(w%ac), c_loc(w%dab), c_loc(w%dac)))
  CHECK_OK(stickslip_pair_gap(pair, w%ab, w%ac, gap))
  do a = 1, NODES
    CHECK_NEAR(sum(w%ab(:, a)), 0.375d0, ROUNDING)
    CHECK_NEAR(gap(1, a), 0d0, ROUNDING)
    CHECK_NEAR(gap(2, a), 0.0375d0, ROUNDING)
  end do
  call tangent(STICKSLIP_MODEL_PLANE)

  ! A ring from the axis on: int 2 pi r N_A over the overlap, 0.125 to 0.875; the node on the axis has the smaller part.
  pair%model = STICKSLIP_MODEL_AXISYMMETRIC
  CHECK_OK(stickslip_pair_weights(pair, c_loc(w%ab), c_loc(w%ac), c_null_ptr, c_null_ptr))
  second = 2 * PI * (0.875d0**3 - 0.125d0**3) / 3
  whole = PI * (0.875d0**2 - 0.125d0**2)
  CHECK_NEAR(sum(w%ab(:, 1)), whole - second, ROUNDING)
  CHECK_NEAR(sum(w%ab(:, 2)), second, ROUNDING)
  call tangent(STICKSLIP_MODEL_AXISYMMETRIC)

  ! Nothing lies beyond the axis.
  pair%x1 = c_loc(beyond)
  CHECK_REFUSED(weighed(), STICKSLIP_INVALID_VALUE, 'pair.x1: node 0 has r = -0.5;')
  pair%x1 = c_loc(start)
  pair%x2 = c_loc(beyond)
  CHECK_REFUSED(weighed(), STICKSLIP_INVALID_VALUE, 'pair.x2: node 0 has r = -0.5;')
  pair%x2 = c_loc(start(X + 1))
  pair%n1 = 4
  CHECK_REFUSED(weighed(), STICKSLIP_INVALID_SIZE, '2 (line2) or 3 (line3)')
  pair%n1 = NODES
  pair%thickness = 1
  CHECK_REFUSED(weighed(), STICKSLIP_INVALID_VALUE, 'pair.thickness')

contains

  integer(c_int32_t) function weighed()
    weighed = stickslip_pair_weights(pair, c_loc(w%ab), c_loc(w%ac), c_loc(w%dab), c_loc(w%dac))
  end function

  type(stickslip_pair) function pair_at(u, model)
    real(c_double), target, intent(in) :: u(UNKNOWNS)
    integer(c_int32_t), intent(in) :: model
    pair_at = stickslip_pair(n1=NODES, n2=NODES, x1=c_loc(u), x2=c_loc(u(X + 1)), model=model)
  end function

  ! Forces, then rows of the multipliers; and the tangent. The weights of t_n are those of the start.
  subroutine evaluate(u, model, residual, k)
    real(c_double), target, intent(in) :: u(UNKNOWNS)
    integer(c_int32_t), intent(in) :: model
    real(c_double), intent(out) :: residual(UNKNOWNS)
    real(c_double), intent(inout) :: k(UNKNOWNS, UNKNOWNS)
    type(weights), target :: now, before
    type(stickslip_pair) :: p, begun
    type(stickslip_node) :: node
    type(stickslip_node_response) :: responses(NODES)
    real(c_double) :: gap(2, NODES), gap_before(2, NODES), forces(2, 2 * NODES)
    real(c_double), target :: block(3, 3)
    integer(c_int32_t) :: status
    integer :: a, first
    p = pair_at(u, model)
    begun = pair_at(start, model)
    CHECK_OK(stickslip_pair_weights(p, c_loc(now%ab), c_loc(now%ac), c_loc(now%dab), c_loc(now%dac)))
    CHECK_OK(stickslip_pair_weights(begun, c_loc(before%ab), c_loc(before%ac), c_null_ptr, c_null_ptr))
    CHECK_OK(stickslip_pair_gap(p, now%ab, now%ac, gap))
    CHECK_OK(stickslip_pair_gap(p, before%ab, before%ac, gap_before))
    CHECK_OK(stickslip_pair_residual(p, now%ab, now%ac, u(2 * X + 1:), forces))
    residual(:2 * X) = reshape(forces, [2 * X])
    do a = 1, NODES
      first = 2 * X + 2 * a - 1
      ! A node of such a model: the third direction is prescribed, the third components are 0.
      node = stickslip_node(augmentation=20d0, mu=0.3d0, coverage=1d0, coverage_previous=1d0, n_directions=1)
      node%directions(3, 1) = 1
      node%normal = [0d0, 1d0, 0d0]
      node%lambda(:2) = u(first:first + 1)
      node%gap_now(:2) = gap(:, a)
      node%gap_previous(:2) = gap_before(:, a)
      CHECK_OK(stickslip_node_respond(node, responses(a)))
      CHECK(responses(a)%row(3) == 0 .and. responses(a)%traction(3) == 0)
      residual(first:first + 1) = responses(a)%row(:2)
    end do
    status = stickslip_pair_tangent(p, c_loc(now%ab), c_loc(now%ac), c_loc(now%dab), c_loc(now%dac), c_loc(before%ab), &
        c_loc(before%ac), u(2 * X + 1:), responses, c_null_ptr, k, int(UNKNOWNS, c_int64_t))
    CHECK_OK(status)
    do a = 1, NODES
      first = 2 * X + 2 * a - 1
      CHECK_OK(stickslip_node_block(responses(a), 1d0, STICKSLIP_LAYOUT_COLUMN_MAJOR, c_null_ptr, c_loc(block)))
      k(first:first + 1, first:first + 1) = k(first:first + 1, first:first + 1) + block(:2, :2)
    end do
  end subroutine

  subroutine tangent(model)
    integer(c_int32_t), intent(in) :: model
    real(c_double) :: u(UNKNOWNS), residual(UNKNOWNS), plus(UNKNOWNS), less(UNKNOWNS)
    real(c_double) :: k(UNKNOWNS, UNKNOWNS), other(UNKNOWNS, UNKNOWNS), kept
    integer :: i, j
    ! Somewhat further than the start, so that the nodes have slid; the axis is not passed.
    u = start
    u(:2 * X) = start(:2 * X) + [(0.01d0 * mod(i, 3), i = 0, 2 * X - 1)]
    call evaluate(u, model, residual, k)
    CHECK_NEAR(sum(residual(1:2 * X:2)), 0d0, 10 * ROUNDING)
    CHECK_NEAR(sum(residual(2:2 * X:2)), 0d0, 10 * ROUNDING)
    ! A node on the axis has a difference to one side only.
    do j = 2, UNKNOWNS
      kept = u(j)
      u(j) = kept + STEP
      call evaluate(u, model, plus, other)
      u(j) = kept - STEP
      call evaluate(u, model, less, other)
      u(j) = kept
      do i = 1, UNKNOWNS
        CHECK_NEAR(k(i, j), (plus(i) - less(i)) / (2 * STEP), DIFFERENCES)
      end do
    end do
  end subroutine
end program
