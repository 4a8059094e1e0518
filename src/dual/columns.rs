//! The rows of a facet's mortar nodes, of all of its pairs together (docs/formulation 10.4). The part
//! -sum_B n_BC D(phi q_B) of Df_C couples all of these nodes with all nodes of the facet, so that the pairs' own parts stand
//! in entries that are there anyway, and are added to them.
//!
//! The columns of a facet are its own nodes, in the first [`MAX_NODES`] places, and then its mortar nodes, each once,
//! in an order that the caller chooses. Its rows are these mortar nodes, four at a time: [`GROUP`].

use crate::mortar::{ForceDerivatives, MORTAR, PAIR_NODES, PairWeights};
use crate::shape::{MAX_CORNERS, MAX_NODES};
use crate::simd::{self, Kernel, Lanes, rolled};

/// Mortar nodes whose rows stand side by side, as lanes.
pub const GROUP: usize = 4;

/// `[j][i][B]`: d (phi q_B)_i / d x_j of a node [F/L^3]. The same with C of a group in place of B: rows of the tangent.
pub type Columns = [[[f64; MAX_CORNERS]; 3]; 3];

/// d (phi q_B)_i / d x_k,j, k over the slots of a pair [F/L^3].
pub type TractionDerivatives = [Columns; PAIR_NODES];

/// A facet's column of a pair's slot; `mortar` holds the places of the pair's mortar nodes among those of the facet.
/// `None`: the pair has no node there.
fn column(slot: usize, nodes: usize, mortar: &[usize]) -> Option<usize> {
    if slot < MORTAR {
        (slot < nodes).then_some(slot)
    } else {
        mortar.get(slot - MORTAR).map(|place| MAX_NODES + place)
    }
}

/// Sums over the pairs of a facet with so many `nodes`, in memory of the caller, who begins with zeros. There are
/// [`MAX_NODES`] columns more than mortar nodes, and as many groups as hold these.
#[derive(Debug)]
pub struct FacetColumns<'a> {
    /// Of the facet.
    pub nodes: usize,
    /// `[group][B][C]`: n_BC [L^2].
    pub weights: &'a mut [[[f64; GROUP]; MAX_CORNERS]],
    /// `[column]`: D(phi q_B).
    pub tractions: &'a mut [Columns],
    /// `[group * columns + column][j][i][C]`: d (f_C)_i / d x_j of the column's node.
    pub rows: &'a mut [Columns],
}

impl FacetColumns<'_> {
    /// Adds n_BC of a pair, whose mortar nodes stand in these places.
    pub fn add_weights(&mut self, weights: &PairWeights, mortar: &[usize]) {
        for (c, &place) in mortar.iter().enumerate() {
            for b in 0..MAX_CORNERS {
                self.weights[place / GROUP][b][place % GROUP] += weights.ac[b][c];
            }
        }
    }

    /// Adds the part of Df_C that belongs to a pair.
    pub fn add_forces(&mut self, forces: &ForceDerivatives, mortar: &[usize]) {
        let columns = self.tractions.len();
        for slot in 0..rolled(PAIR_NODES) {
            let Some(column) = column(slot, self.nodes, mortar) else { continue };
            for (c, &place) in mortar.iter().enumerate() {
                let rows = self.rows[place / GROUP * columns + column].as_flattened_mut();
                for (row, force) in rows.iter_mut().zip(forces.two[slot].as_flattened()) {
                    row[place % GROUP] += force[c % GROUP]; // so that no bounds are checked
                }
            }
        }
    }

    /// Adds the coupling of all pairs.
    pub fn couple(&mut self) {
        for (n, rows) in self.weights.iter().zip(self.rows.chunks_exact_mut(self.tractions.len())) {
            couple(n, self.tractions, rows);
        }
    }
}

/// Adds -sum_B n_BC d(phi q_B) / dx, of weights `n[B][C]`, to the rows of these four nodes C, column by column.
pub fn couple(n: &[[f64; GROUP]; MAX_CORNERS], tractions: &[Columns], rows: &mut [Columns]) {
    simd::dispatch(Couple { n, tractions, rows });
}

struct Couple<'a> {
    n: &'a [[f64; GROUP]; MAX_CORNERS],
    tractions: &'a [Columns],
    rows: &'a mut [Columns],
}

impl Kernel for Couple<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        let n = [L::load(&self.n[0]), L::load(&self.n[1]), L::load(&self.n[2]), L::load(&self.n[3])];
        let rows = self.rows.as_flattened_mut().as_flattened_mut();
        for (row, dq) in rows.iter_mut().zip(self.tractions.as_flattened().as_flattened()) {
            let mut sum = L::load(row);
            for b in 0..MAX_CORNERS {
                sum = n[b].neg_mul_add(L::splat(dq[b]), sum);
            }
            *row = sum.store();
        }
    }
}
