//! A line facet: two end nodes a and b, and of the quadratic kind a node in the middle, in this order. Its parts are the
//! straight lines between neighbouring nodes; xi runs from -1 at a to 1 at b.

use crate::error::{Error, Kind, Result};
use crate::geometry::Vec2;
use crate::mortar::MultiplierSpace;

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
        for (k, &xi) in XI[..n].iter().enumerate() {
            let slopes = facet.slopes(xi);
            let tangent: Vec2 = (1..n).map(|b| (x[b] - x[0]) * slopes[b]).sum();
            if !(tangent.dot(&chord) > LEAST_JACOBIAN * 0.5 * chord.norm_squared()) {
                let text = text!(
                    "at its node {k} a line turns back; the nodes are the ends, then the middle one, farther than a quarter of the line from both"
                );
                return Err(Error::new(Kind::DegenerateFacet, text));
            }
        }
        Ok(facet)
    }

    /// Pairs of nodes, from a to b.
    pub(super) fn parts(&self) -> &'static [[usize; 2]] {
        if self.n == 2 { &[[0, 1]] } else { &[[0, 2], [2, 1]] }
    }

    /// How many multipliers it has: its first so many nodes do.
    pub fn multipliers(&self, space: MultiplierSpace) -> usize {
        if space == MultiplierSpace::Corner { 2 } else { self.n }
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
