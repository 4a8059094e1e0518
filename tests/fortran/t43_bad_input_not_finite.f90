! NaN and infinity, in every entry of every array: refused with the argument's name, nothing written.
#include "check.inc"
module t43_calls
  use, intrinsic :: iso_c_binding
  use, intrinsic :: ieee_arithmetic
  use calls
  use check
  use scenes
  use stickslip
  implicit none
  public

  type(element), target, save :: e
  type(handle), target, save :: h
  real(c_double), target, save :: sums(STICKSLIP_SUMS_PER_NODE, NA), values(SIZE1)
  type(history), target, save :: imported
  ! Which of the evaluations `evaluation` calls.
  integer, save :: chosen

  abstract interface
    integer(c_int32_t) function a_call()
      import :: c_int32_t
    end function
  end interface

contains

  ! Spoils one after the other of the n numbers there, each with NaN and both infinities.
  subroutine not_finite(call_, n, there, name)
    procedure(a_call) :: call_
    integer, intent(in) :: n
    type(c_ptr), intent(in) :: there
    character(*), intent(in) :: name
    real(c_double), pointer :: entries(:)
    real(c_double) :: bad(3), kept
    integer :: i, b
    bad = [ieee_value(kept, ieee_quiet_nan), ieee_value(kept, ieee_positive_inf), ieee_value(kept, ieee_negative_inf)]
    call c_f_pointer(there, entries, [n])
    do i = 1, n
      kept = entries(i)
      do b = 1, 3
        entries(i) = bad(b)
        CHECK_REFUSED(call_(), STICKSLIP_NOT_FINITE, name)
      end do
      entries(i) = kept
    end do
  end subroutine

  integer(c_int32_t) function weights_call()
    weights_call = call_weights(e)
  end function
  integer(c_int32_t) function gap_call()
    gap_call = call_gap(e)
  end function
  integer(c_int32_t) function residual_call()
    residual_call = call_residual(e)
  end function
  integer(c_int32_t) function tangent_call()
    tangent_call = call_tangent(e)
  end function
  integer(c_int32_t) function respond_call()
    respond_call = call_respond(e)
  end function
  integer(c_int32_t) function block_call()
    block_call = call_block(e)
  end function
  integer(c_int32_t) function facet_call()
    facet_call = call_facet(e)
  end function
  integer(c_int32_t) function normal_call()
    normal_call = call_normal(e)
  end function
  integer(c_int32_t) function evaluation()
    evaluation = evaluate(chosen, h)
  end function
  integer(c_int32_t) function residual_with_sums() result(status)
    status = stickslip_interface_residual(h%s%contact, h%s%x1, h%s%x2, h%s%lambda, c_loc(sums), h%force1, h%force2, &
        h%rows)
  end function
  integer(c_int32_t) function commit_with_sums()
    commit_with_sums = stickslip_interface_commit(h%s%contact, h%s%x1, h%s%x2, h%s%lambda, c_loc(sums))
  end function
  integer(c_int32_t) function set_friction()
    set_friction = stickslip_interface_set_friction(h%s%contact, values)
  end function
  integer(c_int32_t) function set_augmentation()
    set_augmentation = stickslip_interface_set_augmentation(h%s%contact, c_loc(values))
  end function
  integer(c_int32_t) function set_normals()
    set_normals = stickslip_interface_set_normals(h%s%contact, c_loc(values))
  end function
  integer(c_int32_t) function set_constraints()
    set_constraints = stickslip_interface_set_constraints(h%s%contact, 1_c_int64_t, [5_c_int64_t], values)
  end function
  integer(c_int32_t) function import_history()
    import_history = stickslip_interface_history_import(h%s%contact, imported%n_integers, imported%integers, &
        imported%n_reals, imported%reals)
  end function
  integer(c_int32_t) function creation()
    creation = call_create(h%s)
  end function
end module

program t43_bad_input_not_finite
  use t43_calls
  implicit none
  call stateless()
  call handles()

contains

  subroutine stateless()
    integer :: a
    call element_init(e)
    call pair_arrays(weights_call, .false.)
    call pair_arrays(gap_call, .true.)
    call pair_arrays(residual_call, .true.)
    call pair_arrays(tangent_call, .true.)
    call not_finite(residual_call, 12, c_loc(e%traction), 'traction')
    call not_finite(tangent_call, 12, c_loc(e%traction), 'traction')
    call not_finite(tangent_call, 16 * 24, c_loc(e%w%dab), 'dn_ab')
    call not_finite(tangent_call, 16 * 24, c_loc(e%w%dac), 'dn_ac')
    call not_finite(tangent_call, 4, c_loc(e%row_scale), 'row_scale')
    do a = 1, 4
      call not_finite(tangent_call, 9, c_loc(e%responses(a)%drow_dnow), 'drow_dnow')
      call not_finite(tangent_call, 9, c_loc(e%responses(a)%drow_dprevious), 'drow_dprevious')
    end do
    call not_finite(block_call, 9, c_loc(e%responses(1)%drow_dlambda), 'drow_dlambda')
    call not_finite(block_call, 3, c_loc(e%responses(1)%row), 'row')
    call not_finite(facet_call, 12, c_loc(e%x1), 'x')
    call not_finite(normal_call, 3, c_loc(e%sum), 'sum')
    call element_untouched(e)

    call not_finite(respond_call, 3, c_loc(e%node%lambda), 'lambda')
    call not_finite(respond_call, 3, c_loc(e%node%normal), 'normal')
    call not_finite(respond_call, 3, c_loc(e%node%gap_now), 'gap_now')
    call not_finite(respond_call, 3, c_loc(e%node%gap_previous), 'gap_previous')
    call not_finite(respond_call, 3, c_loc(e%node%gap_committed), 'gap_committed')
    call not_finite(respond_call, 1, c_loc(e%node%augmentation), 'augmentation')
    call not_finite(respond_call, 1, c_loc(e%node%mu), 'mu')
    call not_finite(respond_call, 1, c_loc(e%node%coverage), 'coverage')
    call not_finite(respond_call, 1, c_loc(e%node%coverage_previous), 'coverage_previous')
    call not_finite(respond_call, 1, c_loc(e%node%coverage_min), 'coverage_min')
    e%node%n_directions = 2
    e%node%directions(1, 1) = 1
    e%node%directions(2, 2) = 1
    call not_finite(respond_call, 6, c_loc(e%node%directions), 'directions')
    call response_untouched(e%responses(4))
  end subroutine

  subroutine pair_arrays(call_, takes_weights)
    procedure(a_call) :: call_
    logical, intent(in) :: takes_weights
    call not_finite(call_, 12, c_loc(e%x1), 'pair.x1')
    call not_finite(call_, 12, c_loc(e%x2), 'pair.x2')
    if (.not. takes_weights) return
    call not_finite(call_, 16, c_loc(e%w%ab), 'n_ab')
    call not_finite(call_, 16, c_loc(e%w%ac), 'n_ac')
  end subroutine

  subroutine handles()
    call handle_init(h)
    do chosen = 1, EVALUATIONS
      call not_finite(evaluation, SIZE1, c_loc(h%s%x1), 'x1')
      call not_finite(evaluation, SIZE2, c_loc(h%s%x2), 'x2')
      if (chosen <= LAMBDA_CALLS) call not_finite(evaluation, SIZE1, c_loc(h%s%lambda), 'lambda')
    end do
    CHECK_OK(stickslip_interface_sums(h%s%contact, h%s%x1, h%s%x2, sums))
    call not_finite(residual_with_sums, size(sums), c_loc(sums), 'sums')
    call not_finite(commit_with_sums, size(sums), c_loc(sums), 'sums')
    values = 1
    call not_finite(set_friction, NA, c_loc(values), 'mu')
    call not_finite(set_augmentation, NA, c_loc(values), 'r')
    call not_finite(set_normals, SIZE1, c_loc(values), 'normals')
    call not_finite(set_constraints, 3, c_loc(values), 'directions')
    imported = h%before
    call not_finite(import_history, int(imported%n_reals), c_loc(imported%reals), 'reals')
    call handle_untouched(h)
    call scene_destroy(h%s)

    call not_finite(creation, SIZE1, c_loc(h%s%reference1), 'nonmortar.coordinates')
    call not_finite(creation, SIZE2, c_loc(h%s%reference2), 'mortar.coordinates')
    call not_finite(creation, 1, c_loc(h%s%options%mu), 'options.mu')
    call not_finite(creation, 1, c_loc(h%s%options%augmentation), 'options.augmentation')
    call not_finite(creation, 1, c_loc(h%s%options%modulus), 'options.modulus')
    call not_finite(creation, 1, c_loc(h%s%options%search_distance), 'options.search_distance')
    call not_finite(creation, 1, c_loc(h%s%options%coverage_min), 'options.coverage_min')
    call not_finite(creation, 1, c_loc(h%s%options%weak_coverage), 'options.weak_coverage')
    call not_finite(creation, 1, c_loc(h%s%options%turn_max), 'options.turn_max')
  end subroutine
end program
