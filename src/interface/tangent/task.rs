//! What a tangent is asked for: of which pairs, and what its numbers are made of.

use super::conserving_numbers::ConservingNumbers;
use super::derivatives::PairDerivatives;
use super::turning::Turns;
use super::union::Pairs;
use crate::element::NodeTangent;
use crate::geometry::Vec3;
use crate::interface::data::active::Active;
use crate::interface::data::extent::Extent;
use crate::interface::pairing::given::Given;
use crate::interface::stages::respond::Responses;
use crate::interface::stages::sums::NodeSums;
use crate::law::NodeResponse;

/// What the numbers of a tangent are made of.
pub struct Numbers<'a, const N: usize> {
    /// Non-mortar positions.
    pub x1: &'a [Vec3],
    /// What the nodes assemble.
    pub sums: &'a [NodeSums],
    /// The law's answers.
    pub responses: &'a Responses<N>,
    /// What the pairs must know of them.
    pub nodes: &'a [NodeTangent<N>],
    /// The pairs whose weights are differentiated; `None`: no weights are.
    pub active: Option<&'a Active>,
    /// How they are.
    pub motion: PairDerivatives<'a>,
    /// How answers turn with the normals of now; `None`: the normals are those of t_n.
    pub turns: Option<Turns<'a, N>>,
    /// With conserving weights: what the blocks of nodes are made of.
    pub conserving: Option<&'a ConservingNumbers<'a, N>>,
}

impl<'a, const N: usize> Numbers<'a, N> {
    /// For the derivatives of weights alone, of forces at the tractions of `nodes`.
    pub fn of_weights(
        active: &'a Active,
        responses: &'a Responses<N>,
        nodes: &'a [NodeTangent<N>],
        motion: PairDerivatives<'a>,
    ) -> Numbers<'a, N> {
        Numbers {
            x1: &active.x1,
            sums: &[],
            responses,
            nodes,
            active: Some(active),
            motion,
            turns: None,
            conserving: None,
        }
    }
    /// Which nodes are carried, with what the pairs must know of their carriers.
    pub fn carried(&self) -> (&[bool], &[NodeTangent<N>]) {
        (&self.responses.carried, self.nodes)
    }

    /// Which nodes are carried, with the law's answers.
    pub fn answers(&self) -> (&[bool], &[NodeResponse<N>]) {
        (&self.responses.carried, &self.responses.nodes)
    }
}

/// The tangent of some pairs.
#[derive(Clone, Copy)]
pub struct Task<'a, const N: usize> {
    /// The interface and its step.
    pub given: Given<'a, N>,
    /// nu of every node; zeros for the pattern alone.
    pub normals: &'a [Vec3],
    /// The pairs.
    pub pairs: Pairs<'a>,
    /// What the tangent is of.
    pub extent: Extent,
    /// Whether the mortar side has rows and columns.
    pub moves: bool,
    /// `None` for the pattern alone.
    pub numbers: Option<&'a Numbers<'a, N>>,
}
