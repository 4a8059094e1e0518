! A history that is corrupt or belongs to another interface is refused as a whole.
#include "check.inc"
#define MISMATCH(word) CHECK_REFUSED(import(), STICKSLIP_HISTORY_MISMATCH, word)
program t49_bad_input_history
  use, intrinsic :: iso_c_binding
  use calls
  use check
  use scenes
  use stickslip
  implicit none
  type(handle), target, save :: h
  type(history), save :: spoilt
  type(scene), target, save :: other

  call handle_init(h)
  call damage()
  call lengths()

  ! Of an interface with other surfaces.
  call scene_init(other)
  other%mortar%n_facets = 6
  other%mortar%n_nodes = 12
  call scene_create(other)
  call history_take(other%contact, spoilt)
  MISMATCH('nodes')
  call scene_destroy(other)
  call handle_untouched(h)

  call scene_destroy(h%s)

contains

  integer(c_int32_t) function import() result(status)
    status = stickslip_interface_history_import(h%s%contact, spoilt%n_integers, spoilt%integers, spoilt%n_reals, &
        spoilt%reals)
  end function

  ! Any integer that is another one, and any bit of any number. (What a checksum that fits would let through is tried in C.)
  subroutine damage()
    integer(c_int64_t) :: values(5)
    integer :: at, k, bit
    values = [INT64_MIN, -1_c_int64_t, 1_c_int64_t, 1000_c_int64_t, INT64_MAX]
    do at = 1, int(h%before%n_integers)
      do k = 1, 5
        if (values(k) == h%before%integers(at)) cycle
        spoilt = h%before
        spoilt%integers(at) = values(k)
        if (at == 1) then
          MISMATCH('')
        else
          MISMATCH('checksum')
        end if
      end do
    end do
    do at = 1, int(h%before%n_reals)
      do bit = mod(at, 7), 51, 7 ! of the mantissa, so that the number stays one
        spoilt = h%before
        spoilt%reals(at) = transfer(ieor(transfer(spoilt%reals(at), 0_c_int64_t), ishft(1_c_int64_t, bit)), 1d0)
        MISMATCH('checksum')
      end do
    end do
    spoilt = h%before
    spoilt%integers(1) = int(z'571C01', c_int64_t)
    MISMATCH('older library version')
  end subroutine

  subroutine lengths()
    integer(c_int64_t) :: n_integers(6), by
    integer :: k
    n_integers = [0_c_int64_t, 1_c_int64_t, 4_c_int64_t, 5_c_int64_t, h%before%n_integers - 1, h%before%n_integers + 1]
    do k = 1, 6
      spoilt = h%before
      spoilt%n_integers = n_integers(k)
      MISMATCH('integers')
    end do
    do by = -1, 1, 2
      spoilt = h%before
      spoilt%n_reals = h%before%n_reals + by
      MISMATCH('reals')
    end do
  end subroutine
end program
