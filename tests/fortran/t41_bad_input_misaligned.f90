! A misaligned pointer is refused like a null: reading through it would be undefined. The twin has pointer arguments,
! pointer members of types, and handles; arrays and types of Fortran are aligned by the compiler.
#include "check.inc"
#define CROOKED_IS_REFUSED(call_, word) CHECK_REFUSED(call_, STICKSLIP_NULL_POINTER, word)
program t41_bad_input_misaligned
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
  call handles()
  call creation()

contains

  subroutine stateless()
    type(c_ptr) :: ab, ac, dab, dac, none
    call element_init(e)
    none = c_null_ptr
    ab = crooked(c_loc(e%w_out%ab))
    ac = crooked(c_loc(e%w_out%ac))
    dab = crooked(c_loc(e%w_out%dab))
    dac = crooked(c_loc(e%w_out%dac))
    CROOKED_IS_REFUSED(stickslip_pair_weights(e%pair, ab, none, none, none), 'n_ab')
    CROOKED_IS_REFUSED(stickslip_pair_weights(e%pair, none, ac, none, none), 'n_ac')
    CROOKED_IS_REFUSED(stickslip_pair_weights(e%pair, c_loc(e%w_out%ab), none, dab, none), 'dn_ab')
    CROOKED_IS_REFUSED(stickslip_pair_weights(e%pair, c_loc(e%w_out%ab), none, none, dac), 'dn_ac')
    CROOKED_IS_REFUSED(tangent(crooked(c_loc(e%w%ab)), c_loc(e%w%ac), none), 'n_ab')
    CROOKED_IS_REFUSED(tangent(c_loc(e%w%ab), crooked(c_loc(e%w%ac)), none), 'n_ac')
    CROOKED_IS_REFUSED(tangent(c_loc(e%w%ab), c_loc(e%w%ac), crooked(c_loc(e%row_scale))), 'row_scale')
    CROOKED_IS_REFUSED(block(crooked(c_loc(e%row)), c_loc(e%block)), 'row')
    CROOKED_IS_REFUSED(block(c_loc(e%row), crooked(c_loc(e%block))), 'block')
    CROOKED_IS_REFUSED(stickslip_facet_geometry(4, e%x1, crooked(c_loc(e%normals)), c_loc(e%areas)), 'normals')
    CROOKED_IS_REFUSED(stickslip_facet_geometry(4, e%x1, c_loc(e%normals), crooked(c_loc(e%areas))), 'areas')
    e%pair%x2 = crooked(c_loc(e%x2))
    CROOKED_IS_REFUSED(call_weights(e), 'pair.x2')
    call element_untouched(e)
  end subroutine

  integer(c_int32_t) function tangent(n_ab, n_ac, row_scale) result(status)
    type(c_ptr), intent(in) :: n_ab, n_ac, row_scale
    status = stickslip_pair_tangent(e%pair, n_ab, n_ac, c_null_ptr, c_null_ptr, c_null_ptr, c_null_ptr, e%traction, &
        e%responses, row_scale, e%k, 36_c_int64_t)
  end function

  integer(c_int32_t) function block(row, block_)
    type(c_ptr), intent(in) :: row, block_
    block = stickslip_node_block(e%responses(1), 1d0, STICKSLIP_LAYOUT_COLUMN_MAJOR, row, block_)
  end function

  subroutine handles()
    type(c_ptr) :: bad
    type(stickslip_interface) :: kept, bad_handle
    call handle_init(h)
    kept = h%s%contact
    bad_handle = transfer(address_of(kept) + 1, kept)
    h%s%contact = bad_handle
    CROOKED_IS_REFUSED(call_interface_residual(h), 'interface')
    CROOKED_IS_REFUSED(stickslip_interface_rollback(bad_handle), 'interface')
    h%s%contact = kept
    bad = crooked(c_loc(h%s%lambda))
    CROOKED_IS_REFUSED(residual(bad), 'sums')
    CROOKED_IS_REFUSED(stickslip_interface_set_augmentation(h%s%contact, bad), 'r')
    CROOKED_IS_REFUSED(stickslip_interface_set_normals(h%s%contact, bad), 'normals')
    CROOKED_IS_REFUSED(coo(crooked(c_loc(h%row_numbers)), c_loc(h%columns), c_loc(h%values)), 'rows')
    CROOKED_IS_REFUSED(coo(c_loc(h%row_numbers), crooked(c_loc(h%columns)), c_loc(h%values)), 'columns')
    CROOKED_IS_REFUSED(coo(c_loc(h%row_numbers), c_loc(h%columns), crooked(c_loc(h%values))), 'values')
    h%states%normal = crooked(c_loc(h%normal))
    CROOKED_IS_REFUSED(call_interface_states(h), 'stickslip_states')
    h%states%normal = c_loc(h%normal)
    h%states%state = crooked(c_loc(h%state))
    CROOKED_IS_REFUSED(call_interface_states(h), 'stickslip_states.state')
    call handle_untouched(h)
    call scene_destroy(h%s)
  end subroutine

  integer(c_int32_t) function residual(sums) result(status)
    type(c_ptr), intent(in) :: sums
    status = stickslip_interface_residual(h%s%contact, h%s%x1, h%s%x2, h%s%lambda, sums, h%force1, h%force2, h%rows)
  end function

  integer(c_int32_t) function coo(rows, columns, values) result(status)
    type(c_ptr), intent(in) :: rows, columns, values
    status = stickslip_interface_tangent_coo(h%s%contact, h%s%x1, h%s%x2, h%s%lambda, c_null_ptr, MOST_ENTRIES, rows, &
        columns, values, h%count)
  end function

  subroutine creation()
    type(scene), target, save :: s
    call scene_init(s)
    s%nonmortar%coordinates = crooked(c_loc(s%reference1))
    CROOKED_IS_REFUSED(call_create(s), 'nonmortar.coordinates')
    s%nonmortar%coordinates = c_loc(s%reference1)
    s%mortar%facet_nodes = crooked(c_loc(s%nodes2))
    CROOKED_IS_REFUSED(call_create(s), 'mortar.facet_nodes')
  end subroutine
end program
