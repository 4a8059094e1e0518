//! The weights of a pair of lines (docs/formulation 13.2): n_AB = int N_A N_B rho ds, n_AC = int N_A N_C rho ds.

use super::facet::{LineFacet, MAX_LINE_NODES, XI, ends};
use super::linear;
use super::segment::{LineSegment, Measure};
use crate::features;
use crate::mortar::MultiplierSpace;
use crate::quadrature::line::GAUSS_3;

/// n_AB and n_AC `[L]` times rho's unit: row A, of the nodes with a multiplier.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LineWeights {
    /// n_AB.
    pub ab: [[f64; MAX_LINE_NODES]; MAX_LINE_NODES],
    /// n_AC.
    pub ac: [[f64; MAX_LINE_NODES]; MAX_LINE_NODES],
}

/// A point of an overlap: functions of the pair there, and the weight with rho.
pub(super) struct Point {
    /// The weight ds.
    pub ds: f64,
    /// Shares of a and b, of c and d.
    pub shares: [[f64; 2]; 2],
    /// N_A of the multipliers, by node of the facet, and N_A'.
    pub test: [f64; MAX_LINE_NODES],
    pub test_slope: [f64; MAX_LINE_NODES],
    /// N_B, N_C, and their derivatives with respect to s.
    pub n: [[f64; MAX_LINE_NODES]; 2],
    pub slope: [[f64; MAX_LINE_NODES]; 2],
}

/// Two parts of a pair, with the functions of the whole facets on them.
pub(super) struct PartPair<'a> {
    pub facets: [&'a LineFacet; 2],
    /// Nodes of the facets that the parts lie between.
    pub nodes: [[usize; 2]; 2],
    pub segment: LineSegment,
    pub space: MultiplierSpace,
}

impl<'a> PartPair<'a> {
    /// Part `i` of the first facet and part `j` of the second one, if they overlap.
    #[inline]
    pub fn of(facets: [&'a LineFacet; 2], (i, j): (usize, usize), space: MultiplierSpace) -> Option<PartPair<'a>> {
        features::LINES.is_here();
        let [one, two] = [facets[0].parts()[i], facets[1].parts()[j]];
        let x = [facets[0].x[one[0]], facets[0].x[one[1]], facets[1].x[two[0]], facets[1].x[two[1]]];
        LineSegment::new(x).map(|segment| PartPair { facets, nodes: [one, two], segment, space })
    }
}

/// The numbers of all pairs of parts.
#[inline]
pub(super) fn all_parts(one: &LineFacet, two: &LineFacet) -> impl Iterator<Item = (usize, usize)> + use<> {
    let (n1, n2) = (one.parts().len(), two.parts().len());
    (0..n1).flat_map(move |i| (0..n2).map(move |j| (i, j)))
}

impl PartPair<'_> {
    /// Multipliers, at the first nodes of the non-mortar line.
    #[inline]
    pub fn rows(&self) -> usize {
        self.facets[0].multipliers(self.space)
    }

    /// The functions at s.
    #[inline(always)]
    pub fn at(&self, s: f64, ds: f64) -> Point {
        let mut point = Point {
            ds,
            shares: [0, 1].map(|side| self.segment.shares(side, s)),
            test: [0.0; MAX_LINE_NODES],
            test_slope: [0.0; MAX_LINE_NODES],
            n: [[0.0; MAX_LINE_NODES]; 2],
            slope: [[0.0; MAX_LINE_NODES]; 2],
        };
        let mut place = [(0.0, 0.0); 2];
        for side in 0..2 {
            let ([k, l], [p, q]) = (self.nodes[side], point.shares[side]);
            let (xi, rise) = (p * XI[k] + q * XI[l], XI[l] - XI[k]);
            let per_s = self.segment.per[side];
            place[side] = (xi, rise * per_s);
            point.n[side] = self.facets[side].values(xi);
            point.slope[side] = self.facets[side].slopes(xi).map(|d| d * rise * per_s);
        }
        match self.space {
            MultiplierSpace::Corner => {
                let (xi, per_s) = place[0];
                point.test[..2].copy_from_slice(&ends(xi));
                point.test_slope[..2].copy_from_slice(&[-0.5 * per_s, 0.5 * per_s]);
            }
            MultiplierSpace::Sub => {
                let per_s = self.segment.per[0];
                for (end, &node) in self.nodes[0].iter().enumerate() {
                    point.test[node] = point.shares[0][end];
                    point.test_slope[node] = if end == 0 { -per_s } else { per_s };
                }
            }
        }
        point
    }

    /// Whether both lines have two nodes.
    #[inline]
    pub fn is_linear(&self) -> bool {
        self.facets.iter().all(|facet| facet.n == 2)
    }

    /// Calls `visit` with the points of a rule that is exact: the functions are of degree 2, rho is of degree 1, and a derivative
    /// has the degree of its weight. `linear.rs` has the points of two lines with two nodes.
    #[inline(always)]
    pub fn for_points(&self, mut visit: impl FnMut(&Point)) {
        let [(from, _), (to, _)] = self.segment.ends;
        for [at, weight] in GAUSS_3 {
            visit(&self.at(from + at * (to - from), weight * (to - from)));
        }
    }
}

impl LineWeights {
    /// Those of a pair; zeros where it does not overlap. Cost: some 0.1 microseconds a pair of parts.
    #[inline]
    pub fn new(one: &LineFacet, two: &LineFacet, space: MultiplierSpace, measure: Measure) -> LineWeights {
        let mut weights = LineWeights::default();
        all_parts(one, two).for_each(|parts| weights.add_parts([one, two], parts, space, measure));
        weights
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
        if pair.is_linear() {
            self.add_linear(&linear::weights(&pair.segment, measure));
        } else {
            pair.for_points(|p| self.add(&pair, p, measure));
        }
    }

    /// Adds those of two lines with two nodes.
    #[inline]
    pub(super) fn add_linear(&mut self, [ab, ac]: &linear::Weights) {
        for (a, b) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            self.ab[a][b] += ab[a][b];
            self.ac[a][b] += ac[a][b];
        }
    }

    /// The integrand at a point.
    #[inline(always)]
    pub(super) fn add(&mut self, parts: &PartPair, p: &Point, measure: Measure) {
        let w = p.ds * measure.at(p.shares[0], parts.segment.r);
        let [n1, n2] = parts.facets.map(|facet| facet.n);
        for a in 0..parts.rows() {
            let w = w * p.test[a];
            (0..n1).for_each(|b| self.ab[a][b] += w * p.n[0][b]);
            (0..n2).for_each(|c| self.ac[a][c] += w * p.n[1][c]);
        }
    }
}
