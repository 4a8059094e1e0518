//! The weights of a pair (paper (13)):
//!
//! n_AB = int N_A N_B da (both non-mortar), n_AC = int N_A N_C da (C mortar), over the overlap,
//! both at the same quadrature points, so that sum_B n_AB = sum_C n_AC holds at any rule.

use super::points::{Fan, points};
use super::segment::{CellKernel, Cells, NonmortarFrame, Segment};
use crate::quadrature::Rule;
use crate::shape::{Cell, MAX_NODES};
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
    /// Integrates the weights over a segment.
    pub fn integrate(frame: &NonmortarFrame, segment: &Segment, rule: &Rule) -> PairWeights {
        Cells::of(frame, segment).dispatch(Integrate { frame, segment, rule })
    }

    /// Covered area of node A: m_A = sum_B n_AB = int N_A da [L^2].
    #[inline]
    pub fn coverage(&self, a: usize) -> f64 {
        self.ab[a].iter().sum()
    }
}

struct Integrate<'a> {
    frame: &'a NonmortarFrame,
    segment: &'a Segment,
    rule: &'a Rule,
}

impl CellKernel for Integrate<'_> {
    type Output = PairWeights;

    #[inline(always)]
    fn run<L: Lanes, One: Cell, Two: Cell>(self) -> PairWeights {
        let Integrate { frame, segment, rule } = self;
        let mut ab = [[L::splat(0.0); MAX_NODES]; MAX_NODES];
        let mut ac = ab;
        let mut fan = Fan::new(frame, segment);
        while let Some(triangle) = fan.triangle() {
            for i in 0..rule.triangle_lanes.len() {
                let p = points::<L>(frame, segment, rule, &triangle, i);
                let (n1, n2) = (One::values(p.one.xi, p.one.eta), Two::values(p.two.xi, p.two.eta));
                for a in 0..One::NODES {
                    let wa = p.weight * n1[a];
                    for b in a..One::NODES {
                        ab[a][b] = wa.mul_add(n1[b], ab[a][b]);
                    }
                    for c in 0..Two::NODES {
                        ac[a][c] = wa.mul_add(n2[c], ac[a][c]);
                    }
                }
            }
        }
        let mut w = PairWeights::default();
        let node = &segment.mortar.node;
        for a in 0..One::NODES {
            w.ab[a] = L::sums(ab[a]).store();
            // n_AB is symmetric; made so to the last bit.
            for b in 0..a {
                w.ab[a][b] = w.ab[b][a];
            }
            let row = L::sums(ac[a]).store();
            for c in 0..Two::NODES {
                w.ac[a][node[c]] = row[c];
            }
        }
        w
    }
}
