//! The integrals over an overlap that its weights' derivatives consist of (docs/formulation 3.4):
//!
//! Q1[m][k][C] = int (mu1_m / det1) N_k N_C, R[m][k][B] = int (mu1_m / det1) N_k N_B, Q2[m][l][A] = int (mu2_m / det2)
//! N_l N_A,
//!
//! N_k, N_l the functions of the two maps, N_A the multipliers', N_B and N_C the displacements'. R serves in place of the
//! integrals with N_A, too, and its sums are fewer because N_B have the monomials of the map.
//!
//! mu = (1, xi, eta) of the facet whose det stands below (of a triangle 1 alone: the others have no coefficient). mu_m
//! N_k has eight monomials, and the functions they are integrated with four, so what is summed over the points are
//! products of monomials, each once; the nodes' integrals follow from the sums.

use super::points::{Fan, Maps, Points, points, triangle_lanes};
use super::segment::{NonmortarFrame, Segment};
use super::weight_sums::Sums;
use crate::quadrature::Rule;
use crate::shape::{Basis, Cell, Isoparametric, MAX_CORNERS, SingleBasis};
use crate::simd::{Lanes, Stack};

/// 1, xi, eta, xi eta, xi^2, eta^2, xi^2 eta, xi eta^2; of a triangle the first three.
pub(super) const MONOMIALS: usize = 8;
/// Which monomials mu_m (1, xi, eta, xi eta) are.
pub(super) const PRODUCTS: [[usize; 4]; 3] = [[0, 1, 2, 3], [1, 4, 3, 6], [2, 3, 5, 7]];

/// Monomials of mu_m N_k.
pub(super) const fn monomials<C: Cell>() -> usize {
    if C::BILINEAR { MONOMIALS } else { 3 }
}

/// How many mu_m have a coefficient.
pub(super) const fn powers<C: Cell>() -> usize {
    if C::BILINEAR { 3 } else { 1 }
}

/// Which of the sums [`own`] gives are monomial j times 1, xi, eta, xi eta. Of the 32 products 15 differ; after the
/// monomials themselves: xi^2 eta^2, xi^3, xi^3 eta, xi^3 eta^2, eta^3, xi eta^3, xi^2 eta^3.
const OWN: [[usize; 4]; MONOMIALS] = [
    [0, 1, 2, 3],
    [1, 4, 3, 6],
    [2, 3, 5, 7],
    [3, 6, 7, 8],
    [4, 9, 6, 10],
    [5, 7, 12, 13],
    [6, 10, 8, 11],
    [7, 8, 13, 14],
];
/// Different entries of [`OWN`].
const OWN_SUMS: usize = 15;

/// Groups of points summed at once: 8 triangles of 7 points.
const GROUPS: usize = 16;

/// Four points.
#[derive(Clone, Copy)]
struct Group<L> {
    /// Monomials of both facets with weight / det.
    monomials: [[L; MONOMIALS]; 2],
    /// xi, eta, xi eta of both.
    at: [[L; 3]; 2],
}

/// [m][k], k over corners, lanes over the third index.
pub(super) type Table<L> = [[L; MAX_CORNERS]; 3];

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

/// Sums of the monomials `first` to `first` + 3 of facet `FACET` times xi, eta, xi eta of facet `OTHER`, by their lanes:
/// twelve are as many as stay in registers.
#[inline(always)]
fn products<L: Lanes, const FACET: usize, const OTHER: usize>(
    groups: &[Group<L>],
    first: usize,
    (monomials, functions): (usize, usize),
) -> [[L; 3]; 4] {
    let mut s = [[L::splat(0.0); 3]; 4];
    for g in groups {
        let at = &g.at[OTHER];
        for j in 0..monomials {
            let m = g.monomials[FACET][first + j];
            for f in 0..functions {
                s[j][f] = m.mul_add(at[f], s[j][f]);
            }
        }
    }
    s
}

/// Sums of the monomials of facet `FACET`, by their lanes.
#[inline(always)]
fn plain<L: Lanes, const FACET: usize>(groups: &[Group<L>], monomials: usize) -> [L; MONOMIALS] {
    let mut s = [L::splat(0.0); MONOMIALS];
    for g in groups {
        for j in 0..monomials {
            s[j] = s[j] + g.monomials[FACET][j];
        }
    }
    s
}

/// Sums of the monomials of the non-mortar facet, and of those with the monomials of its displacement, by their lanes:
/// both are those of the map, so that most products are there twice.
#[inline(always)]
fn own<L: Lanes, One: Isoparametric>(groups: &[Group<L>]) -> [L; OWN_SUMS] {
    let mut s = [L::splat(0.0); OWN_SUMS];
    for g in groups {
        let (m, [xi, eta, both]) = (&g.monomials[0], &g.at[0]);
        for j in 0..monomials::<One::Cell>() {
            s[j] = s[j] + m[j];
        }
        if One::Cell::BILINEAR {
            s[8] = m[6].mul_add(*eta, s[8]);
            s[9] = m[4].mul_add(*xi, s[9]);
            s[10] = m[6].mul_add(*xi, s[10]);
            s[11] = m[6].mul_add(*both, s[11]);
            s[12] = m[5].mul_add(*eta, s[12]);
            s[13] = m[7].mul_add(*eta, s[13]);
            s[14] = m[7].mul_add(*both, s[14]);
        } else {
            s[3] = m[1].mul_add(*eta, s[3]);
            s[4] = m[1].mul_add(*xi, s[4]);
            s[5] = m[2].mul_add(*eta, s[5]);
        }
    }
    s
}

/// Integrals of the monomials of facet `FACET`, whose sums are `sums`, with the functions of a field on facet `OTHER`,
/// lanes over these.
#[inline(always)]
fn with_other<L: Lanes, Facet: Cell, Field: Basis, const FACET: usize, const OTHER: usize>(
    groups: &[Group<L>],
    sums: &[L],
) -> [L; MONOMIALS] {
    let mut whole = [L::splat(0.0); MONOMIALS];
    for first in (0..monomials::<Facet>()).step_by(4) {
        let counts = ((monomials::<Facet>() - first).min(4), Field::TERMS - 1);
        let s = products::<L, FACET, OTHER>(groups, first, counts);
        for j in 0..counts.0 {
            whole[first + j] = Field::nodal_lanes(L::sums([sums[first + j], s[j][0], s[j][1], s[j][2]]));
        }
    }
    whole
}

/// Integrals of the monomials of the non-mortar facet with the functions of its displacement, lanes over these.
#[inline(always)]
fn with_own<L: Lanes, One: Isoparametric>(sums: &[L; OWN_SUMS]) -> [L; MONOMIALS] {
    let mut whole = [L::splat(0.0); MONOMIALS];
    for j in 0..monomials::<One::Cell>() {
        let [a, b, c, d] = OWN[j];
        let last = if One::Displacement::TERMS == 4 { sums[d] } else { L::splat(0.0) };
        whole[j] = One::Displacement::nodal_lanes(L::sums([sums[a], sums[b], sums[c], last]));
    }
    whole
}

/// Expanded to the functions of the map.
#[inline(always)]
pub(super) fn table<L: Lanes, C: Cell>(whole: &[L; MONOMIALS]) -> Table<L> {
    let mut table = [[L::splat(0.0); MAX_CORNERS]; 3];
    for m in 0..powers::<C>() {
        let [a, b, c, d] = PRODUCTS[m];
        table[m] = C::Map::nodal([whole[a], whole[b], whole[c], whole[d]]);
    }
    table
}

/// sum_k c_k n_k, of the `first` ones.
#[inline(always)]
pub(super) fn combine<L: Lanes>(n: &[L; MAX_CORNERS], c: &[f64; MAX_CORNERS], first: usize) -> L {
    let mut sum = n[0] * L::splat(c[0]);
    for k in 1..first {
        sum = n[k].mul_add(L::splat(c[k]), sum);
    }
    sum
}

impl<L: Lanes> Moments<L> {
    /// Over a segment; `weights`, where they are wanted from the same points, get what their own integration adds up.
    #[inline(always)]
    pub fn integrate<One: SingleBasis, Two: Isoparametric>(
        frame: &NonmortarFrame,
        segment: &Segment,
        rule: &Rule,
        weights: Option<&mut Sums<L>>,
    ) -> Self {
        if L::SHARED {
            Self::shared::<One, Two>(frame, segment, rule, weights)
        } else {
            Self::inlined::<One, Two>(frame, segment, rule, weights)
        }
    }

    #[inline(never)]
    fn shared<One: SingleBasis, Two: Isoparametric>(
        frame: &NonmortarFrame,
        segment: &Segment,
        rule: &Rule,
        weights: Option<&mut Sums<L>>,
    ) -> Self {
        Self::inlined::<One, Two>(frame, segment, rule, weights)
    }

    #[inline(always)]
    fn inlined<One: SingleBasis, Two: Isoparametric>(
        frame: &NonmortarFrame,
        segment: &Segment,
        rule: &Rule,
        mut weights: Option<&mut Sums<L>>,
    ) -> Self {
        let mut whole = [[L::splat(0.0); MONOMIALS]; 3];
        let mut stack = Stack::<Group<L>, GROUPS>::new();
        let rule = triangle_lanes::<One, Two>(rule);
        let maps = Maps::new(frame, segment);
        let mut fan = Fan::new(frame, segment);
        let mut triangle = fan.triangle();
        let (mut i, mut more) = (0, false);
        while let Some(t) = &triangle {
            let p = points::<L>(&maps, &rule[i], t);
            if let Some(weights) = &mut weights {
                weights.add::<One, Two>(&p);
            }
            stack.push(group::<L, One::Cell, Two::Cell>(&p));
            i += 1;
            if i == rule.len() {
                (triangle, i) = (fan.triangle(), 0);
            }
            if stack.is_full() || triangle.is_none() {
                let groups = stack.values();
                let sums = own::<L, One>(groups);
                let batch = [
                    with_other::<L, One::Cell, Two::Displacement, 0, 1>(groups, &sums),
                    with_own::<L, One>(&sums),
                    with_other::<L, Two::Cell, One::Multiplier, 1, 0>(
                        groups,
                        &plain::<L, 1>(groups, monomials::<Two::Cell>()),
                    ),
                ];
                if more {
                    for (sum, new) in whole.as_flattened_mut().iter_mut().zip(batch.as_flattened()) {
                        *sum = *sum + *new;
                    }
                } else {
                    whole = batch;
                }
                more = true;
                stack.clear();
            }
        }
        let [q1, r, q2] = &mut whole;
        // The nodes C are the corners, in their order.
        for q in q1.iter_mut() {
            *q = Two::Cell::given(*q, segment.mortar.is_reversed());
        }
        Moments { q1: table::<L, One::Cell>(q1), r: table::<L, One::Cell>(r), q2: table::<L, Two::Cell>(q2) }
    }
}

/// What is summed of four points.
#[inline(always)]
fn group<L: Lanes, One: Cell, Two: Cell>(p: &Points<L>) -> Group<L> {
    let over = p.weight / (p.one.det * p.two.det);
    let one = powers_of::<L, One>(over * p.two.det, p.one.xi, p.one.eta);
    let two = powers_of::<L, Two>(over * p.one.det, p.two.xi, p.two.eta);
    let at = [[p.one.xi, p.one.eta, p.one.xi * p.one.eta], [p.two.xi, p.two.eta, p.two.xi * p.two.eta]];
    Group { monomials: [one, two], at }
}
