! A history whose numbers fit the surfaces but cannot be theirs: other facets on as many nodes, normals that are not
! unit, positions at which a facet has no area. Taken in, it would give wrong forces or refuse every evaluation.
#include "check.inc"
#define MISMATCH(word) CHECK_REFUSED(import(), STICKSLIP_HISTORY_MISMATCH, word)
program t53_foreign_history
  use, intrinsic :: iso_c_binding
  use calls
  use check
  use scenes
  use stickslip
  implicit none
  ! The reals are x1, x2, normals, ...
  integer, parameter :: NORMALS = SIZE1 + SIZE2
  type(handle), target, save :: h
  type(history), save :: spoilt
  type(scene), target, save :: other
  integer :: a

  call handle_init(h)

  ! The same nodes, four facets that begin elsewhere.
  call scene_init(other)
  other%nodes2(:, 1:4) = cshift(other%nodes2(:, 1:4), 1, 1)
  call scene_create(other)
  call history_take(other%contact, spoilt)
  MISMATCH('facets')
  call scene_destroy(other)

  do a = 1, NA
    spoilt = h%before
    spoilt%reals(NORMALS + 3 * a - 2:NORMALS + 3 * a) = 2 * h%before%reals(NORMALS + 3 * a - 2:NORMALS + 3 * a)
    MISMATCH('normal')
  end do
  spoilt = h%before
  spoilt%reals(:SIZE1) = 1
  MISMATCH('facet')
  call handle_untouched(h)
  call scene_destroy(h%s)

contains

  integer(c_int32_t) function import() result(status)
    status = stickslip_interface_history_import(h%s%contact, spoilt%n_integers, spoilt%integers, spoilt%n_reals, &
        spoilt%reals)
  end function
end program
