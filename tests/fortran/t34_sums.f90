! A parallel host: two handles hold the whole non-mortar surface and disjoint halves of the mortar facets. With their
! sums exchanged, residuals and tangents add up to those of one handle.
#include "check.inc"
program t34_sums
  use, intrinsic :: iso_c_binding
  use check
  use scenes
  use stickslip
  implicit none
  ! Sums of a few numbers of size 1; the same in a residual and in a tangent, relative to the largest entries.
  real(c_double), parameter :: ROUNDING = 1d-15, ROUNDING_RESIDUAL = 1d-14, ROUNDING_TANGENT = 1d-12
  ! What a block of the tangent is at least compared with; the largest entries are of size 1.
  real(c_double), parameter :: SMALL_BLOCK = 1d-3
  integer, parameter :: FIRST(2) = [1, 6], LAST(2) = [5, 9]
  type(scene), target, save :: whole, halves(2)
  type(triplets), target, save :: t
  real(c_double), save :: k(UNKNOWNS, UNKNOWNS), total_k(UNKNOWNS, UNKNOWNS)
  real(c_double) :: r(UNKNOWNS), total_r(UNKNOWNS), q(UNKNOWNS)
  real(c_double), target :: sums(STICKSLIP_SUMS_PER_NODE, NA), total(STICKSLIP_SUMS_PER_NODE, NA), &
                            own(STICKSLIP_SUMS_PER_NODE, NA)
  integer(c_int32_t), target :: nobody(NA) = 0
  integer(c_int64_t) :: equations(SIZE2)
  integer :: p, step, n

  call scene_init(whole)
  call scene_create(whole)
  do p = 1, 2
    call scene_init(halves(p))
    call keep_facets(halves(p), FIRST(p), LAST(p))
    if (p == 2) halves(p)%nonmortar%owned = c_loc(nobody) ! the first one adds the nodes' own blocks
    call scene_create(halves(p))
  end do

  do step = 1, 3
    ! Stage 1, summed over the handles.
    total = 0
    do p = 1, 2
      halves(p)%x1 = whole%x1
      CHECK_OK(stickslip_interface_sums(halves(p)%contact, halves(p)%x1, halves(p)%x2, sums))
      total = total + sums
    end do
    CHECK_OK(stickslip_interface_sums(whole%contact, whole%x1, whole%x2, own))
    CHECK_NEAR(total, own, ROUNDING)

    ! The other stages with the total.
    call scene_residual(whole, r)
    call scene_dense(whole, t, k)
    total_k = 0
    total_r = 0
    do p = 1, 2
      n = int(3 * halves(p)%mortar%n_nodes)
      call residual_with(halves(p), c_loc(total), q(:SIZE1), q(SIZE1 + 1:POSITIONS), q(POSITIONS + 1:))
      equations = reshape(halves(p)%equations2, [SIZE2])
      total_r(:SIZE1) = total_r(:SIZE1) + q(:SIZE1)
      total_r(equations(:n)) = total_r(equations(:n)) + q(SIZE1 + 1:SIZE1 + n)
      total_r(POSITIONS + 1:) = total_r(POSITIONS + 1:) + q(POSITIONS + 1:)
      call scene_tangent(halves(p), t, c_loc(total))
      call triplets_add(t, 1, total_k)
    end do
    CHECK_NEAR(total_r, r, ROUNDING_RESIDUAL * worst(r))
    CHECK(block_difference(total_k, k, SMALL_BLOCK) < ROUNDING_TANGENT)

    ! One handle with its own sums does what it does without.
    call residual_with(whole, c_loc(own), q(:SIZE1), q(SIZE1 + 1:POSITIONS), q(POSITIONS + 1:))
    CHECK(all(same(q, r)))

    ! The history moves on together too.
    call scene_commit(whole)
    do p = 1, 2
      call commit_with(halves(p), c_loc(total))
    end do
    call scene_slide(whole, 0.11d0)
  end do
  do p = 1, 2
    call scene_destroy(halves(p))
  end do
  call scene_destroy(whole)

contains

  subroutine commit_with(s, sums)
    type(scene), intent(inout) :: s
    type(c_ptr), intent(in) :: sums
    CHECK_OK(stickslip_interface_commit(s%contact, s%x1, s%x2, s%lambda, sums))
  end subroutine

  ! The mortar facets from first to last with the nodes that they use, renumbered.
  subroutine keep_facets(s, first, last)
    type(scene), intent(inout) :: s
    integer, intent(in) :: first, last
    integer(c_int64_t) :: number(NC)
    integer :: c, n, f
    n = 0
    do c = 1, NC
      if (.not. any(s%nodes2(:, first:last) == c)) cycle
      n = n + 1
      number(c) = n
      s%reference2(:, n) = s%reference2(:, c)
      s%x2(:, n) = s%x2(:, c)
      s%equations2(:, n) = s%equations2(:, c)
    end do
    do f = first, last
      s%nodes2(:, f - first + 1) = number(s%nodes2(:, f))
    end do
    s%mortar%n_nodes = n
    s%mortar%n_facets = last - first + 1
  end subroutine
end program
