//! Derivatives with respect to the projected vertices, in transport form (docs/formulation 3.3): of the
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

use super::edges::{Edges, in_lanes};
use super::moments::{Moments, combine, powers};
use super::segment::{NonmortarFrame, Segment};
use super::slots::{MORTAR_CORNER, PAIR_CORNERS};
use crate::shape::{Basis, Cell, CornerMultipliers, Isoparametric, MAX_CORNERS, SingleBasis};
use crate::simd::Lanes;

/// d/dy of four numbers in the lanes: per corner's slot k the two components of y_k, mortar ones in the order of the
/// projection.
pub(super) type PlaneDerivatives<L> = [[L; 2]; PAIR_CORNERS];

/// A field p = sum_A N_A p_A on the non-mortar facet.
pub(super) struct Field<'a> {
    p: &'a [f64; MAX_CORNERS],
    /// det1 grad p in powers (1, xi, eta).
    slope: [[f64; 2]; 3],
}

/// A pair whose derivatives follow from its integrals by contraction.
pub(super) struct Transport<'a, L> {
    segment: &'a Segment,
    moments: &'a Moments<L>,
    edges: &'a Edges<L>,
    /// int (mu1_m / det1) N_k v, v = sum N_C d_C: the corners' heights are values of a displacement.
    q1v: [[f64; MAX_CORNERS]; 3],
    /// det J grad N of both maps in powers (1, xi, eta), lanes over the corners, of the mortar facet as given: those of
    /// N_A, N_B and N_C.
    gradients: [[[L; 2]; 3]; 2],
    /// det2 grad v in the same powers.
    slope: [[f64; 2]; 3],
}

impl<'a, L: Lanes> Transport<'a, L> {
    #[inline(always)]
    pub fn new<One: SingleBasis, Two: Isoparametric>(
        frame: &NonmortarFrame,
        segment: &'a Segment,
        moments: &'a Moments<L>,
        edges: &'a Edges<L>,
    ) -> Self {
        let two = &segment.mortar;
        let mut gradients = [frame.map.gradients::<L>(), segment.mortar_map.gradients::<L>()];
        let d = L::load(&two.d);
        let slope = dots(&gradients[1], d);
        for m in 0..powers::<Two::Cell>() {
            for c in 0..2 {
                gradients[1][m][c] = Two::Cell::given(gradients[1][m][c], two.is_reversed());
            }
        }
        let v = Two::Cell::given(d, two.is_reversed());
        let mut q1v = [[0.0; MAX_CORNERS]; 3];
        for m in 0..powers::<One::Cell>() {
            let q = &moments.q1[m];
            q1v[m] = L::sums([q[0] * v, q[1] * v, q[2] * v, q[3] * v]).store();
        }
        Transport { segment, moments, edges, q1v, gradients, slope }
    }

    /// The field with the nodal values `p`.
    #[inline(always)]
    pub fn field<'p>(&self, p: &'p [f64; MAX_CORNERS]) -> Field<'p> {
        Field { p, slope: dots(&self.gradients[0], L::load(p)) }
    }

    /// Of the forces f_B of a field, lanes B.
    #[inline(always)]
    pub fn one<One: SingleBasis>(&self, field: &Field) -> PlaneDerivatives<L> {
        if L::SHARED { self.one_shared::<One>(field) } else { self.one_inlined::<One>(field) }
    }

    #[inline(never)]
    fn one_shared<One: SingleBasis>(&self, field: &Field) -> PlaneDerivatives<L> {
        self.one_inlined::<One>(field)
    }

    #[inline(always)]
    fn one_inlined<One: SingleBasis>(&self, Field { p, slope }: &Field) -> PlaneDerivatives<L> {
        let mut d = [[L::splat(0.0); 2]; PAIR_CORNERS];
        let [g, _] = &self.gradients;
        for m in 0..powers::<One::Cell>() {
            let r = &self.moments.r[m];
            // sum_A R[k][A] p_A, lanes k: N_A, N_B and N_k are the same, so r is symmetric in k and B and serves for A.
            let rp = combine(r, p, One::Multiplier::FUNCTIONS).store();
            for k in 0..One::Cell::CORNERS {
                for c in 0..2 {
                    let v = L::splat(slope[m][c]).neg_mul_add(r[k], d[k][c]);
                    d[k][c] = g[m][c].neg_mul_add(L::splat(rp[k]), v);
                }
            }
        }
        for edge in self.edges.nonmortar.values() {
            add_products(&mut d, edge.ends, &edge.normal, p, &edge.own);
        }
        let multipliers = One::Multiplier::FUNCTIONS;
        for edge in self.edges.mortar.values() {
            let n = [combine(&edge.nonmortar[0], p, multipliers), combine(&edge.nonmortar[1], p, multipliers)];
            add(&mut d, MORTAR_CORNER, edge.ends, &edge.normal, n);
        }
        d
    }

    /// Of the forces f_C of the same field, lanes C.
    #[inline(always)]
    pub fn two<One: CornerMultipliers, Two: Isoparametric>(&self, field: &Field) -> PlaneDerivatives<L> {
        if L::SHARED { self.two_shared::<One, Two>(field) } else { self.two_inlined::<One, Two>(field) }
    }

    #[inline(never)]
    fn two_shared<One: CornerMultipliers, Two: Isoparametric>(&self, field: &Field) -> PlaneDerivatives<L> {
        self.two_inlined::<One, Two>(field)
    }

    #[inline(always)]
    fn two_inlined<One: CornerMultipliers, Two: Isoparametric>(
        &self,
        Field { p, slope }: &Field,
    ) -> PlaneDerivatives<L> {
        let mut d = [[L::splat(0.0); 2]; PAIR_CORNERS];
        let lanes = L::load(p);
        let [_, g2] = &self.gradients;
        for m in 0..powers::<One::Cell>() {
            for k in 0..One::Cell::CORNERS {
                for c in 0..2 {
                    d[k][c] = L::splat(slope[m][c]).mul_add(self.moments.q1[m][k], d[k][c]);
                }
            }
        }
        for m in 0..powers::<Two::Cell>() {
            let q = &self.moments.q2[m];
            let qp = L::sums([q[0] * lanes, q[1] * lanes, q[2] * lanes, q[3] * lanes]).store();
            for l in 0..Two::Cell::CORNERS {
                for c in 0..2 {
                    d[MORTAR_CORNER + l][c] = g2[m][c].mul_add(L::splat(qp[l]), d[MORTAR_CORNER + l][c]);
                }
            }
        }
        let minus = (-lanes).store();
        for edge in self.edges.nonmortar.values() {
            add_products(&mut d, edge.ends, &edge.normal, &minus, &edge.mortar);
        }
        for edge in self.edges.mortar.values() {
            let n = &edge.own;
            let [s0, s1, s2, _] = L::sums([n[0] * lanes, n[1] * lanes, n[2] * lanes, L::splat(0.0)]).store();
            subtract(&mut d, MORTAR_CORNER, edge.ends, &edge.normal, in_lanes([s0, s1, s2], &edge.units));
        }
        d
    }

    /// Of the gaps gamma_A at fixed heights, lanes A; `heights` are those of the non-mortar nodes.
    #[inline(always)]
    pub fn gap<One: SingleBasis, Two: Isoparametric>(&self, heights: &[f64; MAX_CORNERS]) -> PlaneDerivatives<L> {
        let mut d = self.one::<One>(&self.field(heights)); // n_AB is symmetric: the field of heights, lanes A
        // -int N_A v: the field of the mortar heights.
        let [g, _] = &self.gradients;
        for m in 0..powers::<One::Cell>() {
            for k in 0..One::Cell::CORNERS {
                for c in 0..2 {
                    d[k][c] = g[m][c].mul_add(L::splat(self.q1v[m][k]), d[k][c]);
                }
            }
        }
        for m in 0..powers::<Two::Cell>() {
            for c in 0..2 {
                let h = L::splat(self.slope[m][c]);
                for l in 0..Two::Cell::CORNERS {
                    d[MORTAR_CORNER + l][c] = h.mul_add(self.moments.q2[m][l], d[MORTAR_CORNER + l][c]);
                }
            }
        }
        for edge in self.edges.nonmortar.values() {
            subtract(&mut d, 0, edge.ends, &edge.normal, edge.height);
        }
        for edge in self.edges.mortar.values() {
            let ([v0, v1], n) = (at_ends::<L>(&self.segment.mortar.d, edge.ends), &edge.own);
            let n = [v0.mul_add(n[0], v1 * n[1]), v0.mul_add(n[1], v1 * n[2])];
            subtract(&mut d, MORTAR_CORNER, edge.ends, &edge.normal, n);
        }
        d
    }
}

/// The values of a field at an edge's ends, two corners.
#[inline(always)]
fn at_ends<L: Lanes>(field: &[f64; MAX_CORNERS], ends: [usize; 2]) -> [L; 2] {
    [L::splat(field[ends[0] & 3]), L::splat(field[ends[1] & 3])]
}

/// Adds n `v` in the slots of an edge's ends, which follow slot `first`.
#[inline(always)]
fn add<L: Lanes>(d: &mut PlaneDerivatives<L>, first: usize, ends: [usize; 2], n: &[L; 2], v: [L; 2]) {
    for j in 0..2 {
        let sum = &mut d[first + (ends[j] & 3)]; // so that no bounds are checked
        *sum = [n[0].mul_add(v[j], sum[0]), n[1].mul_add(v[j], sum[1])];
    }
}

/// Subtracts the same.
#[inline(always)]
fn subtract<L: Lanes>(d: &mut PlaneDerivatives<L>, first: usize, ends: [usize; 2], n: &[L; 2], v: [L; 2]) {
    for j in 0..2 {
        let sum = &mut d[first + (ends[j] & 3)];
        *sum = [n[0].neg_mul_add(v[j], sum[0]), n[1].neg_mul_add(v[j], sum[1])];
    }
}

/// Adds what a field p on a non-mortar edge contributes, from the integrals `of` L_a L_b times what stands in the lanes.
#[inline(always)]
fn add_products<L: Lanes>(
    d: &mut PlaneDerivatives<L>,
    ends: [usize; 2],
    normal: &[L; 2],
    p: &[f64; MAX_CORNERS],
    of: &[L; 3],
) {
    let [p0, p1] = at_ends::<L>(p, ends);
    add(d, 0, ends, normal, [p0.mul_add(of[0], p1 * of[1]), p0.mul_add(of[1], p1 * of[2])]);
}

/// The products with `v`, summed over the lanes.
#[inline(always)]
pub(super) fn dots<L: Lanes>(g: &[[L; 2]; 3], v: L) -> [[f64; 2]; 3] {
    let a = L::sums([g[0][0] * v, g[0][1] * v, g[1][0] * v, g[1][1] * v]).store();
    let b = L::sums([g[2][0] * v, g[2][1] * v, L::splat(0.0), L::splat(0.0)]).store();
    [[a[0], a[1]], [a[2], a[3]], [b[0], b[1]]]
}
