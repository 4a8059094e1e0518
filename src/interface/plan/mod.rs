//! The plan of a tangent: its entries, each once, and where every block of it goes. Made once for as many evaluations as it
//! suffices for.
//!
//! `numbering` orders the nodes as the host's equations are; `pattern` finds which blocks the rows of a node have; `places`
//! turns these into entries of compressed sparse rows; `scatter` keeps where the blocks of facets and pairs begin;
//! `phases` parts the facets among threads; `table` says who writes to which rows; `fill` takes the blocks, `add` adds them.

pub mod add;
pub mod ahead;
pub mod extras;
pub mod fill;
pub mod numbering;
pub mod pattern;
pub mod phases;
pub mod places;
pub mod scatter;
pub mod table;
pub mod whole;
