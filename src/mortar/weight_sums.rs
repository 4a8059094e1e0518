//! What weights are made of: integrals of the monomials of both facets' functions, four points at a time. Weights by themselves
//! (`weights.rs`) and those that come with their derivatives (`moments.rs`) add up the same, so that they have the same bits.

use super::pair_weights::PairWeights;
use super::points::Points;
use super::segment::Segment;
use crate::shape::{Basis, Cell, Isoparametric, SingleBasis};
use crate::simd::Lanes;

/// What weights are made of, by lanes. n_AB is symmetric, and both of its functions have the monomials of the map.
pub(super) struct Sums<L> {
    /// Integrals of 1, xi, eta, xi eta of one (those of N_A) with those of two (of N_C).
    cross: [[L; 4]; 4],
    /// Those of one with another (N_B have the same as N_A) that are new.
    own: [L; 5],
}

impl<L: Lanes> Sums<L> {
    #[inline(always)]
    pub fn new() -> Self {
        let zero = L::splat(0.0);
        Sums { cross: [[zero; 4]; 4], own: [zero; 5] }
    }

    /// Adds four points.
    #[inline(always)]
    pub fn add<One: SingleBasis, Two: Isoparametric>(&mut self, p: &Points<L>) {
        let Sums { cross, own } = self;
        let (xi, eta) = (p.one.xi, p.one.eta);
        let (x, e) = (p.weight * xi, p.weight * eta);
        let xe = x * eta;
        let n = [p.weight, x, e, xe];
        let with = [p.two.xi, p.two.eta, p.two.xi * p.two.eta];
        for j in 0..4 {
            cross[j][0] = cross[j][0] + n[j];
        }
        for j in 0..One::Multiplier::TERMS {
            for k in 1..Two::Displacement::TERMS {
                cross[j][k] = n[j].mul_add(with[k - 1], cross[j][k]);
            }
        }
        own[0] = x.mul_add(xi, own[0]);
        own[1] = e.mul_add(eta, own[1]);
        if One::Displacement::TERMS == 4 {
            let xxe = xe * xi;
            own[2] = own[2] + xxe;
            own[3] = xe.mul_add(eta, own[3]);
            own[4] = xxe.mul_add(eta, own[4]);
        }
    }

    /// The weights, once all points are in.
    #[inline(always)]
    pub fn weights<One: SingleBasis, Two: Isoparametric>(&self, segment: &Segment) -> PairWeights {
        let (Sums { cross, own }, zero) = (self, L::splat(0.0));
        let [n, x, e, xe] = L::sums([cross[0][0], cross[1][0], cross[2][0], cross[3][0]]).store();
        let [xx, ee, xxe, xee] = L::sums([own[0], own[1], own[2], own[3]]).store();
        let [xxee, ..] = L::sums([own[4], zero, zero, zero]).store();
        let ab = [[n, x, e, xe], [x, xx, xe, xxe], [e, xe, ee, xee], [xe, xxe, xee, xxee]];
        let (mut by_one, mut by_two) = ([zero; 4], [zero; 4]);
        for j in 0..One::Multiplier::TERMS {
            by_one[j] = One::Displacement::nodal_lanes(L::load(&ab[j]));
            // The nodes C are the corners, in their order.
            let with_two = Two::Displacement::nodal_lanes(L::sums(cross[j]));
            by_two[j] = Two::Cell::given(with_two, segment.mortar.is_reversed());
        }
        let (ab, ac) = (One::Multiplier::nodal(by_one), One::Multiplier::nodal(by_two));
        PairWeights::of_rows(One::Multiplier::FUNCTIONS, &ab, &ac)
    }
}
