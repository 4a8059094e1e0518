//! A pair of facets and its weights: what integration gives, histories keep and all later stages take.

use crate::mortar::{PairWeights, ParentWeights};

/// The pairs of one configuration, whose weights act: of facets, or of facets of the host where either side has quadratic ones.
#[derive(Clone, Copy, Debug)]
pub enum Weighted<'a> {
    /// Of linear facets.
    Facets(&'a [PairRecord]),
    /// Of parents.
    Parents(&'a [ParentRecord]),
}

impl Weighted<'_> {
    /// How many there are.
    pub fn len(self) -> usize {
        match self {
            Weighted::Facets(pairs) => pairs.len(),
            Weighted::Parents(pairs) => pairs.len(),
        }
    }
}

/// The weights of one pair of facets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairRecord {
    /// Non-mortar facet.
    pub one: usize,
    /// Mortar facet.
    pub two: usize,
    /// Their weights; of parts of facets of the host (`parents.rs`) the covered area of each row alone, on the diagonal of n_AB.
    pub weights: PairWeights,
}

/// The weights of a pair of parents, with the numbers of both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParentRecord {
    /// Non-mortar parent.
    pub one: usize,
    /// Mortar parent.
    pub two: usize,
    /// Their weights.
    pub weights: ParentWeights,
}
