//! The stateless stage: one node with three multipliers under any law, without an interface.

use super::node::{Node, NodeResponse, Turn};
use super::table::Friction;
use super::violation::{Measure, Violation};

impl Friction {
    /// The law's answer.
    pub fn respond(self, node: &Node) -> NodeResponse {
        (self.law().functions.respond)(node)
    }

    /// How it turns with the normal.
    pub fn turn(self, node: &Node) -> Turn {
        (self.law().functions.turn)(node)
    }

    /// The node's distance from equilibrium.
    pub fn violation(self, node: &Node, measure: &Measure) -> Violation {
        match node.covered {
            true => (self.law().functions.violation)(node, measure),
            false => Violation::uncovered(node.lambda.norm(), measure),
        }
    }
}
