//! Where mortar integration and contact law meet: a pair's share of residual and tangent, given the
//! nodal states (stage 3), and a node's own block (stage 4).

mod residual;
mod tangent;

pub use residual::pair_force;
pub use tangent::{FacetResponse, NodeTangent, PairNow, PairTangent, RowColumns, frozen_rows, gap_rows, row_columns};
