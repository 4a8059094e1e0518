//! Derivatives of a facet's dual weights themselves, from those of all weights of its pairs (docs/formulation 10.4):
//!
//! Da = (diag(Dm_A) - a Dm) m^-1,   Dn^d_AC = phi (Da n + a Dn)_AC + Dphi (a n)_AC,   Dn^d_AA = D(phi m_A).
//!
//! The tangent needs none of them: they are many, and Da is known by its products with columns of weights alone, which need no
//! inverse. Here they are what it is compared with.

use stickslip::dual::{DualBasis, whole_area_derivative};
use stickslip::geometry::Vec3;
use stickslip::mortar::{MORTAR, NonmortarFrame, PAIR_NODES, PairWeights, WeightDerivatives};
use stickslip::shape::{MAX_CORNERS, MAX_NODES};

/// Derivatives of the dual weights of a facet, in memory of the caller; columns as in `stickslip::dual::FacetColumns`.
pub struct FullDerivatives<'a> {
    basis: &'a DualBasis,
    /// D|e| / Dx_k.
    area: [Vec3; MAX_CORNERS],
    /// The facet's sums n_BC: `[C][B]`.
    weights: &'a [[f64; MAX_CORNERS]],
    /// `[column][j][A]`: d (phi m_A) / dx_j of the column's node `[L]`.
    pub diagonal: &'a mut [[[f64; MAX_CORNERS]; 3]],
    /// `[column * mortar nodes + C][j][A]`: d n^d_AC / dx_j `[L]`.
    pub mortar: &'a mut [[[f64; MAX_CORNERS]; 3]],
}

impl<'a> FullDerivatives<'a> {
    /// Those of no pairs. `weights`: the facet's sums n_BC, lanes B, of each of its mortar nodes.
    pub fn new(
        frame: &NonmortarFrame,
        basis: &'a DualBasis,
        weights: &'a [[f64; MAX_CORNERS]],
        diagonal: &'a mut [[[f64; MAX_CORNERS]; 3]],
        mortar: &'a mut [[[f64; MAX_CORNERS]; 3]],
    ) -> FullDerivatives<'a> {
        debug_assert_eq!(diagonal.len(), MAX_NODES + weights.len());
        debug_assert_eq!(mortar.len(), diagonal.len() * weights.len());
        diagonal.fill([[0.0; MAX_CORNERS]; 3]);
        mortar.fill([[0.0; MAX_CORNERS]; 3]);
        FullDerivatives { basis, area: whole_area_derivative(frame), weights, diagonal, mortar }
    }

    /// Adds a pair's share; `places` are those of its mortar nodes among the facet's.
    pub fn add(&mut self, weights: &PairWeights, derivatives: &WeightDerivatives, places: &[usize]) {
        let of_pair = (0..self.basis.nodes).map(|a| weights.coverage(a)).sum::<f64>() / self.basis.area;
        for (slot, j) in (0..PAIR_NODES).flat_map(|slot| (0..3).map(move |j| (slot, j))) {
            let column = match slot.checked_sub(MORTAR) {
                None => (slot < self.basis.nodes).then_some(slot),
                Some(c) => places.get(c).map(|place| MAX_NODES + place),
            };
            let Some(column) = column else { continue };
            let dm = derivatives.ab.map(|row| row.map(|d| d[slot][j]));
            let areas = dm.map(|row| row.iter().sum());
            let whole = if slot < MORTAR { self.area[slot][j] } else { 0.0 };
            let dphi = self.basis.fade_derivative(&areas, (of_pair, whole));
            for a in 0..MAX_CORNERS {
                self.diagonal[column][j][a] += self.basis.coverage.fade * areas[a] + dphi * self.basis.areas[a];
            }
            self.add_basis(column, j, &dm, &areas, dphi);
            for (c, &place) in places.iter().enumerate() {
                let dn = self.basis.dual(&derivatives.ac.map(|row| row[c][slot][j]));
                let sum = &mut self.mortar[column * self.weights.len() + place][j];
                for a in 0..MAX_CORNERS {
                    sum[a] += dn[a];
                }
            }
        }
    }

    /// Adds phi Da n + Dphi a n, of all mortar nodes of the facet: with x = m^-1 n it is phi (Dm_A x_A - (a Dm x)_A) +
    /// Dphi m_A x_A.
    fn add_basis(
        &mut self,
        column: usize,
        j: usize,
        dm: &[[f64; MAX_NODES]; MAX_CORNERS],
        areas: &[f64; MAX_CORNERS],
        dphi: f64,
    ) {
        let (basis, phi) = (self.basis, self.basis.coverage.fade);
        for (place, n) in self.weights.iter().enumerate() {
            let x = basis.heights(n);
            let turned = basis.dual(&dm.map(|row| (0..MAX_NODES).map(|b| row[b] * x[b]).sum()));
            let sum = &mut self.mortar[column * self.weights.len() + place][j];
            for a in 0..MAX_CORNERS {
                sum[a] += phi * areas[a] * x[a] - turned[a] + dphi * basis.areas[a] * x[a];
            }
        }
    }
}
