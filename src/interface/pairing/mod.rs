//! What a commit settles about the step that follows: which facets may meet, what can be covered, who carries whom.

pub mod analytic;
pub mod candidates;
pub mod depth;
pub mod filter;
pub mod given;
pub mod hybrid;
pub mod overlaps;
pub mod reach;
pub mod search;
pub mod settle;
pub mod weak;
pub mod work;
