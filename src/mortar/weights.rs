//! The weights of a pair (paper (13)):
//!
//! n_AB = int N_A N_B da (both non-mortar), n_AC = int N_A N_C da (C mortar), over the overlap,
//! both at the same quadrature points, so that sum_B n_AB = sum_C n_AC holds at any rule.

use super::element_rule;
use super::pair_weights::PairWeights;
use super::points::{Fan, Maps, points, triangle_lanes};
use super::segment::{KindKernel, Kinds, NonmortarFrame, Segment};
use super::weight_sums::Sums;
use crate::quadrature::Rule;
use crate::shape::{Isoparametric, SingleBasis};
use crate::simd::Lanes;

impl PairWeights {
    /// Integrates the weights over a segment; one of points has its own rule.
    pub fn integrate(frame: &NonmortarFrame, segment: &Segment, rule: &Rule) -> PairWeights {
        if let Some(points) = segment.points {
            return element_rule::weights(frame, segment, points);
        }
        Kinds::of(frame, segment).dispatch(Integrate { frame, segment, rule })
    }
}

struct Integrate<'a> {
    frame: &'a NonmortarFrame,
    segment: &'a Segment,
    rule: &'a Rule,
}

impl KindKernel for Integrate<'_> {
    type Output = PairWeights;

    #[inline(always)]
    fn run<L: Lanes, One: SingleBasis, Two: Isoparametric>(self) -> PairWeights {
        self.integrate::<L, One, Two>()
    }
}

impl Integrate<'_> {
    #[inline(always)]
    fn integrate<L: Lanes, One: SingleBasis, Two: Isoparametric>(self) -> PairWeights {
        let Integrate { frame, segment, rule } = self;
        let mut sums = Sums::<L>::new();
        let maps = Maps::new(frame, segment);
        let mut fan = Fan::new(frame, segment);
        while let Some(triangle) = fan.triangle() {
            for four in triangle_lanes::<One, Two>(rule) {
                sums.add::<One, Two>(&points::<L>(&maps, four, &triangle));
            }
        }
        sums.weights::<One, Two>(segment)
    }
}
