//! Version numbers.

use libc::c_char;
use std::ffi::CStr;

/// Major version of the header.
pub const STICKSLIP_VERSION_MAJOR: i32 = 0;
/// Minor version of the header.
pub const STICKSLIP_VERSION_MINOR: i32 = 1;
/// Patch version of the header.
pub const STICKSLIP_VERSION_PATCH: i32 = 0;

/// Version of the library that runs, "major.minor.patch"; the macros above are those of the header.
///
/// Cost: none.
/// Owner: the library, for good; never NULL.
#[unsafe(no_mangle)]
pub extern "C" fn stickslip_version() -> *const c_char {
    const VERSION: &CStr = match CStr::from_bytes_with_nul(concat!(env!("CARGO_PKG_VERSION"), "\0").as_bytes()) {
        Ok(text) => text,
        Err(_) => c"",
    };
    VERSION.as_ptr()
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
