//! A pair's nodal forces in internal-force sign (paper (23), first two rows; formulation a):
//! f_B = sum_A n_AB t_A, f_C = -sum_A n_AC t_A with t the multiplier (multiplier form) or the projected
//! traction (augmented form). The force ON the non-mortar body is -f_B.

use crate::geometry::Vec3;
use crate::mortar::{MORTAR, PAIR_NODES, PairWeights};
use crate::shape::MAX_NODES;

/// Forces `[F]` at the pair's slots from the nodal tractions [F/L^2]. Their sum vanishes.
pub fn pair_force(weights: &PairWeights, traction: &[Vec3; MAX_NODES]) -> [Vec3; PAIR_NODES] {
    let mut f = [Vec3::zeros(); PAIR_NODES];
    for a in 0..MAX_NODES {
        for k in 0..MAX_NODES {
            f[k] += traction[a] * weights.ab[a][k];
            f[MORTAR + k] -= traction[a] * weights.ac[a][k];
        }
    }
    f
}
