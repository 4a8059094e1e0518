//! The triangle (0,0), (1,0), (0,1).

use super::cell::{Cell, MAX_CORNERS};
use super::p1::P1;
use crate::simd::Lanes;

/// A triangle; its map is affine.
pub struct Triangle;

impl Cell for Triangle {
    const CORNERS: usize = 3;
    const NEXT: [usize; MAX_CORNERS] = [1, 2, 0, 0];
    const REVERSED: [usize; MAX_CORNERS] = [0, 2, 1, 3];
    type Map = P1;

    #[inline(always)]
    fn given<L: Lanes>(v: L, reversed: bool) -> L {
        if reversed { v.swap_1_2() } else { v }
    }
}
