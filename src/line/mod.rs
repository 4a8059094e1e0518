//! Facets of plane and axisymmetric models: lines with two or three nodes, the weights of their pairs and the exact derivatives
//! (docs/formulation 13). Positions have two components, (x, y) or, axisymmetric, (r, z).

mod closed;
mod derivatives;
mod facet;
mod linear;
mod motion;
mod segment;
mod weights;

pub use closed::{each_part_point, each_point};
pub use derivatives::LineDerivatives;
pub use facet::{LineFacet, MAX_LINE_NODES};
pub use motion::line_motion;
pub use segment::Measure;
pub use weights::LineWeights;
