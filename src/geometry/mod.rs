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
mod over;
mod plane;
mod projection;
mod spin;
mod vector;

pub use analytic_surface::{AnalyticShape, AnalyticSurface, Closest, FRAME, check_rigid_motion, in_plane};
pub use facet::Facet;
pub use over::{OUTSIDE, Over};
pub use plane::Plane;
pub use projection::Projection;
pub use spin::Spin;
pub use vector::{Mat3, Vec2, Vec3, cross};
