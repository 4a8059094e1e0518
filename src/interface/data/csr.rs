//! A compressed sparse row matrix of the host's: where its entries are.

use crate::error::{Error, Kind, Result};
use std::ops::Range;

/// The places of a matrix. Offsets and columns are counted from `base`.
#[derive(Clone, Copy, Debug)]
pub struct Csr<'a> {
    base: i64,
    offsets: &'a [i64],
    columns: &'a [i64],
}

impl<'a> Csr<'a> {
    /// Checks `offsets` (rows + 1); the number of entries that they promise.
    pub fn entries(base: i64, offsets: &[i64]) -> Result<i64> {
        let n = offsets.len() - 1;
        let decreases = || (1..=n).find(|&k| offsets[k] < offsets[k - 1]);
        if let Some(k) = if offsets[0] == base { decreases() } else { Some(0) } {
            let text = text!("row_offsets[{k}] is {}; offsets start at {base} and do not decrease", offsets[k]);
            return Err(Error::new(Kind::InvalidSize, text));
        }
        Ok(offsets[n].saturating_sub(base))
    }

    /// With checked offsets and as many columns as these promise, in any order within a row.
    pub fn new(base: i64, offsets: &'a [i64], columns: &'a [i64]) -> Csr<'a> {
        Csr { base, offsets, columns }
    }

    /// Rows.
    pub fn rows(&self) -> usize {
        self.offsets.len() - 1
    }

    /// The places of an equation's row.
    pub fn row(&self, equation: i64) -> Result<Range<usize>> {
        let n = self.rows();
        let Some(r) = usize::try_from(equation).ok().filter(|&r| r < n) else {
            let text = text!("the interface has equation {}; the matrix has {n} rows", equation + self.base);
            return Err(Error::new(Kind::IndexOutOfRange, text));
        };
        Ok((self.offsets[r] - self.base) as usize..(self.offsets[r + 1] - self.base) as usize)
    }

    /// The column in a place, as an equation.
    pub fn column(&self, place: usize) -> i64 {
        self.columns[place] - self.base
    }

    /// The place of an entry in its row.
    pub fn place(&self, row: i64, column: i64) -> Result<usize> {
        let places = self.row(row)?;
        let (range, target) = (&self.columns[places.start..places.end], column + self.base);
        // Rows are usually sorted; where they are not, look at every entry.
        let found = range.binary_search(&target).ok().or_else(|| range.iter().position(|&c| c == target));
        found.map(|k| places.start + k).ok_or_else(|| {
            let text = text!("the matrix lacks the entry ({}, {target}); renew its pattern", row + self.base);
            Error::new(Kind::MissingEntry, text)
        })
    }
}
