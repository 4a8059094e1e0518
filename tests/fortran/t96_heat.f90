! Heat across an interface: friction makes all that both bodies get; equal temperatures; the tangent's rows; one node.
#include "check.inc"
program t96_heat
  use, intrinsic :: iso_c_binding
  use check
  use scenes
  use stickslip
  implicit none

  real(c_double), parameter :: ROUNDING = 1d-13
  integer(c_int64_t), parameter :: MOST = 10000
  type(scene), target, save :: s
  type(stickslip_heat) :: heat
  type(stickslip_heat_nodes), target :: nodes
  real(c_double) :: t1(NA), t2(NC), heat1(NA), heat2(NC), sides(2)
  real(c_double), target :: friction(NA), values(MOST), slopes(STICKSLIP_HEAT_SLOPES, 2), conductance
  integer(c_int64_t), target :: rows(MOST), columns(MOST)
  integer(c_int64_t) :: e1(NA), e2(NC), count, counted, k
  integer(c_int32_t) :: status
  real(c_double) :: product(NA + NC), t(NA + NC)

  call scene_init(s)
  call scene_create(s)
  heat%contact = 2
  heat%pressure = 0.5d0
  heat%exponent = 1
  heat%constant = 0.3d0
  heat%reach = 10
  heat%share = 0.3d0
  heat%time = 0.25d0
  t1 = [(20 + 0.3d0 * k, k = 1, NA)]
  t2 = [(25 - 0.7d0 * k, k = 1, NC)]
  e1 = [(k, k = 1, NA)]
  e2 = [(NA + k, k = 1, NC)]
  nodes%friction = c_loc(friction)
  status = stickslip_interface_heat(s%contact, s%x1, s%x2, s%lambda, heat, t1, t2, heat1, heat2, c_loc(nodes))
  CHECK_OK(status)
  CHECK(abs(sum(friction)) > 0 .and. abs(sum(heat1) + sum(heat2) + sum(friction)) <= ROUNDING * sum(abs(heat1)))

  ! Without friction heat is what the tangent makes of the temperatures.
  heat%time = 0
  status = stickslip_interface_heat(s%contact, s%x1, s%x2, s%lambda, heat, t1, t2, heat1, heat2, c_null_ptr)
  CHECK_OK(status)
  status = stickslip_interface_heat_tangent_coo(s%contact, s%x1, s%x2, s%lambda, heat, t1, t2, e1, e2, &
      STICKSLIP_HEAT_TEMPERATURES, 0_c_int64_t, c_null_ptr, c_null_ptr, c_null_ptr, counted)
  CHECK_OK(status)
  status = stickslip_interface_heat_tangent_coo(s%contact, s%x1, s%x2, s%lambda, heat, t1, t2, e1, e2, &
      STICKSLIP_HEAT_TEMPERATURES, MOST, c_loc(rows), c_loc(columns), c_loc(values), count)
  CHECK_OK(status)
  CHECK(count == counted .and. count > 0)
  t = [t1, t2]
  product = 0
  do k = 1, count
    product(rows(k)) = product(rows(k)) + values(k) * t(columns(k))
  end do
  CHECK(all(abs(product - [heat1, heat2]) <= 1d-12 * maxval(abs(heat1))))
  status = stickslip_interface_heat_tangent_coo(s%contact, s%x1, s%x2, s%lambda, heat, t1, t2, e1, e2, 7_c_int32_t, MOST, &
      c_loc(rows), c_loc(columns), c_loc(values), count)
  CHECK_REFUSED(status, STICKSLIP_INVALID_VALUE, 'which')

  status = stickslip_node_heat(heat, 0.5d0, 0.5d0, 0d0, 0.25d0, 0d0, sides, c_loc(slopes), c_loc(conductance))
  CHECK_OK(status)
  CHECK(abs(conductance - 2.3d0) < ROUNDING .and. all(abs(sides - 4.6d0) < ROUNDING))
  CHECK(all(abs(slopes(1, :) - 9.2d0) < ROUNDING))
  CHECK_OK(stickslip_interface_destroy(s%contact))
end program
