//! Functions on a cell: those of its map, of a displacement, of multipliers.

use crate::simd::{Lanes, Real};

/// Most nodes of a facet that have displacements: it bounds the columns B and C of weights, and the functions of a basis.
/// Today a facet's nodes are its corners; what needs that says so with a bound on the kind or an assertion.
pub const MAX_NODES: usize = 4;

/// A basis: functions N_k of (xi, eta), combinations of 1, xi, eta, xi eta.
pub trait Basis {
    /// Number of functions.
    const FUNCTIONS: usize;
    /// How many of 1, xi, eta, xi eta the functions have: 3 or 4.
    const TERMS: usize;
    /// Coefficients of 1, xi, eta, xi eta, each of all functions.
    const COEFFICIENTS: [[f64; MAX_NODES]; 4];
    /// Integrals of N_k, xi N_k and eta N_k over the reference cell.
    const MOMENTS: [[f64; 3]; MAX_NODES];
    /// Integrals of N_k N_l over the reference cell, times 1, xi, eta: `[m][k][l]`.
    const PRODUCTS: [[[f64; MAX_NODES]; MAX_NODES]; 3];

    /// Values N_k(xi, eta).
    fn values<R: Real>(xi: R, eta: R) -> [R; MAX_NODES];

    /// The integrals of f N_k from those of f (1, xi, eta, xi eta).
    fn nodal<R: Real>(monomials: [R; 4]) -> [R; MAX_NODES];

    /// The same from and to lanes.
    #[inline(always)]
    fn nodal_lanes<L: Lanes>(monomials: L) -> L {
        let m = monomials.store();
        let mut sum = L::load(&Self::COEFFICIENTS[0]) * L::splat(m[0]);
        for k in 1..Self::TERMS {
            sum = L::load(&Self::COEFFICIENTS[k]).mul_add(L::splat(m[k]), sum);
        }
        sum
    }
}
