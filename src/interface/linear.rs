//! What tangents are made with, and how: by functions of an interface's data and what the last evaluation left.

use super::cache::Cache;
use super::data::extent::Extent;
use super::data::setup::Setup;
use super::pairing::given::Given;
use super::plan::extras::Extras;
use super::plan::fill::FillRoom;
use super::plan::numbering::{Nodes, Numbering};
use super::plan::pattern::System;
use super::plan::whole::Plan;
use super::stages::node::is_out_of_reach;
use super::tangent::blocks::{Numbers, Room, Task, blocks, is_coupled, node_tangents};
use super::tangent::derivatives::PairDerivatives;
use super::tangent::emission::{Place, Takers};
use super::tangent::turning::Turns;
use super::tangent::union::Pairs;
use crate::element::NodeTangent;
use crate::error::{Error, Kind, Result};
use crate::geometry::Vec3;
use crate::memory;
use nalgebra::SVector;
use std::time::Instant;

/// Which pairs a plan has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlanPairs {
    /// Those active at the positions, and those of t_n: its entries are exactly those of the tangent there, of this extent.
    Active(Extent),
    /// All that there may be while the surfaces slide by less than a quarter of a facet.
    Possible,
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
    pub fill: [FillRoom; 2],
    pub room: Room<N>,
    pub normals: Vec<Vec3>,
    pub nodes: Vec<NodeTangent<N>>,
}

impl<const N: usize> Default for Linear<N> {
    fn default() -> Self {
        Linear {
            numbering: None,
            plan: None,
            condensed: None,
            own: None,
            fill: Default::default(),
            room: Room::default(),
            normals: Vec::new(),
            nodes: Vec::new(),
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
        let rooms = self.fill.iter().map(FillRoom::bytes).sum::<usize>();
        let nodes = self.normals.capacity() * size_of::<Vec3>() + self.nodes.capacity() * size_of::<NodeTangent<N>>();
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
        let previous: &[_] = if self.given.setup.effects.law.slips { &history.pairs } else { &[] };
        Pairs::Union([self.cache.pairs(history), previous])
    }

    /// The blocks of a tangent at the point of the last answers, and what they cost: pairs and seconds. `scales`: factors of
    /// the nodes' rows, in place of their own.
    pub fn linearise(
        self,
        (x1, x2): (&[Vec3], &[Vec3]),
        lambda: &[SVector<f64, N>],
        (extent, scales): (Extent, Option<&[f64]>),
        work: Work<N>,
        takers: Takers<N>,
    ) -> Result<(i64, f64)> {
        let start = Instant::now();
        let (given, options) = (self.given, &self.given.setup.options);
        let (mortar, differentiates) = (&given.setup.mortar, options.differentiates_weights());
        given.normals_into(work.normals)?;
        let (normals, answers) = (&work.normals[..], self.cache.answers());
        let responses = &answers.responses;
        let scale = |a: usize| scales.map_or_else(|| given.row_scale(a), |s| s[a]);
        let surface = mortar.analytic.map(|_| mortar.analytic_at(x2)).transpose()?;
        let motion = PairDerivatives {
            opposite: given.setup.effects.opposite,
            surface: surface.as_ref(),
            tangent: options.tangent,
            rule: options.rule,
        };
        node_tangents(given, lambda, responses, normals, scale, work.nodes)?;
        let numbers = Numbers {
            x1,
            responses,
            nodes: work.nodes,
            active: self.cache.active().filter(|_| differentiates),
            motion,
            turns: Turns::at(given, (x1, lambda), (&answers.sums, responses), normals, scale)?,
        };
        let task = Task { given, normals, pairs: self.pairs(), extent, numbers: Some(&numbers) };
        let linearised = blocks(task, work.room, takers)?;
        Ok((linearised, start.elapsed().as_secs_f64()))
    }

    /// The blocks that are not those of facets and pairs: of the tangent, or of forces and of constraints.
    fn extras(self, pairs: Pairs, extent: Extent, is_whole: bool) -> Result<[Vec<(u32, u32)>; 2]> {
        let given = self.given;
        let carries = !given.step.pairing.carriers.is_empty();
        if !carries && !is_coupled(given) && !given.setup.options.follows_normals() {
            return Ok(Default::default());
        }
        let nodes = Nodes::of(given.setup);
        let (mut taker, mut constraints) = (Extras::new(given.setup), Extras::new(given.setup));
        let normals = memory::filled(Vec3::zeros(), given.nodes())?;
        let task = Task { given, normals: &normals, pairs, extent, numbers: None };
        blocks(task, &mut Room::default(), (&mut taker, (!is_whole).then_some(&mut constraints as _)))?;
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
            *numbering = Some(Numbering::of(Nodes::of(given.setup))?);
        }
        let Some(numbering) = numbering else { return Err(no_plan()) };
        let mut extras = self.extras(pairs, extent, systems[0] == System::Whole)?.into_iter();
        let is_diagonal = |a: usize| is_out_of_reach(given, a, extent);
        let mut plans = [const { None }; S];
        for (plan, system) in plans.iter_mut().zip(systems) {
            let extras = extras.next().unwrap_or_default();
            *plan = Some(Plan::new((given.setup, numbering), system, pairs, extras, is_diagonal)?);
        }
        Ok(plans.map(|plan| plan.expect("each was made")))
    }

    /// Fills plans with a tangent at the point of the last answers.
    pub fn fill(
        self,
        (x, lambda, of): AtPoint<N>,
        numbering: &Option<Numbering>,
        rooms: &mut [FillRoom; 2],
        work: Work<N>,
        plans: [Option<(&Plan, &mut [f64])>; 2],
    ) -> Result<(i64, f64)> {
        let Some(numbering) = numbering else { return Err(no_plan()) };
        let mut fills = [None, None];
        for ((fill, room), plan) in fills.iter_mut().zip(rooms).zip(plans) {
            if let Some((plan, values)) = plan {
                if values.len() != plan.len() {
                    let text = text!("values has {} entries; the plan has {}", values.len(), plan.len());
                    return Err(Error::new(Kind::InvalidSize, text));
                }
                *fill = Some(plan.fill((self.given.setup, numbering), values, room)?);
            }
        }
        let [Some(taker), constraints] = &mut fills else { return Err(no_plan()) };
        let linearised = self.linearise(x, lambda, of, work, (taker, constraints.as_mut().map(|taker| taker as _)))?;
        fills.into_iter().flatten().try_for_each(|fill| check(fill.end()))?;
        Ok(linearised)
    }
}

/// Non-mortar and mortar positions.
pub type Positions<'a> = (&'a [Vec3], &'a [Vec3]);

/// Where a tangent is: positions, multipliers, what of, and factors of the nodes' rows in place of their own.
pub type AtPoint<'a, const N: usize> = (Positions<'a>, &'a [SVector<f64, N>], (Extent, Option<&'a [f64]>));

/// What a tangent is made with.
pub struct Work<'a, const N: usize> {
    pub room: &'a mut Room<N>,
    pub normals: &'a mut Vec<Vec3>,
    pub nodes: &'a mut Vec<NodeTangent<N>>,
}

/// What plans belong to: the interface, and the order of its nodes.
pub type PlanOf<'a, const N: usize> = (&'a Setup<N>, &'a Numbering);

pub fn no_plan() -> Error {
    Error::new(
        Kind::InvalidValue,
        "there is no plan; call stickslip_interface_plan or stickslip_interface_condensed_plan first",
    )
}

/// What came up while a plan was filled.
fn check(end: std::result::Result<bool, (Place, Place)>) -> Result<()> {
    let name = |place: Place| match place {
        Place::Displacement(node) => text!("node {node} (mortar nodes after non-mortar ones)"),
        Place::Multiplier(a) => text!("the multiplier of non-mortar node {a}"),
    };
    match end {
        Ok(true) => Ok(()),
        Ok(false) => Err(Error::new(Kind::NotFinite, "values overflows: the inputs are out of range")),
        Err((row, column)) => {
            let text = text!(
                "the plan lacks the entries of {} in the rows of {}: the pairs have changed; make it again (stickslip_interface_plan, stickslip_interface_condensed_plan)",
                name(column),
                name(row)
            );
            Err(Error::new(Kind::MissingEntry, text))
        }
    }
}
