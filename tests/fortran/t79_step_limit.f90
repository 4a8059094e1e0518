! How much of a step may be taken before the surfaces pass through each other: gaps of all sizes, either multiplier, all
! weights, a rigid and an analytic mortar side, parts of the mortar surface on several handles.
#include "check.inc"
program t79_step_limit
  use, intrinsic :: iso_c_binding
  use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan, ieee_positive_inf
  use check
  use scenes
  use stickslip
  implicit none
  ! The shortest edge of the non-mortar facets, and the default of how much of it a node may go deeper.
  real(c_double), parameter :: EDGE = 0.5d0, DEPTH = 0.1d0
  ! An advance may end a quarter of the depth before the limit, and, of the depth, this far beyond it by rounding.
  real(c_double), parameter :: SHARPNESS = 0.25d0, BEYOND = 1d-5
  real(c_double), parameter :: GAPS(6) = [0d0, 1d-3, 0.05d0, 0.5d0, 5d0, 500d0]
  real(c_double), parameter :: MOTIONS(5) = [1d-4, 0.3d0, 1d0, 1d3, 1d9], PENETRATIONS(3) = [0d0, 0.03d0, 1d0]
  type(scene), target :: s
  real(c_double), target :: dx1(3, NA), dx2(3, NC)

  call check_sides()
  call check_analytic()
  call check_parts()
  call check_nothing_changes()
  call check_refusals()

contains

  ! v in the scene's frame.
  function framed(v)
    real(c_double), intent(in) :: v(3)
    real(c_double) :: framed(3)
    framed = v
    call scene_frame(framed)
  end function

  ! Both surfaces flat, with a gap between them.
  subroutine apart_by(gap)
    real(c_double), intent(in) :: gap
    s%x1 = s%reference1 + spread(framed([0d0, 0d0, gap]), 2, NA)
    s%x2 = s%reference2
  end subroutine

  ! The two sides move by v1 and v2.
  subroutine move_by(v1, v2)
    real(c_double), intent(in) :: v1(3), v2(3)
    dx1 = spread(framed(v1), 2, NA)
    dx2 = spread(framed(v2), 2, NC)
  end subroutine

  real(c_double) function limit(penetration)
    real(c_double), intent(in) :: penetration
    limit = -1
    CHECK_OK(stickslip_interface_step_limit(s%contact, s%x1, s%x2, dx1, dx2, penetration, limit))
    CHECK(limit > 0 .and. limit <= 1)
  end function

  ! A gap closes by a motion of this length: it ends in a slight penetration.
  subroutine check_closing(gap, motion, penetration)
    real(c_double), intent(in) :: gap, motion, penetration
    real(c_double) :: deep, most, moved
    real(c_double), parameter :: REST(3) = 0
    deep = EDGE * merge(penetration, DEPTH, penetration > 0)
    most = gap + deep
    call apart_by(gap)
    call move_by([0d0, 0d0, -motion], REST)
    moved = motion * limit(penetration)
    if (motion <= most) then
      CHECK_NEAR(moved, motion, BEYOND * deep)
    else
      CHECK(moved <= most + BEYOND * deep .and. moved >= most - SHARPNESS * deep)
    end if
    ! The same where the other side moves, and where each moves a half.
    call move_by(REST, [0d0, 0d0, motion])
    CHECK_NEAR(motion * limit(penetration), moved, SHARPNESS * deep)
    call move_by([0d0, 0d0, -motion / 2], [0d0, 0d0, motion / 2])
    CHECK_NEAR(motion * limit(penetration), moved, SHARPNESS * deep)
    ! The surfaces part; both go the same way.
    call move_by([0d0, 0d0, motion], REST)
    CHECK(limit(penetration) == 1)
    call move_by([motion, 2 * motion, -motion], [motion, 2 * motion, -motion])
    CHECK(limit(penetration) == 1)
  end subroutine

  subroutine check_all_gaps()
    integer :: i, j, k
    call scene_create(s)
    do i = 1, size(GAPS)
      do j = 1, size(MOTIONS)
        do k = 1, size(PENETRATIONS)
          call check_closing(GAPS(i), MOTIONS(j), PENETRATIONS(k))
        end do
      end do
    end do
  end subroutine

  subroutine check_sides()
    real(c_double) :: moved
    integer :: k
    call scene_init(s)
    call check_all_gaps()
    ! A node that is deep may go on by the depth, one that slides may slide.
    call apart_by(-0.2d0)
    call move_by([0d0, 0d0, -1d0], [0d0, 0d0, 0d0])
    moved = limit(0d0)
    CHECK(moved <= DEPTH * EDGE * (1 + BEYOND) .and. moved >= (1 - SHARPNESS) * DEPTH * EDGE)
    call move_by([0.3d0, 0.2d0, 0d0], [0d0, 0d0, 0d0])
    CHECK(limit(0d0) == 1)
    ! Surfaces that nothing covers after the motion, however long it is.
    call apart_by(0.1d0)
    call move_by([1d6, 0d0, 0d0], [0d0, 0d0, 0d0])
    moved = limit(0d0)
    call scene_destroy(s)
    ! Without friction; a rigid mortar side; frozen weights, of which the gap is linear.
    call scene_init(s)
    s%options%friction = STICKSLIP_FRICTION_NONE
    s%options%mu = 0
    call check_all_gaps()
    call scene_destroy(s)
    call scene_init(s)
    s%equations2 = -1
    s%options%mortar_side = STICKSLIP_MORTAR_RIGID
    call check_all_gaps()
    call scene_destroy(s)
    do k = STICKSLIP_WEIGHTS_COMMITTED, STICKSLIP_WEIGHTS_REFERENCE
      call scene_init(s)
      s%method%weights = k
      call check_all_gaps()
      call scene_destroy(s)
    end do
    ! Tied: as it likes.
    call scene_init(s)
    s%options%friction = STICKSLIP_FRICTION_TIED
    s%options%mu = 0
    call scene_create(s)
    call apart_by(0.1d0)
    call move_by([0d0, 0d0, -9d0], [0d0, 0d0, 0d0])
    CHECK(limit(0d0) == 1)
    call scene_destroy(s)
  end subroutine

  ! A plane in closed form, under the non-mortar side.
  subroutine check_analytic()
    real(c_double), target :: frame(3, 4)
    real(c_double) :: turned(3, 4), rise(3, 4), fraction, most
    integer(c_int32_t) :: status
    integer :: k
    frame = reshape([0.5d0, 0.5d0, 0d0, 0.5d0, 0.5d0, 1d0, 1.5d0, 0.5d0, 0d0, 0.5d0, 1.5d0, 0d0], [3, 4])
    turned = frame
    do k = 1, 4
      call scene_frame(frame(:, k))
      call scene_turn(turned(:, k), [0d0, 0d0, 1d0], 0.5d0)
      call scene_frame(turned(:, k))
    end do
    call scene_init(s)
    s%mortar%n_nodes = 4
    s%mortar%n_facets = 0
    s%mortar%coordinates = c_loc(frame)
    s%mortar%facet_offsets = c_null_ptr
    s%mortar%facet_nodes = c_null_ptr
    s%mortar%equations = c_null_ptr
    s%options%mortar_side = STICKSLIP_MORTAR_ANALYTIC
    call scene_create(s)
    call apart_by(0.7d0)
    call move_by([0d0, 0d0, -100d0], [0d0, 0d0, 0d0])
    rise = spread(framed([0d0, 0d0, 50d0]), 2, 4)
    fraction = -1
    CHECK_OK(stickslip_interface_step_limit(s%contact, s%x1, frame, dx1, rise, 0d0, fraction))
    most = 0.7d0 + DEPTH * EDGE
    CHECK(150 * fraction <= most + BEYOND .and. 150 * fraction >= most - SHARPNESS * DEPTH * EDGE)
    ! A frame that turns is no rigid body on the way.
    status = stickslip_interface_step_limit(s%contact, s%x1, frame, dx1, turned - frame, 0d0, fraction)
    CHECK_REFUSED(status, STICKSLIP_INVALID_VALUE, 'mortar')
    call scene_destroy(s)
  end subroutine

  ! The least that the handles of a mortar surface in parts allow is allowed for the whole.
  subroutine check_parts()
    real(c_double) :: least, fraction, whole
    integer :: a, row
    call scene_init(s)
    call scene_create(s)
    call apart_by(0.3d0)
    call move_by([0d0, 0d0, 0d0], [0d0, 0d0, 0d0])
    ! Tilted, so that the parts are not alike.
    do a = 1, NA
      dx1(:, a) = framed([0d0, 0d0, -2d0 - mod(a - 1, 3) - 0.5d0 * ((a - 1) / 3)])
    end do
    whole = limit(0d0)
    call scene_destroy(s)
    least = 1
    do row = 0, 2
      call scene_init(s)
      call apart_by(0.3d0)
      ! Three facets; their nodes are the two rows of four from 4 row on.
      s%mortar%n_nodes = 8
      s%mortar%n_facets = 3
      s%mortar%coordinates = c_loc(s%reference2(1, 4 * row + 1))
      call scene_create(s)
      fraction = -1
      CHECK_OK(stickslip_interface_step_limit(s%contact, s%x1, s%reference2(:, 4*row + 1:), dx1, dx2, 0d0, fraction))
      least = min(least, fraction)
      call scene_destroy(s)
    end do
    CHECK(least > 0 .and. least <= whole * (1 + SHARPNESS))
    call scene_init(s)
    call scene_create(s)
    call apart_by(0.3d0)
    dx1 = dx1 * least
    CHECK(limit(0d0) == 1)
    call scene_destroy(s)
  end subroutine

  ! Asked in between, everything that follows has the same bits.
  subroutine check_nothing_changes()
    type(history) :: before, after
    real(c_double) :: expected(POSITIONS + SIZE1), r(POSITIONS + SIZE1), first
    call scene_init(s)
    call scene_create(s)
    call scene_commit(s)
    call scene_residual(s, expected)
    call history_take(s%contact, before)
    call move_by([0.1d0, 0.2d0, -3d0], [0d0, 0.1d0, 1d0])
    first = limit(0d0)
    call scene_residual(s, r)
    CHECK(all(r == expected))
    CHECK(limit(0d0) == first)
    call history_take(s%contact, after)
    CHECK(history_equal(before, after))
    call scene_slide(s, 0.01d0)
    call scene_residual(s, expected)
    call scene_destroy(s)
    ! A handle that was never asked.
    call scene_init(s)
    call scene_create(s)
    call scene_commit(s)
    call scene_slide(s, 0.01d0)
    call scene_residual(s, r)
    CHECK(all(r == expected))
    call scene_destroy(s)
  end subroutine

  subroutine check_refusals()
    real(c_double) :: fraction, wrong(4)
    integer(c_int32_t) :: status
    integer :: k
    call scene_init(s)
    call scene_create(s)
    call move_by([0d0, 0d0, -1d0], [0d0, 0d0, 0d0])
    fraction = UNWRITTEN
    status = stickslip_interface_step_limit(no_handle(), s%x1, s%x2, dx1, dx2, 0d0, fraction)
    CHECK_REFUSED(status, STICKSLIP_NULL_POINTER, 'interface')
    wrong = [-0.1d0, 1.1d0, ieee_value(0d0, ieee_quiet_nan), ieee_value(0d0, ieee_positive_inf)]
    do k = 1, size(wrong)
      status = stickslip_interface_step_limit(s%contact, s%x1, s%x2, dx1, dx2, wrong(k), fraction)
      CHECK_REFUSED(status, STICKSLIP_INVALID_VALUE, 'penetration')
    end do
    dx1(2, 2) = ieee_value(0d0, ieee_quiet_nan)
    status = stickslip_interface_step_limit(s%contact, s%x1, s%x2, dx1, dx2, 0d0, fraction)
    CHECK_REFUSED(status, STICKSLIP_NOT_FINITE, 'dx1')
    dx1(2, 2) = 0
    dx2(2, 3) = ieee_value(0d0, ieee_positive_inf)
    status = stickslip_interface_step_limit(s%contact, s%x1, s%x2, dx1, dx2, 0d0, fraction)
    CHECK_REFUSED(status, STICKSLIP_NOT_FINITE, 'dx2')
    dx2(2, 3) = 0
    s%x1 = 1d308
    dx1 = 1d308
    status = stickslip_interface_step_limit(s%contact, s%x1, s%x2, dx1, dx2, 0d0, fraction)
    CHECK_REFUSED(status, STICKSLIP_NOT_FINITE, 'x1 + dx1')
    CHECK(untouched(fraction))
    call scene_destroy(s)
  end subroutine
end program
