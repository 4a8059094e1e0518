//! What an interface computes, and what it has done.

use super::guard::guard;
use super::handle::{either, handle, stickslip_interface};
use super::raw;
use super::sized::{self, Sized64};
use libc::c_char;

/// What an interface has done since its creation.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct stickslip_counters {
    /// sizeof(stickslip_counters).
    pub struct_size: u64,
    /// Pairs that the searches found.
    pub pairs_tested: i64,
    /// Pairs that overlapped or touched.
    pub pairs_clipped: i64,
    /// Pairs with an area.
    pub pairs_integrated: i64,
    /// Pairs whose weights were differentiated.
    pub pairs_linearised: i64,
    /// Searches, without those of `stickslip_interface_pattern_coo`.
    pub searches: i64,
    /// Pairs active at the last evaluation, commit or creation.
    pub pairs_active: i64,
    /// Heap memory in use [bytes]: surfaces, history, the one before it, what the step and the last evaluation keep.
    pub bytes: i64,
    /// Time in search [s].
    pub seconds_search: f64,
    /// Time in clipping and integration [s].
    pub seconds_integration: f64,
    /// Time in derivatives and assembly of the tangent [s].
    pub seconds_assembly: f64,
    /// Pairs whose frozen weights served once more, in place of an integration: once an evaluation or commit.
    pub pairs_reused: i64,
    /// Slip increments computed, one a node and evaluation; 0 without friction.
    pub nodes_slipping: i64,
    /// Evaluations that ended with the finding that the surfaces are apart, without search and integration.
    pub evaluations_apart: i64,
    /// Commits that did.
    pub commits_apart: i64,
    /// Multiplier equations.
    pub multipliers: i64,
    /// Nodes that the law was asked about, one a node and point: residual and tangent of one point ask once.
    pub nodes_evaluated: i64,
    /// At the last evaluation (this member and those that follow, which add up to n1): nodes that were covered and had
    /// friction: a law with mu > 0, or rough.
    pub nodes_frictional: i64,
    /// Covered, without friction: mu = 0, or STICKSLIP_FRICTION_NONE.
    pub nodes_frictionless: i64,
    /// Covered now and not at t_n: without friction for this step (STICKSLIP_NEW_CONTACT_FRICTIONLESS).
    pub nodes_new: i64,
    /// Covered and tied.
    pub nodes_tied: i64,
    /// Not covered.
    pub nodes_uncovered: i64,
    /// Not covered, and the law was not asked: see STICKSLIP_SHORTCUT_UNCOVERED.
    pub nodes_left_out: i64,
    /// Boxes that the searches compared: O(n log n).
    pub boxes_visited: i64,
    /// Covered, and carried by neighbours (weak_coverage); counts with those that add up to n1.
    pub nodes_carried: i64,
}

// SAFETY: repr(C), struct_size first, numbers only.
unsafe impl Sized64 for stickslip_counters {
    const NAME: &'static str = "stickslip_counters";
    const FIRST: usize = 88;
}

/// Reads the counters into out.
///
/// Errors: NULL_POINTER, STRUCT_SIZE.
/// Cost: a copy.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_counters(
    interface: *mut stickslip_interface,
    out: *mut stickslip_counters,
) -> i32 {
    guard(|| {
        let h = &handle(interface)?.inner;
        sized::check_output(out)?;
        let c = either!(h, c => c.counters());
        sized::write(
            out,
            stickslip_counters {
                struct_size: 0,
                pairs_tested: c.pairs_tested,
                pairs_clipped: c.pairs_clipped,
                pairs_integrated: c.pairs_integrated,
                pairs_linearised: c.pairs_linearised,
                searches: c.searches,
                pairs_active: c.pairs_active as i64,
                bytes: either!(h, c => c.bytes()) as i64,
                seconds_search: c.seconds_search,
                seconds_integration: c.seconds_integration,
                seconds_assembly: c.seconds_assembly,
                pairs_reused: c.pairs_reused,
                nodes_slipping: c.nodes_slipping,
                evaluations_apart: c.evaluations_apart,
                commits_apart: c.commits_apart,
                multipliers: either!(h, c => c.multipliers()) as i64,
                nodes_evaluated: c.nodes_evaluated,
                nodes_frictional: c.nodes.frictional,
                nodes_frictionless: c.nodes.frictionless,
                nodes_new: c.nodes.new,
                nodes_tied: c.nodes.tied,
                nodes_uncovered: c.nodes.uncovered,
                nodes_left_out: c.nodes.left_out,
                boxes_visited: c.boxes_visited,
                nodes_carried: c.nodes.carried,
            },
        );
        Ok(())
    })
}

/// What the interface computes and why, one sentence an effect, for the host's log: friction, mortar side, weights,
/// surfaces that are apart, nodes that nothing can cover; "asked for" where the options name it, "chosen" where the scene let the library choose.
/// For people: the words may change.
///
/// text (capacity), output: zero-terminated, cut where it is longer; 1000 characters are enough.
///
/// Errors: NULL_POINTER, INVALID_SIZE (capacity < 1).
/// Cost: O(n1 + n2); allocates.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_effects(
    interface: *mut stickslip_interface,
    text: *mut c_char,
    capacity: i64,
) -> i32 {
    guard(|| {
        let h = &handle(interface)?.inner;
        raw::check(text, "text")?;
        let capacity = raw::count(capacity, 1, "capacity")?;
        let sentences = either!(h, c => c.effects()?);
        raw::write_text(text, capacity, &sentences);
        Ok(())
    })
}
