//! What becomes t_n at a commit: the history of a configuration, and the filter of the step that follows.

use super::acting::acting;
use super::apart;
use super::layers;
use super::sums::assemble;
use crate::error::{Error, Kind, Result};
use crate::geometry::Vec3;
use crate::interface::data::active::Active;
use crate::interface::data::counters::Counters;
use crate::interface::data::extent::Extent;
use crate::interface::data::facet_gaps::FacetGaps;
use crate::interface::data::history::{History, Keeps};
use crate::interface::data::options::Options;
use crate::interface::data::surface::{Surface, frames};
use crate::interface::pairing::candidates::KeptTree;
use crate::interface::pairing::filter::Filter;
use crate::interface::pairing::settle;
use crate::memory::{self, Store};
use crate::normal;

/// What a configuration that becomes t_n has settled; nothing has slipped yet.
pub struct Settled {
    pub history: History,
    /// The filter of the step that follows; `None` where the weights are frozen for good.
    pub filter: Option<Filter>,
    /// The weights, where the history does not keep them: the next evaluation may well be here.
    pub active: Option<Active>,
}

/// The t_n that (x1, x2) makes, of a commit or at the creation.
pub fn settled_at(
    (nonmortar, mortar): (&Surface, &Surface),
    options: &Options,
    extent: Extent,
    (counters, tree): (&mut Counters, &mut KeptTree),
    (x1, x2): (&[Vec3], &[Vec3]),
) -> Result<Settled> {
    let n1 = nonmortar.len();
    let keeps = Keeps::of(options);
    let zeros = |kept: usize| memory::filled(Vec3::zeros(), kept * n1);
    let [gap, slip] = keeps.gaps_and_slips();
    let mut history = History {
        keeps,
        commits: 0,
        x1: memory::copied(x1)?,
        x2: memory::copied(x2)?,
        normals: memory::with_room(n1)?,
        areas: memory::filled(0.0, n1)?,
        coverage: memory::filled(0.0, n1)?,
        gap: zeros(gap)?,
        facet_gaps: FacetGaps::default(),
        slip: zeros(slip)?,
        pairs: Vec::new(),
        integrated: false,
    };
    // Also where the surfaces are apart: a commit refuses degenerate facets of either side.
    let filter = settle::filter((nonmortar, mortar), options, (x1, x2))?;
    let mut active = None;
    // Which nodes carry others follows from what is covered: a step must know it from the start.
    let leaves_out = extent == Extent::Whole && options.effective_weak_coverage() == 0.0;
    let frames = if leaves_out && apart::are_apart((nonmortar, mortar), options, &filter, &[(x1, x2)])? {
        counters.commits_apart += 1;
        &frames(nonmortar, x1)?
    } else {
        let mut new = acting((nonmortar, mortar), options, &filter, (counters, tree), (x1, x2))?;
        layers::refuse(mortar, &new)?;
        let mut sums = assemble((nonmortar, mortar), &new.pairs, x1, x2)?;
        if keeps.facet_gaps() {
            history.facet_gaps = FacetGaps::of((nonmortar, mortar), &new, &mut sums)?;
        }
        history.fill(&mut new.pairs, &sums)?;
        &active.insert(new).frames
    };
    for (facet, frame) in nonmortar.facets.iter().zip(frames) {
        facet.as_slice().iter().zip(frame.nodal_areas()).for_each(|(&node, area)| history.areas[node] += area);
    }
    for (node, sum) in nonmortar.sums_of_normals(x1)?.into_iter().enumerate() {
        history.normals.store(normal::nodal_normal(sum, node)?)?;
        if !(history.areas[node] > 0.0) {
            let text =
                text!("the area of non-mortar node {node} is not positive: the facets around it are too distorted");
            return Err(Error::new(Kind::DegenerateFacet, text));
        }
    }
    // The weights alone: many interfaces never ask for a tangent where a step ends.
    let active = active.filter(|_| keeps == Keeps::Nothing);
    let active = active.map(|k| Active { segments: Vec::new(), ..k });
    Ok(Settled { history, filter: Some(filter), active })
}

/// Makes up for the weights of t_n where they were left out because the surfaces were apart then.
pub fn complete(
    surfaces: (&Surface, &Surface),
    options: &Options,
    (history, filter): (&mut History, &Filter),
    kept: (&mut Counters, &mut KeptTree),
) -> Result<()> {
    let mut new = acting(surfaces, options, filter, kept, (&history.x1, &history.x2))?;
    let sums = assemble(surfaces, &new.pairs, &history.x1, &history.x2)?;
    layers::refuse(surfaces.1, &new)?;
    history.fill(&mut new.pairs, &sums)
}
