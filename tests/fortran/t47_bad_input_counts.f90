! Counts and offsets: negative, too small, far too large, decreasing. The messages count offsets from 0.
#include "check.inc"
program t47_bad_input_counts
  use, intrinsic :: iso_c_binding
  use calls
  use check
  use pairs
  use scenes
  use stickslip
  implicit none
  type(scene), target, save :: s
  type(element), target, save :: e
  type(handle), target, save :: h

  call surfaces()
  call facet_offsets()
  call handle_init(h)
  call handle_counts()
  call row_offsets()
  call handle_untouched(h)
  call scene_destroy(h%s)
  call leading_dimensions()

contains

  ! The smallest number that leaves the integers when it is multiplied by n.
  integer(c_int64_t) function beyond(n)
    integer, intent(in) :: n
    beyond = INT64_MAX / n + 1
  end function

  subroutine surfaces()
    integer(c_int64_t) :: counts(9)
    integer :: k
    ! The last two are too few nodes.
    counts = [INT64_MIN, -1_c_int64_t, 0_c_int64_t, INT64_MAX, beyond(3), beyond(24), 2_c_int64_t**62, 1_c_int64_t, &
              2_c_int64_t]
    do k = 1, 9
      call scene_init(s)
      s%nonmortar%n_nodes = counts(k)
      CHECK_REFUSED(call_create(s), STICKSLIP_INVALID_SIZE, 'nonmortar.n_nodes')
      call scene_init(s)
      s%mortar%n_nodes = counts(k)
      CHECK_REFUSED(call_create(s), STICKSLIP_INVALID_SIZE, 'mortar.n_nodes')
      if (k > 7) cycle
      call scene_init(s)
      s%nonmortar%n_facets = counts(k)
      CHECK_REFUSED(call_create(s), STICKSLIP_INVALID_SIZE, 'nonmortar.n_facets')
      call scene_init(s)
      s%mortar%n_facets = counts(k)
      CHECK_REFUSED(call_create(s), STICKSLIP_INVALID_SIZE, 'mortar.n_facets')
    end do
  end subroutine

  ! Facets have 3 or 4 nodes, so offsets grow by 3 or 4 from 0, in either base.
  subroutine facet_offsets()
    integer(c_int64_t) :: first(4), second(7)
    integer :: base, k
    first = [1_c_int64_t, -4_c_int64_t, INT64_MIN, INT64_MAX]
    second = [-4_c_int64_t, 0_c_int64_t, 2_c_int64_t, 5_c_int64_t, 8_c_int64_t, INT64_MAX, INT64_MIN]
    do base = 0, 1
      do k = 1, size(first)
        call scene_init(s, base)
        s%offsets1(1) = first(k)
        CHECK_REFUSED(call_create(s), STICKSLIP_INVALID_SIZE, 'nonmortar.facet_offsets[0]')
      end do
      do k = 1, size(second)
        call scene_init(s, base)
        s%offsets2(2) = second(k)
        CHECK_REFUSED(call_create(s), STICKSLIP_INVALID_SIZE, 'mortar.facet_offsets[1]')
        call scene_init(s, base)
        s%offsets2(10) = merge(0_c_int64_t, second(k), second(k) == 2) ! decreasing at the end
        CHECK_REFUSED(call_create(s), STICKSLIP_INVALID_SIZE, 'mortar.facet_offsets[9]')
      end do
    end do
  end subroutine

  subroutine handle_counts()
    integer(c_int64_t), parameter :: NINE = 9
    integer(c_int64_t) :: wrong(4)
    integer :: k
    wrong = [INT64_MIN, -1_c_int64_t, INT64_MAX, beyond(8)]
    do k = 1, 4
      CHECK_REFUSED(set_constraints(wrong(k)), STICKSLIP_INVALID_SIZE, 'n')
      CHECK_REFUSED(csr(wrong(k)), STICKSLIP_INVALID_SIZE, 'n_rows')
      CHECK_REFUSED(import(wrong(k), NINE), STICKSLIP_INVALID_SIZE, 'n_integers')
      CHECK_REFUSED(import(NINE, wrong(k)), STICKSLIP_INVALID_SIZE, 'n_reals')
    end do
    CHECK_REFUSED(csr(0_c_int64_t), STICKSLIP_INVALID_SIZE, 'n_rows')
  end subroutine

  ! CSR offsets: not from the base, decreasing, huge.
  subroutine row_offsets()
    integer, parameter :: AT(7) = [1, 1, 8, 8, 8, UNKNOWNS + 1, UNKNOWNS + 1]
    ! Of two numbers that decrease the second one is named, in C's count; after the largest integer any does.
    character(*), parameter :: NAMES(7) = [character(19) :: 'row_offsets[0] is', 'row_offsets[0] is', &
        'row_offsets[7] is', 'row_offsets[8] is', 'row_offsets[7] is', 'row_offsets[n_rows]', 'row_offsets[']
    integer(c_int64_t) :: values(7), kept
    integer :: k
    values = [0_c_int64_t, -1_c_int64_t, 3_c_int64_t, INT64_MAX, INT64_MIN, INT64_MAX, 5_c_int64_t]
    do k = 1, 7
      kept = h%offsets(AT(k))
      h%offsets(AT(k)) = values(k)
      CHECK_REFUSED(call_interface_csr(h), STICKSLIP_INVALID_SIZE, trim(NAMES(k)))
      h%offsets(AT(k)) = kept
    end do
  end subroutine

  subroutine leading_dimensions()
    integer(c_int64_t) :: ld(6)
    integer :: k
    ld = [INT64_MIN, -36_c_int64_t, 0_c_int64_t, 35_c_int64_t, INT64_MAX, beyond(36)]
    call element_init(e)
    do k = 1, 6
      CHECK_REFUSED(tangent(ld(k)), STICKSLIP_INVALID_SIZE, 'ld')
    end do
    call element_untouched(e)
  end subroutine

  integer(c_int32_t) function set_constraints(n) result(status)
    integer(c_int64_t), intent(in) :: n
    status = stickslip_interface_set_constraints(h%s%contact, n, h%s%nodes1, h%s%lambda)
  end function

  integer(c_int32_t) function csr(n_rows) result(status)
    integer(c_int64_t), intent(in) :: n_rows
    status = stickslip_interface_tangent_csr(h%s%contact, h%s%x1, h%s%x2, h%s%lambda, c_null_ptr, n_rows, h%offsets, &
        h%csr_columns, h%csr)
  end function

  integer(c_int32_t) function import(n_integers, n_reals) result(status)
    integer(c_int64_t), intent(in) :: n_integers, n_reals
    status = stickslip_interface_history_import(h%s%contact, n_integers, h%before%integers, n_reals, h%before%reals)
  end function

  integer(c_int32_t) function tangent(ld) result(status)
    integer(c_int64_t), intent(in) :: ld
    status = stickslip_pair_tangent(e%pair, c_loc(e%w%ab), c_loc(e%w%ac), c_null_ptr, c_null_ptr, c_null_ptr, &
        c_null_ptr, e%traction, e%responses, c_null_ptr, e%k, ld)
  end function
end program
