//! The overlaps of a non-mortar facet with its pairs, where the weights alone do not serve: for derivatives, and for layers.
//! They are functions of the positions, so that what is found again is the same in every bit.

use super::candidates::by_points;
use super::filter::Filter;
use super::given::Given;
use crate::error::Result;
use crate::geometry::Facet;
use crate::interface::data::active::Active;
use crate::interface::data::options::Options;
use crate::interface::data::surface::Surface;
use crate::memory::Store;
use crate::mortar::{NonmortarFrame, Segment};
use std::ops::Range;

/// The overlap of a mortar facet with the frame's one, or the points of `line` that stand for it.
#[inline]
pub fn overlap(frame: &NonmortarFrame, facet: &Facet, line: Option<&'static [[f64; 2]]>) -> Result<Option<Segment>> {
    match line {
        Some(line) => Segment::of_points(frame, facet, line),
        None => Segment::new(frame, facet),
    }
}

/// The frame of one facet, and the overlaps of its pairs. Large, so that one serves all facets.
#[derive(Debug, Default)]
pub struct FacetOverlaps {
    frame: Option<NonmortarFrame>,
    /// In the order of the pairs; none against an analytic mortar side.
    pub segments: Vec<Segment>,
}

impl FacetOverlaps {
    /// The frame of the facet that was asked for last.
    pub fn frame(&self) -> &NonmortarFrame {
        self.frame.as_ref().expect("asked for after a facet is")
    }

    /// Makes derivatives leave out how the facet's plane tilts.
    pub fn freeze_normals(&mut self) {
        if let Some(frame) = &mut self.frame {
            frame.plane.tilt = Default::default();
        }
    }

    /// Takes those of the active pairs in these places, all of one facet and at least one.
    pub fn find(
        &mut self,
        (one, two): (&Surface, &Surface),
        (options, filter): (&Options, &Filter),
        active: &Active,
        places: Range<usize>,
    ) -> Result<()> {
        let pairs = &active.pairs[places];
        let f = pairs[0].one;
        let FacetOverlaps { frame, segments } = self;
        *frame = Some(one.frame(f, &active.x1, &active.normals)?);
        segments.clear();
        let (Some(frame), Filter::Facets(filter)) = (frame, filter) else { return Ok(()) };
        let line = by_points(options, filter, f);
        for pair in pairs {
            let facet = two.facet(pair.two, &active.x2);
            // Large: moved once.
            let found = overlap(frame, &facet, line);
            match found {
                Ok(Some(segment)) => segments.store(segment)?,
                Ok(None) => unreachable!("an active pair has an overlap at the positions it was found at"),
                Err(error) => return Err(error),
            }
        }
        Ok(())
    }

    /// The same of a tangent's pairs.
    pub fn of<const N: usize>(&mut self, given: Given<N>, active: &Active, places: Range<usize>) -> Result<()> {
        let filter = given.step.pairing.filter.as_ref().expect("weights that are differentiated are of now");
        self.find(given.setup.surfaces(), (&given.setup.options, filter), active, places)
    }
}
