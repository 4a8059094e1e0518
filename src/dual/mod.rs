//! Dual multipliers: the stage of a facet, between the integration over pairs and the law of a node
//! (docs/formulation 10). All of it is functions of plain data of one non-mortar facet:
//!
//! - values: [`FacetSums`] adds up the facet's pairs, [`DualBasis`] gives dual weights, heights and tractions;
//! - derivatives: the kernels of `mortar` give those of a pair at the facet's heights and tractions, [`FacetMotion`]
//!   makes of them the pair's share of the facet's, [`FacetColumns`] adds up the rows of the mortar nodes of all its pairs;
//! - [`WholeFacet`] does both against an analytic surface, where gaps are vectors.
//!
//! Knows no contact law. Nothing here allocates.

mod basis;
mod columns;
mod coverage;
mod mass;
mod motion;
mod parents;
mod sums;
mod vectors;

pub use basis::DualBasis;
pub use columns::{Columns, FacetColumns, GROUP, TractionDerivatives, couple};
pub use coverage::{Coverage, FADE_BAND, whole_area_derivative};
pub use mass::{Mass, SMALLEST_DETERMINANT, SMALLEST_PIVOT};
pub use motion::{FacetMotion, FacetShare, PairShare, share_of};
pub use parents::corner_shares;
pub use sums::FacetSums;
pub use vectors::WholeFacet;
