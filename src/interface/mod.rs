//! Two surfaces in contact: search, pairing, all four stages, history (docs/formulation 4.5).
//!
//! Residual and tangent are functions of (x, lambda, committed history) alone. Below the ABI nothing else allocates but
//! `adjacency`, which it calls.
//!
//! Data flows one way. [`Contact`] owns it and calls functions of data: `pairing` at a commit; in an evaluation the stages
//! `integrate`, `facet`, `sums`, `respond`, `residual`, and `tangent`. None of them knows the handle, and no stage calls an
//! earlier one.

#[cfg(test)]
mod by_hand;
mod cache;
pub mod compose;
mod condensation;
mod condensed;
mod contact;
mod data;
mod evaluation;
mod heat;
mod inspect;
mod layer;
mod linear;
mod linearisation;
mod offsets;
mod own;
mod pairing;
mod plan;
mod sensitive;
mod sensitivity;
mod stages;
mod tangent;
mod thermal;
mod turning;
mod weights;

pub use condensation::Piece;
pub use condensed::elimination::own_rows;
pub use condensed::reduction::{SplitRows, split_rows};
pub use condensed::rows::CondensedRows;
pub use contact::{Contact, Interface};
pub use data::checksum::{of_history as history_checksum, seal_history};
pub use data::counters::{Counters, NodeCounts};
pub use data::crease::Split;
pub use data::crosspoints::{Crosspoint, InterfaceNodes, crosspoints};
pub use data::csr::Csr;
pub use data::extent::Extent;
pub use data::facet_gaps::FacetGaps;
pub use data::facet_nodes::{FacetNodes, ParentNodes};
pub use data::history::History;
pub use data::node_data::{Owner, free_directions};
pub use data::options::{
    COVERAGE_MIN, Decision, Form, Friction, MODULUS_FACTOR, MortarSide, MultiplierBasis, NO_WEAK_COVERAGE, NewContact,
    Normals, Options, RowScale, Scheme, Shortcuts, Stiffness, TURN_MAX, Tangent, Weights, Wishes,
};
pub use data::pairs::{PairRecord, ParentRecord};
pub use data::parents::Parents;
pub use data::surface::{NO_EQUATION, NO_FACET, Surface};
pub use inspect::adjust::Adjusted;
pub use inspect::diagnosis::{Cause, Diagnosis, SUSPECT, Suspect, WorstPair};
pub use inspect::equilibrium::{Equilibrium, ROUNDINGS};
pub use inspect::largest::{Largest, Scales};
pub use inspect::report::{Cover, NodeCover, Report};
pub use inspect::why::Finding;
pub use linear::{PlanOf, PlanPairs};
pub(crate) use pairing::boxes::Aabb;
pub(crate) use pairing::corners::FACETS as CLOSE;
pub(crate) use pairing::search::Tree;
pub(crate) use pairing::walls::backs;
pub use plan::pattern::System as PlanSystem;
pub use plan::whole::Plan;
pub use sensitivity::Wanted;
pub use sensitivity::layout::Layout;
pub use stages::residual::Residual;
pub use stages::sums::NodeSums;
pub use tangent::by_equations::Sink;
pub use thermal::{Heat, Temperatures};
