//! Which part of a source edge lies inside the other facet (docs/formulation 3.5).
//!
//! Liang-Barsky on signed distances that are taken from differences of the nodes in space, never from
//! the clipped polygon. Mortar lines and edges are evaluated from the end that comes first,
//! so two mortar facets that share one see bitwise opposite distances. Distances that nearly vanish, on which the
//! crossing of nearly parallel edges depends, are taken again in twice the precision (`near_line.rs`): every crossing
//! is right to `CROSSING`, at any angle and anywhere in space. Exact ties are settled as if every mortar line lay an
//! infinitesimal amount to the right of its direction. Then, assembled over the pairs, non-mortar edge parts tile their
//! edge and the edge parts of neighbouring mortar facets cancel. A boundary of the mortar surface has no neighbour to
//! cancel with; where it follows a non-mortar mesh line, the facets at that line agree on what lies on it
//! (`near_line.rs`), and the tie rule decides.

use super::near_line::{LineOf, View};
use super::plane::Plane;
use super::projection::Projection;
use super::vector::Vec3;
use crate::shape::MAX_CORNERS;
use crate::simd::Lanes;
use nalgebra::SVector;

/// An edge of a projected facet in its canonical direction, and the part of it that counts.
#[derive(Clone, Copy, Debug)]
pub struct EdgeInterval {
    /// Position, in the projection's order, of the node where the parameter is 0.
    pub from: usize,
    /// Position of the node where the parameter is 1.
    pub to: usize,
    /// +1 when `from` to `to` runs counter-clockwise, else -1.
    pub orientation: f64,
    /// Parameter where the part begins.
    pub low: f64,
    /// Parameter where it ends, > `low`.
    pub high: f64,
}

/// The parts of a facet's edges, edge k from its k-th node on; `None`: nothing of it counts.
pub type EdgeIntervals = [Option<EdgeInterval>; MAX_CORNERS];

/// Error of a crossing's parameter tau = d0 / (d0 - d1).
const CROSSING: f64 = 1e-11;
/// Error of a distance in doubles over |b - a| |p - a| and the condition of the plane's normal: differences, two
/// products with their sums, the normal's own three roundings.
const ROUNDING: f64 = 8.0 * f64::EPSILON / 2.0;
/// A distance below this, over the same, is taken again. The relative error of a larger one moves a crossing by
/// tau (1 - tau) <= 1/4 of it, twice where both ends are so.
const NEAR: f64 = 0.5 * ROUNDING / CROSSING;

/// Component i of four points.
#[inline(always)]
fn component<L: Lanes, const K: usize>(x: &[SVector<f64, K>; MAX_CORNERS], i: usize) -> L {
    L::load(&[x[0][i], x[1][i], x[2][i], x[3][i]])
}

/// The value at the end of every edge, from those where they begin. A triangle's fourth node is its first one, so that its
/// third edge ends there; there is no fourth.
#[inline(always)]
fn ends<L: Lanes>(v: L) -> L {
    v.swap_neighbours().swap_1_3()
}

/// A facet's edges as lines, lanes over the edges.
struct Lines<L> {
    /// Where they begin.
    from: [L; 3],
    /// From there to where they end.
    along: [L; 3],
    /// 1 for those that run from the node that they are named after to the next one, else -1.
    forward: L,
}

impl<L: Lanes> Lines<L> {
    /// As the facet's order has them.
    #[inline(always)]
    fn around(x: &[L; 3]) -> Self {
        let along = [ends(x[0]) - x[0], ends(x[1]) - x[1], ends(x[2]) - x[2]];
        Lines { from: *x, along, forward: L::splat(1.0) }
    }

    /// Each from the end that comes first (see `near_line::is_before`): without branches, for no processor foresees them.
    #[inline(always)]
    fn canonical(x: &[L; 3]) -> Self {
        let Lines { mut from, mut along, .. } = Self::around(x);
        let (plus, minus) = (L::splat(1.0), L::splat(-1.0));
        let mut forward = minus;
        for i in [2, 1, 0] {
            forward = along[i].where_positive(plus, (-along[i]).where_positive(minus, forward));
        }
        for i in 0..3 {
            from[i] = forward.where_positive(x[i], ends(x[i]));
            along[i] = along[i] * forward;
        }
        Lines { from, along, forward }
    }
}

/// How a facet's edges run as lines: 1 from the node that they are named after to the next one, or -1.
type Orientation = [f64; MAX_CORNERS];

/// Ends of line j of a facet.
#[inline(always)]
fn line<'a>(facet: &'a Projection, orientation: &Orientation, j: usize) -> [&'a Vec3; 2] {
    let next = facet.shape.next[j & 3] & 3; // so that no bounds are checked
    let (a, b) = if orientation[j & 3] > 0.0 { (j & 3, next) } else { (next, j & 3) };
    [&facet.x[a], &facet.x[b]]
}

/// e . ((b - a) x (p - a)) for each line a, b of a facet, a row a line, and the nodes p of the other one: positive to
/// the left. Edge by edge, where it begins and where it ends.
struct Distances {
    from: [[f64; MAX_CORNERS]; MAX_CORNERS],
    to: [[f64; MAX_CORNERS]; MAX_CORNERS],
}

impl Distances {
    /// Of the first `n` lines from the nodes `x`.
    #[inline(always)]
    fn of<L: Lanes>(
        lines: &Lines<L>,
        n: usize,
        x: &[L; 3],
        plane: &Plane,
        anew: impl FnOnce(&mut Distances),
    ) -> Distances {
        let (Lines { from, along, .. }, e) = (lines, &plane.e);
        let a = [from[0].store(), from[1].store(), from[2].store()];
        let (mut normals, mut squared) = ([[0.0; MAX_CORNERS]; 3], along[0] * along[0]);
        for (i, j, k) in [(0, 1, 2), (1, 2, 0), (2, 0, 1)] {
            normals[i] = (L::splat(e[j]) * along[k] - L::splat(e[k]) * along[j]).store();
        }
        for i in 1..3 {
            squared = along[i].mul_add(along[i], squared);
        }
        let near_squared = (L::splat(NEAR * NEAR * plane.condition_squared) * squared).store();
        let zero = [[0.0; MAX_CORNERS]; MAX_CORNERS];
        let (mut distances, mut nearest) = (Distances { from: zero, to: zero }, L::splat(0.0));
        for j in 0..n {
            let j = j & 3; // so that no bounds are checked
            let ap = [x[0] - L::splat(a[0][j]), x[1] - L::splat(a[1][j]), x[2] - L::splat(a[2][j])];
            let (mut d, mut squared) = (L::splat(normals[0][j]) * ap[0], ap[0] * ap[0]);
            for i in 1..3 {
                d = L::splat(normals[i][j]).mul_add(ap[i], d);
                squared = ap[i].mul_add(ap[i], squared);
            }
            nearest = nearest.max(squared * L::splat(near_squared[j]) - d * d);
            (distances.from[j], distances.to[j]) = (d.store(), ends(d).store());
        }
        if nearest.any_positive() {
            anew(&mut distances);
        }
        distances
    }
}

/// What counts as inside where a distance is exactly 0: added to it, this decides, and changes no other one.
const INSIDE: f64 = f64::MIN_POSITIVE;

/// The parts of four edges that are left of all lines so far.
struct Parts<L> {
    low: L,
    high: L,
}

impl<L: Lanes> Parts<L> {
    #[inline(always)]
    fn whole() -> Self {
        Parts { low: L::splat(0.0), high: L::splat(1.0) }
    }

    /// Narrows the parts to where the distance, linear from `d0` to `d1`, is positive. `tie` is added to decide on
    /// zeros: [`INSIDE`] or its negative.
    #[inline(always)]
    fn narrow(&mut self, d0: L, d1: L, tie: L) {
        let (inside0, inside1) = (d0 + tie, d1 + tie);
        let crossing = d0 / (d0 - d1);
        let low = inside0.where_positive(L::splat(0.0), inside1.where_positive(crossing, L::splat(2.0)));
        let high = inside1.where_positive(L::splat(1.0), inside0.where_positive(crossing, L::splat(-1.0)));
        self.low = self.low.max(low);
        self.high = self.high.min(high);
    }
}

/// The parts of the non-mortar edges inside the mortar facet, and of the mortar edges inside the non-mortar facet.
#[inline(always)]
pub fn edge_intervals<L: Lanes>(one: &Projection, two: &Projection, plane: &Plane) -> [EdgeIntervals; 2] {
    let (n1, n2) = (one.shape.n, two.shape.n);
    let mut view = View::new(one, plane);
    let x1 = [component::<L, 3>(&one.x, 0), component(&one.x, 1), component(&one.x, 2)];
    let x2 = [component::<L, 3>(&two.x, 0), component(&two.x, 1), component(&two.x, 2)];

    // Mortar edges run from the end that comes first.
    let lines = Lines::canonical(&x2);
    let orientation = lines.forward.store();
    let distances = Distances::of(&lines, n2, &x1, plane, |d| {
        let near = NEAR * plane.condition_squared.sqrt();
        for j in 0..n2 {
            let line = (LineOf::Mortar, line(two, &orientation, j));
            view.refine(line, one, near, [&mut d.from[j], &mut d.to[j]]);
        }
    });
    let mut nonmortar = Parts::whole();
    for j in 0..n2 {
        let forward = L::splat(orientation[j & 3]);
        let (from, to) = (L::load(&distances.from[j & 3]) * forward, L::load(&distances.to[j & 3]) * forward);
        // The line moves to its right, so a point on it is to its left.
        nonmortar.narrow(from, to, L::splat(INSIDE) * forward);
    }

    let forward = lines.forward;
    let [u, v] = two.in_plane::<L>();
    let direction = [(ends(u) - u) * forward, (ends(v) - v) * forward];
    let distances = Distances::of(&Lines::around(&x1), n1, &x2, plane, |d| {
        let near = NEAR * plane.condition_squared.sqrt();
        for j in 0..n1 {
            let line = (LineOf::Nonmortar(j), line(one, &[1.0; MAX_CORNERS], j));
            view.refine(line, two, near, [&mut d.from[j], &mut d.to[j]]);
        }
    });
    let [u, v] = one.in_plane::<L>();
    let edges = [(ends(u) - u).store(), (ends(v) - v).store()];
    let mut mortar = Parts::whole();
    for j in 0..n1 {
        let j = j & 3;
        let (from, to) = (L::load(&distances.from[j]), L::load(&distances.to[j]));
        // A point of the mortar line moves to the right of `direction`: inwards when that runs
        // against the non-mortar edge. Only a collinear edge depends on it.
        let outwards = L::splat(edges[0][j]).mul_add(direction[0], L::splat(edges[1][j]) * direction[1]);
        let tie = outwards.where_positive(L::splat(-INSIDE), L::splat(INSIDE));
        mortar.narrow(forward.where_positive(from, to), forward.where_positive(to, from), tie);
    }
    [collect(nonmortar, &[1.0; MAX_CORNERS], n1), collect(mortar, &orientation, n2)]
}

#[inline(always)]
fn collect<L: Lanes>(parts: Parts<L>, orientation: &[f64; MAX_CORNERS], n: usize) -> EdgeIntervals {
    let (low, high) = (parts.low.store(), parts.high.store());
    let mut intervals = [None; MAX_CORNERS];
    for k in 0..n {
        if high[k] > low[k] {
            let next = if k + 1 == n { 0 } else { k + 1 };
            let (from, to) = if orientation[k] > 0.0 { (k, next) } else { (next, k) };
            intervals[k] = Some(EdgeInterval { from, to, orientation: orientation[k], low: low[k], high: high[k] });
        }
    }
    intervals
}
