//! Which facets of a skin may touch: a search over all of it, and what rules out far sides of walls (docs/formulation 19.2).

use super::table::Table;
use super::whole::Whole;
use crate::adjacency::Lists;
use crate::error::Result;
use crate::geometry::{Facet, Vec3};
use crate::interface::{Aabb, NO_FACET, Tree};
use crate::memory::{self, Store, Stored};
use std::cell::RefCell;

/// Facets whose normals have a scalar product above this do not touch: side faces near corners look past each other.
const OPPOSITION: f64 = -0.5;
/// Facets are no deeper in each other than this part of the thinner of the walls behind them.
const PART_OF_WALL: f64 = 0.45;
/// Nor than this times the sum of their longest edges, where nothing is behind them.
const DEEPEST: f64 = 1.0;
/// How far a skin looks, over a facet's longest edge, at least.
const LEAST_REACH: f64 = 0.5;
/// And how far beyond that, over the largest motion of the last step: a step may be as large again.
pub const MOTIONS: f64 = 2.0;

/// Facets lie along each other if their normals oppose at least so much: planes behind each other beside a corner do not.
pub const PARALLEL: f64 = -0.8;
/// Faces over each other whose heights differ by less than this, over a facet's longest edge, are one to a facet over both of them.
const STEP: f64 = 0.05;

/// Two facets that may touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Near {
    /// Facets of the host, the smaller number first.
    pub facets: [usize; 2],
    /// How far apart their centres are along the normals, the larger as seen from both; negative: they are in each other `[L]`.
    pub distance: f64,
    /// Scalar product of their normals.
    pub opposition: f64,
    /// How far their centres lie beside each other, over how far both reach that way.
    pub beside: f64,
    /// One of them lies under a face that is nearer to the other: it cannot be touched yet.
    pub under: bool,
}

impl Near {
    /// The other one of its facets.
    pub fn other(&self, f: usize) -> usize {
        self.facets[usize::from(self.facets[0] == f)]
    }
}

/// How far a skin looks for partners.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reach {
    /// As far as the host says `[L]`; `None`: by the facets' sizes, too.
    pub given: Option<f64>,
    /// The largest motion of a step `[L]`.
    pub motion: f64,
}

/// The facets of a skin where they are.
struct Seen {
    facets: Vec<Facet>,
    centres: Vec<Vec3>,
    normals: Vec<Vec3>,
    sizes: Vec<f64>,
    /// How thick the wall behind each is `[L]`.
    walls: Vec<f64>,
}

impl Seen {
    fn new(whole: &Whole, x: &[Vec3]) -> Result<Seen> {
        let n = whole.surface.facets.len();
        let facets: Vec<_> = (0..n).map(|f| whole.surface.facet(f, x)).stored()?;
        let centre = |facet: &Facet| facet.points().iter().sum::<Vec3>() / facet.points().len() as f64;
        let centres: Vec<_> = facets.iter().map(centre).stored()?;
        // A facet without an area looks nowhere, and meets none.
        let normals: Vec<_> = facets.iter().map(|f| f.area_vector().try_normalize(0.0).unwrap_or_default()).stored()?;
        let sizes = facets.iter().map(Facet::longest_edge).stored()?;
        let wall = |f: usize| match whole.surface.backs.get(f) {
            Some(&back) if back != NO_FACET => normals[f].dot(&(centres[f] - centres[back as usize])).max(0.0),
            _ => f64::INFINITY,
        };
        let walls = (0..n).map(wall).stored()?;
        Ok(Seen { facets, centres, normals, sizes, walls })
    }

    /// How deep a facet may be in another one.
    fn depth(&self, f: usize) -> f64 {
        (PART_OF_WALL * self.walls[f]).min(DEEPEST * self.sizes[f])
    }

    /// The least way of a facet's points along a vector, from the centre of another one.
    #[inline(never)]
    fn least(&self, f: usize, from: usize, along: &Vec3) -> f64 {
        let way = |p: &Vec3| along.dot(&(p - self.centres[from]));
        self.facets[f].points().iter().map(way).fold(f64::INFINITY, f64::min)
    }

    /// The least height of a facet over the plane of another one.
    fn lowest(&self, f: usize, over: usize) -> f64 {
        self.least(f, over, &self.normals[over])
    }

    /// Two facets, as parts, if they may touch.
    fn pair(&self, [f, g]: [usize; 2], reach: f64) -> Option<Near> {
        let opposition = self.normals[f].dot(&self.normals[g]);
        if opposition >= OPPOSITION || self.lowest(f, g) > reach || self.lowest(g, f) > reach {
            return None;
        }
        let between = self.centres[g] - self.centres[f];
        let distance = self.normals[f].dot(&between).max(-self.normals[g].dot(&between));
        let deepest = (PART_OF_WALL * self.walls[f].min(self.walls[g])).min(DEEPEST * (self.sizes[f] + self.sizes[g]));
        if -distance > deepest {
            return None;
        }
        let along = (self.normals[f] - self.normals[g]).normalize();
        let across = between - along * along.dot(&between);
        // How far both reach towards each other: long facets far along themselves, and not across.
        let (aside, half) = (across.norm(), -self.least(f, f, &-across) - self.least(g, g, &across));
        let beside = if aside > 0.0 { aside * aside / half } else { 0.0 };
        (aside * aside <= half + 0.5 * reach * aside).then_some(Near {
            facets: [f, g],
            distance,
            opposition,
            beside,
            under: false,
        })
    }
}

/// The pairs of facets that may touch where the copies are at `x`, sorted by the facets of the host. O(n log n).
pub fn near(whole: &Whole, x: &[Vec3], reach: Reach, table: &Table) -> Result<Vec<Near>> {
    let seen = Seen::new(whole, x)?;
    let Reach { given, motion } = reach;
    let reach = |f: usize| given.unwrap_or(LEAST_REACH * seen.sizes[f] + MOTIONS * motion);
    let boxes = seen.facets.iter().map(|facet| Aabb::around(facet.points().iter().copied())).stored()?;
    let tree = Tree::parted(boxes, &seen.normals)?;
    let normals: Vec<_> = seen.normals.iter().map(|n| Aabb::around([*n])).stored()?;
    let normals = tree.gather(&normals)?;
    let found = RefCell::new(Vec::new());
    let (host, original) = (|f: usize| whole.surface.host_facet(f), |a: usize| whole.originals[a]);
    for f in 0..seen.facets.len() {
        let around = reach(f).max(seen.depth(f)) + 0.5 * reach(f);
        let own = Aabb::around(seen.facets[f].points().iter().copied());
        let may = |node: usize, bounds: &Aabb| {
            bounds.distance(&own) <= around && normals[node].along(seen.normals[f], Vec3::zeros()).0 < OPPOSITION
        };
        let refused = RefCell::new(Ok(()));
        let is = |g: usize| {
            let reach = reach(f).max(reach(g));
            // Of two facets that both find each other the first one tells.
            let Some(pair) = (f != g).then(|| seen.pair([f.min(g), f.max(g)], reach)).flatten() else { return false };
            let nodes = |f: usize| whole.surface.facets[f].as_slice().iter().map(|&a| original(a));
            let touches = nodes(f).any(|a| nodes(g).any(|b| a == b));
            let bodies = [f, g].map(|f| whole.bodies[host(f)]);
            if !touches && host(f) != host(g) && !table.excludes(bodies) {
                let stored = found.borrow_mut().store(pair);
                *refused.borrow_mut() = stored.is_err().then_some(()).map_or(Ok(()), |()| stored);
            }
            refused.borrow().is_err()
        };
        tree.any(&may, &is);
        refused.into_inner()?;
    }
    let mut parts = found.into_inner();
    let by_facets = |p: &Near, q: &Near| p.facets.cmp(&q.facets);
    parts = memory::sorted(&parts, by_facets)?;
    parts.dedup_by(|p, q| p.facets == q.facets);
    let mut seen_by_all = visible(&seen, &parts)?;
    find_under(whole, &seen, motion, &mut seen_by_all)?;
    let of_host = |p: &Near| {
        let [f, g] = p.facets.map(host);
        Near { facets: [f.min(g), f.max(g)], ..*p }
    };
    let hosts: Vec<_> = seen_by_all.iter().map(of_host).stored()?;
    // Of the parts of two facets the nearest ones stand for them.
    let nearest = |p: &Near, q: &Near| by_facets(p, q).then(p.distance.total_cmp(&q.distance));
    let mut hosts = memory::sorted(&hosts, nearest)?;
    hosts.dedup_by(|p, q| p.facets == q.facets);
    Ok(hosts)
}

/// Those pairs that no other body is between: one would have to pass through a wall that is nearer.
fn visible(seen: &Seen, pairs: &[Near]) -> Result<Vec<Near>> {
    let others = Lists::around(seen.facets.len(), pairs.len(), |p| &pairs[p].facets)?;
    let is_hidden = |[f, g]: [usize; 2], distance: f64| {
        let mut over = others.of(f).iter().map(|&p| &pairs[p]).filter(|p| p.beside <= 1.0);
        over.any(|p| {
            let between = if p.facets[0] == f { p.facets[1] } else { p.facets[0] };
            between != g && distance > p.distance.max(0.0) + PART_OF_WALL * seen.walls[between]
        })
    };
    let is_visible = |p: &&Near| {
        let [f, g] = p.facets;
        !is_hidden([f, g], p.distance) && !is_hidden([g, f], p.distance)
    };
    pairs.iter().filter(is_visible).copied().stored()
}

/// Marks those pairs in which a face lies under another one: that of a table under a sheet that lies on it, seen from what comes down on
/// both. A weighted gap is a mean over the facets around a node, and at the sheet's border it would be one over both heights. Once the step
/// that follows may come as near the pair counts.
fn find_under(whole: &Whole, seen: &Seen, motion: f64, pairs: &mut [Near]) -> Result<()> {
    // Of each copy how far its nearest partner is, and which.
    let mut least = memory::filled(f64::INFINITY, whole.copies())?;
    let mut over = memory::filled(0, whole.copies())?;
    let face = |f: usize| whole.faces[whole.surface.host_facet(f)];
    for marks in [false, true] {
        for pair in &mut *pairs {
            if pair.opposition >= PARALLEL {
                continue;
            }
            for [f, g] in [pair.facets, [pair.facets[1], pair.facets[0]]] {
                let step = STEP * seen.sizes[f].min(seen.sizes[g]);
                for &a in whole.surface.facets[f].as_slice() {
                    let p = over[a];
                    if !marks && pair.distance < least[a] {
                        (least[a], over[a]) = (pair.distance, g);
                    }
                    // Lower than the plane of the nearest one, and out of reach.
                    pair.under |= marks
                        && pair.distance > least[a].max(0.0) + motion + step
                        && seen.normals[p].dot(&(seen.centres[p] - seen.centres[g])) > step
                        && face(p) != face(g);
                }
            }
        }
    }
    Ok(())
}
