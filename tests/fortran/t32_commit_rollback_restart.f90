! History: evaluations leave it alone, a commit moves it, a rollback and a restart bring it back to the bit.
#include "check.inc"
program t32_commit_rollback_restart
  use, intrinsic :: iso_c_binding
  use check
  use scenes
  use stickslip
  implicit none
  type(scene), target, save :: s, restarted, there
  type(history), save :: before, after, now
  type(triplets), target, save :: t, u
  real(c_double) :: r(UNKNOWNS), q(UNKNOWNS)
  integer(c_int32_t) :: kind_of_weights

  do kind_of_weights = STICKSLIP_WEIGHTS_CURRENT, STICKSLIP_WEIGHTS_REFERENCE
    call scene_init(s)
    s%method%weights = kind_of_weights
    call scene_create(s)
    CHECK_REFUSED(stickslip_interface_rollback(s%contact), STICKSLIP_NOTHING_TO_ROLL_BACK, 'commit')

    call history_take(s%contact, before)
    call scene_residual(s, r)
    call scene_tangent(s, t)
    call history_take(s%contact, now)
    CHECK(history_equal(before, now))

    call scene_commit(s)
    call history_take(s%contact, after)
    CHECK(.not. history_equal(before, after))

    ! One step back: the same bits as before the commit. Only one can be undone.
    CHECK_OK(stickslip_interface_rollback(s%contact))
    call history_take(s%contact, now)
    CHECK(history_equal(before, now))
    call scene_residual(s, q)
    call scene_tangent(s, u)
    CHECK(all(same(r, q)))
    CHECK(triplets_equal(t, u))
    CHECK_REFUSED(stickslip_interface_rollback(s%contact), STICKSLIP_NOTHING_TO_ROLL_BACK, 'commit')

    ! Restart: another handle on the same surfaces takes the history and goes on with the same bits.
    call scene_commit(s)
    call scene_slide(s, 0.1d0)
    call scene_commit(s)
    call history_take(s%contact, after)
    call scene_slide(s, 0.07d0)
    call scene_residual(s, r)
    call scene_init(restarted)
    restarted%method%weights = kind_of_weights
    call scene_create(restarted)
    call history_put(restarted%contact, after)
    call history_take(restarted%contact, now)
    CHECK(history_equal(after, now))
    CHECK_REFUSED(stickslip_interface_rollback(restarted%contact), STICKSLIP_NOTHING_TO_ROLL_BACK, 'commit')
    restarted%x1 = s%x1
    call scene_residual(restarted, q)
    CHECK(all(same(r, q)))
    call scene_commit(s)
    call scene_commit(restarted)
    call history_take(s%contact, after)
    call history_take(restarted%contact, now)
    CHECK(history_equal(after, now))

    ! Larger buffers are fine, and only the needed part is written.
    now%integers = UNWRITTEN_INTEGER
    now%reals = UNWRITTEN
    call history_write_all(s%contact, now)
    CHECK(all(now%integers(:now%n_integers) == after%integers(:now%n_integers)))
    CHECK_UNTOUCHED(now%integers(now%n_integers + 1:))
    CHECK_UNTOUCHED(now%reals(now%n_reals + 1:))
    call scene_destroy(s)
    call scene_destroy(restarted)
  end do

  ! A given t_n: as if the interface had been created there.
  call scene_init(s)
  call scene_init(there)
  call scene_slide(s, 0.2d0)
  there%reference1 = s%x1
  there%reference2 = s%x2
  call scene_create(s)
  call scene_create(there)
  call scene_commit(s)
  CHECK_OK(stickslip_interface_set_previous(s%contact, there%reference1, there%reference2))
  call history_take(s%contact, now)
  call history_take(there%contact, after)
  ! But for where they were created, and the checksum over that.
  now%integers([HISTORY_CHECKSUM, HISTORY_COORDINATES]) = after%integers([HISTORY_CHECKSUM, HISTORY_COORDINATES])
  CHECK(history_equal(now, after))
  CHECK_REFUSED(stickslip_interface_rollback(s%contact), STICKSLIP_NOTHING_TO_ROLL_BACK, 'commit')
  call scene_destroy(s)
  call scene_destroy(there)

contains

  subroutine history_put(contact, h)
    type(stickslip_interface), intent(in) :: contact
    type(history), intent(in) :: h
    integer(c_int32_t) :: status
    status = stickslip_interface_history_import(contact, h%n_integers, h%integers, h%n_reals, h%reals)
    CHECK_OK(status)
  end subroutine

  ! The whole arrays are offered, whatever is needed.
  subroutine history_write_all(contact, h)
    type(stickslip_interface), intent(in) :: contact
    type(history), intent(inout) :: h
    integer(c_int32_t) :: status
    status = stickslip_interface_history_export(contact, size(h%integers, kind=c_int64_t), h%integers, &
        size(h%reals, kind=c_int64_t), h%reals)
    CHECK_OK(status)
  end subroutine
end program
