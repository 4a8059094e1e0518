//! Where the multipliers of quadratic facets stand, as a caller says it.

use super::choice::choose;
use crate::error::Result;
use crate::mortar::MultiplierSpace;

/// Multipliers of a quadratic facet at its corners, with the linear functions of these: the recommended ones.
pub const STICKSLIP_SPACE_CORNER: i32 = 0;
/// Multipliers at all nodes, with the functions of the linear parts that the facet is cut into.
/// Not with (UNSUPPORTED): dual multipliers (STICKSLIP_BASIS_DUAL) and nodes that decide (STICKSLIP_DECISION_NODES).
pub const STICKSLIP_SPACE_SUB: i32 = 1;

/// The space of a STICKSLIP_SPACE_... value.
pub(super) fn multiplier_space(value: i32, name: &str) -> Result<MultiplierSpace> {
    choose(value, name, &[MultiplierSpace::Corner, MultiplierSpace::Sub], 2)
}
