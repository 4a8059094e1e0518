//! Version numbers, and how the library was built.

use crate::simd;
use libc::c_char;
use std::ffi::CStr;

/// Major version of the header.
pub const STICKSLIP_VERSION_MAJOR: i32 = 0;
/// Minor version of the header.
pub const STICKSLIP_VERSION_MINOR: i32 = 1;
/// Patch version of the header.
pub const STICKSLIP_VERSION_PATCH: i32 = 0;

/// A text of the library as C reads it; it is written with its zero.
const fn c_text(with_zero: &'static str) -> &'static CStr {
    match CStr::from_bytes_with_nul(with_zero.as_bytes()) {
        Ok(text) => text,
        Err(_) => panic!("a text ends with its only zero"),
    }
}

/// Version of the library that runs, "major.minor.patch"; the macros above are those of the header.
///
/// Cost: none.
/// Owner: the library, for good; never NULL.
#[unsafe(no_mangle)]
pub extern "C" fn stickslip_version() -> *const c_char {
    const VERSION: &CStr = c_text(concat!(env!("CARGO_PKG_VERSION"), "\0"));
    VERSION.as_ptr()
}

/// `stickslip_build`'s text with the name of the kernels that run.
macro_rules! build_text {
    ($kernels:literal) => {
        c_text(concat!(
            "version=",
            env!("CARGO_PKG_VERSION"),
            " commit=",
            env!("STICKSLIP_BUILD_COMMIT"),
            " target=",
            env!("STICKSLIP_BUILD_TARGET"),
            " profile=",
            env!("STICKSLIP_BUILD_PROFILE"),
            " compiler=",
            env!("STICKSLIP_BUILD_COMPILER"),
            " kernels=",
            $kernels,
            " features=",
            env!("STICKSLIP_BUILD_FEATURES"),
            "\0"
        ))
    };
}

/// How the library that runs was built, for reports of errors and records of results: words "name=value" with one blank
/// between them. Their names are, in this order: version; commit of the source ("unknown" where none was known, with
/// "+changes" where the source was not as committed); target; profile (release or debug, and the level of optimisation);
/// compiler; kernels, those that this processor takes ("plain" or "avx2+fma"); features that are built of those that can be left
/// out, with commas between them, or "none" (docs/abi.md). What was left out is refused with UNSUPPORTED. Later versions append
/// words. No word is a path or a time.
///
/// Cost: none.
/// Owner: the library, for good; never NULL.
#[unsafe(no_mangle)]
pub extern "C" fn stickslip_build() -> *const c_char {
    const PLAIN: &CStr = build_text!("plain");
    const AVX2: &CStr = build_text!("avx2+fma");
    match simd::back_end() {
        simd::BackEnd::Plain => PLAIN.as_ptr(),
        simd::BackEnd::Avx2 => AVX2.as_ptr(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn macros_equal_the_package_version() {
        let macros = format!("{STICKSLIP_VERSION_MAJOR}.{STICKSLIP_VERSION_MINOR}.{STICKSLIP_VERSION_PATCH}");
        assert_eq!(macros, env!("CARGO_PKG_VERSION"));
    }
}
