//! How far a point is from contact equilibrium: for a host's test of convergence.

use super::guard::guard;
use super::handle::{either, handle, stickslip_interface};
use super::node::{read_node, stickslip_node};
use super::point::Point;
use super::raw;
use super::sized::{self, Sized64};
use crate::error::{Error, Kind, Result};
use crate::interface::{Equilibrium, Largest, Scales};
use crate::law::Measure;

/// What `stickslip_interface_equilibrium` finds: three violations, each of the node where it is largest over its scale.
/// Nodes in the index base; -1 where all is zero, and the scale is then the least of all nodes.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct stickslip_equilibrium {
    /// sizeof(stickslip_equilibrium).
    pub struct_size: u64,
    /// Input: Young's modulus of the softer body [F/L^2], no matter where the augmentation comes from; 0: not known.
    pub modulus: f64,
    /// Input: traction_scale is at least this, the largest of earlier steps for example, so that a step that takes the
    /// load away is not judged by its rounding [F/L^2]; 0: those of now alone.
    pub least_traction: f64,
    /// Output: largest penetration, or opening under pressure: g_N over the covered area; of tied surfaces, of the change
    /// of the gap [L].
    pub gap: f64,
    /// Output: what to compare it with: h traction_scale / modulus, h the root of the node's area M_A (with lines about their length); without a modulus
    /// h alone [L].
    pub gap_scale: f64,
    /// Output: largest traction that the law forbids: tension, what is beyond the cone, what an open or uncovered node
    /// has, a component in a prescribed direction, of a carried node the difference from its carriers [F/L^2].
    pub traction: f64,
    /// Output: what to compare it with: the interface's largest traction, that of a node covered in part times the part
    /// [F/L^2].
    pub traction_scale: f64,
    /// Output: largest slip in this step of a node that sticks, or slip against or across the traction; of tied surfaces
    /// along the surface [L].
    pub slip: f64,
    /// Output: what to compare it with, as gap_scale [L].
    pub slip_scale: f64,
    /// Output: the node of gap.
    pub gap_node: i64,
    /// Output: the node of traction.
    pub traction_node: i64,
    /// Output: the node of slip.
    pub slip_node: i64,
    /// Output: how far the surfaces have slid since the weights in use were made: the distance along the surface of the places
    /// where a node's traction acts on the two sides, times the part that the traction is of traction_scale; the largest over
    /// slide_scale. A node that touched at t_n and has opened by less than it has slid counts in full: what it says of its gap is of a chord.
    /// No violation, and 0 with weights of now, and of tied surfaces. Where weights are frozen, contact is sought
    /// and forces act on the mortar side as if nothing had slid, so that a solution is wrong by about this length [L].
    pub slide: f64,
    /// Output: what to compare it with: the size of the facets around the node, however many they are. A slide of half of it is
    /// within what a mesh shows [L].
    pub slide_scale: f64,
    /// Output: the node of slide.
    pub slide_node: i64,
    /// Output: how far the surface has turned since weights of the reference were made: the angle between a node's normals of then and of
    /// now, times the part that its traction is of traction_scale; the largest. So it is with STICKSLIP_WEIGHTS_COMMITTED of the turn since
    /// t_n at nodes about which points slip: turn / mu is the part of their friction that is wrong. No violation, and 0 with all other weights. Pressure goes
    /// on acting along the first normals, so that this part of it acts along the surface as it is now, as a shear that friction has
    /// not allowed. Of tied surfaces offsets act along the first normals, whatever the weights: 0 without offsets. In radians [-].
    pub turn: f64,
    /// Output: the node of turn.
    pub turn_node: i64,
    /// Output: what of a traction the law would not allow if it had turned with the surface since t_n, the largest; compare it with
    /// traction_scale. No violation, and 0 with normals of now, with those of the host, and of tied surfaces. With STICKSLIP_NORMALS_COMMITTED
    /// pressure acts along the normals of t_n, so that a step that turns a surface is wrong by about this: beyond 0.01 tell it, beyond 0.1 take
    /// a smaller step, or STICKSLIP_NORMALS_CURRENT [F/L^2].
    pub lag: f64,
    /// Output: the node of lag.
    pub lag_node: i64,
    /// Output: the same over the interface: lag times area, summed up over the nodes, so that parts of an interface add up; 0 as lag. Beyond
    /// 0.02 of its scale forces are wrong by more than a mesh shows [F].
    pub lag_force: f64,
    /// Output: what to compare it with: the tractions times area in the same way; of a node that slips friction's part alone, where that is a tenth
    /// of it or more [F].
    pub lag_force_scale: f64,
    /// Output: how far a node of either side is really in the other body, whatever the weighted gaps say, beyond what the sagittas of
    /// curved facets are; the largest over penetration_scale. No violation; 0 of tied surfaces. Facets that are coarser than the contact
    /// do not feel it, and overlaps that count as closed press nothing: beyond 0.003 of its scale tell it, and end no run that never pressed beyond 0.02;
    /// beyond 0.1 an interface that has pressed before has lost its contact. Facets that are finer than the contact as non-mortar side, or STICKSLIP_DECISION_POINTS, see more [L].
    pub penetration: f64,
    /// Output: what to compare it with: the longest edge of the smaller facet there; 30 of them where nodes of the facet press and weights
    /// are those of now or of t_n, for a corner that presses lies two thirds of an edge deep however fine the facets are [L].
    pub penetration_scale: f64,
    /// Output: the non-mortar node nearest to penetration.
    pub penetration_node: i64,
    /// Output: how far apart the surfaces really are all around a node that presses, in the same way; the largest over apart_scale. Beyond 0.1 of it the
    /// step is wrong [L].
    pub apart: f64,
    /// Output: what to compare it with: that longest edge [L].
    pub apart_scale: f64,
    /// Output: the node of apart.
    pub apart_node: i64,
}

// SAFETY: repr(C), struct_size first, numbers only.
unsafe impl Sized64 for stickslip_equilibrium {
    const NAME: &'static str = "stickslip_equilibrium";
    const FIRST: usize = 96;
}

/// How far (x1, x2, lambda) is from contact equilibrium, whatever augmentation, row scale and form are: for the test of
/// convergence, beside the forces' residual of each body. The multiplier rows cannot serve there, for they go with the
/// augmentation. Converged is a point with gap <= t gap_scale, traction <= t traction_scale and slip <= t slip_scale; a
/// traction is then known to about t traction_scale, if the modulus is given. t = 1e-10 is within what Newton's method
/// reaches.
///
/// With gbar = g_N over the covered area a node must have lambda_N <= 0, gbar >= 0, lambda_N gbar = 0, and a tangential
/// part within the cone, on it where it slips, the slip along it: the complementarity and Coulomb's law that paper (17),
/// (22), (24) project on. Of the three states the nearest is taken, a length counting as the traction modulus / h times
/// it. What rounding makes of positions does not count: 8 last digits of the largest coordinate that is passed, in a gap
/// and in a slip, and modulus / h times that in a traction. Nodes without any multiplier equation have no part in it.
///
/// With STICKSLIP_WEIGHTS_COMMITTED and _REFERENCE look at slide, too: a point may be in equilibrium with weights that no longer
/// belong to it. Beyond half of slide_scale take smaller steps (COMMITTED alone), or STICKSLIP_WEIGHTS_CURRENT;
/// so do, with _REFERENCE, where turn is more than a few hundredths.
///
/// x1 (3 n1), x2 (3 n2): positions [L]; lambda (3 n1; without friction n1) [F/L^2]; sums: see
/// `stickslip_interface_sums`, or NULL; with sums every handle finds the same but for the largest coordinate, which is
/// that of its own part. out, input and output: modulus and least_traction are read, all others are written. Call it
/// before the commit.
///
/// Errors: NULL_POINTER, STRUCT_SIZE, NOT_FINITE, INVALID_VALUE (modulus, least_traction; as
/// `stickslip_interface_sums`), DEGENERATE_FACET, PROJECTION_NOT_CONVEX, UNDEFINED_NORMAL, UNSUPPORTED (what sums do not go with:
/// docs/compose.md).
/// Cost: as `stickslip_interface_states`; after a residual at the same positions no integration.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_equilibrium(
    interface: *mut stickslip_interface,
    x1: *const f64,
    x2: *const f64,
    lambda: *const f64,
    sums: *const f64,
    out: *mut stickslip_equilibrium,
) -> i32 {
    guard(|| {
        let h = handle(interface)?;
        let point = Point::read(&h.inner, x1, x2, lambda, sums)?;
        let (given, scales) = read_scales(out)?;
        let found =
            either!(&mut h.inner, c => c.equilibrium(point.x1(), point.x2(), point.lambda(), point.sums(), &scales)?);
        sized::write(out, equilibrium_of(given, &found, h.base)?);
        Ok(())
    })
}

/// What a caller says of its problem.
pub(super) fn read_scales(out: *mut stickslip_equilibrium) -> Result<(stickslip_equilibrium, Scales)> {
    sized::check_output(out)?;
    let given = sized::read(out)?;
    let modulus = not_negative(given.modulus, "stickslip_equilibrium.modulus")?;
    let traction = not_negative(given.least_traction, "stickslip_equilibrium.least_traction")?;
    Ok((given, Scales { modulus, traction }))
}

/// What was found, beside what the caller gave.
pub(super) fn equilibrium_of(
    given: stickslip_equilibrium,
    found: &Equilibrium,
    base: i64,
) -> Result<stickslip_equilibrium> {
    let node = |largest: &Largest| largest.node.map_or(-1, |a| a as i64 + base);
    let (gap, traction, slip, slide, turn) = (found.gap, found.traction, found.slip, found.slide, found.turn);
    let (lag, penetration, apart) = (found.lag, found.penetration, found.apart);
    let numbers = [gap, traction, slip, slide, turn, lag, penetration, apart].map(|l| [l.value, l.scale]);
    raw::check_results("equilibrium", numbers.as_flattened())?;
    raw::check_results("equilibrium", &found.lag_force)?;
    Ok(stickslip_equilibrium {
        gap: gap.value,
        gap_scale: gap.scale,
        traction: traction.value,
        traction_scale: traction.scale,
        slip: slip.value,
        slip_scale: slip.scale,
        gap_node: node(&gap),
        traction_node: node(&traction),
        slip_node: node(&slip),
        slide: slide.value,
        slide_scale: slide.scale,
        slide_node: node(&slide),
        turn: turn.value,
        turn_node: node(&turn),
        lag: lag.value,
        lag_node: node(&lag),
        lag_force: found.lag_force[0],
        lag_force_scale: found.lag_force[1],
        penetration: penetration.value,
        penetration_scale: penetration.scale,
        penetration_node: node(&penetration),
        apart: apart.value,
        apart_scale: apart.scale,
        apart_node: node(&apart),
        ..given
    })
}

fn not_negative(v: f64, name: &str) -> Result<f64> {
    let kind = if v.is_finite() { Kind::InvalidValue } else { Kind::NotFinite };
    if v >= 0.0 && v.is_finite() {
        return Ok(v);
    }
    Err(Error::new(kind, text!("{name} is {v}; it must be finite and not negative")))
}

/// The same of one node, for hosts that go through the stages: its violations of the contact conditions, from the gaps
/// summed over all its pairs. The node's augmentation has no part in it.
///
/// node: see `stickslip_node`. stiffness >= 0: a length times this is a traction, modulus / h with h the root of the
/// node's area [F/L^3]; it serves to find the nearest of the three states. rounding >= 0: what rounding makes of a
/// length that is zero [L]; it does not count, nor does stiffness times it in a traction. Outputs, each may be NULL: gap
/// [L], traction [F/L^2], slip [L]. Compare them with what the struct `stickslip_equilibrium` says.
///
/// Errors: NULL_POINTER, STRUCT_SIZE, NOT_FINITE, INVALID_VALUE.
/// Cost: below a microsecond; allocates nothing. Paper: as `stickslip_interface_equilibrium`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_node_equilibrium(
    node: *const stickslip_node,
    stiffness: f64,
    rounding: f64,
    gap: *mut f64,
    traction: *mut f64,
    slip: *mut f64,
) -> i32 {
    guard(|| {
        let (friction, law_node) = read_node(node)?;
        let given = sized::read(node)?;
        let (stiffness, rounding) = (not_negative(stiffness, "stiffness")?, not_negative(rounding, "rounding")?);
        raw::check_optional(gap, "gap")?;
        raw::check_optional(traction, "traction")?;
        raw::check_optional(slip, "slip")?;
        let v = friction.violation(
            &law_node,
            &Measure {
                coverage: given.coverage,
                coverage_previous: given.coverage_previous,
                stiffness,
                rounding,
                traction_rounding: stiffness * rounding,
            },
        );
        raw::check_results("gap, traction, slip", &[v.gap, v.traction, v.slip])?;
        raw::write(gap, &[v.gap]);
        raw::write(traction, &[v.traction]);
        raw::write(slip, &[v.slip]);
        Ok(())
    })
}
