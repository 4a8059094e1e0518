//! Stage 1b: what the multipliers' basis makes of the weights of a facet's pairs (docs/formulation.md 10.1, 10.2). With the
//! standard basis nothing; the dual one depends on all pairs of a facet together.

use crate::dual::{DualBasis, FacetSums};
use crate::error::{Error, Result};
use crate::interface::data::active::Active;
use crate::interface::data::options::MultiplierBasis;
use crate::interface::data::surface::{Surface, at_facet};
use crate::memory::Stored;
use crate::mortar::{PairWeights, Segment};
use std::ops::Range;

/// Puts the weights that act in place of the integrated ones, which are kept beside them.
pub fn facet(nonmortar: &Surface, basis: MultiplierBasis, active: &mut Active) -> Result<()> {
    if basis == MultiplierBasis::Standard {
        return Ok(());
    }
    active.integrated = active.pairs.iter().map(|pair| pair.weights).stored()?;
    let mut first = 0;
    while first < active.pairs.len() {
        let end = end_of_facet(active, first);
        let (_, basis) = dual_basis(nonmortar, active, first..end)?;
        for pair in &mut active.pairs[first..end] {
            // A facet that has faded out has no weights.
            pair.weights = basis.as_ref().map_or_else(PairWeights::default, |basis| basis.weights(&pair.weights));
        }
        first = end;
    }
    Ok(())
}

/// Where the pairs of the facet end whose first pair this is.
fn end_of_facet(active: &Active, first: usize) -> usize {
    let f = active.pairs[first].one;
    first + active.pairs[first..].iter().take_while(|pair| pair.one == f).count()
}

/// The sums of a facet over these pairs of it, and its basis, if it has not faded out.
pub fn dual_basis(nonmortar: &Surface, active: &Active, pairs: Range<usize>) -> Result<(FacetSums, Option<DualBasis>)> {
    let (f, weights) = (active.pairs[pairs.start].one, &active.integrated[pairs.start..pairs.end]);
    // Against an analytic surface there are none.
    let segments = active.segments.get(pairs.start..pairs.end).unwrap_or_default();
    let sums = match segments {
        [] => FacetSums::of_areas(&active.frames[f], weights),
        _ => FacetSums::of(&active.frames[f], segments.iter().zip(weights)),
    };
    let basis = DualBasis::of(&sums).map_err(|error| of_points(segments, &error).unwrap_or(error));
    Ok((sums, basis.map_err(at_facet(nonmortar.side, f))?))
}

/// Why a facet has no dual basis, where it is integrated by points: how many of them there are, and what to do.
#[cold]
fn of_points(segments: &[Segment], error: &Error) -> Option<Error> {
    let points = segments.first()?.points?;
    let count = |s: &Segment| s.points.map_or(0, |points| points.on_facet());
    let text = text!(
        "{} of its {} points lie on the mortar side, which is too few, or they lie badly: its dual multipliers are not determined; take STICKSLIP_INTEGRATION_HYBRID, which has overlaps where a facet is covered in part at the start of a step (with it: take a smaller step), or the standard multipliers",
        segments.iter().map(count).sum::<u32>(),
        points.count()
    );
    Some(Error::new(error.kind, text))
}
