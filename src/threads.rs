//! Threads that write to rows of one array: whose each row is, and work shared out among them.
//!
//! What is computed does not depend on how many threads there are: work is cut into chunks, and chunks are put into phases,
//! of which no two chunks write to the same row. The library starts threads where its caller asks for them, and they end
//! with the call.
//!
//! This is the one place that hands out parts of an array to several writers. Each row has an owner, the chunk that claimed
//! it last. A chunk is given the numbers of a row only while it owns it, and nobody else can claim it before the phase ends.

#![allow(unsafe_code)]

use crate::error::{Error, Kind, Result};
use crate::memory::{self, Store};
use std::marker::PhantomData;
use std::ops::Range;
use std::sync::atomic::{AtomicU32, AtomicUsize, Ordering};

/// Where rows lie: in an array, or in a second one beside it. No two rows of an array overlap.
#[derive(Debug, Default)]
pub struct Parts {
    /// Start and length of each; of the second array where `beside`.
    rows: Vec<(usize, usize)>,
    beside: Vec<bool>,
    /// How long the arrays have to be.
    len: [usize; 2],
}

impl Parts {
    /// These rows (in the second array where `true`), which are looked at to be disjoint.
    ///
    /// # Errors
    /// [`Kind::InvalidSize`] where two overlap.
    pub fn new(rows: impl Iterator<Item = (Range<usize>, bool)>) -> Result<Parts> {
        let mut parts = Parts::default();
        for (row, beside) in rows {
            parts.rows.store((row.start, row.len()))?;
            parts.beside.store(beside)?;
        }
        let order = memory::order(parts.rows.len(), &|i, j| parts.rows[i].cmp(&parts.rows[j]))?;
        for k in order.into_iter().filter(|&k| parts.rows[k].1 > 0) {
            let ((start, len), end) = (parts.rows[k], &mut parts.len[usize::from(parts.beside[k])]);
            if start < *end {
                return Err(Error::new(Kind::InvalidSize, "two rows of a plan overlap"));
            }
            *end = start + len;
        }
        Ok(parts)
    }

    /// Where a row is.
    pub fn range(&self, row: usize) -> Range<usize> {
        let (start, len) = self.rows[row];
        start..start + len
    }

    /// On the heap `[bytes]`.
    pub fn bytes(&self) -> usize {
        self.rows.capacity() * size_of::<(usize, usize)>() + self.beside.capacity()
    }
}

/// Whose each row is, kept from one use to the next.
#[derive(Debug, Default)]
pub struct Owners {
    of: Vec<AtomicU32>,
    /// The first number of the chunks of the last use, and the next number.
    first: u32,
    next: u32,
}

impl Owners {
    /// Begins a use with so many rows, at most so many chunks.
    fn begin(&mut self, rows: usize, chunks: usize) -> Result<()> {
        let chunks = u32::try_from(chunks + 1).unwrap_or(u32::MAX);
        if self.of.len() != rows || self.next.checked_add(chunks).is_none() {
            self.of.clear();
            self.of.store_all((0..rows).map(|_| AtomicU32::new(0)))?;
            self.next = 1;
        }
        self.first = self.next;
        Ok(())
    }

    /// On the heap `[bytes]`.
    pub fn bytes(&self) -> usize {
        self.of.capacity() * size_of::<AtomicU32>()
    }
}

/// Two arrays whose rows chunks claim.
#[derive(Debug)]
pub struct Table<'a> {
    parts: &'a Parts,
    owners: &'a mut Owners,
    arrays: [*mut f64; 2],
    len: [usize; 2],
    of: PhantomData<&'a mut [f64]>,
}

// SAFETY: several threads share a table by `Hand`s alone, which give out numbers of rows that they own.
unsafe impl Sync for Table<'_> {}

impl<'a> Table<'a> {
    /// Of arrays that hold all rows.
    ///
    /// # Errors
    /// [`Kind::InvalidSize`]: an array is too short.
    pub fn new(parts: &'a Parts, owners: &'a mut Owners, arrays: [&'a mut [f64]; 2], chunks: usize) -> Result<Self> {
        if arrays.iter().zip(parts.len).any(|(array, len)| array.len() < len) {
            return Err(Error::new(Kind::InvalidSize, "the values of a plan are fewer than its entries"));
        }
        owners.begin(parts.rows.len(), chunks)?;
        let len = arrays.each_ref().map(|array| array.len());
        Ok(Table { parts, owners, arrays: arrays.map(<[f64]>::as_mut_ptr), len, of: PhantomData })
    }

    /// Whether a chunk has claimed a row so far.
    pub fn is_claimed(&mut self, row: usize) -> bool {
        *self.owners.of[row].get_mut() >= self.owners.first
    }

    /// All numbers, once the chunks are done: of the array, and beside it.
    pub fn arrays(&mut self) -> [&mut [f64]; 2] {
        let [first, second] = [0, 1].map(|k| (self.arrays[k], self.len[k]));
        // SAFETY: these many are there, and `&mut self`: there is no hand.
        unsafe {
            [std::slice::from_raw_parts_mut(first.0, first.1), std::slice::from_raw_parts_mut(second.0, second.1)]
        }
    }

    /// A phase: what the hands given out in it claim is theirs until it ends.
    pub fn phase(&mut self) -> Phase<'_, 'a> {
        let first = self.owners.next;
        Phase { table: self, first, next: AtomicU32::new(first) }
    }
}

/// A time in which each row has one owner.
#[derive(Debug)]
pub struct Phase<'p, 'a> {
    table: &'p mut Table<'a>,
    first: u32,
    next: AtomicU32,
}

impl Phase<'_, '_> {
    /// A hand for one chunk.
    pub fn hand(&self) -> Hand<'_> {
        let chunk = self.next.fetch_add(1, Ordering::Relaxed);
        Hand { parts: self.table.parts, owners: self.table.owners, arrays: self.table.arrays, first: self.first, chunk }
    }
}

impl Drop for Phase<'_, '_> {
    fn drop(&mut self) {
        self.table.owners.next = *self.next.get_mut();
    }
}

/// What a chunk claims rows with and writes to them.
#[derive(Debug)]
pub struct Hand<'a> {
    parts: &'a Parts,
    owners: &'a Owners,
    arrays: [*mut f64; 2],
    first: u32,
    chunk: u32,
}

impl Hand<'_> {
    /// Makes a row this chunk's; those that no chunk has claimed before become 0.
    ///
    /// # Panics
    /// If another chunk of this phase owns it: the phases are wrong.
    #[inline]
    pub fn claim(&mut self, row: usize) {
        let owner = &self.owners.of[row];
        let before = owner.load(Ordering::Relaxed);
        if before == self.chunk {
            return;
        }
        // Acquire and release: nobody relies on it within a phase, and phases end with their threads.
        let taken = owner.compare_exchange(before, self.chunk, Ordering::AcqRel, Ordering::Acquire);
        assert!(before < self.first && taken.is_ok(), "two chunks of one phase share a row");
        if before < self.owners.first {
            self.row(row).fill(0.0);
        }
    }

    /// The numbers of a row that this chunk has claimed.
    ///
    /// # Panics
    /// If it has not.
    #[inline(always)]
    pub fn row(&mut self, row: usize) -> &mut [f64] {
        assert!(self.owners.of[row].load(Ordering::Relaxed) == self.chunk, "a row that was not claimed");
        let ((start, len), beside) = (self.parts.rows[row], self.parts.beside[row]);
        // SAFETY: the array holds the row (`Table::new`), rows do not overlap (`Parts::new`), this chunk alone owns it until
        // the phase ends, which outlives this hand; within the chunk `&mut self` is the only way to it.
        unsafe { std::slice::from_raw_parts_mut(self.arrays[usize::from(beside)].add(start), len) }
    }
}

impl Hand<'_> {
    /// The numbers of the first `n` of some rows that this chunk has claimed, no two of them the same; of the others none.
    ///
    /// # Panics
    /// If it has not, or two are the same.
    #[inline(always)]
    pub fn rows<const K: usize>(&mut self, rows: [usize; K], n: usize) -> [&mut [f64]; K] {
        let mut all: [&mut [f64]; K] = std::array::from_fn(|_| Default::default());
        for k in 0..n {
            assert!(rows[..k].iter().all(|row| *row != rows[k]), "a row that was asked for twice");
            let row = self.row(rows[k]);
            // SAFETY: rows do not overlap, no two of these are the same, and `&mut self` is the only way to any of them.
            all[k] = unsafe { std::slice::from_raw_parts_mut(row.as_mut_ptr(), row.len()) };
        }
        all
    }
}

/// Does `work` for the numbers 0 to n - 1 on so many threads, this one among them; each has one of `rooms`, of which there are
/// as many. The first refusal, by these numbers, is the outcome.
///
/// # Errors
/// Those of `work`; [`Kind::OutOfMemory`] where no thread can be started is none: fewer do the work.
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

    fn parts() -> Parts {
        Parts::new([(0..2, false), (4..6, false), (2..4, false), (0..2, true), (9..9, false)].into_iter()).unwrap()
    }

    #[test]
    fn rows_that_overlap_are_refused() {
        for rows in [[(0..2, false), (1..3, false)], [(4..6, true), (4..6, true)]] {
            assert_eq!(Parts::new(rows.into_iter()).unwrap_err().kind, Kind::InvalidSize);
        }
        assert_eq!(parts().len, [6, 2]);
    }

    #[test]
    fn chunks_add_to_rows_that_begin_with_zero() {
        let (parts, mut owners) = (parts(), Owners::default());
        let (mut values, mut beside) = ([7.0; 6], [7.0; 2]);
        for use_ in 0..3 {
            let mut table = Table::new(&parts, &mut owners, [&mut values, &mut beside], 9).unwrap();
            for _ in 0..2 {
                let phase = table.phase();
                share(3, &mut [(), ()], |k, ()| {
                    let mut hand = phase.hand();
                    hand.claim(k);
                    hand.row(k).iter_mut().for_each(|v| *v += 1.0 + k as f64);
                    Ok(())
                })
                .unwrap();
            }
            assert!((0..5).map(|row| table.is_claimed(row)).eq([true, true, true, false, false]), "{use_}");
        }
        assert_eq!(values, [2.0, 2.0, 6.0, 6.0, 4.0, 4.0]);
        assert_eq!(beside, [7.0; 2]);
    }

    #[test]
    #[should_panic = "two chunks of one phase share a row"]
    fn a_row_has_one_owner_a_phase() {
        let (parts, mut owners, mut values, mut beside) = (parts(), Owners::default(), [0.0; 6], [0.0; 2]);
        let mut table = Table::new(&parts, &mut owners, [&mut values, &mut beside], 9).unwrap();
        let phase = table.phase();
        phase.hand().claim(1);
        phase.hand().claim(1);
    }

    #[test]
    #[should_panic = "a row that was not claimed"]
    fn a_row_is_given_to_its_owner_alone() {
        let (parts, mut owners, mut values, mut beside) = (parts(), Owners::default(), [0.0; 6], [0.0; 2]);
        let mut table = Table::new(&parts, &mut owners, [&mut values, &mut beside], 9).unwrap();
        let phase = table.phase();
        phase.hand().row(1);
    }

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
