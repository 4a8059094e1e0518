! Normals of the current configuration, over a non-mortar surface that is curved in both directions, and partly off the
! mortar surface, where a facet without pairs shares nodes with one that has them. The stages assemble the residual and the
! tangent of a handle, with what follows from the derivative of the normals. Multipliers turn with the surface. A step may
! begin with the normals of its start, and is not accepted with them.
#include "check.inc"
program t85_normals
  use, intrinsic :: iso_c_binding
  use check
  use pairs
  use scenes
  use stickslip
  implicit none
  integer, parameter :: FACETS = 4, PAIRS_ = 9
  ! Rounding of the same sums in another order, relative to the largest number of a block.
  real(c_double), parameter :: ROUNDING = 1d-12
  ! Part of a matrix that is the difference of two: their own rounding, relative to the larger one.
  real(c_double), parameter :: DIFFERENCE = 1d-13
  ! A vector that is turned, of length 1.
  real(c_double), parameter :: TURNED = 1d-14
  real(c_double), parameter :: SLIDES(2) = [0d0, 1.1d0]

  ! A facet with its pairs at one configuration; weights as the library writes them, (b, a) and (c, a).
  type patch
    real(c_double) :: x1(3, 4), x2(3, 4, PAIRS_), n_ab(4, 4, PAIRS_), n_ac(4, 4, PAIRS_)
    real(c_double) :: dn_ab(24, 4, 4, PAIRS_), dn_ac(24, 4, 4, PAIRS_)
    type(stickslip_pair) :: pairs(PAIRS_)
  end type

  type(scene), target, save :: s
  type(patch), target, save :: now(FACETS), before(FACETS)
  type(triplets), save :: t
  real(c_double) :: start(3, NA)
  integer :: n, seen(0:2), lone_facets
  seen = 0
  lone_facets = 0
  do n = 1, size(SLIDES)
    call check_stages(SLIDES(n))
    call check_augmented(SLIDES(n))
  end do
  CHECK(all(seen > 0) .and. lone_facets > 0)
  call check_turn_of_multipliers()
  call check_phases()

contains

  ! Bends the non-mortar surface up at its borders; facets stay parallelograms.
  subroutine bend(x, along, across, up)
    real(c_double), intent(inout) :: x(3, NA)
    real(c_double), intent(in) :: along, across, up
    real(c_double) :: d(3)
    integer :: a
    do a = 1, NA
      d = [0d0, 0d0, up]
      if (mod(a, 3) /= 2) d(3) = d(3) + along
      if ((a - 1) / 3 /= 1) d(3) = d(3) + across
      call scene_frame(d)
      x(:, a) = x(:, a) + d
    end do
  end subroutine

  ! Stage 1, where the scene is.
  subroutine integrate(patches)
    type(patch), target, intent(inout) :: patches(FACETS)
    type(patch), pointer :: p
    integer(c_int32_t) :: status
    integer :: f, q
    do f = 1, FACETS
      p => patches(f)
      p%x1 = s%x1(:, s%nodes1(:, f))
      do q = 1, PAIRS_
        p%x2(:, :, q) = s%x2(:, s%nodes2(:, q))
        p%pairs(q) = stickslip_pair(n1=4, n2=4, x1=c_loc(p%x1), x2=c_loc(p%x2(1, 1, q)))
        status = stickslip_pair_weights(p%pairs(q), c_loc(p%n_ab(1, 1, q)), c_loc(p%n_ac(1, 1, q)), &
            c_loc(p%dn_ab(1, 1, 1, q)), c_loc(p%dn_ac(1, 1, 1, q)))
        CHECK_OK(status)
      end do
    end do
  end subroutine

  ! An interface at t_n, moved within the step: slid by `by` and bent further.
  subroutine set_up(by, normals, form)
    real(c_double), intent(in) :: by
    integer(c_int32_t), intent(in) :: normals, form
    call scene_init(s)
    s%options%mu = 0.4d0
    s%method%normals = normals
    s%method%form = form
    call bend(s%reference1, 0.05d0, 0.04d0, -0.035d0)
    call bend(s%x1, 0.05d0, 0.04d0, -0.035d0)
    call scene_create(s)
    call scene_slide(s, by)
    call scene_commit(s)
    start = s%x1
    call integrate(before)
    call bend(s%x1, 0.03d0, -0.02d0, -0.005d0)
    call scene_slide(s, 0.015d0)
    call integrate(now)
  end subroutine

  ! A facet's share of its nodes' gaps: weights of one configuration at the positions of another.
  subroutine add_gap(w, at, f, gaps)
    type(patch), intent(in) :: w, at
    integer, intent(in) :: f
    real(c_double), intent(inout) :: gaps(3, NA)
    real(c_double) :: share(3, 4)
    integer :: q
    do q = 1, PAIRS_
      CHECK_OK(stickslip_pair_gap(at%pairs(q), w%n_ab(:, :, q), w%n_ac(:, :, q), share))
      gaps(:, s%nodes1(:, f)) = gaps(:, s%nodes1(:, f)) + share
    end do
  end subroutine

  ! Stages 1 and 2: the sums of the corner normals, the nodes and their answers.
  subroutine respond(sums, scale, nodes, responses)
    real(c_double), intent(out) :: sums(3, NA), scale(NA)
    type(stickslip_node), intent(out) :: nodes(NA)
    type(stickslip_node_response), intent(out) :: responses(NA)
    real(c_double), target :: of_normals(3, 4), of_areas(4)
    real(c_double) :: areas(NA), gaps(3, NA, 3)
    integer :: a, b, f
    sums = 0
    areas = 0
    gaps = 0
    do f = 1, FACETS
      CHECK_OK(stickslip_facet_geometry(4, now(f)%x1, c_loc(of_normals), c_null_ptr))
      CHECK_OK(stickslip_facet_geometry(4, before(f)%x1, c_null_ptr, c_loc(of_areas)))
      do b = 1, 4
        a = int(s%nodes1(b, f))
        sums(:, a) = sums(:, a) + of_normals(:, b)
        areas(a) = areas(a) + of_areas(b)
        nodes(a)%coverage = nodes(a)%coverage + sum(now(f)%n_ab(:, b, :))
        nodes(a)%coverage_previous = nodes(a)%coverage_previous + sum(before(f)%n_ab(:, b, :))
      end do
      call add_gap(now(f), now(f), f, gaps(:, :, 1))
      call add_gap(before(f), now(f), f, gaps(:, :, 2))
      call add_gap(before(f), before(f), f, gaps(:, :, 3))
    end do
    do a = 1, NA
      nodes(a)%gap_now = gaps(:, a, 1)
      nodes(a)%gap_previous = gaps(:, a, 2)
      nodes(a)%gap_committed = gaps(:, a, 3)
      nodes(a)%coverage_min = 1d-8 * areas(a)
      nodes(a)%mu = merge(s%options%mu, 0d0, nodes(a)%coverage_previous > nodes(a)%coverage_min)
      nodes(a)%augmentation = s%method%augmentation / areas(a)
      nodes(a)%lambda = s%lambda(:, a)
      scale(a) = nodes(a)%augmentation * areas(a)
      CHECK_OK(stickslip_node_normal(sums(:, a), nodes(a)%normal))
      CHECK_OK(stickslip_node_respond(nodes(a), responses(a)))
    end do
  end subroutine

  ! dnu/ds, dp/dnu and dc/dnu of a node.
  subroutine turn_of(node, sum_, dnu, dp, row)
    type(stickslip_node), intent(in) :: node
    real(c_double), intent(in) :: sum_(3)
    real(c_double), target, intent(out) :: dnu(3, 3), dp(3, 3), row(3, 3)
    real(c_double), target :: rows(3, 3, 3)
    integer(c_int32_t) :: status
    CHECK_OK(stickslip_node_turn(node, sum_, STICKSLIP_LAYOUT_COLUMN_MAJOR, c_loc(dnu), c_loc(dp), c_loc(row)))
    status = stickslip_node_turn(node, sum_, STICKSLIP_LAYOUT_ROW_MAJOR, c_loc(rows(1, 1, 1)), c_loc(rows(1, 1, 2)), &
        c_loc(rows(1, 1, 3)))
    CHECK_OK(status)
    CHECK(all(same(transpose(rows(:, :, 1)), dnu)) .and. all(same(transpose(rows(:, :, 2)), dp)))
    CHECK(all(same(transpose(rows(:, :, 3)), row)))
  end subroutine

  ! What the nodes' normals add to the tangent: to the multipliers' rows, and to forces of p where `augmented`.
  subroutine add_turns(sums, scale, nodes, augmented, k)
    real(c_double), intent(in) :: sums(3, NA), scale(NA)
    type(stickslip_node), intent(in) :: nodes(NA)
    logical, intent(in) :: augmented
    real(c_double), intent(inout) :: k(UNKNOWNS, UNKNOWNS)
    real(c_double) :: d(NA, NA), m(NC, NA), dm(3, 4, 3, 4)
    real(c_double), target :: dnu_dsum(3, 3), dp_dnormal(3, 3), drow_dnormal(3, 3)
    real(c_double) :: dnu(3, 12), rows(3, 12), dp(3, 12)
    integer :: a, b, c, corner, f, q, u(12)
    d = 0
    m = 0
    do f = 1, FACETS
      do q = 1, PAIRS_
        d(s%nodes1(:, f), s%nodes1(:, f)) = d(s%nodes1(:, f), s%nodes1(:, f)) + now(f)%n_ab(:, :, q)
        m(s%nodes2(:, q), s%nodes1(:, f)) = m(s%nodes2(:, q), s%nodes1(:, f)) + now(f)%n_ac(:, :, q)
      end do
    end do
    do f = 1, FACETS
      do b = 1, 4
        u(3 * b - 2:3 * b) = 3 * int(s%nodes1(b, f)) - [2, 1, 0]
      end do
      CHECK_OK(stickslip_facet_normal_derivatives(4, now(f)%x1, dm))
      do corner = 1, 4
        a = int(s%nodes1(corner, f))
        call turn_of(nodes(a), sums(:, a), dnu_dsum, dp_dnormal, drow_dnormal)
        dnu = matmul(dnu_dsum, transpose(reshape(dm(:, :, :, corner), [12, 3])))
        rows = scale(a) * matmul(drow_dnormal, dnu)
        k(POSITIONS + 3 * a - 2:POSITIONS + 3 * a, u) = k(POSITIONS + 3 * a - 2:POSITIONS + 3 * a, u) + rows
        if (.not. augmented) cycle
        dp = matmul(dp_dnormal, dnu)
        do b = 1, NA
          k(3 * b - 2:3 * b, u) = k(3 * b - 2:3 * b, u) + d(b, a) * dp
        end do
        do c = NA + 1, NA + NC
          k(3 * c - 2:3 * c, u) = k(3 * c - 2:3 * c, u) - m(c - NA, a) * dp
        end do
      end do
    end do
  end subroutine

  ! Stages 3 and 4 in the multiplier form.
  subroutine assemble(r, k)
    real(c_double), intent(out) :: r(UNKNOWNS), k(UNKNOWNS, UNKNOWNS)
    type(stickslip_node) :: nodes(NA)
    type(stickslip_node_response) :: responses(NA)
    real(c_double), target :: row(3), block(3, 3)
    real(c_double) :: sums(3, NA), scale(NA)
    logical :: covered, overlaps
    integer :: a, b, f, q, first
    call respond(sums, scale, nodes, responses)
    r = 0
    k = 0
    do f = 1, FACETS
      overlaps = .false.
      covered = .false.
      do b = 1, 4
        a = int(s%nodes1(b, f))
        covered = covered .or. nodes(a)%coverage > nodes(a)%coverage_min
      end do
      do q = 1, PAIRS_
        call add_pair(f, q, scale(s%nodes1(:, f)), responses(s%nodes1(:, f)), r, k)
        overlaps = overlaps .or. worst(now(f)%n_ab(:, :, q)) > 0 .or. worst(before(f)%n_ab(:, :, q)) > 0
      end do
      if (covered .and. .not. overlaps) lone_facets = lone_facets + 1
    end do
    do a = 1, NA
      first = POSITIONS + 3 * (a - 1)
      CHECK_OK(stickslip_node_block(responses(a), scale(a), STICKSLIP_LAYOUT_COLUMN_MAJOR, c_loc(row), c_loc(block)))
      r(first + 1:first + 3) = row
      k(first + 1:first + 3, first + 1:first + 3) = k(first + 1:first + 3, first + 1:first + 3) + block
      seen(responses(a)%state) = seen(responses(a)%state) + 1
    end do
    call add_turns(sums, scale, nodes, .false., k)
  end subroutine

  subroutine add_pair(f, q, scale, responses, r, k)
    integer, intent(in) :: f, q
    real(c_double), target, intent(in) :: scale(4)
    type(stickslip_node_response), intent(in) :: responses(4)
    real(c_double), intent(inout) :: r(UNKNOWNS), k(UNKNOWNS, UNKNOWNS)
    real(c_double) :: lambda(3, 4), force(24), tangent(36, 36)
    integer(c_int32_t) :: status
    integer :: u(36), nodes(12), b
    nodes = int([s%nodes1(:, f), NA + s%nodes2(:, q), NA + NC + s%nodes1(:, f)])
    do b = 1, 12
      u(3 * b - 2:3 * b) = 3 * nodes(b) - [2, 1, 0]
    end do
    lambda = s%lambda(:, s%nodes1(:, f))
    CHECK_OK(stickslip_pair_residual(now(f)%pairs(q), now(f)%n_ab(:, :, q), now(f)%n_ac(:, :, q), lambda, force))
    status = stickslip_pair_tangent(now(f)%pairs(q), c_loc(now(f)%n_ab(1, 1, q)), c_loc(now(f)%n_ac(1, 1, q)), &
        c_loc(now(f)%dn_ab(1, 1, 1, q)), c_loc(now(f)%dn_ac(1, 1, 1, q)), c_loc(before(f)%n_ab(1, 1, q)), &
        c_loc(before(f)%n_ac(1, 1, q)), lambda, responses, c_loc(scale), tangent, 36_c_int64_t)
    CHECK_OK(status)
    r(u(:24)) = r(u(:24)) + force
    k(u, u) = k(u, u) + tangent
  end subroutine

  subroutine check_stages(by)
    real(c_double), intent(in) :: by
    real(c_double), save :: r(UNKNOWNS), k(UNKNOWNS, UNKNOWNS), handle_r(UNKNOWNS), handle_k(UNKNOWNS, UNKNOWNS)
    call set_up(by, STICKSLIP_NORMALS_CURRENT, STICKSLIP_FORM_MULTIPLIER)
    call assemble(r, k)
    call scene_residual(s, handle_r)
    call scene_dense(s, t, handle_k)
    CHECK_NEAR(r, handle_r, ROUNDING * worst(handle_r))
    CHECK(block_difference(k, handle_k, 0.01d0 * worst(handle_k)) <= ROUNDING)
    call scene_destroy(s)
  end subroutine

  ! In the augmented form: the tangent is that with the same normals as data, and what they add.
  subroutine check_augmented(by)
    real(c_double), intent(in) :: by
    real(c_double), save :: with(UNKNOWNS, UNKNOWNS), without(UNKNOWNS, UNKNOWNS)
    type(stickslip_node) :: nodes(NA)
    type(stickslip_node_response) :: responses(NA)
    real(c_double), target :: normals(3, NA)
    real(c_double) :: sums(3, NA), scale(NA)
    integer :: a
    call set_up(by, STICKSLIP_NORMALS_CURRENT, STICKSLIP_FORM_AUGMENTED)
    call scene_dense(s, t, with)
    call scene_destroy(s)
    call set_up(by, STICKSLIP_NORMALS_COMMITTED, STICKSLIP_FORM_AUGMENTED)
    call respond(sums, scale, nodes, responses)
    do a = 1, NA
      normals(:, a) = nodes(a)%normal
    end do
    CHECK_OK(stickslip_interface_set_normals(s%contact, c_loc(normals)))
    call scene_dense(s, t, without)
    CHECK(worst(with - without) > 0.01d0 * worst(with)) ! or nothing would be compared
    call add_turns(sums, scale, nodes, .true., without)
    CHECK_NEAR(without, with, DIFFERENCE * worst(with))
    call scene_destroy(s)
  end subroutine

  ! The normals at the scene's positions.
  subroutine normals_at(normals)
    real(c_double), target, intent(out) :: normals(3, NA)
    type(stickslip_states) :: states
    states = stickslip_states(normal=c_loc(normals))
    CHECK_OK(stickslip_interface_states(s%contact, s%x1, s%x2, s%lambda, c_null_ptr, states))
  end subroutine

  ! About an axis within the surface at a node the smallest rotation is the whole one.
  subroutine check_turn_of_multipliers()
    real(c_double), parameter :: ANGLE = 70 * acos(-1d0) / 180
    real(c_double), target :: normals(3, NA)
    real(c_double) :: x(3, NA), lambda(3, NA), expected(3), axis(3)
    integer :: a, b
    call set_up(0d0, STICKSLIP_NORMALS_CURRENT, STICKSLIP_FORM_MULTIPLIER)
    s%x1 = start
    call normals_at(normals)
    do a = 1, NA
      axis = [0d0, normals(3, a), -normals(2, a)] / norm2(normals(2:, a))
      x = start
      do b = 1, NA
        call scene_turn(x(:, b), axis, ANGLE)
      end do
      lambda = s%lambda
      CHECK_OK(stickslip_interface_turn_multipliers(s%contact, x, lambda))
      expected = s%lambda(:, a)
      call scene_turn(expected, axis, ANGLE)
      CHECK_NEAR(lambda(:, a), expected, TURNED)
      CHECK_NEAR(norm2(lambda, 1), norm2(s%lambda, 1), TURNED)
    end do
    ! Folded along its middle the surface has no normals there; the message counts from 0.
    x(:, 3:NA:3) = x(:, 1:NA:3)
    lambda = s%lambda
    CHECK_REFUSED(stickslip_interface_turn_multipliers(s%contact, x, lambda), STICKSLIP_UNDEFINED_NORMAL, 'node 1')
    CHECK(all(same(lambda, s%lambda)))
    call scene_destroy(s)
    ! Where normals do not turn, multipliers stay.
    call set_up(0d0, STICKSLIP_NORMALS_COMMITTED, STICKSLIP_FORM_MULTIPLIER)
    CHECK_OK(stickslip_interface_turn_multipliers(s%contact, s%x1, lambda))
    CHECK(all(same(lambda, s%lambda)))
    call scene_destroy(s)
  end subroutine

  ! The first phase of a step has the normals of its start; a commit needs those of now.
  subroutine check_phases()
    real(c_double), target :: normals(3, NA)
    real(c_double) :: committed(UNKNOWNS), current(UNKNOWNS), found(UNKNOWNS)
    integer(c_int32_t) :: status
    call set_up(0d0, STICKSLIP_NORMALS_COMMITTED, STICKSLIP_FORM_MULTIPLIER)
    call scene_residual(s, committed)
    CHECK_OK(stickslip_interface_use_normals(s%contact, STICKSLIP_NORMALS_COMMITTED))
    status = stickslip_interface_use_normals(s%contact, STICKSLIP_NORMALS_CURRENT)
    CHECK_REFUSED(status, STICKSLIP_INVALID_VALUE, 'created')
    call scene_residual(s, found)
    CHECK(all(same(found, committed)))
    call normals_at(normals)
    CHECK_OK(stickslip_interface_set_normals(s%contact, c_loc(normals)))
    call scene_destroy(s)

    call set_up(0d0, STICKSLIP_NORMALS_CURRENT, STICKSLIP_FORM_MULTIPLIER)
    call scene_residual(s, current)
    CHECK(.not. all(same(current, committed)))
    CHECK_OK(stickslip_interface_use_normals(s%contact, STICKSLIP_NORMALS_COMMITTED))
    call scene_residual(s, found)
    CHECK(all(same(found, committed)))
    status = stickslip_interface_commit(s%contact, s%x1, s%x2, s%lambda, c_null_ptr)
    CHECK_REFUSED(status, STICKSLIP_INVALID_VALUE, 'use_normals')
    CHECK_OK(stickslip_interface_use_normals(s%contact, STICKSLIP_NORMALS_CURRENT))
    call scene_residual(s, found)
    CHECK(all(same(found, current)))
    call scene_commit(s)
    ! The phase ends with the step.
    CHECK_OK(stickslip_interface_use_normals(s%contact, STICKSLIP_NORMALS_COMMITTED))
    CHECK_OK(stickslip_interface_rollback(s%contact))
    call scene_residual(s, found)
    CHECK(all(same(found, current)))

    ! Normals of the host would not follow.
    status = stickslip_interface_set_normals(s%contact, c_loc(normals))
    CHECK_REFUSED(status, STICKSLIP_UNSUPPORTED, 'STICKSLIP_NORMALS_CURRENT')
    CHECK_OK(stickslip_interface_set_normals(s%contact, c_null_ptr))
    call scene_residual(s, found)
    CHECK(all(same(found, current)))
    call scene_destroy(s)
  end subroutine
end program
