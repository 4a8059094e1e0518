! The report of covered nodes: covers, fractions, layers, claims, penetration, sentences, and what it finds where
! nothing overlaps.
#include "check.inc"
program t71_report
  use, intrinsic :: iso_c_binding
  use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
  use check
  use scenes
  use stickslip
  implicit none
  ! The same quotient of the same numbers.
  real(c_double), parameter :: ROUNDING = 1d-15
  type(scene), target :: s
  integer(c_int32_t), target :: cover(NA), layers(NA)
  real(c_double), target :: fraction(NA)
  integer(c_int64_t), target :: facets(NA)
  character(1000), target :: text

  call check_covered(0d0)
  call check_covered(1.2d0)
  call check_findings()
  call check_mistakes()
  call check_refusals()

contains

  function report_of_all() result(r)
    type(stickslip_report) :: r
    r = stickslip_report(cover=c_loc(cover), fraction=c_loc(fraction), layers=c_loc(layers), facets=c_loc(facets), &
        text=c_loc(text), text_capacity=len(text))
  end function

  ! Where all is covered; slid until the surfaces meet in part and some nodes hang over.
  subroutine check_covered(slid)
    real(c_double), intent(in) :: slid
    type(stickslip_report) :: r, few
    type(stickslip_states) :: states
    type(history) :: before, after
    real(c_double), target :: area(NA), coverage(NA)
    character(8), target :: cut
    integer :: counts(0:3), k
    call scene_init(s)
    call scene_create(s)
    call scene_slide(s, slid)
    r = report_of_all()
    CHECK_OK(stickslip_interface_report(s%contact, s%x1, s%x2, r))
    states = stickslip_states(area=c_loc(area), coverage=c_loc(coverage))
    CHECK_OK(stickslip_interface_states(s%contact, s%x1, s%x2, s%lambda, c_null_ptr, states))
    CHECK_NEAR(fraction, coverage / area, ROUNDING)
    counts = [(size(pack(cover, cover == k)), k = 0, 3)]
    if (slid > 0) then
      CHECK(all(counts(:1) > 0))
    else
      CHECK(counts(2) == NA .and. r%penetration > 0)
    end if
    CHECK(all(counts == [r%nodes_none, r%nodes_part, r%nodes_full, r%nodes_several]))
    CHECK(all(cover /= STICKSLIP_COVER_FULL .or. fraction > 0.99d0))
    CHECK(all(layers == merge(0, 1, cover == STICKSLIP_COVER_NONE)) .and. all(facets >= layers))
    CHECK(r%finding == STICKSLIP_FINDING_NONE)
    CHECK(index(text, 'Of 9 non-mortar nodes ') == 1)
    ! Only what is wanted, and a text that is cut.
    cut = repeat('x', 8)
    few = stickslip_report(text=c_loc(cut), text_capacity=5)
    CHECK_OK(stickslip_interface_report(s%contact, s%x1, s%x2, few))
    CHECK(cut == 'Of 9' // c_null_char // 'xxx' .and. few%nodes_full == counts(2))
    CHECK(few%struct_size == stickslip_report_size)
    ! The handle's history is as before.
    call history_take(s%contact, before)
    CHECK_OK(stickslip_interface_report(s%contact, s%reference1, s%x2, r))
    call history_take(s%contact, after)
    CHECK(history_equal(before, after))
    call scene_destroy(s)
  end subroutine

  ! The sides' node orders, and how far the mortar side is moved away along the frame's normal.
  integer(c_int32_t) function finding_of(reverse1, reverse2, gap, aside)
    logical, intent(in) :: reverse1, reverse2
    real(c_double), intent(in) :: gap, aside
    type(stickslip_report) :: r
    real(c_double) :: away(3)
    call scene_init(s)
    if (reverse1) s%nodes1 = s%nodes1(4:1:-1, :)
    if (reverse2) s%nodes2 = s%nodes2(4:1:-1, :)
    away = [aside, 0d0, -gap]
    call scene_frame(away)
    s%reference2 = s%reference2 + spread(away, 2, NC)
    call scene_create(s)
    r = report_of_all()
    CHECK_OK(stickslip_interface_report(s%contact, s%reference1, s%reference2, r))
    CHECK(any(r%finding == [STICKSLIP_FINDING_NONE, STICKSLIP_FINDING_INSIDE_OUT]) .or. r%nodes_none == NA)
    call scene_destroy(s)
    finding_of = r%finding
  end function

  subroutine check_findings()
    real(c_double), parameter :: GAPS(3) = [0.01d0, 2d0, 40d0]
    integer :: k
    do k = 1, size(GAPS)
      CHECK(finding_of(.false., .false., GAPS(k), 0d0) == STICKSLIP_FINDING_NONE)
      CHECK(finding_of(.true., .false., GAPS(k), 0d0) == STICKSLIP_FINDING_SAME_WAY)
      CHECK(index(text, 'reversed') > 0)
      CHECK(finding_of(.false., .true., GAPS(k), 0d0) == STICKSLIP_FINDING_SAME_WAY)
      CHECK(finding_of(.false., .false., GAPS(k), 9d0) == STICKSLIP_FINDING_NO_OVERLAP)
      ! A shallow one is a pair: an open gap reads as a penetration.
      CHECK(finding_of(.true., .true., GAPS(k), 0d0) == merge(STICKSLIP_FINDING_NONE, STICKSLIP_FINDING_BEHIND, k == 1))
    end do
  end subroutine

  ! x1 and x2 swapped, of sides with as many nodes; open gaps of a tenth of a facet seen from inside.
  subroutine check_mistakes()
    type(stickslip_report) :: r
    real(c_double), target :: x2(3, NA)
    integer(c_int64_t), target :: nodes2(4, 4)
    CHECK(finding_of(.true., .true., 0.1d0, 0d0) == STICKSLIP_FINDING_INSIDE_OUT)
    CHECK(index(text, 'both sides are reversed') > 0)
    CHECK(finding_of(.false., .false., 0.1d0, 0d0) == STICKSLIP_FINDING_NONE)
    call scene_init(s)
    nodes2 = s%nodes1(4:1:-1, :)
    x2 = 1.3d0 * s%reference1
    s%mortar%n_nodes = NA
    s%mortar%n_facets = 4
    s%mortar%coordinates = c_loc(x2)
    s%mortar%facet_nodes = c_loc(nodes2)
    call scene_create(s)
    r = report_of_all()
    CHECK_OK(stickslip_interface_report(s%contact, x2, s%reference1, r))
    CHECK(r%finding == STICKSLIP_FINDING_SWAPPED .and. index(text, 'x1 and x2 are swapped') > 0)
    CHECK_OK(stickslip_interface_report(s%contact, s%reference1, x2, r))
    CHECK(r%finding == STICKSLIP_FINDING_NONE)
    call scene_destroy(s)
  end subroutine

  subroutine check_refusals()
    type(stickslip_report) :: r
    integer(c_int32_t) :: status
    call scene_init(s)
    call scene_create(s)
    r = report_of_all()
    cover = UNWRITTEN_STATE
    fraction = UNWRITTEN
    status = stickslip_interface_report(no_handle(), s%x1, s%x2, r)
    CHECK_REFUSED(status, STICKSLIP_NULL_POINTER, 'interface')
    r%text_capacity = 0
    status = stickslip_interface_report(s%contact, s%x1, s%x2, r)
    CHECK_REFUSED(status, STICKSLIP_INVALID_SIZE, 'text_capacity')
    r = report_of_all()
    r%struct_size = 103
    status = stickslip_interface_report(s%contact, s%x1, s%x2, r)
    CHECK_REFUSED(status, STICKSLIP_STRUCT_SIZE, 'stickslip_report')
    r = report_of_all()
    s%x1(2, 2) = ieee_value(0d0, ieee_quiet_nan)
    status = stickslip_interface_report(s%contact, s%x1, s%x2, r)
    CHECK_REFUSED(status, STICKSLIP_NOT_FINITE, 'x1')
    CHECK_UNTOUCHED(cover)
    CHECK_UNTOUCHED(fraction)
    call scene_destroy(s)
  end subroutine
end program
