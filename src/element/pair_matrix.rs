//! The tangent of a pair of quadrilaterals as the matrix that a host assembles: rows and columns x1, x2, lambda, node by node.
//!
//! Its parts lie column by column, of each the four nodes of a facet (`tangent.rs`). Here four columns at a time become parts of
//! four rows, or one column's three components of four nodes become twelve entries one after the other.

use super::tangent::PairTangent;
use crate::mortar::PairWeights;
use crate::shape::MAX_CORNERS;
use crate::simd::{self, Kernel, Lanes};

/// Unknowns of the four nodes of a facet.
const NODES: usize = 3 * MAX_CORNERS;

/// A matrix that lies line by line, its rows or its columns.
pub trait Lines {
    /// Whether lines are columns.
    fn are_columns(&self) -> bool;
    /// Writes four entries of a line from the `at`-th one on.
    fn set(&mut self, line: usize, at: usize, values: [f64; 4]);
}

/// Writes all 36 x 36 entries, those of (lambda, lambda) as zeros. `weights`: those of now, which are the columns lambda of
/// the forces.
pub fn write_pair<T: Lines>(tangent: &PairTangent, weights: &PairWeights, to: &mut T) {
    simd::dispatch(Write { tangent, weights, to });
}

struct Write<'a, T> {
    tangent: &'a PairTangent,
    weights: &'a PairWeights,
    to: &'a mut T,
}

impl<T: Lines> Kernel for Write<'_, T> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Write { tangent, weights, to } = self;
        let columns = to.are_columns();
        for (part, of) in [&tangent.forces.one, &tangent.forces.two, &tangent.rows].into_iter().enumerate() {
            let of = of.as_flattened();
            if columns {
                by_columns(of, NODES * part, to);
            } else {
                by_rows::<L, T>(of, NODES * part, to);
            }
        }
        for k in 0..MAX_CORNERS {
            // Of node k: what the multipliers do to its forces. Of multiplier k: what it does to the forces of all nodes.
            let (mut own, mut other) = ([0.0; MAX_CORNERS], [0.0; MAX_CORNERS]);
            for a in 0..MAX_CORNERS {
                (own[a], other[a]) = match columns {
                    true => (weights.ab[k][a], -weights.ac[k][a]),
                    false => (weights.ab[a][k], -weights.ac[a][k]),
                };
            }
            let multiplier = 2 * NODES + 3 * k;
            if columns {
                diagonals(&own, multiplier, 0, to);
                diagonals(&other, multiplier, NODES, to);
            } else {
                diagonals(&own, 3 * k, 2 * NODES, to);
                diagonals(&other, NODES + 3 * k, 2 * NODES, to);
            }
            diagonals(&[0.0; MAX_CORNERS], multiplier, 2 * NODES, to);
        }
    }
}

/// Twelve rows of 24 columns.
#[inline(always)]
fn by_rows<L: Lanes, T: Lines>(of: &[[[f64; MAX_CORNERS]; 3]], first: usize, to: &mut T) {
    for (q, four) in of.as_chunks::<4>().0.iter().enumerate() {
        for i in 0..3 {
            let rows =
                L::transpose([L::load(&four[0][i]), L::load(&four[1][i]), L::load(&four[2][i]), L::load(&four[3][i])]);
            for k in 0..MAX_CORNERS {
                to.set(first + 3 * k + i, 4 * q, rows[k].store());
            }
        }
    }
}

/// 24 columns of twelve rows.
#[inline(always)]
fn by_columns<T: Lines>(of: &[[[f64; MAX_CORNERS]; 3]], first: usize, to: &mut T) {
    for (column, [x, y, z]) in of.iter().enumerate() {
        to.set(column, first, [x[0], y[0], z[0], x[1]]);
        to.set(column, first + 4, [y[1], z[1], x[2], y[2]]);
        to.set(column, first + 8, [z[2], x[3], y[3], z[3]]);
    }
}

/// `n` on the diagonals of four blocks of three lines.
#[inline(always)]
fn diagonals<T: Lines>(n: &[f64; MAX_CORNERS], line: usize, at: usize, to: &mut T) {
    let [a, b, c, d] = *n;
    let parts = [
        [[a, 0.0, 0.0, b], [0.0, 0.0, c, 0.0], [0.0, d, 0.0, 0.0]],
        [[0.0, a, 0.0, 0.0], [b, 0.0, 0.0, c], [0.0, 0.0, d, 0.0]],
        [[0.0, 0.0, a, 0.0], [0.0, b, 0.0, 0.0], [c, 0.0, 0.0, d]],
    ];
    for i in 0..3 {
        for q in 0..3 {
            to.set(line + i, at + 4 * q, parts[i][q]);
        }
    }
}
