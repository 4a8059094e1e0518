! Plans of the tangent: their entries are those of the triplets, in 32 and 64 bits, as triplets and as compressed rows, and
! so are the values, which are overwritten; with sums; for how long a plan suffices, and what refuses it afterwards. Those of
! a system without multipliers hold the sums of its pieces.
#include "check.inc"
program t86_plan
  use, intrinsic :: iso_c_binding
  use, intrinsic :: ieee_arithmetic
  use check
  use scenes
  use stickslip
  implicit none
  integer, parameter :: MOST = UNKNOWNS**2
  type(scene), target, save :: s
  type(triplets), target, save :: t
  integer(c_int64_t), save :: rows(MOST), columns(MOST), row_list(UNKNOWNS), offsets(UNKNOWNS + 1), csr_columns(MOST)
  integer(c_int32_t), save :: rows32(MOST), columns32(MOST), row_list32(UNKNOWNS), offsets32(UNKNOWNS + 1)
  integer(c_int32_t), save :: csr_columns32(MOST)
  real(c_double), save :: values(MOST), constraints(MOST), none
  integer(c_int32_t) :: form, weights, pairs
  integer :: base

  none = ieee_value(none, ieee_quiet_nan)
  do base = 0, 1
    do form = 0, 1
      do weights = STICKSLIP_WEIGHTS_CURRENT, STICKSLIP_WEIGHTS_REFERENCE
        call check_tangent(base, form, weights, .false.)
        call check_tangent(base, form, weights, .true.)
      end do
    end do
    do pairs = 0, 2
      call check_condensed(base, pairs, 0d0)
      call check_condensed(base, pairs, 0.3d0)
    end do
  end do
  call check_slides()
  call check_sums()
  call check_refusals()
  call check_threads()

contains

  ! The plan, its number of entries and of its rows.
  subroutine make(pairs, n_rows, n)
    integer(c_int32_t), intent(in) :: pairs
    integer(c_int64_t), intent(inout) :: n_rows, n
    CHECK_OK(stickslip_interface_plan(s%contact, s%x1, s%x2, pairs, n_rows, n))
    CHECK(0 < n_rows .and. n_rows <= UNKNOWNS .and. n_rows <= n .and. n <= MOST)
  end subroutine

  integer(c_int32_t) function fill(sums, n) result(status)
    type(c_ptr), intent(in) :: sums
    integer(c_int64_t), intent(in) :: n
    values = none
    status = stickslip_interface_plan_values(s%contact, s%x1, s%x2, s%lambda, sums, n, values)
  end function

  ! Counted from the base: entries as triplets, ascending and each once, and the same as rows, in 32 bits and 64.
  subroutine check_entries(entries, n_rows, n)
    integer(c_int32_t), intent(in) :: entries
    integer(c_int64_t), intent(in) :: n_rows, n
    integer(c_int64_t) :: e, i, first
    first = s%options%index_base
    CHECK_OK(stickslip_interface_plan_coo(s%contact, entries, n, rows, columns))
    CHECK(all(first <= rows(:n) .and. rows(:n) < first + UNKNOWNS .and. first <= columns(:n)))
    CHECK(all(columns(:n) < first + UNKNOWNS))
    do e = 2, n
      CHECK(rows(e - 1) < rows(e) .or. (rows(e - 1) == rows(e) .and. columns(e - 1) < columns(e)))
    end do
    CHECK_OK(stickslip_interface_plan_csr(s%contact, entries, n, row_list, offsets, csr_columns))
    CHECK(offsets(1) == first .and. offsets(n_rows + 1) == first + n)
    do i = 1, n_rows
      CHECK(offsets(i) < offsets(i + 1))
      CHECK(all(rows(offsets(i) - first + 1:offsets(i + 1) - first) == row_list(i)))
    end do
    CHECK(all(row_list(:n_rows - 1) < row_list(2:n_rows)) .and. all(columns(:n) == csr_columns(:n)))
    CHECK_OK(stickslip_interface_plan_coo32(s%contact, entries, n, rows32, columns32))
    CHECK_OK(stickslip_interface_plan_csr32(s%contact, entries, n, row_list32, offsets32, csr_columns32))
    CHECK(all(rows32(:n) == rows(:n) .and. columns32(:n) == columns(:n) .and. csr_columns32(:n) == columns(:n)))
    CHECK(all(row_list32(:n_rows) == row_list(:n_rows)) .and. all(offsets32(:n_rows + 1) == offsets(:n_rows + 1)))
  end subroutine

  ! `shared`: some nodes have equations of others.
  subroutine set_up(base, form, weights, shared)
    integer, intent(in) :: base
    integer(c_int32_t), intent(in) :: form, weights
    logical, intent(in) :: shared
    call scene_init(s, base)
    s%method%form = form
    s%method%weights = weights
    if (shared) then
      s%equations1(:, 5) = s%equations1(:, 1)
      s%equations2(:, 2) = s%equations1(:, 3)
      s%equations2(:, 11) = s%equations2(:, 6)
    end if
    call scene_create(s)
    call scene_commit(s)
  end subroutine

  subroutine default_scene()
    call set_up(1, STICKSLIP_FORM_MULTIPLIER, STICKSLIP_WEIGHTS_CURRENT, .false.)
  end subroutine

  ! Values in their places of a full matrix.
  function dense(n, v) result(k)
    integer(c_int64_t), intent(in) :: n
    real(c_double), intent(in) :: v(:)
    real(c_double) :: k(UNKNOWNS, UNKNOWNS)
    integer(c_int64_t) :: e
    k = 0
    do e = 1, n
      k(rows(e) - s%options%index_base + 1, columns(e) - s%options%index_base + 1) = v(e)
    end do
  end function

  logical function as_triplets(n)
    integer(c_int64_t), intent(in) :: n
    as_triplets = n == t%n
    if (as_triplets) as_triplets = all(same(values(:n), t%values))
  end function

  ! Entries and values are those of the triplets; then with all pairs that may come, which has zeros besides.
  subroutine check_tangent(base, form, weights, shared)
    integer, intent(in) :: base
    integer(c_int32_t), intent(in) :: form, weights
    logical, intent(in) :: shared
    real(c_double) :: expected(UNKNOWNS, UNKNOWNS)
    integer(c_int64_t) :: n_rows, n
    call set_up(base, form, weights, shared)
    call scene_dense(s, t, expected)
    call make(STICKSLIP_PLAN_ACTIVE, n_rows, n)
    CHECK(n == t%n)
    call check_entries(STICKSLIP_ENTRIES_TANGENT, n_rows, n)
    CHECK(all(rows(:n) == t%rows) .and. all(columns(:n) == t%columns))
    CHECK_OK(fill(c_null_ptr, n))
    CHECK(as_triplets(n) .and. all(ieee_is_nan(values(n + 1:))))
    call make(STICKSLIP_PLAN_SKIN, n_rows, n)
    CHECK(n >= t%n)
    call check_entries(STICKSLIP_ENTRIES_TANGENT, n_rows, n)
    CHECK_OK(fill(c_null_ptr, n))
    CHECK(block_difference(dense(n, values), expected, 1d-300) <= 1d-14)
    call scene_destroy(s)
  end subroutine

  ! A fifth of a facet, 0.1 here, is within the skin. Further off entries are missing, until the plan is made again.
  subroutine check_slides()
    integer(c_int64_t) :: n_rows, n, again
    real(c_double) :: kept(3)
    call default_scene()
    call make(STICKSLIP_PLAN_SKIN, n_rows, n)
    call scene_slide(s, 0.1d0)
    CHECK_OK(fill(c_null_ptr, n))
    call make(STICKSLIP_PLAN_ACTIVE, n_rows, n)
    CHECK_OK(fill(c_null_ptr, n))
    call scene_slide(s, 0.6d0)
    CHECK_REFUSED(fill(c_null_ptr, n), STICKSLIP_MISSING_ENTRY, 'make it again')
    CHECK_OK(stickslip_interface_plan_coo(s%contact, STICKSLIP_ENTRIES_TANGENT, n, rows, columns))
    call scene_tangent(s, t)
    call make(STICKSLIP_PLAN_ACTIVE, n_rows, again)
    CHECK_OK(fill(c_null_ptr, again))
    CHECK(as_triplets(again))
    ! A plan that is refused leaves the older one as it was.
    kept = s%x1(:, 5)
    s%x1(:, 5) = s%x1(:, 1)
    n = UNWRITTEN_INTEGER
    CHECK_REFUSED(stickslip_interface_plan(s%contact, s%x1, s%x2, STICKSLIP_PLAN_SKIN, n, n), STICKSLIP_DEGENERATE_FACET, 'facet')
    CHECK(untouched(n))
    s%x1(:, 5) = kept
    CHECK_OK(fill(c_null_ptr, again))
    CHECK(as_triplets(again))
    call scene_destroy(s)
  end subroutine

  ! Sums of all handles may close nodes that this handle's own leave open: such a plan has their entries.
  subroutine check_sums()
    real(c_double), target :: sums(STICKSLIP_SUMS_PER_NODE * NA)
    integer(c_int64_t) :: n_rows, n
    call default_scene()
    CHECK_OK(stickslip_interface_sums(s%contact, s%x1, s%x2, sums))
    call scene_tangent(s, t, c_loc(sums))
    call make(STICKSLIP_PLAN_ACTIVE_SUMS, n_rows, n)
    CHECK(n == t%n)
    call check_entries(STICKSLIP_ENTRIES_TANGENT, n_rows, n)
    CHECK(all(rows(:n) == t%rows) .and. all(columns(:n) == t%columns))
    CHECK_OK(fill(c_loc(sums), n))
    CHECK(as_triplets(n))
    call make(STICKSLIP_PLAN_SKIN, n_rows, n)
    CHECK_OK(fill(c_loc(sums), n))
    call scene_destroy(s)
  end subroutine

  ! A piece of the condensed matrix, its duplicates added up.
  function piece(which) result(k)
    integer(c_int32_t), intent(in) :: which
    real(c_double) :: k(UNKNOWNS, UNKNOWNS)
    integer(c_int64_t), parameter :: ROOM = 100000
    integer(c_int32_t) :: status
    call triplets_allocate(t, ROOM)
    status = stickslip_interface_condensed_coo(s%contact, s%x1, s%x2, s%lambda, which, ROOM, c_loc(t%rows), &
        c_loc(t%columns), c_loc(t%values), t%n)
    CHECK_OK(status)
    k = 0
    call triplets_add(t, int(s%options%index_base), k)
  end function

  integer(c_int32_t) function fill_condensed() result(status)
    values = none
    constraints = none
    status = stickslip_interface_condensed_values(s%contact, s%x1, s%x2, s%lambda, values, constraints)
  end function

  subroutine check_condensed(base, pairs, slide)
    integer, intent(in) :: base
    integer(c_int32_t), intent(in) :: pairs
    real(c_double), intent(in) :: slide
    integer(c_int64_t) :: n_rows(2), counts(2)
    integer(c_int32_t) :: status
    real(c_double) :: expected(UNKNOWNS, UNKNOWNS)
    call scene_init(s, base)
    s%method%multiplier_basis = STICKSLIP_BASIS_DUAL
    call scene_create(s)
    call scene_slide(s, slide)
    call scene_commit(s)
    CHECK_REFUSED(fill_condensed(), STICKSLIP_INVALID_VALUE, 'there is no plan')
    CHECK_OK(stickslip_interface_condensed_plan(s%contact, s%x1, s%x2, pairs, n_rows, counts))
    CHECK_OK(fill_condensed())
    CHECK(all(0 < counts .and. counts < MOST))
    CHECK(all(ieee_is_nan(values(counts(1) + 1:))) .and. all(ieee_is_nan(constraints(counts(2) + 1:))))
    call check_entries(STICKSLIP_ENTRIES_FORCES, n_rows(1), counts(1))
    expected = piece(STICKSLIP_CONDENSED_FORCES)
    CHECK(worst(expected) > 0)
    CHECK_NEAR(dense(counts(1), values), expected, 1d-13 * worst(expected))
    call check_entries(STICKSLIP_ENTRIES_CONSTRAINTS, n_rows(2), counts(2))
    expected = piece(STICKSLIP_CONDENSED_CONSTRAINTS)
    CHECK(worst(expected) > 0)
    CHECK_NEAR(dense(counts(2), constraints), expected, 1d-13 * worst(expected))
    ! The skin of so small a scene reaches far.
    call scene_slide(s, merge(-0.9d0, 0.6d0, slide > 0))
    status = fill_condensed()
    CHECK(status == STICKSLIP_MISSING_ENTRY .or. (pairs == STICKSLIP_PLAN_SKIN .and. status == STICKSLIP_OK))
    CHECK_OK(stickslip_interface_condensed_plan(s%contact, s%x1, s%x2, pairs, n_rows, counts))
    CHECK_OK(fill_condensed())
    call scene_destroy(s)
  end subroutine

  integer(c_int32_t) function entries_of(which, n) result(status)
    integer(c_int32_t), intent(in) :: which
    integer(c_int64_t), intent(in) :: n
    status = stickslip_interface_plan_coo(s%contact, which, n, rows, columns)
  end function

  integer(c_int32_t) function rows_of(n) result(status)
    integer(c_int64_t), intent(in) :: n
    status = stickslip_interface_plan_csr(s%contact, STICKSLIP_ENTRIES_TANGENT, n, row_list, offsets, csr_columns)
  end function

  subroutine check_refusals()
    integer(c_int64_t), parameter :: ROOM = MOST
    integer(c_int32_t), parameter :: TANGENT = STICKSLIP_ENTRIES_TANGENT
    integer(c_int64_t) :: n_rows, n
    call default_scene()
    rows = UNWRITTEN_INTEGER
    columns = UNWRITTEN_INTEGER
    offsets = UNWRITTEN_INTEGER
    rows32 = UNWRITTEN_STATE
    columns32 = UNWRITTEN_STATE
    CHECK_REFUSED(fill(c_null_ptr, ROOM), STICKSLIP_INVALID_VALUE, 'there is no plan')
    CHECK_REFUSED(entries_of(TANGENT, ROOM), STICKSLIP_INVALID_VALUE, 'there is no plan')
    call make(STICKSLIP_PLAN_ACTIVE, n_rows, n)
    CHECK_REFUSED(fill(c_null_ptr, n - 1), STICKSLIP_BUFFER_TOO_SMALL, 'capacity')
    CHECK(all(ieee_is_nan(values)))
    CHECK_REFUSED(entries_of(TANGENT, n - 1), STICKSLIP_BUFFER_TOO_SMALL, 'capacity')
    CHECK_REFUSED(rows_of(n - 1), STICKSLIP_BUFFER_TOO_SMALL, 'capacity')
    CHECK_REFUSED(entries_of(STICKSLIP_ENTRIES_FORCES, ROOM), STICKSLIP_INVALID_VALUE, 'there is no plan')
    call scene_destroy(s)

    ! Equations beyond 32 bits.
    call scene_init(s)
    s%multipliers = s%multipliers + INT32_MAX
    call scene_create(s)
    call make(STICKSLIP_PLAN_ACTIVE, n_rows, n)
    CHECK_REFUSED(stickslip_interface_plan_coo32(s%contact, TANGENT, n, rows32, columns32), STICKSLIP_INDEX_OUT_OF_RANGE, '32 bits')
    CHECK_UNTOUCHED(rows)
    CHECK_UNTOUCHED(columns)
    CHECK_UNTOUCHED(offsets)
    CHECK_UNTOUCHED(rows32)
    CHECK_UNTOUCHED(columns32)
    CHECK_OK(entries_of(TANGENT, n))
    CHECK(columns(n) > INT32_MAX)
    call scene_destroy(s)
  end subroutine

  ! Threads change no bit.
  subroutine check_threads()
    real(c_double) :: residual(UNKNOWNS, 2), found(MOST, 2)
    integer(c_int64_t) :: n_rows, n
    integer :: k
    do k = 1, 2
      call scene_init(s)
      s%method%threads = merge(2, 0, k == 2)
      call scene_create(s)
      call scene_commit(s)
      call scene_slide(s, 0.05d0)
      call scene_residual(s, residual(:, k))
      call make(STICKSLIP_PLAN_SKIN, n_rows, n)
      CHECK_OK(fill(c_null_ptr, n))
      found(:n, k) = values(:n)
      call scene_destroy(s)
    end do
    CHECK(all(same(residual(:, 1), residual(:, 2))) .and. all(same(found(:n, 1), found(:n, 2))))
  end subroutine
end program
