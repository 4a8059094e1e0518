! Residual and tangent of a whole interface: against central differences in every form and with every kind of weights;
! COO and CSR; missing equations; 0-based indices against the 1-based ones that all else is done with.
#include "check.inc"
program t31_interface_residual_tangent
  use, intrinsic :: iso_c_binding
  use check
  use scenes
  use stickslip
  implicit none
  ! Central differences on affine facets: rounding 1e-16 / 1e-6 and truncation, relative to a block's largest entry or
  ! to SMALL_BLOCK of the whole matrix's.
  real(c_double), parameter :: STEP = 1d-6, DIFFERENCE = 1d-7, SMALL_BLOCK = 1d-2
  ! Duplicates are summed in another order.
  real(c_double), parameter :: ROUNDING = 1d-13
  type(scene), target, save :: s
  type(triplets), target, save :: t
  real(c_double), save :: k(UNKNOWNS, UNKNOWNS), fd(UNKNOWNS, UNKNOWNS), csr(UNKNOWNS, UNKNOWNS)
  integer(c_int64_t), save :: offsets(UNKNOWNS + 1), columns(UNKNOWNS, UNKNOWNS)
  integer(c_int32_t) :: form, kind_of_weights, slip
  real(c_double) :: r(UNKNOWNS)
  integer :: i, twice

  do form = 0, 1
    do kind_of_weights = STICKSLIP_WEIGHTS_CURRENT, STICKSLIP_WEIGHTS_REFERENCE
      do slip = 0, 2
        call scene_init(s)
        s%method%form = form
        s%method%weights = kind_of_weights
        s%method%slip = slip
        call scene_create(s)
        ! On the way it counts the entries with null arrays.
        call scene_dense(s, t, k)
        call differences()
        CHECK(block_difference(k, fd, SMALL_BLOCK * worst(k)) < DIFFERENCE)

        ! A full CSR matrix whose rows list their columns backwards: the tangent is added to what is there. A row of the
        ! matrix is a column of the Fortran array.
        offsets = [(1 + i * UNKNOWNS, i = 0, UNKNOWNS)]
        columns = spread([(i, i = UNKNOWNS, 1, -1)], 2, UNKNOWNS)
        csr = 0.5d0
        do twice = 1, 2
          call add_tangent()
        end do
        csr = transpose(csr(UNKNOWNS:1:-1, :))
        CHECK_NEAR((csr - (0.5d0 + 2 * k)) / (1 + abs(0.5d0 + 2 * k)), 0d0, ROUNDING)
        call scene_destroy(s)
      end do
    end do
  end do

  ! Components without an equation are left out of the tangent, not of the residual.
  call scene_init(s)
  s%equations2 = -1
  s%multipliers(2, 2) = -1
  call scene_create(s)
  call scene_tangent(s, t)
  CHECK(all(t%rows <= SIZE1 .or. t%rows > POSITIONS))
  CHECK(all(t%rows /= POSITIONS + 5 .and. t%columns /= POSITIONS + 5))
  call scene_residual(s, r)
  CHECK(any(r(SIZE1 + 1:POSITIONS) /= 0))
  call scene_destroy(s)

  ! Index base 0: node numbers, equations, rows, columns and CSR offsets; facet offsets start at 0 in any case.
  call scene_init(s)
  call scene_create(s)
  call scene_dense(s, t, k)
  call scene_destroy(s)
  call scene_init(s, 0)
  call scene_create(s)
  call scene_dense(s, t, fd)
  CHECK(minval(t%rows) == 0 .and. minval(t%columns) == 0)
  CHECK(all(same(k, fd)))
  offsets = [(i * UNKNOWNS, i = 0, UNKNOWNS)]
  columns = spread([(i, i = 0, UNKNOWNS - 1)], 2, UNKNOWNS)
  csr = 0
  call add_tangent()
  CHECK(all(same(transpose(csr), k)))
  call scene_destroy(s)

contains

  subroutine add_tangent()
    integer(c_int32_t) :: status
    status = stickslip_interface_tangent_csr(s%contact, s%x1, s%x2, s%lambda, c_null_ptr, &
        int(UNKNOWNS, c_int64_t), offsets, columns, csr)
    CHECK_OK(status)
  end subroutine

  subroutine differences()
    call differences_by(s%x1, 0)
    call differences_by(s%x2, SIZE1)
    call differences_by(s%lambda, POSITIONS)
  end subroutine

  ! The columns of fd behind `before` for these coordinates of the scene.
  subroutine differences_by(x, before)
    real(c_double), target, intent(inout) :: x(:, :)
    integer, intent(in) :: before
    real(c_double) :: plus(UNKNOWNS), minus(UNKNOWNS), at
    integer :: n, j
    do n = 1, size(x, 2)
      do j = 1, 3
        at = x(j, n)
        x(j, n) = at + STEP
        call scene_residual(s, plus)
        x(j, n) = at - STEP
        call scene_residual(s, minus)
        x(j, n) = at
        fd(:, before + 3 * n - 3 + j) = (plus - minus) / (2 * STEP)
      end do
    end do
  end subroutine
end program
