//! Raw pointers to checked references and back.
//!
//! The caller's contract, for every function of the ABI: a non-null pointer points to as many readable
//! (const) or writable values as the documentation says, and stays valid during the call. Null,
//! misalignment and impossible lengths are found here and refused.

use crate::error::{Error, Kind, Result, Text};
use crate::geometry::Vec3;
use crate::memory::{self, Store, Stored};
use crate::simd;
use libc::c_char;
use nalgebra::{SMatrix, SVector};
use std::fmt::{self, Display};
use std::mem::MaybeUninit;

/// Longest array accepted: far above any mesh, far below what a pointer can address.
const LONGEST: usize = 1 << 40;

pub(super) fn refuse<T>(kind: Kind, text: Text) -> Result<T> {
    Err(Error::new(kind, text))
}

/// A member of an argument, for messages; put together where one is written.
#[derive(Clone, Copy)]
pub(super) struct Member<'a>(pub &'a str, pub &'a str);

impl Display for Member<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}", self.0, self.1)
    }
}

/// Puts an argument's name before a refusal of the core.
pub(super) fn named(name: &str) -> impl FnOnce(Error) -> Error + '_ {
    move |e| named_one(name, &e)
}

/// The same of a refusal that stays where it is, in place of something large.
#[cold]
pub(super) fn named_one(name: &str, e: &Error) -> Error {
    Error::new(e.kind, text!("{name}: {}", e.message))
}

/// Refuses null and misaligned pointers.
pub(super) fn check<T>(p: *const T, name: impl Display) -> Result<()> {
    if p.is_null() {
        return refuse(Kind::NullPointer, text!("{name} is NULL"));
    }
    if !p.is_aligned() {
        return refuse(Kind::NullPointer, text!("{name} is not aligned to {} bytes", align_of::<T>()));
    }
    Ok(())
}

/// A count received as a signed integer.
pub(super) fn count(n: i64, least: i64, name: impl Display) -> Result<usize> {
    match usize::try_from(n) {
        Ok(k) if n >= least && k <= LONGEST => Ok(k),
        _ => refuse(Kind::InvalidSize, text!("{name} is {n}; it must be at least {least} and at most {LONGEST}")),
    }
}

/// `n` values at `p`.
pub(super) fn slice<'a, T>(p: *const T, n: usize, name: impl Display) -> Result<&'a [T]> {
    check(p, &name)?;
    if n > LONGEST {
        return refuse(Kind::InvalidSize, text!("{name} would have {n} entries"));
    }
    // SAFETY: non-null, aligned, not overlong; readable for n values by the caller's contract.
    Ok(unsafe { std::slice::from_raw_parts(p, n) })
}

/// `n` finite numbers at `p`.
pub(super) fn numbers<'a>(p: *const f64, n: usize, name: impl Display) -> Result<&'a [f64]> {
    let values = slice(p, n, &name)?;
    if simd::are_finite(values) { Ok(values) } else { not_finite(values, &name) }
}

#[cold]
fn not_finite<'a>(values: &'a [f64], name: &dyn Display) -> Result<&'a [f64]> {
    match values.iter().position(|v| !v.is_finite()) {
        None => Ok(values),
        Some(k) => refuse(Kind::NotFinite, text!("{name}[{k}] is {}; it must be finite", values[k])),
    }
}

/// Refuses results that left the range of doubles: an infinity that went out with a success would end in
/// the host's linear solver, far from its cause.
pub(super) fn check_results<'a>(name: &str, values: impl IntoIterator<Item = &'a f64>) -> Result<()> {
    // Looks at all of them, several at once, rather than stop at the first one.
    match values.into_iter().fold(true, |fine, v| fine & v.is_finite()) {
        true => Ok(()),
        false => overflow(name),
    }
}

/// The same of a matrix' blocks.
pub(super) fn check_blocks<const D: usize>(name: &str, blocks: &[SMatrix<f64, D, D>]) -> Result<()> {
    // 0 times what is not finite is no number, and stays so.
    let mut sums = SMatrix::<f64, D, D>::zeros();
    blocks.iter().for_each(|block| sums += block * 0.0);
    if sums.iter().all(|sum| *sum == 0.0) { Ok(()) } else { overflow(name) }
}

/// The same of results that lie one after the other.
#[inline]
pub(super) fn check_array(name: &str, values: &[f64]) -> Result<()> {
    if simd::are_finite(values) { Ok(()) } else { overflow(name) }
}

#[cold]
pub(super) fn overflow<T>(name: &str) -> Result<T> {
    refuse(Kind::NotFinite, text!("{name} overflows: the inputs are out of range"))
}

/// Like [`numbers`], or nothing where `p` is null.
pub(super) fn optional_numbers<'a>(p: *const f64, n: usize, name: &str) -> Result<Option<&'a [f64]>> {
    if p.is_null() { Ok(None) } else { numbers(p, n, name).map(Some) }
}

/// Room for `n` numbers at `p`, which are written before they are read.
pub(super) fn values<'a>(p: *mut f64, n: usize, name: &str) -> Result<&'a mut [f64]> {
    check(p, name)?;
    // SAFETY: non-null, aligned; writable for n values by the caller's contract, and apart from all other arrays.
    Ok(unsafe { std::slice::from_raw_parts_mut(p, n) })
}

/// Numbers as points.
pub(super) fn vectors(values: &[f64]) -> Result<Vec<Vec3>> {
    values.chunks_exact(3).map(Vec3::from_column_slice).stored()
}

/// The same in their place.
pub(super) fn as_vectors<const N: usize>(values: &[f64]) -> &[SVector<f64, N>] {
    const { assert!(size_of::<SVector<f64, N>>() == N * size_of::<f64>()) }
    const { assert!(align_of::<SVector<f64, N>>() == align_of::<f64>()) }
    // SAFETY: a vector is its components, one after the other, of as many bytes and the same alignment; any numbers are one.
    unsafe { std::slice::from_raw_parts(values.as_ptr().cast(), values.len() / N) }
}

/// Copies `values` to `p`; nothing where `p` is null.
pub(super) fn write<T: Copy>(p: *mut T, values: &[T]) {
    if !p.is_null() {
        // SAFETY: writable for this many values by the caller's contract; `values` is the library's own.
        unsafe { std::ptr::copy_nonoverlapping(values.as_ptr(), p, values.len()) }
    }
}

/// Fills a caller's array from its beginning; appends nothing where the pointer is null.
pub(super) struct Output<T> {
    p: *mut T,
    at: usize,
}

impl<T: Copy> Output<T> {
    /// The array at `p`, as long as the documentation says.
    pub fn new(p: *mut T) -> Output<T> {
        Output { p, at: 0 }
    }

    /// Appends `values`.
    #[inline]
    pub fn append(&mut self, values: &[T]) {
        if !self.p.is_null() {
            // SAFETY: the caller's array holds all that the function appends, by its documentation.
            unsafe { std::ptr::copy_nonoverlapping(values.as_ptr(), self.p.add(self.at), values.len()) }
            self.at += values.len();
        }
    }
}

/// Whether a caller only counts: all of its arrays are NULL, of 64 bits each. One alone must not be.
pub(super) fn only_counts(arrays: &[(*const i64, &str)]) -> Result<bool> {
    let counts = arrays.iter().all(|array| array.0.is_null());
    if !counts {
        arrays.iter().try_for_each(|(array, name)| check(*array, name))?;
    }
    Ok(counts)
}

/// Refuses a caller's array that is too short for `n` values.
pub(super) fn room(capacity: i64, n: usize, name: &str) -> Result<()> {
    if capacity < n as i64 {
        return refuse(Kind::BufferTooSmall, text!("capacity is {capacity}; {name} need {n}"));
    }
    Ok(())
}

/// Writes a text with its final zero, cut to `capacity` characters, that zero included.
pub(super) fn write_text(p: *mut c_char, capacity: usize, text: &str) {
    write_each(p, text.bytes().take(capacity - 1).chain([0]).map(|b| b as c_char));
}

/// Copies equations, counted from `base`, to `p`; nothing where `p` is null.
pub(super) fn write_equations(p: *mut i64, equations: &[i64], base: i64) {
    if !p.is_null() {
        // SAFETY: writable for as many by the caller's contract, apart from the library's own `equations`.
        let to = unsafe { std::slice::from_raw_parts_mut(p.cast::<MaybeUninit<i64>>(), equations.len()) };
        for (to, equation) in to.iter_mut().zip(equations) {
            to.write(equation + base);
        }
    }
}

/// Copies values one by one to `p`; nothing where `p` is null.
pub(super) fn write_each<T>(p: *mut T, values: impl Iterator<Item = T>) {
    if !p.is_null() {
        // `for_each`: of vectors in vectors it is two loops, not a question at each value which one comes next.
        values.enumerate().for_each(|(k, value)| {
            // SAFETY: writable for as many values as the documentation says; the iterator gives those.
            unsafe { p.add(k).write(value) }
        });
    }
}

/// A value on the heap, to be given to the caller; `Box::from_raw` ends it.
pub(super) fn owned<T>(value: T) -> Result<*mut T> {
    let mut one = memory::with_room(1)?;
    one.store(value)?;
    let one: Box<[T; 1]> = one.into_boxed_slice().try_into().unwrap_or_else(|_| unreachable!("it holds one value"));
    Ok(Box::into_raw(one).cast())
}

/// Checks that an output pointer may be null but not misaligned.
pub(super) fn check_optional<T>(p: *const T, name: &str) -> Result<()> {
    if p.is_null() { Ok(()) } else { check(p, name) }
}
