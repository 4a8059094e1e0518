//! The weights of a pair (paper (13)):
//!
//! n_AB = int N_A N_B da (both non-mortar), n_AC = int N_A N_C da (C mortar), over the overlap,
//! both at the same quadrature points, so that sum_B n_AB = sum_C n_AC holds at any rule.

use super::segment::{NonmortarFrame, Segment};
use crate::quadrature::Rule;
use crate::shape::MAX_NODES;

/// Mortar weights of one pair [L^2].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PairWeights {
    /// n_AB.
    pub ab: [[f64; MAX_NODES]; MAX_NODES],
    /// n_AC.
    pub ac: [[f64; MAX_NODES]; MAX_NODES],
}

impl PairWeights {
    /// Integrates the weights over a segment.
    pub fn integrate(frame: &NonmortarFrame, segment: &Segment, rule: &Rule) -> PairWeights {
        let mut w = PairWeights::default();
        let mut ac = [[0.0; MAX_NODES]; MAX_NODES];
        segment.for_each_point(frame, rule, |p| {
            for a in 0..MAX_NODES {
                let wa = p.weight * p.n1[a];
                for b in 0..MAX_NODES {
                    w.ab[a][b] += wa * p.n1[b];
                    ac[a][b] += wa * p.n2[b];
                }
            }
        });
        // n_AB is symmetric; make it so to the last bit.
        for a in 0..MAX_NODES {
            for b in 0..a {
                w.ab[a][b] = w.ab[b][a];
            }
            for c in 0..MAX_NODES {
                w.ac[a][segment.mortar.node[c]] = ac[a][c];
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
