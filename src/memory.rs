//! Memory that may run out: vectors are asked for, and where the system has none left the caller hears of it.
//!
//! A library that aborts its host because a vector did not fit loses the host's work. So nothing in the core grows by
//! `vec!`, `collect`, `push` or the like, which abort, but by what is here (`tests/memory/sources.rs` looks through the
//! sources). A function computes into new vectors and puts them in place at its end, so that a call that finds no memory
//! changes nothing.

use crate::error::{Error, Kind, Result};
use std::cmp::Ordering;
use std::collections::TryReserveError;

impl From<TryReserveError> for Error {
    fn from(_: TryReserveError) -> Error {
        Error::new(Kind::OutOfMemory, "memory has run out; nothing was changed. Free some, or take a smaller model")
    }
}

/// An empty vector with room for `n` values.
pub fn with_room<T>(n: usize) -> Result<Vec<T>> {
    let mut v = Vec::new();
    v.try_reserve_exact(n)?;
    Ok(v)
}

/// `n` times the same value.
pub fn filled<T: Copy>(value: T, n: usize) -> Result<Vec<T>> {
    let mut v = with_room(n)?;
    v.resize(n, value);
    Ok(v)
}

/// `n` times the same value, in place of what was there.
pub fn refill<T: Copy>(v: &mut Vec<T>, value: T, n: usize) -> Result<()> {
    v.clear();
    v.try_reserve(n)?;
    v.resize(n, value);
    Ok(())
}

/// A copy of some values, in place of what was there.
pub fn recopy<T: Copy>(v: &mut Vec<T>, values: &[T]) -> Result<()> {
    v.clear();
    v.try_reserve_exact(values.len())?;
    v.extend_from_slice(values);
    Ok(())
}

/// What a vector that grows piece by piece takes more than it needs, over its length: little, for such vectors are kept, and
/// enough that the next surface of about as many pieces finds room.
const SPARE: usize = 16;

/// Room for `more` values in a vector that is kept. Where there is none it takes a small part of its length beyond them: twice
/// as much, as vectors take of themselves, would stay.
#[inline]
pub fn grow<T>(v: &mut Vec<T>, more: usize) -> Result<()> {
    grow_to(v, more, 0)
}

/// The same of a vector that will probably have this length in the end: it takes up to twice as much on the way there, so that
/// what it holds is not copied again and again.
#[inline]
pub fn grow_to<T>(v: &mut Vec<T>, more: usize, length: usize) -> Result<()> {
    if v.capacity() - v.len() < more {
        let to_length = length.saturating_sub(v.len()).min(v.len());
        v.try_reserve_exact(more.max(v.len() / SPARE).max(to_length))?;
    }
    Ok(())
}

/// `n` times the default value.
pub fn defaults<T: Default>(n: usize) -> Result<Vec<T>> {
    (0..n).map(|_| T::default()).stored()
}

/// A copy of some values.
pub fn copied<T: Copy>(values: &[T]) -> Result<Vec<T>> {
    let mut v = with_room(values.len())?;
    v.extend_from_slice(values);
    Ok(v)
}

/// Appends some values.
pub fn extend<T: Copy>(v: &mut Vec<T>, values: &[T]) -> Result<()> {
    v.try_reserve(values.len())?;
    v.extend_from_slice(values);
    Ok(())
}

/// Gives back the room that values do not need. (`shrink_to_fit` ends the program where there is no memory for the move.)
pub fn fit<T: Copy>(v: &mut Vec<T>) -> Result<()> {
    if v.len() < v.capacity() {
        *v = copied(v)?;
    }
    Ok(())
}

/// The values in an order in which those that compare equal stay as they were. (The standard library's stable sort
/// takes its memory or aborts.)
pub fn sorted<T: Copy>(values: &[T], compare: impl Fn(&T, &T) -> Ordering) -> Result<Vec<T>> {
    let order = order(values.len(), &|i, j| compare(&values[i], &values[j]))?;
    order.iter().map(|&i| values[i]).stored()
}

/// Sorts values. (The standard library's own would be compiled for each type, 20 kB each: it is for where time counts.)
pub fn sort<T: Copy + Ord>(values: &mut Vec<T>) -> Result<()> {
    *values = sorted(values, T::cmp)?;
    Ok(())
}

/// The order of so many values; those that compare equal stay as they were.
pub fn order(n: usize, compare: &dyn Fn(usize, usize) -> Ordering) -> Result<Vec<usize>> {
    let mut order = (0..n).stored()?;
    order.sort_unstable_by(|&i, &j| compare(i, j).then(i.cmp(&j)));
    Ok(order)
}

/// What a refusal may stand in place of: `None` for it, but that there is no memory stays a refusal.
pub fn if_accepted<T>(outcome: Result<T>) -> Result<Option<T>> {
    match outcome {
        Err(error) if error.kind != Kind::OutOfMemory => Ok(None),
        outcome => outcome.map(Some),
    }
}

/// What iterators end in.
pub trait Stored: Iterator + Sized {
    /// Its values in a vector.
    #[inline]
    fn stored(self) -> Result<Vec<Self::Item>> {
        let mut v = Vec::new();
        v.store_all(self)?;
        Ok(v)
    }

    /// Its values in a vector, or the first refusal among them.
    #[inline]
    fn stored_if_ok<T>(self) -> Result<Vec<T>>
    where
        Self: Iterator<Item = Result<T>>,
    {
        let mut v = with_room(self.size_hint().0)?;
        for value in self {
            v.store(value?)?;
        }
        Ok(v)
    }
}

impl<I: Iterator> Stored for I {}

/// How vectors grow.
pub trait Store<T> {
    /// Appends a value.
    fn store(&mut self, value: T) -> Result<()>;
    /// Appends values.
    fn store_all(&mut self, values: impl Iterator<Item = T>) -> Result<()>;
}

/// As [`Store::store`], within the loop that calls it: for what comes entry by entry of a matrix.
#[inline(always)]
pub fn store_entry<T>(values: &mut Vec<T>, value: T) -> Result<()> {
    if values.len() == values.capacity() {
        values.try_reserve(1)?;
    }
    values.push(value);
    Ok(())
}

impl<T> Store<T> for Vec<T> {
    #[inline(never)]
    fn store(&mut self, value: T) -> Result<()> {
        store_entry(self, value)
    }

    #[inline]
    fn store_all(&mut self, values: impl Iterator<Item = T>) -> Result<()> {
        let (least, most) = values.size_hint();
        // Twice as much as before where it goes on growing.
        if self.is_empty() { self.try_reserve_exact(least) } else { self.try_reserve(least) }?;
        if most == Some(least) {
            self.extend(values); // as many as there is room for
            return Ok(());
        }
        for value in values {
            self.store(value)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// More than any memory holds.
    const FAR_TOO_MANY: usize = usize::MAX / 2;

    #[test]
    fn vectors_hold_what_they_were_given() {
        assert_eq!(filled(7, 3), Ok(vec![7; 3]));
        assert_eq!(copied(&[1, 2]), Ok(vec![1, 2]));
        assert_eq!((0..5).stored(), Ok(vec![0, 1, 2, 3, 4]));
        assert_eq!((0..100).filter(|k| k % 40 == 0).stored(), Ok(vec![0, 40, 80]));
        let mut v = vec![1];
        v.store(2).unwrap();
        v.store_all([3, 4].into_iter()).unwrap();
        assert_eq!(v, [1, 2, 3, 4]);
        v.reserve(10);
        fit(&mut v).unwrap();
        assert_eq!((&v[..], v.capacity()), (&[1, 2, 3, 4][..], 4));
        let refused = || Error::new(Kind::InvalidValue, "odd");
        let even = |k: i32| if k % 2 == 0 { Ok(k) } else { Err(refused()) };
        assert_eq!([0, 2].into_iter().map(even).stored_if_ok(), Ok(vec![0, 2]));
        assert_eq!([0, 1].into_iter().map(even).stored_if_ok(), Err(refused()));
    }

    #[test]
    fn equal_values_stay_in_their_order() {
        let values = [(1, 'a'), (0, 'b'), (1, 'c'), (0, 'd')];
        let expected = vec![(0, 'b'), (0, 'd'), (1, 'a'), (1, 'c')];
        assert_eq!(sorted(&values, |p, q| p.0.cmp(&q.0)), Ok(expected));
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        assert_eq!(filled(0.0, FAR_TOO_MANY).unwrap_err().kind, Kind::OutOfMemory);
        assert_eq!((0..FAR_TOO_MANY).map(|k| k as u64).stored().unwrap_err().kind, Kind::OutOfMemory);
    }
}
