//! The integrals that the derivatives of a pair of sub-facets consist of (docs/formulation.md 12.3), contracted with tractions
//! and with positions: those over the overlap from moments, those along edges point by point.

use super::slots::MORTAR_CORNER;
use super::sub_moments::{BATCH, SubMoments, Summation, at};
use super::sub_pair::{Four, OnEdge};
use super::sub_polynomials::{Degree, MU, NU, Polynomials, Powers, degree_of_nu};
use super::transport::PlaneDerivatives;
use crate::shape::{MAX_CORNERS, TERMS, monomials};
use crate::simd::Lanes;

/// Derivatives with respect to the projected corners, monomial by monomial, lanes i.
pub(super) type Plane<L> = [PlaneDerivatives<L>; TERMS];

/// Of forces and gaps.
pub(super) struct Sums<L> {
    pub one: Plane<L>,
    pub two: Plane<L>,
    pub gap: Plane<L>,
}

/// What integrals are contracted with, lanes i.
pub(super) struct Fields<L> {
    /// Of p, in monomials nu_s.
    pub p: [L; 6],
    /// Of the positions of both sides, in monomials mu_t; the fourth number of the first is the field 1.
    pub x: [[L; TERMS]; 2],
}

/// Integrals with the functions of a map, `[c][t][s]`, lanes over these.
type Products = [[[[f64; 4]; 6]; TERMS]; 2];

/// Where x^a y^b times 1, x, y stands, after where x^a y^b does.
const TIMES: [usize; 3] = [at(0, 0), at(1, 0), at(0, 1)];

/// Both sides, and how many nu_s and mu_t there are.
pub(super) struct Integrals<'a> {
    pub one: &'a Polynomials,
    pub two: &'a Polynomials,
    pub nu: usize,
    pub mu: [usize; 2],
}

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

/// Contracts integrals of the corners from slot `first` on.
#[inline(always)]
fn contract<L: Lanes, const NUS: usize>(
    products: &Products,
    (first, corners, mu): (usize, usize, usize),
    p: &[L; 6],
    x: &[L; TERMS],
    forces: &mut Plane<L>,
    gaps: &mut Plane<L>,
) {
    for k in 0..corners.min(MAX_CORNERS) {
        for c in 0..2 {
            let mut g = [L::splat(0.0); NUS];
            for t in 0..mu.min(TERMS) {
                let mut force = forces[t][first + k][c];
                for s in 0..NUS {
                    let n = L::splat(products[c][t][s][k]);
                    force = n.mul_add(p[s], force);
                    g[s] = n.mul_add(x[t], g[s]);
                }
                forces[t][first + k][c] = force;
            }
            for s in 0..NUS {
                gaps[s][first + k][c] = gaps[s][first + k][c] + g[s];
            }
        }
    }
}

impl Integrals<'_> {
    /// Degree of det J1 times the gradients of nu_s. Of bilinear functions along the axes only a linear part is left.
    #[inline(always)]
    fn of_row_slopes(&self) -> Degree {
        if self.one.n == 4 { Degree { total: 1, each: 1 } } else { self.one.beside_map(degree_of_nu(self.nu)) }
    }

    /// The moments that are needed.
    #[inline(always)]
    pub fn moments<'a, L: Lanes>(&self, batch: &'a mut [[L; BATCH]], moments: &'a mut SubMoments) -> Summation<'a, L> {
        let (one, two) = (self.one, self.two);
        let own = one.beside_map(degree_of_nu(self.nu).times(one.of_parent));
        let degrees = [
            one.of_map.times(own),
            one.of_map.times(self.of_row_slopes()),
            two.of_map.times(two.beside_map(two.of_parent)),
        ];
        Summation::new(degrees, [self.nu, self.mu[1]], batch, moments)
    }

    /// Adds what is over the overlap.
    #[inline(always)]
    pub fn contract<L: Lanes>(&self, moments: &SubMoments, fields: &Fields<L>, sums: &mut Sums<L>) {
        let (mut p, mut x) = (fields.p, fields.x[0]);
        for s in 0..6 {
            p[s] = -p[s];
        }
        for t in 0..TERMS {
            x[t] = -x[t];
        }
        let corners = [self.one.n.min(4), self.two.n.min(4)];
        let mut products = [[[[0.0; 4]; 6]; TERMS]; 2];
        match self.one.n {
            3 => self.own::<L, 3>(moments, &mut products),
            4 => self.own::<L, 4>(moments, &mut products),
            _ => self.own::<L, 6>(moments, &mut products),
        }
        self.add(&products, (0, corners[0], self.mu[0]), &p, &x, &mut sums.one, &mut sums.gap);
        match self.one.n {
            3 => self.first::<L, 3>(moments, &mut products),
            4 => self.first::<L, 4>(moments, &mut products),
            _ => self.first::<L, 6>(moments, &mut products),
        }
        self.add(&products, (0, corners[0], self.mu[1]), &fields.p, &fields.x[1], &mut sums.two, &mut sums.gap);
        match self.two.n {
            3 => self.second::<L, 3>(moments, &mut products),
            4 => self.second::<L, 4>(moments, &mut products),
            _ => self.second::<L, 6>(moments, &mut products),
        }
        let first = MORTAR_CORNER;
        self.add(&products, (first, corners[1], self.mu[1]), &fields.p, &fields.x[1], &mut sums.two, &mut sums.gap);
    }

    #[inline(always)]
    fn add<L: Lanes>(
        &self,
        products: &Products,
        of: (usize, usize, usize),
        p: &[L; 6],
        x: &[L; TERMS],
        forces: &mut Plane<L>,
        gaps: &mut Plane<L>,
    ) {
        match self.nu {
            3 => contract::<L, 3>(products, of, p, x, forces, gaps),
            4 => contract::<L, 4>(products, of, p, x, forces, gaps),
            _ => contract::<L, 6>(products, of, p, x, forces, gaps),
        }
    }

    /// int N_k d_c (nu_s mu1_t).
    #[inline(always)]
    fn own<L: Lanes, const N: usize>(&self, moments: &SubMoments, to: &mut Products) {
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
    fn first<L: Lanes, const N: usize>(&self, moments: &SubMoments, to: &mut Products) {
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
    fn second<L: Lanes, const N: usize>(&self, moments: &SubMoments, to: &mut Products) {
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

    /// Adds four points of an edge.
    #[inline(always)]
    pub fn add_edge<L: Lanes>(&self, four: &Four<L>, edge: &OnEdge, fields: &Fields<L>, sums: &mut Sums<L>) {
        let [x1, y1] = self.one.coordinates.of_four([four.one[0], four.one[1]]);
        let [x2, y2] = self.two.coordinates.of_four([four.two[0], four.two[1]]);
        let (mut nu, mu) = ([L::splat(1.0); TERMS], [monomials(x1, y1), monomials(x2, y2)]);
        (nu[1], nu[2], nu[3], nu[4], nu[5]) = (x1, y1, x1 * y1, x1 * x1, y1 * y1);
        let zero = L::splat(0.0);
        let (mut p, mut minus_p, mut gap) = ([zero; MAX_CORNERS], [zero; MAX_CORNERS], [zero; MAX_CORNERS]);
        for s in 0..self.nu.min(6) {
            let n = nu[s].store();
            for q in 0..4 {
                p[q] = fields.p[s].mul_add(L::splat(n[q]), p[q]);
            }
        }
        for t in 0..self.mu[0].min(TERMS) {
            let n = mu[0][t].store();
            for q in 0..4 {
                gap[q] = fields.x[0][t].mul_add(L::splat(n[q]), gap[q]);
            }
        }
        for t in 0..self.mu[1].min(TERMS) {
            let n = mu[1][t].store();
            for q in 0..4 {
                gap[q] = fields.x[1][t].neg_mul_add(L::splat(n[q]), gap[q]);
            }
        }
        for q in 0..4 {
            minus_p[q] = -p[q];
        }
        let ends = [four.weight * L::load(&edge.ends[0]), four.weight * L::load(&edge.ends[1])];
        add(edge, &ends, &mu[0], self.mu[0], &p, &mut sums.one);
        add(edge, &ends, &mu[1], self.mu[1], &minus_p, &mut sums.two);
        add(edge, &ends, &nu, self.nu, &gap, &mut sums.gap);
    }
}

/// Adds int f v (v_e . n) ds of the first `n` functions f, the values v at four points in lanes i.
#[inline(always)]
fn add<L: Lanes>(edge: &OnEdge, ends: &[L; 2], f: &[L; TERMS], n: usize, v: &[L; 4], to: &mut Plane<L>) {
    let normal = [L::splat(edge.normal[0]), L::splat(edge.normal[1])];
    for t in 0..n.min(TERMS) {
        for e in 0..2 {
            let (w, to) = ((ends[e] * f[t]).store(), &mut to[t][edge.slots[e] & 7]);
            let mut sum = v[0] * L::splat(w[0]);
            for q in 1..4 {
                sum = v[q].mul_add(L::splat(w[q]), sum);
            }
            for c in 0..2 {
                to[c] = normal[c].mul_add(sum, to[c]);
            }
        }
    }
}
