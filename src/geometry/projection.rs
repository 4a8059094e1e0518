//! A facet projected on an auxiliary plane: y_k = (t1 . z_k, t2 . z_k), height d_k = e . z_k,
//! z_k = x_k - x0 (docs/formulation 2.1). Sides are ordered counter-clockwise in the plane.

use super::facet::Facet;
use super::plane::Plane;
use super::plane::SMALLEST_AREA_RATIO;
use super::vector::{Vec2, Vec3, cross};
use crate::shape::{MAX_CORNERS, Shape};
use crate::simd::{self, Kernel, Lanes};

/// A corner is convex where the cross product of its edges, squared, is above this times the facet's area2, its size and
/// the reach of the coordinates. The inverse map takes the root of a square, det J^2, that is known to a rounding of
/// those three: what is smaller than the root of that, 1.5e-8 of a facet with the area of its squared size, may come out
/// as 0, and divides. Six times as much.
const SMALLEST_CORNER_SQUARED: f64 = 1e-14;
/// A projected area below this (over the squared size) is a facet seen edge-on, or one without area: no overlap. Its map
/// has no inverse but rounding.
const EDGE_ON: f64 = SMALLEST_AREA_RATIO;
/// The same over size times distance from the plane's origin: rounding of coordinates gives a line an area, too.
const PLACED: f64 = 16.0 * f64::EPSILON;
/// The same over size times largest height over the plane. The rounding of the plane's normal times a height moves a
/// node in the plane. Heights of this many facets move it by up to 1e-5 of a facet, where the normal is at its worst.
const TALL: f64 = 1e-10;

/// A facet in the plane.
#[derive(Clone, Copy, Debug)]
pub struct Projection {
    /// The facet's kind; functions in the order of `y`.
    pub shape: &'static Shape,
    /// Position in space, as given.
    pub x: [Vec3; MAX_CORNERS],
    /// In-plane coordinates, counter-clockwise.
    pub y: [Vec2; MAX_CORNERS],
    /// Height over the plane.
    pub d: [f64; MAX_CORNERS],
    /// Where node k stands in the facet as given: the order is reversed when it came clockwise.
    pub node: [usize; MAX_CORNERS],
    /// Twice the projected area (>= 0) [L^2].
    pub area2: f64,
    /// Largest in-plane extent from the first node `[L]`.
    pub size: f64,
    /// Bounds of the in-plane coordinates.
    pub low: Vec2,
    /// See `low`.
    pub high: Vec2,
}

impl Projection {
    /// Projects `facet` on `plane`.
    pub fn new(facet: &Facet, plane: &Plane) -> Projection {
        simd::dispatch(Project { facet, plane })
    }

    /// The same within a kernel.
    #[inline(always)]
    pub fn on<L: Lanes>(facet: &Facet, plane: &Plane) -> Projection {
        let (shape, zero) = (facet.shape, L::splat(0.0));
        let (mut x, mut y, mut d) = ([Vec3::zeros(); MAX_CORNERS], [zero; 2], zero);
        for k in 0..MAX_CORNERS {
            x[k] = facet.nodes[k] - plane.reference;
        }
        for i in 0..3 {
            let z = L::load(&[x[0][i], x[1][i], x[2][i], x[3][i]]) - L::splat(plane.origin[i]);
            y[0] = L::splat(plane.t1[i]).mul_add(z, y[0]);
            y[1] = L::splat(plane.t2[i]).mul_add(z, y[1]);
            d = L::splat(plane.e[i]).mul_add(z, d);
        }
        let ([u, v], d) = ([y[0].store(), y[1].store()], d.store());
        // A triangle's fourth point is its first one.
        let [low, high] = [[smallest(&u), smallest(&v)], [largest(&u), largest(&v)]];
        let mut p = Projection {
            shape,
            x: facet.nodes,
            y: [Vec2::zeros(); MAX_CORNERS],
            d: [0.0; MAX_CORNERS],
            node: [0, 1, 2, 3],
            area2: (u[2] - u[0]) * (v[3] - v[1]) - (u[3] - u[1]) * (v[2] - v[0]),
            size: (high[0] - u[0]).max(u[0] - low[0]).max(high[1] - v[0]).max(v[0] - low[1]),
            low: low.into(),
            high: high.into(),
        };
        if p.area2 < 0.0 {
            p.area2 = -p.area2;
            p.node = shape.reversed;
        }
        for k in 0..shape.n {
            let j = p.node[k] & 3; // so that no bounds are checked
            (p.x[k], p.y[k], p.d[k]) = (facet.nodes[j], Vec2::new(u[j], v[j]), d[j]);
        }
        p
    }

    /// Whether the facet came clockwise.
    pub fn is_reversed(&self) -> bool {
        self.node[1] != 1
    }

    /// Whether the facet covers nothing of the plane: it is seen edge-on, or reaches so high that its place in the plane
    /// is not known.
    #[inline(always)]
    pub fn is_edge_on(&self) -> bool {
        let height = largest(&self.d.map(f64::abs));
        let least = largest(&[EDGE_ON * self.size, PLACED * self.distance(), TALL * height, 0.0]);
        !(self.area2 > least * self.size)
    }

    /// The largest in-plane coordinate of a node `[L]`.
    #[inline(always)]
    pub fn distance(&self) -> f64 {
        largest(&[-self.low.x, -self.low.y, self.high.x, self.high.y])
    }

    /// The largest reach `[L]` of coordinates, its own and those of points that its map is asked for, at whose rounding
    /// every corner is convex; 0 where one is not at all.
    #[inline(always)]
    pub fn convex_reach(&self) -> f64 {
        if self.shape.n == 3 {
            return f64::INFINITY;
        }
        // The cross products at opposite corners add up to area2.
        let [a, b, c, d] = &self.y;
        let (ab, bc, cd) = (b - a, c - b, d - c);
        let (at_b, at_c) = (cross(ab, bc), cross(bc, cd));
        let corner = smallest(&[at_b, at_c, self.area2 - at_b, self.area2 - at_c]);
        if corner > 0.0 { (corner / self.area2) * (corner / self.size) / SMALLEST_CORNER_SQUARED } else { 0.0 }
    }

    /// Whether the in-plane bounding boxes are apart by more than `margin`.
    #[inline(always)]
    pub fn is_apart(&self, other: &Projection, margin: f64) -> bool {
        let beyond = |a: &Projection, b: &Projection, i: usize| a.low[i] > b.high[i] + margin;
        beyond(self, other, 0) | beyond(self, other, 1) | beyond(other, self, 0) | beyond(other, self, 1)
    }

    /// In-plane coordinates, component by component; a triangle's fourth vertex is its first one.
    #[inline(always)]
    pub fn in_plane<L: Lanes>(&self) -> [L; 2] {
        let y = &self.y;
        let last = if self.shape.n == 3 { y[0] } else { y[3] };
        [L::load(&[y[0].x, y[1].x, y[2].x, last.x]), L::load(&[y[0].y, y[1].y, y[2].y, last.y])]
    }

    /// Whether a side of this convex facet has all of `other` beyond it by more than `margin`.
    #[inline(always)]
    pub fn separates<L: Lanes>(&self, other: &Projection, margin: f64) -> bool {
        let [u, v] = other.in_plane::<L>();
        for k in 0..self.shape.n {
            let next = self.shape.next[k] & 3;
            let (from, side) = (self.y[k], self.y[next] - self.y[k]);
            let inside = L::splat(side.x) * (v - L::splat(from.y)) - L::splat(side.y) * (u - L::splat(from.x));
            if largest(&inside.store()) < -margin * (side.x.abs() + side.y.abs()) {
                return true;
            }
        }
        false
    }
}

struct Project<'a> {
    facet: &'a Facet,
    plane: &'a Plane,
}

impl Kernel for Project<'_> {
    type Output = Projection;
    #[inline(always)]
    fn run<L: Lanes>(self) -> Projection {
        Projection::on::<L>(self.facet, self.plane)
    }
}

#[inline(always)]
fn smallest(v: &[f64; 4]) -> f64 {
    let least = |a: f64, b: f64| if a < b { a } else { b };
    least(least(v[0], v[1]), least(v[2], v[3]))
}

#[inline(always)]
fn largest(v: &[f64; 4]) -> f64 {
    let most = |a: f64, b: f64| if a > b { a } else { b };
    most(most(v[0], v[1]), most(v[2], v[3]))
}
