//! Signed distances in rational arithmetic: the doubles given are taken as exact.

use num_rational::BigRational;

type Vector = [BigRational; 3];

fn difference(a: [f64; 3], b: [f64; 3]) -> Vector {
    let exact = |v: f64| BigRational::from_float(v).expect("a finite coordinate");
    [0, 1, 2].map(|i| exact(a[i]) - exact(b[i]))
}

fn cross(a: &Vector, b: &Vector) -> Vector {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| &a[i] * &b[j] - &a[j] * &b[i])
}

/// w . ((b - a) x (p - a)), w the cross product of two vectors, each given by where it ends and begins: the distance of
/// p from the line from a to b as seen along w, positive to the left, times the lengths of w and of the line.
pub fn distance(spanning: [[[f64; 3]; 2]; 2], [a, b]: [[f64; 3]; 2], p: [f64; 3]) -> BigRational {
    let [w1, w2] = spanning.map(|[end, begin]| difference(end, begin));
    let (w, v) = (cross(&w1, &w2), cross(&difference(b, a), &difference(p, a)));
    &w[0] * &v[0] + &w[1] * &v[1] + &w[2] * &v[2]
}
