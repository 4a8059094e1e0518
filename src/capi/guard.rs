//! Every entry point runs inside [`guard`]: refusals and panics become statuses, and the reason is kept
//! as text for the calling thread. A success allocates nothing.

use super::status::{STICKSLIP_OK, STICKSLIP_PANIC};
use crate::error::Result;
use libc::c_char;
use std::cell::{Cell, RefCell};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Once;

/// Longest message kept, its final zero included.
const CAPACITY: usize = 1024;

thread_local! {
    static MESSAGE: RefCell<[u8; CAPACITY]> = const { RefCell::new([0; CAPACITY]) };
    static INSIDE: Cell<bool> = const { Cell::new(false) };
}

/// Runs one entry point.
pub(super) fn guard(body: impl FnOnce() -> Result<()>) -> i32 {
    silence_panics();
    INSIDE.set(true);
    let outcome = catch_unwind(AssertUnwindSafe(body));
    INSIDE.set(false);
    match outcome {
        Ok(Ok(())) => {
            keep("");
            STICKSLIP_OK
        }
        Ok(Err(error)) => {
            keep(&error.message);
            error.kind as i32
        }
        Err(panic) => {
            let text = panic.downcast_ref::<String>().map(String::as_str);
            let text = text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("no text");
            keep(&format!("internal error, please report it: {text}"));
            STICKSLIP_PANIC
        }
    }
}

/// A panic inside an entry point is reported by its status; the default hook would print it.
fn silence_panics() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let previous = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |info| {
            if !INSIDE.get() {
                previous(info);
            }
        }));
    });
}

fn keep(text: &str) {
    MESSAGE.with_borrow_mut(|message| {
        // Cut at a character's border, so that the text stays UTF-8.
        let mut end = text.len().min(CAPACITY - 1);
        while !text.is_char_boundary(end) {
            end -= 1;
        }
        message[..end].copy_from_slice(&text.as_bytes()[..end]);
        message[end] = 0;
    });
}

/// The calling thread's message.
pub(super) fn message() -> *const c_char {
    MESSAGE.with_borrow(|message| message.as_ptr().cast())
}

/// Its characters, without the final zero.
pub(super) fn message_bytes() -> impl Iterator<Item = u8> {
    MESSAGE.with_borrow(|message| *message).into_iter().take_while(|b| *b != 0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::{Error, Kind};
    use std::ffi::CStr;

    fn text() -> String {
        // SAFETY: message() points to this thread's zero-terminated buffer.
        unsafe { CStr::from_ptr(message()) }.to_string_lossy().into_owned()
    }

    #[test]
    fn panics_and_refusals_become_statuses() {
        assert_eq!(guard(|| panic!("seven {}", 7)), STICKSLIP_PANIC);
        assert!(text().contains("seven 7"));
        assert_eq!(guard(|| Err(Error::new(Kind::InvalidValue, "mu is -1"))), Kind::InvalidValue as i32);
        assert_eq!(text(), "mu is -1");
        assert_eq!(guard(|| Ok(())), STICKSLIP_OK);
        assert_eq!(text(), "");
    }

    #[test]
    fn long_messages_are_cut_at_a_character() {
        guard(|| Err(Error::new(Kind::InvalidValue, "ä".repeat(CAPACITY))));
        assert_eq!(text().len(), CAPACITY - 2);
    }
}
