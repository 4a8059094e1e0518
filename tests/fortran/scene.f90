! A small interface for the tests, the twin of tests/capi/scene.h: 2 x 2 non-mortar quads over 3 x 3 turned mortar
! quads, in a rotated frame. Moved from its first configuration it has nodes in gap, stick and slip. Unknowns: x1, x2,
! lambda in this order. Numbers start at 1 unless a test asks for 0.
#include "check.inc"
module scenes
  use, intrinsic :: iso_c_binding
  use check
  use stickslip
  implicit none
  public

  ! Nodes and coordinates of the non-mortar and the mortar side.
  integer, parameter :: NA = 9, NC = 16, SIZE1 = 3 * NA, SIZE2 = 3 * NC, UNKNOWNS = 2 * SIZE1 + SIZE2
  ! Unknowns before the multipliers.
  integer, parameter :: POSITIONS = SIZE1 + SIZE2

  ! Surfaces point into the variable: it must be a target, is set up in place, and is not to be copied.
  type scene
    real(c_double) :: reference1(3, NA), reference2(3, NC)
    integer(c_int64_t) :: offsets1(5), offsets2(10), nodes1(4, 4), nodes2(4, 9)
    integer(c_int64_t) :: equations1(3, NA), equations2(3, NC), multipliers(3, NA)
    type(stickslip_surface) :: nonmortar, mortar
    type(stickslip_options) :: options
    type(stickslip_method) :: method ! of the options; the paper's where a test does not ask for another
    type(stickslip_interface) :: contact
    real(c_double) :: x1(3, NA), x2(3, NC), lambda(3, NA)
  end type

  ! A tangent's triplets.
  type triplets
    integer(c_int64_t) :: n = 0
    integer(c_int64_t), allocatable :: rows(:), columns(:)
    real(c_double), allocatable :: values(:)
  end type

  ! Places among a history's integers, counted from 1; the pairs' facets come last. The coordinates are those of the first
  ! configuration.
  integer, parameter :: HISTORY_CHECKSUM = 2, HISTORY_COORDINATES = 10, HISTORY_PAIRS = 14

  ! What the history is made of, to the bit.
  type history
    integer(c_int64_t) :: n_integers, n_reals, integers(256)
    real(c_double) :: reals(4096)
  end type

contains

  ! Turns p about the unit axis.
  pure subroutine scene_turn(p, axis, angle)
    real(c_double), intent(inout) :: p(3)
    real(c_double), intent(in) :: axis(3), angle
    real(c_double) :: q(3)
    q = [axis(2) * p(3) - axis(3) * p(2), axis(3) * p(1) - axis(1) * p(3), axis(1) * p(2) - axis(2) * p(1)]
    p = cos(angle) * p + sin(angle) * q + dot_product(axis, p) * (1 - cos(angle)) * axis
  end subroutine

  ! The frame that the scene is built in: nothing is aligned with the axes.
  pure subroutine scene_frame(p)
    real(c_double), intent(inout) :: p(3)
    call scene_turn(p, [2d0, -3d0, 6d0] / 7, 1.1d0)
  end subroutine

  ! n x n quads on [a, b] squared; counter-clockwise from above, or from below.
  pure subroutine scene_grid(n, a, b, up, base, x, offsets, nodes)
    integer, intent(in) :: n
    real(c_double), intent(in) :: a, b
    logical, intent(in) :: up
    integer(c_int64_t), intent(in) :: base
    real(c_double), intent(out) :: x(3, 0:n, 0:n)
    integer(c_int64_t), intent(out) :: offsets(0:n * n), nodes(4, 0:n - 1, 0:n - 1)
    integer :: i, j
    do j = 0, n
      do i = 0, n
        x(:, i, j) = [a + (b - a) * i / n, a + (b - a) * j / n, 0d0]
      end do
    end do
    offsets = [(4_c_int64_t * i, i = 0, n * n)]
    do j = 0, n - 1
      do i = 0, n - 1
        nodes(:, i, j) = base + j * (n + 1) + i + [0, 1, n + 2, n + 1]
        if (.not. up) nodes(:, i, j) = nodes(4:1:-1, i, j)
      end do
    end do
  end subroutine

  ! Fills everything but the handle, which must not be in use; options may be changed before scene_create.
  subroutine scene_init(s, base)
    type(scene), target, intent(inout) :: s
    integer, intent(in), optional :: base
    integer(c_int64_t) :: first, seed
    type(stickslip_method), pointer :: paper
    integer :: a, c, i
    first = 1
    if (present(base)) first = base
    seed = 8
    call scene_grid(2, 0d0, 1d0, .false., first, s%reference1, s%offsets1, s%nodes1)
    call scene_grid(3, -0.45d0, 1.5d0, .true., first, s%reference2, s%offsets2, s%nodes2)
    do c = 1, NC
      call scene_turn(s%reference2(:, c), [0d0, 0d0, 1d0], 0.3d0)
    end do
    s%x1 = s%reference1
    s%x2 = s%reference2
    do a = 1, NA
      ! Tilted, so that gaps of both signs occur, and slid. Facets stay parallelograms.
      call scene_turn(s%x1(:, a), [0.6d0, 0.8d0, 0d0], 0.03d0)
      s%x1(:, a) = s%x1(:, a) + [0.008d0, 0.006d0, 0.004d0]
      do i = 1, 3
        s%lambda(i, a) = draw(seed)
      end do
      s%lambda(:, a) = [0.3d0, 0.3d0, 0.7d0] * s%lambda(:, a) - [0d0, 0d0, 0.5d0]
      call scene_frame(s%reference1(:, a))
      call scene_frame(s%x1(:, a))
      call scene_frame(s%lambda(:, a))
    end do
    do c = 1, NC
      call scene_frame(s%reference2(:, c))
      call scene_frame(s%x2(:, c))
    end do
    s%equations1 = reshape([(first + i, i = 0, SIZE1 - 1)], [3, NA])
    s%equations2 = reshape([(first + SIZE1 + i, i = 0, SIZE2 - 1)], [3, NC])
    s%multipliers = reshape([(first + POSITIONS + i, i = 0, SIZE1 - 1)], [3, NA])
    s%nonmortar = stickslip_surface(n_nodes=NA, n_facets=4, coordinates=c_loc(s%reference1), &
        facet_offsets=c_loc(s%offsets1), facet_nodes=c_loc(s%nodes1), equations=c_loc(s%equations1), &
        multiplier_equations=c_loc(s%multipliers))
    s%mortar = stickslip_surface(n_nodes=NC, n_facets=9, coordinates=c_loc(s%reference2), &
        facet_offsets=c_loc(s%offsets2), facet_nodes=c_loc(s%nodes2), equations=c_loc(s%equations2))
    CHECK_OK(stickslip_options_init(s%options, stickslip_options_size))
    CHECK_OK(stickslip_options_paper(s%options))
    call c_f_pointer(s%options%method, paper)
    s%method = paper
    s%options%method = c_loc(s%method)
    s%options%index_base = int(first, c_int32_t)
    s%options%mu = 0.7d0
    s%method%augmentation = 15
    CHECK(address_of(s%contact) == 0)
  end subroutine

  subroutine scene_create(s)
    type(scene), intent(inout) :: s
    CHECK_OK(stickslip_interface_create(s%nonmortar, s%mortar, s%options, s%contact))
    CHECK(address_of(s%contact) /= 0)
  end subroutine

  subroutine scene_destroy(s)
    type(scene), intent(inout) :: s
    CHECK_OK(stickslip_interface_destroy(s%contact))
    CHECK(address_of(s%contact) == 0)
  end subroutine

  ! Slides the non-mortar side in its plane.
  subroutine scene_slide(s, by)
    type(scene), intent(inout) :: s
    real(c_double), intent(in) :: by
    real(c_double) :: d(3)
    d = [0.8d0, 0.6d0, 0d0] * by
    call scene_frame(d)
    s%x1 = s%x1 + spread(d, 2, NA)
  end subroutine

  subroutine scene_commit(s)
    type(scene), intent(inout) :: s
    CHECK_OK(stickslip_interface_commit(s%contact, s%x1, s%x2, s%lambda, c_null_ptr))
  end subroutine

  ! r: force1, force2, rows.
  subroutine scene_residual(s, r)
    type(scene), intent(inout) :: s
    real(c_double), intent(inout) :: r(UNKNOWNS)
    call residual_with(s, c_null_ptr, r(:SIZE1), r(SIZE1 + 1:POSITIONS), r(POSITIONS + 1:))
  end subroutine

  subroutine residual_with(s, sums, force1, force2, rows)
    type(scene), intent(inout) :: s
    type(c_ptr), intent(in) :: sums
    real(c_double), intent(inout) :: force1(SIZE1), force2(SIZE2), rows(SIZE1)
    CHECK_OK(stickslip_interface_residual(s%contact, s%x1, s%x2, s%lambda, sums, force1, force2, rows))
  end subroutine

  ! Asks for the number of triplets, then for the triplets.
  subroutine scene_tangent(s, t, sums)
    type(scene), intent(inout) :: s
    type(triplets), target, intent(inout) :: t
    type(c_ptr), intent(in), optional :: sums
    type(c_ptr) :: total
    integer(c_int32_t) :: status
    integer(c_int64_t) :: n
    total = c_null_ptr
    if (present(sums)) total = sums
    status = stickslip_interface_tangent_coo(s%contact, s%x1, s%x2, s%lambda, total, 0_c_int64_t, c_null_ptr, &
        c_null_ptr, c_null_ptr, t%n)
    CHECK_OK(status)
    CHECK(t%n > 0)
    call triplets_allocate(t, t%n)
    status = stickslip_interface_tangent_coo(s%contact, s%x1, s%x2, s%lambda, total, t%n, c_loc(t%rows), &
        c_loc(t%columns), c_loc(t%values), n)
    CHECK_OK(status)
    CHECK(n == t%n)
  end subroutine

  ! Room for n triplets, all of it the library's to write.
  subroutine triplets_allocate(t, n)
    type(triplets), intent(inout) :: t
    integer(c_int64_t), intent(in) :: n
    if (allocated(t%rows)) deallocate (t%rows, t%columns, t%values)
    allocate (t%rows(n), t%columns(n), source=UNWRITTEN_INTEGER)
    allocate (t%values(n), source=UNWRITTEN)
  end subroutine

  logical function triplets_equal(a, b)
    type(triplets), intent(in) :: a, b
    triplets_equal = a%n == b%n
    if (.not. triplets_equal) return
    triplets_equal = all(a%rows == b%rows) .and. all(a%columns == b%columns) .and. all(same(a%values, b%values))
  end function

  ! k(row, column) + the triplets, numbered from base.
  subroutine triplets_add(t, base, k)
    type(triplets), intent(in) :: t
    integer, intent(in) :: base
    real(c_double), intent(inout) :: k(UNKNOWNS, UNKNOWNS)
    integer(c_int64_t) :: e, row, column
    do e = 1, t%n
      row = t%rows(e) - base + 1
      column = t%columns(e) - base + 1
      CHECK(1 <= row .and. row <= UNKNOWNS .and. 1 <= column .and. column <= UNKNOWNS)
      k(row, column) = k(row, column) + t%values(e)
    end do
  end subroutine

  ! The tangent as a full matrix.
  subroutine scene_dense(s, t, k)
    type(scene), intent(inout) :: s
    type(triplets), intent(inout) :: t
    real(c_double), intent(out) :: k(UNKNOWNS, UNKNOWNS)
    k = 0
    call scene_tangent(s, t)
    call triplets_add(t, int(s%options%index_base), k)
  end subroutine

  ! Worst difference over the blocks (f1, f2, rows) x (x1, x2, lambda), relative to the block's largest entry, or to
  ! `least` where a block is smaller than that.
  pure real(c_double) function block_difference(k, expected, least)
    real(c_double), intent(in) :: k(UNKNOWNS, UNKNOWNS), expected(UNKNOWNS, UNKNOWNS), least
    integer, parameter :: ends(4) = [0, SIZE1, POSITIONS, UNKNOWNS]
    real(c_double) :: difference(UNKNOWNS, UNKNOWNS), blocks(3, 3)
    integer :: p, q, i, j
    difference = k - expected
    do q = 1, 3
      do p = 1, 3
        i = ends(p) + 1
        j = ends(q) + 1
        blocks(p, q) = worst(difference(i:ends(p + 1), j:ends(q + 1))) / &
                       max(least, worst(expected(i:ends(p + 1), j:ends(q + 1))))
      end do
    end do
    block_difference = worst(blocks)
  end function

  subroutine history_take(contact, h)
    type(stickslip_interface), intent(in) :: contact
    type(history), intent(inout) :: h
    h%integers = 0
    h%reals = 0
    CHECK_OK(stickslip_interface_history_size(contact, h%n_integers, h%n_reals))
    CHECK(h%n_integers <= size(h%integers) .and. h%n_reals <= size(h%reals))
    CHECK_OK(stickslip_interface_history_export(contact, h%n_integers, h%integers, h%n_reals, h%reals))
  end subroutine

  logical function history_equal(a, b)
    type(history), intent(in) :: a, b
    history_equal = a%n_integers == b%n_integers .and. a%n_reals == b%n_reals .and. &
                    all(a%integers == b%integers) .and. all(same(a%reals, b%reals))
  end function
end module
