//! Tractions and positions of a pair of sub-facets in monomials of the parents' coordinates (docs/formulation 12.1), the
//! three components in lanes.

use super::field::MultiplierSpace;
use super::sub_polynomials::Polynomials;
use crate::geometry::Vec3;
use crate::shape::{MAX_CORNERS, MAX_PARENT_NODES, Parent, TERMS};
use crate::simd::{Lanes, rolled};

/// Multipliers in monomials.
pub(super) struct Rows {
    /// Coefficients, monomial by monomial, lanes A.
    pub of: [[f64; 4]; 6],
    /// How many monomials nu_s there are.
    pub n: usize,
}

impl Rows {
    /// Of the non-mortar side.
    #[inline(always)]
    pub fn new(space: MultiplierSpace, parent: &Parent, one: &Polynomials) -> Rows {
        if space == MultiplierSpace::Sub {
            return Rows { of: one.map, n: one.n };
        }
        let mut of = [[0.0; 4]; 6];
        for a in 0..MAX_CORNERS {
            for s in 0..4 {
                of[s][a] = parent.cell.coefficients[a][s];
            }
        }
        Rows { of, n: parent.corners() }
    }
}

/// What integrals are contracted with, lanes i.
pub(super) struct Fields<L> {
    /// Of p, in monomials nu_s.
    pub p: [L; 6],
    /// Of the positions of both sides, in monomials mu_t; the fourth number of the first is the field 1.
    pub x: [[L; TERMS]; 2],
}

impl<L: Lanes> Fields<L> {
    /// Positions from a node of the first side: exact under a common offset.
    #[inline(always)]
    pub fn new(
        rows: &Rows,
        parents: [&Parent; 2],
        tractions: &[[f64; MAX_CORNERS]; 3],
        positions: [&[Vec3; MAX_PARENT_NODES]; 2],
    ) -> Self {
        let base = &positions[0][0];
        Fields {
            p: tractions_in_monomials(rows, tractions),
            x: [in_monomials(parents[0], positions[0], base, 1.0), in_monomials(parents[1], positions[1], base, 0.0)],
        }
    }
}

#[inline(always)]
fn tractions_in_monomials<L: Lanes>(rows: &Rows, [x, y, z]: &[[f64; MAX_CORNERS]; 3]) -> [L; 6] {
    let nodal = L::transpose([L::load(x), L::load(y), L::load(z), L::splat(0.0)]);
    let mut p = [L::splat(0.0); 6];
    for s in 0..rows.n {
        for a in 0..MAX_CORNERS {
            p[s] = nodal[a].mul_add(L::splat(rows.of[s][a]), p[s]);
        }
    }
    p
}

/// Coefficients of the monomials, in the lanes of three components, and of the field `constant` in the fourth.
#[inline(always)]
fn in_monomials<L: Lanes>(parent: &Parent, x: &[Vec3; MAX_PARENT_NODES], base: &Vec3, constant: f64) -> [L; TERMS] {
    let mut of = [L::splat(0.0); TERMS];
    of[0] = L::load(&[0.0, 0.0, 0.0, constant]);
    for b in 0..rolled(parent.n) {
        let at = L::load(&[x[b].x - base.x, x[b].y - base.y, x[b].z - base.z, 0.0]);
        for t in 0..rolled(parent.terms) {
            let c = parent.functions[t][b / 4][b % 4];
            if c != 0.0 {
                of[t] = at.mul_add(L::splat(c), of[t]);
            }
        }
    }
    of
}
