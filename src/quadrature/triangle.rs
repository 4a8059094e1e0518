//! Rules on a triangle: barycentric L1, L2 and weight; the weights sum to 1 (times the triangle's area).

use super::line::GAUSS_6;

/// Radon's 7-point rule, degree 5.
pub static RADON_7: [[f64; 3]; 7] = [
    [0.33333333333333333, 0.33333333333333333, 0.225],
    [0.10128650732345634, 0.10128650732345634, 0.12593918054482715],
    [0.79742698535308732, 0.10128650732345634, 0.12593918054482715],
    [0.10128650732345634, 0.79742698535308732, 0.12593918054482715],
    [0.47014206410511509, 0.47014206410511509, 0.13239415278850618],
    [0.05971587178976982, 0.47014206410511509, 0.13239415278850618],
    [0.47014206410511509, 0.05971587178976982, 0.13239415278850618],
];

/// Conical product of two 6-point Gauss rules, degree 10 (one degree goes to the Jacobian).
pub static CONICAL_36: [[f64; 3]; 36] = conical(&GAUSS_6);

const fn conical(line: &[[f64; 2]; 6]) -> [[f64; 3]; 36] {
    let mut rule = [[0.0; 3]; 36];
    let mut i = 0;
    while i < 36 {
        let (u, v) = (line[i / 6], line[i % 6]);
        // The square (u, v) collapses onto the triangle by L1 = u, L2 = (1 - u) v.
        rule[i] = [u[0], (1.0 - u[0]) * v[0], 2.0 * (1.0 - u[0]) * u[1] * v[1]];
        i += 1;
    }
    rule
}
