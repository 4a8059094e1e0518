//! The four-node quadrilateral on (-1,-1), (1,-1), (1,1), (-1,1).

use super::{Cell, MAX_NODES, Shape};
use crate::simd::{Lanes, Real};

const Q: f64 = 0.25;
const T: f64 = 1.0 / 3.0;

/// Bilinear quadrilateral.
pub static QUAD4: Shape = Shape {
    n: 4,
    coefficients: [[Q, -Q, -Q, Q], [Q, Q, -Q, -Q], [Q, Q, Q, Q], [Q, -Q, Q, -Q]],
    moments: [[1.0, -T, -T], [1.0, T, -T], [1.0, T, T], [1.0, -T, T]],
    next: [1, 2, 3, 0],
    reversed: [0, 3, 2, 1],
};

/// [`QUAD4`] for the compiler.
pub struct Quad4;

impl Cell for Quad4 {
    const NODES: usize = 4;
    const BILINEAR: bool = true;
    const COEFFICIENTS: [[f64; MAX_NODES]; 4] = [[Q; 4], [-Q, Q, Q, -Q], [-Q, -Q, Q, Q], [Q, -Q, Q, -Q]];

    #[inline(always)]
    fn given<L: Lanes>(v: L, reversed: bool) -> L {
        if reversed { v.swap_1_3() } else { v }
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
