! What accuracy may cost: rules, points in place of cells, frozen tangents. The defaults are 0; each choice acts, says
! so, and costs what it should; every rule keeps the balance of forces, not every one meets a patch test.
#include "check.inc"
program t64_accuracy
  use, intrinsic :: iso_c_binding
  use check
  use pairs
  use scenes
  use stickslip
  implicit none
  ! Sums of a few hundred products of numbers of size 1.
  real(c_double), parameter :: ROUNDING = 1d-13
  ! Rows of facets that are parallelograms: what a rule of degree 1 or 2 leaves, points across mortar edges.
  real(c_double), parameter :: COARSE = 1d-4
  type(scene), target, save :: s
  type(triplets), target, save :: t
  type(stickslip_counters) :: counters
  real(c_double) :: exact(UNKNOWNS), r(UNKNOWNS), error(2)
  integer(c_int64_t) :: entries
  integer(c_int32_t) :: i
  integer :: k

  call scene_init(s)
  CHECK(s%method%quadrature == STICKSLIP_QUADRATURE_DEGREE_5 .and. s%method%element_points == 0)
  CHECK(s%method%integration == STICKSLIP_INTEGRATION_SEGMENTS .and. s%method%tangent == STICKSLIP_TANGENT_EXACT)
  call scene_create(s)
  call scene_residual(s, exact)
  call scene_tangent(s, t)
  entries = t%n
  CHECK(says('7 points a triangle.'))
  call scene_destroy(s)

  ! Facets are parallelograms: rules from degree 4 on agree.
  call check_rule(STICKSLIP_QUADRATURE_DEGREE_1, '1 points a triangle, not exact on any facet', agrees=.false.)
  call check_rule(STICKSLIP_QUADRATURE_DEGREE_2, '3 points a triangle, not exact on any facet', agrees=.false.)
  call check_rule(STICKSLIP_QUADRATURE_DEGREE_4, '6 points a triangle.', agrees=.true.)
  call check_rule(STICKSLIP_QUADRATURE_DEGREE_6, '12 points a triangle.', agrees=.true.)
  call check_rule(STICKSLIP_QUADRATURE_DEGREE_10, '36 points a triangle.', agrees=.true.)

  ! Points: nothing is clipped, more points come closer; wholly covered facets leave hybrid no cell.
  do i = STICKSLIP_INTEGRATION_ELEMENTS, STICKSLIP_INTEGRATION_HYBRID
    do k = 1, 2
      call scene_init(s)
      s%method%integration = i
      s%method%element_points = merge(2, 10, k == 1)
      call scene_create(s)
      call scene_residual(s, r)
      error(k) = maxval(abs(r - exact))
      CHECK_OK(stickslip_interface_counters(s%contact, counters))
      CHECK(counters%pairs_integrated > 0 .and. counters%pairs_clipped == 0)
      CHECK(says(merge(' 2 x 2 points', '10 x 10 point', k == 1)))
      CHECK(says('patch tests fail'))
      call scene_destroy(s)
    end do
    CHECK(error(1) > COARSE .and. error(2) < 0.5d0 * error(1) .and. error(2) > ROUNDING)
  end do
  call scene_init(s)
  s%method%integration = STICKSLIP_INTEGRATION_ELEMENTS
  call scene_create(s)
  CHECK(says('4 x 4 points'))
  call scene_destroy(s)

  ! Tangents: frozen weights have no blocks of forces by positions; the answer is the same.
  do i = STICKSLIP_TANGENT_FROZEN_WEIGHTS, STICKSLIP_TANGENT_FROZEN_NORMALS
    call scene_init(s)
    s%method%tangent = i
    call scene_create(s)
    call scene_residual(s, r)
    CHECK(all(same(r, exact)))
    call scene_tangent(s, t)
    CHECK((t%n < entries) .eqv. (i == STICKSLIP_TANGENT_FROZEN_WEIGHTS))
    CHECK_OK(stickslip_interface_counters(s%contact, counters))
    CHECK((counters%pairs_linearised == 0) .eqv. (i == STICKSLIP_TANGENT_FROZEN_WEIGHTS))
    CHECK(says('not quadratic'))
    call scene_destroy(s)
  end do
  call check_pair()

contains

  logical function says(words)
    character(*), intent(in) :: words
    character(1000) :: text
    integer :: ending
    CHECK_OK(stickslip_interface_effects(s%contact, text, len(text, c_int64_t)))
    ending = index(text, c_null_char)
    CHECK(ending > 1 .and. ending < len(text)) ! not cut
    says = index(text(:ending), words) > 0
  end function

  ! All rules keep forces in balance.
  subroutine check_rule(rule, words, agrees)
    integer(c_int32_t), intent(in) :: rule
    character(*), intent(in) :: words
    logical, intent(in) :: agrees
    integer, parameter :: DISPLACEMENTS = UNKNOWNS - 3 * NA
    call scene_init(s)
    s%method%quadrature = rule
    call scene_create(s)
    call scene_residual(s, r)
    CHECK(says(words))
    if (agrees) then
      CHECK(maxval(abs(r - exact)) < ROUNDING)
    else
      CHECK(maxval(abs(r - exact)) > COARSE)
    end if
    CHECK(all(abs(sum(reshape(r(:DISPLACEMENTS), [3, DISPLACEMENTS / 3]), 2)) < ROUNDING))
    call scene_destroy(s)
  end subroutine

  ! A pair alone: points that fall on the mortar facet. The unit square over its lower left quarter.
  subroutine check_pair()
    type(stickslip_pair) :: pair
    real(c_double), target :: x1(3, 4), x2(3, 4), ab(16)
    x1 = reshape([0d0, 0d0, 0d0, 0d0, 1d0, 0d0, 1d0, 1d0, 0d0, 1d0, 0d0, 0d0], [3, 4])
    x2 = reshape([-1d0, -1d0, 0d0, 0.5d0, -1d0, 0d0, 0.5d0, 0.5d0, 0d0, -1d0, 0.5d0, 0d0], [3, 4])
    pair = stickslip_pair(n1=4, n2=4, x1=c_loc(x1), x2=c_loc(x2), element_points=2)
    CHECK_OK(stickslip_pair_weights(pair, c_loc(ab), c_null_ptr, c_null_ptr, c_null_ptr))
    CHECK(abs(sum(ab) - 0.25d0) < ROUNDING) ! one point of four
  end subroutine
end program
