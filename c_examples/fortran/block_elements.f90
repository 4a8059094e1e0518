! block_elements: the block of block_fortran.f90 in a code that calls each element once in an iteration, as FEAP does, and has
! nothing but elements. The same answer and the same iterations.
!
! The contact, to copy: elmt_handle.f90. The rest is what codes have.
!
! From this folder, with the library installed in $PREFIX:
!   gfortran -O2 $PREFIX/include/stickslip.f90 block_model.f90 elmt_solid.f90 elmt_handle.f90 band_matrix.f90 \
!     block_elements.f90 $PREFIX/lib/libstickslip.a -llapack -lblas -lpthread -ldl -lm -o block_elements
!   ./block_elements [--current] [FILE]
!
! FILE receives the nodal displacements. --current: contact at the present positions (large sliding); else at those of
! the undeformed bodies. At the end of --current a deformation that the library refuses is handed to the elements: they must go on
! with the numbers of before. Debian: gfortran, liblapack-dev.
program block_elements
  use band_matrix
  use block_model
  use handle_elements, only: begin, elmt_handle, in_equilibrium, last_message, next_step, nodes_in_states, refusal, &
      residual_only, tangent_and_residual, the_end, small_displacements => small ! names of its own: FEAP has many
  use solid_element
  use stickslip, only: STICKSLIP_OK, STICKSLIP_WEIGHTS_CURRENT, STICKSLIP_WEIGHTS_REFERENCE
  implicit none

  ! Converged: as block_fortran.f90 has it.
  real(dp), parameter :: rtol = 2e-11_dp, noise = 1e-14_dp, smallest_reference = 1e-12_dp, contact_tolerance = 1e-10_dp
  integer, parameter :: steps = 20, max_iterations = 25

  real(dp) :: f(ndf, numnp), f_contact(ndf, numnp) ! residual; internal forces of the contact alone
  real(dp) :: reference, largest_reference, limit, residual
  character(200) :: file = ''
  integer :: step, iterations, in_state(0:2)

  call read_arguments
  call make_mesh
  call number_equations
  u = 0
  call contact_elements(begin)
  largest_reference = smallest_reference * young * model_size**2
  do step = 1, steps
    call contact_elements(next_step) ! TIME
    call set_loads(end_time * step / steps)
    do iterations = 0, max_iterations
      call form
      if (refusal /= STICKSLIP_OK) call stop_with(trim(last_message)) ! a code of your own goes back and takes half the step
      if (residual <= limit) then
        if (in_equilibrium(contact_tolerance)) exit
      end if
      if (iterations == max_iterations) call stop_with('Newton''s method does not converge')
      call solve_and_update
    end do
    largest_reference = max(largest_reference, reference)
    in_state = nodes_in_states()
    print '(a, i2, a, f3.1, a, i2, a, es8.2, 3(a, i0))', 'step ', step, '  t ', end_time * step / steps, &
        '  iterations ', iterations, '  |r| ', residual, '  gap ', in_state(0), '  stick ', in_state(1), '  slip ', in_state(2)
  end do
  print '(a, 3f15.9)', 'force on the block    ', sum(f_contact(1:3, nblock + 1:), dim=2)
  print '(a, 3f15.9)', 'displacement top left ', u(1:3, block_node(0, 0, mz))
  print '(a, 3f15.9)', 'displacement top right', u(1:3, block_node(mx, 0, mz))
  if (file /= '') call write_displacements
  if (.not. small_displacements) call check_refusal ! frozen weights see no facet shrink
  call the_end

contains

  subroutine read_arguments
    character(200) :: word
    integer :: i
    small_displacements = .true.
    do i = 1, command_argument_count()
      call get_command_argument(i, word)
      if (i == 1 .and. word == '--current') then
        small_displacements = .false.
      else if (word(1:1) /= '-' .and. file == '') then
        file = word
      else
        call stop_with('usage: [--current] [FILE]')
      end if
    end do
  end subroutine

  ! One call of each contact element.
  subroutine contact_elements(isw)
    integer, intent(in) :: isw
    real(dp) :: s(nst, nst), p(ndf, nen)
    integer :: k
    f_contact = 0
    do k = 1, numpair
      call elmt_handle(isw, k, ixc(:, k), s, p)
      if (isw == tangent_and_residual .or. isw == residual_only) call assemble(ixc(:, k), s, p, f_contact)
    end do
  end subroutine

  ! Residual and matrix at u, and how large the forces that do not balance may be.
  subroutine form
    real(dp) :: s(nst, nst), p(ndf, nen)
    integer :: e
    ab = 0
    f = -load
    do e = 1, numel
      call elmt_solid(x(:, ix(:, e)), u(:, ix(:, e)), s, p)
      call assemble(ix(:, e), s, p, f)
    end do
    call contact_elements(tangent_and_residual)
    f = f + f_contact
    residual = norm2(pack(f(1:3, :), id(1:3, :) > 0))
    reference = norm2(load) + norm2(pack(f(1:3, :nblock), id(1:3, :nblock) == 0)) + norm2(f_contact(1:3, :nblock))
    limit = max(rtol * max(reference, largest_reference), &
        noise * young * model_size * min(maxval(abs(u(1:3, :))), model_size))
  end subroutine

  subroutine solve_and_update
    real(dp) :: b(neq)
    integer :: i, n
    do n = 1, numnp
      do i = 1, ndf
        if (id(i, n) > 0) b(id(i, n)) = f(i, n)
      end do
    end do
    call solve(b)
    do n = 1, numnp
      do i = 1, ndf
        if (id(i, n) > 0) u(i, n) = u(i, n) - b(id(i, n))
      end do
    end do
  end subroutine

  ! A facet shrinks to a point: the library refuses, and the elements hand out what they had, all of it finite.
  subroutine check_refusal
    real(dp) :: before(ndf, numnp)
    integer :: a
    call contact_elements(residual_only)
    before = f_contact
    do a = 2, 4
      u(1:3, ixf1(a, 1)) = x(:, ixf1(1, 1)) + u(1:3, ixf1(1, 1)) - x(:, ixf1(a, 1))
    end do
    call contact_elements(residual_only)
    if (refusal == STICKSLIP_OK .or. maxval(abs(f_contact - before)) > 0) call stop_with('a refusal is not handled')
    print '(2a)', 'refused, as it must be: ', trim(last_message)
  end subroutine

  subroutine write_displacements
    integer :: unit, n, status
    open (newunit=unit, file=file, action='write', iostat=status)
    if (status /= 0) call stop_with('cannot write the file of displacements')
    write (unit, '(a)') '# X Y Z ux uy uz'
    do n = 1, nblock
      write (unit, '(6es25.16e3)') x(:, n), u(1:3, n)
    end do
    close (unit)
  end subroutine
end program
