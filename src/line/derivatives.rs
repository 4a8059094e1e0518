//! The exact derivatives of the weights of a pair of lines (docs/formulation.md 13.3). With v1 and v2, how fast the parts' points
//! move along t, linear between the parts' nodes:
//!
//! Dn_AC = int [ -(N_A' v1 N_C + N_A N_C' v2) rho + N_A N_C Drho ] ds + [ N_A N_C rho v ] at the ends,
//!
//! v at an end of the overlap that of the node which is that end, Drho = rho' (L_a Dr_a + L_b Dr_b - v1 (r_b - r_a) / (s_b - s_a)).

use super::facet::{LineFacet, MAX_LINE_NODES};
use super::segment::{Measure, NODES};
use super::weights::{PartPair, Point, all_parts};
use crate::mortar::MultiplierSpace;

/// Columns: two components of each of the non-mortar line's nodes, then of the mortar line's.
pub const LINE_COLUMNS: usize = 4 * MAX_LINE_NODES;

/// One weight's derivatives.
type Row = [[[f64; LINE_COLUMNS]; MAX_LINE_NODES]; MAX_LINE_NODES];

/// Dn_AB and Dn_AC: `[A][B][column]`, column 2 k + i of component i of the non-mortar line's node k, 2 (3 + k) + i of the
/// mortar line's, whatever number of nodes they have.
#[derive(Clone, Copy, Debug)]
pub struct LineDerivatives {
    /// Dn_AB.
    pub ab: Row,
    /// Dn_AC.
    pub ac: Row,
}

/// What a weight depends on within two parts: s of the four nodes, then r of the non-mortar ones.
const MOTIONS: usize = NODES + 2;

/// Derivatives of all weights with respect to the motions.
#[derive(Default)]
struct ByMotion {
    of: [[[[f64; MOTIONS]; MAX_LINE_NODES]; MAX_LINE_NODES]; 2],
}

impl Default for LineDerivatives {
    fn default() -> Self {
        let zeros = [[[0.0; LINE_COLUMNS]; MAX_LINE_NODES]; MAX_LINE_NODES];
        LineDerivatives { ab: zeros, ac: zeros }
    }
}

impl LineDerivatives {
    /// Those of a pair; zeros where it does not overlap. Cost: some four times that of the weights.
    pub fn new(one: &LineFacet, two: &LineFacet, space: MultiplierSpace, measure: Measure) -> LineDerivatives {
        let mut d = LineDerivatives::default();
        all_parts(one, two).for_each(|parts| d.add_parts([one, two], parts, space, measure));
        d
    }

    /// Adds those over part `i` of the first facet and part `j` of the second one.
    pub fn add_parts(
        &mut self,
        facets: [&LineFacet; 2],
        parts: (usize, usize),
        space: MultiplierSpace,
        measure: Measure,
    ) {
        let Some(pair) = PartPair::of(facets, parts, space) else { return };
        let mut motions = ByMotion::default();
        pair.for_points(|p| motions.add_point(&pair, p, measure));
        for (end, sign) in pair.segment.ends.into_iter().zip([-1.0, 1.0]) {
            motions.add_end(&pair, &pair.at(end.0, sign), end.1, measure);
        }
        self.chain(&pair, &motions);
    }

    /// Adds what the nodes' motions make of those of s and r.
    fn chain(&mut self, parts: &PartPair, motions: &ByMotion) {
        let [[a, b], [c, d]] = parts.nodes;
        let slots = [a, b, MAX_LINE_NODES + c, MAX_LINE_NODES + d];
        let of_s: [_; NODES] = std::array::from_fn(|k| parts.segment.motion(k));
        for (target, source) in [&mut self.ab, &mut self.ac].into_iter().zip(&motions.of) {
            for (row, of) in target.iter_mut().flatten().zip(source.iter().flatten()) {
                for (node, slot) in slots.into_iter().enumerate() {
                    for i in 0..2 {
                        row[2 * slot + i] += (0..NODES).map(|k| of[k] * of_s[k][node][i]).sum::<f64>();
                    }
                }
                row[2 * slots[0]] += of[NODES];
                row[2 * slots[1]] += of[NODES + 1];
            }
        }
    }
}

impl ByMotion {
    /// The integrand at a point.
    fn add_point(&mut self, parts: &PartPair, p: &Point, measure: Measure) {
        let (segment, rho) = (&parts.segment, measure.at(p.shares[0], parts.segment.r) * p.ds);
        let slope = measure.slope() * p.ds;
        let lean = slope * (segment.r[1] - segment.r[0]) / (segment.s[1] - segment.s[0]);
        for side in 0..2 {
            for (a, b) in (0..MAX_LINE_NODES).flat_map(|a| (0..MAX_LINE_NODES).map(move |b| (a, b))) {
                let n = p.test[a] * p.n[side][b];
                let of_test = p.test_slope[a] * p.n[side][b];
                let of_other = p.test[a] * p.slope[side][b];
                // What moves with the non-mortar part, and with the mortar one.
                let one = -rho * (of_test + if side == 0 { of_other } else { 0.0 }) - n * lean;
                let two = if side == 0 { 0.0 } else { -rho * of_other };
                let of = &mut self.of[side][a][b];
                for end in 0..2 {
                    of[end] += one * p.shares[0][end];
                    of[2 + end] += two * p.shares[1][end];
                    of[NODES + end] += n * slope * p.shares[0][end];
                }
            }
        }
    }

    /// An end of the overlap, which is the part's node `node`; `p.ds` is its sign.
    fn add_end(&mut self, parts: &PartPair, p: &Point, node: usize, measure: Measure) {
        let rho = measure.at(p.shares[0], parts.segment.r) * p.ds;
        for side in 0..2 {
            for (a, b) in (0..MAX_LINE_NODES).flat_map(|a| (0..MAX_LINE_NODES).map(move |b| (a, b))) {
                self.of[side][a][b][node] += rho * p.test[a] * p.n[side][b];
            }
        }
    }
}
