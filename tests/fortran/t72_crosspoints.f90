! Nodes that three interfaces share.
#include "check.inc"
program t72_crosspoints
  use, intrinsic :: iso_c_binding
  use check
  use stickslip
  implicit none
  ! Node 5 twice in one list: a node on a crease is one node.
  integer(c_int64_t), parameter :: OFFSETS1(4) = [0, 5, 7, 10], NODES1(10) = [9, 5, 5, 1, 3, 9, 7, 30, 9, -4], &
      OFFSETS2(4) = [0, 3, 6, 9], NODES2(9) = [20, 21, 3, 1, 20, 21, 7, 9, 20]
  integer(c_int64_t), parameter :: THREE = 3
  integer(c_int64_t), target :: nodes(5), claims(5)
  integer(c_int32_t), target :: kinds(5)
  integer(c_int64_t) :: count

  call check_found()
  call check_refusals()

contains

  integer(c_int32_t) function find(n, offsets, capacity) result(status)
    integer(c_int64_t), intent(in) :: n, offsets(4), capacity
    status = stickslip_crosspoints_find(n, offsets, NODES1, OFFSETS2, NODES2, capacity, c_loc(nodes), c_loc(kinds), &
        c_loc(claims), count)
  end function

  subroutine check_found()
    integer(c_int64_t), parameter :: NOTHING(2) = [0, 0]
    integer(c_int32_t) :: status
    nodes = 0
    kinds = 0
    claims = 0
    status = stickslip_crosspoints_find(THREE, OFFSETS1, NODES1, OFFSETS2, NODES2, 0_c_int64_t, c_null_ptr, &
        c_null_ptr, c_null_ptr, count)
    CHECK_OK(status)
    CHECK(count == 4)
    CHECK_OK(find(THREE, OFFSETS1, 4_c_int64_t))
    CHECK(all(nodes == [1, 3, 7, 9, 0]) .and. all(claims == [1, 1, 1, 3, 0]))
    CHECK(all(kinds([1, 3]) == STICKSLIP_CROSSPOINT_CHAIN) .and. kinds(2) == STICKSLIP_CROSSPOINT_BOTH_SIDES)
    CHECK(kinds(4) == STICKSLIP_CROSSPOINT_CLAIMED + STICKSLIP_CROSSPOINT_CHAIN + STICKSLIP_CROSSPOINT_BOTH_SIDES)
    CHECK(kinds(5) == 0)
    ! One interface whose sides share nothing; its mortar side may be empty, as an analytic one is.
    status = stickslip_crosspoints_find(1_c_int64_t, OFFSETS1, NODES1, NOTHING, NODES2, 0_c_int64_t, c_null_ptr, &
        c_null_ptr, c_null_ptr, count)
    CHECK_OK(status)
    CHECK(count == 0)
  end subroutine

  subroutine check_refusals()
    integer(c_int64_t), parameter :: LATE(4) = [1, 5, 7, 10], FALLING(4) = [0, 5, 4, 10]
    integer(c_int32_t) :: status
    nodes = UNWRITTEN_INTEGER
    claims = UNWRITTEN_INTEGER
    kinds = UNWRITTEN_STATE
    count = UNWRITTEN_INTEGER
    CHECK_REFUSED(find(0_c_int64_t, OFFSETS1, 5_c_int64_t), STICKSLIP_INVALID_SIZE, 'n_interfaces')
    CHECK_REFUSED(find(THREE, OFFSETS1, 3_c_int64_t), STICKSLIP_BUFFER_TOO_SMALL, 'capacity')
    CHECK_REFUSED(find(THREE, LATE, 5_c_int64_t), STICKSLIP_INVALID_SIZE, 'nonmortar_offsets[0]')
    status = stickslip_crosspoints_find(THREE, OFFSETS1, NODES1, FALLING, NODES2, 5_c_int64_t, c_loc(nodes), &
        c_loc(kinds), c_loc(claims), count)
    CHECK_REFUSED(status, STICKSLIP_INVALID_SIZE, 'mortar_offsets[2]')
    status = stickslip_crosspoints_find(THREE, OFFSETS1, NODES1, OFFSETS2, NODES2, 5_c_int64_t, c_loc(nodes), &
        c_null_ptr, c_loc(claims), count)
    CHECK_REFUSED(status, STICKSLIP_NULL_POINTER, 'kinds')
    CHECK(count == UNWRITTEN_INTEGER)
    CHECK_UNTOUCHED(nodes)
    CHECK_UNTOUCHED(claims)
    CHECK_UNTOUCHED(kinds)
  end subroutine
end program
