//! The integrals that the derivatives of a pair of sub-facets consist of (docs/formulation.md 12.3), contracted with tractions
//! and with positions: those over the overlap from moments, those along edges point by point.

use super::slots::{MORTAR_CORNER, PAIR_CORNERS};
use super::sub_moments::{Batch, SubMoments, Summation, at};
use super::sub_pair::{Four, OnEdge};
use super::sub_polynomials::{Degree, MU, NU, Polynomials, degree_of_nu};
use crate::shape::{MAX_CORNERS, TERMS, monomials};
use crate::simd::Lanes;

/// Derivatives with respect to the projected corners: `[slot][c][monomial]`, lanes i.
pub(super) type Plane<L> = [[[L; TERMS]; 2]; PAIR_CORNERS];

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

/// Integrals with the functions of a map, `[c][s][t]`, lanes over these.
type Products = [[[[f64; 4]; TERMS]; 6]; 2];

/// Where x^a y^b times 1, x, y stands, after where x^a y^b does.
const TIMES: [usize; 3] = [at(0, 0), at(1, 0), at(0, 1)];

/// Both sides, and how many nu_s and mu_t there are.
pub(super) struct Integrals<'a> {
    pub one: &'a Polynomials,
    pub two: &'a Polynomials,
    pub nu: usize,
    pub mu: [usize; 2],
}

/// Integrals of a monomial at `place` with the N_k of a map, from moments of which one has so many columns: column `c`.
#[inline(always)]
fn with_map<L: Lanes>(map: &Polynomials, moments: &[f64], place: usize, columns: usize, c: usize) -> L {
    let mut sum = L::splat(0.0);
    for s in 0..map.n {
        let moment = moments[(place + at(NU[s][0], NU[s][1])) * columns + c];
        sum = L::load(&map.map[s]).mul_add(L::splat(moment), sum);
    }
    sum
}

/// Integrals of N_k d_c (x^a y^b) from those of N_k times monomials over the determinant.
#[inline(always)]
fn slope<L: Lanes>(map: &Polynomials, moments: &[L; 64], [a, b]: [usize; 2], c: usize) -> L {
    let mut sum = L::splat(0.0);
    for m in 0..map.powers {
        if a > 0 {
            sum = moments[at(a - 1, b) + TIMES[m]].mul_add(L::splat(a as f64 * map.slopes[0][c][m]), sum);
        }
        if b > 0 {
            sum = moments[at(a, b - 1) + TIMES[m]].mul_add(L::splat(b as f64 * map.slopes[1][c][m]), sum);
        }
    }
    sum
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
    for k in 0..corners {
        for c in 0..2 {
            let (force, gap) = (&mut forces[first + k][c], &mut gaps[first + k][c]);
            let mut g = [L::splat(0.0); NUS];
            for t in 0..mu {
                for s in 0..NUS {
                    let n = L::splat(products[c][s][t][k & 3]);
                    force[t] = n.mul_add(p[s], force[t]);
                    g[s] = n.mul_add(x[t], g[s]);
                }
            }
            for s in 0..NUS {
                gap[s] = gap[s] + g[s];
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
    pub fn moments<'a, L: Lanes>(&self, batch: &'a mut Batch<L>, moments: &'a mut SubMoments) -> Summation<'a, L> {
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
        let corners = [self.one, self.two].map(|side| if side.powers == 1 { 3 } else { 4 });
        let mut products = [[[[0.0; 4]; TERMS]; 6]; 2];
        self.own::<L>(moments, &mut products);
        self.add(&products, (0, corners[0], self.mu[0]), &p, &x, &mut sums.one, &mut sums.gap);
        self.first::<L>(moments, &mut products);
        self.add(&products, (0, corners[0], self.mu[1]), &fields.p, &fields.x[1], &mut sums.two, &mut sums.gap);
        self.second::<L>(moments, &mut products);
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
    fn own<L: Lanes>(&self, moments: &SubMoments, to: &mut Products) {
        let map = self.one;
        let products = degree_of_nu(self.nu).times(map.of_parent);
        let degree = map.beside_map(products);
        let mut with = [L::splat(0.0); 64];
        for a in 0..=degree.each {
            for b in 0..=degree.beside(a) {
                with[at(a, b)] = with_map(map, &moments.own, at(a, b), 1, 0);
            }
        }
        for c in 0..2 {
            let mut slopes = [[0.0; 4]; 40];
            for a in 0..=products.each {
                for b in 0..=products.beside(a) {
                    slopes[at(a, b)] = slope(map, &with, [a, b], c).store();
                }
            }
            for s in 0..self.nu {
                for t in 0..self.mu[0] {
                    to[c][s][t] = slopes[at(NU[s][0] + MU[t][0], NU[s][1] + MU[t][1])];
                }
            }
        }
    }

    /// int N_k (d_c nu_s) mu2_t.
    #[inline(always)]
    fn first<L: Lanes>(&self, moments: &SubMoments, to: &mut Products) {
        let map = self.one;
        let slopes = match self.of_row_slopes().total {
            0 => 1,
            1 => 3,
            _ => 6,
        };
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
        for t in 0..self.mu[1] {
            let mut with = [L::splat(0.0); 6];
            for r in 0..slopes {
                with[r] = with_map(map, moments.one.as_flattened(), at(NU[r][0], NU[r][1]), 12, t);
            }
            for c in 0..2 {
                for s in 0..self.nu {
                    let mut sum = L::splat(0.0);
                    for r in 0..slopes {
                        sum = with[r].mul_add(L::splat(of[c][s][r]), sum);
                    }
                    to[c][s][t] = sum.store();
                }
            }
        }
    }

    /// int N_l nu_s (d_c mu2_t).
    #[inline(always)]
    fn second<L: Lanes>(&self, moments: &SubMoments, to: &mut Products) {
        let map = self.two;
        let degree = map.beside_map(map.of_parent);
        let mut with = [L::splat(0.0); 64];
        for s in 0..self.nu {
            for a in 0..=degree.each {
                for b in 0..=degree.beside(a) {
                    with[at(a, b)] = with_map(map, moments.two.as_flattened(), at(a, b), 8, s);
                }
            }
            for c in 0..2 {
                for t in 0..self.mu[1] {
                    to[c][s][t] = slope(map, &with, MU[t], c).store();
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
        for s in 0..self.nu {
            let n = nu[s].store();
            for q in 0..4 {
                p[q] = fields.p[s].mul_add(L::splat(n[q]), p[q]);
            }
        }
        for t in 0..self.mu[0] {
            let n = mu[0][t].store();
            for q in 0..4 {
                gap[q] = fields.x[0][t].mul_add(L::splat(n[q]), gap[q]);
            }
        }
        for t in 0..self.mu[1] {
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
    for e in 0..2 {
        let to = &mut to[edge.slots[e] & 7];
        for t in 0..n {
            let w = (ends[e] * f[t]).store();
            let mut sum = v[0] * L::splat(w[0]);
            for q in 1..4 {
                sum = v[q].mul_add(L::splat(w[q]), sum);
            }
            for c in 0..2 {
                to[c][t] = normal[c].mul_add(sum, to[c][t]);
            }
        }
    }
}
