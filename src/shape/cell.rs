//! A facet's geometry: the cell that it is mapped from. Planes, overlaps, inverse maps, edges and the velocity of a
//! point know this and no field.

use super::basis::Basis;
use crate::simd::Lanes;

/// Most corners of a cell. Kernels keep one number a corner in the four lanes of a vector. Multipliers stand at corners,
/// so this bounds the rows A of weights and gaps, too.
pub const MAX_CORNERS: usize = 4;

/// A reference cell with its map.
pub trait Cell {
    /// Number of corners, and of edges.
    const CORNERS: usize;
    /// The corner after each, around the cell.
    const NEXT: [usize; MAX_CORNERS];
    /// The order of corners run through backwards; it maps the cell to itself, so the map stays bilinear.
    const REVERSED: [usize; MAX_CORNERS];
    /// The functions N^sigma_k of the map, one a corner: a point of the facet is sum_k N^sigma_k x_k, and its velocity in
    /// the plane is sum_k N^sigma_k Dy_k. Along an edge two of them are linear, the others vanish.
    type Map: Basis;
    /// Whether the map has a term xi eta.
    const BILINEAR: bool = <Self::Map as Basis>::TERMS == 4;

    /// Lanes in the order of the corners as given, where a facet's order was reversed.
    fn given<L: Lanes>(v: L, reversed: bool) -> L;
}
