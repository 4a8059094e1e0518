//! A part of a facet of the host, quadratic or a line, against an analytic surface (docs/formulation 12.7, 13.6): what `analytic.rs` is
//! to linear facets.
//!
//! n_AB = int N_A N_B da, n_AC = int N_A w_C(y(x)) da over the part, x = sum N_B x_B the point of the parent and y the closest one to
//! it, so that g_A = int N_A (x - y) da. The functions do not move against the part's coordinates (u, v); with j the area element
//!
//! Dg_A = int N_A ((x - y) Dj + j D(x - y)/Dx N_B Dx_B) du dv.

use super::analytic::{area_derivative, no_closest_point};
use super::each_point::PartPoint;
use super::field::MultiplierSpace;
use super::segment::NonmortarFrame;
use super::sub_motion::SubMotion;
use super::sub_pair::{Side, SubWeights, rule_for};
use crate::error::Result;
use crate::features;
use crate::geometry::{AnalyticSurface, FRAME, Mat3, Vec3};
use crate::quadrature::Rule;
use crate::quadrature::cell::square_point;
use crate::shape::{MAX_CORNERS, MAX_PARENT_NODES};
use crate::simd::{self, Kernel, Lanes};

/// The area element j of a part, linear in its coordinates, and its derivative.
#[derive(Clone, Copy, Debug)]
pub struct AreaElement {
    /// Factors of 1, u, v.
    pub of: [f64; 3],
    /// Their derivatives with respect to component j of the part's k-th node: `[m][j][k]`.
    pub motion: [[[f64; MAX_CORNERS]; 3]; 3],
}

/// The area element of a facet in its auxiliary plane, and its derivative.
pub fn area_element(frame: &NonmortarFrame) -> AreaElement {
    simd::dispatch(Area(frame))
}

struct Area<'a>(&'a NonmortarFrame);

impl Kernel for Area<'_> {
    type Output = AreaElement;
    #[inline(always)]
    fn run<L: Lanes>(self) -> AreaElement {
        AreaElement { of: self.0.map.determinant(), motion: area_derivative::<L>(self.0) }
    }
}

/// A part of a facet and the surface.
#[derive(Clone, Copy)]
pub struct SurfacePair<'a> {
    /// The parent, and which of its parts it is.
    pub side: Side,
    /// Where multipliers stand.
    pub space: MultiplierSpace,
    /// That of the part.
    pub area: &'a AreaElement,
    /// The surface.
    pub surface: &'a AnalyticSurface,
    /// The rule asked for; of lines that of a square, one way.
    pub rule: &'static Rule,
}

/// What a part's gaps depend on through the motion of the surface's closest point: - N_A Dy/Dx N_B integrated, `[A][B]`.
pub type Turned = [[Mat3; MAX_PARENT_NODES]; MAX_CORNERS];

/// A quadrature point.
pub(super) struct Point {
    /// Weight du dv.
    pub weight: f64,
    /// 1, u, v.
    pub powers: [f64; 3],
    /// N_B of the parent.
    pub n: [f64; MAX_PARENT_NODES],
    /// N_A of the rows.
    pub test: [f64; MAX_CORNERS],
}

impl Point {
    /// At these coordinates of the part.
    fn at((parent, sub): Side, space: MultiplierSpace, [u, v, weight]: [f64; 3]) -> Point {
        let of_part = sub.shape.values(u, v);
        let [x, y] = [0, 1].map(|i| (0..sub.shape.n).map(|k| of_part[k] * parent.at[sub.nodes[k]][i]).sum());
        let n = parent.values([x, y]);
        let test = match space {
            MultiplierSpace::Corner => parent.cell.values(x, y),
            MultiplierSpace::Sub => of_part,
        };
        Point { weight, powers: [1.0, u, v], n, test }
    }
}

fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

impl SurfacePair<'_> {
    /// Calls `visit` with the points of the rule.
    pub(super) fn for_points(&self, mut visit: impl FnMut(Point) -> Result<()>) -> Result<()> {
        let (parent, sub) = self.side;
        let rule = rule_for(self.rule, [parent, parent]);
        let mut at = |place| visit(Point::at(self.side, self.space, place));
        match sub.shape.n {
            2 => rule.square.iter().try_for_each(|[s, w]| at([2.0 * s - 1.0, 0.0, 2.0 * w])),
            3 => rule.triangle.iter().try_for_each(|[u, v, w]| at([*u, *v, 0.5 * w])),
            _ => (0..rule.square.len() * rule.square.len()).try_for_each(|i| at(square_point(rule.square, i))),
        }
    }

    /// x of these nodes.
    pub(super) fn position(&self, p: &Point, x: &[Vec3; MAX_PARENT_NODES]) -> Vec3 {
        (0..self.side.0.n).map(|b| x[b] * p.n[b]).sum()
    }

    /// The weights with the parent's nodes at `x`, from the surface's origin; the mortar columns are the frame's points.
    ///
    /// # Errors
    /// [`crate::error::Kind::UndefinedNormal`] when a quadrature point is the centre or lies on the axis.
    pub fn weights(&self, x: &[Vec3; MAX_PARENT_NODES]) -> Result<SubWeights> {
        features::PARTS.is_here();
        let (mut weights, rows) = (SubWeights::default(), self.rows());
        self.for_points(|p| {
            let x = self.position(&p, x);
            let closest = self.surface.closest(x).ok_or_else(no_closest_point)?;
            let w = self.surface.coordinates(x - closest.normal * closest.distance);
            let da = p.weight * dot(&p.powers, &self.area.of);
            for a in 0..rows {
                (0..self.side.0.n).for_each(|b| weights.ab[a][b] += da * p.test[a] * p.n[b]);
                (0..FRAME).for_each(|c| weights.ac[a][c] += da * p.test[a] * w[c]);
            }
            Ok(())
        })?;
        Ok(weights)
    }

    /// Shows `to` the points of a part, with the frame's coordinates of the closest ones in place of a mortar facet's functions.
    ///
    /// # Errors
    /// As [`SurfacePair::weights`]; what `to` refuses.
    pub fn each_point(&self, x: &[Vec3; MAX_PARENT_NODES], to: &mut dyn FnMut(&PartPoint) -> Result<()>) -> Result<()> {
        self.for_points(|p| {
            let x = self.position(&p, x);
            let closest = self.surface.closest(x).ok_or_else(no_closest_point)?;
            let mut other = [0.0; MAX_PARENT_NODES];
            other[..FRAME].copy_from_slice(&self.surface.coordinates(x - closest.normal * closest.distance));
            to(&PartPoint { weight: p.weight * dot(&p.powers, &self.area.of), own: p.test, all: [p.n, other] })
        })
    }

    /// How many multipliers are over the part.
    fn rows(&self) -> usize {
        self.space.nodes(self.side.0, self.side.1).len()
    }

    /// Derivatives with respect to the part's nodes through its area, as of [`SubMotion`], at tractions `[i][A]` of the rows and
    /// with gaps of the nodes `lowered`; and what gaps depend on through the closest point besides, where the parent's nodes are
    /// at `x`. Both from the surface's origin.
    ///
    /// # Errors
    /// As [`SurfacePair::weights`].
    pub fn motion(
        &self,
        (x, lowered): (&[Vec3; MAX_PARENT_NODES], &[Vec3; MAX_PARENT_NODES]),
        tractions: &[[f64; MAX_CORNERS]; 3],
        to: &mut SubMotion,
    ) -> Result<Turned> {
        features::PARTS.is_here();
        let (nodes, rows, parts) = (self.side.0.n, self.rows(), self.side.1.shape.n);
        // Per power of the area element: int N_B p, int N_A (x - y), int N_A.
        let mut forces = [[[0.0; 3]; MAX_PARENT_NODES]; 3];
        let mut gaps = [[[0.0; 4]; MAX_CORNERS]; 3];
        let mut turned = [[Mat3::zeros(); MAX_PARENT_NODES]; MAX_CORNERS];
        self.for_points(|p| {
            let at = self.position(&p, x);
            let closest = self.surface.closest(at).ok_or_else(no_closest_point)?;
            let gap = self.position(&p, lowered) - (at - closest.normal * closest.distance);
            let traction = [0, 1, 2].map(|i| (0..rows).map(|a| p.test[a] * tractions[i][a]).sum::<f64>());
            for (m, power) in p.powers.into_iter().enumerate() {
                let w = p.weight * power;
                for b in 0..nodes {
                    (0..3).for_each(|i| forces[m][b][i] += w * p.n[b] * traction[i]);
                }
                for a in 0..rows {
                    let of = [gap.x, gap.y, gap.z, 1.0];
                    (0..4).for_each(|i| gaps[m][a][i] += w * p.test[a] * of[i]);
                }
            }
            let da = p.weight * dot(&p.powers, &self.area.of);
            let pulled = self.surface.gradient(&closest) - Mat3::identity();
            for (a, b) in (0..rows).flat_map(|a| (0..nodes).map(move |b| (a, b))) {
                turned[a][b] += pulled * (da * p.test[a] * p.n[b]);
            }
            Ok(())
        })?;
        for (k, j) in (0..parts).flat_map(|k| (0..3).map(move |j| (k, j))) {
            let d = [0, 1, 2].map(|m| self.area.motion[m][j][k]);
            for b in 0..nodes {
                (0..3).for_each(|i| to.one[k][j][b][i] = dot(&d, &[0, 1, 2].map(|m| forces[m][b][i])));
            }
            for a in 0..rows {
                to.gap[k][j][a] = std::array::from_fn(|i| dot(&d, &[0, 1, 2].map(|m| gaps[m][a][i])));
            }
        }
        Ok(turned)
    }
}
