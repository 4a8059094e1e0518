//! Facets of plane and axisymmetric models (`src/line`).

#[path = "../support/mod.rs"]
mod support;

mod golden;
mod identities;
