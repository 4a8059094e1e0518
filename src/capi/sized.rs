//! Structs that grow: callers and library of different versions understand each other.
//!
//! Every struct of the ABI begins with its `struct_size`, which the caller sets. Members are appended only. So:
//! an older caller's shorter struct is read as if its missing members were 0, and written as far as it reaches; a
//! newer caller's longer one is accepted when all that this library does not know is 0. A new member's 0 must
//! therefore mean "as before".

use super::raw::{check, refuse};
use crate::error::{Kind, Result};
use std::mem::MaybeUninit;

/// Longest struct accepted from a newer caller: ten times the longest of today; beyond it a size is garbage.
const LONGEST: usize = 4096;

/// A struct of the ABI: `repr(C)`, first member `struct_size: u64`, no padding, valid for every bit pattern.
///
/// # Safety
/// The implementor must be just that.
pub(super) unsafe trait Sized64: Copy {
    /// Its name in messages.
    const NAME: &'static str;
    /// Its size in the first release that had it; a literal, which stays when the struct grows.
    const FIRST: usize;
}

/// Checks a size that a caller declares.
#[inline]
fn check_size<T: Sized64>(size: u64) -> Result<usize> {
    const { assert!(16 <= T::FIRST && T::FIRST <= size_of::<T>(), "structs only grow") }
    match usize::try_from(size) {
        Ok(size) if (T::FIRST..=LONGEST).contains(&size) => Ok(size),
        _ => {
            let text = text!("{0}.struct_size is {size}; set it to sizeof({0}), which is {1}", T::NAME, size_of::<T>());
            refuse(Kind::StructSize, text)
        }
    }
}

/// Reads the size a caller has put first into a struct.
#[inline]
pub(super) fn declared_size<T: Sized64>(p: *const T) -> Result<usize> {
    check(p, T::NAME)?;
    // SAFETY: non-null and aligned; every struct of the ABI begins with a readable u64.
    check_size::<T>(unsafe { p.cast::<u64>().read() })
}

/// A struct from the caller; what an older caller's one lacks is 0.
#[inline]
pub(super) fn read<T: Sized64>(p: *const T) -> Result<T> {
    let size = declared_size(p)?;
    if size == size_of::<T>() {
        // SAFETY: non-null, aligned, and as long as the caller declares; T is valid for every bit pattern (Sized64).
        return Ok(unsafe { p.read() });
    }
    read_other(p, size)
}

/// The same of a caller whose struct has another size.
#[inline(never)]
fn read_other<T: Sized64>(p: *const T, size: usize) -> Result<T> {
    // SAFETY: the caller's struct has `size` readable bytes by its own declaration.
    let bytes = unsafe { std::slice::from_raw_parts(p.cast::<u8>(), size) };
    let known = size.min(size_of::<T>());
    if bytes[known..].iter().any(|b| *b != 0) {
        let text =
            text!("{0} is longer than this library knows and sets a member beyond it: the caller is newer", T::NAME);
        return refuse(Kind::StructSize, text);
    }
    let mut value = MaybeUninit::<T>::zeroed();
    // SAFETY: known <= size_of::<T>(), and T is valid for every bit pattern (Sized64).
    unsafe {
        std::ptr::copy_nonoverlapping(bytes.as_ptr(), value.as_mut_ptr().cast::<u8>(), known);
        Ok(value.assume_init())
    }
}

/// Checks an output struct; [`write`] then fills it.
pub(super) fn check_output<T: Sized64>(p: *mut T) -> Result<()> {
    declared_size(p.cast_const()).map(|_| ())
}

/// Writes a struct into a caller's one that [`check_output`] has passed, as far as that reaches; zeros where a newer
/// caller's one reaches farther, so that it may be passed on. The caller's size stays.
pub(super) fn write<T: Sized64>(p: *mut T, value: T) {
    // SAFETY: checked by check_output: `size` writable bytes by the caller's declaration, the first 8 its size.
    unsafe {
        let size = p.cast::<u64>().read();
        if size == size_of::<T>() as u64 {
            p.write(value);
        } else {
            fill(p, &value, size as usize);
        }
        p.cast::<u64>().write(size);
    }
}

/// Writes a struct of `size` bytes, known or not, from nothing.
pub(super) fn initialise<T: Sized64>(p: *mut T, size: u64, value: T, name: &str) -> Result<()> {
    check(p, name)?;
    let size = check_size::<T>(size)?;
    // SAFETY: the caller declares `size` writable bytes.
    unsafe { fill(p, &value, size) }
    Ok(())
}

/// Writes `value` as far as `size` bytes reach, and zeros where they reach farther.
///
/// # Safety
/// `p` has `size` writable bytes.
unsafe fn fill<T: Sized64>(p: *mut T, value: &T, size: usize) {
    // SAFETY: no more than either side holds.
    unsafe {
        std::ptr::write_bytes(p.cast::<u8>(), 0, size);
        std::ptr::copy_nonoverlapping(std::ptr::from_ref(value).cast::<u8>(), p.cast::<u8>(), size.min(size_of::<T>()));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A struct as an older caller knows it, as this library does, and as a newer caller does.
    #[repr(C)]
    #[derive(Clone, Copy, PartialEq, Debug)]
    struct Old {
        struct_size: u64,
        a: f64,
    }
    #[repr(C)]
    #[derive(Clone, Copy, PartialEq, Debug)]
    struct Known {
        struct_size: u64,
        a: f64,
        b: f64,
    }
    #[repr(C)]
    #[derive(Clone, Copy, PartialEq, Debug)]
    struct New {
        struct_size: u64,
        a: f64,
        b: f64,
        c: f64,
    }

    // SAFETY: repr(C), struct_size first, numbers only.
    unsafe impl Sized64 for Known {
        const NAME: &'static str = "known";
        const FIRST: usize = 16;
    }

    const VALUE: Known = Known { struct_size: 0, a: 1.0, b: 2.0 };

    #[test]
    fn older_callers_struct_is_read_with_zeros_and_written_as_far_as_it_reaches() {
        // The second one must stay as it is.
        let mut old = [Old { struct_size: 16, a: 7.0 }, Old { struct_size: 3, a: 4.0 }];
        let p = old.as_mut_ptr().cast::<Known>();
        assert_eq!(read(p), Ok(Known { struct_size: 16, a: 7.0, b: 0.0 }));
        assert_eq!(check_output(p), Ok(()));
        write(p, VALUE);
        assert_eq!(old, [Old { struct_size: 16, a: 1.0 }, Old { struct_size: 3, a: 4.0 }]);
        assert_eq!(
            initialise(old.as_mut_ptr().cast::<Known>(), 16, Known { struct_size: 16, a: 5.0, b: 6.0 }, "known"),
            Ok(())
        );
        assert_eq!(old, [Old { struct_size: 16, a: 5.0 }, Old { struct_size: 3, a: 4.0 }]);
    }

    #[test]
    fn newer_callers_struct_is_accepted_unless_it_sets_what_is_unknown() {
        let mut new = New { struct_size: 32, a: 7.0, b: 8.0, c: 0.0 };
        let p = std::ptr::from_mut(&mut new).cast::<Known>();
        assert_eq!(read(p), Ok(Known { struct_size: 32, a: 7.0, b: 8.0 }));
        new.c = 9.0;
        let p = std::ptr::from_mut(&mut new).cast::<Known>();
        assert_eq!(read(p).unwrap_err().kind, Kind::StructSize);
        assert_eq!(check_output(p), Ok(()));
        write(p, VALUE);
        assert_eq!(new, New { struct_size: 32, a: 1.0, b: 2.0, c: 0.0 });
        new.c = 9.0;
        assert_eq!(
            initialise(std::ptr::from_mut(&mut new).cast::<Known>(), 32, Known { struct_size: 32, ..VALUE }, "known"),
            Ok(())
        );
        assert_eq!(new, New { struct_size: 32, a: 1.0, b: 2.0, c: 0.0 });
    }

    #[test]
    fn sizes_below_the_first_release_are_refused() {
        for size in [0, 8, 15, 4097, u64::MAX] {
            let mut old = Old { struct_size: size, a: 7.0 };
            let p = std::ptr::from_mut(&mut old).cast::<Known>();
            assert_eq!(read(p).unwrap_err().kind, Kind::StructSize);
            assert_eq!(check_output(p).unwrap_err().kind, Kind::StructSize);
            assert_eq!(initialise(p, size, VALUE, "known").unwrap_err().kind, Kind::StructSize);
            assert_eq!(old, Old { struct_size: size, a: 7.0 });
        }
    }
}
