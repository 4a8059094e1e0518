! Sizes and numbers far from 1. Units must not matter: scaling by a power of two scales the results exactly, until
! squares of lengths leave the range of doubles; from there on the answer is a refusal.
#include "check.inc"
program t51_extremes
  use, intrinsic :: iso_c_binding
  use, intrinsic :: ieee_arithmetic
  use calls
  use check
  use pairs
  use scenes
  use stickslip
  implicit none
  ! A few roundings of numbers below 1.
  real(c_double), parameter :: ROUNDING = 1d-15
  type(element), target, save :: e
  type(handle), target, save :: h

  call units()
  call sizes_beyond()
  call stresses()
  call distances()
  call positions_of_nodes()

contains

  ! Every number is the other's times two to the power.
  pure logical function exactly_scaled(v, reference, power)
    real(c_double), intent(in) :: v(:), reference(:)
    integer, intent(in) :: power
    exactly_scaled = all(same(v, scale(reference, power)))
  end function

  subroutine units()
    type(weights), target, save :: base, scaled
    real(c_double), target :: areas(4), base_areas(4)
    real(c_double) :: gap(12)
    integer :: power
    call element_init(e)
    call pair_weights(e%pair, base)
    CHECK_OK(call_gap(e))
    gap = reshape(e%gap, [12])
    CHECK_OK(stickslip_facet_geometry(4, quad2, c_null_ptr, c_loc(base_areas)))
    ! 2^240 is 1e72.
    do power = -240, 240, 10
      call element_init(e)
      e%x1 = scale(quad1, power)
      e%x2 = scale(quad2, power)
      call pair_weights(e%pair, scaled)
      CHECK(exactly_scaled(scaled%ab, base%ab, 2 * power) .and. exactly_scaled(scaled%ac, base%ac, 2 * power))
      CHECK(exactly_scaled(scaled%dab, base%dab, power) .and. exactly_scaled(scaled%dac, base%dac, power))
      e%w = scaled
      CHECK_OK(call_gap(e))
      CHECK(exactly_scaled(reshape(e%gap, [12]), gap, 3 * power))
      CHECK_OK(stickslip_facet_geometry(4, e%x2, c_null_ptr, c_loc(areas)))
      CHECK(exactly_scaled(areas, base_areas, 2 * power))
    end do
  end subroutine

  subroutine sizes_beyond()
    integer(c_int32_t) :: status
    integer :: power, sign
    do power = 270, 1010, 20
      do sign = -1, 1, 2
        call element_init(e)
        e%x1 = scale(quad1, sign * power)
        e%x2 = scale(quad2, sign * power)
        status = call_weights(e)
        CHECK(status == STICKSLIP_DEGENERATE_FACET .or. status == STICKSLIP_DUPLICATE_NODE)
        call element_untouched(e)
      end do
    end do
  end subroutine

  ! The tangential part of a node in any unit of stress, from the smallest numbers to the largest.
  subroutine stresses()
    integer :: power
    do power = -900, 900, 100
      call element_init(e)
      e%node%lambda = scale([3d0, 4d0, -2d0], power)
      e%node%augmentation = scale(1d0, power)
      CHECK_OK(call_respond(e))
      CHECK(e%responses(4)%state == STICKSLIP_STATE_SLIP)
      CHECK_NEAR(scale(e%responses(4)%traction(1:2), -power), ([0.6d0, 0.8d0]), ROUNDING)
      CHECK(same(e%responses(4)%traction(3), e%node%lambda(3)))
    end do
    ! A coefficient of friction as large as it gets: stick, not an overflow.
    call element_init(e)
    e%node%mu = 1.7d308
    e%node%lambda(1) = 1d6
    CHECK_OK(call_respond(e))
    CHECK(e%responses(4)%state == STICKSLIP_STATE_STICK)
  end subroutine

  ! No limit to the search distance, however it is said, on facets along the axes.
  subroutine distances()
    real(c_double), target :: table(3, 4) = reshape([-1, -1, 0, 2, -1, 0, 2, 2, 0, -1, 2, 0], [3, 4])
    integer(c_int64_t), target :: offsets(2) = [0, 4], nodes(4) = [1, 2, 3, 4], equations(36)
    real(c_double), parameter :: FAR(6) = [1d-300, 1d0, 1d30, 1d155, 1d300, 1.7d308]
    real(c_double), target :: coverage(4), lambda(3, 4)
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
    lambda = 0
    out%coverage = c_loc(coverage)
    do k = 1, size(FAR)
      CHECK_OK(stickslip_options_init(options, stickslip_options_size))
      CHECK_OK(stickslip_options_paper(options))
      call c_f_pointer(options%method, paper)
      method = paper
      options%method = c_loc(method)
      options%index_base = 1
      method%augmentation = 1
      options%search_distance = FAR(k)
      CHECK_OK(stickslip_interface_create(nonmortar, mortar, options, contact))
      CHECK_OK(stickslip_interface_states(contact, quad1, table, lambda, c_null_ptr, out))
      CHECK_NEAR(coverage, 0.25d0, ROUNDING)
      CHECK_OK(stickslip_interface_destroy(contact))
    end do
  end subroutine

  ! All nodes at one place, or far away, or one node astray: refused or out of contact, never a number that is not one.
  subroutine positions_of_nodes()
    real(c_double), parameter :: FACTORS(8) = [0d0, 5d-324, 1d-300, 1d-160, 1d8, 1d16, 1d30, 1d75]
    integer :: k
    do k = 1, size(FACTORS)
      call handle_init(h)
      h%s%x1 = h%s%x1 * FACTORS(k)
      call refused_or_finite()
      call handle_init(h)
      h%s%x1(:, 5) = h%s%x1(:, 5) * FACTORS(k)
      call refused_or_finite()
      call handle_init(h)
      h%s%x2 = h%s%x2 * FACTORS(k)
      call refused_or_finite()
      call handle_init(h)
      h%s%x2(:, 5) = h%s%x2(:, 5) * FACTORS(k)
      call refused_or_finite()
    end do
  end subroutine

  subroutine refused_or_finite()
    if (call_interface_residual(h) == STICKSLIP_OK) then
      CHECK(all(ieee_is_finite(h%force1)) .and. all(ieee_is_finite(h%force2)) .and. all(ieee_is_finite(h%rows)))
      CHECK_OK(call_interface_coo(h))
      CHECK(all(ieee_is_finite(h%values(:h%count))))
    else
      call handle_untouched(h)
    end if
    if (call_interface_commit(h) /= STICKSLIP_OK) then
      call handle_fill(h)
      call handle_untouched(h)
    end if
    call scene_destroy(h%s)
  end subroutine
end program
