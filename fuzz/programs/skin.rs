//! `src/skin.rs` for libFuzzer: general contact.
#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| stickslip_fuzz::skin::run(data));
