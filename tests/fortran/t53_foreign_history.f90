! A history whose numbers fit the surfaces but cannot be theirs: other facets on as many nodes, another mesh with the same
! facets, another law or slip measure. Taken in, it would give wrong forces.
#include "check.inc"
#define MISMATCH(word) CHECK_REFUSED(import(), STICKSLIP_HISTORY_MISMATCH, word)
program t53_foreign_history
  use, intrinsic :: iso_c_binding
  use calls
  use check
  use scenes
  use stickslip
  implicit none
  type(handle), target, save :: h
  type(history), save :: spoilt
  type(scene), target, save :: other
  integer :: side

  call handle_init(h)

  ! The same nodes, four facets that begin elsewhere.
  call scene_init(other)
  other%nodes2(:, 1:4) = cshift(other%nodes2(:, 1:4), 1, 1)
  call scene_create(other)
  call history_take(other%contact, spoilt)
  MISMATCH('facets')
  call scene_destroy(other)

  ! The same facets on another mesh: one coordinate in its last digit.
  do side = 1, 2
    call scene_init(other)
    if (side == 1) then
      other%reference1(2, 3) = nearest(other%reference1(2, 3), 1d0)
    else
      other%reference2(2, 3) = nearest(other%reference2(2, 3), 1d0)
    end if
    call scene_create(other)
    call history_take(other%contact, spoilt)
    MISMATCH('another mesh')
    call scene_destroy(other)
  end do

  ! What the numbers mean.
  call scene_init(other)
  other%method%slip = STICKSLIP_SLIP_INCREMENT
  call scene_create(other)
  call history_take(other%contact, spoilt)
  MISMATCH('slip increment')
  call scene_destroy(other)
  call scene_init(other)
  other%options%friction = STICKSLIP_FRICTION_ROUGH
  other%options%mu = 0
  call scene_create(other)
  call history_take(other%contact, spoilt)
  MISMATCH('rough')
  call scene_destroy(other)

  ! Others may go on with it: mu, augmentation, tolerances, the form.
  call scene_init(other)
  other%options%mu = 0.1d0
  other%method%augmentation = 70
  other%method%coverage_min = 1d-3
  other%method%form = STICKSLIP_FORM_AUGMENTED
  call scene_create(other)
  spoilt = h%before
  CHECK_OK(import_into(other%contact))
  call scene_destroy(other)
  call handle_untouched(h)
  call scene_destroy(h%s)

contains

  integer(c_int32_t) function import() result(status)
    status = import_into(h%s%contact)
  end function

  integer(c_int32_t) function import_into(contact) result(status)
    type(stickslip_interface), intent(in) :: contact
    status = stickslip_interface_history_import(contact, spoilt%n_integers, spoilt%integers, spoilt%n_reals, spoilt%reals)
  end function
end program
