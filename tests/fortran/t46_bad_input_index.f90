! Indices out of range, in either base: nodes of facets, equations, nodes of constraints. The messages count a member's
! entries from 0.
#include "check.inc"
program t46_bad_input_index
  use, intrinsic :: iso_c_binding
  use calls
  use check
  use scenes
  use stickslip
  implicit none
  type(scene), target, save :: s
  type(handle), target, save :: h
  integer(c_int64_t) :: extreme(6), nodes(5)
  integer(c_int32_t) :: status
  integer :: base, k

  do base = 0, 1
    extreme = [INT64_MIN, INT64_MIN + 1, -2_c_int64_t, base - 1_c_int64_t, INT64_MAX, INT64_MAX - 1]
    do k = 1, size(extreme)
      call scene_init(s, base)
      s%nodes1(2, 2) = extreme(k)
      CHECK_REFUSED(call_create(s), STICKSLIP_INDEX_OUT_OF_RANGE, 'nonmortar')
      call scene_init(s, base)
      s%nodes2(4, 9) = extreme(k)
      CHECK_REFUSED(call_create(s), STICKSLIP_INDEX_OUT_OF_RANGE, 'mortar')

      ! Equations may be as large as the host likes; -1 means none. 0 is below base 1.
      if (extreme(k) > 0 .or. extreme(k) == -1) cycle
      call scene_init(s, base)
      s%equations1(2, 3) = extreme(k)
      CHECK_REFUSED(call_create(s), STICKSLIP_INDEX_OUT_OF_RANGE, 'nonmortar.equations[7]')
      call scene_init(s, base)
      s%equations2(1, 1) = extreme(k)
      CHECK_REFUSED(call_create(s), STICKSLIP_INDEX_OUT_OF_RANGE, 'mortar.equations[0]')
      call scene_init(s, base)
      s%multipliers(3, 9) = extreme(k)
      CHECK_REFUSED(call_create(s), STICKSLIP_INDEX_OUT_OF_RANGE, 'nonmortar.multiplier_equations[26]')
    end do
    ! A multiplier's equation is nobody else's: of a displacement of either side, or of another multiplier.
    call scene_init(s, base)
    s%multipliers(3, 9) = s%equations1(2, 2)
    CHECK_REFUSED(call_create(s), STICKSLIP_INVALID_VALUE, 'multiplier_equations[26] and nonmortar.equations[4]')
    call scene_init(s, base)
    s%multipliers(3, 1) = s%equations2(3, 16)
    CHECK_REFUSED(call_create(s), STICKSLIP_INVALID_VALUE, 'multiplier_equations[2] and mortar.equations[47]')
    call scene_init(s, base)
    s%multipliers(3, 3) = s%multipliers(1, 2)
    CHECK_REFUSED(call_create(s), STICKSLIP_INVALID_VALUE, 'multiplier_equations[8] are the same equation')
    ! Displacements may share theirs, and several components may have none.
    call scene_init(s, base)
    s%equations1(2, 3) = s%equations1(2, 2)
    s%equations2(1, 2) = s%equations1(2, 2)
    s%multipliers(2:3, 2) = -1
    call scene_create(s)
    call scene_destroy(s)

    ! One beyond the last.
    call scene_init(s, base)
    s%nodes1(1, 1) = base + NA
    CHECK_REFUSED(call_create(s), STICKSLIP_INDEX_OUT_OF_RANGE, 'nonmortar')

    call scene_init(s, base)
    call scene_create(s)
    nodes = [INT64_MIN, -1_c_int64_t, base - 1_c_int64_t, base + int(NA, c_int64_t), INT64_MAX]
    do k = 1, size(nodes)
      CHECK_REFUSED(set_constraint(nodes(k)), STICKSLIP_INDEX_OUT_OF_RANGE, 'nodes[0]')
    end do
    call scene_destroy(s)
  end do

  ! Equations near the end of the integers come back as they are; a matrix without their rows is refused.
  call handle_init(h)
  call scene_destroy(h%s)
  h%s%equations1(2, 2) = INT64_MAX
  call scene_create(h%s)
  call scene_commit(h%s)
  call history_take(h%s%contact, h%before)
  status = call_interface_csr(h)
  CHECK(status == STICKSLIP_INDEX_OUT_OF_RANGE .or. status == STICKSLIP_MISSING_ENTRY)
  CHECK(index(last_message(), '9223372036854775807') > 0)
  call handle_untouched(h)
  CHECK_OK(call_interface_coo(h))
  CHECK(any(h%row_numbers(:h%count) == INT64_MAX))
  call scene_destroy(h%s)

contains

  integer(c_int32_t) function set_constraint(node) result(status)
    integer(c_int64_t), intent(in) :: node
    status = stickslip_interface_set_constraints(s%contact, 1_c_int64_t, [node], [0d0, 1d0, 0d0])
  end function
end program
