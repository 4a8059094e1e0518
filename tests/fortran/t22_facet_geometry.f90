! A facet's share of nodal normals and areas, and the nodal normal made of the shares.
#include "check.inc"
program t22_facet_geometry
  use, intrinsic :: iso_c_binding
  use check
  use pairs
  use stickslip
  implicit none
  ! A few roundings of numbers below 1.
  real(c_double), parameter :: ROUNDING = 1d-16, ROUNDING_ROOT = 2d-16
  real(c_double), target :: normals(3, 4), areas(4)
  real(c_double) :: nu(3)

  CHECK_OK(stickslip_facet_geometry(4, quad1, c_loc(normals), c_loc(areas)))
  CHECK(all(normals(1:2, :) == 0) .and. all(normals(3, :) == -1))
  CHECK_NEAR(areas, 0.25d0, ROUNDING)
  CHECK_OK(stickslip_facet_geometry(3, tri1, c_loc(normals), c_loc(areas)))
  CHECK_NEAR(areas(:3), 1d0 / 6, ROUNDING)

  ! Each output alone, and none.
  CHECK_OK(stickslip_facet_geometry(3, tri1, c_loc(normals), c_null_ptr))
  CHECK_OK(stickslip_facet_geometry(3, tri1, c_null_ptr, c_loc(areas)))
  CHECK_OK(stickslip_facet_geometry(3, tri1, c_null_ptr, c_null_ptr))

  ! Two facets at a right angle: the normal in between, into the body.
  CHECK_OK(stickslip_node_normal([1d0, 0d0, 1d0], nu))
  CHECK_NEAR(nu, -sqrt(0.5d0) * ([1, 0, 1]), ROUNDING_ROOT)

  nu = UNWRITTEN
  CHECK_REFUSED(stickslip_node_normal([1d-9, 0d0, -1d-9], nu), STICKSLIP_UNDEFINED_NORMAL, 'normals')
  CHECK_UNTOUCHED(nu)

  ! A sum whose length overflows has no normal.
  CHECK_REFUSED(stickslip_node_normal([1d300, 0d0, 1d300], nu), STICKSLIP_NOT_FINITE, 'normals')
  CHECK_UNTOUCHED(nu)
end program
