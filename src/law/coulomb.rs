//! Coulomb's law: k = -mu sigma_N.

use super::cone::Cone;
use super::node::Node;
use super::projection::Threshold;

/// Slips at mu times the pressure; with mu = infinity (rough) a closed node sticks.
#[derive(Clone, Copy, Debug)]
pub struct Coulomb;

impl Cone for Coulomb {
    fn threshold(node: &Node, sigma_n: f64) -> Threshold {
        Threshold::cone(node.mu, sigma_n)
    }
}
