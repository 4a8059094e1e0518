//! Systems without multipliers (docs/formulation 10.7): with dual ones a node's force is its multiplier times its covered
//! area, so that the node's own rows give the multiplier, and what is left has displacements alone.

pub mod elimination;
pub mod hats;
pub mod pattern;
pub mod reduction;
pub mod refusal;
pub mod rows;
