//! The overlap of a facet pair in the non-mortar facet's auxiliary plane (docs/formulation 2.3): a polygon for the volume
//! integrals, source-edge intervals for the edge integrals of the derivatives (3.5 there).

use super::edges::intervals;
use super::segment::{NonmortarFrame, Segment};
use crate::error::{Error, Kind, Result};
use crate::geometry::bilinear_map::BilinearMap;
use crate::geometry::{Facet, Projection, clip};
use crate::simd::{self, Kernel, Lanes};

/// Overlaps below this (over the squared facet size) are rounding of facets that only touch. Their
/// edge parts count nevertheless.
pub const SMALLEST_OVERLAP: f64 = 1e-15;
/// In-plane boxes are padded by this (over the facet size): pairs that touch must be visited.
pub const BOX_MARGIN: f64 = 1e-9;

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
