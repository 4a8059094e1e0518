//! Mesh tying: a covered node keeps its place over the mortar side, c = g - g_0 with the weights and the gap g_0 of
//! the reference configuration. Linear: no inequality, no state, no history. An uncovered node carries nothing.

use super::node::{Law, Node, NodeResponse};
use super::projection::State;
use crate::geometry::{Mat3, Vec3};

/// Opens never, slips never. A covered node is in the state stick.
#[derive(Clone, Copy, Debug)]
pub struct Tied;

impl Law<3> for Tied {
    const SLIPS: bool = false;

    fn respond(node: &Node) -> NodeResponse {
        let r = node.augmentation;
        let free = if node.covered { node.free } else { Mat3::zeros() };
        let gap = free * (node.gap_now - node.gap_committed);
        let lambda = free * node.lambda;
        let sigma = lambda + gap * r;
        NodeResponse {
            state: if node.covered { State::Stick } else { State::Gap },
            traction: sigma,
            row: gap - (node.lambda - lambda) / r,
            gap_normal: node.normal.dot(&node.gap_now),
            slip: Vec3::zeros(),
            sigma,
            dp_dlambda: free,
            drow_dlambda: (free - Mat3::identity()) / r,
            drow_dnow: free,
            drow_dprevious: Mat3::zeros(),
        }
    }
}
