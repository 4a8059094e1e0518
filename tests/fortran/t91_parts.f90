! A parallel host whose handles own nodes: each holds the facets around its own nodes, and the multipliers of others act
! elsewhere. Residuals and tangents add up to those of one handle, without any sums, and so do the residuals of condensed systems.
#include "check.inc"
program t91_parts
  use, intrinsic :: iso_c_binding
  use check
  use scenes
  use stickslip
  implicit none
  ! Sums of a few numbers in a residual and in a tangent, relative to the largest entries.
  real(c_double), parameter :: ROUNDING_RESIDUAL = 1d-14, ROUNDING_TANGENT = 1d-12
  ! What a block of the tangent is at least compared with; the largest entries are of size 1.
  real(c_double), parameter :: SMALL_BLOCK = 1d-3
  type(scene), target, save :: whole, parts(2)
  type(triplets), target, save :: t
  integer(c_int32_t), target, save :: owned(NA, 2)
  real(c_double), save :: k(UNKNOWNS, UNKNOWNS), total_k(UNKNOWNS, UNKNOWNS)
  real(c_double) :: r(UNKNOWNS), total_r(UNKNOWNS), q(UNKNOWNS)
  integer :: p, step, a

  call scene_init(whole)
  call scene_create(whole)
  do p = 1, 2
    call scene_init(parts(p))
    owned(:, p) = [(merge(STICKSLIP_NODE_OWN, STICKSLIP_NODE_ELSEWHERE, (a <= 5) .eqv. p == 1), a = 1, NA)]
    parts(p)%nonmortar%owned = c_loc(owned(1, p))
    call scene_create(parts(p))
  end do

  do step = 1, 3
    call scene_residual(whole, r)
    call scene_dense(whole, t, k)
    total_k = 0
    total_r = 0
    do p = 1, 2
      parts(p)%x1 = whole%x1
      call scene_residual(parts(p), q)
      total_r = total_r + q
      do a = 1, NA
        if (owned(a, p) == STICKSLIP_NODE_ELSEWHERE) CHECK(all(same(q(POSITIONS + 3 * a - 2:POSITIONS + 3 * a), [0d0, 0d0, 0d0])))
      end do
      call scene_tangent(parts(p), t)
      call triplets_add(t, 1, total_k)
    end do
    CHECK_NEAR(total_r, r, ROUNDING_RESIDUAL * worst(r))
    CHECK(block_difference(total_k, k, SMALL_BLOCK) < ROUNDING_TANGENT)
    call scene_commit(whole)
    do p = 1, 2
      call scene_commit(parts(p))
    end do
    call scene_slide(whole, 0.11d0)
  end do
  do p = 1, 2
    call scene_destroy(parts(p))
  end do
  call scene_destroy(whole)
  call check_condensed()

contains

  ! Multipliers are eliminated where they act.
  subroutine check_condensed()
    real(c_double) :: host(3 * NA), lambda(3, NA), rows(3 * NA), gains(POSITIONS - 3 * NA), right(POSITIONS), total(POSITIONS)
    integer :: i
    call scene_init(whole)
    whole%method%multiplier_basis = STICKSLIP_BASIS_DUAL
    call scene_create(whole)
    host = [(0.05d0 * (mod(7 * i, 11) - 5), i = 0, 3 * NA - 1)]
    CHECK_OK(stickslip_interface_condensed_multipliers(whole%contact, whole%x1, whole%x2, host, whole%lambda))
    CHECK_OK(stickslip_interface_condensed_residual(whole%contact, whole%x1, whole%x2, whole%lambda, host, rows, gains))
    right = [rows, gains]
    total = 0
    do p = 1, 2
      call scene_init(parts(p))
      parts(p)%nonmortar%owned = c_loc(owned(1, p))
      parts(p)%method%multiplier_basis = STICKSLIP_BASIS_DUAL
      call scene_create(parts(p))
      associate (part => parts(p))
        CHECK_OK(stickslip_interface_condensed_multipliers(part%contact, whole%x1, whole%x2, host, lambda))
        do a = 1, NA
          if (owned(a, p) == STICKSLIP_NODE_OWN) CHECK(all(same(lambda(:, a), whole%lambda(:, a))))
        end do
        CHECK_OK(stickslip_interface_condensed_residual(part%contact, whole%x1, whole%x2, whole%lambda, host, rows, gains))
      end associate
      total = total + [rows, gains]
    end do
    CHECK_NEAR(total, right, ROUNDING_RESIDUAL * worst(right))
    do p = 1, 2
      call scene_destroy(parts(p))
    end do
    call scene_destroy(whole)
  end subroutine
end program
