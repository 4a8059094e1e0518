//! A law of one's own, and what lies between the surfaces, at the nodes of an interface (docs/formulation 4.8, 20): what they are asked, and what becomes of their answers.
//! Asked by the calling thread alone, node after node.

use super::sums::NodeSums;
use crate::error::{Error, Kind, Result};
use crate::features;
use crate::geometry::Vec3;
use crate::interface::data::options::NewContact;
use crate::interface::pairing::given::Given;
use crate::law::{
    Layer, LayerAnswer, LayerQuestion, Node, NodeResponse, Own, Question, Special, State, Told, Turn, trial,
};
use crate::memory;
use nalgebra::SVector;

/// At which normal traction a threshold is wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum At {
    /// sigma_N, of a projection.
    Trial,
    /// lambda_N, none under tension: for the distance from equilibrium.
    Multiplier,
}

/// Whether a node acts without friction in the step in which it becomes covered.
pub fn is_new<const N: usize>(given: Given<N>, node: &Node<N>) -> bool {
    !node.covered_before && given.setup.options.new_contact == NewContact::Frictionless
}

/// What the law, and what lies between the surfaces, say of each node at a point; empty without them.
#[derive(Debug, Default)]
pub struct OwnAnswers {
    /// Of every node.
    specials: Vec<Special>,
    layers: Vec<LayerAnswer>,
    /// What is remembered of the nodes if the step ends here: by the law, then by what lies between the surfaces.
    pub states: Vec<f64>,
}

impl OwnAnswers {
    /// Begins anew, with what was remembered at t_n.
    pub fn begin<const N: usize>(&mut self, given: Given<N>) -> Result<()> {
        let (own, layer) = (given.setup.own.is_some(), given.setup.layer.is_some());
        memory::refill(&mut self.specials, Special::Nothing, if own { given.nodes() } else { 0 })?;
        memory::refill(&mut self.layers, LayerAnswer::default(), if layer { given.nodes() } else { 0 })?;
        memory::recopy(&mut self.states, if own || layer { &given.history().states } else { &[] })
    }

    /// The answer of law and layer about node A at its sums.
    pub fn respond<const N: usize>(
        &mut self,
        given: Given<N>,
        a: usize,
        (node, sums): (Node<N>, &NodeSums),
    ) -> Result<NodeResponse<N>> {
        let law = &given.setup.effects.law;
        let Some(layer) = &given.setup.layer else {
            let mut node = node;
            self.ask(given, a, &mut node, sums)?;
            let response = (law.respond)(&node);
            self.settle(given, a, &response);
            return Ok(response);
        };
        let of = given.setup.layer_states(a);
        let answer = layer_answer((layer, given), a, (&node, sums), &mut self.states[of.start..of.end]);
        self.layers[a] = answer;
        let mut inner = answer.inner(&node);
        self.ask(given, a, &mut inner, sums)?;
        let response = (law.respond)(&inner);
        self.settle(given, a, &response);
        layer.settle(response.state == State::Slip, &given.history().states[of.start..of.end], &mut self.states[of]);
        Ok(answer.outer(&node, response))
    }

    /// How that answer turns with the normal of node A.
    pub fn turn<const N: usize>(&self, given: Given<N>, a: usize, mut node: Node<N>) -> Turn<N> {
        let (law, special) = (&given.setup.effects.law, self.specials.get(a).copied().unwrap_or_default());
        let Some(answer) = self.layers.get(a) else {
            node.special = special;
            return (law.turn)(&node);
        };
        answer.turn(law, &node, &Node { special, ..answer.inner(&node) })
    }

    /// How that answer changes with the area that slip is counted over, at the same sum of the slip [L].
    pub fn drow_darea<const N: usize>(
        &self,
        given: Given<N>,
        (a, node): (usize, Node<N>),
        (response, area): (&NodeResponse<N>, f64),
    ) -> SVector<f64, N> {
        let Some(Special::Told(told)) = self.specials.get(a) else { return SVector::zeros() };
        let special = Special::Told(Told { slope: Vec3::zeros(), ..*told });
        let held = (given.setup.effects.law.respond)(&Node { special, ..node });
        (held.drow_dprevious - response.drow_dprevious) * node.gap_previous / area
    }

    /// By how much the surfaces give way at node A: see [`LayerAnswer::yields`].
    pub fn yields(&self, a: usize) -> Option<[f64; 3]> {
        self.layers.get(a).map(LayerAnswer::yields)
    }

    /// Traction that a bond bears at node A.
    pub fn bonded(&self, a: usize) -> Vec3 {
        self.layers.get(a).map_or(Vec3::zeros(), |answer| answer.traction)
    }

    /// Asks about node A at its sums, and puts the answer into it.
    fn ask<const N: usize>(&mut self, given: Given<N>, a: usize, node: &mut Node<N>, sums: &NodeSums) -> Result<()> {
        let Some(own) = &given.setup.own else { return Ok(()) };
        let of = given.setup.law_states(a);
        node.special = special((own, given), a, (node, sums), At::Trial, &mut self.states[of])?;
        self.specials[a] = node.special;
        Ok(())
    }

    /// Takes back what would be remembered of node A where its answer says that nothing has happened there.
    fn settle<const N: usize>(&mut self, given: Given<N>, a: usize, response: &NodeResponse<N>) {
        let Some(own) = &given.setup.own else { return };
        if response.state == State::Gap || (own.ages_by_slip() && response.state != State::Slip) {
            let of = given.setup.law_states(a);
            self.states[of.start..of.end].copy_from_slice(&given.history().states[of]);
        }
    }

    /// On the heap `[bytes]`.
    pub fn bytes(&self) -> usize {
        self.specials.capacity() * size_of::<Special>()
            + self.layers.capacity() * size_of::<LayerAnswer>()
            + self.states.capacity() * size_of::<f64>()
    }
}

/// What lies between the surfaces at node A; `after`: what would be remembered of it.
#[inline(never)]
pub fn layer_answer<const N: usize>(
    (layer, given): (&Layer, Given<N>),
    a: usize,
    (node, sums): (&Node<N>, &NodeSums),
    after: &mut [f64],
) -> LayerAnswer {
    if !node.covered {
        return LayerAnswer::default();
    }
    let history = given.history();
    let states = &history.states[given.setup.layer_states(a)];
    let coverage = [sums.coverage, sums.coverage_previous];
    layer.answer(node, &LayerQuestion { coverage, area: history.areas[a], states }, after)
}

/// What the law adds to node A; `states`: what it would remember of it.
pub fn special<const N: usize>(
    (own, given): (&Own, Given<N>),
    a: usize,
    (node, sums): (&Node<N>, &NodeSums),
    at: At,
    states: &mut [f64],
) -> Result<Special> {
    features::LAWS.is_here();
    if let Own::Orthotropic(ellipse) = own {
        if node.covered && ellipse.axes(node.normal).is_none() {
            let text =
                text!("law.direction lies along the normal of non-mortar node {a}; it must have a part in the surface");
            return Err(Error::new(Kind::InvalidValue, text));
        }
        return Ok(if node.mu > 0.0 { Special::Ellipse(*ellipse) } else { Special::Nothing });
    }
    let trial = trial(node);
    let (normal, open) = match at {
        At::Trial => (trial.sigma_n, trial.sigma_n >= 0.0),
        At::Multiplier => (trial.lambda_n.min(0.0), false),
    };
    if !node.covered || open || is_new(given, node) || given.has_copy_in_contact(a) {
        return Ok(Special::Told(Told::nothing()));
    }
    let history = given.history();
    let area = if node.covered_before { 1.0 / sums.coverage_previous } else { 0.0 };
    let question = Question {
        node: a,
        normal,
        slip: trial.slip * area,
        slip_before: history.slip.get(a).copied().unwrap_or(Vec3::zeros()),
        direction: trial.direction,
        mu: node.mu,
        states: &history.states[given.setup.law_states(a)],
    };
    let answer = own.answer(&question, states)?;
    Ok(Special::Told(Told { threshold: answer.threshold, slope: answer.slope * area }))
}
