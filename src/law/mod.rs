//! The nodal contact law: from the assembled weighted gaps and the multiplier of one non-mortar node to
//! its state, its projected traction and their derivatives (paper (17), (18), (22)-(31) as corrected in
//! docs/formulation 1.3). Knows no geometry: a node is vectors and numbers.
//!
//! One projection per node, from the gap that is summed over all pairs: the projection is not linear,
//! so projecting pair by pair would make the answer depend on the augmentation (docs/formulation
//! 4.5).
//!
//! A law is a type: [`Coulomb`] (with an infinite coefficient: rough), [`Frictionless`], [`Tied`], [`Tresca`]; what the rest of the
//! library knows of it is a row of [`LAWS`]. A host may put one of its own in Coulomb's place: [`Own`]. A node has N multiplier components, three or, without friction, one.

mod bond;
mod cone;
mod coulomb;
mod frictionless;
mod heat;
mod layer;
mod node;
mod orthotropic;
mod overclosure;
mod own;
mod projection;
mod question;
mod rate;
mod slip;
mod special;
mod stateless;
mod table;
mod tied;
mod told;
mod tresca;
mod violation;
mod weakening;

pub use bond::Bond;
pub use cone::{Cone, Trial, trial};
pub use coulomb::Coulomb;
pub use frictionless::Frictionless;
pub use heat::{Conductance, FADES, FEW, HeatFlow, HeatNode, heat_flow};
pub use layer::{Layer, LayerAnswer, LayerQuestion, LayerState};
pub use node::{Law, Node, NodeResponse, Turn};
pub use orthotropic::Orthotropic;
pub use overclosure::{Overclosure, Squeeze};
pub use own::{Host, OWN_NAMES, Own};
pub use projection::{Projected, State, TIE, Threshold, project, project_parts};
pub use question::{Answer, Question};
pub use slip::SlipMeasure;
pub use special::{Ellipse, Special, Told};
pub use table::{Coefficient, Friction, LAWS, LawFunctions, LawRow, Remembers};
pub use tied::Tied;
pub use told::ToldLaw;
pub use tresca::Tresca;
pub use violation::{Measure, Violation};
