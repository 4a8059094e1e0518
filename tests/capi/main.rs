//! The C ABI from Rust (`src/capi`): its numbers, its header, the layout of its structs.
#![allow(unsafe_code)]

#[path = "../support/mod.rs"]
mod support;

mod golden;
mod header;
mod layout;
