! Contact as user elements: how a pair of facets becomes an element of a code that knows nothing but elements.
!
! The pair element has 6 to 8 nodes: a non-mortar facet of 3 or 4 and a mortar facet of 3 or 4. A connectivity of fixed
! length is padded with zeros: ix(1:4) are the non-mortar nodes, ix(4) = 0 for a triangle; ix(5:8) the mortar nodes,
! ix(8) = 0 for a triangle. A node has six places, three displacements and three multipliers; the multipliers' places of
! mortar nodes are not used. What is padded or not used stays zero in s and p.
!
! Two passes over all pairs in each iteration, between them the nodes:
!
!   pass 1   elmt_contact, isw = gaps      weights into h2; coverage and gaps are summed to the nodes
!   nodes    elmt_contact_node             an element of one node: the contact law, the multiplier's own row and block
!   pass 2   elmt_contact, isw = tangent   forces p and tangent s of the pair
!
! The law needs the sums over all pairs. Where a code makes one pass over its elements only, like Abaqus, all pairs
! together have to be one user element: uel.f90.
!
! History: the weights of a pair, 32 numbers. h1 are those of t_n, h2 those of now. The code copies h2 to h1 when a step
! has converged; a step that is repeated starts from h1 again. FEAP: hr(nh1) and hr(nh2).
!
! Signs: p are internal forces, FEAP's p is minus that; multipliers are minus the traction on the non-mortar body. The
! tangent s is exact and not symmetric.
module contact_elements
  use, intrinsic :: iso_c_binding, only: c_int32_t, c_int64_t, c_loc, c_null_ptr, c_ptr
  use block_model, only: dp, ndf, ndm, nen, nst
  use contact_nodes
  use stickslip
  implicit none

  integer, parameter :: start = 0, gaps = 1, tangent = 2 ! tasks, like FEAP's isw
  integer, parameter :: nh = 32                          ! n_ab from h(1) on, n_ac from h(17) on, row by row; the rest 0
  integer, parameter :: kmax = 6 * 4 + 3 * 4             ! unknowns of two quadrilaterals

contains

  subroutine elmt_contact(isw, ix, xl, ul, h1, h2, s, p)
    integer, intent(in) :: isw, ix(nen)
    real(dp), intent(in) :: xl(ndm, nen), ul(ndf, nen) ! positions of the undeformed body; displacements, multipliers
    real(dp), intent(in), target :: h1(nh)
    real(dp), intent(inout), target :: h2(nh)          ! written by start and gaps
    real(dp), intent(out) :: s(nst, nst), p(ndf, nen)  ! computed by tangent, otherwise zero
    real(dp), target :: x1(3, 4), x2(3, 4)
    type(stickslip_pair) :: pair

    s = 0
    p = 0
    x1 = xl(:, 1:4) + ul(1:3, 1:4)
    x2 = xl(:, 5:8) + ul(1:3, 5:8)
    pair%n1 = count(ix(1:4) /= 0, kind=c_int32_t)
    pair%n2 = count(ix(5:8) /= 0, kind=c_int32_t)
    pair%x1 = c_loc(x1)
    pair%x2 = c_loc(x2)
    pair%layout = STICKSLIP_LAYOUT_COLUMN_MAJOR
    select case (isw)
    case (start) ! the weights of these positions, for h1
      call must(stickslip_pair_weights(pair, c_loc(h2(1)), c_loc(h2(17)), c_null_ptr, c_null_ptr))
    case (gaps)
      if (current_weights) &
          call must(stickslip_pair_weights(pair, c_loc(h2(1)), c_loc(h2(17)), c_null_ptr, c_null_ptr))
      call sum_gaps(pair, ix, h2, gap_now, coverage)
      call sum_gaps(pair, ix, h1, gap_previous)
    case (tangent)
      if (overlaps(h1) .or. overlaps(h2)) call forces_and_tangent(pair, ix, ul(4:6, 1:4), h1, h2, s, p)
    end select
  end subroutine

  logical function overlaps(h)
    real(dp), intent(in) :: h(nh)
    overlaps = any(abs(h) > 0)
  end function

  ! The pair's gaps with the weights h, and the area they cover (row A of n_ab sums to node A's), added to its nodes.
  subroutine sum_gaps(pair, ix, h, gap, covered)
    type(stickslip_pair), intent(in) :: pair
    integer, intent(in) :: ix(nen)
    real(dp), intent(in) :: h(nh)
    real(dp), intent(inout) :: gap(:, :)
    real(dp), intent(inout), optional :: covered(:)
    real(dp) :: g(3, 4)
    integer :: a
    if (.not. overlaps(h)) return
    call must(stickslip_pair_gap(pair, h(1:16), h(17:32), g))
    do a = 1, pair%n1
      gap(:, ix(a)) = gap(:, ix(a)) + g(:, a)
      if (present(covered)) covered(ix(a)) = covered(ix(a)) + sum(h(pair%n1 * (a - 1) + 1:pair%n1 * a))
    end do
  end subroutine

  subroutine forces_and_tangent(pair, ix, lambda, h1, h2, s, p)
    type(stickslip_pair), intent(in) :: pair
    integer, intent(in) :: ix(nen)
    real(dp), intent(in) :: lambda(3, 4)
    real(dp), intent(in), target :: h1(nh), h2(nh)
    real(dp), intent(inout) :: s(nst, nst), p(ndf, nen)
    real(dp), target :: dn_ab(24 * 16), dn_ac(24 * 16), scales(4)
    type(c_ptr) :: n_ab, n_ac, previous_ab, previous_ac, derivative_ab, derivative_ac
    type(stickslip_node_response) :: responses(4)
    real(dp) :: force(3, 8), k(kmax, kmax)
    integer :: n1, n2, m, place(kmax)

    n1 = pair%n1
    n2 = pair%n2
    n_ab = c_null_ptr ! stays so where the pair does not overlap now, previous_ab where it did not at t_n,
    n_ac = c_null_ptr ! derivative_ab where the weights are frozen
    previous_ab = c_null_ptr
    previous_ac = c_null_ptr
    derivative_ab = c_null_ptr
    derivative_ac = c_null_ptr
    if (overlaps(h1)) then
      previous_ab = c_loc(h1(1))
      previous_ac = c_loc(h1(17))
    end if
    if (overlaps(h2)) then
      n_ab = c_loc(h2(1))
      n_ac = c_loc(h2(17))
      call must(stickslip_pair_residual(pair, h2(1:16), h2(17:32), lambda, force))
      p(1:3, 1:n1) = force(:, 1:n1)
      p(1:3, 5:4 + n2) = force(:, n1 + 1:n1 + n2)
      if (current_weights) then
        derivative_ab = c_loc(dn_ab)
        derivative_ac = c_loc(dn_ac)
        call must(stickslip_pair_weights(pair, c_null_ptr, c_null_ptr, derivative_ab, derivative_ac))
      end if
    end if
    responses(1:n1) = response(ix(1:n1))
    scales(1:n1) = row_scale(ix(1:n1))
    call must(stickslip_pair_tangent(pair, n_ab, n_ac, derivative_ab, derivative_ac, previous_ab, previous_ac, lambda, &
        responses, c_loc(scales), k, int(kmax, c_int64_t)))
    call places(n1, n2, place, m)
    s(place(1:m), place(1:m)) = k(1:m, 1:m)
  end subroutine

  ! Where the pair's unknowns, x1, x2 and lambda node by node, are in s.
  subroutine places(n1, n2, place, m)
    integer, intent(in) :: n1, n2
    integer, intent(out) :: place(kmax), m
    integer :: a, i
    m = 6 * n1 + 3 * n2
    place(1:m) = [([(ndf * (a - 1) + i, i = 1, 3)], a = 1, n1), ([(ndf * (a - 1) + i, i = 1, 3)], a = 5, 4 + n2), &
        ([(ndf * (a - 1) + i, i = 4, 6)], a = 1, n1)]
  end subroutine

  ! The node as an element of one node: contact law, multiplier row and its derivative by the multiplier. For every
  ! non-mortar node, covered or not, between the passes; pass 2 uses its response.
  subroutine elmt_contact_node(n, ul, s, p)
    integer, intent(in) :: n
    real(dp), intent(in) :: ul(ndf)
    real(dp), intent(out) :: s(ndf, ndf), p(ndf)
    real(dp), target :: row(3), matrix(3, 3)
    call respond(n, ul(4:6))
    call must(stickslip_node_block(response(n), row_scale(n), STICKSLIP_LAYOUT_COLUMN_MAJOR, c_loc(row), c_loc(matrix)))
    s = 0
    p = 0
    p(4:6) = row
    s(4:6, 4:6) = matrix
  end subroutine
end module
