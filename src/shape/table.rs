//! Facet kinds as tables, for code that is not compiled for each: what they are is known while it runs.

use super::basis::{Basis, MAX_NODES};
use super::cell::{Cell, MAX_CORNERS};
use super::kind::{Map, SingleBasis};

/// A facet kind's geometry, and integrals of its fields.
#[derive(Debug)]
pub struct Shape {
    /// Number of corners: 3 or 4.
    pub n: usize,
    /// Coefficients of the map's functions in (1, xi, eta, xi eta), one row a corner; rows beyond `n` are zero.
    pub coefficients: [[f64; 4]; MAX_CORNERS],
    /// The corner after each, around the facet; a table, for a division per step would cost more than all else in a loop.
    pub next: [usize; MAX_CORNERS],
    /// The order of corners run through backwards.
    pub reversed: [usize; MAX_CORNERS],
    /// What is known of its fields.
    pub fields: Fields,
}

/// Integrals of a kind's fields over the reference cell.
#[derive(Debug)]
pub struct Fields {
    /// Of N_A, xi N_A and eta N_A.
    pub moments: [[f64; 3]; MAX_CORNERS],
    /// Of N_A N_B, times 1, xi, eta: `[m][A][B]`.
    pub products: [[[f64; MAX_NODES]; MAX_CORNERS]; 3],
}

impl Shape {
    /// The table of a kind. Code that reads it takes values of the map for those of the fields, and `products` for
    /// symmetric: of other kinds there is no table.
    pub(super) const fn new<K: SingleBasis>() -> Shape {
        let mut coefficients = [[0.0; 4]; MAX_CORNERS];
        let mut k = 0;
        while k < 4 * MAX_CORNERS {
            coefficients[k / 4][k % 4] = <Map<K> as Basis>::COEFFICIENTS[k % 4][k / 4];
            k += 1;
        }
        let (moments, products) = (K::Multiplier::MOMENTS, K::Multiplier::PRODUCTS);
        Shape {
            n: K::Cell::CORNERS,
            coefficients,
            next: K::Cell::NEXT,
            reversed: K::Cell::REVERSED,
            fields: Fields { moments, products },
        }
    }

    /// Values of the map's functions.
    #[inline]
    pub fn values(&self, xi: f64, eta: f64) -> [f64; MAX_CORNERS] {
        let mut n = [0.0; MAX_CORNERS];
        for k in 0..MAX_CORNERS {
            let c = &self.coefficients[k];
            n[k] = c[0] + c[1] * xi + c[2] * eta + c[3] * xi * eta;
        }
        n
    }
}
