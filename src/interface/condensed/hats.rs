//! The linear functions of the corners of quadratic facets as sums of the facets' own (docs/formulation 12.6): with
//! N^lin_B = N_B + sum_m c_Bm N_m the rows (C R)_B = R_B + sum_m c_Bm R_m of a host have -m_B lambda_B of the dual multipliers, and
//! nothing of the others.

use crate::dual::corner_shares;
use crate::error::Result;
use crate::interface::data::surface::Surface;
use crate::memory::{self, Store};

/// c_Bm of nodes m that have no multiplier; none on linear facets.
#[derive(Debug)]
pub struct Hats {
    /// Where those of each node B begin; one more at the end.
    first: Vec<usize>,
    /// m and c_Bm.
    shares: Vec<(usize, f64)>,
}

impl Hats {
    /// Of a surface.
    pub fn of(surface: &Surface) -> Result<Hats> {
        let mut all = Vec::new();
        if let Some(parents) = &surface.parents {
            for facet in &parents.facets {
                let (c, nodes) = (corner_shares(facet.parent), facet.as_slice());
                for (b, k) in (0..facet.parent.corners()).flat_map(|b| (0..nodes.len()).map(move |k| (b, k))) {
                    if c[b][k] != 0.0 && !surface.has_row(nodes[k]) {
                        all.store((nodes[b], nodes[k], c[b][k]))?;
                    }
                }
            }
        }
        let mut all = memory::sorted(&all, |p, q| (p.0, p.1).cmp(&(q.0, q.1)))?;
        all.dedup_by_key(|share| (share.0, share.1));
        let mut hats = Hats { first: memory::with_room(surface.len() + 1)?, shares: Vec::new() };
        for node in 0..=surface.len() {
            hats.first.store(all.partition_point(|share| share.0 < node))?;
        }
        hats.shares.store_all(all.iter().map(|share| (share.1, share.2)))?;
        Ok(hats)
    }

    /// m and c_Bm of node B.
    pub fn get(&self, b: usize) -> &[(usize, f64)] {
        &self.shares[self.first[b]..self.first[b + 1]]
    }
}
