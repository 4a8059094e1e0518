//! A pair's share of the exact tangent, given the nodal states (paper (29)-(31); docs/formulation 5.3):
//!
//! - force rows: Df_B = sum_A Dn_AB t_A + n_AB Dt_A, Df_C = -sum_A (Dn_AC t_A + n_AC Dt_A);
//!   here Dn t; n itself, for the multiplier columns (Dt = Dlambda in the multiplier form), is the pair's weights
//! - multiplier rows: Dc_A = (dc/dg_now) Dg[n_{n+1}, x_{n+1}] + (dc/dg_previous) Dg[n_n, x_{n+1}]
//!
//! In the multiplier form the whole tangent is the sum of these and the node blocks. A pair that
//! overlapped only at t_n has the last term alone. N: multiplier components of a node. Of a facet with all of its pairs: `facet_rows.rs`.
//!
//! Blocks lie column by column, x_k,j with k over the pair's slots and j its components, as they are computed: in a
//! column the components of the rows' equations, and of each the four nodes of a facet.

use super::facet_rows::{Along, FacetGaps, facet_rows};
use super::response::FacetResponse;
use crate::geometry::Mat3;
use crate::mortar::{AlongNormal, ForceDerivatives, MORTAR, PAIR_NODES, PairWeights};
use crate::shape::MAX_CORNERS;
use nalgebra::SMatrix;

/// `[k][j][n][A]`: d row_A,n / d x_k,j.
pub type RowColumns<const N: usize> = [[[[f64; MAX_CORNERS]; N]; 3]; PAIR_NODES];

/// The current weights of a pair.
pub struct PairNow<'a> {
    /// n_{n+1}.
    pub weights: &'a PairWeights,
    /// Dg[n_{n+1}, x_{n+1}]; `None` where the weights are frozen.
    pub gap: Option<&'a AlongNormal>,
}

/// d row / d x of a pair active now, at t_n, or both, into `rows`: a facet that has no other pair.
pub fn row_columns<const N: usize>(
    (now, previous): (Option<&PairNow>, Option<&PairWeights>),
    nodes: &FacetResponse<N>,
    rows: &mut RowColumns<N>,
) {
    let gap = now.and_then(|now| now.gap);
    let fixed = now.filter(|_| gap.is_none()).map(|now| slots(now.weights));
    let (along, previous) = (gap.map(Along::from), previous.map_or([[0.0; MAX_CORNERS]; PAIR_NODES], slots));
    let gaps = FacetGaps {
        along: along.as_ref(),
        slopes: gap.map_or(&[], |gap| &gap.dgamma),
        blocks: None,
        fixed: fixed.as_ref().map_or(&[], |fixed| fixed),
        previous: &previous,
        raise: None,
        offsets: &[],
        areas: &[],
    };
    facet_rows(gaps, nodes, rows);
}

/// n_AB and - n_AC, slot by slot.
fn slots(n: &PairWeights) -> [[f64; MAX_CORNERS]; PAIR_NODES] {
    std::array::from_fn(|k| std::array::from_fn(|a| if k < MORTAR { n.ab[a][k] } else { -n.ac[a][k - MORTAR] }))
}

/// Tangent blocks of one pair.
#[derive(Clone, Debug)]
pub struct PairTangent<const N: usize = 3> {
    /// d force / d x.
    pub forces: ForceDerivatives,
    /// d row / d x.
    pub rows: RowColumns<N>,
}

impl<const N: usize> Default for PairTangent<N> {
    fn default() -> Self {
        PairTangent { forces: ForceDerivatives::default(), rows: [[[[0.0; MAX_CORNERS]; N]; 3]; PAIR_NODES] }
    }
}

impl<const N: usize> PairTangent<N> {
    /// d force of the node in slot `row` / d x of the node in slot `column`.
    pub fn force_x(&self, row: usize, column: usize) -> Mat3 {
        let (forces, node) = if row < MORTAR { (&self.forces.one, row) } else { (&self.forces.two, row - MORTAR) };
        Mat3::from_fn(|i, j| forces[column][j][i][node])
    }

    /// d row_A / d x of the node in slot `column`.
    pub fn row_x(&self, a: usize, column: usize) -> SMatrix<f64, N, 3> {
        SMatrix::from_fn(|n, j| self.rows[column][j][n][a])
    }
}
