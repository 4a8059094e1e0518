//! The area that two convex polygons with whole coordinates share, without rounding.

/// A point (x / w, y / w) with w > 0.
type Point = [i128; 3];

fn gcd(a: i128, b: i128) -> i128 {
    if b == 0 { a.abs() } else { gcd(b, a % b) }
}

fn reduced(p: Point) -> Point {
    let g = p.iter().fold(0, |g, v| gcd(g, *v));
    p.map(|v| v / g)
}

/// Positive where `p` lies to the left of the line from `a` to `b`.
fn side(a: [i64; 2], b: [i64; 2], p: Point) -> i128 {
    let [ax, ay, bx, by] = [a[0], a[1], b[0], b[1]].map(i128::from);
    (bx - ax) * (p[1] - ay * p[2]) - (by - ay) * (p[0] - ax * p[2])
}

/// What two polygons, both counter-clockwise, have in common.
pub fn shared_area(one: &[[i64; 2]], two: &[[i64; 2]]) -> f64 {
    let mut polygon: Vec<Point> = one.iter().map(|p| [p[0].into(), p[1].into(), 1]).collect();
    for (k, &a) in two.iter().enumerate() {
        let b = two[(k + 1) % two.len()];
        let mut kept = Vec::new();
        for (i, &p) in polygon.iter().enumerate() {
            let q = polygon[(i + 1) % polygon.len()];
            let (s, t) = (side(a, b, p), side(a, b, q));
            if s >= 0 {
                kept.push(p);
            }
            if s.signum() * t.signum() < 0 {
                // s and t carry the factors w of p and q already.
                let sign = if s > t { 1 } else { -1 };
                kept.push(reduced([0, 1, 2].map(|c| sign * (s * q[c] - t * p[c]))));
            }
        }
        polygon = kept;
    }
    let Some(&[x0, y0, w0]) = polygon.first() else { return 0.0 };
    // Differences over the common denominator, exact until they become doubles.
    let from = |[x, y, w]: Point| [x * w0 - x0 * w, y * w0 - y0 * w].map(|v| v as f64 / (w * w0) as f64);
    let at: Vec<_> = polygon.into_iter().map(from).collect();
    (2..at.len()).map(|i| 0.5 * (at[i - 1][0] * at[i][1] - at[i - 1][1] * at[i][0])).sum()
}

#[test]
fn shared_area_of_squares() {
    let square = |x: i64, y: i64| [[x, y], [x + 2, y], [x + 2, y + 2], [x, y + 2]];
    assert_eq!(shared_area(&square(0, 0), &square(1, 1)), 1.0);
    assert_eq!(shared_area(&square(0, 0), &square(0, 0)), 4.0);
    assert_eq!(shared_area(&square(0, 0), &square(2, 0)), 0.0);
    let diamond = [[1, -1], [3, 1], [1, 3], [-1, 1]];
    assert_eq!(shared_area(&square(0, 0), &diamond), 4.0);
    assert_eq!(shared_area(&[[0, 0], [3, 0], [0, 3]], &square(1, 1)), 0.5);
}
