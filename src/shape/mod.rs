//! Shape functions of the facet kinds: N_k = c0 + c1 xi + c2 eta + c3 xi eta.
//!
//! Both kinds share this bilinear form (tri3 has c3 = 0 and a fourth function that vanishes), so that
//! every kernel above is written once with fixed arrays of four.

mod quad4;
mod tri3;

pub use quad4::{QUAD4, Quad4};
pub use tri3::{TRI3, Tri3};

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
    /// The kind with `n` nodes, if there is one.
    pub fn of(n: usize) -> Option<&'static Shape> {
        match n {
            3 => Some(&TRI3),
            4 => Some(&QUAD4),
            _ => None,
        }
    }

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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::Plain;

    const NODES: [(&Shape, &[(f64, f64)]); 2] = [
        (&TRI3, &[(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)]),
        (&QUAD4, &[(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]),
    ];

    #[test]
    fn kronecker_and_partition_of_unity() {
        for (shape, nodes) in NODES {
            for (j, &(xi, eta)) in nodes.iter().enumerate() {
                let n = shape.values(xi, eta);
                for k in 0..MAX_NODES {
                    assert_eq!(n[k], if k == j { 1.0 } else { 0.0 });
                }
            }
            let sum: f64 = shape.values(0.3, 0.125).iter().sum();
            assert_eq!(sum, 1.0);
        }
    }

    fn check_cell<C: Cell>(shape: &Shape) {
        let (xi, eta) = (0.3125, 0.125); // exact in every sum
        assert_eq!(C::NODES, shape.n);
        assert_eq!(C::values(xi, eta), shape.values(xi, eta));
        assert_eq!(C::nodal([1.0, xi, eta, xi * eta]), shape.values(xi, eta));
        let lanes = C::nodal_lanes(Plain::load(&[1.0, xi, eta, xi * eta])).store();
        assert_eq!(lanes, shape.values(xi, eta));
        let nodes = [0.0, 1.0, 2.0, 3.0];
        assert_eq!(C::given(Plain::load(&nodes), false).store(), nodes);
        assert_eq!(C::given(Plain::load(&nodes), true).store(), shape.reversed.map(|k| k as f64));
    }

    #[test]
    fn cells_have_the_shape_functions() {
        check_cell::<Tri3>(&TRI3);
        check_cell::<Quad4>(&QUAD4);
    }

    #[test]
    fn moments_are_the_integrals() {
        // Exact for degree 3: 2 x 2 Gauss on the square, centre and three points on the triangle.
        let g = 1.0 / 3.0_f64.sqrt();
        let square = [(-g, -g, 1.0), (g, -g, 1.0), (g, g, 1.0), (-g, g, 1.0)];
        let (third, w) = (1.0 / 3.0, 25.0 / 96.0);
        let triangle = [(third, third, -27.0 / 96.0), (0.6, 0.2, w), (0.2, 0.6, w), (0.2, 0.2, w)];
        for (shape, rule) in [(&TRI3, &triangle[..]), (&QUAD4, &square[..])] {
            for k in 0..shape.n {
                let mut m = [0.0; 3];
                for &(xi, eta, w) in rule {
                    let n = shape.values(xi, eta)[k];
                    m[0] += w * n;
                    m[1] += w * n * xi;
                    m[2] += w * n * eta;
                }
                for i in 0..3 {
                    assert!((m[i] - shape.moments[k][i]).abs() < 1e-15);
                }
                for a in 0..MAX_NODES {
                    let mut products = [0.0; 3];
                    for &(xi, eta, w) in rule {
                        let n = shape.values(xi, eta);
                        for (i, mu) in [1.0, xi, eta].into_iter().enumerate() {
                            products[i] += w * mu * n[a] * n[k];
                        }
                    }
                    for i in 0..3 {
                        assert!((products[i] - shape.products[i][a][k]).abs() < 1e-15);
                    }
                }
            }
        }
    }

    #[test]
    fn reversed_order_is_a_permutation_that_keeps_the_first_node() {
        for (shape, _) in NODES {
            assert!((0..shape.n).all(|k| shape.next[k] == (k + 1) % shape.n));
            assert_eq!(shape.reversed[0], 0);
            for k in 1..shape.n {
                assert_eq!(shape.reversed[k], shape.n - k);
            }
        }
    }
}
