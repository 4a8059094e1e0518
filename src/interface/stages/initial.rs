//! Multipliers to begin with.

use super::sums::NodeSums;
use crate::error::Result;
use crate::interface::data::multiplier::along_normal;
use crate::interface::pairing::given::Given;
use crate::memory::Stored;
use nalgebra::SVector;

/// lambda = -tau rhat_A h_A nu_A, h_A the node's size, on covered, closed nodes.
const INITIAL_TRACTION: f64 = 1e-6;
/// A gap (over the node's size) below this is closed at the start: rounding of a
/// rotated mesh is 1e-16 of its extent.
const CLOSED: f64 = 1e-8;

/// Multipliers for the first step: lambda = 0 at g = 0 is a body without support, so covered nodes that are closed start
/// with a compression of 1e-6 rhat_A h_A. `sums`: at t_n.
pub fn initial_multipliers<const N: usize>(given: Given<N>, sums: &[NodeSums]) -> Result<Vec<SVector<f64, N>>> {
    let areas = &given.history().areas;
    (0..given.nodes())
        .map(|a| {
            let nu = given.normal(a)?;
            let NodeSums { coverage, gap_now: gap, .. } = sums[a];
            let size = given.size(a);
            let covered = coverage > given.least_coverage(a);
            let closed = nu.dot(&gap) <= CLOSED * size * coverage;
            let rhat = given.augmentation(a) * areas[a];
            let size = if covered && closed { -INITIAL_TRACTION * rhat * size } else { 0.0 };
            Ok(along_normal(nu) * size)
        })
        .stored_if_ok()
}
