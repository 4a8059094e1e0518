! Weakly covered nodes that neighbours carry: which and how many, balance, the tangent along one direction against
! differences, the pattern, refusals.
#include "check.inc"
program t74_weak_coverage
  use, intrinsic :: iso_c_binding
  use check
  use scenes
  use stickslip
  implicit none
  ! Step and tolerance of central differences in double precision; facets of size 0.5.
  real(c_double), parameter :: H = 1d-6, TOLERANCE = 1d-8
  ! Rounding of sums of a hundred forces, over the sum of their sizes.
  real(c_double), parameter :: ROUNDING = 1d-14
  type(scene), target, save :: s, moved
  type(triplets), target, save :: t
  logical, save :: entry(UNKNOWNS, UNKNOWNS)

  call check_carried(STICKSLIP_FORM_MULTIPLIER)
  call check_carried(STICKSLIP_FORM_AUGMENTED)
  call check_refusals()

contains

  ! Committed where nodes hang over, then moved a little.
  subroutine hang_over(weak_coverage, form)
    real(c_double), intent(in) :: weak_coverage
    integer(c_int32_t), intent(in) :: form
    call scene_init(s)
    CHECK(s%method%weak_coverage == 0)
    s%method%weak_coverage = weak_coverage
    s%method%form = form
    call scene_create(s)
    call scene_slide(s, 0.9d0)
    call scene_commit(s)
    call scene_slide(s, 0.04d0)
  end subroutine

  function counters() result(c)
    type(stickslip_counters) :: c
    CHECK_OK(stickslip_interface_counters(s%contact, c))
  end function

  ! Along a direction of all unknowns.
  function residual_along(d, by) result(r)
    real(c_double), intent(in) :: d(UNKNOWNS), by
    real(c_double) :: r(UNKNOWNS)
    integer :: x, m
    x = size(s%x1)
    m = x + size(s%x2)
    moved = s
    moved%x1 = s%x1 + by * reshape(d(:x), shape(s%x1))
    moved%x2 = s%x2 + by * reshape(d(x + 1:m), shape(s%x2))
    moved%lambda = s%lambda + by * reshape(d(m + 1:), shape(s%lambda))
    call scene_residual(moved, r)
  end function

  subroutine check_carried(form)
    integer(c_int32_t), intent(in) :: form
    type(stickslip_counters) :: c
    real(c_double) :: own(UNKNOWNS), r(UNKNOWNS), d(UNKNOWNS), product(UNKNOWNS), difference(UNKNOWNS), forces(3)
    integer(c_int64_t) :: e, covered
    integer :: n
    call hang_over(0d0, form)
    call scene_residual(s, own)
    c = counters()
    CHECK(c%nodes_carried == 0)
    call scene_destroy(s)

    call hang_over(0.5d0, form)
    call scene_residual(s, r)
    c = counters()
    CHECK(c%nodes_carried > 0 .and. any(r /= own))
    covered = c%nodes_carried + c%nodes_frictional + c%nodes_frictionless + c%nodes_new + c%nodes_tied
    CHECK(covered + c%nodes_uncovered + c%nodes_left_out == NA)
    n = size(s%x1) + size(s%x2)
    forces = sum(reshape(r(:n), [3, n / 3]), dim=2)
    CHECK_NEAR(forces / sum(abs(r(:n))), 0d0, ROUNDING)

    call random_number(d)
    call scene_tangent(s, t)
    product = 0
    do e = 1, t%n
      product(t%rows(e)) = product(t%rows(e)) + t%values(e) * d(t%columns(e))
    end do
    difference = (residual_along(d, H) - residual_along(d, -H)) / (2 * H)
    CHECK_NEAR(difference / maxval(abs(product)), product / maxval(abs(product)), TOLERANCE)

    call pattern()
    entry = .false.
    do e = 1, t%n
      entry(t%rows(e), t%columns(e)) = .true.
    end do
    call scene_slide(s, 0.05d0)
    call scene_tangent(s, t)
    do e = 1, t%n
      CHECK(entry(t%rows(e), t%columns(e)))
    end do
    call scene_destroy(s)
  end subroutine

  ! Asks for the number of entries, then for the entries.
  subroutine pattern()
    integer(c_int32_t) :: status
    integer(c_int64_t) :: written
    status = stickslip_interface_pattern_coo(s%contact, s%x1, s%x2, 0_c_int64_t, c_null_ptr, c_null_ptr, t%n)
    CHECK_OK(status)
    call triplets_allocate(t, t%n)
    status = stickslip_interface_pattern_coo(s%contact, s%x1, s%x2, t%n, c_loc(t%rows), c_loc(t%columns), written)
    CHECK_OK(status)
    CHECK(written == t%n)
  end subroutine

  subroutine check_refusals()
    real(c_double), parameter :: WRONG(3) = [-1d-12, 1 + 1d-12, 2d0]
    real(c_double), target :: sums(STICKSLIP_SUMS_PER_NODE, NA)
    integer :: k
    do k = 1, 3
      call scene_init(s)
      s%method%weak_coverage = WRONG(k)
      CHECK_REFUSED(created(), STICKSLIP_INVALID_VALUE, 'method.weak_coverage')
    end do
    call hang_over(0.5d0, STICKSLIP_FORM_MULTIPLIER)
    CHECK_OK(stickslip_interface_sums(s%contact, s%x1, s%x2, sums))
    CHECK_REFUSED(refused_with(sums), STICKSLIP_UNSUPPORTED, 'weak_coverage')
    call scene_destroy(s)
  end subroutine

  integer(c_int32_t) function created() result(status)
    status = stickslip_interface_create(s%nonmortar, s%mortar, s%options, s%contact)
  end function

  integer(c_int32_t) function refused_with(sums) result(status)
    real(c_double), target, intent(in) :: sums(STICKSLIP_SUMS_PER_NODE, NA)
    real(c_double) :: force1(3, NA), force2(3, size(s%x2) / 3), rows(3, NA)
    status = stickslip_interface_residual(s%contact, s%x1, s%x2, s%lambda, c_loc(sums), force1, force2, rows)
  end function
end program
