//! A pair of facets of a solid as hosts have them, linear or quadratic (docs/formulation 12.4): its formulas are those of
//! `nodal.rs`.

use super::nodal::{NodalPair, column_force};
use crate::geometry::Vec3;
use crate::mortar::{ParentFacet, ParentWeights};
use crate::shape::MAX_PARENT_NODES;

/// A pair's two facets and how many multipliers it has.
#[derive(Clone, Copy)]
pub struct ParentPair<'a> {
    /// Non-mortar facet.
    pub one: &'a ParentFacet,
    /// Mortar facet.
    pub two: &'a ParentFacet,
    /// Multipliers, at the first nodes of the non-mortar facet.
    pub multipliers: usize,
}

/// sum_A n_A t_A of the k-th column of n_AB or n_AC: its node's share of the tractions `[F]`.
pub fn parent_force(n: &[[f64; MAX_PARENT_NODES]; MAX_PARENT_NODES], traction: &[Vec3], k: usize) -> Vec3 {
    column_force(n, traction, k)
}

impl<'a> ParentPair<'a> {
    /// Its nodes.
    pub fn nodal(&self) -> NodalPair<'a, 3> {
        let (one, two) = (&self.one.x[..self.one.parent.n], &self.two.x[..self.two.parent.n]);
        NodalPair { one, two, multipliers: self.multipliers }
    }

    /// g_A = sum_B n_AB x_B - sum_C n_AC x_C of every multiplier [L^3].
    pub fn gap(&self, w: &ParentWeights) -> [Vec3; MAX_PARENT_NODES] {
        self.nodal().gap([&w.ab, &w.ac])
    }
}
