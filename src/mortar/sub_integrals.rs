//! The integrals that the derivatives of a pair of sub-facets consist of (docs/formulation 12.3), contracted with tractions
//! and with positions: over the overlap from moments (`sub_products.rs`). Those along edges: `sub_edges.rs`.

use super::slots::MORTAR_CORNER;
use super::sub_fields::Fields;
use super::sub_moments::{BATCH, SubMoments, Summation};
use super::sub_polynomials::{Degree, Polynomials, degree_of_nu};
use super::transport::PlaneDerivatives;
use crate::shape::{MAX_CORNERS, TERMS};
use crate::simd::Lanes;

/// Derivatives with respect to the projected corners, monomial by monomial, lanes i.
pub(super) type Plane<L> = [PlaneDerivatives<L>; TERMS];

/// Of forces and gaps.
pub(super) struct Sums<L> {
    pub one: Plane<L>,
    pub two: Plane<L>,
    pub gap: Plane<L>,
}

/// Integrals with the functions of a map, `[c][t][s]`, lanes over these.
pub(super) type Products = [[[[f64; 4]; 6]; TERMS]; 2];

/// Both sides, and how many nu_s and mu_t there are.
pub(super) struct Integrals<'a> {
    pub one: &'a Polynomials,
    pub two: &'a Polynomials,
    pub nu: usize,
    pub mu: [usize; 2],
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
    pub fn of_row_slopes(&self) -> Degree {
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
        if L::SHARED {
            self.add_shared(products, of, p, x, forces, gaps);
        } else {
            self.add_inlined(products, of, p, x, forces, gaps);
        }
    }

    #[inline(never)]
    fn add_shared<L: Lanes>(
        &self,
        products: &Products,
        of: (usize, usize, usize),
        p: &[L; 6],
        x: &[L; TERMS],
        forces: &mut Plane<L>,
        gaps: &mut Plane<L>,
    ) {
        self.add_inlined(products, of, p, x, forces, gaps);
    }

    #[inline(always)]
    fn add_inlined<L: Lanes>(
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
}
