//! What a residual depends on besides the unknowns (docs/formulation.md 18): the positions of t_n, through the weights and the normals
//! that slip is measured with and through who carries whom, and parameters. Beside the stages of forces, whose answers it takes; none of
//! them knows it.

mod carriers;
pub mod layout;
mod normals;
mod parameters;
mod weights;

use parameters::Slipping;

use crate::error::Result;
use crate::geometry::{Mat3, Vec3};
use crate::interface::data::active::Active;
use crate::interface::data::node_data::NodeData;
use crate::interface::data::pairs::Weighted;
use crate::interface::data::surface::Surface;
use crate::interface::pairing::given::{Given, Step};
use crate::interface::pairing::weak::Carrier;
use crate::interface::stages::carried::{carriers_sums, transfer_of};
use crate::interface::stages::respond::Responses;
use crate::interface::stages::sums::{NodeSums, in_previous_gaps};
use crate::interface::tangent::emission::Place;
use crate::interface::tangent::read::square;
use crate::interface::tangent::turning::{Turning, Turns};
use crate::interface::weights::each_weight;
use crate::interface::weights::facet::{FacetWeights, each_facet};
use crate::law::Remembers;
use crate::memory::{self, Store, Stored};
use nalgebra::SVector;

/// What a derivative is by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Column {
    /// The position at t_n of a node over both surfaces: three columns.
    Previous(usize),
    /// mu of a non-mortar node.
    Friction(usize),
    /// The largest shear traction.
    ShearLimit,
    /// The offset of a node over both surfaces.
    Offset(usize),
}

/// What is asked for.
#[derive(Clone, Copy, Debug, Default)]
pub struct Wanted {
    /// Columns of the positions at t_n.
    pub previous: bool,
    /// Those of parameters.
    pub parameters: bool,
}

/// Takes derivatives, column by column: of a node's force three rows, of its multiplier's row as many as it has components. What is given
/// twice adds up.
pub type Take<'a> = dyn FnMut(Place, Column, &[f64]) + 'a;

/// A weight of a node.
#[derive(Clone, Copy, Debug)]
pub struct Weight {
    /// The other node, over both surfaces.
    pub node: usize,
    /// n_AB, or - n_AC [L^2].
    pub now: f64,
    /// The same at t_n.
    pub before: f64,
}

/// Those of every node, by pairs of now and of t_n.
pub fn weights_of((one, two): (&Surface, &Surface), [now, before]: [Weighted; 2]) -> Result<Vec<Vec<Weight>>> {
    let mut all = memory::defaults::<Vec<Weight>>(one.len())?;
    for (pairs, is_now) in [(now, 1.0), (before, 0.0)] {
        each_weight((one, two), pairs, &mut |a, node, n| {
            let (now, before) = (is_now * n, (1.0 - is_now) * n);
            match all[a].iter_mut().find(|weight| weight.node == node) {
                Some(weight) => (weight.now, weight.before) = (weight.now + now, weight.before + before),
                None => all[a].store(Weight { node, now, before })?,
            }
            Ok(())
        })?;
    }
    Ok(all)
}

/// A node's answer at a point, of as many components as its multiplier has.
#[derive(Clone, Copy, Debug)]
pub struct Answer {
    /// d row / d (gap of now, gap that slip is measured from), in the first rows, with the row's scale.
    pub by_gap: [Mat3; 2],
    /// The multiplier.
    pub lambda: Vec3,
    /// The scale of its rows; 0 where another handle has them.
    pub scale: f64,
    /// r_A.
    pub augmentation: f64,
}

/// A point at which a residual was evaluated.
pub struct At<'a> {
    /// Both sides.
    pub surfaces: (&'a Surface, &'a Surface),
    /// The step.
    pub step: &'a Step,
    /// What the host says of the nodes.
    pub nodes: &'a NodeData,
    /// Components of a multiplier.
    pub components: usize,
    /// Whether anything follows slip, and how much of the gap of t_n is taken off it.
    pub slip: Option<f64>,
    /// How much of the first gap is taken off the gap of now: 1 of tied surfaces, else 0.
    pub first_gap: f64,
    /// Positions of both sides.
    pub x: [&'a [Vec3]; 2],
    /// What the nodes assemble.
    pub sums: &'a [NodeSums],
    /// The law's answers.
    pub answers: &'a [Answer],
    /// Whose gaps count in the rows of others; empty: nobody's.
    pub carried: &'a [bool],
    /// nu of every node.
    pub normals: &'a [Vec3],
    /// The weights of now, and those of t_n, of every node.
    pub weights: &'a [Vec<Weight>],
}

impl At<'_> {
    fn is_carried(&self, a: usize) -> bool {
        self.carried.get(a).is_some_and(|is| *is)
    }

    /// Those who carry A.
    fn carriers_of(&self, a: usize) -> &[Carrier] {
        self.step.pairing.carriers.get(a).map_or(&[], |c| c)
    }

    /// T_AB.
    fn transfer(&self, a: usize, b: usize) -> Mat3 {
        transfer_of(self.components, &self.nodes.free[a], self.normals[a], self.normals[b])
    }

    /// d row / d (gap of now, gap that slip is measured from) of A, of the node itself or of each that carries it.
    fn by_gap(&self, a: usize, give: &mut dyn FnMut(usize, [Mat3; 2])) {
        if !self.is_carried(a) {
            return give(a, self.answers[a].by_gap);
        }
        for &(b, w) in self.carriers_of(a) {
            let share = self.transfer(a, b) * w;
            give(b, self.answers[b].by_gap.map(|by| by * share));
        }
    }

    /// Gives three columns of a multiplier's row away.
    fn put(&self, a: usize, column: Column, by: &Mat3, take: &mut Take) {
        put((Place::Multiplier(a), self.components), column, by, take);
    }
}

/// Gives three columns of the first rows of a square away.
fn put((row, rows): (Place, usize), column: Column, by: &Mat3, take: &mut Take) {
    let values: [f64; 9] = std::array::from_fn(|ij| by[(ij % rows, ij / rows % 3)]);
    if values.iter().any(|v| *v != 0.0) {
        take(row, column, &values[..3 * rows]);
    }
}

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
        let through = &mut |facet: &FacetWeights| weights::through_weights(at, (active, facet), take);
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
