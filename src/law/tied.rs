//! Mesh tying (docs/formulation 4.6): a covered node keeps its place over the mortar side, c = g - g_0 with the weights
//! and the gap g_0 of the first configuration. No inequality, no state. An open g_0 turns with the non-mortar facets
//! (`interface/data/facet_gaps.rs`); closed surfaces are linear. An uncovered node has no traction.
//!
//! c depends on the gap alone, and on g_0 as on -g: what is -Dg_0 of Dg goes with Dg.

use super::node::{Law, Node, NodeResponse, Turn};
use super::projection::State;
use super::violation::{Measure, Violation};
use crate::geometry::{Mat3, Vec3};

/// Opens never, slips never. A covered node is in the state stick.
#[derive(Clone, Copy, Debug)]
pub struct Tied;

impl Law<3> for Tied {
    const SLIPS: bool = false;

    fn respond(node: &Node) -> NodeResponse {
        let (r, free) = (node.augmentation, node.free);
        let gap_normal = node.normal.dot(&node.gap_now);
        if !node.covered {
            return NodeResponse { gap_normal, ..NodeResponse::uncovered(&node.lambda, r) };
        }
        let gap = free * (node.gap_now - node.gap_committed);
        let lambda = free * node.lambda;
        let sigma = lambda + gap * r;
        NodeResponse {
            state: State::Stick,
            traction: sigma,
            row: gap - (node.lambda - lambda) / r,
            gap_normal,
            slip: Vec3::zeros(),
            sigma,
            dp_dlambda: free,
            drow_dlambda: (free - Mat3::identity()) / r,
            drow_dnow: free,
            drow_dprevious: Mat3::zeros(),
            drow_darea: Vec3::zeros(),
        }
    }

    /// The normal decides nothing.
    fn turn(_node: &Node) -> Turn {
        Turn::default()
    }

    fn violation(node: &Node, measure: &Measure) -> Violation {
        let apart = node.free * (node.gap_now - node.gap_committed) / measure.coverage;
        let normal = node.normal.dot(&apart);
        let held = (node.lambda - node.free * node.lambda).norm();
        Violation::of(normal.abs(), (apart - node.normal * normal).norm(), held, measure)
    }
}
