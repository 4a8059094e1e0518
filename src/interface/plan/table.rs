//! The numbers that a plan's entries get: whose rows they are while they are written, and which have been written.
//!
//! Rows are set to 0 when the first block of them comes: the array of entries is larger than any cache, and would otherwise pass
//! through it once more. Rows that no block came for are set to 0 at the end.
//!
//! Chunks that are filled at the same time (`phases.rs`) each get the pieces of the arrays that hold their rows.

use super::places::{NOWHERE, NodeRows, Places};
use crate::error::Result;
use crate::memory::{self, Store};
use std::ops::Range;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// What tables work with, kept from one fill to the next.
#[derive(Debug, Default)]
pub struct TableRoom {
    /// Per node, the last fill that wrote to its rows. A node's rows have one writer at a time: no order is needed.
    written: Vec<AtomicU32>,
    /// The fill at hand.
    fill: u32,
    /// The rows beside the entries.
    beside: Vec<f64>,
    /// Per node, where chunks at the same time have its rows.
    parts: Vec<Part>,
}

/// Where a chunk has the rows of a node.
#[derive(Clone, Copy, Debug)]
struct Part {
    chunk: u32,
    piece: u32,
    /// What the array has before the piece.
    before: usize,
}

/// Of rows that no chunk of a phase has.
const NOBODYS: Part = Part { chunk: u32::MAX, piece: 0, before: 0 };

impl TableRoom {
    /// The table of these places with their values, for a fill.
    pub fn table<'a>(&'a mut self, places: &'a Places, values: &'a mut [f64]) -> Result<Table<'a>> {
        if self.beside.len() != places.beside.len() {
            memory::refill(&mut self.beside, 0.0, places.beside.len())?;
        }
        if self.written.len() != places.rows.len() || self.fill == u32::MAX {
            self.written.clear();
            self.written.store_all((0..places.rows.len()).map(|_| AtomicU32::new(0)))?;
            self.fill = 0;
        }
        self.fill += 1;
        let of = Writing { rows: &places.rows, written: &self.written, fill: self.fill };
        Ok(Table { places, of, arrays: [values, &mut self.beside], parts: &mut self.parts })
    }

    /// On the heap `[bytes]`.
    pub fn bytes(&self) -> usize {
        let nodes = self.written.capacity() * size_of::<AtomicU32>() + self.parts.capacity() * size_of::<Part>();
        nodes + self.beside.capacity() * size_of::<f64>()
    }
}

/// What is written in a fill.
#[derive(Clone, Copy, Debug)]
struct Writing<'a> {
    rows: &'a [NodeRows],
    written: &'a [AtomicU32],
    fill: u32,
}

/// The entries' values, and the rows beside them.
#[derive(Debug)]
pub struct Table<'a> {
    places: &'a Places,
    of: Writing<'a>,
    arrays: [&'a mut [f64]; 2],
    parts: &'a mut Vec<Part>,
}

impl<'a> Table<'a> {
    /// Of one chunk at a time: all rows are its own.
    pub fn hand(&mut self) -> Hand<'_, 'a> {
        Hand { of: self.of, pieces: &mut self.arrays, parts: None }
    }

    /// Of several chunks at the same time. `own` gives the nodes whose rows each of them has, no two the same; `order`: nodes
    /// by their places among the entries.
    pub fn parted(
        &mut self,
        chunks: &[Range<usize>],
        own: impl Fn(&Range<usize>, &mut dyn FnMut(usize)),
        order: &[u32],
    ) -> Result<Parted<'_>> {
        let (of, parts) = (self.of, &mut *self.parts);
        memory::refill(parts, NOBODYS, of.rows.len())?;
        for (chunk, facets) in (0..).zip(chunks) {
            own(facets, &mut |node| parts[node].chunk = chunk);
        }
        let mut pieces = memory::with_room(chunks.len())?;
        chunks.iter().try_for_each(|_| pieces.store(Vec::new()))?;
        let [entries, beside] = &mut self.arrays;
        cut(
            entries,
            of.rows,
            order.iter().map(|node| *node as usize).filter(|n| of.rows[*n].is_direct),
            parts,
            &mut pieces,
        )?;
        cut(beside, of.rows, (0..of.rows.len()).filter(|n| !of.rows[*n].is_direct), parts, &mut pieces)?;
        let mut locked = memory::with_room(pieces.len())?;
        pieces.into_iter().try_for_each(|pieces| locked.store(Mutex::new(pieces)))?;
        Ok(Parted { of, pieces: locked, parts })
    }

    /// Ends a fill, all of whose chunks are done: what no block came for becomes 0, and what stands beside the entries is added
    /// to them.
    pub fn finish(self) {
        let (of, [values, beside]) = (self.of, self.arrays);
        for &(first, end) in &self.places.indirect {
            values[first..end].fill(0.0);
        }
        for (rows, written) in of.rows.iter().zip(of.written) {
            let range = rows.range();
            match (rows.is_direct, written.load(Ordering::Relaxed) == of.fill) {
                (true, false) => values[range].fill(0.0),
                (false, true) => {
                    let places = self.places.beside[rows.range()].iter();
                    for (&to, &value) in places.zip(&beside[range]).filter(|(to, _)| **to != NOWHERE) {
                        values[to] += value;
                    }
                }
                _ => {}
            }
        }
    }
}

/// What is left of an array that is cut up from its beginning.
struct Rest<'a> {
    numbers: &'a mut [f64],
    /// How many came before.
    before: usize,
}

impl<'a> Rest<'a> {
    /// Cuts out what stands here in the array.
    fn cut(&mut self, range: Range<usize>) -> &'a mut [f64] {
        let (_, tail) = std::mem::take(&mut self.numbers).split_at_mut(range.start - self.before);
        let (piece, rest) = tail.split_at_mut(range.len());
        (self.numbers, self.before) = (rest, range.end);
        piece
    }
}

/// Cuts the rows of `nodes`, which stand in this order in `array`, out of it, for the chunk that has each: one piece for rows
/// that follow each other.
fn cut<'a>(
    array: &'a mut [f64],
    rows: &[NodeRows],
    nodes: impl Iterator<Item = usize>,
    parts: &mut [Part],
    pieces: &mut [Vec<&'a mut [f64]>],
) -> Result<()> {
    let mut rest = Rest { numbers: array, before: 0 };
    // The piece at hand: whose it is, and where.
    let (mut chunk, mut piece) = (NOBODYS.chunk, 0..0);
    for node in nodes {
        let (part, range) = (&mut parts[node], rows[node].range());
        if part.chunk == NOBODYS.chunk || range.is_empty() {
            continue;
        }
        if (part.chunk, range.start) != (chunk, piece.end) {
            if !piece.is_empty() {
                pieces[chunk as usize].store(rest.cut(piece))?;
            }
            (chunk, piece) = (part.chunk, range.start..range.start);
        }
        piece.end = range.end;
        (part.piece, part.before) = (pieces[chunk as usize].len() as u32, piece.start);
    }
    if piece.is_empty() { Ok(()) } else { pieces[chunk as usize].store(rest.cut(piece)) }
}

/// The pieces of the chunks of a phase.
#[derive(Debug)]
pub struct Parted<'a> {
    of: Writing<'a>,
    pieces: Vec<Mutex<Vec<&'a mut [f64]>>>,
    parts: &'a [Part],
}

impl<'a> Parted<'a> {
    /// Those of the k-th chunk, for [`Parted::hand`].
    pub fn pieces(&self, k: usize) -> MutexGuard<'_, Vec<&'a mut [f64]>> {
        self.pieces[k].lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// What the k-th chunk writes to its pieces with.
    pub fn hand<'h>(&self, k: usize, pieces: &'h mut [&'a mut [f64]]) -> Hand<'h, 'a> {
        Hand { of: self.of, pieces, parts: Some((self.parts, k as u32)) }
    }
}

/// What a chunk writes to its rows with.
#[derive(Debug)]
pub struct Hand<'h, 'a> {
    of: Writing<'a>,
    /// The arrays that the rows are in.
    pub pieces: &'h mut [&'a mut [f64]],
    /// Where this chunk's are, and its number; if none, all are, in the table's arrays.
    parts: Option<(&'a [Part], u32)>,
}

/// Where the rows of a node are.
#[derive(Clone, Copy, Debug, Default)]
pub struct Target {
    pub rows: NodeRows,
    /// In which piece, and where they begin there.
    pub piece: usize,
    pub start: usize,
}

impl Hand<'_, '_> {
    /// Where the rows of a node are. `None`: they are not this chunk's.
    #[inline(always)]
    pub fn find(&self, node: usize) -> Option<Target> {
        let rows = self.of.rows[node];
        let (piece, start) = match self.parts {
            None => (usize::from(!rows.is_direct), rows.start),
            Some((parts, chunk)) if parts[node].chunk == chunk => {
                (parts[node].piece as usize, rows.start - parts[node].before)
            }
            Some(_) => return None,
        };
        Some(Target { rows, piece, start })
    }

    /// The same; they become 0 if nothing was written to them in this fill.
    #[inline]
    pub fn claim(&mut self, node: usize) -> Option<Target> {
        let target = self.find(node)?;
        let Target { rows, piece, start } = target;
        let written = &self.of.written[node];
        if written.load(Ordering::Relaxed) != self.of.fill {
            written.store(self.of.fill, Ordering::Relaxed);
            if rows.len > 0 {
                self.pieces[piece][start..start + rows.size()].fill(0.0);
            }
        }
        Some(target)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Five nodes of one row each: the third is beside, the fifth has nothing.
    fn places() -> Places {
        let row = |start, len, is_direct| NodeRows { start, len, scalars: 1, is_direct, ..NodeRows::default() };
        let rows = vec![row(0, 2, true), row(4, 2, true), row(0, 3, false), row(2, 2, true), row(0, 0, false)];
        Places { rows, beside: vec![6, NOWHERE, 7], indirect: vec![(6, 8)], ..Places::default() }
    }

    fn add(hand: &mut Hand, node: usize, value: f64) {
        let at = hand.claim(node).unwrap();
        hand.pieces[at.piece][at.start..at.start + at.rows.size()].iter_mut().for_each(|v| *v += value);
    }

    #[test]
    fn rows_begin_with_zero_in_every_fill() {
        let (places, mut room, mut values) = (places(), TableRoom::default(), [7.0; 8]);
        for _ in 0..3 {
            let mut table = room.table(&places, &mut values).unwrap();
            for node in [0, 2, 0, 4] {
                add(&mut table.hand(), node, 1.0 + node as f64);
            }
            table.finish();
            assert_eq!(values, [2.0, 2.0, 0.0, 0.0, 0.0, 0.0, 3.0, 3.0]);
        }
    }

    #[test]
    fn chunks_have_their_own_rows_and_no_others() {
        let (places, mut room, mut values) = (places(), TableRoom::default(), [7.0; 8]);
        let own = |chunk: &Range<usize>, give: &mut dyn FnMut(usize)| chunk.clone().for_each(give);
        for _ in 0..2 {
            let mut table = room.table(&places, &mut values).unwrap();
            // Nodes 0 and 2 for one, 1 and 4 for the other; later 3 alone.
            let own_of = |chunk: &Range<usize>, give: &mut dyn FnMut(usize)| {
                own(chunk, &mut |k| give([0, 2, 1, 4][k]));
            };
            let parted = table.parted(&[0..2, 2..4], own_of, &[0, 3, 1]).unwrap();
            for (k, nodes) in [[0, 2], [1, 4]].into_iter().enumerate() {
                let mut pieces = parted.pieces(k);
                for node in nodes {
                    add(&mut parted.hand(k, &mut pieces), node, 1.0 + node as f64);
                }
                let others = [3, if k == 0 { 1 } else { 0 }];
                assert!(others.iter().all(|node| parted.hand(k, &mut pieces).claim(*node).is_none()));
            }
            drop(parted);
            add(&mut table.hand(), 3, 9.0);
            table.finish();
            assert_eq!(values, [1.0, 1.0, 9.0, 9.0, 2.0, 2.0, 3.0, 3.0]);
        }
    }

    #[test]
    fn rows_that_follow_each_other_are_one_piece() {
        let (places, mut room, mut values) = (places(), TableRoom::default(), [7.0; 8]);
        let mut table = room.table(&places, &mut values).unwrap();
        let own = |chunk: &Range<usize>, give: &mut dyn FnMut(usize)| chunk.clone().for_each(give);
        let parted = table.parted(&[0..2, 3..4], own, &[0, 3, 1]).unwrap();
        assert_eq!([0, 1].map(|k| parted.pieces(k).len()), [2, 1]);
        let parted = table.parted(&[0..4, 4..5], own, &[0, 3, 1]).unwrap();
        assert_eq!(parted.pieces(0).iter().map(|piece| piece.len()).collect::<Vec<_>>(), [6, 3]);
    }
}
