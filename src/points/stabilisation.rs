//! K: what keeps multipliers from alternating (docs/formulation 16.3), over the covered area of a facet:
//! K_AB / m = (1/6) mean(h^2 grad N_A . grad N_B), h the nodes' sizes with the facet's own functions. Symmetric, at least 0, and its
//! rows add up to nothing, so that constant multipliers are free of it.

use crate::geometry::{Vec2, cross};
use crate::mortar::NonmortarFrame;
use crate::quadrature::cell::{square_point, triangle_point};
use crate::quadrature::line::GAUSS_2;
use crate::shape::MAX_CORNERS;

/// r over E* / h, E* the modulus of both bodies together as in Hertz' formulas.
pub const STIFFNESS: f64 = 0.9;
/// On a row of equal lines the mass matrix and K together are diagonal then.
const FACTOR: f64 = 1.0 / 6.0;

/// Of a facet with these sizes at its nodes [-].
#[inline(never)] // it is met several times
pub fn of_facet(frame: &NonmortarFrame, sizes: &[f64; MAX_CORNERS]) -> [[f64; MAX_CORNERS]; MAX_CORNERS] {
    let (facet, mut sum, mut area) = (&frame.projection, [[0.0; MAX_CORNERS]; MAX_CORNERS], 0.0);
    let n = facet.shape.n;
    for i in 0..GAUSS_2.len() * GAUSS_2.len() {
        let [xi, eta, weight] = if n == 3 { triangle_point(&GAUSS_2, i) } else { square_point(&GAUSS_2, i) };
        let slopes = facet.shape.coefficients.map(|c| [c[1] + c[3] * eta, c[2] + c[3] * xi]);
        let values = facet.shape.values(xi, eta);
        let (mut tangents, mut h) = ([Vec2::zeros(); 2], 0.0);
        for k in 0..n {
            tangents[0] += facet.y[k] * slopes[k][0];
            tangents[1] += facet.y[k] * slopes[k][1];
            h += values[k] * sizes[k];
        }
        let det = cross(tangents[0], tangents[1]);
        let [eta, xi] = tangents.map(|t| Vec2::new(t.y, -t.x) / det);
        let gradients = slopes.map(|[s, t]| xi * s - eta * t);
        let w = weight * det;
        area += w;
        for (a, b) in (0..n).flat_map(|a| (0..n).map(move |b| (a, b))) {
            sum[a][b] += FACTOR * w * h * h * gradients[a].dot(&gradients[b]);
        }
    }
    sum.map(|row| row.map(|k| k / area))
}

/// Of a line of this length.
pub fn of_line(length: f64, [h, g]: [f64; 2]) -> [[f64; MAX_CORNERS]; MAX_CORNERS] {
    let k = FACTOR * (h * h + h * g + g * g) / (3.0 * length * length);
    let mut of_ends = [[0.0; MAX_CORNERS]; MAX_CORNERS];
    (of_ends[0][0], of_ends[0][1], of_ends[1][0], of_ends[1][1]) = (k, -k, -k, k);
    of_ends
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Facet, Vec3};

    /// Rounding of a few sums of numbers of size 1.
    const ROUNDING: f64 = 1e-14;

    #[test]
    fn constants_are_free_and_squares_are_known() {
        let x = [[0.1, 0.0, 0.05], [1.1, 0.2, -0.05], [0.9, 1.3, 0.1], [-0.2, 0.8, -0.1]].map(Vec3::from);
        for n in [3, 4] {
            let frame = NonmortarFrame::new(&Facet::new(&x[..n]).unwrap()).unwrap();
            let k = of_facet(&frame, &[1.0, 0.7, 1.2, 0.9]);
            for a in 0..n {
                assert!(k[a].iter().sum::<f64>().abs() <= ROUNDING && k[a][a] > 0.0, "{k:?}");
                (0..n).for_each(|b| assert!((k[a][b] - k[b][a]).abs() <= ROUNDING, "{k:?}"));
            }
        }
        let square = [[0.0, 0.0], [0.5, 0.0], [0.5, 0.5], [0.0, 0.5]].map(|[x, y]| Vec3::new(x, y, 0.0));
        let k = of_facet(&NonmortarFrame::new(&Facet::new(&square).unwrap()).unwrap(), &[0.5; 4]);
        // int grad N_A . grad N_B of a square: 2/3, -1/6, -1/3.
        let expected = [2.0 / 3.0, -1.0 / 6.0, -1.0 / 3.0, -1.0 / 6.0].map(|v| v / 6.0);
        assert!(k[0].iter().zip(expected).all(|(k, e)| (k - e).abs() <= ROUNDING), "{k:?}");
    }

    #[test]
    fn mass_and_stabilisation_of_equal_lines_are_diagonal() {
        let k = of_line(0.5, [0.5; 2]);
        assert!((k[0][1] + 1.0 / 6.0).abs() <= ROUNDING && k[0][0] == -k[0][1], "{k:?}");
    }
}
