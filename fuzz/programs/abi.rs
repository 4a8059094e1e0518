//! `src/abi.rs` for libFuzzer: the C ABI.
#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| stickslip_fuzz::abi::run(data));
