//! Every entry point runs inside [`guard`]: refusals and panics become statuses, and the reason is kept
//! as text for the calling thread. A success allocates nothing. The floating-point environment is the default one
//! inside and the caller's again outside.

use super::fp_environment::FpEnvironment;
use super::status::{STICKSLIP_OK, STICKSLIP_PANIC};
use crate::error::{Error, Kind, Result};
use libc::c_char;
use std::cell::Cell;
use std::hint::black_box;
use std::panic::{AssertUnwindSafe, PanicHookInfo, catch_unwind};
use std::sync::{Once, OnceLock};

/// Longest message kept, its final zero included.
const CAPACITY: usize = 1024;

/// What a thread has of its own.
struct Thread {
    message: [Cell<u8>; CAPACITY],
    /// Whether the library's own code runs.
    inside: Cell<bool>,
    /// Whether a function of the host's runs that the library has called.
    calling: Cell<bool>,
}

thread_local! {
    static THREAD: Thread = const {
        Thread { message: [const { Cell::new(0) }; CAPACITY], inside: Cell::new(false), calling: Cell::new(false) }
    };
}

/// Runs one entry point.
#[inline(always)]
pub(super) fn guard(body: impl FnOnce() -> Result<()>) -> i32 {
    let mut body = Some(body);
    // One function for all entry points: a copy in each would be a fiftieth of the library.
    run(&mut || body.take().map_or(Ok(()), |body| body()))
}

/// Runs the body of one entry point, which it calls once.
#[inline(never)]
fn run(body: &mut dyn FnMut() -> Result<()>) -> i32 {
    let _environment = FpEnvironment::enter();
    silence_panics();
    THREAD.with(|thread| {
        let outside = thread.inside.replace(true);
        // What the body computes with may be anything up to here, so no arithmetic can move before the new environment.
        let body = black_box(body);
        let outcome = catch_unwind(AssertUnwindSafe(body));
        thread.inside.set(outside);
        match outcome {
            Ok(Ok(())) => {
                thread.message[0].set(0);
                STICKSLIP_OK
            }
            Ok(Err(error)) => {
                thread.keep(&error.message);
                error.kind as i32
            }
            Err(panic) => {
                let text = panic.downcast_ref::<String>().map(String::as_str);
                let text = text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("no text");
                thread.keep(&text!("internal error, please report it: {text}"));
                STICKSLIP_PANIC
            }
        }
    })
}

/// Calls a function of the host's from within an entry point. It must not unwind.
pub(super) fn calling_the_host<T>(call: impl FnOnce() -> T) -> T {
    THREAD.with(|thread| {
        thread.calling.set(true);
        thread.inside.set(false);
        let answer = call();
        thread.inside.set(true);
        thread.calling.set(false);
        answer
    })
}

/// Refuses what a function of the host's must not do while the library has called it.
pub(super) fn refuse_within_a_law() -> Result<()> {
    if THREAD.with(|thread| thread.calling.get()) {
        let text = "called from within a law of the host's: the library is at work with an interface there, and takes no other call with one";
        return Err(Error::new(Kind::InvalidValue, text));
    }
    Ok(())
}

/// A panic inside an entry point is reported by its status; the default hook would print it.
fn silence_panics() {
    type Hook = Box<dyn Fn(&PanicHookInfo<'_>) + Sync + Send>;
    static ONCE: Once = Once::new();
    static PREVIOUS: OnceLock<Hook> = OnceLock::new();
    ONCE.call_once(|| {
        PREVIOUS.get_or_init(std::panic::take_hook);
        // Holds nothing, so the box takes no memory.
        std::panic::set_hook(Box::new(|info| {
            if let (false, Some(previous)) = (THREAD.with(|thread| thread.inside.get()), PREVIOUS.get()) {
                previous(info);
            }
        }));
    });
}

impl Thread {
    #[cold]
    fn keep(&self, text: &str) {
        // Cut at a character's border, so that the text stays UTF-8.
        let mut end = text.len().min(CAPACITY - 1);
        while !text.is_char_boundary(end) {
            end -= 1;
        }
        for (cell, byte) in self.message.iter().zip(text[..end].bytes().chain([0])) {
            cell.set(byte);
        }
    }
}

/// The calling thread's message.
pub(super) fn message() -> *const c_char {
    THREAD.with(|thread| thread.message.as_ptr().cast())
}

/// Its characters, without the final zero.
pub(super) fn message_bytes() -> impl Iterator<Item = u8> {
    THREAD.with(|thread| thread.message.each_ref().map(Cell::get)).into_iter().take_while(|b| *b != 0)
}

#[cfg(test)]
mod tests {
    use super::*;
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
    #[cfg(target_arch = "x86_64")]
    fn panics_and_refusals_give_the_floating_point_environment_back() {
        /// Rounding upwards, subnormal results and inputs as zeros, every flag raised; masks as they are.
        const OTHER: u32 = 0x1F80 | 0x4000 | 0x8040 | 0x3F;
        let (mut own, mut within, mut after) = (0u32, 0u32, [0u32; 3]);
        // SAFETY: stores MXCSR.
        let read = |to: &mut u32| unsafe { std::arch::asm!("stmxcsr [{}]", in(reg) to) };
        // SAFETY: loads a valid MXCSR; what runs under it computes nothing with numbers.
        let load = |value: &u32| unsafe { std::arch::asm!("ldmxcsr [{}]", in(reg) value) };
        read(&mut own);
        let ends: [fn() -> Result<()>; 3] =
            [|| Ok(()), || Err(Error::new(Kind::InvalidValue, "refused")), || panic!("a fault")];
        for (end, after) in ends.into_iter().zip(&mut after) {
            load(&OTHER);
            guard(|| {
                read(&mut within);
                end()
            });
            read(after);
            load(&own);
            assert_eq!(within, 0x1F80);
        }
        assert_eq!(after, [OTHER; 3]);
    }

    #[test]
    fn long_messages_are_cut_at_a_character() {
        guard(|| Err(Error::new(Kind::InvalidValue, "ä".repeat(CAPACITY))));
        assert_eq!(text().len(), CAPACITY - 2);
    }
}
