! Stages 1 and 3 of a pair with a state in the caller's memory: what the separate calls give.
#include "check.inc"
program t15_pair_state
  use, intrinsic :: iso_c_binding
  use calls
  use check
  use pairs
  use stickslip
  implicit none
  type(element), target, save :: e
  type(weights), target :: w, with_state
  real(c_double), target :: gap(3, 4), same_gap(3, 4)
  real(c_double) :: force(3, 8), same_force(3, 8), k(36, 36), same_k(36, 36)
  integer(c_int64_t) :: needed
  integer(c_int32_t) :: layout, status
  integer :: far

  call element_init(e)
  needed = stickslip_pair_state_size()
  CHECK(needed > 0 .and. needed <= STATE_SIZE)
  do layout = 0, 1
    do far = 0, 1
      e%x2(1, :) = quad2(1, :) + 100 * far
      e%pair%layout = layout
      ! Exactly as much memory as is needed.
      CHECK_OK(stickslip_pair_begin(e%pair, needed, e%state, c_loc(with_state%ab), c_loc(with_state%ac), c_loc(same_gap)))
      call pair_weights(e%pair, w)
      CHECK(all(same(w%ab, with_state%ab)) .and. all(same(w%ac, with_state%ac)))
      CHECK_OK(stickslip_pair_gap(e%pair, w%ab, w%ac, gap))
      CHECK(all(same(gap, same_gap)))
      CHECK_OK(stickslip_pair_state_gap(e%state, c_null_ptr, c_null_ptr, same_gap))
      CHECK(all(same(gap, same_gap)))
      CHECK_OK(stickslip_pair_gap(e%pair, e%w%ab, e%w%ac, gap))
      CHECK_OK(stickslip_pair_state_gap(e%state, c_loc(e%w%ab), c_loc(e%w%ac), same_gap))
      CHECK(all(same(gap, same_gap)))
      CHECK_OK(stickslip_pair_residual(e%pair, w%ab, w%ac, e%traction, force))
      CHECK_OK(stickslip_pair_state_residual(e%state, e%traction, same_force))
      CHECK(all(same(force, same_force)))
      status = stickslip_pair_tangent(e%pair, c_loc(w%ab), c_loc(w%ac), c_loc(w%dab), c_loc(w%dac), c_loc(e%w%ab), &
          c_loc(e%w%ac), e%traction, e%responses, c_loc(e%row_scale), k, 36_c_int64_t)
      CHECK_OK(status)
      status = stickslip_pair_state_tangent(e%state, c_loc(e%w%ab), c_loc(e%w%ac), e%traction, e%responses, &
          c_loc(e%row_scale), same_k, 36_c_int64_t)
      CHECK_OK(status)
      CHECK_NEAR(same_k, k, 1d-15 * maxval(abs(k)))
    end do
  end do
end program
