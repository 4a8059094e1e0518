//! The overlap of a facet pair in the non-mortar facet's auxiliary plane (formulation c.3, kernel
//! notes A): a polygon for the volume integrals, source-edge intervals for the edge integrals of the derivatives.

use crate::error::{Error, Kind, Result};
use crate::geometry::bilinear_map::{BilinearMap, Preimage};
use crate::geometry::clip::{self, Polygon};
use crate::geometry::edge_interval::{self, EdgeInterval};
use crate::geometry::{Facet, Plane, Projection, Vec2, cross};
use crate::quadrature::Rule;
use crate::shape::MAX_NODES;

/// Overlaps below this (over the squared facet size) are rounding of facets that only touch. Their
/// edge parts count nevertheless.
pub const SMALLEST_OVERLAP: f64 = 1e-15;
/// In-plane boxes are padded by this (over the facet size): pairs that touch must be visited.
pub const BOX_MARGIN: f64 = 1e-9;

/// A non-mortar facet with everything its pairs share.
#[derive(Clone, Debug)]
pub struct NonmortarFrame {
    /// Auxiliary plane.
    pub plane: Plane,
    /// The facet projected on it.
    pub projection: Projection,
    /// Its map.
    pub map: BilinearMap,
}

impl NonmortarFrame {
    /// The frame of `facet`.
    ///
    /// # Errors
    /// [`Kind::DegenerateFacet`] when the facet has no area, is folded or is not convex.
    pub fn new(facet: &Facet) -> Result<NonmortarFrame> {
        let plane = Plane::of(facet)?;
        let projection = Projection::new(facet, &plane);
        if !projection.is_convex() {
            return Err(Error::new(
                Kind::DegenerateFacet,
                "the facet is folded or not convex; all its corners must be convex",
            ));
        }
        Ok(NonmortarFrame { map: BilinearMap::new(&projection), plane, projection })
    }

    /// int N_A da over the whole facet, covered or not [L^2].
    pub fn nodal_areas(&self) -> [f64; MAX_NODES] {
        let det = self.map.determinant();
        let mut areas = [0.0; MAX_NODES];
        for (area, m) in areas.iter_mut().zip(&self.projection.shape.moments) {
            *area = (0..3).map(|i| m[i] * det[i]).sum();
        }
        areas
    }
}

/// The overlap of one pair.
#[derive(Clone, Debug)]
pub struct Segment {
    /// The mortar facet projected on the non-mortar facet's plane.
    pub mortar: Projection,
    /// Its map.
    pub mortar_map: BilinearMap,
    /// The overlap; no vertices when it has no area.
    pub polygon: Polygon,
    /// Area of the overlap [L^2].
    pub area: f64,
}

/// The parts of a pair's edges that bound the overlap; only derivatives ask for them.
pub(super) struct Edges {
    /// Parts of the non-mortar edges inside the mortar facet.
    pub nonmortar: [Option<EdgeInterval>; MAX_NODES],
    /// Parts of the mortar edges inside the non-mortar facet.
    pub mortar: [Option<EdgeInterval>; MAX_NODES],
}

/// A quadrature point of the overlap.
pub(super) struct Point {
    /// Weight times area [L^2].
    pub weight: f64,
    /// Position on the non-mortar facet.
    pub one: Preimage,
    /// Position on the mortar facet.
    pub two: Preimage,
    /// Non-mortar shape functions.
    pub n1: [f64; MAX_NODES],
    /// Mortar shape functions, in the projection's order.
    pub n2: [f64; MAX_NODES],
}

impl Segment {
    /// The overlap of `facet` with the frame's facet; `None` when they do not even touch.
    ///
    /// # Errors
    /// [`Kind::ProjectionNotConvex`] when the mortar facet is too steep or too warped to be projected.
    pub fn new(frame: &NonmortarFrame, facet: &Facet) -> Result<Option<Segment>> {
        let one = &frame.projection;
        let mortar = Projection::new(facet, &frame.plane);
        let margin = BOX_MARGIN * one.size.min(mortar.size);
        if one.is_apart(&mortar, margin) || mortar.is_edge_on() {
            return Ok(None);
        }
        if !mortar.is_convex() {
            return Err(Error::new(
                Kind::ProjectionNotConvex,
                "the mortar facet's projection on the non-mortar facet's plane is not convex: it is too steep or too warped for this pair",
            ));
        }
        let mut polygon = clip::overlap(one, &mortar);
        let mut area = polygon.area();
        let small = one.size.min(mortar.size);
        if !(area > SMALLEST_OVERLAP * small * small) {
            area = 0.0;
            polygon = Polygon::empty();
        }
        let segment = Segment { mortar_map: BilinearMap::new(&mortar), mortar, polygon, area };
        let touches = || {
            let edges = segment.edges(frame);
            edges.nonmortar.iter().chain(&edges.mortar).any(Option::is_some)
        };
        Ok((area > 0.0 || touches()).then_some(segment))
    }

    /// The parts of the edges that bound the overlap.
    pub(super) fn edges(&self, frame: &NonmortarFrame) -> Edges {
        let (one, two) = (&frame.projection, &self.mortar);
        let nonmortar = |k| {
            if k < one.shape.n { edge_interval::nonmortar_edge(one, two, &frame.plane, k) } else { None }
        };
        let mortar = |k| if k < two.shape.n { edge_interval::mortar_edge(one, two, &frame.plane, k) } else { None };
        Edges { nonmortar: std::array::from_fn(nonmortar), mortar: std::array::from_fn(mortar) }
    }

    /// Calls `visit` at every quadrature point of the overlap.
    #[inline]
    pub(super) fn for_each_point(&self, frame: &NonmortarFrame, rule: &Rule, mut visit: impl FnMut(&Point)) {
        let v = self.polygon.vertices();
        if v.is_empty() {
            return;
        }
        // Affine integrands are exact on any triangles, so the fan with the fewest will do; otherwise
        // triangles around the mean vertex have the smaller error.
        let affine = frame.map.is_affine && self.mortar_map.is_affine;
        let (apex, first) = if affine { (v[0], 2) } else { (self.polygon.mean_vertex(), 0) };
        for i in first..v.len() {
            let (p, q) = (v[(i + v.len() - 1) % v.len()] - apex, v[i] - apex);
            let area = 0.5 * cross(p, q);
            for [l1, l2, w] in rule.triangle {
                let y: Vec2 = apex + p * *l1 + q * *l2;
                let (one, two) = (frame.map.inverse(y), self.mortar_map.inverse(y));
                visit(&Point {
                    weight: w * area,
                    one,
                    two,
                    n1: frame.projection.shape.values(one.xi, one.eta),
                    n2: self.mortar.shape.values(two.xi, two.eta),
                });
            }
        }
    }
}
