! STICKSLIP_FRICTION_TIED: neither opens nor slips; closed surfaces are linear. STICKSLIP_FRICTION_ROUGH: Coulomb's law
! with a coefficient that nothing exceeds.
#include "check.inc"
program t61_tied_rough
  use, intrinsic :: iso_c_binding
  use check
  use scenes
  use stickslip
  implicit none
  ! Rounding of the sum of a row's products.
  real(c_double), parameter :: ROUNDING = 1d-13
  real(c_double), parameter :: BEYOND_ALL = 1d30
  type(scene), target, save :: s, other
  type(triplets), target, save :: t, u
  real(c_double) :: r(UNKNOWNS), q(UNKNOWNS)

  call check_tied()
  call check_linear()
  call check_rough()
  ! A coefficient belongs to Coulomb's law alone.
  call refused(STICKSLIP_FRICTION_TIED)
  call refused(STICKSLIP_FRICTION_ROUGH)

contains

  subroutine create(s, friction, mu)
    type(scene), target, intent(inout) :: s
    integer(c_int32_t), intent(in) :: friction
    real(c_double), intent(in) :: mu
    call scene_init(s)
    s%options%friction = friction
    s%options%mu = mu
    call scene_create(s)
  end subroutine

  ! How many nodes are in the state.
  integer function count_states(s, wanted)
    type(scene), intent(inout) :: s
    integer(c_int32_t), intent(in) :: wanted
    integer(c_int32_t), target :: state(NA)
    type(stickslip_states) :: out
    integer(c_int32_t) :: status
    out = stickslip_states(state=c_loc(state))
    status = stickslip_interface_states(s%contact, s%x1, s%x2, s%lambda, c_null_ptr, out)
    CHECK_OK(status)
    count_states = count(state == wanted)
  end function

  ! Pulled and far apart it holds, and a commit anywhere changes no bit.
  subroutine check_tied()
    real(c_double) :: up(3), saved(3, NA)
    call create(s, STICKSLIP_FRICTION_TIED, 0d0)
    up = [0d0, 0d0, 9d0]
    call scene_frame(up)
    s%lambda = s%lambda + spread(up, 2, NA)
    saved = s%x1
    CHECK(count_states(s, STICKSLIP_STATE_STICK) == NA)
    call scene_residual(s, r)
    call scene_tangent(s, t)
    call scene_slide(s, 0.8d0)
    CHECK(count_states(s, STICKSLIP_STATE_STICK) == NA)
    call scene_commit(s)
    call scene_slide(s, 50d0)
    CHECK(count_states(s, STICKSLIP_STATE_STICK) == NA)
    call scene_commit(s)
    s%x1 = saved
    call scene_residual(s, q)
    call scene_tangent(s, u)
    CHECK(all(same(r, q)))
    CHECK(triplets_equal(t, u))
  end subroutine

  ! residual(z + d) - residual(z) is the tangent times d, however large d is.
  subroutine check_linear()
    type(stickslip_counters) :: counters
    real(c_double) :: d(UNKNOWNS), expected(UNKNOWNS)
    integer(c_int64_t) :: seed, e
    integer :: i
    seed = 3
    do i = 1, UNKNOWNS
      d(i) = 3 * draw(seed)
    end do
    expected = 0
    do e = 1, t%n
      expected(t%rows(e)) = expected(t%rows(e)) + t%values(e) * d(t%columns(e))
    end do
    s%x1 = s%x1 + reshape(d(:SIZE1), [3, NA])
    s%x2 = s%x2 + reshape(d(SIZE1 + 1:POSITIONS), [3, NC])
    s%lambda = s%lambda + reshape(d(POSITIONS + 1:), [3, NA])
    call scene_residual(s, q)
    CHECK_NEAR(q - r, expected, ROUNDING)
    CHECK_OK(stickslip_interface_counters(s%contact, counters))
    CHECK(counters%searches == 1 .and. counters%nodes_slipping == 0 .and. counters%pairs_linearised == 0)
    CHECK(counters%pairs_reused > 0)
    call scene_destroy(s)
  end subroutine

  ! Sticks where it is closed, opens, and equals Coulomb's law without limit over steps.
  subroutine check_rough()
    integer :: step, open, sticking
    call create(s, STICKSLIP_FRICTION_ROUGH, 0d0)
    call create(other, STICKSLIP_FRICTION_COULOMB, BEYOND_ALL)
    do step = 1, 3
      open = count_states(s, STICKSLIP_STATE_GAP)
      sticking = count_states(s, STICKSLIP_STATE_STICK)
      CHECK(0 < open .and. open < NA .and. sticking == NA - open)
      call scene_residual(s, r)
      call scene_residual(other, q)
      CHECK(all(same(r, q)))
      call scene_tangent(s, t)
      call scene_tangent(other, u)
      CHECK(triplets_equal(t, u))
      call scene_commit(s)
      call scene_commit(other)
      call scene_slide(s, 0.05d0)
      call scene_slide(other, 0.05d0)
    end do
    call scene_destroy(s)
    call scene_destroy(other)
  end subroutine

  subroutine refused(friction)
    integer(c_int32_t), intent(in) :: friction
    real(c_double), parameter :: mu(NA) = 0
    integer(c_int32_t) :: status
    call scene_init(s)
    s%options%friction = friction
    status = stickslip_interface_create(s%nonmortar, s%mortar, s%options, s%contact)
    CHECK_REFUSED(status, STICKSLIP_INVALID_VALUE, 'options.mu')
    s%options%mu = 0
    call scene_create(s)
    CHECK_REFUSED(stickslip_interface_set_friction(s%contact, mu), STICKSLIP_INVALID_VALUE, 'mu')
    call scene_destroy(s)
  end subroutine
end program
