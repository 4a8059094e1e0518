//! Mortar integration of one facet pair: the overlap, the weights n_AB and n_AC, their exact
//! derivatives, and the weighted gap (paper (11), (13); docs/formulation.md 2, 3). The same of a facet against an analytic
//! surface, without an overlap.
//!
//! Knows no contact law. Nothing here allocates.

mod analytic;
mod at_rest;
mod derivatives;
mod edges;
mod element_rule;
mod gap;
mod moments;
#[cfg(test)]
mod oracle;
mod points;
mod segment;
mod transport;
mod weights;

pub use analytic::{analytic_motion, analytic_weights};
pub use at_rest::facet_motion;
pub use derivatives::{ForceDerivatives, WeightDerivatives, pair_motion};
pub use element_rule::CellPoints;
pub use gap::{AlongNormal, GapDerivative, columns, gap};
pub use segment::{NonmortarFrame, Segment};
pub use weights::PairWeights;

/// Slots for the nodes of a pair: 0..4 non-mortar, 4..8 mortar, in the order the facets were given.
pub const PAIR_NODES: usize = 8;
/// First mortar slot.
pub const MORTAR: usize = 4;

/// The slots that a tangent looks at: all, or the non-mortar ones where the mortar side does not move.
pub const fn slots(moves: bool) -> usize {
    if moves { PAIR_NODES } else { MORTAR }
}
