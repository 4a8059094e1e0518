! Rigid bodies: where a motion puts their nodes, force and moment, the tangent by six unknowns in place of nodes against
! differences at finite rotations, of either side and of both, and of lines; what is refused.
#include "check.inc"
program t94_rigid
  use, intrinsic :: iso_c_binding
  use check
  use scenes
  use stickslip
  implicit none

  integer, parameter :: SIX = 6, NEW = UNKNOWNS + 2 * SIX, MOST = UNKNOWNS**2
  real(c_double), parameter :: DIFFERENCES = 1d-7 ! of entries against central differences, of the largest of their kind of row
  real(c_double), parameter :: ROUND = 1d-14
  real(c_double), parameter :: STEP = 1d-6        ! of the differences: rounding of forces of size 1 gives 1e-10

  ! A side as a body, with a motion that puts it where the scene has it.
  type part
    integer :: side, n
    real(c_double) :: coordinates(SIZE2), point(3), forces(SIZE2)
    integer(c_int64_t) :: equations(SIX)
    type(stickslip_rigid_body) :: body
    type(stickslip_rigid_motion) :: motion
  end type

  type(scene), target, save :: s
  type(part), target, save :: parts(2)
  integer :: base
  do base = 0, 1
    call check_tangent(base, [1], .false., STICKSLIP_RIGID_ARMS_END)
    call check_tangent(base, [2], .false., STICKSLIP_RIGID_ARMS_END)
    call check_tangent(base, [2, 1], .false., STICKSLIP_RIGID_ARMS_END)
    call check_tangent(base, [2, 1], .true., STICKSLIP_RIGID_ARMS_END)
    call check_tangent(base, [2, 1], .true., STICKSLIP_RIGID_ARMS_MIDDLE)
  end do
  call check_lines()
  call check_turns()
  call check_refusals()

contains

  subroutine rigid_init(p, side, first)
    type(part), target, intent(inout) :: p
    integer, intent(in) :: side, first
    type(stickslip_rigid_body) :: frame
    type(stickslip_rigid_motion) :: turn
    real(c_double), target :: axes(3, 3), origin(3)
    real(c_double) :: r(3, 3), x(3, NC)
    integer :: a, i
    p%side = side
    p%n = merge(NA, NC, side == 1)
    p%point = [0.3d0, -0.2d0, 0.8d0]
    p%equations = [(int(first + i, c_int64_t), i = 0, SIX - 1)]
    p%body = stickslip_rigid_body(n_nodes=p%n, coordinates=c_loc(p%coordinates), point=c_loc(p%point), &
        equations=c_loc(p%equations))
    if (side == 1) then
      p%body%node_equations = c_loc(s%equations1)
      x(:, :NA) = s%x1
    else
      p%body%node_equations = c_loc(s%equations2)
      x = s%x2
    end if
    p%motion = stickslip_rigid_motion(rotation=[0.9d0, -1.4d0, 0.5d0])
    CHECK_OK(stickslip_rigid_turn(p%motion))
    p%motion%displacement = [0.4d0, 0.1d0, -0.2d0]
    p%motion%rotation = [0.7d0, 0.2d0, -0.3d0]
    ! The columns of the rotation are where it takes the axes; X = P + R^T (x - P - u).
    axes = reshape([1d0, 0d0, 0d0, 0d0, 1d0, 0d0, 0d0, 0d0, 1d0], [3, 3])
    origin = 0
    frame = stickslip_rigid_body(n_nodes=3, coordinates=c_loc(axes), point=c_loc(origin))
    turn = p%motion
    turn%displacement = 0
    CHECK_OK(stickslip_rigid_positions(frame, turn, r))
    do a = 1, p%n
      p%coordinates(3 * a - 2:3 * a) = p%point + matmul(transpose(r), x(:, a) - p%point - p%motion%displacement)
    end do
  end subroutine

  ! r: force1, force2, rows, of rigid sides 0; then the resultants.
  subroutine residual(n, r)
    integer, intent(in) :: n
    real(c_double), intent(out) :: r(NEW)
    integer :: b, first, last
    do b = 1, n
      if (parts(b)%side == 1) then
        CHECK_OK(stickslip_rigid_positions(parts(b)%body, parts(b)%motion, s%x1))
      else
        CHECK_OK(stickslip_rigid_positions(parts(b)%body, parts(b)%motion, s%x2))
      end if
    end do
    r = 0
    call scene_residual(s, r(:UNKNOWNS))
    do b = 1, n
      first = merge(1, SIZE1 + 1, parts(b)%side == 1)
      last = first + 3 * parts(b)%n - 1
      parts(b)%forces(:3 * parts(b)%n) = r(first:last)
      r(first:last) = 0
      CHECK_OK(stickslip_rigid_resultant(parts(b)%body, parts(b)%motion, parts(b)%forces, r(UNKNOWNS + SIX * (b - 1) + 1:)))
    end do
  end subroutine

  ! Forces, moments, multiplier rows.
  pure integer function kind_of(k)
    integer, intent(in) :: k
    kind_of = 1
    if (k > POSITIONS) kind_of = 3
    if (k > UNKNOWNS) kind_of = merge(1, 2, mod(k - UNKNOWNS - 1, SIX) < 3)
  end function

  ! Moves unknown j.
  subroutine move(j, by)
    integer, intent(in) :: j
    real(c_double), intent(in) :: by
    integer :: b, i
    if (j <= SIZE1) then
      i = j - 1
      s%x1(mod(i, 3) + 1, i / 3 + 1) = s%x1(mod(i, 3) + 1, i / 3 + 1) + by
    else if (j <= POSITIONS) then
      i = j - SIZE1 - 1
      s%x2(mod(i, 3) + 1, i / 3 + 1) = s%x2(mod(i, 3) + 1, i / 3 + 1) + by
    else if (j <= UNKNOWNS) then
      i = j - POSITIONS - 1
      s%lambda(mod(i, 3) + 1, i / 3 + 1) = s%lambda(mod(i, 3) + 1, i / 3 + 1) + by
    else
      b = (j - UNKNOWNS - 1) / SIX + 1
      i = mod(j - UNKNOWNS - 1, SIX) + 1
      if (i <= 3) then
        parts(b)%motion%displacement(i) = parts(b)%motion%displacement(i) + by
      else
        parts(b)%motion%rotation(i - 3) = parts(b)%motion%rotation(i - 3) + by
      end if
    end if
  end subroutine

  ! drops: the first body has no equation of the displacement along y and of the rotation about z.
  subroutine check_tangent(base, sides, drops, arms)
    integer, intent(in) :: base, sides(:)
    integer(c_int32_t), intent(in) :: arms
    logical, intent(in) :: drops
    type(triplets), target :: t
    type(stickslip_rigid) :: rigid
    real(c_double) :: plus(NEW), minus(NEW), forces(POSITIONS), values(MOST), largest, error
    real(c_double), allocatable :: k(:, :), d(:, :)
    logical :: is_left(NEW), rows_of(NEW)
    integer(c_int64_t) :: count, rows(MOST), columns(MOST), n
    integer :: b, at, j, i, e
    allocate (k(NEW, NEW), d(NEW, NEW), source=0d0)
    call scene_init(s, base)
    call scene_create(s)
    call scene_commit(s)
    call scene_slide(s, 0.03d0)
    n = size(sides)
    do b = 1, int(n)
      call rigid_init(parts(b), sides(b), base + UNKNOWNS + SIX * (b - 1))
      parts(b)%motion%arms = arms
    end do
    if (drops) parts(1)%equations([2, 6]) = -1
    call residual(int(n), plus)
    call scene_tangent(s, t)
    at = 0
    do b = 1, int(n)
      forces(at + 1:at + 3 * parts(b)%n) = parts(b)%forces(:3 * parts(b)%n)
      at = at + 3 * parts(b)%n
    end do
    CHECK_OK(stickslip_rigid_create(n, parts(:n)%body, int(base, c_int32_t), t%n, t%rows, t%columns, rigid, count))
    CHECK(0 < count .and. count < t%n)
    CHECK_REFUSED(stickslip_rigid_coo(rigid, count - 1, rows, columns), STICKSLIP_BUFFER_TOO_SMALL, 'capacity')
    CHECK_OK(stickslip_rigid_coo(rigid, count, rows, columns))
    CHECK_OK(stickslip_rigid_values(rigid, parts(:n)%motion, forces, t%values, values))
    CHECK_OK(stickslip_rigid_destroy(rigid))
    CHECK_OK(stickslip_rigid_destroy(rigid))
    do e = 1, int(count)
      k(rows(e) - base + 1, columns(e) - base + 1) = values(e)
    end do
    is_left = .true.
    is_left(UNKNOWNS + SIX * int(n) + 1:) = .false.
    if (any(sides == 1)) is_left(:SIZE1) = .false.
    if (any(sides == 2)) is_left(SIZE1 + 1:POSITIONS) = .false.
    if (drops) is_left(UNKNOWNS + [2, 6]) = .false.
    do j = 1, NEW
      if (.not. is_left(j)) cycle
      call move(j, STEP)
      call residual(int(n), plus)
      call move(j, -2 * STEP)
      call residual(int(n), minus)
      call move(j, STEP)
      where (is_left) d(:, j) = (plus - minus) / (2 * STEP)
    end do
    do i = 1, 3
      rows_of = [(kind_of(j) == i, j = 1, NEW)]
      largest = maxval(abs(k), spread(rows_of, 2, NEW))
      error = maxval(abs(k - d), spread(rows_of, 2, NEW))
      CHECK(largest > 0.1d0)
      CHECK_NEAR(error / largest, 0d0, DIFFERENCES)
    end do
    call scene_destroy(s)
  end subroutine

  ! In the plane: a lever of length 2 along x, turned by a right angle.
  subroutine check_lines()
    real(c_double), target :: x(2), point(2)
    integer(c_int64_t), target :: nodes(2), equations(3)
    type(stickslip_rigid_body) :: body
    type(stickslip_rigid_motion) :: motion
    real(c_double) :: now(3), resultant(4)
    x = [3, 1]
    point = 1
    nodes = [10, 11]
    equations = [0, 1, 2]
    now = 9
    resultant = 9
    body = stickslip_rigid_body(dimension=2, n_nodes=1, coordinates=c_loc(x), point=c_loc(point), node_equations=c_loc(nodes), &
        equations=c_loc(equations))
    motion = stickslip_rigid_motion(displacement=[0.5d0, 0.25d0, 0d0], rotation=[0d0, 0d0, acos(0d0)])
    CHECK_OK(stickslip_rigid_positions(body, motion, now))
    CHECK_NEAR(now, ([1.5d0, 3.25d0, 9d0]), ROUND)
    CHECK_OK(stickslip_rigid_resultant(body, motion, [5d0, 7d0], resultant))
    CHECK_NEAR(resultant, ([5d0, 7d0, -10d0, 9d0]), 1d-13)
    motion%rotation(1) = 1
    CHECK_REFUSED(stickslip_rigid_positions(body, motion, now), STICKSLIP_INVALID_VALUE, 'leaves the plane')
  end subroutine

  ! Many steps of turns are one turn.
  subroutine check_turns()
    real(c_double), target :: x(3), origin(3)
    real(c_double) :: axis(3), a(3), b(3)
    type(stickslip_rigid_body) :: body
    type(stickslip_rigid_motion) :: steps, once
    integer :: k
    x = [1d0, 2d0, -0.5d0]
    origin = 0
    axis = [2d0, -3d0, 6d0] / 7
    body = stickslip_rigid_body(n_nodes=1, coordinates=c_loc(x), point=c_loc(origin))
    once%rotation = 3 * axis
    do k = 1, 100
      steps%rotation = 0.03d0 * axis
      CHECK_OK(stickslip_rigid_positions(body, steps, a))
      CHECK_OK(stickslip_rigid_turn(steps))
      CHECK(all(same(steps%rotation, [0d0, 0d0, 0d0])))
      CHECK_OK(stickslip_rigid_positions(body, steps, b))
      CHECK_NEAR(a, b, ROUND)
    end do
    CHECK_OK(stickslip_rigid_positions(body, once, b))
    CHECK_NEAR(a, b, 1d-13)
  end subroutine

  integer(c_int32_t) function make(body, rigid, count)
    type(stickslip_rigid_body), intent(in) :: body(1)
    type(stickslip_rigid), intent(inout) :: rigid
    integer(c_int64_t), intent(inout) :: count
    integer(c_int64_t), parameter :: rows(2) = [10, 0], columns(2) = [20, 15]
    make = stickslip_rigid_create(1_c_int64_t, body, 0_c_int32_t, 2_c_int64_t, rows, columns, rigid, count)
  end function

  subroutine check_refusals()
    real(c_double), target :: x(3, 2), point(3)
    integer(c_int64_t), target :: nodes(6), equations(SIX)
    integer(c_int64_t) :: count
    type(stickslip_rigid_body) :: body(1)
    type(stickslip_rigid_motion) :: motion(1)
    type(stickslip_rigid) :: rigid
    real(c_double) :: now(3, 2)
    x = reshape([1, 2, 3, 4, 5, 6], [3, 2])
    point = 0
    nodes = [10, 11, 12, 13, 14, 15]
    equations = [0, 1, 2, 3, 4, 5]
    count = UNWRITTEN_INTEGER
    now = UNWRITTEN
    body(1) = stickslip_rigid_body(n_nodes=2, coordinates=c_loc(x), node_equations=c_loc(nodes), equations=c_loc(equations))
    CHECK_REFUSED(make(body, rigid, count), STICKSLIP_NULL_POINTER, 'a rigid body needs a reference point')
    body(1)%point = c_loc(point)
    nodes(6) = 10
    CHECK_REFUSED(make(body, rigid, count), STICKSLIP_INVALID_VALUE, '10 is that of two components')
    nodes(6) = 3
    CHECK_REFUSED(make(body, rigid, count), STICKSLIP_INVALID_VALUE, '3 of a reference point is in node_equations')
    nodes(6) = 15
    equations(6) = 2
    CHECK_REFUSED(make(body, rigid, count), STICKSLIP_INVALID_VALUE, '2 is that of two unknowns')
    CHECK(count == UNWRITTEN_INTEGER)
    motion(1)%rotation(2) = 3.2d0
    CHECK_REFUSED(stickslip_rigid_positions(body(1), motion(1), now), STICKSLIP_INVALID_VALUE, 'at most pi')
    motion(1)%rotation = 0
    motion(1)%turned([1, 5, 9]) = 1.1d0
    CHECK_REFUSED(stickslip_rigid_turn(motion(1)), STICKSLIP_INVALID_VALUE, 'no rotation')
    CHECK_UNTOUCHED(reshape(now, [6]))
  end subroutine
end program
