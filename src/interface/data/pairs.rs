//! A pair of facets and its weights: what integration gives, histories keep and all later stages take.

use crate::mortar::PairWeights;

/// The weights of one pair of facets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairRecord {
    /// Non-mortar facet.
    pub one: usize,
    /// Mortar facet.
    pub two: usize,
    /// Their weights.
    pub weights: PairWeights,
}
