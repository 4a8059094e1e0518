//! How matrices go out.

use super::raw;
use crate::dual::Columns;
use crate::element::Lines;
use crate::error::{Error, Kind, Result};
use nalgebra::SMatrix;

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

/// A caller's square matrix of blocks, 3 x 3 or of lines 2 x 2.
pub(super) struct Matrix {
    k: *mut f64,
    ld: usize,
    column_major: bool,
}

impl Matrix {
    /// The matrix k of so many rows, with its leading dimension.
    pub fn new(k: *mut f64, size: usize, ld: i64, column_major: bool) -> Result<Matrix> {
        if ld < size as i64 {
            return Err(Error::new(Kind::InvalidSize, text!("ld is {ld}; it must be at least {size}")));
        }
        let ld = raw::count(ld, 1, "ld")?;
        raw::check(k, "k")?;
        Ok(Matrix { k, ld, column_major })
    }

    /// Writes `[j][i][row]` of so many rows of blocks in a column; rows and columns are counted in blocks.
    pub fn write_rows(&mut self, (row, rows): (usize, usize), column: usize, values: &Columns) {
        let (down, right) = if self.column_major { (1, self.ld) } else { (self.ld, 1) };
        for (c, i) in (0..rows).flat_map(|c| (0..3).map(move |i| (c, i))) {
            let at = (3 * (row + c) + i) * down + 3 * column * right;
            for j in 0..3 {
                // SAFETY: at + j right < ld * size; the caller's k has that many entries.
                unsafe { self.k.add(at + j * right).write(values[j][i][c]) };
            }
        }
    }

    /// Writes a block; rows and columns are counted in blocks.
    pub fn write<const D: usize>(&mut self, row: usize, column: usize, block: &SMatrix<f64, D, D>) {
        let (down, right) = if self.column_major { (1, self.ld) } else { (self.ld, 1) };
        let first = D * (row * down + column * right);
        for j in 0..D {
            for i in 0..D {
                // SAFETY: the entry < ld * size; the caller's k has that many.
                unsafe { self.k.add(first + i * down + j * right).write(block[(i, j)]) };
            }
        }
    }
}

impl Lines for Matrix {
    #[inline(always)]
    fn are_columns(&self) -> bool {
        self.column_major
    }

    #[inline(always)]
    fn set(&mut self, line: usize, at: usize, values: [f64; 4]) {
        // SAFETY: at + 3 < size <= ld and line < size, so all four lie in the caller's k; doubles are aligned as it is.
        unsafe { self.k.add(line * self.ld + at).cast::<[f64; 4]>().write(values) };
    }
}
