//! A sub-facet in its parent's coordinates (x, y) (docs/formulation 12.1): these are affine in its own, so the functions of
//! its map and det J times the gradients of x and y are polynomials in them, as the parent's functions are. Times 1 / det J
//! everything in an integral of 12.3 is a polynomial, and the integral a sum of moments.
//!
//! A triangle's functions are linear. On a parallelogram along the axes they are bilinear; on one askew to them, the middle
//! of a quad8, quadratic.

use super::field::{Coordinates, corners};
use crate::geometry::Projection;
use crate::geometry::bilinear_map::BilinearMap;
use crate::shape::{Parent, SubFacet, TERMS};
use crate::simd::Lanes;

/// Powers of x and y.
pub(super) type Powers = [usize; 2];

/// Monomials of the functions of maps and multipliers: the first 3, 4 or 6 of 1, x, y, xy, x^2, y^2.
pub(super) const NU: [Powers; 6] = [[0, 0], [1, 0], [0, 1], [1, 1], [2, 0], [0, 2]];
/// Those of a parent's functions, in its order.
pub(super) const MU: [Powers; TERMS] = [[0, 0], [1, 0], [0, 1], [2, 0], [1, 1], [0, 2], [2, 1], [1, 2], [2, 2]];

/// All monomials up to a degree in x and y together, and in each of them.
#[derive(Clone, Copy)]
pub(super) struct Degree {
    pub total: usize,
    pub each: usize,
}

impl Degree {
    /// Of products with functions of another degree.
    pub fn times(self, other: Degree) -> Degree {
        Degree::of(self.total + other.total, self.each + other.each)
    }

    /// `each` is not above `total`.
    pub fn of(total: usize, each: usize) -> Degree {
        Degree { total, each: each.min(total) }
    }

    /// Highest power of y beside x^a; a is not above `each`.
    #[inline(always)]
    pub fn beside(&self, a: usize) -> usize {
        self.each.min(self.total - a)
    }
}

/// Of the functions with the first so many monomials of [`NU`].
pub(super) fn degree_of_nu(n: usize) -> Degree {
    match n {
        3 => Degree { total: 1, each: 1 },
        4 => Degree { total: 2, each: 1 },
        _ => Degree { total: 2, each: 2 },
    }
}

/// One side of a pair.
pub(super) struct Polynomials {
    /// Coefficients of the N_k of the map, monomial by monomial of [`NU`], lanes k.
    pub map: [[f64; 4]; 6],
    /// How many of these monomials there are.
    pub n: usize,
    /// det J grad x and det J grad y: `[x or y][c]`, coefficients of 1, x, y; of a triangle the first alone.
    pub slopes: [[[f64; 3]; 2]; 2],
    /// Degrees of N_k, of the slopes, of the parent's functions.
    pub of_map: Degree,
    pub of_slopes: Degree,
    pub of_parent: Degree,
    pub coordinates: Coordinates,
}

impl Polynomials {
    #[inline(always)]
    pub fn new<L: Lanes>(parent: &Parent, sub: &SubFacet, projection: &Projection, map: &BilinearMap) -> Self {
        let coordinates = Coordinates::new::<L>(projection, map, corners(parent, sub, projection));
        // The sub-facet's coordinates in those of the parent.
        let [[ax, bx, cx], [ay, by, cy]] = coordinates.affine;
        let over = 1.0 / (bx * cy - by * cx);
        let (e1, e2, f1, f2) = (cy * over, -cx * over, -by * over, bx * over);
        let (e0, f0) = (-(e1 * ax + e2 * ay), -(f1 * ax + f2 * ay));
        let (e, f) = ([e0, e1, e2], [f0, f1, f2]);
        let both = [e0 * f0, e0 * f1 + e1 * f0, e0 * f2 + e2 * f0, e1 * f2 + e2 * f1, e1 * f1, e2 * f2];
        let (mut of_map, mut slopes) = ([[0.0; 4]; 6], [[[0.0; 3]; 2]; 2]);
        for k in 0..4 {
            let c = &projection.shape.coefficients[k];
            for s in 0..6 {
                of_map[s][k] = c[3] * both[s];
            }
            for s in 0..3 {
                of_map[s][k] += c[1] * e[s] + c[2] * f[s];
            }
            of_map[0][k] += c[0];
        }
        for i in 0..2 {
            for c in 0..2 {
                let s = &coordinates.slopes[i];
                for m in 0..3 {
                    slopes[i][c][m] = s[1][c] * e[m] + s[2][c] * f[m];
                }
                slopes[i][c][0] += s[0][c];
            }
        }
        let n = match (projection.shape.n, parent.n) {
            (3, _) => 3,
            (_, 8) => 6,
            _ => 4,
        };
        let of_parent = match parent.n {
            3 => Degree { total: 1, each: 1 },
            4 => Degree { total: 2, each: 1 },
            6 => Degree { total: 2, each: 2 },
            8 => Degree { total: 3, each: 2 },
            _ => Degree { total: 4, each: 2 },
        };
        let of_slopes = if n == 3 { Degree { total: 0, each: 0 } } else { Degree { total: 1, each: 1 } };
        Polynomials { map: of_map, n, slopes, of_map: degree_of_nu(n), of_slopes, of_parent, coordinates }
    }

    /// What N_k are multiplied with in a moment: the slopes times the derivatives of functions of this degree.
    pub fn beside_map(&self, functions: Degree) -> Degree {
        Degree::of(self.of_slopes.total + functions.total - 1, self.of_slopes.each + functions.each)
    }
}
