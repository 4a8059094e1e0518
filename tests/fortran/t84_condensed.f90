! Systems without multipliers: a made-up host with a full matrix takes the step that the system with multipliers takes,
! be its matrix condensed in place or in pieces, and gets the multipliers back; with carried nodes and without. The pattern
! has all entries, carriers' weights add up to 1, and a node's own rows are those of the stateless stage.
#include "check.inc"
program t84_condensed
  use, intrinsic :: iso_c_binding
  use check
  use scenes
  use stickslip
  implicit none
  ! Steps of two factorisations of one system, relative to the largest entry: the system's condition times rounding.
  real(c_double), parameter :: SAME_STEP = 1d-12
  ! Sums of a few hundred products, relative to the largest entry.
  real(c_double), parameter :: ROUNDING = 1d-13
  integer, parameter :: N = POSITIONS
  integer(c_int32_t), parameter :: KINDS(2) = [STICKSLIP_WEIGHTS_CURRENT, STICKSLIP_WEIGHTS_COMMITTED]
  type(scene), target, save :: s
  type(triplets), target, save :: t
  ! The host's own matrix, host(row, column), and residual; a full matrix in rows.
  real(c_double), save :: host(N, N), r(N)
  integer(c_int64_t), save :: offsets(N + 1), columns(N * N)
  logical :: carried
  integer :: k, c

  offsets = [(1_c_int64_t + k * N, k = 0, N)]
  columns = [(1_c_int64_t + mod(k, N), k = 0, N * N - 1)]
  do c = 0, 1
    carried = c == 1
    do k = 1, 2
      call set_up(KINDS(k))
      call check_step()
      call check_reduction(KINDS(k) == STICKSLIP_WEIGHTS_COMMITTED)
      call check_pattern()
      call check_carriers()
      if (.not. carried .and. KINDS(k) == STICKSLIP_WEIGHTS_CURRENT) call check_nodes()
      call scene_destroy(s)
    end do
  end do

contains

  ! Moves within a step; where carried, off the other surface's edge. The multipliers are those in force.
  subroutine set_up(weights)
    integer(c_int32_t), intent(in) :: weights
    integer(c_int64_t) :: seed
    integer :: i, j
    seed = 84
    call scene_init(s)
    s%method%multiplier_basis = STICKSLIP_BASIS_DUAL
    s%method%weak_coverage = merge(0.5d0, STICKSLIP_WEAK_COVERAGE_NONE, carried)
    s%method%weights = weights
    call scene_create(s)
    if (carried) call scene_slide(s, 0.9d0)
    call scene_commit(s)
    call scene_slide(s, 0.02d0)
    do j = 1, N
      do i = 1, N
        host(i, j) = draw(seed) + merge(20, 0, i == j)
      end do
      r(j) = 0.05d0 * draw(seed)
    end do
    CHECK_OK(stickslip_interface_condensed_multipliers(s%contact, s%x1, s%x2, r, s%lambda))
  end subroutine

  ! x = k^-1 right. Gauss with row exchanges.
  function solved(k, right) result(x)
    real(c_double), intent(in) :: k(:, :), right(:)
    real(c_double) :: x(size(right)), m(size(right), size(right) + 1), row(size(right) + 1)
    integer :: i, j, pivot
    m(:, :size(right)) = k
    m(:, size(right) + 1) = right
    do j = 1, size(right)
      pivot = j - 1 + maxloc(abs(m(j:, j)), 1)
      CHECK(m(pivot, j) /= 0)
      row = m(j, :)
      m(j, :) = m(pivot, :)
      m(pivot, :) = row
      do i = j + 1, size(right)
        m(i, j:) = m(i, j:) - m(i, j) / m(j, j) * m(j, j:)
      end do
    end do
    do i = size(right), 1, -1
      x(i) = (m(i, size(right) + 1) - dot_product(m(i, i + 1:size(right)), x(i + 1:))) / m(i, i)
    end do
  end function

  ! A piece of the condensed matrix.
  function piece(which) result(m)
    integer(c_int32_t), intent(in) :: which
    real(c_double) :: m(N, N)
    integer(c_int32_t) :: status
    integer(c_int64_t) :: counted, e
    logical :: moving
    type(c_ptr), parameter :: none = c_null_ptr
    status = stickslip_interface_condensed_coo(s%contact, s%x1, s%x2, s%lambda, which, 0_c_int64_t, none, none, none, counted)
    CHECK_OK(status)
    ! Forces at given multipliers do not move with the bodies where weights are frozen.
    moving = which /= STICKSLIP_CONDENSED_FORCES .or. s%method%weights == STICKSLIP_WEIGHTS_CURRENT
    CHECK((counted > 0) .eqv. moving)
    call triplets_allocate(t, counted)
    status = stickslip_interface_condensed_coo(s%contact, s%x1, s%x2, s%lambda, which, counted, c_loc(t%rows), &
        c_loc(t%columns), c_loc(t%values), t%n)
    CHECK_OK(status)
    CHECK(t%n == counted .and. all(1 <= t%rows .and. t%rows <= N .and. 1 <= t%columns .and. t%columns <= N))
    m = 0
    do e = 1, t%n
      m(t%rows(e), t%columns(e)) = m(t%rows(e), t%columns(e)) + t%values(e)
    end do
  end function

  ! The condensed matrix of a full one, in place.
  function condensed(k) result(m)
    real(c_double), intent(in) :: k(N, N)
    real(c_double) :: m(N, N), values(N * N)
    values = reshape(transpose(k), [N * N])
    CHECK_OK(call_csr(offsets, columns, values))
    m = transpose(reshape(values, [N, N]))
  end function

  integer(c_int32_t) function call_csr(offsets_, columns_, values) result(status)
    integer(c_int64_t), intent(in) :: offsets_(:), columns_(:)
    real(c_double), intent(inout) :: values(:)
    status = stickslip_interface_condensed_csr(s%contact, s%x1, s%x2, s%lambda, int(N, c_int64_t), offsets_, columns_, values)
  end function

  real(c_double) function difference(found, expected)
    real(c_double), intent(in) :: found(:), expected(:)
    difference = worst(found - expected) / worst(expected)
  end function

  subroutine check_step()
    real(c_double) :: k(UNKNOWNS, UNKNOWNS), all_rows(UNKNOWNS), x(UNKNOWNS), in_place(N, N), l(N, N), j(N, N), du(N)
    real(c_double) :: rows(N), force2(SIZE2), found(SIZE1), pieces(N, N), after(SIZE1)
    ! The system with multipliers.
    call scene_dense(s, t, k)
    k(:N, :N) = k(:N, :N) + host
    call scene_residual(s, all_rows)
    all_rows(:N) = all_rows(:N) + r
    x = -solved(k, all_rows)
    after = reshape(s%lambda, [SIZE1]) + x(N + 1:)

    rows = r
    CHECK_OK(stickslip_interface_condensed_residual(s%contact, s%x1, s%x2, s%lambda, r, rows, force2))
    rows(SIZE1 + 1:) = rows(SIZE1 + 1:) + force2
    in_place = condensed(host)
    du = -solved(in_place, rows)
    CHECK(difference(du, x(:N)) <= SAME_STEP)

    j = host + piece(STICKSLIP_CONDENSED_FORCES)
    l = piece(STICKSLIP_CONDENSED_ELIMINATION)
    pieces = j + matmul(l, j) + piece(STICKSLIP_CONDENSED_CONSTRAINTS)
    CHECK(difference(reshape(pieces, [N * N]), reshape(in_place, [N * N])) <= ROUNDING)

    rows = r + matmul(j, du)
    CHECK_OK(stickslip_interface_condensed_multipliers(s%contact, s%x1, s%x2, rows, found))
    CHECK(difference(found, after) <= SAME_STEP)
  end subroutine

  ! The reduced form has the condensed system's step; with frozen weights its constraints are its diagonal's.
  subroutine check_reduction(frozen)
    logical, intent(in) :: frozen
    real(c_double) :: rows(N), force2(SIZE2), left(N, N), right(N, N), matrix(N, N), x(N), v(N), diagonal(N, N)
    rows = r
    CHECK_OK(stickslip_interface_condensed_residual(s%contact, s%x1, s%x2, s%lambda, r, rows, force2))
    rows(SIZE1 + 1:) = rows(SIZE1 + 1:) + force2
    matrix = condensed(host)
    x = solved(matrix, rows)
    left = piece(STICKSLIP_CONDENSED_REDUCTION_ROWS)
    right = piece(STICKSLIP_CONDENSED_REDUCTION_COLUMNS)
    matrix = matrix + matmul(left, matrix)
    matrix = matrix + matmul(matrix, right)
    v = solved(matrix, rows + matmul(left, rows))
    CHECK(difference(v + matmul(right, v), x) <= SAME_STEP)
    if (.not. frozen) return
    diagonal = piece(STICKSLIP_CONDENSED_CONSTRAINT_DIAGONAL)
    matrix = matmul(piece(STICKSLIP_CONDENSED_CONSTRAINED), matrix)
    CHECK(difference(reshape(matrix, [N * N]), reshape(diagonal, [N * N])) <= ROUNDING)
  end subroutine

  ! Each node is coupled to itself and to the one after the next: a sparse host's condensed matrix has no entry that is
  ! neither its own nor in the pattern.
  subroutine check_pattern()
    logical :: known(N, N)
    integer(c_int64_t) :: starts(N + 1), listed(N * N), e, count
    integer(c_int32_t) :: status
    real(c_double) :: k(N, N), values(N * N), before(N * N)
    integer :: i, j, places
    places = 0
    starts(1) = 1
    values = 0
    do i = 1, N
      do j = 1, N
        known(i, j) = (i - 1) / 3 == (j - 1) / 3 .or. abs(i - j) == 6
        if (.not. known(i, j)) cycle
        places = places + 1
        listed(places) = j
        values(places) = host(i, j)
      end do
      starts(i + 1) = places + 1
    end do
    before = values
    CHECK_REFUSED(call_csr(starts, listed(:places), values(:places)), STICKSLIP_MISSING_ENTRY, 'pattern')
    CHECK(all(same(values, before)))
    status = stickslip_interface_condensed_pattern(s%contact, s%x1, s%x2, int(N, c_int64_t), starts, listed, 0_c_int64_t, &
        c_null_ptr, c_null_ptr, count)
    CHECK_OK(status)
    CHECK(count > 0)
    call triplets_allocate(t, count)
    status = stickslip_interface_condensed_pattern(s%contact, s%x1, s%x2, int(N, c_int64_t), starts, listed, count, &
        c_loc(t%rows), c_loc(t%columns), t%n)
    CHECK_OK(status)
    CHECK(t%n == count)
    k = condensed(merge(host, 0d0, known))
    do e = 1, t%n
      known(t%rows(e), t%columns(e)) = .true.
    end do
    CHECK(all(known .or. k == 0) .and. .not. all(known))
  end subroutine

  subroutine check_carriers()
    real(c_double) :: total(NA)
    integer(c_int32_t) :: status
    integer(c_int64_t) :: e
    status = stickslip_interface_carriers(s%contact, 0_c_int64_t, c_null_ptr, c_null_ptr, c_null_ptr, t%n)
    CHECK_OK(status)
    CHECK((t%n > 0) .eqv. carried)
    call triplets_allocate(t, t%n)
    status = stickslip_interface_carriers(s%contact, t%n, c_loc(t%rows), c_loc(t%columns), c_loc(t%values), t%n)
    CHECK_OK(status)
    total = 0
    do e = 1, t%n
      total(t%rows(e)) = total(t%rows(e)) + t%values(e)
    end do
    CHECK(all(total(t%columns) == 0))
    CHECK(all(t%rows(2:) >= t%rows(:size(t%rows) - 1)))
    CHECK(all(total == 0 .or. abs(total - 1) <= ROUNDING))
  end subroutine

  ! The stateless stage, from the sums of this handle: W of every node, s c, s.
  subroutine check_nodes()
    real(c_double), target :: sums(STICKSLIP_SUMS_PER_NODE, NA), normal(3, NA), r_a(NA), w(3, 3), columns_(3, 3), row(3), scale
    real(c_double) :: l(N, N), rows1(3, NA), force2(SIZE2), identity(3, 3)
    integer(c_int32_t), target :: state(NA)
    integer(c_int32_t) :: status
    type(stickslip_states) :: states
    type(stickslip_node) :: node
    type(stickslip_node_response) :: response
    integer :: a, i
    identity = reshape([1, 0, 0, 0, 1, 0, 0, 0, 1], [3, 3])
    l = piece(STICKSLIP_CONDENSED_ELIMINATION)
    CHECK_OK(stickslip_interface_sums(s%contact, s%x1, s%x2, sums))
    states = stickslip_states(state=c_loc(state), normal=c_loc(normal), augmentation=c_loc(r_a))
    CHECK_OK(stickslip_interface_states(s%contact, s%x1, s%x2, s%lambda, c_null_ptr, states))
    CHECK_OK(stickslip_interface_condensed_residual(s%contact, s%x1, s%x2, s%lambda, r, rows1, force2))
    do a = 1, NA
      node = stickslip_node(augmentation=r_a(a), mu=s%options%mu, coverage=sums(1, a), coverage_previous=sums(5, a), &
          coverage_min=1d-8, lambda=s%lambda(:, a), normal=normal(:, a), gap_now=sums(2:4, a), gap_previous=sums(6:8, a), &
          gap_committed=sums(9:11, a))
      response = stickslip_node_response()
      CHECK_OK(stickslip_node_respond(node, response))
      status = stickslip_node_condense(node, response, STICKSLIP_LAYOUT_COLUMN_MAJOR, c_loc(w), c_loc(row), c_loc(scale))
      CHECK_OK(status)
      status = stickslip_node_condense(node, response, STICKSLIP_LAYOUT_ROW_MAJOR, c_loc(columns_), c_null_ptr, c_null_ptr)
      CHECK_OK(status)
      i = 3 * a - 2
      CHECK_NEAR(scale / (r_a(a) * sums(1, a)), 1d0, ROUNDING)
      CHECK_NEAR(w, identity + l(i:i + 2, i:i + 2), ROUNDING)
      CHECK(all(same(w, transpose(columns_))))
      ! With the multipliers in force the forces' rows vanish, and the constraints remain.
      CHECK_NEAR(row, rows1(:, a), ROUNDING)
      node%coverage = 0
      status = stickslip_node_condense(node, response, STICKSLIP_LAYOUT_COLUMN_MAJOR, c_loc(w), c_loc(row), c_loc(scale))
      CHECK_OK(status)
      CHECK(all(w == identity) .and. all(row == 0) .and. scale == 0)
    end do
    CHECK(any(state == STICKSLIP_STATE_GAP) .and. any(state /= STICKSLIP_STATE_GAP))
  end subroutine
end program
