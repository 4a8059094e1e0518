//! `src/interface.rs` for libFuzzer: an interface by its C functions.
#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| stickslip_fuzz::interface::run(data));
