//! The tangent of an interface through its handle: entry by entry, or by a plan, which is made once and filled in every
//! evaluation.

use super::cache::Cache;
use super::contact::Contact;
use super::data::extent::Extent;
use super::data::options::Form;
use super::data::setup::Setup;
use super::pairing::given::Given;
use super::plan::extras::Extras;
use super::plan::fill::FillRoom;
use super::plan::numbering::{Nodes, Numbering};
use super::plan::pattern::System;
use super::plan::whole::Plan;
use super::stages::node::is_out_of_reach;
use super::stages::sums::NodeSums;
use super::tangent::blocks::{Numbers, Room, Task, blocks, is_coupled, node_tangents};
use super::tangent::by_equations::{ByEquations, Sink};
use super::tangent::derivatives::PairDerivatives;
use super::tangent::emission::{Place, Takers};
use super::tangent::turning::Turns;
use super::tangent::union::{Pairs, possible_pairs};
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
    numbering: Option<Numbering>,
    /// What the host asked for: the tangent with multipliers; forces and constraints of a condensed system.
    pub(super) plan: Option<Plan>,
    pub(super) condensed: Option<[Plan; 2]>,
    /// The entries of the tangent at the last positions that asked for them, and of which pairs.
    own: Option<(u64, Plan)>,
    fill: [FillRoom; 2],
    room: Room<N>,
    normals: Vec<Vec3>,
    nodes: Vec<NodeTangent<N>>,
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
pub(super) struct Here<'a, const N: usize> {
    given: Given<'a, N>,
    cache: &'a Cache<N>,
}

impl<'a, const N: usize> Here<'a, N> {
    /// The pairs that a tangent has at the last positions.
    fn pairs(self) -> Pairs<'a> {
        if self.cache.is_apart() {
            return Pairs::Union([&[], &[]]);
        }
        let history = self.given.history();
        let previous: &[_] = if self.given.setup.effects.law.slips { &history.pairs } else { &[] };
        Pairs::Union([self.cache.pairs(history), previous])
    }

    /// The blocks of a tangent at the point of the last answers, and what they cost: pairs and seconds. `scales`: factors of
    /// the nodes' rows, in place of their own.
    fn linearise(
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
    fn plans<const S: usize>(
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
    fn fill(
        self,
        (x, lambda, of): (Positions, &[SVector<f64, N>], (Extent, Option<&[f64]>)),
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

type Positions<'a> = (&'a [Vec3], &'a [Vec3]);

/// What a tangent is made with.
struct Work<'a, const N: usize> {
    room: &'a mut Room<N>,
    normals: &'a mut Vec<Vec3>,
    nodes: &'a mut Vec<NodeTangent<N>>,
}

/// Entry by entry.
impl<const N: usize> Contact<N> {
    /// The exact tangent d residual / d (x1, x2, lambda) at (x, lambda).
    pub fn tangent(
        &mut self,
        x1: &[Vec3],
        x2: &[Vec3],
        lambda: &[SVector<f64, N>],
        sums: Option<&[NodeSums]>,
        sink: &mut impl Sink,
    ) -> Result<()> {
        self.refuse_sums(sums)?;
        self.cache.respond(&self.setup, &mut self.step, (x1, x2), lambda, sums)?;
        self.linearise_by_equations((x1, x2), lambda, Extent::of(sums), None, (sink, None))
    }

    /// The blocks of a tangent at the point of the last answers. `scales`: factors of the nodes' rows, in place of their own.
    pub(super) fn linearise_by_equations(
        &mut self,
        x: Positions,
        lambda: &[SVector<f64, N>],
        extent: Extent,
        scales: Option<&[f64]>,
        (sink, constraints): (&mut dyn Sink, Option<&mut dyn Sink>),
    ) -> Result<()> {
        self.cache.find_segments(&self.setup, &self.step)?;
        let here = Here { given: Given { setup: &self.setup, step: &self.step }, cache: &self.cache };
        let Linear { room, normals, nodes, .. } = &mut self.linear;
        let mut taker = ByEquations::new(&self.setup, sink);
        let mut constraints = constraints.map(|sink| ByEquations::new(&self.setup, sink));
        let takers: Takers<N> = (&mut taker, constraints.as_mut().map(|taker| taker as _));
        let cost = here.linearise(x, lambda, (extent, scales), Work { room, normals, nodes }, takers)?;
        self.count(cost);
        Ok(())
    }

    /// The entries of the tangent at (x1, x2), in its order: as many as [`Contact::tangent`] gives there, without sums
    /// (`Whole`) or with those of all handles. Their values mean nothing.
    pub fn pattern(&mut self, x1: &[Vec3], x2: &[Vec3], extent: Extent, sink: &mut impl Sink) -> Result<()> {
        self.given().check_positions(x1, x2)?;
        self.cache.integrate(&self.setup, &mut self.step, (x1, x2), extent)?;
        self.blocks_without_numbers(self.here().pairs(), extent, (sink, None))
    }

    /// The entries of any tangent, with sums or without, while the surfaces slide by less than a quarter of a facet. A
    /// larger motion may need entries beyond these.
    pub fn superset_pattern(&mut self, x1: &[Vec3], x2: &[Vec3], sink: &mut impl Sink) -> Result<()> {
        self.given().check_positions(x1, x2)?;
        self.superset((x1, x2), (sink, None))
    }

    pub(super) fn superset(&mut self, x: Positions, sinks: (&mut dyn Sink, Option<&mut dyn Sink>)) -> Result<()> {
        let pairs = self.possible_pairs(x)?;
        self.blocks_without_numbers(Pairs::Possible(&pairs), Extent::Part, sinks)
    }

    fn blocks_without_numbers(
        &self,
        pairs: Pairs,
        extent: Extent,
        (sink, constraints): (&mut dyn Sink, Option<&mut dyn Sink>),
    ) -> Result<()> {
        let mut taker = ByEquations::new(&self.setup, sink);
        let mut constraints = constraints.map(|sink| ByEquations::new(&self.setup, sink));
        let takers: Takers<N> = (&mut taker, constraints.as_mut().map(|taker| taker as _));
        let normals = memory::filled(Vec3::zeros(), self.setup.nonmortar.len())?;
        let task = Task { given: self.given(), normals: &normals, pairs, extent, numbers: None };
        blocks(task, &mut Room::default(), takers).map(|_| ())
    }
}

/// By a plan.
impl<const N: usize> Contact<N> {
    /// Makes the plan of these pairs at (x1, x2); gives the number of its entries.
    pub fn make_plan(&mut self, x: Positions, of: PlanPairs) -> Result<usize> {
        let [plan] = self.plans(x, of, [System::Whole])?;
        let entries = plan.len();
        self.linear.plan = Some(plan);
        Ok(entries)
    }

    /// Plans of these pairs at (x1, x2).
    pub(super) fn plans<const S: usize>(
        &mut self,
        x: Positions,
        of: PlanPairs,
        systems: [System; S],
    ) -> Result<[Plan; S]> {
        self.given().check_positions(x.0, x.1)?;
        let mut numbering = self.linear.numbering.take();
        let plans = match of {
            PlanPairs::Active(extent) => {
                self.cache.integrate(&self.setup, &mut self.step, x, extent)?;
                self.here().plans((self.here().pairs(), extent), systems, &mut numbering)
            }
            PlanPairs::Possible => {
                let pairs = self.possible_pairs(x)?;
                self.here().plans((Pairs::Possible(&pairs), Extent::Part), systems, &mut numbering)
            }
        };
        self.linear.numbering = numbering;
        plans
    }

    /// The plan of this that was made last.
    ///
    /// # Errors
    /// [`Kind::InvalidValue`]: there is none.
    pub fn plan(&self, system: System) -> Result<(&Plan, PlanOf<'_, N>)> {
        let condensed = self.linear.condensed.as_ref();
        self.with_numbering(match system {
            System::Whole => self.linear.plan.as_ref(),
            System::Forces => condensed.map(|plans| &plans[0]),
            System::Constraints => condensed.map(|plans| &plans[1]),
        })
    }

    fn with_numbering<'a>(&'a self, plan: Option<&'a Plan>) -> Result<(&'a Plan, PlanOf<'a, N>)> {
        match (plan, &self.linear.numbering) {
            (Some(plan), Some(numbering)) => Ok((plan, (&self.setup, numbering))),
            _ => Err(no_plan()),
        }
    }

    /// The tangent at (x, lambda) in the order of the plan's entries. After an error the values mean nothing.
    ///
    /// # Errors
    /// [`Kind::MissingEntry`]: the plan does not suffice here.
    pub fn plan_values(
        &mut self,
        x: Positions,
        lambda: &[SVector<f64, N>],
        sums: Option<&[NodeSums]>,
        values: &mut [f64],
    ) -> Result<()> {
        self.refuse_sums(sums)?;
        self.plan(System::Whole)?;
        self.cache.respond(&self.setup, &mut self.step, x, lambda, sums)?;
        self.fill_plan(false, (x, lambda, (Extent::of(sums), None)), values)
    }

    /// The plan of all pairs that there may be near x, for those who ask for its entries alone.
    pub fn possible_plan(&mut self, x: Positions) -> Result<(&Plan, PlanOf<'_, N>)> {
        self.given().check_positions(x.0, x.1)?;
        let pairs = self.possible_pairs(x)?;
        let pairs = Pairs::Possible(&pairs);
        let key = pairs.checksum(true);
        if self.linear.own.as_ref().is_none_or(|own| own.0 != key) {
            let mut numbering = self.linear.numbering.take();
            let plans = self.here().plans((pairs, Extent::Part), [System::Whole], &mut numbering);
            self.linear.numbering = numbering;
            let [plan] = plans?;
            self.linear.own = Some((key, plan));
        }
        self.with_numbering(self.linear.own.as_ref().map(|own| &own.1))
    }

    /// The plan of the tangent at these positions alone, for those who ask for its entries in each evaluation.
    pub fn plan_here(&mut self, x: Positions, extent: Extent) -> Result<(&Plan, PlanOf<'_, N>)> {
        self.given().check_positions(x.0, x.1)?;
        self.cache.integrate(&self.setup, &mut self.step, x, extent)?;
        let key = self.here().pairs().checksum(extent == Extent::Whole);
        if self.linear.own.as_ref().is_none_or(|own| own.0 != key) {
            let [plan] = self.plans(x, PlanPairs::Active(extent), [System::Whole])?;
            self.linear.own = Some((key, plan));
        }
        self.with_numbering(self.linear.own.as_ref().map(|own| &own.1))
    }

    /// The values of [`Contact::plan_here`].
    pub fn values_here(
        &mut self,
        x: Positions,
        lambda: &[SVector<f64, N>],
        sums: Option<&[NodeSums]>,
        values: &mut [f64],
    ) -> Result<()> {
        self.refuse_sums(sums)?;
        self.cache.respond(&self.setup, &mut self.step, x, lambda, sums)?;
        self.plan_here(x, Extent::of(sums))?;
        self.fill_plan(true, (x, lambda, (Extent::of(sums), None)), values)
    }

    fn fill_plan(
        &mut self,
        is_own: bool,
        of: (Positions, &[SVector<f64, N>], (Extent, Option<&[f64]>)),
        values: &mut [f64],
    ) -> Result<()> {
        self.cache.find_segments(&self.setup, &self.step)?;
        let here = Here { given: Given { setup: &self.setup, step: &self.step }, cache: &self.cache };
        let Linear { numbering, plan, own, fill, room, normals, nodes, .. } = &mut self.linear;
        let plan = if is_own { own.as_ref().map(|own| &own.1) } else { plan.as_ref() };
        let plans = [plan.map(|plan| (plan, values)), None];
        let cost = here.fill(of, numbering, fill, Work { room, normals, nodes }, plans)?;
        self.count(cost);
        Ok(())
    }

    /// Fills the plans of a condensed system: what the forces depend on the displacements by, and the constraints.
    pub(super) fn fill_condensed(
        &mut self,
        of: (Positions, &[SVector<f64, N>], (Extent, Option<&[f64]>)),
        [forces, constraints]: [&mut [f64]; 2],
    ) -> Result<()> {
        self.cache.find_segments(&self.setup, &self.step)?;
        let here = Here { given: Given { setup: &self.setup, step: &self.step }, cache: &self.cache };
        let Linear { numbering, condensed, fill, room, normals, nodes, .. } = &mut self.linear;
        let Some([first, second]) = condensed else { return Err(no_plan()) };
        let plans = [Some((&*first, forces)), Some((&*second, constraints))];
        let cost = here.fill(of, numbering, fill, Work { room, normals, nodes }, plans)?;
        self.count(cost);
        Ok(())
    }

    fn here(&self) -> Here<'_, N> {
        Here { given: self.given(), cache: &self.cache }
    }

    fn refuse_sums(&self, sums: Option<&[NodeSums]>) -> Result<()> {
        if sums.is_some() && self.setup.options.form == Form::Augmented {
            let text =
                "sums with the augmented form: its tangent couples pairs of different handles; use the multiplier form";
            return Err(Error::new(Kind::Unsupported, text));
        }
        Ok(())
    }

    /// The pairs that there may be near x.
    fn possible_pairs(&mut self, x: Positions) -> Result<Vec<(usize, usize)>> {
        // Refuses what an evaluation here does, and serves the next one.
        self.cache.integrate(&self.setup, &mut self.step, x, Extent::Whole)?;
        let given = Given { setup: &self.setup, step: &self.step };
        possible_pairs(given, self.cache.work().1, x)
    }

    fn count(&mut self, (pairs, seconds): (i64, f64)) {
        self.cache.counters.pairs_linearised += pairs;
        self.cache.counters.seconds_assembly += seconds;
    }
}

/// What plans belong to: the interface, and the order of its nodes.
pub type PlanOf<'a, const N: usize> = (&'a Setup<N>, &'a Numbering);

fn no_plan() -> Error {
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
                "the plan lacks the entries of {} in the rows of {}: the pairs have changed; make it again (stickslip_interface_plan)",
                name(column),
                name(row)
            );
            Err(Error::new(Kind::MissingEntry, text))
        }
    }
}
