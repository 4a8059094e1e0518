//! The quadrature points of an overlap, four at a time: triangles of the polygon (docs/formulation 2.3) with the inverse
//! maps of both facets (2.2).

use super::segment::{NonmortarFrame, Segment};
use crate::geometry::bilinear_map::{InverseMap, Preimage};
use crate::geometry::{Vec2, cross};
use crate::quadrature::{DEGREE_2, Rule};
use crate::shape::{Cell, Isoparametric, SingleBasis};
use crate::simd::Lanes;

/// Four quadrature points.
#[derive(Clone, Copy)]
pub(super) struct Points<L> {
    /// Weight times area [L^2].
    pub weight: L,
    /// Positions on the non-mortar facet.
    pub one: Preimage<L>,
    /// Positions on the mortar facet.
    pub two: Preimage<L>,
}

/// The triangles of an overlap: (apex; p, q) stands for apex, apex + p, apex + q.
pub(super) struct Fan<'a> {
    vertices: &'a [Vec2],
    apex: Vec2,
    next: usize,
    last: Vec2,
}

impl<'a> Fan<'a> {
    /// Affine integrands are exact on any triangles, so the fan with the fewest will do; otherwise triangles around the
    /// mean vertex have the smaller error.
    #[inline(always)]
    pub fn new(frame: &NonmortarFrame, segment: &'a Segment) -> Fan<'a> {
        let vertices = segment.polygon.vertices();
        let Some(&last) = vertices.last() else {
            return Fan { vertices, apex: Vec2::zeros(), next: 0, last: Vec2::zeros() };
        };
        if frame.map.is_affine && segment.mortar_map.is_affine {
            return Fan { vertices, apex: vertices[0], next: 2, last: vertices[1] };
        }
        Fan { vertices, apex: segment.polygon.mean_vertex(), next: 0, last }
    }

    /// The next triangle.
    #[inline(always)]
    pub fn triangle(&mut self) -> Option<[Vec2; 3]> {
        let &vertex = self.vertices.get(self.next)?;
        let triangle = [self.apex, self.last - self.apex, vertex - self.apex];
        self.next += 1;
        self.last = vertex;
        Some(triangle)
    }
}

/// The points of a triangle, four at a time. The functions of triangles, their maps' and so their fields', are linear with
/// constant gradients: nothing in their integrals is above degree 2, so that any finer rule gives the same with more
/// points.
#[inline(always)]
pub(super) fn triangle_lanes<One: SingleBasis, Two: Isoparametric>(rule: &Rule) -> &'static [[[f64; 4]; 3]] {
    let linear = !One::Cell::BILINEAR && !Two::Cell::BILINEAR;
    if linear && rule.degree > DEGREE_2.degree { DEGREE_2.triangle_lanes } else { rule.triangle_lanes }
}

/// The maps of a pair's facets.
pub(super) struct Maps<L> {
    pub one: InverseMap<L>,
    pub two: InverseMap<L>,
}

impl<L: Lanes> Maps<L> {
    #[inline(always)]
    pub fn new(frame: &NonmortarFrame, segment: &Segment) -> Self {
        Maps { one: frame.map.lanes(), two: segment.mortar_map.lanes() }
    }
}

/// Four points of a triangle.
#[inline(always)]
pub(super) fn points<L: Lanes>(maps: &Maps<L>, [l1, l2, w]: &[[f64; 4]; 3], [apex, p, q]: &[Vec2; 3]) -> Points<L> {
    let (l1, l2) = (L::load(l1), L::load(l2));
    let x = L::splat(q.x).mul_add(l2, L::splat(p.x).mul_add(l1, L::splat(apex.x)));
    let y = L::splat(q.y).mul_add(l2, L::splat(p.y).mul_add(l1, L::splat(apex.y)));
    Points { weight: L::load(w) * L::splat(0.5 * cross(*p, *q)), one: maps.one.at([x, y]), two: maps.two.at([x, y]) }
}
