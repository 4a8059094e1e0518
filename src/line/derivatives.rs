//! The exact derivatives of the weights of a pair of lines (docs/formulation 13.3). With v1 and v2, how fast the parts' points
//! move along t, linear between the parts' nodes:
//!
//! Dn_AC = int [ -(N_A' v1 N_C + N_A N_C' v2) rho + N_A N_C Drho ] ds + [ N_A N_C rho v ] at the ends,
//!
//! v at an end of the overlap that of the node which is that end, Drho = rho' (L_a Dr_a + L_b Dr_b - v1 (r_b - r_a) / (s_b - s_a)).

use super::facet::{LineFacet, MAX_LINE_NODES};
use super::linear::{self, LINE_COLUMNS, Linear, Rows};
use super::segment::{Measure, NODES};
use super::weights::{LineWeights, PartPair, Point, all_parts};
use crate::geometry::Vec2;
use crate::mortar::MultiplierSpace;
use crate::simd;

/// Dn_AB and Dn_AC: `[A][B][column]`, column 2 k + i of component i of the non-mortar line's node k, 2 (3 + k) + i of the
/// mortar line's, whatever number of nodes they have.
#[derive(Clone, Copy, Debug)]
pub struct LineDerivatives {
    /// Dn_AB.
    pub ab: Rows,
    /// Dn_AC.
    pub ac: Rows,
}

/// A weight's derivatives by what it depends on within two parts: s of the four nodes, then r of the non-mortar ones.
#[derive(Clone, Copy, Default)]
struct ByMotion {
    of_s: [f64; NODES],
    of_r: [f64; 2],
}

impl Default for LineDerivatives {
    fn default() -> LineDerivatives {
        let zeros = [[[0.0; LINE_COLUMNS]; MAX_LINE_NODES]; MAX_LINE_NODES];
        LineDerivatives { ab: zeros, ac: zeros }
    }
}

impl LineDerivatives {
    /// Those of a pair; zeros where it does not overlap.
    pub fn new(one: &LineFacet, two: &LineFacet, space: MultiplierSpace, measure: Measure) -> LineDerivatives {
        let mut d = LineDerivatives::default();
        d.add(one, two, space, measure);
        d
    }

    /// Adds those of a pair, and gives its weights, with the bits of [`LineWeights::new`]. Cost: two to three times theirs.
    pub fn add(&mut self, one: &LineFacet, two: &LineFacet, space: MultiplierSpace, measure: Measure) -> LineWeights {
        let mut weights = LineWeights::default();
        for parts in all_parts(one, two) {
            self.add_parts([one, two], parts, space, measure, &mut weights);
        }
        weights
    }

    /// Adds those over part `i` of the first facet and part `j` of the second one, and to `weights` the weights.
    pub fn add_parts(
        &mut self,
        facets: [&LineFacet; 2],
        parts: (usize, usize),
        space: MultiplierSpace,
        measure: Measure,
        weights: &mut LineWeights,
    ) {
        let Some(pair) = PartPair::of(facets, parts, space) else { return };
        if pair.is_linear() {
            weights.add_linear(&linear::weights(&pair.segment, measure));
            simd::dispatch(Linear(&pair.segment, measure, [&mut self.ab, &mut self.ac]));
        } else {
            self.add_part_pair(&pair, measure, weights);
        }
    }

    fn add_part_pair(&mut self, parts: &PartPair, measure: Measure, weights: &mut LineWeights) {
        let mut motions = [[[ByMotion::default(); MAX_LINE_NODES]; MAX_LINE_NODES]; 2];
        parts.for_points(|p| {
            weights.add(parts, p, measure);
            add_point::<0>(&mut motions[0], (parts, p), measure);
            add_point::<1>(&mut motions[1], (parts, p), measure);
        });
        for (end, sign) in parts.segment.ends.into_iter().zip([-1.0, 1.0]) {
            let p = parts.at(end.0, sign);
            add_end::<0>(&mut motions[0], (parts, &p), end.1, measure);
            add_end::<1>(&mut motions[1], (parts, &p), end.1, measure);
        }
        for (to, of) in [&mut self.ab, &mut self.ac].into_iter().zip(&motions) {
            for (a, b) in all_nodes() {
                chain(parts, &of[a][b], &mut to[a][b]);
            }
        }
    }
}

/// A and B; the functions of nodes that a line has not are 0.
fn all_nodes() -> impl Iterator<Item = (usize, usize)> {
    (0..MAX_LINE_NODES).flat_map(|a| (0..MAX_LINE_NODES).map(move |b| (a, b)))
}

/// Adds what the nodes' motions make of those of s and r.
#[inline(always)]
fn chain(parts: &PartPair, of: &ByMotion, row: &mut [f64; LINE_COLUMNS]) {
    let [[a, b], [c, d]] = parts.nodes;
    let slots = [a, b, MAX_LINE_NODES + c, MAX_LINE_NODES + d];
    let [along, turn] = parts.segment.motion(&of.of_s);
    let frame: [Vec2; NODES] = [along - turn, along + turn, Vec2::zeros(), Vec2::zeros()];
    for (k, slot) in slots.into_iter().enumerate() {
        let v = frame[k] + parts.segment.t * of.of_s[k];
        row[2 * slot] += v.x;
        row[2 * slot + 1] += v.y;
    }
    row[2 * a] += of.of_r[0];
    row[2 * b] += of.of_r[1];
}

/// The integrand at a point, of the weights with the nodes of a side.
#[inline(always)]
fn add_point<const SIDE: usize>(
    to: &mut [[ByMotion; MAX_LINE_NODES]; MAX_LINE_NODES],
    (parts, p): (&PartPair, &Point),
    measure: Measure,
) {
    let (segment, rho) = (&parts.segment, measure.at(p.shares[0], parts.segment.r) * p.ds);
    let slope = measure.slope() * p.ds;
    let lean = slope * (segment.r[1] - segment.r[0]) * segment.per[0];
    for (a, b) in all_nodes() {
        let n = p.test[a] * p.n[SIDE][b];
        let of_test = p.test_slope[a] * p.n[SIDE][b];
        let of_other = p.test[a] * p.slope[SIDE][b];
        // What moves with the non-mortar part, and with the mortar one.
        let one = -rho * (of_test + if SIDE == 0 { of_other } else { 0.0 }) - n * lean;
        let of = &mut to[a][b];
        for end in 0..2 {
            of.of_s[end] += one * p.shares[0][end];
            of.of_r[end] += n * slope * p.shares[0][end];
            if SIDE == 1 {
                of.of_s[2 + end] -= rho * of_other * p.shares[1][end];
            }
        }
    }
}

/// An end of the overlap, which is the part's node `node`; `p.ds` is its sign.
#[inline(always)]
fn add_end<const SIDE: usize>(
    to: &mut [[ByMotion; MAX_LINE_NODES]; MAX_LINE_NODES],
    (parts, p): (&PartPair, &Point),
    node: usize,
    measure: Measure,
) {
    let rho = measure.at(p.shares[0], parts.segment.r) * p.ds;
    for (a, b) in all_nodes() {
        to[a][b].of_s[node] += rho * p.test[a] * p.n[SIDE][b];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::on_plain_lanes;

    /// Sums of some ten products.
    const ROUNDING: f64 = 1e-14;

    /// Two lines with two nodes have kernels of their own: they are what the ones for all lines give, on any back end.
    #[test]
    fn lines_of_two_nodes_are_as_others() {
        let mut state = 1_u64;
        let mut random = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        let mut met = 0;
        for k in 0..400 {
            let mut at = |x: f64, y: f64| Vec2::new(3.0 + x + 0.2 * random(), y + 0.2 * random());
            let one = LineFacet::new(&[at(0.0, 0.0), at(1.0, 0.0)]).unwrap();
            let shift = 1.2 * (k % 20) as f64 / 10.0 - 1.2;
            let two = LineFacet::new(&[at(1.0 + shift, 0.2), at(shift, 0.2)]).unwrap();
            let measure = if k % 2 == 0 { Measure::Axisymmetric } else { Measure::Thickness(0.7) };
            let (mut general, mut weights) = (LineDerivatives::default(), LineWeights::default());
            if let Some(pair) = PartPair::of([&one, &two], (0, 0), MultiplierSpace::Corner) {
                general.add_part_pair(&pair, measure, &mut weights);
                met += 1;
            }
            for plain in [false, true] {
                let mut d = LineDerivatives::default();
                let w = match plain {
                    true => on_plain_lanes(|| d.add(&one, &two, MultiplierSpace::Sub, measure)),
                    false => d.add(&one, &two, MultiplierSpace::Sub, measure),
                };
                assert_eq!(w, LineWeights::new(&one, &two, MultiplierSpace::Sub, measure));
                let rows = |d: &LineDerivatives| [d.ab, d.ac].concat().concat().concat();
                let weights_of = |w: &LineWeights| [w.ab, w.ac].concat().concat();
                let pairs = rows(&d).into_iter().zip(rows(&general));
                for (n, m) in pairs.chain(weights_of(&w).into_iter().zip(weights_of(&weights))) {
                    assert!((n - m).abs() <= 100.0 * ROUNDING, "{k}: {n:e}, {m:e}"); // 2 pi r is 20
                }
            }
        }
        assert!(met > 300, "{met}");
    }
}
