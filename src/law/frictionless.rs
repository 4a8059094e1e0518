//! Contact without friction: Coulomb's law with mu = 0 and lambda along the normal, without its tangential part.
//! Closed: p = lambda_N + r g_N < 0, c = g_N; open: p = 0, c = -lambda_N / r. A closed node is in the state slip.

use super::node::{Law, Node, NodeResponse, Turn};
use super::projection::State;
use super::violation::{Covered, Measure, Violation};
use crate::geometry::{Mat3, Vec3};
use nalgebra::{SMatrix, SVector};

/// No traction along the surface. With one multiplier per node, or with three whose tangential rows are
/// -lambda_T / r.
#[derive(Clone, Copy, Debug)]
pub struct Frictionless;

/// sigma_N and whether the node is closed.
fn close<const N: usize>(node: &Node<N>, lambda_n: f64) -> (f64, f64, bool) {
    let gap_normal = node.normal.dot(&node.gap_now);
    let sigma_n = lambda_n + node.augmentation * gap_normal;
    (gap_normal, sigma_n, node.covered && sigma_n < 0.0)
}

/// Of a node with this lambda_N and lambda_T.
fn nearest<const N: usize>(node: &Node<N>, normal: f64, tangential: Vec3, held: f64, measure: &Measure) -> Violation {
    let gap = node.normal.dot(&node.gap_now) / measure.coverage;
    Covered { gap, slip: Vec3::zeros(), normal, tangential, held, radius: 0.0 }.nearest(measure)
}

impl Law<1> for Frictionless {
    const SLIPS: bool = false;

    fn respond(node: &Node<1>) -> NodeResponse<1> {
        let r = node.augmentation;
        let lambda = node.lambda[0];
        let (gap_normal, sigma_n, closed) = close(node, lambda);
        let on = if closed { 1.0 } else { 0.0 };
        NodeResponse {
            state: if closed { State::Slip } else { State::Gap },
            traction: node.normal * (sigma_n * on),
            row: SVector::from([if closed { gap_normal } else { -lambda / r }]),
            gap_normal,
            slip: Vec3::zeros(),
            sigma: node.normal * sigma_n,
            dp_dlambda: node.normal * on,
            drow_dlambda: SMatrix::from([[(on - 1.0) / r]]),
            drow_dnow: node.normal.transpose() * on,
            drow_dprevious: SMatrix::zeros(),
            drow_darea: SVector::zeros(),
        }
    }

    fn turn(node: &Node<1>) -> Turn<1> {
        let (_, sigma_n, closed) = close(node, node.lambda[0]);
        if !closed {
            return Turn::default();
        }
        let dsigma_n = node.gap_now.transpose();
        let dp_dnormal = Mat3::identity() * sigma_n + node.normal * dsigma_n * node.augmentation;
        Turn { dp_dnormal, drow_dnormal: dsigma_n }
    }

    fn violation(node: &Node<1>, measure: &Measure) -> Violation {
        nearest(node, node.lambda[0], Vec3::zeros(), 0.0, measure)
    }
}

impl Law<3> for Frictionless {
    const SLIPS: bool = false;

    fn respond(node: &Node) -> NodeResponse {
        let r = node.augmentation;
        let lambda_n = node.normal.dot(&(node.free * node.lambda));
        let (gap_normal, sigma_n, closed) = close(node, lambda_n);
        let on = if closed { node.normal * node.normal.transpose() } else { Mat3::zeros() };
        // In the order of Coulomb's law, so that row and traction are the same to the last bit.
        let lambda_t = node.lambda - node.normal * lambda_n;
        NodeResponse {
            state: if closed { State::Slip } else { State::Gap },
            traction: if closed { node.normal * sigma_n } else { Vec3::zeros() },
            row: if closed { node.normal * gap_normal - lambda_t / r } else { -node.lambda / r },
            gap_normal,
            slip: Vec3::zeros(),
            sigma: node.normal * sigma_n,
            dp_dlambda: on,
            drow_dlambda: (on - Mat3::identity()) / r,
            drow_dnow: on,
            drow_dprevious: Mat3::zeros(),
            drow_darea: SVector::zeros(),
        }
    }

    fn turn(node: &Node) -> Turn {
        let (r, lambda) = (node.augmentation, node.free * node.lambda);
        let (_, sigma_n, closed) = close(node, node.normal.dot(&lambda));
        if !closed {
            return Turn::default();
        }
        let dp = Mat3::identity() * sigma_n + node.normal * (lambda + node.gap_now * r).transpose();
        Turn { dp_dnormal: dp, drow_dnormal: dp / r }
    }

    fn violation(node: &Node, measure: &Measure) -> Violation {
        let lambda = node.free * node.lambda;
        let normal = node.normal.dot(&lambda);
        nearest(node, normal, lambda - node.normal * normal, (node.lambda - lambda).norm(), measure)
    }
}
