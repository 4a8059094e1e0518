//! Surfaces of plane and axisymmetric models: their facets are lines (docs/formulation 13). Nodes have z = 0.
//!
//! Search, heights and overlaps are those of quadrilaterals: each part of a line is given a width along z, the same one on
//! both sides. Weights, areas and derivatives are those of lines (`src/line`), whatever the width is.

use super::facet_nodes::FacetNodes;
use crate::adjacency::SharedEdge;
use crate::error::{Error, Kind, Result};
use crate::geometry::{Facet, Vec3};
use crate::line::{LineFacet, Measure};
use crate::memory::{self, Store};
use crate::mortar::ParentFacet;
use crate::shape::Shape;
use std::f64::consts::TAU;

/// What the lines of a surface stand for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lines {
    /// rho.
    pub measure: Measure,
    /// Their width along z `[L]`.
    pub width: f64,
}

impl Lines {
    /// Of parts between these nodes, as wide as the shortest one is long.
    pub fn of(measure: Measure, x: &[Vec3], parts: &[FacetNodes]) -> Lines {
        let length = |part: &FacetNodes| (x[part.nodes[1]] - x[part.nodes[0]]).norm();
        Lines { measure, width: parts.iter().map(length).fold(f64::INFINITY, f64::min) }
    }

    /// The quadrilateral of the part from a to b. Its normal is that of the line, out of the body: across a to b, to the right.
    pub fn facet(&self, [a, b]: [Vec3; 2]) -> Facet {
        let half = Vec3::new(0.0, 0.0, 0.5 * self.width);
        let shape = Shape::of(4).expect("there are quadrilaterals");
        Facet { nodes: [a - half, b - half, b + half, a + half], shape }
    }

    /// How long the lines around a node at `x` with this area M_A are: M_A over rho, whatever the thickness is `[L]`. At the axis
    /// rho is that of a line away from it.
    pub fn size(&self, area: f64, x: Vec3) -> f64 {
        match self.measure {
            Measure::Thickness(thickness) => area / thickness,
            Measure::Axisymmetric => (area / (TAU * x.x)).min((area / TAU).sqrt()),
        }
    }

    /// Refuses positions of a side that lie out of the plane, or beyond the axis.
    pub fn check(&self, side: &str, x: &[Vec3]) -> Result<()> {
        if let Some(k) = x.iter().position(|x| x.z != 0.0) {
            let text = text!("{side}: node {k} has z = {:e}; nodes of plane models have z = 0", x[k].z);
            return Err(Error::new(Kind::InvalidValue, text));
        }
        match self.measure.beyond_axis(x) {
            None => Ok(()),
            Some(k) => {
                let r = x[k].x;
                let text =
                    text!("{side}: node {k} has r = {r:e}, beyond the axis; r is the first coordinate, 0 or more");
                Err(Error::new(Kind::InvalidValue, text))
            }
        }
    }
}

/// The line that a facet of the host is.
pub fn line(facet: &ParentFacet) -> LineFacet {
    LineFacet { n: facet.parent.n, x: [0, 1, 2].map(|k| facet.x[k].xy()) }
}

/// Neighbouring parts: the node that both have, twice; the part that ends there, and the one that begins.
///
/// # Errors
/// [`Kind::InvalidValue`] where two parts end, or begin, at one node, naming both.
pub fn shared_ends<'a>(parts: usize, nodes: impl Fn(usize) -> &'a [usize]) -> Result<Vec<SharedEdge>> {
    let mut ends = memory::with_room(2 * parts)?;
    for f in 0..parts {
        ends.store((nodes(f)[1], false, f))?;
        ends.store((nodes(f)[0], true, f))?;
    }
    memory::sort(&mut ends)?;
    let mut shared = memory::with_room(parts)?;
    for pair in ends.windows(2) {
        let ((a, f_begins, f), (b, g_begins, g)) = (pair[0], pair[1]);
        if a != b {
            continue;
        }
        if f_begins == g_begins {
            let what = if f_begins { "begin" } else { "end" };
            let text = text!(
                "facets {f} and {g} both {what} at node {a}: the node order of one of them is reversed, or the surface branches there"
            );
            return Err(Error::new(Kind::InvalidValue, text));
        }
        shared.store(SharedEdge { nodes: [a, a], facets: [f, g] })?;
    }
    Ok(shared)
}
