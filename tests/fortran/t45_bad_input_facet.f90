! Facets without an area, folded or not convex, with a node twice, too warped or too steep to be projected. The messages
! count nodes and facets from 0.
#include "check.inc"
program t45_bad_input_facet
  use, intrinsic :: iso_c_binding
  use calls
  use check
  use pairs
  use scenes
  use stickslip
  implicit none
  ! A needle thinner than 1e-12, a line; a bow tie and an arrow head; a last edge that runs back over the first.
  integer, parameter :: BOW_TIE = 3, ARROW_HEAD = 4
  real(c_double), parameter :: SHAPES(3, 4, 5) = reshape( &
      [0d0, 0d0, 0d0, 1d0, 0d0, 0d0, 1d0, 1d-13, 0d0, 0d0, 1d-13, 0d0, &
       0d0, 0d0, 0d0, 1d0, 0d0, 0d0, 2d0, 0d0, 0d0, 3d0, 0d0, 0d0, &
       0d0, 0d0, 0d0, 1d0, 1d0, 0d0, 1d0, 0d0, 0d0, 0d0, 1d0, 0d0, &
       0d0, 0d0, 0d0, 1d0, 0d0, 0d0, 0.1d0, 0.1d0, 0d0, 0d0, 1d0, 0d0, &
       0d0, 0d0, 0d0, 1d0, 0d0, 0d0, 1d0, 1d0, 0d0, 2d0, 0d0, 0d0], [3, 4, 5])
  type(element), target, save :: e
  type(scene), target, save :: s
  type(handle), target, save :: h

  call shapes_refused()
  call duplicates()
  call counts()
  call surfaces()
  call evaluation()

contains

  subroutine shapes_refused()
    real(c_double), parameter :: STEEP(3, 4) = reshape([0.2d0, 0.2d0, 0d0, 0.8d0, 0.2d0, 0d0, 0.8d0, 0.2d0, 1d0, &
                                                        0.2d0, 0.2d0, 1d0], [3, 4])
    integer :: k
    call element_init(e)
    do k = 1, size(SHAPES, 3)
      e%x1 = SHAPES(:, :, k)
      CHECK_REFUSED(call_weights(e), STICKSLIP_DEGENERATE_FACET, 'facet')
      CHECK_REFUSED(call_facet(e), STICKSLIP_DEGENERATE_FACET, 'facet')
      CHECK_REFUSED(call_tangent(e), STICKSLIP_DEGENERATE_FACET, 'facet')
    end do
    e%x1 = quad1

    ! On the mortar side a facet that is not convex in the plane is refused; one seen edge-on covers nothing.
    do k = BOW_TIE, ARROW_HEAD
      e%x2 = SHAPES(:, :, k)
      if (k == BOW_TIE) e%x2(2, 3) = 0.2d0 ! one with an area
      CHECK_REFUSED(call_weights(e), STICKSLIP_PROJECTION_NOT_CONVEX, 'mortar facet')
    end do
    call element_untouched(e)
    e%x2 = STEEP
    CHECK_OK(call_weights(e))
    CHECK(all(e%w_out%ab == 0))
  end subroutine

  ! Two nodes at one place, next to each other or not.
  subroutine duplicates()
    integer :: j, k
    do k = 1, 4
      do j = 1, k - 1
        call element_init(e)
        e%x1(:, k) = e%x1(:, j)
        CHECK_REFUSED(call_weights(e), STICKSLIP_DUPLICATE_NODE, 'pair.x1')
        CHECK_REFUSED(call_gap(e), STICKSLIP_DUPLICATE_NODE, 'pair.x1')
        CHECK_REFUSED(call_residual(e), STICKSLIP_DUPLICATE_NODE, 'pair.x1')
        CHECK_REFUSED(call_tangent(e), STICKSLIP_DUPLICATE_NODE, 'pair.x1')
        CHECK_REFUSED(call_facet(e), STICKSLIP_DUPLICATE_NODE, 'x')
        e%x1 = quad1
        e%x2(:, k) = e%x2(:, j)
        CHECK_REFUSED(call_weights(e), STICKSLIP_DUPLICATE_NODE, 'pair.x2')
        call element_untouched(e)
      end do
    end do
  end subroutine

  ! Facets have 3 or 4 nodes.
  subroutine counts()
    integer(c_int32_t), parameter :: WRONG(8) = [-1, 0, 1, 2, 5, 8, INT32_MAX, INT32_MIN]
    integer :: k
    do k = 1, size(WRONG)
      call element_init(e)
      e%pair%n1 = WRONG(k)
      CHECK_REFUSED(call_weights(e), STICKSLIP_INVALID_SIZE, 'pair.x1')
      e%pair%n1 = 4
      e%pair%n2 = WRONG(k)
      CHECK_REFUSED(call_residual(e), STICKSLIP_INVALID_SIZE, 'pair.x2')
      CHECK_REFUSED(geometry(WRONG(k)), STICKSLIP_INVALID_SIZE, 'x')
      call element_untouched(e)
    end do
  end subroutine

  integer(c_int32_t) function geometry(n)
    integer(c_int32_t), intent(in) :: n
    geometry = stickslip_facet_geometry(n, e%x1, c_loc(e%normals), c_loc(e%areas))
  end function

  subroutine surfaces()
    integer(c_int64_t), target :: offsets(3) = [0, 3, 6], folded(6) = [1, 2, 3, 1, 3, 2], facing(6) = [1, 2, 5, 3, 4, 5]
    real(c_double), parameter :: BEYOND(2) = [1d0, 2.5d0]
    integer :: k

    ! A node of a facet in contact moves onto the opposite one, or beyond it: the facet is folded.
    do k = 1, 2
      call scene_init(s)
      s%reference1(:, 1) = BEYOND(k) * s%reference1(:, 5) + (1 - BEYOND(k)) * s%reference1(:, 1)
      CHECK_REFUSED(call_create(s), STICKSLIP_DEGENERATE_FACET, 'nonmortar facet 0')
      call scene_init(s)
      s%reference2(:, 6) = BEYOND(k) * s%reference2(:, 11) + (1 - BEYOND(k)) * s%reference2(:, 6)
      CHECK_REFUSED(call_create(s), STICKSLIP_DEGENERATE_FACET, 'mortar facet')
    end do

    ! A facet names a node twice.
    call scene_init(s)
    s%nodes1(3, 1) = s%nodes1(1, 1)
    CHECK_REFUSED(call_create(s), STICKSLIP_DUPLICATE_NODE, 'nonmortar: facet 0')
    call scene_init(s)
    s%nodes2(3, 1) = s%nodes2(1, 1)
    CHECK_REFUSED(call_create(s), STICKSLIP_DUPLICATE_NODE, 'mortar: facet 0')

    ! A node of the surface that no facet uses.
    call scene_init(s)
    s%nonmortar%n_facets = 3
    CHECK_REFUSED(call_create(s), STICKSLIP_INVALID_VALUE, 'nonmortar: node 8')

    ! Facets that lie on each other, along all their edges.
    call scene_init(s)
    s%nonmortar%n_nodes = 3
    s%nonmortar%n_facets = 2
    s%nonmortar%facet_offsets = c_loc(offsets)
    s%nonmortar%facet_nodes = c_loc(folded)
    s%reference1(:, 3) = s%reference1(:, 5) ! not in line
    CHECK_REFUSED(call_create(s), STICKSLIP_INVALID_VALUE, 'facets 0 and 1')

    ! Facets that look in opposite directions around a node, their only one in common: its normal has no direction.
    call scene_init(s)
    s%nonmortar%n_nodes = 5
    s%nonmortar%n_facets = 2
    s%nonmortar%facet_offsets = c_loc(offsets)
    s%nonmortar%facet_nodes = c_loc(facing)
    CHECK_REFUSED(call_create(s), STICKSLIP_UNDEFINED_NORMAL, 'non-mortar node 4')
  end subroutine

  ! Within Newton the same is a domain error: refused, and the handle goes on.
  subroutine evaluation()
    real(c_double) :: kept(3)
    integer :: k
    call handle_init(h)
    do k = 1, EVALUATIONS
      kept = h%s%x1(:, 5)
      h%s%x1(:, 5) = h%s%x1(:, 1)
      CHECK_REFUSED(evaluate(k, h), STICKSLIP_DEGENERATE_FACET, 'nonmortar facet')
      h%s%x1(:, 5) = kept

      kept = h%s%x2(:, 6)
      h%s%x2(:, 6) = 0.5d0 * (h%s%x2(:, 11) + kept) + 1.5d0 * (h%s%x2(:, 11) - kept)
      CHECK_REFUSED(evaluate(k, h), STICKSLIP_PROJECTION_NOT_CONVEX, 'mortar facet')
      h%s%x2(:, 6) = kept
    end do
    call handle_untouched(h)
    do k = 1, EVALUATIONS
      CHECK_OK(evaluate(k, h))
    end do
    call scene_destroy(h%s)
  end subroutine
end program
