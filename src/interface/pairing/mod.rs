//! What a commit settles about the step that follows: which facets may meet, what can be covered, who carries whom.

pub mod analytic;
pub mod boxes;
pub mod candidates;
pub mod corners;
pub mod depth;
pub mod ends;
pub mod filter;
pub mod given;
pub mod hidden;
pub mod hybrid;
pub mod nearest;
pub mod orientation;
pub mod overlaps;
pub mod prism;
pub mod reach;
pub mod search;
pub mod seen;
pub mod settle;
pub mod stacked;
pub mod walls;
pub mod weak;
pub mod work;
