//! A facet projected on an auxiliary plane: y_k = (t1 . z_k, t2 . z_k), height d_k = e . z_k,
//! z_k = x_k - x0 (formulation c.2). Sides are ordered counter-clockwise in the plane.

use super::plane::SMALLEST_AREA_RATIO;
use super::{Facet, Plane, Vec2, Vec3, cross};
use crate::shape::{MAX_NODES, Shape};

/// A projected corner (the cross product of its edges, over the facet's area) below this makes the facet non-convex. The
/// inverse map takes the root of a square that is known to a rounding of the area's: what is smaller than the root of
/// that rounding, 1.5e-8, may come out as 0, and divides.
const SMALLEST_CORNER: f64 = 1e-7;
/// A projected area below this (over the squared size) is a facet seen edge-on, or one without area: no overlap. Its map
/// has no inverse but rounding.
const EDGE_ON: f64 = SMALLEST_AREA_RATIO;

/// A facet in the plane.
#[derive(Clone, Copy, Debug)]
pub struct Projection {
    /// Shape functions, in the order of `y`.
    pub shape: &'static Shape,
    /// Position relative to the plane's reference node; differences of these are exact under offsets.
    pub x: [Vec3; MAX_NODES],
    /// In-plane coordinates, counter-clockwise.
    pub y: [Vec2; MAX_NODES],
    /// Height over the plane.
    pub d: [f64; MAX_NODES],
    /// Where node k stands in the facet as given: the order is reversed when it came clockwise.
    pub node: [usize; MAX_NODES],
    /// Twice the projected area (>= 0) [L^2].
    pub area2: f64,
    /// Largest in-plane extent `[L]`.
    pub size: f64,
}

impl Projection {
    /// Projects `facet` on `plane`.
    pub fn new(facet: &Facet, plane: &Plane) -> Projection {
        let shape = facet.shape;
        let mut p = Projection {
            shape,
            x: [Vec3::zeros(); MAX_NODES],
            y: [Vec2::zeros(); MAX_NODES],
            d: [0.0; MAX_NODES],
            node: [0, 1, 2, 3],
            area2: 0.0,
            size: 0.0,
        };
        let z = facet.nodes.map(|x| x - plane.reference - plane.origin);
        let y = z.map(|z| Vec2::new(plane.t1.dot(&z), plane.t2.dot(&z)));
        for k in 1..shape.n {
            let side = y[k] - y[0];
            p.area2 += cross(side, y[shape.next[k]] - y[0]);
            p.size = p.size.max(side.x.abs()).max(side.y.abs());
        }
        if p.area2 < 0.0 {
            p.area2 = -p.area2;
            p.node = shape.reversed;
        }
        for k in 0..shape.n {
            let j = p.node[k];
            p.x[k] = facet.nodes[j] - plane.reference;
            p.y[k] = y[j];
            p.d[k] = plane.e.dot(&z[j]);
        }
        p
    }

    /// Whether the facet came clockwise.
    pub fn is_reversed(&self) -> bool {
        self.node[1] != 1
    }

    /// Whether the facet is seen edge-on, so that it covers nothing of the plane.
    pub fn is_edge_on(&self) -> bool {
        !(self.area2 > EDGE_ON * self.size * self.size)
    }

    /// Whether every corner is convex.
    pub fn is_convex(&self) -> bool {
        let next = &self.shape.next;
        (0..self.shape.n).all(|k| {
            let (a, b, c) = (self.y[k], self.y[next[k]], self.y[next[next[k]]]);
            cross(b - a, c - b) > SMALLEST_CORNER * self.area2
        })
    }

    /// Whether the in-plane bounding boxes are apart by more than `margin`.
    pub fn is_apart(&self, other: &Projection, margin: f64) -> bool {
        let (a, b) = (self.bounds(), other.bounds());
        (0..2).any(|i| a.0[i] > b.1[i] + margin || b.0[i] > a.1[i] + margin)
    }

    /// Whether a side of this convex facet has all of `other` beyond it by more than `margin`.
    pub fn separates(&self, other: &Projection, margin: f64) -> bool {
        (0..self.shape.n).any(|k| {
            let (from, side) = (self.y[k], self.y[self.shape.next[k]] - self.y[k]);
            let beyond = -margin * (side.x.abs() + side.y.abs());
            other.y[..other.shape.n].iter().all(|y| cross(side, y - from) < beyond)
        })
    }

    fn bounds(&self) -> (Vec2, Vec2) {
        let y = &self.y[..self.shape.n];
        let low = |a: Vec2, b: &Vec2| Vec2::new(a.x.min(b.x), a.y.min(b.y));
        let high = |a: Vec2, b: &Vec2| Vec2::new(a.x.max(b.x), a.y.max(b.y));
        (y.iter().fold(y[0], low), y.iter().fold(y[0], high))
    }
}
