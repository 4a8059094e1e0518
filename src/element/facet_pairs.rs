//! What a facet's tangent must know of its pairs, and their sums (docs/formulation 10.2).

use crate::dual::FacetSums;
use crate::error::{Error, Kind, Result};
use crate::mortar::{NonmortarFrame, PairWeights, Segment, height_gap};

/// The pairs of a non-mortar facet, by their number.
pub trait FacetPairs {
    /// How many there are.
    fn count(&self) -> usize;
    /// Number of a mortar facet's nodes.
    fn nodes(&self, pair: usize) -> usize;
    /// What overlaps now, if anything does.
    ///
    /// # Errors
    /// Those of the overlap.
    fn overlap(&self, pair: usize) -> Result<Option<Segment>>;
    /// The weights of now, as they were integrated.
    fn weights(&self, pair: usize) -> PairWeights;
    /// The dual weights of t_n of a pair that overlapped then.
    fn previous(&self, pair: usize) -> Option<PairWeights>;
}

/// The sums of a facet over its pairs.
///
/// # Errors
/// Those of the overlaps; [`Kind::InvalidValue`] where facets that do not overlap have weights.
pub fn facet_sums(frame: &NonmortarFrame, pairs: &impl FacetPairs) -> Result<FacetSums> {
    let mut sums = FacetSums::new(frame);
    for p in 0..pairs.count() {
        let weights = pairs.weights(p);
        match pairs.overlap(p)? {
            Some(overlap) => sums.add(&weights, &height_gap(frame, &overlap.mortar, &weights)),
            None if weights.ab.iter().chain(&weights.ac).flatten().all(|n| *n == 0.0) => {}
            None => {
                let text =
                    text!("n_ab, n_ac of pair {p} are not 0, and its facets do not overlap: not the weights of now");
                return Err(Error::new(Kind::InvalidValue, text));
            }
        }
    }
    Ok(sums)
}
