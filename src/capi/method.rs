//! How an interface is computed: for comparisons with other elements, and for systems that have to be symmetric.

use super::choice::choose;
use super::sized::Sized64;
use super::space::{STICKSLIP_SPACE_CORNER, multiplier_space as read_multiplier_space};
use super::{raw, sized};
use crate::error::{Error, Kind, Result};
use crate::interface::{
    COVERAGE_MIN, Decision, Form, MultiplierBasis, NewContact, Normals, Options, RowScale, Scheme, Shortcuts,
    Stiffness, TURN_MAX, Tangent, Weights, Wishes,
};
use crate::law::SlipMeasure;
use crate::quadrature::{DEGREE_1, DEGREE_2, DEGREE_4, DEGREE_5, DEGREE_6, DEGREE_10, Rule, cell};

/// Forces use lambda, rows the projection; the tangent is a sum of pairs and nodes. Default.
pub const STICKSLIP_FORM_MULTIPLIER: i32 = 0;
/// Forces use the projected traction (the paper's form). Same solutions.
/// Not with (UNSUPPORTED): points that decide (STICKSLIP_DECISION_POINTS); conserving weights
/// (STICKSLIP_WEIGHTS_CONSERVING); condensation; the tangent by sums of several handles; derivatives by positions of t_n and
/// by parameters.
pub const STICKSLIP_FORM_AUGMENTED: i32 = 1;
/// P(g[n_n,x] - g[n_{n+1},x]): invariant under rigid motion within a step. Default.
pub const STICKSLIP_SLIP_OBJECTIVE: i32 = 0;
/// P(g[n_n,x] - g[n_n,x_n]).
pub const STICKSLIP_SLIP_INCREMENT: i32 = 1;
/// P g[n_n,x]: the paper's literal (12); drifts on curved interfaces.
/// Not with (UNSUPPORTED): points that decide (STICKSLIP_DECISION_POINTS) and friction; conserving weights
/// (STICKSLIP_WEIGHTS_CONSERVING); wear or a bond (stickslip_layer).
pub const STICKSLIP_SLIP_PAPER: i32 = 2;
/// Of now; with STICKSLIP_DECISION_POINTS and friction, or an analytic surface, those of the last commit. Default.
pub const STICKSLIP_WEIGHTS_AUTO: i32 = 0;
/// Weights of the current configuration, linearised: large sliding.
pub const STICKSLIP_WEIGHTS_CURRENT: i32 = 1;
/// Weights frozen at the last commit.
pub const STICKSLIP_WEIGHTS_COMMITTED: i32 = 2;
/// Weights, normals and areas frozen at the first configuration: small displacements.
pub const STICKSLIP_WEIGHTS_REFERENCE: i32 = 3;
/// Weights and normals of now, and gaps that are functions of the places alone. A step closes them up to what the last one has left, and its
/// forces work exactly what they change by: nothing gains and nothing sinks, whatever slides and turns. For dynamics whose displacements follow
/// the mean of the velocities. Multipliers and `normal` are along the normals half way between t_n and now (docs/formulation 21).
/// Not with (UNSUPPORTED): the paper's slip measure (STICKSLIP_SLIP_PAPER); points that decide (STICKSLIP_DECISION_POINTS);
/// the augmented form (STICKSLIP_FORM_AUGMENTED); points that stand for overlaps (method.element_points); nodes that others
/// carry (weak_coverage > 0, the default of dual multipliers); an analytic mortar side whose frame has equations; normals of
/// the host; offsets; a layer between the surfaces (stickslip_interface_set_layer); nodes that handles share (owned has
/// STICKSLIP_NODE_SHARED); condensation; sums of several handles; derivatives of heat by displacements and multipliers;
/// derivatives by positions of t_n and by parameters.
pub const STICKSLIP_WEIGHTS_CONSERVING: i32 = 5;
/// Of now, unless weights are frozen or the host gives normals: then of the last commit. Default.
pub const STICKSLIP_NORMALS_AUTO: i32 = 0;
/// Normals nu of the last commit, as in the paper: data of a step. Where surfaces turn or slide on curved ones the forces lag
/// behind by half a step.
pub const STICKSLIP_NORMALS_COMMITTED: i32 = 1;
/// Normals of the current configuration, linearised: the size of a step does not decide how accurate normals are, a surface may
/// turn by any angle within it, and a step without load moves nothing. Tied surfaces
/// use no normals. Which facets look at each other follows the motion, too.
/// Not with (UNSUPPORTED): frozen weights; normals of the host.
pub const STICKSLIP_NORMALS_CURRENT: i32 = 2;
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
/// Dual, but with STICKSLIP_SPACE_SUB where nodes decide, or STICKSLIP_WEIGHTS_CONSERVING, standard. Default.
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
/// Not with (UNSUPPORTED): multipliers at all nodes of quadratic facets or lines (STICKSLIP_SPACE_SUB) and nodes that decide
/// (STICKSLIP_DECISION_NODES); sums of several handles.
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
/// Not with (UNSUPPORTED): points that decide (STICKSLIP_DECISION_POINTS); conserving weights
/// (STICKSLIP_WEIGHTS_CONSERVING); quadratic facets; lines.
pub const STICKSLIP_INTEGRATION_ELEMENTS: i32 = 1;
/// As ELEMENTS; but as SEGMENTS for all pairs of a non-mortar facet of which a point or a corner was uncovered at the last
/// commit. Patch tests fail.
pub const STICKSLIP_INTEGRATION_HYBRID: i32 = 2;
/// The tangent is exact. Default.
pub const STICKSLIP_TANGENT_EXACT: i32 = 0;
/// Weights of now, but constants in the tangent: fewer entries, no derivatives; Newton's method converges linearly.
/// Not with (UNSUPPORTED): derivatives by positions of t_n and by parameters.
pub const STICKSLIP_TANGENT_FROZEN_WEIGHTS: i32 = 1;
/// The tangent leaves out that facets' planes tilt: converges linearly too, and saves nothing; for comparisons with
/// codes that do so. Exact against an analytic mortar side.
/// Not with (UNSUPPORTED): lines; derivatives by positions of t_n and by parameters.
pub const STICKSLIP_TANGENT_FROZEN_NORMALS: i32 = 2;
/// A node is closed or open. Default.
pub const STICKSLIP_DECISION_NODES: i32 = 0;
/// Each point of an overlap is closed or open (docs/formulation 16): the border of the contact lies inside facets. modulus is needed,
/// and is E* of both bodies together: 1 / E* = (1 - nu1^2) / E1 + (1 - nu2^2) / E2, of a rigid one without its part. The answer depends
/// on it, by what vanishes with the facets' size. An augmentation beside it takes the place of r = 0.9 E* / h_A alone; r is then part of the
/// answer, too.
/// Not with (UNSUPPORTED): tied surfaces (STICKSLIP_FRICTION_TIED); friction and weights of now (STICKSLIP_WEIGHTS_CURRENT);
/// friction and the paper's slip measure (STICKSLIP_SLIP_PAPER); standard multipliers (STICKSLIP_BASIS_STANDARD); the
/// augmented form (STICKSLIP_FORM_AUGMENTED); points that stand for overlaps (method.element_points); nodes that others
/// carry (weak_coverage > 0, the default of dual multipliers); conserving weights (STICKSLIP_WEIGHTS_CONSERVING); an
/// analytic mortar side and weights of now (STICKSLIP_WEIGHTS_CURRENT); facets with mid nodes and weights of now
/// (STICKSLIP_WEIGHTS_CURRENT); a law of one's own; wear or a bond (stickslip_layer); nodes that handles share (owned has
/// STICKSLIP_NODE_SHARED); a history of nodes (stickslip_interface_set_committed) and friction; condensation; derivatives of
/// heat by displacements and multipliers; derivatives by positions of t_n and by parameters.
pub const STICKSLIP_DECISION_POINTS: i32 = 1;
/// Multiplier rows times r_A M_A: M_A (p_A - lambda_A), a force. Default.
pub const STICKSLIP_ROW_SCALE_FORCE: i32 = 0;
/// Multiplier rows as in the paper [L^3].
pub const STICKSLIP_ROW_SCALE_NONE: i32 = 1;
/// A node that was uncovered at t_n acts without friction for one step. Default.
pub const STICKSLIP_NEW_CONTACT_FRICTIONLESS: i32 = 0;
/// It keeps its mu (a sticking one then has zero tangential rows).
pub const STICKSLIP_NEW_CONTACT_KEEP: i32 = 1;

/// How an interface is computed: a host needs none of it (`method` of `stickslip_options` is NULL). Every member's 0 is the library's
/// choice, so that {.struct_size = sizeof(stickslip_method)} is what NULL is.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct stickslip_method {
    /// sizeof(stickslip_method).
    pub struct_size: u64,
    /// STICKSLIP_FORM_...
    pub form: i32,
    /// STICKSLIP_SLIP_... (with frozen weights OBJECTIVE acts as INCREMENT).
    pub slip: i32,
    /// STICKSLIP_WEIGHTS_...
    pub weights: i32,
    /// STICKSLIP_BASIS_...
    pub multiplier_basis: i32,
    /// STICKSLIP_NORMALS_...
    pub normals: i32,
    /// STICKSLIP_SPACE_..., for interfaces with quadratic facets: where the multipliers of such facets stand. Nodes of
    /// the non-mortar side at which no facet has a multiplier have no multiplier equations (-1).
    pub multiplier_space: i32,
    /// STICKSLIP_DECISION_...: whether nodes or points are closed.
    pub decision: i32,
    /// STICKSLIP_QUADRATURE_...
    pub quadrature: i32,
    /// STICKSLIP_ROW_SCALE_...
    pub row_scale: i32,
    /// STICKSLIP_NEW_CONTACT_...
    pub new_contact: i32,
    /// STICKSLIP_INTEGRATION_... (of no effect against an analytic mortar side: there is nothing to clip).
    pub integration: i32,
    /// STICKSLIP_TANGENT_... (of no effect with frozen weights). The answer does not depend on it.
    pub tangent: i32,
    /// Sum of the STICKSLIP_SHORTCUT_... that the library is not to take; 0 (default): it takes all.
    pub no_shortcuts: i32,
    /// Threads that `stickslip_interface_plan_values`, the residual and a commit may use, 1 to 256; 0 (default): the calling one
    /// alone. They end with the call. The results are the same bit for bit, whatever their number.
    pub threads: i32,
    /// Points along a side with STICKSLIP_INTEGRATION_ELEMENTS and HYBRID: 2 to 10; 0 (default): 4. Otherwise 0.
    pub element_points: i64,
    /// rhat [F/L^3]; 0 (default): use the modulus. One of the two is needed: nothing else has the unit
    /// of a stiffness. The answer does not depend on it, except with STICKSLIP_DECISION_POINTS.
    pub augmentation: f64,
    /// A node whose covered area over its full area [-] is at most this counts as uncovered; default 1e-8. Where a
    /// surface slides off an edge, the tractions of nodes that are hardly covered grow like the inverse of their
    /// coverage, and the least singular value of a scaled Newton matrix goes down to about a thousandth of this number.
    /// 1e-4 is milder there.
    pub coverage_min: f64,
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
    /// 0 (default): pi / 9, 20 degrees. What a turn below it costs: docs/host_steps.md.
    pub turn_max: f64,
}

// SAFETY: repr(C), struct_size first, numbers only.
unsafe impl Sized64 for stickslip_method {
    const NAME: &'static str = "stickslip_method";
    const FIRST: usize = size_of::<stickslip_method>();
}

/// All is the library's choice.
pub(super) const CHOSEN: stickslip_method = stickslip_method {
    struct_size: size_of::<stickslip_method>() as u64,
    form: STICKSLIP_FORM_MULTIPLIER,
    slip: STICKSLIP_SLIP_OBJECTIVE,
    weights: STICKSLIP_WEIGHTS_AUTO,
    multiplier_basis: STICKSLIP_BASIS_AUTO,
    normals: STICKSLIP_NORMALS_AUTO,
    multiplier_space: STICKSLIP_SPACE_CORNER,
    decision: STICKSLIP_DECISION_NODES,
    quadrature: STICKSLIP_QUADRATURE_DEGREE_5,
    row_scale: STICKSLIP_ROW_SCALE_FORCE,
    new_contact: STICKSLIP_NEW_CONTACT_FRICTIONLESS,
    integration: STICKSLIP_INTEGRATION_SEGMENTS,
    tangent: STICKSLIP_TANGENT_EXACT,
    no_shortcuts: 0,
    threads: 0,
    element_points: 0,
    augmentation: 0.0,
    coverage_min: 0.0,
    weak_coverage: 0.0,
    turn_max: 0.0,
};

/// The paper's element.
pub(super) static PAPER: stickslip_method =
    stickslip_method { multiplier_basis: STICKSLIP_BASIS_STANDARD, normals: STICKSLIP_NORMALS_COMMITTED, ..CHOSEN };

/// The host's, or the library's where it has none.
pub(super) fn read_method(p: *const stickslip_method) -> Result<stickslip_method> {
    if p.is_null() {
        return Ok(CHOSEN);
    }
    raw::check(p, "options.method")?;
    sized::read(p)
}

impl stickslip_method {
    /// The options of an interface, with what is asked for here, and the best of the rest.
    pub(super) fn put(&self, options: Options, what: Modelled) -> Result<Options> {
        let decisions = [Decision::Nodes, Decision::Points(what.modulus)];
        let tangents = [Tangent::Exact, Tangent::FrozenWeights, Tangent::FrozenNormals];
        let new_contacts = [NewContact::Frictionless, NewContact::KeepFriction];
        let settled = Options {
            decision: choose(self.decision, "method.decision", &decisions, 2)?,
            space: read_multiplier_space(self.multiplier_space, "method.multiplier_space")?,
            form: choose(self.form, "method.form", &[Form::Multiplier, Form::Augmented], 2)?,
            slip: slip_measure(self.slip, "method.slip")?,
            rule: rule(self.quadrature, "method.quadrature")?,
            scheme: read_scheme(self.integration, self.element_points)?,
            tangent: choose(self.tangent, "method.tangent", &tangents, 3)?,
            row_scale: choose(self.row_scale, "method.row_scale", &[RowScale::Force, RowScale::None], 2)?,
            new_contact: choose(self.new_contact, "method.new_contact", &new_contacts, 2)?,
            shortcuts: read_shortcuts(self.no_shortcuts)?,
            threads: read_threads(self.threads)?,
            coverage_min: finite("coverage_min", self.coverage_min, COVERAGE_MIN)?,
            weak_coverage: finite("weak_coverage", self.weak_coverage, 0.0)?,
            turn_max: finite("turn_max", self.turn_max, TURN_MAX)?,
            ..options
        };
        Ok(settled.settle(self.wishes(what.small_displacements)?))
    }

    /// With what is in force of what depends on other choices.
    pub(super) fn settled(&self, options: &Options) -> stickslip_method {
        // Each enumeration begins with AUTO.
        let [weights, multiplier_basis, normals] =
            [options.weights as i32, options.basis as i32, options.normals as i32].map(|k| k + 1);
        stickslip_method { weights, multiplier_basis, normals, ..*self }
    }

    /// What is not AUTO.
    fn wishes(&self, small_displacements: bool) -> Result<Wishes> {
        let bases = [None, Some(MultiplierBasis::Standard), Some(MultiplierBasis::Dual)];
        let [current, committed, reference, conserving] =
            [Weights::Current, Weights::Committed, Weights::Reference, Weights::Conserving].map(Some);
        let mut weights = match self.weights {
            STICKSLIP_WEIGHTS_CONSERVING => conserving,
            weights => choose(weights, "method.weights", &[None, current, committed, reference], 4).map_err(|_| {
                let text =
                    text!("method.weights is {weights}; the header names 0 to 3 and {STICKSLIP_WEIGHTS_CONSERVING}");
                Error::new(Kind::InvalidValue, text)
            })?,
        };
        if small_displacements {
            if weights.is_some() && weights != reference {
                let text = "options.small_displacements is 1, but method.weights asks for others than STICKSLIP_WEIGHTS_REFERENCE; leave one of them 0";
                return Err(Error::new(Kind::InvalidValue, text));
            }
            weights = reference;
        }
        Ok(Wishes {
            basis: choose(self.multiplier_basis, "method.multiplier_basis", &bases, 3)?,
            weights,
            normals: choose_normals(self.normals, "method.normals")?,
        })
    }

    /// The augmentation, or that of the modulus.
    pub(super) fn stiffness(&self, modulus: f64) -> Result<Stiffness> {
        let augmentation = finite("augmentation", self.augmentation, 0.0)?;
        match (augmentation, modulus) {
            (_, 0.0) if self.decision == STICKSLIP_DECISION_POINTS => {
                let text =
                    "options.modulus is 0; STICKSLIP_DECISION_POINTS needs E*, the modulus of both bodies together";
                Err(Error::new(Kind::MissingStiffness, text))
            }
            (0.0, 0.0) => {
                let text = "options.modulus and method.augmentation are both 0; give one: the softer body's Young's modulus, or rhat [F/L^3]";
                Err(Error::new(Kind::MissingStiffness, text))
            }
            (0.0, e) => Ok(Stiffness::Modulus(e)),
            (r, _) => Ok(Stiffness::Augmentation(r)),
        }
    }
}

/// What is modelled, as far as the method depends on it.
#[derive(Clone, Copy)]
pub(super) struct Modelled {
    pub modulus: f64,
    pub small_displacements: bool,
}

/// A number of the method; 0 stands for `chosen`.
fn finite(name: &str, value: f64, chosen: f64) -> Result<f64> {
    if !value.is_finite() {
        return Err(Error::new(Kind::NotFinite, text!("method.{name} is {value}; it must be finite")));
    }
    Ok(if value == 0.0 { chosen } else { value })
}

/// More than any one interface gains from.
const MAX_THREADS: i32 = 256;

fn read_threads(threads: i32) -> Result<usize> {
    if !(0..=MAX_THREADS).contains(&threads) {
        let text = text!("method.threads is {threads}; 0 to {MAX_THREADS} are allowed");
        return Err(Error::new(Kind::InvalidValue, text));
    }
    Ok((threads as usize).max(1))
}

fn read_shortcuts(off: i32) -> Result<Shortcuts> {
    let all = STICKSLIP_SHORTCUT_FRICTIONLESS
        | STICKSLIP_SHORTCUT_RIGID
        | STICKSLIP_SHORTCUT_APART
        | STICKSLIP_SHORTCUT_UNCOVERED;
    if off & !all != 0 {
        let text = text!("method.no_shortcuts is {off}; a sum of STICKSLIP_SHORTCUT_... is allowed");
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
    let name = "method.element_points";
    match choose(integration, "method.integration", &by_points, 3)? {
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

/// The normals of a STICKSLIP_NORMALS_... value; `None`: the library's choice.
pub(super) fn choose_normals(value: i32, name: &str) -> Result<Option<Normals>> {
    choose(value, name, &[None, Some(Normals::Committed), Some(Normals::Current)], 3)
}
