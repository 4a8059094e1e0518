//! Blocks of up to four by four nodes into the rows of a plan.

use super::table::Target;
use crate::shape::MAX_NODES;
use crate::simd::{Kernel, Lanes};

/// Where the columns of four nodes begin in the rows of four nodes: by row, then by column.
pub type Starts = [[u32; MAX_NODES]; MAX_NODES];

/// There is no such block.
pub const LACKS: u32 = u32::MAX;
/// The block's row or its column has no equation: nothing is to be added.
pub const SKIP: u32 = u32::MAX - 1;

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
        let (mut lacks, mut sum) = (false, L::load(nothing));
        let zero = L::splat(0.0);
        for k in 0..shape.1 {
            let mut by_node = [[[0.0; 4]; R]; MAX_NODES];
            for i in 0..R {
                let (x, y, z) = (L::load(&values[k][0][i]), L::load(&values[k][1][i]), L::load(&values[k][2][i]));
                sum = zero.mul_add(x, zero.mul_add(y, zero.mul_add(z, sum)));
                let nodes = L::transpose([x, y, z, zero]);
                for b in 0..MAX_NODES {
                    by_node[b][i] = nodes[b].store();
                }
            }
            for b in 0..shape.0 {
                let start = starts[b][k];
                if start >= SKIP {
                    lacks |= start == LACKS;
                    continue;
                }
                // The rows of a node are equally long: their parts of this block are as far from each other.
                let Target { rows, piece, start: first } = rows[b];
                let (mut row, len) = (&mut pieces[piece][first + start as usize..], rows.len as usize);
                for i in 0..R {
                    let [x, y, z, _] = by_node[b][i];
                    let part = &mut row[..3];
                    part[0] += x;
                    part[1] += y;
                    part[2] += z;
                    if i + 1 < R {
                        row = &mut row[len..];
                    }
                }
            }
        }
        *nothing = sum.store();
        lacks
    }
}
