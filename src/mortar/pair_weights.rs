//! The weights of a pair as data: n_AB and n_AC (`weights.rs`).

use crate::shape::MAX_NODES;
use crate::simd::Lanes;

/// Mortar weights of one pair [L^2].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PairWeights {
    /// n_AB.
    pub ab: [[f64; MAX_NODES]; MAX_NODES],
    /// n_AC.
    pub ac: [[f64; MAX_NODES]; MAX_NODES],
}

impl PairWeights {
    /// From rows A, lanes B and C in the order of the facet as given.
    #[inline(always)]
    pub(super) fn of_rows<L: Lanes>(nodes: usize, ab: &[L; MAX_NODES], ac: &[L; MAX_NODES]) -> PairWeights {
        let mut w = PairWeights::default();
        for a in 0..nodes {
            (w.ab[a], w.ac[a]) = (ab[a].store(), ac[a].store());
            // n_AB is symmetric; made so to the last bit.
            for b in 0..a {
                w.ab[a][b] = w.ab[b][a];
            }
        }
        w
    }

    /// Covered area of node A: m_A = sum_B n_AB = int N_A da [L^2].
    #[inline]
    pub fn coverage(&self, a: usize) -> f64 {
        self.ab[a].iter().sum()
    }
}
