! Every entry point with arguments that it accepts, to be spoilt one at a time by the tests of bad input, the twin of
! tests/capi/calls.h. Each output holds a value that a refused call must leave alone.
#include "check.inc"
module calls
  use, intrinsic :: iso_c_binding
  use check
  use pairs
  use scenes
  use stickslip
  implicit none
  public

  ! Room for the state of a pair, twice as much as it takes.
  integer, parameter :: STATE_SIZE = 512

  ! Stateless calls on two quadrilaterals.
  type element
    real(c_double) :: x1(3, 4), x2(3, 4)
    type(stickslip_pair) :: pair
    type(weights) :: w
    ! The non-mortar facet with this one pair.
    integer(c_int32_t) :: n2(1)
    type(stickslip_facet) :: facet
    real(c_double) :: mass(16)
    type(stickslip_node) :: node
    type(stickslip_node_response) :: responses(4)
    real(c_double) :: traction(3, 4), row_scale(4), sum(3), state(STATE_SIZE)
    ! Outputs.
    type(weights) :: w_out
    real(c_double) :: gap(3, 4), force(3, 8), k(36, 36), normals(3, 4), areas(4), normal(3), row(3), block(3, 3)
    real(c_double) :: fade, dual_areas(4), coefficients(16), dual_ab(16), dual_ac(16), facet_k(36, 36)
    real(c_double) :: normal_derivatives(3, 4, 3, 4), turn(9, 3), state_out(STATE_SIZE)
  end type

  ! Room for any tangent or pattern of the scene.
  integer(c_int64_t), parameter :: MOST_ENTRIES = 100000

  ! Calls on an interface handle.
  type handle
    type(scene) :: s
    type(history) :: before
    ! Outputs.
    real(c_double) :: force1(3, NA), force2(3, NC), rows(3, NA), sums(STICKSLIP_SUMS_PER_NODE, NA)
    real(c_double), allocatable :: values(:)
    integer(c_int64_t), allocatable :: row_numbers(:), columns(:)
    integer(c_int64_t) :: count
    integer(c_int32_t) :: state(NA)
    real(c_double) :: normal(3, NA), fraction
    type(stickslip_states) :: states
    ! Input: what a host's own forces leave at the non-mortar nodes.
    real(c_double) :: host1(3, NA)
    ! A CSR matrix with every entry.
    integer(c_int64_t) :: offsets(UNKNOWNS + 1)
    integer(c_int64_t), allocatable :: csr_columns(:)
    real(c_double), allocatable :: csr(:)
  end type

  ! The calls of `evaluate`; the first LAMBDA_CALLS take multipliers too.
  integer, parameter :: EVALUATIONS = 9, LAMBDA_CALLS = 5

contains

  subroutine element_init(e)
    type(element), target, intent(inout) :: e
    integer :: a
    e%x1 = quad1
    e%x2 = quad2
    e%pair = make_pair(4, e%x1, 4, e%x2)
    call pair_weights(e%pair, e%w)
    CHECK_OK(stickslip_pair_begin(e%pair, size(e%state, kind=c_int64_t), e%state, c_null_ptr, c_null_ptr, c_null_ptr))
    e%n2 = 4
    e%facet = stickslip_facet(n1=4, n_pairs=1, x1=c_loc(e%x1), n2=c_loc(e%n2), x2=c_loc(e%x2))
    e%mass = e%w%ab
    e%node = stickslip_node(normal=[0d0, 0d0, 1d0], lambda=[0d0, 0d0, -1d0], augmentation=3d0, mu=0.5d0, &
        coverage=1d0, coverage_previous=1d0)
    e%sum = [0d0, 0d0, -2d0]
    e%row_scale = 2
    e%traction = spread([0d0, 0d0, -1d0], 2, 4)
    do a = 1, 4
      e%responses(a) = stickslip_node_response()
      CHECK_OK(stickslip_node_respond(e%node, e%responses(a)))
    end do
    e%w_out = weights(UNWRITTEN, UNWRITTEN, UNWRITTEN, UNWRITTEN)
    e%gap = UNWRITTEN
    e%force = UNWRITTEN
    e%k = UNWRITTEN
    e%normals = UNWRITTEN
    e%areas = UNWRITTEN
    e%normal = UNWRITTEN
    e%row = UNWRITTEN
    e%block = UNWRITTEN
    e%fade = UNWRITTEN
    e%dual_areas = UNWRITTEN
    e%coefficients = UNWRITTEN
    e%dual_ab = UNWRITTEN
    e%dual_ac = UNWRITTEN
    e%facet_k = UNWRITTEN
    e%normal_derivatives = UNWRITTEN
    e%turn = UNWRITTEN
    e%state_out = UNWRITTEN
  end subroutine

  integer(c_int32_t) function call_weights(e) result(status)
    type(element), target, intent(inout) :: e
    status = stickslip_pair_weights(e%pair, c_loc(e%w_out%ab), c_loc(e%w_out%ac), c_loc(e%w_out%dab), &
        c_loc(e%w_out%dac))
  end function

  integer(c_int32_t) function call_gap(e) result(status)
    type(element), target, intent(inout) :: e
    status = stickslip_pair_gap(e%pair, e%w%ab, e%w%ac, e%gap)
  end function

  integer(c_int32_t) function call_residual(e) result(status)
    type(element), target, intent(inout) :: e
    status = stickslip_pair_residual(e%pair, e%w%ab, e%w%ac, e%traction, e%force)
  end function

  integer(c_int32_t) function call_tangent(e) result(status)
    type(element), target, intent(inout) :: e
    status = stickslip_pair_tangent(e%pair, c_loc(e%w%ab), c_loc(e%w%ac), c_loc(e%w%dab), c_loc(e%w%dac), &
        c_loc(e%w%ab), c_loc(e%w%ac), e%traction, e%responses, c_loc(e%row_scale), e%k, 36_c_int64_t)
  end function

  integer(c_int32_t) function call_begin(e) result(status)
    type(element), target, intent(inout) :: e
    status = stickslip_pair_begin(e%pair, size(e%state_out, kind=c_int64_t), e%state_out, c_loc(e%w_out%ab), &
        c_loc(e%w_out%ac), c_loc(e%gap))
  end function

  integer(c_int32_t) function call_state_gap(e) result(status)
    type(element), target, intent(inout) :: e
    status = stickslip_pair_state_gap(e%state, c_loc(e%w%ab), c_loc(e%w%ac), e%gap)
  end function

  integer(c_int32_t) function call_state_residual(e) result(status)
    type(element), target, intent(inout) :: e
    status = stickslip_pair_state_residual(e%state, e%traction, e%force)
  end function

  integer(c_int32_t) function call_state_tangent(e) result(status)
    type(element), target, intent(inout) :: e
    status = stickslip_pair_state_tangent(e%state, c_loc(e%w%ab), c_loc(e%w%ac), e%traction, e%responses, &
        c_loc(e%row_scale), e%k, 36_c_int64_t)
  end function

  ! Into the last response, of which all but the size is filled.
  integer(c_int32_t) function call_respond(e) result(status)
    type(element), target, intent(inout) :: e
    call response_fill(e%responses(4))
    status = stickslip_node_respond(e%node, e%responses(4))
  end function

  integer(c_int32_t) function call_block(e) result(status)
    type(element), target, intent(inout) :: e
    status = stickslip_node_block(e%responses(1), 1d0, STICKSLIP_LAYOUT_COLUMN_MAJOR, c_loc(e%row), c_loc(e%block))
  end function

  integer(c_int32_t) function call_facet(e) result(status)
    type(element), target, intent(inout) :: e
    status = stickslip_facet_geometry(4, e%x1, c_loc(e%normals), c_loc(e%areas))
  end function

  integer(c_int32_t) function call_facet_dual(e) result(status)
    type(element), target, intent(inout) :: e
    status = stickslip_facet_dual(4, e%x1, e%mass, c_loc(e%fade), c_loc(e%dual_areas), c_loc(e%coefficients))
  end function

  integer(c_int32_t) function call_pair_dual(e) result(status)
    type(element), target, intent(inout) :: e
    status = stickslip_pair_dual(e%pair, e%mass, e%w%ab, e%w%ac, c_loc(e%dual_ab), c_loc(e%dual_ac))
  end function

  integer(c_int32_t) function call_facet_tangent(e) result(status)
    type(element), target, intent(inout) :: e
    status = stickslip_facet_tangent(e%facet, e%w%ab, e%w%ac, c_loc(e%w%ab), c_loc(e%w%ac), e%traction, e%responses, &
        c_loc(e%row_scale), e%facet_k, 36_c_int64_t)
  end function

  integer(c_int32_t) function call_normal_derivatives(e) result(status)
    type(element), target, intent(inout) :: e
    status = stickslip_facet_normal_derivatives(4, e%x1, e%normal_derivatives)
  end function

  integer(c_int32_t) function call_turn(e) result(status)
    type(element), target, intent(inout) :: e
    status = stickslip_node_turn(e%node, e%sum, STICKSLIP_LAYOUT_COLUMN_MAJOR, c_loc(e%turn(1, 1)), c_loc(e%turn(1, 2)), &
        c_loc(e%turn(1, 3)))
  end function

  integer(c_int32_t) function call_normal(e) result(status)
    type(element), target, intent(inout) :: e
    status = stickslip_node_normal(e%sum, e%normal)
  end function

  subroutine response_fill(r)
    type(stickslip_node_response), intent(out) :: r
    r%state = UNWRITTEN_STATE
    r%reserved = UNWRITTEN_STATE
    r%traction = UNWRITTEN
    r%row = UNWRITTEN
    r%gap_normal = UNWRITTEN
    r%slip = UNWRITTEN
    r%sigma = UNWRITTEN
    r%dp_dlambda = UNWRITTEN
    r%drow_dlambda = UNWRITTEN
    r%drow_dnow = UNWRITTEN
    r%drow_dprevious = UNWRITTEN
  end subroutine

  subroutine response_untouched(r)
    type(stickslip_node_response), intent(in) :: r
    CHECK(r%state == UNWRITTEN_STATE .and. r%reserved == UNWRITTEN_STATE .and. untouched(r%gap_normal))
    CHECK_UNTOUCHED(r%traction)
    CHECK_UNTOUCHED(r%row)
    CHECK_UNTOUCHED(r%slip)
    CHECK_UNTOUCHED(r%sigma)
    CHECK_UNTOUCHED(r%dp_dlambda)
    CHECK_UNTOUCHED(r%drow_dlambda)
    CHECK_UNTOUCHED(r%drow_dnow)
    CHECK_UNTOUCHED(r%drow_dprevious)
  end subroutine

  subroutine element_untouched(e)
    type(element), intent(in) :: e
    CHECK_UNTOUCHED(e%w_out%ab)
    CHECK_UNTOUCHED(e%w_out%ac)
    CHECK_UNTOUCHED(e%w_out%dab)
    CHECK_UNTOUCHED(e%w_out%dac)
    CHECK_UNTOUCHED(e%gap)
    CHECK_UNTOUCHED(e%force)
    CHECK_UNTOUCHED(e%k)
    CHECK_UNTOUCHED(e%normals)
    CHECK_UNTOUCHED(e%areas)
    CHECK_UNTOUCHED(e%normal)
    CHECK_UNTOUCHED(e%row)
    CHECK_UNTOUCHED(e%block)
    CHECK(untouched(e%fade))
    CHECK_UNTOUCHED(e%dual_areas)
    CHECK_UNTOUCHED(e%coefficients)
    CHECK_UNTOUCHED(e%dual_ab)
    CHECK_UNTOUCHED(e%dual_ac)
    CHECK_UNTOUCHED(e%facet_k)
    CHECK_UNTOUCHED(e%normal_derivatives)
    CHECK_UNTOUCHED(e%turn)
    CHECK_UNTOUCHED(e%state_out)
  end subroutine

  subroutine handle_fill(h)
    type(handle), intent(inout) :: h
    h%force1 = UNWRITTEN
    h%force2 = UNWRITTEN
    h%rows = UNWRITTEN
    h%sums = UNWRITTEN
    h%values = UNWRITTEN
    h%row_numbers = UNWRITTEN_INTEGER
    h%columns = UNWRITTEN_INTEGER
    h%count = UNWRITTEN_INTEGER
    h%state = UNWRITTEN_STATE
    h%normal = UNWRITTEN
    h%fraction = UNWRITTEN
    h%csr = UNWRITTEN
  end subroutine

  ! Room for the outputs, and what points to it.
  subroutine handle_prepare(h)
    type(handle), target, intent(inout) :: h
    integer(c_int64_t) :: base
    integer :: i
    base = h%s%options%index_base
    if (.not. allocated(h%values)) then
      allocate (h%values(MOST_ENTRIES), h%row_numbers(MOST_ENTRIES), h%columns(MOST_ENTRIES))
      allocate (h%csr(UNKNOWNS**2), h%csr_columns(UNKNOWNS**2))
    end if
    h%states = stickslip_states(state=c_loc(h%state), normal=c_loc(h%normal))
    h%offsets = [(base + i * UNKNOWNS, i = 0, UNKNOWNS)]
    h%csr_columns = [(base + mod(i, UNKNOWNS), i = 0, UNKNOWNS**2 - 1)]
    h%host1 = reshape([(0.01d0 * mod(i, 7) - 0.02d0, i = 0, SIZE1 - 1)], [3, NA])
    call handle_fill(h)
  end subroutine

  ! A scene with one committed step.
  subroutine handle_init(h)
    type(handle), target, intent(inout) :: h
    call scene_init(h%s)
    call scene_create(h%s)
    call scene_commit(h%s)
    call history_take(h%s%contact, h%before)
    call handle_prepare(h)
  end subroutine

  integer(c_int32_t) function call_interface_residual(h) result(status)
    type(handle), target, intent(inout) :: h
    status = stickslip_interface_residual(h%s%contact, h%s%x1, h%s%x2, h%s%lambda, c_null_ptr, h%force1, h%force2, &
        h%rows)
  end function

  integer(c_int32_t) function call_interface_states(h) result(status)
    type(handle), target, intent(inout) :: h
    status = stickslip_interface_states(h%s%contact, h%s%x1, h%s%x2, h%s%lambda, c_null_ptr, h%states)
  end function

  integer(c_int32_t) function call_interface_sums(h) result(status)
    type(handle), target, intent(inout) :: h
    status = stickslip_interface_sums(h%s%contact, h%s%x1, h%s%x2, h%sums)
  end function

  integer(c_int32_t) function call_interface_coo(h) result(status)
    type(handle), target, intent(inout) :: h
    status = stickslip_interface_tangent_coo(h%s%contact, h%s%x1, h%s%x2, h%s%lambda, c_null_ptr, MOST_ENTRIES, &
        c_loc(h%row_numbers), c_loc(h%columns), c_loc(h%values), h%count)
  end function

  integer(c_int32_t) function call_interface_csr(h) result(status)
    type(handle), target, intent(inout) :: h
    status = stickslip_interface_tangent_csr(h%s%contact, h%s%x1, h%s%x2, h%s%lambda, c_null_ptr, &
        int(UNKNOWNS, c_int64_t), h%offsets, h%csr_columns, h%csr)
  end function

  integer(c_int32_t) function call_interface_pattern(h) result(status)
    type(handle), target, intent(inout) :: h
    status = stickslip_interface_pattern_coo(h%s%contact, h%s%x1, h%s%x2, MOST_ENTRIES, c_loc(h%row_numbers), &
        c_loc(h%columns), h%count)
  end function

  integer(c_int32_t) function call_carriers(h) result(status)
    type(handle), target, intent(inout) :: h
    status = stickslip_interface_carriers(h%s%contact, MOST_ENTRIES, c_loc(h%row_numbers), c_loc(h%columns), &
        c_loc(h%values), h%count)
  end function

  ! The multipliers turn in the output, which holds its mark again where the call is refused.
  integer(c_int32_t) function call_turn_multipliers(h) result(status)
    type(handle), target, intent(inout) :: h
    h%rows = h%s%lambda
    status = stickslip_interface_turn_multipliers(h%s%contact, h%s%x1, h%rows)
    if (status == STICKSLIP_OK) return
    CHECK(all(same(reshape(h%rows, [SIZE1]), reshape(h%s%lambda, [SIZE1]))))
    h%rows = UNWRITTEN
  end function

  ! Calls for systems without multipliers, which interfaces with dual ones accept in the multiplier form.
  integer(c_int32_t) function call_condensed_multipliers(h) result(status)
    type(handle), target, intent(inout) :: h
    status = stickslip_interface_condensed_multipliers(h%s%contact, h%s%x1, h%s%x2, h%host1, h%rows)
  end function

  integer(c_int32_t) function call_condensed_residual(h) result(status)
    type(handle), target, intent(inout) :: h
    status = stickslip_interface_condensed_residual(h%s%contact, h%s%x1, h%s%x2, h%s%lambda, h%host1, h%force1, h%force2)
  end function

  integer(c_int32_t) function call_condensed_coo(h, piece) result(status)
    type(handle), target, intent(inout) :: h
    integer(c_int32_t), intent(in) :: piece
    status = stickslip_interface_condensed_coo(h%s%contact, h%s%x1, h%s%x2, h%s%lambda, piece, MOST_ENTRIES, &
        c_loc(h%row_numbers), c_loc(h%columns), c_loc(h%values), h%count)
  end function

  integer(c_int32_t) function call_condensed_csr(h) result(status)
    type(handle), target, intent(inout) :: h
    status = stickslip_interface_condensed_csr(h%s%contact, h%s%x1, h%s%x2, h%s%lambda, int(UNKNOWNS, c_int64_t), &
        h%offsets, h%csr_columns, h%csr)
  end function

  integer(c_int32_t) function call_condensed_pattern(h) result(status)
    type(handle), target, intent(inout) :: h
    status = stickslip_interface_condensed_pattern(h%s%contact, h%s%x1, h%s%x2, int(UNKNOWNS, c_int64_t), h%offsets, &
        h%csr_columns, MOST_ENTRIES, c_loc(h%row_numbers), c_loc(h%columns), h%count)
  end function

  integer(c_int32_t) function call_interface_commit(h) result(status)
    type(handle), target, intent(inout) :: h
    status = stickslip_interface_commit(h%s%contact, h%s%x1, h%s%x2, h%s%lambda, c_null_ptr)
  end function

  integer(c_int32_t) function call_interface_limit(h) result(status)
    type(handle), target, intent(inout) :: h
    real(c_double) :: dx1(3, NA), dx2(3, NC)
    dx1 = 0
    dx1(1, 1) = 1
    dx2 = 0
    status = stickslip_interface_step_limit(h%s%contact, h%s%x1, h%s%x2, dx1, dx2, 0d0, h%fraction)
  end function

  integer(c_int32_t) function call_interface_previous(h) result(status)
    type(handle), target, intent(inout) :: h
    status = stickslip_interface_set_previous(h%s%contact, h%s%x1, h%s%x2)
  end function

  integer(c_int32_t) function call_interface_committed(h) result(status)
    type(handle), target, intent(inout) :: h
    real(c_double), target :: slip(3, NA)
    slip = 0
    slip(1, 1) = 0.125d0
    status = stickslip_interface_set_committed(h%s%contact, h%s%x1, h%s%x2, c_loc(slip), 3_c_int64_t)
  end function

  ! The calls that take positions, by number.
  integer(c_int32_t) function evaluate(call_number, h) result(status)
    integer, intent(in) :: call_number
    type(handle), target, intent(inout) :: h
    select case (call_number)
    case (1)
      status = call_interface_residual(h)
    case (2)
      status = call_interface_states(h)
    case (3)
      status = call_interface_coo(h)
    case (4)
      status = call_interface_csr(h)
    case (5)
      status = call_interface_commit(h)
    case (6)
      status = call_interface_sums(h)
    case (7)
      status = call_interface_pattern(h)
    case (8)
      status = call_interface_limit(h)
    case (9)
      status = call_interface_committed(h)
    case default
      status = call_interface_previous(h)
    end select
  end function

  ! Neither outputs nor history have changed, and the handle goes on working.
  subroutine handle_untouched(h)
    type(handle), intent(inout) :: h
    type(history), save :: now
    CHECK_UNTOUCHED(h%force1)
    CHECK_UNTOUCHED(h%force2)
    CHECK_UNTOUCHED(h%rows)
    CHECK_UNTOUCHED(h%sums)
    CHECK_UNTOUCHED(h%values)
    CHECK_UNTOUCHED(h%row_numbers)
    CHECK_UNTOUCHED(h%columns)
    CHECK(untouched(h%count))
    CHECK_UNTOUCHED(h%state)
    CHECK_UNTOUCHED(h%normal)
    CHECK(untouched(h%fraction))
    CHECK_UNTOUCHED(h%csr)
    call history_take(h%s%contact, now)
    CHECK(history_equal(h%before, now))
  end subroutine

  ! Creation alone; an interface that is refused must leave the handle as it was, here null.
  integer(c_int32_t) function call_create(s) result(status)
    type(scene), intent(in) :: s
    type(stickslip_interface) :: out
    out = no_handle()
    status = stickslip_interface_create(s%nonmortar, s%mortar, s%options, out)
    CHECK(address_of(out) == 0)
  end function
end module
