//! Mortar integration of one facet pair: the overlap, the weights n_AB and n_AC, their exact
//! derivatives, and the weighted gap (paper (11), (13); docs/formulation 2, 3). The same of a facet against an analytic
//! surface, without an overlap.
//!
//! Knows no contact law. Nothing here allocates.

mod analytic;
mod at_rest;
mod chain;
mod closed;
mod closed_part;
mod derivatives;
mod each_point;
mod edges;
mod element_rule;
mod field;
mod frame_motion;
mod gap;
mod moments;
mod offset;
#[cfg(test)]
mod oracle;
mod overlap;
mod pair_weights;
mod parent_pair;
mod points;
mod segment;
mod slots;
mod sub_edges;
mod sub_fields;
mod sub_integrals;
mod sub_moments;
mod sub_motion;
mod sub_pair;
mod sub_polynomials;
mod sub_products;
mod surface_pair;
mod transport;
mod weight_sums;
mod weights;

pub use analytic::{analytic_motion, analytic_motion_raised, analytic_weights, each_surface_point};
pub use at_rest::{facet_motion, facet_motion_raised};
pub use chain::{AreaDerivatives, ForceDerivatives, WeightDerivatives};
pub use closed_part::ClosedPart;
pub use derivatives::{pair_motion, pair_motion_raised};
pub use each_point::{OverlapPoint, PartPoint, each_part_point, each_point};
pub use field::MultiplierSpace;
pub use frame_motion::{FrameGaps, FrameMotion};
pub use gap::{AlongNormal, GapBlocks, Raised, gap, height_gap};
pub use offset::offset_motion;
pub use pair_weights::PairWeights;
pub use parent_pair::{ParentDerivatives, ParentFacet, ParentWeights, parent_weights};
pub use segment::{CellPoints, NonmortarFrame, Segment};
pub use slots::{MORTAR, PAIR_NODES};
pub use sub_motion::{ParentPositions, SubMotion, sub_motion};
pub use sub_pair::{COLUMNS, Side, SubWeights, rule_for, sub_weights};
pub use surface_pair::{AreaElement, SurfacePair, area_element};
