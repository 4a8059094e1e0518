//! Leaf geometry (`src/geometry`).

#[path = "../support/mod.rs"]
mod support;

mod edge_interval;
mod leaves;
