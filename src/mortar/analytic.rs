//! A facet against an analytic surface (formulation as for two facets, but for the overlap: there is none to find, the
//! surface lies under the whole facet).
//!
//! n_AB = int N_A N_B da, n_AC = int N_A w_C(y(x)) da over the facet, y the closest point to x and w its coordinates in
//! the surface's frame, so that g_A = sum n_AB x_B - sum n_AC P_C = int N_A (x - y) da. da is the area in the facet's
//! auxiliary plane, as for two facets: n_AB is that of a facet that is covered everywhere, and exact for any facet.
//!
//! The surface is rigid: derivatives are with respect to the facet's nodes alone,
//! Dg_A = int N_A ((x - y) Dj + j D(x - y)/Dx N_k Dx_k), j the area element.

use super::gap::GapDerivative;
use super::segment::NonmortarFrame;
use super::{ForceDerivatives, PairWeights};
use crate::error::{Error, Kind, Result};
use crate::geometry::{AnalyticSurface, Closest, Vec3};
use crate::quadrature::Rule;
use crate::shape::{MAX_NODES, Shape};
use crate::simd::{Lanes, Plain};

/// A quadrature point of the facet.
struct Point {
    /// Weight on the reference cell; times `area` it is an area [L^2].
    weight: f64,
    /// The area element j = det J [L^2].
    area: f64,
    /// 1, xi, eta: j is linear in them.
    powers: [f64; 3],
    /// Shape functions.
    n: [f64; MAX_NODES],
    /// x - P0.
    x: Vec3,
    /// The surface there.
    closest: Closest,
}

/// The i-th point of a rule on the reference cell, (xi, eta, weight); `None` behind the last.
fn cell_point(shape: &Shape, rule: &Rule, i: usize) -> Option<[f64; 3]> {
    if shape.n == 3 {
        return rule.triangle.get(i).map(|[l1, l2, w]| [*l1, *l2, 0.5 * w]);
    }
    let n = rule.square.len();
    let [s, v] = rule.square.get(i / n)?;
    let [t, w] = rule.square[i % n];
    Some([2.0 * s - 1.0, 2.0 * t - 1.0, 4.0 * v * w])
}

/// Calls `visit` at every quadrature point of the facet.
#[inline]
fn for_each_point(
    frame: &NonmortarFrame,
    surface: &AnalyticSurface,
    rule: &Rule,
    mut visit: impl FnMut(&Point),
) -> Result<()> {
    let (facet, area) = (&frame.projection, frame.map.determinant());
    // Differences of nodes and P0 first: exact under a common offset.
    let corner = frame.plane.reference - surface.origin;
    for i in 0.. {
        let Some([xi, eta, weight]) = cell_point(facet.shape, rule, i) else { break };
        let n = facet.shape.values(xi, eta);
        let x = (0..MAX_NODES).fold(corner, |x, k| x + facet.x[k] * n[k]);
        let closest = surface.closest(x).ok_or_else(|| {
            let text = "a point of the facet is the centre of the analytic mortar surface, or on its axis: it has no closest point";
            Error::new(Kind::UndefinedNormal, text)
        })?;
        visit(&Point { weight, area: area[0] + area[1] * xi + area[2] * eta, powers: [1.0, xi, eta], n, x, closest });
    }
    Ok(())
}

/// The weights of a facet against an analytic surface; the mortar slots are the frame's points.
///
/// # Errors
/// [`Kind::UndefinedNormal`] when a quadrature point is the centre or lies on the axis.
pub fn analytic_weights(frame: &NonmortarFrame, surface: &AnalyticSurface, rule: &Rule) -> Result<PairWeights> {
    let mut w = PairWeights::default();
    for_each_point(frame, surface, rule, |p| {
        let c = surface.coordinates(p.x - p.closest.normal * p.closest.distance);
        for a in 0..MAX_NODES {
            let wa = p.weight * p.area * p.n[a];
            for b in 0..=a {
                w.ab[a][b] += wa * p.n[b];
            }
            for k in 0..MAX_NODES {
                w.ac[a][k] += wa * c[k];
            }
        }
    })?;
    for a in 0..MAX_NODES {
        for b in 0..a {
            w.ab[b][a] = w.ab[a][b];
        }
    }
    Ok(w)
}

/// Derivatives of the forces f_B of the fields `p[i][A]`, into `forces`, and of the gap with respect to the facet's nodes.
/// All else in `forces` belongs to the surface, which has no equations, and stays as it is.
///
/// # Errors
/// As [`analytic_weights`].
pub fn analytic_motion(
    frame: &NonmortarFrame,
    surface: &AnalyticSurface,
    rule: &Rule,
    p: &[[f64; MAX_NODES]; 3],
    forces: &mut ForceDerivatives,
) -> Result<GapDerivative> {
    // int p^i N_B (1, xi, eta) over the cell; int N_A (x - y) (1, xi, eta); int N_A N_B D(x - y)/Dx da.
    let mut moments = [[[0.0; MAX_NODES]; 3]; 3];
    let mut gaps = [[[0.0; MAX_NODES]; 3]; 3];
    let mut blocks = [[[[0.0; MAX_NODES]; 3]; 3]; MAX_NODES];
    for_each_point(frame, surface, rule, |q| {
        let (gap, gradient) = (q.closest.normal * q.closest.distance, surface.gradient(&q.closest));
        for i in 0..3 {
            let field: f64 = (0..MAX_NODES).map(|a| p[i][a] * q.n[a]).sum();
            for m in 0..3 {
                let (f, g) = (q.weight * q.powers[m] * field, q.weight * q.powers[m] * gap[i]);
                for a in 0..MAX_NODES {
                    moments[m][i][a] += f * q.n[a];
                    gaps[m][i][a] += g * q.n[a];
                }
            }
        }
        for k in 0..MAX_NODES {
            for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
                let g = q.weight * q.area * q.n[k] * gradient[(i, j)];
                for a in 0..MAX_NODES {
                    blocks[k][i][j][a] += g * q.n[a];
                }
            }
        }
    })?;
    let darea = area_derivative(frame);
    for (k, j) in (0..MAX_NODES).flat_map(|k| (0..3).map(move |j| (k, j))) {
        for i in 0..3 {
            for a in 0..MAX_NODES {
                forces.one[k][j][i][a] = (0..3).map(|m| darea[m][k][j] * moments[m][i][a]).sum();
                blocks[k][i][j][a] += (0..3).map(|m| darea[m][k][j] * gaps[m][i][a]).sum::<f64>();
            }
        }
    }
    Ok(GapDerivative::Blocks(blocks))
}

/// Dj / Dx_k in the powers (1, xi, eta) `[L]`. Translation and spin of the plane change no area: its tilt is left.
fn area_derivative(frame: &NonmortarFrame) -> [[Vec3; MAX_NODES]; 3] {
    let (plane, facet) = (&frame.plane, &frame.projection);
    frame.map.gradients::<Plain>().map(|g| {
        let g = g.map(Lanes::store);
        let tilt = (0..MAX_NODES).fold([0.0; 2], |t, k| [t[0] + g[0][k] * facet.d[k], t[1] + g[1][k] * facet.d[k]]);
        std::array::from_fn(|k| {
            let in_plane = plane.t1 * g[0][k] + plane.t2 * g[1][k];
            in_plane - plane.e * (plane.tilt[0][k] * tilt[0] + plane.tilt[1][k] * tilt[1])
        })
    })
}
