! uel_demo: a little code that plays the host of uel.f90, Abaqus' part, and checks the element.
!
! A strip of two facets, its nodes joined by springs, lies on three facets whose nodes are on springs to the ground.
! Nothing but contact and friction holds the strip. It is pressed, lifted at one end, pushed, pulled and pushed again.
!
! From this folder, with the library installed in $PREFIX:
!   gfortran $PREFIX/include/stickslip.f90 uel.f90 uel_demo.f90 $PREFIX/lib/libstickslip.a \
!     -llapack -lblas -lpthread -ldl -lm -o uel_demo && ./uel_demo
!
! Checked: answer and iterations are those of a direct assembly through the handle, although with the element one
! increment is given up halfway and tried again; a refusal cuts the increment; the tasks of lflags(3); the matrix equals
! differences of the residual, with nodes in gap, stick and slip. Exit code 1 if not. Any consistent units.
program uel_demo
  use contact_interface
  implicit none
  integer, parameter :: increments = 6, given_up = 3 ! the increment that is tried twice
  real(dp), parameter :: friction = 0.3_dp, young = 1000, joint = 100, ground = 300 ! springs [F/L]
  ! Forces on a node: press on all, twice that in the middle; lift at x = 0; push at x = 1.
  real(dp), parameter :: press = 5, lift(increments) = [0, 7, 7, 7, 7, 7], push(increments) = &
      [0.0_dp, 2.0_dp, 3.0_dp, -1.0_dp, 1.2_dp, 3.4_dp]
  ! Newton's method stops at this part of the press: a hundred times the rounding of forces.
  real(dp), parameter :: rtol = 1e-12_dp
  integer, parameter :: max_iterations = 20
  ! What rtol leaves in both, and rounding: the element takes u - du for the end of an increment.
  real(dp), parameter :: same = 1e-12_dp
  ! Central differences err by the rounding of forces over the step, and by the step squared.
  real(dp), parameter :: difference_step = 3e-6_dp, difference_bound = 1e-8_dp
  ! How close: away from the solution, where terms may vanish by chance, but with its states.
  real(dp), parameter :: aside = 1e-4_dp

  ! The host's nodes: 1 to 6 strip, 7 to 14 base, 15 to 20 multiplier nodes; and the element's list of them.
  integer, parameter :: n = 60, nodes(20) = [1, 15, 2, 16, 3, 17, 4, 18, 5, 19, 6, 20, 7, 8, 9, 10, 11, 12, 13, 14]
  integer, parameter :: joints(2, 7) = reshape([1, 2, 3, 4, 5, 6, 1, 3, 3, 5, 2, 4, 4, 6], [2, 7])
  integer, parameter :: of_strip = 18, of_bodies = 42 ! their last unknowns; then the multipliers
  integer :: i, j
  integer, parameter :: place(n) = [((3 * (nodes(i) - 1) + j, j = 1, 3), i = 1, 20)] ! of element's unknowns, here
  real(dp) :: x(3, 20), u(n), u_direct(n), u_old(n), matrix(n, n), residual(n), pnewdt
  integer :: iterations(increments), iterations_direct(increments)
  type(stickslip_interface) :: direct
  logical :: passed = .true.

  interface
    subroutine dgesv(n, nrhs, a, lda, ipiv, b, ldb, info)
      import :: dp
      integer, intent(in) :: n, nrhs, lda, ldb
      real(dp), intent(inout) :: a(lda, *), b(ldb, *)
      integer, intent(out) :: ipiv(*), info
    end subroutine
  end interface

  n1 = 6; n2 = 8
  offsets1 = [0, 4, 8]
  facets1 = [1, 2, 4, 3, 3, 4, 6, 5] ! seen from below
  offsets2 = [0, 4, 8, 12]
  facets2 = [1, 3, 4, 2, 3, 5, 6, 4, 5, 7, 8, 6]
  x(:, 1:6) = reshape([((real([i, j, 0], dp), j = 0, 1), i = 0, 2)], [3, 6])
  x(:, 7:14) = reshape([(([0.9_dp * i - 0.4_dp, 1.4_dp * j - 0.2_dp, 0.0_dp], j = 0, 1), i = 0, 3)], [3, 8])
  x(:, 15:20) = x(:, 1:6)
  call run(.false., u_direct, iterations_direct)
  call run(.true., u, iterations)
  print '(2(a, 6i3))', 'iterations', iterations, '; directly assembled', iterations_direct
  call check('increments with other iterations', real(count(iterations /= iterations_direct), dp), 0.0_dp)
  u_direct(of_bodies + 1:) = u_direct(of_bodies + 1:) - reshape(start, [of_strip])
  call check('unknowns, difference', maxval(abs(u - u_direct)) / maxval(abs(u)), same)
  call check_element
  call must(stickslip_interface_destroy(direct))
  call must(stickslip_interface_destroy(contact))
  if (.not. passed) stop 1

contains

  subroutine run(by_element, u, iterations)
    logical, intent(in) :: by_element
    real(dp), intent(out) :: u(n)
    integer, intent(out) :: iterations(increments)
    real(dp) :: extrapolation(n)
    integer :: k
    u = 0
    if (.not. by_element) call start_directly(u)
    extrapolation = 0
    do k = 1, increments
      u_old = u
      if (by_element .and. k == given_up) call give_up(k, u)
      u = u_old + extrapolation ! as Abaqus does it
      call newton(by_element, k, u, max_iterations, iterations(k))
      if (.not. norm2(residual) <= rtol * press) call stop_with('Newton''s method does not converge')
      if (.not. by_element) &
          call must(stickslip_interface_commit(direct, strip(u), base(u), u(of_bodies + 1:), c_null_ptr))
      extrapolation = u - u_old
    end do
  end subroutine

  ! An attempt at increment k that leads nowhere: two iterations, then a state that contact refuses; back to the start.
  subroutine give_up(k, u)
    integer, intent(in) :: k
    real(dp), intent(inout) :: u(n)
    integer :: done
    call newton(.true., k, u, 2, done)
    u(:of_strip) = -reshape(x(:, 1:6), [of_strip]) ! the strip shrinks to a point
    call form(.true., k, u)
    call check('pnewdt after a refusal', pnewdt, 0.5_dp)
  end subroutine

  ! At most `limit` iterations of increment k; residual is the last one's.
  subroutine newton(by_element, k, u, limit, iterations)
    logical, intent(in) :: by_element
    integer, intent(in) :: k, limit
    real(dp), intent(inout) :: u(n)
    integer, intent(out) :: iterations
    integer :: pivots(n), info
    iterations = 0
    do
      call form(by_element, k, u)
      if (norm2(residual) <= rtol * press .or. iterations == limit) return
      call dgesv(n, 1, matrix, n, pivots, residual, n, info)
      if (info /= 0) call stop_with('dgesv finds the matrix singular')
      u = u - residual
      iterations = iterations + 1
    end do
  end subroutine

  ! Residual and matrix of increment k: springs, loads and contact.
  subroutine form(by_element, k, u)
    logical, intent(in) :: by_element
    integer, intent(in) :: k
    real(dp), intent(in) :: u(n)
    real(dp) :: rhs(n, 1), amatrx(n, n)
    integer :: i, s, ends(2)
    matrix = 0
    do i = 1, 3
      do s = 1, size(joints, 2)
        ends = 3 * (joints(:, s) - 1) + i
        matrix(ends, ends) = matrix(ends, ends) + joint * reshape([1, -1, -1, 1], [2, 2])
      end do
    end do
    do i = of_strip + 1, of_bodies
      matrix(i, i) = ground
    end do
    residual = matmul(matrix, u)
    residual(3:18:3) = residual(3:18:3) + press * [1, 1, 2, 2, 1, 1]
    residual(3:6:3) = residual(3:6:3) - lift(k)
    residual(7:10:3) = residual(7:10:3) - push(k)
    if (by_element) then
      call call_element(1, k, u(place), rhs, amatrx)
      residual(place) = residual(place) - rhs(:, 1)
      matrix(place, place) = matrix(place, place) + amatrx
    else
      call add_directly(u)
    end if
  end subroutine

  ! task: lflags(3). u in the element's order. k: the increment, of step 1.
  subroutine call_element(task, k, u, rhs, amatrx)
    integer, intent(in) :: task, k
    real(dp), intent(in) :: u(n)
    real(dp), intent(out) :: rhs(n, 1), amatrx(n, n)
    real(dp) :: svars(1), energy(8), du(n, 1) ! not used: svars, energy
    real(dp), parameter :: at_rest(n) = 0, real_nothing(2) = 0
    integer, parameter :: nothing(1) = 0
    du(:, 1) = u - u_old(place)
    pnewdt = 1
    call uel(rhs, amatrx, svars, energy, n, 1, 1, [friction, young], 2, x(:, nodes), 3, size(nodes), u, du, at_rest, &
        at_rest, 1, real_nothing, 1.0_dp, 1, k, 1, real_nothing, 0, nothing, real_nothing, real_nothing, 0, &
        [1, 0, task, 0, 0], n, real_nothing, 1, pnewdt, nothing, 0, 1.0_dp)
  end subroutine

  ! The same contact with a handle of the host's own and the multipliers themselves as unknowns.
  subroutine start_directly(u)
    real(dp), intent(inout) :: u(n)
    integer(c_int64_t) :: numbers(3, 20)
    numbers = reshape([(i, i = 1, n)], [3, 20])
    call create(x(:, 1:6), x(:, 7:14), numbers(:, 1:6), numbers(:, 7:14), numbers(:, 15:20), friction, young, direct)
    call must(stickslip_interface_initial_multipliers(direct, u(of_bodies + 1:)))
  end subroutine

  subroutine add_directly(u)
    real(dp), intent(in) :: u(n)
    integer(c_int64_t), allocatable, target :: row(:), column(:)
    real(dp), allocatable, target :: entry(:)
    real(dp) :: force(n)
    integer(c_int64_t) :: entries, k
    call must(stickslip_interface_residual(direct, strip(u), base(u), u(of_bodies + 1:), c_null_ptr, force, &
        force(of_strip + 1:), force(of_bodies + 1:)))
    residual = residual + force
    call must(stickslip_interface_tangent_coo(direct, strip(u), base(u), u(of_bodies + 1:), c_null_ptr, 0_c_int64_t, &
        c_null_ptr, c_null_ptr, c_null_ptr, entries))
    allocate (row(entries), column(entries), entry(entries))
    call must(stickslip_interface_tangent_coo(direct, strip(u), base(u), u(of_bodies + 1:), c_null_ptr, entries, &
        c_loc(row), c_loc(column), c_loc(entry), entries))
    do k = 1, entries
      matrix(row(k), column(k)) = matrix(row(k), column(k)) + entry(k)
    end do
  end subroutine

  ! Positions of the strip, and of the base, at u.
  function strip(u)
    real(dp), intent(in) :: u(n)
    real(dp) :: strip(3, 6)
    strip = x(:, 1:6) + reshape(u(:of_strip), [3, 6])
  end function

  function base(u)
    real(dp), intent(in) :: u(n)
    real(dp) :: base(3, 8)
    base = x(:, 7:14) + reshape(u(of_strip + 1:of_bodies), [3, 8])
  end function

  ! Close to the end of the last increment: states, tasks, matrix against differences.
  subroutine check_element
    real(dp) :: at(n), rhs(n, 1), amatrx(n, n), other(n, 1), none(n, n), differences(n, n), unit(n)
    integer(c_int32_t), target :: state(6)
    logical :: multiplier(n), block(n, n)
    integer :: r, c
    at = u + aside * [(sin(real(i, dp)), i = 1, n)]
    call must(stickslip_interface_states(contact, strip(at), base(at), at(of_bodies + 1:) + reshape(start, [3 * n1]), &
        c_null_ptr, stickslip_states(state=c_loc(state))))
    do i = STICKSLIP_STATE_GAP, STICKSLIP_STATE_SLIP
      if (all(state /= i)) call stop_with('not all states are there')
    end do
    at = at(place)
    call call_element(1, increments, at, rhs, amatrx)
    call call_element(2, increments, at, other, none)
    call check('matrix alone', maxval(abs(none - amatrx)) + maxval(abs(other)), 0.0_dp)
    call call_element(5, increments, at, other, none)
    call check('residual alone', maxval(abs(other - rhs)) + maxval(abs(none)), 0.0_dp)
    do j = 1, n
      unit = 0
      unit(j) = difference_step
      call call_element(5, increments, at + unit, rhs, none)
      call call_element(5, increments, at - unit, other, none)
      differences(:, j) = (other(:, 1) - rhs(:, 1)) / (2 * difference_step)
    end do
    multiplier = place > of_bodies
    do r = 0, 1
      do c = 0, 1
        block = spread(multiplier .eqv. r == 1, 2, n) .and. spread(multiplier .eqv. c == 1, 1, n)
        call check(merge('multiplier rows', 'forces         ', r == 1) // ' by ' // &
            merge('multipliers  ', 'displacements', c == 1), maxval(abs(amatrx - differences), block) / &
            maxval(abs(amatrx), block), difference_bound)
      end do
    end do
  end subroutine

  subroutine check(what, figure, bound)
    character(*), intent(in) :: what
    real(dp), intent(in) :: figure, bound
    print '(a, t40, 2(a, es9.2))', what, merge('ok    ', 'FAILED', figure <= bound), figure, ' <= ', bound
    passed = passed .and. figure <= bound
  end subroutine
end program
