//! `src/pair.rs` for libFuzzer: two facets.
#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| stickslip_fuzz::pair::run(data));
