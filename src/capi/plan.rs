//! The interface's tangent by a plan: its entries once, values as often as they suffice.

use super::choice::choose;
use super::guard::guard;
use super::handle::{either, handle, stickslip_interface};
use super::point::Point;
use super::raw;
use crate::error::{Error, Kind, Result};
use crate::features;
use crate::interface::{Extent, Plan, PlanOf, PlanPairs, PlanSystem};

/// A plan of the pairs that are active at the positions, and of those of t_n: exactly the entries of the tangent there.
pub const STICKSLIP_PLAN_ACTIVE: i32 = 0;
/// The same for values with sums of several handles.
pub const STICKSLIP_PLAN_ACTIVE_SUMS: i32 = 1;
/// A plan of all pairs that may be active, here and at t_n, while the surfaces slide by less than a quarter of a facet; for
/// values with sums or without.
pub const STICKSLIP_PLAN_SKIN: i32 = 2;

/// The entries of the tangent, the plan of `stickslip_interface_plan`.
pub const STICKSLIP_ENTRIES_TANGENT: i32 = 0;
/// What contact forces depend on the displacements by, the first part of `stickslip_interface_condensed_plan`.
pub const STICKSLIP_ENTRIES_FORCES: i32 = 1;
/// The contact constraints, its second part.
pub const STICKSLIP_ENTRIES_CONSTRAINTS: i32 = 2;

const PAIRS: [PlanPairs; 3] = [PlanPairs::Active(Extent::Whole), PlanPairs::Active(Extent::Part), PlanPairs::Possible];
const SYSTEMS: [PlanSystem; 3] = [PlanSystem::Whole, PlanSystem::Forces, PlanSystem::Constraints];

/// An index of the caller's, 64 or 32 bits.
pub(super) trait Index: Copy {
    fn of(value: i64) -> Option<Self>;
}

impl Index for i64 {
    fn of(value: i64) -> Option<i64> {
        Some(value)
    }
}

impl Index for i32 {
    fn of(value: i64) -> Option<i32> {
        i32::try_from(value).ok()
    }
}

pub(super) fn index<I: Index>(value: i64) -> Result<I> {
    let refused = || {
        let text = text!("{value} does not fit into 32 bits; take the function for 64");
        Error::new(Kind::IndexOutOfRange, text)
    };
    I::of(value).ok_or_else(refused)
}

/// Writes rows and columns of all entries, counted from `base`.
pub(super) fn write_coo<I: Index>(plan: &Plan, of: PlanOf, base: i64, rows: *mut I, columns: *mut I) -> Result<()> {
    let (mut to_rows, mut to_columns) = (raw::Output::new(rows), raw::Output::new(columns));
    let mut equations = plan.rows().0.iter();
    plan.each_row(of, &mut |of_row| {
        let row = index(equations.next().map_or(0, |row| row + base))?;
        of_row.iter().try_for_each(|&column| {
            to_rows.append(&[row]);
            to_columns.append(&[index(column + base)?]);
            Ok(())
        })
    })
}

/// Gives the plan of a handle, and what it belongs to, to `write`: all of its numbers fit, and there is room for its entries.
fn with_plan<I: Index>(
    h: &stickslip_interface,
    (entries, capacity): (i32, i64),
    write: impl FnOnce(&Plan, PlanOf) -> Result<()>,
) -> Result<()> {
    let (system, base) = (choose(entries, "entries", &SYSTEMS, 3)?, h.base);
    either!(&h.inner, c => {
        let (plan, of) = c.plan(system)?;
        raw::room(capacity, plan.len(), "the entries")?;
        // The largest number of each kind.
        index::<I>(plan.len() as i64 + base)?;
        plan.each_row(of, &mut |columns| index::<I>(columns[columns.len() - 1] + base).map(|_| ()))?;
        plan.rows().0.last().map_or(Ok(()), |row| index::<I>(row + base).map(|_| ()))?;
        write(plan, of)
    })
}

fn coo<I: Index>(
    interface: *mut stickslip_interface,
    entries: i32,
    capacity: i64,
    rows: *mut I,
    columns: *mut I,
) -> Result<()> {
    let h = handle(interface)?;
    raw::check(rows, "rows")?;
    raw::check(columns, "columns")?;
    with_plan::<I>(h, (entries, capacity), |plan, of| write_coo(plan, of, h.base, rows, columns))
}

fn csr<I: Index>(
    interface: *mut stickslip_interface,
    entries: i32,
    capacity: i64,
    rows: *mut I,
    row_offsets: *mut I,
    columns: *mut I,
) -> Result<()> {
    let h = handle(interface)?;
    raw::check(rows, "rows")?;
    raw::check(row_offsets, "row_offsets")?;
    raw::check(columns, "columns")?;
    with_plan::<I>(h, (entries, capacity), |plan, of| {
        let (equations, offsets) = plan.rows();
        let (mut to_rows, mut to_offsets) = (raw::Output::new(rows), raw::Output::new(row_offsets));
        equations.iter().try_for_each(|row| index(row + h.base).map(|row| to_rows.append(&[row])))?;
        offsets.iter().try_for_each(|at| index(*at as i64 + h.base).map(|at| to_offsets.append(&[at])))?;
        let mut to_columns = raw::Output::new(columns);
        plan.each_row(of, &mut |of_row| {
            of_row.iter().try_for_each(|column| index(column + h.base).map(|column| to_columns.append(&[column])))
        })
    })
}

/// Makes the plan of the tangent: its entries, each once, and where every block of it goes. The handle keeps it, in place of
/// an older one, until it is made again; `stickslip_interface_plan_values` fills it in every evaluation.
///
/// x1 (3 n1), x2 (3 n2): positions [L]; pairs: STICKSLIP_PLAN_... Outputs: rows, the number of equations that have
/// entries; count, the number of entries. Make it again when values are refused with MISSING_ENTRY, at the positions of
/// that call. A refused call leaves the older plan as it was.
///
/// Errors: NULL_POINTER, NOT_FINITE, INVALID_VALUE (pairs, and as `stickslip_interface_sums`), DEGENERATE_FACET,
/// PROJECTION_NOT_CONVEX, UNDEFINED_NORMAL, UNSUPPORTED (more than 2^30 nodes).
/// Cost: at new positions those of the residual, then O(entries); STICKSLIP_PLAN_SKIN one search more. Allocates.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_plan(
    interface: *mut stickslip_interface,
    x1: *const f64,
    x2: *const f64,
    pairs: i32,
    rows: *mut i64,
    count: *mut i64,
) -> i32 {
    guard(|| {
        let h = handle(interface)?;
        let point = Point::positions(&h.inner, x1, x2)?;
        let pairs = choose(pairs, "pairs", &PAIRS, 3)?;
        raw::check(rows, "rows")?;
        raw::check(count, "count")?;
        either!(&mut h.inner, c => {
            c.make_plan((point.x1(), point.x2()), pairs)?;
            let plan = c.plan(PlanSystem::Whole)?.0;
            raw::write(rows, &[plan.rows().0.len() as i64]);
            raw::write(count, &[plan.len() as i64]);
        });
        Ok(())
    })
}

/// The entries of a plan as pairs of row and column, by rows and within a row by columns, each once: what PETSc's
/// MatSetPreallocationCOO takes.
///
/// entries: STICKSLIP_ENTRIES_...; capacity: how many entries rows and columns have room for, at least the count that the plan
/// was made with. Outputs, in the host's equations and index base: rows, columns.
///
/// Errors: NULL_POINTER, INVALID_VALUE (entries; there is no plan), BUFFER_TOO_SMALL.
/// Cost: O(entries).
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_plan_coo(
    interface: *mut stickslip_interface,
    entries: i32,
    capacity: i64,
    rows: *mut i64,
    columns: *mut i64,
) -> i32 {
    guard(|| coo(interface, entries, capacity, rows, columns))
}

/// As `stickslip_interface_plan_coo`, in 32 bits: entries, capacity; outputs rows, columns.
///
/// Errors: as there, and INDEX_OUT_OF_RANGE where a number does not fit.
/// Cost: O(entries).
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_plan_coo32(
    interface: *mut stickslip_interface,
    entries: i32,
    capacity: i64,
    rows: *mut i32,
    columns: *mut i32,
) -> i32 {
    guard(|| coo(interface, entries, capacity, rows, columns))
}

/// The entries of a plan as compressed sparse rows. Only equations that have entries have a row.
///
/// entries: STICKSLIP_ENTRIES_...; capacity: how many entries columns has room for, at least the count that the plan was made
/// with. Outputs: rows, their equations, ascending, as many as the plan was made with; row_offsets, one more, where the columns
/// of each begin; columns, within a row ascending. All in the host's index base, row_offsets too.
///
/// Errors: NULL_POINTER, INVALID_VALUE (entries; there is no plan), BUFFER_TOO_SMALL.
/// Cost: O(entries).
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_plan_csr(
    interface: *mut stickslip_interface,
    entries: i32,
    capacity: i64,
    rows: *mut i64,
    row_offsets: *mut i64,
    columns: *mut i64,
) -> i32 {
    guard(|| csr(interface, entries, capacity, rows, row_offsets, columns))
}

/// As `stickslip_interface_plan_csr`, in 32 bits: entries, capacity; outputs rows, row_offsets, columns.
///
/// Errors: as there, and INDEX_OUT_OF_RANGE where a number does not fit.
/// Cost: O(entries).
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_plan_csr32(
    interface: *mut stickslip_interface,
    entries: i32,
    capacity: i64,
    rows: *mut i32,
    row_offsets: *mut i32,
    columns: *mut i32,
) -> i32 {
    guard(|| csr(interface, entries, capacity, rows, row_offsets, columns))
}

/// The exact tangent d residual / d (x1, x2, lambda) in the order of the plan's entries. Paper (29)-(31).
///
/// x1, x2, lambda, sums as for `stickslip_interface_residual`; with sums the plan is of STICKSLIP_PLAN_ACTIVE_SUMS or _SKIN.
/// capacity: how many values there is room for, at least as many as the plan has entries. Output: values, overwritten.
/// Units of an entry: its row's over its column's. After MISSING_ENTRY, OUT_OF_MEMORY and NOT_FINITE (a value overflows) they
/// mean nothing; after any other error they are as they were.
///
/// Errors: those of `stickslip_interface_residual`, INVALID_VALUE (there is no plan), BUFFER_TOO_SMALL, UNSUPPORTED (what sums do not go with:
/// docs/compose.md), MISSING_ENTRY: the plan lacks an entry; make it again.
/// Cost: at new positions those of the residual, then the derivatives of every pair's weights (frozen weights: none), each
/// block added at its place without a search. Allocates.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_plan_values(
    interface: *mut stickslip_interface,
    x1: *const f64,
    x2: *const f64,
    lambda: *const f64,
    sums: *const f64,
    capacity: i64,
    values: *mut f64,
) -> i32 {
    guard(|| {
        let h = handle(interface)?;
        let point = Point::read(&h.inner, x1, x2, lambda, sums)?;
        either!(&mut h.inner, c => {
            let n = c.plan(PlanSystem::Whole)?.0.len();
            raw::room(capacity, n, "the values")?;
            let values = raw::values(values, n, "values")?;
            c.plan_values((point.x1(), point.x2()), point.lambda(), point.sums(), values)
        })
    })
}

/// Makes the plans of what a system without multipliers has of displacements: its pieces FORCES and CONSTRAINTS (see
/// `stickslip_interface_condensed_coo`). The handle keeps them until they are made again.
///
/// x1 (3 n1), x2 (3 n2): positions [L]; pairs: STICKSLIP_PLAN_... Outputs: rows (2) and counts (2): how many equations have
/// entries, and how many entries there are, of FORCES and of CONSTRAINTS.
///
/// Errors: as `stickslip_interface_condensed_multipliers` and `stickslip_interface_plan`, INVALID_VALUE (pairs) among them.
/// Cost: as `stickslip_interface_plan`, twice. Allocates.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_condensed_plan(
    interface: *mut stickslip_interface,
    x1: *const f64,
    x2: *const f64,
    pairs: i32,
    rows: *mut i64,
    counts: *mut i64,
) -> i32 {
    guard(|| {
        features::needs!(CONDENSED);
        let h = handle(interface)?;
        let point = Point::positions(&h.inner, x1, x2)?;
        let pairs = choose(pairs, "pairs", &PAIRS, 3)?;
        raw::check(rows, "rows")?;
        raw::check(counts, "counts")?;
        either!(&mut h.inner, c => {
            c.make_condensed_plan((point.x1(), point.x2()), pairs)?;
            let [forces, constraints] = [PlanSystem::Forces, PlanSystem::Constraints].map(|system| c.plan(system));
            let (forces, constraints) = (forces?.0, constraints?.0);
            raw::write(rows, &[forces, constraints].map(|plan| plan.rows().0.len() as i64));
            raw::write(counts, &[forces, constraints].map(|plan| plan.len() as i64));
        });
        Ok(())
    })
}

/// The pieces FORCES and CONSTRAINTS of the matrix of a system without multipliers (`stickslip_interface_condensed_coo`) in
/// the order of their plans, of one linearisation.
///
/// x1 (3 n1), x2 (3 n2): positions [L]; lambda (n1 multipliers) [F/L^2], as for `stickslip_interface_condensed_residual`.
/// Outputs: forces, constraints, as many as the counts of `stickslip_interface_condensed_plan` [F/L]. After MISSING_ENTRY,
/// OUT_OF_MEMORY and NOT_FINITE (a value overflows) they mean nothing.
///
/// Errors: as `stickslip_interface_condensed_coo`, INVALID_VALUE (there is no plan), MISSING_ENTRY: a plan lacks an entry;
/// make both again.
/// Cost: as `stickslip_interface_plan_values`, and a sort of the pairs' nodes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_condensed_values(
    interface: *mut stickslip_interface,
    x1: *const f64,
    x2: *const f64,
    lambda: *const f64,
    forces: *mut f64,
    constraints: *mut f64,
) -> i32 {
    guard(|| {
        features::needs!(CONDENSED);
        let h = handle(interface)?;
        let point = Point::read(&h.inner, x1, x2, lambda, std::ptr::null())?;
        either!(&mut h.inner, c => {
            let counts = [c.plan(PlanSystem::Forces)?.0.len(), c.plan(PlanSystem::Constraints)?.0.len()];
            let values = [raw::values(forces, counts[0], "forces")?, raw::values(constraints, counts[1], "constraints")?];
            c.condensed_values((point.x1(), point.x2()), point.lambda(), values)
        })
    })
}
