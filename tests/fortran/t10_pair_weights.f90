! Stage 1: mortar weights of a pair, their derivative, and what does not overlap. In Fortran's order the weights are
! n_ab(b, a), n_ac(c, a), their derivatives dn_ab(coordinate, b, a).
#include "check.inc"
program t10_pair_weights
  use, intrinsic :: iso_c_binding
  use check
  use pairs
  use stickslip
  implicit none
  ! Sums of a few products of numbers of size 1.
  real(c_double), parameter :: ROUNDING = 1d-15
  ! The rules of degree 5 and 10 agree on parallelograms; a distorted quadrilateral leaves the lower one's error.
  real(c_double), parameter :: RULE_ERROR = 1d-7
  ! Central differences over 2e-6: rounding 1e-16 / 1e-6; with a distorted mortar quad the rule's own error.
  real(c_double), parameter :: DIFFERENCE = 1d-8, DIFFERENCE_DISTORTED = 1d-5
  type(stickslip_pair) :: pair
  type(weights), target :: w, v
  real(c_double), target :: alone(16), x2(3, 4)
  real(c_double), allocatable, save :: x(:, :), ac(:, :), other_ac(:, :)
  integer, parameter :: place(4) = [3, 2, 1, 4]
  integer :: k, n

  do k = 1, KINDS
    call pair_of_kind(k, pair, x)
    n = pair%n1 * pair%n2
    call pair_weights(pair, w)
    call check_rows(int(pair%n1), int(pair%n2), w)
    ! The degree-10 rule serves quadrilaterals that are no parallelograms.
    pair%quadrature = STICKSLIP_QUADRATURE_DEGREE_10
    call pair_weights(pair, v)
    CHECK_NEAR(v%ac(:n), w%ac(:n), merge(ROUNDING, RULE_ERROR, pair%n2 == 3))
    ! Each output alone, and none.
    CHECK_OK(stickslip_pair_weights(pair, c_null_ptr, c_loc(alone), c_null_ptr, c_null_ptr))
    CHECK(all(same(alone(:n), v%ac(:n))))
    CHECK_OK(stickslip_pair_weights(pair, c_null_ptr, c_null_ptr, c_null_ptr, c_null_ptr))
    CHECK(difference_error(k) < merge(DIFFERENCE, DIFFERENCE_DISTORTED, pair%n2 == 3))
  end do

  ! A known overlap: the unit square over a square shifted by (0.5, 0.5) at a distance.
  x2 = reshape([0.5d0, 0.5d0, -0.1d0, 1.5d0, 0.5d0, -0.1d0, 1.5d0, 1.5d0, -0.1d0, 0.5d0, 1.5d0, -0.1d0], [3, 4])
  pair = make_pair(4, quad1, 4, x2)
  call pair_weights(pair, w)
  call check_rows(4, 4, w)
  CHECK_NEAR(sum(w%ab), 0.25d0, ROUNDING)
  ! int of (1-x)^2 (1-y)^2 over [0.5, 1]^2 = (1/24)^2 for the node at the origin.
  CHECK_NEAR(w%ab(1), 1d0 / 576, 0.1d0 * ROUNDING)

  ! The weights do not depend on the side a mortar facet is seen from, nor on its first node.
  ac = reshape(w%ac, [4, 4])
  x2 = x2(:, place)
  call pair_weights(pair, v)
  other_ac = reshape(v%ac, [4, 4])
  CHECK_NEAR(other_ac, ac(place, :), 0.1d0 * ROUNDING)

  ! No overlap is no error: all zero, also beside, and for facets that only touch at a corner.
  do k = 0, 1
    x2 = quad1(:, 4:1:-1)
    x2(:2, :) = x2(:2, :) + merge(7d0, 1d0, k == 1)
    v = weights(UNWRITTEN, UNWRITTEN, UNWRITTEN, UNWRITTEN)
    call pair_weights(pair, v)
    CHECK(all(v%ab == 0) .and. all(v%ac == 0))
    if (k == 1) then
      CHECK(all(v%dab == 0) .and. all(v%dac == 0))
    end if
  end do

contains

  ! Each row of n_AB and of n_AC sums to the covered part of int N_A: both sides share their quadrature points.
  subroutine check_rows(n1, n2, w)
    integer, intent(in) :: n1, n2
    type(weights), intent(in) :: w
    real(c_double) :: ab(n1, n1), ac(n2, n1)
    ab = reshape(w%ab, shape(ab))
    ac = reshape(w%ac, shape(ac))
    CHECK_NEAR(sum(ab, 1), sum(ac, 1), ROUNDING)
    CHECK(all(ab == transpose(ab)))
  end subroutine

  ! Worst error of the derivatives against central differences, relative to the largest derivative.
  real(c_double) function difference_error(kind) result(relative)
    integer, intent(in) :: kind
    real(c_double), parameter :: STEP = 1d-6
    type(stickslip_pair) :: pair
    type(weights), target :: w, plus, minus
    real(c_double), allocatable, target :: x(:, :), dab(:, :), dac(:, :)
    real(c_double) :: at, error, scale
    integer :: n1, n2, i, j, coordinate
    call pair_of_kind(kind, pair, x)
    n1 = pair%n1
    n2 = pair%n2
    pair%x1 = c_loc(x(1, 1))
    pair%x2 = c_loc(x(1, n1 + 1))
    call pair_weights(pair, w)
    dab = reshape(w%dab, [3 * (n1 + n2), n1 * n1])
    dac = reshape(w%dac, [3 * (n1 + n2), n1 * n2])
    error = 0
    do j = 1, n1 + n2
      do i = 1, 3
        at = x(i, j)
        x(i, j) = at + STEP
        call pair_weights(pair, plus)
        x(i, j) = at - STEP
        call pair_weights(pair, minus)
        x(i, j) = at
        coordinate = 3 * (j - 1) + i
        error = worst([error, (plus%ab(:n1 * n1) - minus%ab(:n1 * n1)) / (2 * STEP) - dab(coordinate, :), &
                       (plus%ac(:n1 * n2) - minus%ac(:n1 * n2)) / (2 * STEP) - dac(coordinate, :)])
      end do
    end do
    scale = max(worst(dab), worst(dac))
    CHECK(scale > 0.01d0)
    relative = error / scale
  end function
end program
