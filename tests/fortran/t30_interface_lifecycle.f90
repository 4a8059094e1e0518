! Creation and destruction; initial multipliers; states; counters. The twin leaves out destroying NULL, a reference that
! Fortran does not have; a handle that was never created is there.
#include "check.inc"
program t30_interface_lifecycle
  use, intrinsic :: iso_c_binding
  use check
  use scenes
  use stickslip
  implicit none
  ! Numbers of size 1; sums of a few; the slight compression, 1e-5; numbers of size 20.
  real(c_double), parameter :: ROUNDING = 1d-15, ROUNDING_SUM = 1d-14, ROUNDING_START = 1d-20, ROUNDING_15 = 1d-13, &
                               ROUNDING_20 = 1d-12
  type(scene), target, save :: s
  type(stickslip_options) :: by_modulus
  type(stickslip_method), target :: without
  type(stickslip_interface) :: other
  type(stickslip_counters) :: counters
  type(stickslip_states) :: out
  real(c_double) :: r(UNKNOWNS), again(UNKNOWNS), up(3)
  real(c_double), target :: lambda(3, NA), normal(3, NA), area(NA), gap(NA), coverage(NA), augmentation(NA), &
                            slip(3, NA), traction(3, NA), dissipation(NA)
  integer(c_int32_t), target :: state(NA)
  integer :: a

  call scene_init(s)

  ! A handle that was never created, and destroying once, are fine.
  CHECK_OK(stickslip_interface_destroy(s%contact))
  call scene_create(s)
  call scene_destroy(s)
  CHECK_OK(stickslip_interface_destroy(s%contact))

  ! Surfaces are copied: the host's arrays may go.
  call scene_create(s)
  call scene_residual(s, r)
  s%reference1 = 0
  s%nodes2 = 0
  s%multipliers = 0
  call scene_residual(s, again)
  CHECK(all(same(r, again)))
  call scene_destroy(s)

  ! The start: a slight compression on all covered closed nodes, -1e-6 rhat sqrt(M) nu.
  call scene_init(s)
  call scene_create(s)
  out = stickslip_states(state=c_loc(state), normal=c_loc(normal), traction=c_loc(traction), gap=c_loc(gap), &
      slip=c_loc(slip), coverage=c_loc(coverage), area=c_loc(area), dissipation=c_loc(dissipation), &
      augmentation=c_loc(augmentation))
  CHECK_OK(stickslip_interface_initial_multipliers(s%contact, lambda))
  CHECK_OK(stickslip_interface_states(s%contact, s%reference1, s%reference2, lambda, c_null_ptr, out))
  up = [0d0, 0d0, 1d0]
  call scene_frame(up)
  do a = 1, NA
    CHECK_NEAR(normal(:, a), up, ROUNDING)
    CHECK_NEAR(lambda(:, a), -1d-6 * 15 * sqrt(area(a)) * up, ROUNDING_START)
  end do
  CHECK(all(state == STICKSLIP_STATE_STICK))
  CHECK_NEAR(gap, 0d0, ROUNDING)
  CHECK_NEAR(coverage, area, ROUNDING)
  CHECK_NEAR(augmentation * area, 15d0, ROUNDING_15)
  CHECK_NEAR(sum(area), 1d0, ROUNDING_SUM)
  CHECK_NEAR(slip, 0d0, ROUNDING)

  ! A modulus gives rhat = 0.1 E / sqrt(M).
  by_modulus = s%options
  without = s%method
  without%augmentation = 0
  by_modulus%method = c_loc(without)
  by_modulus%modulus = 200
  CHECK_OK(stickslip_interface_create(s%nonmortar, s%mortar, by_modulus, other))
  out = stickslip_states(augmentation=c_loc(augmentation))
  CHECK_OK(stickslip_interface_states(other, s%reference1, s%reference2, lambda, c_null_ptr, out))
  CHECK_NEAR(augmentation * area**1.5d0, 20d0, ROUNDING_20)
  CHECK_OK(stickslip_interface_destroy(other))

  ! All three states occur once the scene has moved.
  out%state = c_loc(state)
  CHECK_OK(stickslip_interface_states(s%contact, s%x1, s%x2, s%lambda, c_null_ptr, out))
  CHECK(all(0 <= state .and. state <= 2))
  CHECK(any(state == STICKSLIP_STATE_GAP))
  CHECK(any(state == STICKSLIP_STATE_STICK))
  CHECK(any(state == STICKSLIP_STATE_SLIP))

  CHECK_OK(stickslip_interface_counters(s%contact, counters))
  CHECK(counters%struct_size == stickslip_counters_size)
  CHECK(counters%pairs_active > 4 .and. counters%pairs_clipped <= counters%pairs_tested)
  CHECK(counters%searches >= 1 .and. counters%bytes > 0 .and. counters%seconds_search >= 0)

  ! Initial multipliers belong before the first step.
  call scene_commit(s)
  lambda = UNWRITTEN
  CHECK_REFUSED(stickslip_interface_initial_multipliers(s%contact, lambda), STICKSLIP_INVALID_VALUE, 'first step')
  CHECK_UNTOUCHED(lambda)
  call scene_destroy(s)
end program
