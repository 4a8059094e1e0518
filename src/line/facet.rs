//! A line facet: two end nodes a and b, and of the quadratic kind a node in the middle, in this order. Its parts are the
//! straight lines between neighbouring nodes; xi runs from -1 at a to 1 at b.

use super::segment::Measure;
use crate::error::{Error, Kind, Result};
use crate::geometry::Vec2;
use crate::mortar::{AreaElement, MultiplierSpace};
use crate::shape::MAX_CORNERS;

/// Most nodes of a line facet.
pub const MAX_LINE_NODES: usize = 3;
/// dx/dxi along the chord at a node, over half of the chord, is above this. 0 is a middle node at a quarter of a straight
/// line, where the direction at the end is made of rounding.
const LEAST_JACOBIAN: f64 = 1e-3;

/// Where the nodes stand.
pub(super) const XI: [f64; MAX_LINE_NODES] = [-1.0, 1.0, 0.0];

/// A line facet, as hosts have it.
#[derive(Clone, Copy, Debug)]
pub struct LineFacet {
    /// 2 or 3 nodes.
    pub n: usize,
    /// Node positions: the ends, then the middle.
    pub x: [Vec2; MAX_LINE_NODES],
}

impl LineFacet {
    /// The facet through 2 or 3 finite points.
    ///
    /// # Errors
    /// [`Kind::InvalidSize`]: another number; [`Kind::NotFinite`]; [`Kind::DegenerateFacet`]: no length, or a middle node that is
    /// a quarter of the line from an end, or nearer.
    #[inline]
    pub fn new(nodes: &[Vec2]) -> Result<LineFacet> {
        let n = nodes.len();
        if !(2..=MAX_LINE_NODES).contains(&n) {
            return Err(Error::new(Kind::InvalidSize, text!("a line has {n} nodes; 2 or 3 are allowed")));
        }
        let mut x = [nodes[0]; MAX_LINE_NODES];
        x[..n].copy_from_slice(nodes);
        if let Some(k) = (0..n).find(|&k| !x[k].iter().all(|c| c.is_finite())) {
            return Err(Error::new(Kind::NotFinite, text!("node {k} of a line is not finite")));
        }
        let facet = LineFacet { n, x };
        let chord = x[1] - x[0];
        if !(chord.norm_squared() > 0.0) {
            return Err(Error::new(Kind::DegenerateFacet, text!("the ends of a line are at one place")));
        }
        for k in 0..n {
            if !(facet.tangent(k).dot(&chord) > LEAST_JACOBIAN * 0.5 * chord.norm_squared()) {
                let text = text!(
                    "at its node {k} a line turns back; the nodes are the ends, then the middle one, farther than a quarter of the line from both"
                );
                return Err(Error::new(Kind::DegenerateFacet, text));
            }
        }
        Ok(facet)
    }

    /// The parts, pairs of nodes, from a to b.
    #[inline]
    pub fn parts(&self) -> &'static [[usize; 2]] {
        if self.n == 2 { &[[0, 1]] } else { &[[0, 2], [2, 1]] }
    }

    /// How many multipliers it has: its first so many nodes do.
    #[inline]
    pub fn multipliers(&self, space: MultiplierSpace) -> usize {
        if space == MultiplierSpace::Corner { 2 } else { self.n }
    }

    /// int N_A rho ds of the multipliers over the whole facet, covered or not: lengths times rho's unit.
    pub fn areas(&self, space: MultiplierSpace, measure: Measure) -> [f64; MAX_LINE_NODES] {
        let mut areas = [0.0; MAX_LINE_NODES];
        for &part in self.parts() {
            let [a, b] = part.map(|k| self.x[k]);
            // Both factors are linear along the part: Simpson's rule is exact.
            for (at, weight) in [(0.0, 1.0), (0.5, 4.0), (1.0, 1.0)] {
                let shares = [1.0 - at, at];
                let w = (b - a).norm() * weight / 6.0 * measure.at(shares, [a.x, b.x]);
                match space {
                    MultiplierSpace::Sub => (0..2).for_each(|end| areas[part[end]] += w * shares[end]),
                    MultiplierSpace::Corner => {
                        let n = ends(shares[0] * XI[part[0]] + shares[1] * XI[part[1]]);
                        (0..2).for_each(|end| areas[end] += w * n[end]);
                    }
                }
            }
        }
        areas
    }

    /// The derivative of int rho ds over the whole facet with respect to its nodes.
    pub fn area_derivative(&self, measure: Measure) -> [Vec2; MAX_LINE_NODES] {
        let mut d = [Vec2::zeros(); MAX_LINE_NODES];
        for &[k, l] in self.parts() {
            let (a, b) = (self.x[k], self.x[l]);
            let (length, rho) = ((b - a).norm(), measure.at([0.5, 0.5], [a.x, b.x]));
            let stretch = (b - a) * (rho / length);
            let wider = Vec2::new(0.5 * length * measure.slope(), 0.0);
            d[k] += wider - stretch;
            d[l] += wider + stretch;
        }
        d
    }

    /// The area element of a part, rho ds/du with u from -1 to 1, and its derivative.
    pub fn area_element(&self, part: usize, measure: Measure) -> AreaElement {
        let [a, b] = self.parts()[part].map(|k| self.x[k]);
        let (length, t) = ((b - a).norm(), (b - a).normalize());
        let [middle, end] = [[0.5, 0.5], [0.0, 1.0]].map(|shares| measure.at(shares, [a.x, b.x]));
        let rho = [middle, end - middle]; // at 0, and its slope
        let mut motion = [[[0.0; MAX_CORNERS]; 3]; 3];
        for (m, rho) in rho.into_iter().enumerate() {
            for j in 0..2 {
                (motion[m][j][0], motion[m][j][1]) = (-0.5 * rho * t[j], 0.5 * rho * t[j]);
            }
            // Half the length times half of 2 pi: r at the middle is the mean, and its slope half the difference.
            let wider = 0.25 * length * measure.slope();
            motion[m][0][0] += if m == 0 { wider } else { -wider };
            motion[m][0][1] += wider;
        }
        AreaElement { of: [0.5 * length * rho[0], 0.5 * length * rho[1], 0.0], motion }
    }

    /// The direction of the line at a node, from a to b, not of length 1 `[L]`.
    #[inline]
    pub fn tangent(&self, node: usize) -> Vec2 {
        let slopes = self.slopes(XI[node]);
        // Differences of nodes: exact under a common offset.
        (1..self.n).map(|b| (self.x[b] - self.x[0]) * slopes[b]).sum()
    }

    /// Shape functions.
    pub(super) fn values(&self, xi: f64) -> [f64; MAX_LINE_NODES] {
        let [a, b] = ends(xi);
        if self.n == 2 { [a, b, 0.0] } else { [-a * xi, b * xi, 1.0 - xi * xi] }
    }

    /// Their derivatives with respect to xi.
    pub(super) fn slopes(&self, xi: f64) -> [f64; MAX_LINE_NODES] {
        if self.n == 2 { [-0.5, 0.5, 0.0] } else { [xi - 0.5, xi + 0.5, -2.0 * xi] }
    }
}

/// (1 - xi) / 2, (1 + xi) / 2.
pub(super) fn ends(xi: f64) -> [f64; 2] {
    [0.5 * (1.0 - xi), 0.5 * (1.0 + xi)]
}
