! Random calls with numbers from everywhere in the range of doubles, null and crooked pointers, and corrupt histories:
! whatever comes, the answer is success or a refusal that has written nothing; never a fault of the library. And whatever
! came before, the answer has the bits that a fresh handle gives which has taken nothing but the calls that define its
! state. The twin gives bad pointers where Fortran has pointers, that is, not for arrays and types.
#include "check.inc"
program t52_random_calls
  use, intrinsic :: iso_c_binding
  use, intrinsic :: ieee_arithmetic
  use calls
  use check
  use pairs
  use scenes
  use stickslip
  implicit none
  real(c_double), parameter :: SPECIAL(30) = [0d0, -0d0, 1d0, -1d0, 5d-324, -5d-324, 1d-310, 2.2d-308, 1d-160, 1d-80, &
      1d-16, 1d16, 1d75, 1d80, 1d150, 1d155, 1d300, 1.7d308, -1d155, -1.7d308, 1d-300, 1d-150, 1d-100, 1d100, -1d100, &
      1d-12, 0.5d0, 2d0, 3d0, 1d8]

  ! A call that defines a handle's state, with its numbers.
  type change
    integer :: what
    logical :: given
    integer(c_int64_t) :: n, nodes(2)
    real(c_double) :: values(3, NA), x1(3, NA), x2(3, NC), lambda(3, NA)
    type(history) :: imported
  end type
  integer, parameter :: CALLS_OF_SEQUENCE = 8
  integer(c_int64_t) :: seed = 2024
  integer :: successes = 0, refusals = 0, n, k
  character(20) :: argument

  ! More with a number on the command line.
  n = 20000
  call get_command_argument(1, argument)
  if (argument /= '') read (argument, *) n
  do k = 0, n - 1
    call stateless(k == 0)
    if (mod(k, 40) == 0) call sequence(mod(k, 160) == 0)
  end do
  CHECK(successes > n / 20 .and. refusals > n / 20)

contains

  ! A number from 0 to below - 1.
  integer function random(below)
    integer, intent(in) :: below
    random = min(int((draw(seed) + 1) / 2 * below), below - 1)
  end function

  ! True once in so many times.
  logical function once_in(times)
    integer, intent(in) :: times
    once_in = random(times) == 0
  end function

  ! a b, without the traps that the product of such numbers would set off.
  elemental real(c_double) function product_of(a, b) result(x)
    real(c_double), intent(in) :: a, b
    logical :: infinite
    if (ieee_is_nan(a) .or. ieee_is_nan(b)) then
      x = ieee_value(x, ieee_quiet_nan)
      return
    end if
    infinite = .not. (ieee_is_finite(a) .and. ieee_is_finite(b))
    if (infinite .and. (a == 0 .or. b == 0)) then
      x = ieee_value(x, ieee_quiet_nan)
      return
    end if
    if (.not. infinite .and. abs(a) > 1) infinite = abs(b) > huge(b) / abs(a)
    if (infinite) then
      x = ieee_value(x, ieee_positive_inf)
      if (sign(1d0, a) * sign(1d0, b) < 0) x = -x
    else
      x = a * b
    end if
  end function

  real(c_double) function any_number(usual) result(x)
    real(c_double), intent(in) :: usual
    select case (random(40))
    case (0)
      x = ieee_value(x, ieee_quiet_nan)
    case (1)
      x = ieee_value(x, ieee_positive_inf)
      if (once_in(2)) x = -x
    case (2)
      x = product_of(usual, 1 + 1d-15 * draw(seed))
    case (3)
      x = product_of(usual, SPECIAL(1 + random(size(SPECIAL))))
    case (4)
      x = draw(seed)
    case default
      x = SPECIAL(1 + random(size(SPECIAL)))
    end select
  end function

  ! Spoils a few of the n entries; now and then all.
  subroutine spoil(n, entries)
    integer, intent(in) :: n
    real(c_double), intent(inout) :: entries(n)
    integer :: k, i
    if (once_in(30)) entries = product_of(entries, any_number(1d0))
    do k = 1, random(3)
      i = 1 + random(n)
      entries(i) = any_number(entries(i))
    end do
  end subroutine

  integer(c_int64_t) function any_integer(usual) result(i)
    integer(c_int64_t), intent(in) :: usual
    integer(c_int64_t) :: others(14)
    i = usual
    if (.not. once_in(12)) return
    others = [INT64_MIN, INT64_MAX, -1_c_int64_t, 0_c_int64_t, 1_c_int64_t, 2_c_int64_t, 3_c_int64_t, 4_c_int64_t, &
              5_c_int64_t, 35_c_int64_t, 36_c_int64_t, 37_c_int64_t, 100_c_int64_t, 2_c_int64_t**41]
    i = others(1 + random(14))
  end function

  ! The same, and its low bits where that does not fit.
  integer(c_int32_t) function any_short(usual)
    integer, intent(in) :: usual
    integer(c_int64_t) :: i
    i = any_integer(int(usual, c_int64_t))
    any_short = transfer(i, any_short)
  end function

  type(c_ptr) function any_pointer(usual) result(p)
    type(c_ptr), intent(in) :: usual
    p = usual
    select case (random(40))
    case (0)
      p = c_null_ptr
    case (1)
      if (c_associated(usual)) p = crooked(usual)
    end select
  end function

  ! The array's address or another one, or null where there is nothing to give.
  type(c_ptr) function given(present, usual)
    logical, intent(in) :: present
    type(c_ptr), intent(in) :: usual
    given = c_null_ptr
    if (present) given = any_pointer(usual)
  end function

  ! Success or a refusal with a message, never the library's fault.
  logical function succeeded(status)
    integer(c_int32_t), intent(in) :: status
    CHECK(status >= STICKSLIP_OK .and. status <= STICKSLIP_CONTACT_LOST)
    CHECK(status == STICKSLIP_OK .eqv. last_message() == '')
    succeeded = status == STICKSLIP_OK
    if (succeeded) then
      successes = successes + 1
    else
      refusals = refusals + 1
    end if
  end function

  subroutine stateless(first)
    logical, intent(in) :: first
    type(element), target, save :: good, e
    integer(c_int32_t) :: status
    if (first) call element_init(good)
    e = good
    if (once_in(2)) then
      call spoil(12, e%x1)
      call spoil(12, e%x2)
    end if
    if (once_in(4)) e%x2 = e%x1
    call spoil(16, e%w%ab)
    call spoil(16 * 24, e%w%dac)
    call spoil(12, e%traction)
    call spoil(4, e%row_scale)
    call spoil(3, e%sum)
    call spoil(3, e%node%lambda)
    if (once_in(4)) call spoil(3, e%node%normal)
    call spoil_scalar(e%node%augmentation)
    call spoil_scalar(e%node%mu)
    call spoil_scalar(e%node%coverage)
    call spoil_scalar(e%node%coverage_previous)
    call spoil(3, e%node%gap_now)
    call spoil(3, e%node%gap_previous)
    call spoil(3, e%node%gap_committed)
    call spoil(9, e%responses(1 + random(3))%drow_dnow)
    call spoil(9, e%responses(1 + random(3))%drow_dprevious)
    e%pair%n1 = any_short(3 + random(2))
    e%pair%n2 = any_short(3 + random(2))
    e%pair%quadrature = any_short(random(2))
    e%pair%layout = any_short(random(2))
    e%node%slip = any_short(random(3))
    e%node%n_directions = any_short(random(2))
    if (once_in(2)) e%node%directions(1, 1) = 1
    if (once_in(4)) call spoil(6, e%node%directions)
    e%pair%x1 = any_pointer(c_loc(e%x1))
    e%pair%x2 = any_pointer(c_loc(e%x2))
    call spoil(16, e%mass)
    e%facet%n1 = e%pair%n1
    e%facet%quadrature = e%pair%quadrature
    e%facet%layout = e%pair%layout
    e%facet%n_pairs = merge(-int(random(2), c_int64_t), 1_c_int64_t, once_in(8))
    e%n2 = e%pair%n2
    e%facet%x1 = e%pair%x1
    e%facet%n2 = any_pointer(c_loc(e%n2))
    e%facet%x2 = e%pair%x2
    call one_call(e, status)
    if (.not. succeeded(status)) call element_untouched(e)
  end subroutine

  subroutine spoil_scalar(entry)
    real(c_double), intent(inout) :: entry
    if (once_in(6)) entry = any_number(entry)
  end subroutine

  subroutine one_call(e, status)
    type(element), target, intent(inout) :: e
    integer(c_int32_t), intent(out) :: status
    logical :: now, moving, before
    integer(c_int64_t) :: size_of, ld
    select case (random(16))
    case (0)
      status = stickslip_pair_weights(e%pair, any_pointer(c_loc(e%w_out%ab)), any_pointer(c_loc(e%w_out%ac)), &
          any_pointer(c_loc(e%w_out%dab)), any_pointer(c_loc(e%w_out%dac)))
    case (1)
      status = stickslip_pair_gap(e%pair, e%w%ab, e%w%ac, e%gap)
    case (2)
      status = stickslip_pair_residual(e%pair, e%w%ab, e%w%ac, e%traction, e%force)
    case (3)
      now = .not. once_in(4)
      moving = .not. once_in(4)
      before = .not. once_in(4)
      ! The leading dimension is as large as the buffer allows, or wrong.
      size_of = 6_c_int64_t * e%pair%n1 + 3_c_int64_t * e%pair%n2
      ld = 36
      if (once_in(8)) ld = random(int(merge(size_of, 36_c_int64_t, 0 < size_of .and. size_of < 36)))
      status = stickslip_pair_tangent(e%pair, given(now, c_loc(e%w%ab)), given(now, c_loc(e%w%ac)), &
          given(moving, c_loc(e%w%dab)), given(moving, c_loc(e%w%dac)), given(before, c_loc(e%w%ab)), &
          given(before, c_loc(e%w%ac)), e%traction, e%responses, any_pointer(c_loc(e%row_scale)), e%k, ld)
    case (4)
      status = call_respond(e)
      if (status /= STICKSLIP_OK) call response_untouched(e%responses(4))
    case (5)
      call spoil(3, e%responses(1)%row)
      status = stickslip_node_block(e%responses(1), any_number(1d0), random(3), any_pointer(c_loc(e%row)), &
          any_pointer(c_loc(e%block)))
    case (6)
      status = stickslip_facet_geometry(any_short(4), e%x1, any_pointer(c_loc(e%normals)), any_pointer(c_loc(e%areas)))
    case (7)
      status = stickslip_facet_dual(any_short(4), e%x1, e%mass, any_pointer(c_loc(e%fade)), any_pointer(c_loc(e%dual_areas)), &
          any_pointer(c_loc(e%coefficients)))
    case (8)
      status = stickslip_pair_dual(e%pair, e%mass, e%w%ab, e%w%ac, any_pointer(c_loc(e%dual_ab)), &
          any_pointer(c_loc(e%dual_ac)))
    case (9)
      before = .not. once_in(4)
      status = stickslip_facet_tangent(e%facet, e%w%ab, e%w%ac, given(before, c_loc(e%w%ab)), given(before, c_loc(e%w%ac)), &
          e%traction, e%responses, any_pointer(c_loc(e%row_scale)), e%facet_k, 36_c_int64_t)
    case (10)
      status = stickslip_facet_normal_derivatives(any_short(4), e%x1, e%normal_derivatives)
    case (11)
      ! Mostly with a sum that fits: only one that does is looked into.
      if (.not. once_in(4)) e%sum = product_of(e%node%normal, -2d0)
      status = stickslip_node_turn(e%node, e%sum, random(3), any_pointer(c_loc(e%turn(1, 1))), &
          any_pointer(c_loc(e%turn(1, 2))), any_pointer(c_loc(e%turn(1, 3))))
    case (12)
      status = stickslip_pair_begin(e%pair, merge(int(random(200), c_int64_t), size(e%state_out, kind=c_int64_t), once_in(8)), &
          e%state_out, any_pointer(c_loc(e%w_out%ab)), any_pointer(c_loc(e%w_out%ac)), any_pointer(c_loc(e%gap)))
    case (13)
      before = .not. once_in(4)
      status = stickslip_pair_state_gap(e%state, given(before, c_loc(e%w%ab)), given(before, c_loc(e%w%ac)), e%gap)
    case (14)
      if (once_in(2)) then
        status = stickslip_pair_state_residual(e%state, e%traction, e%force)
      else
        before = .not. once_in(4)
        status = stickslip_pair_state_tangent(e%state, given(before, c_loc(e%w%ab)), given(before, c_loc(e%w%ac)), &
            e%traction, e%responses, any_pointer(c_loc(e%row_scale)), e%k, 36_c_int64_t)
      end if
    case default
      status = stickslip_node_normal(e%sum, e%normal)
    end select
  end subroutine

  ! Any sequence of calls on one handle, `compared` with fresh ones.
  subroutine sequence(compared)
    logical, intent(in) :: compared
    type(handle), target, save :: h
    type(scene), target, save :: usual
    type(change), target, save :: changes(CALLS_OF_SEQUENCE)
    integer(c_int32_t) :: status
    integer(c_int64_t) :: lengths(2)
    integer :: calls, n
    logical :: accepted, changed, again
    call scene_init(h%s)
    h%s%method%form = random(2)
    h%s%method%weights = random(4)
    h%s%method%slip = random(3)
    h%s%method%new_contact = random(2)
    h%s%method%quadrature = random(2)
    h%s%options%friction = random(int(STICKSLIP_FRICTION_TRESCA) + 1)
    h%s%method%no_shortcuts = random(16)
    h%s%method%weak_coverage = 0.5d0 * random(3)
    h%s%method%multiplier_basis = random(3)
    if (h%s%method%weights <= STICKSLIP_WEIGHTS_CURRENT) h%s%method%normals = random(3)
    if (all(h%s%options%friction /= [STICKSLIP_FRICTION_COULOMB, STICKSLIP_FRICTION_TRESCA])) h%s%options%mu = 0
    if (h%s%options%friction == STICKSLIP_FRICTION_TRESCA) h%s%options%shear_limit = 0.5d0
    if (once_in(2)) then
      call spoil_scalar(h%s%options%mu)
      call spoil_scalar(h%s%method%augmentation)
      call spoil_scalar(h%s%options%modulus)
      call spoil_scalar(h%s%method%coverage_min)
      call spoil_scalar(h%s%options%search_distance)
    end if
    if (once_in(4)) call spoil(SIZE1, h%s%reference1)
    if (once_in(4)) call spoil(SIZE2, h%s%reference2)
    if (.not. succeeded(stickslip_interface_create(h%s%nonmortar, h%s%mortar, h%s%options, h%s%contact))) then
      CHECK(address_of(h%s%contact) == 0)
      return
    end if
    call handle_prepare(h)
    call scene_init(usual)
    n = 0
    do calls = 1, CALLS_OF_SEQUENCE
      ! Now and then where the last call was, whose findings might be taken for its own.
      again = once_in(2)
      if (calls == 1 .or. again) then
        h%s%x1 = usual%x1
        h%s%x2 = usual%x2
        h%s%lambda = usual%lambda
        if (once_in(2)) call scene_slide(h%s, draw(seed))
        if (once_in(3)) call lift(h%s)
        if (once_in(3)) call spoil(SIZE1, h%s%x1)
        if (once_in(3)) call spoil(SIZE2, h%s%x2)
        if (once_in(2)) call spoil(SIZE1, h%s%lambda)
      end if
      call handle_fill(h)
      if (once_in(2)) call spoil(SIZE1, h%host1)
      ! Weights of t_n that were left out while the surfaces were apart may be refused when they are asked for.
      if (.not. succeeded(stickslip_interface_history_size(h%s%contact, lengths(1), lengths(2)))) exit
      call history_take(h%s%contact, h%before)
      call any_change(h, changes(n + 1))
      changed = changes(n + 1)%what < 8
      if (changed) then
        status = apply(h%s%contact, changes(n + 1))
      else
        status = look(changes(n + 1)%what, h)
      end if
      accepted = succeeded(status)
      if (compared .and. .not. changed) call check_fresh(h, changes(:n), changes(n + 1)%what, status)
      ! The values of a tangent that has overflowed mean nothing.
      if (status == STICKSLIP_NOT_FINITE .and. changes(n + 1)%what == 10) h%values = UNWRITTEN
      if (.not. accepted) call handle_untouched(h)
      if (accepted .and. changed) n = n + 1
    end do
    call scene_destroy(h%s)
  end subroutine

  ! Out of reach.
  subroutine lift(s)
    type(scene), intent(inout) :: s
    real(c_double) :: up(3)
    up = [0d0, 0d0, 4d0]
    call scene_frame(up)
    s%x1 = s%x1 + spread(up, 2, NA)
  end subroutine

  ! A change (-1 to 7), or a look (8 to 26), with its numbers.
  subroutine any_change(h, c)
    type(handle), intent(in) :: h
    type(change), intent(out) :: c
    integer :: k, i
    c%what = random(28) - 1
    c%given = .not. once_in(3)
    c%values = 1
    if (c%what == 2) c%values = spread([0d0, 0d0, merge(-1d0, 1d0, once_in(2))], 2, NA)
    call spoil(NA, c%values)
    c%n = random(3)
    c%nodes = [any_integer(5_c_int64_t), any_integer(5_c_int64_t)]
    c%x1 = h%s%x1
    c%x2 = h%s%x2
    c%lambda = h%s%lambda
    c%imported = h%before
    if (c%what /= 5) return
    do k = 1, random(4) - 2
      i = 1 + random(int(h%before%n_integers))
      c%imported%integers(i) = any_integer(c%imported%integers(i))
    end do
    if (once_in(2)) call spoil(int(h%before%n_reals), c%imported%reals)
    c%n = mod(any_integer(h%before%n_integers), size(c%imported%integers, kind=c_int64_t))
  end subroutine

  integer(c_int32_t) function apply(contact, c) result(status)
    type(stickslip_interface), intent(in) :: contact
    type(change), target, intent(in) :: c
    type(c_ptr) :: values
    values = c_null_ptr
    if (c%given) values = c_loc(c%values)
    select case (c%what)
    case (-1)
      status = stickslip_interface_use_normals(contact, int(c%n, c_int32_t))
    case (0)
      status = stickslip_interface_set_friction(contact, c%values)
    case (1)
      status = stickslip_interface_set_augmentation(contact, values)
    case (2)
      status = stickslip_interface_set_normals(contact, values)
    case (3)
      status = stickslip_interface_set_constraints(contact, c%n, c%nodes, c%values)
    case (4)
      status = stickslip_interface_rollback(contact)
    case (5)
      status = stickslip_interface_history_import(contact, c%n, c%imported%integers, c%imported%n_reals, c%imported%reals)
    case (6)
      status = stickslip_interface_commit(contact, c%x1, c%x2, c%lambda, c_null_ptr)
    case default
      status = stickslip_interface_set_previous(contact, c%x1, c%x2)
    end select
  end function

  ! Calls that leave no trace.
  integer(c_int32_t) function look(what, h) result(status)
    integer, intent(in) :: what
    type(handle), target, intent(inout) :: h
    type(stickslip_report) :: report
    select case (what)
    case (8)
      status = call_interface_residual(h)
    case (9)
      status = call_interface_states(h)
    case (10)
      status = call_interface_coo(h)
    case (11)
      status = call_interface_csr(h)
    case (12)
      status = call_interface_sums(h)
    case (13)
      status = call_interface_pattern(h)
    case (14)
      status = stickslip_interface_initial_multipliers(h%s%contact, h%rows)
    case (15)
      status = call_carriers(h)
    case (16)
      status = call_condensed_multipliers(h)
    case (17)
      status = call_condensed_residual(h)
    case (18, 19, 20)
      status = call_condensed_coo(h, int(what - 18, c_int32_t))
    case (21)
      status = call_condensed_csr(h)
    case (22)
      status = call_condensed_pattern(h)
    case (24)
      status = call_turn_multipliers(h)
    case (25)
      status = look_plan(h)
    case (26)
      status = look_condensed_plan(h)
    case default
      report = stickslip_report(cover=c_loc(h%state), fraction=c_loc(h%rows))
      status = stickslip_interface_report(h%s%contact, h%s%x1, h%s%x2, report)
    end select
  end function

  ! By plans. Values go out on success alone: after a refusal they mean nothing.
  integer(c_int32_t) function look_plan(h) result(status)
    type(handle), target, intent(inout) :: h
    integer(c_int64_t) :: rows, count
    real(c_double), save :: values(UNKNOWNS**2)
    status = stickslip_interface_plan(h%s%contact, h%s%x1, h%s%x2, STICKSLIP_PLAN_ACTIVE, rows, count)
    if (status /= STICKSLIP_OK) return
    CHECK(count <= size(values))
    status = stickslip_interface_plan_values(h%s%contact, h%s%x1, h%s%x2, h%s%lambda, c_null_ptr, count, values)
    if (status /= STICKSLIP_OK) return
    h%count = count
    h%values(:count) = values(:count)
    status = stickslip_interface_plan_coo(h%s%contact, STICKSLIP_ENTRIES_TANGENT, count, h%row_numbers, h%columns)
  end function

  integer(c_int32_t) function look_condensed_plan(h) result(status)
    type(handle), target, intent(inout) :: h
    integer(c_int64_t) :: rows(2), counts(2)
    real(c_double), save :: forces(UNKNOWNS**2), constraints(UNKNOWNS**2)
    status = stickslip_interface_condensed_plan(h%s%contact, h%s%x1, h%s%x2, STICKSLIP_PLAN_SKIN, rows, counts)
    if (status /= STICKSLIP_OK) return
    CHECK(all(counts <= size(forces)))
    status = stickslip_interface_condensed_values(h%s%contact, h%s%x1, h%s%x2, h%s%lambda, forces, constraints)
    if (status /= STICKSLIP_OK) return
    h%count = counts(2)
    h%csr(:counts(1)) = forces(:counts(1))
    h%values(:counts(2)) = constraints(:counts(2))
    status = stickslip_interface_plan_coo(h%s%contact, STICKSLIP_ENTRIES_CONSTRAINTS, counts(2), h%row_numbers, h%columns)
  end function

  ! What a call has given is what a fresh handle gives.
  subroutine check_fresh(h, changes, what, status)
    type(handle), target, intent(in) :: h
    type(change), intent(in) :: changes(:)
    integer, intent(in) :: what
    integer(c_int32_t), intent(in) :: status
    type(handle), target, save :: fresh
    integer :: k
    fresh%s = h%s ! whose arrays the surfaces point to
    call handle_prepare(fresh)
    fresh%host1 = h%host1
    CHECK_OK(stickslip_interface_create(h%s%nonmortar, h%s%mortar, h%s%options, fresh%s%contact))
    do k = 1, size(changes)
      CHECK_OK(apply(fresh%s%contact, changes(k)))
    end do
    CHECK(look(what, fresh) == status)
    CHECK(all(same(h%force1, fresh%force1)) .and. all(same(h%force2, fresh%force2)) .and. all(same(h%rows, fresh%rows)))
    CHECK(all(same(h%sums, fresh%sums)) .and. all(same(h%values, fresh%values)) .and. all(same(h%csr, fresh%csr)))
    CHECK(all(h%row_numbers == fresh%row_numbers) .and. all(h%columns == fresh%columns) .and. h%count == fresh%count)
    CHECK(all(h%state == fresh%state) .and. all(same(h%normal, fresh%normal)))
    call scene_destroy(fresh%s)
  end subroutine
end program
