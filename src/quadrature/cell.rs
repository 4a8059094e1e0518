//! Product rules on a facet's whole reference cell, from n Gauss points on a line: n x n points.

use super::line;

/// The fewest and the most points along a line.
pub const POINTS: [usize; 2] = [2, 10];

/// The Gauss points on a line; `None` of a number that is not there.
pub fn line_of(points: usize) -> Option<&'static [[f64; 2]]> {
    const LINES: [&[[f64; 2]]; 9] = [
        &line::GAUSS_2,
        &line::GAUSS_3,
        &line::GAUSS_4,
        &line::GAUSS_5,
        &line::GAUSS_6,
        &line::GAUSS_7,
        &line::GAUSS_8,
        &line::GAUSS_9,
        &line::GAUSS_10,
    ];
    LINES.get(points.checked_sub(POINTS[0])?).copied()
}

/// The i-th of the n x n points on the square (-1, 1) x (-1, 1): xi, eta, weight; the weights sum to 4.
#[inline(always)]
pub fn square_point(line: &[[f64; 2]], i: usize) -> [f64; 3] {
    let ([s, v], [t, w]) = (line[i / line.len()], line[i % line.len()]);
    [2.0 * s - 1.0, 2.0 * t - 1.0, 4.0 * v * w]
}

/// The i-th of the n x n points on the triangle (0, 0), (1, 0), (0, 1), on which the square collapses: xi, eta, weight;
/// the weights sum to 1/2. One degree goes to the Jacobian.
#[inline(always)]
pub fn triangle_point(line: &[[f64; 2]], i: usize) -> [f64; 3] {
    let ([s, v], [t, w]) = (line[i / line.len()], line[i % line.len()]);
    [s, (1.0 - s) * t, (1.0 - s) * v * w]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_have_the_points_asked_for() {
        for n in 0..12 {
            let line = line_of(n);
            assert_eq!(line.map(<[_]>::len), (POINTS[0]..=POINTS[1]).contains(&n).then_some(n));
        }
    }

    #[test]
    fn cells_integrate_their_degree() {
        for n in POINTS[0]..=POINTS[1] {
            let line = line_of(n).unwrap();
            for (a, b) in (0..2 * n as i32).flat_map(|a| (0..2 * n as i32).map(move |b| (a, b))) {
                let sum = |point: fn(&[[f64; 2]], usize) -> [f64; 3]| -> f64 {
                    (0..n * n).map(|i| point(line, i)).map(|[xi, eta, w]| w * xi.powi(a) * eta.powi(b)).sum()
                };
                let side = |k: i32| if k % 2 == 0 { 2.0 / f64::from(k + 1) } else { 0.0 };
                assert!((sum(square_point) - side(a) * side(b)).abs() < 1e-14, "{n}: xi^{a} eta^{b}");
                if a + b <= 2 * n as i32 - 2 {
                    // a! b! / (a + b + 2)!
                    let exact =
                        (1..=b).map(f64::from).product::<f64>() / (a + 1..=a + b + 2).map(f64::from).product::<f64>();
                    assert!((sum(triangle_point) - exact).abs() < 1e-15, "{n}: L1^{a} L2^{b}");
                }
            }
        }
    }
}
