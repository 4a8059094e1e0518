! A punch with a sharp edge: its surface is split along it, and presses on the floor and the wall of a channel.
#include "check.inc"
program t70_creases
  use, intrinsic :: iso_c_binding
  use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan, ieee_positive_inf
  use check
  use stickslip
  implicit none
  integer, parameter :: WHOLE = 6, DOUBLED = 8, CHANNEL_NODES = 8
  ! Sums of a few numbers of size 1.
  real(c_double), parameter :: ROUNDING = 1d-15
  ! Below the edge's 90 degrees, and above.
  real(c_double), parameter :: SHARP = 0.7d0, BLUNT = 1.6d0
  ! A floor of 1 x 1 in z = 0, looking down, and a wall of 1 x 1 in x = 0, looking left; nodes 1 and 2 on the edge.
  real(c_double), target :: punch(3, WHOLE) = reshape( &
      [0, 0, 0, 0, 1, 0, 1, 1, 0, 1, 0, 0, 0, 0, 1, 0, 1, 1], [3, WHOLE])
  integer(c_int64_t), target :: offsets(3) = [0, 4, 8], facets(8) = [1, 2, 3, 4, 1, 5, 6, 2]
  ! Looking up and to the right.
  real(c_double), target :: channel(3, CHANNEL_NODES) = reshape( &
      [-1, -1, 0, 2, -1, 0, 2, 2, 0, -1, 2, 0, 0, -1, -1, 0, 2, -1, 0, 2, 2, 0, -1, 2], [3, CHANNEL_NODES])
  integer(c_int64_t), target :: channel_facets(8) = [1, 2, 3, 4, 5, 6, 7, 8]
  integer(c_int64_t), parameter :: EXPECTED(8) = [1, 2, 3, 4, 7, 5, 6, 8], COPIED(DOUBLED) = [1, 2, 3, 4, 5, 6, 1, 2]

  call check_numbering()
  call check_lines()
  call check_refusals()
  call check_contact()

contains

  function surface_of(x, n, nodes) result(s)
    real(c_double), target, intent(in) :: x(3, *)
    integer, intent(in) :: n
    integer(c_int64_t), target, intent(in) :: nodes(8)
    type(stickslip_surface) :: s
    s = stickslip_surface(n_nodes=n, n_facets=2, coordinates=c_loc(x), facet_offsets=c_loc(offsets), &
        facet_nodes=c_loc(nodes))
  end function

  subroutine check_numbering()
    integer(c_int64_t) :: count
    integer(c_int64_t), target :: nodes(8), originals(DOUBLED + 1), in_place(8)
    type(stickslip_surface) :: s
    s = surface_of(punch, WHOLE, facets)
    CHECK_OK(stickslip_surface_split_creases(s, SHARP, 1, 0_c_int64_t, c_null_ptr, c_null_ptr, count))
    CHECK(count == DOUBLED)
    originals = -7
    CHECK_OK(stickslip_surface_split_creases(s, SHARP, 1, count, c_loc(nodes), c_loc(originals), count))
    ! The first facet keeps its nodes; the copies follow, in the order of what they copy.
    CHECK(all(nodes == EXPECTED) .and. all(originals(:DOUBLED) == COPIED) .and. originals(DOUBLED + 1) == -7)
    ! From 0, in place.
    in_place = facets - 1
    s = surface_of(punch, WHOLE, in_place)
    CHECK_OK(stickslip_surface_split_creases(s, SHARP, 0, count, c_loc(in_place), c_loc(originals), count))
    CHECK(all(in_place == EXPECTED - 1) .and. all(originals(:DOUBLED) == COPIED - 1))
    ! An angle beyond the edge's splits nothing.
    s = surface_of(punch, WHOLE, facets)
    CHECK_OK(stickslip_surface_split_creases(s, BLUNT, 1, count, c_loc(nodes), c_loc(originals), count))
    CHECK(count == WHOLE .and. all(nodes == facets))
  end subroutine

  ! Two lines at a right angle, from 1.
  subroutine check_lines()
    real(c_double), target :: corner(2, 3) = reshape([0d0, 0d0, 1d0, 0d0, 1d0, -1d0], [2, 3])
    integer(c_int64_t), target :: starts(3) = [0, 2, 4], lines(4) = [1, 2, 2, 3], originals(4)
    integer(c_int64_t) :: count
    type(stickslip_surface) :: s
    s = stickslip_surface(n_nodes=3, n_facets=2, coordinates=c_loc(corner), facet_offsets=c_loc(starts), &
        facet_nodes=c_loc(lines))
    CHECK_OK(stickslip_lines_split_creases(s, SHARP, 1, 4_c_int64_t, c_loc(lines), c_loc(originals), count))
    CHECK(count == 4 .and. all(lines == [1, 2, 4, 3]) .and. all(originals == [1, 2, 3, 2]))
  end subroutine

  subroutine check_refusals()
    integer(c_int64_t) :: count
    integer(c_int64_t), target :: nodes(8), originals(DOUBLED), reversed(8) = [1, 2, 3, 4, 2, 6, 5, 1]
    real(c_double) :: angles(6)
    type(stickslip_surface) :: s
    integer(c_int32_t) :: status
    integer(c_int64_t), parameter :: ROOM = DOUBLED
    integer :: k
    type(c_ptr) :: out, old
    s = surface_of(punch, WHOLE, facets)
    count = UNWRITTEN_INTEGER
    nodes = UNWRITTEN_INTEGER
    originals = UNWRITTEN_INTEGER
    out = c_loc(nodes)
    old = c_loc(originals)
    angles = [0d0, -0.7d0, 3.2d0, 40d0, ieee_value(0d0, ieee_quiet_nan), ieee_value(0d0, ieee_positive_inf)]
    do k = 1, size(angles)
      status = stickslip_surface_split_creases(s, angles(k), 1, ROOM, out, old, count)
      CHECK_REFUSED(status, STICKSLIP_INVALID_VALUE, 'angle')
    end do
    status = stickslip_surface_split_creases(s, SHARP, 2, ROOM, out, old, count)
    CHECK_REFUSED(status, STICKSLIP_INVALID_VALUE, 'index_base')
    status = stickslip_surface_split_creases(s, SHARP, 1, ROOM - 1, out, old, count)
    CHECK_REFUSED(status, STICKSLIP_BUFFER_TOO_SMALL, 'capacity')
    status = stickslip_surface_split_creases(s, SHARP, 1, ROOM, c_null_ptr, old, count)
    CHECK_REFUSED(status, STICKSLIP_NULL_POINTER, 'facet_nodes')
    status = stickslip_surface_split_creases(s, SHARP, 1, ROOM, out, c_null_ptr, count)
    CHECK_REFUSED(status, STICKSLIP_NULL_POINTER, 'originals')
    status = stickslip_surface_split_creases(s, SHARP, 0, ROOM, out, old, count)
    CHECK_REFUSED(status, STICKSLIP_INDEX_OUT_OF_RANGE, 'node')
    ! The second facet the other way round: no surface of a body.
    s%facet_nodes = c_loc(reversed)
    status = stickslip_surface_split_creases(s, SHARP, 1, ROOM, out, old, count)
    CHECK_REFUSED(status, STICKSLIP_INVALID_VALUE, 'facets 0 and 1')
    s%struct_size = 3
    status = stickslip_surface_split_creases(s, SHARP, 1, ROOM, out, old, count)
    CHECK_REFUSED(status, STICKSLIP_STRUCT_SIZE, 'stickslip_surface')
    CHECK(count == UNWRITTEN_INTEGER)
    CHECK_UNTOUCHED(nodes)
    CHECK_UNTOUCHED(originals)
  end subroutine

  ! Pressed by 0.01 on both faces, with a pressure of 1 on each: a quarter of it at every corner.
  subroutine check_contact()
    integer(c_int64_t) :: count
    integer(c_int64_t), target :: nodes(8), originals(DOUBLED), equations(3, DOUBLED), multipliers(3, DOUBLED), &
        none(3, CHANNEL_NODES)
    real(c_double), target :: x(3, DOUBLED), normal(3, DOUBLED)
    real(c_double) :: x1(3, DOUBLED), lambda(3, DOUBLED), mu(DOUBLED), force1(3, DOUBLED), force2(3, CHANNEL_NODES), &
        rows(3, DOUBLED), total(3, WHOLE), corner(3, WHOLE)
    type(stickslip_surface) :: one, two
    type(stickslip_options) :: options
    type(stickslip_interface) :: contact
    type(stickslip_states) :: states
    integer :: a, i
    one = surface_of(punch, WHOLE, facets)
    CHECK_OK(stickslip_surface_split_creases(one, SHARP, 1, 8_c_int64_t, c_loc(nodes), c_loc(originals), count))
    x = punch(:, originals)
    x1 = x
    x1([1, 3], :) = x1([1, 3], :) - 0.01d0
    do a = 1, DOUBLED
      mu(a) = merge(0d0, 0.3d0, size(pack(originals, originals == originals(a))) > 1)
      equations(:, a) = [(3 * (originals(a) - 1) + i, i = 1, 3)]
      multipliers(:, a) = [(3 * (WHOLE + a - 1) + i, i = 1, 3)]
    end do
    none = -1
    one = surface_of(x, DOUBLED, nodes)
    one%equations = c_loc(equations)
    one%multiplier_equations = c_loc(multipliers)
    two = surface_of(channel, CHANNEL_NODES, channel_facets)
    two%equations = c_loc(none)
    CHECK_OK(stickslip_options_init(options, stickslip_options_size))
    CHECK_OK(stickslip_options_paper(options))
    options%index_base = 1
    options%modulus = 100
    options%mu = 0.3d0
    CHECK_OK(stickslip_interface_create(one, two, options, contact))
    CHECK_OK(stickslip_interface_set_friction(contact, mu))
    lambda = 0
    states = stickslip_states(normal=c_loc(normal))
    CHECK_OK(stickslip_interface_states(contact, x1, channel, lambda, c_null_ptr, states))
    ! The floor's; 5, 6 and the copies are the wall's.
    lambda(3, :4) = -1
    lambda(1, 5:) = -1
    CHECK_NEAR(normal, -lambda, ROUNDING)
    CHECK_OK(stickslip_interface_residual(contact, x1, channel, lambda, c_null_ptr, force1, force2, rows))
    total = 0
    do a = 1, DOUBLED
      total(:, originals(a)) = total(:, originals(a)) + force1(:, a)
    end do
    corner = 0
    corner(3, :4) = -0.25d0
    corner(1, [1, 2, 5, 6]) = -0.25d0
    CHECK_NEAR(total, corner, ROUNDING)
    CHECK_OK(stickslip_interface_destroy(contact))
  end subroutine
end program
