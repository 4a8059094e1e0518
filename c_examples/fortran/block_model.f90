! The model of the block: sizes, material, mesh, unknowns and loads, in fixed arrays as old codes have them.
!
! An elastic block, 4 x 1 x 2, on a rigid foundation whose mesh does not match; plane strain: y is fixed. It is pressed
! by 200 per area on its top (time 0 to 1), then pushed by 60 on its left side (time 1 to 2); friction 0.2: the problem
! of scenes/block_bottom_mu02.yaml. Here half of the foundation's facets are cut into triangles, so that there are
! contact elements with seven and with eight nodes; on a flat foundation the answer stays. Any consistent units.
!
! Every node has ndf = 6 places, three displacements and three multipliers. A place without an equation has id = 0.
module block_model
  use, intrinsic :: iso_c_binding, only: dp => c_double
  implicit none

  integer, parameter :: ndm = 3, ndf = 6, nen = 8, nst = ndf * nen
  integer, parameter :: mx = 20, my = 1, mz = 10          ! elements of the block along x, y, z
  integer, parameter :: fx = 13, fy = 3                   ! quadrilaterals of the foundation
  integer, parameter :: plane = (my + 1) * (mz + 1)       ! nodes with the same x; they are numbered plane by plane
  integer, parameter :: nblock = (mx + 1) * plane, numnp = nblock + (fx + 1) * (fy + 1)
  integer, parameter :: numel = mx * my * mz, nf1 = mx * my
  integer, parameter :: nf2 = fx * fy + (fx * fy + 1) / 2 ! every other one is two triangles
  integer, parameter :: numpair = nf1 * nf2
  integer, parameter :: maxeq = ndf * numnp
  ! Equations of two neighbouring planes, each with x and z of its nodes and of the multipliers at its bottom.
  integer, parameter :: band = 2 * 2 * (plane + my + 1) - 1

  real(dp), parameter :: young = 1000, poisson = 0.3_dp, friction = 0.2_dp
  real(dp), parameter :: model_size = norm2([5.0_dp, 2.0_dp, 3.0_dp]) ! the box around both bodies
  real(dp), parameter :: block(3) = [4, 1, 2], press = -200, end_time = 2
  real(dp) :: push = 60

  real(dp) :: x(ndm, numnp)          ! positions of the undeformed bodies
  real(dp) :: u(ndf, numnp)          ! displacements, multipliers; zero where there is no equation
  real(dp) :: load(ndf, numnp)       ! external forces of the present time
  integer :: ix(nen, numel)          ! solid elements: lower face counter-clockwise seen from above, then the upper
  ! Facets, 1 non-mortar, 2 mortar: right-hand order seen from outside the body; a triangle's fourth node is 0.
  integer :: ixf1(4, nf1), ixf2(4, nf2)
  integer :: ixc(nen, numpair)       ! contact elements: a non-mortar facet and a mortar facet
  integer :: id(ndf, numnp), neq     ! equation numbers, 0: none

contains

  integer function block_node(i, j, k)
    integer, intent(in) :: i, j, k
    block_node = i * plane + k * (my + 1) + j + 1
  end function

  integer function foundation_node(i, j)
    integer, intent(in) :: i, j
    foundation_node = nblock + i * (fy + 1) + j + 1
  end function

  subroutine make_mesh
    integer :: i, j, k, e, f, corners(4)
    do i = 0, mx
      do k = 0, mz
        do j = 0, my
          x(:, block_node(i, j, k)) = block * [i, j, k] / [mx, my, mz]
        end do
      end do
    end do
    do i = 0, fx
      do j = 0, fy
        x(:, foundation_node(i, j)) = [-0.5_dp + 5.0_dp * i / fx, -0.5_dp + 2.0_dp * j / fy, 0.0_dp]
      end do
    end do
    e = 0
    do i = 0, mx - 1
      do k = 0, mz - 1
        do j = 0, my - 1
          e = e + 1
          ix(1:4, e) = [block_node(i, j, k), block_node(i + 1, j, k), block_node(i + 1, j + 1, k), &
              block_node(i, j + 1, k)]
          ix(5:8, e) = ix(1:4, e) + my + 1
        end do
      end do
    end do
    f = 0
    do i = 0, mx - 1 ! seen from below: the normal points out of the block
      do j = 0, my - 1
        f = f + 1
        ixf1(:, f) = [block_node(i, j, 0), block_node(i, j + 1, 0), block_node(i + 1, j + 1, 0), &
            block_node(i + 1, j, 0)]
      end do
    end do
    f = 0
    do i = 0, fx - 1 ! seen from above
      do j = 0, fy - 1
        corners = [foundation_node(i, j), foundation_node(i + 1, j), foundation_node(i + 1, j + 1), &
            foundation_node(i, j + 1)]
        f = f + 1
        ixf2(:, f) = corners
        if (mod(i + j, 2) == 1) cycle
        ixf2(:, f) = [corners(1:3), 0]
        f = f + 1
        ixf2(:, f) = [corners(3), corners(4), corners(1), 0]
      end do
    end do
    call make_pairs
  end subroutine

  ! All pairs of facets: what a code without a search can do. Pairs that do not overlap cost a look at their weights and
  ! are skipped. The surfaces must face each other: nothing here keeps the far side of a body away.
  subroutine make_pairs
    integer :: f1, f2, k
    k = 0
    do f1 = 1, nf1
      do f2 = 1, nf2
        k = k + 1
        ixc(1:4, k) = ixf1(:, f1)
        ixc(5:8, k) = ixf2(:, f2)
      end do
    end do
  end subroutine

  ! Node by node, so that the multipliers of a node follow its displacements and the band stays narrow. Along y both
  ! sides are held: neither displacement nor multiplier is unknown. The foundation is rigid.
  subroutine number_equations
    integer :: n
    logical :: carries_multiplier
    id = 0
    neq = 0
    do n = 1, nblock
      carries_multiplier = any(ixf1 == n)
      call number_place(1, n)
      call number_place(3, n)
      if (carries_multiplier) then
        call number_place(4, n)
        call number_place(6, n)
      end if
    end do
  end subroutine

  subroutine number_place(i, n)
    integer, intent(in) :: i, n
    neq = neq + 1
    id(i, n) = neq
  end subroutine

  ! A constant traction on a rectangle: a quarter of its force at each corner.
  subroutine set_loads(time)
    real(dp), intent(in) :: time
    real(dp) :: top, left
    integer :: e, a
    top = press * min(time, 1.0_dp) * block(1) * block(2) / (mx * my) / 4
    left = push * max(time - 1, 0.0_dp) * block(2) * block(3) / (my * mz) / 4
    load = 0
    do e = 1, numel
      do a = 1, nen
        if (mod(ix(a, e) - 1, plane) / (my + 1) == mz) load(3, ix(a, e)) = load(3, ix(a, e)) + top
        if (ix(a, e) <= plane) load(1, ix(a, e)) = load(1, ix(a, e)) + left
      end do
    end do
  end subroutine
end module
