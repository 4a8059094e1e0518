//! Stage 2 over a whole interface: the law's answers at every node.

use super::carried::{carry, find_carried};
use super::node::{count_of, is_left_out, node};
use super::own::OwnAnswers;
use super::sums::NodeSums;
use crate::error::{Error, Kind, Result};
use crate::interface::data::active::Active;
use crate::interface::data::counters::NodeCounts;
use crate::interface::data::extent::Scope;
use crate::interface::data::points::Points;
use crate::interface::pairing::given::Given;
use crate::law::NodeResponse;
use crate::memory::{self, Store};
use nalgebra::SVector;

/// What stage 2 gives.
#[derive(Debug)]
pub struct Responses<const N: usize> {
    /// Of every node.
    pub nodes: Vec<NodeResponse<N>>,
    /// Which nodes are carried here; empty where none is.
    pub carried: Vec<bool>,
    /// How the nodes were treated.
    pub counts: NodeCounts,
    /// What a law of one's own has answered.
    pub own: OwnAnswers,
    /// What points have answered where they decide.
    pub points: Points,
}

impl<const N: usize> Default for Responses<N> {
    fn default() -> Self {
        let (counts, own) = (NodeCounts::default(), OwnAnswers::default());
        Responses { nodes: Vec::new(), carried: Vec::new(), counts, own, points: Points::default() }
    }
}

/// The law's answers to the sums of every node, in place of what was in `answers`. `active`: the pairs there, with weights of now.
pub fn respond<const N: usize>(
    (given, active): (Given<N>, Option<&Active>),
    lambda: &[SVector<f64, N>],
    sums: &[NodeSums],
    scope: Scope,
    answers: &mut Responses<N>,
) -> Result<()> {
    let Responses { nodes: responses, carried, counts, own, points } = answers;
    find_carried(given, sums, carried)?;
    *counts = NodeCounts::default();
    responses.clear();
    memory::grow(responses, lambda.len())?;
    own.begin(given)?;
    for a in 0..lambda.len() {
        responses.store(if is_left_out(given, a, scope) {
            counts.left_out += 1;
            NodeResponse::uncovered(&lambda[a], given.augmentation(a))
        } else {
            let node = node(given, a, lambda[a], &sums[a])?;
            let is_carried = carried.get(a).is_some_and(|c| *c);
            *(if is_carried { &mut counts.carried } else { count_of(given, a, &node, counts) }) += 1;
            own.respond(given, a, (node, &sums[a]))?
        })?;
    }
    if carried.contains(&true) {
        carry(given, lambda, (sums, carried), responses, own)?;
    }
    if given.setup.decides_at_points() {
        if N == 3 {
            points.respond_with_friction(given, lambda, (sums, own), responses)?;
            memory::recopy(&mut own.states, &points.friction.states)?;
        } else {
            points.respond((given, active), lambda, (sums, own), responses)?;
        }
    }
    for (a, response) in responses.iter().enumerate() {
        if !response.row.iter().chain(response.traction.iter()).all(|v| v.is_finite()) {
            let text = text!("the response of non-mortar node {a} overflows; positions or multiplier are out of range");
            return Err(Error::new(Kind::NotFinite, text));
        }
    }
    Ok(())
}
