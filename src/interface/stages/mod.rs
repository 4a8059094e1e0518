//! What a commit and an evaluation are made of: functions from data to data. Of the stages of an evaluation (`integrate`,
//! `facet`, `sums`, `respond`, `residual`) none calls an earlier one; `commit` runs the first three at the new configuration.

pub mod acting;
pub mod again;
pub mod apart;
pub mod away;
pub mod carried;
pub mod commit;
pub mod conserving;
pub mod facet;
pub mod initial;
pub mod integrate;
pub mod keep;
pub mod layers;
pub mod lost;
pub mod node;
pub mod normals;
pub mod over;
pub mod own;
pub mod part_weights;
pub mod point_friction;
mod point_layers;
pub mod point_memory;
mod point_parts;
pub mod points;
pub mod points_now;
pub mod residual;
pub mod respond;
pub mod shares;
pub mod spin;
pub mod sums;
pub mod turn;
