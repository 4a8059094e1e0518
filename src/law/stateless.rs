//! The stateless stage: one node under Coulomb's law, without an interface.

use super::coulomb::Coulomb;
use super::node::{Law, Node, NodeResponse};
use super::violation::{Measure, Violation};

impl Node {
    /// Coulomb's answer, of the stateless stage.
    pub fn respond(&self) -> NodeResponse {
        Coulomb::respond(self)
    }

    /// Its distance from equilibrium under Coulomb's law, of the stateless stage.
    pub fn violation(&self, measure: &Measure) -> Violation {
        match self.covered {
            true => Coulomb::violation(self, measure),
            false => Violation::uncovered(self.lambda.norm(), measure),
        }
    }
}
