//! Evaluating and looking at an interface through its handle: sums, answers, residual; the report, the diagnosis, the distance from equilibrium.

use super::contact::Contact;
use super::data::extent::Extent;
use super::inspect::closing;
use super::inspect::diagnosis::{self, Diagnosis};
use super::inspect::equilibrium::{self, Equilibrium};
use super::inspect::largest::Scales;
use super::inspect::report::{self, Report};
use super::pairing::given::Given;
use super::stages::conserving;
use super::stages::initial;
use super::stages::normals;
use super::stages::residual::{self, Residual};
use super::stages::sums::NodeSums;
use crate::error::{Error, Kind, Result};
use crate::geometry::Vec3;
use crate::law::{NodeResponse, State};
use crate::memory::{self, Stored};
use nalgebra::SVector;

/// Evaluations.
impl<const N: usize> Contact<N> {
    /// Stage 1, assembled: every node's gaps and coverage.
    pub fn sums(&mut self, x1: &[Vec3], x2: &[Vec3]) -> Result<Vec<NodeSums>> {
        memory::copied(self.cache.sums(&self.setup, &mut self.step, (x1, x2), Extent::Whole)?)
    }

    /// This handle's share of them, of several handles whose shares a host adds up.
    pub fn share_of_sums(&mut self, x1: &[Vec3], x2: &[Vec3]) -> Result<Vec<NodeSums>> {
        memory::copied(self.kept_share_of_sums(x1, x2)?)
    }

    /// The same, which the interface keeps.
    pub fn kept_share_of_sums(&mut self, x1: &[Vec3], x2: &[Vec3]) -> Result<&[NodeSums]> {
        self.cache.sums(&self.setup, &mut self.step, (x1, x2), Extent::Part)
    }

    /// Stage 2: the law at every node. `sums` overrides this handle's own, for parallel hosts.
    pub fn responses(
        &mut self,
        x1: &[Vec3],
        x2: &[Vec3],
        lambda: &[SVector<f64, N>],
        sums: Option<&[NodeSums]>,
    ) -> Result<Vec<NodeResponse<N>>> {
        self.evaluate(x1, x2, lambda, sums).map(|(_, responses)| responses)
    }

    /// Stages 1 and 2: the sums, `sums` or this handle's own, and the law's answers to them.
    pub fn evaluate(
        &mut self,
        x1: &[Vec3],
        x2: &[Vec3],
        lambda: &[SVector<f64, N>],
        sums: Option<&[NodeSums]>,
    ) -> Result<(Vec<NodeSums>, Vec<NodeResponse<N>>)> {
        self.respond(x1, x2, lambda, sums)?;
        let (sums, responses) = self.answers();
        Ok((memory::copied(sums)?, memory::copied(responses)?))
    }

    /// The same, to be looked at by [`Contact::answers`].
    pub fn respond(
        &mut self,
        x1: &[Vec3],
        x2: &[Vec3],
        lambda: &[SVector<f64, N>],
        sums: Option<&[NodeSums]>,
    ) -> Result<()> {
        self.cache.respond(&self.setup, &mut self.step, (x1, x2), lambda, sums)
    }

    /// The sums and the law's answers where [`Contact::respond`] was called last, before anything else that changes the
    /// interface.
    pub fn answers(&self) -> (&[NodeSums], &[NodeResponse<N>]) {
        let answers = self.cache.answers();
        (&answers.sums, &answers.responses.nodes)
    }

    /// How much of what is covered of a node is closed, at the same point.
    pub fn closed_share(&self, a: usize) -> f64 {
        let responses = &self.cache.answers().responses;
        let share = f64::from(u8::from(responses.nodes[a].state != State::Gap));
        if self.setup.decides_at_points() { responses.points.shares[a] } else { share }
    }

    /// What friction takes of a node in this step, at the same point [F L]: its traction times its slip; where points decide the sum over
    /// them, of which nothing is stored.
    pub fn dissipation(&self, a: usize) -> f64 {
        let responses = &self.cache.answers().responses;
        match self.setup.has_point_friction() {
            true => responses.points.friction.dissipation[a],
            false => (responses.nodes[a].traction - responses.own.bonded(a)).dot(&responses.nodes[a].slip),
        }
    }

    /// Multipliers for the first step.
    ///
    /// # Errors
    /// [`Kind::InvalidValue`] once a step is committed.
    pub fn initial_multipliers(&mut self) -> Result<Vec<SVector<f64, N>>> {
        let history = &self.step.history;
        if history.commits > 0 {
            let text = text!("initial multipliers belong before the first step; {} are committed", history.commits);
            return Err(Error::new(Kind::InvalidValue, text));
        }
        // Those of now: the history may keep none, or those of t_n may be left out so far.
        let (x1, x2) = (memory::copied(&history.x1)?, memory::copied(&history.x2)?);
        let sums = self.sums(&x1, &x2)?;
        initial::initial_multipliers(self.given(), &sums)
    }

    /// Forces and multiplier rows at (x, lambda).
    pub fn residual(
        &mut self,
        x1: &[Vec3],
        x2: &[Vec3],
        lambda: &[SVector<f64, N>],
        sums: Option<&[NodeSums]>,
    ) -> Result<Residual<N>> {
        let r = self.kept_residual(x1, x2, lambda, sums)?;
        let (nonmortar, mortar) = (memory::copied(&r.nonmortar)?, memory::copied(&r.mortar)?);
        Ok(Residual { nonmortar, mortar, rows: memory::copied(&r.rows)? })
    }

    /// The same, which the interface keeps.
    pub fn kept_residual(
        &mut self,
        x1: &[Vec3],
        x2: &[Vec3],
        lambda: &[SVector<f64, N>],
        sums: Option<&[NodeSums]>,
    ) -> Result<&Residual<N>> {
        self.respond(x1, x2, lambda, sums)?;
        if self.setup.options.conserves() {
            let (given, answers) = (Given { setup: &self.setup, step: &self.step }, self.cache.answers());
            let known = self.cache.conserving();
            conserving::residual(given, known, lambda, &answers.responses.nodes, &mut self.residual)?;
            return Ok(&self.residual);
        }
        let (pairs, answers, work) = self.cache.acting(self.setup.surfaces(), &self.step.history);
        let (given, responses) = (Given { setup: &self.setup, step: &self.step }, &answers.responses.nodes);
        if self.setup.decides_at_points() {
            let points = &answers.responses.points;
            match self.setup.has_point_friction() {
                true => points.residual_with_friction(given, responses, &mut self.residual)?,
                false => points.residual(given, responses, &mut self.residual)?,
            }
            return Ok(&self.residual);
        }
        residual::refresh(given, pairs, lambda, responses, &mut work.room.vectors, &mut self.residual)?;
        Ok(&self.residual)
    }
}

/// Looking at an interface.
impl<const N: usize> Contact<N> {
    /// The fraction of the step (dx1, dx2) from (x1, x2) that is allowed, above 0 and at most 1. `depth`: how much deeper a
    /// node may go, over its shortest edge, or the default. Sides that are tied may move as they like.
    pub fn step_limit(&mut self, x: (&[Vec3], &[Vec3]), dx: (&[Vec3], &[Vec3]), depth: Option<f64>) -> Result<f64> {
        self.given().check_positions(x.0, x.1)?;
        // At a point in between they would say hardly more.
        normals::follow(&self.setup, &mut self.step, x.0)?;
        let given = Given { setup: &self.setup, step: &self.step };
        closing::step_limit(given, self.cache.looked_at(), x, dx, depth)
    }

    /// The distance of (x, lambda) from equilibrium. Nodes without any multiplier equation have no part in it.
    pub fn equilibrium(
        &mut self,
        x1: &[Vec3],
        x2: &[Vec3],
        lambda: &[SVector<f64, N>],
        sums: Option<&[NodeSums]>,
        scales: &Scales,
    ) -> Result<Equilibrium> {
        let extent = Extent::of(sums);
        self.cache.respond(&self.setup, &mut self.step, (x1, x2), lambda, sums)?;
        let scope = self.cache.scope(extent);
        let (_, answers, work) = self.cache.acting(self.setup.surfaces(), &self.step.history);
        let known = (&answers.sums[..], &answers.responses.carried[..], &answers.responses.nodes[..]);
        let given = Given { setup: &self.setup, step: &self.step };
        equilibrium::equilibrium(given, (x1, x2), lambda, known, scope, (scales, work))
    }

    /// Which nodes are covered, and how, at (x1, x2), however far apart the surfaces are there.
    pub fn report(&mut self, x1: &[Vec3], x2: &[Vec3]) -> Result<Report> {
        self.given().check_positions(x1, x2)?;
        normals::follow(&self.setup, &mut self.step, x1)?;
        let given = Given { setup: &self.setup, step: &self.step };
        report::report(given, &mut self.cache.work, (x1, x2))
    }

    /// The diagnosis at (x, lambda). The state of the interface stays as it is.
    pub fn diagnose(
        &mut self,
        x1: &[Vec3],
        x2: &[Vec3],
        lambda: &[SVector<f64, N>],
        sums: Option<&[NodeSums]>,
    ) -> Result<Diagnosis> {
        let (node_sums, responses) = self.evaluate(x1, x2, lambda, sums)?;
        let states: Vec<_> = responses.iter().map(|r| r.state).stored()?;
        // With sums a handle's rows are parts of rows: nothing can be said of them.
        let suspects = if sums.is_some() {
            Vec::new()
        } else {
            let mut rows = diagnosis::Rows::new(&self.setup.multiplier_equations)?;
            self.tangent(x1, x2, lambda, None, &mut rows)?;
            diagnosis::suspects(self.given(), rows, &node_sums, &states)?
        };
        let mut diagnosis = diagnosis::diagnosis(
            self.given(),
            self.cache.pairs(&self.step.history),
            (x1, x2),
            &node_sums,
            states,
            suspects,
        );
        if self.setup.acts_along_first_normals() {
            diagnosis.turn = self.equilibrium(x1, x2, lambda, sums, &Scales::default())?.turn;
        }
        Ok(diagnosis)
    }
}
