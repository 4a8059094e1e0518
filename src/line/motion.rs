//! Derivatives of the forces and gaps of a pair of lines, from those of its weights (paper (23), (11); docs/formulation 13.3),
//! in the form that a pair of parts of quadratic facets has: with z, where nothing happens.

use super::derivatives::LineDerivatives;
use super::facet::{LineFacet, MAX_LINE_NODES};
use crate::mortar::{MORTAR, SubMotion};
use crate::shape::MAX_CORNERS;

/// Those at fixed tractions, `[i][A]`, into the blocks of `to` between nodes of the two lines: of f_B = sum_A n_AB p_A,
/// f_C = - sum_A n_AC p_A, g_A = sum_B n_AB x_B - sum_C n_AC x_C at fixed nodes, and of the covered area, sum_B n_AB. Other blocks are
/// left as they are, and so are derivatives with respect to z.
pub fn line_motion(
    d: &LineDerivatives,
    (one, two): (&LineFacet, &LineFacet),
    tractions: &[[f64; MAX_CORNERS]; 3],
    to: &mut SubMotion,
) {
    for slot in (0..one.n).chain(MAX_LINE_NODES..MAX_LINE_NODES + two.n) {
        let place = if slot < MAX_LINE_NODES { slot } else { MORTAR + slot - MAX_LINE_NODES };
        for j in 0..2 {
            let column = 2 * slot + j;
            let ab = d.ab.map(|row| row.map(|of| of[column]));
            let ac = d.ac.map(|row| row.map(|of| of[column]));
            for b in 0..MAX_LINE_NODES {
                let force = |n: &[[f64; MAX_LINE_NODES]; MAX_LINE_NODES], i: usize| -> f64 {
                    (0..MAX_LINE_NODES).map(|a| n[a][b] * tractions[i][a]).sum()
                };
                to.one[place][j][b] = [force(&ab, 0), force(&ab, 1), 0.0, 0.0];
                to.two[place][j][b] = [-force(&ac, 0), -force(&ac, 1), 0.0, 0.0];
            }
            for a in 0..MAX_LINE_NODES {
                // Sums of the derivatives of n_AB and of n_AC are the same: a common offset vanishes.
                let gap = |i: usize| -> f64 {
                    let of_one = (0..one.n).map(|b| ab[a][b] * (one.x[b] - one.x[0])[i]).sum::<f64>();
                    of_one - (0..two.n).map(|c| ac[a][c] * (two.x[c] - one.x[0])[i]).sum::<f64>()
                };
                to.gap[place][j][a] = [gap(0), gap(1), 0.0, ab[a].iter().sum()];
            }
        }
    }
}
