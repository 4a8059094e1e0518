//! Two surfaces in contact: search, pairing, all four stages, history (docs/formulation.md 4.5).
//!
//! Residual and tangent are functions of (x, lambda, committed history) alone. The only place of the core that allocates.
//!
//! Data flows one way. [`Contact`] owns it and calls the stages, which are functions of data: `pairing` at a commit, then
//! `integrate`, `sums`, `respond`, `residual` and `tangent` in an evaluation. No stage knows the handle, nor calls an earlier
//! one.

mod active;
mod analytic;
mod apart;
mod augmented;
mod away;
mod bytes;
mod cache;
mod candidates;
mod carried;
mod carried_tangent;
mod checksum;
mod closing;
mod commit;
mod contact;
mod counters;
mod crease;
mod crosspoints;
mod depth;
mod derivatives;
mod describe;
mod diagnosis;
mod effects;
mod emission;
mod equilibrium;
mod extent;
mod facet_gaps;
mod facet_tangent;
mod filter;
mod given;
mod history;
mod hybrid;
mod initial;
mod integrate;
mod layers;
mod lost;
mod meaning;
mod mistakes;
mod multiplier;
mod node;
mod node_data;
mod numbering;
mod options;
mod pairing;
mod pairs;
mod reach;
mod report;
mod residual;
mod respond;
mod restart;
mod search;
mod setup;
mod sums;
mod surface;
mod tangent;
mod turn;
mod union;
mod weak;

pub use checksum::seal_history;
pub use contact::{Contact, Interface};
pub use counters::{Counters, NodeCounts};
pub use crease::Split;
pub use crosspoints::{Crosspoint, InterfaceNodes, crosspoints};
pub use diagnosis::{Cause, Diagnosis, SUSPECT, Suspect, WorstPair};
pub use emission::Sink;
pub use equilibrium::{Equilibrium, Largest, ROUNDINGS, Scales};
pub use extent::Extent;
pub use facet_gaps::FacetGaps;
pub use history::History;
pub use options::{
    COVERAGE_MIN, Form, Friction, MODULUS_FACTOR, MortarSide, NewContact, Options, RowScale, Scheme, Shortcuts,
    Stiffness, TURN_MAX, Tangent, Weights,
};
pub use pairs::PairRecord;
pub use report::{Cover, Finding, NodeCover, Report};
pub use residual::Residual;
pub use sums::NodeSums;
pub use surface::{FacetNodes, NO_EQUATION, Surface};
