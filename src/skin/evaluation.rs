//! Evaluating a skin: every piece at its part of the point, and what lies between the pieces.

use super::handle::{Skin, is_there};
use super::piece::Held;
use crate::error::{Error, Kind, Result};
use crate::geometry::Vec3;
use crate::interface::{Equilibrium, Extent, Normals, PlanPairs, PlanSystem, Scales};
use crate::law::State;
use crate::memory::{self, Store, Stored};

/// What there is to say of a copy.
#[derive(Clone, Copy, Debug)]
pub struct OfCopy {
    /// State.
    pub state: State,
    /// nu, into the non-mortar body.
    pub normal: Vec3,
    /// Projected traction [F/L^2].
    pub traction: Vec3,
    /// Weighted gap `[L^3]`.
    pub gap: f64,
    /// Slip since the first configuration `[L]`.
    pub slip: Vec3,
    /// Covered area `[L^2]`.
    pub coverage: f64,
    /// Full area `[L^2]`.
    pub area: f64,
    /// Work of friction in this step [F L].
    pub dissipation: f64,
    /// r_A [F/L^5].
    pub augmentation: f64,
    /// How much of what is covered is closed [-].
    pub share: f64,
}

/// Of a copy that nothing can touch.
const ALONE: OfCopy = OfCopy {
    state: State::Gap,
    normal: Vec3::new(0.0, 0.0, 0.0),
    traction: Vec3::new(0.0, 0.0, 0.0),
    gap: 0.0,
    slip: Vec3::new(0.0, 0.0, 0.0),
    coverage: 0.0,
    area: 0.0,
    dissipation: 0.0,
    augmentation: 0.0,
    share: 0.0,
};

/// A component of a multiplier that no piece has, and the area of its copy.
struct Alone {
    copy: usize,
    component: usize,
    area: f64,
}

/// Forces on the host's nodes, and the multipliers' rows.
#[derive(Debug)]
pub struct SkinResidual {
    /// In internal-force sign `[F]`.
    pub forces: Vec<Vec3>,
    /// Per copy.
    pub rows: Vec<Vec3>,
}

impl Skin {
    /// Multipliers to start with: a slight compression where facets touch.
    pub fn initial_multipliers(&mut self) -> Result<Vec<Vec3>> {
        let mut lambda = memory::filled(Vec3::zeros(), self.whole.copies())?;
        for held in &mut self.held {
            for (&a, value) in held.copies[0].iter().zip(held.contact.initial_multipliers()?) {
                lambda[a] += value;
            }
        }
        Ok(lambda)
    }

    /// Forces and rows at (x, lambda).
    pub fn residual(&mut self, x: &[Vec3], lambda: &[Vec3]) -> Result<SkinResidual> {
        self.check(x, lambda)?;
        let mut forces = memory::filled(Vec3::zeros(), self.whole.nodes)?;
        let mut rows = memory::filled(Vec3::zeros(), self.whole.copies())?;
        for held in &mut self.held {
            held.go_to(&self.whole, x, lambda)?;
            let Held { contact, room, copies, has_multiplier, .. } = held;
            let found = contact.kept_residual(&room.x[0], &room.x[1], &room.lambda, None)?;
            for (side, of_side) in [&found.nonmortar, &found.mortar].into_iter().enumerate() {
                for (&a, force) in copies[side].iter().zip(of_side) {
                    forces[self.whole.originals[a]] += force;
                }
            }
            let own = copies[0].iter().zip(has_multiplier).zip(&found.rows);
            own.filter(|((_, has), _)| **has).for_each(|((&a, _), row)| rows[a] = *row);
        }
        for Alone { copy, component, area } in self.alone()? {
            rows[copy][component] = -lambda[copy][component] * area;
        }
        Ok(SkinResidual { forces, rows })
    }

    /// The multipliers that no piece has: their rows say that they are 0.
    fn alone(&self) -> Result<Vec<Alone>> {
        let n = self.whole.copies();
        let mut has = memory::filled([false; 3], n)?;
        for held in &self.held {
            for (local, &a) in held.copies[0].iter().enumerate().filter(|(local, _)| held.has_multiplier[*local]) {
                has[a] = held.idle[local].map(|idle| !idle);
            }
        }
        let mut alone = Vec::new();
        for copy in (0..n).filter(|&a| is_there(&self.whole.multipliers[a])) {
            let of_facet = |&f: &usize| self.whole.areas[f] / self.whole.surface.host_nodes(f).len() as f64;
            let area = self.whole.around.of(copy).iter().map(of_facet).sum();
            let missing = (0..self.whole.components()).filter(|&i| !has[copy][i]);
            alone.store_all(missing.map(|component| Alone { copy, component, area }))?;
        }
        Ok(alone)
    }

    /// Makes the plan of the tangent; the number of its entries. Some entries come more than once: they add up.
    pub fn make_plan(&mut self, x: &[Vec3], possible: bool) -> Result<usize> {
        self.whole.check(x)?;
        let of = if possible { PlanPairs::Possible } else { PlanPairs::Active(Extent::Whole) };
        let mut entries = 0;
        for held in &mut self.held {
            let (contact, room) = held.at(&self.whole, x, &[])?;
            entries += contact.make_plan((&room.x[0], &room.x[1]), of)?;
        }
        self.is_planned = true;
        Ok(entries + self.alone()?.len())
    }

    /// How many entries the plan has.
    ///
    /// # Errors
    /// [`Kind::MissingEntry`]: the pieces have changed since it was made, or it never was.
    pub fn plan_len(&self) -> Result<usize> {
        if !self.is_planned {
            let text = "the plan is not that of this step: what may touch has changed at the commit; make it again";
            return Err(Error::new(Kind::MissingEntry, text));
        }
        let mut entries = self.alone()?.len();
        for held in &self.held {
            entries += held.contact.plan(PlanSystem::Whole)?.0.len();
        }
        Ok(entries)
    }

    /// Rows and columns of the plan's entries, in the order of their values.
    pub fn plan_entries(&self, take: &mut dyn FnMut(i64, i64) -> Result<()>) -> Result<()> {
        self.plan_len()?;
        let alone = self.alone()?; // before anything is taken, for there may be no memory
        for held in &self.held {
            let (plan, of) = held.contact.plan(PlanSystem::Whole)?;
            let mut rows = plan.rows().0.iter();
            plan.each_row(of, &mut |columns| {
                let row = rows.next().copied().unwrap_or_default();
                columns.iter().try_for_each(|&column| take(row, column))
            })?;
        }
        alone
            .into_iter()
            .map(|Alone { copy, component, .. }| self.whole.multipliers[copy][component])
            .try_for_each(|e| take(e, e))
    }

    /// The tangent in the order of the plan's entries.
    pub fn plan_values(&mut self, x: &[Vec3], lambda: &[Vec3], values: &mut [f64]) -> Result<()> {
        self.check(x, lambda)?;
        self.plan_len()?;
        let mut rest = values;
        for held in &mut self.held {
            let n = held.contact.plan(PlanSystem::Whole)?.0.len();
            let own;
            (own, rest) = rest.split_at_mut(n);
            let (contact, room) = held.at(&self.whole, x, lambda)?;
            contact.plan_values((&room.x[0], &room.x[1]), &room.lambda, None, own)?;
        }
        self.alone()?.into_iter().zip(rest).for_each(|(Alone { area, .. }, value)| *value = -area);
        Ok(())
    }

    /// What there is to say of every copy.
    pub fn states(&mut self, x: &[Vec3], lambda: &[Vec3]) -> Result<Vec<OfCopy>> {
        self.check(x, lambda)?;
        let mut all = memory::filled(ALONE, self.whole.copies())?;
        for held in &mut self.held {
            let (contact, room) = held.at(&self.whole, x, lambda)?;
            contact.respond(&room.x[0], &room.x[1], &room.lambda, None)?;
            let contact = &held.contact;
            let (sums, responses) = contact.answers();
            for (local, &a) in held.copies[0].iter().enumerate().filter(|(local, _)| held.has_multiplier[*local]) {
                let (response, sum) = (&responses[local], &sums[local]);
                all[a] = OfCopy {
                    state: response.state,
                    normal: contact.normal(local)?,
                    traction: response.traction,
                    gap: response.gap_normal,
                    slip: contact.slip_after(local, response, sum.coverage_previous),
                    coverage: sum.coverage,
                    area: contact.history().areas[local],
                    dissipation: contact.dissipation(local),
                    augmentation: contact.augmentation(local),
                    share: contact.closed_share(local),
                };
            }
        }
        Ok(all)
    }

    /// The distance from equilibrium: of all pieces the worst, by the largest traction of all; nodes are copies.
    pub fn equilibrium(&mut self, x: &[Vec3], lambda: &[Vec3], scales: &Scales) -> Result<Equilibrium> {
        self.check(x, lambda)?;
        let (mut scales, mut worst) = (*scales, Equilibrium::default());
        // The first time for the largest traction of all pieces alone.
        for _ in 0..2 {
            (worst, scales) = self.worst(x, lambda, scales)?;
        }
        Ok(worst)
    }

    /// The worst of all pieces, and the scales with the largest traction of any.
    fn worst(&mut self, x: &[Vec3], lambda: &[Vec3], scales: Scales) -> Result<(Equilibrium, Scales)> {
        let (mut next, mut worst) = (scales, Equilibrium::default());
        for held in &mut self.held {
            let (contact, room) = held.at(&self.whole, x, lambda)?;
            let found = contact.equilibrium(&room.x[0], &room.x[1], &room.lambda, None, &scales)?;
            next.traction = next.traction.max(found.traction.scale);
            worst.take_worse(&found, &|local| held.copies[0][local]);
        }
        Ok((worst, next))
    }

    /// The part of a step that is allowed.
    pub fn step_limit(&mut self, x: &[Vec3], dx: &[Vec3], depth: Option<f64>) -> Result<f64> {
        self.whole.check(x)?;
        self.whole.check(dx)?;
        let mut limit = 1.0_f64;
        for held in &mut self.held {
            let [one, two] = [0, 1].map(|side| held.originals(&self.whole, side).map(|a| dx[a]).stored());
            let (one, two) = (one?, two?);
            let (contact, room) = held.at(&self.whole, x, &[])?;
            limit = limit.min(contact.step_limit((&room.x[0], &room.x[1]), (&one, &two), depth)?);
        }
        Ok(limit)
    }

    /// Solves on with these normals: those of t_n are for the first phase of a step.
    pub fn use_normals(&mut self, normals: Normals) -> Result<()> {
        self.held.iter_mut().try_for_each(|held| held.contact.use_normals(normals))
    }

    /// Multipliers that have turned with the skin since t_n.
    pub fn turn_multipliers(&mut self, x: &[Vec3], lambda: &mut [Vec3]) -> Result<()> {
        self.check(x, lambda)?;
        for held in &mut self.held {
            let (contact, room) = held.at(&self.whole, x, lambda)?;
            let turned = contact.turn_multipliers(&room.x[0], &room.lambda)?;
            let own = held.copies[0].iter().zip(&held.has_multiplier).zip(turned);
            own.filter(|((_, has), _)| **has).for_each(|((&a, _), turned)| lambda[a] = turned);
        }
        Ok(())
    }
}
