! Stage 1: the weighted gap of a pair, gap(3, n1).
#include "check.inc"
program t11_pair_gap
  use, intrinsic :: iso_c_binding
  use check
  use pairs
  use stickslip
  implicit none
  ! Sums of a few products of weights and gaps below 1.
  real(c_double), parameter :: ROUNDING = 1d-16
  real(c_double), parameter :: DISTANCES(3) = [-0.125d0, 0d0, 0.25d0], OFFSET = 1048576
  type(stickslip_pair) :: pair
  type(weights), target :: w
  real(c_double), target :: x1(3, 3), x2(3, 4)
  real(c_double) :: gap(3, 4), triangle_gap(3, 3), moved(3, 3)
  integer :: k

  ! Parallel at the distance d: g_A = d e m_A, e out of the non-mortar body; nu = -e, so d < 0 below is a gap > 0.
  x2 = reshape([-1, -1, 0, 2, -1, 0, 2, 2, 0, -1, 2, 0], [3, 4])
  pair = make_pair(4, quad1, 4, x2)
  do k = 1, 3
    x2(3, :) = DISTANCES(k)
    call pair_weights(pair, w)
    CHECK_OK(stickslip_pair_gap(pair, w%ab, w%ac, gap))
    CHECK_NEAR(gap(:2, :), 0d0, ROUNDING)
    CHECK_NEAR(gap(3, :), -DISTANCES(k) * 0.25d0, ROUNDING)
  end do

  ! The definition, with any weights: g_A = sum_B n_AB x_B - sum_C n_AC x_C, which are products of matrices here.
  pair = make_pair(3, tri1, 4, quad2)
  call pair_weights(pair, w)
  CHECK_OK(stickslip_pair_gap(pair, w%ab, w%ac, triangle_gap))
  CHECK_NEAR(triangle_gap, matmul(tri1, ab(w)) - matmul(quad2, ac(w)), ROUNDING)

  ! Far from the origin no digit is lost: the gap is taken relative to a node.
  x1 = tri1
  x2 = floor(quad2 * 1024) / 1024d0
  pair = make_pair(3, x1, 4, x2)
  call pair_weights(pair, w)
  CHECK_OK(stickslip_pair_gap(pair, w%ab, w%ac, triangle_gap))
  x1 = x1 + OFFSET
  x2 = x2 + OFFSET
  call pair_weights(pair, w)
  CHECK_OK(stickslip_pair_gap(pair, w%ab, w%ac, moved))
  CHECK(all(same(moved, triangle_gap)))

contains

  function ab(w)
    type(weights), intent(in) :: w
    real(c_double) :: ab(3, 3)
    ab = reshape(w%ab, [3, 3])
  end function

  function ac(w)
    type(weights), intent(in) :: w
    real(c_double) :: ac(4, 3)
    ac = reshape(w%ac, [4, 3])
  end function
end program
