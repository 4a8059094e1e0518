//! The weights of the part of an overlap of two lines where a field is negative, as of facets (`mortar/closed.rs`).

use super::facet::LineFacet;
use super::linear;
use super::segment::Measure;
use super::weights::{LineWeights, PartPair};
use crate::error::Result;
use crate::mortar::{MultiplierSpace, OverlapPoint};

impl LineWeights {
    /// Those of the points where the field with these values at the ends of the non-mortar line is negative; of lines with two nodes.
    pub fn closed(one: &LineFacet, two: &LineFacet, measure: Measure, field: [f64; 2]) -> LineWeights {
        let mut weights = LineWeights::default();
        if let Some(pair) = PartPair::of([one, two], (0, 0), MultiplierSpace::Corner) {
            weights.add_linear(&linear::closed_weights(&pair.segment, measure, field));
        }
        weights
    }
}

/// Shows `to` the points of two lines with two nodes, those that their weights are sums over.
pub fn each_point(
    one: &LineFacet,
    two: &LineFacet,
    measure: Measure,
    to: &mut dyn FnMut(OverlapPoint) -> Result<()>,
) -> Result<()> {
    if let Some(pair) = PartPair::of([one, two], (0, 0), MultiplierSpace::Corner) {
        linear::each_point(&pair.segment, measure, to)?;
    }
    Ok(())
}
