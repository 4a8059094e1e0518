//! What a host should know of how its surfaces lie: which nodes are covered, in part, not at all, by how many facets
//! and layers; and, where nothing overlaps, what mistake that looks like.

use super::mistakes;
use super::why::{Finding, why_nothing_overlaps};
use crate::error::{Result, Text};
use crate::geometry::Vec3;
use crate::interface::data::active::Active;
use crate::interface::data::options::Weights;
use crate::interface::data::pairs::Weighted;
use crate::interface::data::surface::Surface;
use crate::interface::pairing::given::Given;
use crate::interface::pairing::work::Work;
use crate::interface::stages::conserving::gap_before;
use crate::interface::stages::integrate::integrate;
use crate::interface::stages::layers;
use crate::interface::stages::over::SHARED;
use crate::interface::stages::sums::{add_offsets, assemble};
use crate::memory::{self, Store, Stored};
use crate::mortar::NonmortarFrame;

/// Coverage over area above this is full: facets that meet under an angle lack a part of second order, distorted quads
/// have an error of the quadrature.
const LEAST: f64 = 0.99;
/// A facet that is covered more than this over its area lies under several layers. The shape functions add up to 1 at
/// every point of the rule, so that a facet's coverage, unlike a node's, has no error of the quadrature.
const MOST: f64 = 1.0 + SHARED;
/// An overlap that counts as closed is told where it is more than this over the size of the facets: coordinates of single precision are
/// off by as much on a mesh of a hundred facets.
const KEPT: f64 = 1e-5;

/// How much of a node's area is covered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(i32)]
pub enum Cover {
    /// At and below the option `coverage_min`: the node is open.
    None = 0,
    /// In part: at an edge of the mortar surface.
    Part = 1,
    /// In full.
    Full = 2,
    /// By several layers of the mortar surface.
    Several = 3,
}

/// A non-mortar node's cover.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NodeCover {
    /// Which of the four.
    pub cover: Cover,
    /// Covered over full area [-].
    pub fraction: f64,
    /// Layers of the mortar surface over the facets around the node, where they cover more than one of these in all.
    pub layers: i32,
    /// Mortar facets that overlap with the facets around it.
    pub facets: i64,
}

/// The report at one configuration.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// Per non-mortar node; one at which no facet has a multiplier, as mid nodes, is covered by nothing.
    pub nodes: Vec<NodeCover>,
    /// How many of these there are.
    pub without_multiplier: usize,
    /// The deepest penetration of a covered node, -g_N over its covered area `[L]`; 0 where there is none.
    pub penetration: f64,
    /// With weights that keep overlaps: the covered node that overlaps most at the last commit over the size of its facets, by how much
    /// `[L]`, and what that is over this size; where it is worth telling.
    pub kept: Option<(usize, f64, f64)>,
    /// With covered nodes `Swapped` or `InsideOut` alone.
    pub finding: Option<Finding>,
}

impl Report {
    /// How many nodes at which facets have multipliers have this cover.
    pub fn count(&self, cover: Cover) -> usize {
        let without = if cover == Cover::None { self.without_multiplier } else { 0 };
        self.nodes.iter().filter(|n| n.cover == cover).count() - without
    }

    /// The report in sentences.
    ///
    /// # Errors
    /// [`crate::error::Kind::OutOfMemory`].
    pub fn text(&self) -> Result<Text> {
        let [none, part, full, several] =
            [Cover::None, Cover::Part, Cover::Full, Cover::Several].map(|c| self.count(c));
        let mut text = Text::EMPTY;
        text.append(format_args!(
            "Of {} non-mortar nodes {full} are covered in full, {part} in part, {none} not at all, {several} by several \
             layers.",
            self.nodes.len() - self.without_multiplier
        ))?;
        let least = self.nodes.iter().enumerate().filter(|(_, n)| n.cover == Cover::Part);
        if let Some((a, n)) = least.min_by(|(_, m), (_, n)| m.fraction.total_cmp(&n.fraction)) {
            text.append(format_args!(" Least covered is node {a}, to {:.2e}.", n.fraction))?;
        }
        let finding = match self.finding {
            None => "",
            Some(Finding::NoOverlap) => {
                " No facets lie over each other, or only in front of each other, beyond search_distance."
            }
            Some(Finding::SameWay) => {
                " Facets lie over each other, but all of them look the same way: the node order of one side is reversed, \
                 or it is the wrong face of its body."
            }
            Some(Finding::Behind) => {
                " Facets lie over each other, but behind each other by more than a facet: the node orders of both sides \
                 are reversed, or the bodies have passed through each other, or start so deep that search_distance is \
                 needed."
            }
            Some(Finding::Swapped) => {
                " The positions given for each side are those of the other side's first configuration: x1 and x2 are \
                 swapped."
            }
            Some(Finding::InsideOut) => {
                " Every covered node penetrates by a tenth of a facet or more, or a closed surface is seen from inside and \
                 the other side is not in it: the node orders of both sides are reversed, or this is a deep interference \
                 fit."
            }
        };
        text.append(format_args!("{finding}"))?;
        if let Some((a, depth, of_size)) = self.kept {
            text.append(format_args!(
                " Node {a} overlaps by {depth:.2e} at the last commit, {of_size:.1e} of the size of its facets: with \
                 STICKSLIP_WEIGHTS_CONSERVING that counts as closed, presses nothing and stays."
            ))?;
        }
        Ok(text)
    }
}

/// Which nodes are covered, and how, at (x1, x2), however far apart the surfaces are there.
pub fn report<const N: usize>(given: Given<N>, work: &mut Work, (x1, x2): (&[Vec3], &[Vec3])) -> Result<Report> {
    let (surfaces, options, h) = (given.setup.surfaces(), &given.setup.options, given.history());
    let mut now = Active::default();
    let mut several = memory::filled(false, given.nodes())?;
    let (pairs, at) = match (options.effective_weights(), &given.step.pairing.filter) {
        (Weights::Current, Some(filter)) => {
            integrate(surfaces, options, filter, work, (x1, x2), &mut now, None)?;
            for found in layers::find(surfaces, (options, filter), &mut work.room, &now)? {
                surfaces.0.rows(found?.under).as_slice().iter().for_each(|&a| several[a] = true);
            }
            (now.weighted(surfaces), x1)
        }
        (Weights::Committed, _) => (h.weighted(surfaces), &h.x1[..]),
        (_, _) => (h.weighted(surfaces), &surfaces.0.reference[..]),
    };
    let mut sums = Vec::new();
    assemble(surfaces, pairs, (x1, x2), &mut sums)?;
    add_offsets(given, pairs, &mut sums)?;
    let layers = covered_times(surfaces.0, pairs, at)?;
    let claims = claims(surfaces.0, pairs)?;
    let node = |a: usize| {
        let fraction = sums[a].0 / h.areas[a];
        let cover = match fraction {
            f if f <= options.coverage_min => Cover::None,
            _ if several[a] || layers[a] > MOST => Cover::Several,
            f if f < LEAST => Cover::Part,
            _ => Cover::Full,
        };
        let least = match cover {
            Cover::None => 0.0,
            Cover::Several => 2.0,
            _ => 1.0,
        };
        let layers = (layers[a] - (MOST - 1.0)).ceil().max(least) as i32;
        NodeCover { cover, fraction, layers, facets: claims[a] }
    };
    let nodes: Vec<_> = (0..given.nodes()).map(node).stored()?;
    let mut depths = Vec::new();
    for a in (0..nodes.len()).filter(|&a| nodes[a].cover != Cover::None) {
        let (coverage, gap) = sums[a];
        depths.store(-given.normal(a)?.dot(&gap) / coverage)?;
    }
    let penetration = depths.iter().fold(0.0_f64, |most, d| most.max(*d));
    let inside_out = mistakes::are_inside_out(surfaces, (x1, x2), &depths);
    let finding = if mistakes::are_swapped(surfaces, (x1, x2)) {
        Some(Finding::Swapped)
    } else if depths.is_empty() {
        let why = why_nothing_overlaps(surfaces, options, (x1, x2))?;
        Some(if why == Finding::NoOverlap && inside_out { Finding::InsideOut } else { why })
    } else {
        inside_out.then_some(Finding::InsideOut)
    };
    let without_multiplier = surfaces.0.nodes_without_row();
    let kept = if options.conserves() { kept(given)? } else { None };
    Ok(Report { nodes, without_multiplier, penetration, kept, finding })
}

/// The worst of the overlaps e_A of the step (docs/formulation 21), as a length.
fn kept<const N: usize>(given: Given<N>) -> Result<Option<(usize, f64, f64)>> {
    let mut worst = None;
    for a in 0..given.nodes() {
        let depth = -gap_before(given, a)?.unwrap_or(0.0);
        let of_size = depth / given.facet_size(a);
        if of_size > worst.map_or(KEPT, |(_, _, most)| most) {
            worst = Some((a, depth, of_size));
        }
    }
    Ok(worst)
}

/// Per non-mortar node the most that a facet around it is covered, over the facet's area at `x`.
fn covered_times(one: &Surface, pairs: Weighted, x: &[Vec3]) -> Result<Vec<f64>> {
    let mut covered = memory::filled(0.0, one.host_facets())?;
    each_coverage(one, pairs, |[f, _], _, area| {
        covered[f] += area;
        Ok(())
    })?;
    let mut most = memory::filled(0.0_f64, one.len())?;
    for f in (0..covered.len()).filter(|&f| covered[f] > 0.0) {
        let area: f64 = match &one.parents {
            None => NonmortarFrame::new(&one.facet(f, x))?.nodal_areas().iter().sum(),
            Some(parents) => parents.areas(f, x, parents.space)?.iter().sum(),
        };
        one.host_nodes(f).iter().for_each(|&a| most[a] = most[a].max(covered[f] / area));
    }
    Ok(most)
}

/// Gives the facets of the host of each pair with each of its multipliers' nodes and what it covers of it [L^2].
fn each_coverage(
    one: &Surface,
    pairs: Weighted,
    mut give: impl FnMut([usize; 2], usize, f64) -> Result<()>,
) -> Result<()> {
    let nodes = |f: usize| one.host_nodes(f).iter().take(one.multipliers(f)).enumerate();
    match pairs {
        Weighted::Facets(pairs) => pairs.iter().try_for_each(|pair| {
            nodes(pair.one).try_for_each(|(k, &a)| give([pair.one, pair.two], a, pair.weights.coverage(k)))
        }),
        Weighted::Parents(pairs) => pairs.iter().try_for_each(|pair| {
            nodes(pair.one).try_for_each(|(k, &a)| give([pair.one, pair.two], a, pair.weights.coverage(k)))
        }),
    }
}

/// Per non-mortar node the mortar facets that overlap with the facets around it.
fn claims(one: &Surface, pairs: Weighted) -> Result<Vec<i64>> {
    let mut claims = Vec::new();
    // A pair's share of dual weights may be negative; it is 0 only where nothing overlaps.
    each_coverage(one, pairs, |[_, g], a, area| if area != 0.0 { claims.store((a, g)) } else { Ok(()) })?;
    memory::sort(&mut claims)?;
    claims.dedup();
    let mut counts = memory::filled(0, one.len())?;
    claims.iter().for_each(|&(a, _)| counts[a] += 1);
    Ok(counts)
}
