! A border of the mortar surface that follows the edge between two non-mortar facets, in planes of their own: by itself
! each facet may claim it, or neither. With the normals of its neighbours a pair agrees with the other one.
#include "check.inc"
program t83_neighbour_normals
  use, intrinsic :: iso_c_binding
  use, intrinsic :: ieee_arithmetic
  use check
  use scenes
  use stickslip
  implicit none
  integer, parameter :: FRAMES = 200, LINE = 3
  ! Two quads with the line x = 1 in common; a mortar quad that ends on it, but for rounding.
  real(c_double), parameter :: NONMORTAR(3, 4, 2) = reshape([ &
      0d0, 0d0, 0.3d0, 0d0, 1d0, 0.3d0, 1d0, 1d0, 0d0, 1d0, 0d0, 0d0, &
      1d0, 0d0, 0d0, 1d0, 1d0, 0d0, 2d0, 1d0, 0.2d0, 2d0, 0d0, 0.2d0], [3, 4, 2])
  real(c_double), parameter :: MORTAR(3, 4) = reshape([ &
      -0.5d0, -0.4d0, 0.1d0, 1d0, -0.4d0, 0d0, 1d0, 1.7d0, 0d0, -0.5d0, 1.7d0, 0.1d0], [3, 4])
  ! Rates at which the planes see the border sweep, the cosines of their slopes; and twenty times the rounding.
  real(c_double), parameter :: RATES(2) = 1 / sqrt(1 + [0.3d0, 0.2d0]**2), ROUNDING = 1d-13
  real(c_double), target, save :: x1(3, 4, 2), x2(3, 4), normals(3, 4, 2)
  real(c_double) :: along(3)
  integer(c_int64_t) :: seed = 16
  integer :: k, disagree

  disagree = 0
  do k = 1, FRAMES
    call place()
    if (.not. is_one_of_both(rate(.false.))) disagree = disagree + 1
    CHECK(is_one_of_both(rate(.true.)))
  end do
  ! Or nothing was tried.
  CHECK(disagree > FRAMES / 10)
  call bad_input()

contains

  subroutine place()
    real(c_double) :: axis(3), angle
    integer :: f, a
    axis = [draw(seed), draw(seed), draw(seed)]
    axis = axis / norm2(axis)
    angle = 3 * draw(seed)
    x1 = NONMORTAR
    x2 = MORTAR
    along = [1d0, 0d0, 0d0]
    do a = 1, 4
      do f = 1, 2
        call scene_turn(x1(:, a, f), axis, angle)
      end do
      call scene_turn(x2(:, a), axis, angle)
    end do
    call scene_turn(along, axis, angle)
    ! The line is the third edge of the first facet and the first one of the second.
    normals = 0
    CHECK_OK(stickslip_facet_normal(4, x1(:, :, 2), normals(:, LINE, 1)))
    CHECK_OK(stickslip_facet_normal(4, x1(:, :, 1), normals(:, 1, 2)))
  end subroutine

  ! The covered area's rate while the mortar facet slides across the line.
  real(c_double) function rate(informed)
    logical, intent(in) :: informed
    type(stickslip_pair) :: pair
    real(c_double), target :: dab(3, 8, 16)
    integer :: f, a, b
    rate = 0
    do f = 1, 2
      pair = stickslip_pair(n1=4, n2=4, x1=c_loc(x1(1, 1, f)), x2=c_loc(x2))
      if (informed) pair%neighbour_normals = c_loc(normals(1, 1, f))
      CHECK_OK(stickslip_pair_weights(pair, c_null_ptr, c_null_ptr, c_loc(dab), c_null_ptr))
      do b = 1, 16
        do a = 5, 8
          rate = rate + dot_product(dab(:, a, b), along)
        end do
      end do
    end do
  end function

  logical function is_one_of_both(rate)
    real(c_double), intent(in) :: rate
    is_one_of_both = any(abs(rate - RATES) < ROUNDING)
  end function

  subroutine bad_input()
    type(stickslip_pair) :: pair
    real(c_double) :: out(3)
    out = UNWRITTEN
    pair = stickslip_pair(n1=4, n2=4, x1=c_loc(x1), x2=c_loc(x2), neighbour_normals=c_loc(normals))
    normals(:, 2, 1) = [0d0, 2d0, 0d0]
    CHECK_REFUSED(weigh(pair), STICKSLIP_INVALID_VALUE, 'neighbour_normals of edge 1')
    normals(2, 2, 1) = ieee_value(1d0, ieee_quiet_nan)
    CHECK_REFUSED(weigh(pair), STICKSLIP_NOT_FINITE, 'pair.neighbour_normals')
    CHECK_REFUSED(stickslip_facet_normal(5, x2, out), STICKSLIP_INVALID_SIZE, 'x')
    CHECK_UNTOUCHED(out)
  end subroutine

  integer(c_int32_t) function weigh(pair)
    type(stickslip_pair), intent(in) :: pair
    weigh = stickslip_pair_weights(pair, c_null_ptr, c_null_ptr, c_null_ptr, c_null_ptr)
  end function
end program
