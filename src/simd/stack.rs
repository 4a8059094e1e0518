//! A list of fixed capacity that costs nothing to begin: zeros that are overwritten at once would be a fifth of a
//! kernel's stores.
#![allow(unsafe_code)]

use std::fmt::{Debug, Formatter};
use std::mem::MaybeUninit;

/// At most `CAPACITY` values.
pub struct Stack<T, const CAPACITY: usize> {
    values: [MaybeUninit<T>; CAPACITY],
    len: usize,
}

impl<T: Copy, const CAPACITY: usize> Stack<T, CAPACITY> {
    /// No values.
    #[inline(always)]
    pub fn new() -> Self {
        Stack { values: [const { MaybeUninit::uninit() }; CAPACITY], len: 0 }
    }

    /// Whether no value more goes in.
    #[inline(always)]
    pub fn is_full(&self) -> bool {
        self.len == CAPACITY
    }

    /// Appends a value; there must be room.
    #[inline(always)]
    pub fn push(&mut self, value: T) {
        self.values[self.len].write(value);
        self.len += 1;
    }

    /// Takes the last value off.
    #[inline(always)]
    pub fn pop(&mut self) -> Option<T> {
        self.len = self.len.checked_sub(1)?;
        // SAFETY: `push` wrote it.
        Some(unsafe { self.values[self.len].assume_init() })
    }

    /// Forgets all values.
    #[inline(always)]
    pub fn clear(&mut self) {
        self.len = 0;
    }

    /// The values.
    #[inline(always)]
    pub fn values(&self) -> &[T] {
        // SAFETY: the first `len` values were written by `push`.
        unsafe { std::slice::from_raw_parts(self.values.as_ptr().cast(), self.len) }
    }
}

impl<T: Copy, const CAPACITY: usize> Clone for Stack<T, CAPACITY> {
    #[inline(always)]
    fn clone(&self) -> Self {
        let mut copy = Stack::new();
        for &value in self.values() {
            copy.push(value);
        }
        copy
    }
}

impl<T: Copy + Debug, const CAPACITY: usize> Debug for Stack<T, CAPACITY> {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        f.debug_list().entries(self.values()).finish()
    }
}

impl<T: Copy, const CAPACITY: usize> Default for Stack<T, CAPACITY> {
    fn default() -> Self {
        Stack::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn holds_what_was_pushed() {
        let mut s = Stack::<f64, 3>::new();
        assert!(s.values().is_empty());
        for k in 0..3 {
            assert!(!s.is_full());
            s.push(f64::from(k));
        }
        assert!(s.is_full());
        assert_eq!(s.values(), [0.0, 1.0, 2.0]);
        assert_eq!(s.clone().values(), s.values());
        assert_eq!(format!("{s:?}"), "[0.0, 1.0, 2.0]");
        assert_eq!(s.pop(), Some(2.0));
        assert_eq!(s.values(), [0.0, 1.0]);
        s.clear();
        assert!(s.values().is_empty());
        assert_eq!(s.pop(), None);
    }

    #[test]
    #[should_panic(expected = "out of bounds")]
    fn has_no_room_for_more() {
        let mut s = Stack::<u8, 1>::new();
        s.push(1);
        s.push(2);
    }
}
