//! What tangents are made with, and how: by functions of an interface's data and what the last evaluation left.

use super::cache::Cache;
use super::data::extent::Extent;
use super::pairing::given::Given;
use super::plan::extras::Extras;
use super::plan::fill::Shown;
use super::plan::numbering::{Nodes, Numbering, Sides};
use super::plan::pattern::System;
use super::plan::table::{Hand, Table, TableRoom};
use super::plan::whole::Plan;
use super::stages::conserving::parts;
use super::stages::node::is_out_of_reach;
use super::tangent::augmented::NodeCouplings;
use super::tangent::augmented::is_coupled;
use super::tangent::blocks::{Room, beyond_facets, node_tangents, of_facets, of_nodes};
use super::tangent::conserving_numbers::{ConservingNumbers, Curvature, WeightSlopes};
use super::tangent::derivatives::PairDerivatives;
use super::tangent::emission::{Emitter, Place};
use super::tangent::task::{Numbers, Task};
use super::tangent::turning::{NodeTurn, Turns};
use super::tangent::union::Pairs;
use super::weights::facet::each_facet;
use crate::element::NodeTangent;
use crate::error::{Error, Kind, Result};
use crate::geometry::Vec3;
use crate::memory::{self, Store};
use crate::threads;
use nalgebra::SVector;
use std::ops::Range;
use std::time::Instant;

/// Which pairs a plan has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlanPairs {
    /// Those active at the positions, and those of t_n: its entries are exactly those of the tangent there, of this extent.
    Active(Extent),
    /// All that there may be while the surfaces slide by less than a quarter of a facet.
    Possible,
}

impl PlanPairs {
    /// What the tangents of such a plan are of.
    pub fn extent(self) -> Extent {
        if let PlanPairs::Active(extent) = self { extent } else { Extent::Part }
    }
}

/// What tangents are made with, kept from one to the next.
#[derive(Debug)]
pub struct Linear<const N: usize> {
    pub numbering: Option<Numbering>,
    /// What the host asked for: the tangent with multipliers; forces and constraints of a condensed system.
    pub plan: Option<Plan>,
    pub condensed: Option<[Plan; 2]>,
    /// The entries of the tangent at the last positions that asked for them, and of which pairs.
    pub own: Option<(u64, Plan)>,
    pub fill: [TableRoom; 2],
    pub rooms: Vec<ThreadRoom<N>>,
    pub normals: Vec<Vec3>,
    pub nodes: Vec<NodeTangent<N>>,
    pub turns: Vec<NodeTurn<N>>,
    pub couplings: Vec<NodeCouplings>,
}

impl<const N: usize> Default for Linear<N> {
    fn default() -> Self {
        Linear {
            numbering: None,
            plan: None,
            condensed: None,
            own: None,
            fill: Default::default(),
            rooms: Vec::new(),
            normals: Vec::new(),
            nodes: Vec::new(),
            turns: Vec::new(),
            couplings: Vec::new(),
        }
    }
}

impl<const N: usize> Linear<N> {
    /// Drops what is of pairs that the last step had.
    pub fn forget(&mut self) {
        self.own = None;
    }

    /// On the heap `[bytes]`.
    pub fn bytes(&self) -> usize {
        let plans = self.plan.iter().chain(self.condensed.iter().flatten()).chain(self.own.iter().map(|own| &own.1));
        let rooms = self.fill.iter().map(TableRoom::bytes).sum::<usize>();
        let nodes = self.normals.capacity() * size_of::<Vec3>()
            + self.nodes.capacity() * size_of::<NodeTangent<N>>()
            + self.turns.capacity() * size_of::<NodeTurn<N>>()
            + self.couplings.iter().map(NodeCouplings::bytes).sum::<usize>();
        plans.map(Plan::bytes).sum::<usize>() + self.numbering.as_ref().map_or(0, Numbering::bytes) + rooms + nodes
    }
}

/// What a tangent is made of: all of an interface but what it is made with.
#[derive(Clone, Copy)]
pub struct Here<'a, const N: usize> {
    /// The interface and its step.
    pub given: Given<'a, N>,
    /// What the last evaluation left.
    pub cache: &'a Cache<N>,
}

impl<'a, const N: usize> Here<'a, N> {
    /// The pairs that a tangent has at the last positions.
    pub fn pairs(self) -> Pairs<'a> {
        if self.cache.is_apart() {
            return Pairs::Union([&[], &[]]);
        }
        let history = self.given.history();
        if self.given.setup.options.conserves() {
            let mean = &self.cache.conserving().mean;
            return match self.given.setup.has_parents() {
                true => Pairs::Parents([self.cache.parents(history), &mean.parents]),
                false => Pairs::Union([self.cache.pairs(history), &mean.pairs]),
            };
        }
        if self.given.setup.has_parents() {
            let previous: &[_] = if self.given.setup.effects.law.slips { &history.parents } else { &[] };
            return Pairs::Parents([self.cache.parents(history), previous]);
        }
        let previous: &[_] = if self.given.setup.effects.law.slips { &history.pairs } else { &[] };
        Pairs::Union([self.cache.pairs(history), previous])
    }

    /// Makes what the blocks of a tangent at the point of the last answers need, and gives it to `make`; tells what that says
    /// and the seconds that it took. `scales`: factors of the nodes' rows, in place of their own.
    pub fn linearise(
        self,
        (x1, x2): Positions,
        lambda: &[SVector<f64, N>],
        (extent, scales): (Extent, Option<&[f64]>),
        work: Work<N>,
        make: &mut dyn FnMut(Task<N>, &mut [ThreadRoom<N>]) -> Result<i64>,
    ) -> Result<(i64, f64)> {
        let start = Instant::now();
        let (given, options) = (self.given, &self.given.setup.options);
        let (mortar, differentiates) = (&given.setup.mortar, options.differentiates_weights());
        given.normals_into(work.normals)?;
        let (normals, answers) = (&work.normals[..], self.cache.answers());
        let responses = &answers.responses;
        let scale = |a: usize| scales.map_or_else(|| given.row_scale(a), |s| s[a]);
        let surface = mortar.analytic.map(|_| mortar.analytic_at(x2)).transpose()?;
        let conserving = match options.conserves() && !self.cache.is_apart() {
            true => Some(self.conserving(normals, lambda)?),
            false => None,
        };
        let motion = PairDerivatives { surface: surface.as_ref(), tangent: options.tangent, rule: options.rule };
        node_tangents(given, lambda, responses, normals, scale, work.nodes)?;
        let pairs = self.cache.weighted(given.setup.surfaces(), given.history());
        let numbers = Numbers {
            x1,
            sums: &answers.sums,
            responses,
            nodes: work.nodes,
            active: self.cache.active().filter(|_| differentiates),
            motion,
            turns: match conserving {
                Some(_) => None,
                None => Turns::at(given, (x1, lambda), (pairs, &answers.sums, responses), normals, &scale, work.turns)?,
            },
            conserving: conserving.as_ref(),
        };
        while work.rooms.len() < options.threads {
            work.rooms.store(ThreadRoom::default())?;
        }
        let moves = given.setup.effects.moves();
        let task = Task { given, normals, pairs: self.pairs(), extent, moves, numbers: Some(&numbers) };
        let made = make(task, work.rooms)?;
        Ok((made, start.elapsed().as_secs_f64()))
    }

    /// What blocks of nodes are made of with conserving weights.
    fn conserving<'b>(self, normals: &[Vec3], lambda: &'b [SVector<f64, N>]) -> Result<ConservingNumbers<'b, N>>
    where
        'a: 'b,
    {
        let (given, known, answers) = (self.given, self.cache.conserving(), self.cache.answers());
        let mut along = memory::filled(0.0, lambda.len())?;
        let mut slopes: Vec<WeightSlopes> = Vec::new();
        if given.setup.options.differentiates_weights() {
            for (a, along) in along.iter_mut().enumerate().filter(|(a, _)| given.setup.nodes.acts(*a)) {
                *along = parts(&lambda[a], known.gaps[1][a].normal).0;
            }
        }
        let curvature = Curvature::of(given, known, &along)?;
        // Without friction multipliers along the surface are 0 in a solution, and act until then.
        let along = |a: usize| parts(&lambda[a], known.gaps[1][a].normal).1 != Vec3::zeros();
        if N > 1 && (given.setup.effects.law.slips || (0..lambda.len()).any(along)) {
            slopes = memory::defaults(lambda.len())?;
            each_facet((given, normals), (&known.mean, &answers.responses), &mut |facet| {
                let n = facet.nodes.len();
                for a in 0..facet.multipliers {
                    for (k, c) in (0..n).flat_map(|k| (0..n).map(move |c| (k, c))) {
                        let slope = facet.slopes[(a * n + k) * n + c];
                        if slope != Vec3::zeros() {
                            slopes[facet.nodes[a]].store((facet.nodes[k], facet.nodes[c], slope))?;
                        }
                    }
                }
                Ok(())
            })?;
        }
        Ok(ConservingNumbers { known, lambda, sums: &answers.sums, curvature, slopes })
    }

    /// The blocks that are not those of facets and pairs: of the tangent, or of forces and of constraints.
    fn extras(self, pairs: Pairs, extent: Extent, is_whole: bool) -> Result<[Vec<(u32, u32)>; 2]> {
        let given = self.given;
        let carries = !given.step.pairing.carriers.is_empty();
        let frame_moves = given.setup.frame_moves();
        let by_nodes = given.setup.has_blocks_of_nodes();
        if !by_nodes && !carries && !is_coupled(given) && !given.setup.options.follows_normals() && !frame_moves {
            return Ok(Default::default());
        }
        let nodes = Nodes::of(Sides::of(given.setup));
        let (mut taker, mut constraints) = (Extras::new(given.setup), Extras::new(given.setup));
        let normals = memory::filled(Vec3::zeros(), given.nodes())?;
        let moves = given.setup.effects.moves();
        let task = Task { given, normals: &normals, pairs, extent, moves, numbers: None };
        beyond_facets(task, &mut Room::default(), (&mut taker, (!is_whole).then_some(&mut constraints as _)))?;
        // A multiplier's block with itself is there anyway, and may be a diagonal.
        let own = |taker: Extras<N>| -> Result<Vec<(u32, u32)>> {
            taker.refused.map_or(Ok(()), Err)?;
            let mut blocks = taker.blocks;
            blocks.retain(|(row, column)| row != column || !nodes.is_multiplier(*row as usize));
            Ok(blocks)
        };
        Ok([own(taker)?, own(constraints)?])
    }

    /// A plan for each of `systems`, of these pairs.
    pub fn plans<const S: usize>(
        self,
        (pairs, extent): (Pairs, Extent),
        systems: [System; S],
        numbering: &mut Option<Numbering>,
    ) -> Result<[Plan; S]> {
        let given = self.given;
        if numbering.is_none() {
            *numbering = Some(Numbering::of(Nodes::of(Sides::of(given.setup)))?);
        }
        let Some(numbering) = numbering else { return Err(no_plan()) };
        let mut extras = self.extras(pairs, extent, systems[0] == System::Whole)?.into_iter();
        // Carried nodes add to rows of other facets' nodes.
        let by_nodes = given.setup.has_blocks_of_nodes();
        let alone = given.step.pairing.carriers.is_empty() && !by_nodes;
        let is_diagonal = |a: usize| !by_nodes && is_out_of_reach(given, a, extent);
        let mut plans = [const { None }; S];
        for (plan, system) in plans.iter_mut().zip(systems) {
            let extras = extras.next().unwrap_or_default();
            *plan = Some(Plan::new((Sides::of(given.setup), numbering), system, pairs, (extras, alone), &is_diagonal)?);
        }
        Ok(plans.map(|plan| plan.expect("each was made")))
    }

    /// Fills a plan, or those of forces and of constraints, with a tangent at the point of the last answers; tells the pairs
    /// whose weights were differentiated and the seconds.
    pub fn fill(
        self,
        (x, lambda, of): AtPoint<N>,
        numbering: &Option<Numbering>,
        [first, second]: &mut [TableRoom; 2],
        (work, kept_couplings): (Work<N>, &mut Vec<NodeCouplings>),
        (plan, values): (&Plan, &mut [f64]),
        constraints: Option<(&Plan, &mut [f64])>,
    ) -> Result<(i64, f64)> {
        let Some(numbering) = numbering else { return Err(no_plan()) };
        let belongs = (Sides::of(self.given.setup), numbering);
        let mut table = plan.table(values, first)?;
        let (other_plan, mut other) = match constraints {
            Some((plan, values)) => (Some(plan), Some(plan.table(values, second)?)),
            None => (None, None),
        };
        let mut make = |task: Task<N>, rooms: &mut [ThreadRoom<N>]| {
            rooms.iter_mut().for_each(ThreadRoom::begin);
            let is_coupled = is_coupled(task.given);
            NodeCouplings::renew(kept_couplings, if is_coupled { task.given.nodes() } else { 0 })?;
            let mut couplings = is_coupled.then_some(&mut kept_couplings[..]);
            let of_chunk = |chunk: Option<&Range<usize>>,
                            (hand, other_hand): (Hand, Option<Hand>),
                            room: &mut ThreadRoom<N>,
                            couplings: Option<&mut [NodeCouplings]>|
             -> Result<()> {
                let mut taker = plan.fill(belongs, hand);
                let mut constraints = other_plan.zip(other_hand).map(|(plan, hand)| plan.fill(belongs, hand));
                let mut emitter = Emitter {
                    given: task.given,
                    normals: task.normals,
                    taker: &mut taker,
                    constraints: constraints.as_mut().map(|taker| taker as _),
                };
                match chunk {
                    Some(chunk) => {
                        room.linearised +=
                            of_facets(task, Range { ..*chunk }, &mut room.room, couplings, &mut emitter)?;
                    }
                    None => of_nodes(task, &mut room.room, couplings, &mut emitter)?,
                }
                room.shown.add(taker.shown());
                constraints.iter().for_each(|taker| room.shown.add(taker.shown()));
                Ok(())
            };
            let one_by_one = rooms.len() == 1 || is_coupled;
            for chunks in plan.phases() {
                if one_by_one || chunks.len() == 1 {
                    for chunk in chunks {
                        let hands = (table.hand(), other.as_mut().map(Table::hand));
                        of_chunk(Some(chunk), hands, &mut rooms[0], couplings.as_deref_mut())?;
                    }
                    continue;
                }
                let parted = plan.parted(belongs, chunks, &mut table)?;
                let other = match (other_plan, &mut other) {
                    (Some(plan), Some(table)) => Some(plan.parted(belongs, chunks, table)?),
                    _ => None,
                };
                threads::share(chunks.len(), rooms, |k, room| {
                    let (mut pieces, mut others) = (parted.pieces(k), other.as_ref().map(|other| other.pieces(k)));
                    let other_hand = other.as_ref().zip(others.as_mut()).map(|(other, pieces)| other.hand(k, pieces));
                    of_chunk(Some(&chunks[k]), (parted.hand(k, &mut pieces), other_hand), room, None)
                })?;
            }
            // What is of no facet.
            let hands = (table.hand(), other.as_mut().map(Table::hand));
            of_chunk(None, hands, &mut rooms[0], couplings)?;
            rooms.iter().try_for_each(|room| check(room.shown, task.given.nodes()))?;
            Ok(rooms.iter().map(|room| room.linearised).sum())
        };
        let made = self.linearise(x, lambda, of, work, &mut make)?;
        table.finish();
        if let Some(table) = other {
            table.finish();
        }
        Ok(made)
    }
}

/// What one thread works with.
#[derive(Debug, Default)]
pub struct ThreadRoom<const N: usize> {
    pub room: Room<N>,
    linearised: i64,
    shown: Shown,
}

impl<const N: usize> ThreadRoom<N> {
    fn begin(&mut self) {
        (self.linearised, self.shown) = (0, Shown::default());
    }
}

/// Non-mortar and mortar positions.
pub type Positions<'a> = (&'a [Vec3], &'a [Vec3]);

/// Where a tangent is: positions, multipliers, what of, and factors of the nodes' rows in place of their own.
pub type AtPoint<'a, const N: usize> = (Positions<'a>, &'a [SVector<f64, N>], (Extent, Option<&'a [f64]>));

/// What a tangent is made with.
pub struct Work<'a, const N: usize> {
    pub rooms: &'a mut Vec<ThreadRoom<N>>,
    pub normals: &'a mut Vec<Vec3>,
    pub nodes: &'a mut Vec<NodeTangent<N>>,
    pub turns: &'a mut Vec<NodeTurn<N>>,
}

/// What plans belong to: the interface, and the order of its nodes.
pub type PlanOf<'a> = (Sides<'a>, &'a Numbering);

pub fn no_plan() -> Error {
    Error::new(
        Kind::InvalidValue,
        "there is no plan of these entries; for the tangent call stickslip_interface_plan first, for FORCES and CONSTRAINTS stickslip_interface_condensed_plan",
    )
}

/// Refuses what came up while a plan was filled, of so many non-mortar nodes.
fn check(shown: Shown, n1: usize) -> Result<()> {
    let name = |place: Place| match place {
        Place::Displacement(node) if node < n1 => text!("non-mortar node {node}"),
        Place::Displacement(node) => text!("mortar node {}", node - n1),
        Place::Multiplier(a) => text!("the multiplier of non-mortar node {a}"),
    };
    if let Some((row, column)) = shown.lacks {
        let text = text!(
            "the plan has no place for the entries of {} in the rows of {}: the pairs have changed; make it again (stickslip_interface_plan, stickslip_interface_condensed_plan)",
            name(column),
            name(row)
        );
        return Err(Error::new(Kind::MissingEntry, text));
    }
    if shown.nothing == 0.0 {
        return Ok(());
    }
    Err(Error::new(Kind::NotFinite, "values overflows: the inputs are out of range"))
}
