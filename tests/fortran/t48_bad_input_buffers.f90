! Buffers that are too small, and a matrix that lacks an entry: nothing is written, nothing is added.
#include "check.inc"
program t48_bad_input_buffers
  use, intrinsic :: iso_c_binding
  use calls
  use check
  use scenes
  use stickslip
  implicit none
  type(handle), target, save :: h
  type(triplets), target, save :: t

  call handle_init(h)
  call triplets_buffers()
  call history_buffers()
  call missing_entries()
  call handle_untouched(h)
  call scene_destroy(h%s)

contains

  subroutine triplets_buffers()
    integer(c_int64_t) :: n, fewer(5)
    integer :: k
    call scene_tangent(h%s, t)
    fewer = [t%n - 1, 1_c_int64_t, 0_c_int64_t, -1_c_int64_t, INT64_MIN]
    do k = 1, 5
      CHECK_REFUSED(coo(fewer(k)), STICKSLIP_BUFFER_TOO_SMALL, 'capacity')
    end do
    CHECK_OK(count_pattern(n))
    fewer = [n - 1, 1_c_int64_t, 0_c_int64_t, -1_c_int64_t, INT64_MIN]
    do k = 1, 5
      CHECK_REFUSED(pattern(fewer(k)), STICKSLIP_BUFFER_TOO_SMALL, 'capacity')
    end do
  end subroutine

  subroutine history_buffers()
    integer(c_int64_t) :: i, r
    i = h%before%n_integers
    r = h%before%n_reals
    CHECK_REFUSED(export(i - 1, r), STICKSLIP_BUFFER_TOO_SMALL, 'n_integers')
    CHECK_REFUSED(export(i, r - 1), STICKSLIP_BUFFER_TOO_SMALL, 'n_reals')
    CHECK_REFUSED(export(-1_c_int64_t, -1_c_int64_t), STICKSLIP_BUFFER_TOO_SMALL, 'n_integers')
  end subroutine

  ! Each entry that the tangent needs, missing once; then too few rows; then an empty matrix.
  subroutine missing_entries()
    integer(c_int64_t) :: e, at
    do e = 1, t%n, 1 + t%n / 40
      at = (t%rows(e) - 1) * UNKNOWNS + t%columns(e)
      h%csr_columns(at) = 1 + mod(t%columns(e), int(UNKNOWNS, c_int64_t)) ! twice in its row: allowed, but one is gone
      CHECK_REFUSED(call_interface_csr(h), STICKSLIP_MISSING_ENTRY, 'pattern')
      h%csr_columns(at) = t%columns(e)
    end do
    CHECK_REFUSED(csr(UNKNOWNS - 1_c_int64_t), STICKSLIP_INDEX_OUT_OF_RANGE, 'rows')
    h%offsets = 1
    CHECK_REFUSED(call_interface_csr(h), STICKSLIP_MISSING_ENTRY, 'pattern')
  end subroutine

  integer(c_int32_t) function coo(capacity) result(status)
    integer(c_int64_t), intent(in) :: capacity
    status = stickslip_interface_tangent_coo(h%s%contact, h%s%x1, h%s%x2, h%s%lambda, c_null_ptr, capacity, &
        c_loc(h%row_numbers), c_loc(h%columns), c_loc(h%values), h%count)
  end function

  integer(c_int32_t) function count_pattern(n) result(status)
    integer(c_int64_t), intent(inout) :: n
    status = stickslip_interface_pattern_coo(h%s%contact, h%s%x1, h%s%x2, 0_c_int64_t, c_null_ptr, c_null_ptr, n)
  end function

  integer(c_int32_t) function pattern(capacity) result(status)
    integer(c_int64_t), intent(in) :: capacity
    status = stickslip_interface_pattern_coo(h%s%contact, h%s%x1, h%s%x2, capacity, c_loc(h%row_numbers), &
        c_loc(h%columns), h%count)
  end function

  integer(c_int32_t) function export(n_integers, n_reals) result(status)
    integer(c_int64_t), intent(in) :: n_integers, n_reals
    status = stickslip_interface_history_export(h%s%contact, n_integers, h%columns, n_reals, h%values)
  end function

  integer(c_int32_t) function csr(n_rows) result(status)
    integer(c_int64_t), intent(in) :: n_rows
    status = stickslip_interface_tangent_csr(h%s%contact, h%s%x1, h%s%x2, h%s%lambda, c_null_ptr, n_rows, h%offsets, &
        h%csr_columns, h%csr)
  end function
end program
