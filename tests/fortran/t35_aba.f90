! Residual and tangent are functions of their inputs and the committed history: evaluating at A, B, A gives equal bits,
! whatever was evaluated in between, together or apart.
#include "check.inc"
program t35_aba
  use, intrinsic :: iso_c_binding
  use check
  use scenes
  use stickslip
  implicit none
  ! Within the search's skin, out of it, and out of contact.
  real(c_double), parameter :: SLIDES(3) = [0.05d0, 0.9d0, 50d0]
  type(scene), target, save :: s
  type(triplets), target, save :: t, u
  real(c_double) :: r(UNKNOWNS), q(UNKNOWNS), saved(3, NA)
  integer(c_int32_t) :: form, kind_of_weights, status
  integer(c_int64_t) :: count
  integer :: k

  do form = 0, 1
    do kind_of_weights = STICKSLIP_WEIGHTS_CURRENT, STICKSLIP_WEIGHTS_REFERENCE
      call scene_init(s)
      s%method%form = form
      s%method%weights = kind_of_weights
      call scene_create(s)
      call scene_residual(s, r)
      call scene_tangent(s, t)
      saved = s%x1
      do k = 1, 3
        call scene_slide(s, SLIDES(k))
        call scene_residual(s, q)
        status = stickslip_interface_pattern_coo(s%contact, s%x1, s%x2, 0_c_int64_t, c_null_ptr, c_null_ptr, count)
        CHECK_OK(status)
        s%x1 = saved
        ! Tangent before residual this time.
        call scene_tangent(s, u)
        call scene_residual(s, q)
        CHECK(all(same(r, q)))
        CHECK(triplets_equal(t, u))
      end do
      call scene_destroy(s)
    end do
  end do
end program
