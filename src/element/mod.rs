//! Where mortar integration and contact law meet: a pair's share of residual and tangent, given the
//! nodal states (stage 3), and a node's own block (stage 4). With dual multipliers the tangent is a facet's.

mod dual_facet;
mod facet_pairs;
mod facet_rows;
mod nodal;
mod pair_matrix;
mod parent;
mod residual;
mod response;
mod tangent;

pub use dual_facet::DualFacet;
pub use facet_pairs::{FacetPairs, facet_sums};
pub use facet_rows::{Along, FacetGaps, Raise, Rows, Slopes, facet_rows, node_row};
pub use nodal::{NodalPair, NodalWeights, column_force};
pub use pair_matrix::{Lines, write_pair};
pub use parent::{ParentPair, parent_force};
pub use residual::pair_force;
pub use response::{FacetResponse, NodeTangent};
pub use tangent::{PairNow, PairTangent, RowColumns, row_columns};
