//! What weighted gaps do not see: how far the surfaces really overlap at a point, and how far apart they really are where
//! they press (docs/formulation.md 4.7).
//!
//! A weighted gap is a mean over the facets around a node. It may read open where a body dents a facet that is coarser than the
//! contact, or closed where overlaps count as closed. So every node of either side is looked at (`pairing/nearest.rs`).
//!
//! Facets are chords: a round body and a hollow one whose nodes touch overlap by the sagittas of the hollow one, and where they are pressed
//! together, so that gaps and overlaps have the mean 0, by those of the round one, too. These do not count. Nor does what the
//! pressure there would make of a gap in any case: an overlap d changes the pressure by E d / h, so that with a modulus d counts
//! against h p / E, but never against more than h nor less than a tenth of that: before anything presses a
//! hundredth of a facet is as bad as a tenth is later.

use super::largest::{Largest, Scales};
use crate::interface::data::surface::Surface;
use crate::interface::pairing::seen::{Nearest, Seen};

/// An overlap counts in full against a facet where the pressure is this part of the modulus or more.
const WORTH: f64 = 0.1;
/// The least that it counts against, over the facet.
const LEAST: f64 = 0.1;

/// Against what an overlap counts where facets are so large `[L]`.
fn scale(size: f64, scales: &Scales) -> f64 {
    match scales.modulus {
        0.0 if scales.traction > 0.0 => size,
        0.0 => LEAST * size,
        modulus => size * (scales.traction / (WORTH * modulus)).clamp(LEAST, 1.0),
    }
}

/// The largest overlap, and the largest distance at which a node `presses`, of what was looked at. `scales`: with the largest traction;
/// `rounding` does not count.
#[inline(never)]
pub fn largest(
    one: &Surface,
    seen: &Seen,
    presses: &dyn Fn(usize) -> bool,
    scales: &Scales,
    rounding: f64,
) -> [Largest; 2] {
    let mut found = [Largest::default(); 2];
    let mut offer = |which: usize, n: &Nearest, gap: f64| {
        found[which].offer((gap - rounding).max(0.0), scale(n.size, scales), n.node);
    };
    // A mortar node behind a plate that is nearer to the facet's own nodes is in no body.
    let nearer = |n: &Nearest, a: usize| !seen.nearest[a].opposes && seen.nearest[a].gap.abs() < n.gap.abs();
    let hidden = |n: &Nearest| one.facets[n.facet].as_slice().iter().all(|&a| nearer(n, a));
    for n in seen.nearest.iter().filter(|n| n.opposes && n.gap < -n.sagittas[0] && !hidden(n)) {
        let pressed = one.rows(n.facet).as_slice().iter().any(|&a| presses(a));
        offer(0, n, -n.gap - n.sagittas[0] - if pressed { n.sagittas[1] } else { 0.0 });
    }
    let pressing = seen.front.iter().enumerate().filter(|(a, n)| n.gap.is_finite() && presses(*a));
    pressing.for_each(|(_, n)| offer(1, n, n.gap - n.sagittas[0] - n.sagittas[1]));
    found
}
