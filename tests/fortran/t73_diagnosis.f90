! The diagnosis: worst pairs, states and their changes, suspects with their causes, sentences; refusals.
#include "check.inc"
program t73_diagnosis
  use, intrinsic :: iso_c_binding
  use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
  use check
  use scenes
  use stickslip
  implicit none
  integer, parameter :: ROOM = 40
  ! Of an angle from two cross products.
  real(c_double), parameter :: ROUNDING = 1d-14
  type(scene), target :: s
  integer(c_int32_t), target :: state(NA), causes(ROOM)
  integer(c_int64_t), target :: nodes(ROOM)
  real(c_double), target :: directions(3, ROOM), ratios(ROOM)
  character(1000), target :: text

  call check_sound()
  call check_prescribed()
  call check_refusals()

contains

  function diagnosis_of_all() result(d)
    type(stickslip_diagnosis) :: d
    d = stickslip_diagnosis(state=c_loc(state), suspect_nodes=c_loc(nodes), suspect_directions=c_loc(directions), &
        suspect_ratios=c_loc(ratios), suspect_causes=c_loc(causes), suspect_capacity=ROOM, text=c_loc(text), &
        text_capacity=len(text))
  end function

  integer(c_int32_t) function diagnose(d)
    type(stickslip_diagnosis), intent(inout) :: d
    diagnose = stickslip_interface_diagnose(s%contact, s%x1, s%x2, s%lambda, c_null_ptr, d)
  end function

  ! A scene with all states and nothing amiss.
  subroutine check_sound()
    type(stickslip_diagnosis) :: d, few
    type(stickslip_states) :: states
    integer(c_int32_t), target :: expected(NA)
    call scene_init(s)
    call scene_create(s)
    state = -1
    d = diagnosis_of_all()
    CHECK_OK(diagnose(d))
    CHECK(d%state_changes == NA .and. d%suspects == 0 .and. d%nodes_gap + d%nodes_stick + d%nodes_slip == NA)
    states = stickslip_states(state=c_loc(expected))
    CHECK_OK(stickslip_interface_states(s%contact, s%x1, s%x2, s%lambda, c_null_ptr, states))
    CHECK(all(state == expected))
    CHECK(d%covered_node >= 1 .and. d%covered_node <= NA .and. d%covered_fraction > 0.1d0)
    CHECK(d%overlap > 0 .and. d%overlap <= 1 .and. d%error >= 0 .and. d%error < 1d-12)
    CHECK(all(d%overlap_facets >= 1) .and. all(d%overlap_facets <= [4, 9]))
    CHECK(abs(d%angle - 0.03d0) < ROUNDING .and. d%warp < ROUNDING)
    CHECK(index(text, 'in gap') > 0 .and. index(text, 'singular') == 0)
    ! Once more: nothing has changed since. Then one node has.
    CHECK_OK(diagnose(d))
    CHECK(d%state_changes == 0)
    state(4) = merge(STICKSLIP_STATE_SLIP, STICKSLIP_STATE_GAP, state(4) == STICKSLIP_STATE_GAP)
    CHECK_OK(diagnose(d))
    CHECK(d%state_changes == 1 .and. state(4) == expected(4))
    ! Nothing but numbers.
    few = stickslip_diagnosis()
    CHECK_OK(diagnose(few))
    CHECK(few%state_changes == 0 .and. few%overlap == d%overlap .and. few%nodes_stick == d%nodes_stick)
    call scene_destroy(s)
  end subroutine

  ! Both sides held along x, the multipliers there left in: closed nodes cannot stick. (Frozen weights: those of now turn
  ! with the facets, whose normals have a part along x.)
  subroutine check_prescribed()
    type(stickslip_diagnosis) :: d
    integer :: n
    call scene_init(s)
    s%equations1(1, :) = -1
    s%equations2(1, :) = -1
    s%options%mu = 1d6
    s%method%weights = STICKSLIP_WEIGHTS_REFERENCE
    call scene_create(s)
    state = -1
    d = diagnosis_of_all()
    CHECK_OK(diagnose(d))
    n = int(d%suspects)
    CHECK(n > 0 .and. n == d%nodes_stick)
    CHECK(all(state(nodes(:n)) == STICKSLIP_STATE_STICK) .and. all(causes(:n) == STICKSLIP_CAUSE_PRESCRIBED))
    CHECK(all(ratios(:n) < 1d-7) .and. all(abs(directions(1, :n) - 1) < 1d-12))
    CHECK(index(text, 'no displacement there has an equation') > 0)
    ! Less room than suspects.
    nodes = -7
    d%suspect_capacity = 1
    CHECK_OK(diagnose(d))
    CHECK(d%suspects == n .and. nodes(1) >= 1 .and. all(nodes(2:) == -7))
    call scene_destroy(s)
  end subroutine

  subroutine check_refusals()
    type(stickslip_diagnosis) :: d
    call scene_init(s)
    call scene_create(s)
    state = -1
    ratios = UNWRITTEN
    d = diagnosis_of_all()
    d%text_capacity = 0
    CHECK_REFUSED(diagnose(d), STICKSLIP_INVALID_SIZE, 'text_capacity')
    d = diagnosis_of_all()
    d%suspect_capacity = -1
    CHECK_REFUSED(diagnose(d), STICKSLIP_INVALID_SIZE, 'suspect_capacity')
    d = diagnosis_of_all()
    d%struct_size = stickslip_diagnosis_size - 8
    CHECK_REFUSED(diagnose(d), STICKSLIP_STRUCT_SIZE, 'stickslip_diagnosis')
    d = diagnosis_of_all()
    state(3) = 3
    CHECK_REFUSED(diagnose(d), STICKSLIP_INVALID_VALUE, 'state[2]')
    state(3) = -1
    s%lambda(2, 2) = ieee_value(0d0, ieee_quiet_nan)
    CHECK_REFUSED(diagnose(d), STICKSLIP_NOT_FINITE, 'lambda')
    CHECK_UNTOUCHED(ratios)
    call scene_destroy(s)
  end subroutine
end program
