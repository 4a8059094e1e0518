! Checks for the ABI's tests in Fortran, the twin of tests/capi/check.h: the first failure says where, what and the
! library's last message, and ends the test. A test that passes prints nothing.
module check
  use, intrinsic :: iso_c_binding
  use, intrinsic :: iso_fortran_env, only: error_unit
  use stickslip
  implicit none
  private
  public :: check_true, check_near, check_status, worst, same, untouched, c_text, last_message, digits_of, address_of, &
            no_handle, crooked, draw

  ! What outputs are filled with before a call that must not write them. Not a likely result, and a normal number, so
  ! that == compares its bits.
  real(c_double), parameter, public :: UNWRITTEN = -1.2345678901234567d123
  integer(c_int64_t), parameter, public :: UNWRITTEN_INTEGER = -123456789012345678_c_int64_t
  integer(c_int32_t), parameter, public :: UNWRITTEN_STATE = -123456789_c_int32_t

  ! Limits of the integers that C has in stdint.h; the smallest cannot be written as a number in Fortran.
  integer(c_int64_t), parameter, public :: INT64_MAX = huge(0_c_int64_t), INT64_MIN = -INT64_MAX - 1
  integer(c_int32_t), parameter, public :: INT32_MAX = huge(0_c_int32_t), INT32_MIN = -INT32_MAX - 1

  ! Longer than any message of the library.
  integer, parameter :: LONGEST_TEXT = 2000

  ! The largest magnitude; NaN if there is one.
  interface worst
    module procedure worst0, worst1, worst2, worst3
  end interface

  ! Equal bits.
  interface same
    module procedure same_reals, same_integers
  end interface

  ! Still what it was filled with.
  interface untouched
    module procedure untouched_real, untouched_integer, untouched_state
  end interface

contains

  subroutine check_true(holds, file, line, text)
    logical, intent(in) :: holds
    character(*), intent(in) :: file, text
    integer, intent(in) :: line
    if (.not. holds) call fail(file, line, text // ' does not hold')
  end subroutine

  ! |difference| <= tolerance; false for NaN.
  subroutine check_near(difference, tolerance, file, line, text)
    real(c_double), intent(in) :: difference, tolerance
    character(*), intent(in) :: file, text
    integer, intent(in) :: line
    character(80) :: numbers
    if (difference <= tolerance) return
    write (numbers, '(a, es10.3, a, es10.3)') ': differ by ', difference, ', allowed ', tolerance
    call fail(file, line, text // trim(numbers))
  end subroutine

  ! The status is the expected one; a refusal's message holds the word, a success leaves none.
  subroutine check_status(status, expected, word, file, line, text)
    integer(c_int32_t), intent(in) :: status, expected
    character(*), intent(in) :: word, file, text
    integer, intent(in) :: line
    character(LONGEST_TEXT) :: message
    logical :: said
    message = last_message()
    said = message == '' .eqv. expected == STICKSLIP_OK
    if (expected /= STICKSLIP_OK) said = said .and. index(message, word) > 0
    if (status == expected .and. said) return
    call fail(file, line, text // new_line('a') // &
        '  gave ' // c_text(stickslip_status_string(status)) // ', expected ' // &
        c_text(stickslip_status_string(expected)) // ' with a message that names "' // word // '"')
  end subroutine

  subroutine fail(file, line, text)
    character(*), intent(in) :: file, text
    integer, intent(in) :: line
    character(LONGEST_TEXT) :: message
    message = last_message()
    write (error_unit, '(2a, i0, 2a)') file, ':', line, ': ', text
    write (error_unit, '(3a)') '  last message: "', trim(message), '"'
    error stop 1
  end subroutine

  ! The number without blanks.
  pure function digits_of(n) result(text)
    integer(c_int64_t), intent(in) :: n
    character(:), allocatable :: text
    character(20) :: buffer
    write (buffer, '(i0)') n
    text = trim(buffer)
  end function

  ! The text of a C string.
  function c_text(string) result(text)
    type(c_ptr), intent(in) :: string
    character(:), allocatable :: text
    character(kind=c_char), pointer :: letters(:)
    integer :: n
    call c_f_pointer(string, letters, [LONGEST_TEXT])
    text = ''
    do n = 1, LONGEST_TEXT
      if (letters(n) == c_null_char) return
      text = text // letters(n)
    end do
  end function

  ! The calling thread's last message, as a Fortran host reads it. Of a fixed length: gfortran keeps the length of a
  ! deferred-length result in one static variable for all threads.
  character(LONGEST_TEXT) function last_message()
    if (stickslip_last_error_padded(last_message, len(last_message, c_int64_t)) /= STICKSLIP_OK) error stop 2
  end function

  ! An interface's handle as a number; its component is private to the module `stickslip`.
  integer(c_intptr_t) function address_of(contact)
    type(stickslip_interface), intent(in) :: contact
    address_of = transfer(contact, address_of)
  end function

  ! An interface that was never created.
  type(stickslip_interface) function no_handle()
    no_handle = stickslip_interface()
  end function

  ! One byte further: a pointer to no double, integer or struct.
  type(c_ptr) function crooked(pointer)
    type(c_ptr), intent(in) :: pointer
    crooked = transfer(transfer(pointer, 0_c_intptr_t) + 1, pointer)
  end function

  ! Deterministic numbers in -1..1: the generator of Park and Miller, which never overflows.
  real(c_double) function draw(state)
    integer(c_int64_t), intent(inout) :: state
    state = mod(state * 48271, 2147483647_c_int64_t)
    draw = 2 * real(state, c_double) / 2147483647d0 - 1
  end function

  pure real(c_double) function worst0(v)
    real(c_double), intent(in) :: v
    worst0 = abs(v)
  end function

  pure real(c_double) function worst1(v)
    real(c_double), intent(in) :: v(:)
    integer :: i
    worst1 = 0
    do i = 1, size(v)
      ! The negated comparison takes NaN, and a NaN is never replaced.
      if (.not. abs(v(i)) <= worst1 .and. worst1 == worst1) worst1 = abs(v(i))
    end do
  end function

  pure real(c_double) function worst2(v)
    real(c_double), intent(in) :: v(:, :)
    worst2 = worst1(reshape(v, [size(v)]))
  end function

  pure real(c_double) function worst3(v)
    real(c_double), intent(in) :: v(:, :, :)
    worst3 = worst1(reshape(v, [size(v)]))
  end function

  elemental logical function same_reals(a, b)
    real(c_double), intent(in) :: a, b
    same_reals = transfer(a, 0_c_int64_t) == transfer(b, 0_c_int64_t)
  end function

  elemental logical function same_integers(a, b)
    integer(c_int64_t), intent(in) :: a, b
    same_integers = a == b
  end function

  elemental logical function untouched_real(v)
    real(c_double), intent(in) :: v
    untouched_real = same_reals(v, UNWRITTEN)
  end function

  elemental logical function untouched_integer(v)
    integer(c_int64_t), intent(in) :: v
    untouched_integer = v == UNWRITTEN_INTEGER
  end function

  elemental logical function untouched_state(v)
    integer(c_int32_t), intent(in) :: v
    untouched_state = v == UNWRITTEN_STATE
  end function
end module
