! Offsets of the nodes: a gap of as much on either side, gaps closed at the start, the shape of a faceted surface.
#include "check.inc"
program t93_offsets
  use, intrinsic :: iso_c_binding
  use check
  use scenes
  use stickslip
  implicit none

  real(c_double), parameter :: SAME_NUMBER = 1d-12
  type(scene), target, save :: s
  real(c_double), target :: one(NA), two(NC), x(3, NA), gaps(NA), offsets(NA)
  integer(c_int32_t), target :: moved(NA)
  integer(c_int32_t) :: status
  real(c_double) :: sums(STICKSLIP_SUMS_PER_NODE, NA), centre(3)

  call scene_init(s)
  call scene_create(s)
  one = 0.02d0
  two = -0.05d0
  CHECK_OK(stickslip_interface_set_offsets(s%contact, c_loc(one), c_loc(two)))
  CHECK_OK(stickslip_interface_sums(s%contact, s%reference1, s%reference2, sums))
  CHECK(all(abs(norm2(sums(2:4, :), 1) / sums(1, :) - 0.03d0) < SAME_NUMBER))
  CHECK_OK(stickslip_interface_set_offsets(s%contact, c_null_ptr, c_null_ptr))
  CHECK_OK(stickslip_interface_sums(s%contact, s%reference1, s%reference2, sums))
  CHECK(all(norm2(sums(2:4, :), 1) < SAME_NUMBER))

  CHECK_OK(stickslip_interface_adjust(s%contact, 0.05d0, c_loc(x), c_loc(gaps), c_loc(moved)))
  CHECK(all(moved == STICKSLIP_ADJUST_MOVED) .and. all(abs(gaps) < SAME_NUMBER))
  CHECK(all(abs(x - s%reference1) < SAME_NUMBER))
  CHECK_REFUSED(stickslip_interface_adjust(s%contact, -1d0, c_loc(x), c_loc(gaps), c_loc(moved)), STICKSLIP_INVALID_VALUE, 'toler')

  centre = [0d0, 0d0, 1d4]
  call scene_frame(centre)
  status = stickslip_interface_shape_offsets(s%contact, STICKSLIP_SIDE_NONMORTAR, STICKSLIP_SHAPE_SPHERE, 1d4, centre, &
      centre, offsets)
  CHECK_OK(status)
  CHECK(all(offsets > 0) .and. all(offsets < 1d-4))
  CHECK_OK(stickslip_interface_destroy(s%contact))
end program
