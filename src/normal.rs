//! Averaged nodal normals (docs/formulation 4.1) and their derivatives (11.1): nu_A is minus the normalised, unweighted
//! sum of the unit corner normals of the non-mortar facets at A, so it points INTO the non-mortar body.

use crate::error::{Error, Kind, Result};
use crate::geometry::{Facet, Mat3, Vec3};
use nalgebra::SMatrix;

/// A sum of unit normals shorter than this has no direction: the facets around the node face each
/// other, or the node is a knife's edge.
pub const SMALLEST_SUM: f64 = 1e-6;

/// Unit normal at corner k of a facet, out of the body; zero where the corner is degenerate.
pub fn corner_normal(facet: &Facet, k: usize) -> Vec3 {
    let [a, b] = edges(facet, k);
    let w = a.cross(&b);
    let norm = w.norm();
    if norm > 0.0 { w / norm } else { Vec3::zeros() }
}

/// The angle between two unit vectors, exact where it is small, as the scalar product is not.
pub fn angle(from: &Vec3, to: &Vec3) -> f64 {
    2.0 * ((from - to).norm() / 2.0).min(1.0).asin()
}

/// The edges at corner k of a facet, to the next corner and to the previous one.
fn edges(facet: &Facet, k: usize) -> [Vec3; 2] {
    let (n, x) = (facet.len(), &facet.nodes);
    [x[(k + 1) % n] - x[k], x[(k + n - 1) % n] - x[k]]
}

/// `rows` times the derivatives of m, the unit normal at corner k of a facet: each corner that it depends on, with
/// `rows` Dm / Dx of it. With the edges a and b, Dm = (I - m m^T) (Da x b + a x Db) / |a x b|. Zero where the corner is degenerate.
pub fn corner_normal_derivatives<const R: usize>(
    facet: &Facet,
    k: usize,
    rows: &SMatrix<f64, R, 3>,
) -> [(usize, SMatrix<f64, R, 3>); 3] {
    let n = facet.len();
    let [a, b] = edges(facet, k);
    let w = a.cross(&b);
    let norm = w.norm();
    let (mut next, mut previous) = (SMatrix::zeros(), SMatrix::zeros());
    if norm > 0.0 {
        let m = w / norm;
        for i in 0..R {
            let row = Vec3::new(rows[(i, 0)], rows[(i, 1)], rows[(i, 2)]);
            let row = (row - m * row.dot(&m)) / norm;
            // row . (Da x b) = (b x row) . Da, row . (a x Db) = (row x a) . Db
            let (of_a, of_b) = (b.cross(&row), row.cross(&a));
            for j in 0..3 {
                (next[(i, j)], previous[(i, j)]) = (of_a[j], of_b[j]);
            }
        }
    }
    [((k + 1) % n, next), ((k + n - 1) % n, previous), (k, -next - previous)]
}

/// D nu / D s of the nodal normal nu = -Q s / |Q s| from the sum s of corner normals; Q projects on the free directions.
pub fn nodal_normal_derivative(sum: Vec3, free: &Mat3) -> Mat3 {
    let s = free * sum;
    let norm = s.norm();
    let nu = s / norm;
    (nu * nu.transpose() - Mat3::identity()) * free / norm
}

/// A vector that turns as one unit normal turns to another, by the smallest rotation. Where they are opposite that is any
/// half turn across the normal: what lies along the surface then stays.
pub fn turned(v: Vec3, from: Vec3, to: Vec3) -> Vec3 {
    let along = from.dot(&v);
    let tangential = v - from * along;
    let cosine = from.dot(&to);
    // Rounding of the quotient below, over the square root of the machine epsilon.
    const OPPOSITE: f64 = 1e-8;
    let carried =
        if 1.0 + cosine > OPPOSITE { (from + to) * (to.dot(&tangential) / (1.0 + cosine)) } else { Vec3::zeros() };
    to * along + tangential - carried
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
