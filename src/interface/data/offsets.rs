//! Offsets of a surface's nodes: how far the surface that is meant lies behind the one that is meshed, along the normal into the
//! body `[L]` (docs/formulation 15.1). Positive ones open a gap (a clearance); negative ones close it (an interference, half
//! the thickness of a shell, the rise of a circle over its chord). They are the host's and belong to no history.

use super::node_data::check_length;
use super::surface::Surface;
use crate::error::{Error, Kind, Result};
use crate::features;
use crate::shape::MAX_CORNERS;

/// Checks the offsets of a surface; empty where all are 0: then there is no such effect.
pub fn checked(surface: &Surface, offsets: Option<Vec<f64>>) -> Result<Vec<f64>> {
    let Some(offsets) = offsets else { return Ok(Vec::new()) };
    let side = surface.side;
    check_length(side, offsets.len(), surface.len())?;
    if let Some(k) = offsets.iter().position(|h| !h.is_finite()) {
        return Err(Error::new(Kind::NotFinite, text!("offset of {side} node {k} is not finite")));
    }
    if offsets.iter().all(|h| *h == 0.0) {
        return Ok(Vec::new());
    }
    Ok(offsets)
}

/// Whether either side has any.
pub fn are_there((one, two): (&Surface, &Surface)) -> bool {
    features::OFFSETS.built && !(one.offsets.is_empty() && two.offsets.is_empty())
}

/// How far offsets, and what lies between the surfaces, close a gap, and how far they open one, at most `[L]`; neither is negative.
pub fn reach((one, two): (&Surface, &Surface)) -> (f64, f64) {
    let ((low, high), of_two) = (range(one), range(two));
    ((-low - of_two.0).max(0.0) + one.layer[0], (high + of_two.1).max(0.0) + one.layer[1])
}

/// The same of a non-mortar side whose other side has none.
pub fn reach_of(one: &Surface) -> (f64, f64) {
    let (low, high) = range(one);
    ((-low).max(0.0) + one.layer[0], high.max(0.0) + one.layer[1])
}

/// The least and the largest offset of a side.
fn range(side: &Surface) -> (f64, f64) {
    let first = side.offsets.first().copied().unwrap_or(0.0);
    side.offsets.iter().fold((first, first), |(low, high), h| (low.min(*h), high.max(*h)))
}

impl Surface {
    /// The offset of a node.
    pub fn offset(&self, a: usize) -> f64 {
        self.offsets.get(a).copied().unwrap_or(0.0)
    }

    /// Those of these nodes; 0 of the fourth one that a triangle does not have.
    pub fn offsets_of(&self, nodes: &[usize]) -> [f64; MAX_CORNERS] {
        std::array::from_fn(|k| nodes.get(k).map_or(0.0, |&a| self.offset(a)))
    }
}
