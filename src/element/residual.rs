//! A pair's nodal forces in internal-force sign (paper (23), first two rows; docs/formulation 5.1):
//! f_B = sum_A n_AB t_A, f_C = -sum_A n_AC t_A with t the multiplier (multiplier form) or the projected
//! traction (augmented form). The force ON the non-mortar body is -f_B.

use crate::geometry::Vec3;
use crate::mortar::{MORTAR, PAIR_NODES, PairWeights};
use crate::shape::{MAX_CORNERS, MAX_NODES};
use crate::simd::{self, Kernel, Lanes};

/// Forces `[F]` at the pair's slots from the nodal tractions [F/L^2]. Their sum vanishes.
pub fn pair_force(weights: &PairWeights, traction: &[Vec3; MAX_CORNERS]) -> [Vec3; PAIR_NODES] {
    simd::dispatch(Forces { weights, traction })
}

struct Forces<'a> {
    weights: &'a PairWeights,
    traction: &'a [Vec3; MAX_CORNERS],
}

impl Kernel for Forces<'_> {
    type Output = [Vec3; PAIR_NODES];

    #[inline(always)]
    fn run<L: Lanes>(self) -> [Vec3; PAIR_NODES] {
        let Forces { weights, traction } = self;
        let mut f = [Vec3::zeros(); PAIR_NODES];
        for i in 0..3 {
            let (mut one, mut two) = (L::splat(0.0), L::splat(0.0)); // lanes B and C
            for a in 0..MAX_CORNERS {
                let t = L::splat(traction[a][i]);
                one = t.mul_add(L::load(&weights.ab[a]), one);
                two = t.neg_mul_add(L::load(&weights.ac[a]), two);
            }
            let (one, two) = (one.store(), two.store());
            for k in 0..MAX_NODES {
                (f[k][i], f[MORTAR + k][i]) = (one[k], two[k]);
            }
        }
        f
    }
}
