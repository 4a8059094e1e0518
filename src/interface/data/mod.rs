//! What an interface is, and what is known of it: plain data, each with its own checks. It knows no stage.

pub mod active;
pub mod checksum;
pub mod counters;
pub mod crease;
pub mod crosspoints;
pub mod csr;
pub mod effects;
pub mod extent;
pub mod facet_gaps;
pub mod facet_nodes;
pub mod frame;
pub mod history;
pub mod host_facets;
pub mod lines;
pub mod meaning;
pub mod multiplier;
pub mod node_data;
pub mod numbering;
pub mod offsets;
pub mod options;
pub mod pairs;
pub mod parents;
pub mod restart;
pub mod setup;
pub mod shape_offsets;
pub mod surface;
