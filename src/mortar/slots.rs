//! Where the nodes of a pair stand, and the corners of its two facets.

use crate::shape::{MAX_CORNERS, MAX_NODES};

/// First mortar slot.
pub const MORTAR: usize = MAX_NODES;
/// Slots for the nodes of a pair: the non-mortar ones, then the mortar ones, in the order the facets were given.
pub const PAIR_NODES: usize = MORTAR + MAX_NODES;

/// First slot of a mortar corner.
pub(super) const MORTAR_CORNER: usize = MAX_CORNERS;
/// Slots for the corners of a pair, mortar ones in the order of the projection: what moves the maps and the edges.
pub(super) const PAIR_CORNERS: usize = MORTAR_CORNER + MAX_CORNERS;
