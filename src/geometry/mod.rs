//! Leaf geometry: facets, the auxiliary plane, projection, clipping, inverse maps, edge intervals; analytic surfaces.
//!
//! Nothing here knows of contact; nothing allocates.

mod analytic_surface;
pub mod bilinear_map;
pub mod clip;
pub mod double_double;
pub mod edge_interval;
mod facet;
mod near_line;
mod plane;
mod projection;

pub use analytic_surface::{AnalyticShape, AnalyticSurface, Closest, FRAME, check_rigid_motion};
pub use facet::Facet;
pub use plane::Plane;
pub use projection::Projection;

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
