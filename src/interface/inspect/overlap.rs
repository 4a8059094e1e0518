//! What weighted gaps do not see: how far the surfaces really overlap at a point, and how far apart they really are where
//! they press (docs/formulation 4.7).
//!
//! A weighted gap is a mean over the facets around a node. It may read open where a body dents a facet that is coarser than the
//! contact, or closed where overlaps count as closed. So every node of either side is looked at (`pairing/nearest.rs`).
//!
//! Facets are chords: a round body and a hollow one whose nodes touch overlap by the sagittas of the hollow one, and where they are pressed
//! together, so that gaps and overlaps have the mean 0, by those of the round one, too. These do not count.
//!
//! An overlap counts against the facet's edge. Where a node of the facet presses the bodies feel each other, and the weighted gap is 0 only
//! after a tip has gone some way into the facets around it, however fine these are: a corner by two thirds of an edge. There an
//! overlap counts against many edges.

use super::largest::Largest;
use crate::interface::data::surface::Surface;
use crate::interface::pairing::seen::{Nearest, Seen};

/// Edges that an overlap counts against where nodes of the facet press: a hundredth of an edge that nothing feels is as bad as a corner that
/// presses with a third of one.
const FELT: f64 = 30.0;

/// The largest overlap, and the largest distance at which a node `presses`, of what was looked at. `feels`: weights
/// know of overlaps there, and something presses. `rounding` does not count.
#[inline(never)]
pub fn largest(
    one: &Surface,
    seen: &Seen,
    (presses, feels): (&dyn Fn(usize) -> bool, &dyn Fn(usize) -> bool),
    rounding: f64,
) -> [Largest; 2] {
    let mut found = [Largest::default(); 2];
    let mut offer = |which: usize, n: &Nearest, gap: f64, scale: f64| {
        found[which].offer((gap - rounding).max(0.0), scale, n.node);
    };
    // A mortar node behind a plate that is nearer to the facet's own nodes is in no body.
    let nearer = |n: &Nearest, a: usize| !seen.nearest[a].opposes && seen.nearest[a].gap.abs() < n.gap.abs();
    let hidden = |n: &Nearest| one.facets[n.facet].as_slice().iter().all(|&a| nearer(n, a));
    for n in seen.nearest.iter().filter(|n| n.opposes && n.gap < -n.sagittas[0] && !hidden(n)) {
        let any = |what: &dyn Fn(usize) -> bool| one.rows(n.facet).as_slice().iter().any(|&a| what(a));
        let round = if any(presses) { n.sagittas[1] } else { 0.0 };
        offer(0, n, -n.gap - n.sagittas[0] - round, if any(feels) { FELT * n.size } else { n.size });
    }
    let pressing = seen.front.iter().enumerate().filter(|(a, n)| n.gap.is_finite() && presses(*a));
    pressing.for_each(|(_, n)| offer(1, n, n.gap - n.sagittas[0] - n.sagittas[1], n.size));
    found
}
