//! The three-node triangle.

use super::kind::FacetKind;
use super::p1::P1;
use super::table::Shape;
use super::triangle::Triangle;

/// Linear triangle.
pub struct Tri3;

impl FacetKind for Tri3 {
    type Cell = Triangle;
    type Displacement = P1;
    type Multiplier = P1;
}

/// [`Tri3`] as a table.
pub static TRI3: Shape = Shape::new::<Tri3>();
