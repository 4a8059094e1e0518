//! The three-node triangle on (0,0), (1,0), (0,1).

use super::Shape;

/// Linear triangle.
pub static TRI3: Shape = Shape {
    n: 3,
    coefficients: [[1.0, -1.0, -1.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0; 4]],
    moments: [
        [1.0 / 6.0, 1.0 / 24.0, 1.0 / 24.0],
        [1.0 / 6.0, 1.0 / 12.0, 1.0 / 24.0],
        [1.0 / 6.0, 1.0 / 24.0, 1.0 / 12.0],
        [0.0; 3],
    ],
    reversed: [0, 2, 1, 3],
};
