//! The square (-1,-1), (1,-1), (1,1), (-1,1).

use super::cell::{Cell, MAX_CORNERS};
use super::q1::Q1;
use crate::simd::Lanes;

/// A quadrilateral; its map is bilinear.
pub struct Quadrilateral;

impl Cell for Quadrilateral {
    const CORNERS: usize = 4;
    const NEXT: [usize; MAX_CORNERS] = [1, 2, 3, 0];
    const REVERSED: [usize; MAX_CORNERS] = [0, 3, 2, 1];
    type Map = Q1;

    #[inline(always)]
    fn given<L: Lanes>(v: L, reversed: bool) -> L {
        if reversed { v.swap_1_3() } else { v }
    }
}
