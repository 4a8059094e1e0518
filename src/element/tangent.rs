//! A pair's share of the exact tangent, given the nodal states (paper (29)-(31); formulation a):
//!
//! - force rows: Df_B = sum_A Dn_AB t_A + n_AB Dt_A, Df_C = -sum_A (Dn_AC t_A + n_AC Dt_A);
//!   here Dn t, and n itself for the multiplier columns (Dt = Dlambda in the multiplier form)
//! - multiplier rows: Dc_A = (dc/dg_now) Dg[n_{n+1}, x_{n+1}] + (dc/dg_previous) Dg[n_n, x_{n+1}]
//!
//! In the multiplier form the whole tangent is the sum of these and the node blocks. A pair that
//! overlapped only at t_n has the last term alone. `MOVES`: whether the mortar side has rows and columns; N: multiplier
//! components of a node.

use crate::geometry::{Mat3, Vec3};
use crate::mortar::{GapDerivative, MORTAR, PAIR_NODES, PairWeights, WeightDerivatives, frozen_rows, slots};
use crate::shape::MAX_NODES;
use nalgebra::SMatrix;

/// What a pair must know of a node's response.
#[derive(Clone, Copy, Debug)]
pub struct NodeTangent<const N: usize = 3> {
    /// The traction its forces use [F/L^2].
    pub traction: Vec3,
    /// dc/dg_now times the row scale.
    pub drow_dnow: SMatrix<f64, N, 3>,
    /// dc/dg_previous times the row scale.
    pub drow_dprevious: SMatrix<f64, N, 3>,
}

impl<const N: usize> Default for NodeTangent<N> {
    fn default() -> Self {
        NodeTangent { traction: Vec3::zeros(), drow_dnow: SMatrix::zeros(), drow_dprevious: SMatrix::zeros() }
    }
}

/// The current weights of a pair.
pub struct PairNow<'a> {
    /// n_{n+1}.
    pub weights: &'a PairWeights,
    /// Dn and Dg[n_{n+1}, x_{n+1}]; `None` where the weights are frozen.
    pub motion: Option<(&'a WeightDerivatives, &'a GapDerivative)>,
}

impl PairNow<'_> {
    /// `drow` . Dg_A / Dx_k for every slot k.
    #[inline]
    pub fn gap_rows<const MOVES: bool, const N: usize>(
        &self,
        a: usize,
        drow: &SMatrix<f64, N, 3>,
    ) -> [SMatrix<f64, N, 3>; PAIR_NODES] {
        match self.motion {
            Some((_, gap)) => gap.rows::<MOVES, N>(a, drow),
            None => frozen_rows::<MOVES, N>(self.weights, a, drow),
        }
    }
}

/// Tangent blocks of one pair over its slots.
#[derive(Clone, Debug)]
pub struct PairTangent<const N: usize = 3> {
    /// d force / d x.
    pub force_x: [[Mat3; PAIR_NODES]; PAIR_NODES],
    /// d force / d (traction of A) in the multiplier form: these numbers times I.
    pub force_lambda: [[f64; MAX_NODES]; PAIR_NODES],
    /// d row_A / d x.
    pub row_x: [[SMatrix<f64, N, 3>; PAIR_NODES]; MAX_NODES],
}

impl<const N: usize> Default for PairTangent<N> {
    fn default() -> Self {
        PairTangent {
            force_x: [[Mat3::zeros(); PAIR_NODES]; PAIR_NODES],
            force_lambda: [[0.0; MAX_NODES]; PAIR_NODES],
            row_x: [[SMatrix::zeros(); PAIR_NODES]; MAX_NODES],
        }
    }
}

impl<const N: usize> PairTangent<N> {
    /// The blocks of a pair active now, at t_n, or both.
    pub fn new<const MOVES: bool>(
        now: Option<&PairNow>,
        previous: Option<&PairWeights>,
        nodes: &[NodeTangent<N>; MAX_NODES],
    ) -> PairTangent<N> {
        let mut t = PairTangent::default();
        t.update::<MOVES>(now, previous, nodes);
        t
    }

    /// The same in place. Left as they are: the mortar side's slots where it does not move, and what a pair does not
    /// have: `force_x` with frozen weights, both kinds of force where it is not active now.
    pub fn update<const MOVES: bool>(
        &mut self,
        now: Option<&PairNow>,
        previous: Option<&PairWeights>,
        nodes: &[NodeTangent<N>; MAX_NODES],
    ) {
        for a in 0..MAX_NODES {
            let rows = now.map(|now| now.gap_rows::<MOVES, N>(a, &nodes[a].drow_dnow));
            self.row_x[a] = rows.unwrap_or_else(|| [SMatrix::zeros(); PAIR_NODES]);
            if let Some(weights) = previous {
                let rows = frozen_rows::<MOVES, N>(weights, a, &nodes[a].drow_dprevious);
                for k in 0..slots(MOVES) {
                    self.row_x[a][k] += rows[k];
                }
            }
        }
        if let Some(now) = now {
            self.update_forces::<MOVES>(now, nodes);
        }
    }

    fn update_forces<const MOVES: bool>(&mut self, now: &PairNow, nodes: &[NodeTangent<N>; MAX_NODES]) {
        for a in 0..MAX_NODES {
            for k in 0..MAX_NODES {
                self.force_lambda[k][a] = now.weights.ab[a][k];
                if MOVES {
                    self.force_lambda[MORTAR + k][a] = -now.weights.ac[a][k];
                }
            }
        }
        let Some((dn, _)) = now.motion else { return };
        let sum = |d: &[[[Vec3; PAIR_NODES]; MAX_NODES]; MAX_NODES], b: usize, k: usize| {
            let term = |a: usize| nodes[a].traction * d[a][b][k].transpose();
            term(0) + term(1) + term(2) + term(3)
        };
        for b in 0..MAX_NODES {
            for k in 0..slots(MOVES) {
                self.force_x[b][k] = sum(&dn.ab, b, k);
                if MOVES {
                    self.force_x[MORTAR + b][k] = -sum(&dn.ac, b, k);
                }
            }
        }
    }
}
