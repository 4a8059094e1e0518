//! Numbers of a caller that stand for a choice.

use crate::error::{Error, Kind, Result};

/// Looks up an option's number in a table of what this version has; numbers below `named` exist in the
/// header.
pub(super) fn choose<T: Copy>(value: i32, name: &str, available: &[T], named: i32) -> Result<T> {
    let choice = usize::try_from(value).ok().and_then(|k| available.get(k));
    choice.copied().ok_or_else(|| {
        if (0..named).contains(&value) {
            Error::new(Kind::Unsupported, text!("{name} = {value} is not available in this version"))
        } else {
            unnamed(value, name, named)
        }
    })
}

#[cold]
pub(super) fn unnamed(value: i32, name: &str, named: i32) -> Error {
    Error::new(Kind::InvalidValue, text!("{name} is {value}; the header names 0 to {}", named - 1))
}
