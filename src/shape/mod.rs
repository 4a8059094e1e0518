//! Shape functions of the facet kinds: N_k = c0 + c1 xi + c2 eta + c3 xi eta.
//!
//! Both kinds share this bilinear form (tri3 has c3 = 0 and a fourth function that vanishes), so that
//! every kernel above is written once with fixed arrays of four.

mod cell;
mod quad4;
mod tri3;

pub use cell::{Cell, MAX_NODES, Shape};
pub use quad4::{QUAD4, Quad4};
pub use tri3::{TRI3, Tri3};

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
