//! Heat across an interface (docs/formulation 17): the weights at work for temperatures. Beside the stages of forces, whose
//! answers it takes; none of them knows it.

pub mod rows;
pub mod sides;
pub mod tangent;
