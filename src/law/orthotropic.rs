//! Orthotropic friction: mu along a direction of the surface, another coefficient across it. The tractions that stick lie within
//! an ellipse, (lambda_1 / mu_1)^2 + (lambda_2 / mu_2)^2 < sigma_N^2, and the node slips at a right angle to its border (an
//! associated rule, as of Mroz and of Michalowski): g_T goes along (lambda_1 / mu_1^2, lambda_2 / mu_2^2).
//!
//! With L = diag(l, 1 / l) in the surface and 1 along nu, l = sqrt(mu_1 / mu_2), the tractions lambda' = L^-1 lambda and the gaps
//! g' = L g obey Coulomb's law with mu' = sqrt(mu_1 mu_2): the ellipse becomes a circle, the right angle the same direction, and
//! the work lambda . g does not change. So p = L p', c = L c', and each derivative by lambda is L (.) L^-1, by a gap L (.) L.
//! No iteration, and exact. With equal coefficients L is 1.

use super::coulomb::Coulomb;
use super::node::{Law, Node, NodeResponse, Turn};
use super::special::Special;
use super::violation::{Measure, Violation};
use crate::geometry::Mat3;

/// Coulomb's law of a node, stretched.
#[derive(Clone, Copy, Debug)]
pub struct Orthotropic;

/// L, L^-1 and the node as Coulomb's law sees it; `None`: it is that node.
fn stretched(node: &Node) -> Option<(Mat3, Mat3, Node)> {
    let Special::Ellipse(ellipse) = node.special else { return None };
    let axes = ellipse.axes(node.normal)?;
    let free = node.free - node.normal * node.normal.transpose();
    let (mu, identity) = ([node.mu, ellipse.across], Mat3::identity());
    // Where a direction in the surface is prescribed, what is left is the ellipse's shadow: the supports bear the rest.
    const TWO: f64 = 1.5;
    if free.trace() < TWO {
        let [one, two] = [0, 1].map(|k| mu[k] * (free * axes[k]).norm());
        return Some((identity, identity, Node { mu: one.hypot(two), ..*node }));
    }
    let l = (mu[0] / mu[1]).sqrt();
    let [one, two] = axes.map(|axis| axis * axis.transpose());
    let stretch = identity + one * (l - 1.0) + two * (1.0 / l - 1.0);
    let inverse = identity + one * (1.0 / l - 1.0) + two * (l - 1.0);
    let node = Node {
        lambda: inverse * node.lambda,
        mu: (mu[0] * mu[1]).sqrt(),
        gap_now: stretch * node.gap_now,
        gap_previous: stretch * node.gap_previous,
        gap_committed: stretch * node.gap_committed,
        ..*node
    };
    Some((stretch, inverse, node))
}

impl Law<3> for Orthotropic {
    const SLIPS: bool = true;

    fn respond(node: &Node) -> NodeResponse {
        let Some((l, inverse, node)) = stretched(node) else { return Coulomb::respond(node) };
        let r = Coulomb::respond(&node);
        NodeResponse {
            state: r.state,
            traction: l * r.traction,
            row: l * r.row,
            gap_normal: r.gap_normal,
            slip: inverse * r.slip,
            sigma: l * r.sigma,
            dp_dlambda: l * r.dp_dlambda * inverse,
            drow_dlambda: l * r.drow_dlambda * inverse,
            drow_dnow: l * r.drow_dnow * l,
            drow_dprevious: l * r.drow_dprevious * l,
        }
    }

    /// Where normals follow the motion the law is refused: its axes would turn with them.
    fn turn(_node: &Node) -> Turn {
        Turn::default()
    }

    /// Lengths and tractions are the stretched ones.
    fn violation(node: &Node, measure: &Measure) -> Violation {
        match stretched(node) {
            Some((_, _, node)) => Coulomb::violation(&node, measure),
            None => Coulomb::violation(node, measure),
        }
    }
}
