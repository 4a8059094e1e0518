//! The three-node triangle on (0,0), (1,0), (0,1).

use super::cell::{Cell, MAX_NODES, Shape};
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
    products: products(),
    next: [1, 2, 0, 0],
    reversed: [0, 2, 1, 3],
};

const fn products() -> [[[f64; MAX_NODES]; MAX_NODES]; 3] {
    // int N_0^i N_1^j N_2^k = i! j! k! / (i + j + k + 2)!; xi is N_1, eta is N_2.
    let mut p = [[[0.0; MAX_NODES]; MAX_NODES]; 3];
    let mut k = 0;
    while k < 27 {
        let (m, a, b) = (k / 9, k / 3 % 3, k % 3);
        let mut power = [0; 3];
        power[a] += 1;
        power[b] += 1;
        if m > 0 {
            power[m] += 1;
        }
        let factorials = [1.0, 1.0, 2.0, 6.0];
        let above = factorials[power[0]] * factorials[power[1]] * factorials[power[2]];
        p[m][a][b] = above / if m > 0 { 120.0 } else { 24.0 };
        k += 1;
    }
    p
}

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
