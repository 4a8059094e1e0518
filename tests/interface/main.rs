//! The interface (`src/interface`): the stages as a handle runs them, its history, its effects.

#[path = "../support/mod.rs"]
mod support;

mod analytic;
mod boundary;
mod closing;
mod commits;
mod condensed;
mod crease;
mod crosspoints;
mod diagnosis;
mod dual;
mod dual_points;
mod effects;
mod ends;
mod equilibrium;
mod golden;
mod golden_parts;
mod history;
mod identities;
mod large_sliding;
mod laws;
mod lines;
mod normals;
mod offsets;
mod orders;
mod orientation;
mod parts;
mod parts_condensed;
mod patch;
mod plan;
mod points;
mod quadratic;
mod ratios;
mod reduction;
mod report;
mod rigid;
mod search;
mod stacked;
mod surface;
mod symmetric;
mod tangent;
mod tied_gap;
mod turns;
mod weak;
