//! Averaged nodal normals (docs/formulation.md 4.1): nu_A is minus the normalised, unweighted sum of the
//! unit corner normals of the non-mortar facets at A, so it points INTO the non-mortar body.

use crate::error::{Error, Kind, Result};
use crate::geometry::{Facet, Vec3};

/// A sum of unit normals shorter than this has no direction: the facets around the node face each
/// other, or the node is a knife's edge.
pub const SMALLEST_SUM: f64 = 1e-6;

/// Unit normal at corner k of a facet, out of the body; zero where the corner is degenerate.
pub fn corner_normal(facet: &Facet, k: usize) -> Vec3 {
    let n = facet.len();
    let x = &facet.nodes;
    let w = (x[(k + 1) % n] - x[k]).cross(&(x[(k + n - 1) % n] - x[k]));
    let norm = w.norm();
    if norm > 0.0 { w / norm } else { Vec3::zeros() }
}

/// nu_A from the sum of the corner normals around node `node`.
///
/// # Errors
/// [`Kind::UndefinedNormal`] when the normals cancel, [`Kind::NotFinite`] when the sum is too long to have a length.
pub fn nodal_normal(sum: Vec3, node: usize) -> Result<Vec3> {
    let norm = sum.norm();
    if norm == f64::INFINITY {
        let text = text!("the sum of the normals at non-mortar node {node} overflows; it is one of unit vectors");
        return Err(Error::new(Kind::NotFinite, text));
    }
    if !(norm > SMALLEST_SUM) {
        return Err(Error::new(
            Kind::UndefinedNormal,
            text!(
                "the normals of the facets around non-mortar node {node} cancel; split the surface along its creases, or give a normal"
            ),
        ));
    }
    Ok(-sum / norm)
}
