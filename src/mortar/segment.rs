//! What the kernels of a pair work on: the non-mortar facet's frame, and the overlap of the mortar facet with it (found in
//! `overlap.rs`), or the points that stand for it (`element_rule.rs`); and how kernels are compiled for the facets' kinds.

use crate::error::{Error, Kind, Result};
use crate::geometry::bilinear_map::BilinearMap;
use crate::geometry::clip::Polygon;
use crate::geometry::{Facet, Plane, Projection};
use crate::shape::{Isoparametric, MAX_CORNERS, Quad4, SingleBasis, Tri3};
use crate::simd::{self, Kernel, Lanes, Plain};
use std::marker::PhantomData;

/// A non-mortar facet with everything its pairs share.
#[derive(Clone, Debug)]
pub struct NonmortarFrame {
    /// Auxiliary plane.
    pub plane: Plane,
    /// The facet projected on it.
    pub projection: Projection,
    /// Its map.
    pub map: BilinearMap,
    /// See [`Projection::convex_reach`]; its own coordinates are within.
    pub(super) reach: f64,
}

impl NonmortarFrame {
    /// The frame of `facet`.
    ///
    /// # Errors
    /// [`Kind::DegenerateFacet`] when the facet has no area, is folded or is not convex, be it by rounding.
    pub fn new(facet: &Facet) -> Result<NonmortarFrame> {
        simd::dispatch(Frame { facet })
    }

    /// int N_A da over the whole facet, covered or not [L^2].
    pub fn nodal_areas(&self) -> [f64; MAX_CORNERS] {
        let det = self.map.determinant();
        let mut areas = [0.0; MAX_CORNERS];
        for (area, m) in areas.iter_mut().zip(&self.projection.shape.fields.moments) {
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
    /// The points that stand for the overlap, in place of the polygon.
    pub points: Option<CellPoints>,
}

/// Points of a non-mortar facet's product rule, and which of them count. Packed, so that a segment may lie wherever a double
/// may, in a caller's array of these.
#[derive(Clone, Copy, Debug)]
#[repr(C, packed(8))]
pub struct CellPoints {
    /// Gauss points on a line.
    pub(super) line: &'static [[f64; 2]],
    /// Bit i: the i-th of their products lies on the mortar facet; bits after those: the non-mortar facet's corners.
    pub inside: u128,
}

impl CellPoints {
    /// The set in which every point and every corner lies on a mortar facet.
    pub fn all(frame: &NonmortarFrame, line: &[[f64; 2]]) -> u128 {
        (1 << (line.len() * line.len() + frame.projection.shape.n)) - 1
    }

    /// Points of the rule.
    pub fn count(&self) -> usize {
        self.line.len() * self.line.len()
    }

    /// Those of them that lie on the mortar facet.
    pub fn on_facet(&self) -> u32 {
        (self.inside & ((1 << self.count()) - 1)).count_ones()
    }
}

/// A kernel over the kinds of both facets. Kernels of a pair need all fields of the non-mortar facet, and the displacement
/// of the mortar facet, to have the functions of the maps. For a kind with others these bounds have to go, and then the
/// compiler names each place that needs them.
pub(super) trait KindKernel {
    type Output;
    /// To be marked `#[inline(always)]`.
    fn run<L: Lanes, One: SingleBasis, Two: Isoparametric>(self) -> Self::Output;
}

/// The kinds of a pair's facets.
#[derive(Clone, Copy)]
pub(super) enum Kinds {
    TriTri,
    TriQuad,
    QuadTri,
    QuadQuad,
}

impl Kinds {
    #[inline]
    pub fn of(frame: &NonmortarFrame, segment: &Segment) -> Kinds {
        match (frame.projection.shape.n, segment.mortar.shape.n) {
            (3, 3) => Kinds::TriTri,
            (3, _) => Kinds::TriQuad,
            (_, 3) => Kinds::QuadTri,
            _ => Kinds::QuadQuad,
        }
    }

    /// Runs the kernel compiled for these kinds, for any processor.
    #[inline]
    pub fn plain<K: KindKernel>(self, kernel: K) -> K::Output {
        match self {
            Kinds::TriTri => kernel.run::<Plain, Tri3, Tri3>(),
            Kinds::TriQuad => kernel.run::<Plain, Tri3, Quad4>(),
            Kinds::QuadTri => kernel.run::<Plain, Quad4, Tri3>(),
            Kinds::QuadQuad => kernel.run::<Plain, Quad4, Quad4>(),
        }
    }

    /// Runs the kernel compiled for these kinds, on this processor.
    #[inline]
    pub fn dispatch<K: KindKernel>(self, kernel: K) -> K::Output {
        match self {
            Kinds::TriTri => simd::dispatch(ForKinds(kernel, PhantomData::<(Tri3, Tri3)>)),
            Kinds::TriQuad => simd::dispatch(ForKinds(kernel, PhantomData::<(Tri3, Quad4)>)),
            Kinds::QuadTri => simd::dispatch(ForKinds(kernel, PhantomData::<(Quad4, Tri3)>)),
            Kinds::QuadQuad => simd::dispatch_wide(ForKinds(kernel, PhantomData::<(Quad4, Quad4)>)),
        }
    }
}

struct ForKinds<K, One, Two>(K, PhantomData<(One, Two)>);

impl<K: KindKernel, One: SingleBasis, Two: Isoparametric> Kernel for ForKinds<K, One, Two> {
    type Output = K::Output;
    #[inline(always)]
    fn run<L: Lanes>(self) -> K::Output {
        self.0.run::<L, One, Two>()
    }
}

struct Frame<'a> {
    facet: &'a Facet,
}

impl Kernel for Frame<'_> {
    type Output = Result<NonmortarFrame>;

    #[inline(always)]
    fn run<L: Lanes>(self) -> Result<NonmortarFrame> {
        let plane = Plane::of(self.facet)?;
        let projection = Projection::on::<L>(self.facet, &plane);
        let reach = projection.convex_reach();
        if !(reach > projection.size) {
            return Err(folded());
        }
        Ok(NonmortarFrame { map: BilinearMap::new(&projection), plane, projection, reach })
    }
}

#[cold]
fn folded() -> Error {
    let text = "the facet is folded or not convex; all its corners must be convex, by more than rounding";
    Error::new(Kind::DegenerateFacet, text)
}
