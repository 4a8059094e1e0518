//! The integrals of products with the functions of a sub-facet's map, from moments (docs/formulation 12.3): with nu_s the
//! monomials of the multipliers N_A, mu_t those of N_B or N_C,
//!
//! int N_k d_c (nu_s mu1_t), int N_k (d_c nu_s) mu2_t, int N_l nu_s (d_c mu2_t).

use super::sub_integrals::{Integrals, Products};
use super::sub_moments::{SubMoments, at};
use super::sub_polynomials::{MU, NU, Polynomials, Powers, degree_of_nu};
use crate::shape::TERMS;
use crate::simd::Lanes;

/// Where x^a y^b times 1, x, y stands, after where x^a y^b does.
const TIMES: [usize; 3] = [at(0, 0), at(1, 0), at(0, 1)];

/// Where nu_s and mu_t stand.
const NU_AT: [usize; 6] = places(&NU);
const MU_AT: [usize; TERMS] = places(&MU);

const fn places<const N: usize>(powers: &[Powers; N]) -> [usize; N] {
    let mut of = [0; N];
    let mut n = 0;
    while n < N {
        of[n] = at(powers[n][0], powers[n][1]);
        n += 1;
    }
    of
}

/// Integrals of a function with the N_k of a map of `N` monomials, from those with these.
#[inline(always)]
fn with_map<L: Lanes, const N: usize>(map: &Polynomials, moments: [f64; N]) -> L {
    let mut sum = L::load(&map.map[0]) * L::splat(moments[0]);
    for s in 1..N {
        sum = L::load(&map.map[s]).mul_add(L::splat(moments[s]), sum);
    }
    sum
}

/// Integrals of N_k d_c (x^a y^b), both c, from those of N_k times monomials over the determinant.
#[inline(always)]
fn slopes<L: Lanes, const N: usize>(map: &Polynomials, moments: &[L; 64], [a, b]: Powers) -> [L; 2] {
    let mut sums = [L::splat(0.0); 2];
    let powers = if N == 3 { 1 } else { 3 };
    let (place, x, y) = (at(a, b), L::splat(a as f64), L::splat(b as f64));
    for m in 0..powers {
        if a > 0 {
            let n = moments[(place + TIMES[m] - at(1, 0)) & 63] * x;
            for c in 0..2 {
                sums[c] = n.mul_add(L::splat(map.slopes[0][c][m]), sums[c]);
            }
        }
        if b > 0 {
            let n = moments[(place + TIMES[m] - at(0, 1)) & 63] * y;
            for c in 0..2 {
                sums[c] = n.mul_add(L::splat(map.slopes[1][c][m]), sums[c]);
            }
        }
    }
    sums
}

impl Integrals<'_> {
    /// int N_k d_c (nu_s mu1_t).
    #[inline(always)]
    pub fn own<L: Lanes, const N: usize>(&self, moments: &SubMoments, to: &mut Products) {
        let map = self.one;
        let products = degree_of_nu(self.nu).times(map.of_parent);
        let degree = map.beside_map(products);
        let mut with = [L::splat(0.0); 64];
        for a in 0..degree.each + 1 {
            for b in 0..degree.beside(a) + 1 {
                let mut of = [0.0; N];
                for s in 0..N {
                    of[s] = moments.own[(at(a, b) + NU_AT[s]) & 63];
                }
                with[at(a, b) & 63] = with_map::<L, N>(map, of);
            }
        }
        let mut of = [[[0.0; 4]; 64]; 2];
        for a in 0..products.each + 1 {
            for b in 0..products.beside(a) + 1 {
                let s = slopes::<L, N>(map, &with, [a, b]);
                for c in 0..2 {
                    of[c][at(a, b) & 63] = s[c].store();
                }
            }
        }
        for c in 0..2 {
            for t in 0..self.mu[0].min(TERMS) {
                for s in 0..self.nu.min(6) {
                    to[c][t][s] = of[c][(NU_AT[s] + MU_AT[t]) & 63];
                }
            }
        }
    }

    /// int N_k (d_c nu_s) mu2_t.
    #[inline(always)]
    pub fn first<L: Lanes, const N: usize>(&self, moments: &SubMoments, to: &mut Products) {
        let map = self.one;
        // det J1 d_c nu_s in monomials 1, x, y, xy, x^2, y^2.
        let mut of = [[[0.0; 6]; 6]; 2];
        for c in 0..2 {
            let ([x0, x1, x2], [y0, y1, y2]) = (map.slopes[0][c], map.slopes[1][c]);
            of[c] = [
                [0.0; 6],
                [x0, x1, x2, 0.0, 0.0, 0.0],
                [y0, y1, y2, 0.0, 0.0, 0.0],
                [0.0, y0, x0, x1 + y2, y1, x2],
                [0.0, 2.0 * x0, 0.0, 2.0 * x2, 2.0 * x1, 0.0],
                [0.0, 0.0, 2.0 * y0, 2.0 * y1, 0.0, 2.0 * y2],
            ];
        }
        let monomials = match self.of_row_slopes().total {
            0 => 1,
            1 => 3,
            _ => 6,
        };
        for t in 0..self.mu[1].min(TERMS) {
            let mut with = [L::splat(0.0); 6];
            for r in 0..monomials {
                let mut of = [0.0; N];
                for s in 0..N {
                    of[s] = moments.one[(NU_AT[r] + NU_AT[s]) & 63][t / 4][t % 4];
                }
                with[r] = with_map::<L, N>(map, of);
            }
            for c in 0..2 {
                for s in 1..self.nu.min(6) {
                    let mut sum = L::splat(0.0);
                    for r in 0..monomials {
                        sum = with[r].mul_add(L::splat(of[c][s][r]), sum);
                    }
                    to[c][t][s] = sum.store();
                }
                to[c][t][0] = [0.0; 4];
            }
        }
    }

    /// int N_l nu_s (d_c mu2_t).
    #[inline(always)]
    pub fn second<L: Lanes, const N: usize>(&self, moments: &SubMoments, to: &mut Products) {
        let map = self.two;
        let degree = map.beside_map(map.of_parent);
        let mut with = [L::splat(0.0); 64];
        for s in 0..self.nu.min(6) {
            for a in 0..degree.each + 1 {
                for b in 0..degree.beside(a) + 1 {
                    let mut of = [0.0; N];
                    for m in 0..N {
                        of[m] = moments.two[(at(a, b) + NU_AT[m]) & 63][s / 4][s % 4];
                    }
                    with[at(a, b) & 63] = with_map::<L, N>(map, of);
                }
            }
            for t in 0..self.mu[1].min(TERMS) {
                let of = slopes::<L, N>(map, &with, MU[t]);
                for c in 0..2 {
                    to[c][t][s] = of[c].store();
                }
            }
        }
    }
}
