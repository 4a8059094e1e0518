//! What a law of one's own is asked about a node, and what it answers.

use super::projection::Threshold;
use crate::geometry::Vec3;

/// What a threshold may depend on at a node.
#[derive(Clone, Copy, Debug)]
pub struct Question<'a> {
    /// Which node, from 0.
    pub node: usize,
    /// sigma_N <= 0 [F/L^2].
    pub normal: f64,
    /// Slip of the step `[L]`.
    pub slip: Vec3,
    /// Slip before the step, since the first configuration `[L]`.
    pub slip_before: Vec3,
    /// Where the node would slip to: a unit vector, or 0.
    pub direction: Vec3,
    /// Coulomb's coefficient.
    pub mu: f64,
    /// What the law remembers of the node at t_n.
    pub states: &'a [f64],
}

impl Question<'_> {
    /// Along which |slip| grows: where nothing has slipped yet, where the node would slip to.
    pub fn along(&self) -> Vec3 {
        let step = self.slip.norm();
        if step > 0.0 { self.slip / step } else { self.direction }
    }
}

/// A threshold, with derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Answer {
    /// k and -dk / dsigma_N.
    pub threshold: Threshold,
    /// dk / dslip [F/L^3].
    pub slope: Vec3,
}
