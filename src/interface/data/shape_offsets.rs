//! Offsets that give a faceted surface back its shape (docs/formulation 15.5): of each node the mean of the signed distance of
//! its facets from the shape, weighted with the node's function, along the facets' normals and then the node's, as gaps are
//! measured. Facets are chords: of a shaft they lie inside it, and the offset
//! closes a gap; of a bore they lie in the hole, and it opens one.

use super::surface::Surface;
use crate::error::{Error, Kind, Result};
use crate::geometry::{AnalyticSurface, Vec3};
use crate::interface::compose::{self, Feature, Features};
use crate::memory::{self, Stored};
use crate::normal::nodal_normal;
use crate::quadrature::cell::{line_of, square_point, triangle_point};

/// Points along a facet: the distance is nearly a parabola, and exact means are wanted of coarse facets, too.
const POINTS: usize = 5;
/// A node farther from the shape than this, over the longest edge of the surface, is not on it.
const FARTHEST: f64 = 1.0;
/// A facet that is steeper to the shape is none of its chords; 60 degrees. One that looks the other way by more is on the wrong
/// side of it.
const LEAST_COSINE: f64 = 0.5;

/// Of each node of a surface in its first configuration `[L]`.
///
/// # Errors
/// [`Kind::Unsupported`] of facets with mid nodes, which follow a shape by themselves, and of an analytic surface;
/// [`Kind::InvalidValue`] where a node is farther from the shape than the longest facet is long, or a facet looks into its body.
pub fn shape_offsets(surface: &Surface, shape: &AnalyticSurface) -> Result<Vec<f64>> {
    let side = surface.side;
    compose::refuse(Features::which(&[
        (Feature::ShapeOffsets, true),
        (Feature::Analytic, surface.analytic.is_some()),
        (Feature::MidNodes, surface.has_mid_nodes()),
    ]))?;
    let (n, lines) = (surface.len(), surface.lines().is_some());
    let far = |x: &Vec3| shape.distance(x - shape.origin).abs() > FARTHEST * surface.longest_edge;
    if let Some(k) = surface.reference.iter().position(far) {
        let text = text!(
            "{side} node {k} is {:.3e} away from the shape, more than the longest edge ({:.3e}): is it the shape of this side?",
            shape.distance(surface.reference[k] - shape.origin),
            surface.longest_edge
        );
        return Err(Error::new(Kind::InvalidValue, text));
    }
    let mut normals = Vec::new();
    surface.add_normals(&surface.reference, &mut normals)?;
    for (a, sum) in normals.iter_mut().enumerate() {
        *sum = nodal_normal(*sum, a)?;
    }
    let line = line_of(POINTS).expect("there are as many points");
    let mut sums = memory::filled((0.0_f64, 0.0_f64), n)?;
    for (f, nodes) in surface.facets.iter().enumerate() {
        let facet = surface.facet(f, &surface.reference);
        let (triangle, out) = (facet.shape.n == 3, facet.area_vector());
        let (size, e) = (out.norm(), out.normalize());
        for [xi, eta, weight] in
            (0..POINTS * POINTS).map(|i| if triangle { triangle_point(line, i) } else { square_point(line, i) })
        {
            let values = facet.shape.values(xi, eta);
            let mut x: Vec3 = facet.nodes.iter().zip(values).map(|(x, n)| x * n).sum();
            if lines {
                x.z = 0.0;
            }
            let Some(closest) = shape.closest(x - shape.origin) else { continue };
            if closest.normal.dot(&e) < -LEAST_COSINE {
                let text = text!(
                    "{side} facet {} looks into the body of the shape: the radius is above 0 of a ball or a bar, whose body is inside, and below 0 of a cavity or a bore; turn its sign round",
                    surface.host_facet(f)
                );
                return Err(Error::new(Kind::InvalidValue, text));
            }
            let distance = closest.distance / closest.normal.dot(&e).abs().max(LEAST_COSINE);
            for (k, value) in values.iter().enumerate().take(facet.shape.n) {
                // The quadrilateral of a line has each of its nodes twice: a, b, b, a.
                let node = if lines { nodes.nodes[[0, 1, 1, 0][k]] } else { nodes.nodes[k] };
                let (share, along) = (weight * value * size, -e.dot(&normals[node]));
                (sums[node].0, sums[node].1) = (sums[node].0 + share, sums[node].1 + share * distance * along);
            }
        }
    }
    sums.iter().map(|(area, sum)| sum / area).stored()
}
