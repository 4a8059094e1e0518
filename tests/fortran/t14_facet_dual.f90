! Dual multipliers from the stages, by a host: 2 x 2 non-mortar quads with nine pairs each. Stage 1b turns each pair's
! weights; then the calls of pairs and nodes go on as with the standard basis, and the tangent is assembled facet by facet.
! Residual and tangent equal those of an interface handle, and central differences of the host's own residual. The surfaces
! slide until facets are covered in part, hardly, and not at all.
#include "check.inc"
program t14_facet_dual
  use, intrinsic :: iso_c_binding
  use check
  use pairs
  use scenes
  use stickslip
  implicit none
  integer, parameter :: FACETS = 4, PAIRS_ = 9, BLOCKS = 8 + 4 * PAIRS_, ROWS = 3 * BLOCKS, LD = ROWS + 5
  ! Rounding of the same sums in another order, relative to the largest number of a block.
  real(c_double), parameter :: ROUNDING = 1d-12
  ! Central differences: truncation 1e-9 of the largest entry, and 1e-8 where a facet fades out.
  real(c_double), parameter :: STEP = 1d-6, DIFFERENCES = 1d-7
  ! Of a few sums, relative to the largest coefficient and weight.
  real(c_double), parameter :: FEW = 1d-15
  real(c_double), parameter :: SLIDES(5) = [0d0, 0.3d0, 0.8d0, 0.89d0, 1.1d0]

  ! A facet with its pairs at one configuration; weights as the library writes them, (b, a) and (c, a).
  type patch
    real(c_double) :: x1(3, 4), x2(3, 4, PAIRS_), mass(4, 4), n_ab(4, 4, PAIRS_), n_ac(4, 4, PAIRS_)
    real(c_double) :: dual_ab(4, 4, PAIRS_), dual_ac(4, 4, PAIRS_)
    type(stickslip_pair) :: pairs(PAIRS_)
  end type

  type(scene), target, save :: s
  type(patch), target, save :: now(FACETS), before(FACETS)
  integer :: n, states(0:2), faded, partly
  states = 0
  faded = 0
  partly = 0
  do n = 1, size(SLIDES)
    call check_slide(SLIDES(n), .false.)
  end do
  CHECK(all(states > 0) .and. faded > 0 .and. partly > 0)
  call check_slide(0.05d0, .true.)

contains

  ! The unknowns of a facet: its nodes, those of the mortar facets, its multipliers.
  function unknowns_of(f)
    integer, intent(in) :: f
    integer :: unknowns_of(ROWS), nodes(BLOCKS), b
    nodes = int([s%nodes1(:, f), NA + reshape(s%nodes2, [4 * PAIRS_]), NA + NC + s%nodes1(:, f)])
    do b = 1, BLOCKS
      unknowns_of(3 * b - 2:3 * b) = 3 * nodes(b) - [2, 1, 0]
    end do
  end function

  ! Stages 1 and 1b.
  subroutine integrate(x1, x2, patches)
    real(c_double), intent(in) :: x1(3, NA), x2(3, NC)
    type(patch), target, intent(inout) :: patches(FACETS)
    integer :: f, q
    integer(c_int32_t) :: status
    do f = 1, FACETS
      associate (p => patches(f))
        p%mass = 0
        p%x1 = x1(:, s%nodes1(:, f))
        do q = 1, PAIRS_
          p%x2(:, :, q) = x2(:, s%nodes2(:, q))
          p%pairs(q) = stickslip_pair(n1=4, n2=4, x1=c_loc(patches(f)%x1), x2=c_loc(patches(f)%x2(1, 1, q)))
          status = stickslip_pair_weights(p%pairs(q), c_loc(patches(f)%n_ab(1, 1, q)), c_loc(patches(f)%n_ac(1, 1, q)), &
              c_null_ptr, c_null_ptr)
          CHECK_OK(status)
          p%mass = p%mass + p%n_ab(:, :, q)
        end do
        do q = 1, PAIRS_
          status = stickslip_pair_dual(p%pairs(q), p%mass, p%n_ab(:, :, q), p%n_ac(:, :, q), &
              c_loc(patches(f)%dual_ab(1, 1, q)), c_loc(patches(f)%dual_ac(1, 1, q)))
          CHECK_OK(status)
        end do
      end associate
    end do
  end subroutine

  ! What a facet's dual basis says of itself is what it makes of the pairs' weights.
  subroutine check_basis(p, fade)
    type(patch), intent(in) :: p
    real(c_double), target, intent(out) :: fade
    real(c_double), target :: areas(4), coefficients(4, 4)
    real(c_double) :: limit, total(4, 4)
    integer :: a, q
    integer(c_int32_t) :: status
    status = stickslip_facet_dual(4, p%x1, p%mass, c_loc(fade), c_loc(areas), c_loc(coefficients))
    CHECK_OK(status)
    CHECK(0 <= fade .and. fade <= 1)
    limit = FEW * (1 + worst(coefficients)) * worst(p%mass)
    do q = 1, PAIRS_
      CHECK_NEAR(p%dual_ac(:, :, q), matmul(p%n_ac(:, :, q), coefficients), limit)
      ! Pair by pair: no momentum is lost.
      CHECK_NEAR(sum(p%dual_ac(:, :, q), 1), sum(p%dual_ab(:, :, q), 1), limit)
    end do
    total = sum(p%dual_ab, 3)
    do a = 1, 4
      total(a, a) = total(a, a) - areas(a)
    end do
    CHECK_NEAR(total, 0, limit)
  end subroutine

  ! Stages 2 to 4 from the configurations of now and of t_n, with the weights of now or, frozen, those of t_n.
  subroutine assemble(frozen, layout, r, k)
    logical, intent(in) :: frozen
    integer(c_int32_t), intent(in) :: layout
    real(c_double), intent(out) :: r(UNKNOWNS)
    real(c_double), optional, intent(out) :: k(UNKNOWNS, UNKNOWNS)
    type(patch), pointer :: w(:)
    type(stickslip_node) :: nodes(NA)
    type(stickslip_node_response) :: responses(NA)
    real(c_double), target :: of_normals(3, 4), of_areas(4), row(3), block(3, 3)
    real(c_double) :: normals(3, NA), areas(NA), scale(NA), share(3, 4), force(24)
    integer :: a, b, f, q, u(ROWS), first
    w => now
    if (frozen) w => before
    normals = 0
    areas = 0
    do f = 1, FACETS
      CHECK_OK(stickslip_facet_geometry(4, before(f)%x1, c_loc(of_normals), c_loc(of_areas)))
      do b = 1, 4
        a = int(s%nodes1(b, f))
        areas(a) = areas(a) + of_areas(b)
        normals(:, a) = normals(:, a) + of_normals(:, b)
        nodes(a)%coverage = nodes(a)%coverage + sum(w(f)%dual_ab(:, b, :))
        nodes(a)%coverage_previous = nodes(a)%coverage_previous + sum(before(f)%dual_ab(:, b, :))
      end do
      do q = 1, PAIRS_
        CHECK_OK(stickslip_pair_gap(now(f)%pairs(q), w(f)%dual_ab(:, :, q), w(f)%dual_ac(:, :, q), share))
        do b = 1, 4
          a = int(s%nodes1(b, f))
          nodes(a)%gap_now = nodes(a)%gap_now + share(:, b)
        end do
        CHECK_OK(stickslip_pair_gap(now(f)%pairs(q), before(f)%dual_ab(:, :, q), before(f)%dual_ac(:, :, q), share))
        do b = 1, 4
          a = int(s%nodes1(b, f))
          nodes(a)%gap_previous = nodes(a)%gap_previous + share(:, b)
        end do
        CHECK_OK(stickslip_pair_gap(before(f)%pairs(q), before(f)%dual_ab(:, :, q), before(f)%dual_ac(:, :, q), share))
        do b = 1, 4
          a = int(s%nodes1(b, f))
          nodes(a)%gap_committed = nodes(a)%gap_committed + share(:, b)
        end do
      end do
    end do
    do a = 1, NA
      ! What the handle measures then.
      nodes(a)%slip = merge(STICKSLIP_SLIP_INCREMENT, STICKSLIP_SLIP_OBJECTIVE, frozen)
      nodes(a)%coverage_min = 1d-8 * areas(a)
      nodes(a)%mu = merge(s%options%mu, 0d0, nodes(a)%coverage_previous > nodes(a)%coverage_min)
      nodes(a)%augmentation = s%method%augmentation / areas(a)
      nodes(a)%lambda = s%lambda(:, a)
      scale(a) = nodes(a)%augmentation * areas(a)
      CHECK_OK(stickslip_node_normal(normals(:, a), nodes(a)%normal))
      CHECK_OK(stickslip_node_respond(nodes(a), responses(a)))
    end do
    r = 0
    if (present(k)) k = 0
    do f = 1, FACETS
      u = unknowns_of(f)
      do q = 1, PAIRS_
        call pair_forces(w(f), q, s%lambda(:, s%nodes1(:, f)), force)
        r(u(:12)) = r(u(:12)) + force(:12)
        r(u(12 * q + 1:12 * q + 12)) = r(u(12 * q + 1:12 * q + 12)) + force(13:)
      end do
      if (.not. present(k)) cycle
      if (frozen) then
        call add_frozen(f, u, responses(s%nodes1(:, f)), scale(s%nodes1(:, f)), layout, k)
      else
        call add_tangent(f, u, responses(s%nodes1(:, f)), scale(s%nodes1(:, f)), layout, k)
      end if
    end do
    do a = 1, NA
      first = POSITIONS + 3 * (a - 1)
      CHECK_OK(stickslip_node_block(responses(a), scale(a), STICKSLIP_LAYOUT_COLUMN_MAJOR, c_loc(row), c_loc(block)))
      r(first + 1:first + 3) = row
      if (present(k)) k(first + 1:first + 3, first + 1:first + 3) = k(first + 1:first + 3, first + 1:first + 3) + block
    end do
  end subroutine

  subroutine pair_forces(p, q, lambda, force)
    type(patch), intent(in) :: p
    integer, intent(in) :: q
    real(c_double), intent(in) :: lambda(3, 4)
    real(c_double), intent(inout) :: force(24)
    CHECK_OK(stickslip_pair_residual(p%pairs(q), p%dual_ab(:, :, q), p%dual_ac(:, :, q), lambda, force))
  end subroutine

  ! Adds the tangent of a facet. Only its own entries are written.
  subroutine add_tangent(f, u, responses, scale, layout, k)
    integer, intent(in) :: f, u(ROWS)
    type(stickslip_node_response), intent(in) :: responses(4)
    real(c_double), target, intent(in) :: scale(4)
    integer(c_int32_t), intent(in) :: layout
    real(c_double), intent(inout) :: k(UNKNOWNS, UNKNOWNS)
    real(c_double), save :: tangent(LD, ROWS)
    integer(c_int32_t), target :: n2(PAIRS_)
    type(stickslip_facet) :: facet
    integer(c_int32_t) :: status
    n2 = 4
    facet = stickslip_facet(n1=4, layout=layout, n_pairs=PAIRS_, x1=c_loc(now(f)%x1), n2=c_loc(n2), x2=c_loc(now(f)%x2))
    tangent = UNWRITTEN
    status = stickslip_facet_tangent(facet, now(f)%n_ab, now(f)%n_ac, c_loc(before(f)%dual_ab), c_loc(before(f)%dual_ac), &
        s%lambda(:, s%nodes1(:, f)), responses, c_loc(scale), tangent, int(LD, c_int64_t))
    CHECK_OK(status)
    CHECK_UNTOUCHED(tangent(ROWS + 1:, :))
    call add_entries(u, layout, tangent(:ROWS, :), k)
  end subroutine

  ! The same with frozen weights, pair by pair.
  subroutine add_frozen(f, u, responses, scale, layout, k)
    integer, intent(in) :: f, u(ROWS)
    type(stickslip_node_response), intent(in) :: responses(4)
    real(c_double), target, intent(in) :: scale(4)
    integer(c_int32_t), intent(in) :: layout
    real(c_double), intent(inout) :: k(UNKNOWNS, UNKNOWNS)
    real(c_double) :: tangent(36, 36)
    type(stickslip_pair) :: pair
    type(c_ptr) :: ab, ac
    integer(c_int32_t) :: status
    integer :: q
    do q = 1, PAIRS_
      pair = now(f)%pairs(q)
      pair%layout = layout
      ab = c_loc(before(f)%dual_ab(1, 1, q))
      ac = c_loc(before(f)%dual_ac(1, 1, q))
      status = stickslip_pair_tangent(pair, ab, ac, c_null_ptr, c_null_ptr, ab, ac, s%lambda(:, s%nodes1(:, f)), responses, &
          c_loc(scale), tangent, 36_c_int64_t)
      CHECK_OK(status)
      call add_entries([u(:12), u(12 * q + 1:12 * q + 12), u(ROWS - 11:)], layout, tangent, k)
    end do
  end subroutine

  ! k of these unknowns + the tangent.
  subroutine add_entries(u, layout, tangent, k)
    integer, intent(in) :: u(:)
    integer(c_int32_t), intent(in) :: layout
    real(c_double), intent(in) :: tangent(:, :)
    real(c_double), intent(inout) :: k(UNKNOWNS, UNKNOWNS)
    integer :: i, j
    do j = 1, size(u)
      do i = 1, size(u)
        if (layout == STICKSLIP_LAYOUT_COLUMN_MAJOR) then
          k(u(i), u(j)) = k(u(i), u(j)) + tangent(i, j)
        else
          k(u(i), u(j)) = k(u(i), u(j)) + tangent(j, i)
        end if
      end do
    end do
  end subroutine

  subroutine check_slide(by, frozen)
    real(c_double), intent(in) :: by
    logical, intent(in) :: frozen
    real(c_double), save :: r(UNKNOWNS), k(UNKNOWNS, UNKNOWNS), handle_r(UNKNOWNS), handle_k(UNKNOWNS, UNKNOWNS)
    type(triplets), save :: t
    integer(c_int32_t), target :: state(NA)
    type(stickslip_states) :: out
    real(c_double), target :: fade
    real(c_double) :: least
    integer :: a, f, layout
    call scene_init(s)
    s%method%multiplier_basis = STICKSLIP_BASIS_DUAL
    s%method%weak_coverage = 0
    s%method%weights = merge(STICKSLIP_WEIGHTS_COMMITTED, STICKSLIP_WEIGHTS_CURRENT, frozen)
    call scene_create(s)
    call scene_commit(s)
    call integrate(s%x1, s%x2, before)
    call scene_slide(s, by)
    call integrate(s%x1, s%x2, now)
    least = 1
    do f = 1, FACETS
      call check_basis(now(f), fade)
      least = min(least, fade)
    end do
    if (least == 0) faded = faded + 1
    if (0 < least .and. least < 1) partly = partly + 1

    out = stickslip_states(state=c_loc(state))
    CHECK_OK(stickslip_interface_states(s%contact, s%x1, s%x2, s%lambda, c_null_ptr, out))
    do a = 1, NA
      states(state(a)) = states(state(a)) + 1
    end do
    call scene_residual(s, handle_r)
    call scene_dense(s, t, handle_k)
    do layout = 0, 1
      call assemble(frozen, int(layout, c_int32_t), r, k)
      CHECK_NEAR(r, handle_r, ROUNDING * worst(handle_r))
      CHECK(block_difference(k, handle_k, 0.01d0 * worst(handle_k)) <= ROUNDING)
    end do
    call check_differences(frozen, k)
    call scene_destroy(s)
  end subroutine

  subroutine check_differences(frozen, k)
    logical, intent(in) :: frozen
    real(c_double), intent(in) :: k(UNKNOWNS, UNKNOWNS)
    real(c_double) :: plus(UNKNOWNS), minus(UNKNOWNS), limit
    integer :: j
    limit = DIFFERENCES * worst(k)
    do j = 1, UNKNOWNS
      call moved_residual(frozen, j, STEP, plus)
      call moved_residual(frozen, j, -STEP, minus)
      CHECK_NEAR(k(:, j), (plus - minus) / (2 * STEP), limit)
    end do
  end subroutine

  ! The residual with the j-th unknown moved from where it is, and back.
  subroutine moved_residual(frozen, j, by, r)
    logical, intent(in) :: frozen
    integer, intent(in) :: j
    real(c_double), intent(in) :: by
    real(c_double), intent(out) :: r(UNKNOWNS)
    real(c_double) :: x1(3, NA), x2(3, NC), lambda(3, NA)
    integer :: node, i
    x1 = s%x1
    x2 = s%x2
    lambda = s%lambda
    node = (j + 2) / 3
    i = j - 3 * (node - 1)
    if (node <= NA) then
      s%x1(i, node) = s%x1(i, node) + by
    else if (node <= NA + NC) then
      s%x2(i, node - NA) = s%x2(i, node - NA) + by
    else
      s%lambda(i, node - NA - NC) = s%lambda(i, node - NA - NC) + by
    end if
    call integrate(s%x1, s%x2, now)
    call assemble(frozen, STICKSLIP_LAYOUT_COLUMN_MAJOR, r)
    s%x1 = x1
    s%x2 = x2
    s%lambda = lambda
  end subroutine
end program
