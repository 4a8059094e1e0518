//! The three-node triangle on (0,0), (1,0), (0,1).

use super::{Cell, MAX_NODES, Shape};
use crate::simd::{Lanes, Real};

/// Linear triangle.
pub static TRI3: Shape = Shape {
    n: 3,
    coefficients: [[1.0, -1.0, -1.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0; 4]],
    moments: [
        [1.0 / 6.0, 1.0 / 24.0, 1.0 / 24.0],
        [1.0 / 6.0, 1.0 / 12.0, 1.0 / 24.0],
        [1.0 / 6.0, 1.0 / 24.0, 1.0 / 12.0],
        [0.0; 3],
    ],
    next: [1, 2, 0, 0],
    reversed: [0, 2, 1, 3],
};

/// [`TRI3`] for the compiler.
pub struct Tri3;

impl Cell for Tri3 {
    const NODES: usize = 3;
    const BILINEAR: bool = false;
    const COEFFICIENTS: [[f64; MAX_NODES]; 4] =
        [[1.0, 0.0, 0.0, 0.0], [-1.0, 1.0, 0.0, 0.0], [-1.0, 0.0, 1.0, 0.0], [0.0; 4]];

    #[inline(always)]
    fn given<L: Lanes>(v: L, reversed: bool) -> L {
        if reversed { v.swap_1_2() } else { v }
    }

    #[inline(always)]
    fn values<R: Real>(xi: R, eta: R) -> [R; MAX_NODES] {
        [R::splat(1.0) - xi - eta, xi, eta, R::splat(0.0)]
    }

    #[inline(always)]
    fn nodal<R: Real>(m: [R; 4]) -> [R; MAX_NODES] {
        [m[0] - m[1] - m[2], m[1], m[2], R::splat(0.0)]
    }
}
