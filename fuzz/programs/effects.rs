//! `src/effects.rs` for libFuzzer: an interface with laws, heat, decisions at points.
#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| stickslip_fuzz::effects::run(data));
