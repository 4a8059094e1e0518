//! The stage of a facet with dual multipliers (`src/dual`).

#[path = "../support/mod.rs"]
mod support;

mod derivatives;
mod facet;
mod full;
mod golden;
mod identities;
mod interfaces;
