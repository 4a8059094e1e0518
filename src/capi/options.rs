//! Options of an interface and their numbers.

use super::choice::{choose, unnamed};
use super::guard::guard;
use super::model::{STICKSLIP_MODEL_SOLID, measure, model as read_model};
use super::raw;
use super::sized::{self, Sized64};
use super::space::{STICKSLIP_SPACE_CORNER, multiplier_space as read_multiplier_space};
use crate::error::{Error, Kind, Result, Text};
use crate::geometry::AnalyticShape;
use crate::interface::{
    COVERAGE_MIN, Decision, Form, MortarSide, MultiplierBasis, NewContact, Normals, Options, RowScale, Scheme,
    Shortcuts, Stiffness, TURN_MAX, Tangent, Weights, Wishes,
};
use crate::law::{Coefficient, Friction, LAWS, SlipMeasure};
use crate::line::Measure;
use crate::quadrature::{DEGREE_1, DEGREE_2, DEGREE_4, DEGREE_5, DEGREE_6, DEGREE_10, Rule, cell};

/// Forces use lambda, rows the projection; the tangent is a sum of pairs and nodes. Default.
pub const STICKSLIP_FORM_MULTIPLIER: i32 = 0;
/// Forces use the projected traction (the paper's form). Same solutions.
/// Not with (UNSUPPORTED): points that decide (STICKSLIP_DECISION_POINTS); condensation; the tangent by sums of several
/// handles.
pub const STICKSLIP_FORM_AUGMENTED: i32 = 1;
/// P(g[n_n,x] - g[n_{n+1},x]): invariant under rigid motion within a step. Default.
pub const STICKSLIP_SLIP_OBJECTIVE: i32 = 0;
/// P(g[n_n,x] - g[n_n,x_n]).
pub const STICKSLIP_SLIP_INCREMENT: i32 = 1;
/// P g[n_n,x]: the paper's literal (12); drifts on curved interfaces.
/// Not with (UNSUPPORTED): persistent weights (STICKSLIP_WEIGHTS_PERSISTENT); points that decide (STICKSLIP_DECISION_POINTS)
/// and friction (STICKSLIP_FRICTION_COULOMB).
pub const STICKSLIP_SLIP_PAPER: i32 = 2;
/// Of now; with STICKSLIP_DECISION_POINTS and friction those of the last commit. Default.
pub const STICKSLIP_WEIGHTS_AUTO: i32 = 0;
/// Weights of the current configuration, linearised: large sliding.
pub const STICKSLIP_WEIGHTS_CURRENT: i32 = 1;
/// Weights frozen at the last commit.
pub const STICKSLIP_WEIGHTS_COMMITTED: i32 = 2;
/// Weights, normals and areas frozen at the first configuration: small displacements.
pub const STICKSLIP_WEIGHTS_REFERENCE: i32 = 3;
/// Weights frozen at the last commit, and what overlaps there counts as closed: a step need not part it. The work of the contact forces over a
/// step is then never positive, whatever slides and turns: for dynamics.
/// Not with (UNSUPPORTED): the paper's slip measure (STICKSLIP_SLIP_PAPER); points that decide (STICKSLIP_DECISION_POINTS);
/// offsets.
pub const STICKSLIP_WEIGHTS_PERSISTENT: i32 = 4;
/// Of now, unless weights are frozen, points decide or the host gives normals: then of the last commit. Default.
pub const STICKSLIP_NORMALS_AUTO: i32 = 0;
/// Normals nu of the last commit, as in the paper: data of a step. Where surfaces turn or slide on curved ones the forces lag
/// behind by half a step.
pub const STICKSLIP_NORMALS_COMMITTED: i32 = 1;
/// Normals of the current configuration, linearised: the size of a step does not decide how accurate normals are, a surface may
/// turn by any angle within it, and a step without load moves nothing. Tied surfaces
/// use no normals. Which facets look at each other follows the motion, too.
/// Not with (UNSUPPORTED): frozen weights; points that decide (STICKSLIP_DECISION_POINTS); normals of the host.
pub const STICKSLIP_NORMALS_CURRENT: i32 = 2;
/// Coulomb friction with the coefficient mu (0 allowed). Default.
pub const STICKSLIP_FRICTION_COULOMB: i32 = 0;
/// One multiplier per node, along the normal: multiplier_equations, lambda and rows have n1 entries. No slip history.
pub const STICKSLIP_FRICTION_NONE: i32 = 1;
/// Mesh tying: a node that is covered in the first configuration keeps its place; weights of the reference. A gap at the
/// start stays, and turns with the non-mortar facets; linear where there is none.
/// Not with (UNSUPPORTED): points that decide (STICKSLIP_DECISION_POINTS).
pub const STICKSLIP_FRICTION_TIED: i32 = 2;
/// Opens and closes, never slips.
pub const STICKSLIP_FRICTION_ROUGH: i32 = 3;
/// Coulomb friction with the coefficient mu, up to a largest shear traction, shear_limit.
pub const STICKSLIP_FRICTION_TRESCA: i32 = 4;
/// The mortar side deforms (or is prescribed, where it has no equations). Default.
pub const STICKSLIP_MORTAR_DEFORMABLE: i32 = 0;
/// The mortar side is rigid or prescribed (no equations): no rows and columns for it in the tangent.
pub const STICKSLIP_MORTAR_RIGID: i32 = 1;
/// The mortar side is rigid and in closed form, STICKSLIP_SHAPE_...: no facets, no search. Its stickslip_surface has
/// four nodes (of lines three), a frame that is fixed to it and that the host moves as a rigid body: see there.
/// Not with (UNSUPPORTED): points that decide (STICKSLIP_DECISION_POINTS); offsets of the mortar nodes; offsets that follow
/// from a shape.
pub const STICKSLIP_MORTAR_ANALYTIC: i32 = 2;
/// A plane; of lines a straight line. Default.
pub const STICKSLIP_SHAPE_PLANE: i32 = 0;
/// A sphere; of lines a circle.
pub const STICKSLIP_SHAPE_SPHERE: i32 = 1;
/// A circular cylinder without ends; of lines a circle.
pub const STICKSLIP_SHAPE_CYLINDER: i32 = 2;
/// Coulomb with mu = 0 at every node: no slip is computed (and none reported).
pub const STICKSLIP_SHORTCUT_FRICTIONLESS: i32 = 1;
/// A mortar side without equations is treated as rigid.
pub const STICKSLIP_SHORTCUT_RIGID: i32 = 2;
/// Surfaces that are apart are neither searched nor integrated; their nodes count as uncovered. They are apart where their
/// boxes lie farther from each other, along one axis, than the deepest penetration of a pair (see search_distance; on
/// flat surfaces the shorter of their longest edges); this must hold at t_n and now, with the same side above, and the
/// surfaces must look at each other. From an analytic surface every node must be outside by more than the non-mortar
/// side's longest edge. Calls with sums of handles leave nothing out; with weak_coverage no commit leaves anything out.
pub const STICKSLIP_SHORTCUT_APART: i32 = 4;
/// Nodes that nothing can cover before the next commit (no mortar facet passes the filters with a facet around them), and
/// all while the surfaces are apart: no law, row -lambda / r; the former's tangent block is its diagonal.
pub const STICKSLIP_SHORTCUT_UNCOVERED: i32 = 8;
/// Dual, but with STICKSLIP_SPACE_SUB standard. Default.
pub const STICKSLIP_BASIS_AUTO: i32 = 0;
/// Standard shape functions for the multiplier (the paper's): tractions oscillate beside edges and on curved surfaces.
/// Not with (UNSUPPORTED): points that decide (STICKSLIP_DECISION_POINTS); condensation.
pub const STICKSLIP_BASIS_STANDARD: i32 = 1;
/// Dual functions, biorthogonal to the shape functions over what is covered of a facet: a node's force is its multiplier
/// times its covered area, and tractions do not oscillate beside edges and on curved surfaces. The tangent couples the
/// mortar nodes of all pairs of a facet. Neighbours carry weakly covered nodes unless weak_coverage says NONE. With
/// STICKSLIP_INTEGRATION_ELEMENTS a facet whose covered points do not determine its multipliers is refused
/// (DEGENERATE_FACET); STICKSLIP_INTEGRATION_HYBRID takes overlaps there from the next commit on. The stages
/// have calls of their own for it.
/// Not with (UNSUPPORTED): multipliers at all nodes of quadratic facets or lines (STICKSLIP_SPACE_SUB); sums of several
/// handles.
pub const STICKSLIP_BASIS_DUAL: i32 = 2;
/// weak_coverage: every covered node has a multiplier of its own.
pub const STICKSLIP_WEAK_COVERAGE_NONE: f64 = -1.0;
/// 7 points a triangle, degree 5: exact for triangles and parallelograms. Default.
pub const STICKSLIP_QUADRATURE_DEGREE_5: i32 = 0;
/// 36 points a triangle, degree 10: for warped or distorted quadrilaterals where accuracy counts.
pub const STICKSLIP_QUADRATURE_DEGREE_10: i32 = 1;
/// 1 point a triangle, degree 1: for comparisons. Of this and the next the weights are not exact on any facet, and patch
/// tests fail; the tangent is that of exact weights, so that Newton's method converges linearly.
pub const STICKSLIP_QUADRATURE_DEGREE_1: i32 = 2;
/// 3 points a triangle, degree 2: for comparisons.
pub const STICKSLIP_QUADRATURE_DEGREE_2: i32 = 3;
/// 6 points a triangle, degree 4: weights exact for triangles and parallelograms; the tangent is that of degree 5, not
/// quite this rule's own: Newton's method converges linearly, but fast.
pub const STICKSLIP_QUADRATURE_DEGREE_4: i32 = 4;
/// 12 points a triangle, degree 6: for warped or distorted quadrilaterals.
pub const STICKSLIP_QUADRATURE_DEGREE_6: i32 = 5;
/// Weights over triangles of each overlap. Default.
pub const STICKSLIP_INTEGRATION_SEGMENTS: i32 = 0;
/// Over element_points x element_points points on each non-mortar facet, each where it falls on a mortar facet: no
/// clipping. Functions with kinks at the mortar edges are integrated as if they were smooth: patch tests fail, however
/// many points there are. The tangent is that of the sums; they jump where a point passes a mortar edge.
/// Not with (UNSUPPORTED): points that decide (STICKSLIP_DECISION_POINTS); quadratic facets; lines.
pub const STICKSLIP_INTEGRATION_ELEMENTS: i32 = 1;
/// As ELEMENTS; but as SEGMENTS for all pairs of a non-mortar facet of which a point or a corner was uncovered at the last
/// commit. Patch tests fail.
pub const STICKSLIP_INTEGRATION_HYBRID: i32 = 2;
/// The tangent is exact. Default.
pub const STICKSLIP_TANGENT_EXACT: i32 = 0;
/// Weights of now, but constants in the tangent: fewer entries, no derivatives; Newton's method converges linearly.
pub const STICKSLIP_TANGENT_FROZEN_WEIGHTS: i32 = 1;
/// The tangent leaves out that facets' planes tilt: converges linearly too, and saves nothing; for comparisons with
/// codes that do so. Exact against an analytic mortar side.
/// Not with (UNSUPPORTED): lines.
pub const STICKSLIP_TANGENT_FROZEN_NORMALS: i32 = 2;
/// A node is closed or open. Default.
pub const STICKSLIP_DECISION_NODES: i32 = 0;
/// Each point of an overlap is closed or open (docs/formulation.md 16): the border of the contact lies inside facets. modulus is needed,
/// and is E* of both bodies together: 1 / E* = (1 - nu1^2) / E1 + (1 - nu2^2) / E2, of a rigid one without its part. The answer depends
/// on it, by what vanishes with the facets' size. An augmentation beside it takes the place of r = 0.9 E* / h_A alone; r is then part of the
/// answer, too.
/// Not with (UNSUPPORTED): tied surfaces (STICKSLIP_FRICTION_TIED); a law that is not Coulomb's; friction
/// (STICKSLIP_FRICTION_COULOMB) and weights of now (STICKSLIP_WEIGHTS_CURRENT); friction (STICKSLIP_FRICTION_COULOMB) and
/// the paper's slip measure (STICKSLIP_SLIP_PAPER); standard multipliers (STICKSLIP_BASIS_STANDARD); persistent weights
/// (STICKSLIP_WEIGHTS_PERSISTENT); normals of now (STICKSLIP_NORMALS_CURRENT); the augmented form
/// (STICKSLIP_FORM_AUGMENTED); points that stand for overlaps (options.element_points); nodes that others carry
/// (weak_coverage > 0, the default of dual multipliers); an analytic mortar side; facets with mid nodes; a law of one's own;
/// offsets and weights of now (STICKSLIP_WEIGHTS_CURRENT); parts of an interface (owned has STICKSLIP_NODE_ELSEWHERE); nodes
/// that handles share (owned has STICKSLIP_NODE_SHARED); a history of nodes (stickslip_interface_set_committed) and friction
/// (STICKSLIP_FRICTION_COULOMB); condensation; heat.
pub const STICKSLIP_DECISION_POINTS: i32 = 1;
/// Multiplier rows times r_A M_A: M_A (p_A - lambda_A), a force. Default.
pub const STICKSLIP_ROW_SCALE_FORCE: i32 = 0;
/// Multiplier rows as in the paper [L^3].
pub const STICKSLIP_ROW_SCALE_NONE: i32 = 1;
/// A node that was uncovered at t_n acts without friction for one step. Default.
pub const STICKSLIP_NEW_CONTACT_FRICTIONLESS: i32 = 0;
/// It keeps its mu (a sticking one then has zero tangential rows).
pub const STICKSLIP_NEW_CONTACT_KEEP: i32 = 1;

/// Options of an interface; `stickslip_options_init` writes the defaults.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct stickslip_options {
    /// sizeof(stickslip_options), as `stickslip_options_init` sets it.
    pub struct_size: u64,
    /// STICKSLIP_FORM_...
    pub form: i32,
    /// STICKSLIP_SLIP_... (with frozen weights OBJECTIVE acts as INCREMENT).
    pub slip: i32,
    /// STICKSLIP_WEIGHTS_...
    pub weights: i32,
    /// STICKSLIP_FRICTION_...
    pub friction: i32,
    /// STICKSLIP_MORTAR_...
    pub mortar_side: i32,
    /// STICKSLIP_BASIS_...
    pub multiplier_basis: i32,
    /// STICKSLIP_QUADRATURE_...
    pub quadrature: i32,
    /// STICKSLIP_ROW_SCALE_...
    pub row_scale: i32,
    /// STICKSLIP_NEW_CONTACT_...
    pub new_contact: i32,
    /// 0 (default, C) or 1 (Fortran): base of node numbers, equations, rows, columns and row offsets. Not of
    /// facet_offsets.
    pub index_base: i32,
    /// Coulomb coefficient of all nodes [-]; default 0, and 0 with FRICTION_NONE, _ROUGH and _TIED.
    pub mu: f64,
    /// rhat [F/L^3]; 0 (default): use the modulus. One of the two is needed: nothing else has the unit
    /// of a stiffness. The answer does not depend on it, except with STICKSLIP_DECISION_POINTS.
    pub augmentation: f64,
    /// Young's modulus of the softer body [F/L^2]: rhat_A = 0.1 E / h_A, h_A = sqrt(M_A), of lines about their length; 0 (default): use the
    /// augmentation. With STICKSLIP_DECISION_POINTS it is needed, and is E* of both bodies together.
    pub modulus: f64,
    /// A node whose covered area over its full area [-] is at most this counts as uncovered; default 1e-8. Where a
    /// surface slides off an edge, the tractions of nodes that are hardly covered grow like the inverse of their
    /// coverage, and the least singular value of a scaled Newton matrix goes down to about a thousandth of this number.
    /// 1e-4 is milder there.
    pub coverage_min: f64,
    /// Facets farther apart than this along the normal at the last commit, gap or penetration, are no pair
    /// [L]. 0 (default): any gap, and a penetration of one facet (the smaller of the two) beyond what the curved
    /// surfaces lie off their facets, so that the far side of a body is not found; a fine mortar surface that dips into
    /// coarse non-mortar facets is followed down from where it enters them, by as much as a coarse facet is long. Give it
    /// where the mortar surface lies in layers (refused otherwise) or the surfaces start deeper in each other than a facet.
    pub search_distance: f64,
    /// Sum of the STICKSLIP_SHORTCUT_... that the library is not to take; 0 (default): it takes all.
    pub no_shortcuts: i32,
    /// STICKSLIP_SHAPE_... with STICKSLIP_MORTAR_ANALYTIC, else 0.
    pub shape: i32,
    /// With STICKSLIP_MORTAR_ANALYTIC [L]. Sphere, cylinder: > 0: a ball, a bar; < 0: a cavity, a bore, the body
    /// outside. Plane, and where there is no shape: 0.
    pub radius: f64,
    /// STICKSLIP_INTEGRATION_... (of no effect against an analytic mortar side: there is nothing to clip).
    pub integration: i32,
    /// STICKSLIP_TANGENT_... (of no effect with frozen weights). The answer does not depend on it.
    pub tangent: i32,
    /// Points along a side with STICKSLIP_INTEGRATION_ELEMENTS and HYBRID: 2 to 10; 0 (default): 4. Otherwise 0.
    pub element_points: i64,
    /// A node covered less than this times its best covered neighbour at t_n [-] has no multiplier of its own in the
    /// step: covered neighbours carry it, lambda_A = sum_B w_AB lambda_B with sum_B w_AB = 1, and its gap counts in
    /// their rows. They carry newly covered nodes too, with friction, up to four facets away. At most 1; 0 (default): the
    /// library's choice, none with standard multipliers and 0.2 with dual ones, told by `stickslip_interface_effects`;
    /// STICKSLIP_WEAK_COVERAGE_NONE: every covered node has its own, and that of a sliver grows without bound as the sliver
    /// goes; 0.5: none beyond the mortar surface's edge has. It changes the answer at partly covered nodes alone. Not with
    /// sums of handles. Who carries whom: `stickslip_interface_carriers`. With
    /// one multiplier a node (no friction) a node hands on its normal traction; with three it hands on the vector. So
    /// between nodes of different normals mu = 0 and no friction give slightly different answers.
    pub weak_coverage: f64,
    /// How far a surface may turn from one commit to the next, in radians [-], where the normals are those of t_n. A commit
    /// refuses more with TURNED_TOO_FAR. With NORMALS_CURRENT only where slip is not measured by SLIP_OBJECTIVE, and at nodes on
    /// a knife's edge, which keep nu(t_n). Each side counts alone, in space; with WEIGHTS_REFERENCE the non-mortar side's
    /// turn since the first configuration, as of tied surfaces with offsets; other tied ones may turn as they like. With friction,
    /// whatever the normals, the sides may spin no further against each other about their normal, for slip is the chord of the way:
    /// the moment of friction is cos(spin / 2) of what it must be. At most pi, which refuses nothing;
    /// 0 (default): pi / 9, 20 degrees. What a turn below it costs: docs/plug_in.md.
    pub turn_max: f64,
    /// With STICKSLIP_FRICTION_TRESCA the largest shear traction, > 0 [F/L^2]; else 0 (default).
    pub shear_limit: f64,
    /// STICKSLIP_NORMALS_...
    pub normals: i32,
    /// Threads that `stickslip_interface_plan_values`, the residual and a commit may use, 1 to 256; 0 (default): the calling one
    /// alone. They end with the call. The results are the same bit for bit, whatever their number.
    pub threads: i32,
    /// STICKSLIP_SPACE_..., for interfaces with quadratic facets: where the multipliers of such facets stand. Nodes of
    /// the non-mortar side at which no facet has a multiplier have no multiplier equations (-1).
    pub multiplier_space: i32,
    /// STICKSLIP_MODEL_...: whether facets are of a model in space, or lines of a plane or axisymmetric one. With lines every array of
    /// vectors of this interface has two components a node in place of three: positions, forces, multipliers, normals,
    /// directions; so have equations. The frame of an analytic mortar side has three points. What
    /// lines do not go with: docs/compose.md.
    pub model: i32,
    /// Thickness of a plane model [L]; 0 (default): 1. 0 of other models.
    pub thickness: f64,
    /// STICKSLIP_DECISION_...: whether nodes or points are closed.
    pub decision: i32,
    /// 0.
    pub reserved: i32,
}

// SAFETY: repr(C), struct_size first, numbers only.
unsafe impl Sized64 for stickslip_options {
    const NAME: &'static str = "stickslip_options";
    const FIRST: usize = 88;
}

const DEFAULTS: stickslip_options = stickslip_options {
    struct_size: 0,
    form: STICKSLIP_FORM_MULTIPLIER,
    slip: STICKSLIP_SLIP_OBJECTIVE,
    weights: STICKSLIP_WEIGHTS_AUTO,
    friction: STICKSLIP_FRICTION_COULOMB,
    mortar_side: STICKSLIP_MORTAR_DEFORMABLE,
    multiplier_basis: STICKSLIP_BASIS_AUTO,
    quadrature: STICKSLIP_QUADRATURE_DEGREE_5,
    row_scale: STICKSLIP_ROW_SCALE_FORCE,
    new_contact: STICKSLIP_NEW_CONTACT_FRICTIONLESS,
    index_base: 0,
    mu: 0.0,
    augmentation: 0.0,
    modulus: 0.0,
    coverage_min: COVERAGE_MIN,
    search_distance: 0.0,
    no_shortcuts: 0,
    shape: STICKSLIP_SHAPE_PLANE,
    radius: 0.0,
    integration: STICKSLIP_INTEGRATION_SEGMENTS,
    tangent: STICKSLIP_TANGENT_EXACT,
    element_points: 0,
    weak_coverage: 0.0,
    turn_max: 0.0,
    shear_limit: 0.0,
    normals: STICKSLIP_NORMALS_AUTO,
    threads: 0,
    multiplier_space: STICKSLIP_SPACE_CORNER,
    model: STICKSLIP_MODEL_SOLID,
    thickness: 0.0,
    decision: STICKSLIP_DECISION_NODES,
    reserved: 0,
};

/// Writes the defaults into options: what docs/accuracy.md recommends, as the host's other choices allow. struct_size:
/// sizeof(stickslip_options) as the caller knows it; of an older caller's shorter struct only that much is written, the tail of
/// a newer caller's longer one is zeroed.
///
/// Errors: NULL_POINTER, STRUCT_SIZE.
/// Cost: a copy.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_options_init(options: *mut stickslip_options, struct_size: u64) -> i32 {
    guard(|| sized::initialise(options, struct_size, stickslip_options { struct_size, ..DEFAULTS }, "options"))
}

/// Makes options those of the paper's element: standard multipliers, weights of now, normals of the last commit. Other members stay.
///
/// options: in and out, after `stickslip_options_init`.
///
/// Errors: NULL_POINTER, STRUCT_SIZE.
/// Cost: a copy.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_options_paper(options: *mut stickslip_options) -> i32 {
    guard(|| {
        raw::check(options, "options")?;
        let given = sized::read(options)?;
        let paper = stickslip_options {
            weights: STICKSLIP_WEIGHTS_CURRENT,
            multiplier_basis: STICKSLIP_BASIS_STANDARD,
            normals: STICKSLIP_NORMALS_COMMITTED,
            ..given
        };
        sized::initialise(options, given.struct_size, paper, "options")
    })
}

/// Replaces what is AUTO in options by what an interface with these options takes: `stickslip_interface_effects` says it of a handle.
///
/// options: in and out, complete but for the stiffness.
///
/// Errors: NULL_POINTER, STRUCT_SIZE, INVALID_VALUE.
/// Cost: a copy.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_options_settle(options: *mut stickslip_options) -> i32 {
    guard(|| {
        raw::check(options, "options")?;
        let given = sized::read(options)?;
        let chosen = Options {
            decision: read_decision(given.decision, 1.0)?,
            friction: law(given.friction, "options.friction")?,
            space: read_multiplier_space(given.multiplier_space, "options.multiplier_space")?,
            ..Options::paper(Stiffness::Modulus(1.0))
        };
        let settled = chosen.settle(read_wishes(&given)?);
        let settled = stickslip_options {
            weights: 1 + settled.weights as i32,
            multiplier_basis: 1 + settled.basis as i32,
            normals: 1 + settled.normals as i32,
            ..given
        };
        sized::initialise(options, given.struct_size, settled, "options")
    })
}

/// What is not AUTO.
fn read_wishes(given: &stickslip_options) -> Result<Wishes> {
    let bases = [None, Some(MultiplierBasis::Standard), Some(MultiplierBasis::Dual)];
    let [current, committed, reference, persistent] =
        [Weights::Current, Weights::Committed, Weights::Reference, Weights::Persistent].map(Some);
    Ok(Wishes {
        basis: choose(given.multiplier_basis, "options.multiplier_basis", &bases, 3)?,
        weights: choose(given.weights, "options.weights", &[None, current, committed, reference, persistent], 5)?,
        normals: choose_normals(given.normals, "options.normals")?,
    })
}

fn read_decision(value: i32, modulus: f64) -> Result<Decision> {
    choose(value, "options.decision", &[Decision::Nodes, Decision::Points(modulus)], 2)
}

fn read_shortcuts(off: i32) -> Result<Shortcuts> {
    let all = STICKSLIP_SHORTCUT_FRICTIONLESS
        | STICKSLIP_SHORTCUT_RIGID
        | STICKSLIP_SHORTCUT_APART
        | STICKSLIP_SHORTCUT_UNCOVERED;
    if off & !all != 0 {
        let text = text!("options.no_shortcuts is {off}; a sum of STICKSLIP_SHORTCUT_... is allowed");
        return Err(Error::new(Kind::InvalidValue, text));
    }
    let on = |bit: i32| off & bit == 0;
    Ok(Shortcuts {
        frictionless: on(STICKSLIP_SHORTCUT_FRICTIONLESS),
        rigid: on(STICKSLIP_SHORTCUT_RIGID),
        apart: on(STICKSLIP_SHORTCUT_APART),
        uncovered: on(STICKSLIP_SHORTCUT_UNCOVERED),
    })
}

/// The rule of a STICKSLIP_QUADRATURE_... value.
pub(super) fn rule(value: i32, name: &str) -> Result<&'static Rule> {
    choose(value, name, &[&DEGREE_5, &DEGREE_10, &DEGREE_1, &DEGREE_2, &DEGREE_4, &DEGREE_6], 6)
}

/// What `element_points` 0 means where points are asked for.
const ELEMENT_POINTS: i64 = 4;

/// The Gauss points of `points` along a side.
pub(super) fn element_line(points: i64, name: &str) -> Result<&'static [[f64; 2]]> {
    usize::try_from(points).ok().and_then(cell::line_of).ok_or_else(|| {
        let [least, most] = cell::POINTS;
        Error::new(Kind::InvalidValue, text!("{name} is {points}; {least} to {most} is allowed"))
    })
}

fn read_scheme(integration: i32, points: i64) -> Result<Scheme> {
    let by_points: [Option<fn(_) -> _>; 3] = [None, Some(Scheme::Elements), Some(Scheme::Hybrid)];
    let name = "options.element_points";
    match choose(integration, "options.integration", &by_points, 3)? {
        Some(by_points) => Ok(by_points(element_line(if points == 0 { ELEMENT_POINTS } else { points }, name)?)),
        None if points == 0 => Ok(Scheme::Segments),
        None => {
            let text = text!("{name} is {points}; it must be 0 with STICKSLIP_INTEGRATION_SEGMENTS");
            Err(Error::new(Kind::InvalidValue, text))
        }
    }
}

/// The measure of a STICKSLIP_SLIP_... value.
pub(super) fn slip_measure(value: i32, name: &str) -> Result<SlipMeasure> {
    choose(value, name, &[SlipMeasure::Objective, SlipMeasure::Increment, SlipMeasure::Paper], 3)
}

/// More than any one interface gains from.
const MAX_THREADS: i32 = 256;

/// The normals of a STICKSLIP_NORMALS_... value; `None`: the library's choice.
pub(super) fn choose_normals(value: i32, name: &str) -> Result<Option<Normals>> {
    choose(value, name, &[None, Some(Normals::Committed), Some(Normals::Current)], 3)
}

/// The law of a STICKSLIP_FRICTION_... value.
pub(super) fn law(value: i32, name: &str) -> Result<Friction> {
    let row = usize::try_from(value).ok().and_then(|k| LAWS.get(k));
    row.map(|row| row.friction).ok_or_else(|| unnamed(value, name, LAWS.len() as i32))
}

/// Refuses numbers of other laws, and a law without its own.
pub(super) fn law_numbers(friction: Friction, mu: f64, shear_limit: f64, of: &str) -> Result<()> {
    let refuse = |text: Text| Err(Error::new(Kind::InvalidValue, text));
    let law = friction.law();
    if law.mu != Coefficient::Given && mu != 0.0 {
        return refuse(text!(
            "{of}.mu is {mu}; it must be 0 where {of}.friction is not Coulomb's, with a limit or without"
        ));
    }
    match law.refuses(given_limit(shear_limit)) {
        None => Ok(()),
        Some(allowed) => refuse(text!("{of}.shear_limit is {shear_limit}; it must be {allowed}")),
    }
}

/// 0 stands for no limit.
fn given_limit(shear_limit: f64) -> Option<f64> {
    (shear_limit != 0.0).then_some(shear_limit)
}

/// What an interface is created with.
pub(super) struct Choices {
    /// The core's options.
    pub options: Options,
    /// The index base.
    pub base: i64,
    /// The shape of an analytic mortar side.
    pub shape: Option<AnalyticShape>,
    /// rho of lines; `None`: a model in space.
    pub measure: Option<Measure>,
}

/// The shape; with `lines` as it is seen in their plane.
fn read_shape(analytic: bool, lines: bool, shape: i32, radius: f64) -> Result<Option<AnalyticShape>> {
    let refuse = |text: Text| Err(Error::new(Kind::InvalidValue, text));
    if !analytic {
        return match (shape, radius) {
            (0, 0.0) => Ok(None),
            _ => refuse(text!(
                "options.shape is {shape} and options.radius {radius}; both must be 0 where options.mortar_side is not STICKSLIP_MORTAR_ANALYTIC"
            )),
        };
    }
    let shapes = [AnalyticShape::Plane, AnalyticShape::Sphere(radius), AnalyticShape::Cylinder(radius)];
    let shape = choose(shape, "options.shape", &shapes, 3)?;
    match (shape, radius == 0.0) {
        (AnalyticShape::Plane, false) => refuse(text!("options.radius is {radius}; it must be 0 of a plane")),
        (AnalyticShape::Sphere(_) | AnalyticShape::Cylinder(_), true) => {
            refuse("options.radius is 0; it must be positive (a ball, a bar) or negative (a cavity, a bore)".into())
        }
        _ if lines => {
            Ok(Some(if shape == AnalyticShape::Plane { AnalyticShape::Line } else { AnalyticShape::Circle(radius) }))
        }
        _ => Ok(Some(shape)),
    }
}

/// The options, checked.
pub(super) fn read_options(p: *const stickslip_options) -> Result<Choices> {
    let given = sized::read(p)?;
    // Every member by name: a new one does not compile until it is handled.
    let stickslip_options {
        struct_size: _,
        form,
        slip,
        weights: _,
        friction,
        mortar_side,
        multiplier_basis: _,
        quadrature,
        row_scale,
        new_contact,
        index_base,
        mu,
        augmentation,
        modulus,
        coverage_min,
        search_distance,
        no_shortcuts,
        shape,
        radius,
        integration,
        tangent,
        element_points,
        weak_coverage,
        turn_max,
        shear_limit,
        normals: _,
        threads,
        multiplier_space,
        model,
        thickness,
        decision,
        reserved,
    } = given;
    if reserved != 0 {
        let text = text!("options.reserved is {reserved}; it must be 0");
        return Err(Error::new(Kind::InvalidValue, text));
    }
    let decision = read_decision(decision, modulus)?;
    let friction = law(friction, "options.friction")?;
    let sides = [MortarSide::Deformable, MortarSide::Rigid, MortarSide::Rigid];
    let analytic = mortar_side == STICKSLIP_MORTAR_ANALYTIC;
    let mortar_side = choose(mortar_side, "options.mortar_side", &sides, 3)?;
    let numbers = [
        ("mu", mu),
        ("augmentation", augmentation),
        ("modulus", modulus),
        ("search_distance", search_distance),
        ("coverage_min", coverage_min),
        ("radius", radius),
        ("weak_coverage", weak_coverage),
        ("turn_max", turn_max),
        ("shear_limit", shear_limit),
    ];
    for (name, v) in numbers {
        if !v.is_finite() {
            return Err(Error::new(Kind::NotFinite, text!("options.{name} is {v}; it must be finite")));
        }
    }
    law_numbers(friction, mu, shear_limit, "options")?;
    if !(0..=MAX_THREADS).contains(&threads) {
        let text = text!("options.threads is {threads}; 0 to {MAX_THREADS} are allowed");
        return Err(Error::new(Kind::InvalidValue, text));
    }
    if modulus < 0.0 {
        return Err(Error::new(Kind::InvalidValue, text!("options.modulus is {modulus}; it must not be negative")));
    }
    let stiffness = match (augmentation, modulus) {
        (0.0, 0.0) => {
            let text = "options.augmentation and options.modulus are both 0; give one: rhat [F/L^3] or the softer body's Young's modulus";
            return Err(Error::new(Kind::MissingStiffness, text));
        }
        (0.0, e) => Stiffness::Modulus(e),
        (r, _) => Stiffness::Augmentation(r),
    };
    if decision == Decision::Points(0.0) {
        let text = "options.modulus is 0; STICKSLIP_DECISION_POINTS needs E*, the modulus of both bodies together";
        return Err(Error::new(Kind::MissingStiffness, text));
    }
    let measure = measure(read_model(model, "options.model")?, thickness, "options.thickness")?;
    let options = Options {
        decision,
        space: read_multiplier_space(multiplier_space, "options.multiplier_space")?,
        form: choose(form, "options.form", &[Form::Multiplier, Form::Augmented], 2)?,
        slip: slip_measure(slip, "options.slip")?,
        threads: (threads as usize).max(1),
        rule: rule(quadrature, "options.quadrature")?,
        scheme: read_scheme(integration, element_points)?,
        tangent: choose(
            tangent,
            "options.tangent",
            &[Tangent::Exact, Tangent::FrozenWeights, Tangent::FrozenNormals],
            3,
        )?,
        row_scale: choose(row_scale, "options.row_scale", &[RowScale::Force, RowScale::None], 2)?,
        new_contact: choose(
            new_contact,
            "options.new_contact",
            &[NewContact::Frictionless, NewContact::KeepFriction],
            2,
        )?,
        friction,
        mortar_side,
        shortcuts: read_shortcuts(no_shortcuts)?,
        mu,
        shear_limit: given_limit(shear_limit),
        coverage_min,
        weak_coverage,
        search_distance: (search_distance != 0.0).then_some(search_distance),
        turn_max: if turn_max == 0.0 { TURN_MAX } else { turn_max },
        ..Options::paper(stiffness)
    };
    let options = options.settle(read_wishes(&given)?);
    options.validate()?;
    let base = choose(index_base, "options.index_base", &[0, 1], 2)?;
    Ok(Choices { options, base, shape: read_shape(analytic, measure.is_some(), shape, radius)?, measure })
}
