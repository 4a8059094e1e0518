//! General contact: sides, pieces, evaluations, steps of a skin.

#[path = "../support/mod.rs"]
mod support;

mod bodies;
mod evaluation;
mod roles;
mod step;
