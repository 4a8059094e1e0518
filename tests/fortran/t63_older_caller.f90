! A caller that was compiled with the first version of the module: its types end earlier, and what lies behind them is
! its own, neither read nor written.
#include "check.inc"
program t63_older_caller
  use, intrinsic :: iso_c_binding
  use check
  use scenes
  use stickslip
  implicit none
  ! The sizes of the first version, in bytes and in integers of 8.
  integer(c_int64_t), parameter :: OPTIONS_1 = 88, COUNTERS_1 = 88
  integer, parameter :: WORDS = 11
  type(scene), target, save :: s
  ! Types as that caller has them, and what lies behind.
  integer(c_int64_t), target, save :: options(32), counters(32), before(32)
  type(stickslip_options), pointer :: older_options
  type(stickslip_counters), pointer :: older_counters
  type(stickslip_counters), target, save :: now
  integer(c_int64_t), pointer :: words_now(:)
  real(c_double) :: r(UNKNOWNS), q(UNKNOWNS)
  integer(c_int32_t) :: status

  call c_f_pointer(c_loc(options), older_options)
  call c_f_pointer(c_loc(counters), older_counters)

  options = UNWRITTEN_INTEGER
  CHECK_OK(stickslip_options_init(older_options, OPTIONS_1))
  CHECK_UNTOUCHED(options(WORDS + 1:))
  CHECK(older_options%struct_size == OPTIONS_1 .and. .not. c_associated(older_options%method) .and. older_options%mu == 0)
  CHECK(older_options%search_distance == 0)
  ! Too short even for that caller.
  before = options
  CHECK_REFUSED(stickslip_options_init(older_options, OPTIONS_1 - 8), STICKSLIP_STRUCT_SIZE, 'options')
  CHECK(all(options == before))

  ! An interface made with them answers as one of a caller of today; all shortcuts are taken.
  call scene_init(s, base=0)
  older_options%mu = s%options%mu
  older_options%method = c_loc(s%method)
  call scene_create(s)
  call scene_residual(s, r)
  call scene_destroy(s)
  CHECK_OK(stickslip_interface_create(s%nonmortar, s%mortar, older_options, s%contact))
  CHECK_UNTOUCHED(options(WORDS + 1:))
  call scene_residual(s, q)
  CHECK(all(same(r, q)))

  counters = UNWRITTEN_INTEGER
  counters(1) = COUNTERS_1
  CHECK_OK(stickslip_interface_counters(s%contact, now))
  CHECK_OK(stickslip_interface_counters(s%contact, older_counters))
  CHECK_UNTOUCHED(counters(WORDS + 1:))
  call c_f_pointer(c_loc(now), words_now, [WORDS])
  CHECK(counters(1) == COUNTERS_1 .and. all(counters(2:WORDS) == words_now(2:WORDS)))
  counters = UNWRITTEN_INTEGER
  counters(1) = COUNTERS_1 - 8
  CHECK_REFUSED(stickslip_interface_counters(s%contact, older_counters), STICKSLIP_STRUCT_SIZE, 'stickslip_counters')
  CHECK_UNTOUCHED(counters(2:))
  call scene_destroy(s)

  ! A refusal names the option at fault, as ever.
  older_options%mu = -1
  status = stickslip_interface_create(s%nonmortar, s%mortar, older_options, s%contact)
  CHECK_REFUSED(status, STICKSLIP_INVALID_VALUE, 'options.mu')
  CHECK_UNTOUCHED(options(WORDS + 1:))
end program
