//! What couples the mortar nodes of all pairs of a facet (docs/formulation.md 10.4): the part -sum_B n_BC D(phi q_B) of
//! Df_C. D(phi q_B) depends on all of these nodes, and acts on all of them.
//!
//! The columns of a facet are its own nodes, in the first [`MAX_NODES`] places, and then its mortar nodes, each once,
//! in an order that the caller chooses.

use crate::geometry::Mat3;
use crate::mortar::{MORTAR, PAIR_NODES, PairWeights};
use crate::shape::{MAX_CORNERS, MAX_NODES};

/// `[k][j][i][B]`: d (phi q_B)_i / d x_k,j, k over the slots of a pair [F/L^3].
pub type TractionDerivatives = [[[[f64; MAX_CORNERS]; 3]; 3]; PAIR_NODES];

/// A facet's column of a pair's slot; `mortar` holds the places of the pair's mortar nodes among those of the facet.
/// `None`: the pair has no node there.
pub(super) fn column(slot: usize, nodes: usize, mortar: &[usize]) -> Option<usize> {
    if slot < MORTAR {
        (slot < nodes).then_some(slot)
    } else {
        mortar.get(slot - MORTAR).map(|place| MAX_NODES + place)
    }
}

/// The two factors of the coupling, added up over pairs, in memory of the caller.
#[derive(Debug)]
pub struct FacetColumns<'a> {
    nodes: usize,
    /// n_BC of each mortar node C, lanes B [L^2].
    pub weights: &'a mut [[f64; MAX_CORNERS]],
    /// `[column][j][i][B]`: d (phi q_B)_i / d x_j of the column's node.
    pub tractions: &'a mut [[[[f64; MAX_CORNERS]; 3]; 3]],
}

impl<'a> FacetColumns<'a> {
    /// Those of no pairs: of a facet with so many nodes, as many mortar nodes as there are `weights`, and [`MAX_NODES`]
    /// more `tractions`.
    pub fn new(
        nodes: usize,
        weights: &'a mut [[f64; MAX_CORNERS]],
        tractions: &'a mut [[[[f64; MAX_CORNERS]; 3]; 3]],
    ) -> FacetColumns<'a> {
        debug_assert_eq!(tractions.len(), MAX_NODES + weights.len());
        weights.fill([0.0; MAX_CORNERS]);
        tractions.fill([[[0.0; MAX_CORNERS]; 3]; 3]);
        FacetColumns { nodes, weights, tractions }
    }

    /// Adds n_BC of a pair, whose mortar nodes stand in these places.
    pub fn add_weights(&mut self, weights: &PairWeights, mortar: &[usize]) {
        for (c, &place) in mortar.iter().enumerate() {
            for b in 0..MAX_CORNERS {
                self.weights[place][b] += weights.ac[b][c];
            }
        }
    }

    /// Adds a pair's share of D(phi q).
    pub fn add_tractions(&mut self, pair: &TractionDerivatives, mortar: &[usize]) {
        for (slot, share) in pair.iter().enumerate() {
            let Some(column) = column(slot, self.nodes, mortar) else { continue };
            let sum = self.tractions[column].as_flattened_mut().as_flattened_mut();
            for (sum, share) in sum.iter_mut().zip(share.as_flattened().as_flattened()) {
                *sum += share;
            }
        }
    }

    /// -sum_B n_BC d(phi q_B) / dx: a block of the tangent, with the row of the mortar node in this place and the column
    /// of any node of the facet.
    pub fn coupling(&self, place: usize, column: usize) -> Mat3 {
        coupling(&self.weights[place], &self.tractions[column])
    }
}

/// -sum_B n_BC d(phi q_B) / dx of a mortar node's weights n_BC and the derivatives `[j][i][B]` by one node's x_j.
pub fn coupling(n: &[f64; MAX_CORNERS], dq: &[[[f64; MAX_CORNERS]; 3]; 3]) -> Mat3 {
    Mat3::from_fn(|i, j| -(0..MAX_CORNERS).map(|b| n[b] * dq[j][i][b]).sum::<f64>())
}
