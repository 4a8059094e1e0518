//! The texts of refusals and statuses.

use super::status::{STICKSLIP_OK, STICKSLIP_PANIC};
use super::{guard, raw};
use crate::error::KINDS;
use libc::c_char;

/// The calling thread's last refusal in words: which argument, what was wrong, what is allowed. Empty after
/// a success. Nodes and facets are counted from 0 in it.
///
/// Cost: none.
/// Owner: the library; valid until the thread's next call. Zero-terminated, never NULL.
#[unsafe(no_mangle)]
pub extern "C" fn stickslip_last_error_message() -> *const c_char {
    guard::message()
}

/// The same text for a fixed-length character variable (Fortran): cut or padded with blanks to `length`
/// characters, no final zero. Leaves the message as it is unless it is refused itself.
///
/// text (length), output.
///
/// Errors: NULL_POINTER, INVALID_SIZE (length < 0).
/// Cost: a copy.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_last_error_padded(text: *mut c_char, length: i64) -> i32 {
    let outcome = raw::check(text, "text").and_then(|()| raw::count(length, 0, "length"));
    match outcome {
        Ok(length) => {
            let bytes = guard::message_bytes().chain(std::iter::repeat(b' ')).take(length);
            raw::write_each(text, bytes.map(|b| b as c_char));
            STICKSLIP_OK
        }
        Err(error) => guard::guard(|| Err(error)),
    }
}

/// A short text for any status number, known or not.
///
/// Cost: none.
/// Owner: the library, for good. Zero-terminated, never NULL.
#[unsafe(no_mangle)]
pub extern "C" fn stickslip_status_string(status: i32) -> *const c_char {
    let text = match status {
        STICKSLIP_OK => c"success",
        STICKSLIP_PANIC => c"fault of the library",
        _ => KINDS.iter().find(|(kind, _)| *kind as i32 == status).map_or(c"unknown status", |(_, text)| text),
    };
    text.as_ptr()
}
