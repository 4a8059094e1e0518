//! The same integrals as they stand on paper, point by point and number by number: what the kernels must give, on
//! every back end, to the rounding of their sums.

use super::at_rest::{facet_motion, facet_motion_raised};
use super::chain::{ForceDerivatives, WeightDerivatives};
use super::derivatives::{pair_motion, pair_motion_raised};
use super::gap::{AlongNormal, Raised};
use super::pair_weights::PairWeights;
use super::segment::{NonmortarFrame, Segment};
use super::slots::{MORTAR, MORTAR_CORNER, PAIR_CORNERS, PAIR_NODES};
use crate::geometry::{Facet, Projection, Vec2, Vec3, cross};
use crate::quadrature::{DEGREE_5, DEGREE_10, Rule};
use crate::shape::{MAX_CORNERS, MAX_NODES};
use crate::simd;
use num_traits::ToPrimitive;
use proptest::prelude::*;

#[path = "../../tests/support/exact.rs"]
mod exact;
#[path = "../../tests/support/random.rs"]
mod random;

/// Rounding of a few thousand sums, relative to the largest of the compared numbers.
const SAME: f64 = 1e-12;
/// On slivers, whose edges cross at small angles: the error of a crossing, 1e-11, where it is taken in doubles.
const SAME_ON_SLIVERS: f64 = 1e-10;
/// Shape functions and their gradients at a point of a projected facet.
struct At {
    n: [f64; MAX_CORNERS],
    gradient: [Vec2; MAX_CORNERS],
}

impl At {
    fn new(facet: &Projection, y: Vec2, (xi, eta): (f64, f64)) -> At {
        let c = &facet.shape.coefficients;
        let (mut tangents, mut at) = ([Vec2::zeros(); 2], y);
        let slopes = c.map(|c| [c[1] + c[3] * eta, c[2] + c[3] * xi]);
        let n = facet.shape.values(xi, eta);
        for k in 0..MAX_CORNERS {
            at -= facet.y[k] * n[k];
            tangents[0] += facet.y[k] * slopes[k][0];
            tangents[1] += facet.y[k] * slopes[k][1];
        }
        assert!(at.norm() <= 1e-9 * facet.size, "the inverse map does not return to the point");
        let det = cross(tangents[0], tangents[1]);
        let [eta, xi] = tangents.map(|t| Vec2::new(t.y, -t.x) / det);
        At { n, gradient: slopes.map(|[s, t]| xi * s - eta * t) }
    }
}

struct Straight<'a> {
    frame: &'a NonmortarFrame,
    segment: &'a Segment,
    weights: PairWeights,
    /// d n / d y_k.
    ab: [[[Vec2; MAX_NODES]; MAX_CORNERS]; PAIR_CORNERS],
    ac: [[[Vec2; MAX_NODES]; MAX_CORNERS]; PAIR_CORNERS],
}

impl<'a> Straight<'a> {
    fn new(frame: &'a NonmortarFrame, segment: &'a Segment, rule: &Rule) -> Self {
        let zero = [[[Vec2::zeros(); MAX_NODES]; MAX_CORNERS]; PAIR_CORNERS];
        let mut s = Straight { frame, segment, weights: PairWeights::default(), ab: zero, ac: zero };
        let v = segment.polygon.vertices();
        let affine = frame.map.is_affine && segment.mortar_map.is_affine;
        let first = if affine { 2 } else { 0 };
        for i in first..v.len() {
            let apex = if affine { v[0] } else { segment.polygon.mean_vertex() };
            let (p, q) = (v[(i + v.len() - 1) % v.len()] - apex, v[i] - apex);
            for [l1, l2, w] in rule.triangle {
                s.add_point(apex + p * *l1 + q * *l2, 0.5 * w * cross(p, q));
            }
        }
        for k in 0..frame.projection.shape.n {
            s.add_nonmortar_edge(rule, k);
        }
        for k in 0..segment.mortar.shape.n {
            s.add_mortar_edge(rule, k);
        }
        s
    }

    fn at(&self, y: Vec2) -> (At, At) {
        let point = [y.x, y.y];
        let (one, two) = (self.frame.map.inverse(point), self.segment.mortar_map.inverse(point));
        (At::new(&self.frame.projection, y, (one.xi, one.eta)), At::new(&self.segment.mortar, y, (two.xi, two.eta)))
    }

    /// Weights, and -(grad N_A . v1) N - N_A (grad N . v).
    fn add_point(&mut self, y: Vec2, w: f64) {
        let (one, two) = self.at(y);
        let node = self.segment.mortar.node;
        for a in 0..MAX_CORNERS {
            for b in 0..MAX_NODES {
                self.weights.ab[a][b] += w * one.n[a] * one.n[b];
                self.weights.ac[a][node[b]] += w * one.n[a] * two.n[b];
                for k in 0..MAX_CORNERS {
                    let v = w * one.n[k];
                    self.ab[k][a][b] -= one.gradient[a] * (v * one.n[b]) + one.gradient[b] * (v * one.n[a]);
                    self.ac[k][a][node[b]] -= one.gradient[a] * (v * two.n[b]);
                    self.ac[MORTAR_CORNER + k][a][node[b]] -= two.gradient[b] * (w * two.n[k] * one.n[a]);
                }
            }
        }
    }

    fn add_nonmortar_edge(&mut self, rule: &Rule, k: usize) {
        let (one, two) = (&self.frame.projection, &self.segment.mortar);
        let (from, to) = (k, (k + 1) % one.shape.n);
        let mut part = (0.0, 1.0);
        for j in 0..two.shape.n {
            let (a, b, orientation) = canonical_edge(two, j);
            let d = [from, to].map(|p| orientation * distance(self.frame, [two.x[a], two.x[b]], one.x[p]));
            narrow(&mut part, d, orientation > 0.0);
        }
        let span = one.y[to] - one.y[from];
        for [t, w] in rule.line.iter().filter(|_| part.1 > part.0) {
            let t = part.0 + (part.1 - part.0) * t;
            let normal = Vec2::new(span.y, -span.x) * (w * (part.1 - part.0));
            let (_, at) = self.at(one.y[from] + span * t);
            let l = |k: usize| {
                if k == from {
                    1.0 - t
                } else if k == to {
                    t
                } else {
                    0.0
                }
            };
            for (k, a) in [(from, from), (from, to), (to, from), (to, to)] {
                for b in 0..MAX_NODES {
                    self.ab[k][a][b] += normal * (l(k) * l(a) * l(b));
                    self.ac[k][a][two.node[b]] += normal * (l(k) * l(a) * at.n[b]);
                }
            }
        }
    }

    fn add_mortar_edge(&mut self, rule: &Rule, k: usize) {
        let (one, two) = (&self.frame.projection, &self.segment.mortar);
        let (from, to, orientation) = canonical_edge(two, k);
        let span = two.y[to] - two.y[from];
        let mut part = (0.0, 1.0);
        for j in 0..one.shape.n {
            let next = (j + 1) % one.shape.n;
            let d = [from, to].map(|p| distance(self.frame, [one.x[j], one.x[next]], two.x[p]));
            narrow(&mut part, d, (one.y[next] - one.y[j]).dot(&span) <= 0.0);
        }
        for [t, w] in rule.line.iter().filter(|_| part.1 > part.0) {
            let t = part.0 + (part.1 - part.0) * t;
            let normal = Vec2::new(span.y, -span.x) * (orientation * w * (part.1 - part.0));
            let (at, _) = self.at(two.y[from] + span * t);
            for (k, l) in [(from, 1.0 - t), (to, t)] {
                for a in 0..MAX_CORNERS {
                    for b in 0..MAX_NODES {
                        self.ab[MORTAR_CORNER + k][a][b] += normal * (l * at.n[a] * at.n[b]);
                    }
                    for (c, m) in [(from, 1.0 - t), (to, t)] {
                        self.ac[MORTAR_CORNER + k][a][two.node[c]] += normal * (l * m * at.n[a]);
                    }
                }
            }
        }
    }

    /// sum_k g_k . Dy_k as coefficients of Dx_k. With a mortar side at rest the plane's own translation and spin are
    /// left out: as exact as the rule, which makes them cancel.
    fn chain(&self, g: [Vec2; PAIR_CORNERS], moves: bool) -> [Vec3; PAIR_NODES] {
        let (plane, one, two) = (&self.frame.plane, &self.frame.projection, &self.segment.mortar);
        let mut x = [Vec3::zeros(); PAIR_NODES];
        let (mut shift, mut spin, mut tilt) = (Vec3::zeros(), 0.0, Vec2::zeros());
        for k in 0..PAIR_NODES {
            let (slot, y, d) = if k < MORTAR {
                (k, one.y[k], one.d[k])
            } else {
                (MORTAR + two.node[k - MORTAR], two.y[k - MORTAR], two.d[k - MORTAR])
            };
            x[slot] = plane.t1 * g[k].x + plane.t2 * g[k].y;
            shift += x[slot];
            spin += cross(g[k], y);
            tilt += g[k] * d;
        }
        for k in 0..one.shape.n {
            if moves {
                x[k] += plane.t2 * (plane.spin[k] * spin) - shift / one.shape.n as f64;
            }
            x[k] -= plane.e * (plane.tilt[0][k] * tilt.x + plane.tilt[1][k] * tilt.y);
        }
        x
    }

    fn derivatives(&self, moves: bool) -> WeightDerivatives {
        let mut d = WeightDerivatives::default();
        for a in 0..MAX_CORNERS {
            for b in 0..MAX_NODES {
                d.ab[a][b] = self.chain(self.ab.map(|g| g[a][b]), moves).map(Into::into);
                d.ac[a][b] = self.chain(self.ac.map(|g| g[a][b]), moves).map(Into::into);
            }
        }
        d
    }
}

/// Without rounding where that may matter; 0 where the kernel, in twice a double's precision, cannot tell it from 0.
fn distance(frame: &NonmortarFrame, [a, b]: [Vec3; 2], p: Vec3) -> f64 {
    let d = frame.plane.e.dot(&(b - a).cross(&(p - a)));
    if d.abs() > 1e-3 * (b - a).norm() * (p - a).norm() {
        return d;
    }
    let one = Facet { nodes: frame.projection.x, shape: frame.projection.shape };
    let spanning = one.spanning_signs().map(|(to, from)| [one.nodes[to].into(), one.nodes[from].into()]);
    let d = exact::distance(spanning, [a.into(), b.into()], p.into()).to_f64().unwrap() / one.area_vector().norm();
    if d.abs() <= 1e-29 * (b - a).norm() * (p - a).norm().max((p - b).norm()) { 0.0 } else { d }
}

fn canonical_edge(mortar: &Projection, k: usize) -> (usize, usize, f64) {
    let next = (k + 1) % mortar.shape.n;
    let (a, b) = (mortar.x[k], mortar.x[next]);
    if (a.x, a.y, a.z) < (b.x, b.y, b.z) { (k, next, 1.0) } else { (next, k, -1.0) }
}

fn narrow(part: &mut (f64, f64), [d0, d1]: [f64; 2], zero_is_inside: bool) {
    let inside = |d: f64| d > 0.0 || (d == 0.0 && zero_is_inside);
    match (inside(d0), inside(d1)) {
        (true, true) => {}
        (false, false) => *part = (1.0, 0.0),
        (false, true) => part.0 = part.0.max(d0 / (d0 - d1)),
        (true, false) => part.1 = part.1.min(d0 / (d0 - d1)),
    }
}

fn largest<'a>(v: impl IntoIterator<Item = &'a f64>) -> f64 {
    v.into_iter().fold(0.0, |m, v| v.abs().max(m))
}

fn check_same(what: &str, found: &[f64], expected: &[f64], (scale, same): (f64, f64)) -> Result<(), TestCaseError> {
    let error = found.iter().zip(expected).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
    prop_assert!(error <= same * largest(expected).max(scale), "{what} off by {error:e} of {:e}", largest(expected));
    Ok(())
}

fn flat<const A: usize, const B: usize, const C: usize>(v: &[[[[f64; A]; B]; C]]) -> &[f64] {
    v.as_flattened().as_flattened().as_flattened()
}

fn check(one: &Facet, two: &Facet, p: &[[f64; MAX_CORNERS]; 3], same: f64) -> Result<(), TestCaseError> {
    let Ok(frame) = NonmortarFrame::new(one) else { return Ok(()) };
    let Ok(Some(segment)) = Segment::new(&frame, two) else { return Ok(()) };
    let h = one.longest_edge();
    for rule in [&DEGREE_5, &DEGREE_10] {
        let straight = Straight::new(&frame, &segment, rule);
        let weights = PairWeights::integrate(&frame, &segment, rule);
        for (found, expected) in [(&weights.ab, &straight.weights.ab), (&weights.ac, &straight.weights.ac)] {
            check_same("weights", found.as_flattened(), expected.as_flattened(), (h * h, same))?;
        }
        let ((with, found), expected) =
            (WeightDerivatives::integrate(&frame, &segment, rule), straight.derivatives(true));
        check_same("weights with derivatives", with.ab.as_flattened(), weights.ab.as_flattened(), (h * h, same))?;
        check_same("weights with derivatives", with.ac.as_flattened(), weights.ac.as_flattened(), (h * h, same))?;
        check_same("dn_ab", flat(&found.ab), flat(&expected.ab), (h, same))?;
        check_same("dn_ac", flat(&found.ac), flat(&expected.ac), (h, same))?;

        let forces = expected.of_forces(p);
        let gap = AlongNormal::from_weights(&frame, &segment.mortar, &weights, &expected);
        let size = largest(p.as_flattened());
        let mut motion = ForceDerivatives::default();
        let found = pair_motion((&frame, &segment, rule), &weights, p, &mut motion);
        check_same("forces on one", flat(&motion.one), flat(&forces.one), (size * h, same))?;
        check_same("forces on two", flat(&motion.two), flat(&forces.two), (size * h, same))?;
        let dgamma = |g: &AlongNormal| g.dgamma.as_flattened().as_flattened().to_vec();
        check_same("gap", &dgamma(&found), &dgamma(&gap), (h * h, same))?;

        // Over a mortar surface that is raised by the field p[2]: the forces are the same.
        let (raised_gap, areas) = raised(&expected, &gap, &p[2]);
        let (mut again, mut dm) = (ForceDerivatives::default(), [[[0.0; MAX_CORNERS]; 3]; PAIR_NODES]);
        let over = Raised { heights: &p[2], areas: &mut dm };
        let found = pair_motion_raised((&frame, &segment, rule), &weights, p, &mut again, over);
        prop_assert_eq!((flat(&again.one), flat(&again.two)), (flat(&motion.one), flat(&motion.two)));
        check_same("raised gap", &dgamma(&found), &raised_gap, (size.max(h) * h, same))?;
        check_same("areas", dm.as_flattened().as_flattened(), &areas, (h, same))?;

        // At rest: the same columns of the non-mortar side, no others.
        let expected = straight.derivatives(false);
        let forces = expected.of_forces(p);
        let gap = AlongNormal::from_weights(&frame, &segment.mortar, &weights, &expected);
        let mut motion = ForceDerivatives::default();
        let found = facet_motion(&frame, [(&segment, &weights)].into_iter(), rule, p, &mut motion);
        check_same("forces at rest", flat(&motion.one[..MORTAR]), flat(&forces.one[..MORTAR]), (size * h, same))?;
        check_same("gap at rest", &dgamma(&found)[..12 * MORTAR], &dgamma(&gap)[..12 * MORTAR], (h * h, same))?;
        let untouched = flat(&motion.one[MORTAR..])
            .iter()
            .chain(flat(&motion.two))
            .chain(found.dgamma[MORTAR..].as_flattened().as_flattened());
        prop_assert_eq!(largest(untouched), 0.0);
        let (raised_gap, areas) = raised(&expected, &gap, &p[2]);
        let (mut again, mut dm) = (ForceDerivatives::default(), [[[0.0; MAX_CORNERS]; 3]; PAIR_NODES]);
        let (pairs, over) = ([(&segment, &weights)].into_iter(), Raised { heights: &p[2], areas: &mut dm });
        let found = facet_motion_raised(&frame, pairs, rule, p, &mut again, over);
        prop_assert_eq!(flat(&again.one), flat(&motion.one));
        let columns = 12 * MORTAR;
        let scale = (size.max(h) * h, same);
        check_same("raised gap at rest", &dgamma(&found)[..columns], &raised_gap[..columns], scale)?;
        check_same("areas at rest", &dm.as_flattened().as_flattened()[..columns], &areas[..columns], (h, same))?;
    }
    Ok(())
}

/// Dgamma_A - sum_B Dn_AB h_B, and sum_B Dn_AB.
fn raised(d: &WeightDerivatives, gap: &AlongNormal, heights: &[f64; MAX_CORNERS]) -> (Vec<f64>, Vec<f64>) {
    let (mut gap, mut areas) = (gap.dgamma, [[[0.0; MAX_CORNERS]; 3]; PAIR_NODES]);
    for (k, j) in (0..PAIR_NODES).flat_map(|k| (0..3).map(move |j| (k, j))) {
        for a in 0..MAX_CORNERS {
            for b in 0..MAX_NODES {
                gap[k][j][a] -= d.ab[a][b][k][j] * heights[b];
                areas[k][j][a] += d.ab[a][b][k][j];
            }
        }
    }
    [gap, areas].map(|v| v.as_flattened().as_flattened().to_vec()).into()
}

/// A facet over the square -1..1 with mild noise; `grid` quantises it, to force coincident vertices and edges; `flat`:
/// a parallelogram or triangle, so that both maps are affine.
fn facet() -> impl Strategy<Value = Facet> {
    let numbers = proptest::collection::vec(-1.0..1.0f64, 12);
    let kind = (3usize..=4, any::<bool>(), any::<bool>(), prop_oneof![Just(None), Just(Some(8.0)), Just(Some(1.0))]);
    (kind, numbers, 0.0..std::f64::consts::TAU).prop_map(|((n, clockwise, parallelogram, grid), r, turn)| {
        let corner = |k: usize| {
            let angle = turn + std::f64::consts::TAU * (k as f64 + 0.15 * r[3 * k]) / n as f64;
            let p = Vec3::new(angle.cos(), angle.sin(), 0.08 * r[3 * k + 2]) + Vec3::new(r[9], r[10], 0.1) * 0.8;
            grid.map_or(p, |g| p.map(|v| (v * g).round() / g))
        };
        let mut points: Vec<Vec3> = (0..n).map(corner).collect();
        if n == 4 && parallelogram {
            points[3] = points[0] + points[2] - points[1];
        }
        if clockwise {
            points.reverse();
        }
        Facet::new(&points).unwrap()
    })
}

proptest! {
    #![proptest_config(random::cases(1500))]

    #[test]
    fn kernels_equal_the_formulas_on_every_back_end(one in facet(), two in facet(), p in proptest::collection::vec(-1.0..1.0f64, 12)) {
        let mut fields = [[0.0; MAX_CORNERS]; 3];
        fields.as_flattened_mut().copy_from_slice(&p);
        // A triangle has no fourth traction.
        if one.len() == 3 {
            fields.iter_mut().for_each(|f| f[3] = 0.0);
        }
        check(&one, &two, &fields, SAME)?;
        simd::on_plain_lanes(|| check(&one, &two, &fields, SAME))?;
    }

    /// Slivers: the facets overlap by `width`, or not quite, or touch (1e-400 is 0).
    #[test]
    fn kernels_equal_the_formulas_on_slivers(one in facet(), exponent in prop_oneof![1..17i32, Just(400)], sign in prop_oneof![Just(-1.0), Just(1.0)]) {
        let shift = (one.nodes[1] - one.nodes[0]).cross(&one.area_vector()).normalize();
        let width = sign * 10f64.powi(-exponent) * one.longest_edge();
        let mirrored = |x: &Vec3| x + shift * (2.0 * shift.dot(&(one.nodes[0] - x)) - width);
        let mut points: Vec<Vec3> = one.points().iter().map(mirrored).collect();
        points.rotate_left(1);
        check(&one, &Facet::new(&points).unwrap(), &[[1.0, -0.5, 0.25, 0.0]; 3], SAME_ON_SLIVERS)?;
    }
}
