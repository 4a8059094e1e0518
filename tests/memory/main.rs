//! Memory (`src/memory.rs`): what allocates, how much, and that nothing aborts where there is none.
#![allow(unsafe_code)]

#[path = "../support/mod.rs"]
mod support;

mod allocator;
mod bytes;
mod calls;
mod evaluations;
mod sources;
