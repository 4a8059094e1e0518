//! The plane map y = a + b xi + c eta + d xi eta of a projected facet and its inverse in closed form
//! (docs/formulation 2.2). No iteration: one square root and one division a point.

use super::projection::Projection;
use super::vector::{Vec2, cross};
use crate::shape::MAX_CORNERS;
use crate::simd::{Lanes, Real};

/// A twist below this (over the facet's size) is rounding: the facet is a parallelogram.
const PARALLELOGRAM: f64 = 1e-14;
/// det J^2 over that at the centre is above this on a facet whose corners are convex ([`Projection::convex_reach`]): above
/// 2.5e-15, for no facet's area is above four times the square of its size, nor its size above twice its reach.
const LEAST_SQUARE: f64 = 1e-15;

/// Coefficients of the map of one projected facet.
#[derive(Clone, Copy, Debug)]
pub struct BilinearMap {
    a: Vec2,
    b: Vec2,
    c: Vec2,
    d: Vec2,
    /// b x c, b x d, d x c: det J = j0 + j1 xi + j2 eta [L^2].
    determinant: [f64; 3],
    /// 1 / (b x c).
    inverse_affine: f64,
    coefficients: &'static [[f64; 4]; MAX_CORNERS],
    /// Whether the map is affine (triangle or parallelogram): then the weights are polynomials.
    pub is_affine: bool,
}

/// `s` `a` - `t` `b`.
#[inline(always)]
fn difference<L: Lanes>(s: f64, a: L, t: f64, b: L) -> L {
    L::splat(s).mul_sub(a, L::splat(t) * b)
}

/// r x v.
#[inline(always)]
fn times<R: Real>(r: [R; 2], v: [R; 2]) -> R {
    r[0].mul_sub(v[1], r[1] * v[0])
}

/// The inverse of a map, its coefficients in every lane: spread once, not at every point.
pub struct InverseMap<R> {
    a: [R; 2],
    b: [R; 2],
    c: [R; 2],
    d: [R; 2],
    /// b x c and 4 b x d.
    bc: R,
    four_bd: R,
    least_square: R,
    inverse_affine: R,
    is_affine: bool,
}

impl<R: Real> InverseMap<R> {
    /// See [`BilinearMap::inverse`].
    #[inline(always)]
    pub fn at(&self, y: [R; 2]) -> Preimage<R> {
        let r = [y[0] - self.a[0], y[1] - self.a[1]];
        let (rc, br, bc) = (times(r, self.c), times(self.b, r), self.bc);
        if self.is_affine {
            return Preimage { xi: rc * self.inverse_affine, eta: br * self.inverse_affine, det: bc };
        }
        let rd = times(r, self.d);
        let lead = bc - rd;
        // Rounding may take the square below that only near a corner where det J nearly vanishes.
        let square = lead.mul_add(lead, self.four_bd * rc);
        let det = square.max(self.least_square).sqrt();
        let (xi, eta) = (lead + det, bc + rd + det); // xi = 2 rc / .., eta = 2 br / .., with one division
        let inverse = R::splat(2.0) / (xi * eta);
        Preimage { xi: rc * eta * inverse, eta: br * xi * inverse, det }
    }
}

/// A point's reference coordinates and the map's Jacobian determinant there.
#[derive(Clone, Copy, Debug)]
pub struct Preimage<R = f64> {
    /// First reference coordinate.
    pub xi: R,
    /// Second reference coordinate.
    pub eta: R,
    /// det dy/d(xi, eta) [L^2].
    pub det: R,
}

impl BilinearMap {
    /// The map of a projected facet.
    pub fn new(facet: &Projection) -> BilinearMap {
        let mut m = [Vec2::zeros(); 4];
        for k in 0..facet.shape.n {
            for i in 0..4 {
                m[i] += facet.y[k] * facet.shape.coefficients[k][i];
            }
        }
        let determinant = [cross(m[1], m[2]), cross(m[1], m[3]), cross(m[3], m[2])];
        BilinearMap {
            a: m[0],
            b: m[1],
            c: m[2],
            d: m[3],
            determinant,
            inverse_affine: 1.0 / determinant[0],
            coefficients: &facet.shape.coefficients,
            is_affine: m[3].amax() <= PARALLELOGRAM * facet.size,
        }
    }

    /// Reference coordinates of the point `y`, or of four points, of a convex facet. Points outside it by rounding
    /// are fine.
    #[inline(always)]
    pub fn inverse<R: Real>(&self, y: [R; 2]) -> Preimage<R> {
        self.lanes().at(y)
    }

    /// The inverse map, for many points.
    #[inline(always)]
    pub fn lanes<R: Real>(&self) -> InverseMap<R> {
        let pair = |v: Vec2| [R::splat(v.x), R::splat(v.y)];
        InverseMap {
            a: pair(self.a),
            b: pair(self.b),
            c: pair(self.c),
            d: pair(self.d),
            bc: R::splat(self.determinant[0]),
            four_bd: R::splat(4.0 * self.determinant[1]),
            least_square: R::splat(LEAST_SQUARE * self.determinant[0] * self.determinant[0]),
            inverse_affine: R::splat(self.inverse_affine),
            is_affine: self.is_affine,
        }
    }

    /// det J dN_k/dy = `g[0] + g[1] xi + g[2] eta`, lanes k: linear, the products xi eta cancel. `[L]`
    #[inline(always)]
    pub fn gradients<L: Lanes>(&self) -> [[L; 2]; 3] {
        let (b, c, d, n) = (self.b, self.c, self.d, self.coefficients);
        let xi = L::load(&[n[0][1], n[1][1], n[2][1], n[3][1]]);
        let eta = L::load(&[n[0][2], n[1][2], n[2][2], n[3][2]]);
        let both = L::load(&[n[0][3], n[1][3], n[2][3], n[3][3]]);
        [
            [difference(c.y, xi, b.y, eta), difference(b.x, eta, c.x, xi)],
            [difference(d.y, xi, b.y, both), difference(b.x, both, d.x, xi)],
            [difference(c.y, both, d.y, eta), difference(d.x, eta, c.x, both)],
        ]
    }

    /// det J = j0 + j1 xi + j2 eta.
    #[inline]
    pub fn determinant(&self) -> [f64; 3] {
        self.determinant
    }
}
