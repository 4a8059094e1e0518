//! Where points decide: what the numbers of a tangent are made of.

use super::around::Around;
use crate::geometry::Vec3;
use crate::interface::data::active::Active;
use crate::interface::data::host_facets::NormalDerivatives;
use crate::interface::data::pairs::ParentRecord;
use crate::interface::data::points::{Closed, Points};
use crate::interface::stages::sums::NodeSums;

/// What the numbers are made of.
pub struct PointNumbers<'a> {
    pub points: &'a Points,
    pub sums: &'a [NodeSums],
    /// Pairs of facets that have parts: their dual weights.
    pub parents: &'a [ParentRecord],
    /// nu_A.
    pub normals: &'a [Vec3],
    /// The pairs whose weights are differentiated; `None`: no weights are.
    pub active: Option<&'a Active>,
    /// Dnu of a facet's node, by facet and place, where normals follow the motion.
    pub turns: Option<&'a dyn Fn((usize, usize)) -> NormalDerivatives>,
}

impl PointNumbers<'_> {
    /// Whether sigma_A acts anywhere: on a facet that is not open.
    pub fn acts(&self, a: usize, around: &Around) -> bool {
        let is_closed = |at: usize| self.points.states[at] != Closed::Nothing;
        self.points.is_covered[a] && around.around(a).iter().any(|&k| around.at(k as usize).any(is_closed))
    }
}
