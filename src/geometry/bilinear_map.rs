//! The plane map y = a + b xi + c eta + d xi eta of a projected facet and its inverse in closed form
//! (kernel notes A). No iteration: one square root and one division a point.

use super::{Projection, Vec2, cross};
use crate::shape::MAX_NODES;

/// A twist below this (over the facet's size) is rounding: the facet is a parallelogram.
const PARALLELOGRAM: f64 = 1e-14;

/// Coefficients of the map of one projected facet.
#[derive(Clone, Copy, Debug)]
pub struct BilinearMap {
    a: Vec2,
    b: Vec2,
    c: Vec2,
    d: Vec2,
    coefficients: &'static [[f64; 4]; MAX_NODES],
    /// Whether the map is affine (triangle or parallelogram): then the weights are polynomials.
    pub is_affine: bool,
}

/// A point's reference coordinates and the map's Jacobian determinant there.
#[derive(Clone, Copy, Debug)]
pub struct Preimage {
    /// First reference coordinate.
    pub xi: f64,
    /// Second reference coordinate.
    pub eta: f64,
    /// det dy/d(xi, eta) [L^2].
    pub det: f64,
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
        BilinearMap {
            a: m[0],
            b: m[1],
            c: m[2],
            d: m[3],
            coefficients: &facet.shape.coefficients,
            is_affine: m[3].amax() <= PARALLELOGRAM * facet.size,
        }
    }

    /// Reference coordinates of the point `y` of a convex facet. Points outside it by rounding are
    /// fine.
    #[inline]
    pub fn inverse(&self, y: Vec2) -> Preimage {
        let r = y - self.a;
        let (bc, bd, rc, rd) = (cross(self.b, self.c), cross(self.b, self.d), cross(r, self.c), cross(r, self.d));
        let lead = bc - rd;
        // Rounding may take the discriminant below zero only at a corner where det J vanishes.
        let det = (lead * lead + 4.0 * bd * rc).max(0.0).sqrt();
        Preimage { xi: 2.0 * rc / (lead + det), eta: 2.0 * cross(self.b, r) / (bc + rd + det), det }
    }

    /// det J dN_k/dy = `g[0] + g[1] xi + g[2] eta`: linear, the products xi eta cancel.
    #[inline]
    pub fn gradients(&self) -> [[Vec2; MAX_NODES]; 3] {
        let (b, c, d) = (self.b, self.c, self.d);
        let mut g = [[Vec2::zeros(); MAX_NODES]; 3];
        for k in 0..MAX_NODES {
            let [_, n1, n2, n3] = self.coefficients[k];
            g[0][k] = Vec2::new(c.y * n1 - b.y * n2, b.x * n2 - c.x * n1);
            g[1][k] = Vec2::new(d.y * n1 - b.y * n3, b.x * n3 - d.x * n1);
            g[2][k] = Vec2::new(c.y * n3 - d.y * n2, d.x * n2 - c.x * n3);
        }
        g
    }

    /// det J = j0 + j1 xi + j2 eta.
    #[inline]
    pub fn determinant(&self) -> [f64; 3] {
        [cross(self.b, self.c), cross(self.b, self.d), cross(self.d, self.c)]
    }
}
