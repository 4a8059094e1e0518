//! One non-mortar node: gaps and multiplier in, state, projected traction and multiplier row out
//! (stage 2). The row is c = -(lambda - p) / r [L^3] (paper (26), (30), third row), written without
//! subtracting lambda from p: stick c = g_N nu + g_T, slip c = g_N nu - (lambda_T - beta sigma_T) / r.

use super::projection::{Projected, State, project};
use super::slip::SlipMeasure;
use crate::geometry::{Mat3, Vec3};

/// Everything the law needs of one node.
#[derive(Clone, Copy, Debug)]
pub struct Node {
    /// Multiplier: minus the Cauchy traction on the non-mortar body [F/L^2].
    pub lambda: Vec3,
    /// Unit normal into the non-mortar body, of t_n.
    pub normal: Vec3,
    /// Augmentation r_A > 0 [F/L^5].
    pub augmentation: f64,
    /// Coulomb coefficient >= 0.
    pub mu: f64,
    /// g[n_{n+1}, x_{n+1}], assembled over all pairs [L^3].
    pub gap_now: Vec3,
    /// g[n_n, x_{n+1}].
    pub gap_previous: Vec3,
    /// g[n_n, x_n]; only the increment measure reads it.
    pub gap_committed: Vec3,
    /// Whether the node is covered now; an uncovered node is in gap whatever its multiplier.
    pub covered: bool,
    /// Whether it was covered at t_n; if not it has no slip history and g_T = 0.
    pub covered_before: bool,
    /// How slip is measured.
    pub slip: SlipMeasure,
    /// Projector on the directions in which the node is free: I, or I - d d^T - ... for prescribed
    /// directions d. The normal must lie in its range.
    pub free: Mat3,
}

/// The law's answer for one node.
#[derive(Clone, Copy, Debug)]
pub struct NodeResponse {
    /// Gap, stick or slip.
    pub state: State,
    /// Projected traction p [F/L^2].
    pub traction: Vec3,
    /// Multiplier row c [L^3].
    pub row: Vec3,
    /// Normal gap g_N = nu . g [L^3].
    pub gap_normal: f64,
    /// Slip increment g_T [L^3].
    pub slip: Vec3,
    /// Augmented traction sigma [F/L^2].
    pub sigma: Vec3,
    /// dp/dlambda [-].
    pub dp_dlambda: Mat3,
    /// dc/dlambda [L^5/F].
    pub drow_dlambda: Mat3,
    /// dc/dg_now [-]; dp/dg_now is r times this.
    pub drow_dnow: Mat3,
    /// dc/dg_previous [-]; dp/dg_previous is r times this.
    pub drow_dprevious: Mat3,
}

impl Node {
    /// Evaluates the law.
    pub fn respond(&self) -> NodeResponse {
        let r = self.augmentation;
        let nn = self.normal * self.normal.transpose();
        let tangent = self.free * (Mat3::identity() - nn);
        let (now, committed) = self.slip.coefficients();

        let lambda = self.free * self.lambda;
        let gap_normal = self.normal.dot(&self.gap_now);
        let slip = if self.covered_before {
            tangent * (self.gap_previous - self.gap_now * now - self.gap_committed * committed)
        } else {
            Vec3::zeros()
        };
        let gap = self.normal * gap_normal + slip;
        let sigma = lambda + gap * r;
        let p = if self.covered { project(sigma, self.normal, self.mu) } else { Projected::gap() };
        let row = match p.state {
            State::Gap => -self.lambda / r,
            State::Stick => gap - (self.lambda - lambda) / r,
            State::Slip => {
                let lambda_t = self.lambda - self.normal * self.normal.dot(&lambda);
                self.normal * gap_normal - (lambda_t - p.tangential) / r
            }
        };

        let dsigma_dnow = if self.covered_before { nn - tangent * now } else { nn };
        let dsigma_dprevious = if self.covered_before { tangent } else { Mat3::zeros() };
        NodeResponse {
            state: p.state,
            traction: p.traction,
            row,
            gap_normal,
            slip,
            sigma,
            dp_dlambda: p.derivative * self.free,
            drow_dlambda: (p.derivative * self.free - Mat3::identity()) / r,
            drow_dnow: p.derivative * dsigma_dnow,
            drow_dprevious: p.derivative * dsigma_dprevious,
        }
    }
}
