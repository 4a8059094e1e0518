//! How matrices go out.

use crate::error::{Error, Kind, Result};

/// Matrices go out row by row (what PETSc's MatSetValues takes).
pub const STICKSLIP_LAYOUT_ROW_MAJOR: i32 = 0;
/// Matrices go out column by column (what a Fortran array is).
pub const STICKSLIP_LAYOUT_COLUMN_MAJOR: i32 = 1;

/// Whether a STICKSLIP_LAYOUT_... value asks for columns.
pub(super) fn column_major(layout: i32, name: &str) -> Result<bool> {
    match layout {
        STICKSLIP_LAYOUT_ROW_MAJOR => Ok(false),
        STICKSLIP_LAYOUT_COLUMN_MAJOR => Ok(true),
        _ => Err(Error::new(
            Kind::InvalidValue,
            text!("{name} is {layout}; 0 (row-major) or 1 (column-major) are allowed"),
        )),
    }
}
