//! Deciding at points: what one non-mortar facet adds to the rows of its multipliers beside integrals of tractions
//! (docs/formulation 16). Functions of plain data; the weights of the closed part of an overlap are those of `mortar` and `line`.

mod stabilisation;

pub use stabilisation::{STIFFNESS, of_facet, of_line};
