//! The weights of the part of an overlap where a field is negative: those of the points where it is (docs/formulation 16.2). Where
//! the field is negative at all nodes they are the pair's own weights, to rounding: the points are the same.

use super::pair_weights::PairWeights;
use super::points::{Fan, Maps, points, triangle_lanes};
use super::segment::{KindKernel, Kinds, NonmortarFrame, Segment};
use super::weight_sums::Sums;
use crate::quadrature::Rule;
use crate::shape::{Basis, Isoparametric, MAX_CORNERS, SingleBasis};
use crate::simd::Lanes;

impl PairWeights {
    /// Those of the points of a segment where the field with these values at the non-mortar nodes is negative. Not of points that
    /// stand for an overlap. For the few facets that a border cuts: compiled once, for any processor.
    #[inline(never)]
    pub fn closed(frame: &NonmortarFrame, segment: &Segment, rule: &Rule, field: &[f64; MAX_CORNERS]) -> PairWeights {
        Kinds::of(frame, segment).plain(Closed { frame, segment, rule, field })
    }
}

struct Closed<'a> {
    frame: &'a NonmortarFrame,
    segment: &'a Segment,
    rule: &'a Rule,
    field: &'a [f64; MAX_CORNERS],
}

impl KindKernel for Closed<'_> {
    type Output = PairWeights;

    #[inline(always)]
    fn run<L: Lanes, One: SingleBasis, Two: Isoparametric>(self) -> PairWeights {
        let Closed { frame, segment, rule, field } = self;
        let (mut sums, zero) = (Sums::<L>::new(), L::splat(0.0));
        let maps = Maps::new(frame, segment);
        let mut fan = Fan::new(frame, segment);
        while let Some(triangle) = fan.triangle() {
            for four in triangle_lanes::<One, Two>(rule) {
                let mut p = points::<L>(&maps, four, &triangle);
                let n = One::Multiplier::values(p.one.xi, p.one.eta);
                let value = (0..MAX_CORNERS).fold(zero, |sum, a| n[a].mul_add(L::splat(field[a]), sum));
                p.weight = (-value).where_positive(p.weight, zero);
                sums.add::<One, Two>(&p);
            }
        }
        sums.weights::<One, Two>(segment)
    }
}
