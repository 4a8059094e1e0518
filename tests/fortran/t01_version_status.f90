! Version and status texts: never null, and the module's constants are the library's version. How the library was built:
! the words that the header names, in that order, each with something after its "=", no word a path. The twin leaves out the
! calls with NULL for an array or a text, which Fortran cannot write; a handle that was never created stands for them.
#include "check.inc"
program t01_version_status
  use, intrinsic :: iso_c_binding
  use check
  use stickslip
  implicit none
  character(*), parameter :: UNKNOWN = 'unknown status'
  real(c_double) :: normal(3)
  character(40) :: fixed
  character(:), allocatable, save :: message
  character(20) :: version
  integer(c_int32_t) :: status, other

  write (version, '(i0, ".", i0, ".", i0)') STICKSLIP_VERSION_MAJOR, STICKSLIP_VERSION_MINOR, STICKSLIP_VERSION_PATCH
  CHECK(trim(version) == c_text(stickslip_version()))
  call check_build(trim(version))

  ! Nothing refused yet on this thread.
  CHECK(c_text(stickslip_last_error_message()) == '')
  fixed = 'something'
  CHECK_OK(stickslip_last_error_padded(fixed, 40_c_int64_t))
  CHECK(fixed == '')

  do status = STICKSLIP_PANIC, STICKSLIP_CONTACT_LOST
    CHECK(len(c_text(stickslip_status_string(status))) > 3)
    CHECK(c_text(stickslip_status_string(status)) /= UNKNOWN)
    do other = STICKSLIP_PANIC, status - 1
      CHECK(c_text(stickslip_status_string(status)) /= c_text(stickslip_status_string(other)))
    end do
  end do
  CHECK(c_text(stickslip_status_string(INT32_MIN)) == UNKNOWN)
  CHECK(c_text(stickslip_status_string(STICKSLIP_CONTACT_LOST + 1)) == UNKNOWN)

  ! A refusal leaves a message, in C's form and padded, cut, or of no length; reading it leaves it as it is.
  CHECK_REFUSED(stickslip_interface_rollback(no_handle()), STICKSLIP_NULL_POINTER, 'interface')
  message = c_text(stickslip_last_error_message())
  CHECK(len(message) < len(fixed))
  call check_padded(40, message)
  call check_padded(9, 'interface' // repeat('x', 31))
  call check_padded(0, repeat('x', 40))
  CHECK(c_text(stickslip_last_error_message()) == message)
  fixed = repeat('x', 40)
  CHECK_REFUSED(stickslip_last_error_padded(fixed, -1_c_int64_t), STICKSLIP_INVALID_SIZE, 'length')
  CHECK(fixed == repeat('x', 40))

  ! A success clears it.
  CHECK_OK(stickslip_node_normal([0d0, 0d0, 2d0], normal))
  CHECK(all(normal == [0, 0, -1]))

contains

  subroutine check_build(version)
    character(*), intent(in) :: version
    character(8), parameter :: NAMES(7) = [character(8) :: 'version', 'commit', 'target', 'profile', 'compiler', 'kernels', &
      'features']
    character(:), allocatable :: rest, word, value
    integer :: k, blank, sign
    rest = c_text(stickslip_build())
    CHECK(scan(rest, '/' // achar(92)) == 0)
    do k = 1, size(NAMES)
      blank = index(rest // ' ', ' ')
      word = rest(:blank - 1)
      rest = rest(min(blank, len(rest)) + 1:)
      sign = index(word, '=')
      CHECK(sign > 1 .and. sign < len(word))
      CHECK(word(:sign - 1) == trim(NAMES(k)))
      value = word(sign + 1:)
      if (k == 1) then
        CHECK(value == version)
      else if (k == 4) then
        CHECK(index(value, 'release-O') == 1 .or. index(value, 'debug-O') == 1)
      else if (k == 6) then
        CHECK(value == 'plain' .or. value == 'avx2+fma')
      end if
    end do
    CHECK(len(rest) == 0)
  end subroutine

  ! What the variable holds when the first `length` of its letters are offered.
  subroutine check_padded(length, expected)
    integer, intent(in) :: length
    character(*), intent(in) :: expected
    fixed = repeat('x', 40)
    status = stickslip_last_error_padded(fixed, int(length, c_int64_t))
    CHECK(status == STICKSLIP_OK)
    CHECK(fixed == expected)
  end subroutine
end program
