! STICKSLIP_FRICTION_NONE: one multiplier a node, along the normal. The arrays have n1 elements, the answers are those
! of Coulomb's law with mu = 0 computed in full, and there is no slip history.
#include "check.inc"
program t60_frictionless
  use, intrinsic :: iso_c_binding
  use check
  use scenes
  use stickslip
  implicit none
  ! Rounding of a few operations on numbers of size 1; of the slight compression; step and bound of the difference.
  real(c_double), parameter :: ROUNDING = 1d-14, ROUNDING_START = 1d-20, STEP = 1d-6, DIFFERENCE = 1d-7
  integer, parameter :: UNKNOWNS_1 = POSITIONS + NA
  type(scene), target, save :: one, three
  type(history), save :: whole, shorter, now
  real(c_double), target, save :: normal(3, NA)
  real(c_double) :: lambda(3 * NA), r(UNKNOWNS), q(UNKNOWNS_1)
  integer(c_int32_t) :: kind_of_weights

  do kind_of_weights = STICKSLIP_WEIGHTS_CURRENT, STICKSLIP_WEIGHTS_REFERENCE
    call create_both()
    call check_start()
    call check_residual()
    call check_tangent()
    call check_history()
    call check_counters()
    call scene_destroy(one)
    call scene_destroy(three)
  end do

contains

  subroutine create_both()
    integer :: i
    call scene_init(one)
    one%options%friction = STICKSLIP_FRICTION_NONE
    one%options%mu = 0
    one%method%weights = kind_of_weights
    ! One a node; the rest of the array is not to be read.
    one%multipliers = reshape([(merge(POSITIONS + int(i, c_int64_t), INT64_MIN, i <= NA), i = 1, SIZE1)], [3, NA])
    call scene_create(one)
    call scene_init(three)
    three%options%mu = 0
    three%method%weights = kind_of_weights
    three%method%no_shortcuts = STICKSLIP_SHORTCUT_FRICTIONLESS + STICKSLIP_SHORTCUT_RIGID + &
                                 STICKSLIP_SHORTCUT_APART + STICKSLIP_SHORTCUT_UNCOVERED
    call scene_create(three)
  end subroutine

  ! What lies behind the n1 elements stays as it is.
  subroutine check_start()
    type(stickslip_states) :: out
    real(c_double) :: start(3, NA)
    integer(c_int32_t) :: status
    integer :: a
    lambda = UNWRITTEN
    CHECK_OK(stickslip_interface_initial_multipliers(one%contact, lambda))
    CHECK_UNTOUCHED(lambda(NA + 1:))
    CHECK_OK(stickslip_interface_initial_multipliers(three%contact, start))
    out = stickslip_states(normal=c_loc(normal))
    status = stickslip_interface_states(one%contact, one%x1, one%x2, lambda, c_null_ptr, out)
    CHECK_OK(status)
    do a = 1, NA
      CHECK_NEAR(start(:, a), lambda(a) * normal(:, a), ROUNDING_START)
    end do
  end subroutine

  subroutine check_residual()
    real(c_double) :: rows(3 * NA)
    integer(c_int64_t) :: seed
    integer(c_int32_t) :: status
    integer :: a
    seed = 3
    do a = 1, NA
      lambda(a) = -0.5d0 + 0.7d0 * draw(seed)
      three%lambda(:, a) = lambda(a) * normal(:, a)
    end do
    rows = UNWRITTEN
    status = stickslip_interface_residual(one%contact, one%x1, one%x2, lambda, c_null_ptr, q, q(SIZE1 + 1), rows)
    CHECK_OK(status)
    CHECK_UNTOUCHED(rows(NA + 1:))
    q(POSITIONS + 1:) = rows(:NA)
    call scene_residual(three, r)
    CHECK_NEAR(q(:POSITIONS), r(:POSITIONS), ROUNDING)
    do a = 1, NA
      CHECK_NEAR(rows(a) * normal(:, a), r(POSITIONS + 3 * a - 2:POSITIONS + 3 * a), ROUNDING)
    end do
  end subroutine

  ! Against a difference in one direction of all unknowns.
  subroutine check_tangent()
    type(triplets), target, save :: t
    real(c_double) :: direction(UNKNOWNS_1), along(UNKNOWNS_1), plus(UNKNOWNS_1), minus(UNKNOWNS_1)
    integer(c_int64_t) :: seed, n, e
    integer(c_int32_t) :: status
    integer :: i
    seed = 11
    do i = 1, UNKNOWNS_1
      direction(i) = draw(seed)
    end do
    status = stickslip_interface_tangent_coo(one%contact, one%x1, one%x2, lambda, c_null_ptr, 0_c_int64_t, c_null_ptr, &
        c_null_ptr, c_null_ptr, n)
    CHECK_OK(status)
    call triplets_allocate(t, n)
    status = stickslip_interface_tangent_coo(one%contact, one%x1, one%x2, lambda, c_null_ptr, n, c_loc(t%rows), &
        c_loc(t%columns), c_loc(t%values), n)
    CHECK_OK(status)
    CHECK(all(1 <= t%rows .and. t%rows <= UNKNOWNS_1) .and. all(1 <= t%columns .and. t%columns <= UNKNOWNS_1))
    along = 0
    do e = 1, n
      along(t%rows(e)) = along(t%rows(e)) + t%values(e) * direction(t%columns(e))
    end do
    call moved_by(STEP * direction, plus)
    call moved_by(-STEP * direction, minus)
    CHECK_NEAR(along, (plus - minus) / (2 * STEP), DIFFERENCE)
  end subroutine

  subroutine moved_by(d, at)
    real(c_double), intent(in) :: d(UNKNOWNS_1)
    real(c_double), intent(out) :: at(UNKNOWNS_1)
    real(c_double) :: x1(3, NA), x2(3, NC)
    integer(c_int32_t) :: status
    x1 = one%x1 + reshape(d(:SIZE1), [3, NA])
    x2 = one%x2 + reshape(d(SIZE1 + 1:POSITIONS), [3, NC])
    status = stickslip_interface_residual(one%contact, x1, x2, lambda(:NA) + d(POSITIONS + 1:), c_null_ptr, at, &
        at(SIZE1 + 1), at(POSITIONS + 1))
    CHECK_OK(status)
  end subroutine

  ! Shorter, undone and continued with the same bits; another interface's is refused by name.
  subroutine check_history()
    real(c_double) :: again(UNKNOWNS_1)
    integer(c_int32_t) :: status
    call history_take(three%contact, whole)
    call history_take(one%contact, shorter)
    CHECK(shorter%n_reals == whole%n_reals - 6 * NA - merge(32 * whole%integers(HISTORY_PAIRS), 0_c_int64_t, kind_of_weights == STICKSLIP_WEIGHTS_CURRENT))
    CHECK(shorter%integers(HISTORY_PAIRS) == merge(0_c_int64_t, whole%integers(HISTORY_PAIRS), kind_of_weights == STICKSLIP_WEIGHTS_CURRENT))
    CHECK_OK(stickslip_interface_commit(one%contact, one%x1, one%x2, lambda, c_null_ptr))
    CHECK_OK(stickslip_interface_rollback(one%contact))
    call history_take(one%contact, now)
    CHECK(history_equal(now, shorter))
    CHECK_OK(stickslip_interface_commit(one%contact, one%x1, one%x2, lambda, c_null_ptr))
    CHECK_OK(import(one, now))
    status = stickslip_interface_residual(one%contact, one%x1, one%x2, lambda, c_null_ptr, again, again(SIZE1 + 1), &
        again(POSITIONS + 1))
    CHECK_OK(status)
    CHECK(all(same(again, q)))
    CHECK_REFUSED(import(one, whole), STICKSLIP_HISTORY_MISMATCH, "Coulomb's law")
    CHECK_REFUSED(import(three, now), STICKSLIP_HISTORY_MISMATCH, 'no friction')
  end subroutine

  integer(c_int32_t) function import(s, h) result(status)
    type(scene), intent(in) :: s
    type(history), intent(in) :: h
    status = stickslip_interface_history_import(s%contact, h%n_integers, h%integers, h%n_reals, h%reals)
  end function

  ! No slip is computed. There is no coefficient to set, and none to give.
  subroutine check_counters()
    type(stickslip_counters) :: counters
    real(c_double), parameter :: mu(NA) = 0
    CHECK_OK(stickslip_interface_counters(one%contact, counters))
    CHECK(counters%nodes_slipping == 0 .and. counters%multipliers == NA)
    CHECK(counters%nodes_frictionless == NA .and. counters%nodes_frictional == 0)
    CHECK_REFUSED(stickslip_interface_set_friction(one%contact, mu), STICKSLIP_INVALID_VALUE, 'friction')
    CHECK_OK(stickslip_interface_counters(three%contact, counters))
    CHECK(counters%nodes_slipping > 0 .and. counters%multipliers == SIZE1)
  end subroutine
end program
