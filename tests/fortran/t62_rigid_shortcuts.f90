! A mortar side without equations, and what the library leaves out by itself: not a bit of the residual changes. Misuse
! is refused; the interface says in sentences what it computes and why. The twin leaves out NULL for the text.
#include "check.inc"
program t62_rigid_shortcuts
  use, intrinsic :: iso_c_binding
  use check
  use scenes
  use stickslip
  implicit none
  integer(c_int32_t), parameter :: EVERY = STICKSLIP_SHORTCUT_FRICTIONLESS + STICKSLIP_SHORTCUT_RIGID + &
                                           STICKSLIP_SHORTCUT_APART + STICKSLIP_SHORTCUT_UNCOVERED
  ! Entries of tangents that are computed in two ways, relative to the largest of a block, or to this one's size.
  real(c_double), parameter :: ROUNDING = 1d-12, LEAST = 1d-3
  type(scene), target, save :: s, full
  real(c_double) :: r(UNKNOWNS), q(UNKNOWNS)
  integer :: k

  do k = 0, 1
    call check_rigid(asked=k == 1)
  end do
  call check_frictionless()
  call check_apart()
  call check_uncovered()
  call check_layers()
  call check_misuse()
  call check_sentences()

contains

  logical function says(s, words)
    type(scene), intent(in) :: s
    character(*), intent(in) :: words
    character(1000) :: text
    integer(c_int32_t) :: status
    integer :: ending
    text = ''
    status = stickslip_interface_effects(s%contact, text, len(text, c_int64_t))
    CHECK_OK(status)
    ending = index(text, c_null_char)
    CHECK(ending > 1)
    says = index(text(:ending), words) > 0
  end function

  type(stickslip_counters) function counters_of(s)
    type(scene), intent(in) :: s
    CHECK_OK(stickslip_interface_counters(s%contact, counters_of))
    ! Each node was treated in one way.
    CHECK(treated(counters_of) == NA)
  end function

  integer(c_int64_t) function treated(c)
    type(stickslip_counters), intent(in) :: c
    treated = c%nodes_frictional + c%nodes_frictionless + c%nodes_new + c%nodes_tied + c%nodes_uncovered + &
              c%nodes_left_out
  end function

  subroutine compare_residuals()
    call scene_residual(s, r)
    call scene_residual(full, q)
    CHECK(all(same(r, q)))
  end subroutine

  subroutine create_both()
    call scene_create(s)
    call scene_create(full)
  end subroutine

  subroutine destroy_both()
    call scene_destroy(s)
    call scene_destroy(full)
  end subroutine

  ! Rigid, asked for or chosen, against a deformable side without equations.
  subroutine check_rigid(asked)
    logical, intent(in) :: asked
    type(triplets), target, save :: t
    real(c_double), save :: a(UNKNOWNS, UNKNOWNS), b(UNKNOWNS, UNKNOWNS)
    call scene_init(s)
    call scene_init(full)
    s%equations2 = -1
    full%equations2 = -1
    s%options%mortar_side = merge(STICKSLIP_MORTAR_RIGID, STICKSLIP_MORTAR_DEFORMABLE, asked)
    full%method%no_shortcuts = EVERY
    call create_both()
    call compare_residuals()
    call scene_dense(s, t, a)
    call scene_dense(full, t, b)
    CHECK(block_difference(a, b, LEAST) <= ROUNDING)
    if (asked) then
      CHECK(says(s, 'rigid (asked for)'))
    else
      CHECK(says(s, 'rigid (chosen: no mortar node has an equation)'))
    end if
    CHECK(says(full, 'as deformable'))
    call destroy_both()
  end subroutine

  ! mu = 0 at every node: no slip is computed, until there is friction.
  subroutine check_frictionless()
    real(c_double) :: mu(NA)
    type(stickslip_counters) :: cheap, dear
    call scene_init(s)
    call scene_init(full)
    s%options%mu = 0
    full%options%mu = 0
    full%method%no_shortcuts = EVERY
    call create_both()
    CHECK(says(s, 'chosen: mu is 0 at every node'))
    CHECK(says(full, 'law with mu 0'))
    call compare_residuals()
    cheap = counters_of(s)
    dear = counters_of(full)
    CHECK(cheap%nodes_slipping == 0 .and. dear%nodes_slipping == NA)
    call scene_commit(s)
    call scene_commit(full)
    mu = 0
    mu(5) = 0.4d0
    CHECK_OK(stickslip_interface_set_friction(s%contact, mu))
    CHECK_OK(stickslip_interface_set_friction(full%contact, mu))
    CHECK(says(s, 'mu from 0 to 0.4'))
    call scene_slide(s, 0.05d0)
    call scene_slide(full, 0.05d0)
    call compare_residuals()
    cheap = counters_of(s)
    CHECK(cheap%nodes_slipping == NA)
    call destroy_both()
  end subroutine

  ! Far apart: a comparison. The history is made up for when it is asked for.
  subroutine check_apart()
    type(history), save :: made_up, searched
    type(stickslip_counters) :: cheap, dear
    real(c_double) :: up(3)
    up = [0d0, 0d0, 30d0]
    call scene_frame(up)
    call scene_init(s)
    call scene_init(full)
    full%method%no_shortcuts = STICKSLIP_SHORTCUT_APART
    call lift(s, up)
    call lift(full, up)
    call create_both()
    call scene_residual(s, r)
    call scene_residual(full, q)
    CHECK(all(r == q))
    call scene_commit(s)
    call scene_commit(full)
    cheap = counters_of(s)
    dear = counters_of(full)
    CHECK(cheap%pairs_tested == 0 .and. cheap%searches == 0)
    CHECK(cheap%evaluations_apart == 1 .and. cheap%commits_apart == 2)
    CHECK(dear%pairs_tested > 0 .and. dear%searches > 0)
    CHECK(dear%evaluations_apart == 0 .and. dear%commits_apart == 0)
    CHECK(cheap%nodes_left_out == NA .and. cheap%nodes_evaluated == 0)
    CHECK(dear%nodes_left_out == 0 .and. dear%nodes_evaluated == NA .and. dear%nodes_frictional == NA)
    call history_take(s%contact, made_up)
    call history_take(full%contact, searched)
    CHECK(history_equal(made_up, searched))
    call touch(s, up)
    call touch(full, up)
    call compare_residuals()
    call destroy_both()
  end subroutine

  ! A mortar side that looks away covers no node before the next commit: no law is asked about any.
  subroutine check_uncovered()
    type(triplets), target, save :: t, u
    real(c_double), save :: a(UNKNOWNS, UNKNOWNS), b(UNKNOWNS, UNKNOWNS)
    type(stickslip_counters) :: cheap, dear
    call scene_init(s)
    call scene_init(full)
    full%method%no_shortcuts = STICKSLIP_SHORTCUT_UNCOVERED
    call turn_over(s)
    call turn_over(full)
    call create_both()
    call compare_residuals()
    call scene_dense(s, t, a)
    call scene_dense(full, u, b)
    CHECK(all(same(a, b)))
    ! The diagonal; the blocks, which have no more in them.
    CHECK(t%n == 3 * NA .and. u%n == 9 * NA)
    cheap = counters_of(s)
    dear = counters_of(full)
    CHECK(cheap%nodes_left_out == NA .and. cheap%nodes_evaluated == 0)
    CHECK(dear%nodes_uncovered == NA .and. dear%nodes_evaluated == NA)
    call destroy_both()
  end subroutine

  ! Quadrilaterals the other way round.
  subroutine turn_over(s)
    type(scene), intent(inout) :: s
    s%nodes2 = s%nodes2([1, 4, 3, 2], :)
  end subroutine

  subroutine lift(s, up)
    type(scene), intent(inout) :: s
    real(c_double), intent(in) :: up(3)
    s%reference1 = s%reference1 + spread(up, 2, NA)
    s%x1 = s%x1 + spread(up, 2, NA)
    s%lambda = 0
  end subroutine

  subroutine touch(s, up)
    type(scene), intent(inout) :: s
    real(c_double), intent(in) :: up(3)
    s%x1 = s%x1 - spread(up, 2, NA)
    s%lambda = spread([0.1d0, 0.1d0, -0.5d0], 2, NA)
  end subroutine

  ! Two mortar facets on each other, 50 away: found when it comes near, or when the history of t_n is asked for.
  subroutine check_layers()
    real(c_double), target :: upper(3, 4), lower(3, 8), near(3, 4)
    real(c_double) :: zero(3, 4), sums(STICKSLIP_SUMS_PER_NODE, 4), force1(3, 4), force2(3, 8), rows(3, 4)
    integer(c_int64_t), target :: offsets(3), quads(8), none(3, 8)
    integer(c_int32_t), target :: states(4)
    integer(c_int32_t) :: status
    integer(c_int64_t) :: integers, reals
    integer :: again, i
    type(stickslip_surface) :: one, two
    type(stickslip_interface) :: layers
    type(stickslip_states) :: out
    upper = reshape([0, 0, 50, 0, 1, 50, 1, 1, 50, 1, 0, 50], [3, 4])
    lower = reshape([-1, -1, -1, 2, -1, -1, 2, 2, -1, -1, 2, -1, -1, -1, -1, 2, -1, -1, 2, 2, -1, -1, 2, -1], [3, 8])
    lower(3, :) = lower(3, :) / 10
    near = upper
    near(3, :) = 0
    offsets = [0, 4, 8]
    quads = [(i, i = 1, 8)]
    none = -1
    zero = 0
    call scene_init(s)
    one = s%nonmortar
    one%n_nodes = 4
    one%n_facets = 1
    one%coordinates = c_loc(upper)
    one%facet_offsets = c_loc(offsets)
    one%facet_nodes = c_loc(quads)
    two = s%mortar
    two%n_nodes = 8
    two%n_facets = 2
    two%coordinates = c_loc(lower)
    two%facet_offsets = c_loc(offsets)
    two%facet_nodes = c_loc(quads)
    two%equations = c_loc(none)
    CHECK_OK(stickslip_interface_create(one, two, s%options, layers))
    states = UNWRITTEN_STATE
    sums = UNWRITTEN
    force1 = UNWRITTEN
    force2 = UNWRITTEN
    rows = UNWRITTEN
    out%state = c_loc(states)
    do again = 1, 2
      status = stickslip_interface_residual(layers, near, lower, zero, c_null_ptr, force1, force2, rows)
      CHECK_REFUSED(status, STICKSLIP_INVALID_VALUE, 'lie on each other')
      status = stickslip_interface_states(layers, near, lower, zero, c_null_ptr, out)
      CHECK_REFUSED(status, STICKSLIP_INVALID_VALUE, 'lie on each other')
      CHECK_REFUSED(stickslip_interface_sums(layers, near, lower, sums), STICKSLIP_INVALID_VALUE, 'lie on each other')
      CHECK_REFUSED(stickslip_interface_history_size(layers, integers, reals), STICKSLIP_INVALID_VALUE, 'lie on each other')
    end do
    CHECK_UNTOUCHED(force1)
    CHECK_UNTOUCHED(force2)
    CHECK_UNTOUCHED(rows)
    CHECK_UNTOUCHED(sums)
    CHECK_UNTOUCHED(states)
    CHECK_OK(stickslip_interface_destroy(layers))
  end subroutine

  ! A rigid side has no equation; a shortcut has a name.
  subroutine check_misuse()
    integer(c_int32_t), parameter :: UNKNOWN(4) = [16, -1, INT32_MIN, INT32_MAX]
    integer(c_int32_t) :: status
    integer :: n
    call scene_init(s)
    s%options%mortar_side = STICKSLIP_MORTAR_RIGID
    status = stickslip_interface_create(s%nonmortar, s%mortar, s%options, s%contact)
    CHECK_REFUSED(status, STICKSLIP_INVALID_VALUE, 'mortar')
    s%options%mortar_side = STICKSLIP_MORTAR_DEFORMABLE
    do n = 1, size(UNKNOWN)
      s%method%no_shortcuts = UNKNOWN(n)
      status = stickslip_interface_create(s%nonmortar, s%mortar, s%options, s%contact)
      CHECK_REFUSED(status, STICKSLIP_INVALID_VALUE, 'no_shortcuts')
    end do
    CHECK(address_of(s%contact) == 0)
  end subroutine

  ! Cut where they are longer, always ended; refused without room for the end.
  subroutine check_sentences()
    character(1000) :: text
    character(20) :: cut
    integer(c_int32_t) :: status
    s%method%no_shortcuts = 0
    call scene_create(s)
    text = ''
    status = stickslip_interface_effects(s%contact, text, len(text, c_int64_t))
    CHECK_OK(status)
    CHECK(index(text, 'Friction: ') == 1 .and. index(text, '.' // c_null_char) > 0)
    cut = repeat('x', 20)
    CHECK_OK(stickslip_interface_effects(s%contact, cut, 11_c_int64_t))
    CHECK(cut == 'Friction: ' // c_null_char // repeat('x', 9))
    CHECK_OK(stickslip_interface_effects(s%contact, cut, 1_c_int64_t))
    CHECK(cut == c_null_char // 'riction: ' // c_null_char // repeat('x', 9))
    cut = repeat('x', 20)
    CHECK_REFUSED(stickslip_interface_effects(s%contact, cut, 0_c_int64_t), STICKSLIP_INVALID_SIZE, 'capacity')
    CHECK_REFUSED(stickslip_interface_effects(s%contact, cut, -1_c_int64_t), STICKSLIP_INVALID_SIZE, 'capacity')
    CHECK_REFUSED(stickslip_interface_effects(no_handle(), cut, 20_c_int64_t), STICKSLIP_NULL_POINTER, 'interface')
    CHECK(cut == repeat('x', 20))
    call scene_destroy(s)
  end subroutine
end program
