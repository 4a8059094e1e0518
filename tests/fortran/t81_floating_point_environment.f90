! The caller's floating-point environment: which exceptions halt, rounding, treatment of subnormal numbers and raised flags
! are the same before and after each call, also where it is refused; and results do not depend on any of them.
#include "check.inc"
program t81_floating_point_environment
  use, intrinsic :: iso_c_binding
  use, intrinsic :: ieee_arithmetic
  use calls
  use check
  use scenes
  use stickslip
  implicit none

  ! An environment to be called in.
  type environment
    type(ieee_round_type) :: rounding
    logical :: raised, halting, gradual
  end type

  ! Everything that is computed.
  type work
    type(element) :: e
    type(scene) :: s
    type(triplets) :: t
    real(c_double) :: r(UNKNOWNS)
  end type
  type(work), target, save :: expected, found
  type(ieee_round_type) :: roundings(4)
  integer :: turn, bits

  roundings = [ieee_nearest, ieee_up, ieee_down, ieee_to_zero]
  call compute(environment(ieee_nearest, .false., .false., .true.), expected)
  do turn = 1, 4
    do bits = 0, 7
      call compute(environment(roundings(turn), btest(bits, 0), btest(bits, 1), btest(bits, 2)), found)
      call compare()
    end do
  end do

contains

  subroutine compute(env, w)
    type(environment), intent(in) :: env
    type(work), target, intent(inout) :: w
    type(ieee_status_type) :: own
    type(stickslip_interface) :: none
    integer :: k
    integer(c_int32_t) :: status
    real(c_double) :: normal(3)
    call element_init(w%e)
    call scene_init(w%s)
    call scene_create(w%s)
    if (.not. allocated(w%t%rows)) call scene_tangent(w%s, w%t)
    none = no_handle()
    do k = 1, 12
      call ieee_get_status(own)
      call enter(env)
      select case (k)
      case (1)
        status = call_weights(w%e)
      case (2)
        status = call_gap(w%e)
      case (3)
        status = call_residual(w%e)
      case (4)
        status = call_tangent(w%e)
      case (5)
        status = stickslip_node_respond(w%e%node, w%e%responses(4))
      case (6)
        status = call_block(w%e)
      case (7)
        status = call_facet(w%e)
      case (8)
        status = call_normal(w%e)
      case (9)
        status = stickslip_interface_residual(w%s%contact, w%s%x1, w%s%x2, w%s%lambda, c_null_ptr, w%r, &
            w%r(SIZE1 + 1:), w%r(POSITIONS + 1:))
      case (10)
        status = stickslip_interface_tangent_coo(w%s%contact, w%s%x1, w%s%x2, w%s%lambda, c_null_ptr, &
            size(w%t%rows, kind=c_int64_t), c_loc(w%t%rows), c_loc(w%t%columns), c_loc(w%t%values), w%t%n)
      case (11)
        status = stickslip_interface_commit(w%s%contact, w%s%x1, w%s%x2, w%s%lambda, c_null_ptr)
      case (12)
        status = stickslip_interface_rollback(none)
      end select
      call leave(env, own, k)
      CHECK(status == merge(STICKSLIP_NULL_POINTER, STICKSLIP_OK, k == 12))
    end do
    CHECK_REFUSED(stickslip_node_normal([0d0, 0d0, 0d0], normal), STICKSLIP_UNDEFINED_NORMAL, 'normal')
    call scene_destroy(w%s)
  end subroutine

  subroutine enter(env)
    type(environment), intent(in) :: env
    ! Flags first: raising one where it halts would be the end.
    call ieee_set_halting_mode(ieee_usual, .false.)
    call ieee_set_flag(ieee_all, env%raised)
    if (ieee_support_underflow_control(1d0)) call ieee_set_underflow_mode(env%gradual)
    call ieee_set_rounding_mode(env%rounding)
    ! gfortran reads a raised flag with its trap on as an exception that is still to come.
    if (.not. env%raised) call ieee_set_halting_mode(ieee_usual, env%halting)
  end subroutine

  ! The environment is the one that was entered; back to the test's own.
  subroutine leave(env, own, k)
    type(environment), intent(in) :: env
    type(ieee_status_type), intent(in) :: own
    integer, intent(in) :: k
    logical :: raised(5), halting(3), gradual
    type(ieee_round_type) :: rounding
    call ieee_get_flag(ieee_all, raised)
    call ieee_get_halting_mode(ieee_usual, halting)
    call ieee_get_rounding_mode(rounding)
    gradual = env%gradual
    if (ieee_support_underflow_control(1d0)) call ieee_get_underflow_mode(gradual)
    call ieee_set_status(own)
    CHECK(k > 0 .and. all(raised .eqv. env%raised))
    CHECK(all(halting .eqv. (env%halting .and. .not. env%raised)))
    CHECK(rounding == env%rounding)
    CHECK(gradual .eqv. env%gradual)
  end subroutine

  subroutine compare()
    CHECK(all(same(found%e%w_out%ab, expected%e%w_out%ab)) .and. all(same(found%e%w_out%ac, expected%e%w_out%ac)))
    CHECK(all(same(found%e%w_out%dab, expected%e%w_out%dab)) .and. all(same(found%e%w_out%dac, expected%e%w_out%dac)))
    CHECK(all(same(found%e%gap, expected%e%gap)))
    CHECK(all(same(found%e%force, expected%e%force)))
    CHECK(all(same(found%e%k, expected%e%k)))
    CHECK(all(same(found%e%responses(4)%sigma, expected%e%responses(4)%sigma)))
    CHECK(all(same(found%e%responses(4)%drow_dnow, expected%e%responses(4)%drow_dnow)))
    CHECK(all(same(found%e%block, expected%e%block)))
    CHECK(all(same(found%e%normals, expected%e%normals)) .and. all(same(found%e%areas, expected%e%areas)))
    CHECK(all(same(found%e%normal, expected%e%normal)))
    CHECK(all(same(found%r, expected%r)))
    CHECK(triplets_equal(found%t, expected%t))
  end subroutine
end program
