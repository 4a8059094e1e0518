//! The weighted gap of a pair (paper (11)), g_A = sum_B n_AB x_B - sum_C n_AC x_C [L^3], and its
//! derivative.
//!
//! With the pair's own current weights g_A lies along the plane's normal, g_A = gamma_A e, because both
//! inverse maps return the same in-plane point; so Dg_A = e Dgamma_A + gamma_A De: one scalar row a
//! node, without cancellation of in-plane coordinates (kernel notes A).

use super::derivatives::WeightDerivatives;
use super::segment::NonmortarFrame;
use super::weights::PairWeights;
use super::{MORTAR, PAIR_NODES, slots};
use crate::geometry::{Facet, Mat3, Projection, Vec3};
use crate::shape::MAX_NODES;
use nalgebra::SMatrix;

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

/// Dg_A of a pair with its current weights.
#[derive(Clone, Debug)]
pub enum GapDerivative {
    /// Of two facets.
    Facets(AlongNormal),
    /// Dg_A / Dx_k of a facet against an analytic surface, which is at rest.
    Blocks([[Mat3; MAX_NODES]; MAX_NODES]),
}

/// Dg_A of two facets in factors: Dg_A = e Dgamma_A + gamma_A De.
#[derive(Clone, Debug)]
pub struct AlongNormal {
    e: Vec3,
    axes: [Vec3; 2],
    tilt: [[Vec3; MAX_NODES]; 2],
    gamma: [f64; MAX_NODES],
    dgamma: [[Vec3; PAIR_NODES]; MAX_NODES],
}

impl GapDerivative {
    /// The derivative with the pair's current weights and their derivatives; `two` is the mortar facet
    /// projected on the frame's plane.
    pub fn current(
        frame: &NonmortarFrame,
        two: &Projection,
        weights: &PairWeights,
        derivatives: &WeightDerivatives,
    ) -> GapDerivative {
        Self::current_for::<true>(frame, two, weights, derivatives)
    }

    /// The same with respect to the non-mortar nodes alone, where the mortar side does not move (`MOVES` false).
    pub fn current_for<const MOVES: bool>(
        frame: &NonmortarFrame,
        two: &Projection,
        weights: &PairWeights,
        derivatives: &WeightDerivatives,
    ) -> GapDerivative {
        let (plane, one) = (&frame.plane, &frame.projection);
        let (mut gamma, mut dgamma) = ([0.0; MAX_NODES], [[Vec3::zeros(); PAIR_NODES]; MAX_NODES]);
        for a in 0..one.shape.n {
            let (gamma, dgamma) = (&mut gamma[a], &mut dgamma[a]);
            for b in 0..one.shape.n {
                let n = weights.ab[a][b];
                *gamma += n * one.d[b];
                dgamma[b] += plane.e * n;
                for k in 0..slots(MOVES) {
                    dgamma[k] += derivatives.ab[a][b][k] * one.d[b];
                }
            }
            for j in 0..two.shape.n {
                let (c, d) = (two.node[j], two.d[j]);
                let n = weights.ac[a][c];
                *gamma -= n * d;
                if MOVES {
                    dgamma[MORTAR + c] -= plane.e * n;
                }
                for k in 0..slots(MOVES) {
                    dgamma[k] -= derivatives.ac[a][c][k] * d;
                }
            }
        }
        GapDerivative::Facets(AlongNormal { e: plane.e, axes: [plane.t1, plane.t2], tilt: plane.tilt, gamma, dgamma })
    }

    /// `drow` . Dg_A / Dx_k for every slot k.
    #[inline]
    pub fn rows<const MOVES: bool, const N: usize>(
        &self,
        a: usize,
        drow: &SMatrix<f64, N, 3>,
    ) -> [SMatrix<f64, N, 3>; PAIR_NODES] {
        match self {
            GapDerivative::Facets(factors) => factors.rows::<MOVES, N>(a, drow),
            GapDerivative::Blocks(blocks) => {
                let mut rows = [SMatrix::zeros(); PAIR_NODES];
                for k in 0..MAX_NODES {
                    rows[k] = drow * blocks[a][k];
                }
                rows
            }
        }
    }
}

impl AlongNormal {
    #[inline]
    fn rows<const MOVES: bool, const N: usize>(
        &self,
        a: usize,
        drow: &SMatrix<f64, N, 3>,
    ) -> [SMatrix<f64, N, 3>; PAIR_NODES] {
        let mut rows = [SMatrix::zeros(); PAIR_NODES];
        let along = drow * self.e;
        for k in 0..slots(MOVES) {
            rows[k] = along * self.dgamma[a][k].transpose();
        }
        let across = self.axes.map(|t| drow * t * self.gamma[a]);
        for c in 0..MAX_NODES {
            rows[c] += across[0] * self.tilt[0][c].transpose() + across[1] * self.tilt[1][c].transpose();
        }
        rows
    }
}

/// `drow` . Dg_A / Dx_k with weights held fixed, for every slot k: n_AB `drow` and -n_AC `drow`.
#[inline]
pub fn frozen_rows<const MOVES: bool, const N: usize>(
    weights: &PairWeights,
    a: usize,
    drow: &SMatrix<f64, N, 3>,
) -> [SMatrix<f64, N, 3>; PAIR_NODES] {
    let mut rows = [SMatrix::zeros(); PAIR_NODES];
    for k in 0..MAX_NODES {
        rows[k] = drow * weights.ab[a][k];
        if MOVES {
            rows[MORTAR + k] = drow * -weights.ac[a][k];
        }
    }
    rows
}
