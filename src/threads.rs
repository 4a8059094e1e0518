//! Work shared out among threads.
//!
//! What is computed does not depend on how many threads there are: work is cut into the same chunks for any number. The
//! library starts threads where its caller asks for them, and they end with the call.

use crate::error::{Error, Result};
use crate::memory::{self, Store};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Does `work` for the numbers 0 to n - 1 on so many threads, this one among them; each has one of `rooms`, of which there are
/// as many. The first refusal, by these numbers, is the outcome.
///
/// # Errors
/// Those of `work`. That no thread can be started is none: fewer do the work.
pub fn share<R: Send>(n: usize, rooms: &mut [R], work: impl Fn(usize, &mut R) -> Result<()> + Sync) -> Result<()> {
    let next = AtomicUsize::new(0);
    let run = |room: &mut R| -> Option<(usize, Error)> {
        loop {
            let k = next.fetch_add(1, Ordering::Relaxed);
            if k >= n {
                return None;
            }
            if let Err(error) = work(k, room) {
                return Some((k, error));
            }
        }
    };
    let Some((own, others)) = rooms.split_first_mut() else { return Ok(()) };
    let outcome = if others.is_empty() || n < 2 {
        run(own)
    } else {
        std::thread::scope(|scope| {
            let run = &run;
            let start = |room| std::thread::Builder::new().spawn_scoped(scope, move || run(room)).ok();
            let mut threads = memory::with_room(others.len()).unwrap_or_default();
            for room in others.iter_mut().take(threads.capacity()) {
                if let Some(thread) = start(room) {
                    let _ = threads.store(thread);
                }
            }
            let first = run(own);
            let others = threads.into_iter().map(|thread| match thread.join() {
                Ok(refused) => refused,
                Err(panic) => std::panic::resume_unwind(panic),
            });
            others.chain([first]).flatten().min_by_key(|refused| refused.0)
        })
    };
    outcome.map_or(Ok(()), |(_, error)| Err(error))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Kind;

    #[test]
    fn the_first_refusal_is_told() {
        let work =
            |k: usize, (): &mut ()| if k % 4 == 3 { Err(Error::new(Kind::InvalidValue, text!("{k}"))) } else { Ok(()) };
        for threads in 1..5 {
            let refused = share(40, &mut vec![(); threads], work).unwrap_err();
            assert_eq!(&*refused.message, "3");
        }
    }
}
