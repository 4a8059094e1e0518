//! The weights of the part of an overlap of two lines where a field is negative, as of facets: of the points that are there
//! (`mortar/closed.rs`), and of a region of its own (`mortar/closed_part.rs`), which is an interval.

use super::derivatives::LineDerivatives;
use super::facet::{LineFacet, MAX_LINE_NODES};
use super::linear::{self, Linear};
use super::segment::{LineSegment, Measure};
use super::weights::{LineWeights, PartPair};
use crate::error::Result;
use crate::mortar::{MultiplierSpace, OverlapPoint, PartPoint};
use crate::shape::{MAX_CORNERS, MAX_PARENT_NODES};
use crate::simd;

impl LineWeights {
    /// Those of the points where the field with these values at the ends of the non-mortar line is negative; of lines with two nodes.
    pub fn closed(one: &LineFacet, two: &LineFacet, measure: Measure, field: [f64; 2]) -> LineWeights {
        let mut weights = LineWeights::default();
        if let Some(pair) = PartPair::of([one, two], (0, 0), MultiplierSpace::Corner) {
            weights.add_linear(&linear::closed_weights(&pair.segment, measure, field));
        }
        weights
    }

    /// Those of the region.
    pub fn closed_part(one: &LineFacet, two: &LineFacet, measure: Measure, field: [f64; 2]) -> LineWeights {
        let mut weights = LineWeights::default();
        if let Some(segment) = closed_part(one, two, field) {
            weights.add_linear(&linear::weights(&segment, measure));
        }
        weights
    }
}

impl LineDerivatives {
    /// Of the weights of the region, to be multiplied with the field at fixed nodal values: where the field vanishes the region's end
    /// has the velocity of a node, and nothing to multiply it with.
    pub fn closed_part(one: &LineFacet, two: &LineFacet, measure: Measure, field: [f64; 2]) -> LineDerivatives {
        let mut d = LineDerivatives::default();
        if let Some(segment) = closed_part(one, two, field) {
            simd::dispatch(Linear(&segment, measure, [&mut d.ab, &mut d.ac]));
        }
        d
    }
}

/// The overlap as far as the field with these values at the ends of the first line is negative.
fn closed_part(one: &LineFacet, two: &LineFacet, field: [f64; 2]) -> Option<LineSegment> {
    let mut segment = PartPair::of([one, two], (0, 0), MultiplierSpace::Corner)?.segment;
    let at = segment.ends.map(|(s, _)| {
        let [a, b] = segment.shares(0, s);
        a * field[0] + b * field[1]
    });
    let [(from, _), (to, _)] = segment.ends;
    for (end, _) in segment.ends.iter_mut().zip(at).filter(|(_, value)| *value >= 0.0) {
        end.0 = from + (to - from) * (at[0] / (at[0] - at[1]));
    }
    (at[0] < 0.0 || at[1] < 0.0).then_some(segment)
}

/// Shows `to` the points of part `i` of the first line and part `j` of the second one.
pub fn each_part_point(
    facets: [&LineFacet; 2],
    parts: (usize, usize),
    (space, measure): (MultiplierSpace, Measure),
    to: &mut dyn FnMut(&PartPoint) -> Result<()>,
) -> Result<()> {
    let (Some(pair), mut done) = (PartPair::of(facets, parts, space), Ok(())) else { return Ok(()) };
    let rows = if space == MultiplierSpace::Corner { [0, 1] } else { pair.nodes[0] };
    pair.for_points(|p| {
        let (mut own, mut all) = ([0.0; MAX_CORNERS], [[0.0; MAX_PARENT_NODES]; 2]);
        rows.into_iter().enumerate().for_each(|(k, row)| own[k] = p.test[row]);
        all.iter_mut().zip(&p.n).for_each(|(all, n)| all[..MAX_LINE_NODES].copy_from_slice(n));
        let weight = p.ds * measure.at(p.shares[0], pair.segment.r);
        if done.is_ok() {
            done = to(&PartPoint { weight, own, all });
        }
    });
    done
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
