//! Rigid bodies: six equations of a reference point in place of those of nodes (docs/formulation 14).
//!
//! Functions of plain data. An interface knows nothing of them: it has positions of nodes, gives their forces, and its tangent
//! has equations of nodes. `rotation` is of one body's rotation, `body` puts nodes where a motion has them and their forces
//! together, `plan` does the same with the entries of a tangent.

mod body;
mod plan;
mod rotation;

pub use body::{Body, Levers, Motion};
pub use plan::{RigidPlan, SIX};
pub use rotation::{cross, rotation, spin, turned};
