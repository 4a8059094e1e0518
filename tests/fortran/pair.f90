! One pair of facets for the tests of the stateless calls, the twin of tests/capi/pair.h. The pair's matrices come out
! in column-major layout, the default of stickslip_pair in Fortran.
#include "check.inc"
module pairs
  use, intrinsic :: iso_c_binding
  use check
  use stickslip
  implicit none
  public

  ! Weights and their derivatives as the library writes them, large enough for two quadrilaterals. As Fortran arrays:
  ! ab(n1, n1) as (b, a), ac(n2, n1) as (c, a), dab(3 (n1 + n2), n1, n1), dac(3 (n1 + n2), n2, n1).
  type weights
    real(c_double) :: ab(16), ac(16), dab(16 * 24), dac(16 * 24)
  end type

  ! Facets of the unit size that overlap in part. Non-mortar: its body above, so clockwise seen from above.
  real(c_double), target, save :: quad1(3, 4) = &
      reshape([0d0, 0d0, 0d0, 0d0, 1d0, 0d0, 1d0, 1d0, 0d0, 1d0, 0d0, 0d0], [3, 4])
  real(c_double), target, save :: tri1(3, 3) = reshape([0d0, 0d0, 0d0, 0d0, 1d0, 0d0, 1d0, 0d0, 0d0], [3, 3])
  real(c_double), target, save :: quad2(3, 4) = &
      reshape([0.3d0, -0.4d0, -0.02d0, 1.4d0, 0.1d0, 0.01d0, 1.1d0, 1.2d0, 0.04d0, 0d0, 0.7d0, 0.01d0], [3, 4])
  real(c_double), target, save :: tri2(3, 3) = &
      reshape([-0.3d0, -0.2d0, -0.02d0, 0.8d0, 0.1d0, 0.01d0, 0.2d0, 0.9d0, 0.02d0], [3, 3])

  ! The four kinds of pairs: quad1 or tri1 over quad2 or tri2.
  integer, parameter :: KINDS = 4

contains

  ! A pair that points to x1(3, n1), x2(3, n2): they must outlive it and be targets where they are declared.
  type(stickslip_pair) function make_pair(n1, x1, n2, x2)
    integer, intent(in) :: n1, n2
    real(c_double), target, intent(in) :: x1(3, n1), x2(3, n2)
    make_pair%n1 = n1
    make_pair%n2 = n2
    make_pair%x1 = c_loc(x1)
    make_pair%x2 = c_loc(x2)
  end function

  ! The k-th kind of pair and its coordinates, x2 behind x1.
  subroutine pair_of_kind(k, pair, x)
    integer, intent(in) :: k
    type(stickslip_pair), intent(out) :: pair
    real(c_double), allocatable, intent(out) :: x(:, :)
    select case (k)
    case (1)
      pair = make_pair(4, quad1, 4, quad2)
      x = reshape([quad1, quad2], [3, 8])
    case (2)
      pair = make_pair(4, quad1, 3, tri2)
      x = reshape([quad1, tri2], [3, 7])
    case (3)
      pair = make_pair(3, tri1, 4, quad2)
      x = reshape([tri1, quad2], [3, 7])
    case default
      pair = make_pair(3, tri1, 3, tri2)
      x = reshape([tri1, tri2], [3, 6])
    end select
  end subroutine

  subroutine pair_weights(pair, w)
    type(stickslip_pair), intent(in) :: pair
    type(weights), target, intent(inout) :: w
    CHECK_OK(stickslip_pair_weights(pair, c_loc(w%ab), c_loc(w%ac), c_loc(w%dab), c_loc(w%dac)))
  end subroutine
end module
