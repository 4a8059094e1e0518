//! The matrix m_AB of a facet, the sum of n_AB over its pairs, and systems with it (docs/formulation 10.6).
//!
//! Cholesky's factors are those of the matrix scaled to a unit diagonal. A facet that is covered along one edge has
//! diagonals that differ by powers of the width, and no other ill condition: scaled, its condition is below 200 at any
//! width. Values are solutions with these factors; derivatives are products with the inverse, whose columns are such solutions
//! (`motion.rs`).

use crate::error::{Error, Kind, Result};
use crate::shape::MAX_CORNERS;

/// Smallest pivot of the scaled matrix. The worst condition that the fade leaves is 1e8, and no pivot is below one over
/// the condition; the rounding of a pivot is a few 1e-16. What is smaller than this is rounding.
pub const SMALLEST_PIVOT: f64 = 1e-14;

/// Smallest determinant of the scaled matrix of a facet that is integrated by points. Where the points do not determine
/// its functions the matrix is singular, and whatever the pivots of rounding do, its determinant is rounding: below 1e-15.
/// The smallest eigenvalue is not below 0.4 of the determinant, since those of a unit diagonal add up to 4: six digits of
/// the weights are left at least. Points within a convex set that do determine the functions have above 2e-8, for 2 to 10
/// points along a side.
pub const SMALLEST_DETERMINANT: f64 = 1e-9;

/// The factors of m_AB.
#[derive(Clone, Copy, Debug)]
pub struct Mass {
    nodes: usize,
    /// s_A = 1 / sqrt(m_AA) [1/L]; 0 of absent nodes.
    scale: [f64; MAX_CORNERS],
    /// L of s_A m_AB s_B = L L^T, with 1 / L_AA on its diagonal.
    lower: [[f64; MAX_CORNERS]; MAX_CORNERS],
}

impl Mass {
    /// Factors the matrix of a facet with so many nodes.
    ///
    /// # Errors
    /// [`Kind::DegenerateFacet`] when a pivot is not above [`SMALLEST_PIVOT`].
    pub fn new(nodes: usize, m: &[[f64; MAX_CORNERS]; MAX_CORNERS]) -> Result<Mass> {
        let (mut scale, mut lower) = ([0.0; MAX_CORNERS], [[0.0; MAX_CORNERS]; MAX_CORNERS]);
        for a in 0..nodes {
            scale[a] = 1.0 / m[a][a].sqrt();
        }
        for a in 0..nodes {
            for b in 0..=a {
                let mut v = scale[a] * m[a][b] * scale[b];
                for k in 0..b {
                    v -= lower[a][k] * lower[b][k];
                }
                if b < a {
                    lower[a][b] = v * lower[b][b];
                } else if v > SMALLEST_PIVOT {
                    lower[a][a] = 1.0 / v.sqrt();
                } else {
                    return Err(too_narrow(v)); // NaN, too
                }
            }
        }
        Ok(Mass { nodes, scale, lower })
    }

    /// The determinant of the scaled matrix, the product of its pivots.
    pub fn determinant(&self) -> f64 {
        (0..self.nodes).map(|a| 1.0 / (self.lower[a][a] * self.lower[a][a])).product()
    }

    /// m^-1 `v`; 0 at absent nodes.
    #[inline(always)]
    pub fn solve(&self, v: &[f64; MAX_CORNERS]) -> [f64; MAX_CORNERS] {
        let (s, l, mut x) = (&self.scale, &self.lower, [0.0; MAX_CORNERS]);
        for a in 0..self.nodes {
            x[a] = s[a] * v[a];
            for k in 0..a {
                x[a] -= l[a][k] * x[k];
            }
            x[a] *= l[a][a];
        }
        for a in (0..self.nodes).rev() {
            for k in a + 1..self.nodes {
                x[a] -= l[k][a] * x[k];
            }
            x[a] *= l[a][a];
        }
        for a in 0..MAX_CORNERS {
            x[a] *= s[a];
        }
        x
    }
}

impl Mass {
    /// m^-1, column by column: the solutions of unit vectors.
    pub fn inverse(&self) -> [[f64; MAX_CORNERS]; MAX_CORNERS] {
        let mut columns = [[0.0; MAX_CORNERS]; MAX_CORNERS];
        for b in 0..self.nodes {
            columns[b][b] = 1.0;
            columns[b] = self.solve(&columns[b]);
        }
        columns
    }
}

#[cold]
pub(super) fn too_few(determinant: f64) -> Error {
    let text = text!("its dual multipliers are not determined by points (a determinant of {determinant:.1e})");
    Error::new(Kind::DegenerateFacet, text)
}

#[cold]
fn too_narrow(pivot: f64) -> Error {
    let text = text!(
        "the mortar surface covers the facet by patches so small that its dual multipliers are not determined (a pivot of its mass matrix is {pivot:.1e}; above {SMALLEST_PIVOT:.0e} is needed): exchange the two sides, refine the non-mortar side, or take the standard multipliers"
    );
    Error::new(Kind::DegenerateFacet, text)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rounding of a few sums and divisions.
    const SAME: f64 = 1e-14;

    /// The matrix of a triangle of the area 12.
    const TRIANGLE: [[f64; 4]; 4] = [[2.0, 1.0, 1.0, 0.0], [1.0, 2.0, 1.0, 0.0], [1.0, 1.0, 2.0, 0.0], [0.0; 4]];

    #[test]
    fn solutions_solve() {
        let x = Mass::new(3, &TRIANGLE).unwrap().solve(&[4.0, 0.0, 0.0, 7.0]);
        for (found, expected) in x.iter().zip([3.0, -1.0, -1.0, 0.0]) {
            assert!((found - expected).abs() <= SAME, "{x:?}");
        }
    }

    /// Scaling of the nodes by powers of two, which a strip along an edge does, changes no digit.
    #[test]
    fn scaled_matrices_have_the_same_digits() {
        let power = |k: usize| 2f64.powi(-20 * k as i32);
        let scaled = std::array::from_fn(|a| std::array::from_fn(|b| TRIANGLE[a][b] * power(a) * power(b)));
        let v = [0.3, -0.7, 0.9, 0.0];
        let x = Mass::new(3, &TRIANGLE).unwrap().solve(&v);
        let y = Mass::new(3, &scaled).unwrap().solve(&std::array::from_fn(|a| v[a] * power(a)));
        for a in 0..3 {
            assert!((y[a] * power(a) - x[a]).abs() <= SAME, "{x:?} {y:?}");
        }
    }

    #[test]
    fn the_determinant_is_that_of_the_scaled_matrix() {
        // Eigenvalues 1/2, 1/2 and 2.
        let mass = Mass::new(3, &TRIANGLE).unwrap();
        assert!((mass.determinant() - 0.5).abs() <= SAME, "{}", mass.determinant());
    }

    #[test]
    fn what_determines_nothing_is_refused() {
        // All of the coverage in one point.
        for m in [[[0.0625; 4]; 4], [[0.0; 4]; 4], [[f64::NAN; 4]; 4]] {
            let error = Mass::new(4, &m).unwrap_err();
            assert_eq!(error.kind, Kind::DegenerateFacet);
            assert!(error.message.contains("exchange the two sides"), "{error}");
        }
    }
}
