//! Quadrature rules with their stated degree.
//!
//! The transport form of the weights' derivative has degree 5 on affine facets where the weights
//! themselves have degree 4, so no rule below degree 5 is offered.

pub mod line;
pub mod triangle;

/// The rules a pair is integrated with: cells of the overlap, and source-edge intervals; whole quadrilaterals against an
/// analytic surface.
#[derive(Clone, Copy, Debug)]
pub struct Rule {
    /// Points (L1, L2, weight; weights sum to 1) on a triangle.
    pub triangle: &'static [[f64; 3]],
    /// Points (abscissa in 0..1, weight; weights sum to 1) on an interval.
    pub line: &'static [[f64; 2]],
    /// The same; products of two of its points integrate over a square.
    pub square: &'static [[f64; 2]],
    /// Polynomial degree that all integrate exactly.
    pub degree: u32,
}

/// 7 points a triangle, 4 an interval: exact for affine facets. The default.
pub static DEGREE_5: Rule =
    Rule { triangle: &triangle::RADON_7, line: &line::GAUSS_4, square: &line::GAUSS_3, degree: 5 };

/// 36 points a triangle, 6 an interval: for warped or distorted facets where accuracy counts more
/// than time, and for difference tests on such facets.
pub static DEGREE_10: Rule =
    Rule { triangle: &triangle::CONICAL_36, line: &line::GAUSS_6, square: &line::GAUSS_6, degree: 10 };

#[cfg(test)]
mod tests {
    use super::*;

    // a! b! / (a + b + 2)! times 2: the mean of L1^a L2^b over a triangle.
    fn mean_monomial(a: u32, b: u32) -> f64 {
        let f = |n: u32| (1..=n).map(f64::from).product::<f64>();
        2.0 * f(a) * f(b) / f(a + b + 2)
    }

    #[test]
    fn triangle_rules_integrate_their_degree() {
        for rule in [&DEGREE_5, &DEGREE_10] {
            for a in 0..=rule.degree {
                for b in 0..=rule.degree - a {
                    let sum: f64 = rule.triangle.iter().map(|p| p[2] * p[0].powi(a as i32) * p[1].powi(b as i32)).sum();
                    assert!((sum - mean_monomial(a, b)).abs() < 1e-15, "L1^{a} L2^{b}");
                }
            }
            let above: f64 = rule.triangle.iter().map(|p| p[2] * p[0].powi(rule.degree as i32 + 2)).sum();
            assert!((above - mean_monomial(rule.degree + 2, 0)).abs() > 1e-15, "degree is understated");
        }
    }

    #[test]
    fn line_rules_integrate_their_degree() {
        for rule in [&DEGREE_5, &DEGREE_10] {
            for (line, a) in [rule.line, rule.square].into_iter().flat_map(|l| (0..=rule.degree).map(move |a| (l, a))) {
                let sum: f64 = line.iter().map(|p| p[1] * p[0].powi(a as i32)).sum();
                assert!((sum - 1.0 / f64::from(a + 1)).abs() < 1e-15, "t^{a}");
            }
        }
    }
}
