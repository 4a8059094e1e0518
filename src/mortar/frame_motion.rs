//! What the weights and gaps of a facet of the host against an analytic surface gain as the surface moves, and the surface's own weights
//! as the facet moves (docs/formulation 14.5). The frame's points P_D move as a rigid body, and only of such motions is this the
//! derivative.
//!
//! At a fixed point x the closest point y moves by v(y) - Y v(x), with v(z) = sum w_D(z) DP_D and Y = Dy/Dx. So
//!
//! Dg_A = int N_A (Y v(x) - v(y)) da, Dn_AC = - int N_A grad w_C . Y v(x) da by the frame, and
//! Dn_AC = int N_A (w_C Dj + j grad w_C . Y N_k Dx_k) by the facet's nodes, j the area element.

use super::analytic::no_closest_point;
use super::surface_pair::SurfacePair;
use crate::error::Result;
use crate::geometry::{FRAME, Mat3, Vec3};
use crate::shape::{MAX_CORNERS, MAX_PARENT_NODES};

/// Dg_A / DP_D: `[A][D]`.
pub type FrameGaps = [[Mat3; FRAME]; MAX_PARENT_NODES];

/// Derivatives of the weights and gaps of a facet with its own nodes and the frame of an analytic surface; A and k are nodes of the facet.
#[derive(Clone, Debug, Default)]
pub struct FrameMotion {
    /// Dg_A / DP_D.
    pub gap: FrameGaps,
    /// Dn_AC / DP_D: `[A][C][D]`.
    pub by_frame: [[[Vec3; FRAME]; FRAME]; MAX_PARENT_NODES],
    /// Dn_AC / Dx_k: `[A][C][k]`.
    pub by_nodes: [[[Vec3; MAX_PARENT_NODES]; FRAME]; MAX_PARENT_NODES],
    /// Dn_AB / Dx_k: `[A][B][k]`.
    pub own: [[[Vec3; MAX_PARENT_NODES]; MAX_PARENT_NODES]; MAX_PARENT_NODES],
}

impl FrameMotion {
    /// D int N_A N_B da / Dx_k, the functions being those of the corners, which have the multipliers. `shares`: what a corner's function
    /// is at each node.
    pub fn mass(&self, (a, b, k): (usize, usize, usize), shares: &[[f64; MAX_PARENT_NODES]; MAX_CORNERS]) -> Vec3 {
        self.own[a].iter().zip(&shares[b]).map(|(of, share)| of[k] * *share).sum()
    }
}

impl SurfacePair<'_> {
    /// Adds that of a part; its facet's nodes are at `x`, from the surface's origin.
    ///
    /// # Errors
    /// As [`SurfacePair::weights`].
    pub fn frame_motion(&self, x: &[Vec3; MAX_PARENT_NODES], to: &mut FrameMotion) -> Result<()> {
        let ((parent, sub), surface) = (self.side, self.surface);
        let (rows, gradients) = (self.space.nodes(parent, sub), surface.coordinate_gradients());
        self.for_points(|q| {
            let at = self.position(&q, x);
            let closest = surface.closest(at).ok_or_else(no_closest_point)?;
            let lag = Mat3::identity() - surface.gradient(&closest); // Y, symmetric
            let on_surface = at - closest.normal * closest.distance;
            let (at_x, at_y) = (surface.coordinates(at), surface.coordinates(on_surface));
            let slopes = gradients.map(|g| lag * g);
            let along = |k: usize| Vec3::from_fn(|j, _| (0..3).map(|m| q.powers[m] * self.area.motion[m][j][k]).sum());
            let areas: [Vec3; MAX_CORNERS] = std::array::from_fn(along);
            let area: f64 = (0..3).map(|m| q.powers[m] * self.area.of[m]).sum();
            for (row, &a) in rows.iter().enumerate() {
                let (w, da) = (q.weight * q.test[row], q.weight * q.test[row] * area);
                for d in 0..FRAME {
                    to.gap[a][d] += (lag * at_x[d] - Mat3::identity() * at_y[d]) * da;
                }
                for (c, slope) in slopes.iter().enumerate() {
                    for (d, x) in at_x.iter().enumerate() {
                        to.by_frame[a][c][d] -= slope * (da * x);
                    }
                    for (k, n) in q.n.iter().enumerate().take(parent.n) {
                        to.by_nodes[a][c][k] += slope * (da * n);
                    }
                    for (&k, area) in sub.nodes.iter().zip(&areas).take(sub.shape.n) {
                        to.by_nodes[a][c][k] += area * (w * at_y[c]);
                    }
                }
                for (b, n) in q.n.iter().enumerate().take(parent.n) {
                    for (&k, area) in sub.nodes.iter().zip(&areas).take(sub.shape.n) {
                        to.own[a][b][k] += area * (w * n);
                    }
                }
            }
            Ok(())
        })
    }
}
