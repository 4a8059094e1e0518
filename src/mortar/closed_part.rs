//! The part of an overlap where a field sigma = sum_A N_A sigma_A of the non-mortar facet is negative, as a region of its own
//! (docs/formulation 16.8), and the derivatives of integrals of sigma over it.
//!
//! In the non-mortar facet's coordinates (xi, eta) sigma is bilinear, and a line xi = const is straight in the plane. So the region is
//! cut into strips between those xi where the overlap has a vertex or sigma = 0 crosses its edge. In a strip each line xi = const has
//! one interval of the overlap, by its convex polygon, and of that one where sigma < 0; their ends are smooth functions of xi.
//! Where both facets are parallelograms or triangles and the border is straight, the rules are exact.
//!
//! At fixed nodal values the region moves with the coordinates: its border does not count, and what is left is
//! D int sigma N = int sigma D(N j) d(xi, eta) + the flux of (v2 - v1) . n through the mortar facet's edges within the closed part.
//!
//! For the few facets that a border cuts: compiled once, for any processor.

use super::chain::{Chain, Component, ForceDerivatives};
use super::edges::{intervals, line};
use super::element_rule::{Derivatives, Point, add_weights, lanes};
use super::pair_weights::PairWeights;
use super::segment::{KindKernel, Kinds, NonmortarFrame, Segment};
use super::slots::MORTAR_CORNER;
use crate::geometry::clip::MAX_VERTICES;
use crate::geometry::edge_interval::EdgeInterval;
use crate::geometry::{Vec2, cross};
use crate::quadrature::line::{GAUSS_4, GAUSS_6};
use crate::shape::{Isoparametric, MAX_CORNERS, SingleBasis};
use crate::simd::{Lanes, Plain};

/// Within a strip d sigma / d eta changes by this factor at most: then its border, a hyperbola whose pole is a strip's width away, is
/// known to 1e-9 at six points.
const BEND: f64 = 2.0;
/// Strips that one is cut into for that. A border that bends more sharply has next to no area beside its bend.
const PIECES: usize = 8;
/// Vertices of an overlap, and twice its edges.
const BREAKS: usize = 3 * MAX_VERTICES;

/// A region.
pub struct ClosedPart<'a> {
    frame: &'a NonmortarFrame,
    segment: &'a Segment,
    field: &'a [f64; MAX_CORNERS],
    /// sigma and y in powers 1, xi, eta, xi eta.
    sigma: [f64; 4],
    y: [Vec2; 4],
}

impl<'a> ClosedPart<'a> {
    /// Of a segment that has an overlap, not points that stand for one, and a field with these values at the non-mortar nodes.
    pub fn new(frame: &'a NonmortarFrame, segment: &'a Segment, field: &'a [f64; MAX_CORNERS]) -> ClosedPart<'a> {
        let (facet, mut sigma, mut y) = (&frame.projection, [0.0; 4], [Vec2::zeros(); 4]);
        for k in 0..facet.shape.n {
            for i in 0..4 {
                sigma[i] += facet.shape.coefficients[k][i] * field[k];
                y[i] += facet.y[k] * facet.shape.coefficients[k][i];
            }
        }
        ClosedPart { frame, segment, field, sigma, y }
    }

    /// n_AB and n_AC over it.
    pub fn weights(&self) -> PairWeights {
        let mut weights = PairWeights::default();
        self.each(&mut |at| add_weights(&mut weights, self.segment, &Point::of_both(self.frame, self.segment, at)));
        weights
    }

    /// Puts the derivatives of int sigma N_B and - int sigma N_C over it at fixed nodal values in the place of the first component of
    /// `forces`.
    pub fn motion(&self, forces: &mut ForceDerivatives) {
        let (frame, segment) = (self.frame, self.segment);
        let mut plane = Derivatives::zero();
        self.each(&mut |at| {
            let point = Point::of_both(frame, segment, at);
            plane.add((frame, segment), &point, &[*self.field], &[0.0; MAX_CORNERS]);
        });
        let [_, edges] = intervals::<Plain>(&frame.projection, &segment.mortar, &frame.plane);
        edges.iter().flatten().for_each(|edge| self.add_edge(edge, &mut plane));
        Kinds::of(frame, segment).plain(ToNodes { frame, segment, plane, forces });
    }

    /// Where sigma = 0 meets the line p + t q, 0 < t < 1: its xi, and t.
    fn crossings(&self, p: Vec2, q: Vec2) -> [Option<[f64; 2]>; 2] {
        let (s, mut l) = (&self.sigma, self.y.map(|y| cross(y, q)));
        l[0] -= cross(p, q);
        // Both are bilinear and 0: without eta a quadratic equation for xi.
        let c = [
            l[0] * s[2] - l[2] * s[0],
            l[0] * s[3] + l[1] * s[2] - l[2] * s[1] - l[3] * s[0],
            l[1] * s[3] - l[3] * s[1],
        ];
        let root = (c[1] * c[1] - 4.0 * c[0] * c[2]).max(0.0).sqrt();
        let w = -0.5 * (c[1] + if c[1] < 0.0 { -root } else { root });
        let [of_s, of_l] = [s, &l].map(|v| v.iter().map(|v| v.abs()).sum::<f64>());
        [w / c[2], c[0] / w].map(|xi| {
            let (by_s, by_l) = (s[2] + s[3] * xi, l[2] + l[3] * xi);
            let eta = match by_s.abs() * of_l >= by_l.abs() * of_s {
                true => -(s[0] + s[1] * xi) / by_s,
                false => -(l[0] + l[1] * xi) / by_l,
            };
            let at = self.y[0] + self.y[1] * xi + (self.y[2] + self.y[3] * xi) * eta;
            let t = (at - p).dot(&q) / q.norm_squared();
            (t > 0.0 && t < 1.0 && xi.is_finite()).then_some([xi, t])
        })
    }

    /// Shows `to` points of it: xi, eta, and the weight there.
    fn each(&self, to: &mut dyn FnMut([f64; 3])) {
        let (vertices, mut breaks, mut n) = (self.segment.polygon.vertices(), [0.0; BREAKS], 0);
        for (k, &p) in vertices.iter().enumerate() {
            let q = vertices[(k + 1) % vertices.len()];
            let [from, end] = [p, q].map(|y| self.frame.map.inverse([y.x, y.y]).xi);
            // The other root may lie outside of the facet, where its map folds: then it is no point of the edge, between whose ends xi grows
            // or falls.
            let is_on_edge = |xi: &f64| (from.min(end)..=from.max(end)).contains(xi);
            let crossings = self.crossings(p, q - p).into_iter().flatten().map(|[xi, _]| xi).filter(is_on_edge);
            for xi in std::iter::once(from).chain(crossings) {
                breaks[n] = xi;
                n += 1;
            }
        }
        sort_few(&mut breaks[..n]);
        for strip in breaks[..n].windows(2) {
            let mut from = strip[0];
            for piece in 1..=PIECES {
                let end = if piece == PIECES { strip[1] } else { self.smooth_until(from, strip[1]) };
                for [at, weight] in GAUSS_6 {
                    let xi = from + at * (end - from);
                    if let Some([low, high]) = self.interval(xi) {
                        let weight = weight * (end - from) * (high - low);
                        GAUSS_4.iter().for_each(|[t, w]| to([xi, low + t * (high - low), weight * w]));
                    }
                }
                if !(end < strip[1]) {
                    break;
                }
                from = end;
            }
        }
    }

    /// The end of a strip from `from` to `end` in which the border does not bend much.
    fn smooth_until(&self, from: f64, end: f64) -> f64 {
        let [_, _, s, slope] = self.sigma;
        let (first, last) = (s + slope * from, s + slope * end);
        let bent = match last / first {
            ratio if ratio > BEND => first * BEND,
            ratio if ratio > 0.0 && ratio < 1.0 / BEND => first / BEND,
            _ => return end,
        };
        ((bent - s) / slope).clamp(from.min(end), from.max(end))
    }

    /// Where on the line of this xi the overlap is, and closed.
    fn interval(&self, xi: f64) -> Option<[f64; 2]> {
        let (vertices, from, along) =
            (self.segment.polygon.vertices(), self.y[0] + self.y[1] * xi, self.y[2] + self.y[3] * xi);
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for (k, &p) in vertices.iter().enumerate() {
            let q = vertices[(k + 1) % vertices.len()];
            let [side, other] = [p, q].map(|p| cross(p - from, along));
            if (side < 0.0) != (other < 0.0) {
                let at = p + (q - p) * (side / (side - other));
                let eta = (at - from).dot(&along) / along.norm_squared();
                (low, high) = (low.min(eta), high.max(eta));
            }
        }
        let (value, slope) = (self.sigma[0] + self.sigma[1] * xi, self.sigma[2] + self.sigma[3] * xi);
        let border = -value / slope;
        match slope {
            slope if slope > 0.0 => high = high.min(border),
            slope if slope < 0.0 => low = low.max(border),
            _ if value >= 0.0 => return None,
            _ => {}
        }
        (high > low).then_some([low, high])
    }

    /// Adds the flux through the closed part of a mortar edge.
    fn add_edge(&self, edge: &EdgeInterval, plane: &mut Derivatives<1>) {
        let (one, two) = (&self.frame.projection, &self.segment.mortar);
        let (p, q, normal) = line(&two.y, edge);
        let (from, to) = (p + q * edge.low, q * (edge.high - edge.low));
        let mut ends = [0.0, 1.0, 1.0, 1.0];
        for (end, at) in ends[1..3].iter_mut().zip(self.crossings(from, to)) {
            *end = at.map_or(1.0, |[_, t]| t);
        }
        sort_few(&mut ends[1..3]);
        for part in ends.windows(2) {
            for [at, weight] in GAUSS_6 {
                let t = edge.low + (part[0] + at * (part[1] - part[0])) * (edge.high - edge.low);
                let y = p + q * t;
                let at = self.frame.map.inverse([y.x, y.y]);
                let n1 = one.shape.values(at.xi, at.eta);
                let value: f64 = n1.iter().zip(self.field).map(|(n, v)| n * v).sum();
                if value >= 0.0 {
                    continue; // of this part all
                }
                let value = value * weight * (part[1] - part[0]) * (edge.high - edge.low);
                let ends = [(edge.from, 1.0 - t), (edge.to, t)];
                for c in 0..2 {
                    let of_one = (0..one.shape.n).map(|k| (k, -n1[k]));
                    let of_two = ends.into_iter().map(|(l, n)| (MORTAR_CORNER + l, n));
                    for (slot, velocity) in of_one.chain(of_two) {
                        let flux = value * velocity * normal[c];
                        (0..one.shape.n).for_each(|b| plane.one[0][slot][c][b] += flux * n1[b]);
                        ends.into_iter().for_each(|(l, n)| plane.two[0][slot][c][two.node[l]] -= flux * n);
                    }
                }
            }
        }
    }
}

/// Sorts by insertion. (The standard library's sort of numbers would be 8 kB of code.)
fn sort_few(values: &mut [f64]) {
    for k in 1..values.len() {
        let mut i = k;
        while i > 0 && values[i - 1].total_cmp(&values[i]).is_gt() {
            values.swap(i - 1, i);
            i -= 1;
        }
    }
}

struct ToNodes<'a> {
    frame: &'a NonmortarFrame,
    segment: &'a Segment,
    plane: Derivatives<1>,
    forces: &'a mut ForceDerivatives,
}

impl KindKernel for ToNodes<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes, One: SingleBasis, Two: Isoparametric>(self) {
        let ToNodes { frame, segment, plane, forces } = self;
        let chain = Chain::new(frame, segment);
        for (sums, to) in [(&plane.one[0], &mut forces.one), (&plane.two[0], &mut forces.two)] {
            chain.nodes::<One::Cell, Two::Cell>(&lanes::<L>(sums), &mut Component { to, i: 0 });
        }
    }
}
