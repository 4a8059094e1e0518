//! The tangent: which pairs it has, their derivatives, and how its blocks leave.

pub mod around;
pub mod augmented;
pub mod blocks;
pub mod by_equations;
pub mod carried_tangent;
pub mod derivatives;
pub mod dual_facet;
pub mod emission;
pub mod facet_table;
pub mod fields;
pub mod frame;
pub mod linear_facet;
pub mod lines;
pub mod parent_table;
pub mod parents;
pub mod point_friction;
pub mod point_motion;
pub mod point_numbers;
pub mod point_offsets;
mod point_rows;
pub mod points;
pub mod read;
pub mod row_sums;
pub mod slopes;
pub mod task;
pub mod turning;
pub mod union;
