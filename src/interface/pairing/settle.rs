//! What a commit settles about the step that follows: which facets may meet, which nodes can be covered, and which nodes
//! carry others.

use super::analytic;
use super::boxes::Aabb;
use super::candidates::KeptTree;
use super::corners::{Copies, Corners};
use super::depth;
use super::filter::{FacetFilter, Filter, Side};
use super::hidden::Hidden;
use super::hybrid;
use super::reach;
use super::search::Tree;
use super::weak::{self, Carrier};
use crate::error::Result;
use crate::geometry::Vec3;
use crate::interface::data::history::History;
use crate::interface::data::offsets;
use crate::interface::data::options::{Options, Weights};
use crate::interface::data::setup::Setup;
use crate::interface::data::surface::Surface;
use crate::memory::{self, Stored};

/// What t_n settles.
#[derive(Debug)]
pub struct Pairing {
    /// Which facets may meet; `None` where the weights are frozen for good.
    pub filter: Option<Filter>,
    /// Per non-mortar node, whether anything can cover it.
    pub coverable: Vec<bool>,
    /// Per non-mortar node those that carry it; empty where no node is carried.
    pub carriers: Vec<Vec<Carrier>>,
    /// Per non-mortar node, whether it keeps nu(t_n) although the others follow the motion; empty where none does.
    pub keeps_normal: Vec<bool>,
    /// What copies of nodes on creases do.
    pub corners: Corners,
}

/// Near a knife's edge the sum s of the corner normals has next to no length, and Dnu grows like 1 / |s|. A node where |s|
/// at t_n is below this times the number of corners keeps its nu(t_n) for the step.
const KNIFE_EDGE: f64 = 0.1;

impl Pairing {
    /// That of a history and the filter of its configuration.
    pub fn new<const N: usize>(setup: &Setup<N>, filter: Option<Filter>, history: &History) -> Result<Pairing> {
        let frozen = setup.options.effective_weights() != Weights::Current;
        let pairs = frozen.then(|| history.weighted(setup.surfaces()));
        // Where the normals follow the motion, so does which facets look at each other (`candidates.rs`).
        let follows = setup.options.follows_normals();
        let coverable = reach::coverable(&setup.nonmortar, filter.as_ref().filter(|_| !follows), pairs)?;
        let mut carriers = carriers(setup, history, &coverable)?;
        let copies = Copies {
            pairs: &setup.copies,
            surface: &setup.nonmortar,
            options: &setup.options,
            slips: setup.effects.law.slips,
            has_multiplier: &|a| setup.has_multiplier(a),
        };
        let corners = Corners::settle(&copies, history, &coverable, &mut carriers)?;
        let mut keeps_normal = if follows { on_knife_edges(&setup.nonmortar, &history.x1)? } else { Vec::new() };
        if follows {
            corners.edges.iter().flat_map(|edge| &edge.sides).for_each(|&a| keeps_normal[a] = true);
        }
        Ok(Pairing { filter, coverable, carriers, keeps_normal, corners })
    }

    /// Takes what layers of the mortar surface hide away.
    pub fn take_hidden(&mut self) -> Hidden {
        match &mut self.filter {
            Some(Filter::Facets(filter)) => std::mem::take(&mut filter.hidden),
            _ => Hidden::default(),
        }
    }

    /// Puts it back.
    pub fn put_hidden(&mut self, hidden: Hidden) {
        if let Some(Filter::Facets(filter)) = &mut self.filter {
            filter.hidden = hidden;
        }
    }
}

/// The filter of the configuration (x1, x2).
#[inline(never)] // it is met several times
pub fn filter(
    (one, two): (&Surface, &Surface),
    options: &Options,
    (x1, x2): (&[Vec3], &[Vec3]),
    tree: &mut KeptTree,
) -> Result<Filter> {
    if two.analytic.is_some() {
        return analytic::facing(one, &two.analytic_at(x2)?, options, x1, 0.0).map(Filter::Analytic);
    }
    let mut sides = [Side::new(one, x1)?, Side::new(two, x2)?];
    let (closing, opening) = offsets::reach((one, two));
    sides[0].raise(opening);
    let mut filter = FacetFilter {
        sides,
        distance: options.search_distance.map(|distance| distance + closing.max(opening)),
        depths: Vec::new(),
        reached: Vec::new(),
        by_overlaps: Vec::new(),
        hidden: Hidden::default(),
    };
    let tree = tree.at(two, x2)?;
    let normals: Vec<_> = filter.sides[1].facets.iter().map(|(_, plane)| plane.e).stored()?;
    // The answers of a search that counts boxes depend on its axes; those of space are wanted.
    let parted = if !tree.is_along_space() || Tree::parts(&normals) {
        let points = filter.sides[1].facets.iter().map(|(facet, _)| Aabb::around(facet.points().iter().copied()));
        Some(Tree::parted(points.stored()?, &normals)?)
    } else {
        None
    };
    let over = parted.as_ref().unwrap_or(tree);
    filter.reached = reach::reached(&filter, over)?;
    if filter.distance.is_none() {
        filter.depths = depth::followed((one, two), &filter, over, x2)?;
        if !filter.depths.is_empty() {
            filter.reached = reach::reached(&filter, over)?;
        }
    }
    filter.by_overlaps = hybrid::partly_covered((one, two), options, &filter, (x1, x2), tree)?;
    Ok(Filter::Facets(filter))
}

/// Per node, whether it is near a knife's edge.
fn on_knife_edges(nonmortar: &Surface, x1: &[Vec3]) -> Result<Vec<bool>> {
    let mut corners = memory::filled(0.0, nonmortar.len())?;
    for facet in &nonmortar.facets {
        facet.as_slice().iter().for_each(|&a| corners[a] += 1.0);
    }
    let sums = nonmortar.sums_of_normals(x1)?;
    sums.iter().zip(corners).map(|(sum, corners)| sum.norm() < KNIFE_EDGE * corners).stored()
}

/// The carriers of every node, by the history.
fn carriers<const N: usize>(setup: &Setup<N>, h: &History, coverable: &[bool]) -> Result<Vec<Vec<Carrier>>> {
    let part = setup.options.effective_weak_coverage();
    if part == 0.0 || !h.integrated {
        return Ok(Vec::new());
    }
    let fraction = |a: usize| {
        let f = h.coverage[a] / h.areas[a];
        if f > setup.options.coverage_min { f } else { 0.0 }
    };
    let nodes = weak::Nodes {
        fraction: &(0..setup.nonmortar.len()).map(fraction).stored()?,
        coverable,
        has_multiplier: &|a| setup.has_multiplier(a),
    };
    weak::carriers(&nodes, &weak::links(&setup.nonmortar, h)?, part)
}
