//! Integration over pairs of facets (`src/mortar`).

#[path = "../support/mod.rs"]
mod support;

mod element_rule;
mod golden;
mod quadratic;
mod sub_motion;
