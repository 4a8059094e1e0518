//! Of mortar facets that lie over each other under one non-mortar facet, which are the nearest ones (docs/formulation 6.6).

use crate::adjacency::root;
use crate::error::Result;
use crate::geometry::bilinear_map::BilinearMap;
use crate::geometry::clip::{self, Polygon};
use crate::geometry::{Projection, Vec2};
use crate::interface::data::pairs::PairRecord;
use crate::interface::data::surface::Surface;
use crate::interface::pairing::stacked::TOGETHER;
use crate::memory::{self, Store};
use crate::mortar::{NonmortarFrame, Segment};
use crate::simd::Plain;

/// There are layers where two sheets share more than this of the smaller one, or all that is covered twice is more than
/// this of the facet. Parts side by side whose meshes do not match along a curve share less: a polygon of 12 edges lacks
/// 4.5 % of its circle.
pub const SHARED: f64 = 0.05;
/// A facet is hidden where nearer ones lie over more than this of it: then less is lost than would be covered twice.
const MOST: f64 = 0.5;
/// What is hidden hides nothing, so that one layer after the other is settled, from the nearest on: at most so many.
const LAYERS: usize = 16;
/// Overlaps below this, over the smaller facet's area, are rounding of facets that touch: of positions a million facets
/// from the origin, with four digits to spare.
pub const SLIVER: f64 = 1e-6;

/// Mortar facets that lie over each other under one non-mortar facet.
#[derive(Debug)]
pub struct Layers {
    /// The non-mortar facet.
    pub under: usize,
    /// Those that nearer ones hide.
    pub hidden: Vec<usize>,
    /// Two of which none is nearer.
    pub together: Option<[usize; 2]>,
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

/// One of two lies nearer where both cover the plane.
struct Order {
    nearer: usize,
    farther: usize,
    area: f64,
    /// None of them does.
    is_together: bool,
}

/// The mortar facets over one non-mortar facet.
pub struct Over<'a> {
    pub surfaces: (&'a Surface, &'a Surface),
    pub frame: &'a NonmortarFrame,
    pub pairs: &'a [PairRecord],
    pub segments: &'a [Segment],
}

impl Over<'_> {
    /// Layers among them, whose sheets are `of`; those of one sheet are compared where `is_twice`.
    pub fn layers(&self, of: &mut [usize], is_twice: bool) -> Result<Option<Layers>> {
        let Over { frame, pairs, segments, .. } = *self;
        let (mut own, mut areas) = (memory::filled(0.0, pairs.len())?, memory::filled(0.0, pairs.len())?);
        let mut regions = memory::with_room(pairs.len())?;
        for (pair, segment) in segments.iter().enumerate().filter(|(_, s)| s.area > 0.0) {
            // Points in place of an overlap have no polygon.
            let polygon = match segment.points {
                None => segment.polygon.clone(),
                Some(_) => clip::overlap::<Plain>(&frame.projection, &segment.mortar),
            };
            let sheet = root(of, pair);
            own[pair] = polygon.area();
            areas[sheet] += own[pair];
            let bound = |pick: fn(f64, f64) -> f64, from: f64| {
                polygon.vertices().iter().fold(Vec2::repeat(from), |b, v| b.zip_map(v, pick))
            };
            let (low, high) = (bound(f64::min, f64::INFINITY), bound(f64::max, f64::NEG_INFINITY));
            regions.store(Region { pair, sheet, polygon, low, high })?;
        }
        let shared = overlaps(&regions, segments, is_twice)?;
        let least = SHARED * (0.5 * frame.projection.area2);
        let all = shared.iter().map(|s| s.area).sum::<f64>() > least;
        let shared = memory::sorted(&shared, |s, t| (s.sheets, s.pairs).cmp(&(t.sheets, t.pairs)))?;
        let sheets = || shared.chunk_by(|s, t| s.sheets == t.sheets);
        let at_most = |[a, b]: [usize; 2]| if a == b { least } else { SHARED * areas[a].min(areas[b]) };
        let are_layers = |both: &&[Shared]| {
            let [a, b] = both[0].sheets;
            all || a != b && both.iter().map(|s| s.area).sum::<f64>() > at_most([a, b])
        };
        let mut orders = Vec::new();
        for s in sheets().filter(are_layers).flatten() {
            orders.store(self.order(s))?;
        }
        if orders.is_empty() {
            return Ok(None);
        }
        let (mut is_hidden, mut lost) = (memory::filled(false, pairs.len())?, Vec::new());
        for _ in 0..LAYERS {
            memory::refill(&mut lost, 0.0, pairs.len())?;
            for o in orders.iter().filter(|o| !o.is_together && !is_hidden[o.nearer]) {
                lost[o.farther] += o.area;
            }
            let hides = |p: usize| lost[p] > MOST * own[p];
            if (0..pairs.len()).all(|p| is_hidden[p] == hides(p)) {
                break;
            }
            (0..pairs.len()).for_each(|p| is_hidden[p] = hides(p));
        }
        let mut hidden = Vec::new();
        hidden.store_all((0..pairs.len()).filter(|&p| is_hidden[p]).map(|p| pairs[p].two))?;
        let mut together = None;
        let mut orders = orders.iter();
        for both in sheets().filter(are_layers) {
            let on_each_other = |o: &&Order| o.is_together && !is_hidden[o.nearer] && !is_hidden[o.farther];
            let these = orders.by_ref().take(both.len()).filter(on_each_other);
            let (mut area, mut largest) = (0.0, None::<&Order>);
            for o in these {
                area += o.area;
                largest = largest.filter(|l| l.area >= o.area).or(Some(o));
            }
            if let Some(o) = largest.filter(|_| area > at_most(both[0].sheets)) {
                together = together.or(Some([o.nearer, o.farther].map(|p| pairs[p].two)));
            }
        }
        Ok(Some(Layers { under: pairs[0].one, hidden, together }))
    }

    /// Which of the two that share a part of the plane is the nearer one, by their gaps in the middle of this part: the
    /// smaller one without its sign. Of a gap and an overlap that are as large the overlap.
    fn order(&self, s: &Shared) -> Order {
        let [(p, a), (q, b)] = s.pairs.map(|p| (p, self.gap(p, s.centre)));
        let size = s.pairs.iter().fold(self.frame.projection.size, |size, &p| size.min(self.segments[p].mortar.size));
        let is_first = (a.abs(), a) <= (b.abs(), b);
        let (nearer, farther) = if is_first { (p, q) } else { (q, p) };
        Order { nearer, farther, area: s.area, is_together: (a - b).abs() <= TOGETHER * size }
    }

    /// The gap to the mortar facet of a pair, along the normal, at a point of the plane that it covers `[L]`.
    fn gap(&self, pair: usize, at: Vec2) -> f64 {
        let ((one, two), PairRecord { one: i, two: j, .. }) = (self.surfaces, &self.pairs[pair]);
        let (frame, segment) = (self.frame, &self.segments[pair]);
        let own = |k: usize, d: f64| one.offset(one.facets[*i].of_corner(k)) - d;
        let other = |k: usize, d: f64| two.offset(two.facets[*j].of_corner(k)) + d;
        value(&frame.projection, &frame.map, at, &own) + value(&segment.mortar, &segment.mortar_map, at, &other)
    }
}

/// What a field is at a point of a projected facet, of its corners' values, which follow from their place and their height.
fn value(facet: &Projection, map: &BilinearMap, at: Vec2, of: &dyn Fn(usize, f64) -> f64) -> f64 {
    let p = map.inverse([at.x, at.y]);
    let n = facet.shape.values(p.xi, p.eta);
    (0..facet.shape.n).map(|k| n[k] * of(facet.node[k], facet.d[k])).sum()
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
