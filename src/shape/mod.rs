//! What a facet is: its geometry (`cell`), the functions of its fields (`basis`), and which of both a kind has (`kind`).
//!
//! All functions are N_k = c0 + c1 xi + c2 eta + c3 xi eta: those of the triangle have c3 = 0 and a fourth one that
//! vanishes, so that every kernel above is written once with fixed arrays of four.

mod basis;
mod cell;
mod kind;
mod p1;
mod parent;
mod q1;
mod quad4;
mod quadrilateral;
mod table;
mod tri3;
mod triangle;

pub use basis::{Basis, MAX_NODES};
pub use cell::{Cell, MAX_CORNERS};
pub use kind::{CornerMultipliers, FacetKind, Isoparametric, Map, SingleBasis, StandardMultipliers};
pub use p1::P1;
pub use parent::{GROUPS, MAX_PARENT_NODES, Parent, SubFacet, TERMS, cell_corners, monomial_slopes, monomials};
pub use q1::Q1;
pub use quad4::{QUAD4, Quad4};
pub use quadrilateral::Quadrilateral;
pub use table::{Fields, Shape};
pub use tri3::{TRI3, Tri3};
pub use triangle::Triangle;

impl Shape {
    /// The kind with `n` nodes, if there is one.
    pub fn of(n: usize) -> Option<&'static Shape> {
        match n {
            3 => Some(&TRI3),
            4 => Some(&QUAD4),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::{Lanes, Plain};

    const NODES: [(&Shape, &[(f64, f64)]); 2] = [
        (&TRI3, &[(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)]),
        (&QUAD4, &[(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]),
    ];

    #[test]
    fn kronecker_and_partition_of_unity() {
        for (shape, nodes) in NODES {
            for (j, &(xi, eta)) in nodes.iter().enumerate() {
                let n = shape.values(xi, eta);
                for k in 0..MAX_CORNERS {
                    assert_eq!(n[k], if k == j { 1.0 } else { 0.0 });
                }
            }
            let sum: f64 = shape.values(0.3, 0.125).iter().sum();
            assert_eq!(sum, 1.0);
        }
    }

    fn check_functions<B: Basis>(shape: &Shape) {
        let (xi, eta) = (0.3125, 0.125); // exact in every sum
        assert_eq!(B::FUNCTIONS, shape.n);
        assert_eq!(B::values(xi, eta), shape.values(xi, eta));
        assert_eq!(B::nodal([1.0, xi, eta, xi * eta]), shape.values(xi, eta));
        let lanes = B::nodal_lanes(Plain::load(&[1.0, xi, eta, xi * eta])).store();
        assert_eq!(lanes, shape.values(xi, eta));
        assert_eq!(B::TERMS == 4, B::COEFFICIENTS[3] != [0.0; MAX_NODES]);
    }

    fn check_kind<K: SingleBasis>(shape: &Shape) {
        check_functions::<Map<K>>(shape);
        check_functions::<K::Displacement>(shape);
        check_functions::<K::Multiplier>(shape);
        let corners = [0.0, 1.0, 2.0, 3.0];
        assert_eq!(K::Cell::given(Plain::load(&corners), false).store(), corners);
        assert_eq!(K::Cell::given(Plain::load(&corners), true).store(), shape.reversed.map(|k| k as f64));
    }

    #[test]
    fn kinds_are_their_tables() {
        check_kind::<Tri3>(&TRI3);
        check_kind::<Quad4>(&QUAD4);
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
                    assert!((m[i] - shape.fields.moments[k][i]).abs() < 1e-15);
                }
                for a in 0..MAX_CORNERS {
                    let mut products = [0.0; 3];
                    for &(xi, eta, w) in rule {
                        let n = shape.values(xi, eta);
                        for (i, mu) in [1.0, xi, eta].into_iter().enumerate() {
                            products[i] += w * mu * n[a] * n[k];
                        }
                    }
                    for i in 0..3 {
                        assert!((products[i] - shape.fields.products[i][a][k]).abs() < 1e-15);
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
