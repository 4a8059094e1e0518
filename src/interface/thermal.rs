//! Heat through the handle (docs/formulation 17).

use super::cache::Answers;
use super::compose::Feature;
use super::contact::Contact;
use super::data::extent::Extent;
use super::data::node_data::check_length;
use super::heat::rows::{Row, rows};
use super::heat::sides::{Place, sides};
use super::heat::tangent::{Equations, tangent};
use super::pairing::given::Given;
use super::tangent::by_equations::Sink;
use super::tangent::turning::{NodeTurn, Turns};
use crate::error::{Error, Kind, Result};
use crate::geometry::Vec3;
use crate::law::{Conductance, HeatFlow, HeatNode};
use nalgebra::SVector;

/// Heat of an interface.
#[derive(Debug)]
pub struct Heat {
    /// What leaves the nodes of the non-mortar and of the mortar side [F L/T].
    pub sides: [Vec<f64>; 2],
    /// Every non-mortar node, and what passes through it.
    pub nodes: Vec<(HeatNode, HeatFlow)>,
}

/// Temperatures of both sides, and how heat passes.
#[derive(Clone, Copy, Debug)]
pub struct Temperatures<'a> {
    /// Of the nodes \[K\].
    pub sides: [&'a [f64]; 2],
    /// The law.
    pub conductance: &'a Conductance,
}

impl<const N: usize> Contact<N> {
    /// What leaves the nodes at (x, lambda) and these temperatures.
    ///
    /// # Errors
    /// Those of a residual.
    pub fn heat(&mut self, x: [&[Vec3]; 2], lambda: &[SVector<f64, N>], t: Temperatures) -> Result<Heat> {
        let rows = self.heat_rows(x, lambda, t, false)?;
        let at = self.heat_place(x, t);
        let nodes = at.flows(&rows)?;
        Ok(Heat { sides: sides(&at, &rows, &nodes)?, nodes })
    }

    /// The derivatives of what leaves the nodes. With the columns of displacements and multipliers, or without.
    ///
    /// # Errors
    /// Those of [`Contact::heat`].
    pub fn heat_tangent(
        &mut self,
        x: [&[Vec3]; 2],
        lambda: &[SVector<f64, N>],
        t: Temperatures,
        (temperatures, with_motion): ([&[i64]; 2], bool),
        sink: &mut dyn Sink,
    ) -> Result<()> {
        check_length("equations1", temperatures[0].len(), x[0].len())?;
        check_length("equations2", temperatures[1].len(), x[1].len())?;
        let mut rows = self.heat_rows(x, lambda, t, with_motion)?;
        let at = self.heat_place(x, t);
        let nodes = at.flows(&rows)?;
        let active = self.cache.active().filter(|_| self.setup.options.differentiates_weights());
        let (known, mut room) = ((active, &self.cache.answers().responses), Vec::new());
        let turns = if with_motion { self.turns(at.given, (x[0], lambda), &mut room)? } else { None };
        tangent(&at, &mut rows, &nodes, known, turns.as_ref(), Equations { temperatures, with_motion }, sink)
    }

    /// The weights of now, and where slip counts of t_n. Leaves the law's answers.
    fn heat_rows(
        &mut self,
        x: [&[Vec3]; 2],
        lambda: &[SVector<f64, N>],
        t: Temperatures,
        with_motion: bool,
    ) -> Result<Vec<Row>> {
        self.setup.refuse(&[(Feature::HeatMotion, with_motion)])?;
        let (one, two) = self.setup.surfaces();
        for (name, values, needed) in
            [("temperatures1", t.sides[0], one.len()), ("temperatures2", t.sides[1], two.len())]
        {
            check_length(name, values.len(), needed)?;
            if let Some(k) = values.iter().position(|v| !v.is_finite()) {
                return Err(Error::new(Kind::NotFinite, text!("{name} of node {k} is not finite")));
            }
        }
        let at = (x[0], x[1]);
        self.cache.respond(&self.setup, &mut self.step, at, lambda, None)?;
        // Heat crosses gaps, too: where the surfaces are apart and forces need no pairs.
        self.cache.integrate(&self.setup, &mut self.step, at, Extent::Part)?;
        self.cache.turn_half_way(&self.setup, &mut self.step)?;
        let surfaces = self.setup.surfaces();
        let previous = with_motion && self.setup.effects.law.slips;
        let history = &self.step.history;
        let now = self.cache.weighted(surfaces, history);
        rows(surfaces, now, previous.then(|| history.weighted(surfaces)))
    }

    fn heat_place<'a>(&'a self, x: [&'a [Vec3]; 2], t: Temperatures<'a>) -> Place<'a, N> {
        let Answers { responses, sums, .. } = self.cache.answers();
        let given = Given { setup: &self.setup, step: &self.step };
        let work = self.setup.has_point_friction().then_some(&responses.points.friction.dissipation[..]);
        Place { given, x, temperatures: t.sides, responses: &responses.nodes, work, sums, conductance: t.conductance }
    }

    /// How the answers turn with normals of now.
    fn turns<'a>(
        &self,
        given: Given<N>,
        at: (&'a [Vec3], &[SVector<f64, N>]),
        room: &'a mut Vec<NodeTurn<N>>,
    ) -> Result<Option<Turns<'a, N>>> {
        let answers = self.cache.answers();
        let pairs = self.cache.weighted(self.setup.surfaces(), &self.step.history);
        Turns::at(given, at, (pairs, &answers.sums, &answers.responses), &given.normals()?, &|_| 1.0, room)
    }
}
