! General contact: two cubes as one skin. Copies, sides, forces, the tangent against differences, steps and their undoing, restarts,
! pairs that do not see each other; what is refused.
#include "check.inc"
program t99_skin
  use, intrinsic :: ieee_arithmetic
  use, intrinsic :: iso_c_binding
  use check
  use scenes
  use stickslip
  implicit none

  ! Nodes, facets and copies of two cubes, and the facets that touch: of the lower one its top, of the upper one its bottom.
  integer, parameter :: NODES = 16, FACETS = 12, COPIES = 48, SIZEX = 3 * NODES, SIZEL = 3 * COPIES, ALL_OF_IT = SIZEX + SIZEL
  integer, parameter :: LOWER_TOP = 2, UPPER_BOTTOM = 7, MOST = 2000
  integer(c_int64_t), parameter :: LOWER = 7, UPPER = -3
  real(c_double), parameter :: OVERLAP = 1d-3
  real(c_double), parameter :: BALANCE = 1d-15     ! of sums of forces, over the sum of their sizes
  real(c_double), parameter :: ROUND = 1d-14
  real(c_double), parameter :: DIFFERENCES = 1d-7  ! of entries against central differences, of the largest of their block
  real(c_double), parameter :: STEP = 1d-6         ! of the differences: rounding of forces of size 1 gives 1e-10

  real(c_double), target, save :: reference(SIZEX), x(SIZEX), lambda(SIZEL)
  integer(c_int64_t), target, save :: offsets(FACETS + 1), corners(4, FACETS), equations(SIZEX), bodies(FACETS)
  integer(c_int32_t), target, save :: side(FACETS)
  integer(c_int64_t), target, save :: piece(FACETS), partner(FACETS), body(FACETS), originals(COPIES), own(3, COPIES)
  real(c_double), target, save :: distance(FACETS)
  type(stickslip_surface), save :: surface
  type(stickslip_options), save :: options
  type(stickslip_skin), save :: skin
  integer :: base

  do base = 0, 1
    call check_found()
    call check_tangent()
  end do
  base = 1
  call check_balance()
  call check_steps()
  call check_pairs()
  call check_aids()
  call check_refusals()

contains

  ! Moves the nodes of the upper cube in the scene's frame.
  subroutine move(y, right, back, up)
    real(c_double), intent(inout) :: y(SIZEX)
    real(c_double), intent(in) :: right, back, up
    real(c_double) :: d(3)
    integer :: a
    d = [right, back, up]
    call scene_frame(d)
    do a = NODES / 2 + 1, NODES
      y(3 * a - 2:3 * a) = y(3 * a - 2:3 * a) + d
    end do
  end subroutine

  ! Fills everything but the handle. x: the first configuration with a small motion of every node; lambda presses and shears.
  subroutine init()
    integer, parameter :: QUADS(4, 6) = reshape([0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5], [4, 6])
    integer(c_int64_t) :: random
    real(c_double) :: p(3)
    integer :: a, f, i
    random = 11
    do a = 1, NODES
      p = [(real(ibits(mod(a - 1, 8), i, 1), c_double), i = 0, 2)]
      call scene_frame(p)
      reference(3 * a - 2:3 * a) = p
    end do
    call move(reference, 0.24d0, 0.18d0, 1 - OVERLAP)
    offsets = [(int(4 * f, c_int64_t), f = 0, FACETS)]
    do f = 1, FACETS
      corners(:, f) = base + QUADS(:, mod(f - 1, 6) + 1) + 8 * ((f - 1) / 6)
      bodies(f) = merge(LOWER, UPPER, f <= 6)
    end do
    do i = 1, SIZEX
      x(i) = reference(i) + 1d-4 * draw(random)
      equations(i) = base + i - 1
    end do
    do a = 1, COPIES
      p = [0.1d0 * draw(random), 0.1d0 * draw(random), draw(random)]
      call scene_frame(p)
      lambda(3 * a - 2:3 * a) = p
    end do
    surface = stickslip_surface(n_nodes=NODES, n_facets=FACETS, coordinates=c_loc(reference), facet_offsets=c_loc(offsets), &
        facet_nodes=c_loc(corners), equations=c_loc(equations))
    CHECK_OK(stickslip_options_init(options, stickslip_options_size))
    options%index_base = int(base, c_int32_t)
    options%mu = 0.4d0
    options%modulus = 100
  end subroutine

  integer(c_int32_t) function make(first)
    integer, intent(in) :: first
    make = stickslip_skin_create(surface, c_loc(bodies), int(first, c_int64_t), options, skin)
  end function

  subroutine create()
    call init()
    CHECK_OK(make(base + SIZEX))
  end subroutine

  subroutine residual(r)
    real(c_double), intent(out) :: r(ALL_OF_IT)
    r = 0
    CHECK_OK(stickslip_skin_residual(skin, x, lambda, r(:SIZEX), r(SIZEX + 1:)))
  end subroutine

  subroutine ask()
    integer(c_int64_t) :: count, multipliers
    CHECK_OK(stickslip_skin_facets(skin, sides()))
    CHECK_OK(stickslip_skin_copies(skin, 0_c_int64_t, c_null_ptr, c_null_ptr, count, multipliers))
    CHECK(count == COPIES .and. multipliers == SIZEL)
    CHECK_OK(copies_in(COPIES, count))
  end subroutine

  integer(c_int32_t) function copies_in(room, count)
    integer, intent(in) :: room
    integer(c_int64_t), intent(inout) :: count
    integer(c_int64_t) :: multipliers
    copies_in = stickslip_skin_copies(skin, int(room, c_int64_t), c_loc(originals), c_loc(own), count, multipliers)
  end function

  type(stickslip_skin_sides) function sides()
    sides = stickslip_skin_sides(side=c_loc(side), piece=c_loc(piece), partner=c_loc(partner), distance=c_loc(distance), &
        body=c_loc(body))
  end function

  subroutine destroy()
    CHECK_OK(stickslip_skin_destroy(skin))
    CHECK_OK(stickslip_skin_destroy(skin))
  end subroutine

  subroutine take(h)
    type(history), intent(out) :: h
    h%integers = 0
    h%reals = 0
    CHECK_OK(stickslip_skin_history_size(skin, h%n_integers, h%n_reals))
    CHECK(h%n_integers <= size(h%integers) .and. h%n_reals <= size(h%reals))
    CHECK_OK(stickslip_skin_history_export(skin, h%n_integers, h%integers, h%n_reals, h%reals))
  end subroutine

  subroutine check_found()
    type(stickslip_skin_summary) :: now
    integer(c_int64_t) :: count
    integer :: a, f
    logical :: touches
    call create()
    call ask()
    do a = 1, COPIES
      CHECK(a > NODES .or. originals(a) == base + a - 1)
      CHECK(all(own(:, a) == base + SIZEX + 3 * (a - 1) + [0, 1, 2]))
    end do
    do a = base, base + NODES - 1
      CHECK(count_of(a) == 3)
    end do
    count = UNWRITTEN_INTEGER
    CHECK_REFUSED(copies_in(COPIES - 1, count), STICKSLIP_BUFFER_TOO_SMALL, 'copies')
    CHECK(count == UNWRITTEN_INTEGER)
    do f = 1, FACETS
      touches = f == LOWER_TOP .or. f == UPPER_BOTTOM
      CHECK((side(f) /= STICKSLIP_SKIN_NONE) .eqv. touches)
      CHECK(piece(f) == merge(0, -1, side(f) == STICKSLIP_SKIN_NONMORTAR))
      CHECK(partner(f) == merge(base - 1 + merge(UPPER_BOTTOM, LOWER_TOP, f == LOWER_TOP), -1, touches))
      CHECK_NEAR(distance(f), merge(-OVERLAP, 0d0, touches), ROUND)
      CHECK(body(f) == bodies(f))
    end do
    CHECK_OK(stickslip_skin_report(skin, now))
    CHECK(now%bodies == 2 .and. now%pieces == 1 .and. now%pairs == 1 .and. now%contradictions == 0)
    CHECK(now%made == 1 .and. now%exchanged == 0 .and. now%missed == 0)
    call destroy()
    ! What hangs together is one body, numbered from 0.
    CHECK_OK(stickslip_skin_create(surface, c_null_ptr, int(base + SIZEX, c_int64_t), options, skin))
    call ask()
    CHECK(all(body(:FACETS / 2) == 0) .and. all(body(FACETS / 2 + 1:) == 1))
    call destroy()
  end subroutine

  integer function count_of(node)
    integer, intent(in) :: node
    count_of = count(originals == node)
  end function

  ! Forces sum up to nothing, and there are some; copies that touch nothing say that their multipliers are zero.
  subroutine check_balance()
    real(c_double) :: r(ALL_OF_IT), force(3, NODES), rows(3, COPIES), l(3, COPIES)
    real(c_double), target :: area(COPIES)
    integer :: i, a
    call create()
    call residual(r)
    force = reshape(r(:SIZEX), [3, NODES])
    rows = reshape(r(SIZEX + 1:), [3, COPIES])
    l = reshape(lambda, [3, COPIES])
    CHECK(sum(abs(force)) > 0.1d0)
    do i = 1, 3
      CHECK_NEAR(sum(force(i, :)), 0d0, BALANCE * sum(abs(force)))
    end do
    CHECK_OK(stickslip_skin_states(skin, x, lambda, stickslip_states(area=c_loc(area))))
    CHECK(count(area > 0) == 4)
    do a = 1, COPIES
      if (area(a) > 0) cycle
      CHECK_NEAR(rows(:, a), -0.25d0 * l(:, a), ROUND)
    end do
    call destroy()
  end subroutine

  ! Entries of the same row and column add up.
  subroutine check_tangent()
    real(c_double), allocatable :: k(:, :), d(:, :)
    real(c_double) :: plus(ALL_OF_IT), minus(ALL_OF_IT), values(MOST), start(SIZEL), largest, error
    integer(c_int64_t) :: count, rows(MOST), columns(MOST)
    integer(c_int32_t) :: rows32(MOST), columns32(MOST)
    integer :: e, j, p, q
    integer, parameter :: ENDS(3) = [0, SIZEX, ALL_OF_IT]
    allocate (k(ALL_OF_IT, ALL_OF_IT), d(ALL_OF_IT, ALL_OF_IT), source=0d0)
    call create()
    start = lambda
    CHECK_OK(stickslip_skin_commit(skin, reference, lambda))
    lambda = start
    CHECK_OK(stickslip_skin_plan(skin, x, STICKSLIP_PLAN_SKIN, count))
    CHECK(0 < count .and. count <= MOST)
    CHECK_OK(stickslip_skin_plan_coo(skin, count, rows, columns))
    CHECK_OK(stickslip_skin_plan_coo32(skin, count, rows32, columns32))
    CHECK_OK(stickslip_skin_plan_values(skin, x, lambda, count, values))
    do e = 1, int(count)
      CHECK(rows(e) == rows32(e) .and. columns(e) == columns32(e))
      k(rows(e) - base + 1, columns(e) - base + 1) = k(rows(e) - base + 1, columns(e) - base + 1) + values(e)
    end do
    do j = 1, ALL_OF_IT
      call shift(j, STEP)
      call residual(plus)
      call shift(j, -2 * STEP)
      call residual(minus)
      call shift(j, STEP)
      d(:, j) = (plus - minus) / (2 * STEP)
    end do
    k = k - d
    do p = 1, 2
      do q = 1, 2
        largest = maxval(abs(d(ENDS(p) + 1:ENDS(p + 1), ENDS(q) + 1:ENDS(q + 1))))
        error = maxval(abs(k(ENDS(p) + 1:ENDS(p + 1), ENDS(q) + 1:ENDS(q + 1))))
        CHECK(largest > 1d-3)
        CHECK_NEAR(error / largest, 0d0, DIFFERENCES)
      end do
    end do
    call destroy()
  end subroutine

  subroutine shift(j, by)
    integer, intent(in) :: j
    real(c_double), intent(in) :: by
    if (j <= SIZEX) then
      x(j) = x(j) + by
    else
      lambda(j - SIZEX) = lambda(j - SIZEX) + by
    end if
  end subroutine

  ! A commit, its undoing, an export and its import leave the bits of histories, and what comes after them.
  subroutine check_steps()
    type(history), save :: first, second, now
    real(c_double) :: after(ALL_OF_IT), again(ALL_OF_IT)
    call create()
    CHECK_OK(stickslip_skin_initial_multipliers(skin, lambda))
    CHECK(any(abs(lambda) > 0))
    CHECK_REFUSED(stickslip_skin_rollback(skin), STICKSLIP_NOTHING_TO_ROLL_BACK, 'no commit can be undone')
    CHECK_OK(stickslip_skin_commit(skin, reference, lambda))
    call take(first)
    CHECK_OK(stickslip_skin_commit(skin, x, lambda))
    call take(second)
    CHECK(.not. history_equal(first, second))
    call move(x, 2d-3, 1d-3, -1d-4)
    call residual(after)
    CHECK_OK(stickslip_skin_rollback(skin))
    call take(now)
    CHECK(history_equal(first, now))
    CHECK_OK(stickslip_skin_exchange(skin, lambda))
    CHECK_OK(stickslip_skin_exchange(skin, lambda))
    CHECK_OK(import_of(second))
    call take(now)
    CHECK(history_equal(second, now))
    call residual(again)
    CHECK_NEAR(after, again, ROUND)
    now%reals(1) = now%reals(1) + 1
    CHECK_REFUSED(import_of(now), STICKSLIP_HISTORY_MISMATCH, 'changed')
    call destroy()
  end subroutine

  integer(c_int32_t) function import_of(h)
    type(history), intent(in) :: h
    import_of = stickslip_skin_history_import(skin, h%n_integers, h%integers, h%n_reals, h%reals)
  end function

  subroutine check_pairs()
    real(c_double) :: r(ALL_OF_IT), first(ALL_OF_IT)
    call create()
    call residual(first)
    CHECK_OK(stickslip_skin_set_pair(skin, UPPER, LOWER, STICKSLIP_SKIN_APART))
    call residual(r)
    CHECK(all(same(r(:SIZEX), 0 * r(:SIZEX))))
    CHECK_OK(stickslip_skin_set_pair(skin, LOWER, UPPER, options%mu))
    call residual(r)
    CHECK(all(same(r, first)))
    CHECK_REFUSED(stickslip_skin_set_pair(skin, 0_c_int64_t, UPPER, 0.1d0), STICKSLIP_INVALID_VALUE, 'body1 is 0')
    CHECK_REFUSED(stickslip_skin_set_pair(skin, LOWER, UPPER, -0.5d0), STICKSLIP_INVALID_VALUE, 'mu is -0.5')
    call destroy()
  end subroutine

  ! How far a step may go, normals, how multipliers turn, directions, the distance from equilibrium.
  subroutine check_aids()
    real(c_double) :: dx(SIZEX), fraction, turned(SIZEL), r(ALL_OF_IT), with(ALL_OF_IT), across(3), start(SIZEL)
    type(stickslip_equilibrium) :: e
    call create()
    dx = 0
    call move(dx, 0d0, 0d0, -2d0)
    CHECK_OK(stickslip_skin_step_limit(skin, x, dx, 0.5d0, fraction))
    CHECK(0 < fraction .and. fraction < 1)
    start = lambda
    CHECK_OK(stickslip_skin_commit(skin, reference, lambda))
    lambda = start
    turned = lambda
    CHECK_OK(stickslip_skin_turn_multipliers(skin, reference, turned))
    CHECK_NEAR(turned, lambda, ROUND)
    call residual(r)
    CHECK_OK(stickslip_skin_use_normals(skin, STICKSLIP_NORMALS_COMMITTED))
    call residual(with)
    CHECK(.not. all(same(r, with)))
    CHECK_REFUSED(stickslip_skin_commit(skin, x, lambda), STICKSLIP_INVALID_VALUE, 'normals')
    CHECK_OK(stickslip_skin_use_normals(skin, STICKSLIP_NORMALS_CURRENT))
    across = [1, 0, 0]
    call scene_frame(across)
    CHECK_OK(constrain(5, across))
    call residual(with)
    CHECK(.not. all(same(r, with)))
    CHECK_REFUSED(constrain(NODES, across), STICKSLIP_INDEX_OUT_OF_RANGE, 'nodes[0] is 17')
    e%modulus = options%modulus
    CHECK_OK(stickslip_skin_equilibrium(skin, reference, lambda, e))
    CHECK_NEAR(e%gap, OVERLAP, 1d-12)
    call destroy()
  end subroutine

  integer(c_int32_t) function constrain(node, direction)
    integer, intent(in) :: node
    real(c_double), intent(in) :: direction(3)
    constrain = stickslip_skin_set_constraints(skin, 1_c_int64_t, [int(base + node, c_int64_t)], direction)
  end function

  subroutine check_refusals()
    real(c_double) :: r(ALL_OF_IT)
    integer(c_int64_t) :: count
    call init()
    CHECK_REFUSED(make(base + SIZEX - 1), STICKSLIP_INVALID_VALUE, 'that of a displacement')
    CHECK_REFUSED(make(base - 1), STICKSLIP_INVALID_VALUE, 'first_multiplier')
    options%mortar_side = STICKSLIP_MORTAR_ANALYTIC
    CHECK_REFUSED(make(base + SIZEX), STICKSLIP_UNSUPPORTED, 'options.mortar_side')
    call create()
    r = UNWRITTEN
    x(4) = ieee_value(x(4), ieee_quiet_nan)
    CHECK_REFUSED(stickslip_skin_residual(skin, x, lambda, r(:SIZEX), r(SIZEX + 1:)), STICKSLIP_NOT_FINITE, 'x[3]')
    CHECK_REFUSED(stickslip_skin_plan_values(skin, reference, lambda, 2000_c_int64_t, r), STICKSLIP_MISSING_ENTRY, 'plan')
    CHECK_REFUSED(stickslip_skin_plan(skin, reference, STICKSLIP_PLAN_ACTIVE_SUMS, count), STICKSLIP_INVALID_VALUE, 'pairs')
    CHECK_UNTOUCHED(r)
    call destroy()
    CHECK_REFUSED(stickslip_skin_rollback(skin), STICKSLIP_NULL_POINTER, 'skin')
  end subroutine
end program
