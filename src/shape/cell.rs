//! What a facet kind is: a cell that kernels are compiled for, and its shape functions as a table.

use crate::simd::{Lanes, Real};

/// Most nodes a facet can have.
pub const MAX_NODES: usize = 4;

/// A facet kind that a kernel is compiled for.
pub trait Cell {
    /// Number of nodes.
    const NODES: usize;
    /// Whether the shape functions have a term xi eta.
    const BILINEAR: bool;
    /// Coefficients of 1, xi, eta, xi eta, each of all nodes.
    const COEFFICIENTS: [[f64; MAX_NODES]; 4];

    /// Values N_k(xi, eta).
    fn values<R: Real>(xi: R, eta: R) -> [R; MAX_NODES];

    /// The integrals of f N_k from those of f (1, xi, eta, xi eta).
    fn nodal<R: Real>(monomials: [R; 4]) -> [R; MAX_NODES];

    /// The same from and to lanes.
    #[inline(always)]
    fn nodal_lanes<L: Lanes>(monomials: L) -> L {
        let m = monomials.store();
        let mut sum = L::load(&Self::COEFFICIENTS[0]) * L::splat(m[0]);
        for k in 1..if Self::BILINEAR { 4 } else { 3 } {
            sum = L::load(&Self::COEFFICIENTS[k]).mul_add(L::splat(m[k]), sum);
        }
        sum
    }

    /// Lanes in the order of the nodes as given, where a facet's order was reversed.
    fn given<L: Lanes>(v: L, reversed: bool) -> L;
}

/// A facet kind's shape functions on its reference cell.
#[derive(Debug)]
pub struct Shape {
    /// Number of nodes: 3 or 4.
    pub n: usize,
    /// Coefficients of N_k in (1, xi, eta, xi eta), one row a node; rows beyond `n` are zero.
    pub coefficients: [[f64; 4]; MAX_NODES],
    /// Integrals of N_k, xi N_k and eta N_k over the reference cell.
    pub moments: [[f64; 3]; MAX_NODES],
    /// Integrals of N_A N_B, times 1, xi, eta: `[m][A][B]`.
    pub products: [[[f64; MAX_NODES]; MAX_NODES]; 3],
    /// The node after each, around the facet; a table, for a division per step would cost more than all else in a loop.
    pub next: [usize; MAX_NODES],
    /// The node order run through backwards; it maps the cell to itself, so the map stays bilinear.
    pub reversed: [usize; MAX_NODES],
}

impl Shape {
    /// Values N_k(xi, eta).
    #[inline]
    pub fn values(&self, xi: f64, eta: f64) -> [f64; MAX_NODES] {
        let mut n = [0.0; MAX_NODES];
        for k in 0..MAX_NODES {
            let c = &self.coefficients[k];
            n[k] = c[0] + c[1] * xi + c[2] * eta + c[3] * xi * eta;
        }
        n
    }
}
