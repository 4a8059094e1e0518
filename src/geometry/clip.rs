//! Sutherland-Hodgman clipping of two convex polygons, in a fixed buffer and without a tolerance.
//!
//! Serves the volume part of the weights only, which depends on the region and not on who owns its
//! edges; the edge part of the derivative has its own exact intervals (`edge_interval`).

use super::projection::Projection;
use super::vector::{Vec2, cross};
use crate::simd::{Lanes, Stack};

/// Vertices a polygon can have. Exact arithmetic gives at most 8; rounding can add half as many again
/// at each of the four cuts: 4, 6, 9, 13, 19.
pub const MAX_VERTICES: usize = 20;

/// A polygon, counter-clockwise.
#[derive(Clone, Debug)]
pub struct Polygon {
    vertices: Stack<Vec2, MAX_VERTICES>,
}

impl Polygon {
    /// No vertices.
    pub fn empty() -> Polygon {
        Polygon { vertices: Stack::new() }
    }

    /// Takes all vertices away.
    pub fn clear(&mut self) {
        self.vertices.clear();
    }

    #[inline]
    fn push(&mut self, vertex: Vec2) {
        self.vertices.push(vertex);
    }

    /// The vertices.
    #[inline]
    pub fn vertices(&self) -> &[Vec2] {
        self.vertices.values()
    }

    /// Area, positive: the polygon is counter-clockwise [L^2].
    pub fn area(&self) -> f64 {
        let v = self.vertices();
        (2..v.len()).map(|i| 0.5 * cross(v[i - 1] - v[0], v[i] - v[0])).sum()
    }

    /// The arithmetic mean of the vertices.
    pub fn mean_vertex(&self) -> Vec2 {
        self.vertices().iter().sum::<Vec2>() / self.vertices().len() as f64
    }

    /// Makes `kept` the part to the left of the line from `a` to `b`; points on the line stay.
    #[inline(always)]
    fn cut(&self, a: Vec2, b: Vec2, kept: &mut Polygon) {
        kept.clear();
        let v = self.vertices();
        let Some(&last) = v.last() else { return };
        let side = |p: Vec2| cross(b - a, p - a);
        let (mut p0, mut s0) = (last, side(last));
        for &p1 in v {
            let s1 = side(p1);
            if (s0 < 0.0) != (s1 < 0.0) {
                kept.push(p0 + (p1 - p0) * (s0 / (s0 - s1)));
            }
            if s1 >= 0.0 {
                kept.push(p1);
            }
            (p0, s0) = (p1, s1);
        }
    }
}

impl Polygon {
    /// Area [L^2] and centroid of the part within a projected convex facet; the origin where there is none. Triangle by
    /// triangle: three vertices and four cuts fit into the buffers, whatever rounding does.
    pub fn part_within(&self, facet: &Projection) -> (f64, Vec2) {
        let (mut area, mut moment) = (0.0, Vec2::zeros());
        let (mut part, mut next) = (Polygon::empty(), Polygon::empty());
        let v = self.vertices();
        for i in 2..v.len() {
            part.clear();
            [v[0], v[i - 1], v[i]].into_iter().for_each(|corner| part.push(corner));
            for k in 0..facet.shape.n {
                part.cut(facet.y[k], facet.y[facet.shape.next[k]], &mut next);
                std::mem::swap(&mut part, &mut next);
            }
            let w = part.vertices();
            for j in 2..w.len() {
                let triangle = 0.5 * cross(w[j - 1] - w[0], w[j] - w[0]);
                area += triangle;
                moment += (w[0] + w[j - 1] + w[j]) * (triangle / 3.0);
            }
        }
        (area, if area > 0.0 { moment / area } else { moment })
    }
}

/// The overlap of two projected convex facets.
#[inline(always)]
pub fn overlap<L: Lanes>(one: &Projection, two: &Projection) -> Polygon {
    // The smaller one is cut: the vertices it keeps know nothing of the other's size.
    let (one, two) = if one.area2 < two.area2 { (two, one) } else { (one, two) };
    let (mut first, mut second) = (Polygon::empty(), Polygon::empty());
    let (mut polygon, mut next) = (&mut first, &mut second);
    for k in 0..two.shape.n {
        polygon.push(two.y[k]);
    }
    let [u, v] = two.in_plane::<L>();
    for k in 0..one.shape.n {
        let (a, b) = (one.y[k], one.y[one.shape.next[k] & 3]);
        // What has no vertex beyond a line is not cut by it.
        let side = b - a;
        let inside = L::splat(side.x) * (v - L::splat(a.y)) - L::splat(side.y) * (u - L::splat(a.x));
        if inside.store().iter().any(|s| *s < 0.0) {
            polygon.cut(a, b, next);
            (polygon, next) = (next, polygon);
        }
    }
    polygon.clone()
}
