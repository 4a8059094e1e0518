//! What may be wrong with an interface: for a host whose Newton does not converge, or whose solver finds a singular
//! matrix.

use super::guard::guard;
use super::handle::{either, handle, stickslip_interface};
use super::point::Point;
use super::raw;
use super::sized::{self, Sized64};
use crate::error::{Error, Kind, Result, Text};
use crate::interface::{Diagnosis, WorstPair};
use crate::law::State;
use crate::memory;
use libc::c_char;

/// Cause of a suspect: none of those below.
pub const STICKSLIP_CAUSE_OTHER: i32 = 0;
/// Cause of a suspect: the node is hardly covered.
pub const STICKSLIP_CAUSE_COVERAGE: i32 = 1;
/// Cause of a suspect: no displacement in this direction, of either side, has an equation. Declare the direction with
/// `stickslip_interface_set_constraints`, or take the multiplier's equation away.
pub const STICKSLIP_CAUSE_PRESCRIBED: i32 = 2;
/// Cause of a suspect: it sticks and has no slip history (STICKSLIP_NEW_CONTACT_KEEP).
pub const STICKSLIP_CAUSE_NEW: i32 = 3;

/// What `stickslip_interface_diagnose` finds. A NULL member is not wanted. Facets and nodes in the index base; -1 where
/// there is no such pair or node.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct stickslip_diagnosis {
    /// sizeof(stickslip_diagnosis).
    pub struct_size: u64,
    /// n1, input and output: STICKSLIP_STATE_... of the last iteration, -1 where unknown; those of this one.
    pub state: *mut i32,
    /// capacity: nodes where the matrix may be singular, the worst first.
    pub suspect_nodes: *mut i64,
    /// 3 capacity: unit vectors, in which direction [-].
    pub suspect_directions: *mut f64,
    /// capacity: size of the node's multiplier row in this direction over that of an ordinary row, below 1e-4 [-].
    pub suspect_ratios: *mut f64,
    /// capacity: STICKSLIP_CAUSE_...
    pub suspect_causes: *mut i32,
    /// Room in each of the four arrays of suspects; what there is no room for is left out.
    pub suspect_capacity: i64,
    /// The diagnosis in sentences, for the host's log; zero-terminated, cut where it is longer. For people: the words
    /// may change.
    pub text: *mut c_char,
    /// Room for text, at least 1; 1000 characters are enough. 0 where text is NULL.
    pub text_capacity: i64,
    /// Output: how many suspects there are, with room or without.
    pub suspects: i64,
    /// Output: nodes whose state differs from the one given in `state`; 0 without it.
    pub state_changes: i64,
    /// Output: nodes with STICKSLIP_STATE_GAP.
    pub nodes_gap: i64,
    /// Output: nodes with STICKSLIP_STATE_STICK.
    pub nodes_stick: i64,
    /// Output: nodes with STICKSLIP_STATE_SLIP.
    pub nodes_slip: i64,
    /// Output: the node that is covered least, of those above coverage_min.
    pub covered_node: i64,
    /// Output: its covered over full area [-].
    pub covered_fraction: f64,
    /// Output: the smallest overlap of a pair, over the area of its smaller facet [-].
    pub overlap: f64,
    /// Output: its non-mortar and mortar facet.
    pub overlap_facets: [i64; 2],
    /// Output: the largest warp of a facet of a pair: distance of a node from its plane over its longest edge [-].
    pub warp: f64,
    /// Output: the pair's facets.
    pub warp_facets: [i64; 2],
    /// Output: the largest angle between the planes of a pair's facets, in radians [-].
    pub angle: f64,
    /// Output: the pair's facets.
    pub angle_facets: [i64; 2],
    /// Output: the largest error of a pair's weights, by comparison with the degree-10 rule, over the area of its
    /// non-mortar facet [-]. 0 to rounding for triangles and parallelograms.
    pub error: f64,
    /// Output: the pair's facets.
    pub error_facets: [i64; 2],
}

// SAFETY: repr(C), struct_size first, numbers and raw pointers only.
unsafe impl Sized64 for stickslip_diagnosis {
    const NAME: &'static str = "stickslip_diagnosis";
    const FIRST: usize = 224;
}

/// What may be wrong at (x1, x2, lambda): the worst pairs, how many nodes have changed state since the last iteration,
/// and the nodes and directions in which the matrix may be singular because a multiplier row (nearly) vanishes there.
/// When a run has failed, or in every iteration of one that is looked into. What couples several nodes, as more
/// multipliers than displacements to react do, is not seen. The state of the handle stays as it is.
///
/// x1 (3 n1), x2 (3 n2): positions [L]; lambda (3 n1; without friction n1) [F/L^2]; sums: see
/// `stickslip_interface_sums`, or NULL; with sums no suspects are looked for, for a handle's rows are parts. out, input and output: its members point to the caller's arrays, which are
/// filled; its numbers are written. Against an analytic mortar side there are no pairs.
///
/// Errors: NULL_POINTER, STRUCT_SIZE, INVALID_SIZE (text_capacity, suspect_capacity), INVALID_VALUE (state; as
/// `stickslip_interface_sums`), NOT_FINITE, DEGENERATE_FACET, PROJECTION_NOT_CONVEX, UNDEFINED_NORMAL, UNSUPPORTED (what sums do not go with:
/// docs/compose.md).
/// Cost: those of a tangent, and every pair integrated once more with the degree-10 rule; allocates.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_diagnose(
    interface: *mut stickslip_interface,
    x1: *const f64,
    x2: *const f64,
    lambda: *const f64,
    sums: *const f64,
    out: *mut stickslip_diagnosis,
) -> i32 {
    guard(|| {
        let h = handle(interface)?;
        let point = Point::read(&h.inner, x1, x2, lambda, sums)?;
        sized::check_output(out)?;
        let wanted = sized::read(out)?;
        let room = check(&wanted)?;
        let before = states_before(&wanted, point.x1().len())?;
        let d = either!(&mut h.inner, c => c.diagnose(point.x1(), point.x2(), point.lambda(), point.sums())?);
        write(&wanted, out, &d, (&before, room, h.base))
    })
}

/// Room for suspects.
fn check(wanted: &stickslip_diagnosis) -> Result<usize> {
    raw::check_optional(wanted.state, "stickslip_diagnosis.state")?;
    raw::check_optional(wanted.suspect_nodes, "stickslip_diagnosis.suspect_nodes")?;
    raw::check_optional(wanted.suspect_directions, "stickslip_diagnosis.suspect_directions")?;
    raw::check_optional(wanted.suspect_ratios, "stickslip_diagnosis.suspect_ratios")?;
    raw::check_optional(wanted.suspect_causes, "stickslip_diagnosis.suspect_causes")?;
    if !wanted.text.is_null() {
        raw::count(wanted.text_capacity, 1, "stickslip_diagnosis.text_capacity")?;
    }
    raw::count(wanted.suspect_capacity, 0, "stickslip_diagnosis.suspect_capacity")
}

/// The states of the last iteration; none where they are not wanted.
fn states_before(wanted: &stickslip_diagnosis, n: usize) -> Result<Vec<i32>> {
    if wanted.state.is_null() {
        return Ok(Vec::new());
    }
    let states = raw::slice(wanted.state, n, "stickslip_diagnosis.state")?;
    match states.iter().position(|s| !(-1..=2).contains(s)) {
        None => memory::copied(states),
        Some(k) => {
            let text = text!("stickslip_diagnosis.state[{k}] is {}; it must be a state or -1", states[k]);
            Err(Error::new(Kind::InvalidValue, text))
        }
    }
}

fn write(
    wanted: &stickslip_diagnosis,
    out: *mut stickslip_diagnosis,
    d: &Diagnosis,
    (before, room, base): (&[i32], usize, i64),
) -> Result<()> {
    let text = if wanted.text.is_null() { Text::EMPTY } else { d.text(base as usize)? };
    let suspects = &d.suspects[..room.min(d.suspects.len())];
    raw::write_each(wanted.suspect_nodes, suspects.iter().map(|s| s.node as i64 + base));
    raw::write_each(
        wanted.suspect_directions,
        suspects.iter().flat_map(|s| [s.direction.x, s.direction.y, s.direction.z]),
    );
    raw::write_each(wanted.suspect_ratios, suspects.iter().map(|s| s.ratio));
    raw::write_each(wanted.suspect_causes, suspects.iter().map(|s| s.cause as i32));
    raw::write_each(wanted.state, d.states.iter().map(|s| *s as i32));
    if !wanted.text.is_null() {
        raw::write_text(wanted.text, wanted.text_capacity as usize, &text);
    }
    let count = |state| d.count(state) as i64;
    let value = |pair: &Option<WorstPair>| pair.map_or(0.0, |p| p.value);
    let facets = |pair: &Option<WorstPair>| pair.map_or([-1; 2], |p| p.facets.map(|f| f as i64 + base));
    sized::write(
        out,
        stickslip_diagnosis {
            suspects: d.suspects.len() as i64,
            state_changes: before.iter().zip(&d.states).filter(|(b, s)| **b != **s as i32).count() as i64,
            nodes_gap: count(State::Gap),
            nodes_stick: count(State::Stick),
            nodes_slip: count(State::Slip),
            covered_node: d.least_covered.map_or(-1, |(a, _)| a as i64 + base),
            covered_fraction: d.least_covered.map_or(0.0, |(_, f)| f),
            overlap: value(&d.overlap),
            overlap_facets: facets(&d.overlap),
            warp: value(&d.warp),
            warp_facets: facets(&d.warp),
            angle: value(&d.angle),
            angle_facets: facets(&d.angle),
            error: value(&d.error),
            error_facets: facets(&d.error),
            ..*wanted
        },
    );
    Ok(())
}
