//! The tangent of an interface through its handle: entry by entry, or by a plan, which is made once and filled in every
//! evaluation.

use super::compose::Feature;
use super::contact::Contact;
use super::data::extent::Extent;
use super::linear::{AtPoint, Here, Linear, PlanOf, PlanPairs, Positions, ThreadRoom, Work, no_plan};
use super::pairing::given::Given;
use super::plan::numbering::Sides;
use super::plan::pattern::System;
use super::plan::whole::Plan;
use super::stages::sums::NodeSums;
use super::tangent::blocks::{Room, blocks};
use super::tangent::by_equations::{ByEquations, Numbers, Sink};
use super::tangent::emission::Takers;
use super::tangent::task::Task;
use super::tangent::union::{Pairs, possible_pairs};
use crate::error::Result;
use crate::geometry::Vec3;
use crate::memory;
use nalgebra::SVector;

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
        self.linearise_by_equations((x1, x2), lambda, Extent::of(sums), (None, None), (sink, None))
    }

    /// The blocks of a tangent at the point of the last answers. `scales`: factors of the nodes' rows, in place of their own; `numbers`:
    /// likewise of the equations.
    pub(super) fn linearise_by_equations(
        &mut self,
        x: Positions,
        lambda: &[SVector<f64, N>],
        extent: Extent,
        (scales, numbers): (Option<&[f64]>, Option<Numbers<N>>),
        (sink, constraints): (&mut dyn Sink, Option<&mut dyn Sink>),
    ) -> Result<()> {
        let numbers = numbers.unwrap_or_else(|| Numbers::of(&self.setup));
        let here = Here { given: Given { setup: &self.setup, step: &self.step }, cache: &self.cache };
        let Linear { rooms, normals, nodes, turns, .. } = &mut self.linear;
        let mut taker = ByEquations::new(&self.setup, numbers, sink);
        let mut constraints = constraints.map(|sink| ByEquations::new(&self.setup, numbers, sink));
        let takers: Takers<N> = (&mut taker, constraints.as_mut().map(|taker| taker as _));
        let mut takers = Some(takers);
        let mut make = |task: Task<N>, rooms: &mut [ThreadRoom<N>]| match takers.take() {
            Some(takers) => blocks(task, &mut rooms[0].room, takers),
            None => Ok(0),
        };
        let cost = here.linearise(x, lambda, (extent, scales), Work { rooms, normals, nodes, turns }, &mut make)?;
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
        let numbers = Numbers::of(&self.setup);
        let mut taker = ByEquations::new(&self.setup, numbers, sink);
        let mut constraints = constraints.map(|sink| ByEquations::new(&self.setup, numbers, sink));
        let takers: Takers<N> = (&mut taker, constraints.as_mut().map(|taker| taker as _));
        let normals = memory::filled(Vec3::zeros(), self.setup.nonmortar.len())?;
        let moves = self.setup.effects.moves();
        let task = Task { given: self.given(), normals: &normals, pairs, extent, moves, numbers: None };
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
        let possible = self.find_pairs(x, of)?;
        self.plans_of(&possible, of, systems)
    }

    /// Finds the pairs of a plan: the active ones in the handle, or those that there may be.
    fn find_pairs(&mut self, x: Positions, of: PlanPairs) -> Result<Option<Vec<(usize, usize)>>> {
        self.given().check_positions(x.0, x.1)?;
        match of {
            PlanPairs::Active(extent) => {
                self.cache.integrate(&self.setup, &mut self.step, x, extent)?;
                Ok(None)
            }
            PlanPairs::Possible => self.possible_pairs(x).map(Some),
        }
    }

    fn found_pairs<'a>(&'a self, possible: &'a Option<Vec<(usize, usize)>>) -> Pairs<'a> {
        possible.as_ref().map_or_else(|| self.here().pairs(), |pairs| Pairs::Possible(pairs))
    }

    fn plans_of<const S: usize>(
        &mut self,
        possible: &Option<Vec<(usize, usize)>>,
        of: PlanPairs,
        systems: [System; S],
    ) -> Result<[Plan; S]> {
        // Nothing may leave between here and where it is put back: an older plan needs it.
        let mut numbering = self.linear.numbering.take();
        let plans = self.here().plans((self.found_pairs(possible), of.extent()), systems, &mut numbering);
        self.linear.numbering = numbering;
        plans
    }

    /// The plan of this that was made last.
    ///
    /// # Errors
    /// [`crate::error::Kind::InvalidValue`]: there is none.
    pub fn plan(&self, system: System) -> Result<(&Plan, PlanOf<'_>)> {
        let condensed = self.linear.condensed.as_ref();
        self.with_numbering(match system {
            System::Whole => self.linear.plan.as_ref(),
            System::Forces => condensed.map(|plans| &plans[0]),
            System::Constraints => condensed.map(|plans| &plans[1]),
        })
    }

    fn with_numbering<'a>(&'a self, plan: Option<&'a Plan>) -> Result<(&'a Plan, PlanOf<'a>)> {
        match (plan, &self.linear.numbering) {
            (Some(plan), Some(numbering)) => Ok((plan, (Sides::of(&self.setup), numbering))),
            _ => Err(no_plan()),
        }
    }

    /// The tangent at (x, lambda) in the order of the plan's entries. After an error the values mean nothing.
    ///
    /// # Errors
    /// [`crate::error::Kind::MissingEntry`]: the plan does not suffice here.
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

    /// The plan of these pairs at (x1, x2) that the handle makes and keeps for itself, for those who ask for its entries in
    /// each evaluation.
    pub fn own_plan(&mut self, x: Positions, of: PlanPairs) -> Result<(&Plan, PlanOf<'_>)> {
        let possible = self.find_pairs(x, of)?;
        let key = self.found_pairs(&possible).checksum(of.extent() == Extent::Whole);
        if self.linear.own.as_ref().is_none_or(|own| own.0 != key) {
            let [plan] = self.plans_of(&possible, of, [System::Whole])?;
            self.linear.own = Some((key, plan));
        }
        self.with_numbering(self.linear.own.as_ref().map(|own| &own.1))
    }

    /// The values of [`Contact::own_plan`] of the active pairs, which has just been asked for here.
    pub fn own_values(
        &mut self,
        x: Positions,
        lambda: &[SVector<f64, N>],
        sums: Option<&[NodeSums]>,
        values: &mut [f64],
    ) -> Result<(&Plan, PlanOf<'_>)> {
        self.refuse_sums(sums)?;
        self.cache.respond(&self.setup, &mut self.step, x, lambda, sums)?;
        self.fill_plan(true, (x, lambda, (Extent::of(sums), None)), values)?;
        self.with_numbering(self.linear.own.as_ref().map(|own| &own.1))
    }

    fn fill_plan(&mut self, is_own: bool, of: AtPoint<N>, values: &mut [f64]) -> Result<()> {
        let here = Here { given: Given { setup: &self.setup, step: &self.step }, cache: &self.cache };
        let Linear { numbering, plan, own, fill, rooms, normals, nodes, turns, couplings, .. } = &mut self.linear;
        let plan = if is_own { own.as_ref().map(|own| &own.1) } else { plan.as_ref() };
        let Some(plan) = plan else { return Err(no_plan()) };
        let cost = {
            let work = (Work { rooms, normals, nodes, turns }, couplings);
            here.fill(of, numbering, fill, work, (plan, values), None)?
        };
        self.count(cost);
        Ok(())
    }

    /// Fills the plans of a condensed system: what the forces depend on the displacements by, and the constraints.
    pub(super) fn fill_condensed(&mut self, of: AtPoint<N>, [forces, constraints]: [&mut [f64]; 2]) -> Result<()> {
        let here = Here { given: Given { setup: &self.setup, step: &self.step }, cache: &self.cache };
        let Linear { numbering, condensed, fill, rooms, normals, nodes, turns, couplings, .. } = &mut self.linear;
        let Some([first, second]) = condensed else { return Err(no_plan()) };
        let work = (Work { rooms, normals, nodes, turns }, couplings);
        let constraints = Some((&*second, constraints));
        let cost = here.fill(of, numbering, fill, work, (first, forces), constraints)?;
        self.count(cost);
        Ok(())
    }

    fn here(&self) -> Here<'_, N> {
        Here { given: self.given(), cache: &self.cache }
    }

    fn refuse_sums(&self, sums: Option<&[NodeSums]>) -> Result<()> {
        sums.map_or(Ok(()), |_| self.setup.refuse(&[(Feature::SumsTangent, true)]))
    }

    /// The pairs that there may be near x.
    fn possible_pairs(&mut self, x: Positions) -> Result<Vec<(usize, usize)>> {
        // Refuses what an evaluation here does, and serves the next one.
        self.cache.integrate(&self.setup, &mut self.step, x, Extent::Whole)?;
        let given = Given { setup: &self.setup, step: &self.step };
        possible_pairs(given, &mut self.cache.work.tree, x)
    }

    fn count(&mut self, (pairs, seconds): (i64, f64)) {
        self.cache.work.counters.pairs_linearised += pairs;
        self.cache.work.counters.seconds_assembly += seconds;
    }
}
