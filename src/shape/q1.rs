//! Bilinear functions on the square.

use super::basis::{Basis, MAX_NODES};
use crate::simd::{Lanes, Real};

const Q: f64 = 0.25;
const T: f64 = 1.0 / 3.0;

/// The four bilinear functions, 1 at one corner each.
pub struct Q1;

impl Basis for Q1 {
    const FUNCTIONS: usize = 4;
    const TERMS: usize = 4;
    const COEFFICIENTS: [[f64; MAX_NODES]; 4] = [[Q; 4], [-Q, Q, Q, -Q], [-Q, -Q, Q, Q], [Q, -Q, Q, -Q]];
    const MOMENTS: [[f64; 3]; MAX_NODES] = [[1.0, -T, -T], [1.0, T, -T], [1.0, T, T], [1.0, -T, T]];
    const PRODUCTS: [[[f64; MAX_NODES]; MAX_NODES]; 3] = products();

    #[inline(always)]
    fn nodal_lanes<L: Lanes>(m: L) -> L {
        // The parts of `nodal`: low, low_xi, high, high_xi.
        let parts = L::load(&[-1.0, -1.0, 1.0, 1.0]).mul_add(m.swap_halves(), m);
        let (of_xi, of_others) = (L::load(&[Q, Q, Q, -Q]), L::load(&[-Q, Q, Q, Q]));
        of_xi.mul_add(parts, of_others * parts.swap_neighbours())
    }

    #[inline(always)]
    fn values<R: Real>(xi: R, eta: R) -> [R; MAX_NODES] {
        Self::nodal([R::splat(1.0), xi, eta, xi * eta])
    }

    #[inline(always)]
    fn nodal<R: Real>(m: [R; 4]) -> [R; MAX_NODES] {
        let quarter = R::splat(Q);
        // Times 1 - eta, and the part with xi; times 1 + eta, likewise.
        let (low, low_xi) = ((m[0] - m[2]) * quarter, (m[1] - m[3]) * quarter);
        let (high, high_xi) = ((m[0] + m[2]) * quarter, (m[1] + m[3]) * quarter);
        [low - low_xi, low + low_xi, high + high_xi, high - high_xi]
    }
}

const fn products() -> [[[f64; MAX_NODES]; MAX_NODES]; 3] {
    // Of (1 - x) / 2, (1 + x) / 2 over -1..1, then times x; which of the two a node has in xi and eta.
    let plain = [[2.0 * T, T], [T, 2.0 * T]];
    let with_x = [[-T, 0.0], [0.0, T]];
    let (xi, eta) = ([0, 1, 1, 0], [0, 0, 1, 1]);
    let mut p = [[[0.0; MAX_NODES]; MAX_NODES]; 3];
    let mut k = 0;
    while k < MAX_NODES * MAX_NODES {
        let (a, b) = (k / MAX_NODES, k % MAX_NODES);
        let (x, e) = (plain[xi[a]][xi[b]], plain[eta[a]][eta[b]]);
        p[0][a][b] = x * e;
        p[1][a][b] = with_x[xi[a]][xi[b]] * e;
        p[2][a][b] = x * with_x[eta[a]][eta[b]];
        k += 1;
    }
    p
}
