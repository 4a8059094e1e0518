//! The points of an overlap one by one: those that its weights are sums over (`weights.rs`), to rounding.

use super::pair_weights::PairWeights;
use super::points::{Fan, Maps, points, triangle_lanes};
use super::segment::{KindKernel, Kinds, NonmortarFrame, Segment};
use crate::error::Result;
use crate::quadrature::Rule;
use crate::shape::{Basis, Cell, Isoparametric, MAX_CORNERS, SingleBasis};
use crate::simd::Lanes;

/// A point of an overlap.
#[derive(Clone, Copy, Debug, Default)]
pub struct OverlapPoint {
    /// Its share of the measure [L^2]; of lines with their thickness.
    pub weight: f64,
    /// N_A, by the nodes of the non-mortar facet.
    pub own: [f64; MAX_CORNERS],
    /// N_C, of the mortar facet.
    pub other: [f64; MAX_CORNERS],
}

impl PairWeights {
    /// The weights of those of these points where the field with these values at the non-mortar nodes is negative.
    pub fn negative(points: &[OverlapPoint], field: &[f64; MAX_CORNERS]) -> PairWeights {
        let mut n = PairWeights::default();
        for OverlapPoint { weight, own, other } in points {
            if own.iter().zip(field).map(|(n, value)| n * value).sum::<f64>() >= 0.0 {
                continue;
            }
            for (a, own_a) in own.iter().enumerate() {
                (0..MAX_CORNERS).for_each(|b| n.ab[a][b] += weight * own_a * own[b]);
                (0..MAX_CORNERS).for_each(|c| n.ac[a][c] += weight * own_a * other[c]);
            }
        }
        n
    }
}

/// Shows `to` the points of a segment; not of points that stand for an overlap. Compiled once, for any processor.
pub fn each_point(
    frame: &NonmortarFrame,
    segment: &Segment,
    rule: &Rule,
    to: &mut dyn FnMut(OverlapPoint) -> Result<()>,
) -> Result<()> {
    Kinds::of(frame, segment).plain(EachPoint { frame, segment, rule, to })
}

struct EachPoint<'a> {
    frame: &'a NonmortarFrame,
    segment: &'a Segment,
    rule: &'a Rule,
    to: &'a mut dyn FnMut(OverlapPoint) -> Result<()>,
}

impl KindKernel for EachPoint<'_> {
    type Output = Result<()>;

    #[inline(always)]
    fn run<L: Lanes, One: SingleBasis, Two: Isoparametric>(self) -> Result<()> {
        let EachPoint { frame, segment, rule, to } = self;
        let maps = Maps::new(frame, segment);
        let mut fan = Fan::new(frame, segment);
        while let Some(triangle) = fan.triangle() {
            for four in triangle_lanes::<One, Two>(rule) {
                let p = points::<L>(&maps, four, &triangle);
                let weights = p.weight.store();
                let own = One::Multiplier::values(p.one.xi, p.one.eta).map(L::store);
                let other = Two::Displacement::values(p.two.xi, p.two.eta).map(L::store);
                for (lane, &weight) in weights.iter().enumerate().filter(|(_, weight)| **weight != 0.0) {
                    let given = Two::Cell::given(L::load(&other.map(|n| n[lane])), segment.mortar.is_reversed());
                    to(OverlapPoint { weight, own: own.map(|n| n[lane]), other: given.store() })?;
                }
            }
        }
        Ok(())
    }
}
