! A null where something is needed: refused by name, nothing written. The twin has what Fortran can write: pointer
! arguments, pointer members of types, and handles that were never created; an array or a type is never null.
#include "check.inc"
#define NULL_IS_REFUSED(call_, word) CHECK_REFUSED(call_, STICKSLIP_NULL_POINTER, word)
program t40_bad_input_null
  use, intrinsic :: iso_c_binding
  use calls
  use check
  use pairs
  use scenes
  use stickslip
  implicit none
  type(element), target, save :: e
  type(handle), target, save :: h

  call stateless()
  call creation()
  call handles()
  call outputs()

contains

  ! The tangent with these weights.
  integer(c_int32_t) function tangent(n_ab, n_ac, dn_ab, dn_ac, n_ab_previous, n_ac_previous) result(status)
    type(c_ptr), intent(in) :: n_ab, n_ac, dn_ab, dn_ac, n_ab_previous, n_ac_previous
    status = stickslip_pair_tangent(e%pair, n_ab, n_ac, dn_ab, dn_ac, n_ab_previous, n_ac_previous, e%traction, &
        e%responses, c_null_ptr, e%k, 36_c_int64_t)
  end function

  subroutine stateless()
    type(c_ptr) :: ab, ac, dab, dac, none, kept
    call element_init(e)
    ab = c_loc(e%w%ab)
    ac = c_loc(e%w%ac)
    dab = c_loc(e%w%dab)
    dac = c_loc(e%w%dac)
    none = c_null_ptr
    NULL_IS_REFUSED(tangent(none, ac, dab, dac, ab, ac), 'n_ab')
    NULL_IS_REFUSED(tangent(ab, none, dab, dac, ab, ac), 'n_ac')
    NULL_IS_REFUSED(tangent(ab, ac, none, dac, ab, ac), 'dn_ab')
    NULL_IS_REFUSED(tangent(ab, ac, dab, none, ab, ac), 'dn_ac')
    NULL_IS_REFUSED(tangent(ab, ac, dab, dac, none, ac), 'n_ab_previous')
    NULL_IS_REFUSED(tangent(ab, ac, dab, dac, ab, none), 'n_ac_previous')

    kept = e%pair%x1
    e%pair%x1 = none
    NULL_IS_REFUSED(call_weights(e), 'pair.x1')
    e%pair%x1 = kept
    e%pair%x2 = none
    NULL_IS_REFUSED(call_weights(e), 'pair.x2')
    NULL_IS_REFUSED(call_gap(e), 'pair.x2')
    NULL_IS_REFUSED(call_residual(e), 'pair.x2')
    NULL_IS_REFUSED(call_tangent(e), 'pair.x2')
    call element_untouched(e)
  end subroutine

  subroutine creation()
    type(scene), target, save :: s
    type(stickslip_surface) :: good
    integer :: member
    call scene_init(s)
    good = s%nonmortar
    do member = 1, 5
      s%nonmortar = good
      call remove(s%nonmortar, member)
      NULL_IS_REFUSED(call_create(s), 'nonmortar.' // name_of(member))
    end do
    s%nonmortar = good
    good = s%mortar
    do member = 1, 4
      s%mortar = good
      call remove(s%mortar, member)
      NULL_IS_REFUSED(call_create(s), 'mortar.' // name_of(member))
      ! Which of the two: "nonmortar.x" holds "mortar.x" as well.
      CHECK(index(last_message(), 'nonmortar') == 0)
    end do
  end subroutine

  function name_of(member) result(name)
    integer, intent(in) :: member
    character(:), allocatable :: name
    character(20), parameter :: NAMES(5) = [character(20) :: 'coordinates', 'facet_offsets', 'facet_nodes', &
                                            'equations', 'multiplier_equations']
    name = trim(NAMES(member))
  end function

  subroutine remove(surface, member)
    type(stickslip_surface), intent(inout) :: surface
    integer, intent(in) :: member
    if (member == 1) surface%coordinates = c_null_ptr
    if (member == 2) surface%facet_offsets = c_null_ptr
    if (member == 3) surface%facet_nodes = c_null_ptr
    if (member == 4) surface%equations = c_null_ptr
    if (member == 5) surface%multiplier_equations = c_null_ptr
  end subroutine

  ! Every call on a handle that was never created.
  subroutine handles()
    type(stickslip_interface) :: kept, none
    type(stickslip_counters) :: counters
    integer(c_int64_t), parameter :: NINE = 9
    integer :: k
    call handle_init(h)
    kept = h%s%contact
    h%s%contact = none
    do k = 1, EVALUATIONS
      NULL_IS_REFUSED(evaluate(k, h), 'interface')
    end do
    counters%searches = 77
    NULL_IS_REFUSED(stickslip_interface_counters(none, counters), 'interface')
    CHECK(counters%searches == 77)
    NULL_IS_REFUSED(stickslip_interface_rollback(none), 'interface')
    NULL_IS_REFUSED(stickslip_interface_set_friction(none, h%s%lambda), 'interface')
    NULL_IS_REFUSED(stickslip_interface_set_augmentation(none, c_loc(h%s%lambda)), 'interface')
    NULL_IS_REFUSED(stickslip_interface_set_normals(none, c_loc(h%s%lambda)), 'interface')
    NULL_IS_REFUSED(stickslip_interface_set_constraints(none, 0_c_int64_t, [1_c_int64_t], h%s%lambda), 'interface')
    NULL_IS_REFUSED(stickslip_interface_initial_multipliers(none, h%rows), 'interface')
    NULL_IS_REFUSED(stickslip_interface_history_size(none, h%count, h%columns(1)), 'interface')
    NULL_IS_REFUSED(stickslip_interface_history_export(none, NINE, h%columns, NINE, h%values), 'interface')
    NULL_IS_REFUSED(stickslip_interface_history_import(none, NINE, h%columns, NINE, h%values), 'interface')
    h%s%contact = kept
    call handle_untouched(h)
  end subroutine

  ! Some of the arrays for the triplets, which are wanted all or none.
  subroutine outputs()
    type(c_ptr) :: rows, columns, values, none
    rows = c_loc(h%row_numbers)
    columns = c_loc(h%columns)
    values = c_loc(h%values)
    none = c_null_ptr
    NULL_IS_REFUSED(coo(none, columns, values), 'rows')
    NULL_IS_REFUSED(coo(rows, none, values), 'columns')
    NULL_IS_REFUSED(coo(rows, columns, none), 'values')
    NULL_IS_REFUSED(pattern(none, columns), 'rows')
    NULL_IS_REFUSED(pattern(rows, none), 'columns')
    call handle_untouched(h)
    call scene_destroy(h%s)
  end subroutine

  integer(c_int32_t) function coo(rows, columns, values) result(status)
    type(c_ptr), intent(in) :: rows, columns, values
    status = stickslip_interface_tangent_coo(h%s%contact, h%s%x1, h%s%x2, h%s%lambda, c_null_ptr, MOST_ENTRIES, rows, &
        columns, values, h%count)
  end function

  integer(c_int32_t) function pattern(rows, columns) result(status)
    type(c_ptr), intent(in) :: rows, columns
    status = stickslip_interface_pattern_coo(h%s%contact, h%s%x1, h%s%x2, MOST_ENTRIES, rows, columns, h%count)
  end function
end program
