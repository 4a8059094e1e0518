! Finite inputs whose results leave the range of doubles: refused, as stickslip_node_respond does for its row. An
! infinity that goes out with a success ends in the host's linear solver, far from its cause.
#include "check.inc"
program t54_overflow
  use, intrinsic :: iso_c_binding
  use, intrinsic :: ieee_arithmetic
  use calls
  use check
  use scenes
  use stickslip
  implicit none
  ! A mortar side that a diverging iteration has thrown far out: squares of its facets' areas overflow.
  real(c_double), parameter :: SIZES(5) = [1d75, 1d80, 1d120, 1d154, 1d200]
  ! Stiffnesses for which the handle's tangent overflows while its residual does not.
  real(c_double), parameter :: STIFFNESS(4) = [1d-320, 1d-310, 1d300, 1.7d308]
  type(element), target, save :: e
  type(handle), target, save :: h
  real(c_double) :: lambda(3, NA)
  integer(c_int32_t) :: status
  integer :: k

  call element_init(e)
  e%w%ab = 1d308
  e%traction = 1d10
  e%row_scale = 1d300
  status = call_gap(e)
  CHECK(status > STICKSLIP_OK .or. all(ieee_is_finite(e%gap)))
  status = call_residual(e)
  CHECK(status > STICKSLIP_OK .or. all(ieee_is_finite(e%force)))
  status = call_tangent(e)
  CHECK(status > STICKSLIP_OK .or. all(ieee_is_finite(e%k)))
  status = call_facet_tangent(e)
  CHECK(status > STICKSLIP_OK .or. all(ieee_is_finite(e%facet_k)))
  status = call_pair_dual(e)
  CHECK(status > STICKSLIP_OK .or. (all(ieee_is_finite(e%dual_ab)) .and. all(ieee_is_finite(e%dual_ac))))

  call element_init(e)
  e%mass = e%mass * 4d306
  status = call_facet_dual(e)
  CHECK(status > STICKSLIP_OK .or. (all(ieee_is_finite(e%dual_areas)) .and. all(ieee_is_finite(e%coefficients))))

  call element_init(e)
  e%row_scale = 1d308
  status = call_facet_tangent(e)
  CHECK(status > STICKSLIP_OK .or. all(ieee_is_finite(e%facet_k)))

  call element_init(e)
  e%responses(1)%row(1) = 1d300
  status = stickslip_node_block(e%responses(1), 1d300, STICKSLIP_LAYOUT_COLUMN_MAJOR, c_loc(e%row), c_loc(e%block))
  CHECK(status > STICKSLIP_OK .or. all(ieee_is_finite(e%row)))

  ! A facet so small that the derivatives of its normals overflow; a node whose traction turns beyond all numbers.
  call element_init(e)
  e%x1 = e%x1 * 1d-155
  status = call_normal_derivatives(e)
  CHECK(status > STICKSLIP_OK .or. all(ieee_is_finite(e%normal_derivatives)))
  call element_init(e)
  e%node%gap_now(3) = -1d300
  e%node%augmentation = 1d10
  status = call_turn(e)
  CHECK(status > STICKSLIP_OK .or. all(ieee_is_finite(e%turn)))

  ! 1 / r overflows.
  call element_init(e)
  e%node%augmentation = 1d-310
  e%node%lambda(3) = 0
  e%node%gap_now(3) = 1
  status = call_respond(e)
  CHECK(status > STICKSLIP_OK .or. all(ieee_is_finite(e%responses(4)%drow_dlambda)))

  do k = 1, size(SIZES)
    call element_init(e)
    e%x2 = e%x2 * SIZES(k)
    status = call_weights(e)
    CHECK(status > STICKSLIP_OK .or. (all(ieee_is_finite(e%w_out%ab)) .and. all(ieee_is_finite(e%w_out%ac))))
    CHECK(status > STICKSLIP_OK .or. (all(ieee_is_finite(e%w_out%dab)) .and. all(ieee_is_finite(e%w_out%dac))))

    call handle_init(h)
    h%s%x2 = h%s%x2 * SIZES(k)
    call evaluation()
    call scene_destroy(h%s)
  end do

  do k = 1, size(STIFFNESS)
    call scene_init(h%s)
    h%s%method%augmentation = STIFFNESS(k)
    if (stickslip_interface_create(h%s%nonmortar, h%s%mortar, h%s%options, h%s%contact) /= STICKSLIP_OK) cycle
    lambda = 0
    status = stickslip_interface_initial_multipliers(h%s%contact, lambda)
    CHECK(status > STICKSLIP_OK .or. all(ieee_is_finite(lambda)))
    h%s%lambda = 0
    call evaluation()
    call scene_destroy(h%s)
  end do

contains

  subroutine evaluation()
    integer(c_int32_t) :: status
    status = call_interface_residual(h)
    CHECK(status > STICKSLIP_OK .or. all(ieee_is_finite(h%force1)) .and. all(ieee_is_finite(h%force2)))
    CHECK(status > STICKSLIP_OK .or. all(ieee_is_finite(h%rows)))
    status = call_interface_coo(h)
    if (status > STICKSLIP_OK) return
    CHECK(all(ieee_is_finite(h%values(:h%count))))
  end subroutine
end program
