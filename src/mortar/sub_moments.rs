//! The moments over the overlap of two sub-facets that their derivatives consist of (docs/formulation 12.3): of monomials
//! in the coordinates of both parents, (x1, y1) and (x2, y2), over the determinants of the sub-facets' maps.
//!
//! own[a b] = int x1^a y1^b / det1,  one[a b][t] = int x1^a y1^b mu_t(x2, y2) / det1,
//! two[a b][s] = int x2^a y2^b nu_s(x1, y1) / det2.

use super::sub_pair::Four;
use super::sub_polynomials::{Degree, Polynomials};
use crate::shape::monomials;
use crate::simd::Lanes;

/// Groups of four points that are summed at once.
pub(super) const BATCH: usize = 4;
/// Most monomials of x1, y1 beside det1, and of x2, y2 beside det2.
const ROWS: usize = 36;
/// Rows and columns of a batch at most, and of two triangles with six nodes or three.
pub(super) const SLOTS: usize = ROWS + 22 + 8 + 12;
pub(super) const FEW_SLOTS: usize = 10 + 6 + 4 + 8;

/// Where x^a y^b stands.
#[inline(always)]
pub(super) const fn at(a: usize, b: usize) -> usize {
    8 * a + b
}

pub(super) struct SubMoments {
    pub own: [f64; 64],
    pub one: [[[f64; 4]; 3]; 64],
    pub two: [[[f64; 4]; 2]; 64],
}

impl SubMoments {
    #[inline(always)]
    pub fn zero() -> Self {
        SubMoments { own: [0.0; 64], one: [[[0.0; 4]; 3]; 64], two: [[[0.0; 4]; 2]; 64] }
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
        for a in 0..degree.each + 1 {
            for b in 0..degree.beside(a) + 1 {
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
    /// How many nu_s and mu_t there are, and groups of four of these.
    counts: [usize; 2],
    groups: [usize; 2],
    /// Where in the batch the rows of `two` begin, its columns, those of `one`: after the rows of `own`.
    first: [usize; 3],
    /// Sums for `own`, four points in lanes.
    sums: [L; ROWS],
    batch: &'a mut [[L; BATCH]],
    len: usize,
    pub moments: &'a mut SubMoments,
}

impl<'a, L: Lanes> Summation<'a, L> {
    /// Of these degrees of the three, with so many nu_s and mu_t.
    #[inline(always)]
    pub fn new(
        [own, one, two]: [Degree; 3],
        counts: [usize; 2],
        batch: &'a mut [[L; BATCH]],
        moments: &'a mut SubMoments,
    ) -> Self {
        let (own, one, two) = (List::new(own), List::new(one), List::new(two));
        let (mut place, mut of) = ([0; ROWS], [0; 64]);
        for i in 0..own.len {
            of[own.at[i] & 63] = i;
        }
        for n in 0..one.len {
            place[n] = of[one.at[n] & 63];
        }
        let groups = [counts[0].div_ceil(4), counts[1].div_ceil(4)];
        let nus = own.len + two.len;
        let first = [own.len, nus, nus + 4 * groups[0]];
        Summation { own, one, two, place, counts, groups, first, sums: [L::splat(0.0); ROWS], batch, len: 0, moments }
    }

    #[inline(always)]
    pub fn add(&mut self, four: &Four<L>, one: &Polynomials, two: &Polynomials) {
        let [x1, y1] = one.coordinates.of_four([four.one[0], four.one[1]]);
        let [x2, y2] = two.coordinates.of_four([four.two[0], four.two[1]]);
        let over = four.weight / (four.one[2] * four.two[2]);
        let g = self.len & (BATCH - 1);
        rows_of(&self.own, [over * four.two[2], x1, y1], self.batch, g);
        for n in 0..self.own.len.min(ROWS) {
            self.sums[n] = self.sums[n] + self.batch[n][g];
        }
        rows_of(&self.two, [over * four.one[2], x2, y2], &mut self.batch[self.first[0]..], g);
        let nu = [L::splat(1.0), x1, y1, x1 * y1, x1 * x1, y1 * y1];
        for s in 0..self.counts[0].min(6) {
            self.batch[self.first[1] + s][g] = nu[s];
        }
        let mu = monomials(x2, y2);
        for t in 0..self.counts[1].min(9) {
            self.batch[self.first[2] + t][g] = mu[t];
        }
        self.len += 1;
        if self.len == BATCH {
            self.flush();
        }
    }

    /// The moments of all points.
    #[inline(always)]
    pub fn finish(&mut self) {
        if self.len > 0 {
            self.flush();
        }
        let mut n = 0;
        while n < ROWS {
            let sums = L::sums([self.sums[n], self.sums[n + 1], self.sums[n + 2], self.sums[n + 3]]).store();
            for i in 0..4 {
                self.moments.own[self.own.at[n + i] & 63] += sums[i];
            }
            n += 4;
            if n >= self.own.len {
                break;
            }
        }
    }

    /// Adds what is there.
    #[inline(always)]
    fn flush(&mut self) {
        if L::SHARED { self.flush_shared() } else { self.flush_inlined() }
    }

    #[inline(never)]
    fn flush_shared(&mut self) {
        self.flush_inlined();
    }

    #[inline(always)]
    fn flush_inlined(&mut self) {
        let groups = self.len;
        let (mut first, last) = (0, self.one.len - 1);
        while first <= last {
            let n = [first, last.min(first + 1), last.min(first + 2)];
            let rows = [self.place[n[0]], self.place[n[1]], self.place[n[2]]];
            for t in 0..self.groups[1] {
                let s = products(self.batch, rows, self.first[2] + 4 * t, groups);
                for r in 0..3 {
                    if r == 0 || n[r] > n[r - 1] {
                        let to = &mut self.moments.one[self.one.at[n[r]] & 63][t];
                        *to = (L::load(to) + s[r]).store();
                    }
                }
            }
            first += 3;
        }
        let two = self.first[0];
        let (mut first, last) = (0, self.two.len - 1);
        while first <= last {
            let n = [first, last.min(first + 1), last.min(first + 2)];
            for k in 0..self.groups[0] {
                let s = products(self.batch, [two + n[0], two + n[1], two + n[2]], self.first[1] + 4 * k, groups);
                for r in 0..3 {
                    if r == 0 || n[r] > n[r - 1] {
                        let to = &mut self.moments.two[self.two.at[n[r]] & 63][k];
                        *to = (L::load(to) + s[r]).store();
                    }
                }
            }
            first += 3;
        }
        self.len = 0;
    }
}

/// Monomials with a weight.
#[inline(always)]
fn rows_of<L: Lanes>(list: &List, wxy: [L; 3], to: &mut [[L; BATCH]], g: usize) {
    // Of every kind of facet, so that loops have known lengths.
    match (list.degree.total, list.degree.each) {
        (1, _) => rows::<L, 1, 1, 3>(wxy, to, g),
        (2, _) => rows::<L, 2, 2, 6>(wxy, to, g),
        (3, _) => rows::<L, 3, 3, 10>(wxy, to, g),
        (4, 3) => rows::<L, 4, 3, 13>(wxy, to, g),
        (4, _) => rows::<L, 4, 4, 15>(wxy, to, g),
        (5, 4) => rows::<L, 5, 4, 19>(wxy, to, g),
        (5, _) => rows::<L, 5, 5, 21>(wxy, to, g),
        (6, _) => rows::<L, 6, 4, 22>(wxy, to, g),
        (7, 6) => rows::<L, 7, 6, 34>(wxy, to, g),
        (7, _) => rows::<L, 7, 7, 36>(wxy, to, g),
        _ => rows::<L, 8, 5, 33>(wxy, to, g),
    }
}

/// Those up to degree `TOTAL`, and `EACH` in x and in y, in the order of [`List`].
#[inline(always)]
fn rows<L: Lanes, const TOTAL: usize, const EACH: usize, const COUNT: usize>(
    [mut w, x, y]: [L; 3],
    to: &mut [[L; BATCH]],
    g: usize,
) {
    let Some(to) = to.first_chunk_mut::<COUNT>() else { return };
    let mut n = 0;
    for a in 0..EACH + 1 {
        let mut m = w;
        for b in 0..EACH + 1 {
            if a + b <= TOTAL {
                to[n][g & (BATCH - 1)] = m;
                m = m * y;
                n += 1;
            }
        }
        w = w * x;
    }
}

/// Sums of the products of three rows and four columns from `first` on: twelve stay in registers.
#[inline(always)]
fn products<L: Lanes>(batch: &[[L; BATCH]], rows: [usize; 3], first: usize, groups: usize) -> [L; 3] {
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
