! Stage 3: a pair's forces balance, in force and in moment about the normal gap. force(3, n1 + n2), traction(3, n1).
#include "check.inc"
program t12_pair_residual_balance
  use, intrinsic :: iso_c_binding
  use check
  use pairs
  use stickslip
  implicit none
  ! Sums of a few products of numbers below 1; of two dozen of them.
  real(c_double), parameter :: ROUNDING = 1d-16, ROUNDING_OF_SUMS = 1d-15
  type(stickslip_pair) :: pair
  type(weights), target :: w
  real(c_double), allocatable, save :: x(:, :), ab(:, :), ac(:, :), traction(:, :), force(:, :), gap(:, :)
  real(c_double) :: moment(3)
  integer(c_int64_t) :: seed
  integer :: k, n1, n2, a, i

  seed = 5
  do k = 1, KINDS
    call pair_of_kind(k, pair, x)
    n1 = pair%n1
    n2 = pair%n2
    call pair_weights(pair, w)
    ab = reshape(w%ab, [n1, n1])
    ac = reshape(w%ac, [n2, n1])
    traction = reshape([(draw(seed), i = 1, 3 * n1)], [3, n1])
    force = spread([UNWRITTEN, UNWRITTEN, UNWRITTEN], 2, n1 + n2)
    CHECK_OK(stickslip_pair_residual(pair, ab, ac, traction, force))

    ! The definition: f1_B = sum_A n_AB t_A, f2_C = -sum_A n_AC t_A.
    CHECK_NEAR(force(:, :n1), matmul(traction, transpose(ab)), ROUNDING)
    CHECK_NEAR(force(:, n1 + 1:), -matmul(traction, transpose(ac)), ROUNDING)

    ! Sum of forces: zero. Sum of moments: sum_A g_A x t_A.
    gap = 0 * traction
    CHECK_OK(stickslip_pair_gap(pair, ab, ac, gap))
    moment = 0
    do a = 1, n1 + n2
      moment = moment + cross(x(:, a), force(:, a))
    end do
    do a = 1, n1
      moment = moment - cross(gap(:, a), traction(:, a))
    end do
    CHECK_NEAR(sum(force, 2), 0d0, ROUNDING_OF_SUMS)
    CHECK_NEAR(moment, 0d0, ROUNDING_OF_SUMS)
  end do

contains

  pure function cross(a, b)
    real(c_double), intent(in) :: a(3), b(3)
    real(c_double) :: cross(3)
    cross = cshift(a, 1) * cshift(b, 2) - cshift(a, 2) * cshift(b, 1)
  end function
end program
