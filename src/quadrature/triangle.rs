//! Rules on a triangle: barycentric L1, L2 and weight; the weights sum to 1 (times the triangle's area).

use super::line::GAUSS_6;

/// Radon's 7-point rule, degree 5.
pub static RADON_7: [[f64; 3]; 7] = [
    [0.333_333_333_333_333_3, 0.333_333_333_333_333_3, 0.225],
    [0.10128650732345634, 0.10128650732345634, 0.12593918054482715],
    [0.797_426_985_353_087_3, 0.10128650732345634, 0.12593918054482715],
    [0.10128650732345634, 0.797_426_985_353_087_3, 0.12593918054482715],
    [0.470_142_064_105_115_1, 0.470_142_064_105_115_1, 0.132_394_152_788_506_2],
    [0.05971587178976982, 0.470_142_064_105_115_1, 0.132_394_152_788_506_2],
    [0.470_142_064_105_115_1, 0.05971587178976982, 0.132_394_152_788_506_2],
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
