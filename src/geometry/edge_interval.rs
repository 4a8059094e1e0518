//! Which part of a source edge lies inside the other facet (kernel notes A, "strict").
//!
//! Liang-Barsky on signed distances that are taken from differences of the nodes in space, never from
//! the clipped polygon. Mortar lines and edges are evaluated from their lexicographically smaller end,
//! so two mortar facets that share one see bitwise opposite distances; exact ties are settled as if
//! every mortar line lay an infinitesimal amount to the right of that direction. Then, assembled over
//! the pairs, non-mortar edge parts tile their edge and the edge parts of neighbouring mortar facets
//! cancel, whatever the rounding error of a near-parallel crossing. A boundary of the mortar surface has no
//! neighbour to cancel with; where it follows a non-mortar mesh line, the tie rule decides.

use super::{Plane, Projection, Vec3};
use crate::shape::MAX_NODES;
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
pub type EdgeIntervals = [Option<EdgeInterval>; MAX_NODES];

/// A distance below this (over the lengths that make it) is a tie: a few hundred roundings of coordinates and of the
/// planes of neighbouring non-mortar facets, which otherwise decide differently about a mortar boundary
/// that follows their common edge.
const TIE: f64 = 1e-13;

/// Component i of four points.
#[inline(always)]
fn component<L: Lanes, const K: usize>(x: &[SVector<f64, K>; MAX_NODES], i: usize) -> L {
    L::load(&[x[0][i], x[1][i], x[2][i], x[3][i]])
}

/// The nodes of a facet relative to the plane's reference, component by component.
struct Nodes<L>([L; 3]);

impl<L: Lanes> Nodes<L> {
    #[inline(always)]
    fn of(facet: &Projection) -> Self {
        Nodes([component(&facet.x, 0), component(&facet.x, 1), component(&facet.x, 2)])
    }

    /// e . ((b - a) x (p - a)) of every node p: positive to the left of the line from a to b.
    #[inline(always)]
    fn distances(&self, e: Vec3, a: Vec3, b: Vec3) -> L {
        let ab = b - a;
        let normal = e.cross(&ab);
        let (mut d, mut from_a, mut from_b) = (L::splat(0.0), L::splat(0.0), L::splat(0.0));
        for i in 0..3 {
            let (ap, bp) = (self.0[i] - L::splat(a[i]), self.0[i] - L::splat(b[i]));
            d = L::splat(normal[i]).mul_add(ap, d);
            from_a = ap.mul_add(ap, from_a);
            from_b = bp.mul_add(bp, from_b);
        }
        let size = from_a.max(from_b) * L::splat(TIE * TIE * ab.norm_squared());
        (d * d - size).where_positive(d, L::splat(0.0))
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

fn lexicographically_smaller(a: Vec3, b: Vec3) -> bool {
    (a.x, a.y, a.z) < (b.x, b.y, b.z)
}

/// For every edge of a facet with `n` nodes the value at the node where it ends.
#[inline(always)]
fn ends<L: Lanes>(v: L, n: usize) -> L {
    let v = v.store();
    L::load(&[v[1], v[2], if n == 4 { v[3] } else { v[0] }, v[0]])
}

/// The parts of the non-mortar edges inside the mortar facet, and of the mortar edges inside the non-mortar facet.
#[inline(always)]
pub fn edge_intervals<L: Lanes>(one: &Projection, two: &Projection, plane: &Plane) -> [EdgeIntervals; 2] {
    let (n1, n2) = (one.shape.n, two.shape.n);
    let (nodes1, nodes2) = (Nodes::<L>::of(one), Nodes::<L>::of(two));

    // Mortar edges run from their smaller end: 1 where that is the node they are named after, else -1.
    let mut orientation = [1.0; MAX_NODES];
    let mut nonmortar = Parts::whole();
    for j in 0..n2 {
        let next = two.shape.next[j];
        let (mut a, mut b) = (two.x[j], two.x[next]);
        if !lexicographically_smaller(a, b) {
            (a, b, orientation[j]) = (b, a, -1.0);
        }
        let d = nodes1.distances(plane.e, a, b) * L::splat(orientation[j]);
        // The line moves to its right, so a point on it is to its left.
        nonmortar.narrow(d, ends(d, n1), L::splat(INSIDE * orientation[j]));
    }

    let forward = L::load(&orientation);
    let y = [component::<L, 2>(&two.y, 0), component(&two.y, 1)];
    let direction = [(ends(y[0], n2) - y[0]) * forward, (ends(y[1], n2) - y[1]) * forward];
    let mut mortar = Parts::whole();
    for j in 0..n1 {
        let next = one.shape.next[j];
        let d = nodes2.distances(plane.e, one.x[j], one.x[next]);
        let end = ends(d, n2);
        // A point of the mortar line moves to the right of `direction`: inwards when that runs
        // against the non-mortar edge. Only a collinear edge depends on it.
        let edge = one.y[next] - one.y[j];
        let outwards = L::splat(edge.x).mul_add(direction[0], L::splat(edge.y) * direction[1]);
        let tie = outwards.where_positive(L::splat(-INSIDE), L::splat(INSIDE));
        mortar.narrow(forward.where_positive(d, end), forward.where_positive(end, d), tie);
    }
    [collect(nonmortar, &[1.0; MAX_NODES], n1), collect(mortar, &orientation, n2)]
}

#[inline(always)]
fn collect<L: Lanes>(parts: Parts<L>, orientation: &[f64; MAX_NODES], n: usize) -> EdgeIntervals {
    let (low, high) = (parts.low.store(), parts.high.store());
    let mut intervals = [None; MAX_NODES];
    for k in 0..n {
        if high[k] > low[k] {
            let next = if k + 1 == n { 0 } else { k + 1 };
            let (from, to) = if orientation[k] > 0.0 { (k, next) } else { (next, k) };
            intervals[k] = Some(EdgeInterval { from, to, orientation: orientation[k], low: low[k], high: high[k] });
        }
    }
    intervals
}
