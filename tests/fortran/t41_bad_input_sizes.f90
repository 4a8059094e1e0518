! Sizes of types of a newer caller's module, which are accepted: what this library does not know must be zero where it goes
! in, and is filled with zeros where it comes out. The sizes that are refused stand in tests/capi/bad_input.txt; an older
! caller's ones are those of its module, t63_older_caller.f90.
#include "check.inc"
program t41_bad_input_sizes
  use, intrinsic :: iso_c_binding
  use calls
  use check
  use scenes
  use stickslip
  implicit none
  type, bind(C) :: newer_options
    type(stickslip_options) :: known
    real(c_double) :: unknown(2) = 0
  end type
  type, bind(C) :: newer_counters
    type(stickslip_counters) :: known
    integer(c_int64_t) :: unknown
  end type
  integer(c_int64_t), parameter :: OPTIONS_SIZE = stickslip_options_size + 16, COUNTERS_SIZE = stickslip_counters_size + 8
  type(scene), target, save :: s
  ! Targets, for the library reads and writes behind the part that is passed.
  type(newer_options), target, save :: options
  type(newer_counters), target, save :: counters
  integer(c_int32_t) :: status

  options%unknown = UNWRITTEN
  CHECK_OK(stickslip_options_init(options%known, OPTIONS_SIZE))
  CHECK(options%known%struct_size == OPTIONS_SIZE .and. .not. c_associated(options%known%method) .and. options%known%mu == 0)
  CHECK(all(options%unknown == 0))

  call scene_init(s)
  options%known = s%options
  options%known%struct_size = OPTIONS_SIZE
  CHECK_OK(stickslip_interface_create(s%nonmortar, s%mortar, options%known, s%contact))
  counters%known%struct_size = COUNTERS_SIZE
  counters%unknown = 77
  CHECK_OK(stickslip_interface_counters(s%contact, counters%known))
  CHECK(counters%known%struct_size == COUNTERS_SIZE .and. counters%unknown == 0 .and. counters%known%searches > 0)
  call scene_destroy(s)

  options%unknown(2) = 1
  status = stickslip_interface_create(s%nonmortar, s%mortar, options%known, s%contact)
  CHECK_REFUSED(status, STICKSLIP_STRUCT_SIZE, 'stickslip_options')
  CHECK(address_of(s%contact) == 0)
end program
