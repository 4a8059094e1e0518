//! The four-node quadrilateral on (-1,-1), (1,-1), (1,1), (-1,1).

use super::Shape;

const Q: f64 = 0.25;
const T: f64 = 1.0 / 3.0;

/// Bilinear quadrilateral.
pub static QUAD4: Shape = Shape {
    n: 4,
    coefficients: [[Q, -Q, -Q, Q], [Q, Q, -Q, -Q], [Q, Q, Q, Q], [Q, -Q, Q, -Q]],
    moments: [[1.0, -T, -T], [1.0, T, -T], [1.0, T, T], [1.0, -T, T]],
    reversed: [0, 3, 2, 1],
};
