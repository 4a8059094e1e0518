//! The moments over the overlap of two sub-facets that their derivatives consist of (docs/formulation.md 12.3): of monomials
//! in the coordinates of both parents, (x1, y1) and (x2, y2), over the determinants of the sub-facets' maps.
//!
//! own[a b] = int x1^a y1^b / det1,  one[a b][t] = int x1^a y1^b mu_t(x2, y2) / det1,
//! two[a b][s] = int x2^a y2^b nu_s(x1, y1) / det2.

use super::sub_pair::Four;
use super::sub_polynomials::{Degree, Polynomials};
use crate::shape::monomials;
use crate::simd::Lanes;

/// No points.
#[inline(always)]
pub(super) fn no_points<L: Lanes>() -> Batch<L> {
    [[L::splat(0.0); BATCH]; SLOTS]
}

/// Groups of four points that are summed at once.
const BATCH: usize = 4;
/// Most monomials of x1, y1 beside det1, and of x2, y2 beside det2.
const ROWS: usize = 36;
/// Where the rows of `two`, its columns and those of `one` begin in a batch.
const TWO: usize = ROWS;
const NUS: usize = 2 * ROWS;
const MUS: usize = NUS + 8;
const SLOTS: usize = MUS + 12;

/// Where x^a y^b stands.
#[inline(always)]
pub(super) const fn at(a: usize, b: usize) -> usize {
    8 * a + b
}

pub(super) struct SubMoments {
    pub own: [f64; 64],
    pub one: [[f64; 12]; 40],
    pub two: [[f64; 8]; 48],
}

impl SubMoments {
    #[inline(always)]
    pub fn zero() -> Self {
        SubMoments { own: [0.0; 64], one: [[0.0; 12]; 40], two: [[0.0; 8]; 48] }
    }
}

/// Monomials up to a degree, one after the other.
struct List {
    degree: Degree,
    len: usize,
    /// Where each stands (see [`at`]).
    at: [usize; ROWS],
}

impl List {
    #[inline(always)]
    fn new(degree: Degree) -> Self {
        let mut list = List { degree, len: 0, at: [0; ROWS] };
        for a in 0..=degree.each {
            for b in 0..=degree.beside(a) {
                list.at[list.len] = at(a, b);
                list.len += 1;
            }
        }
        list
    }
}

/// Points and the sums over them.
pub(super) struct Summation<'a, L> {
    own: List,
    one: List,
    two: List,
    /// Where the monomials of `one` stand among those of `own`.
    place: [usize; ROWS],
    counts: [usize; 2],
    batch: &'a mut Batch<L>,
    len: usize,
    pub moments: &'a mut SubMoments,
}

/// Points that wait for their sums: rows and columns, four points in lanes.
pub(super) type Batch<L> = [[L; BATCH]; SLOTS];

impl<'a, L: Lanes> Summation<'a, L> {
    /// Of these degrees of the three, with so many nu_s and mu_t.
    #[inline(always)]
    pub fn new(
        [own, one, two]: [Degree; 3],
        counts: [usize; 2],
        batch: &'a mut Batch<L>,
        moments: &'a mut SubMoments,
    ) -> Self {
        let (own, one, two) = (List::new(own), List::new(one), List::new(two));
        let mut place = [0; ROWS];
        for n in 0..one.len {
            for i in 0..own.len {
                if own.at[i] == one.at[n] {
                    place[n] = i;
                }
            }
        }
        Summation { own, one, two, place, counts, batch, len: 0, moments }
    }

    #[inline(always)]
    pub fn add(&mut self, four: &Four<L>, one: &Polynomials, two: &Polynomials) {
        let [x1, y1] = one.coordinates.of_four([four.one[0], four.one[1]]);
        let [x2, y2] = two.coordinates.of_four([four.two[0], four.two[1]]);
        let over = four.weight / (four.one[2] * four.two[2]);
        let g = self.len & (BATCH - 1);
        rows(&self.own, [over * four.two[2], x1, y1], &mut self.batch[..TWO], g);
        rows(&self.two, [over * four.one[2], x2, y2], &mut self.batch[TWO..NUS], g);
        let nu = [L::splat(1.0), x1, y1, x1 * y1, x1 * x1, y1 * y1];
        for s in 0..self.counts[0] {
            self.batch[NUS + s][g] = nu[s];
        }
        let mu = monomials(x2, y2);
        for t in 0..self.counts[1] {
            self.batch[MUS + t][g] = mu[t];
        }
        self.len += 1;
        if self.len == BATCH {
            self.flush();
        }
    }

    /// Adds what is there.
    #[inline(always)]
    pub fn flush(&mut self) {
        let groups = self.len;
        if groups == 0 {
            return;
        }
        for n in 0..self.own.len {
            let row = &self.batch[n];
            let mut sum = row[0];
            for g in 1..groups {
                sum = sum + row[g];
            }
            // Summed over the lanes when all are there: see `own`.
            let [a, b, c, d] = sum.store();
            self.moments.own[self.own.at[n] & 63] += (a + b) + (c + d);
        }
        for first in (0..self.one.len).step_by(3) {
            for t in (0..self.counts[1]).step_by(4) {
                let n = [first, first + 1, first + 2].map(|n| n.min(self.one.len - 1));
                let s = products(self.batch, [self.place[n[0]], self.place[n[1]], self.place[n[2]]], MUS + t, groups);
                for r in 0..3.min(self.one.len - first) {
                    add(s[r], &mut self.moments.one[self.one.at[first + r]][t..]);
                }
            }
        }
        for first in (0..self.two.len).step_by(3) {
            for k in (0..self.counts[0]).step_by(4) {
                let n = [first, first + 1, first + 2].map(|n| TWO + n.min(self.two.len - 1));
                let s = products(self.batch, n, NUS + k, groups);
                for r in 0..3.min(self.two.len - first) {
                    add(s[r], &mut self.moments.two[self.two.at[first + r]][k..]);
                }
            }
        }
        self.len = 0;
    }
}

/// Adds four sums to the first numbers.
#[inline(always)]
fn add<L: Lanes>(sums: L, to: &mut [f64]) {
    if let Some(to) = to.first_chunk_mut::<4>() {
        *to = (L::load(to) + sums).store();
    }
}

/// Monomials with a weight.
#[inline(always)]
fn rows<L: Lanes>(list: &List, [mut w, x, y]: [L; 3], to: &mut [[L; BATCH]], g: usize) {
    let mut n = 0;
    for a in 0..=list.degree.each {
        let mut m = w;
        for _ in 0..=list.degree.beside(a) {
            to[n][g] = m;
            m = m * y;
            n += 1;
        }
        w = w * x;
    }
}

/// Sums of the products of three rows and four columns from `first` on: twelve stay in registers.
#[inline(always)]
fn products<L: Lanes>(batch: &[[L; BATCH]; SLOTS], rows: [usize; 3], first: usize, groups: usize) -> [L; 3] {
    let mut s = [[L::splat(0.0); 4]; 3];
    let rows = [&batch[rows[0]], &batch[rows[1]], &batch[rows[2]]];
    let columns = [&batch[first], &batch[first + 1], &batch[first + 2], &batch[first + 3]];
    for g in 0..groups.min(BATCH) {
        for j in 0..4 {
            for r in 0..3 {
                s[r][j] = rows[r][g].mul_add(columns[j][g], s[r][j]);
            }
        }
    }
    [L::sums(s[0]), L::sums(s[1]), L::sums(s[2])]
}
