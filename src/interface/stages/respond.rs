//! Stage 2 over a whole interface: the law's answers at every node.

use super::carried::{carried, carry};
use super::node::{count_of, is_left_out, node};
use super::sums::NodeSums;
use crate::error::{Error, Kind, Result};
use crate::interface::data::counters::NodeCounts;
use crate::interface::data::extent::Scope;
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
}

/// The law's answers to the sums of every node.
pub fn respond<const N: usize>(
    given: Given<N>,
    lambda: &[SVector<f64, N>],
    sums: &[NodeSums],
    scope: Scope,
) -> Result<Responses<N>> {
    let carried = carried(given, sums)?;
    let mut counts = NodeCounts::default();
    let mut responses = memory::with_room(lambda.len())?;
    for a in 0..lambda.len() {
        responses.store(if is_left_out(given, a, scope) {
            counts.left_out += 1;
            NodeResponse::uncovered(&lambda[a], given.augmentation(a))
        } else {
            let node = node(given, a, lambda[a], &sums[a])?;
            let is_carried = carried.get(a).is_some_and(|c| *c);
            *(if is_carried { &mut counts.carried } else { count_of(given, a, &node, &mut counts) }) += 1;
            (given.setup.effects.law.respond)(&node)
        })?;
    }
    if carried.contains(&true) {
        carry(given, lambda, sums, &carried, &mut responses)?;
    }
    for (a, response) in responses.iter().enumerate() {
        if !response.row.iter().chain(response.traction.iter()).all(|v| v.is_finite()) {
            let text = text!("the response of non-mortar node {a} overflows; positions or multiplier are out of range");
            return Err(Error::new(Kind::NotFinite, text));
        }
    }
    Ok(Responses { nodes: responses, carried, counts })
}
