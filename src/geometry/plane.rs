//! The auxiliary plane of a non-mortar facet and its derivative (docs/formulation 3.1).
//!
//! Through the mean of the nodes, normal e along the facet's normal at its centre. The in-plane frame
//! follows the first spanning vector and its spin is kept, so that translation and rotation
//! invariance of the weights' derivative hold exactly, whatever the quadrature.

use super::facet::Facet;
use super::vector::{Mat3, Vec3};
use crate::error::{Error, Kind, Result};
use crate::shape::MAX_CORNERS;

/// A facet flatter than this (area over squared longest edge) has no usable normal. The aspect ratio
/// 1e4 : 1 has 1e-4, rounding of the cross product 1e-16.
pub const SMALLEST_AREA_RATIO: f64 = 1e-12;

/// Orthonormal frame (t1, t2, e) of a facet's auxiliary plane.
#[derive(Clone, Copy, Debug)]
pub struct Plane {
    /// The facet's first node: coordinates are taken relative to it before anything else.
    pub reference: Vec3,
    /// The plane's point (mean of the nodes) relative to `reference`.
    pub origin: Vec3,
    /// In-plane axis along the first spanning vector.
    pub t1: Vec3,
    /// In-plane axis e x t1.
    pub t2: Vec3,
    /// Unit normal, out of the non-mortar body.
    pub e: Vec3,
    /// Spin: Dt1 . t2 = `sum_c spin[c] t2 . Dx_c` [1/L].
    pub spin: [f64; MAX_CORNERS],
    /// Tilt: t_j . De = `sum_c tilt[j][c] e . Dx_c` [1/L]. The spanning vectors lie in the plane, so only motions
    /// along e tilt it.
    pub tilt: [[f64; MAX_CORNERS]; 2],
    /// What rounding of the spanning vectors is multiplied by in the direction of their cross product, squared:
    /// 1 / sin^2 of the angle between them.
    pub condition_squared: f64,
    /// Normals of the planes of the facets beyond each edge, where they are known.
    pub beyond: [Option<Vec3>; MAX_CORNERS],
}

impl Plane {
    /// The auxiliary plane of `facet`.
    ///
    /// # Errors
    /// [`Kind::DegenerateFacet`] when the facet has (nearly) no area.
    pub fn of(facet: &Facet) -> Result<Plane> {
        let [w1, w2] = facet.spanning_vectors();
        let w = w1.cross(&w2);
        let norm = w.norm();
        let h = facet.longest_edge();
        // Written so that NaN is refused too.
        if !(norm > SMALLEST_AREA_RATIO * h * h) {
            return Err(Error::new(
                Kind::DegenerateFacet,
                text!(
                    "the facet's area is {:.1e} of its squared longest edge; it needs more than {SMALLEST_AREA_RATIO:.0e}",
                    if h > 0.0 { norm / (h * h) } else { 0.0 }
                ),
            ));
        }
        let e = w / norm;
        let length = w1.norm();
        let t1 = w1 / length;
        let t2 = e.cross(&t1);
        let mut plane = Plane {
            reference: facet.nodes[0],
            origin: Vec3::zeros(),
            t1,
            t2,
            e,
            spin: [0.0; MAX_CORNERS],
            tilt: [[0.0; MAX_CORNERS]; 2],
            condition_squared: 1.0,
            beyond: [None; MAX_CORNERS],
        };
        for x in facet.points() {
            plane.origin += (x - facet.nodes[0]) / facet.len() as f64;
        }
        // t_j . De = t_j . (Dw1 x w2 + w1 x Dw2) / |w|, t1 along w1;  t2 . Dt1 = t2 . Dw1 / |w1|.
        let signs = facet.spanning_signs();
        let (along, across) = (w2.dot(&t1) / norm, w2.dot(&t2) / norm);
        plane.condition_squared += (length * along) * (length * along); // cot^2 of the angle between w1 and w2
        for (node, sign) in [(signs[0].0, 1.0), (signs[0].1, -1.0)] {
            plane.spin[node] += sign / length;
            plane.tilt[0][node] -= across * sign;
            plane.tilt[1][node] += along * sign;
        }
        for (node, sign) in [(signs[1].0, 1.0), (signs[1].1, -1.0)] {
            plane.tilt[1][node] -= length / norm * sign;
        }
        Ok(plane)
    }

    /// Dv / Dx_c of a vector v that is fixed in the frame (t1, t2, e) and so turns with it: Dv = omega x v,
    /// omega = (t1 . De) t2 - (t2 . De) t1 + (t2 . Dt1) e.
    pub fn derivative_of_fixed(&self, v: &Vec3) -> [Mat3; MAX_CORNERS] {
        let (t1, t2, e) = (self.t1.cross(v), self.t2.cross(v), self.e.cross(v));
        std::array::from_fn(|c| {
            let tilted = t2 * self.tilt[0][c] - t1 * self.tilt[1][c];
            tilted * self.e.transpose() + e * self.spin[c] * self.t2.transpose()
        })
    }
}
