//! The integrals along edges of which the derivatives of a pair of sub-facets consist (docs/formulation 12.3), point by
//! point: of every monomial times the tractions, or the positions, times the velocity of the edge.

use super::sub_fields::Fields;
use super::sub_integrals::{Integrals, Plane, Sums};
use super::sub_pair::{Four, OnEdge};
use crate::shape::{MAX_CORNERS, TERMS, monomials};
use crate::simd::Lanes;

impl Integrals<'_> {
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
