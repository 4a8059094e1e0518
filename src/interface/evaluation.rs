//! Evaluating and looking at an interface through its handle: sums, answers, residual, tangent, pattern; the report, the
//! diagnosis, the distance from equilibrium.

use super::contact::Contact;
use super::data::extent::Extent;
use super::data::options::Form;
use super::inspect::closing;
use super::inspect::diagnosis::{self, Diagnosis};
use super::inspect::equilibrium::{self, Equilibrium, Scales};
use super::inspect::report::{self, Report};
use super::pairing::given::Given;
use super::stages::initial;
use super::stages::normals;
use super::stages::residual::{self, Residual};
use super::stages::sums::NodeSums;
use super::tangent::blocks::{Numbers, blocks, node_tangents};
use super::tangent::derivatives::PairDerivatives;
use super::tangent::emission::{Sink, Sinks};
use super::tangent::turning::Turns;
use super::tangent::union::{UnionPair, possible_pairs, union};
use crate::error::{Error, Kind, Result};
use crate::geometry::Vec3;
use crate::law::NodeResponse;
use crate::memory::{self, Stored};
use crate::mortar::PairWeights;
use nalgebra::SVector;
use std::time::Instant;

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
        let (pairs, answers, work) = self.cache.acting(&self.step.history);
        let (given, responses) = (Given { setup: &self.setup, step: &self.step }, &answers.responses.nodes);
        residual::refresh(given, pairs, lambda, responses, &mut work.room.vectors, &mut self.residual)?;
        Ok(&self.residual)
    }

    /// The exact tangent d residual / d (x1, x2, lambda) at (x, lambda).
    pub fn tangent(
        &mut self,
        x1: &[Vec3],
        x2: &[Vec3],
        lambda: &[SVector<f64, N>],
        sums: Option<&[NodeSums]>,
        sink: &mut impl Sink,
    ) -> Result<()> {
        if sums.is_some() && self.setup.options.form == Form::Augmented {
            let text =
                "sums with the augmented form: its tangent couples pairs of different handles; use the multiplier form";
            return Err(Error::new(Kind::Unsupported, text));
        }
        self.cache.respond(&self.setup, &mut self.step, (x1, x2), lambda, sums)?;
        self.linearise((x1, x2), lambda, Extent::of(sums), None, (sink, None))
    }

    /// The blocks of a tangent at the point of the last answers. `scales`: factors of the nodes' rows, in place of their own.
    pub(super) fn linearise(
        &mut self,
        (x1, x2): (&[Vec3], &[Vec3]),
        lambda: &[SVector<f64, N>],
        extent: Extent,
        scales: Option<&[f64]>,
        sinks: Sinks,
    ) -> Result<()> {
        let differentiates = self.setup.options.differentiates_weights();
        let start = Instant::now();
        let (given, mortar, options) = (self.given(), &self.setup.mortar, &self.setup.options);
        let (normals, answers) = (given.normals()?, self.cache.answers());
        let responses = &answers.responses;
        let scale = |a: usize| scales.map_or_else(|| given.row_scale(a), |s| s[a]);
        let surface = mortar.analytic.map(|_| mortar.analytic_at(x2)).transpose()?;
        let motion = PairDerivatives {
            opposite: self.setup.effects.opposite,
            surface: surface.as_ref(),
            tangent: options.tangent,
            rule: options.rule,
        };
        let numbers = Numbers {
            x1,
            responses,
            nodes: node_tangents(given, lambda, responses, &normals, scale)?,
            active: self.cache.active().filter(|_| differentiates),
            motion,
            turns: Turns::at(given, (x1, lambda), (&answers.sums, responses), &normals, scale)?,
        };
        let linearised = self.blocks(&self.union()?, &normals, extent, Some(&numbers), sinks)?;
        self.cache.work.counters.pairs_linearised += linearised;
        self.cache.work.counters.seconds_assembly += start.elapsed().as_secs_f64();
        Ok(())
    }

    pub(super) fn blocks(
        &self,
        union: &[UnionPair],
        normals: &[Vec3],
        extent: Extent,
        numbers: Option<&Numbers<N>>,
        sinks: Sinks,
    ) -> Result<i64> {
        let given = (self.given(), normals);
        if self.setup.effects.moves() {
            blocks::<true, N>(given, union, extent, numbers, sinks)
        } else {
            blocks::<false, N>(given, union, extent, numbers, sinks)
        }
    }

    /// The pairs that a tangent has here.
    pub(super) fn union(&self) -> Result<Vec<UnionPair<'_>>> {
        if self.cache.is_apart() {
            return Ok(Vec::new());
        }
        union(self.cache.pairs(&self.step.history), &self.step.history.pairs, self.setup.effects.law.slips)
    }

    /// The entries of the tangent at (x1, x2), in its order: as many as [`Contact::tangent`] writes there, without sums
    /// (`Whole`) or with those of all handles. Their values mean nothing.
    pub fn pattern(&mut self, x1: &[Vec3], x2: &[Vec3], extent: Extent, sink: &mut impl Sink) -> Result<()> {
        self.given().check_positions(x1, x2)?;
        self.cache.integrate(&self.setup, &mut self.step, (x1, x2), extent)?;
        let normals = memory::filled(Vec3::zeros(), self.setup.nonmortar.len())?;
        self.blocks(&self.union()?, &normals, extent, None, (sink, None)).map(|_| ())
    }

    /// The entries of any tangent, with sums or without, while the surfaces slide by less than a quarter of a facet. A
    /// larger motion may need entries beyond these.
    pub fn superset_pattern(&mut self, x1: &[Vec3], x2: &[Vec3], sink: &mut impl Sink) -> Result<()> {
        self.given().check_positions(x1, x2)?;
        self.superset((x1, x2), (sink, None))
    }

    pub(super) fn superset(&mut self, (x1, x2): (&[Vec3], &[Vec3]), sinks: Sinks) -> Result<()> {
        // Refuses what an evaluation here does, and serves the next one.
        self.cache.integrate(&self.setup, &mut self.step, (x1, x2), Extent::Whole)?;
        let weights = PairWeights::default();
        let given = Given { setup: &self.setup, step: &self.step };
        let pairs = possible_pairs(given, &mut self.cache.work.tree, (x1, x2))?;
        let any = |&(one, two)| UnionPair { one, two, now: Some(&weights), place: 0, previous: Some(&weights) };
        let all: Vec<_> = pairs.iter().map(any).stored()?;
        let normals = memory::filled(Vec3::zeros(), self.setup.nonmortar.len())?;
        self.blocks(&all, &normals, Extent::Part, None, sinks).map(|_| ())
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
        let (answers, scope) = (self.cache.answers(), self.cache.scope(extent));
        let known = (&answers.sums[..], &answers.responses.carried[..]);
        equilibrium::equilibrium(self.given(), (x1, x2), lambda, known, scope, scales)
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
        Ok(diagnosis::diagnosis(
            self.given(),
            self.cache.pairs(&self.step.history),
            (x1, x2),
            &node_sums,
            states,
            suspects,
        ))
    }
}
