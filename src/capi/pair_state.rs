//! The stages of one pair with a state in the caller's memory, which carries planes, overlap and weights from one to the next:
//! nothing is checked or integrated twice, and the tangent contracts where `stickslip_pair_tangent` takes derivatives that
//! were expanded before.

use super::guard::guard;
use super::layout::Matrix;
use super::node::stickslip_node_response;
use super::pair_in::{Pair, node_tangents, read_previous, stickslip_pair, tractions};
use super::pair_out::{check_tangent, check_weights, write_force, write_gap, write_tangent, write_weights};
use super::raw::{self, refuse};
use crate::element::{FacetResponse, PairNow, PairTangent, pair_force, row_columns};
use crate::error::{Kind, Result};
use crate::geometry::Facet;
use crate::mortar::{self, NonmortarFrame, PairWeights, Segment, pair_motion};
use crate::quadrature::Rule;
use crate::shape::MAX_CORNERS;

/// What a state begins with, but for where the library lies: "stickslip" in letters of a keypad, and the state's version.
const MAGIC: u64 = 0x7842_5754_7547_0001;

/// What stands in the caller's memory, in this order.
#[repr(C)]
struct PairState {
    /// See [`magic`].
    magic: u64,
    /// As the pair's layout has it.
    column_major: bool,
    rule: &'static Rule,
    one: Facet,
    two: Facet,
    weights: PairWeights,
    frame: NonmortarFrame,
    segment: Option<Segment>,
}

/// Doubles that a state takes.
const SIZE: usize = size_of::<PairState>() / size_of::<f64>();
const _: () = assert!(align_of::<PairState>() == align_of::<f64>());
const _: () = assert!(!std::mem::needs_drop::<PairState>());

/// What a state of this process begins with: states point to tables of the library, which another process may have elsewhere.
fn magic() -> u64 {
    MAGIC ^ std::ptr::from_ref(&crate::quadrature::DEGREE_5).addr() as u64
}

/// The state at `p`.
fn state<'a>(p: *const f64) -> Result<&'a PairState> {
    raw::check(p, "state")?;
    let p = p.cast::<PairState>();
    // SAFETY: non-null and aligned; by the caller's contract as long as `stickslip_pair_state_size` says.
    if unsafe { (&raw const (*p).magic).read() } != magic() {
        let text = text!("state is not one that stickslip_pair_begin filled in this process");
        return refuse(Kind::InvalidValue, text);
    }
    // SAFETY: it was filled by `stickslip_pair_begin`, and by the caller's contract only copied since.
    Ok(unsafe { &*p })
}

impl PairState {
    /// Numbers of nodes.
    fn n(&self) -> (usize, usize) {
        (self.one.len(), self.two.len())
    }
}

/// How many doubles the state of a pair takes (below 290), for `stickslip_pair_begin`. It may be another number in another
/// version of the library, so it is to be asked for when the program runs.
///
/// Cost: nanoseconds; allocates nothing.
#[unsafe(no_mangle)]
pub extern "C" fn stickslip_pair_state_size() -> i64 {
    SIZE as i64
}

/// Stage 1 with a state: weights and gap of a pair in its current configuration, and what the other stages need of it. In
/// place of `stickslip_pair_weights` and `stickslip_pair_gap`, with their results. Paper (11), (13).
///
/// pair: see `stickslip_pair`; it and its arrays are read here and not kept. capacity: number of doubles in state, at least
/// `stickslip_pair_state_size`. state: output; opaque, the caller's, with nothing to give back. It may be copied, and be used by
/// several threads at once while no one fills it. It belongs to this process: it must not be stored. A refused call leaves it as it was.
/// Outputs, each may be NULL: n_ab (n1 x n1) and n_ac (n1 x n2) [L^2], row A; gap (3 n1), g[n_{n+1}, x_{n+1}] [L^3],
/// to be summed over the pairs of a node. Facets that do not overlap give zeros: not an error.
///
/// Errors: NULL_POINTER, STRUCT_SIZE, INVALID_SIZE, NOT_FINITE, DUPLICATE_NODE, DEGENERATE_FACET,
/// PROJECTION_NOT_CONVEX, INVALID_VALUE, BUFFER_TOO_SMALL, UNSUPPORTED (lines).
/// Cost: that of `stickslip_pair_weights` without derivatives; allocates nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_pair_begin(
    pair: *const stickslip_pair,
    capacity: i64,
    state: *mut f64,
    n_ab: *mut f64,
    n_ac: *mut f64,
    gap: *mut f64,
) -> i32 {
    guard(|| {
        let pair = &Pair::read(pair)?;
        let column_major = pair.column_major()?;
        raw::check(state, "state")?;
        raw::room(capacity, SIZE, "the doubles of a state")?;
        for (p, name) in [(n_ab, "n_ab"), (n_ac, "n_ac"), (gap, "gap")] {
            raw::check_optional(p, name)?;
        }
        pair.overlapping(|frame, segment, rule| {
            let weights = match segment {
                Some(segment) => PairWeights::integrate(frame, segment, rule),
                None => PairWeights::default(),
            };
            check_weights(&weights)?;
            if !gap.is_null() {
                write_gap(&mortar::gap(&weights, &pair.one, &pair.two), pair.one.len(), gap)?;
            }
            write_weights(&weights, pair.n(), n_ab, n_ac);
            let to = state.cast::<PairState>();
            // SAFETY: aligned, `capacity` doubles by the caller's declaration, and those are enough. Member by member, for
            // the large ones are then copied once. What they hold needs no end.
            unsafe {
                (&raw mut (*to).magic).write(magic());
                (&raw mut (*to).column_major).write(column_major);
                (&raw mut (*to).rule).write(rule);
                (&raw mut (*to).one).write(pair.one);
                (&raw mut (*to).two).write(pair.two);
                (&raw mut (*to).weights).write(weights);
                (&raw mut (*to).frame).copy_from_nonoverlapping(frame, 1);
                (&raw mut (*to).segment).copy_from_nonoverlapping(segment, 1);
            }
            Ok(())
        })
    })
}

/// The weighted gap of a pair at the positions of its state with other weights, those of t_n: g[n_n, x_{n+1}]. Paper (11).
///
/// state: of `stickslip_pair_begin`. n_ab_previous (n1 x n1), n_ac_previous (n1 x n2) [L^2], row A; both NULL: the weights of
/// now. gap (3 n1), output [L^3].
///
/// Errors: NULL_POINTER, INVALID_VALUE (state), NOT_FINITE.
/// Cost: nanoseconds; allocates nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_pair_state_gap(
    state: *const f64,
    n_ab_previous: *const f64,
    n_ac_previous: *const f64,
    gap: *mut f64,
) -> i32 {
    guard(|| {
        let pair = self::state(state)?;
        let previous = read_previous(pair.n(), n_ab_previous, n_ac_previous)?;
        raw::check(gap, "gap")?;
        let weights = previous.as_ref().unwrap_or(&pair.weights);
        write_gap(&mortar::gap(weights, &pair.one, &pair.two), pair.one.len(), gap)
    })
}

/// Stage 3 with a state: `stickslip_pair_residual` with the weights of now. Paper (23).
///
/// state: of `stickslip_pair_begin`. traction (3 n1): the multipliers lambda (multiplier form) or the projected tractions
/// p (augmented form) [F/L^2]; force (3 (n1 + n2)), output [F], in internal-force sign.
///
/// Errors: NULL_POINTER, INVALID_VALUE (state), NOT_FINITE.
/// Cost: nanoseconds; allocates nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_pair_state_residual(
    state: *const f64,
    traction: *const f64,
    force: *mut f64,
) -> i32 {
    guard(|| {
        let pair = self::state(state)?;
        let traction = tractions(traction, pair.one.len())?;
        raw::check(force, "force")?;
        write_force(&pair_force(&pair.weights, &traction), pair.n(), force)
    })
}

/// Stage 3 with a state: `stickslip_pair_tangent` with the weights of now and their derivatives, which are never expanded.
/// A pair whose facets do not overlap now has the terms of t_n alone. Where weights are frozen, the stateless call
/// serves. Paper (29)-(31).
///
/// state: of `stickslip_pair_begin`, where the pair's layout was read. n_ab_previous, n_ac_previous: weights of t_n [L^2], both
/// NULL for a pair that did not overlap then. traction (3 n1): lambda [F/L^2]. responses: n1 results of
/// `stickslip_node_respond`, from the gaps assembled over all pairs. row_scale (n1) multiplies the multiplier rows,
/// NULL: 1; r M_A [F/L^3] makes them forces. k: output, (6 n1 + 3 n2) squared, leading dimension ld >= 6 n1 + 3 n2;
/// rows and columns x1 (3 n1), x2 (3 n2), lambda (3 n1); overwritten, the block (lambda, lambda) with zeros.
///
/// Errors: NULL_POINTER, STRUCT_SIZE, INVALID_SIZE, NOT_FINITE, INVALID_VALUE (state).
/// Cost: 1 to 2 microseconds; allocates nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_pair_state_tangent(
    state: *const f64,
    n_ab_previous: *const f64,
    n_ac_previous: *const f64,
    traction: *const f64,
    responses: *const stickslip_node_response,
    row_scale: *const f64,
    k: *mut f64,
    ld: i64,
) -> i32 {
    guard(|| {
        let pair = self::state(state)?;
        let (n1, n2) = pair.n();
        let mut k = Matrix::new(k, 6 * n1 + 3 * n2, ld, pair.column_major)?;
        let previous = read_previous((n1, n2), n_ab_previous, n_ac_previous)?;
        let traction = tractions::<MAX_CORNERS, 3>(traction, n1)?;
        let nodes = node_tangents(&traction[..n1], responses, row_scale)?;
        let nodes = FacetResponse::new(nodes.each_ref());
        let mut t = PairTangent::default();
        let (frame, weights) = (&pair.frame, &pair.weights);
        let motion = |segment| pair_motion((frame, segment, pair.rule), weights, &nodes.traction, &mut t.forces);
        let gap = pair.segment.as_ref().map(motion);
        let now = gap.as_ref().map(|gap| PairNow { weights, gap: Some(gap) });
        row_columns::<3>((now.as_ref(), previous.as_ref()), &nodes, &mut t.rows);
        check_tangent(&t)?;
        write_tangent(&t, Some(weights), (n1, n2), &mut k);
        Ok(())
    })
}
