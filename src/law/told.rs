//! A threshold that somebody else has found for the node: k at its normal traction and slip, with its derivatives.

use super::cone::Cone;
use super::node::Node;
use super::projection::Threshold;
use super::special::{Special, Told};
use crate::geometry::Vec3;

/// Slips at the threshold that its node has been told.
#[derive(Clone, Copy, Debug)]
pub struct ToldLaw;

/// A node that has been told nothing has no friction.
fn told(node: &Node) -> Told {
    match node.special {
        Special::Told(told) => told,
        _ => Told::nothing(),
    }
}

impl Cone for ToldLaw {
    const FOLLOWS_SLIP: bool = true;

    fn threshold(node: &Node, _sigma_n: f64) -> Threshold {
        told(node).threshold
    }

    fn slope(node: &Node) -> Vec3 {
        told(node).slope
    }
}
