! Stage 2: gap, stick and slip of a node; ties, frictionless and uncovered nodes; derivatives by differences. Matrices
! of a response are row-major: derivative(j, i) is d row_i / d x_j.
#include "check.inc"
program t20_node
  use, intrinsic :: iso_c_binding
  use check
  use stickslip
  implicit none
  ! Sums of a few numbers of size 1, of size 10.
  real(c_double), parameter :: ROUNDING = 1d-15, ROUNDING_10 = 1d-14
  ! Central differences: rounding 1e-16 / 1e-6 on numbers of size 10.
  real(c_double), parameter :: STEP = 1d-6, DIFFERENCE = 1d-8
  real(c_double), parameter :: NU(3) = [0.6d0, 0d0, 0.8d0], MU = 0.5d0
  real(c_double), parameter :: IDENTITY(3, 3) = reshape([1, 0, 0, 0, 1, 0, 0, 0, 1], [3, 3])
  ! The inputs that the response has derivatives for.
  integer, parameter :: LAMBDA = 1, GAP_NOW = 2, GAP_PREVIOUS = 3
  real(c_double), parameter :: MEASURED(3) = [0.75d0, 0.875d0, 1d0]
  type(stickslip_node) :: n
  type(stickslip_node_response) :: r
  integer(c_int32_t) :: slip
  integer :: k

  ! Stick: p = sigma, below mu |sigma_N| = 5.
  n = make_node(4d0, MU)
  r = respond(n)
  CHECK(r%state == STICKSLIP_STATE_STICK)
  CHECK_NEAR(r%gap_normal, -0.5d0, ROUNDING)
  CHECK_NEAR(r%slip(2), 1d0, ROUNDING)
  CHECK_NEAR(r%sigma, ([-6d0, 4d0, -8d0]), ROUNDING_10)
  CHECK(all(same(r%traction, r%sigma)))

  ! Slip: the tangential part is cut to the cone.
  n = make_node(20d0, MU)
  r = respond(n)
  CHECK(r%state == STICKSLIP_STATE_SLIP)
  CHECK_NEAR(r%traction(1:2), ([-6d0, 5d0]), ROUNDING_10)

  ! Gap: open beyond the multiplier. The row drives lambda to zero.
  n = make_node(4d0, MU)
  n%gap_now = 3 * NU
  r = respond(n)
  CHECK(r%state == STICKSLIP_STATE_GAP .and. all(r%traction == 0))

  ! On the cone within 1e-12 a node slips; the border of the gap is gap.
  CHECK(state(make_node(5d0, MU)) == STICKSLIP_STATE_SLIP)
  CHECK(state(make_node(5 * (1 - 1d-13), MU)) == STICKSLIP_STATE_SLIP)
  CHECK(state(make_node(5 * (1 - 1d-10), MU)) == STICKSLIP_STATE_STICK)
  n = make_node(0d0, MU)
  n%lambda = 0
  n%gap_now = 0
  n%gap_previous = 0
  CHECK(state(n) == STICKSLIP_STATE_GAP)

  ! Without friction nothing tangential is carried, with or without a trial traction.
  do k = 0, 1
    r = respond(make_node(4d0 * k, 0d0))
    CHECK(r%state == STICKSLIP_STATE_SLIP)
    CHECK(r%traction(2) == 0)
    CHECK_NEAR(r%traction(1), -6d0, ROUNDING_10)
  end do

  ! The other laws. With a shear limit below mu |sigma_N| = 5 that is the shear; above it mu decides.
  n = make_node(20d0, MU)
  n%friction = STICKSLIP_FRICTION_TRESCA
  n%shear_limit = 3
  r = respond(n)
  CHECK(r%state == STICKSLIP_STATE_SLIP)
  CHECK_NEAR(r%traction(2), 3d0, ROUNDING_10)
  call check_derivative(n, GAP_NOW, r%drow_dnow)
  n%shear_limit = 6
  r = respond(n)
  CHECK_NEAR(r%traction(2), 5d0, ROUNDING_10)
  n%shear_limit = 0
  CHECK_REFUSED(stickslip_node_respond(n, r), STICKSLIP_INVALID_VALUE, 'node.shear_limit')
  n = make_node(20d0, 0d0)
  n%friction = STICKSLIP_FRICTION_ROUGH
  CHECK(state(n) == STICKSLIP_STATE_STICK)
  n%friction = STICKSLIP_FRICTION_NONE
  r = respond(n)
  CHECK(r%state == STICKSLIP_STATE_SLIP .and. all(r%slip == 0))
  CHECK(r%traction(2) == 0)
  ! Tied to the gap 2 nu, 2.5 away.
  n%friction = STICKSLIP_FRICTION_TIED
  n%gap_committed = 2 * NU
  r = respond(n)
  CHECK(r%state == STICKSLIP_STATE_STICK)
  CHECK_NEAR(r%row(3), -2.5d0 * NU(3), ROUNDING)
  n%friction = 5
  CHECK_REFUSED(stickslip_node_respond(n, r), STICKSLIP_INVALID_VALUE, 'node.friction')
  n = make_node(20d0, MU)
  n%friction = STICKSLIP_FRICTION_TIED
  CHECK_REFUSED(stickslip_node_respond(n, r), STICKSLIP_INVALID_VALUE, 'node.mu')

  ! A huge coefficient sticks.
  CHECK(state(make_node(20d0, 1d6)) == STICKSLIP_STATE_STICK)

  ! Uncovered: gap, whatever the multiplier. Uncovered at t_n: no slip history.
  n = make_node(4d0, MU)
  n%coverage = n%coverage_min
  CHECK(state(n) == STICKSLIP_STATE_GAP)
  n = make_node(4d0, MU)
  n%coverage_previous = 0
  r = respond(n)
  CHECK(r%state == STICKSLIP_STATE_STICK .and. all(r%slip == 0) .and. all(r%drow_dprevious == 0))

  ! The three measures of slip: P (g_prev - g_now), P (g_prev - g_committed), P g_prev.
  n = make_node(4d0, MU)
  n%gap_now(2) = 0.25d0
  n%gap_committed(2) = 0.125d0
  do slip = 0, 2
    n%slip = slip
    r = respond(n)
    CHECK_NEAR(r%slip(2), MEASURED(slip + 1), ROUNDING)
  end do

  ! Prescribed along y: nothing tangential is left there, and the row removes the multiplier's part.
  n = make_node(20d0, MU)
  n%n_directions = 1
  n%directions(:, 1) = [0d0, 1d0, 0d0]
  n%lambda(2) = 2
  r = respond(n)
  CHECK(r%state == STICKSLIP_STATE_STICK)
  CHECK(r%traction(2) == 0)
  CHECK_NEAR(r%row(2), -0.5d0, ROUNDING)

  ! All derivatives, in every state and for every measure.
  do slip = 0, 2
    do k = 0, 3
      n = make_node(merge(20d0, 3d0, k == 1), merge(0d0, MU, k == 3))
      n%slip = slip
      n%lambda = n%lambda + [0.3d0, 0d0, -0.4d0]
      n%gap_committed(2) = 0.02d0
      if (k == 2) n%gap_now(1) = n%gap_now(1) + 30
      r = respond(n)
      CHECK(r%state == expected_state(k))
      call check_derivative(n, LAMBDA, r%drow_dlambda)
      call check_derivative(n, GAP_NOW, r%drow_dnow)
      call check_derivative(n, GAP_PREVIOUS, r%drow_dprevious)
      ! dc/dlambda = (dp/dlambda - I) / r.
      CHECK_NEAR(r%drow_dlambda, (r%dp_dlambda - IDENTITY) / n%augmentation, ROUNDING)
    end do
  end do

contains

  ! A closed, covered node with sigma_N = -10 and sigma_T = t along y.
  type(stickslip_node) function make_node(t, friction) result(n)
    real(c_double), intent(in) :: t, friction
    n = stickslip_node(normal=NU, augmentation=4d0, mu=friction, coverage=1d0, coverage_previous=1d0, &
        coverage_min=1d-8, lambda=-8 * NU, gap_now=-0.5d0 * NU, gap_previous=-0.5d0 * NU)
    n%gap_previous(2) = n%gap_previous(2) + 0.25d0 * t
  end function

  type(stickslip_node_response) function respond(n) result(r)
    type(stickslip_node), intent(in) :: n
    CHECK_OK(stickslip_node_respond(n, r))
    CHECK(r%struct_size == stickslip_node_response_size .and. r%reserved == 0)
    ! The row is -(lambda - p) / r in every state.
    CHECK_NEAR(r%row, -(n%lambda - r%traction) / n%augmentation, ROUNDING_10)
  end function

  integer(c_int32_t) function state(n)
    type(stickslip_node), intent(in) :: n
    type(stickslip_node_response) :: r
    r = respond(n)
    state = r%state
  end function

  integer(c_int32_t) function expected_state(k)
    integer, intent(in) :: k
    expected_state = STICKSLIP_STATE_SLIP
    if (k == 0) expected_state = STICKSLIP_STATE_STICK
    if (k == 2) expected_state = STICKSLIP_STATE_GAP
  end function

  ! One input of the node, its derivative in the response.
  subroutine check_derivative(node, input, derivative)
    type(stickslip_node), intent(in) :: node
    integer, intent(in) :: input
    real(c_double), intent(in) :: derivative(3, 3)
    type(stickslip_node_response) :: plus, minus
    integer :: j
    do j = 1, 3
      plus = respond(moved(node, input, j, STEP))
      minus = respond(moved(node, input, j, -STEP))
      CHECK_NEAR(derivative(j, :), (plus%row - minus%row) / (2 * STEP), DIFFERENCE)
      if (input == LAMBDA) cycle
      ! dp/dg is r times dc/dg.
      CHECK_NEAR(node%augmentation * derivative(j, :), (plus%traction - minus%traction) / (2 * STEP), DIFFERENCE)
    end do
  end subroutine

  type(stickslip_node) function moved(node, input, j, by)
    type(stickslip_node), intent(in) :: node
    integer, intent(in) :: input, j
    real(c_double), intent(in) :: by
    moved = node
    if (input == LAMBDA) moved%lambda(j) = moved%lambda(j) + by
    if (input == GAP_NOW) moved%gap_now(j) = moved%gap_now(j) + by
    if (input == GAP_PREVIOUS) moved%gap_previous(j) = moved%gap_previous(j) + by
  end function
end program
