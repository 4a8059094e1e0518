//! The C ABI from Rust (`src/capi`): its numbers, its header, the layout of its structs.
#![allow(unsafe_code)]

#[path = "../support/mod.rs"]
mod support;

#[macro_use]
mod golden;
mod compose;
mod condensed;
mod dual;
mod header;
mod layout;
mod lines;
mod normals;
mod pair_state;
mod quadratic;
mod soname;
