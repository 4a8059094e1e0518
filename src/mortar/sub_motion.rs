//! What a pair of sub-facets adds to a tangent (docs/formulation.md 12.3): derivatives of the forces of a field of tractions
//! p = sum_A N_A p_A, and of the gaps of its multipliers, with respect to the sub-facets' nodes. The weights alone are
//! differentiated: nodes that forces and gaps depend on through their own motion are the caller's.

use super::chain::AreaDerivatives;
use super::field::MultiplierSpace;
use super::segment::{NonmortarFrame, Segment};
use super::slots::PAIR_NODES;
use super::sub_pair::{COLUMNS, Side, SubDerivatives, sub_weights};
use crate::geometry::Vec3;
use crate::quadrature::Rule;
use crate::shape::{MAX_CORNERS, MAX_PARENT_NODES};

/// `[k][j][i][B]`: derivatives of components i with respect to component j of the k-th node of the two sub-facets.
type Columns<const LANES: usize> = [[[[f64; LANES]; 3]; 3]; PAIR_NODES];

/// Derivatives of forces and gaps of a pair of sub-facets.
#[derive(Clone, Debug)]
pub struct SubMotion {
    /// Of f_B = sum_A n_AB p_A at the non-mortar parent's nodes [F/L].
    pub one: Columns<COLUMNS>,
    /// Of f_C = -sum_A n_AC p_A at the mortar parent's [F/L].
    pub two: Columns<COLUMNS>,
    /// Of g_A = sum_B n_AB x_B - sum_C n_AC x_C at fixed nodes, rows A [L^2].
    pub gap: Columns<MAX_CORNERS>,
    /// Of the covered areas int N_A da of the rows A [L].
    pub areas: AreaDerivatives,
}

impl Default for SubMotion {
    fn default() -> Self {
        let zero = [[[[0.0; COLUMNS]; 3]; 3]; PAIR_NODES];
        SubMotion {
            one: zero,
            two: zero,
            gap: [[[[0.0; MAX_CORNERS]; 3]; 3]; PAIR_NODES],
            areas: [[[0.0; MAX_CORNERS]; 3]; PAIR_NODES],
        }
    }
}

/// Nodes of both parents, from any point that both have in common `[L]`.
pub type ParentPositions<'a> = (&'a [Vec3; MAX_PARENT_NODES], &'a [Vec3; MAX_PARENT_NODES]);

/// Those of a pair with these tractions, `[i][A]` of the rows A, by a rule of `rule_for`, in place of what was in `to`.
pub fn sub_motion(
    pair: (&NonmortarFrame, &Segment, &Rule),
    sides: (Side, Side),
    space: MultiplierSpace,
    tractions: &[[f64; MAX_CORNERS]; 3],
    (x1, x2): ParentPositions,
    to: &mut SubMotion,
) {
    let mut d = SubDerivatives::default();
    sub_weights(pair, sides, space, Some(&mut d));
    *to = SubMotion::default();
    let (n1, n2, rows) = (sides.0.0.n, sides.1.0.n, space.nodes(sides.0.0, sides.0.1).len());
    for (k, j) in (0..PAIR_NODES).flat_map(|k| (0..3).map(move |j| (k, j))) {
        for a in 0..rows {
            to.areas[k][j][a] = d.ab[a][k][j][..n1].iter().sum();
        }
        for (a, i) in (0..rows).flat_map(|a| (0..3).map(move |i| (a, i))) {
            let p = tractions[i][a];
            for b in 0..n1 {
                to.one[k][j][i][b] += d.ab[a][k][j][b] * p;
                to.gap[k][j][i][a] += d.ab[a][k][j][b] * x1[b][i];
            }
            for c in 0..n2 {
                to.two[k][j][i][c] -= d.ac[a][k][j][c] * p;
                to.gap[k][j][i][a] -= d.ac[a][k][j][c] * x2[c][i];
            }
        }
    }
}
