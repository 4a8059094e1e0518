! The pattern holds every entry that a tangent writes while nothing moves out of the search's skin.
#include "check.inc"
program t36_pattern
  use, intrinsic :: iso_c_binding
  use check
  use scenes
  use stickslip
  implicit none
  ! Slides within the skin, a quarter of a facet: 0.125 here.
  real(c_double), parameter :: SLIDES(4) = [0d0, 0.05d0, 0.05d0, -0.18d0]
  logical, save :: entry(UNKNOWNS, UNKNOWNS)
  type(scene), target, save :: s
  type(triplets), target, save :: t
  integer(c_int32_t) :: form, kind_of_weights
  integer(c_int64_t) :: e
  integer :: k

  do form = 0, 1
    do kind_of_weights = STICKSLIP_WEIGHTS_CURRENT, STICKSLIP_WEIGHTS_REFERENCE
      call scene_init(s)
      s%method%form = form
      s%method%weights = kind_of_weights
      call scene_create(s)
      call scene_commit(s)

      call pattern()
      entry = .false.
      do e = 1, t%n
        entry(t%rows(e), t%columns(e)) = .true.
      end do

      do k = 1, 4
        call scene_slide(s, SLIDES(k))
        call scene_tangent(s, t)
        do e = 1, t%n
          CHECK(entry(t%rows(e), t%columns(e)))
        end do
      end do
      call scene_destroy(s)
    end do
  end do

contains

  ! Asks for the number of entries, then for the entries.
  subroutine pattern()
    integer(c_int32_t) :: status
    integer(c_int64_t) :: written
    status = stickslip_interface_pattern_coo(s%contact, s%x1, s%x2, 0_c_int64_t, c_null_ptr, c_null_ptr, t%n)
    CHECK_OK(status)
    CHECK(0 < t%n .and. t%n <= 100000)
    call triplets_allocate(t, t%n)
    status = stickslip_interface_pattern_coo(s%contact, s%x1, s%x2, t%n, c_loc(t%rows), c_loc(t%columns), written)
    CHECK_OK(status)
    CHECK(written == t%n)
    CHECK(all(1 <= t%rows .and. t%rows <= UNKNOWNS .and. 1 <= t%columns .and. t%columns <= UNKNOWNS))
  end subroutine
end program
