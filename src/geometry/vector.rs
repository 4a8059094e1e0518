//! Vectors and matrices in space and in the auxiliary plane.

/// A point or vector in space.
pub type Vec3 = nalgebra::Vector3<f64>;
/// A point or vector in the auxiliary plane.
pub type Vec2 = nalgebra::Vector2<f64>;
/// A 3 x 3 matrix.
pub type Mat3 = nalgebra::Matrix3<f64>;

/// The plane's cross product a x b: positive when b is to the left of a.
#[inline]
pub fn cross(a: Vec2, b: Vec2) -> f64 {
    a.x * b.y - a.y * b.x
}
