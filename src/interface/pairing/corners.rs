//! Copies of a node on a crease (docs/formulation.md 6.5) that meet the other side together, as in a corner.
//!
//! Copies share displacements. Where two of them touch, two normals hold the node, and a third condition, of sticking, would
//! be one of the two again: the matrix is singular. So a copy acts without friction in a step in which another one may be in
//! contact, too; one that is alone in contact has friction as any other node. Settled by t_n.

use crate::error::Result;
use crate::interface::data::history::History;
use crate::interface::data::setup::Setup;
use crate::memory;

/// A copy that is farther open than so many facets at t_n is not taken to close within the step: where the sides of an edge lean over the
/// other surface by 40 degrees it is open by 0.4.
const FACETS: f64 = 0.2;

/// Per node, whether it acts without friction in the step for the sake of a copy; empty where none does.
pub fn without_friction<const N: usize>(setup: &Setup<N>, h: &History, coverable: &[bool]) -> Result<Vec<bool>> {
    if setup.copies.is_empty() || !setup.effects.law.slips || !h.integrated {
        return Ok(Vec::new());
    }
    let mut all = memory::filled(false, coverable.len())?;
    for &[a, b] in &setup.copies {
        let (covered, surface) = (h.coverage[b], &setup.nonmortar);
        let near = || h.gap[b].dot(&h.normals[b]) <= FACETS * surface.size(h.areas[b], h.x1[b]) * covered;
        all[a] |=
            coverable[b] && covered > setup.options.coverage_min * h.areas[b] && setup.has_multiplier(b) && near();
    }
    Ok(all)
}
