//! The points of an overlap one by one: those that its weights are sums over (`weights.rs`), to rounding.

use super::field::MultiplierSpace;
use super::pair_weights::PairWeights;
use super::points::{Fan, Maps, points, triangle_lanes};
use super::segment::{KindKernel, Kinds, NonmortarFrame, Segment};
use super::sub_pair::Side;
use crate::error::Result;
use crate::geometry::bilinear_map::Preimage;
use crate::geometry::{Projection, cross};
use crate::quadrature::Rule;
use crate::shape::{Basis, Cell, Isoparametric, MAX_CORNERS, MAX_PARENT_NODES, SingleBasis};
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

/// A point of an overlap of parts of facets of the host.
#[derive(Clone, Copy, Debug)]
pub struct PartPoint {
    /// Its share of the measure, as of [`OverlapPoint`].
    pub weight: f64,
    /// N_A, of the multipliers over the non-mortar part.
    pub own: [f64; MAX_CORNERS],
    /// N_B and N_C, of all nodes of both facets of the host; over an analytic surface the points of its frame.
    pub all: [[f64; MAX_PARENT_NODES]; 2],
}

impl PartPoint {
    /// As that of facets that have no nodes but these.
    pub fn overlap_point(&self) -> OverlapPoint {
        OverlapPoint { weight: self.weight, own: self.own, other: std::array::from_fn(|c| self.all[1][c]) }
    }
}

/// Shows `to` the points of an overlap of two parts, with a rule of [`super::rule_for`]: those that their weights are sums over, to rounding.
pub fn each_part_point(
    (frame, segment, rule): (&NonmortarFrame, &Segment, &Rule),
    sides: (Side, Side),
    space: MultiplierSpace,
    to: &mut dyn FnMut(&PartPoint) -> Result<()>,
) -> Result<()> {
    let (one, two) = (&frame.projection, &segment.mortar);
    let mut fan = Fan::new(frame, segment);
    while let Some([apex, p, q]) = fan.triangle() {
        for [u, v, w] in rule.triangle {
            let y = apex + p * *u + q * *v;
            let at = [frame.map.inverse([y.x, y.y]), segment.mortar_map.inverse([y.x, y.y])];
            let ([of_part, x1], [_, x2]) = (on_parent(sides.0, one, &at[0]), on_parent(sides.1, two, &at[1]));
            let own = match space {
                MultiplierSpace::Corner => sides.0.0.cell.values(x1[0], x1[1]),
                MultiplierSpace::Sub => of_part,
            };
            let all = [sides.0.0.values([x1[0], x1[1]]), sides.1.0.values([x2[0], x2[1]])];
            to(&PartPoint { weight: 0.5 * cross(p, q) * w, own, all })?;
        }
    }
    Ok(())
}

/// The functions of a part at a point of its projection, by its nodes, and where the point is in the parent's coordinates.
fn on_parent((parent, sub): Side, projection: &Projection, at: &Preimage) -> [[f64; MAX_CORNERS]; 2] {
    let mut found = [[0.0; MAX_CORNERS]; 2];
    for (k, n) in projection.shape.values(at.xi, at.eta).into_iter().enumerate().take(projection.shape.n) {
        let node = projection.node[k];
        found[0][node] = n;
        (0..2).for_each(|i| found[1][i] += n * parent.at[sub.nodes[node]][i]);
    }
    found
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
