! Sizes of types: one shorter than the first version had is refused, a longer one only if it sets something that this
! library does not know.
#include "check.inc"
program t42_bad_input_struct_size
  use, intrinsic :: iso_c_binding
  use calls
  use check
  use pairs
  use scenes
  use stickslip
  implicit none

  ! Types of a newer caller's module.
  type, bind(C) :: newer_counters
    type(stickslip_counters) :: known
    integer(c_int64_t) :: tail
  end type
  type, bind(C) :: newer_options
    type(stickslip_options) :: known
    real(c_double) :: unknown(2)
  end type

  ! The types that go in, by number.
  integer, parameter :: PAIR = 1, NODE = 2, RESPONSE = 3, STATES = 4, NONMORTAR = 5, MORTAR = 6, OPTIONS = 7
  character(23), parameter :: NAMES(7) = [character(23) :: 'stickslip_pair', 'stickslip_node', &
      'stickslip_node_response', 'stickslip_states', 'stickslip_surface', 'stickslip_surface', 'stickslip_options']
  ! Sizes of the first version, the shortest that are accepted, of the types that have grown since.
  integer(c_int64_t), parameter :: OPTIONS_1 = 88, COUNTERS_1 = 88
  ! The largest size that is accepted, in bytes.
  integer, parameter :: LONGEST = 4096
  type(element), target, save :: e
  type(handle), target, save :: h
  ! A buffer of that size, for the library reads what a struct declares; its first integer is the struct's size.
  integer(c_int64_t), target, save :: longer(LONGEST / 8)
  integer(c_int8_t), pointer :: bytes(:)
  integer(c_int64_t) :: size_of
  integer :: k

  call element_init(e)
  call handle_init(h)
  call c_f_pointer(c_loc(longer), bytes, [LONGEST])
  do k = PAIR, OPTIONS
    call copy(k, size_of)
    call check_input(k, trim(NAMES(k)), size_of, merge(OPTIONS_1, size_of, k == OPTIONS))
  end do
  call check_counters()
  call check_response()
  call check_options()

  ! Responses of different size in one array: each says its own, the first one sets the distance.
  call element_init(e)
  e%responses(3)%struct_size = 8
  CHECK_REFUSED(call_tangent(e), STICKSLIP_STRUCT_SIZE, 'stickslip_node_response')
  call element_untouched(e)
  call scene_destroy(h%s)

contains

  ! A good value of the type at the buffer's beginning, zeros behind it.
  subroutine copy(k, size_of)
    integer, intent(in) :: k
    integer(c_int64_t), intent(out) :: size_of
    longer = 0
    size_of = 0
    select case (k)
    case (PAIR)
      size_of = fill(transfer(e%pair, longer))
    case (NODE)
      size_of = fill(transfer(e%node, longer))
    case (RESPONSE)
      size_of = fill(transfer(e%responses(1), longer))
    case (STATES)
      size_of = fill(transfer(h%states, longer))
    case (NONMORTAR)
      size_of = fill(transfer(h%s%nonmortar, longer))
    case (MORTAR)
      size_of = fill(transfer(h%s%mortar, longer))
    case (OPTIONS)
      size_of = fill(transfer(h%s%options, longer))
    end select
    CHECK(longer(1) == size_of)
  end subroutine

  integer(c_int64_t) function fill(words)
    integer(c_int64_t), intent(in) :: words(:)
    longer(:size(words)) = words
    fill = 8 * size(words)
  end function

  ! The call that takes the type from the buffer.
  integer(c_int32_t) function call_with(k) result(status)
    integer, intent(in) :: k
    type(stickslip_pair), pointer :: a_pair
    type(stickslip_node), pointer :: a_node
    type(stickslip_node_response), pointer :: a_response
    type(stickslip_states), pointer :: some_states
    type(stickslip_surface), pointer :: surface
    type(stickslip_options), pointer :: some_options
    type(c_ptr) :: at
    at = c_loc(longer)
    status = -77
    select case (k)
    case (PAIR)
      call c_f_pointer(at, a_pair)
      status = stickslip_pair_weights(a_pair, c_loc(e%w_out%ab), c_loc(e%w_out%ac), c_null_ptr, c_null_ptr)
    case (NODE)
      call c_f_pointer(at, a_node)
      status = stickslip_node_respond(a_node, e%responses(4))
    case (RESPONSE)
      call c_f_pointer(at, a_response)
      status = stickslip_node_block(a_response, 1d0, 0, c_loc(e%row), c_loc(e%block))
    case (STATES)
      call c_f_pointer(at, some_states)
      status = stickslip_interface_states(h%s%contact, h%s%x1, h%s%x2, h%s%lambda, c_null_ptr, some_states)
    case (NONMORTAR)
      call c_f_pointer(at, surface)
      status = create(surface, h%s%mortar, h%s%options)
    case (MORTAR)
      call c_f_pointer(at, surface)
      status = create(h%s%nonmortar, surface, h%s%options)
    case (OPTIONS)
      call c_f_pointer(at, some_options)
      status = create(h%s%nonmortar, h%s%mortar, some_options)
    end select
  end function

  integer(c_int32_t) function create(one, two, some_options) result(status)
    type(stickslip_surface), intent(in) :: one, two
    type(stickslip_options), intent(in) :: some_options
    type(stickslip_interface) :: out
    integer(c_int32_t) :: ended
    status = stickslip_interface_create(one, two, some_options, out)
    CHECK(address_of(out) /= 0 .eqv. status == STICKSLIP_OK)
    if (status /= STICKSLIP_OK) return
    ended = stickslip_interface_destroy(out)
    CHECK_OK(ended)
  end function

  subroutine check_input(k, name, size_of, first)
    integer, intent(in) :: k
    character(*), intent(in) :: name
    integer(c_int64_t), intent(in) :: size_of, first
    ! C's sizes have no sign: the last two are the largest one and half of it.
    integer(c_int64_t) :: wrong(7), newer(3)
    integer :: i
    wrong = [0_c_int64_t, 1_c_int64_t, 8_c_int64_t, first - 1, LONGEST + 1_c_int64_t, -1_c_int64_t, INT64_MIN]
    do i = 1, size(wrong)
      longer(1) = wrong(i)
      CHECK_REFUSED(call_with(k), STICKSLIP_STRUCT_SIZE, name)
    end do
    ! A newer caller's type, the unknown tail all zero: accepted. With any bit set there, refused.
    newer = [size_of + 1, size_of + 8, int(LONGEST, c_int64_t)]
    do i = 1, size(newer)
      longer(1) = newer(i)
      CHECK_OK(call_with(k))
      bytes(newer(i)) = 1
      CHECK_REFUSED(call_with(k), STICKSLIP_STRUCT_SIZE, name)
      bytes(newer(i)) = 0
    end do
  end subroutine

  ! Outputs. A longer one is filled as far as it is known; its size and its tail stay.
  subroutine check_counters()
    type(stickslip_counters) :: counters
    type(newer_counters) :: newer
    counters%struct_size = COUNTERS_1 - 1
    CHECK_REFUSED(stickslip_interface_counters(h%s%contact, counters), STICKSLIP_STRUCT_SIZE, 'stickslip_counters')
    newer%known%struct_size = stickslip_counters_size + 8
    newer%tail = 77
    CHECK_OK(stickslip_interface_counters(h%s%contact, newer%known))
    CHECK(newer%known%struct_size == stickslip_counters_size + 8 .and. newer%tail == 77 .and. newer%known%searches > 0)
  end subroutine

  subroutine check_response()
    type(stickslip_node_response) :: r
    call response_fill(r)
    r%struct_size = stickslip_node_response_size + 8000
    CHECK_REFUSED(stickslip_node_respond(e%node, r), STICKSLIP_STRUCT_SIZE, 'stickslip_node_response')
    call response_untouched(r)
  end subroutine

  ! A newer caller's longer options: defaults, and zeros in what this library does not know.
  subroutine check_options()
    type(newer_options) :: grown
    integer(c_int64_t), parameter :: GROWN_SIZE = stickslip_options_size + 16
    grown%known%struct_size = UNWRITTEN_INTEGER
    grown%known%mu = UNWRITTEN
    CHECK_REFUSED(stickslip_options_init(grown%known, OPTIONS_1 - 1), STICKSLIP_STRUCT_SIZE, 'struct_size')
    CHECK_REFUSED(stickslip_options_init(grown%known, 0_c_int64_t), STICKSLIP_STRUCT_SIZE, 'struct_size')
    CHECK(grown%known%struct_size == UNWRITTEN_INTEGER .and. untouched(grown%known%mu))
    grown%unknown = UNWRITTEN
    CHECK_OK(stickslip_options_init(grown%known, GROWN_SIZE))
    CHECK(grown%known%struct_size == GROWN_SIZE .and. grown%known%coverage_min == 1d-8 .and. grown%known%mu == 0)
    CHECK(all(grown%unknown == 0))
  end subroutine
end program
