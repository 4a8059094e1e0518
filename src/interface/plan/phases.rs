//! Facets in chunks, and chunks in phases: those of a phase have no rows in common, so that threads may add their blocks at
//! the same time. The order in which blocks are added up is that of phases and chunks, however many threads there are.

use super::numbering::Sides;
use super::pattern::FacetPairs;
use crate::error::Result;
use crate::memory::{self, Store};
use std::ops::Range;

/// Chunks at most: so many phases fit into the bits of a number.
const MOST_CHUNKS: usize = 64;
/// Facets of a chunk at least: the rows at the border of a chunk come from memory once a phase, and are few then.
const LEAST_FACETS: usize = 1024;

/// The phases of these pairs, each with its chunks of facets; `alone`: whether facets add to rows of their own nodes alone. If
/// not there is one chunk.
pub fn of(setup: Sides, pairs: &FacetPairs, alone: bool) -> Result<Vec<Vec<Range<usize>>>> {
    let (one, facets) = (&setup.nonmortar, setup.nonmortar.host_facets());
    let size = if alone { LEAST_FACETS.max(facets.div_ceil(MOST_CHUNKS)) } else { facets };
    // Per node the phases that have its rows.
    let mut own = memory::filled(0_u64, one.len())?;
    let mut mortar = memory::filled(0_u64, setup.mortar.len())?;
    let mut phases: Vec<Vec<Range<usize>>> = Vec::new();
    for first in (0..facets).step_by(size) {
        let chunk = first..facets.min(first + size);
        let mut taken = 0;
        for f in chunk.start..chunk.end {
            one.host_nodes(f).iter().for_each(|&a| taken |= own[a]);
            pairs.mortar_nodes(f).iter().for_each(|node| taken |= mortar[node.0 as usize]);
        }
        let phase = (!taken).trailing_zeros() as usize;
        for f in chunk.start..chunk.end {
            one.host_nodes(f).iter().for_each(|&a| own[a] |= 1 << phase);
            pairs.mortar_nodes(f).iter().for_each(|node| mortar[node.0 as usize] |= 1 << phase);
        }
        if phase == phases.len() {
            phases.store(Vec::new())?;
        }
        phases[phase].store(chunk)?;
    }
    Ok(phases)
}
