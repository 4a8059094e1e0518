//! Where the nodes of a pair stand.

/// Slots for the nodes of a pair: 0..4 non-mortar, 4..8 mortar, in the order the facets were given.
pub const PAIR_NODES: usize = 8;
/// First mortar slot.
pub const MORTAR: usize = 4;

/// The slots that a tangent looks at: all, or the non-mortar ones where the mortar side does not move.
pub const fn slots(moves: bool) -> usize {
    if moves { PAIR_NODES } else { MORTAR }
}
