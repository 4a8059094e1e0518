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
use super::projection::State;
use super::special::Special;
use super::violation::{Measure, Violation};
use crate::geometry::{Mat3, Vec3};

/// Coulomb's law of a node, stretched.
#[derive(Clone, Copy, Debug)]
pub struct Orthotropic;

/// Whether one direction of the surface is prescribed: the free ones and the normal are fewer than three.
fn has_one_direction(node: &Node) -> bool {
    const TWO: f64 = 1.5;
    node.free.trace() - 1.0 < TWO
}

/// L, L^-1 and the node as Coulomb's law sees it; `None`: it is that node.
fn stretched(node: &Node) -> Option<(Mat3, Mat3, Node)> {
    let Special::Ellipse(ellipse) = node.special else { return None };
    let axes = ellipse.axes(node.normal)?;
    let free = node.free - node.normal * node.normal.transpose();
    let (mu, identity) = ([node.mu, ellipse.across], Mat3::identity());
    // Where a direction in the surface is prescribed, what is left is the ellipse's shadow: the supports bear the rest.
    if has_one_direction(node) {
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

/// How the ellipse's shadow on the only free direction of the surface changes with normal and axes.
fn shadow_change(node: &Node, (mu, axes): ([f64; 2], [Vec3; 2]), (d, change): ([Vec3; 2], Vec3)) -> f64 {
    let nu = node.normal;
    let free = node.free - nu * nu.transpose();
    let d_free = -(change * nu.transpose() + nu * change.transpose());
    let shadows = [0, 1].map(|k| free * axes[k]);
    let of: f64 = (0..2).map(|k| mu[k] * mu[k] * shadows[k].dot(&(d_free * axes[k] + free * d[k]))).sum();
    let size = (mu[0] * shadows[0].norm()).hypot(mu[1] * shadows[1].norm());
    if size > 0.0 { of / size } else { 0.0 }
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
            drow_darea: Vec3::zeros(),
        }
    }

    /// As Coulomb's law turns, with the axes: Dp = DL p' + L (dp'/dnu Dnu + dp'/dlambda' DL^-1 lambda + dp'/dg' DL g).
    fn turn(node: &Node) -> Turn {
        let (Special::Ellipse(ellipse), Some((l, _, of))) = (node.special, stretched(node)) else {
            return Coulomb::turn(node);
        };
        let (r, response, mut turn) = (node.augmentation, Coulomb::respond(&of), Coulomb::turn(&of));
        turn.dp_dnormal = l * turn.dp_dnormal;
        let Some(axes) = ellipse.axes(node.normal).filter(|_| response.state != State::Gap) else { return turn };
        let mu = [node.mu, ellipse.across];
        let (is_shadow, (_, committed)) = (has_one_direction(node), node.slip.coefficients());
        for (i, change) in [Vec3::x(), Vec3::y(), Vec3::z()].into_iter().enumerate() {
            let d = ellipse.turned_axes(node.normal, axes, change);
            let mut column = turn.dp_dnormal.column_mut(i);
            if is_shadow {
                let tangential = response.traction - node.normal * node.normal.dot(&response.traction);
                if response.state == State::Slip && of.mu > 0.0 {
                    column += tangential * (shadow_change(node, (mu, axes), (d, change)) / of.mu);
                }
                continue;
            }
            let [one, two] = [0, 1].map(|k| d[k] * axes[k].transpose() + axes[k] * d[k].transpose());
            let size = (mu[0] / mu[1]).sqrt();
            let stretch = one * (size - 1.0) + two * (1.0 / size - 1.0);
            let inverse = one * (1.0 / size - 1.0) + two * (size - 1.0);
            let previous = node.gap_previous - node.gap_committed * committed;
            let by_gaps =
                response.drow_dnow * (stretch * node.gap_now) + response.drow_dprevious * (stretch * previous);
            column += stretch * response.traction + l * (response.dp_dlambda * (inverse * node.lambda) + by_gaps * r);
        }
        Turn { dp_dnormal: turn.dp_dnormal, drow_dnormal: turn.dp_dnormal / r }
    }

    /// Lengths and tractions are the stretched ones.
    fn violation(node: &Node, measure: &Measure) -> Violation {
        match stretched(node) {
            Some((_, _, node)) => Coulomb::violation(&node, measure),
            None => Coulomb::violation(node, measure),
        }
    }
}
