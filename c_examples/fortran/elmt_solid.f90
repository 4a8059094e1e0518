! Solid element: hexahedron with 8 nodes, linear elastic, 2 x 2 x 2 Gauss points.
!
! Stiffness s = int B^T C B dV [F/L] and internal forces p = s u [F], in the places of the displacements; the others
! stay zero.
module solid_element
  use block_model, only: dp, ndf, ndm, nen, nst, poisson, young
  implicit none

  real(dp), parameter :: lame = young * poisson / ((1 + poisson) * (1 - 2 * poisson))
  real(dp), parameter :: shear = young / (2 * (1 + poisson))
  ! Corners of the reference element [-1, 1]^3; divided by sqrt(3), the Gauss points, all of weight 1.
  real(dp), parameter :: corner(ndm, nen) = reshape(real([ &
      -1, -1, -1, 1, -1, -1, 1, 1, -1, -1, 1, -1, -1, -1, 1, 1, -1, 1, 1, 1, 1, -1, 1, 1], dp), [ndm, nen])

contains

  subroutine elmt_solid(xl, ul, s, p)
    real(dp), intent(in) :: xl(ndm, nen), ul(ndf, nen)
    real(dp), intent(out) :: s(nst, nst), p(ndf, nen)
    real(dp) :: g(ndm, nen), volume, dot
    integer :: q, a, b, i, j, row, column
    s = 0
    do q = 1, nen
      call gradients(xl, corner(:, q) / sqrt(3.0_dp), g, volume)
      do b = 1, nen
        do a = 1, nen
          dot = dot_product(g(:, a), g(:, b))
          do j = 1, ndm
            do i = 1, ndm
              row = ndf * (a - 1) + i
              column = ndf * (b - 1) + j
              s(row, column) = s(row, column) + volume * (lame * g(i, a) * g(j, b) + shear * g(j, a) * g(i, b))
              if (i == j) s(row, column) = s(row, column) + volume * shear * dot
            end do
          end do
        end do
      end do
    end do
    p = reshape(matmul(s, reshape(ul, [nst])), [ndf, nen])
  end subroutine

  ! g = dN/dX of all nodes at the reference point xi, and det dX/dxi.
  subroutine gradients(xl, xi, g, det)
    real(dp), intent(in) :: xl(ndm, nen), xi(ndm)
    real(dp), intent(out) :: g(ndm, nen), det
    real(dp) :: d(ndm, nen), jacobian(ndm, ndm), adjugate(ndm, ndm), t(ndm)
    integer :: a, i, k
    do a = 1, nen
      t = 1 + corner(:, a) * xi
      d(:, a) = corner(:, a) * [t(2) * t(3), t(3) * t(1), t(1) * t(2)] / 8
    end do
    jacobian = matmul(xl, transpose(d)) ! (i, k): dX_i / dxi_k
    do i = 1, ndm
      do k = 1, ndm
        associate (i1 => mod(i, 3) + 1, i2 => mod(i + 1, 3) + 1, k1 => mod(k, 3) + 1, k2 => mod(k + 1, 3) + 1)
          adjugate(k, i) = jacobian(i1, k1) * jacobian(i2, k2) - jacobian(i1, k2) * jacobian(i2, k1)
        end associate
      end do
    end do
    det = dot_product(jacobian(1, :), adjugate(:, 1))
    g = matmul(transpose(adjugate), d) / det
  end subroutine
end module
