! The assembled system: a matrix in a profile, each row from its first to its last column, which is compressed sparse rows
! without gaps; and its LU without exchanging rows, as old codes have it.
module profile_matrix
  use, intrinsic :: iso_c_binding, only: c_int64_t
  use, intrinsic :: iso_fortran_env, only: error_unit
  use block_model, only: dp, id, maxeq, ndf, neq, nen, numnp
  implicit none

  integer(c_int64_t) :: first(maxeq), last(maxeq), start(maxeq + 1)
  integer(c_int64_t), allocatable :: columns(:)
  real(dp), allocatable :: entries(:)
  real(dp) :: smallest_pivot = huge(1.0_dp) ! over the largest diagonal entry, in all solutions

contains

  subroutine clear_profile
    integer :: i
    first = [(i, i = 1, maxeq)]
    last = first
  end subroutine

  subroutine widen(row, column)
    integer(c_int64_t), intent(in) :: row, column
    first(row) = min(first(row), column)
    last(row) = max(last(row), column)
  end subroutine

  subroutine widen_by_element(nodes)
    integer, intent(in) :: nodes(nen)
    integer(c_int64_t) :: equations(3 * nen)
    integer :: i, j
    equations = reshape(id(1:3, nodes), [3 * nen])
    do j = 1, size(equations)
      do i = 1, size(equations)
        if (equations(i) > 0 .and. equations(j) > 0) call widen(equations(i), equations(j))
      end do
    end do
  end subroutine

  ! Room for what `widen` was told. What a row has, elimination hands on to the rows below: they end no sooner.
  subroutine make_profile
    integer :: i
    integer(c_int64_t) :: k
    start(1) = 1
    do i = 2, neq
      last(i) = max(last(i), last(i - 1))
    end do
    do i = 1, neq
      start(i + 1) = start(i) + last(i) - first(i) + 1
    end do
    if (allocated(columns)) deallocate (columns, entries)
    allocate (columns(start(neq + 1) - 1), entries(start(neq + 1) - 1))
    do i = 1, neq
      columns(start(i):start(i + 1) - 1) = [(k, k = first(i), last(i))]
    end do
  end subroutine

  ! Element matrix s and forces p, in the places of displacements, into the matrix and the nodal forces f.
  subroutine assemble(nodes, s, p, f)
    integer, intent(in) :: nodes(nen)
    real(dp), intent(in) :: s(:, :), p(:, :)
    real(dp), intent(inout) :: f(3, numnp)
    integer :: equations(ndf * nen), i, j
    integer(c_int64_t) :: k
    f(:, nodes) = f(:, nodes) + p(1:3, :)
    equations = reshape(id(:, nodes), [ndf * nen])
    do j = 1, size(equations)
      do i = 1, size(equations)
        if (equations(i) == 0 .or. equations(j) == 0) cycle
        k = start(equations(i)) + equations(j) - first(equations(i))
        entries(k) = entries(k) + s(i, j)
      end do
    end do
  end subroutine

  ! Solves matrix step = b in place by LU without exchanging rows; the matrix is lost.
  subroutine solve(b)
    real(dp), intent(inout) :: b(:)
    integer(c_int64_t) :: i, k, n, at, diagonal
    real(dp) :: largest, factor
    largest = maxval([(abs(entries(start(i) + i - first(i))), i = 1, neq)])
    do i = 1, neq
      do k = first(i), i - 1
        at = start(i) + k - first(i)
        diagonal = start(k) + k - first(k)
        n = last(k) - k
        factor = entries(at) / entries(diagonal)
        if (.not. abs(factor) > 0) cycle
        entries(at + 1:at + n) = entries(at + 1:at + n) - factor * entries(diagonal + 1:diagonal + n)
        b(i) = b(i) - factor * b(k)
      end do
      diagonal = start(i) + i - first(i)
      if (.not. abs(entries(diagonal)) > 0) call stop_with('a pivot is zero; is every body held?')
      smallest_pivot = min(smallest_pivot, abs(entries(diagonal)) / largest)
    end do
    do i = neq, 1, -1
      diagonal = start(i) + i - first(i)
      n = last(i) - i
      b(i) = (b(i) - dot_product(entries(diagonal + 1:diagonal + n), b(i + 1:i + n))) / entries(diagonal)
    end do
  end subroutine

  subroutine stop_with(why)
    character(*), intent(in) :: why
    write (error_unit, '(2a)') 'profile_host: ', why
    stop 1
  end subroutine
end module
