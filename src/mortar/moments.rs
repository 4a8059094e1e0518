//! The integrals over an overlap that its weights' derivatives consist of (kernel notes A):
//!
//! Q1[m][k][C] = int (mu1_m / det1) N_k N_C, R[m][k][B] = int (mu1_m / det1) N_k N_B, Q2[m][l][A] = int (mu2_m / det2)
//! N_l N_A,
//!
//! mu = (1, xi, eta) of the facet whose det stands below (of a triangle 1 alone: the others have no coefficient). mu_m
//! N_k has eight monomials, so each is summed over the points as eight integrals per node and expanded once.

use super::points::{Fan, Points, points};
use super::segment::{NonmortarFrame, Segment};
use super::weights::PairWeights;
use crate::quadrature::Rule;
use crate::shape::{Cell, MAX_NODES};
use crate::simd::{Lanes, Stack};

/// 1, xi, eta, xi eta, xi^2, eta^2, xi^2 eta, xi eta^2; of a triangle the first three.
pub(super) const MONOMIALS: usize = 8;
/// Which monomials mu_m (1, xi, eta, xi eta) are.
pub(super) const PRODUCTS: [[usize; 4]; 3] = [[0, 1, 2, 3], [1, 4, 3, 6], [2, 3, 5, 7]];

pub(super) const fn monomials<C: Cell>() -> usize {
    if C::BILINEAR { MONOMIALS } else { 3 }
}

/// How many mu_m have a coefficient.
pub(super) const fn powers<C: Cell>() -> usize {
    if C::BILINEAR { 3 } else { 1 }
}

/// Groups of points summed at once: 8 triangles of 7 points.
const GROUPS: usize = 16;

/// Four points: monomials of both facets with weight / det, and what they are integrated with.
#[derive(Clone, Copy)]
struct Group<L> {
    monomials: [[L; MONOMIALS]; 2],
    n: [[L; MAX_NODES]; 2],
}

/// [m][k], lanes over the third index.
pub(super) type Table<L> = [[L; MAX_NODES]; 3];

/// The integrals, lanes C in the order of the facet as given.
pub(super) struct Moments<L> {
    pub q1: Table<L>,
    pub r: Table<L>,
    pub q2: Table<L>,
}

#[inline(always)]
pub(super) fn powers_of<L: Lanes, C: Cell>(w: L, xi: L, eta: L) -> [L; MONOMIALS] {
    let (x, e) = (w * xi, w * eta);
    if !C::BILINEAR {
        let zero = L::splat(0.0);
        return [w, x, e, zero, zero, zero, zero, zero];
    }
    let xe = x * eta;
    [w, x, e, xe, x * xi, e * eta, xe * xi, xe * eta]
}

/// Integrals of the monomials of facet `FACET` with functions of facet `OTHER`, lanes over these. Two monomials at a
/// time: eight sums are as many as stay in registers.
#[inline(always)]
fn integrals<L: Lanes, const FACET: usize, const OTHER: usize>(
    groups: &[Group<L>],
    monomials: usize,
    functions: usize,
) -> [L; MONOMIALS] {
    let mut whole = [L::splat(0.0); MONOMIALS];
    for j in (0..monomials).step_by(2) {
        let mut s = [[L::splat(0.0); MAX_NODES]; 2];
        for g in groups {
            let m = &g.monomials[FACET];
            for f in 0..functions {
                s[0][f] = m[j].mul_add(g.n[OTHER][f], s[0][f]);
                s[1][f] = m[j + 1].mul_add(g.n[OTHER][f], s[1][f]);
            }
        }
        whole[j] = L::sums(s[0]);
        whole[j + 1] = L::sums(s[1]);
    }
    whole
}

/// Expanded to the nodes of the cell.
#[inline(always)]
pub(super) fn table<L: Lanes, C: Cell>(whole: &[L; MONOMIALS]) -> Table<L> {
    let mut table = [[L::splat(0.0); MAX_NODES]; 3];
    for m in 0..powers::<C>() {
        let [a, b, c, d] = PRODUCTS[m];
        table[m] = C::nodal([whole[a], whole[b], whole[c], whole[d]]);
    }
    table
}

/// sum_k c_k n_k, of the first `n`.
#[inline(always)]
pub(super) fn combine<L: Lanes>(n: &[L; MAX_NODES], c: &[f64; MAX_NODES], nodes: usize) -> L {
    let mut sum = n[0] * L::splat(c[0]);
    for k in 1..nodes {
        sum = n[k].mul_add(L::splat(c[k]), sum);
    }
    sum
}

impl<L: Lanes> Moments<L> {
    #[inline(always)]
    pub fn integrate<One: Cell, Two: Cell>(frame: &NonmortarFrame, segment: &Segment, rule: &Rule) -> Self {
        let mut whole = [[L::splat(0.0); MONOMIALS]; 3];
        let mut stack = Stack::<Group<L>, GROUPS>::new();
        let mut fan = Fan::new(frame, segment);
        let mut triangle = fan.triangle();
        let mut i = 0;
        while let Some(t) = &triangle {
            stack.push(group::<L, One, Two>(&points::<L>(frame, segment, rule, t, i)));
            i += 1;
            if i == rule.triangle_lanes.len() {
                (triangle, i) = (fan.triangle(), 0);
            }
            if stack.is_full() || triangle.is_none() {
                let groups = stack.values();
                let batch = [
                    integrals::<L, 0, 1>(groups, monomials::<One>(), Two::NODES),
                    integrals::<L, 0, 0>(groups, monomials::<One>(), One::NODES),
                    integrals::<L, 1, 0>(groups, monomials::<Two>(), One::NODES),
                ];
                for (sum, new) in whole.as_flattened_mut().iter_mut().zip(batch.as_flattened()) {
                    *sum = *sum + *new;
                }
                stack.clear();
            }
        }
        let [q1, r, q2] = &mut whole;
        for q in q1.iter_mut() {
            *q = Two::given(*q, segment.mortar.is_reversed());
        }
        Moments { q1: table::<L, One>(q1), r: table::<L, One>(r), q2: table::<L, Two>(q2) }
    }

    /// n_AB = sum_m j_m R[m][A][B] and n_AC = sum_m j_m Q1[m][A][C], det1 = j0 + j1 xi + j2 eta.
    #[inline(always)]
    pub fn weights<One: Cell>(&self, determinant: &[f64; 3]) -> PairWeights {
        let (mut ab, mut ac) = ([L::splat(0.0); MAX_NODES], [L::splat(0.0); MAX_NODES]);
        for m in 0..powers::<One>() {
            let j = L::splat(determinant[m]);
            for a in 0..One::NODES {
                ab[a] = j.mul_add(self.r[m][a], ab[a]);
                ac[a] = j.mul_add(self.q1[m][a], ac[a]);
            }
        }
        PairWeights::of_rows(One::NODES, &ab, &ac)
    }
}

/// What is summed of four points.
#[inline(always)]
fn group<L: Lanes, One: Cell, Two: Cell>(p: &Points<L>) -> Group<L> {
    let over = p.weight / (p.one.det * p.two.det);
    let one = powers_of::<L, One>(over * p.two.det, p.one.xi, p.one.eta);
    let two = powers_of::<L, Two>(over * p.one.det, p.two.xi, p.two.eta);
    Group { monomials: [one, two], n: [One::values(p.one.xi, p.one.eta), Two::values(p.two.xi, p.two.eta)] }
}
