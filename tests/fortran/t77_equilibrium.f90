! How far a point is from contact equilibrium: independent of augmentation, row scale and form; one node by itself; what
! is refused.
#include "check.inc"
program t77_equilibrium
  use, intrinsic :: iso_c_binding
  use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
  use check
  use scenes
  use stickslip
  implicit none
  ! Rounding of a few operations; the positions' own is taken off by the library.
  real(c_double), parameter :: ROUNDING = 1d-11
  ! Of the order of the multipliers times h over the gaps, so that neither hides the other.
  real(c_double), parameter :: MODULUS = 5
  type(scene), target :: s

  call check_independence()
  call check_solution()
  call check_one_node()
  call check_refusals()

contains

  function measured() result(e)
    type(stickslip_equilibrium) :: e
    e = stickslip_equilibrium(modulus=MODULUS)
    CHECK_OK(stickslip_interface_equilibrium(s%contact, s%x1, s%x2, s%lambda, c_null_ptr, e))
    CHECK(e%struct_size == stickslip_equilibrium_size .and. e%modulus == MODULUS)
  end function

  pure function numbers(e) result(v)
    type(stickslip_equilibrium), intent(in) :: e
    real(c_double) :: v(6)
    v = [e%gap, e%gap_scale, e%traction, e%traction_scale, e%slip, e%slip_scale]
  end function

  ! Equal bits at a point with all states.
  subroutine check_independence()
    real(c_double), parameter :: AUGMENTATIONS(3) = [1d-9, 15d0, 1d7]
    real(c_double) :: expected(6)
    integer :: k, form
    call scene_init(s)
    call scene_create(s)
    expected = numbers(measured())
    CHECK(expected(3) > 0.01d0 * expected(4) .and. expected(1) + expected(5) > 0)
    call scene_destroy(s)
    do k = 1, size(AUGMENTATIONS)
      do form = 0, 1
        call scene_init(s)
        s%method%augmentation = AUGMENTATIONS(k)
        s%method%form = form
        s%method%row_scale = merge(STICKSLIP_ROW_SCALE_NONE, STICKSLIP_ROW_SCALE_FORCE, form == 1)
        call scene_create(s)
        CHECK(all(numbers(measured()) == expected))
        call scene_destroy(s)
      end do
    end do
  end subroutine

  ! A point that lacks nothing, then tension at the fifth node.
  subroutine check_solution()
    real(c_double), target :: normal(3, NA)
    type(stickslip_states) :: states
    type(stickslip_equilibrium) :: e
    call scene_init(s)
    call scene_create(s)
    s%x1 = s%reference1
    states = stickslip_states(normal=c_loc(normal))
    CHECK_OK(stickslip_interface_states(s%contact, s%x1, s%x2, s%lambda, c_null_ptr, states))
    s%lambda = -2 * normal
    e = measured()
    CHECK(e%gap == 0 .and. e%traction == 0 .and. e%slip == 0 .and. e%traction_scale >= 2 - ROUNDING)
    CHECK(e%gap_node == -1 .and. e%traction_node == -1 .and. e%slip_node == -1)
    s%lambda(:, 5) = normal(:, 5) / 4
    e = measured()
    CHECK(e%traction_node == 5)
    CHECK_NEAR(e%traction, 0.25d0, ROUNDING)
    call scene_destroy(s)
  end subroutine

  subroutine check_one_node()
    real(c_double), target :: gap, traction, slip
    type(stickslip_node) :: n
    n%augmentation = 1d30 ! has no part in it
    n%normal = [0, 0, 1]
    n%mu = 0.5d0
    n%coverage = 2
    n%coverage_previous = 4
    n%lambda = [0, 0, -2]
    n%gap_now(3) = -0.02d0 ! over the covered area: a penetration of 0.01
    n%gap_previous(1) = 0.04d0
    CHECK_OK(stickslip_node_equilibrium(n, 10d0, 0d0, c_loc(gap), c_loc(traction), c_loc(slip)))
    CHECK(gap == 0.01d0 .and. traction == 0 .and. slip == 0.01d0)
    n%lambda(1) = 1 ! on the cone, and the slip along it
    CHECK_OK(stickslip_node_equilibrium(n, 10d0, 0d0, c_null_ptr, c_loc(traction), c_loc(slip)))
    CHECK(traction == 0 .and. slip == 0)
    gap = UNWRITTEN
    CHECK_REFUSED(stickslip_node_equilibrium(n, -1d0, 0d0, c_loc(gap), c_null_ptr, c_null_ptr), STICKSLIP_INVALID_VALUE, 'stiffness')
    CHECK(gap == UNWRITTEN)
  end subroutine

  subroutine check_refusals()
    type(stickslip_equilibrium) :: e
    integer(c_int32_t) :: status
    call scene_init(s)
    call scene_create(s)
    e = stickslip_equilibrium(modulus=-1)
    e%gap = UNWRITTEN
    status = stickslip_interface_equilibrium(s%contact, s%x1, s%x2, s%lambda, c_null_ptr, e)
    CHECK_REFUSED(status, STICKSLIP_INVALID_VALUE, 'modulus')
    e%modulus = 1
    status = stickslip_interface_equilibrium(no_handle(), s%x1, s%x2, s%lambda, c_null_ptr, e)
    CHECK_REFUSED(status, STICKSLIP_NULL_POINTER, 'interface')
    e%struct_size = 88
    status = stickslip_interface_equilibrium(s%contact, s%x1, s%x2, s%lambda, c_null_ptr, e)
    CHECK_REFUSED(status, STICKSLIP_STRUCT_SIZE, 'stickslip_equilibrium')
    e%struct_size = stickslip_equilibrium_size
    s%lambda(1, 2) = ieee_value(0d0, ieee_quiet_nan)
    status = stickslip_interface_equilibrium(s%contact, s%x1, s%x2, s%lambda, c_null_ptr, e)
    CHECK_REFUSED(status, STICKSLIP_NOT_FINITE, 'lambda')
    CHECK(e%gap == UNWRITTEN)
    call scene_destroy(s)
  end subroutine
end program
