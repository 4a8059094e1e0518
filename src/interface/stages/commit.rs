//! What becomes t_n at a commit: the history of a configuration, and the filter of the step that follows.

use super::acting::acting;
use super::apart;
use super::keep::keep;
use super::layers;
use super::sums::assemble;
use crate::error::{Error, Kind, Result};
use crate::geometry::Vec3;
use crate::interface::data::active::Active;
use crate::interface::data::extent::Extent;
use crate::interface::data::history::{History, Keeps};
use crate::interface::data::options::{Options, Scheme, Weights};
use crate::interface::data::parents::Parents;
use crate::interface::data::surface::Surface;
use crate::interface::pairing::candidates::KeptTree;
use crate::interface::pairing::filter::Filter;
use crate::interface::pairing::settle;
use crate::interface::pairing::work::Work;
use crate::memory::{self, Store};
use crate::mortar::{MultiplierSpace, NonmortarFrame};
use crate::normal;

/// What a configuration that becomes t_n has settled; nothing has slipped yet.
pub struct Settled {
    pub history: History,
    /// The filter of the step that follows; `None` where the weights are frozen for good.
    pub filter: Option<Filter>,
    /// Whether the active pairs are those of the step that follows: where the history does not keep them, for the next
    /// evaluation may well be here.
    pub active: bool,
}

/// What is known of the pairs at the positions that become t_n.
pub struct Known<'a> {
    /// The pairs, or memory for them.
    pub active: &'a mut Active,
    /// The filter that has found them; `None`: none has.
    pub filter: Option<&'a Filter>,
}

/// The t_n that (x1, x2) makes, of a commit or at the creation, in the memory of another `history`. Pairs that were known and
/// will be none are left in the room's `dropped`.
pub fn settled_at(
    (nonmortar, mortar): (&Surface, &Surface),
    options: &Options,
    extent: Extent,
    work: &mut Work,
    (x1, x2): (&[Vec3], &[Vec3]),
    Known { active, filter: found_by }: Known,
    mut history: History,
) -> Result<Settled> {
    let (surfaces, keeps) = ((nonmortar, mortar), Keeps::of(options));
    history.begin(keeps, (x1, x2))?;
    if options.effective_weights() == Weights::Reference {
        history.freeze_at(surfaces, (x1, x2))?;
    }
    work.room.dropped.clear();
    // Also where the surfaces are apart: a commit refuses degenerate facets of either side.
    let mut filter = settle::filter(surfaces, options, (x1, x2), &mut work.tree)?;
    let mut is_active = false;
    // Which nodes carry others follows from what is covered: a step must know it from the start.
    let leaves_out = extent == Extent::Whole && options.effective_weak_coverage() == 0.0;
    if leaves_out && apart::are_apart(surfaces, options, &filter, &[(x1, x2)])? {
        work.counters.commits_apart += 1;
        if found_by.is_some() {
            active.find_dropped(&[], &mut work.room.dropped)?;
        }
        active.clear();
    } else {
        match found_by {
            // A facet of a hybrid scheme may be integrated in another way from here on.
            // Nor are shares of parents' weights taken out one by one.
            Some(Filter::Facets(old))
                if active.knows_excluded
                    && !matches!(options.scheme, Scheme::Hybrid(_))
                    && nonmortar.parents.is_none() =>
            {
                keep(surfaces, options, (old, &filter), work, active)?;
            }
            _ => {
                let mut anew = std::mem::take(&mut work.room.anew);
                acting(surfaces, options, &filter, work, (x1, x2), &mut anew)?;
                if found_by.is_some() {
                    active.find_dropped(&anew.pairs, &mut work.room.dropped)?;
                }
                std::mem::swap(active, &mut anew);
                if found_by.is_some() {
                    work.room.anew = anew;
                }
            }
        }
        layers::settle(surfaces, options, &mut filter, work, (x1, x2), active)?;
        let sums = &mut work.room.sums;
        assemble(surfaces, active.weighted(surfaces), (x1, x2), sums)?;
        if keeps.facet_gaps() {
            history.facet_gaps.take(surfaces, active, options.rule, sums)?;
        }
        history.fill(active, nonmortar.parents.is_some(), sums)?;
        is_active = !keeps.pairs();
    }
    if let Some(parents) = &nonmortar.parents {
        check_parents(surfaces, (x1, x2))?;
        if options.friction.law().opens {
            let named = |e: Error| Error::new(e.kind, text!("{} {}", nonmortar.side, e.message));
            parents.check_normals(x1).map_err(named)?;
        }
        nodal_areas(parents, x1, &mut history.areas)?;
    }
    let linear = if nonmortar.parents.is_none() { &nonmortar.facets[..] } else { &[] };
    for (f, facet) in linear.iter().enumerate() {
        let frame = NonmortarFrame::new(&nonmortar.facet(f, x1)).map_err(nonmortar.at(f))?;
        facet.as_slice().iter().zip(frame.nodal_areas()).for_each(|(&node, area)| history.areas[node] += area);
    }
    nonmortar.add_normals(x1, &mut work.room.vectors)?;
    memory::grow(&mut history.normals, nonmortar.len())?;
    for (node, sum) in work.room.vectors.iter().enumerate() {
        history.normals.store(normal::nodal_normal(*sum, node)?)?;
        if !(history.areas[node] > 0.0) {
            let text =
                text!("the area of non-mortar node {node} is not positive: the facets around it are too distorted");
            return Err(Error::new(Kind::DegenerateFacet, text));
        }
    }
    Ok(Settled { history, filter: Some(filter), active: is_active })
}

/// The same with weights that are frozen for good: those of `old`, in the memory of `history`; `sums`: room.
pub fn with_the_same_weights(
    surfaces: (&Surface, &Surface),
    old: &History,
    (x1, x2): (&[Vec3], &[Vec3]),
    sums: &mut Vec<(f64, Vec3)>,
    mut history: History,
) -> Result<Settled> {
    history.move_to(old, x1, x2)?;
    // Also where mu is 0 at every node: it may be set before the next step. Tied nodes keep their first gap.
    if matches!(old.keeps, Keeps::Slip | Keeps::GapAndWeights) {
        assemble(surfaces, old.weighted(surfaces), (x1, x2), sums)?;
        history.gap.iter_mut().zip(sums).for_each(|(to, (_, gap))| *to = *gap);
    }
    Ok(Settled { history, filter: None, active: false })
}

/// The filter of a history that is not of now, whose positions may be refused: with nothing hidden. `None` where the weights are
/// frozen.
#[inline(never)] // it is met several times
pub fn filter_of(surfaces: (&Surface, &Surface), options: &Options, history: &History) -> Result<Option<Filter>> {
    let mut tree = KeptTree::default();
    let at = || settle::filter(surfaces, options, (&history.x1, &history.x2), &mut tree);
    (options.effective_weights() == Weights::Current).then(at).transpose()
}

/// The same with what is hidden.
pub fn filter_again(
    surfaces: (&Surface, &Surface),
    options: &Options,
    history: &History,
    work: &mut Work,
) -> Result<Option<Filter>> {
    let mut filter = filter_of(surfaces, options, history)?;
    if let Some(filter) = filter.as_mut().filter(|_| history.integrated) {
        pairs(surfaces, options, filter, work, (&history.x1, &history.x2))?;
    }
    Ok(filter)
}

/// The active pairs at (x1, x2) with a filter of it that hides nothing yet.
pub fn pairs(
    surfaces: (&Surface, &Surface),
    options: &Options,
    filter: &mut Filter,
    work: &mut Work,
    x: (&[Vec3], &[Vec3]),
) -> Result<Active> {
    let mut active = Active::default();
    acting(surfaces, options, filter, work, x, &mut active)?;
    layers::settle(surfaces, options, filter, work, x, &mut active)?;
    Ok(active)
}

/// Makes up for the weights of t_n, and what is hidden, where they were left out because the surfaces were apart then.
pub fn complete(
    surfaces: (&Surface, &Surface),
    options: &Options,
    (history, filter): (&mut History, &mut Filter),
    work: &mut Work,
) -> Result<()> {
    let (x, mut sums) = ((&history.x1[..], &history.x2[..]), Vec::new());
    let mut new = pairs(surfaces, options, filter, work, x)?;
    assemble(surfaces, new.weighted(surfaces), x, &mut sums)?;
    history.fill(&mut new, surfaces.0.parents.is_some(), &sums)
}

/// Refuses quadratic facets of either side whose mapping has no area somewhere, or turns over.
fn check_parents((one, two): (&Surface, &Surface), (x1, x2): (&[Vec3], &[Vec3])) -> Result<()> {
    for (side, x) in [(one, x1), (two, x2)] {
        let named = |e: Error| Error::new(e.kind, text!("{} {}", side.side, e.message));
        let parents = side.parents.as_ref().filter(|_| side.analytic.is_none());
        parents.map_or(Ok(()), |parents| parents.check(x)).map_err(named)?;
    }
    Ok(())
}

/// Adds the areas of the nodes of parents: int N_A da of the multipliers. Nodes at which no facet has a multiplier are given the area
/// that they would have with multipliers everywhere: nothing depends on it.
fn nodal_areas(parents: &Parents, x1: &[Vec3], areas: &mut [f64]) -> Result<()> {
    for space in [parents.space, MultiplierSpace::Sub] {
        let mut add = memory::filled(0.0, areas.len())?;
        for (f, facet) in parents.facets.iter().enumerate() {
            let own = parents.areas(f, x1, space)?;
            facet.as_slice().iter().zip(own).for_each(|(&node, area)| add[node] += area);
        }
        areas.iter_mut().zip(add).filter(|(area, _)| **area == 0.0).for_each(|(area, add)| *area = add);
    }
    Ok(())
}
