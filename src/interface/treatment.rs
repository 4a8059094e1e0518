//! How each node is treated, for the counters: what a scene pays for, node by node.

use super::{Contact, Extent, Friction};
use crate::law::Node;

/// How the nodes were treated at the last evaluation. They add up to all of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct NodeCounts {
    /// Covered, with friction: Coulomb's law with mu > 0, rough.
    pub frictional: i64,
    /// Covered, without friction: mu = 0, or no friction at all.
    pub frictionless: i64,
    /// Covered now and not at t_n: without friction for this step.
    pub new: i64,
    /// Covered and tied.
    pub tied: i64,
    /// Covered, and carried by neighbours: no multiplier of its own in this step.
    pub carried: i64,
    /// Not covered here: the row is -lambda / r.
    pub uncovered: i64,
    /// Not covered wherever the step may go, or the surfaces are apart: the same row, without asking the law.
    pub left_out: i64,
}

impl NodeCounts {
    /// All nodes.
    pub fn total(&self) -> i64 {
        self.frictional + self.frictionless + self.new + self.tied + self.carried + self.uncovered + self.left_out
    }
}

impl<const N: usize> Contact<N> {
    /// The count that a node which the law is asked about belongs to.
    pub(super) fn count_of<'c>(&self, a: usize, node: &Node<N>, counts: &'c mut NodeCounts) -> &'c mut i64 {
        if !node.covered {
            &mut counts.uncovered
        } else if self.options.friction == Friction::Tied {
            &mut counts.tied
        } else if !self.kernels.slips || self.mu[a] == 0.0 {
            &mut counts.frictionless
        } else if node.mu == 0.0 {
            &mut counts.new
        } else {
            &mut counts.frictional
        }
    }

    /// Whether nothing can cover a node before the next commit. Of a part of an interface other handles may know better.
    pub(super) fn is_out_of_reach(&self, a: usize, extent: Extent) -> bool {
        self.options.shortcuts.uncovered && extent == Extent::Whole && !self.coverable[a]
    }

    /// Whether the law need not be asked about a node: out of reach, or the surfaces are apart.
    pub(super) fn is_left_out(&self, a: usize, extent: Extent) -> bool {
        self.is_out_of_reach(a, extent) || (self.options.shortcuts.uncovered && self.is_apart())
    }
}
