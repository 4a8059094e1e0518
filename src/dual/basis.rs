//! The dual basis of a facet and what follows from it for values (docs/formulation 10.1, 10.2):
//!
//! psi_A = sum_B a_AB N_B, a_AB = m_A (m^-1)_AB, which is biorthogonal over the covered part:
//! int psi_A N_B da = m_A where A = B, 0 elsewhere.

use super::coverage::Coverage;
use super::mass::{Mass, SMALLEST_DETERMINANT, too_few};
use super::sums::FacetSums;
use crate::error::Result;
use crate::mortar::PairWeights;
use crate::shape::{MAX_CORNERS, MAX_NODES};

/// The dual basis of one facet, with its measure phi.
#[derive(Clone, Copy, Debug)]
pub struct DualBasis {
    /// Number of the facet's nodes.
    pub nodes: usize,
    /// |e|, the area of the projected facet [L^2].
    pub area: f64,
    /// m_A, the covered area of each node [L^2].
    pub areas: [f64; MAX_CORNERS],
    /// How much of the facet is covered, and phi.
    pub coverage: Coverage,
    mass: Mass,
}

impl DualBasis {
    /// That of a facet's sums; `None` where the facet has faded out and contributes nothing.
    ///
    /// # Errors
    /// [`crate::error::Kind::DegenerateFacet`] when what covers the facet does not determine its multipliers.
    #[inline(never)] // it is met several times
    pub fn of(sums: &FacetSums) -> Result<Option<DualBasis>> {
        let coverage = sums.coverage();
        if !(coverage.fade > 0.0) {
            return Ok(None);
        }
        let mass = Mass::new(sums.nodes, &sums.mass)?;
        if sums.by_points && mass.determinant() <= SMALLEST_DETERMINANT {
            return Err(too_few(mass.determinant()));
        }
        Ok(Some(DualBasis { nodes: sums.nodes, area: sums.area, areas: sums.areas(), coverage, mass }))
    }

    /// phi m_A = n^d_AA: what the nodes have of the facet's area [L^2]. The other n^d_AB vanish.
    pub fn diagonal(&self) -> [f64; MAX_CORNERS] {
        self.areas.map(|m| self.coverage.fade * m)
    }

    /// Dphi = phi' (sum_A Dm_A - kappa D|e|) / |e|: of all pairs, or of one with its share of kappa.
    #[inline]
    pub fn fade_derivative(&self, dm: &[f64; MAX_CORNERS], (share, whole): (f64, f64)) -> f64 {
        self.coverage.slope * (dm.iter().sum::<f64>() - share * whole) / self.area
    }

    /// m^-1 v.
    #[inline(never)] // it is large, and met many times
    pub(super) fn solve(&self, v: &[f64; MAX_CORNERS]) -> [f64; MAX_CORNERS] {
        self.mass.solve(v)
    }

    /// m^-1, column by column.
    pub(super) fn inverse(&self) -> [[f64; MAX_CORNERS]; MAX_CORNERS] {
        self.mass.inverse()
    }

    /// phi sum_B a_AB v_B: of a column n_BC of the facet's weights the dual ones n^d_AC, of gamma_B the gaps of the nodes
    /// along e, phi m_A h_A.
    pub fn dual(&self, v: &[f64; MAX_CORNERS]) -> [f64; MAX_CORNERS] {
        let x = self.solve(v);
        std::array::from_fn(|a| self.coverage.fade * self.areas[a] * x[a])
    }

    /// A pair's share of the dual weights, phi sum_B a_AB times n_BB' and n_BC. Over the facet's pairs those of the
    /// non-mortar side add up to the diagonal. A frozen basis needs no more: gaps, forces and coverage of the pair
    /// follow from them as from its own weights.
    pub fn weights(&self, pair: &PairWeights) -> PairWeights {
        let mut dual = PairWeights::default();
        for k in 0..MAX_NODES {
            let column = |n: &[[f64; MAX_NODES]; MAX_CORNERS]| self.dual(&[n[0][k], n[1][k], n[2][k], n[3][k]]);
            let (ab, ac) = (column(&pair.ab), column(&pair.ac));
            for a in 0..MAX_CORNERS {
                (dual.ab[a][k], dual.ac[a][k]) = (ab[a], ac[a]);
            }
        }
        dual
    }

    /// h = m^-1 gamma: heights of the nodes over the mortar surface, projected on the facet's functions `[L]`.
    pub fn heights(&self, gamma: &[f64; MAX_CORNERS]) -> [f64; MAX_CORNERS] {
        self.solve(gamma)
    }

    /// q with sum_B m_AB q_B = m_A p_A: nodal values in the standard basis of the field sum_A psi_A p_A, component by
    /// component `[i][A]`. The forces of the facet's pairs are those of phi q.
    pub fn tractions(&self, p: &[[f64; MAX_CORNERS]; 3]) -> [[f64; MAX_CORNERS]; 3] {
        let mut q = *p;
        for p in &mut q {
            *p = self.solve(&std::array::from_fn(|a| self.areas[a] * p[a]));
        }
        q
    }

    /// a_AB.
    pub fn coefficients(&self) -> [[f64; MAX_CORNERS]; MAX_CORNERS] {
        let inverse = self.inverse();
        std::array::from_fn(|a| std::array::from_fn(|b| self.areas[a] * inverse[b][a]))
    }

    /// phi a_AB: times n_BC of a pair its share of n^d_AC.
    pub fn faded_coefficients(&self) -> [[f64; MAX_CORNERS]; MAX_CORNERS] {
        self.coefficients().map(|row| row.map(|a| self.coverage.fade * a))
    }
}
