//! The weighted gap of a pair (paper (11)), g_A = sum_B n_AB x_B - sum_C n_AC x_C [L^3], and its
//! derivative.
//!
//! With the pair's own current weights g_A lies along the plane's normal, g_A = gamma_A e, because both
//! inverse maps return the same in-plane point; so Dg_A = e Dgamma_A + gamma_A De: one scalar row a
//! node, without cancellation of in-plane coordinates (kernel notes A).

use super::derivatives::WeightDerivatives;
use super::segment::NonmortarFrame;
use super::weights::PairWeights;
use super::{MORTAR, PAIR_NODES};
use crate::geometry::{Facet, Mat3, Projection, Vec3};
use crate::shape::MAX_NODES;

/// Weighted gap of the pair's non-mortar nodes with any weights: those of now or those of t_n.
pub fn gap(weights: &PairWeights, one: &Facet, two: &Facet) -> [Vec3; MAX_NODES] {
    // Relative to one node of the pair: legal because sum_B n_AB = sum_C n_AC, and exact under offsets.
    let reference = one.nodes[0];
    let mut g = [Vec3::zeros(); MAX_NODES];
    for a in 0..one.len() {
        for b in 0..one.len() {
            g[a] += (one.nodes[b] - reference) * weights.ab[a][b];
        }
        for c in 0..two.len() {
            g[a] -= (two.nodes[c] - reference) * weights.ac[a][c];
        }
    }
    g
}

/// d g_A / d x_k of a pair, `block[A][k]`, k over the pair's slots [L^2].
#[derive(Clone, Debug)]
pub struct GapDerivative {
    /// One 3 x 3 block per non-mortar node and slot.
    pub block: [[Mat3; PAIR_NODES]; MAX_NODES],
}

impl GapDerivative {
    /// The derivative with weights held fixed: n_AB I and -n_AC I.
    pub fn frozen(weights: &PairWeights) -> GapDerivative {
        let mut block = [[Mat3::zeros(); PAIR_NODES]; MAX_NODES];
        for a in 0..MAX_NODES {
            for k in 0..MAX_NODES {
                block[a][k] = Mat3::from_diagonal_element(weights.ab[a][k]);
                block[a][MORTAR + k] = Mat3::from_diagonal_element(-weights.ac[a][k]);
            }
        }
        GapDerivative { block }
    }

    /// The derivative with the pair's current weights and their derivatives; `two` is the mortar facet
    /// projected on the frame's plane.
    pub fn current(
        frame: &NonmortarFrame,
        two: &Projection,
        weights: &PairWeights,
        derivatives: &WeightDerivatives,
    ) -> GapDerivative {
        let (plane, one) = (&frame.plane, &frame.projection);
        let mut block = [[Mat3::zeros(); PAIR_NODES]; MAX_NODES];
        for a in 0..one.shape.n {
            let mut gamma = 0.0;
            let mut dgamma = [Vec3::zeros(); PAIR_NODES];
            for b in 0..one.shape.n {
                let n = weights.ab[a][b];
                gamma += n * one.d[b];
                dgamma[b] += plane.e * n;
                for k in 0..PAIR_NODES {
                    dgamma[k] += derivatives.ab[a][b][k] * one.d[b];
                }
            }
            for j in 0..two.shape.n {
                let (c, d) = (two.node[j], two.d[j]);
                let n = weights.ac[a][c];
                gamma -= n * d;
                dgamma[MORTAR + c] -= plane.e * n;
                for k in 0..PAIR_NODES {
                    dgamma[k] -= derivatives.ac[a][c][k] * d;
                }
            }
            for k in 0..PAIR_NODES {
                block[a][k] = plane.e * dgamma[k].transpose();
            }
            for c in 0..one.shape.n {
                block[a][c] +=
                    (plane.t1 * plane.tilt[0][c].transpose() + plane.t2 * plane.tilt[1][c].transpose()) * gamma;
            }
        }
        GapDerivative { block }
    }
}
