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
  call integers()
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

  call areas()
  call handle_untouched(h)

  ! The largest number of commits can be continued from.
  spoilt = h%before
  spoilt%integers(2) = INT64_MAX
  CHECK_OK(import())
  CHECK_OK(call_interface_commit(h))
  call scene_destroy(h%s)

contains

  integer(c_int32_t) function import() result(status)
    status = stickslip_interface_history_import(h%s%contact, spoilt%n_integers, spoilt%integers, spoilt%n_reals, &
        spoilt%reals)
  end function

  ! Layout, commits, nodes of both sides, pairs; then the pairs' facets. They are counted from 0 in either base.
  subroutine integers()
    integer(c_int64_t) :: values(5)
    integer :: at, k
    values = [INT64_MIN, -1_c_int64_t, 1_c_int64_t, 1000_c_int64_t, INT64_MAX]
    do at = 1, 5
      do k = 1, 5
        if (at == 2 .and. values(k) >= 0) cycle ! any number of steps may have been committed
        spoilt = h%before
        spoilt%integers(at) = values(k)
        MISMATCH('')
      end do
    end do
    do at = 6, int(h%before%n_integers)
      do k = 1, 5
        if (values(k) == 1) cycle ! a facet that exists
        spoilt = h%before
        spoilt%integers(at) = values(k)
        MISMATCH('facets')
      end do
    end do
    spoilt = h%before ! unsorted
    spoilt%integers(7:8) = h%before%integers(9:10)
    spoilt%integers(9:10) = h%before%integers(7:8)
    MISMATCH('sorted')
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

  ! Numbers that cannot be: areas that are not positive. The reals are x1, x2, normals, gaps, slip (3 each), areas,
  ! coverage, weights; SIZE1 each where a non-mortar node has three.
  subroutine areas()
    integer, parameter :: AREAS_BEFORE = SIZE1 + SIZE2 + 3 * SIZE1
    integer :: a
    do a = 1, NA
      spoilt = h%before
      spoilt%reals(AREAS_BEFORE + a) = merge(0, -1, mod(a, 2) == 0)
      MISMATCH('area')
    end do
  end subroutine
end program
