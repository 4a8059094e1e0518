//! Gap, stick and slip under any threshold k of the tangential traction (paper (17), (22), (24)). The row is written
//! without subtracting lambda from p: stick c = g_N nu + g_T, slip c = g_N nu - (lambda_T - beta sigma_T) / r.

use super::node::{Law, Node, NodeResponse, Turn};
use super::projection::{Projected, State, Threshold, project_parts, safe_norm};
use super::violation::{Covered, Measure, Violation};
use crate::geometry::{Mat3, Vec3};

/// A law that is told by its threshold. Implementing this makes it a [`Law`].
pub trait Cone {
    /// Whether k depends on the slip of the step.
    const FOLLOWS_SLIP: bool = false;

    /// Which tangential tractions stick at a normal traction sigma_N < 0, the node's numbers being given.
    fn threshold(node: &Node, sigma_n: f64) -> Threshold;

    /// dk / dg_T [F/L^5] of a law that follows the slip.
    fn slope(_node: &Node) -> Vec3 {
        Vec3::zeros()
    }
}

/// g_T before it is projected; none where the node was not covered at t_n.
fn unprojected_slip<const N: usize>(node: &Node<N>) -> Vec3 {
    if !node.covered_before {
        return Vec3::zeros();
    }
    let (now, committed) = node.slip.coefficients();
    node.gap_previous - node.gap_now * now - node.gap_committed * committed
}

/// g_T.
fn weighted_slip<const N: usize>(node: &Node<N>) -> Vec3 {
    let slip = unprojected_slip(node);
    node.free * (slip - node.normal * node.normal.dot(&slip))
}

/// What a threshold is asked about.
#[derive(Clone, Copy, Debug)]
pub struct Trial {
    /// sigma_N.
    pub sigma_n: f64,
    /// lambda_N.
    pub lambda_n: f64,
    /// g_T [L^3].
    pub slip: Vec3,
    /// The direction of sigma_T; 0 where there is none.
    pub direction: Vec3,
}

/// Of a node with three multipliers, by which law ever.
pub fn trial<const N: usize>(node: &Node<N>) -> Trial {
    let r = node.augmentation;
    let lambda = node.free * Vec3::from_fn(|i, _| node.lambda.get(i).copied().unwrap_or(0.0));
    let (lambda_n, slip) = (node.normal.dot(&lambda), weighted_slip(node));
    let sigma_t = lambda - node.normal * lambda_n + slip * r;
    let sigma_n = lambda_n + r * node.normal.dot(&node.gap_now);
    Trial { sigma_n, lambda_n, slip, direction: direction_of(sigma_t) }
}

/// sigma_N, sigma_T and what they project to, apart from what is free. lambda: within the free directions.
fn projected<C: Cone>(node: &Node, lambda: Vec3, gap_normal: f64, slip: Vec3) -> (f64, Vec3, Threshold, Projected) {
    let r = node.augmentation;
    let lambda_n = node.normal.dot(&lambda);
    // Part by part, so that sigma_N has no rounding of the slip: with mu = 0 the answer is that without friction.
    let (sigma_n, sigma_t) = (lambda_n + r * gap_normal, lambda - node.normal * lambda_n + slip * r);
    let threshold = C::threshold(node, sigma_n);
    let p = if node.covered { project_parts(sigma_n, sigma_t, node.normal, threshold) } else { Projected::gap() };
    (sigma_n, sigma_t, threshold, p)
}

/// k at a multiplier's lambda_N: that of no pressure under tension, infinite where mu is.
fn radius_at<C: Cone>(node: &Node, lambda_n: f64) -> f64 {
    if node.mu.is_infinite() { f64::INFINITY } else { C::threshold(node, lambda_n.min(0.0)).radius }
}

/// The direction of a vector; 0 of none.
fn direction_of(v: Vec3) -> Vec3 {
    let size = safe_norm(v);
    if size > 0.0 { v / size } else { Vec3::zeros() }
}

/// The part of a vector that is free and along the surface.
fn in_surface(node: &Node, v: Vec3) -> Vec3 {
    let v = node.free * v;
    v - node.normal * node.normal.dot(&v)
}

impl<C: Cone> Law<3> for C {
    const SLIPS: bool = true;

    #[inline(never)] // the table calls it by its address, and other laws may call it, too
    fn respond(node: &Node) -> NodeResponse {
        let r = node.augmentation;
        let (now, _) = node.slip.coefficients();

        let lambda = node.free * node.lambda;
        let gap_normal = node.normal.dot(&node.gap_now);
        let slip = weighted_slip(node);
        let (sigma_n, sigma_t, _, p) = projected::<C>(node, lambda, gap_normal, slip);
        let row = match p.state {
            State::Gap => -node.lambda / r,
            State::Stick => node.normal * gap_normal + slip - (node.lambda - lambda) / r,
            State::Slip => {
                let lambda_t = node.lambda - node.normal * node.normal.dot(&lambda);
                node.normal * gap_normal - (lambda_t - p.tangential) / r
            }
        };

        // With F the free directions and H = dp/dsigma: dsigma/dlambda = F, dsigma/dg = nu nu^T - F (I - nu nu^T) now,
        // dsigma/dg_previous = F (I - nu nu^T); without a history the first term alone.
        let (h, along_normal) = (p.derivative * node.free, node.normal.transpose());
        let normal = (p.derivative * node.normal) * along_normal;
        let mut tangential = if node.covered_before { h - (h * node.normal) * along_normal } else { Mat3::zeros() };
        if C::FOLLOWS_SLIP && p.state == State::Slip && node.covered_before {
            tangential += direction_of(sigma_t) * (in_surface(node, C::slope(node)) / r).transpose();
        }
        NodeResponse {
            state: p.state,
            traction: p.traction,
            row,
            gap_normal,
            slip,
            sigma: node.normal * sigma_n + sigma_t,
            dp_dlambda: h,
            drow_dlambda: (h - Mat3::identity()) / r,
            drow_dnow: normal - tangential * now,
            drow_dprevious: tangential,
            drow_darea: Vec3::zeros(),
        }
    }

    /// With g_t the unprojected slip (of a law that follows it less t (dk/dg_T)^T ((nu.g_t) I + nu g_t^T)), v = lambda + r g_t, w = g - g_t, all within the free directions, and t the direction
    /// of slip: r ((nu.w) I + nu w^T) in stick, and in slip with k and its fall
    /// (nu - fall t) (lambda + r g)^T + sigma_N I - k/|sigma_T| (I - t t^T) ((nu.v) I + nu v^T).
    fn turn(node: &Node) -> Turn {
        let (r, nu, free) = (node.augmentation, node.normal, node.free);
        let (lambda, gap, slip) = (free * node.lambda, free * node.gap_now, free * unprojected_slip(node));
        let (sigma_n, sigma_t, k, p) = projected::<C>(node, lambda, nu.dot(&gap), slip - nu * nu.dot(&slip));
        // D (nu (nu.v)) / D nu.
        let along = |v: Vec3| Mat3::identity() * nu.dot(&v) + nu * v.transpose();
        let dp = match p.state {
            State::Gap => return Turn::default(),
            State::Stick => along(gap - slip) * r,
            State::Slip => {
                let size = safe_norm(sigma_t);
                let (t, beta) = if size > 0.0 { (sigma_t / size, k.radius / size) } else { (Vec3::zeros(), 0.0) };
                let tangential = (Mat3::identity() - t * t.transpose()) * along(lambda + slip * r) * beta;
                let dp = (nu - t * k.fall) * (lambda + gap * r).transpose() + Mat3::identity() * sigma_n - tangential;
                if C::FOLLOWS_SLIP { dp - t * (free * C::slope(node)).transpose() * along(slip) } else { dp }
            }
        };
        Turn { dp_dnormal: dp, drow_dnormal: dp / r }
    }

    #[inline(never)]
    fn violation(node: &Node, measure: &Measure) -> Violation {
        let lambda = node.free * node.lambda;
        let normal = node.normal.dot(&lambda);
        let slip = if node.covered_before { weighted_slip(node) / measure.coverage_previous } else { Vec3::zeros() };
        let node = Covered {
            gap: node.normal.dot(&node.gap_now) / measure.coverage,
            slip,
            normal,
            tangential: lambda - node.normal * normal,
            held: (node.lambda - lambda).norm(),
            radius: radius_at::<C>(node, normal),
        };
        node.nearest(measure)
    }
}
