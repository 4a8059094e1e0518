! Every function as the rows of tests/capi/bad_input.txt call it, and what is good for it: for t40_bad_input.f90.
#include "check.inc"
module bad_input
  use, intrinsic :: iso_c_binding
  use calls
  use check
  use pairs
  use scenes
  use stickslip
  implicit none
  public

  ! Types of places, and what a program does, as in tests/capi/bad_rows.h.
  integer(c_int), parameter :: NEEDED = 0, OPTIONAL_ = 1, REAL_ = 3, INT64 = 4, INT32 = 5
  type, bind(C) :: bad_host
    type(c_funptr) :: call, set_up, compare, tear_down
  end type

  interface
    subroutine bad_place(name, type, at, n) bind(C)
      import :: c_char, c_int, c_int32_t, c_ptr
      character(kind=c_char), intent(in) :: name(*)
      integer(c_int), value :: type
      type(c_ptr), value :: at
      integer(c_int32_t), value :: n
    end subroutine
    subroutine bad_struct(kind, name, at) bind(C)
      import :: c_char, c_ptr
      character(kind=c_char), intent(in) :: kind(*), name(*)
      type(c_ptr), value :: at
    end subroutine
    subroutine bad_rows(who, base, host) bind(C)
      import :: bad_host, c_char, c_int32_t
      character(kind=c_char), intent(in) :: who(*)
      integer(c_int32_t), value :: base
      type(bad_host), intent(in) :: host
    end subroutine
  end interface

  ! Outputs that `element` and `handle` do not have.
  type, bind(C) :: outputs
    type(stickslip_options) :: options
    type(stickslip_counters) :: counters
    type(stickslip_report) :: report
    type(stickslip_diagnosis) :: diagnosis
    type(stickslip_equilibrium) :: equilibrium
    type(stickslip_node_response) :: answer
    integer(c_int64_t) :: split_nodes(16), originals(2 * NA), shared_nodes(8), claims(8), count, n_integers, n_reals
    integer(c_int64_t) :: integers(256), facets(NA), suspect_nodes(8)
    real(c_double) :: reals(4096), initial(SIZE1), fractions(NA), suspect_directions(24), suspect_ratios(8), facet_normal(3)
    real(c_double) :: gap, traction, slip, condensed_lambda(SIZE1), rows1(SIZE1), force2(SIZE2)
    real(c_double) :: w(9), scale
    integer(c_int64_t) :: plan_rows(2), plan_counts(2), row_list(UNKNOWNS), row_offsets(UNKNOWNS + 1)
    integer(c_int64_t) :: plan_columns(UNKNOWNS**2)
    integer(c_int32_t) :: row_list32(UNKNOWNS), row_offsets32(UNKNOWNS + 1), rows32(UNKNOWNS**2), columns32(UNKNOWNS**2)
    real(c_double) :: plan_values(UNKNOWNS**2), constraints(UNKNOWNS**2)
    real(c_double) :: adjusted(SIZE1), gaps(NA), shape_offsets(NA)
    integer(c_int32_t) :: moved(NA)
    integer(c_int32_t) :: kinds(8), cover(NA), layers(NA), state(NA), suspect_causes(8)
    character(kind=c_char) :: text(80), effects(1000), report_text(1000), diagnosis_text(2000)
  end type

  type(element), target, save :: e
  type(handle), target, save :: h
  type(outputs), target, save :: o
  integer(c_int8_t), pointer :: bytes(:)
  integer(c_int8_t), allocatable, save :: bytes_before(:)
  real(c_double), save :: residual_before(UNKNOWNS)

  ! Inputs that they do not have.
  type(history), target, save :: imported
  type(weights), target, save :: previous
  type(stickslip_interface), target, save :: interface_, other, created
  integer(c_int64_t), target, save :: ld, capacity, length, n_interfaces, n, n_rows, n_integers, n_reals, commits, struct_size
  integer(c_int64_t), target, save :: nodes(3), offsets1(3), offsets2(3), shared1(6), shared2(4)
  integer(c_int32_t), target, save :: n_facet, layout, index_base, piece, which_normals, which_pairs, entries, side, shape_
  real(c_double), target, save :: scale, stiffness, rounding, angle, penetration, neighbours(12)
  real(c_double), target, save :: mu(NA), r(NA), normals(SIZE1), slip(SIZE1), directions(9), sums(STICKSLIP_SUMS_PER_NODE * NA)
  real(c_double), target, save :: dx1(SIZE1), dx2(SIZE2), raised1(NA), raised2(NC)
  real(c_double), target, save :: tolerance, radius, point(3), direction(3)
  ! Pointer arguments, by the names of the header.
  integer, parameter :: POINTERS = 41
  character(13), parameter :: NAMES(POINTERS) = [character(13) :: 'n_ab', 'n_ac', 'dn_ab', 'dn_ac', 'n_ab_previous', &
      'n_ac_previous', 'row_scale', 'normals', 'areas', 'row', 'block', 'gap', 'traction', 'slip', 'facet_nodes', &
      'originals', 'nodes', 'kinds', 'claims', 'rows', 'columns', 'values', 'sums', 'r', &
      'fade', 'coefficients', 'dual_ab', 'dual_ac', 'carriers', 'weights', 'entry_rows', 'entry_columns', 'w', &
      'dnu_dsum', 'dp_dnormal', 'drow_dnormal', 'offsets1', 'offsets2', 'coordinates', 'gaps', 'moved']
  type(c_ptr), target, save :: p(POINTERS)

contains

  ! The pointer argument of this name.
  type(c_ptr) function at(name)
    character(*), intent(in) :: name
    at = p(findloc(NAMES, name, 1))
  end function

  integer(c_int32_t) function perform(function_) bind(C)
    type(c_ptr), value :: function_
    perform = call_of(c_text(function_))
  end function

  integer(c_int32_t) function call_of(name) result(status)
    character(*), intent(in) :: name
    call end_created()
    select case (name)
    case ('pair_weights')
      status = stickslip_pair_weights(e%pair, at('n_ab'), at('n_ac'), at('dn_ab'), at('dn_ac'))
    case ('pair_gap')
      status = call_gap(e)
    case ('pair_residual')
      status = call_residual(e)
    case ('pair_tangent')
      status = stickslip_pair_tangent(e%pair, at('n_ab'), at('n_ac'), at('dn_ab'), at('dn_ac'), at('n_ab_previous'), &
          at('n_ac_previous'), e%traction, e%responses, at('row_scale'), e%k, ld)
    case ('pair_begin')
      status = stickslip_pair_begin(e%pair, capacity, e%state_out, at('n_ab'), at('n_ac'), at('gap'))
    case ('pair_state_gap')
      status = stickslip_pair_state_gap(e%state, at('n_ab_previous'), at('n_ac_previous'), e%gap)
    case ('pair_state_residual')
      status = stickslip_pair_state_residual(e%state, e%traction, e%force)
    case ('pair_state_tangent')
      status = stickslip_pair_state_tangent(e%state, at('n_ab_previous'), at('n_ac_previous'), e%traction, e%responses, &
          at('row_scale'), e%k, ld)
    case ('facet_dual')
      status = stickslip_facet_dual(n_facet, e%x1, e%mass, at('fade'), at('areas'), at('coefficients'))
    case ('pair_dual')
      status = stickslip_pair_dual(e%pair, e%mass, e%w%ab, e%w%ac, at('dual_ab'), at('dual_ac'))
    case ('facet_tangent')
      status = stickslip_facet_tangent(e%facet, e%w%ab, e%w%ac, at('n_ab_previous'), at('n_ac_previous'), e%traction, &
          e%responses, at('row_scale'), e%facet_k, ld)
    case ('facet_geometry')
      status = stickslip_facet_geometry(n_facet, e%x1, at('normals'), at('areas'))
    case ('facet_normal')
      status = stickslip_facet_normal(n_facet, e%x1, o%facet_normal)
    case ('node_normal')
      status = call_normal(e)
    case ('node_respond')
      status = stickslip_node_respond(e%node, o%answer)
    case ('node_block')
      status = stickslip_node_block(e%responses(1), scale, layout, at('row'), at('block'))
    case ('node_equilibrium')
      status = stickslip_node_equilibrium(e%node, stiffness, rounding, at('gap'), at('traction'), at('slip'))
    case ('options_init')
      status = stickslip_options_init(o%options, struct_size)
    case ('options_paper')
      status = stickslip_options_paper(h%s%options)
    case ('options_method')
      status = stickslip_options_method(h%s%options, h%s%method)
    case ('last_error_padded')
      status = stickslip_last_error_padded(o%text, length)
    case ('surface_split_creases')
      status = stickslip_surface_split_creases(h%s%nonmortar, angle, index_base, capacity, at('facet_nodes'), &
          at('originals'), o%count)
    case ('crosspoints_find')
      status = stickslip_crosspoints_find(n_interfaces, offsets1, shared1, offsets2, shared2, capacity, at('nodes'), &
          at('kinds'), at('claims'), o%count)
    case ('interface_create')
      status = stickslip_interface_create(h%s%nonmortar, h%s%mortar, h%s%options, created)
    case ('interface_destroy')
      status = stickslip_interface_destroy(other)
    case ('interface_set_friction')
      status = stickslip_interface_set_friction(interface_, mu)
    case ('interface_set_augmentation')
      status = stickslip_interface_set_augmentation(interface_, at('r'))
    case ('interface_set_normals')
      status = stickslip_interface_set_normals(interface_, at('normals'))
    case ('interface_set_constraints')
      status = stickslip_interface_set_constraints(interface_, n, nodes, directions)
    case ('interface_set_previous')
      status = stickslip_interface_set_previous(interface_, h%s%x1, h%s%x2)
    case ('interface_set_committed')
      status = stickslip_interface_set_committed(interface_, h%s%x1, h%s%x2, c_loc(slip), commits)
    case ('interface_initial_multipliers')
      status = stickslip_interface_initial_multipliers(interface_, o%initial)
    case ('interface_sums')
      status = stickslip_interface_sums(interface_, h%s%x1, h%s%x2, h%sums)
    case ('interface_states')
      status = stickslip_interface_states(interface_, h%s%x1, h%s%x2, h%s%lambda, at('sums'), h%states)
    case ('interface_residual')
      status = stickslip_interface_residual(interface_, h%s%x1, h%s%x2, h%s%lambda, at('sums'), h%force1, h%force2, h%rows)
    case ('interface_tangent_coo')
      status = stickslip_interface_tangent_coo(interface_, h%s%x1, h%s%x2, h%s%lambda, at('sums'), capacity, at('rows'), &
          at('columns'), at('values'), h%count)
    case ('interface_tangent_csr')
      status = stickslip_interface_tangent_csr(interface_, h%s%x1, h%s%x2, h%s%lambda, at('sums'), n_rows, h%offsets, &
          h%csr_columns, h%csr)
    case ('interface_pattern_coo')
      status = stickslip_interface_pattern_coo(interface_, h%s%x1, h%s%x2, capacity, at('rows'), at('columns'), h%count)
    case ('interface_plan')
      status = stickslip_interface_plan(interface_, h%s%x1, h%s%x2, which_pairs, o%plan_rows(1), o%plan_counts(1))
    case ('interface_plan_coo')
      status = stickslip_interface_plan_coo(interface_, entries, capacity, h%row_numbers, h%columns)
    case ('interface_plan_coo32')
      status = stickslip_interface_plan_coo32(interface_, entries, capacity, o%rows32, o%columns32)
    case ('interface_plan_csr')
      status = stickslip_interface_plan_csr(interface_, entries, capacity, o%row_list, o%row_offsets, o%plan_columns)
    case ('interface_plan_csr32')
      status = stickslip_interface_plan_csr32(interface_, entries, capacity, o%row_list32, o%row_offsets32, o%columns32)
    case ('interface_plan_values')
      status = stickslip_interface_plan_values(interface_, h%s%x1, h%s%x2, h%s%lambda, at('sums'), capacity, o%plan_values)
    case ('interface_condensed_plan')
      status = stickslip_interface_condensed_plan(interface_, h%s%x1, h%s%x2, which_pairs, o%plan_rows, o%plan_counts)
    case ('interface_condensed_values')
      status = stickslip_interface_condensed_values(interface_, h%s%x1, h%s%x2, h%s%lambda, o%plan_values, o%constraints)
    case ('interface_step_limit')
      status = stickslip_interface_step_limit(interface_, h%s%x1, h%s%x2, dx1, dx2, penetration, h%fraction)
    case ('interface_commit')
      status = stickslip_interface_commit(interface_, h%s%x1, h%s%x2, h%s%lambda, at('sums'))
    case ('interface_commit_check')
      status = stickslip_interface_commit_check(interface_, h%s%x1, h%s%x2, h%s%lambda, at('sums'))
    case ('interface_rollback')
      status = stickslip_interface_rollback(interface_)
    case ('interface_history_size')
      status = stickslip_interface_history_size(interface_, o%n_integers, o%n_reals)
    case ('interface_history_export')
      status = stickslip_interface_history_export(interface_, n_integers, o%integers, n_reals, o%reals)
    case ('interface_history_import')
      status = stickslip_interface_history_import(interface_, n_integers, imported%integers, n_reals, imported%reals)
    case ('interface_counters')
      status = stickslip_interface_counters(interface_, o%counters)
    case ('interface_effects')
      status = stickslip_interface_effects(interface_, o%effects, capacity)
    case ('interface_report')
      status = stickslip_interface_report(interface_, h%s%x1, h%s%x2, o%report)
    case ('interface_diagnose')
      status = stickslip_interface_diagnose(interface_, h%s%x1, h%s%x2, h%s%lambda, at('sums'), o%diagnosis)
    case ('interface_set_offsets')
      status = stickslip_interface_set_offsets(interface_, at('offsets1'), at('offsets2'))
    case ('interface_adjust')
      status = stickslip_interface_adjust(interface_, tolerance, at('coordinates'), at('gaps'), at('moved'))
    case ('interface_shape_offsets')
      status = stickslip_interface_shape_offsets(interface_, side, shape_, radius, point, direction, o%shape_offsets)
    case ('interface_equilibrium')
      status = stickslip_interface_equilibrium(interface_, h%s%x1, h%s%x2, h%s%lambda, at('sums'), o%equilibrium)
    case ('node_condense')
      status = stickslip_node_condense(e%node, e%responses(1), layout, at('w'), at('row'), at('row_scale'))
    case ('interface_use_normals')
      status = stickslip_interface_use_normals(interface_, which_normals)
    case ('interface_turn_multipliers')
      status = stickslip_interface_turn_multipliers(interface_, h%s%x1, h%s%lambda)
    case ('facet_normal_derivatives')
      status = stickslip_facet_normal_derivatives(n_facet, e%x1, e%normal_derivatives)
    case ('node_turn')
      status = stickslip_node_turn(e%node, e%sum, layout, at('dnu_dsum'), at('dp_dnormal'), at('drow_dnormal'))
    case ('interface_carriers')
      status = stickslip_interface_carriers(interface_, capacity, at('nodes'), at('carriers'), at('weights'), h%count)
    case ('interface_condensed_multipliers')
      status = stickslip_interface_condensed_multipliers(interface_, h%s%x1, h%s%x2, h%host1, o%condensed_lambda)
    case ('interface_condensed_residual')
      status = stickslip_interface_condensed_residual(interface_, h%s%x1, h%s%x2, h%s%lambda, h%host1, o%rows1, o%force2)
    case ('interface_condensed_coo')
      status = stickslip_interface_condensed_coo(interface_, h%s%x1, h%s%x2, h%s%lambda, piece, capacity, at('rows'), &
          at('columns'), at('values'), h%count)
    case ('interface_condensed_csr')
      status = stickslip_interface_condensed_csr(interface_, h%s%x1, h%s%x2, h%s%lambda, n_rows, h%offsets, h%csr_columns, &
          h%csr)
    case ('interface_condensed_pattern')
      status = stickslip_interface_condensed_pattern(interface_, h%s%x1, h%s%x2, n_rows, h%offsets, h%csr_columns, &
          capacity, at('entry_rows'), at('entry_columns'), h%count)
    case default
      call check_true(.false., __FILE__, __LINE__, 'a function is called ' // name // ', which')
      status = 0
    end select
  end function

  ! Good values for everything, and marks in all outputs.
  subroutine set_up(function_, base) bind(C)
    type(c_ptr), value :: function_
    integer(c_int32_t), value :: base
    character(:), allocatable :: name
    type(stickslip_states) :: states
    name = c_text(function_)
    call element_init(e)
    call scene_init(h%s, int(base))
    if (name == 'interface_carriers' .or. index(name, 'interface_condensed_') == 1) &
        h%s%method%multiplier_basis = STICKSLIP_BASIS_DUAL
    if (name == 'interface_carriers') call scene_slide(h%s, 0.9d0)
    if (name == 'interface_use_normals' .or. name == 'interface_turn_multipliers') &
        h%s%method%normals = STICKSLIP_NORMALS_CURRENT
    call scene_create(h%s)
    call scene_commit(h%s)
    call history_take(h%s%contact, h%before)
    call handle_prepare(h)
    CHECK_OK(stickslip_interface_create(h%s%nonmortar, h%s%mortar, h%s%options, other))
    states = stickslip_states(normal=c_loc(normals))
    CHECK_OK(stickslip_interface_states(h%s%contact, h%s%x1, h%s%x2, h%s%lambda, c_null_ptr, states))
    CHECK_OK(stickslip_interface_sums(h%s%contact, h%s%x1, h%s%x2, sums))
    call set_up_inputs(name, base)
    call set_up_pointers(name)
    interface_ = h%s%contact
    if (name == 'interface_initial_multipliers') interface_ = other
    call c_f_pointer(c_loc(o), bytes, [c_sizeof(o)])
    bytes = 90
    o%counters%struct_size = stickslip_counters_size
    o%answer%struct_size = stickslip_node_response_size
    o%report = stickslip_report(cover=c_loc(o%cover), fraction=c_loc(o%fractions), layers=c_loc(o%layers), &
        facets=c_loc(o%facets), text=c_loc(o%report_text), text_capacity=size(o%report_text), nodes_none=-77)
    o%diagnosis = stickslip_diagnosis(state=c_loc(o%state), suspect_nodes=c_loc(o%suspect_nodes), suspect_capacity=8, &
        suspect_directions=c_loc(o%suspect_directions), suspect_ratios=c_loc(o%suspect_ratios), suspects=-77, &
        suspect_causes=c_loc(o%suspect_causes), text=c_loc(o%diagnosis_text), text_capacity=size(o%diagnosis_text))
    o%state = 0
    o%equilibrium = stickslip_equilibrium(gap=-77d0)
    bytes_before = bytes
    call scene_residual(h%s, residual_before)
  end subroutine

  subroutine set_up_inputs(name, base)
    character(*), intent(in) :: name
    integer(c_int32_t), intent(in) :: base
    type(c_ptr), parameter :: none = c_null_ptr
    integer(c_int32_t) :: status
    integer(c_int64_t) :: rows(2), counts(2)
    imported = h%before
    n_integers = imported%n_integers
    n_reals = imported%n_reals
    previous = e%w
    ld = 36
    n = 1
    n_rows = UNKNOWNS
    n_facet = 4
    n_interfaces = 2
    length = size(o%text)
    struct_size = stickslip_options_size
    index_base = base
    piece = STICKSLIP_CONDENSED_FORCES
    which_normals = STICKSLIP_NORMALS_COMMITTED
    which_pairs = STICKSLIP_PLAN_ACTIVE
    entries = STICKSLIP_ENTRIES_TANGENT
    layout = STICKSLIP_LAYOUT_COLUMN_MAJOR
    angle = 0.5d0
    scale = 1
    stiffness = 1
    rounding = 0
    penetration = 0
    nodes = base + 4
    slip = 0
    commits = 3
    directions = [1, 0, 0, 0, 1, 0, 0, 0, 1]
    neighbours = 0
    mu = 1
    r = 1
    dx1 = 0
    dx1(1) = 1
    dx2 = 0
    raised1 = 0
    raised2 = 0
    tolerance = 0.02d0
    side = STICKSLIP_SIDE_NONMORTAR
    shape_ = STICKSLIP_SHAPE_SPHERE
    radius = 1d4
    point = [0d0, 0d0, 1d4]
    direction = point
    call scene_frame(point)
    offsets1 = [0, 3, 6]
    offsets2 = [0, 2, 4]
    shared1 = [1, 2, 3, 3, 4, 5]
    shared2 = [7, 5, 1, 4]
    ! As much as is needed, where that can be asked.
    select case (name)
    case ('pair_begin')
      capacity = stickslip_pair_state_size()
    case ('interface_effects')
      capacity = size(o%effects)
    case ('crosspoints_find')
      status = stickslip_crosspoints_find(n_interfaces, offsets1, shared1, offsets2, shared2, 0_c_int64_t, none, none, none, &
          capacity)
      CHECK_OK(status)
    case ('interface_tangent_coo')
      status = stickslip_interface_tangent_coo(h%s%contact, h%s%x1, h%s%x2, h%s%lambda, none, 0_c_int64_t, none, none, none, &
          capacity)
      CHECK_OK(status)
    case ('interface_pattern_coo')
      CHECK_OK(stickslip_interface_pattern_coo(h%s%contact, h%s%x1, h%s%x2, 0_c_int64_t, none, none, capacity))
    case ('interface_plan_coo', 'interface_plan_coo32', 'interface_plan_csr', 'interface_plan_csr32', 'interface_plan_values')
      CHECK_OK(stickslip_interface_plan(h%s%contact, h%s%x1, h%s%x2, STICKSLIP_PLAN_ACTIVE, rows(1), capacity))
    case ('interface_condensed_values')
      CHECK_OK(stickslip_interface_condensed_plan(h%s%contact, h%s%x1, h%s%x2, STICKSLIP_PLAN_ACTIVE, rows, counts))
    case ('interface_carriers')
      CHECK_OK(stickslip_interface_carriers(h%s%contact, 0_c_int64_t, none, none, none, capacity))
    case ('interface_condensed_coo')
      status = stickslip_interface_condensed_coo(h%s%contact, h%s%x1, h%s%x2, h%s%lambda, piece, 0_c_int64_t, none, none, &
          none, capacity)
      CHECK_OK(status)
    case ('interface_condensed_pattern')
      status = stickslip_interface_condensed_pattern(h%s%contact, h%s%x1, h%s%x2, n_rows, h%offsets, h%csr_columns, &
          0_c_int64_t, none, none, capacity)
      CHECK_OK(status)
    case default
      capacity = NA
    end select
  end subroutine

  subroutine set_up_pointers(name)
    character(*), intent(in) :: name
    p = [c_loc(e%w%ab), c_loc(e%w%ac), c_loc(e%w%dab), c_loc(e%w%dac), c_loc(previous%ab), c_loc(previous%ac), &
         c_loc(e%row_scale), c_loc(e%normals), c_loc(e%areas), c_loc(e%row), c_loc(e%block), c_loc(o%gap), &
         c_loc(o%traction), c_loc(o%slip), c_loc(o%split_nodes), c_loc(o%originals), c_loc(o%shared_nodes), &
         c_loc(o%kinds), c_loc(o%claims), c_loc(h%row_numbers), c_loc(h%columns), c_loc(h%values), c_null_ptr, c_loc(r), &
         c_loc(e%fade), c_loc(e%coefficients), c_loc(e%dual_ab), c_loc(e%dual_ac), &
         c_loc(h%columns), c_loc(h%values), c_loc(h%row_numbers), c_loc(h%columns), c_loc(o%w), &
         c_loc(e%turn(1, 1)), c_loc(e%turn(1, 2)), c_loc(e%turn(1, 3)), c_loc(raised1), c_loc(raised2), &
         c_loc(o%adjusted), c_loc(o%gaps), c_loc(o%moved)]
    if (name == 'node_condense') p(7) = c_loc(o%scale)
    if (name == 'interface_carriers') p(17) = c_loc(h%row_numbers)
    if (name == 'pair_begin') p([1, 2, 12]) = [c_loc(e%w_out%ab), c_loc(e%w_out%ac), c_loc(e%gap)]
    if (name == 'pair_weights') p(1:4) = [c_loc(e%w_out%ab), c_loc(e%w_out%ac), c_loc(e%w_out%dab), c_loc(e%w_out%dac)]
    if (name == 'interface_set_normals') p(8) = c_loc(normals)
  end subroutine

  subroutine compare() bind(C)
    real(c_double) :: residual(UNKNOWNS)
    CHECK(all(bytes == bytes_before))
    call element_untouched(e)
    call handle_untouched(h)
    CHECK(address_of(created) == 0)
    call scene_residual(h%s, residual)
    CHECK(all(same(residual, residual_before)))
  end subroutine

  ! What a creation that succeeded has left.
  subroutine end_created()
    CHECK_OK(stickslip_interface_destroy(created))
  end subroutine

  subroutine tear_down() bind(C)
    call end_created()
    CHECK_OK(stickslip_interface_destroy(other))
    call scene_destroy(h%s)
  end subroutine
end module
