//! A law of one's own at the nodes of an interface (docs/formulation.md 4.8): what it is asked, and what becomes of its answers.
//! Asked by the calling thread alone, node after node.

use super::sums::NodeSums;
use crate::error::{Error, Kind, Result};
use crate::features;
use crate::geometry::Vec3;
use crate::interface::data::options::NewContact;
use crate::interface::pairing::given::Given;
use crate::law::{Node, NodeResponse, Own, Question, Special, State, Told, trial};
use crate::memory;

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

/// What the law says of each node at a point; empty without one.
#[derive(Debug, Default)]
pub struct OwnAnswers {
    /// Of every node.
    specials: Vec<Special>,
    /// What it remembers of the nodes if the step ends here.
    pub states: Vec<f64>,
}

impl OwnAnswers {
    /// Begins anew, with what was remembered at t_n.
    pub fn begin<const N: usize>(&mut self, given: Given<N>) -> Result<()> {
        if given.setup.own.is_none() {
            self.specials.clear();
            self.states.clear();
            return Ok(());
        }
        memory::refill(&mut self.specials, Special::Nothing, given.nodes())?;
        memory::recopy(&mut self.states, &given.history().states)
    }

    /// Asks about node A at its sums, and puts the answer into it.
    pub fn ask<const N: usize>(
        &mut self,
        given: Given<N>,
        a: usize,
        node: &mut Node<N>,
        sums: &NodeSums,
    ) -> Result<()> {
        let Some(own) = &given.setup.own else { return Ok(()) };
        let of = own.states() * a..own.states() * (a + 1);
        node.special = special((own, given), a, (node, sums), At::Trial, &mut self.states[of])?;
        self.specials[a] = node.special;
        Ok(())
    }

    /// Puts what was answered about node A into it.
    pub fn put<const N: usize>(&self, a: usize, node: &mut Node<N>) {
        node.special = self.specials.get(a).copied().unwrap_or_default();
    }

    /// Takes back what would be remembered of node A where its answer says that nothing has happened there.
    pub fn settle<const N: usize>(&mut self, given: Given<N>, a: usize, response: &NodeResponse<N>) {
        let Some(own) = &given.setup.own else { return };
        if response.state == State::Gap || (own.ages_by_slip() && response.state != State::Slip) {
            let (from, to) = (own.states() * a, own.states() * (a + 1));
            self.states[from..to].copy_from_slice(&given.history().states[from..to]);
        }
    }

    /// On the heap `[bytes]`.
    pub fn bytes(&self) -> usize {
        self.specials.capacity() * size_of::<Special>() + self.states.capacity() * size_of::<f64>()
    }
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
        states: &history.states[own.states() * a..own.states() * (a + 1)],
    };
    let answer = own.answer(&question, states)?;
    Ok(Special::Told(Told { threshold: answer.threshold, slope: answer.slope * area }))
}
