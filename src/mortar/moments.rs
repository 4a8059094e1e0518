//! The integrals over an overlap that its weights' derivatives consist of (kernel notes A):
//!
//! Q1[m][k][C] = int (mu1_m / det1) N_k N_C, R[m][k][B] = int (mu1_m / det1) N_k N_B, Q2[m][l][A] = int (mu2_m / det2) N_l N_A,
//!
//! mu = (1, xi, eta) of the facet whose det stands below (of a triangle 1 alone: the others have no coefficient). mu_m N_k
//! has eight monomials, so each is summed over the points as eight integrals per node and expanded once.

use super::points::{Fan, points};
use super::segment::{NonmortarFrame, Segment};
use crate::quadrature::Rule;
use crate::shape::{Cell, MAX_NODES};
use crate::simd::{Lanes, Stack};

/// 1, xi, eta, xi eta, xi^2, eta^2, xi^2 eta, xi eta^2; of a triangle the first three.
const MONOMIALS: usize = 8;
/// Which monomials mu_m (1, xi, eta, xi eta) are.
const PRODUCTS: [[usize; 4]; 3] = [[0, 1, 2, 3], [1, 4, 3, 6], [2, 3, 5, 7]];

const fn monomials<C: Cell>() -> usize {
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

/// Integrals [1] of the monomials with four functions.
type Sums<L> = [[L; MAX_NODES]; MONOMIALS];

/// [m][k], lanes over the third index.
type Table<L> = [[L; MAX_NODES]; 3];

/// The integrals with a mortar side that moves, lanes C in the order of the facet as given.
pub(super) struct Moments<L> {
    pub q1: Table<L>,
    pub r: Table<L>,
    pub q2: Table<L>,
}

/// Those with a mortar side at rest, with the height v = sum N_C d_C in the place of the mortar nodes.
pub(super) struct RestMoments<L> {
    /// int (mu1_m / det1) N_k v.
    pub q1v: [[f64; MAX_NODES]; 3],
    pub r: Table<L>,
    /// int (mu2_m / det2) v N_A.
    pub q2v: [L; 3],
}

#[inline(always)]
fn powers_of<L: Lanes, C: Cell>(w: L, xi: L, eta: L) -> [L; MONOMIALS] {
    let (x, e) = (w * xi, w * eta);
    if !C::BILINEAR {
        let zero = L::splat(0.0);
        return [w, x, e, zero, zero, zero, zero, zero];
    }
    let xe = x * eta;
    [w, x, e, xe, x * xi, e * eta, xe * xi, xe * eta]
}

/// Adds the groups' monomials of facet `FACET` with `functions` functions of facet `OTHER`.
#[inline(always)]
fn add<L: Lanes, const FACET: usize, const OTHER: usize>(
    sums: &mut Sums<L>,
    groups: &[Group<L>],
    monomials: usize,
    functions: usize,
) {
    for f in 0..functions {
        let mut s = [L::splat(0.0); MONOMIALS];
        for j in 0..monomials {
            s[j] = sums[j][f];
        }
        for g in groups {
            let n = g.n[OTHER][f];
            for j in 0..monomials {
                s[j] = g.monomials[FACET][j].mul_add(n, s[j]);
            }
        }
        for j in 0..monomials {
            sums[j][f] = s[j];
        }
    }
}

/// Sums over the lanes, expanded to the nodes of the cell.
#[inline(always)]
fn table<L: Lanes, C: Cell>(sums: &Sums<L>) -> Table<L> {
    let mut whole = [L::splat(0.0); MONOMIALS];
    for j in 0..monomials::<C>() {
        whole[j] = L::sums(sums[j]);
    }
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

/// Calls `$flush` with groups of points, each made by `$group` from points with weight / det of both facets.
macro_rules! integrate {
    ($frame:ident, $segment:ident, $rule:ident, |$p:ident, $w1:ident, $w2:ident| $group:expr, |$groups:ident| $flush:expr) => {{
        let mut stack = Stack::<Group<L>, GROUPS>::new();
        let mut fan = Fan::new($frame, $segment);
        while let Some(triangle) = fan.triangle() {
            for i in 0..$rule.triangle_lanes.len() {
                if stack.is_full() {
                    let $groups = stack.values();
                    $flush;
                    stack.clear();
                }
                let $p = points::<L>($frame, $segment, $rule, &triangle, i);
                let over = $p.weight / ($p.one.det * $p.two.det);
                let ($w1, $w2) = (over * $p.two.det, over * $p.one.det);
                stack.push($group);
            }
        }
        let $groups = stack.values();
        $flush;
    }};
}

impl<L: Lanes> Moments<L> {
    #[inline(always)]
    pub fn integrate<One: Cell, Two: Cell>(frame: &NonmortarFrame, segment: &Segment, rule: &Rule) -> Self {
        let zero = [[L::splat(0.0); MAX_NODES]; MONOMIALS];
        let (mut q1, mut r, mut q2) = (zero, zero, zero);
        let node = &segment.mortar.node;
        integrate!(
            frame,
            segment,
            rule,
            |p, w1, w2| {
                let n2 = Two::values(p.two.xi, p.two.eta);
                let mut given = n2;
                for c in 0..Two::NODES {
                    given[node[c]] = n2[c];
                }
                let (one, two) =
                    (powers_of::<L, One>(w1, p.one.xi, p.one.eta), powers_of::<L, Two>(w2, p.two.xi, p.two.eta));
                Group { monomials: [one, two], n: [One::values(p.one.xi, p.one.eta), given] }
            },
            |groups| {
                add::<L, 0, 1>(&mut q1, groups, monomials::<One>(), Two::NODES);
                add::<L, 0, 0>(&mut r, groups, monomials::<One>(), One::NODES);
                add::<L, 1, 0>(&mut q2, groups, monomials::<Two>(), One::NODES);
            }
        );
        Moments { q1: table::<L, One>(&q1), r: table::<L, One>(&r), q2: table::<L, Two>(&q2) }
    }
}

impl<L: Lanes> RestMoments<L> {
    #[inline(always)]
    pub fn integrate<One: Cell, Two: Cell>(frame: &NonmortarFrame, segment: &Segment, rule: &Rule) -> Self {
        let zero = [[L::splat(0.0); MAX_NODES]; MONOMIALS];
        let (mut h, mut r, mut q2v) = (zero, zero, zero);
        let d = &segment.mortar.d;
        integrate!(
            frame,
            segment,
            rule,
            |p, w1, w2| {
                let n1 = One::values(p.one.xi, p.one.eta);
                let v = combine(&Two::values(p.two.xi, p.two.eta), d, Two::NODES);
                let mut two = [L::splat(0.0); MONOMIALS];
                two[..3].copy_from_slice(&[w2 * v, w2 * v * p.two.xi, w2 * v * p.two.eta]);
                Group { monomials: [powers_of::<L, One>(w1, p.one.xi, p.one.eta), two], n: [n1, [v; MAX_NODES]] }
            },
            |groups| {
                add::<L, 0, 1>(&mut h, groups, monomials::<One>(), 1);
                add::<L, 0, 0>(&mut r, groups, monomials::<One>(), One::NODES);
                add::<L, 1, 0>(&mut q2v, groups, powers::<Two>(), One::NODES);
            }
        );
        let low = L::sums([h[0][0], h[1][0], h[2][0], h[3][0]]).store();
        let high = L::sums([h[4][0], h[5][0], h[6][0], h[7][0]]).store();
        let whole = [low[0], low[1], low[2], low[3], high[0], high[1], high[2], high[3]];
        let mut q1v = [[0.0; MAX_NODES]; 3];
        for m in 0..powers::<One>() {
            let [a, b, c, d] = PRODUCTS[m];
            q1v[m] = One::nodal([whole[a], whole[b], whole[c], whole[d]]);
        }
        let mut v = [L::splat(0.0); 3];
        for m in 0..powers::<Two>() {
            v[m] = L::sums(q2v[m]);
        }
        RestMoments { q1v, r: table::<L, One>(&r), q2v: v }
    }
}
