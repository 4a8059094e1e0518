//! Functions of a parent facet over one of its projected sub-facets: values and gradients in the plane
//! (docs/formulation 12.2).
//!
//! With the sub-facet's coordinates eta, a point has the parent's coordinates xi = c0 + c1 eta_1 + c2 eta_2, and
//! grad N_B = (d eta / dy)^T (d xi / d eta)^T grad_xi N_B.

use super::transport::dots;
use crate::geometry::Projection;
use crate::geometry::bilinear_map::BilinearMap;
use crate::shape::{GROUPS, MAX_CORNERS, Parent, SubFacet, TERMS, cell_corners, monomial_slopes, monomials};
use crate::simd::Lanes;

/// Coordinates that are affine in a sub-facet's own, with their gradients in the plane.
pub(super) struct Coordinates {
    /// c0, c1, c2 of each of the two.
    pub affine: [[f64; 3]; 2],
    /// det J times the gradient of each, in powers 1, eta_1, eta_2: `[i][m][c]`.
    pub slopes: [[[f64; 2]; 3]; 2],
}

/// Two coordinates of a point, and `[i][c]`, their derivatives with respect to y_c.
pub(super) struct Place {
    at: [f64; 2],
    gradient: [[f64; 2]; 2],
}

impl Coordinates {
    /// With these values at the corners of the projection, in its order.
    #[inline(always)]
    pub fn new<L: Lanes>(projection: &Projection, map: &BilinearMap, corners: [[f64; 2]; MAX_CORNERS]) -> Self {
        let gradients = map.gradients::<L>();
        let mut c = Coordinates { affine: [[0.0; 3]; 2], slopes: [[[0.0; 2]; 3]; 2] };
        for i in 0..2 {
            let v = [corners[0][i], corners[1][i], corners[2][i], corners[3][i]];
            c.affine[i] = match projection.shape.n {
                3 => [v[0], v[1] - v[0], v[2] - v[0]],
                _ => [
                    0.25 * (v[0] + v[1] + v[2] + v[3]),
                    0.25 * (v[1] + v[2] - v[0] - v[3]),
                    0.25 * (v[2] + v[3] - v[0] - v[1]),
                ],
            };
            c.slopes[i] = dots(&gradients, L::load(&v));
        }
        c
    }

    /// Of four points with these coordinates of the sub-facet.
    #[inline(always)]
    pub fn of_four<L: Lanes>(&self, eta: [L; 2]) -> [L; 2] {
        let mut at = eta;
        for i in 0..2 {
            let [a, b, c] = self.affine[i];
            at[i] = L::splat(c).mul_add(eta[1], L::splat(b).mul_add(eta[0], L::splat(a)));
        }
        at
    }

    /// At a point with these coordinates of the sub-facet, and the determinant there.
    #[inline(always)]
    pub fn at(&self, eta: [f64; 2], det: f64) -> Place {
        let mut place = Place { at: [0.0; 2], gradient: [[0.0; 2]; 2] };
        for i in 0..2 {
            let ([a, b, c], s) = (self.affine[i], &self.slopes[i]);
            place.at[i] = a + b * eta[0] + c * eta[1];
            for j in 0..2 {
                place.gradient[i][j] = (s[0][j] + s[1][j] * eta[0] + s[2][j] * eta[1]) / det;
            }
        }
        place
    }
}

/// Functions at a point, four in a group of lanes: values, and components of the gradients.
pub(super) struct Values<L, const G: usize> {
    pub n: [L; G],
    pub gradient: [[L; 2]; G],
}

/// Gradients in the plane from the derivatives with respect to two coordinates.
#[inline(always)]
fn in_plane<L: Lanes>([dx, dy]: [L; 2], gradient: &[[f64; 2]; 2]) -> [L; 2] {
    let mut of = [dx; 2];
    for c in 0..2 {
        of[c] = dx.mul_add(L::splat(gradient[0][c]), dy * L::splat(gradient[1][c]));
    }
    of
}

/// A parent's functions N_B over a sub-facet.
pub(super) struct Field {
    parent: &'static Parent,
    coordinates: Coordinates,
}

/// The parent's coordinates of a sub-facet's corners, in the order of its projection.
#[inline(always)]
pub(super) fn corners(parent: &Parent, sub: &SubFacet, projection: &Projection) -> [[f64; 2]; MAX_CORNERS] {
    let mut at = [[0.0; 2]; MAX_CORNERS];
    for k in 0..MAX_CORNERS {
        at[k] = parent.at[sub.nodes[projection.node[k] & 3]];
    }
    at
}

impl Field {
    #[inline(always)]
    pub fn new<L: Lanes>(parent: &'static Parent, sub: &SubFacet, projection: &Projection, map: &BilinearMap) -> Self {
        Field { parent, coordinates: Coordinates::new::<L>(projection, map, corners(parent, sub, projection)) }
    }

    /// Groups of functions that there are.
    pub fn groups(&self) -> usize {
        self.parent.groups()
    }

    /// Adds the integrals of `wn`, functions times weights at four points, and each monomial.
    #[inline(always)]
    pub fn add_moments<L: Lanes>(&self, eta: [L; 2], wn: &[L], moments: &mut [[L; TERMS]; MAX_CORNERS]) {
        let [x, y] = self.coordinates.of_four(eta);
        let m = monomials(x, y);
        for a in 0..wn.len() {
            for t in 0..TERMS {
                moments[a][t] = wn[a].mul_add(m[t], moments[a][t]);
            }
        }
    }

    /// The integrals of a function and each N_B from those of the monomials, lanes over points.
    #[inline(always)]
    pub fn of_moments<L: Lanes>(&self, moments: &[L; TERMS]) -> [L; GROUPS] {
        let zero = L::splat(0.0);
        let m = moments;
        let sums = [
            L::sums([m[0], m[1], m[2], m[3]]).store(),
            L::sums([m[4], m[5], m[6], m[7]]).store(),
            L::sums([m[8], zero, zero, zero]).store(),
        ];
        let mut n = [zero; GROUPS];
        for t in 0..self.parent.terms {
            let sum = L::splat(sums[t / 4][t % 4]);
            for g in 0..self.parent.groups() {
                n[g] = L::load(&self.parent.functions[t][g]).mul_add(sum, n[g]);
            }
        }
        n
    }

    #[inline(always)]
    pub fn at<L: Lanes>(&self, eta: [f64; 2], det: f64) -> Values<L, GROUPS> {
        let Place { at: [x, y], gradient } = self.coordinates.at(eta, det);
        let [m, mx, my] = monomial_slopes(x, y);
        let zero = L::splat(0.0);
        let mut v = Values { n: [zero; GROUPS], gradient: [[zero; 2]; GROUPS] };
        for g in 0..self.parent.groups() {
            let (mut dx, mut dy) = (zero, zero);
            for t in 0..self.parent.terms {
                let c = L::load(&self.parent.functions[t][g]);
                v.n[g] = c.mul_add(L::splat(m[t]), v.n[g]);
                dx = c.mul_add(L::splat(mx[t]), dx);
                dy = c.mul_add(L::splat(my[t]), dy);
            }
            v.gradient[g] = in_plane([dx, dy], &gradient);
        }
        v
    }
}

/// Where multipliers of a quadratic facet stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MultiplierSpace {
    /// At the parent's corners, with the functions of the linear cell on them.
    Corner,
    /// At all nodes, with the functions of the sub-facets.
    Sub,
}

impl MultiplierSpace {
    /// The parent's nodes that have the multipliers over a sub-facet, in the order of the functions N_A.
    pub fn nodes<'a>(self, parent: &Parent, sub: &'a SubFacet) -> &'a [usize] {
        const CORNERS: [usize; MAX_CORNERS] = [0, 1, 2, 3];
        match self {
            MultiplierSpace::Corner => &CORNERS[..parent.corners()],
            MultiplierSpace::Sub => &sub.nodes[..sub.shape.n],
        }
    }
}

/// The functions N_A of the multipliers over a sub-facet.
pub(super) struct Multipliers {
    /// Coefficients of 1, x, y, xy, lanes A.
    coefficients: [[f64; 4]; 4],
    coordinates: Coordinates,
}

impl Multipliers {
    #[inline(always)]
    pub fn new<L: Lanes>(
        space: MultiplierSpace,
        (parent, sub): (&Parent, &SubFacet),
        projection: &Projection,
        map: &BilinearMap,
    ) -> Self {
        let (shape, corners) = match space {
            MultiplierSpace::Corner => (parent.cell, corners(parent, sub, projection)),
            MultiplierSpace::Sub => (sub.shape, cell_corners(sub.shape)),
        };
        let mut coefficients = [[0.0; 4]; 4];
        for a in 0..MAX_CORNERS {
            for t in 0..4 {
                coefficients[t][a] = shape.coefficients[a][t];
            }
        }
        Multipliers { coefficients, coordinates: Coordinates::new::<L>(projection, map, corners) }
    }

    /// The functions at four points, one function after the other.
    #[inline(always)]
    pub fn of_four<L: Lanes>(&self, eta: [L; 2]) -> [L; MAX_CORNERS] {
        let [x, y] = self.coordinates.of_four(eta);
        let mut n = [x; MAX_CORNERS];
        for a in 0..MAX_CORNERS {
            let c = &self.coefficients;
            let slope = L::splat(c[3][a]).mul_add(y, L::splat(c[1][a]));
            n[a] = slope.mul_add(x, L::splat(c[2][a]).mul_add(y, L::splat(c[0][a])));
        }
        n
    }

    #[inline(always)]
    pub fn at<L: Lanes>(&self, eta: [f64; 2], det: f64) -> Values<L, 1> {
        let Place { at: [x, y], gradient } = self.coordinates.at(eta, det);
        let [one, cx, cy, cxy] = &self.coefficients;
        let (cx, cy, cxy) = (L::load(cx), L::load(cy), L::load(cxy));
        let dx = cxy.mul_add(L::splat(y), cx);
        let dy = cxy.mul_add(L::splat(x), cy);
        let n = dx.mul_add(L::splat(x), cy.mul_add(L::splat(y), L::load(one)));
        Values { n: [n], gradient: [in_plane([dx, dy], &gradient)] }
    }
}
