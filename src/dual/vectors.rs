//! A facet against an analytic surface (docs/formulation 10.8): one pair, which covers all of the facet at any
//! position, and gaps G_A = int N_A (x - y) da that do not lie along one direction. What 10.2 and 10.4 say of heights holds
//! for each component i of the gaps,
//!
//! H_i = m^-1 G_i,   g_A = m_A H_A,   Dg_A = Dm_A H_A + m_A (m^-1 [DG - Dm H])_A,   Df_B = Dm_B p_B.
//!
//! kappa is 1 and so is phi, without a derivative. The surface has no rows: q is needed for its forces alone.

use super::basis::DualBasis;
use crate::geometry::Vec3;
use crate::mortar::{ForceDerivatives, GapBlocks};
use crate::shape::MAX_CORNERS;

/// A facet of which all is covered, with the vectors from the surface to its nodes.
#[derive(Clone, Debug)]
pub struct WholeFacet<'a> {
    basis: &'a DualBasis,
    /// H_A, by which kernels are to raise the surface: `[i][A]` `[L]`.
    pub heights: [[f64; MAX_CORNERS]; 3],
}

impl<'a> WholeFacet<'a> {
    /// From G_A.
    pub fn new(basis: &'a DualBasis, gaps: &[Vec3; MAX_CORNERS]) -> WholeFacet<'a> {
        debug_assert!(basis.coverage.fade == 1.0 && basis.coverage.slope == 0.0);
        let heights = [0, 1, 2].map(|i| basis.heights(&gaps.map(|g| g[i])));
        WholeFacet { basis, heights }
    }

    /// Makes of a facet's derivatives those of its dual gaps and forces: of Dm_B in each component of `forces` Df_B at
    /// the tractions `p[i][A]`, of [DG - Dm H] Dg_A.
    pub fn share(&self, p: &[[f64; MAX_CORNERS]; 3], forces: &mut ForceDerivatives, gaps: &mut GapBlocks) {
        for (k, i, j) in (0..self.basis.nodes).flat_map(|k| (0..9).map(move |ij| (k, ij / 3, ij % 3))) {
            let force = &mut forces.one[k][j][i];
            gaps[k][i][j] = self.basis.dual(&gaps[k][i][j]);
            for a in 0..MAX_CORNERS {
                gaps[k][i][j][a] += force[a] * self.heights[i][a];
                force[a] *= p[i][a];
            }
        }
    }
}
