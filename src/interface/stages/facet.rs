//! Stage 1b: what the multipliers' basis makes of the weights of a facet's pairs (docs/formulation 10.1, 10.2). With the
//! standard basis nothing; the dual one depends on all pairs of a facet together.

use crate::dual::{DualBasis, FacetSums};
use crate::error::{Error, Result};
use crate::interface::data::active::Active;
use crate::interface::data::surface::Surface;
use crate::memory::{self, Store};
use crate::mortar::{NonmortarFrame, PairWeights, ParentWeights, Segment};

/// Puts the dual weights of a facet, whose pairs are those from place `first` on, in place of the integrated ones, which are
/// kept beside them.
pub fn facet(
    nonmortar: &Surface,
    active: &mut Active,
    first: usize,
    overlaps: (&NonmortarFrame, &[Segment]),
) -> Result<()> {
    let Some(pair) = active.pairs.get(first) else { return Ok(()) };
    let f = pair.one;
    let more = active.pairs.capacity() - active.integrated.len();
    memory::grow(&mut active.integrated, more)?;
    active.integrated.store_all(active.pairs[first..].iter().map(|pair| pair.weights))?;
    let (_, basis) = dual_basis(nonmortar, f, overlaps, &active.integrated[first..])?;
    for pair in &mut active.pairs[first..] {
        // A facet that has faded out has no weights.
        pair.weights = basis.as_ref().map_or_else(PairWeights::default, |basis| basis.weights(&pair.weights));
    }
    Ok(())
}

/// The sums of facet f over all of its pairs with these weights, and its basis, if it has not faded out. Against an analytic
/// surface there are no segments.
pub fn dual_basis(
    nonmortar: &Surface,
    f: usize,
    (frame, segments): (&NonmortarFrame, &[Segment]),
    weights: &[PairWeights],
) -> Result<(FacetSums, Option<DualBasis>)> {
    let sums = match segments {
        [] => FacetSums::of_areas(frame, weights),
        _ => FacetSums::of(frame, segments.iter().zip(weights)),
    };
    let basis = DualBasis::of(&sums).map_err(|error| of_points(segments, &error).unwrap_or(error));
    Ok((sums, basis.map_err(nonmortar.at(f))?))
}

/// Puts the dual weights of all pairs of parents in place of the integrated ones, which are kept beside them.
pub fn dual_parents(nonmortar: &Surface, active: &mut Active) -> Result<()> {
    memory::grow(&mut active.integrated_parents, active.parents.len())?;
    active.integrated_parents.store_all(active.parents.iter().map(|pair| pair.weights))?;
    let x1 = &active.x1;
    for pairs in active.parents.chunk_by_mut(|p, q| p.one == q.one) {
        let basis = nonmortar.parent_basis(pairs[0].one, x1, &mut pairs.iter().map(|pair| &pair.weights))?;
        for pair in pairs {
            pair.weights = basis.as_ref().map_or_else(ParentWeights::default, |b| b.parent_weights(&pair.weights));
        }
    }
    Ok(())
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
