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

/// A distance below this (over the lengths that make it) is a tie: a few hundred roundings of coordinates and of the
/// planes of neighbouring non-mortar facets, which otherwise decide differently about a mortar boundary
/// that follows their common edge.
const TIE: f64 = 1e-13;

/// e . ((b - a) x (p - a)): positive when p is to the left of the line from a to b.
#[inline]
fn distance(e: Vec3, a: Vec3, b: Vec3, p: Vec3) -> f64 {
    let (ab, ap, bp) = (b - a, p - a, p - b);
    let d = e.dot(&ab.cross(&ap));
    let size = ab.norm_squared() * ap.norm_squared().max(bp.norm_squared());
    if d * d <= TIE * TIE * size { 0.0 } else { d }
}

fn lexicographically_smaller(a: Vec3, b: Vec3) -> bool {
    (a.x, a.y, a.z) < (b.x, b.y, b.z)
}

/// The k-th edge of a mortar facet from its smaller end: (from, to, orientation).
fn canonical_edge(mortar: &Projection, k: usize) -> (usize, usize, f64) {
    let next = (k + 1) % mortar.shape.n;
    if lexicographically_smaller(mortar.x[k], mortar.x[next]) { (k, next, 1.0) } else { (next, k, -1.0) }
}

/// Narrows [low, high] to where the distance, linear from d0 to d1, is positive.
/// `zero_is_inside` says how a distance of exactly 0 counts.
fn narrow(interval: &mut (f64, f64), d0: f64, d1: f64, zero_is_inside: bool) {
    let inside = |d: f64| d > 0.0 || (d == 0.0 && zero_is_inside);
    match (inside(d0), inside(d1)) {
        (true, true) => {}
        (false, false) => *interval = (1.0, 0.0),
        (false, true) => interval.0 = interval.0.max(d0 / (d0 - d1)),
        (true, false) => interval.1 = interval.1.min(d0 / (d0 - d1)),
    }
}

/// The part of non-mortar edge k inside the mortar facet.
pub fn nonmortar_edge(one: &Projection, two: &Projection, plane: &Plane, k: usize) -> Option<EdgeInterval> {
    let (from, to) = (k, (k + 1) % one.shape.n);
    let mut interval = (0.0, 1.0);
    for j in 0..two.shape.n {
        let (a, b, orientation) = canonical_edge(two, j);
        let d = |p: Vec3| distance(plane.e, two.x[a], two.x[b], p);
        let (d0, d1) = (d(one.x[from]), d(one.x[to]));
        // The line moves to its right, so a point on it is to its left.
        narrow(&mut interval, orientation * d0, orientation * d1, orientation > 0.0);
    }
    let (low, high) = interval;
    (high > low).then_some(EdgeInterval { from, to, orientation: 1.0, low, high })
}

/// The part of mortar edge k inside the non-mortar facet.
pub fn mortar_edge(one: &Projection, two: &Projection, plane: &Plane, k: usize) -> Option<EdgeInterval> {
    let (from, to, orientation) = canonical_edge(two, k);
    let direction = two.y[to] - two.y[from];
    let mut interval = (0.0, 1.0);
    for j in 0..one.shape.n {
        let (a, b) = (j, (j + 1) % one.shape.n);
        let d = |p: Vec3| distance(plane.e, one.x[a], one.x[b], p);
        let (d0, d1) = (d(two.x[from]), d(two.x[to]));
        // A point of the mortar line moves to the right of `direction`: inwards when that runs
        // against the non-mortar edge. Only a collinear edge depends on it.
        let moves_inwards = (one.y[b] - one.y[a]).dot(&direction) <= 0.0;
        narrow(&mut interval, d0, d1, moves_inwards);
    }
    let (low, high) = interval;
    (high > low).then_some(EdgeInterval { from, to, orientation, low, high })
}
