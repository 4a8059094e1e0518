//! Derivatives with respect to the projected vertices, in transport form (formulation c.5, kernel notes A): of the
//! forces of a field p = sum_A N_A p_A on the non-mortar facet,
//!
//! f_B = int p N_B da, f_C = -int p N_C da,
//!
//! which with p = N_A are the weights themselves, and of the gaps gamma_A = int N_A (sum N_B d_B - sum N_C d_C) da at
//! fixed heights d, whose first part is the force of the field of heights. Of every such integral of f1 f2, functions
//! of the two facets,
//!
//! D int f1 f2 = -int (grad f1 . v1) f2 + f1 (grad f2 . v2) da + sum_edges int f1 f2 (v . n) ds,
//!
//! v1 = sum N_k Dy1_k, v2 = sum N_l Dy2_l, v the velocity of the facet that owns the edge. No vertex
//! of the overlap is differentiated: that would lose a digit for every digit of a small crossing angle. Where the mortar
//! side is at rest: `at_rest`.

use super::edges::Edges;
use super::moments::{Moments, combine, powers};
use super::segment::{NonmortarFrame, Segment};
use super::{MORTAR, PAIR_NODES};
use crate::geometry::Vec2;
use crate::quadrature::Rule;
use crate::shape::{Cell, MAX_NODES};
use crate::simd::{Lanes, Stack};

/// d/dy of four numbers in the lanes: per slot k the two components of y_k, mortar slots in the order of the
/// projection.
pub(super) type PlaneDerivatives<L> = [[L; 2]; PAIR_NODES];

/// A pair whose derivatives follow from its integrals by contraction.
pub(super) struct Transport<'a, L> {
    segment: &'a Segment,
    integrals: &'a Integrals<L>,
    /// det J grad N of both facets in powers (1, xi, eta), lanes over the nodes, of the mortar facet as given.
    gradients: [[[L; 2]; 3]; 2],
    /// det2 grad v in the same powers.
    slope: [[f64; 2]; 3],
}

/// What is integrated of a pair.
pub(super) struct Integrals<L> {
    pub moments: Moments<L>,
    /// int (mu1_m / det1) N_k v, v = sum N_C d_C.
    q1v: [[f64; MAX_NODES]; 3],
    edges: Edges<L>,
}

impl<L: Lanes> Integrals<L> {
    #[inline(always)]
    pub fn new<One: Cell, Two: Cell>(frame: &NonmortarFrame, segment: &Segment, rule: &Rule) -> Self {
        if L::SHARED {
            Self::shared::<One, Two>(frame, segment, rule)
        } else {
            Self::inlined::<One, Two>(frame, segment, rule)
        }
    }

    #[inline(never)]
    fn shared<One: Cell, Two: Cell>(frame: &NonmortarFrame, segment: &Segment, rule: &Rule) -> Self {
        Self::inlined::<One, Two>(frame, segment, rule)
    }

    #[inline(always)]
    fn inlined<One: Cell, Two: Cell>(frame: &NonmortarFrame, segment: &Segment, rule: &Rule) -> Self {
        let two = &segment.mortar;
        let moments = Moments::integrate::<One, Two>(frame, segment, rule);
        let v = Two::given(L::load(&two.d), two.is_reversed());
        let mut q1v = [[0.0; MAX_NODES]; 3];
        for m in 0..powers::<One>() {
            let q = &moments.q1[m];
            q1v[m] = L::sums([q[0] * v, q[1] * v, q[2] * v, q[3] * v]).store();
        }
        let mut integrals = Integrals { moments, q1v, edges: Edges { nonmortar: Stack::new(), mortar: Stack::new() } };
        integrals.edges.integrate::<One, Two>(frame, segment, rule);
        integrals
    }
}

impl<'a, L: Lanes> Transport<'a, L> {
    #[inline(always)]
    pub fn new<Two: Cell>(frame: &NonmortarFrame, segment: &'a Segment, integrals: &'a Integrals<L>) -> Self {
        let two = &segment.mortar;
        let mut gradients = [frame.map.gradients::<L>(), segment.mortar_map.gradients::<L>()];
        let slope = dots(&gradients[1], L::load(&two.d));
        for m in 0..powers::<Two>() {
            for c in 0..2 {
                gradients[1][m][c] = Two::given(gradients[1][m][c], two.is_reversed());
            }
        }
        Transport { segment, integrals, gradients, slope }
    }

    /// Of the forces f_B of the field with the nodal values `p`, lanes B.
    #[inline(always)]
    pub fn one<One: Cell>(&self, p: &[f64; MAX_NODES]) -> PlaneDerivatives<L> {
        if L::SHARED { self.one_shared::<One>(p) } else { self.one_inlined::<One>(p) }
    }

    #[inline(never)]
    fn one_shared<One: Cell>(&self, p: &[f64; MAX_NODES]) -> PlaneDerivatives<L> {
        self.one_inlined::<One>(p)
    }

    #[inline(always)]
    fn one_inlined<One: Cell>(&self, p: &[f64; MAX_NODES]) -> PlaneDerivatives<L> {
        let mut d = [[L::splat(0.0); 2]; PAIR_NODES];
        let [g, _] = &self.gradients;
        let slope = dots(g, L::load(p));
        for m in 0..powers::<One>() {
            let r = &self.integrals.moments.r[m];
            let rp = combine(r, p, One::NODES).store(); // r is symmetric in k and B
            for k in 0..One::NODES {
                for c in 0..2 {
                    let v = L::splat(slope[m][c]).mul_add(r[k], g[m][c] * L::splat(rp[k]));
                    d[k][c] = d[k][c] - v;
                }
            }
        }
        for edge in self.integrals.edges.nonmortar.values() {
            let [from, to] = edge.ends;
            let (p0, p1, s) = (p[from], p[to], &edge.cubic);
            let products = [p0 * s[0] + p1 * s[1], p0 * s[1] + p1 * s[2], p0 * s[2] + p1 * s[3]];
            add_ends(&mut d, edge.ends, edge.normal, &products, &edge.units);
        }
        for edge in self.integrals.edges.mortar.values() {
            let n = [combine(&edge.nonmortar[0], p, One::NODES), combine(&edge.nonmortar[1], p, One::NODES)];
            add_mortar(&mut d, edge.ends, edge.normal, n);
        }
        d
    }

    /// Of the forces f_C of the same field, lanes C.
    #[inline(always)]
    pub fn two<One: Cell, Two: Cell>(&self, p: &[f64; MAX_NODES]) -> PlaneDerivatives<L> {
        if L::SHARED { self.two_shared::<One, Two>(p) } else { self.two_inlined::<One, Two>(p) }
    }

    #[inline(never)]
    fn two_shared<One: Cell, Two: Cell>(&self, p: &[f64; MAX_NODES]) -> PlaneDerivatives<L> {
        self.two_inlined::<One, Two>(p)
    }

    #[inline(always)]
    fn two_inlined<One: Cell, Two: Cell>(&self, p: &[f64; MAX_NODES]) -> PlaneDerivatives<L> {
        let mut d = [[L::splat(0.0); 2]; PAIR_NODES];
        let lanes = L::load(p);
        let [g1, g2] = &self.gradients;
        let slope = dots(g1, lanes);
        for m in 0..powers::<One>() {
            for k in 0..One::NODES {
                for c in 0..2 {
                    d[k][c] = L::splat(slope[m][c]).mul_add(self.integrals.moments.q1[m][k], d[k][c]);
                }
            }
        }
        for m in 0..powers::<Two>() {
            let q = &self.integrals.moments.q2[m];
            let qp = L::sums([q[0] * lanes, q[1] * lanes, q[2] * lanes, q[3] * lanes]).store();
            for l in 0..Two::NODES {
                for c in 0..2 {
                    d[MORTAR + l][c] = g2[m][c].mul_add(L::splat(qp[l]), d[MORTAR + l][c]);
                }
            }
        }
        for edge in self.integrals.edges.nonmortar.values() {
            let [from, to] = edge.ends;
            let (p0, p1, n) = (L::splat(p[from]), L::splat(p[to]), &edge.mortar);
            add(&mut d[from], -edge.normal, p0.mul_add(n[0], p1 * n[1]));
            add(&mut d[to], -edge.normal, p0.mul_add(n[1], p1 * n[2]));
        }
        for edge in self.integrals.edges.mortar.values() {
            let [from, to] = edge.ends;
            let n = &edge.own;
            let s = L::sums([n[0] * lanes, n[1] * lanes, n[2] * lanes, L::splat(0.0)]).store();
            add_ends(&mut d, [MORTAR + from, MORTAR + to], -edge.normal, &[s[0], s[1], s[2]], &edge.units);
        }
        d
    }

    /// Of the gaps gamma_A at fixed heights, lanes A; `heights` are those of the non-mortar nodes.
    #[inline(always)]
    pub fn gap<One: Cell, Two: Cell>(&self, heights: &[f64; MAX_NODES]) -> PlaneDerivatives<L> {
        let mut d = self.one::<One>(heights);
        // -int N_A v: the field of the mortar heights.
        let [g, _] = &self.gradients;
        for m in 0..powers::<One>() {
            for k in 0..One::NODES {
                for c in 0..2 {
                    d[k][c] = g[m][c].mul_add(L::splat(self.integrals.q1v[m][k]), d[k][c]);
                }
            }
        }
        for m in 0..powers::<Two>() {
            for c in 0..2 {
                let h = L::splat(self.slope[m][c]);
                for l in 0..Two::NODES {
                    d[MORTAR + l][c] = h.mul_add(self.integrals.moments.q2[m][l], d[MORTAR + l][c]);
                }
            }
        }
        for edge in self.integrals.edges.nonmortar.values() {
            add_ends(&mut d, edge.ends, -edge.normal, &edge.height, &edge.units);
        }
        let v = &self.segment.mortar.d;
        for edge in self.integrals.edges.mortar.values() {
            let (v0, v1, n) = (L::splat(v[edge.ends[0]]), L::splat(v[edge.ends[1]]), &edge.own);
            let n = [v0.mul_add(n[0], v1 * n[1]), v0.mul_add(n[1], v1 * n[2])];
            add_mortar(&mut d, edge.ends, -edge.normal, n);
        }
        d
    }
}

/// Adds what a mortar edge's two ends contribute.
#[inline(always)]
fn add_mortar<L: Lanes>(d: &mut PlaneDerivatives<L>, ends: [usize; 2], normal: Vec2, n: [L; 2]) {
    add(&mut d[MORTAR + ends[0]], normal, n[0]);
    add(&mut d[MORTAR + ends[1]], normal, n[1]);
}

/// `sum` + n `v`, component by component.
#[inline(always)]
fn add<L: Lanes>(sum: &mut [L; 2], n: Vec2, v: L) {
    *sum = [L::splat(n.x).mul_add(v, sum[0]), L::splat(n.y).mul_add(v, sum[1])];
}

/// Adds n times the products 00, 01, 11 of an edge's ends, in the slots and in the lanes (`units`) of the two.
#[inline(always)]
pub(super) fn add_ends<L: Lanes, const SLOTS: usize>(
    d: &mut [[L; 2]; SLOTS],
    slots: [usize; 2],
    normal: Vec2,
    products: &[f64; 3],
    units: &[L; 2],
) {
    for j in 0..2 {
        let v = units[0].mul_add(L::splat(products[j]), units[1] * L::splat(products[j + 1]));
        add(&mut d[slots[j]], normal, v);
    }
}

/// The products with `v`, summed over the lanes.
#[inline(always)]
pub(super) fn dots<L: Lanes>(g: &[[L; 2]; 3], v: L) -> [[f64; 2]; 3] {
    let a = L::sums([g[0][0] * v, g[0][1] * v, g[1][0] * v, g[1][1] * v]).store();
    let b = L::sums([g[2][0] * v, g[2][1] * v, L::splat(0.0), L::splat(0.0)]).store();
    [[a[0], a[1]], [a[2], a[3]], [b[0], b[1]]]
}
