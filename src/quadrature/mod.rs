//! Quadrature rules with their stated degree.
//!
//! The transport form of the weights' derivative has degree 5 on affine facets where the weights themselves have degree
//! 4: rules below degree 5 leave the derivatives to that of degree 5 ([`Rule::for_derivatives`]). The exact integral's
//! derivative is not that of a coarse sum, so Newton's method then converges linearly, the slower the coarser.

pub mod cell;
pub mod line;
pub mod triangle;

/// The rules a pair is integrated with: triangles of the overlap, and source-edge intervals; whole quadrilaterals against
/// an analytic surface.
#[derive(Clone, Copy, Debug)]
pub struct Rule {
    /// Points (L1, L2, weight; weights sum to 1) on a triangle.
    pub triangle: &'static [[f64; 3]],
    /// Points (abscissa in 0..1, weight; weights sum to 1) on an interval.
    pub line: &'static [[f64; 2]],
    /// The same; products of two of its points integrate over a square.
    pub square: &'static [[f64; 2]],
    /// `triangle`, four points at a time (L1, L2, weight), filled up with points without weight.
    pub triangle_lanes: &'static [[[f64; 4]; 3]],
    /// `line`, four points at a time (abscissa, weight), likewise.
    pub line_lanes: &'static [[[f64; 4]; 2]],
    /// Polynomial degree that all integrate exactly.
    pub degree: u32,
}

/// 1 point a triangle: for comparisons; not even the weights of affine facets are exact, so the patch test is not met.
pub static DEGREE_1: Rule = Rule {
    triangle: &triangle::CENTROID_1,
    line: &line::GAUSS_4,
    square: &line::GAUSS_2,
    triangle_lanes: &lanes::<3, 1, 1>(&triangle::CENTROID_1),
    line_lanes: &lanes::<2, 4, 1>(&line::GAUSS_4),
    degree: 1,
};

/// 3 points a triangle: for comparisons; exact for no kind of facet, as degree 1, but closer.
pub static DEGREE_2: Rule = Rule {
    triangle: &triangle::STRANG_3,
    triangle_lanes: &lanes::<3, 3, 1>(&triangle::STRANG_3),
    degree: 2,
    ..DEGREE_1
};

/// 6 points a triangle: weights of affine facets exact.
pub static DEGREE_4: Rule = Rule {
    triangle: &triangle::STRANG_6,
    square: &line::GAUSS_3,
    triangle_lanes: &lanes::<3, 6, 2>(&triangle::STRANG_6),
    degree: 4,
    ..DEGREE_1
};

/// 12 points a triangle: distorted quadrilaterals.
pub static DEGREE_6: Rule = Rule {
    triangle: &triangle::DUNAVANT_12,
    square: &line::GAUSS_4,
    triangle_lanes: &lanes::<3, 12, 3>(&triangle::DUNAVANT_12),
    degree: 6,
    ..DEGREE_1
};

/// 12 points a triangle: exact for quadratic facets whose sub-facets are affine, where the others need degree 5.
pub static DEGREE_7: Rule = Rule {
    triangle: &triangle::GATERMANN_12,
    square: &line::GAUSS_4,
    triangle_lanes: &lanes::<3, 12, 3>(&triangle::GATERMANN_12),
    degree: 7,
    ..DEGREE_1
};

/// Most groups of four points that a rule has on an interval.
pub const LINE_GROUPS: usize = 2;

/// All of them, by degree.
pub static RULES: [&Rule; 7] = [&DEGREE_1, &DEGREE_2, &DEGREE_4, &DEGREE_5, &DEGREE_6, &DEGREE_7, &DEGREE_10];

impl Rule {
    /// The rule for integrals of derivatives: of degree 5 at least.
    pub fn for_derivatives(&self) -> &Rule {
        if self.degree < DEGREE_5.degree { &DEGREE_5 } else { self }
    }
}

/// 7 points a triangle, 4 an interval: exact for affine facets. The default.
pub static DEGREE_5: Rule = Rule {
    triangle: &triangle::RADON_7,
    line: &line::GAUSS_4,
    square: &line::GAUSS_3,
    triangle_lanes: &lanes::<3, 7, 2>(&triangle::RADON_7),
    line_lanes: &lanes::<2, 4, 1>(&line::GAUSS_4),
    degree: 5,
};

/// 36 points a triangle, 6 an interval: for warped or distorted facets where accuracy counts more
/// than time, and for difference tests on such facets.
pub static DEGREE_10: Rule = Rule {
    triangle: &triangle::CONICAL_36,
    line: &line::GAUSS_6,
    square: &line::GAUSS_6,
    triangle_lanes: &lanes::<3, 36, 9>(&triangle::CONICAL_36),
    line_lanes: &lanes::<2, 6, 2>(&line::GAUSS_6),
    degree: 10,
};

/// `N` points of `K` numbers each, the last one the weight, in `G` groups of four. What is left over repeats the first
/// point without weight.
const fn lanes<const K: usize, const N: usize, const G: usize>(rule: &[[f64; K]; N]) -> [[[f64; 4]; K]; G] {
    let mut groups = [[[0.0; 4]; K]; G];
    let mut i = 0;
    while i < 4 * G {
        let mut k = 0;
        while k < K {
            let point = if i < N { rule[i][k] } else { rule[0][k] };
            groups[i / 4][k][i % 4] = if i >= N && k == K - 1 { 0.0 } else { point };
            k += 1;
        }
        i += 1;
    }
    groups
}

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
        for rule in RULES {
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
        for rule in RULES {
            for (line, a) in [rule.line, rule.square].into_iter().flat_map(|l| (0..=rule.degree).map(move |a| (l, a))) {
                let sum: f64 = line.iter().map(|p| p[1] * p[0].powi(a as i32)).sum();
                assert!((sum - 1.0 / f64::from(a + 1)).abs() < 1e-15, "t^{a}");
            }
        }
    }

    #[test]
    fn lanes_hold_the_same_points() {
        for rule in RULES {
            let mut triangle = rule.triangle.iter();
            for i in 0..4 * rule.triangle_lanes.len() {
                let [l1, l2, w] = rule.triangle_lanes[i / 4].map(|v| v[i % 4]);
                let [p1, p2, v] = triangle.next().copied().unwrap_or([rule.triangle[0][0], rule.triangle[0][1], 0.0]);
                assert_eq!([l1, l2, w], [p1, p2, v]);
            }
            assert!(triangle.next().is_none());
            assert!(rule.line_lanes.len() <= LINE_GROUPS);
            let mut line = rule.line.iter();
            for i in 0..4 * rule.line_lanes.len() {
                let point = rule.line_lanes[i / 4].map(|v| v[i % 4]);
                assert_eq!(point, line.next().copied().unwrap_or([rule.line[0][0], 0.0]));
            }
            assert!(line.next().is_none());
        }
    }
}
