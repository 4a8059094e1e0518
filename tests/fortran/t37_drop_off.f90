! A facet slides over the edge of its partner within one step: until it is gone the slip is how far it went, the forces
! balance, and nothing blows up as the covered area vanishes.
#include "check.inc"
program t37_drop_off
  use, intrinsic :: iso_c_binding
  use check
  use pairs
  use stickslip
  implicit none
  ! Sums of numbers of size 1; the slip is a quotient of two.
  real(c_double), parameter :: ROUNDING = 1d-15, ROUNDING_SLIP = 1d-14
  ! The options' coverage_min times the nodal area, a quarter.
  real(c_double), parameter :: UNCOVERED = 1d-8 * 0.25d0
  real(c_double), parameter :: MOVED(10) = [0.1d0, 0.5d0, 0.9d0, 0.9999d0, 1 - 1d-6, 1 - 1d-9, 1 - 1d-15, 1d0, &
                                            1 + 1d-12, 7d0]
  real(c_double), target :: table(3, 4) = reshape([-1, -1, 0, 1, -1, 0, 1, 2, 0, -1, 2, 0], [3, 4])
  integer(c_int64_t), target :: offsets(2) = [0, 4], nodes(4) = [1, 2, 3, 4], equations(36)
  real(c_double), target :: x1(3, 4), lambda(3, 4), slip(3, 4), kept(3, 4), coverage(4), dissipation(4)
  real(c_double) :: f1(3, 4), f2(3, 4), rows(3, 4), covered
  integer(c_int32_t), target :: state(4)
  type(stickslip_surface) :: nonmortar, mortar
  type(stickslip_options) :: options
  type(stickslip_method), target :: method
  type(stickslip_method), pointer :: paper
  type(stickslip_interface) :: contact
  type(stickslip_states) :: out
  integer :: i, k

  equations = [(i, i = 1, 36)]
  nonmortar = stickslip_surface(n_nodes=4, n_facets=1, coordinates=c_loc(quad1), facet_offsets=c_loc(offsets), &
      facet_nodes=c_loc(nodes), equations=c_loc(equations), multiplier_equations=c_loc(equations(25)))
  mortar = stickslip_surface(n_nodes=4, n_facets=1, coordinates=c_loc(table), facet_offsets=c_loc(offsets), &
      facet_nodes=c_loc(nodes), equations=c_loc(equations(13)))
  CHECK_OK(stickslip_options_init(options, stickslip_options_size))
  CHECK_OK(stickslip_options_paper(options))
  call c_f_pointer(options%method, paper)
  method = paper
  options%method = c_loc(method)
  options%index_base = 1
  method%augmentation = 10
  options%mu = 0.1d0

  do k = 1, size(MOVED)
    CHECK_OK(stickslip_interface_create(nonmortar, mortar, options, contact))
    x1 = quad1
    x1(1, :) = x1(1, :) + MOVED(k)
    lambda = spread([0d0, 0d0, -1d0], 2, 4)
    out = stickslip_states(state=c_loc(state), slip=c_loc(slip), coverage=c_loc(coverage), &
        dissipation=c_loc(dissipation))
    CHECK_OK(stickslip_interface_states(contact, x1, table, lambda, c_null_ptr, out))
    CHECK_OK(stickslip_interface_residual(contact, x1, table, lambda, c_null_ptr, f1, f2, rows))
    ! A node that is uncovered in the end is open, and an open node does not slip.
    CHECK_NEAR(slip(1, :), merge(0d0, MOVED(k), state == STICKSLIP_STATE_GAP), ROUNDING_SLIP * MOVED(k))
    CHECK(all(state /= STICKSLIP_STATE_GAP .or. coverage <= UNCOVERED))
    CHECK_NEAR(slip(2:3, :), 0d0, ROUNDING)
    CHECK(all(dissipation >= 0))
    covered = max(0d0, 1 - MOVED(k))
    CHECK_NEAR(sum(coverage), covered, ROUNDING)
    CHECK_NEAR(sum(f1(3, :)), -covered, ROUNDING)
    CHECK_NEAR(sum(f2(3, :)), covered, ROUNDING)

    ! What was reported is what a commit keeps.
    CHECK_OK(stickslip_interface_commit(contact, x1, table, lambda, c_null_ptr))
    out%slip = c_loc(kept)
    CHECK_OK(stickslip_interface_states(contact, x1, table, lambda, c_null_ptr, out))
    CHECK_NEAR((kept - slip) / (1 + abs(slip)), 0d0, ROUNDING)
    CHECK_OK(stickslip_interface_destroy(contact))
  end do
end program
