//! Work shared out among threads.
//!
//! What is computed does not depend on how many threads there are: work is cut into the same chunks for any number. The
//! library starts threads where its caller asks for them, and they end with the call.

use crate::error::{Error, Result};
use crate::memory::{self, Store};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

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

/// Values of nodes that follow each other: one thread's of all.
#[derive(Debug)]
pub struct Part<'a, T> {
    first: usize,
    values: &'a mut [T],
}

impl<T> Part<'_, T> {
    /// Whether it has a node's value.
    #[inline]
    pub fn has(&self, node: usize) -> bool {
        node.wrapping_sub(self.first) < self.values.len()
    }

    /// Whether it has that of one of these nodes.
    #[inline]
    pub fn has_any(&self, nodes: &[usize]) -> bool {
        nodes.iter().any(|&node| self.has(node))
    }

    /// That of a node, if it has it.
    #[inline]
    pub fn at(&mut self, node: usize) -> Option<&mut T> {
        self.values.get_mut(node.wrapping_sub(self.first))
    }
}

/// Fewer values than this are not worth a thread.
const FEW: usize = 2048;

/// Cuts two arrays into as many parts as there are threads and does `work` for each on one of them. What is added to a value is
/// added by one thread, in the order in which `work` meets it: sums have the same bits on any number of threads.
///
/// # Errors
/// Those of [`share`].
pub fn in_parts<A: Send, B: Send>(
    threads: usize,
    (a, b): (&mut [A], &mut [B]),
    work: impl Fn(Part<A>, Part<B>) + Sync,
) -> Result<()> {
    if threads < 2 || a.len().max(b.len()) < FEW {
        work(Part { first: 0, values: a }, Part { first: 0, values: b });
        return Ok(());
    }
    let sizes = [a.len(), b.len()].map(|n| n.div_ceil(threads).max(1));
    let (mut a, mut b) = (a.chunks_mut(sizes[0]), b.chunks_mut(sizes[1]));
    let mut parts = memory::with_room(threads)?;
    for k in 0..threads {
        let own = [k * sizes[0], k * sizes[1]];
        let a = Part { first: own[0], values: a.next().unwrap_or_default() };
        let b = Part { first: own[1], values: b.next().unwrap_or_default() };
        parts.store(Mutex::new(Some((a, b))))?;
    }
    share_numbers(threads, &|k| {
        if let Some((a, b)) = parts[k].lock().unwrap_or_else(PoisonError::into_inner).take() {
            work(a, b);
        }
    })
}

/// [`share`] without rooms, as many numbers as threads: compiled once, whatever is done.
#[inline(never)]
fn share_numbers(threads: usize, work: &(dyn Fn(usize) + Sync)) -> Result<()> {
    share(threads, &mut memory::filled((), threads)?, |k, ()| {
        work(k);
        Ok(())
    })
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
    #[test]
    fn every_value_is_in_one_part() {
        for (threads, n, m) in
            [(1, 5000, 7000), (2, 5000, 7001), (3, 7000, 1), (4, 0, 9000), (7, 2048, 2048), (2, 10, 10)]
        {
            let (mut a, mut b) = (vec![0.0; n], vec![0; m]);
            for pass in 0..2 {
                in_parts(threads, (&mut a, &mut b), |mut a, mut b| {
                    for node in 0..n.max(m) {
                        assert_eq!(a.has(node), a.at(node).is_some());
                        a.at(node).into_iter().for_each(|v| *v += node as f64);
                        b.at(node).into_iter().for_each(|v| *v += node);
                    }
                })
                .unwrap();
                assert!(a.iter().enumerate().all(|(k, v)| *v == ((pass + 1) * k) as f64), "{threads} {n}");
                assert!(b.iter().enumerate().all(|(k, v)| *v == (pass + 1) * k), "{threads} {m}");
            }
        }
    }
}
