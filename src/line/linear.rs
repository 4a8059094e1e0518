//! Two lines with two nodes each (docs/formulation 13.2, 13.3): what `weights.rs` and `derivatives.rs` do, with the functions of
//! such lines. Lanes are the two components of a side's two nodes, the columns of a row of derivatives.

use super::facet::MAX_LINE_NODES;
use super::segment::{LineSegment, Measure};
use crate::error::Result;
use crate::geometry::Vec2;
use crate::mortar::OverlapPoint;
use crate::quadrature::line::GAUSS_2;
use crate::simd::{Kernel, Lanes};

/// n_AB and n_AC, `[side][A][B]`.
pub(super) type Weights = [[[f64; 2]; 2]; 2];

/// Derivatives of n_AB or n_AC: `[A][B][column]`, column 2 k + i of component i of the non-mortar line's node k, 2 (3 + k) + i of the
/// mortar line's, whatever number of nodes they have.
pub(super) type Rows = [[[f64; LINE_COLUMNS]; MAX_LINE_NODES]; MAX_LINE_NODES];

/// Columns: two components of each of the non-mortar line's nodes, then of the mortar line's.
pub const LINE_COLUMNS: usize = 4 * MAX_LINE_NODES;

/// N_A, and N_B or N_C, at a point.
type Functions = [[f64; 2]; 2];

/// The weights over an overlap.
#[inline(always)]
pub(super) fn weights(segment: &LineSegment, measure: Measure) -> Weights {
    let mut n = [[[0.0; 2]; 2]; 2];
    for (at, ds) in points(segment) {
        let w = ds * measure.at(at[0], segment.r);
        for (side, a) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            n[side][a][0] += w * at[0][a] * at[side][0];
            n[side][a][1] += w * at[0][a] * at[side][1];
        }
    }
    n
}

/// The same over the points where the field with these values at the ends of the first line is negative.
pub(super) fn closed_weights(segment: &LineSegment, measure: Measure, field: [f64; 2]) -> Weights {
    let mut n = [[[0.0; 2]; 2]; 2];
    for (at, ds) in points(segment).into_iter().filter(|(at, _)| at[0][0] * field[0] + at[0][1] * field[1] < 0.0) {
        let w = ds * measure.at(at[0], segment.r);
        for (side, a) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            n[side][a][0] += w * at[0][a] * at[side][0];
            n[side][a][1] += w * at[0][a] * at[side][1];
        }
    }
    n
}

/// The points that these are sums over.
pub(super) fn each_point(
    segment: &LineSegment,
    measure: Measure,
    to: &mut dyn FnMut(OverlapPoint) -> Result<()>,
) -> Result<()> {
    for (at, ds) in points(segment) {
        let [own, other] = at.map(|[a, b]| [a, b, 0.0, 0.0]);
        to(OverlapPoint { weight: ds * measure.at(at[0], segment.r), own, other })?;
    }
    Ok(())
}

/// The functions at the points of the rule, and ds.
#[inline(always)]
fn points(segment: &LineSegment) -> [(Functions, f64); 2] {
    let [first, second] = GAUSS_2;
    [point(segment, first), point(segment, second)]
}

#[inline(always)]
fn point(segment: &LineSegment, [at, weight]: [f64; 2]) -> (Functions, f64) {
    let [(from, _), (to, _)] = segment.ends;
    let s = from + at * (to - from);
    ([segment.shares(0, s), segment.shares(1, s)], weight * (to - from))
}

#[inline(always)]
fn both<L: Lanes>(first: Vec2, second: Vec2) -> L {
    L::load(&[first.x, first.y, second.x, second.y])
}

/// Adds the derivatives of two lines that overlap: of n_AB, of n_AC.
pub(super) struct Linear<'a>(pub &'a LineSegment, pub Measure, pub [&'a mut Rows; 2]);

impl Kernel for Linear<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Linear(segment, measure, to) = self;
        let (t, zero) = (segment.t, L::splat(0.0));
        // Ds_k: by the non-mortar nodes, through the frame too, and by the mortar ones.
        let (back, turn) = (t * -0.5, segment.turn());
        let of_s: [(L, L); 4] = [
            (both(-back, back), zero),
            (both(back, -back), zero),
            (both(back - turn[0], back + turn[0]), both(t, Vec2::zeros())),
            (both(back - turn[1], back + turn[1]), both(Vec2::zeros(), t)),
        ];
        let slope = measure.slope();
        let lean = slope * (segment.r[1] - segment.r[0]) * segment.per[0];
        let rises = [[-segment.per[0], segment.per[0]], [-segment.per[1], segment.per[1]]];
        // Per side, A and B: by the non-mortar nodes, by the mortar ones.
        let mut sums = [[[[zero; 2]; 2]; 2]; 2];
        for (at, ds) in points(segment) {
            let rho = L::splat(ds * measure.at(at[0], segment.r));
            let [p, q] = [[L::splat(at[0][0]), L::splat(at[0][1])], [L::splat(at[1][0]), L::splat(at[1][1])]];
            let v1 = of_s[0].0 * p[0] + of_s[1].0 * p[1];
            let v2 = [of_s[2].0 * q[0] + of_s[3].0 * q[1], of_s[2].1 * q[0] + of_s[3].1 * q[1]];
            // ds Drho, rho ds v1, rho ds v2.
            let wider = L::load(&[slope * ds * at[0][0], 0.0, slope * ds * at[0][1], 0.0]) - v1 * L::splat(lean * ds);
            let (v1, v2) = (v1 * rho, [v2[0] * rho, v2[1] * rho]);
            for a in 0..2 {
                for b in 0..2 {
                    let of_test = [rises[0][a] * at[0][b], rises[0][a] * at[1][b]];
                    let of_other = [at[0][a] * rises[0][b], at[0][a] * rises[1][b]];
                    let n = [L::splat(at[0][a] * at[0][b]), L::splat(at[0][a] * at[1][b])];
                    let sum = &mut sums[0][a][b][0];
                    *sum = n[0].mul_add(wider, L::splat(of_test[0] + of_other[0]).neg_mul_add(v1, *sum));
                    let [one, two] = &mut sums[1][a][b];
                    let other = L::splat(of_other[1]);
                    *one = other.neg_mul_add(v2[0], L::splat(of_test[1]).neg_mul_add(v1, n[1].mul_add(wider, *one)));
                    *two = other.neg_mul_add(v2[1], *two);
                }
            }
        }
        for ((s, node), sign) in segment.ends.into_iter().zip([-1.0, 1.0]) {
            let at = [segment.shares(0, s), segment.shares(1, s)];
            let rho = L::splat(sign * measure.at(at[0], segment.r));
            let v = [of_s[node].0 * rho, of_s[node].1 * rho];
            for (side, a) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                for b in 0..2 {
                    let n = L::splat(at[0][a] * at[side][b]);
                    let [one, two] = &mut sums[side][a][b];
                    (*one, *two) = (n.mul_add(v[0], *one), n.mul_add(v[1], *two));
                }
            }
        }
        for (side, a) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            for b in 0..2 {
                add(&mut to[side][a][b], 0, sums[side][a][b][0]);
                add(&mut to[side][a][b], 2 * MAX_LINE_NODES, sums[side][a][b][1]);
            }
        }
    }
}

/// Adds to the four columns from `first` on.
#[inline(always)]
fn add<L: Lanes>(row: &mut [f64; LINE_COLUMNS], first: usize, sum: L) {
    let Some(four) = row[first..].first_chunk_mut::<4>() else { return };
    *four = (L::load(four) + sum).store();
}
