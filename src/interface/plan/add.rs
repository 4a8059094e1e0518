//! Blocks of up to four by four nodes into the rows of a plan.

use super::table::Target;
use crate::shape::MAX_NODES;
use crate::simd::{Kernel, Lanes, add_rows};

/// Where the columns of four nodes begin in the rows of four nodes.
#[derive(Clone, Copy, Debug, Default)]
pub struct Starts {
    /// By row, then by column: an offset, or `skip` where the block's row or its column has no equation and nothing is to be
    /// added, or one more where there is no such block.
    pub at: [[u32; MAX_NODES]; MAX_NODES],
    /// Larger than any offset.
    pub skip: u32,
}

/// Adds the blocks of up to four by four nodes, `[k][j][i][B]`. Gives whether one of them has no place.
pub struct Add<'a, 'p, const R: usize> {
    /// What the rows are in.
    pub pieces: &'a mut [&'p mut [f64]],
    pub rows: &'a [Target; MAX_NODES],
    pub starts: &'a Starts,
    /// Nodes of the rows and of the columns.
    pub shape: (usize, usize),
    pub values: &'a [[[[f64; 4]; R]; 3]],
    pub nothing: &'a mut [f64; 4],
}

impl<const R: usize> Kernel for Add<'_, '_, R> {
    type Output = bool;

    #[inline(always)]
    fn run<L: Lanes>(self) -> bool {
        let Add { pieces, rows, starts, shape, values, nothing } = self;
        let (mut lacks, zero) = (false, L::splat(0.0));
        let mut sums = [L::load(nothing), zero, zero];
        for k in 0..shape.1 {
            // The first two components of nodes 0 and 2, then of nodes 1 and 3.
            let mut pairs = [[[0.0; 4]; 2]; R];
            for i in 0..R {
                let (x, y, z) = (L::load(&values[k][0][i]), L::load(&values[k][1][i]), L::load(&values[k][2][i]));
                sums[i] = zero.mul_add(x, zero.mul_add(y, zero.mul_add(z, sums[i])));
                let [even, odd] = x.pairs(y);
                pairs[i] = [even.store(), odd.store()];
            }
            let last = &values[k][2];
            lacks |= node::<R, 0>(pieces, rows, starts, (shape.0, k), &pairs, last)
                | node::<R, 1>(pieces, rows, starts, (shape.0, k), &pairs, last)
                | node::<R, 2>(pieces, rows, starts, (shape.0, k), &pairs, last)
                | node::<R, 3>(pieces, rows, starts, (shape.0, k), &pairs, last);
        }
        let sum = (sums[0] + sums[1]) + sums[2];
        *nothing = sum.store();
        lacks
    }
}

/// Adds the block of column k of node B, if there is such a node. Gives whether it has no place.
#[inline(always)]
fn node<const R: usize, const B: usize>(
    pieces: &mut [&mut [f64]],
    rows: &[Target; MAX_NODES],
    starts: &Starts,
    (n, k): (usize, usize),
    pairs: &[[[f64; 4]; 2]; R],
    last: &[[f64; 4]; R],
) -> bool {
    let start = starts.at[B][k & 3]; // so that no bounds are checked
    if B >= n || start >= starts.skip {
        return B < n && start > starts.skip;
    }
    let (mut block, first) = ([[0.0; 3]; R], B & 2);
    for i in 0..R {
        let pair = &pairs[i][B & 1];
        block[i] = [pair[first], pair[first + 1], last[i][B]];
    }
    // The rows of a node are equally long: their parts of this block are as far from each other.
    let Target { rows, piece, start: first } = rows[B];
    add_rows(pieces[piece], first + start as usize, rows.len, block);
    false
}
