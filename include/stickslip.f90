! stickslip: frictional mortar contact element for any finite element code. MIT OR Apache-2.0.
!
! The Fortran 2003 interface: stickslip.h in Fortran's words, same names, same order, no code of its own. Compile this
! file with your sources, with your compiler; a ready-made .mod file would serve one version of one compiler only.
! stickslip.h has the whole text of each function: errors, signs, units, who calls what when.
!
! Sides: 1 = non-mortar (has the multipliers), 2 = mortar. nu points INTO the non-mortar body; a gap > 0 is open;
! lambda is minus the Cauchy traction on the non-mortar body, so lambda . nu <= 0 is compression. F force, L length.
!
! Status: every function that can refuse returns one; 0 is success. After a refusal stickslip_last_error_padded says
! which argument was wrong; it counts nodes and facets from 0 and names dimensions as C has them.
!
! Arrays: in the order of C's memory, so C's "3 n1, node by node" is x(3, n1) here. A matrix in C's row-major order is
! transposed: C's row-major n_ab (n1 x n1), row A, is n_ab(b, a). Tangents and blocks go out as k(row, column) with
! STICKSLIP_LAYOUT_COLUMN_MAJOR. Arrays of any rank will do for `x(3, *)` if the elements are in this order.
!
! Numbering: stickslip_options_init chooses index base 0. Set index_base = 1, and nodes, equations, rows and columns are
! counted from 1; the facet offsets start at 0 all the same.
!
! Pointers: what may be NULL in C is `type(c_ptr), value` here: give c_null_ptr, or c_loc(a) of an array with the TARGET
! attribute. Pointer members of types alike; the arrays must live as long as the call, not longer.
!
! Outputs are intent(inout) because a refused call leaves them as they were; they need no value before the call.
!
! Types set their struct_size and null pointers by themselves; leave struct_size alone.
module stickslip
  use, intrinsic :: iso_c_binding, only: c_char, c_double, c_funptr, c_int32_t, c_int64_t, c_null_ptr, c_ptr
  implicit none
  public

  ! Version of this module.
  integer(c_int32_t), parameter :: STICKSLIP_VERSION_MAJOR = 0
  integer(c_int32_t), parameter :: STICKSLIP_VERSION_MINOR = 1
  integer(c_int32_t), parameter :: STICKSLIP_VERSION_PATCH = 0

  ! Status.
  integer(c_int32_t), parameter :: STICKSLIP_OK = 0
  integer(c_int32_t), parameter :: STICKSLIP_NULL_POINTER = 1
  integer(c_int32_t), parameter :: STICKSLIP_STRUCT_SIZE = 2
  integer(c_int32_t), parameter :: STICKSLIP_INVALID_SIZE = 3
  integer(c_int32_t), parameter :: STICKSLIP_NOT_FINITE = 4
  integer(c_int32_t), parameter :: STICKSLIP_INDEX_OUT_OF_RANGE = 5
  integer(c_int32_t), parameter :: STICKSLIP_DUPLICATE_NODE = 6
  integer(c_int32_t), parameter :: STICKSLIP_DEGENERATE_FACET = 7
  integer(c_int32_t), parameter :: STICKSLIP_INVALID_VALUE = 8
  integer(c_int32_t), parameter :: STICKSLIP_MISSING_STIFFNESS = 9
  integer(c_int32_t), parameter :: STICKSLIP_UNSUPPORTED = 10
  integer(c_int32_t), parameter :: STICKSLIP_UNDEFINED_NORMAL = 11
  ! Within Newton: a domain error; take a smaller step.
  integer(c_int32_t), parameter :: STICKSLIP_PROJECTION_NOT_CONVEX = 12
  integer(c_int32_t), parameter :: STICKSLIP_BUFFER_TOO_SMALL = 13
  integer(c_int32_t), parameter :: STICKSLIP_MISSING_ENTRY = 14
  integer(c_int32_t), parameter :: STICKSLIP_NOTHING_TO_ROLL_BACK = 15
  integer(c_int32_t), parameter :: STICKSLIP_HISTORY_MISMATCH = 16
  ! Within the step a surface has turned too far; commit smaller steps. With weights of the reference: since the first configuration.
  integer(c_int32_t), parameter :: STICKSLIP_TURNED_TOO_FAR = 17
  ! The system has no memory left for what the call needs.
  integer(c_int32_t), parameter :: STICKSLIP_OUT_OF_MEMORY = 18
  ! A commit would take pairs away from a closed node.
  integer(c_int32_t), parameter :: STICKSLIP_CONTACT_LOST = 19
  ! The library is at fault; the handle is suspect.
  integer(c_int32_t), parameter :: STICKSLIP_PANIC = -1

  ! Options; 0 is the default of each.
  integer(c_int32_t), parameter :: STICKSLIP_FORM_MULTIPLIER = 0
  integer(c_int32_t), parameter :: STICKSLIP_FORM_AUGMENTED = 1

  integer(c_int32_t), parameter :: STICKSLIP_SLIP_OBJECTIVE = 0
  integer(c_int32_t), parameter :: STICKSLIP_SLIP_INCREMENT = 1
  integer(c_int32_t), parameter :: STICKSLIP_SLIP_PAPER = 2

  integer(c_int32_t), parameter :: STICKSLIP_WEIGHTS_AUTO = 0
  integer(c_int32_t), parameter :: STICKSLIP_WEIGHTS_CURRENT = 1
  integer(c_int32_t), parameter :: STICKSLIP_WEIGHTS_COMMITTED = 2
  integer(c_int32_t), parameter :: STICKSLIP_WEIGHTS_REFERENCE = 3
  integer(c_int32_t), parameter :: STICKSLIP_WEIGHTS_CONSERVING = 5

  ! Normals: of the last commit; of the current configuration, linearised, with current weights and averaged normals only.
  integer(c_int32_t), parameter :: STICKSLIP_NORMALS_AUTO = 0
  integer(c_int32_t), parameter :: STICKSLIP_NORMALS_COMMITTED = 1
  integer(c_int32_t), parameter :: STICKSLIP_NORMALS_CURRENT = 2

  ! Added up in no_shortcuts: work that the library is to do although the answer does not depend on it.
  integer(c_int32_t), parameter :: STICKSLIP_SHORTCUT_FRICTIONLESS = 1
  integer(c_int32_t), parameter :: STICKSLIP_SHORTCUT_RIGID = 2
  integer(c_int32_t), parameter :: STICKSLIP_SHORTCUT_APART = 4
  integer(c_int32_t), parameter :: STICKSLIP_SHORTCUT_UNCOVERED = 8

  integer(c_int32_t), parameter :: STICKSLIP_BASIS_AUTO = 0
  integer(c_int32_t), parameter :: STICKSLIP_BASIS_STANDARD = 1
  integer(c_int32_t), parameter :: STICKSLIP_BASIS_DUAL = 2

  ! weak_coverage: every covered node has a multiplier of its own.
  real(c_double), parameter :: STICKSLIP_WEAK_COVERAGE_NONE = -1.0_c_double

  integer(c_int32_t), parameter :: STICKSLIP_QUADRATURE_DEGREE_5 = 0
  integer(c_int32_t), parameter :: STICKSLIP_QUADRATURE_DEGREE_10 = 1
  integer(c_int32_t), parameter :: STICKSLIP_QUADRATURE_DEGREE_1 = 2
  integer(c_int32_t), parameter :: STICKSLIP_QUADRATURE_DEGREE_2 = 3
  integer(c_int32_t), parameter :: STICKSLIP_QUADRATURE_DEGREE_4 = 4
  integer(c_int32_t), parameter :: STICKSLIP_QUADRATURE_DEGREE_6 = 5

  ! Weights over triangles of each overlap; over points on each non-mortar facet, patch tests fail; over overlaps where such a
  ! facet is partly covered, points elsewhere.
  integer(c_int32_t), parameter :: STICKSLIP_INTEGRATION_SEGMENTS = 0
  integer(c_int32_t), parameter :: STICKSLIP_INTEGRATION_ELEMENTS = 1
  integer(c_int32_t), parameter :: STICKSLIP_INTEGRATION_HYBRID = 2

  ! The tangent: exact; with weights of now as constants; without the tilt of facets.
  integer(c_int32_t), parameter :: STICKSLIP_TANGENT_EXACT = 0
  integer(c_int32_t), parameter :: STICKSLIP_TANGENT_FROZEN_WEIGHTS = 1
  integer(c_int32_t), parameter :: STICKSLIP_TANGENT_FROZEN_NORMALS = 2

  ! Whether nodes or points are closed.
  integer(c_int32_t), parameter :: STICKSLIP_DECISION_NODES = 0
  integer(c_int32_t), parameter :: STICKSLIP_DECISION_POINTS = 1

  integer(c_int32_t), parameter :: STICKSLIP_ROW_SCALE_FORCE = 0
  integer(c_int32_t), parameter :: STICKSLIP_ROW_SCALE_NONE = 1

  integer(c_int32_t), parameter :: STICKSLIP_NEW_CONTACT_FRICTIONLESS = 0
  integer(c_int32_t), parameter :: STICKSLIP_NEW_CONTACT_KEEP = 1

  integer(c_int32_t), parameter :: STICKSLIP_FRICTION_COULOMB = 0
  integer(c_int32_t), parameter :: STICKSLIP_FRICTION_NONE = 1
  integer(c_int32_t), parameter :: STICKSLIP_FRICTION_TIED = 2
  integer(c_int32_t), parameter :: STICKSLIP_FRICTION_ROUGH = 3
  integer(c_int32_t), parameter :: STICKSLIP_FRICTION_TRESCA = 4

  integer(c_int32_t), parameter :: STICKSLIP_MORTAR_DEFORMABLE = 0
  integer(c_int32_t), parameter :: STICKSLIP_MORTAR_RIGID = 1
  integer(c_int32_t), parameter :: STICKSLIP_MORTAR_ANALYTIC = 2

  integer(c_int32_t), parameter :: STICKSLIP_SHAPE_PLANE = 0
  integer(c_int32_t), parameter :: STICKSLIP_SHAPE_SPHERE = 1
  integer(c_int32_t), parameter :: STICKSLIP_SHAPE_CYLINDER = 2

  integer(c_int32_t), parameter :: STICKSLIP_NODE_SHARED = 0
  integer(c_int32_t), parameter :: STICKSLIP_NODE_OWN = 1
  integer(c_int32_t), parameter :: STICKSLIP_NODE_ELSEWHERE = 2

  ! Added up in the kinds of a node that interfaces share.
  integer(c_int32_t), parameter :: STICKSLIP_CROSSPOINT_CLAIMED = 1
  integer(c_int32_t), parameter :: STICKSLIP_CROSSPOINT_CHAIN = 2
  integer(c_int32_t), parameter :: STICKSLIP_CROSSPOINT_BOTH_SIDES = 4

  ! Reals per node of stickslip_interface_sums.
  integer(c_int32_t), parameter :: STICKSLIP_SUMS_PER_NODE = 11

  ! Plans: of the pairs that are active; the same for values with sums; of all that may be while the surfaces slide by less
  ! than a quarter of a facet.
  integer(c_int32_t), parameter :: STICKSLIP_PLAN_ACTIVE = 0
  integer(c_int32_t), parameter :: STICKSLIP_PLAN_ACTIVE_SUMS = 1
  integer(c_int32_t), parameter :: STICKSLIP_PLAN_SKIN = 2

  ! Entries of plans: of the tangent; of both parts of a system without multipliers.
  integer(c_int32_t), parameter :: STICKSLIP_ENTRIES_TANGENT = 0
  integer(c_int32_t), parameter :: STICKSLIP_ENTRIES_FORCES = 1
  integer(c_int32_t), parameter :: STICKSLIP_ENTRIES_CONSTRAINTS = 2

  ! Pieces of a condensed matrix: what the contact forces add to the host's own matrix, the elimination L - I, the contact
  ! constraints.
  integer(c_int32_t), parameter :: STICKSLIP_CONDENSED_FORCES = 0
  integer(c_int32_t), parameter :: STICKSLIP_CONDENSED_ELIMINATION = 1
  integer(c_int32_t), parameter :: STICKSLIP_CONDENSED_CONSTRAINTS = 2
  integer(c_int32_t), parameter :: STICKSLIP_CONDENSED_SCALES = 3
  ! Of the reduced form, for multigrid: E_L - I and E_R - I, the projector on the directions of constraints, and what these
  ! have on its diagonal.
  integer(c_int32_t), parameter :: STICKSLIP_CONDENSED_REDUCTION_ROWS = 4
  integer(c_int32_t), parameter :: STICKSLIP_CONDENSED_REDUCTION_COLUMNS = 5
  integer(c_int32_t), parameter :: STICKSLIP_CONDENSED_CONSTRAINED = 6
  integer(c_int32_t), parameter :: STICKSLIP_CONDENSED_CONSTRAINT_DIAGONAL = 7

  ! Cover of a node: none, in part, in full, by several layers.
  integer(c_int32_t), parameter :: STICKSLIP_COVER_NONE = 0
  integer(c_int32_t), parameter :: STICKSLIP_COVER_PART = 1
  integer(c_int32_t), parameter :: STICKSLIP_COVER_FULL = 2
  integer(c_int32_t), parameter :: STICKSLIP_COVER_SEVERAL = 3

  ! What a report finds where no node is covered.
  integer(c_int32_t), parameter :: STICKSLIP_FINDING_NONE = 0
  integer(c_int32_t), parameter :: STICKSLIP_FINDING_NO_OVERLAP = 1
  integer(c_int32_t), parameter :: STICKSLIP_FINDING_SAME_WAY = 2
  integer(c_int32_t), parameter :: STICKSLIP_FINDING_BEHIND = 3
  integer(c_int32_t), parameter :: STICKSLIP_FINDING_SWAPPED = 4
  integer(c_int32_t), parameter :: STICKSLIP_FINDING_INSIDE_OUT = 5

  ! Why a node and direction are suspected.
  integer(c_int32_t), parameter :: STICKSLIP_CAUSE_OTHER = 0
  integer(c_int32_t), parameter :: STICKSLIP_CAUSE_COVERAGE = 1
  integer(c_int32_t), parameter :: STICKSLIP_CAUSE_PRESCRIBED = 2
  integer(c_int32_t), parameter :: STICKSLIP_CAUSE_NEW = 3

  ! With COLUMN_MAJOR a matrix comes out as k(row, column) of Fortran.
  integer(c_int32_t), parameter :: STICKSLIP_LAYOUT_ROW_MAJOR = 0
  integer(c_int32_t), parameter :: STICKSLIP_LAYOUT_COLUMN_MAJOR = 1

  ! Where multipliers of a quadratic facet stand: at its corners, or at all nodes with the functions of its parts.
  integer(c_int32_t), parameter :: STICKSLIP_SPACE_CORNER = 0
  integer(c_int32_t), parameter :: STICKSLIP_SPACE_SUB = 1
  integer(c_int32_t), parameter :: STICKSLIP_MODEL_SOLID = 0
  integer(c_int32_t), parameter :: STICKSLIP_MODEL_PLANE = 1
  integer(c_int32_t), parameter :: STICKSLIP_MODEL_AXISYMMETRIC = 2

  ! What facets are: of a solid; lines (x, y) of a plane model; lines (r, z) of an axisymmetric one.

  ! State of a node: open or uncovered; closed, sticking; closed, sliding or on the friction cone.
  integer(c_int32_t), parameter :: STICKSLIP_STATE_GAP = 0
  integer(c_int32_t), parameter :: STICKSLIP_STATE_STICK = 1
  integer(c_int32_t), parameter :: STICKSLIP_STATE_SLIP = 2

  ! What stickslip_interface_adjust did with a node; sides of an interface.
  integer(c_int32_t), parameter :: STICKSLIP_ADJUST_ALONE = 0
  integer(c_int32_t), parameter :: STICKSLIP_ADJUST_LEFT = 1
  integer(c_int32_t), parameter :: STICKSLIP_ADJUST_MOVED = 2
  integer(c_int32_t), parameter :: STICKSLIP_SIDE_NONMORTAR = 0
  integer(c_int32_t), parameter :: STICKSLIP_SIDE_MORTAR = 1

  ! Arms of forces on a rigid body: those at the motion; the means of those at t_n and at the motion, for dynamics.
  integer(c_int32_t), parameter :: STICKSLIP_RIGID_ARMS_END = 0
  integer(c_int32_t), parameter :: STICKSLIP_RIGID_ARMS_MIDDLE = 1

  ! Laws in place of Coulomb's; the most numbers a node that a law may remember.
  integer(c_int32_t), parameter :: STICKSLIP_LAW_COULOMB = 0
  integer(c_int32_t), parameter :: STICKSLIP_LAW_COHESION = 1
  integer(c_int32_t), parameter :: STICKSLIP_LAW_WEAKENING = 2
  integer(c_int32_t), parameter :: STICKSLIP_LAW_ORTHOTROPIC = 3
  integer(c_int32_t), parameter :: STICKSLIP_LAW_RATE = 4
  integer(c_int32_t), parameter :: STICKSLIP_LAW_MAX_STATES = 1024

  ! Columns of the heat's tangent: of temperatures alone, or of displacements and multipliers, too. Derivatives per side of
  ! stickslip_node_heat.
  integer(c_int32_t), parameter :: STICKSLIP_HEAT_TEMPERATURES = 0
  integer(c_int32_t), parameter :: STICKSLIP_HEAT_ALL = 1
  integer(c_int32_t), parameter :: STICKSLIP_HEAT_SLOPES = 5

  ! Of stickslip_skin_set_pair in place of mu: the two bodies do not see each other. Sides of a skin's facet.
  real(c_double), parameter :: STICKSLIP_SKIN_APART = -1.0_c_double
  integer(c_int32_t), parameter :: STICKSLIP_SKIN_NONE = 0
  integer(c_int32_t), parameter :: STICKSLIP_SKIN_NONMORTAR = 1
  integer(c_int32_t), parameter :: STICKSLIP_SKIN_MORTAR = 2

  ! Sizes of the types in bytes (64-bit machines), their struct_size.
  integer(c_int64_t), parameter :: stickslip_method_size = 104
  integer(c_int64_t), parameter :: stickslip_options_size = 88
  integer(c_int64_t), parameter :: stickslip_surface_size = 72
  integer(c_int64_t), parameter :: stickslip_states_size = 120
  integer(c_int64_t), parameter :: stickslip_counters_size = 200
  integer(c_int64_t), parameter :: stickslip_report_size = 104
  integer(c_int64_t), parameter :: stickslip_diagnosis_size = 224
  integer(c_int64_t), parameter :: stickslip_pair_size = 72
  integer(c_int64_t), parameter :: stickslip_node_response_size = 408
  integer(c_int64_t), parameter :: stickslip_node_size = 240
  integer(c_int64_t), parameter :: stickslip_facet_size = 72
  integer(c_int64_t), parameter :: stickslip_equilibrium_size = 216
  integer(c_int64_t), parameter :: stickslip_rigid_body_size = 56
  integer(c_int64_t), parameter :: stickslip_rigid_motion_size = 136
  integer(c_int64_t), parameter :: stickslip_law_size = 88
  integer(c_int64_t), parameter :: stickslip_law_point_size = 104
  integer(c_int64_t), parameter :: stickslip_law_answer_size = 48
  integer(c_int64_t), parameter :: stickslip_layer_size = 72
  integer(c_int64_t), parameter :: stickslip_heat_size = 80
  integer(c_int64_t), parameter :: stickslip_heat_nodes_size = 48
  integer(c_int64_t), parameter :: stickslip_gradient_size = 72
  integer(c_int64_t), parameter :: stickslip_direction_size = 72
  integer(c_int64_t), parameter :: stickslip_skin_sides_size = 48
  integer(c_int64_t), parameter :: stickslip_skin_summary_size = 64

  ! A contact interface, made by stickslip_interface_create and ended by stickslip_interface_destroy. A copy means the
  ! same interface. One thread at a time.
  type, bind(C) :: stickslip_interface
    private
    type(c_ptr) :: handle = c_null_ptr
  end type

  ! Where the entries of a nodal matrix with rigid bodies go, made by stickslip_rigid_create and ended by stickslip_rigid_destroy. A
  ! copy means the same. One thread at a time.
  type, bind(C) :: stickslip_rigid
    private
    type(c_ptr) :: handle = c_null_ptr
  end type

  ! General contact: the skin of all bodies, made by stickslip_skin_create and ended by stickslip_skin_destroy. A copy means
  ! the same. One thread at a time.
  type, bind(C) :: stickslip_skin
    private
    type(c_ptr) :: handle = c_null_ptr
  end type

  ! How an interface is computed; a host needs none of it. Every 0 is the library's choice.
  type, bind(C) :: stickslip_method
    integer(c_int64_t) :: struct_size = stickslip_method_size
    integer(c_int32_t) :: form = 0                 ! STICKSLIP_FORM_...
    integer(c_int32_t) :: slip = 0                 ! STICKSLIP_SLIP_...
    integer(c_int32_t) :: weights = 0              ! STICKSLIP_WEIGHTS_...
    integer(c_int32_t) :: multiplier_basis = 0     ! STICKSLIP_BASIS_...
    integer(c_int32_t) :: normals = 0              ! STICKSLIP_NORMALS_...
    integer(c_int32_t) :: multiplier_space = STICKSLIP_SPACE_CORNER ! where quadratic facets have multipliers
    integer(c_int32_t) :: decision = 0             ! STICKSLIP_DECISION_...: nodes or points are closed
    integer(c_int32_t) :: quadrature = 0           ! STICKSLIP_QUADRATURE_...
    integer(c_int32_t) :: row_scale = 0            ! STICKSLIP_ROW_SCALE_...
    integer(c_int32_t) :: new_contact = 0          ! STICKSLIP_NEW_CONTACT_...
    integer(c_int32_t) :: integration = 0          ! STICKSLIP_INTEGRATION_...
    integer(c_int32_t) :: tangent = 0              ! STICKSLIP_TANGENT_...
    integer(c_int32_t) :: no_shortcuts = 0         ! sum of STICKSLIP_SHORTCUT_...; 0: all are taken
    integer(c_int32_t) :: threads = 0              ! that values, residual and commit may use; 0: the calling one alone
    integer(c_int64_t) :: element_points = 0       ! along a side, without SEGMENTS: 2 to 10; 0: 4
    real(c_double) :: augmentation = 0             ! rhat [F/L^3]; 0: use the modulus
    real(c_double) :: coverage_min = 0             ! covered / full area at and below which a node is uncovered
    real(c_double) :: weak_coverage = 0            ! nodes covered less, over the best neighbour, are carried; 0: the
                                                   ! library's choice, 0.2 with dual multipliers, else none; or ..._NONE
    real(c_double) :: turn_max = 0                 ! radians from one commit to the next; 0: pi / 9; pi: any
  end type

  ! What an interface models. stickslip_options_init writes the defaults, which are those of this type.
  type, bind(C) :: stickslip_options
    integer(c_int64_t) :: struct_size = stickslip_options_size
    type(c_ptr) :: method = c_null_ptr             ! c_loc of a stickslip_method; null: as the library chooses
    integer(c_int32_t) :: friction = 0             ! STICKSLIP_FRICTION_...
    integer(c_int32_t) :: mortar_side = 0          ! STICKSLIP_MORTAR_...
    integer(c_int32_t) :: shape = 0                ! STICKSLIP_SHAPE_... with STICKSLIP_MORTAR_ANALYTIC, else 0
    integer(c_int32_t) :: model = STICKSLIP_MODEL_SOLID ! STICKSLIP_MODEL_...: in space, or lines
    integer(c_int32_t) :: small_displacements = 0  ! 1: weights and normals stay those of the first configuration
    integer(c_int32_t) :: index_base = 0           ! 0, or 1 as in Fortran: nodes, equations, rows, columns
    real(c_double) :: mu = 0                       ! Coulomb coefficient of all nodes
    real(c_double) :: shear_limit = 0              ! largest shear traction, > 0 with TRESCA [F/L^2]
    real(c_double) :: thickness = 0                ! of a plane model [L]; 0: 1
    real(c_double) :: radius = 0                   ! of sphere and cylinder [L]; < 0: the body is outside
    real(c_double) :: modulus = 0                  ! Young's modulus of the softer body [F/L^2]
    real(c_double) :: search_distance = 0          ! 0: as far as the surfaces reach [L]
  end type

  ! One surface of an interface. nf facets with 3, 4, 6, 8 or 9 nodes each: corners, mid nodes, centre.
  type, bind(C) :: stickslip_surface
    integer(c_int64_t) :: struct_size = stickslip_surface_size
    integer(c_int64_t) :: n_nodes = 0
    integer(c_int64_t) :: n_facets = 0
    type(c_ptr) :: coordinates = c_null_ptr        ! real(c_double) (3, n_nodes), first configuration [L]
    type(c_ptr) :: facet_offsets = c_null_ptr      ! integer(c_int64_t) (n_facets + 1), from 0 in either base
    type(c_ptr) :: facet_nodes = c_null_ptr        ! integer(c_int64_t), right-hand order seen from outside the body
    type(c_ptr) :: equations = c_null_ptr          ! integer(c_int64_t) (3, n_nodes); -1: none (prescribed)
    type(c_ptr) :: multiplier_equations = c_null_ptr ! integer(c_int64_t) (3, n_nodes), or (n_nodes) without friction;
                                                   ! -1: removed. Mortar: null
    type(c_ptr) :: owned = c_null_ptr              ! integer(c_int32_t) (n_nodes), parallel hosts: STICKSLIP_NODE_...; null: all own
  end type

  ! What stickslip_interface_states reports per non-mortar node; what stays null is not wanted.
  type, bind(C) :: stickslip_states
    integer(c_int64_t) :: struct_size = stickslip_states_size
    type(c_ptr) :: state = c_null_ptr              ! integer(c_int32_t) (n1): STICKSLIP_STATE_...
    type(c_ptr) :: normal = c_null_ptr             ! real(c_double) (3, n1): nu
    type(c_ptr) :: traction = c_null_ptr           ! (3, n1): projected traction p [F/L^2]
    type(c_ptr) :: gap = c_null_ptr                ! (n1): weighted gap [L^3]
    type(c_ptr) :: slip = c_null_ptr               ! (3, n1): slip since the first configuration [L]
    type(c_ptr) :: coverage = c_null_ptr           ! (n1): covered area [L^2]
    type(c_ptr) :: area = c_null_ptr               ! (n1): full tributary area M_A [L^2]
    type(c_ptr) :: dissipation = c_null_ptr        ! (n1): work of friction in this step [F L]
    type(c_ptr) :: augmentation = c_null_ptr       ! (n1): r_A [F/L^5]
    type(c_ptr) :: share = c_null_ptr              ! (n1): closed part of what is covered [-]
    type(c_ptr) :: worn = c_null_ptr               ! (n1): depth that is worn off [L]
    type(c_ptr) :: worn_volume = c_null_ptr        ! (n1): volume likewise [L^3]
    type(c_ptr) :: damage = c_null_ptr             ! (n1): of the bond, 0 to 1 [-]
    type(c_ptr) :: bond_loss = c_null_ptr          ! (n1): work that the bond has lost an area [F/L]
  end type

  ! What an interface has done since its creation.
  type, bind(C) :: stickslip_counters
    integer(c_int64_t) :: struct_size = stickslip_counters_size
    integer(c_int64_t) :: pairs_tested = 0
    integer(c_int64_t) :: pairs_clipped = 0
    integer(c_int64_t) :: pairs_integrated = 0
    integer(c_int64_t) :: pairs_linearised = 0
    integer(c_int64_t) :: searches = 0
    integer(c_int64_t) :: pairs_active = 0
    integer(c_int64_t) :: bytes = 0
    real(c_double) :: seconds_search = 0
    real(c_double) :: seconds_integration = 0
    real(c_double) :: seconds_assembly = 0
    integer(c_int64_t) :: pairs_reused = 0         ! frozen weights that served once more
    integer(c_int64_t) :: nodes_slipping = 0       ! slip increments computed
    integer(c_int64_t) :: evaluations_apart = 0    ! evaluations that found the surfaces apart
    integer(c_int64_t) :: commits_apart = 0        ! commits that did
    integer(c_int64_t) :: multipliers = 0          ! multiplier equations
    integer(c_int64_t) :: nodes_evaluated = 0      ! nodes that the law was asked about, one a node and point
    integer(c_int64_t) :: nodes_frictional = 0     ! at the last evaluation, adding up to n1: covered, with friction
    integer(c_int64_t) :: nodes_frictionless = 0   ! covered, without friction
    integer(c_int64_t) :: nodes_new = 0            ! covered now, not at t_n: without friction for this step
    integer(c_int64_t) :: nodes_tied = 0           ! covered and tied
    integer(c_int64_t) :: nodes_uncovered = 0      ! not covered
    integer(c_int64_t) :: nodes_left_out = 0       ! not covered, and the law was not asked
    integer(c_int64_t) :: boxes_visited = 0        ! boxes that the searches compared
    integer(c_int64_t) :: nodes_carried = 0        ! covered, and carried by neighbours: counts with nodes_...
  end type

  ! What stickslip_interface_report finds; an array that stays null is not wanted.
  type, bind(C) :: stickslip_report
    integer(c_int64_t) :: struct_size = stickslip_report_size
    type(c_ptr) :: cover = c_null_ptr              ! integer(c_int32_t) (n1): STICKSLIP_COVER_...
    type(c_ptr) :: fraction = c_null_ptr           ! real(c_double) (n1): covered / full area
    type(c_ptr) :: layers = c_null_ptr             ! integer(c_int32_t) (n1): of the mortar surface
    type(c_ptr) :: facets = c_null_ptr             ! integer(c_int64_t) (n1): mortar facets that overlap
    type(c_ptr) :: text = c_null_ptr               ! character(kind=c_char) (text_capacity): in sentences
    integer(c_int64_t) :: text_capacity = 0
    integer(c_int64_t) :: nodes_none = 0           ! outputs: how many nodes of each cover
    integer(c_int64_t) :: nodes_part = 0
    integer(c_int64_t) :: nodes_full = 0
    integer(c_int64_t) :: nodes_several = 0
    integer(c_int32_t) :: finding = STICKSLIP_FINDING_NONE ! output
    integer(c_int32_t) :: reserved = 0
    real(c_double) :: penetration = 0              ! output: the deepest [L]
  end type

  ! What stickslip_interface_diagnose finds; an array that stays null is not wanted. Nodes and facets in the index base,
  ! -1: none.
  type, bind(C) :: stickslip_diagnosis
    integer(c_int64_t) :: struct_size = stickslip_diagnosis_size
    type(c_ptr) :: state = c_null_ptr              ! integer(c_int32_t) (n1): in: of the last iteration, or -1; out: now
    type(c_ptr) :: suspect_nodes = c_null_ptr      ! integer(c_int64_t) (suspect_capacity)
    type(c_ptr) :: suspect_directions = c_null_ptr ! real(c_double) (3, suspect_capacity)
    type(c_ptr) :: suspect_ratios = c_null_ptr     ! real(c_double) (suspect_capacity): row over an ordinary row
    type(c_ptr) :: suspect_causes = c_null_ptr     ! integer(c_int32_t) (suspect_capacity): STICKSLIP_CAUSE_...
    integer(c_int64_t) :: suspect_capacity = 0
    type(c_ptr) :: text = c_null_ptr               ! character(kind=c_char) (text_capacity): in sentences
    integer(c_int64_t) :: text_capacity = 0
    integer(c_int64_t) :: suspects = 0             ! outputs from here on: how many, with room or without
    integer(c_int64_t) :: state_changes = 0        ! nodes whose state differs from the one given
    integer(c_int64_t) :: nodes_gap = 0
    integer(c_int64_t) :: nodes_stick = 0
    integer(c_int64_t) :: nodes_slip = 0
    integer(c_int64_t) :: covered_node = -1        ! covered least of those that are covered,
    real(c_double) :: covered_fraction = 0         ! to this fraction
    real(c_double) :: overlap = 0                  ! smallest overlap over the smaller facet's area,
    integer(c_int64_t) :: overlap_facets(2) = -1   ! of these facets
    real(c_double) :: warp = 0                     ! largest distance of a node from its facet's plane, over the edge
    integer(c_int64_t) :: warp_facets(2) = -1
    real(c_double) :: angle = 0                    ! largest angle between the facets' planes
    integer(c_int64_t) :: angle_facets(2) = -1
    real(c_double) :: error = 0                    ! largest error of a weight over the facet's area
    integer(c_int64_t) :: error_facets(2) = -1
  end type

  ! A pair of facets, non-mortar first. Node order: right-hand, seen from outside each body; of a line: its direction, turned
  ! from the first axis towards the second, points into the body. A line's arrays have 2 in place of 3 in their first dimension.
  type, bind(C) :: stickslip_pair
    integer(c_int64_t) :: struct_size = stickslip_pair_size
    integer(c_int32_t) :: n1 = 0                   ! 3 (tri3) or 4 (quad4); 6, 8, 9 where quadratic facets are taken
    integer(c_int32_t) :: n2 = 0
    type(c_ptr) :: x1 = c_null_ptr                 ! real(c_double) (3, n1) [L]
    type(c_ptr) :: x2 = c_null_ptr                 ! real(c_double) (3, n2) [L]
    integer(c_int32_t) :: quadrature = STICKSLIP_QUADRATURE_DEGREE_5
    integer(c_int32_t) :: layout = STICKSLIP_LAYOUT_COLUMN_MAJOR ! of the tangent: k(row, column)
    integer(c_int64_t) :: element_points = 0       ! 0: overlaps; 2 to 10: points along a side
    type(c_ptr) :: neighbour_normals = c_null_ptr  ! real(c_double) (3, n1): of the facets beyond the edges, 0: none
    integer(c_int32_t) :: multiplier_space = STICKSLIP_SPACE_CORNER ! of a quadratic non-mortar facet or a line3
    integer(c_int32_t) :: model = STICKSLIP_MODEL_SOLID ! the others: lines, n1, n2 2 or 3, x1(2, n1), x2(2, n2)
    real(c_double) :: thickness = 0                ! of STICKSLIP_MODEL_PLANE alone [L]; 0: 1
  end type

  ! The law's answer for one node. Matrices are row-major in C, so dp_dlambda(j, i) = dp_i / dlambda_j.
  type, bind(C) :: stickslip_node_response
    integer(c_int64_t) :: struct_size = stickslip_node_response_size
    integer(c_int32_t) :: state = STICKSLIP_STATE_GAP
    integer(c_int32_t) :: reserved = 0
    real(c_double) :: traction(3) = 0              ! projected traction p [F/L^2]
    real(c_double) :: row(3) = 0                   ! multiplier row c = -(lambda - p) / r [L^3]
    real(c_double) :: gap_normal = 0               ! g_N = nu . g > 0: open [L^3]
    real(c_double) :: slip(3) = 0                  ! slip increment g_T [L^3]
    real(c_double) :: sigma(3) = 0                 ! augmented traction lambda + r g [F/L^2]
    real(c_double) :: dp_dlambda(3, 3) = 0
    real(c_double) :: drow_dlambda(3, 3) = 0       ! [L^5/F]
    real(c_double) :: drow_dnow(3, 3) = 0          ! dc / dg[n_{n+1}, x_{n+1}]
    real(c_double) :: drow_dprevious(3, 3) = 0     ! dc / dg[n_n, x_{n+1}]
  end type

  ! One non-mortar node: what is assembled over all its pairs, and its data.
  type, bind(C) :: stickslip_node
    integer(c_int64_t) :: struct_size = stickslip_node_size
    integer(c_int32_t) :: slip = STICKSLIP_SLIP_OBJECTIVE
    integer(c_int32_t) :: n_directions = 0         ! number of prescribed directions, 0 to 2
    real(c_double) :: lambda(3) = 0                ! multiplier [F/L^2]
    real(c_double) :: normal(3) = 0                ! nu(t_n), unit, INTO the non-mortar body
    real(c_double) :: augmentation = 0             ! r > 0 [F/L^5]
    real(c_double) :: mu = 0
    real(c_double) :: coverage = 0                 ! covered area now [L^2]
    real(c_double) :: coverage_previous = 0        ! covered area at t_n [L^2]; 0: pass mu = 0 for that one step
    real(c_double) :: coverage_min = 0             ! [L^2]; 1e-8 of the node's full area is a good choice
    real(c_double) :: gap_now(3) = 0               ! g[n_{n+1}, x_{n+1}] [L^3]
    real(c_double) :: gap_previous(3) = 0          ! g[n_n, x_{n+1}] [L^3]
    real(c_double) :: gap_committed(3) = 0         ! g[n_n, x_n] [L^3]; read by STICKSLIP_SLIP_INCREMENT only
    real(c_double) :: directions(3, 2) = 0         ! orthonormal, one a column, orthogonal to the normal
    integer(c_int32_t) :: friction = STICKSLIP_FRICTION_COULOMB
    integer(c_int32_t) :: reserved = 0
    real(c_double) :: shear_limit = 0              ! largest shear traction, > 0 with TRESCA [F/L^2]
  end type

  ! A non-mortar facet with all the mortar facets that it overlaps, or overlapped at t_n.
  type, bind(C) :: stickslip_facet
    integer(c_int64_t) :: struct_size = stickslip_facet_size
    integer(c_int32_t) :: n1 = 0                   ! 3 (tri3) or 4 (quad4)
    integer(c_int32_t) :: quadrature = STICKSLIP_QUADRATURE_DEGREE_5
    integer(c_int32_t) :: layout = STICKSLIP_LAYOUT_COLUMN_MAJOR ! of the tangent: k(row, column)
    integer(c_int32_t) :: reserved = 0
    integer(c_int64_t) :: n_pairs = 0              ! mortar facets
    type(c_ptr) :: x1 = c_null_ptr                 ! real(c_double) (3, n1) [L]
    type(c_ptr) :: n2 = c_null_ptr                 ! integer(c_int32_t) (n_pairs)
    type(c_ptr) :: x2 = c_null_ptr                 ! real(c_double) (3, sum(n2)), one mortar facet after the other [L]
    integer(c_int64_t) :: element_points = 0       ! 0: overlaps; 2 to 10: points along a side
    type(c_ptr) :: neighbour_normals = c_null_ptr  ! real(c_double) (3, n1): of the facets beyond the edges, 0: none
  end type

  ! What stickslip_interface_equilibrium finds. Nodes in the index base, -1: all is zero.
  type, bind(C) :: stickslip_equilibrium
    integer(c_int64_t) :: struct_size = stickslip_equilibrium_size
    real(c_double) :: modulus = 0                  ! input: E of the softer body; 0: not known
    real(c_double) :: least_traction = 0           ! input: traction_scale is at least this
    real(c_double) :: gap = 0                      ! outputs from here on: largest penetration or opening [L],
    real(c_double) :: gap_scale = 0                ! and what to compare it with
    real(c_double) :: traction = 0                 ! largest traction that the law forbids [F/L^2]
    real(c_double) :: traction_scale = 0
    real(c_double) :: slip = 0                     ! largest slip of a node that sticks [L]
    real(c_double) :: slip_scale = 0
    integer(c_int64_t) :: gap_node = -1
    integer(c_int64_t) :: traction_node = -1
    integer(c_int64_t) :: slip_node = -1
    real(c_double) :: slide = 0                    ! since frozen weights were made [L]; compare with half of slide_scale
    real(c_double) :: slide_scale = 0              ! size of the facets around the node [L]
    integer(c_int64_t) :: slide_node = -1
    real(c_double) :: turn = 0                     ! since weights of the reference were made, by the part of the pressure [rad]
    integer(c_int64_t) :: turn_node = -1
    real(c_double) :: lag = 0                      ! of tractions, by the normals of now [F/L^2]; compare with traction_scale
    integer(c_int64_t) :: lag_node = -1
    real(c_double) :: lag_force = 0                ! the same times area, summed up over the nodes [F]
    real(c_double) :: lag_force_scale = 0
    real(c_double) :: penetration = 0              ! real overlap at a point [L]
    real(c_double) :: penetration_scale = 0
    integer(c_int64_t) :: penetration_node = -1
    real(c_double) :: apart = 0                    ! real distance where a node presses [L]
    real(c_double) :: apart_scale = 0
    integer(c_int64_t) :: apart_node = -1
  end type

  ! A rigid body: nodes that move with a reference point. Of lines (dimension 2) vectors have two numbers.
  type, bind(C) :: stickslip_rigid_body
    integer(c_int64_t) :: struct_size = stickslip_rigid_body_size
    integer(c_int32_t) :: dimension = 3            ! numbers of a node: 3, or 2 of lines
    integer(c_int32_t) :: reserved = 0             ! 0
    integer(c_int64_t) :: n_nodes = 0
    type(c_ptr) :: coordinates = c_null_ptr        ! real(c_double) (dimension, n_nodes), first configuration [L]
    type(c_ptr) :: point = c_null_ptr              ! real(c_double) (dimension): the reference point [L]
    type(c_ptr) :: node_equations = c_null_ptr     ! integer(c_int64_t) (dimension, n_nodes): of the nodal matrix; -1: none
    type(c_ptr) :: equations = c_null_ptr          ! integer(c_int64_t) (6), of lines (3): displacement, rotation; -1: prescribed
  end type

  ! Its motion since the first configuration: x = P + u + exp[theta] R (X - P).
  type, bind(C) :: stickslip_rigid_motion
    integer(c_int64_t) :: struct_size = stickslip_rigid_motion_size
    real(c_double) :: displacement(3) = 0          ! u [L]
    real(c_double) :: rotation(3) = 0              ! theta of the step: axis times angle, at most pi
    real(c_double) :: turned(9) = 0                ! R at t_n, row by row; zeros alone: not at all
    integer(c_int32_t) :: arms = 0                 ! STICKSLIP_RIGID_ARMS_...
    integer(c_int32_t) :: reserved = 0             ! 0
  end type

  ! A law of the library in place of Coulomb's.
  type, bind(C) :: stickslip_law
    integer(c_int64_t) :: struct_size = stickslip_law_size
    integer(c_int32_t) :: kind = STICKSLIP_LAW_COULOMB
    integer(c_int32_t) :: reserved = 0             ! 0
    real(c_double) :: cohesion = 0                 ! COHESION: c >= 0 [F/L^2]
    real(c_double) :: mu_after = 0                 ! WEAKENING: the coefficient from the critical slip on
    real(c_double) :: critical_slip = 0            ! WEAKENING: > 0 [L]
    real(c_double) :: mu_across = 0                ! ORTHOTROPIC: the coefficient across the direction, > 0
    real(c_double) :: direction(3) = 0             ! ORTHOTROPIC: along which mu counts, any length but 0
    real(c_double) :: critical_rate = 0            ! RATE: the velocity over which 1/e is left, > 0 [L/T]
    real(c_double) :: time = 0                     ! RATE: how long the step takes, > 0 [T]
  end type

  ! What a law of the host's is asked about a node.
  type, bind(C) :: stickslip_law_point
    integer(c_int64_t) :: struct_size = stickslip_law_point_size
    integer(c_int64_t) :: node = 0                 ! counted from options%index_base
    real(c_double) :: normal = 0                   ! sigma_N <= 0 [F/L^2]
    real(c_double) :: slip(3) = 0                  ! of this step [L]
    real(c_double) :: slip_before(3) = 0           ! before it [L]
    real(c_double) :: direction(3) = 0             ! where the node would slip to: a unit vector, or 0
    real(c_double) :: mu = 0
  end type

  ! What it answers. Before the call threshold is NaN, and the derivatives are 0.
  type, bind(C) :: stickslip_law_answer
    integer(c_int64_t) :: struct_size = stickslip_law_answer_size
    real(c_double) :: threshold = 0                ! k >= 0 [F/L^2]
    real(c_double) :: dthreshold_dnormal = 0       ! <= 0
    real(c_double) :: dthreshold_dslip(3) = 0      ! [F/L^3]
  end type

  ! What lies between the surfaces, or becomes of them: what is 0 is not there.
  type, bind(C) :: stickslip_layer
    integer(c_int64_t) :: struct_size = stickslip_layer_size
    integer(c_int64_t) :: n_overclosure = 0        ! points of the table: 0, or at least 2
    type(c_ptr) :: overclosure = c_null_ptr        ! real(c_double) (n_overclosure): growing [L]
    type(c_ptr) :: pressure = c_null_ptr           ! real(c_double) (n_overclosure): growing from 0 [F/L^2]
    real(c_double) :: wear = 0                     ! depth a unit of pressure and of slip [L^2/F]
    real(c_double) :: bond_stiffness = 0           ! traction an opening, before damage [F/L^3]
    real(c_double) :: bond_strength = 0            ! the largest in tension [F/L^2]
    real(c_double) :: bond_toughness = 0           ! work that parts an area [F/L]
    real(c_double) :: bond_shear = 0               ! the largest in shear over that in tension
  end type

  ! How heat crosses an interface: per area h (T1 - T2) with
  ! h = contact f(p / pressure) + (constant + gas / (g + gas_gap)) b(g / reach). T: a time.
  type, bind(C) :: stickslip_heat
    integer(c_int64_t) :: struct_size = stickslip_heat_size
    real(c_double) :: contact = 0                  ! at the reference pressure [F/(L T K)]
    real(c_double) :: pressure = 0                 ! that pressure, > 0 where contact is [F/L^2]
    real(c_double) :: exponent = 0                 ! > 0 where contact is, at most 2
    real(c_double) :: constant = 0                 ! at any pressure, within reach [F/(L T K)]
    real(c_double) :: gas = 0                      ! conductivity of what fills the gap [F/(T K)]
    real(c_double) :: gas_gap = 0                  ! what touching surfaces count as a gap, > 0 where gas is [L]
    real(c_double) :: reach = 0                    ! gaps from which on neither passes anything [L]
    real(c_double) :: share = 0                    ! of friction's heat that goes into the non-mortar body
    real(c_double) :: time = 0                     ! that the step takes [T]; 0: friction makes no heat
  end type

  ! What passes through the non-mortar nodes: c_loc of real(c_double) (n1) each, or c_null_ptr.
  type, bind(C) :: stickslip_heat_nodes
    integer(c_int64_t) :: struct_size = stickslip_heat_nodes_size
    type(c_ptr) :: conductance = c_null_ptr        ! h [F/(L T K)]
    type(c_ptr) :: flux = c_null_ptr               ! h times the mean jump [F/(L T)]
    type(c_ptr) :: jump = c_null_ptr               ! the mean jump of temperature [K]
    type(c_ptr) :: friction = c_null_ptr           ! the heat of friction [F L/T]
    type(c_ptr) :: area = c_null_ptr               ! that the means are of [L^2]
  end type

  type, bind(C) :: stickslip_gradient
    integer(c_int64_t) :: struct_size = stickslip_gradient_size
    type(c_ptr) :: previous1 = c_null_ptr
    type(c_ptr) :: previous2 = c_null_ptr
    type(c_ptr) :: now1 = c_null_ptr
    type(c_ptr) :: now2 = c_null_ptr
    type(c_ptr) :: friction = c_null_ptr
    type(c_ptr) :: shear_limit = c_null_ptr
    type(c_ptr) :: offsets1 = c_null_ptr
    type(c_ptr) :: offsets2 = c_null_ptr
  end type

  type, bind(C) :: stickslip_direction
    integer(c_int64_t) :: struct_size = stickslip_direction_size
    type(c_ptr) :: previous1 = c_null_ptr
    type(c_ptr) :: previous2 = c_null_ptr
    type(c_ptr) :: now1 = c_null_ptr
    type(c_ptr) :: now2 = c_null_ptr
    type(c_ptr) :: friction = c_null_ptr
    type(c_ptr) :: shear_limit = c_null_ptr
    type(c_ptr) :: offsets1 = c_null_ptr
    type(c_ptr) :: offsets2 = c_null_ptr
  end type

  ! What stickslip_skin_facets tells of each facet; what stays null is not wanted.
  type, bind(C) :: stickslip_skin_sides
    integer(c_int64_t) :: struct_size = stickslip_skin_sides_size
    type(c_ptr) :: side = c_null_ptr               ! integer(c_int32_t) (n_facets): STICKSLIP_SKIN_...
    type(c_ptr) :: piece = c_null_ptr              ! integer(c_int64_t) (n_facets): of a non-mortar facet, from 0; -1 of the others
    type(c_ptr) :: partner = c_null_ptr            ! integer(c_int64_t) (n_facets): the nearest facet in reach; -1: none
    type(c_ptr) :: distance = c_null_ptr           ! real(c_double) (n_facets): how far it is at t_n, negative: in each other [L]
    type(c_ptr) :: body = c_null_ptr               ! integer(c_int64_t) (n_facets): the number of its body
  end type

  ! What a skin has found in this step, and done since its creation.
  type, bind(C) :: stickslip_skin_summary
    integer(c_int64_t) :: struct_size = stickslip_skin_summary_size
    integer(c_int64_t) :: bodies = 0
    integer(c_int64_t) :: pieces = 0               ! interfaces of this step
    integer(c_int64_t) :: pairs = 0                ! pairs of facets that may touch in this step
    integer(c_int64_t) :: contradictions = 0       ! pairs that could not be put on different sides; none is known to occur
    integer(c_int64_t) :: made = 0                 ! interfaces made since creation
    integer(c_int64_t) :: exchanged = 0            ! facets in contact that have exchanged their side
    integer(c_int64_t) :: missed = 0               ! steps refused since facets met that were out of reach
  end type

  interface
    ! Version of the library, "major.minor.patch", as a C string.
    type(c_ptr) function stickslip_version() bind(C)
      import :: c_ptr
    end function

    ! How the library was built, as a C string: words "name=value", of version, commit, target, profile, compiler, kernels.
    type(c_ptr) function stickslip_build() bind(C)
      import :: c_ptr
    end function

    ! The thread's last refusal in words, as a C string; until the next call. Fortran reads it more easily with
    ! stickslip_last_error_padded.
    type(c_ptr) function stickslip_last_error_message() bind(C)
      import :: c_ptr
    end function

    ! The same in a character variable, cut or filled up with blanks: (text, len(text, c_int64_t)).
    integer(c_int32_t) function stickslip_last_error_padded(text, length) bind(C)
      import :: c_char, c_int32_t, c_int64_t
      character(kind=c_char), intent(inout) :: text(*)
      integer(c_int64_t), value :: length
    end function

    ! A short text for any status number, as a C string.
    type(c_ptr) function stickslip_status_string(status) bind(C)
      import :: c_int32_t, c_ptr
      integer(c_int32_t), value :: status
    end function

    ! Writes the defaults: (options, stickslip_options_size). Then set options%index_base = 1.
    integer(c_int32_t) function stickslip_options_init(options, struct_size) bind(C)
      import :: c_int32_t, c_int64_t, stickslip_options
      type(stickslip_options), intent(inout) :: options
      integer(c_int64_t), value :: struct_size
    end function

    ! After stickslip_options_init: the method is that of the paper's element, standard multipliers with normals of the last commit.
    integer(c_int32_t) function stickslip_options_paper(options) bind(C)
      import :: c_int32_t, stickslip_options
      type(stickslip_options), intent(inout) :: options
    end function

    ! The method of an interface with these options, with what the library chooses for weights, basis and normals.
    integer(c_int32_t) function stickslip_options_method(options, method) bind(C)
      import :: c_int32_t, stickslip_options, stickslip_method
      type(stickslip_options), intent(in) :: options
      type(stickslip_method), intent(inout) :: method
    end function

    ! Splits the nodes on creases until no fan of facets around a node spans more than angle (radians):
    ! integer(c_int64_t) facet_nodes (as many as the surface has), originals(capacity), and count, the nodes of the new
    ! surface. Both null: only count. Copies that may be in contact together act without friction.
    integer(c_int32_t) function stickslip_surface_split_creases(surface, angle, index_base, capacity, facet_nodes, &
        originals, count) bind(C)
      import :: c_double, c_int32_t, c_int64_t, c_ptr, stickslip_surface
      type(stickslip_surface), intent(in) :: surface
      real(c_double), value :: angle
      integer(c_int32_t), value :: index_base
      integer(c_int64_t), value :: capacity
      type(c_ptr), value :: facet_nodes, originals
      integer(c_int64_t), intent(inout) :: count
    end function

    ! The same for the lines of a plane or axisymmetric model, with two coordinates a node.
    integer(c_int32_t) function stickslip_lines_split_creases(surface, angle, index_base, capacity, facet_nodes, &
        originals, count) bind(C)
      import :: c_double, c_int32_t, c_int64_t, c_ptr, stickslip_surface
      type(stickslip_surface), intent(in) :: surface
      real(c_double), value :: angle
      integer(c_int32_t), value :: index_base
      integer(c_int64_t), value :: capacity
      type(c_ptr), value :: facet_nodes, originals
      integer(c_int64_t), intent(inout) :: count
    end function

    ! Nodes that interfaces share: nonmortar_offsets(n_interfaces + 1), from 0, into nonmortar_nodes(*), the same of the
    ! mortar sides. integer(c_int64_t) nodes(capacity), claims(capacity), integer(c_int32_t) kinds(capacity), and count.
    ! All three null: only count.
    integer(c_int32_t) function stickslip_crosspoints_find(n_interfaces, nonmortar_offsets, nonmortar_nodes, &
        mortar_offsets, mortar_nodes, capacity, nodes, kinds, claims, count) bind(C)
      import :: c_int32_t, c_int64_t, c_ptr
      integer(c_int64_t), value :: n_interfaces
      integer(c_int64_t), intent(in) :: nonmortar_offsets(*), nonmortar_nodes(*), mortar_offsets(*), mortar_nodes(*)
      integer(c_int64_t), value :: capacity
      type(c_ptr), value :: nodes, kinds, claims
      integer(c_int64_t), intent(inout) :: count
    end function

    ! Creates an interface between two surfaces, whose coordinates are the first configuration and t_0. nonmortar: the
    ! side that stays covered; of two that do the softer, then the finer. The surfaces are copied. A handle that was in use must be destroyed first.
    integer(c_int32_t) function stickslip_interface_create(nonmortar, mortar, options, out) bind(C)
      import :: c_int32_t, stickslip_interface, stickslip_options, stickslip_surface
      type(stickslip_surface), intent(in) :: nonmortar, mortar
      type(stickslip_options), intent(in) :: options
      type(stickslip_interface), intent(inout) :: out
    end function

    ! Destroys an interface. One that was never created, or is destroyed already, is fine.
    integer(c_int32_t) function stickslip_interface_destroy(interface) bind(C)
      import :: c_int32_t, stickslip_interface
      type(stickslip_interface), intent(inout) :: interface
    end function

    ! Friction coefficient per non-mortar node, mu(n1).
    integer(c_int32_t) function stickslip_interface_set_friction(interface, mu) bind(C)
      import :: c_double, c_int32_t, stickslip_interface
      type(stickslip_interface), value :: interface
      real(c_double), intent(in) :: mu(*)
    end function

    ! Augmentation per non-mortar node, r(n1) [F/L^5]; null: the options' own.
    integer(c_int32_t) function stickslip_interface_set_augmentation(interface, r) bind(C)
      import :: c_int32_t, c_ptr, stickslip_interface
      type(stickslip_interface), value :: interface
      type(c_ptr), value :: r
    end function

    ! Normals per non-mortar node, normals(3, n1), unit and INTO the non-mortar body; null: the averaged ones.
    integer(c_int32_t) function stickslip_interface_set_normals(interface, normals) bind(C)
      import :: c_int32_t, c_ptr, stickslip_interface
      type(stickslip_interface), value :: interface
      type(c_ptr), value :: normals
    end function

    ! Directions prescribed on both sides: nodes(n), directions(3, n). Replaces all earlier ones; n = 0 clears.
    integer(c_int32_t) function stickslip_interface_set_constraints(interface, n, nodes, directions) bind(C)
      import :: c_double, c_int32_t, c_int64_t, stickslip_interface
      type(stickslip_interface), value :: interface
      integer(c_int64_t), value :: n
      integer(c_int64_t), intent(in) :: nodes(*)
      real(c_double), intent(in) :: directions(3, *)
    end function

    ! Takes x1(3, n1), x2(3, n2) as the configuration of t_n with nothing slipped yet.
    integer(c_int32_t) function stickslip_interface_set_previous(interface, x1, x2) bind(C)
      import :: c_double, c_int32_t, stickslip_interface
      type(stickslip_interface), value :: interface
      real(c_double), intent(in) :: x1(3, *), x2(3, *)
    end function

    ! Takes x1(3, n1), x2(3, n2) as t_n after so many commits; slip(3, n1) since the first configuration, null: none.
    integer(c_int32_t) function stickslip_interface_set_committed(interface, x1, x2, slip, commits) bind(C)
      import :: c_double, c_int32_t, c_int64_t, c_ptr, stickslip_interface
      type(stickslip_interface), value :: interface
      real(c_double), intent(in) :: x1(3, *), x2(3, *)
      type(c_ptr), value :: slip
      integer(c_int64_t), value :: commits
    end function

    ! Multipliers to start the first step with, lambda(3, n1), output.
    integer(c_int32_t) function stickslip_interface_initial_multipliers(interface, lambda) bind(C)
      import :: c_double, c_int32_t, stickslip_interface
      type(stickslip_interface), value :: interface
      real(c_double), intent(inout) :: lambda(3, *)
    end function

    ! Stage 1, assembled, for parallel hosts: sums(11, n1), output.
    integer(c_int32_t) function stickslip_interface_sums(interface, x1, x2, sums) bind(C)
      import :: c_double, c_int32_t, stickslip_interface, STICKSLIP_SUMS_PER_NODE
      type(stickslip_interface), value :: interface
      real(c_double), intent(in) :: x1(3, *), x2(3, *)
      real(c_double), intent(inout) :: sums(STICKSLIP_SUMS_PER_NODE, *)
    end function

    ! Stage 2: state and nodal results, written to the arrays that out points to. x1(3, n1), x2(3, n2), lambda(3, n1);
    ! sums(11, n1) of stickslip_interface_sums or null, as in all calls below. With STICKSLIP_FRICTION_NONE lambda and
    ! rows have n1 elements, one a node: give a vector.
    integer(c_int32_t) function stickslip_interface_states(interface, x1, x2, lambda, sums, out) bind(C)
      import :: c_double, c_int32_t, c_ptr, stickslip_interface, stickslip_states
      type(stickslip_interface), value :: interface
      real(c_double), intent(in) :: x1(3, *), x2(3, *), lambda(3, *)
      type(c_ptr), value :: sums
      type(stickslip_states), intent(in) :: out
    end function

    ! Residual in internal-force sign: add it to your internal forces. Outputs force1(3, n1), force2(3, n2),
    ! rows(3, n1).
    integer(c_int32_t) function stickslip_interface_residual(interface, x1, x2, lambda, sums, force1, force2, rows) &
        bind(C)
      import :: c_double, c_int32_t, c_ptr, stickslip_interface
      type(stickslip_interface), value :: interface
      real(c_double), intent(in) :: x1(3, *), x2(3, *), lambda(3, *)
      type(c_ptr), value :: sums
      real(c_double), intent(inout) :: force1(3, *), force2(3, *), rows(3, *)
    end function

    ! The exact tangent as triplets in your equation numbers, sorted by rows, each entry once: integer(c_int64_t)
    ! rows(capacity), columns(capacity), real(c_double) values(capacity), and count. All three null: only count.
    integer(c_int32_t) function stickslip_interface_tangent_coo(interface, x1, x2, lambda, sums, capacity, rows, &
        columns, values, count) bind(C)
      import :: c_double, c_int32_t, c_int64_t, c_ptr, stickslip_interface
      type(stickslip_interface), value :: interface
      real(c_double), intent(in) :: x1(3, *), x2(3, *), lambda(3, *)
      type(c_ptr), value :: sums
      integer(c_int64_t), value :: capacity
      type(c_ptr), value :: rows, columns, values
      integer(c_int64_t), intent(inout) :: count
    end function

    ! Adds the exact tangent into your compressed sparse row matrix: row_offsets(n_rows + 1), starting at the index
    ! base, columns and values.
    integer(c_int32_t) function stickslip_interface_tangent_csr(interface, x1, x2, lambda, sums, n_rows, row_offsets, &
        columns, values) bind(C)
      import :: c_double, c_int32_t, c_int64_t, c_ptr, stickslip_interface
      type(stickslip_interface), value :: interface
      real(c_double), intent(in) :: x1(3, *), x2(3, *), lambda(3, *)
      type(c_ptr), value :: sums
      integer(c_int64_t), value :: n_rows
      integer(c_int64_t), intent(in) :: row_offsets(*), columns(*)
      real(c_double), intent(inout) :: values(*)
    end function

    ! Entries of any tangent while the surfaces slide by less than a quarter of a facet, each once: integer(c_int64_t)
    ! rows(capacity), columns(capacity), and count. Both null: only count.
    integer(c_int32_t) function stickslip_interface_pattern_coo(interface, x1, x2, capacity, rows, columns, count) &
        bind(C)
      import :: c_double, c_int32_t, c_int64_t, c_ptr, stickslip_interface
      type(stickslip_interface), value :: interface
      real(c_double), intent(in) :: x1(3, *), x2(3, *)
      integer(c_int64_t), value :: capacity
      type(c_ptr), value :: rows, columns
      integer(c_int64_t), intent(inout) :: count
    end function

    ! Makes the plan of the tangent, which the handle keeps: its entries once, pairs being STICKSLIP_PLAN_... Outputs: rows,
    ! how many equations have entries, and count, how many entries. Make it again after STICKSLIP_MISSING_ENTRY.
    integer(c_int32_t) function stickslip_interface_plan(interface, x1, x2, pairs, rows, count) bind(C)
      import :: c_double, c_int32_t, c_int64_t, stickslip_interface
      type(stickslip_interface), value :: interface
      real(c_double), intent(in) :: x1(3, *), x2(3, *)
      integer(c_int32_t), value :: pairs
      integer(c_int64_t), intent(inout) :: rows, count
    end function

    ! The entries of a plan, STICKSLIP_ENTRIES_..., sorted by rows: rows(capacity), columns(capacity).
    integer(c_int32_t) function stickslip_interface_plan_coo(interface, entries, capacity, rows, columns) bind(C)
      import :: c_int32_t, c_int64_t, stickslip_interface
      type(stickslip_interface), value :: interface
      integer(c_int32_t), value :: entries
      integer(c_int64_t), value :: capacity
      integer(c_int64_t), intent(inout) :: rows(*), columns(*)
    end function

    ! The same in 32 bits.
    integer(c_int32_t) function stickslip_interface_plan_coo32(interface, entries, capacity, rows, columns) bind(C)
      import :: c_int32_t, c_int64_t, stickslip_interface
      type(stickslip_interface), value :: interface
      integer(c_int32_t), value :: entries
      integer(c_int64_t), value :: capacity
      integer(c_int32_t), intent(inout) :: rows(*), columns(*)
    end function

    ! The entries of a plan as compressed sparse rows: the equations that have entries, where the columns of each begin,
    ! one more at the end, from the index base, and columns(capacity).
    integer(c_int32_t) function stickslip_interface_plan_csr(interface, entries, capacity, rows, row_offsets, columns) &
        bind(C)
      import :: c_int32_t, c_int64_t, stickslip_interface
      type(stickslip_interface), value :: interface
      integer(c_int32_t), value :: entries
      integer(c_int64_t), value :: capacity
      integer(c_int64_t), intent(inout) :: rows(*), row_offsets(*), columns(*)
    end function

    ! The same in 32 bits.
    integer(c_int32_t) function stickslip_interface_plan_csr32(interface, entries, capacity, rows, row_offsets, columns) &
        bind(C)
      import :: c_int32_t, c_int64_t, stickslip_interface
      type(stickslip_interface), value :: interface
      integer(c_int32_t), value :: entries
      integer(c_int64_t), value :: capacity
      integer(c_int32_t), intent(inout) :: rows(*), row_offsets(*), columns(*)
    end function

    ! The exact tangent in the order of the plan's entries: values(capacity), overwritten.
    integer(c_int32_t) function stickslip_interface_plan_values(interface, x1, x2, lambda, sums, capacity, values) &
        bind(C)
      import :: c_double, c_int32_t, c_int64_t, c_ptr, stickslip_interface
      type(stickslip_interface), value :: interface
      real(c_double), intent(in) :: x1(3, *), x2(3, *), lambda(3, *)
      type(c_ptr), value :: sums
      integer(c_int64_t), value :: capacity
      real(c_double), intent(inout) :: values(*)
    end function

    ! Makes the plans of the pieces FORCES and CONSTRAINTS of a system without multipliers: rows(2) and counts(2).
    integer(c_int32_t) function stickslip_interface_condensed_plan(interface, x1, x2, pairs, rows, counts) bind(C)
      import :: c_double, c_int32_t, c_int64_t, stickslip_interface
      type(stickslip_interface), value :: interface
      real(c_double), intent(in) :: x1(3, *), x2(3, *)
      integer(c_int32_t), value :: pairs
      integer(c_int64_t), intent(inout) :: rows(2), counts(2)
    end function

    ! These pieces in the order of their plans: forces(counts(1)), constraints(counts(2)), overwritten.
    integer(c_int32_t) function stickslip_interface_condensed_values(interface, x1, x2, lambda, forces, constraints) &
        bind(C)
      import :: c_double, c_int32_t, stickslip_interface
      type(stickslip_interface), value :: interface
      real(c_double), intent(in) :: x1(3, *), x2(3, *), lambda(3, *)
      real(c_double), intent(inout) :: forces(*), constraints(*)
    end function

    ! Who carries weakly covered nodes in this step: integer(c_int64_t) nodes(capacity), carriers(capacity),
    ! real(c_double) weights(capacity), and count. All three null: only count.
    integer(c_int32_t) function stickslip_interface_carriers(interface, capacity, nodes, carriers, weights, count) &
        bind(C)
      import :: c_int32_t, c_int64_t, c_ptr, stickslip_interface
      type(stickslip_interface), value :: interface
      integer(c_int64_t), value :: capacity
      type(c_ptr), value :: nodes, carriers, weights
      integer(c_int64_t), intent(inout) :: count
    end function

    ! The multipliers of a system without them: lambda(3, n1), or a vector of n1 with STICKSLIP_FRICTION_NONE, output.
    ! host1(3, n1): the residual of your own forces at the non-mortar nodes, without contact.
    integer(c_int32_t) function stickslip_interface_condensed_multipliers(interface, x1, x2, host1, lambda) bind(C)
      import :: c_double, c_int32_t, stickslip_interface
      type(stickslip_interface), value :: interface
      real(c_double), intent(in) :: x1(3, *), x2(3, *), host1(3, *)
      real(c_double), intent(inout) :: lambda(3, *)
    end function

    ! The residual of a system without multipliers: rows1(3, n1) in place of your rows of the non-mortar nodes,
    ! force2(3, n2) to be added to those of the mortar nodes.
    integer(c_int32_t) function stickslip_interface_condensed_residual(interface, x1, x2, lambda, host1, rows1, &
        force2) bind(C)
      import :: c_double, c_int32_t, stickslip_interface
      type(stickslip_interface), value :: interface
      real(c_double), intent(in) :: x1(3, *), x2(3, *), lambda(3, *), host1(3, *)
      real(c_double), intent(inout) :: rows1(3, *), force2(3, *)
    end function

    ! A piece of the matrix of a system without multipliers, STICKSLIP_CONDENSED_..., as triplets like those of the
    ! tangent. With J your own matrix plus FORCES the matrix is J + ELIMINATION J + CONSTRAINTS.
    integer(c_int32_t) function stickslip_interface_condensed_coo(interface, x1, x2, lambda, piece, capacity, rows, &
        columns, values, count) bind(C)
      import :: c_double, c_int32_t, c_int64_t, c_ptr, stickslip_interface
      type(stickslip_interface), value :: interface
      real(c_double), intent(in) :: x1(3, *), x2(3, *), lambda(3, *)
      integer(c_int32_t), value :: piece
      integer(c_int64_t), value :: capacity
      type(c_ptr), value :: rows, columns, values
      integer(c_int64_t), intent(inout) :: count
    end function

    ! Turns your own matrix, compressed sparse rows, into that of the system without multipliers, in place.
    integer(c_int32_t) function stickslip_interface_condensed_csr(interface, x1, x2, lambda, n_rows, row_offsets, &
        columns, values) bind(C)
      import :: c_double, c_int32_t, c_int64_t, stickslip_interface
      type(stickslip_interface), value :: interface
      real(c_double), intent(in) :: x1(3, *), x2(3, *), lambda(3, *)
      integer(c_int64_t), value :: n_rows
      integer(c_int64_t), intent(in) :: row_offsets(*), columns(*)
      real(c_double), intent(inout) :: values(*)
    end function

    ! Entries that stickslip_interface_condensed_csr may need in your matrix while the surfaces slide by less than a
    ! quarter of a facet: integer(c_int64_t) entry_rows(capacity), entry_columns(capacity), and count. Both null: only count.
    integer(c_int32_t) function stickslip_interface_condensed_pattern(interface, x1, x2, n_rows, row_offsets, columns, &
        capacity, entry_rows, entry_columns, count) bind(C)
      import :: c_double, c_int32_t, c_int64_t, c_ptr, stickslip_interface
      type(stickslip_interface), value :: interface
      real(c_double), intent(in) :: x1(3, *), x2(3, *)
      integer(c_int64_t), value :: n_rows
      integer(c_int64_t), intent(in) :: row_offsets(*), columns(*)
      integer(c_int64_t), value :: capacity
      type(c_ptr), value :: entry_rows, entry_columns
      integer(c_int64_t), intent(inout) :: count
    end function

    ! How much of a step dx1(3, n1), dx2(3, n2) from x1(3, n1), x2(3, n2) may be taken before the surfaces pass through
    ! each other: fraction, above 0 and at most 1. penetration: over the shortest edges; 0: the default, 0.1.
    integer(c_int32_t) function stickslip_interface_step_limit(interface, x1, x2, dx1, dx2, penetration, fraction) &
        bind(C)
      import :: c_double, c_int32_t, stickslip_interface
      type(stickslip_interface), value :: interface
      real(c_double), intent(in) :: x1(3, *), x2(3, *), dx1(3, *), dx2(3, *)
      real(c_double), value :: penetration
      real(c_double), intent(inout) :: fraction
    end function

    ! Accepts a converged step: x1(3, n1), x2(3, n2), lambda(3, n1) become t_n.
    integer(c_int32_t) function stickslip_interface_commit(interface, x1, x2, lambda, sums) bind(C)
      import :: c_double, c_int32_t, c_ptr, stickslip_interface
      type(stickslip_interface), value :: interface
      real(c_double), intent(in) :: x1(3, *), x2(3, *), lambda(3, *)
      type(c_ptr), value :: sums
    end function

    ! Whether the commit would accept the step; nothing changes.
    integer(c_int32_t) function stickslip_interface_commit_check(interface, x1, x2, lambda, sums) bind(C)
      import :: c_double, c_int32_t, c_ptr, stickslip_interface
      type(stickslip_interface), value :: interface
      real(c_double), intent(in) :: x1(3, *), x2(3, *), lambda(3, *)
      type(c_ptr), value :: sums
    end function

    ! Undoes the last commit exactly.
    integer(c_int32_t) function stickslip_interface_rollback(interface) bind(C)
      import :: c_int32_t, stickslip_interface
      type(stickslip_interface), value :: interface
    end function

    ! Lengths of the arrays that hold the history now.
    integer(c_int32_t) function stickslip_interface_history_size(interface, n_integers, n_reals) bind(C)
      import :: c_int32_t, c_int64_t, stickslip_interface
      type(stickslip_interface), value :: interface
      integer(c_int64_t), intent(inout) :: n_integers, n_reals
    end function

    ! Writes the history to integers(n_integers) and reals(n_reals), for a restart file.
    integer(c_int32_t) function stickslip_interface_history_export(interface, n_integers, integers, n_reals, reals) &
        bind(C)
      import :: c_double, c_int32_t, c_int64_t, stickslip_interface
      type(stickslip_interface), value :: interface
      integer(c_int64_t), value :: n_integers
      integer(c_int64_t), intent(inout) :: integers(*)
      integer(c_int64_t), value :: n_reals
      real(c_double), intent(inout) :: reals(*)
    end function

    ! Replaces the history by an exported one of the same surfaces.
    integer(c_int32_t) function stickslip_interface_history_import(interface, n_integers, integers, n_reals, reals) &
        bind(C)
      import :: c_double, c_int32_t, c_int64_t, stickslip_interface
      type(stickslip_interface), value :: interface
      integer(c_int64_t), value :: n_integers
      integer(c_int64_t), intent(in) :: integers(*)
      integer(c_int64_t), value :: n_reals
      real(c_double), intent(in) :: reals(*)
    end function

    ! Reads the counters.
    integer(c_int32_t) function stickslip_interface_counters(interface, out) bind(C)
      import :: c_int32_t, stickslip_counters, stickslip_interface
      type(stickslip_interface), value :: interface
      type(stickslip_counters), intent(inout) :: out
    end function

    ! What the interface computes and why, one sentence an effect: (text, capacity), ended by c_null_char, cut where it is
    ! longer.
    integer(c_int32_t) function stickslip_interface_effects(interface, text, capacity) bind(C)
      import :: c_char, c_int32_t, c_int64_t, stickslip_interface
      type(stickslip_interface), value :: interface
      character(kind=c_char), intent(inout) :: text(*)
      integer(c_int64_t), value :: capacity
    end function

    ! Which nodes are covered at x1(3, n1), x2(3, n2), and what is amiss where none is; written to out and to the arrays
    ! that it points to.
    integer(c_int32_t) function stickslip_interface_report(interface, x1, x2, out) bind(C)
      import :: c_double, c_int32_t, stickslip_interface, stickslip_report
      type(stickslip_interface), value :: interface
      real(c_double), intent(in) :: x1(3, *), x2(3, *)
      type(stickslip_report), intent(inout) :: out
    end function

    ! What may be wrong at x1(3, n1), x2(3, n2), lambda(3, n1); written to out and to the arrays that it points to.
    integer(c_int32_t) function stickslip_interface_diagnose(interface, x1, x2, lambda, sums, out) bind(C)
      import :: c_double, c_int32_t, c_ptr, stickslip_interface, stickslip_diagnosis
      type(stickslip_interface), value :: interface
      real(c_double), intent(in) :: x1(3, *), x2(3, *), lambda(3, *)
      type(c_ptr), value :: sums
      type(stickslip_diagnosis), intent(inout) :: out
    end function

    ! A non-mortar facet's share of its nodes' normals and areas. x(3, n); outputs, each may be null: normals(3, n),
    ! areas(n), of a quadratic facet those of its corners.
    integer(c_int32_t) function stickslip_facet_geometry(n, x, normals, areas) bind(C)
      import :: c_double, c_int32_t, c_ptr
      integer(c_int32_t), value :: n
      real(c_double), intent(in) :: x(3, *)
      type(c_ptr), value :: normals, areas
    end function

    ! The unit normal of a facet's plane, out of its body, for neighbour_normals. x(3, n).
    integer(c_int32_t) function stickslip_facet_normal(n, x, normal) bind(C)
      import :: c_double, c_int32_t
      integer(c_int32_t), value :: n
      real(c_double), intent(in) :: x(3, *)
      real(c_double), intent(inout) :: normal(3)
    end function

    ! The nodal normal nu (unit, INTO the non-mortar body) from the sum of the corner normals around a node.
    integer(c_int32_t) function stickslip_node_normal(sum, normal) bind(C)
      import :: c_double, c_int32_t
      real(c_double), intent(in) :: sum(3)
      real(c_double), intent(inout) :: normal(3)
    end function

    ! Stage 1: the mortar weights of a pair. Outputs, each may be null: n_ab(n1, m) as (b, a), n_ac(n2, m) as (c, a)
    ! [L^2]; derivatives dn_ab(3 (n1 + n2), n1, m), dn_ac(3 (n1 + n2), n2, m) [L], first the coordinate of (x1, x2).
    ! m multipliers, at the first nodes: n1; of a quadratic facet with STICKSLIP_SPACE_CORNER its 3 or 4 corners, of a line3 its
    ! 2 ends. Lines: dn_ab(2 (n1 + n2), n1, m), dn_ac(2 (n1 + n2), n2, m).
    integer(c_int32_t) function stickslip_pair_weights(pair, n_ab, n_ac, dn_ab, dn_ac) bind(C)
      import :: c_int32_t, c_ptr, stickslip_pair
      type(stickslip_pair), intent(in) :: pair
      type(c_ptr), value :: n_ab, n_ac, dn_ab, dn_ac
    end function

    ! The weighted gap of a pair with any weights: n_ab(n1, m) as (b, a), n_ac(n2, m) as (c, a); gap(3, m), of lines
    ! gap(2, m), output.
    integer(c_int32_t) function stickslip_pair_gap(pair, n_ab, n_ac, gap) bind(C)
      import :: c_double, c_int32_t, stickslip_pair
      type(stickslip_pair), intent(in) :: pair
      real(c_double), intent(in) :: n_ab(*), n_ac(*)
      real(c_double), intent(inout) :: gap(3, *)
    end function

    ! Stage 3: a pair's nodal forces in internal-force sign. Weights as above; traction(3, m);
    ! force(3, n1 + n2), output. Lines: traction(2, m), force(2, n1 + n2).
    integer(c_int32_t) function stickslip_pair_residual(pair, n_ab, n_ac, traction, force) bind(C)
      import :: c_double, c_int32_t, stickslip_pair
      type(stickslip_pair), intent(in) :: pair
      real(c_double), intent(in) :: n_ab(*), n_ac(*), traction(3, *)
      real(c_double), intent(inout) :: force(3, *)
    end function

    ! Stage 3: a pair's share of the exact tangent in the multiplier form. Weights and derivatives as
    ! stickslip_pair_weights has them, null in pairs as the header says; traction(3, m); responses(m);
    ! row_scale(m), null: 1; k(ld, *), output, rows and columns: x1, x2, lambda. Lines: traction(2, m), 2 (n1 + n2 + m) rows.
    integer(c_int32_t) function stickslip_pair_tangent(pair, n_ab, n_ac, dn_ab, dn_ac, n_ab_previous, n_ac_previous, &
        traction, responses, row_scale, k, ld) bind(C)
      import :: c_double, c_int32_t, c_int64_t, c_ptr, stickslip_node_response, stickslip_pair
      type(stickslip_pair), intent(in) :: pair
      type(c_ptr), value :: n_ab, n_ac, dn_ab, dn_ac, n_ab_previous, n_ac_previous
      real(c_double), intent(in) :: traction(3, *)
      type(stickslip_node_response), intent(in) :: responses(*)
      type(c_ptr), value :: row_scale
      integer(c_int64_t), value :: ld
      real(c_double), intent(inout) :: k(ld, *)
    end function

    ! How many doubles the state of a pair takes, for stickslip_pair_begin.
    integer(c_int64_t) function stickslip_pair_state_size() bind(C)
      import :: c_int64_t
    end function

    ! Stage 1 with a state, real(c_double) state(capacity), which the other stages of the pair read: opaque, of this process,
    ! not to be stored. Outputs, each may be null: n_ab(n1, n1) as (b, a), n_ac(n2, n1) as (c, a) [L^2], gap(3, n1) [L^3].
    integer(c_int32_t) function stickslip_pair_begin(pair, capacity, state, n_ab, n_ac, gap) bind(C)
      import :: c_double, c_int32_t, c_int64_t, c_ptr, stickslip_pair
      type(stickslip_pair), intent(in) :: pair
      integer(c_int64_t), value :: capacity
      real(c_double), intent(inout) :: state(*)
      type(c_ptr), value :: n_ab, n_ac, gap
    end function

    ! The weighted gap(3, n1) [L^3] at the positions of a state with the weights of t_n, both null: with those of now.
    integer(c_int32_t) function stickslip_pair_state_gap(state, n_ab_previous, n_ac_previous, gap) bind(C)
      import :: c_double, c_int32_t, c_ptr
      real(c_double), intent(in) :: state(*)
      type(c_ptr), value :: n_ab_previous, n_ac_previous
      real(c_double), intent(inout) :: gap(3, *)
    end function

    ! Stage 3 with a state: force(3, n1 + n2) of traction(3, n1), as stickslip_pair_residual.
    integer(c_int32_t) function stickslip_pair_state_residual(state, traction, force) bind(C)
      import :: c_double, c_int32_t
      real(c_double), intent(in) :: state(*), traction(3, *)
      real(c_double), intent(inout) :: force(3, *)
    end function

    ! Stage 3 with a state: the tangent k(ld, *), as stickslip_pair_tangent with the weights of now and their derivatives.
    ! n_ab_previous, n_ac_previous: of t_n, both null where there are none; row_scale(n1), null: 1.
    integer(c_int32_t) function stickslip_pair_state_tangent(state, n_ab_previous, n_ac_previous, traction, responses, &
        row_scale, k, ld) bind(C)
      import :: c_double, c_int32_t, c_int64_t, c_ptr, stickslip_node_response
      real(c_double), intent(in) :: state(*), traction(3, *)
      type(c_ptr), value :: n_ab_previous, n_ac_previous, row_scale
      type(stickslip_node_response), intent(in) :: responses(*)
      integer(c_int64_t), value :: ld
      real(c_double), intent(inout) :: k(ld, *)
    end function

    ! Stage 2: gap, stick or slip of a node from the gaps assembled over ALL its pairs, with all derivatives.
    integer(c_int32_t) function stickslip_node_respond(node, response) bind(C)
      import :: c_int32_t, stickslip_node, stickslip_node_response
      type(stickslip_node), intent(in) :: node
      type(stickslip_node_response), intent(inout) :: response
    end function

    ! Stage 4: the node's own block, once per non-mortar node. Outputs, each may be null: row(3), block(3, 3), which is
    ! (row, column) with layout = STICKSLIP_LAYOUT_COLUMN_MAJOR.
    integer(c_int32_t) function stickslip_node_block(response, scale, layout, row, block) bind(C)
      import :: c_double, c_int32_t, c_ptr, stickslip_node_response
      type(stickslip_node_response), intent(in) :: response
      real(c_double), value :: scale
      integer(c_int32_t), value :: layout
      type(c_ptr), value :: row, block
    end function

    ! What eliminating a node's multiplier makes of its rows, for hosts without multipliers that assemble element by
    ! element: real(c_double) w(3, 3), row(3), row_scale, each or null.
    integer(c_int32_t) function stickslip_node_condense(node, response, layout, w, row, row_scale) bind(C)
      import :: c_int32_t, c_ptr, stickslip_node, stickslip_node_response
      type(stickslip_node), intent(in) :: node
      type(stickslip_node_response), intent(in) :: response
      integer(c_int32_t), value :: layout
      type(c_ptr), value :: w, row, row_scale
    end function

    ! Which normals evaluations use until the next commit, rollback or import: STICKSLIP_NORMALS_CURRENT, as after each of
    ! these, or STICKSLIP_NORMALS_COMMITTED for a robust first phase of a step, with which a commit refuses.
    integer(c_int32_t) function stickslip_interface_use_normals(interface, normals) bind(C)
      import :: c_int32_t, stickslip_interface
      type(stickslip_interface), value :: interface
      integer(c_int32_t), value :: normals
    end function

    ! Turns multipliers lambda(3, n1), in and out, as the normals turn from t_n to x1(3, n1): a start for Newton's method.
    integer(c_int32_t) function stickslip_interface_turn_multipliers(interface, x1, lambda) bind(C)
      import :: c_double, c_int32_t, stickslip_interface
      type(stickslip_interface), value :: interface
      real(c_double), intent(in) :: x1(3, *)
      real(c_double), intent(inout) :: lambda(3, *)
    end function

    ! Derivatives of a facet's corner normals m(i, k) with respect to its nodes x(j, l), to be summed over the facets
    ! around a node: derivatives(3, n, 3, n) as (j, l, i, k), output [1/L].
    integer(c_int32_t) function stickslip_facet_normal_derivatives(n, x, derivatives) bind(C)
      import :: c_double, c_int32_t
      integer(c_int32_t), value :: n
      real(c_double), intent(in) :: x(3, *)
      real(c_double), intent(inout) :: derivatives(*)
    end function

    ! How a node's answer turns with its normal, which is that of the sum of the corner normals around it. Outputs, each
    ! may be null: dnu_dsum(3, 3) [-], dp_dnormal(3, 3) [F/L^2], drow_dnormal(3, 3) [L^3], which are (row, column) with
    ! layout = STICKSLIP_LAYOUT_COLUMN_MAJOR.
    integer(c_int32_t) function stickslip_node_turn(node, sum, layout, dnu_dsum, dp_dnormal, drow_dnormal) bind(C)
      import :: c_double, c_int32_t, c_ptr, stickslip_node
      type(stickslip_node), intent(in) :: node
      real(c_double), intent(in) :: sum(3)
      integer(c_int32_t), value :: layout
      type(c_ptr), value :: dnu_dsum, dp_dnormal, drow_dnormal
    end function

    ! Stage 1b: dual multipliers of a facet x(3, n) with the sum mass(n, n) of its pairs' n_ab. Outputs, each may be null:
    ! fade; areas(n) [L^2]; coefficients(n, n) as (b, a).
    integer(c_int32_t) function stickslip_facet_dual(n, x, mass, fade, areas, coefficients) bind(C)
      import :: c_double, c_int32_t, c_ptr
      integer(c_int32_t), value :: n
      real(c_double), intent(in) :: x(3, *), mass(*)
      type(c_ptr), value :: fade, areas, coefficients
    end function

    ! Stage 1b: a pair's share of the dual weights, with the sum mass(n1, n1) of n_ab over all pairs of its facet. Outputs,
    ! each may be null: dual_ab(n1, n1) as (b, a), dual_ac(n2, n1) as (c, a) [L^2].
    integer(c_int32_t) function stickslip_pair_dual(pair, mass, n_ab, n_ac, dual_ab, dual_ac) bind(C)
      import :: c_double, c_int32_t, c_ptr, stickslip_pair
      type(stickslip_pair), intent(in) :: pair
      real(c_double), intent(in) :: mass(*), n_ab(*), n_ac(*)
      type(c_ptr), value :: dual_ab, dual_ac
    end function

    ! Stage 3 with dual multipliers: the share of a facet and all its pairs of the exact tangent, in place of
    ! stickslip_pair_tangent. n_ab(n1, n1, n_pairs), n_ac: (n2, n1) of one pair after the other, as stickslip_pair_weights
    ! gives them; n_ab_previous, n_ac_previous: the dual ones of t_n, both null where there are none; traction(3, n1);
    ! responses(n1); row_scale(n1), null: 1; k(ld, *), output, rows and columns: x1, x2 of one pair after the other, lambda.
    integer(c_int32_t) function stickslip_facet_tangent(facet, n_ab, n_ac, n_ab_previous, n_ac_previous, traction, responses, &
        row_scale, k, ld) bind(C)
      import :: c_double, c_int32_t, c_int64_t, c_ptr, stickslip_facet, stickslip_node_response
      type(stickslip_facet), intent(in) :: facet
      real(c_double), intent(in) :: n_ab(*), n_ac(*)
      type(c_ptr), value :: n_ab_previous, n_ac_previous
      real(c_double), intent(in) :: traction(3, *)
      type(stickslip_node_response), intent(in) :: responses(*)
      type(c_ptr), value :: row_scale
      integer(c_int64_t), value :: ld
      real(c_double), intent(inout) :: k(ld, *)
    end function

    ! How far x1(3, n1), x2(3, n2), lambda(3, n1) is from contact equilibrium, whatever the augmentation: for the test of
    ! convergence. out: two inputs and all outputs.
    integer(c_int32_t) function stickslip_interface_equilibrium(interface, x1, x2, lambda, sums, out) bind(C)
      import :: c_double, c_int32_t, c_ptr, stickslip_interface, stickslip_equilibrium
      type(stickslip_interface), value :: interface
      real(c_double), intent(in) :: x1(3, *), x2(3, *), lambda(3, *)
      type(c_ptr), value :: sums
      type(stickslip_equilibrium), intent(inout) :: out
    end function

    ! The same of one node, with its gaps summed over all pairs. Outputs, each a real(c_double) that may be null: gap,
    ! traction, slip.
    integer(c_int32_t) function stickslip_node_equilibrium(node, stiffness, rounding, gap, traction, slip) bind(C)
      import :: c_double, c_int32_t, c_ptr, stickslip_node
      type(stickslip_node), intent(in) :: node
      real(c_double), value :: stiffness, rounding
      type(c_ptr), value :: gap, traction, slip
    end function

    ! Offsets of the nodes of both sides, offsets1(n1), offsets2(n2) [L]; null: none. Positive ones open gaps.
    integer(c_int32_t) function stickslip_interface_set_offsets(interface, offsets1, offsets2) bind(C)
      import :: c_int32_t, c_ptr, stickslip_interface
      type(stickslip_interface), value :: interface
      type(c_ptr), value :: offsets1, offsets2
    end function

    ! Nodes of the first configuration within the tolerance of the mortar surface, moved onto it: coordinates(3, n1), gaps(n1),
    ! moved(n1), each or null.
    integer(c_int32_t) function stickslip_interface_adjust(interface, tolerance, coordinates, gaps, moved) bind(C)
      import :: c_double, c_int32_t, c_ptr, stickslip_interface
      type(stickslip_interface), value :: interface
      real(c_double), value :: tolerance
      type(c_ptr), value :: coordinates, gaps, moved
    end function

    ! Offsets that give a faceted surface its shape: point(3), direction(3), offsets(n1 or n2), output.
    integer(c_int32_t) function stickslip_interface_shape_offsets(interface, side, shape, radius, point, direction, offsets) &
        bind(C)
      import :: c_double, c_int32_t, stickslip_interface
      type(stickslip_interface), value :: interface
      integer(c_int32_t), value :: side, shape
      real(c_double), value :: radius
      real(c_double), intent(in) :: point(3), direction(3)
      real(c_double), intent(out) :: offsets(*)
    end function

    ! Positions x(dimension, n_nodes) of a rigid body's nodes: those of a reference point with a displacement and a rotation.
    integer(c_int32_t) function stickslip_rigid_positions(body, motion, x) bind(C)
      import :: c_double, c_int32_t, stickslip_rigid_body, stickslip_rigid_motion
      type(stickslip_rigid_body), intent(in) :: body
      type(stickslip_rigid_motion), intent(in) :: motion
      real(c_double), intent(inout) :: x(*)
    end function

    ! Force and moment about the reference point as it is now, resultant(6), of lines (3), of forces(dimension, n_nodes).
    integer(c_int32_t) function stickslip_rigid_resultant(body, motion, forces, resultant) bind(C)
      import :: c_double, c_int32_t, stickslip_rigid_body, stickslip_rigid_motion
      type(stickslip_rigid_body), intent(in) :: body
      type(stickslip_rigid_motion), intent(in) :: motion
      real(c_double), intent(in) :: forces(*)
      real(c_double), intent(inout) :: resultant(*)
    end function

    ! After a converged step: takes what the body has turned by in it into turned, and sets rotation to 0.
    integer(c_int32_t) function stickslip_rigid_turn(motion) bind(C)
      import :: c_int32_t, stickslip_rigid_motion
      type(stickslip_rigid_motion), intent(inout) :: motion
    end function

    ! Finds where the n_entries entries of a nodal matrix, rows(n_entries) and columns(n_entries), go where rigid bodies(n_bodies)
    ! have equations of their reference points in place of those of their nodes. count: entries of the outcome. The arrays are
    ! copied. A handle that was in use must be destroyed first.
    integer(c_int32_t) function stickslip_rigid_create(n_bodies, bodies, index_base, n_entries, rows, columns, out, count) bind(C)
      import :: c_int32_t, c_int64_t, stickslip_rigid, stickslip_rigid_body
      integer(c_int64_t), value :: n_bodies
      type(stickslip_rigid_body), intent(in) :: bodies(*)
      integer(c_int32_t), value :: index_base
      integer(c_int64_t), value :: n_entries
      integer(c_int64_t), intent(in) :: rows(*), columns(*)
      type(stickslip_rigid), intent(inout) :: out
      integer(c_int64_t), intent(inout) :: count
    end function

    ! Its entries rows(capacity), columns(capacity), by rows and within a row by columns, each once.
    integer(c_int32_t) function stickslip_rigid_coo(rigid, capacity, rows, columns) bind(C)
      import :: c_int32_t, c_int64_t, stickslip_rigid
      type(stickslip_rigid), value :: rigid
      integer(c_int64_t), value :: capacity
      integer(c_int64_t), intent(inout) :: rows(*), columns(*)
    end function

    ! Their values(count): exact derivatives. motions(n_bodies); forces: of the bodies' nodes, (dimension, n_nodes) of one body after
    ! the other; nodal(n_entries): the nodal matrix.
    integer(c_int32_t) function stickslip_rigid_values(rigid, motions, forces, nodal, values) bind(C)
      import :: c_double, c_int32_t, stickslip_rigid, stickslip_rigid_motion
      type(stickslip_rigid), value :: rigid
      type(stickslip_rigid_motion), intent(in) :: motions(*)
      real(c_double), intent(in) :: forces(*), nodal(*)
      real(c_double), intent(inout) :: values(*)
    end function

    ! Ends what stickslip_rigid_create made. One that was never created, or is destroyed already, is fine.
    integer(c_int32_t) function stickslip_rigid_destroy(rigid) bind(C)
      import :: c_int32_t, stickslip_rigid
      type(stickslip_rigid), intent(inout) :: rigid
    end function

    ! Takes a law of the library in place of Coulomb's; c_null_ptr, or c_loc of a stickslip_law with the TARGET attribute.
    integer(c_int32_t) function stickslip_interface_set_law(interface, law) bind(C)
      import :: c_int32_t, c_ptr, stickslip_interface
      type(stickslip_interface), value :: interface
      type(c_ptr), value :: law
    end function

    ! Takes a function of the host's as the law, c_funloc(law) of
    !   integer(c_int32_t) function law(user, point, states, answer, states_after) bind(C)
    !     type(c_ptr), value :: user
    !     type(stickslip_law_point), intent(in) :: point
    !     real(c_double), intent(in) :: states(*)
    !     type(stickslip_law_answer), intent(inout) :: answer
    !     real(c_double), intent(inout) :: states_after(*)
    ! which returns 0. It must not call the library with an interface.
    integer(c_int32_t) function stickslip_interface_set_threshold(interface, threshold, user, n_states) bind(C)
      import :: c_funptr, c_int32_t, c_int64_t, c_ptr, stickslip_interface
      type(stickslip_interface), value :: interface
      type(c_funptr), value :: threshold
      type(c_ptr), value :: user
      integer(c_int64_t), value :: n_states
    end function

    ! What the law remembers of the nodes at t_n: states(n), or c_null_ptr to count them alone.
    integer(c_int32_t) function stickslip_interface_law_states(interface, n, states, count) bind(C)
      import :: c_int32_t, c_int64_t, c_ptr, stickslip_interface
      type(stickslip_interface), value :: interface
      integer(c_int64_t), value :: n
      type(c_ptr), value :: states
      integer(c_int64_t), intent(inout) :: count
    end function

    ! Replaces that: states(n).
    integer(c_int32_t) function stickslip_interface_set_law_states(interface, n, states) bind(C)
      import :: c_double, c_int32_t, c_int64_t, stickslip_interface
      type(stickslip_interface), value :: interface
      integer(c_int64_t), value :: n
      real(c_double), intent(in) :: states(*)
    end function

    ! Takes what lies between the surfaces; c_null_ptr, or c_loc of a stickslip_layer with the TARGET attribute.
    integer(c_int32_t) function stickslip_interface_set_layer(interface, layer) bind(C)
      import :: c_int32_t, c_ptr, stickslip_interface
      type(stickslip_interface), value :: interface
      type(c_ptr), value :: layer
    end function

    ! Heat that leaves the nodes of both sides: heat1(n1), heat2(n2) [F L/T], to add to the host's internal heat flow.
    ! temperatures1(n1), temperatures2(n2); nodes: c_null_ptr, or c_loc of a stickslip_heat_nodes.
    integer(c_int32_t) function stickslip_interface_heat(interface, x1, x2, lambda, heat, temperatures1, temperatures2, &
        heat1, heat2, nodes) bind(C)
      import :: c_double, c_int32_t, c_ptr, stickslip_heat, stickslip_interface
      type(stickslip_interface), value :: interface
      real(c_double), intent(in) :: x1(*), x2(*), lambda(*)
      type(stickslip_heat), intent(in) :: heat
      real(c_double), intent(in) :: temperatures1(*), temperatures2(*)
      real(c_double), intent(inout) :: heat1(*), heat2(*)
      type(c_ptr), value :: nodes
    end function

    ! Its tangent as triplets: equations1(n1), equations2(n2) of the temperatures; which: STICKSLIP_HEAT_... With rows, columns
    ! and values c_null_ptr only count is written.
    integer(c_int32_t) function stickslip_interface_heat_tangent_coo(interface, x1, x2, lambda, heat, temperatures1, &
        temperatures2, equations1, equations2, which, capacity, rows, columns, values, count) bind(C)
      import :: c_double, c_int32_t, c_int64_t, c_ptr, stickslip_heat, stickslip_interface
      type(stickslip_interface), value :: interface
      real(c_double), intent(in) :: x1(*), x2(*), lambda(*)
      type(stickslip_heat), intent(in) :: heat
      real(c_double), intent(in) :: temperatures1(*), temperatures2(*)
      integer(c_int64_t), intent(in) :: equations1(*), equations2(*)
      integer(c_int32_t), value :: which
      integer(c_int64_t), value :: capacity
      type(c_ptr), value :: rows, columns, values
      integer(c_int64_t), intent(inout) :: count
    end function

    ! What passes through one node: sides(2) [F/(L T)]; slopes(STICKSLIP_HEAT_SLOPES, 2) and conductance: c_loc, or c_null_ptr.
    integer(c_int32_t) function stickslip_node_heat(heat, jump, pressure, gap, area, work, sides, slopes, conductance) bind(C)
      import :: c_double, c_int32_t, c_ptr, stickslip_heat
      type(stickslip_heat), intent(in) :: heat
      real(c_double), value :: jump, pressure, gap, area, work
      real(c_double), intent(inout) :: sides(*)
      type(c_ptr), value :: slopes, conductance
    end function

    ! How the residual depends on the positions of t_n, as triplets. With rows, columns and values c_null_ptr only count is written.
    integer(c_int32_t) function stickslip_interface_previous_tangent_coo(interface, x1, x2, lambda, capacity, rows, columns, &
        values, count) bind(C)
      import :: c_double, c_int32_t, c_int64_t, c_ptr, stickslip_interface
      type(stickslip_interface), value :: interface
      real(c_double), intent(in) :: x1(*), x2(*), lambda(*)
      integer(c_int64_t), value :: capacity
      type(c_ptr), value :: rows, columns, values
      integer(c_int64_t), intent(inout) :: count
    end function

    ! Products from the left: a1(3, n1), a2(3, n2), a_rows(3, n1), or a_rows(n1) without friction; members of gradient: c_loc, or c_null_ptr.
    integer(c_int32_t) function stickslip_interface_adjoint(interface, x1, x2, lambda, a1, a2, a_rows, gradient) bind(C)
      import :: c_double, c_int32_t, stickslip_gradient, stickslip_interface
      type(stickslip_interface), value :: interface
      real(c_double), intent(in) :: x1(*), x2(*), lambda(*), a1(*), a2(*), a_rows(*)
      type(stickslip_gradient), intent(in) :: gradient
    end function

    ! Products from the right: force1(3, n1), force2(3, n2), rows(3, n1), or rows(n1); members of direction: c_loc, or c_null_ptr.
    integer(c_int32_t) function stickslip_interface_sensitivity(interface, x1, x2, lambda, direction, force1, force2, rows) bind(C)
      import :: c_double, c_int32_t, stickslip_direction, stickslip_interface
      type(stickslip_interface), value :: interface
      real(c_double), intent(in) :: x1(*), x2(*), lambda(*)
      type(stickslip_direction), intent(in) :: direction
      real(c_double), intent(inout) :: force1(*), force2(*), rows(*)
    end function

    ! Creates general contact over a skin, whose coordinates are the first configuration and t_0. bodies(n_facets): c_loc of
    ! the numbers of the facets' bodies, or c_null_ptr: what hangs together is one. first_multiplier: the first equation of
    ! multipliers. A handle that was in use must be destroyed first.
    integer(c_int32_t) function stickslip_skin_create(surface, bodies, first_multiplier, options, out) bind(C)
      import :: c_int32_t, c_int64_t, c_ptr, stickslip_options, stickslip_skin, stickslip_surface
      type(stickslip_surface), intent(in) :: surface
      type(c_ptr), value :: bodies
      integer(c_int64_t), value :: first_multiplier
      type(stickslip_options), intent(in) :: options
      type(stickslip_skin), intent(inout) :: out
    end function

    ! Destroys a skin. One that was never created, or is destroyed already, is fine.
    integer(c_int32_t) function stickslip_skin_destroy(skin) bind(C)
      import :: c_int32_t, stickslip_skin
      type(stickslip_skin), intent(inout) :: skin
    end function

    ! The copies of a skin's nodes, which have the multipliers: originals(count), equations(3, count), of lines (2, count); both
    ! c_null_ptr: only count and multipliers are written.
    integer(c_int32_t) function stickslip_skin_copies(skin, capacity, originals, equations, count, multipliers) bind(C)
      import :: c_int32_t, c_int64_t, c_ptr, stickslip_skin
      type(stickslip_skin), value :: skin
      integer(c_int64_t), value :: capacity
      type(c_ptr), value :: originals, equations
      integer(c_int64_t), intent(inout) :: count, multipliers
    end function

    ! What there is between two bodies, or within one: friction mu >= 0, or STICKSLIP_SKIN_APART. Make the plan again.
    integer(c_int32_t) function stickslip_skin_set_pair(skin, body1, body2, mu) bind(C)
      import :: c_double, c_int32_t, c_int64_t, stickslip_skin
      type(stickslip_skin), value :: skin
      integer(c_int64_t), value :: body1, body2
      real(c_double), value :: mu
    end function

    ! Directions(3, n), of lines (2, n), in which displacement is prescribed on both sides at nodes(n). Replaces all earlier ones.
    integer(c_int32_t) function stickslip_skin_set_constraints(skin, n, nodes, directions) bind(C)
      import :: c_double, c_int32_t, c_int64_t, stickslip_skin
      type(stickslip_skin), value :: skin
      integer(c_int64_t), value :: n
      integer(c_int64_t), intent(in) :: nodes(*)
      real(c_double), intent(in) :: directions(*)
    end function

    ! Multipliers lambda(3, copies), of lines (2, copies), to start the first step with.
    integer(c_int32_t) function stickslip_skin_initial_multipliers(skin, lambda) bind(C)
      import :: c_double, c_int32_t, stickslip_skin
      type(stickslip_skin), value :: skin
      real(c_double), intent(inout) :: lambda(*)
    end function

    ! Residual in internal-force sign: add it to your internal forces. x(3, nodes), lambda(3, copies); force(3, nodes),
    ! rows(3, copies); of lines 2 in place of 3.
    integer(c_int32_t) function stickslip_skin_residual(skin, x, lambda, force, rows) bind(C)
      import :: c_double, c_int32_t, stickslip_skin
      type(stickslip_skin), value :: skin
      real(c_double), intent(in) :: x(*), lambda(*)
      real(c_double), intent(inout) :: force(*), rows(*)
    end function

    ! Makes the plan of the tangent: its entries, which may be there more than once and add up. pairs: STICKSLIP_PLAN_ACTIVE, _SKIN.
    integer(c_int32_t) function stickslip_skin_plan(skin, x, pairs, count) bind(C)
      import :: c_double, c_int32_t, c_int64_t, stickslip_skin
      type(stickslip_skin), value :: skin
      real(c_double), intent(in) :: x(*)
      integer(c_int32_t), value :: pairs
      integer(c_int64_t), intent(inout) :: count
    end function

    ! The entries of the plan in the order of the values: rows(capacity), columns(capacity).
    integer(c_int32_t) function stickslip_skin_plan_coo(skin, capacity, rows, columns) bind(C)
      import :: c_int32_t, c_int64_t, stickslip_skin
      type(stickslip_skin), value :: skin
      integer(c_int64_t), value :: capacity
      integer(c_int64_t), intent(inout) :: rows(*), columns(*)
    end function

    ! The same in 32 bits.
    integer(c_int32_t) function stickslip_skin_plan_coo32(skin, capacity, rows, columns) bind(C)
      import :: c_int32_t, c_int64_t, stickslip_skin
      type(stickslip_skin), value :: skin
      integer(c_int64_t), value :: capacity
      integer(c_int32_t), intent(inout) :: rows(*), columns(*)
    end function

    ! The exact tangent in the order of the plan's entries: values(capacity), overwritten.
    integer(c_int32_t) function stickslip_skin_plan_values(skin, x, lambda, capacity, values) bind(C)
      import :: c_double, c_int32_t, c_int64_t, stickslip_skin
      type(stickslip_skin), value :: skin
      real(c_double), intent(in) :: x(*), lambda(*)
      integer(c_int64_t), value :: capacity
      real(c_double), intent(inout) :: values(*)
    end function

    ! State and results of every copy: the members of out are c_loc of arrays with copies in place of n1, or c_null_ptr.
    integer(c_int32_t) function stickslip_skin_states(skin, x, lambda, out) bind(C)
      import :: c_double, c_int32_t, stickslip_skin, stickslip_states
      type(stickslip_skin), value :: skin
      real(c_double), intent(in) :: x(*), lambda(*)
      type(stickslip_states), intent(in) :: out
    end function

    ! How far x, lambda is from contact equilibrium; nodes are copies. out: two inputs and all outputs.
    integer(c_int32_t) function stickslip_skin_equilibrium(skin, x, lambda, out) bind(C)
      import :: c_double, c_int32_t, stickslip_equilibrium, stickslip_skin
      type(stickslip_skin), value :: skin
      real(c_double), intent(in) :: x(*), lambda(*)
      type(stickslip_equilibrium), intent(inout) :: out
    end function

    ! How much of a step dx(3, nodes) of Newton's method may be taken; penetration: above 0 and at most 1, 0: the default.
    integer(c_int32_t) function stickslip_skin_step_limit(skin, x, dx, penetration, fraction) bind(C)
      import :: c_double, c_int32_t, stickslip_skin
      type(stickslip_skin), value :: skin
      real(c_double), intent(in) :: x(*), dx(*)
      real(c_double), value :: penetration
      real(c_double), intent(inout) :: fraction
    end function

    ! Which normals evaluations use until the next commit: STICKSLIP_NORMALS_COMMITTED or _CURRENT.
    integer(c_int32_t) function stickslip_skin_use_normals(skin, normals) bind(C)
      import :: c_int32_t, stickslip_skin
      type(stickslip_skin), value :: skin
      integer(c_int32_t), value :: normals
    end function

    ! Turns multipliers lambda(3, copies), in and out, as the skin turns from t_n to x(3, nodes).
    integer(c_int32_t) function stickslip_skin_turn_multipliers(skin, x, lambda) bind(C)
      import :: c_double, c_int32_t, stickslip_skin
      type(stickslip_skin), value :: skin
      real(c_double), intent(in) :: x(*)
      real(c_double), intent(inout) :: lambda(*)
    end function

    ! Accepts a converged step: x(3, nodes), lambda(3, copies) become t_n; lambda changes where sides do. After
    ! STICKSLIP_CONTACT_LOST solve the same step again, with a new plan, or a smaller one.
    integer(c_int32_t) function stickslip_skin_commit(skin, x, lambda) bind(C)
      import :: c_double, c_int32_t, stickslip_skin
      type(stickslip_skin), value :: skin
      real(c_double), intent(in) :: x(*)
      real(c_double), intent(inout) :: lambda(*)
    end function

    ! Exchanges the sides of all facets at t_n, for a step that fails however small it is; lambda(3, copies): those of t_n.
    integer(c_int32_t) function stickslip_skin_exchange(skin, lambda) bind(C)
      import :: c_double, c_int32_t, stickslip_skin
      type(stickslip_skin), value :: skin
      real(c_double), intent(inout) :: lambda(*)
    end function

    ! Undoes the last commit exactly. Make the plan again.
    integer(c_int32_t) function stickslip_skin_rollback(skin) bind(C)
      import :: c_int32_t, stickslip_skin
      type(stickslip_skin), value :: skin
    end function

    ! Lengths of the arrays that hold the history now; they change with each commit.
    integer(c_int32_t) function stickslip_skin_history_size(skin, n_integers, n_reals) bind(C)
      import :: c_int32_t, c_int64_t, stickslip_skin
      type(stickslip_skin), value :: skin
      integer(c_int64_t), intent(inout) :: n_integers, n_reals
    end function

    ! Writes the history to integers(n_integers) and reals(n_reals), for a restart file.
    integer(c_int32_t) function stickslip_skin_history_export(skin, n_integers, integers, n_reals, reals) bind(C)
      import :: c_double, c_int32_t, c_int64_t, stickslip_skin
      type(stickslip_skin), value :: skin
      integer(c_int64_t), value :: n_integers
      integer(c_int64_t), intent(inout) :: integers(*)
      integer(c_int64_t), value :: n_reals
      real(c_double), intent(inout) :: reals(*)
    end function

    ! Replaces the history by an exported one of the same skin. Make the plan again.
    integer(c_int32_t) function stickslip_skin_history_import(skin, n_integers, integers, n_reals, reals) bind(C)
      import :: c_double, c_int32_t, c_int64_t, stickslip_skin
      type(stickslip_skin), value :: skin
      integer(c_int64_t), value :: n_integers
      integer(c_int64_t), intent(in) :: integers(*)
      integer(c_int64_t), value :: n_reals
      real(c_double), intent(in) :: reals(*)
    end function

    ! Who may touch whom in this step, facet by facet: the members of out are c_loc of arrays, or c_null_ptr.
    integer(c_int32_t) function stickslip_skin_facets(skin, out) bind(C)
      import :: c_int32_t, stickslip_skin, stickslip_skin_sides
      type(stickslip_skin), value :: skin
      type(stickslip_skin_sides), intent(in) :: out
    end function

    ! What the skin has found in this step, and done since its creation.
    integer(c_int32_t) function stickslip_skin_report(skin, out) bind(C)
      import :: c_int32_t, stickslip_skin, stickslip_skin_summary
      type(stickslip_skin), value :: skin
      type(stickslip_skin_summary), intent(inout) :: out
    end function
  end interface
end module
