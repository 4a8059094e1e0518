//! The four-node quadrilateral.

use super::kind::FacetKind;
use super::q1::Q1;
use super::quadrilateral::Quadrilateral;
use super::table::Shape;

/// Bilinear quadrilateral.
pub struct Quad4;

impl FacetKind for Quad4 {
    type Cell = Quadrilateral;
    type Displacement = Q1;
    type Multiplier = Q1;
}

/// [`Quad4`] as a table.
pub static QUAD4: Shape = Shape::new::<Quad4>();
