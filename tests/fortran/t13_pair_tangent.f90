! Stages 1 to 4 put together by a host: one non-mortar quad that slides over two mortar quads. Residual and tangent
! assembled pair by pair and node by node equal those of an interface handle, and central differences of its residual.
! In the last case the first pair overlapped at t_n only. Unknowns: x1, x2, lambda, counted from 1.
#include "check.inc"
program t13_pair_tangent
  use, intrinsic :: iso_c_binding
  use check
  use pairs
  use stickslip
  implicit none
  integer, parameter :: ONE = 12, TWO = 18, ALL_ = 2 * ONE + TWO, PAIR_SIZE = 36
  ! The same sums in nearly the same order, relative to the largest entry.
  real(c_double), parameter :: ROUNDING_RESIDUAL = 1d-15, ROUNDING_TANGENT = 1d-14
  ! Central differences: rounding 1e-16 / 1e-6, relative to the largest entry.
  real(c_double), parameter :: STEP = 1d-6, DIFFERENCE = 1d-8
  ! One product of numbers below 1.
  real(c_double), parameter :: ROUNDING_PRODUCT = 1d-16
  real(c_double), target :: at_t_n(3, 4) = &
      reshape([0.1d0, 0.2d0, 0d0, 0.1d0, 0.8d0, 0d0, 0.9d0, 0.8d0, 0d0, 0.9d0, 0.2d0, 0d0], [3, 4])
  real(c_double), target :: ground(3, 6) = reshape([0d0, 0d0, 0d0, 1d0, 0d0, 0d0, 2d0, 0d0, 0d0, &
                                                    0d0, 1d0, 0d0, 1d0, 1d0, 0d0, 2d0, 1d0, 0d0], [3, 6])
  integer(c_int64_t), target :: mortar_nodes(4, 2) = reshape([1, 2, 5, 4, 2, 3, 6, 5], [4, 2])

  ! x1, x2 and lambda node by node: node n's coordinates are x(:, n).
  type problem
    type(stickslip_interface) :: contact
    real(c_double) :: x(3, ALL_ / 3)
  end type

  call check_case(0d0, 0.5d0, STICKSLIP_STATE_STICK)
  call check_case(0.5d0, 0.5d0, STICKSLIP_STATE_SLIP)  ! both pairs now, one at t_n
  call check_case(1.03d0, 0.5d0, STICKSLIP_STATE_SLIP) ! one pair at t_n only, the other now only
  call check_leading_dimension()

contains

  subroutine create(s, slide, friction)
    type(problem), intent(inout) :: s
    real(c_double), intent(in) :: slide, friction
    integer(c_int64_t), target :: offsets(3), nodes(4), equations(ALL_)
    type(stickslip_surface) :: nonmortar, mortar
    type(stickslip_options) :: options
    type(stickslip_method), target :: method
    type(stickslip_method), pointer :: paper
    integer :: i
    offsets = [0, 4, 8]
    nodes = [1, 2, 3, 4]
    equations = [(i, i = 1, ALL_)]
    nonmortar = stickslip_surface(n_nodes=4, n_facets=1, coordinates=c_loc(at_t_n), facet_offsets=c_loc(offsets), &
        facet_nodes=c_loc(nodes), equations=c_loc(equations), multiplier_equations=c_loc(equations(ONE + TWO + 1)))
    mortar = stickslip_surface(n_nodes=6, n_facets=2, coordinates=c_loc(ground), facet_offsets=c_loc(offsets), &
        facet_nodes=c_loc(mortar_nodes), equations=c_loc(equations(ONE + 1)))
    CHECK_OK(stickslip_options_init(options, stickslip_options_size))
    CHECK_OK(stickslip_options_paper(options))
    call c_f_pointer(options%method, paper)
    method = paper
    options%method = c_loc(method)
    options%index_base = 1
    options%mu = friction
    method%augmentation = 20
    CHECK_OK(stickslip_interface_create(nonmortar, mortar, options, s%contact))
    s%x(:, 1:4) = at_t_n
    s%x(:, 5:10) = ground
    do i = 1, 4
      ! Tilted about one edge direction: not flat against the ground.
      s%x(:, i) = s%x(:, i) + [slide, 0.02d0, -0.01d0 + 0.004d0 * (i - 1)]
      s%x(:, 10 + i) = [0.1d0, -0.05d0 * (i - 1), -1d0]
    end do
  end subroutine

  subroutine handle_residual(s, r)
    type(problem), intent(in) :: s
    real(c_double), intent(inout) :: r(ALL_)
    CHECK_OK(stickslip_interface_residual(s%contact, s%x, s%x(1, 5), s%x(1, 11), c_null_ptr, r(1), r(13), r(31)))
  end subroutine

  ! The nodes of a pair in x: its non-mortar nodes, its four mortar nodes, its multipliers.
  function nodes_of(facet)
    integer, intent(in) :: facet
    integer :: nodes_of(12)
    nodes_of = [1, 2, 3, 4, 4 + int(mortar_nodes(:, facet)), 11, 12, 13, 14]
  end function

  ! The unknowns of these nodes.
  function unknowns_of(nodes)
    integer, intent(in) :: nodes(:)
    integer :: unknowns_of(3 * size(nodes)), n
    do n = 1, size(nodes)
      unknowns_of(3 * n - 2:3 * n) = 3 * nodes(n) - [2, 1, 0]
    end do
  end function

  ! What a host without the handle does.
  subroutine assemble(s, layout, r, k)
    type(problem), target, intent(inout) :: s
    integer(c_int32_t), intent(in) :: layout
    real(c_double), intent(out) :: r(ALL_), k(ALL_, ALL_)
    real(c_double), target :: x2(3, 4, 2), old2(3, 4, 2), share(3, 4)
    type(weights), target :: now(2), previous(2)
    type(stickslip_pair) :: pair(2), old(2)
    logical :: active(2), before(2)
    type(stickslip_node) :: nodes(4)
    type(stickslip_node_response) :: responses(4)
    real(c_double), target :: normals(3, 4), areas(4), scale(4), row(3), block(3, 3)
    real(c_double) :: force(24), tangent(PAIR_SIZE, PAIR_SIZE)
    integer :: f, a, i, u(PAIR_SIZE), own(3), n(12)
    integer(c_int32_t) :: status

    ! Stage 1: weights of now and of t_n; coverage and gaps summed over the pairs.
    do f = 1, 2
      n = nodes_of(f)
      x2(:, :, f) = s%x(:, n(5:8))
      old2(:, :, f) = ground(:, mortar_nodes(:, f))
      pair(f) = make_pair(4, s%x(:, 1:4), 4, x2(:, :, f))
      pair(f)%layout = layout
      old(f) = make_pair(4, at_t_n, 4, old2(:, :, f))
      call pair_weights(pair(f), now(f))
      call pair_weights(old(f), previous(f))
      active(f) = worst(now(f)%ab) > 0
      before(f) = worst(previous(f)%ab) > 0
      CHECK_OK(stickslip_pair_gap(pair(f), now(f)%ab, now(f)%ac, share))
      do a = 1, 4
        nodes(a)%coverage = nodes(a)%coverage + sum(now(f)%ab(4 * a - 3:4 * a))
        nodes(a)%coverage_previous = nodes(a)%coverage_previous + sum(previous(f)%ab(4 * a - 3:4 * a))
        nodes(a)%gap_now = nodes(a)%gap_now + share(:, a)
      end do
      CHECK_OK(stickslip_pair_gap(pair(f), previous(f)%ab, previous(f)%ac, share))
      do a = 1, 4
        nodes(a)%gap_previous = nodes(a)%gap_previous + share(:, a)
      end do
    end do

    ! Stage 2: the law at every node.
    CHECK_OK(stickslip_facet_geometry(4, at_t_n, c_loc(normals), c_loc(areas)))
    do a = 1, 4
      nodes(a)%coverage_min = 1d-8 * areas(a)
      nodes(a)%mu = 0.5d0
      nodes(a)%augmentation = 20 / areas(a)
      nodes(a)%lambda = s%x(:, 10 + a)
      CHECK_OK(stickslip_node_normal(normals(1, a), nodes(a)%normal))
      CHECK_OK(stickslip_node_respond(nodes(a), responses(a)))
      scale(a) = nodes(a)%augmentation * areas(a)
    end do

    ! Stage 3: forces and tangents of the pairs of now and of t_n.
    r = 0
    k = 0
    do f = 1, 2
      u = unknowns_of(nodes_of(f))
      if (active(f)) then
        CHECK_OK(stickslip_pair_residual(pair(f), now(f)%ab, now(f)%ac, s%x(1, 11), force))
        r(u(:24)) = r(u(:24)) + force
      end if
      if (.not. active(f) .and. .not. before(f)) cycle
      status = stickslip_pair_tangent(pair(f), given(active(f), now(f)%ab), given(active(f), now(f)%ac), &
          given(active(f), now(f)%dab), given(active(f), now(f)%dac), given(before(f), previous(f)%ab), &
          given(before(f), previous(f)%ac), s%x(1, 11), responses, c_loc(scale), tangent, int(PAIR_SIZE, c_int64_t))
      CHECK_OK(status)
      if (layout == STICKSLIP_LAYOUT_ROW_MAJOR) tangent = transpose(tangent)
      k(u, u) = k(u, u) + tangent
    end do

    ! Stage 4: the nodes' own rows and blocks.
    do a = 1, 4
      own = unknowns_of([10 + a])
      CHECK_OK(stickslip_node_block(responses(a), scale(a), layout, c_loc(row), c_loc(block)))
      if (layout == STICKSLIP_LAYOUT_ROW_MAJOR) block = transpose(block)
      do i = 1, 3
        r(own(i)) = row(i)
        k(own(i), own) = k(own(i), own) + block(i, :)
      end do
    end do
  end subroutine

  ! The array's address, or null where there is none to give.
  type(c_ptr) function given(present, array)
    logical, intent(in) :: present
    real(c_double), target, intent(in) :: array(*)
    given = c_null_ptr
    if (present) given = c_loc(array)
  end function

  subroutine check_case(slide, friction, state)
    real(c_double), intent(in) :: slide, friction
    integer(c_int32_t), intent(in) :: state
    integer(c_int64_t), parameter :: CAPACITY = 20000
    integer(c_int64_t), target, save :: rows(CAPACITY), columns(CAPACITY)
    real(c_double), target, save :: values(CAPACITY), k(ALL_, ALL_), handle_k(ALL_, ALL_)
    real(c_double) :: r(ALL_), handle_r(ALL_), plus(ALL_), minus(ALL_), at
    integer(c_int32_t), target :: states(4)
    integer(c_int64_t) :: n, e
    integer(c_int32_t) :: status, layout
    integer :: i, j
    type(problem), target :: s
    call create(s, slide, friction)
    status = stickslip_interface_states(s%contact, s%x, s%x(1, 5), s%x(1, 11), c_null_ptr, &
        stickslip_states(state=c_loc(states)))
    CHECK_OK(status)
    CHECK(all(states == state))

    call handle_residual(s, handle_r)
    status = stickslip_interface_tangent_coo(s%contact, s%x, s%x(1, 5), s%x(1, 11), c_null_ptr, CAPACITY, c_loc(rows), &
        c_loc(columns), c_loc(values), n)
    CHECK_OK(status)
    handle_k = 0
    do e = 1, n
      handle_k(rows(e), columns(e)) = handle_k(rows(e), columns(e)) + values(e)
    end do

    do layout = 0, 1
      call assemble(s, layout, r, k)
      CHECK_NEAR(r, handle_r, ROUNDING_RESIDUAL * worst(handle_r))
      CHECK_NEAR(k, handle_k, ROUNDING_TANGENT * worst(handle_k))
    end do

    do j = 1, ALL_ / 3
      do i = 1, 3
        at = s%x(i, j)
        s%x(i, j) = at + STEP
        call handle_residual(s, plus)
        s%x(i, j) = at - STEP
        call handle_residual(s, minus)
        s%x(i, j) = at
        CHECK_NEAR(k(:, 3 * j - 3 + i), (plus - minus) / (2 * STEP), DIFFERENCE * worst(k))
      end do
    end do
    CHECK_OK(stickslip_interface_destroy(s%contact))
  end subroutine

  ! A tangent inside a larger matrix: only its own entries are written, in either layout.
  subroutine check_leading_dimension()
    integer, parameter :: N = 6 * 3 + 3 * 3, LD = N + 5
    real(c_double) :: whole(N, N), inside(LD, N), lambda(3, 3), expected(3, 3)
    type(weights), target :: w
    type(stickslip_node_response) :: responses(3)
    type(stickslip_pair) :: pair
    integer(c_int64_t) :: seed
    integer(c_int32_t) :: status, layout
    integer :: a, b, c, i, j
    real(c_double) :: ab(3, 3), ac(3, 3)
    lambda = reshape([0.1d0, 0.2d0, -1d0, 0d0, 0.1d0, -1d0, 0.3d0, 0d0, -1d0], [3, 3])
    seed = 3
    do a = 1, 3
      do j = 1, 3
        do i = 1, 3
          responses(a)%drow_dnow(i, j) = draw(seed)
          responses(a)%drow_dprevious(i, j) = draw(seed)
        end do
      end do
    end do
    pair = make_pair(3, tri1, 3, tri2)
    call pair_weights(pair, w)
    ab = reshape(w%ab, [3, 3])
    ac = reshape(w%ac, [3, 3])
    status = stickslip_pair_tangent(pair, c_loc(w%ab), c_loc(w%ac), c_loc(w%dab), c_loc(w%dac), c_loc(w%ab), &
        c_loc(w%ac), lambda, responses, c_null_ptr, whole, int(N, c_int64_t))
    CHECK_OK(status)
    do layout = 0, 1
      pair%layout = layout
      inside = UNWRITTEN
      status = stickslip_pair_tangent(pair, c_loc(w%ab), c_loc(w%ac), c_loc(w%dab), c_loc(w%dac), c_loc(w%ab), &
          c_loc(w%ac), lambda, responses, c_null_ptr, inside, int(LD, c_int64_t))
      CHECK_OK(status)
      CHECK_UNTOUCHED(inside(N + 1:, :))
      if (layout == STICKSLIP_LAYOUT_COLUMN_MAJOR) then
        CHECK(all(same(inside(:N, :), whole)))
      else
        CHECK(all(same(inside(:N, :), transpose(whole))))
      end if
    end do

    ! Previous-only: the rows' dependence on x through the weights of t_n, and nothing else.
    pair%layout = STICKSLIP_LAYOUT_COLUMN_MAJOR
    status = stickslip_pair_tangent(pair, c_null_ptr, c_null_ptr, c_null_ptr, c_null_ptr, c_loc(w%ab), c_loc(w%ac), &
        lambda, responses, c_null_ptr, whole, int(N, c_int64_t))
    CHECK_OK(status)
    CHECK(all(whole(:18, :) == 0) .and. all(whole(19:, 19:) == 0))
    do c = 1, 3
      do a = 1, 3
        ! A matrix of a response is row-major, so its transpose stands in the Fortran array.
        expected = transpose(responses(a)%drow_dprevious)
        i = 18 + 3 * a - 2
        b = 3 * c - 2
        CHECK_NEAR(whole(i:i + 2, b:b + 2), expected * ab(c, a), ROUNDING_PRODUCT)
        CHECK_NEAR(whole(i:i + 2, 9 + b:9 + b + 2), -expected * ac(c, a), ROUNDING_PRODUCT)
      end do
    end do

    ! Frozen weights: no derivative of the forces with respect to positions.
    status = stickslip_pair_tangent(pair, c_loc(w%ab), c_loc(w%ac), c_null_ptr, c_null_ptr, c_loc(w%ab), c_loc(w%ac), &
        lambda, responses, c_null_ptr, whole, int(N, c_int64_t))
    CHECK_OK(status)
    CHECK(all(whole(:18, :18) == 0))
  end subroutine
end program
