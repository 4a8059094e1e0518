//! Integration over pairs of facets (`src/mortar`).

#[path = "../support/mod.rs"]
mod support;

mod closed_part;
mod element_rule;
mod golden;
mod quadratic;
mod sub_motion;
