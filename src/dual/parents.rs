//! Dual multipliers at the corners of a quadratic facet (docs/formulation 12.6). The linear functions of its corners are sums of
//! its own, N^lin_B = sum_k c_Bk N_k, so that the matrix m_AB = int N^lin_A N^lin_B follows from its weights, and from it the basis
//! as that of a linear facet.

use super::basis::DualBasis;
use super::sums::FacetSums;
use crate::error::Result;
use crate::mortar::ParentWeights;
use crate::shape::{MAX_CORNERS, MAX_PARENT_NODES, Parent};
use crate::simd::rolled;

/// c_Bk: 1 at the own corner, 1/2 at the mid nodes beside it, 1/4 at the centre.
pub fn corner_shares(parent: &Parent) -> [[f64; MAX_PARENT_NODES]; MAX_CORNERS] {
    let mut c = [[0.0; MAX_PARENT_NODES]; MAX_CORNERS];
    for k in 0..parent.n {
        let n = parent.cell.values(parent.at[k][0], parent.at[k][1]);
        (0..parent.corners()).for_each(|b| c[b][k] = n[b]);
    }
    c
}

impl DualBasis {
    /// That of a facet of this area, the sum of its parts', with all of its pairs; `None` where it has faded out.
    ///
    /// # Errors
    /// As [`DualBasis::of`].
    pub fn of_parent(
        parent: &Parent,
        area: f64,
        pairs: &mut dyn Iterator<Item = &ParentWeights>,
    ) -> Result<Option<DualBasis>> {
        let (nodes, c) = (parent.corners(), corner_shares(parent));
        let (gamma, by_points) = ([0.0; MAX_CORNERS], false);
        let mut sums = FacetSums { nodes, area, mass: [[0.0; MAX_CORNERS]; MAX_CORNERS], gamma, by_points };
        for weights in pairs {
            for (a, b) in (0..nodes).flat_map(|a| (0..nodes).map(move |b| (a, b))) {
                sums.mass[a][b] += (0..parent.n).map(|k| weights.ab[a][k] * c[b][k]).sum::<f64>();
            }
        }
        DualBasis::of(&sums)
    }

    /// A pair's share of the dual weights, as [`DualBasis::weights`].
    #[inline(never)] // it is met several times
    pub fn parent_weights(&self, pair: &ParentWeights) -> ParentWeights {
        let mut dual = ParentWeights::default();
        for (n, to) in [(&pair.ab, &mut dual.ab), (&pair.ac, &mut dual.ac)] {
            for k in 0..rolled(MAX_PARENT_NODES) {
                let column = self.dual(&[n[0][k], n[1][k], n[2][k], n[3][k]]);
                (0..self.nodes).for_each(|a| to[a][k] = column[a]);
            }
        }
        dual
    }
}
