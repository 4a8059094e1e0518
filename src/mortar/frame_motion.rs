//! What the weights and gaps of a facet against an analytic surface gain as the surface moves, and the surface's own weights as the
//! facet moves (docs/formulation.md 14.5). The frame's points P_D move as a rigid body, and only of such motions is this the
//! derivative.
//!
//! At a fixed point x the closest point y moves by v(y) - Y v(x), with v(z) = sum w_D(z) DP_D and Y = Dy/Dx. So
//!
//! Dg_A = int N_A (Y v(x) - v(y)) da, Dn_AC = - int N_A grad w_C . Y v(x) da by the frame, and
//! Dn_AC = int N_A (w_C Dj + j grad w_C . Y N_k Dx_k) by the facet's nodes, j the area element.

use super::analytic::{cell_points, corners, point};
use super::segment::NonmortarFrame;
use super::surface_pair::area_element;
use crate::error::Result;
use crate::geometry::{AnalyticSurface, FRAME, Mat3, Vec3};
use crate::quadrature::Rule;
use crate::shape::MAX_CORNERS;

/// Derivatives of a facet's pair with the frame of an analytic surface; nodes A and k are its corners.
#[derive(Clone, Debug, Default)]
pub struct FrameMotion {
    /// Dg_A / DP_D: `[A][D]`.
    pub gap: [[Mat3; FRAME]; MAX_CORNERS],
    /// Dn_AC / DP_D: `[A][C][D]`.
    pub by_frame: [[[Vec3; FRAME]; FRAME]; MAX_CORNERS],
    /// Dn_AC / Dx_k: `[A][C][k]`.
    pub by_nodes: [[[Vec3; MAX_CORNERS]; FRAME]; MAX_CORNERS],
}

/// Of a facet and the surface.
///
/// # Errors
/// As `analytic_weights`.
pub fn frame_motion(frame: &NonmortarFrame, surface: &AnalyticSurface, rule: &Rule) -> Result<FrameMotion> {
    let (corners, area) = (corners(frame, surface), area_element(frame).motion);
    let (nodes, gradients) = (frame.projection.shape.n, surface.coordinate_gradients());
    let mut of = FrameMotion::default();
    for i in 0..cell_points(frame, rule) {
        let q = point(frame, surface, &corners, rule, i)?;
        let lag = Mat3::identity() - surface.gradient(&q.place.closest); // Y, symmetric
        let (at_x, at_y) = (surface.coordinates(q.place.x), surface.coordinates(q.place.on_surface()));
        let slopes = gradients.map(|g| lag * g);
        let along = |k: usize| Vec3::from_fn(|j, _| (0..3).map(|m| q.powers[m] * area[m][j][k]).sum());
        let areas: [Vec3; MAX_CORNERS] = std::array::from_fn(along);
        for a in 0..nodes {
            let (w, da) = (q.weight * q.n[a], q.weight * q.n[a] * q.area);
            for d in 0..FRAME {
                of.gap[a][d] += (lag * at_x[d] - Mat3::identity() * at_y[d]) * da;
            }
            for (c, slope) in slopes.iter().enumerate() {
                for (d, x) in at_x.iter().enumerate() {
                    of.by_frame[a][c][d] -= slope * (da * x);
                }
                for (k, area) in areas.iter().enumerate().take(nodes) {
                    of.by_nodes[a][c][k] += area * (w * at_y[c]) + slope * (da * q.n[k]);
                }
            }
        }
    }
    Ok(of)
}
