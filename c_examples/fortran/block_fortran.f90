! block_fortran: a finite element code of the old kind, with frictional mortar contact as user elements. Fixed arrays,
! element loops, a band solver. The same problem and the same answer as block_host.c (see block_model.f90).
!
! The contact, to copy: elmt_contact.f90 (a pair of facets), contact_nodes.f90 (the nodes). The rest is what codes have.
!
!   cargo build --release
!   cd c_examples/fortran
!   gfortran -O2 -J../../target ../../include/stickslip.f90 block_model.f90 elmt_solid.f90 contact_nodes.f90 \
!     elmt_contact.f90 band_matrix.f90 block_fortran.f90 ../../target/release/libstickslip.a \
!     -llapack -lblas -lpthread -ldl -lm -o ../../target/block_fortran
!   ../../target/block_fortran [--current] [FILE]
!
! FILE receives the nodal displacements. --current: contact at the present positions (large sliding); else at those of
! the undeformed bodies. Debian: gfortran, liblapack-dev.
program block_fortran
  use band_matrix
  use block_model
  use contact_elements
  use contact_nodes
  use solid_element
  implicit none

  ! Converged: the block's |residual| <= rtol times its largest |loads| + |reactions| + |contact forces| so far, 2-norms of nodal
  ! forces, or below `noise`, the rounding of internal forces when a body moves as a whole; and the contact is in
  ! equilibrium (contact_nodes.f90). The multiplier rows cannot tell: they are as small as the augmentation.
  real(dp), parameter :: rtol = 2e-11_dp, noise = 1e-14_dp, smallest_reference = 1e-12_dp
  integer, parameter :: steps = 20, max_iterations = 25

  real(dp) :: h1(nh, numpair) = 0, h2(nh, numpair) = 0       ! history of the contact elements: t_n, now
  real(dp) :: f(ndf, numnp), f_contact(ndf, numnp)           ! residual; internal forces of the contact alone
  real(dp) :: reference, largest_reference, limit, residual
  character(200) :: file = ''
  integer :: step, iterations

  call read_arguments
  call make_mesh
  call number_equations
  call start_contact
  largest_reference = smallest_reference * young * model_size**2
  do step = 1, steps
    call set_loads(end_time * step / steps)
    do iterations = 0, max_iterations
      call form
      if (residual <= limit .and. in_equilibrium(u(4:6, :))) exit
      if (iterations == max_iterations) call stop_with('Newton''s method does not converge')
      call solve_and_update
    end do
    largest_reference = max(largest_reference, reference)
    call print_step
    h1 = h2
    call commit_nodes(x + u(1:3, :))
  end do
  call print_end
  if (file /= '') call write_displacements

contains

  subroutine read_arguments
    character(200) :: word
    integer :: i
    do i = 1, command_argument_count()
      call get_command_argument(i, word)
      if (i == 1 .and. word == '--current') then
        current_weights = .true.
      else if (word(1:1) /= '-' .and. file == '') then
        file = word
      else
        call stop_with('usage: [--current] [FILE]')
      end if
    end do
  end subroutine

  ! Weights, normals and areas of the undeformed bodies, which are t_0; then the multipliers to start with.
  subroutine start_contact
    u = 0
    call node_geometry(x)
    call contact_pairs(start)
    h1 = h2
    call contact_pairs(gaps)
    call commit_nodes(x)
    call initial_multipliers(u)
  end subroutine

  subroutine contact_pairs(isw)
    integer, intent(in) :: isw
    real(dp) :: xl(ndm, nen), ul(ndf, nen), s(nst, nst), p(ndf, nen)
    integer :: k
    if (isw == gaps) call clear_sums
    do k = 1, numpair
      if (isw == tangent .and. .not. (overlaps(h1(:, k)) .or. overlaps(h2(:, k)))) cycle
      call localise(ixc(:, k), xl, ul)
      call elmt_contact(isw, ixc(:, k), xl, ul, h1(:, k), h2(:, k), s, p)
      if (isw == tangent) call assemble(ixc(:, k), s, p, f_contact)
    end do
  end subroutine

  subroutine localise(nodes, xl, ul)
    integer, intent(in) :: nodes(nen)
    real(dp), intent(out) :: xl(ndm, nen), ul(ndf, nen)
    integer :: a
    xl = 0
    ul = 0
    do a = 1, nen
      if (nodes(a) == 0) cycle
      xl(:, a) = x(:, nodes(a))
      ul(:, a) = u(:, nodes(a))
    end do
  end subroutine

  ! Residual and matrix at u, and how large the forces that do not balance may be.
  subroutine form
    real(dp) :: xl(ndm, nen), ul(ndf, nen), s(nst, nst), p(ndf, nen), s_node(ndf, ndf), p_node(ndf, 1)
    integer :: e, n
    ab = 0
    f = -load
    do e = 1, numel
      call localise(ix(:, e), xl, ul)
      call elmt_solid(xl, ul, s, p)
      call assemble(ix(:, e), s, p, f)
    end do
    f_contact = 0
    call contact_pairs(gaps)
    do n = 1, numnp
      if (.not. carries_multiplier(n)) cycle
      call elmt_contact_node(n, u(:, n), s_node, p_node)
      call assemble([n], s_node, p_node, f_contact)
    end do
    call contact_pairs(tangent)
    f = f + f_contact
    residual = norm2(pack(f(1:3, :), id(1:3, :) > 0))
    reference = norm2(load) + norm2(pack(f(1:3, :nblock), id(1:3, :nblock) == 0)) + &
        norm2(f_contact(1:3, :nblock))
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

  subroutine print_step
    integer :: in_state(0:2), state
    do state = 0, 2
      in_state(state) = count(carries_multiplier .and. response%state == state)
    end do
    print '(a, i2, a, f3.1, a, i2, a, es8.2, 3(a, i0))', 'step ', step, '  t ', end_time * step / steps, &
        '  iterations ', iterations, '  |r| ', residual, '  gap ', in_state(STICKSLIP_STATE_GAP), &
        '  stick ', in_state(STICKSLIP_STATE_STICK), '  slip ', in_state(STICKSLIP_STATE_SLIP)
  end subroutine

  ! Internal forces on the foundation are those of the foundation on the block.
  subroutine print_end
    print '(a, 3f15.9)', 'force on the block    ', sum(f_contact(1:3, nblock + 1:), dim=2)
    print '(a, 3f15.9)', 'displacement top left ', u(1:3, block_node(0, 0, mz))
    print '(a, 3f15.9)', 'displacement top right', u(1:3, block_node(mx, 0, mz))
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
