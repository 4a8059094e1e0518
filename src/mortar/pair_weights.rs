//! The weights of a pair as data: n_AB and n_AC (`weights.rs`).

use crate::shape::{MAX_CORNERS, MAX_NODES};
use crate::simd::Lanes;

/// Mortar weights of one pair [L^2].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PairWeights {
    /// n_AB, rows A.
    pub ab: [[f64; MAX_NODES]; MAX_CORNERS],
    /// n_AC, rows A.
    pub ac: [[f64; MAX_NODES]; MAX_CORNERS],
}

impl PairWeights {
    /// From the rows of so many multipliers, lanes B and C in the order of the facet as given. Of standard multipliers
    /// alone: what is below the diagonal of n_AB is taken from above it.
    #[inline(always)]
    pub(super) fn of_rows<L: Lanes>(multipliers: usize, ab: &[L; MAX_CORNERS], ac: &[L; MAX_CORNERS]) -> PairWeights {
        let mut w = PairWeights::default();
        for a in 0..multipliers {
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
