//! Lists of numbers in one vector: what lies around each node, what each facet has.

use crate::error::Result;
use crate::memory;

/// Lists of numbers, one after the other.
#[derive(Debug, Default)]
pub struct Lists {
    /// Where each begins; one more at the end.
    pub first: Vec<usize>,
    /// The numbers.
    pub all: Vec<u32>,
}

impl Lists {
    /// The places of one of them.
    pub fn range(&self, k: usize) -> std::ops::Range<usize> {
        self.first[k]..self.first[k + 1]
    }

    /// One of them.
    pub fn get(&self, k: usize) -> &[u32] {
        &self.all[self.range(k)]
    }

    /// On the heap `[bytes]`.
    pub fn bytes(&self) -> usize {
        self.first.capacity() * size_of::<usize>() + self.all.capacity() * size_of::<u32>()
    }

    /// `n` lists of what `each` gives to a function of list and number; it is asked twice.
    pub fn of(n: usize, each: impl Fn(&mut dyn FnMut(usize, u32))) -> Result<Lists> {
        let mut first = memory::filled(0, n + 2)?;
        each(&mut |list, _| first[list + 2] += 1);
        for k in 2..n + 2 {
            first[k] += first[k - 1];
        }
        let mut all = memory::filled(0, first[n + 1])?;
        each(&mut |list, number| {
            all[first[list + 1]] = number;
            first[list + 1] += 1;
        });
        first.truncate(n + 1);
        Ok(Lists { first, all })
    }
}
