//! The fuzz targets, and what they share: numbers from bytes, buffers that are watched, and what every answer of the C
//! ABI must keep to. libFuzzer runs them by `programs/`, `cargo test` by `tests/fuzz.rs`.

pub mod abi;
mod bytes;
mod derivatives;
pub mod effects;
pub mod interface;
mod lines;
mod meshes;
pub mod pair;
pub mod skin;
mod watched;

use bytes::Bytes;
use watched::Watched;

use std::ffi::CStr;
use stickslip::capi::{STICKSLIP_OK, stickslip_last_error_message, stickslip_status_string};

/// Whether a call succeeded. A refusal has a message and a known number, a success has none; nothing is ever the
/// library's own fault.
pub fn succeeded(status: i32) -> bool {
    // SAFETY: both return texts of the library that end with a zero.
    let [message, kind] =
        unsafe { [CStr::from_ptr(stickslip_last_error_message()), CStr::from_ptr(stickslip_status_string(status))] };
    assert!(status >= STICKSLIP_OK, "status {status}: {message:?}");
    assert!(kind != c"unknown status", "status {status}");
    assert_eq!(status == STICKSLIP_OK, message.is_empty(), "status {status}: {message:?}");
    assert!(message.to_str().is_ok(), "{message:?}");
    status == STICKSLIP_OK
}

/// What the library said of the last call.
pub fn message() -> String {
    // SAFETY: as above.
    unsafe { CStr::from_ptr(stickslip_last_error_message()) }.to_string_lossy().into_owned()
}

/// No infinity and no NaN leaves the library with a success.
pub fn all_finite(values: &[f64]) {
    assert!(values.iter().all(|v| v.is_finite()), "{values:?}");
}
