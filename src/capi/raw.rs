//! Raw pointers to checked references and back.
//!
//! The caller's contract, for every function of the ABI: a non-null pointer points to as many readable
//! (const) or writable values as the documentation says, and stays valid during the call. Null,
//! misalignment and impossible lengths are found here and refused.

use crate::error::{Error, Kind, Result};
use crate::geometry::Vec3;
use std::mem::MaybeUninit;

/// Longest array accepted: far above any mesh, far below what a pointer can address.
const LONGEST: usize = 1 << 40;
/// Longest struct accepted from a newer caller.
pub(super) const LONGEST_STRUCT: usize = 4096;

/// A struct of the ABI: `repr(C)`, first member `struct_size: u64`, valid for every bit pattern.
///
/// # Safety
/// The implementor must be just that.
pub(super) unsafe trait Sized64: Copy {
    /// Its name in messages.
    const NAME: &'static str;
}

fn refuse<T>(kind: Kind, text: String) -> Result<T> {
    Err(Error::new(kind, text))
}

/// Puts an argument's name before a refusal of the core.
pub(super) fn named(name: &str) -> impl FnOnce(Error) -> Error + '_ {
    move |e| Error::new(e.kind, format!("{name}: {}", e.message))
}

/// Refuses null and misaligned pointers.
pub(super) fn check<T>(p: *const T, name: &str) -> Result<()> {
    if p.is_null() {
        return refuse(Kind::NullPointer, format!("{name} is NULL"));
    }
    if !p.is_aligned() {
        return refuse(Kind::NullPointer, format!("{name} is not aligned to {} bytes", align_of::<T>()));
    }
    Ok(())
}

/// A count received as a signed integer.
pub(super) fn count(n: i64, least: i64, name: &str) -> Result<usize> {
    match usize::try_from(n) {
        Ok(k) if n >= least && k <= LONGEST => Ok(k),
        _ => refuse(Kind::InvalidSize, format!("{name} is {n}; it must be at least {least} and at most {LONGEST}")),
    }
}

/// `n` values at `p`.
pub(super) fn slice<'a, T>(p: *const T, n: usize, name: &str) -> Result<&'a [T]> {
    check(p, name)?;
    if n > LONGEST {
        return refuse(Kind::InvalidSize, format!("{name} would have {n} entries"));
    }
    // SAFETY: non-null, aligned, not overlong; readable for n values by the caller's contract.
    Ok(unsafe { std::slice::from_raw_parts(p, n) })
}

/// `n` finite numbers at `p`.
pub(super) fn numbers<'a>(p: *const f64, n: usize, name: &str) -> Result<&'a [f64]> {
    let values = slice(p, n, name)?;
    match values.iter().position(|v| !v.is_finite()) {
        None => Ok(values),
        Some(k) => refuse(Kind::NotFinite, format!("{name}[{k}] is {}; it must be finite", values[k])),
    }
}

/// Refuses results that left the range of doubles: an infinity that went out with a success would end in
/// the host's linear solver, far from its cause.
pub(super) fn check_results<'a>(name: &str, values: impl IntoIterator<Item = &'a f64>) -> Result<()> {
    match values.into_iter().all(|v| v.is_finite()) {
        true => Ok(()),
        false => refuse(Kind::NotFinite, format!("{name} overflows: the inputs are out of range")),
    }
}

/// Like [`numbers`], or nothing where `p` is null.
pub(super) fn optional_numbers<'a>(p: *const f64, n: usize, name: &str) -> Result<Option<&'a [f64]>> {
    if p.is_null() { Ok(None) } else { numbers(p, n, name).map(Some) }
}

/// Numbers as points.
pub(super) fn vectors(values: &[f64]) -> Vec<Vec3> {
    values.chunks_exact(3).map(Vec3::from_column_slice).collect()
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

/// Copies values one by one to `p`; nothing where `p` is null.
pub(super) fn write_each<T>(p: *mut T, values: impl Iterator<Item = T>) {
    if !p.is_null() {
        for (k, value) in values.enumerate() {
            // SAFETY: writable for as many values as the documentation says; the iterator gives those.
            unsafe { p.add(k).write(value) }
        }
    }
}

/// Checks that an output pointer may be null but not misaligned.
pub(super) fn check_optional<T>(p: *const T, name: &str) -> Result<()> {
    if p.is_null() { Ok(()) } else { check(p, name) }
}

/// Checks a size that a caller declares; the bytes beyond what this library knows.
pub(super) fn check_size<T: Sized64>(size: u64) -> Result<usize> {
    let known = size_of::<T>();
    match usize::try_from(size) {
        Ok(size) if (known..=LONGEST_STRUCT).contains(&size) => Ok(size - known),
        _ => {
            let text = format!("{0}.struct_size is {size}; set it to sizeof({0}), which is {known}", T::NAME);
            refuse(Kind::StructSize, text)
        }
    }
}

/// Reads the size a caller has put first into a struct.
fn declared_size<T: Sized64>(p: *const T) -> Result<usize> {
    check(p, T::NAME)?;
    // SAFETY: non-null and aligned; every struct of the ABI begins with a readable u64.
    let size = unsafe { p.cast::<u64>().read() };
    check_size::<T>(size).map(|tail| size_of::<T>() + tail)
}

/// A struct from the caller. A longer one (a newer caller's) must have a tail of zeros.
pub(super) fn read<T: Sized64>(p: *const T) -> Result<T> {
    let size = declared_size(p)?;
    // SAFETY: the caller's struct has `size` readable bytes by its own declaration.
    let bytes = unsafe { std::slice::from_raw_parts(p.cast::<u8>(), size) };
    if bytes[size_of::<T>()..].iter().any(|b| *b != 0) {
        let text =
            format!("{0} is longer than this library knows and sets a member beyond it: the caller is newer", T::NAME);
        return refuse(Kind::StructSize, text);
    }
    let mut value = MaybeUninit::<T>::uninit();
    // SAFETY: size >= size_of::<T>(), and T is valid for every bit pattern (Sized64).
    unsafe {
        std::ptr::copy_nonoverlapping(bytes.as_ptr(), value.as_mut_ptr().cast::<u8>(), size_of::<T>());
        Ok(value.assume_init())
    }
}

/// Checks an output struct; [`write_struct`] then fills it.
pub(super) fn check_struct<T: Sized64>(p: *mut T) -> Result<()> {
    declared_size(p.cast_const()).map(|_| ())
}

/// Writes a struct into a caller's one that [`check_struct`] has passed; the caller's size stays.
pub(super) fn write_struct<T: Sized64>(p: *mut T, value: T) {
    // SAFETY: checked by check_struct; at least size_of::<T>() writable bytes by its declaration.
    unsafe {
        let size = p.cast::<u64>().read();
        p.write(value);
        p.cast::<u64>().write(size);
    }
}
