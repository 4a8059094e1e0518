! Stage 4: the node's own row and block, scaled, in both layouts.
#include "check.inc"
program t21_node_block
  use, intrinsic :: iso_c_binding
  use, intrinsic :: ieee_arithmetic
  use check
  use stickslip
  implicit none
  integer(c_int32_t), parameter :: COLUMN_MAJOR = STICKSLIP_LAYOUT_COLUMN_MAJOR
  type(stickslip_node_response) :: r
  real(c_double), target :: row(3), block(3, 3)
  real(c_double) :: infinity
  integer :: i

  r%row = [1, 2, 3]
  r%drow_dlambda = reshape([(-i, i = 1, 9)], [3, 3])

  ! The response's matrices are row-major: (j, i). The block's own layout is a choice.
  CHECK_OK(stickslip_node_block(r, 2d0, COLUMN_MAJOR, c_loc(row), c_loc(block)))
  CHECK(all(row == [2, 4, 6]))
  CHECK(all(block == 2 * transpose(r%drow_dlambda)))
  CHECK_OK(stickslip_node_block(r, 2d0, STICKSLIP_LAYOUT_ROW_MAJOR, c_loc(row), c_loc(block)))
  CHECK(all(row == [2, 4, 6]))
  CHECK(all(block == 2 * r%drow_dlambda))

  ! Either output alone, or none.
  CHECK_OK(stickslip_node_block(r, 1d0, COLUMN_MAJOR, c_loc(row), c_null_ptr))
  CHECK_OK(stickslip_node_block(r, 1d0, COLUMN_MAJOR, c_null_ptr, c_loc(block)))
  CHECK_OK(stickslip_node_block(r, 1d0, COLUMN_MAJOR, c_null_ptr, c_null_ptr))
  CHECK(row(1) == 1 .and. block(1, 1) == -1)

  row = UNWRITTEN
  block = UNWRITTEN
  infinity = ieee_value(infinity, ieee_positive_inf)
  CHECK_REFUSED(stickslip_node_block(r, 1d0, 2, c_loc(row), c_loc(block)), STICKSLIP_INVALID_VALUE, 'layout')
  CHECK_REFUSED(stickslip_node_block(r, 1d0, -1, c_loc(row), c_loc(block)), STICKSLIP_INVALID_VALUE, 'layout')
  CHECK_REFUSED(stickslip_node_block(r, infinity, 1, c_loc(row), c_loc(block)), STICKSLIP_NOT_FINITE, 'scale')
  CHECK_UNTOUCHED(row)
  CHECK_UNTOUCHED(block)
end program
