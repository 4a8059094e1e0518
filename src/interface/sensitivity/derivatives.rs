//! All derivatives of a residual by what is no unknown, from what an evaluation has left: as data of plain nodes, of which the parts make
//! their shares (docs/formulation 18).

use super::parameters::Slipping;
use super::{Answer, At, Take, Wanted, carriers, normals, parameters, weights, weights_of};
use crate::error::Result;
use crate::geometry::Vec3;
use crate::interface::data::active::Active;
use crate::interface::data::pairs::Weighted;
use crate::interface::pairing::given::Given;
use crate::interface::stages::carried::carriers_sums;
use crate::interface::stages::respond::Responses;
use crate::interface::stages::sums::{NodeSums, in_previous_gaps};
use crate::interface::tangent::read::square;
use crate::interface::tangent::turning::{Turning, Turns};
use crate::interface::weights::facet::{FacetWeights, each_facet};
use crate::law::Remembers;
use crate::memory::Stored;
use nalgebra::SVector;

/// What is known where a residual was evaluated.
#[derive(Clone, Copy)]
pub struct Known<'a, const N: usize> {
    /// The interface and its step.
    pub given: Given<'a, N>,
    /// Positions of both sides.
    pub x: [&'a [Vec3]; 2],
    /// Multipliers.
    pub lambda: &'a [SVector<f64, N>],
    /// The pairs whose weights act there.
    pub pairs: Weighted<'a>,
    /// What the nodes assemble.
    pub sums: &'a [NodeSums],
    /// The law's answers.
    pub responses: &'a Responses<N>,
}

impl<const N: usize> Known<'_, N> {
    /// As answers of plain nodes.
    fn answers(&self) -> Result<Vec<Answer>> {
        let (given, nodes) = (self.given, &self.given.setup.nodes);
        let answer = |a: usize| {
            let (of, scale) = (&self.responses.nodes[a], if nodes.is_own(a) { given.row_scale(a) } else { 0.0 });
            let by_gap = [of.drow_dnow, of.drow_dprevious].map(|by| square(&by) * scale);
            let lambda = Vec3::from_fn(|i, _| self.lambda[a].get(i).copied().unwrap_or(0.0));
            Answer { by_gap, lambda, scale, augmentation: given.augmentation(a) }
        };
        (0..given.nodes()).map(answer).stored()
    }
}

/// All that is asked for. `active`: the pairs at t_n whose weights move with its positions; `None`: weights are frozen.
pub fn derivatives<const N: usize>(
    known: Known<N>,
    wanted: Wanted,
    active: Option<&Active>,
    take: &mut Take,
) -> Result<()> {
    let Known { given, x, pairs, sums, responses, .. } = known;
    let (setup, surfaces) = (given.setup, given.setup.surfaces());
    let weights = weights_of(surfaces, [pairs, given.history().weighted(surfaces)])?;
    let (normals, answers) = (given.normals()?, known.answers()?);
    let at = At {
        surfaces,
        step: given.step,
        nodes: &setup.nodes,
        components: N,
        slip: setup.effects.law.slips.then(|| setup.options.effective_slip().coefficients().1),
        first_gap: f64::from(setup.options.friction.law().remembers == Remembers::FirstGap),
        x,
        sums,
        answers: &answers,
        carried: &responses.carried,
        normals: &normals,
        weights: &weights,
    };
    if wanted.previous {
        by_previous((&at, known), active, take)?;
    }
    if wanted.parameters {
        by_parameters((&at, known), take)?;
    }
    Ok(())
}

fn by_previous<const N: usize>((at, known): (&At, Known<N>), active: Option<&Active>, take: &mut Take) -> Result<()> {
    let (given, step) = (known.given, known.given.step);
    weights::through_gaps(at, take);
    carriers::through_shares(at, take)?;
    let Some(active) = active else { return Ok(()) };
    if at.slip.is_some() {
        let through = &mut |facet: &FacetWeights| {
            weights::through_weights(at, (active, facet), take);
            Ok(())
        };
        each_facet((given, at.normals), (active, known.responses), through)?;
    }
    let keeps = |a: usize| step.now.is_none() || step.pairing.keeps_normal[a];
    if given.setup.nodes.normals.is_none() && (0..given.nodes()).any(keeps) {
        let (x1, mut corner_sums, mut room) = (&given.history().x1, Vec::new(), Vec::new());
        at.surfaces.0.add_normals(x1, &mut corner_sums)?;
        let turning = Turning { x1, corner_sums: &corner_sums, turns: &keeps };
        let of = (known.pairs, known.sums, known.responses);
        let turns = Turns::of(given, turning, known.lambda, of, at.normals, &|a| given.row_scale(a), &mut room)?;
        normals::through_normals(at, given, &turns, take);
    }
    Ok(())
}

fn by_parameters<const N: usize>((at, known): (&At, Known<N>), take: &mut Take) -> Result<()> {
    let Known { given, lambda, sums, responses, .. } = known;
    let shared = carriers_sums(given, sums, &responses.carried, at.normals)?;
    for (a, response) in responses.nodes.iter().enumerate().filter(|(a, _)| N == 3 && !at.is_carried(*a)) {
        let sums = shared.binary_search_by_key(&a, |(b, _)| *b).map_or(&sums[a], |k| &shared[k].1);
        let slipping = Slipping { lambda: &lambda[a], sums, response };
        if let Some(by) = parameters::by_threshold(given, a, slipping)? {
            parameters::through_threshold(at, a, by, take);
        }
    }
    // The offsets of now are in both gaps where slip is a difference of the two, and where weights are frozen.
    let both = at.slip.is_some() && (in_previous_gaps(given) || !given.setup.options.differentiates_weights());
    parameters::through_offsets(at, both, take);
    Ok(())
}
