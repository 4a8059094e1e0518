//! The overlap of a facet pair in the non-mortar facet's auxiliary plane (docs/formulation.md 2.3):
//! a polygon for the volume integrals, source-edge intervals for the edge integrals of the derivatives (3.5 there).
//! Or the points of the non-mortar facet that fall on the mortar facet (`element_rule.rs`).

use super::edges::intervals;
use super::element_rule::CellPoints;
use crate::error::{Error, Kind, Result};
use crate::geometry::bilinear_map::BilinearMap;
use crate::geometry::clip::{self, Polygon};
use crate::geometry::{Facet, Plane, Projection};
use crate::shape::{Cell, MAX_NODES, Quad4, Tri3};
use crate::simd::{self, Kernel, Lanes, Plain};
use std::marker::PhantomData;

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
    /// See [`Projection::convex_reach`]; its own coordinates are within.
    reach: f64,
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
    /// The points that stand for the overlap, in place of the polygon.
    pub points: Option<CellPoints>,
}

/// A kernel over the kinds of both facets.
pub(super) trait CellKernel {
    type Output;
    /// To be marked `#[inline(always)]`.
    fn run<L: Lanes, One: Cell, Two: Cell>(self) -> Self::Output;
}

/// The kinds of a pair's facets.
#[derive(Clone, Copy)]
pub(super) enum Cells {
    TriTri,
    TriQuad,
    QuadTri,
    QuadQuad,
}

impl Cells {
    #[inline]
    pub fn of(frame: &NonmortarFrame, segment: &Segment) -> Cells {
        match (frame.projection.shape.n, segment.mortar.shape.n) {
            (3, 3) => Cells::TriTri,
            (3, _) => Cells::TriQuad,
            (_, 3) => Cells::QuadTri,
            _ => Cells::QuadQuad,
        }
    }

    /// Runs the kernel compiled for these kinds, for any processor.
    #[inline]
    pub fn plain<K: CellKernel>(self, kernel: K) -> K::Output {
        match self {
            Cells::TriTri => kernel.run::<Plain, Tri3, Tri3>(),
            Cells::TriQuad => kernel.run::<Plain, Tri3, Quad4>(),
            Cells::QuadTri => kernel.run::<Plain, Quad4, Tri3>(),
            Cells::QuadQuad => kernel.run::<Plain, Quad4, Quad4>(),
        }
    }

    /// Runs the kernel compiled for these kinds, on this processor.
    #[inline]
    pub fn dispatch<K: CellKernel>(self, kernel: K) -> K::Output {
        match self {
            Cells::TriTri => simd::dispatch(ForCells(kernel, PhantomData::<(Tri3, Tri3)>)),
            Cells::TriQuad => simd::dispatch(ForCells(kernel, PhantomData::<(Tri3, Quad4)>)),
            Cells::QuadTri => simd::dispatch(ForCells(kernel, PhantomData::<(Quad4, Tri3)>)),
            Cells::QuadQuad => simd::dispatch(ForCells(kernel, PhantomData::<(Quad4, Quad4)>)),
        }
    }
}

struct ForCells<K, One, Two>(K, PhantomData<(One, Two)>);

impl<K: CellKernel, One: Cell, Two: Cell> Kernel for ForCells<K, One, Two> {
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

impl Segment {
    /// The overlap of `facet` with the frame's facet; `None` when they do not even touch.
    ///
    /// # Errors
    /// [`Kind::ProjectionNotConvex`] when the mortar facet is too steep or too warped to be projected, or so much larger
    /// that to its rounding the non-mortar facet is not convex.
    pub fn new(frame: &NonmortarFrame, facet: &Facet) -> Result<Option<Segment>> {
        simd::dispatch(Overlap { frame, facet })
    }
}

struct Overlap<'a> {
    frame: &'a NonmortarFrame,
    facet: &'a Facet,
}

impl Kernel for Overlap<'_> {
    type Output = Result<Option<Segment>>;

    #[inline(always)]
    fn run<L: Lanes>(self) -> Result<Option<Segment>> {
        let Overlap { frame, facet } = self;
        let one = &frame.projection;
        let Some(mortar) = project::<L>(frame, facet) else { return Ok(None) };
        check(frame, &mortar)?;
        let mut polygon = clip::overlap::<L>(one, &mortar);
        let mut area = polygon.area();
        let small = one.size.min(mortar.size);
        if !(area > SMALLEST_OVERLAP * small * small) {
            area = 0.0;
            polygon.clear();
            // Whether a part of an edge bounds the overlap.
            let intervals = intervals::<L>(one, &mortar, &frame.plane);
            if !intervals.iter().flatten().any(Option::is_some) {
                return Ok(None);
            }
        }
        Ok(Some(Segment { mortar_map: BilinearMap::new(&mortar), mortar, polygon, area, points: None }))
    }
}

/// The mortar facet in the frame's plane; `None` when it does not even touch the frame's facet.
#[inline(always)]
pub(super) fn project<L: Lanes>(frame: &NonmortarFrame, facet: &Facet) -> Option<Projection> {
    let one = &frame.projection;
    let mortar = Projection::on::<L>(facet, &frame.plane);
    let margin = BOX_MARGIN * one.size.min(mortar.size);
    // Most of those beside each other, before the exact test of what touches.
    let apart = one.is_apart(&mortar, margin) || mortar.is_edge_on() || one.separates::<L>(&mortar, margin);
    (!apart).then_some(mortar)
}

/// Whether the maps of both facets have inverses at all points of either.
#[inline(always)]
pub(super) fn check(frame: &NonmortarFrame, mortar: &Projection) -> Result<()> {
    let (distance, reach) = (mortar.distance(), mortar.convex_reach());
    if !((reach > frame.projection.size) & (reach > distance)) {
        return Err(not_convex());
    }
    if !(frame.reach > distance) {
        return Err(too_large());
    }
    Ok(())
}

#[cold]
fn not_convex() -> Error {
    let text = "the mortar facet's projection on the non-mortar facet's plane is not convex, or has a straight corner to rounding: it is too steep or too warped for this pair";
    Error::new(Kind::ProjectionNotConvex, text)
}

#[cold]
fn too_large() -> Error {
    let text = "the mortar facet is so much larger than the non-mortar one that to its rounding a corner of that is straight, and the projection not convex";
    Error::new(Kind::ProjectionNotConvex, text)
}
