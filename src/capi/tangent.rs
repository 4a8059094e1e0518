//! The interface's tangent in the host's sparse formats.

use super::guard::guard;
use super::handle::{either, handle, stickslip_interface};
use super::plan::write_coo;
use super::point::Point;
use super::raw;
use crate::error::{Error, Kind, Result};
use crate::interface::{Csr, Extent, NO_EQUATION, PlanPairs, Sink};
use crate::memory::{self, Store};

/// Entries in the core's numbering.
#[derive(Default)]
pub(super) struct Triplets {
    pub rows: Vec<i64>,
    pub columns: Vec<i64>,
    pub values: Vec<f64>,
    /// There was no memory for all of them.
    refused: Option<Error>,
}

impl Sink for Triplets {
    #[inline]
    fn add(&mut self, row: i64, column: i64, value: f64) {
        let stored =
            self.rows.store(row).and_then(|()| self.columns.store(column)).and_then(|()| self.values.store(value));
        self.note(stored);
    }

    fn add_block(&mut self, rows: &[i64], columns: &[i64], values: &[f64]) {
        // NO_EQUATION alone is below 0; a look at all of them is faster than a search.
        if rows.iter().chain(columns).fold(0, |all, e| all | e) < 0 {
            for (&column, values) in columns.iter().zip(values.chunks_exact(rows.len())) {
                for (&row, &value) in rows.iter().zip(values) {
                    if row != NO_EQUATION && column != NO_EQUATION {
                        self.add(row, column, value);
                    }
                }
            }
            return;
        }
        // Nearly every block: all of its equations exist. The common lengths are known to the compiler.
        let stored = if let Ok(rows) = <&[i64; 12]>::try_from(rows) {
            self.store_block(rows, columns, values)
        } else if let Ok(rows) = <&[i64; 4]>::try_from(rows) {
            self.store_block(rows, columns, values)
        } else {
            self.store_block(rows, columns, values)
        };
        self.note(stored);
    }
}

impl Triplets {
    /// Keeps the first refusal for `check`.
    #[inline]
    fn note(&mut self, stored: Result<()>) {
        if let Err(error) = stored {
            self.refused.get_or_insert(error);
        }
    }

    /// A block.
    #[inline(always)]
    fn store_block(&mut self, rows: &[i64], columns: &[i64], values: &[f64]) -> Result<()> {
        let n = rows.len() * columns.len();
        self.rows.try_reserve(n)?;
        self.columns.try_reserve(n)?;
        self.values.store_all(values.iter().copied())?;
        let spare_rows = self.rows.spare_capacity_mut()[..n].chunks_exact_mut(rows.len());
        let spare_columns = self.columns.spare_capacity_mut()[..n].chunks_exact_mut(rows.len());
        for ((to_rows, to_columns), &column) in spare_rows.zip(spare_columns).zip(columns) {
            for (to, &row) in to_rows.iter_mut().zip(rows) {
                to.write(row);
            }
            for to in to_columns {
                to.write(column);
            }
        }
        // SAFETY: the loops wrote all n of both.
        unsafe {
            self.rows.set_len(self.rows.len() + n);
            self.columns.set_len(self.columns.len() + n);
        }
        Ok(())
    }

    /// Copies to the caller's arrays, or only counts when they are all NULL. `values` may be absent.
    pub fn write(
        &self,
        base: i64,
        capacity: i64,
        rows: *mut i64,
        columns: *mut i64,
        values: Option<*mut f64>,
        count: *mut i64,
    ) -> Result<()> {
        self.write_as(["rows", "columns", "values"], base, capacity, rows, columns, values, count)
    }

    /// The same, with other names for these arrays.
    #[expect(clippy::too_many_arguments, reason = "what a caller gives")]
    pub fn write_as(
        &self,
        names: [&str; 3],
        base: i64,
        capacity: i64,
        rows: *mut i64,
        columns: *mut i64,
        values: Option<*mut f64>,
        count: *mut i64,
    ) -> Result<()> {
        raw::check(count, "count")?;
        let n = self.values.len();
        let indices = [(rows.cast_const(), names[0]), (columns.cast_const(), names[1])];
        let counts = match values {
            Some(values) => raw::only_counts(&[indices[0], indices[1], (values.cast(), names[2])])?,
            None => raw::only_counts(&indices)?,
        };
        if !counts {
            if capacity < n as i64 {
                return Err(Error::new(Kind::BufferTooSmall, text!("capacity is {capacity}; {n} entries are needed")));
            }
            raw::write_equations(rows, &self.rows, base);
            raw::write_equations(columns, &self.columns, base);
            if let Some(values) = values {
                raw::write(values, &self.values);
            }
        }
        raw::write(count, &[n as i64]);
        Ok(())
    }

    /// Refuses where an entry found no memory or left the range of doubles.
    pub fn check(&mut self) -> Result<()> {
        self.refused.take().map_or(Ok(()), Err)?;
        // 0 v is 0 unless v is infinite or not a number; eight sums at a time.
        let (eights, rest) = self.values.as_chunks::<8>();
        let mut sums = [0.0; 8];
        for eight in eights {
            for (sum, v) in sums.iter_mut().zip(eight) {
                *sum += 0.0 * v;
            }
        }
        raw::check_results("values", sums.iter().chain(rest))
    }
}

/// The places of a host's matrix.
pub(super) fn read_csr<'a>(base: i64, n_rows: i64, row_offsets: *const i64, columns: *const i64) -> Result<Csr<'a>> {
    let n = raw::count(n_rows, 1, "n_rows")?;
    let offsets = raw::slice(row_offsets, n + 1, "row_offsets")?;
    let entries = raw::count(Csr::entries(base, offsets)?, 0, "row_offsets[n_rows]")?;
    let columns = raw::slice(columns, entries, "columns")?;
    Ok(Csr::new(base, offsets, columns))
}

/// The exact tangent d residual / d (x1, x2, lambda) as triplets in the host's equation numbers and index
/// base, by rows and within a row by columns, each once. Entries without an equation are left out. Entries depend on
/// the active pairs, so the pattern may change between evaluations; within one evaluation point it does not. Not
/// symmetric, even without friction. Paper (29)-(31). A host that fills a matrix of its own again and again takes
/// `stickslip_interface_plan` and `stickslip_interface_plan_values`.
///
/// Inputs x1, x2, lambda, sums as for `stickslip_interface_residual`. Outputs: rows, columns, values (capacity
/// each), count. With all three arrays NULL only count is written, and capacity is not read. Units of an entry:
/// its row's over its column's. After NOT_FINITE because a value overflows, values mean nothing; after any other error
/// they are as they were.
///
/// Errors: NULL_POINTER, NOT_FINITE, DEGENERATE_FACET, PROJECTION_NOT_CONVEX, UNDEFINED_NORMAL, INVALID_VALUE (as the
/// residual), BUFFER_TOO_SMALL, UNSUPPORTED (what sums do not go with:
/// docs/compose.md).
/// Cost: at new positions those of the residual, then the derivatives of every pair's weights (frozen weights:
/// none), O(pairs); counting needs no derivatives. Allocates.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_tangent_coo(
    interface: *mut stickslip_interface,
    x1: *const f64,
    x2: *const f64,
    lambda: *const f64,
    sums: *const f64,
    capacity: i64,
    rows: *mut i64,
    columns: *mut i64,
    values: *mut f64,
    count: *mut i64,
) -> i32 {
    guard(|| {
        let h = handle(interface)?;
        let point = Point::read(&h.inner, x1, x2, lambda, sums)?;
        raw::check(count, "count")?;
        let counts =
            raw::only_counts(&[(rows.cast(), "rows"), (columns.cast(), "columns"), (values.cast(), "values")])?;
        let (at, sums) = ((point.x1(), point.x2()), point.sums());
        let base = h.base;
        either!(&mut h.inner, c => {
            let n = c.own_plan(at, PlanPairs::Active(Extent::of(sums)))?.0.len();
            if !counts {
                raw::room(capacity, n, "the entries")?;
                let (plan, of) = c.own_values(at, point.lambda(), sums, raw::values(values, n, "values")?)?;
                write_coo(plan, of, base, rows, columns)?;
            }
            raw::write(count, &[n as i64]);
        });
        Ok(())
    })
}

/// Adds the exact tangent into a compressed sparse row matrix of the host's. Paper (29)-(31).
///
/// Inputs x1, x2, lambda, sums as for `stickslip_interface_residual`; n_rows rows; row_offsets (n_rows + 1),
/// starting at the index base; columns and values (as many as row_offsets says), columns in the index base, in
/// any order within a row. Every entry of the tangent is looked up once; a host that does so in every iteration takes
/// `stickslip_interface_plan_csr` and keeps the places.
///
/// Errors: NULL_POINTER, NOT_FINITE, DEGENERATE_FACET, PROJECTION_NOT_CONVEX, UNDEFINED_NORMAL, INVALID_VALUE (as the
/// residual), INVALID_SIZE, INDEX_OUT_OF_RANGE (an equation beyond n_rows), UNSUPPORTED (what sums do not go with:
/// docs/compose.md),
/// and MISSING_ENTRY when the matrix lacks an entry (renew the pattern from
/// `stickslip_interface_pattern_coo`); then nothing was added.
/// Cost: as `stickslip_interface_tangent_coo`, and a search in a row for each entry, by bisection where the
/// columns ascend. Allocates.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_tangent_csr(
    interface: *mut stickslip_interface,
    x1: *const f64,
    x2: *const f64,
    lambda: *const f64,
    sums: *const f64,
    n_rows: i64,
    row_offsets: *const i64,
    columns: *const i64,
    values: *mut f64,
) -> i32 {
    guard(|| {
        let h = handle(interface)?;
        let point = Point::read(&h.inner, x1, x2, lambda, sums)?;
        let csr = read_csr(h.base, n_rows, row_offsets, columns)?;
        raw::check(values, "values")?;
        let (at, sums) = ((point.x1(), point.x2()), point.sums());
        either!(&mut h.inner, c => {
            let n = c.own_plan(at, PlanPairs::Active(Extent::of(sums)))?.0.len();
            let mut entries = memory::filled(0.0, n)?;
            let (plan, of) = c.own_values(at, point.lambda(), sums, &mut entries)?;
            let (mut places, (equations, _)) = (memory::with_room(entries.len())?, plan.rows());
            let mut row = equations.iter();
            plan.each_row(of, &mut |columns| {
                let row = *row.next().unwrap_or(&NO_EQUATION);
                columns.iter().try_for_each(|&column| places.store(csr.place(row, column)?))
            })?;
            for (place, value) in places.into_iter().zip(entries) {
                // SAFETY: place < entries of the matrix, and the caller's values has that many.
                unsafe { *values.add(place) += value };
            }
        });
        Ok(())
    })
}

/// Entries of any tangent, with sums or without, while the surfaces slide by less than a quarter of a facet: by rows and
/// within a row by columns, each once. Preallocate with this; a larger motion may need entries beyond these; call again then.
///
/// x1 (3 n1), x2 (3 n2): positions [L]. Outputs: rows, columns (capacity each; both NULL: only count), count.
///
/// Errors: NULL_POINTER, NOT_FINITE, BUFFER_TOO_SMALL, DEGENERATE_FACET, PROJECTION_NOT_CONVEX, UNDEFINED_NORMAL,
/// INVALID_VALUE (as `stickslip_interface_sums`).
/// Cost: at new positions those of the residual, then one search and O(pairs); allocates.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_pattern_coo(
    interface: *mut stickslip_interface,
    x1: *const f64,
    x2: *const f64,
    capacity: i64,
    rows: *mut i64,
    columns: *mut i64,
    count: *mut i64,
) -> i32 {
    guard(|| {
        let h = handle(interface)?;
        let point = Point::positions(&h.inner, x1, x2)?;
        raw::check(count, "count")?;
        let counts = raw::only_counts(&[(rows.cast(), "rows"), (columns.cast(), "columns")])?;
        let base = h.base;
        either!(&mut h.inner, c => {
            let (plan, of) = c.own_plan((point.x1(), point.x2()), PlanPairs::Possible)?;
            if !counts {
                raw::room(capacity, plan.len(), "the entries")?;
                write_coo(plan, of, base, rows, columns)?;
            }
            raw::write(count, &[plan.len() as i64]);
        });
        Ok(())
    })
}
