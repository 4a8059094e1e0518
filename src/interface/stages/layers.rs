//! Layers of the mortar surface over a non-mortar facet: mortar facets that are paired with it and lie over each other.
//! Their gaps would be added up, and each of them would be given the facet's force.
//!
//! The mortar facets over one non-mortar facet fall into sheets, joined by common nodes. Bodies side by side are several
//! sheets, too, so that what counts is the area that two sheets both cover: of polygons in the facet's plane, exact,
//! where a coverage by quadrature has the error of its rule. A sheet lies over itself only where its polygons have more
//! area than the facet.

use crate::adjacency::root;
use crate::error::{Error, Kind, Result};
use crate::geometry::Vec2;
use crate::geometry::clip::{self, Polygon};
use crate::interface::data::active::Active;
use crate::interface::data::options::Options;
use crate::interface::data::pairs::PairRecord;
use crate::interface::data::surface::Surface;
use crate::interface::pairing::filter::Filter;
use crate::interface::pairing::overlaps::FacetOverlaps;
use crate::interface::pairing::work::Room;
use crate::memory::{self, Store};
use crate::mortar::{NonmortarFrame, Segment};
use crate::simd::Plain;
use std::ops::Range;

/// There are layers where two sheets share more than this of the smaller one, or all that is covered twice is more than
/// this of the facet. Parts side by side whose meshes do not match along a curve share less: a polygon of 12 edges lacks
/// 4.5 % of its circle.
pub const SHARED: f64 = 0.05;
/// Overlaps below this, over the smaller facet's area, are rounding of facets that touch: of positions a million facets
/// from the origin, with four digits to spare.
const SLIVER: f64 = 1e-6;
/// A facet's area as two ways of reckoning it find it differs by less than this: rounding of coordinates a million facets from
/// the origin, with six digits to spare.
const DIFFERENT: f64 = 1e-4;
/// Facets closer than this, over the size of the smaller one, lie on each other: rounding of a rotated mesh is 1e-16 of
/// its extent.
const TOGETHER: f64 = 1e-8;

/// Two mortar facets that lie over each other under a non-mortar one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layers {
    /// The non-mortar facet.
    pub under: usize,
    /// The mortar facets.
    pub facets: [usize; 2],
    /// Their distance along the non-mortar facet's normal, in the middle of their overlap `[L]`; 0 within rounding.
    pub apart: f64,
}

/// Refuses a mortar surface that lies in layers.
pub fn refuse(surfaces: (&Surface, &Surface), by: (&Options, &Filter), room: &mut Room, at: &Active) -> Result<()> {
    let Some(found) = find(surfaces, by, room, at)?.next() else { return Ok(()) };
    let Layers { under, facets, apart } = found?;
    let (under, [a, b]) = (surfaces.0.host_facet(under), facets.map(|f| surfaces.1.host_facet(f)));
    let text = if apart > 0.0 {
        text!(
            "the mortar surface lies in layers over non-mortar facet {under}: mortar facets {a} and {b} lie over each other, {apart:.3e} apart; set search_distance below their distance, or leave the farther ones out"
        )
    } else {
        text!(
            "the mortar surface lies in layers over non-mortar facet {under}: mortar facets {a} and {b} lie on each other, in one place; leave one of them out"
        )
    };
    Err(Error::new(Kind::InvalidValue, text))
}

/// One pair of mortar facets for each non-mortar facet that has layers over it. None against an analytic mortar side,
/// which has no overlaps.
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
        if is_several || is_twice { among(frame, (pairs, segments), self.of, is_twice) } else { Ok(None) }
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

/// What one mortar facet covers of the non-mortar one.
struct Region {
    /// Place of its pair, and sheet.
    pair: usize,
    sheet: usize,
    polygon: Polygon,
    low: Vec2,
    high: Vec2,
}

/// What two of them cover both.
#[derive(Clone, Copy)]
struct Shared {
    sheets: [usize; 2],
    pairs: [usize; 2],
    area: f64,
    centre: Vec2,
}

/// Layers among the mortar facets over one non-mortar facet; those of one sheet are compared where `is_twice`.
fn among(
    frame: &NonmortarFrame,
    (pairs, segments): (&[PairRecord], &[Segment]),
    of: &mut [usize],
    is_twice: bool,
) -> Result<Option<Layers>> {
    let mut areas = memory::filled(0.0, pairs.len())?;
    let mut regions = memory::with_room(pairs.len())?;
    for (pair, segment) in segments.iter().enumerate().filter(|(_, s)| s.area > 0.0) {
        // Points in place of an overlap have no polygon.
        let polygon = match segment.points {
            None => segment.polygon.clone(),
            Some(_) => clip::overlap::<Plain>(&frame.projection, &segment.mortar),
        };
        let sheet = root(of, pair);
        areas[sheet] += polygon.area();
        let bound = |pick: fn(f64, f64) -> f64, from: f64| {
            polygon.vertices().iter().fold(Vec2::repeat(from), |b, v| b.zip_map(v, pick))
        };
        let (low, high) = (bound(f64::min, f64::INFINITY), bound(f64::max, f64::NEG_INFINITY));
        regions.store(Region { pair, sheet, polygon, low, high })?;
    }
    let shared = overlaps(&regions, segments, is_twice)?;
    let area = 0.5 * frame.projection.area2;
    let covered_twice: f64 = shared.iter().map(|s| s.area).sum();
    let shared = memory::sorted(&shared, |s, t| (s.sheets, s.pairs).cmp(&(t.sheets, t.pairs)))?;
    let layers = shared.chunk_by(|s, t| s.sheets == t.sheets).find(|both| {
        let [a, b] = both[0].sheets;
        a != b && both.iter().map(|s| s.area).sum::<f64>() > SHARED * areas[a].min(areas[b])
    });
    let most = |shared: &[Shared]| shared.iter().max_by(|s, t| s.area.total_cmp(&t.area)).map(|s| (s.pairs, s.centre));
    let found = match layers {
        Some(layers) => most(layers),
        None if covered_twice > SHARED * area => most(&shared),
        None => None,
    };
    let Some((both, centre)) = found else { return Ok(None) };
    let [a, b] = both.map(|p| height(&segments[p], centre));
    let size = both.map(|p| segments[p].mortar.size).into_iter().fold(frame.projection.size, f64::min);
    let apart = (a - b).abs();
    let apart = if apart > TOGETHER * size { apart } else { 0.0 };
    Ok(Some(Layers { under: pairs[0].one, facets: both.map(|p| pairs[p].two), apart }))
}

/// Overlaps of regions of different sheets, and of the same one where `within`: only of those whose boxes overlap, found
/// by a sweep along the longer axis.
fn overlaps(regions: &[Region], segments: &[Segment], within: bool) -> Result<Vec<Shared>> {
    let extent = |i: usize| {
        let (low, high) =
            regions.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), r| (l.min(r.low[i]), h.max(r.high[i])));
        high - low
    };
    let (along, across) = if extent(0) > extent(1) { (0, 1) } else { (1, 0) };
    let compare = |r: &Region, s: &Region| r.low[along].total_cmp(&s.low[along]).then(r.pair.cmp(&s.pair));
    let order = memory::order(regions.len(), &|i, j| compare(&regions[i], &regions[j]))?;
    let mut shared = Vec::new();
    for (k, &i) in order.iter().enumerate() {
        let r = &regions[i];
        for s in order[k + 1..].iter().map(|&j| &regions[j]).take_while(|s| s.low[along] < r.high[along]) {
            let apart = s.low[across] >= r.high[across] || r.low[across] >= s.high[across];
            if apart || (r.sheet == s.sheet && !within) {
                continue;
            }
            let (one, two) = (&segments[r.pair].mortar, &segments[s.pair].mortar);
            let (area, centre) = r.polygon.part_within(two);
            if area > 0.5 * SLIVER * one.area2.min(two.area2) {
                let sheets = [r.sheet.min(s.sheet), r.sheet.max(s.sheet)];
                shared.store(Shared { sheets, pairs: [r.pair.min(s.pair), r.pair.max(s.pair)], area, centre })?;
            }
        }
    }
    Ok(shared)
}

/// Height of a mortar facet over the plane, at a point that it covers `[L]`.
fn height(segment: &Segment, at: Vec2) -> f64 {
    let p = segment.mortar_map.inverse([at.x, at.y]);
    let n = segment.mortar.shape.values(p.xi, p.eta);
    (0..segment.mortar.shape.n).map(|k| n[k] * segment.mortar.d[k]).sum()
}
