//! Layers of the mortar surface over a non-mortar facet: mortar facets that are paired with it and lie over each other.
//! Their gaps would be added up, and each of them would be given the facet's force. So a commit settles which of them are
//! pairs: the nearest ones (docs/formulation 6.6).
//!
//! The mortar facets over one non-mortar facet fall into sheets, joined by common nodes. Bodies side by side are several
//! sheets, too, so that what counts is the area that two sheets both cover: of polygons in the facet's plane, exact,
//! where a coverage by quadrature has the error of its rule. A sheet lies over itself only where its polygons have more
//! area than the facet.

use super::acting::acting;
use super::over::{Layers, Over, SHARED, SLIVER};
use crate::adjacency::root;
use crate::error::{Error, Kind, Result};
use crate::geometry::Vec3;
use crate::interface::data::active::Active;
use crate::interface::data::options::Options;
use crate::interface::data::pairs::PairRecord;
use crate::interface::data::surface::{NO_FACET, Surface};
use crate::interface::pairing::filter::Filter;
use crate::interface::pairing::hidden::Hidden;
use crate::interface::pairing::overlaps::FacetOverlaps;
use crate::interface::pairing::stacked::stacked;
use crate::interface::pairing::work::{Room, Work};
use crate::memory::{self, Store};
use std::ops::Range;

/// A facet's area as two ways of reckoning it find it differs by less than this: rounding of coordinates a million facets from
/// the origin, with six digits to spare.
const DIFFERENT: f64 = 1e-4;

/// Settles which mortar facets are hidden in the step that follows, of the pairs at (x1, x2) with a filter that hides none, and
/// leaves the others. What is there after a refusal means nothing.
#[inline(never)] // it is met several times
pub fn settle(
    surfaces: (&Surface, &Surface),
    options: &Options,
    filter: &mut Filter,
    work: &mut Work,
    (x1, x2): (&[Vec3], &[Vec3]),
    active: &mut Active,
) -> Result<()> {
    let mut hidden = Hidden::default();
    for layers in find(surfaces, (options, filter), &mut work.room, active)? {
        let Layers { under, hidden: facets, together } = layers?;
        if let Some(both) = together {
            let (under, [a, b]) = (surfaces.0.host_facet(under), both.map(|f| surfaces.1.host_facet(f)));
            let text = text!(
                "the mortar surface lies in layers over non-mortar facet {under}: mortar facets {a} and {b} lie on each other, in one place, so that none is nearer; leave one of them out"
            );
            return Err(Error::new(Kind::InvalidValue, text));
        }
        hidden.pairs.store_all(facets.iter().map(|&j| (under as u32, j as u32)))?;
    }
    let Filter::Facets(facets) = filter else { return Ok(()) };
    if hidden.pairs.is_empty() {
        return Ok(());
    }
    hidden.stacked = stacked(facets, work.tree.at(surfaces.1, x2)?)?;
    for (pair, area) in active.pairs.iter().zip(&active.areas) {
        let numbers = (pair.one as u32, pair.two as u32);
        let size = facets.sides[0].edges[pair.one].min(facets.sides[1].edges[pair.two]);
        let is_stacked = hidden.stacked[pair.two] != [NO_FACET; 2] && *area > SLIVER * size * size;
        if is_stacked && hidden.pairs.binary_search(&numbers).is_err() {
            hidden.kept.store(numbers)?;
        }
    }
    facets.hidden = hidden;
    acting(surfaces, options, filter, work, (x1, x2), active)
}

/// One for each non-mortar facet that has layers over it. None against an analytic mortar side, which has no overlaps.
pub fn find<'a>(
    (one, two): (&'a Surface, &'a Surface),
    by: (&'a Options, &'a Filter),
    Room { met, sheets, .. }: &'a mut Room,
    at: &'a Active,
) -> Result<impl Iterator<Item = Result<Layers>> + 'a> {
    memory::refill(met, (usize::MAX, 0), two.reference.len())?;
    let (mut sheets, mut overlaps) = (Sheets { met, of: sheets }, FacetOverlaps::default());
    let pairs = if at.areas.is_empty() { &[] } else { &at.pairs[..] };
    let mut first = 0;
    Ok(pairs.chunk_by(|p, q| p.one == q.one).filter_map(move |pairs| {
        let places = first..first + pairs.len();
        first = places.end;
        if pairs.len() < 2 {
            return None;
        }
        sheets.over((one, two), by, (at, places), &mut overlaps).transpose()
    }))
}

/// Which mortar facets over one non-mortar facet hang together.
struct Sheets<'a> {
    /// See [`Room::met`].
    met: &'a mut [(usize, usize)],
    /// See [`Room::sheets`].
    of: &'a mut Vec<usize>,
}

impl Sheets<'_> {
    /// Layers over one non-mortar facet, that of the pairs in these places. Overlaps are found again where there may be any.
    fn over(
        &mut self,
        (one, two): (&Surface, &Surface),
        by: (&Options, &Filter),
        (at, places): (&Active, Range<usize>),
        overlaps: &mut FacetOverlaps,
    ) -> Result<Option<Layers>> {
        let (pairs, areas) = (&at.pairs[places.start..places.end], &at.areas[places.start..places.end]);
        let covered = areas.iter().sum::<f64>();
        let is_several = self.unite(two, pairs, areas)?;
        let area = 0.5 * one.facet(pairs[0].one, &at.x1).area_vector().norm();
        if !is_several && covered <= (1.0 + SHARED - DIFFERENT) * area {
            return Ok(None);
        }
        overlaps.find((one, two), by, at, places)?;
        let (frame, segments) = (overlaps.frame(), &overlaps.segments[..]);
        let is_twice = covered > (1.0 + SHARED) * (0.5 * frame.projection.area2);
        let at = Over { surfaces: (one, two), frame, pairs, segments };
        if is_several || is_twice { at.layers(self.of, is_twice) } else { Ok(None) }
    }

    /// Joins the pairs of a non-mortar facet that have an area; whether there are several sheets.
    fn unite(&mut self, mortar: &Surface, pairs: &[PairRecord], areas: &[f64]) -> Result<bool> {
        self.of.clear();
        self.of.store_all(0..pairs.len())?;
        let mut sheets = 0;
        for (p, pair) in pairs.iter().enumerate().filter(|(p, _)| areas[*p] > 0.0) {
            sheets += 1;
            for &node in mortar.facets[pair.two].as_slice() {
                let (one, q) = std::mem::replace(&mut self.met[node], (pair.one, p));
                if one == pair.one {
                    let (a, b) = (root(self.of, p), root(self.of, q));
                    self.of[a] = b;
                    sheets -= usize::from(a != b);
                }
            }
        }
        Ok(sheets > 1)
    }
}
