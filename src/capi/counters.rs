//! What an interface has done.

use super::guard::guard;
use super::interface::{either, handle, stickslip_interface};
use super::sized::{self, Sized64};

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
    /// Pairs active at the last evaluation.
    pub pairs_active: i64,
    /// Heap memory in use, roughly [bytes].
    pub bytes: i64,
    /// Time in search [s].
    pub seconds_search: f64,
    /// Time in clipping and integration [s].
    pub seconds_integration: f64,
    /// Time in derivatives and assembly of the tangent [s].
    pub seconds_assembly: f64,
    /// Pairs whose frozen weights served once more, in place of an integration.
    pub pairs_reused: i64,
    /// Slip increments computed, one a node and evaluation; 0 without friction.
    pub nodes_slipping: i64,
    /// Evaluations that ended with the comparison of two boxes: the surfaces were apart.
    pub evaluations_apart: i64,
    /// Commits that did.
    pub commits_apart: i64,
    /// Multiplier equations.
    pub multipliers: i64,
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
                pairs_active: either!(h, c => c.active_pairs()) as i64,
                bytes: either!(h, c => c.bytes()) as i64,
                seconds_search: c.seconds_search,
                seconds_integration: c.seconds_integration,
                seconds_assembly: c.seconds_assembly,
                pairs_reused: c.pairs_reused,
                nodes_slipping: c.nodes_slipping,
                evaluations_apart: c.evaluations_apart,
                commits_apart: c.commits_apart,
                multipliers: either!(h, c => c.multipliers()) as i64,
            },
        );
        Ok(())
    })
}
