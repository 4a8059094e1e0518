//! A pair's share of the exact tangent, given the nodal states (paper (25)-(31); formulation a):
//!
//! - force rows: Df_B = sum_A Dn_AB t_A + n_AB Dt_A, Df_C = -sum_A (Dn_AC t_A + n_AC Dt_A);
//!   here Dn t, and n itself for the multiplier columns (Dt = Dlambda in the multiplier form)
//! - multiplier rows: Dc_A = (dc/dg_now) Dg[n_{n+1}, x_{n+1}] + (dc/dg_previous) Dg[n_n, x_{n+1}]
//!
//! In the multiplier form the whole tangent is the sum of these and the node blocks. A pair that
//! overlapped only at t_n has the last term alone.

use crate::geometry::{Mat3, Vec3};
use crate::mortar::{GapDerivative, MORTAR, PAIR_NODES, PairWeights, WeightDerivatives};
use crate::shape::MAX_NODES;

/// What a pair must know of a node's response.
#[derive(Clone, Copy, Debug)]
pub struct NodeTangent {
    /// The traction its forces use [F/L^2].
    pub traction: Vec3,
    /// dc/dg_now times the row scale.
    pub drow_dnow: Mat3,
    /// dc/dg_previous times the row scale.
    pub drow_dprevious: Mat3,
}

impl Default for NodeTangent {
    fn default() -> Self {
        NodeTangent { traction: Vec3::zeros(), drow_dnow: Mat3::zeros(), drow_dprevious: Mat3::zeros() }
    }
}

/// The current weights of a pair and what is needed to differentiate them.
pub struct PairNow<'a> {
    /// n_{n+1}.
    pub weights: &'a PairWeights,
    /// Dn; `None` where the weights are frozen.
    pub derivatives: Option<&'a WeightDerivatives>,
    /// Dg[n_{n+1}, x_{n+1}].
    pub gap: &'a GapDerivative,
}

/// Tangent blocks of one pair over its slots.
#[derive(Clone, Debug)]
pub struct PairTangent {
    /// d force / d x.
    pub force_x: [[Mat3; PAIR_NODES]; PAIR_NODES],
    /// d force / d lambda_A in the multiplier form: these numbers times I.
    pub force_lambda: [[f64; MAX_NODES]; PAIR_NODES],
    /// d row_A / d x.
    pub row_x: [[Mat3; PAIR_NODES]; MAX_NODES],
}

impl Default for PairTangent {
    fn default() -> Self {
        PairTangent {
            force_x: [[Mat3::zeros(); PAIR_NODES]; PAIR_NODES],
            force_lambda: [[0.0; MAX_NODES]; PAIR_NODES],
            row_x: [[Mat3::zeros(); PAIR_NODES]; MAX_NODES],
        }
    }
}

impl PairTangent {
    /// The blocks of a pair active now, at t_n, or both.
    pub fn new(now: Option<&PairNow>, previous: Option<&PairWeights>, nodes: &[NodeTangent; MAX_NODES]) -> PairTangent {
        let mut t = PairTangent::default();
        if let Some(now) = now {
            t.add_now(now, nodes);
        }
        if let Some(weights) = previous {
            for a in 0..MAX_NODES {
                for k in 0..MAX_NODES {
                    t.row_x[a][k] += nodes[a].drow_dprevious * weights.ab[a][k];
                    t.row_x[a][MORTAR + k] -= nodes[a].drow_dprevious * weights.ac[a][k];
                }
            }
        }
        t
    }

    fn add_now(&mut self, now: &PairNow, nodes: &[NodeTangent; MAX_NODES]) {
        for a in 0..MAX_NODES {
            for k in 0..MAX_NODES {
                self.force_lambda[k][a] = now.weights.ab[a][k];
                self.force_lambda[MORTAR + k][a] = -now.weights.ac[a][k];
            }
            for k in 0..PAIR_NODES {
                self.row_x[a][k] = nodes[a].drow_dnow * now.gap.block[a][k];
            }
        }
        let Some(dn) = now.derivatives else { return };
        for a in 0..MAX_NODES {
            let t = nodes[a].traction;
            for b in 0..MAX_NODES {
                for k in 0..PAIR_NODES {
                    self.force_x[b][k] += t * dn.ab[a][b][k].transpose();
                    self.force_x[MORTAR + b][k] -= t * dn.ac[a][b][k].transpose();
                }
            }
        }
    }
}
