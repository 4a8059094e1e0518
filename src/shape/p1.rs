//! Linear functions on the triangle.

use super::basis::{Basis, MAX_NODES};
use crate::simd::Real;

/// The three linear functions, 1 at one corner each.
pub struct P1;

impl Basis for P1 {
    const FUNCTIONS: usize = 3;
    const TERMS: usize = 3;
    const COEFFICIENTS: [[f64; MAX_NODES]; 4] =
        [[1.0, 0.0, 0.0, 0.0], [-1.0, 1.0, 0.0, 0.0], [-1.0, 0.0, 1.0, 0.0], [0.0; 4]];
    const MOMENTS: [[f64; 3]; MAX_NODES] = [
        [1.0 / 6.0, 1.0 / 24.0, 1.0 / 24.0],
        [1.0 / 6.0, 1.0 / 12.0, 1.0 / 24.0],
        [1.0 / 6.0, 1.0 / 24.0, 1.0 / 12.0],
        [0.0; 3],
    ];
    const PRODUCTS: [[[f64; MAX_NODES]; MAX_NODES]; 3] = products();

    #[inline(always)]
    fn values<R: Real>(xi: R, eta: R) -> [R; MAX_NODES] {
        [R::splat(1.0) - xi - eta, xi, eta, R::splat(0.0)]
    }

    #[inline(always)]
    fn nodal<R: Real>(m: [R; 4]) -> [R; MAX_NODES] {
        [m[0] - m[1] - m[2], m[1], m[2], R::splat(0.0)]
    }
}

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
