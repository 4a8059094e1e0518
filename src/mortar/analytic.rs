//! A facet against an analytic surface (formulation as for two facets, but for the overlap: there is none to find, the
//! surface lies under the whole facet).
//!
//! n_AB = int N_A N_B da, n_AC = int N_A w_C(y(x)) da over the facet, y the closest point to x and w its coordinates in
//! the surface's frame, so that g_A = sum n_AB x_B - sum n_AC P_C = int N_A (x - y) da. da is the area in the facet's
//! auxiliary plane, as for two facets: n_AB is that of a facet that is covered everywhere, and exact for any facet.
//!
//! The surface is rigid: derivatives are with respect to the facet's nodes alone,
//! Dg_A = int N_A ((x - y) Dj + j D(x - y)/Dx N_k Dx_k), j the area element.
//!
//! Integrals of shape functions alone are constants of the cell; over a plane there are no others, and no quadrature.

use super::chain::{ForceDerivatives, ONE};
use super::each_point::OverlapPoint;
use super::gap::GapBlocks;
use super::pair_weights::PairWeights;
use super::segment::NonmortarFrame;
use super::transport::dots;
use crate::error::{Error, Kind, Result};
use crate::features;
use crate::geometry::{AnalyticSurface, Closest, Vec3};
use crate::quadrature::Rule;
use crate::quadrature::cell::square_point;
use crate::shape::{MAX_CORNERS, MAX_NODES};
use crate::simd::{self, Kernel, Lanes};

/// A point of the facet and the closest one of the surface.
struct Place {
    /// x - P0.
    pub x: Vec3,
    /// The surface there.
    pub closest: Closest,
}

impl Place {
    #[inline(always)]
    fn at(surface: &AnalyticSurface, x: Vec3) -> Result<Place> {
        Ok(Place { x, closest: surface.closest(x).ok_or_else(no_closest_point)? })
    }

    /// y - P0.
    #[inline(always)]
    pub fn on_surface(&self) -> Vec3 {
        self.x - self.closest.normal * self.closest.distance
    }
}

/// The facet's nodes - P0. Differences of nodes and P0 come first: exact under a common offset.
#[inline(always)]
fn corners(frame: &NonmortarFrame, surface: &AnalyticSurface) -> [Vec3; MAX_CORNERS] {
    let x = &frame.projection.x;
    [x[0] - surface.origin, x[1] - surface.origin, x[2] - surface.origin, x[3] - surface.origin]
}

/// A quadrature point of the facet.
struct Point {
    /// Weight on the reference cell; times `area` it is an area [L^2].
    pub weight: f64,
    /// The area element j = det J [L^2].
    pub area: f64,
    /// 1, xi, eta: j is linear in them.
    pub powers: [f64; 3],
    /// The functions of the map, which are N_A and N_B, too: other kinds have no table.
    pub n: [f64; MAX_CORNERS],
    pub place: Place,
}

/// Quadrature points of the facet's cell.
#[inline(always)]
fn cell_points(frame: &NonmortarFrame, rule: &Rule) -> usize {
    if frame.projection.shape.n == 3 { rule.triangle.len() } else { rule.square.len() * rule.square.len() }
}

/// The i-th of them.
#[inline(always)]
fn point(
    frame: &NonmortarFrame,
    surface: &AnalyticSurface,
    corners: &[Vec3; MAX_CORNERS],
    rule: &Rule,
    i: usize,
) -> Result<Point> {
    let (facet, area) = (&frame.projection, frame.map.determinant());
    let [xi, eta, weight] = if facet.shape.n == 3 {
        let [l1, l2, w] = rule.triangle[i];
        [l1, l2, 0.5 * w]
    } else {
        square_point(rule.square, i)
    };
    let n = facet.shape.values(xi, eta);
    let mut x = Vec3::zeros();
    for k in 0..MAX_CORNERS {
        x += corners[k] * n[k];
    }
    let (area, place) = (area[0] + area[1] * xi + area[2] * eta, Place::at(surface, x)?);
    Ok(Point { weight, area, powers: [1.0, xi, eta], n, place })
}

#[cold]
pub(super) fn no_closest_point() -> Error {
    let text =
        "a point of the facet is the centre of the analytic mortar surface, or on its axis: it has no closest point";
    Error::new(Kind::UndefinedNormal, text)
}

/// The weights of a facet against an analytic surface; the mortar slots are the frame's points.
///
/// # Errors
/// [`Kind::UndefinedNormal`] when a quadrature point is the centre or lies on the axis.
pub fn analytic_weights(frame: &NonmortarFrame, surface: &AnalyticSurface, rule: &Rule) -> Result<PairWeights> {
    features::needs!(ANALYTIC);
    simd::dispatch(Weights { frame, surface, rule })
}

struct Weights<'a> {
    frame: &'a NonmortarFrame,
    surface: &'a AnalyticSurface,
    rule: &'a Rule,
}

impl Kernel for Weights<'_> {
    type Output = Result<PairWeights>;
    #[inline(always)]
    fn run<L: Lanes>(self) -> Result<PairWeights> {
        let Weights { frame, surface, rule } = self;
        let (ab, mut ac) = (mass::<L>(frame), [L::splat(0.0); MAX_CORNERS]);
        let (nodes, corners) = (frame.projection.shape.n, corners(frame, surface));
        if surface.is_flat() {
            for b in 0..nodes {
                let p = Place::at(surface, corners[b])?;
                let c = L::load(&surface.coordinates(p.on_surface()));
                let n = ab[b].store();
                for a in 0..nodes {
                    ac[a] = L::splat(n[a]).mul_add(c, ac[a]);
                }
            }
            return Ok(PairWeights::of_rows(nodes, &ab, &ac));
        }
        for i in 0..cell_points(frame, rule) {
            let p = point(frame, surface, &corners, rule, i)?;
            let c = L::load(&surface.coordinates(p.place.on_surface()));
            for a in 0..nodes {
                ac[a] = L::splat(p.weight * p.area * p.n[a]).mul_add(c, ac[a]);
            }
        }
        Ok(PairWeights::of_rows(nodes, &ab, &ac))
    }
}

/// Shows `to` the points of a facet, with the frame's coordinates of the closest points in the slots of a mortar facet.
///
/// # Errors
/// As [`analytic_weights`]; what `to` refuses.
pub fn each_surface_point(
    frame: &NonmortarFrame,
    surface: &AnalyticSurface,
    rule: &Rule,
    to: &mut dyn FnMut(OverlapPoint) -> Result<()>,
) -> Result<()> {
    let corners = corners(frame, surface);
    (0..cell_points(frame, rule)).try_for_each(|i| {
        let p = point(frame, surface, &corners, rule, i)?;
        let other = surface.coordinates(p.place.on_surface());
        to(OverlapPoint { weight: p.weight * p.area, own: p.n, other })
    })
}

/// n_AB of the whole facet, rows A, lanes B, symmetric: int N_A N_B j over the cell, j the area element.
#[inline(always)]
fn mass<L: Lanes>(frame: &NonmortarFrame) -> [L; MAX_CORNERS] {
    let (det, products) = (frame.map.determinant(), &frame.projection.shape.fields.products);
    let mut ab = [L::splat(0.0); MAX_CORNERS];
    for a in 0..MAX_CORNERS {
        for m in 0..3 {
            ab[a] = L::splat(det[m]).mul_add(L::load(&products[m][a]), ab[a]);
        }
    }
    ab
}

/// Derivatives of the forces f_B of the fields `p[i][A]`, into `forces`, and of the gap with respect to the facet's
/// nodes. All else in `forces` belongs to the surface, which has no equations, and stays as it is.
///
/// # Errors
/// As [`analytic_weights`].
pub fn analytic_motion(
    frame: &NonmortarFrame,
    surface: &AnalyticSurface,
    rule: &Rule,
    p: &[[f64; MAX_CORNERS]; 3],
    forces: &mut ForceDerivatives,
) -> Result<GapBlocks> {
    features::needs!(ANALYTIC);
    simd::dispatch(Motion { frame, surface, rule, p, forces, raised: None })
}

/// The derivatives of the stage of a facet with dual multipliers: Dm_B of the covered areas as the forces f_B of the
/// field 1, in each of their components, and D int N_A (x - y - h) da at a fixed field h = sum_B N_B h_B,
/// `heights[i][B]`. The surface is raised by h, which is a vector here: x - y turns from point to point.
///
/// # Errors
/// As [`analytic_weights`].
pub fn analytic_motion_raised(
    frame: &NonmortarFrame,
    surface: &AnalyticSurface,
    rule: &Rule,
    heights: &[[f64; MAX_CORNERS]; 3],
    areas: &mut ForceDerivatives,
) -> Result<GapBlocks> {
    features::needs!(ANALYTIC);
    simd::dispatch(Motion { frame, surface, rule, p: &[ONE; 3], forces: areas, raised: Some(heights) })
}

struct Motion<'a> {
    frame: &'a NonmortarFrame,
    surface: &'a AnalyticSurface,
    rule: &'a Rule,
    p: &'a [[f64; MAX_CORNERS]; 3],
    forces: &'a mut ForceDerivatives,
    /// Nodal values of the field by which the surface is raised: `[i][B]`.
    raised: Option<&'a [[f64; MAX_CORNERS]; 3]>,
}

impl Kernel for Motion<'_> {
    type Output = Result<GapBlocks>;
    #[inline(always)]
    fn run<L: Lanes>(self) -> Result<GapBlocks> {
        const { assert!(MAX_NODES == MAX_CORNERS) }; // the corners, which move the facet, are the nodes
        let Motion { frame, surface, rule, p, forces, raised } = self;
        let zero = L::splat(0.0);
        let products = &frame.projection.shape.fields.products;
        // Lanes B: int p^i N_B (1, xi, eta) over the cell.
        let mut fields = [[zero; 3]; 3];
        for m in 0..3 {
            for a in 0..MAX_CORNERS {
                for i in 0..3 {
                    fields[m][i] = L::splat(p[i][a]).mul_add(L::load(&products[m][a]), fields[m][i]);
                }
            }
        }
        let mut of = if surface.is_flat() { flat(frame, surface)? } else { curved(frame, surface, rule)? };
        if let Some(heights) = raised {
            // At a fixed place of the facet N_B h_B does not move: its integrals change with the area alone.
            for m in 0..3 {
                for b in 0..MAX_CORNERS {
                    let product = L::load(&products[m][b]); // lanes A of a row B: the products are symmetric
                    for i in 0..3 {
                        of.gaps[m][i] = L::splat(-heights[i][b]).mul_add(product, of.gaps[m][i]);
                    }
                }
            }
        }
        let darea = area_derivative::<L>(frame);
        let mut gap = [[[[0.0; MAX_CORNERS]; 3]; 3]; MAX_NODES];
        for k in 0..MAX_NODES {
            for j in 0..3 {
                let d = [L::splat(darea[0][j][k]), L::splat(darea[1][j][k]), L::splat(darea[2][j][k])];
                for i in 0..3 {
                    forces.one[k][j][i] = along(&d, &fields, i, zero).store();
                    gap[k][i][j] = along(&d, &of.gaps, i, of.blocks[k][i.max(j)][i.min(j)]).store();
                }
            }
        }
        Ok(gap)
    }
}

/// Integrals of x - y, lanes A.
struct Gaps<L> {
    /// int N_A (x - y)_i (1, xi, eta) over the cell: `[m][i]`.
    gaps: [[L; 3]; 3],
    /// int N_k N_A D(x - y)_i/Dx_j da: `[k][i][j]`, symmetric in i and j, given for j <= i.
    blocks: [[[L; 3]; 3]; MAX_NODES],
}

/// Over a plane: x - y = n sum N_B s_B with the distances s_B of the nodes, D(x - y)/Dx the same everywhere.
#[inline(always)]
fn flat<L: Lanes>(frame: &NonmortarFrame, surface: &AnalyticSurface) -> Result<Gaps<L>> {
    let (zero, products) = (L::splat(0.0), &frame.projection.shape.fields.products);
    let mut of = Gaps { gaps: [[zero; 3]; 3], blocks: [[[zero; 3]; 3]; MAX_NODES] };
    let (mut sums, mut normal, mass) = ([zero; 3], Vec3::zeros(), mass::<L>(frame));
    let corners = corners(frame, surface);
    for k in 0..frame.projection.shape.n {
        let closest = Place::at(surface, corners[k])?.closest;
        let gradient = surface.gradient(&closest);
        for m in 0..3 {
            // Lanes A of a row B: the products are symmetric.
            sums[m] = L::splat(closest.distance).mul_add(L::load(&products[m][k]), sums[m]);
        }
        for i in 0..3 {
            for j in 0..=i {
                of.blocks[k][i][j] = L::splat(gradient[(i, j)]) * mass[k];
            }
        }
        normal = closest.normal;
    }
    for m in 0..3 {
        for i in 0..3 {
            of.gaps[m][i] = L::splat(normal[i]) * sums[m];
        }
    }
    Ok(of)
}

/// Over any surface, by quadrature.
#[inline(always)]
fn curved<L: Lanes>(frame: &NonmortarFrame, surface: &AnalyticSurface, rule: &Rule) -> Result<Gaps<L>> {
    let zero = L::splat(0.0);
    let mut of = Gaps { gaps: [[zero; 3]; 3], blocks: [[[zero; 3]; 3]; MAX_NODES] };
    let corners = corners(frame, surface);
    for i in 0..cell_points(frame, rule) {
        let q = point(frame, surface, &corners, rule, i)?;
        let closest = &q.place.closest;
        let (gap, gradient) = (closest.normal * closest.distance, surface.gradient(closest));
        let n = L::load(&q.n);
        for i in 0..3 {
            for m in 0..3 {
                of.gaps[m][i] = L::splat(q.weight * q.powers[m] * gap[i]).mul_add(n, of.gaps[m][i]);
            }
        }
        let wn = n * L::splat(q.weight * q.area);
        for k in 0..MAX_NODES {
            let wnn = wn * L::splat(q.n[k]);
            for i in 0..3 {
                for j in 0..=i {
                    of.blocks[k][i][j] = L::splat(gradient[(i, j)]).mul_add(wnn, of.blocks[k][i][j]);
                }
            }
        }
    }
    Ok(of)
}

/// `sum` + sum_m d_m of[m][i].
#[inline(always)]
fn along<L: Lanes>(d: &[L; 3], of: &[[L; 3]; 3], i: usize, sum: L) -> L {
    d[0].mul_add(of[0][i], d[1].mul_add(of[1][i], d[2].mul_add(of[2][i], sum)))
}

/// Dj / Dx_k,j in the powers (1, xi, eta) `[L]`: `[m][j]`, lanes k. Translation and spin of the plane change no area:
/// its tilt is left.
#[inline(always)]
pub(super) fn area_derivative<L: Lanes>(frame: &NonmortarFrame) -> [[[f64; MAX_CORNERS]; 3]; 3] {
    let (plane, g) = (&frame.plane, frame.map.gradients::<L>());
    let (tilt, sums) = ([L::load(&plane.tilt[0]), L::load(&plane.tilt[1])], dots(&g, L::load(&frame.projection.d)));
    let mut d = [[[0.0; MAX_CORNERS]; 3]; 3];
    for m in 0..3 {
        let along = tilt[0].mul_add(L::splat(sums[m][0]), tilt[1] * L::splat(sums[m][1]));
        for j in 0..3 {
            let in_plane = L::splat(plane.t1[j]).mul_add(g[m][0], L::splat(plane.t2[j]) * g[m][1]);
            d[m][j] = (in_plane - L::splat(plane.e[j]) * along).store();
        }
    }
    d
}
