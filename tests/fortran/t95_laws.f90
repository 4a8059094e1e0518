! Laws in place of Coulomb's: a function of Fortran that says what Coulomb says, and remembers how often a node was closed.
#include "check.inc"
module t95_law
  use, intrinsic :: iso_c_binding
  use stickslip
  implicit none
  integer :: calls = 0
contains
  integer(c_int32_t) function coulomb(user, point, states, answer, states_after) bind(C)
    type(c_ptr), value :: user
    type(stickslip_law_point), intent(in) :: point
    real(c_double), intent(in) :: states(*)
    type(stickslip_law_answer), intent(inout) :: answer
    real(c_double), intent(inout) :: states_after(*)
    real(c_double), pointer :: factor
    call c_f_pointer(user, factor)
    calls = calls + 1
    answer%threshold = -factor * point%mu * point%normal
    answer%dthreshold_dnormal = -factor * point%mu
    states_after(1) = states(1) + 1
    coulomb = 0
  end function
end module

program t95_laws
  use, intrinsic :: iso_c_binding
  use check
  use scenes
  use stickslip
  use t95_law
  implicit none

  real(c_double), parameter :: SAME_NUMBER = 1d-13
  type(scene), target, save :: s
  type(stickslip_law), target :: law
  type(stickslip_layer), target :: layer
  type(stickslip_states) :: out
  real(c_double), target :: factor, states(NA), worn(NA), overclosure(2) = [0d0, 1d-3], pressure(2) = [0d0, 1d2]
  real(c_double) :: force1(3, NA), force2(3, NC), rows(3, NA), plain1(3, NA), plain(3, NA)
  integer(c_int64_t) :: n

  call scene_init(s)
  call scene_create(s)
  CHECK_OK(stickslip_interface_residual(s%contact, s%x1, s%x2, s%lambda, c_null_ptr, plain1, force2, plain))
  factor = 1
  CHECK_OK(stickslip_interface_set_threshold(s%contact, c_funloc(coulomb), c_loc(factor), 1_c_int64_t))
  CHECK_OK(stickslip_interface_residual(s%contact, s%x1, s%x2, s%lambda, c_null_ptr, force1, force2, rows))
  CHECK(calls > 0 .and. calls <= NA)
  CHECK(maxval(abs(force1 - plain1)) <= SAME_NUMBER * maxval(abs(plain1)))
  CHECK(maxval(abs(rows - plain)) <= SAME_NUMBER * maxval(abs(plain)))
  CHECK_OK(stickslip_interface_commit(s%contact, s%x1, s%x2, s%lambda, c_null_ptr))
  CHECK_OK(stickslip_interface_law_states(s%contact, int(NA, c_int64_t), c_loc(states), n))
  CHECK(n == NA .and. maxval(states) == 1 .and. minval(states) >= 0)
  states = 2
  CHECK_OK(stickslip_interface_set_law_states(s%contact, n, states))
  states = 0
  CHECK_OK(stickslip_interface_law_states(s%contact, int(NA, c_int64_t), c_loc(states), n))
  CHECK(all(states == 2))
  CHECK_REFUSED(stickslip_interface_rollback(s%contact), STICKSLIP_NOTHING_TO_ROLL_BACK, 'commit')
  factor = -1
  CHECK_REFUSED(stickslip_interface_residual(s%contact, s%x1, s%x2, s%lambda, c_null_ptr, force1, force2, rows), STICKSLIP_INVALID_VALUE, 'node')

  law%kind = STICKSLIP_LAW_WEAKENING
  law%mu_after = 0.2d0
  law%critical_slip = 0.01d0
  CHECK_OK(stickslip_interface_set_law(s%contact, c_loc(law)))
  CHECK_OK(stickslip_interface_residual(s%contact, s%x1, s%x2, s%lambda, c_null_ptr, force1, force2, rows))
  CHECK_OK(stickslip_interface_law_states(s%contact, 0_c_int64_t, c_null_ptr, n))
  CHECK(n == NA)
  law%kind = 9
  CHECK_REFUSED(stickslip_interface_set_law(s%contact, c_loc(law)), STICKSLIP_INVALID_VALUE, 'law.kind')
  CHECK_OK(stickslip_interface_set_law(s%contact, c_null_ptr))

  layer%n_overclosure = 2
  layer%overclosure = c_loc(overclosure)
  layer%pressure = c_loc(pressure)
  layer%wear = 1d-3
  CHECK_OK(stickslip_interface_set_layer(s%contact, c_loc(layer)))
  CHECK_OK(stickslip_interface_law_states(s%contact, 0_c_int64_t, c_null_ptr, n))
  CHECK(n == 2 * NA)
  out%worn = c_loc(worn)
  CHECK_OK(stickslip_interface_states(s%contact, s%x1, s%x2, s%lambda, c_null_ptr, out))
  CHECK(all(worn >= 0))
  pressure(1) = 1
  CHECK_REFUSED(stickslip_interface_set_layer(s%contact, c_loc(layer)), STICKSLIP_INVALID_VALUE, 'layer.pressure')
  CHECK_OK(stickslip_interface_set_layer(s%contact, c_null_ptr))
  CHECK_OK(stickslip_interface_destroy(s%contact))
end program
