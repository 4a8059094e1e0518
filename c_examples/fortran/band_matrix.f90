! The assembled system: a banded matrix as LAPACK's dgbsv stores it, and the nodal forces.
module band_matrix
  use, intrinsic :: iso_fortran_env, only: error_unit
  use block_model, only: band, dp, id, maxeq, ndf, neq, numnp
  implicit none

  ! ab(2 band + 1 + i - j, j) = k(i, j); dgbsv fills in the first `band` rows.
  integer, parameter :: ldab = 3 * band + 1
  real(dp) :: ab(ldab, maxeq)

  interface
    subroutine dgbsv(n, kl, ku, nrhs, ab, ldab, ipiv, b, ldb, info)
      import :: dp
      integer, intent(in) :: n, kl, ku, nrhs, ldab, ldb
      real(dp), intent(inout) :: ab(ldab, *), b(ldb, *)
      integer, intent(out) :: ipiv(*), info
    end subroutine
  end interface

contains

  ! Element matrix s and forces p into the band and the nodal forces f; nodes without a number are padding.
  subroutine assemble(nodes, s, p, f)
    integer, intent(in) :: nodes(:)
    real(dp), intent(in) :: s(:, :), p(:, :)
    real(dp), intent(inout) :: f(ndf, numnp)
    integer :: equations(ndf * size(nodes)), a, i, j
    do a = 1, size(nodes)
      equations(ndf * (a - 1) + 1:ndf * a) = 0
      if (nodes(a) == 0) cycle
      equations(ndf * (a - 1) + 1:ndf * a) = id(:, nodes(a))
      f(:, nodes(a)) = f(:, nodes(a)) + p(:, a)
    end do
    do j = 1, size(equations)
      do i = 1, size(equations)
        if (equations(i) > 0 .and. equations(j) > 0) call add(equations(i), equations(j), s(i, j))
      end do
    end do
  end subroutine

  subroutine add(i, j, value)
    integer, intent(in) :: i, j
    real(dp), intent(in) :: value
    if (abs(i - j) > band) call stop_with('an entry lies outside the band; a larger one is needed')
    ab(2 * band + 1 + i - j, j) = ab(2 * band + 1 + i - j, j) + value
  end subroutine

  ! Solves k step = b in place; the matrix is lost.
  subroutine solve(b)
    real(dp), intent(inout) :: b(:)
    integer :: pivots(maxeq), info
    call dgbsv(neq, band, band, 1, ab, ldab, pivots, b, size(b), info)
    if (info /= 0) call stop_with('dgbsv finds the matrix singular; is every body held?')
  end subroutine

  subroutine stop_with(why)
    character(*), intent(in) :: why
    write (error_unit, '(2a)') 'block_fortran: ', why
    stop 1
  end subroutine
end module
