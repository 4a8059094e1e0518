//! Where points decide: what the numbers of a tangent are made of.

use crate::geometry::Vec3;
use crate::interface::data::active::Active;
use crate::interface::data::points::Points;
use crate::interface::stages::sums::NodeSums;

/// What the numbers are made of.
pub struct PointNumbers<'a> {
    pub points: &'a Points,
    pub sums: &'a [NodeSums],
    /// nu_A.
    pub normals: &'a [Vec3],
    /// The pairs whose weights are differentiated; `None`: no weights are.
    pub active: Option<&'a Active>,
}
