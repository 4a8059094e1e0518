! Stateless calls and distinct handles from several threads at once give the bits that one thread gets; messages belong
! to their thread. Threads are OpenMP's, whose stacks are not the test's to choose.
#include "check.inc"
program t50_threads
  use, intrinsic :: iso_c_binding
  use calls
  use check
  use scenes
  use stickslip
  use omp_lib, only: omp_get_num_threads, omp_get_thread_num
  implicit none
  integer, parameter :: THREADS = 6, ROUNDS = 20

  ! Everything one thread computes.
  type work
    type(element) :: e
    type(scene) :: s
    type(triplets) :: t
    real(c_double) :: r(UNKNOWNS)
  end type
  type(work), target, save :: expected, works(0:THREADS - 1)
  real(c_double) :: normal(3)
  integer :: k, round

  call element_init(expected%e)
  call scene_init(expected%s)
  call compute(expected)
  do k = 0, THREADS - 1
    call element_init(works(k)%e)
    call scene_init(works(k)%s)
  end do

  !$omp parallel num_threads(THREADS) private(round, normal, k)
  CHECK(omp_get_num_threads() == THREADS)
  k = omp_get_thread_num()
  CHECK(last_message() == '')
  do round = 1, ROUNDS
    call compute(works(k))
    call compare(works(k))
    ! Refusals in the midst of others' successes.
    CHECK_REFUSED(stickslip_interface_rollback(no_handle()), STICKSLIP_NULL_POINTER, 'interface')
  end do
  ! One thread's success leaves the others' messages.
  !$omp barrier
  if (k == 0) then
    CHECK_OK(stickslip_node_normal([0d0, 0d0, 1d0], normal))
  end if
  !$omp barrier
  CHECK(last_message() == '' .eqv. k == 0)
  !$omp end parallel

contains

  subroutine compute(w)
    type(work), target, intent(inout) :: w
    integer :: step
    CHECK_OK(call_weights(w%e))
    CHECK_OK(call_gap(w%e))
    CHECK_OK(call_residual(w%e))
    CHECK_OK(call_tangent(w%e))
    CHECK_OK(call_respond(w%e))
    call scene_create(w%s)
    do step = 1, 2
      call scene_residual(w%s, w%r)
      call scene_tangent(w%s, w%t)
      call scene_commit(w%s)
    end do
    call scene_residual(w%s, w%r)
    call scene_destroy(w%s)
  end subroutine

  subroutine compare(w)
    type(work), intent(in) :: w
    CHECK(all(same(w%e%w_out%ab, expected%e%w_out%ab)) .and. all(same(w%e%w_out%ac, expected%e%w_out%ac)))
    CHECK(all(same(w%e%w_out%dab, expected%e%w_out%dab)) .and. all(same(w%e%w_out%dac, expected%e%w_out%dac)))
    CHECK(all(same(w%e%gap, expected%e%gap)))
    CHECK(all(same(w%e%force, expected%e%force)))
    CHECK(all(same(w%e%k, expected%e%k)))
    CHECK(all(words(w%e%responses(4)) == words(expected%e%responses(4))))
    CHECK(all(same(w%r, expected%r)))
    CHECK(triplets_equal(w%t, expected%t))
  end subroutine

  ! A response's bits.
  function words(r)
    type(stickslip_node_response), intent(in) :: r
    integer(c_int64_t) :: words(stickslip_node_response_size / 8)
    words = transfer(r, words)
  end function
end program
