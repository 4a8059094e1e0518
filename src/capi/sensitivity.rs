//! Derivatives of a residual by what it depends on besides the unknowns.

use super::guard::guard;
use super::handle::{Inner, dimension, either, handle, stickslip_interface};
use super::point::Point;
use super::raw;
use super::sized::{self, Sized64};
use super::tangent::Triplets;
use crate::error::Result;
use crate::features;
use crate::interface::{Layout, Wanted};
use crate::memory;
use std::ops::Range;

/// What a residual depends on besides multipliers: where products with its derivatives go (`stickslip_interface_adjoint`), n1 and n2
/// being the nodes of both sides. A NULL member is not wanted. Units are those of the product a^T R, which the caller's functional has, over the
/// member's own; in brackets where that product has none.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct stickslip_gradient {
    /// sizeof(stickslip_gradient).
    pub struct_size: u64,
    /// By the positions at t_n of the non-mortar nodes (3 n1; plane and axisymmetric models: 2 n1) [L^-1].
    pub previous1: *mut f64,
    /// By those of the mortar nodes (3 n2) [L^-1].
    pub previous2: *mut f64,
    /// By the positions of now: the tangent's columns, also of nodes without equations (3 n1) [L^-1].
    pub now1: *mut f64,
    /// Likewise (3 n2) [L^-1]. Not of a mortar side of which no node has an equation.
    pub now2: *mut f64,
    /// By the coefficients of friction (n1) [-].
    pub friction: *mut f64,
    /// By the largest shear traction (1) [L^2/F].
    pub shear_limit: *mut f64,
    /// By the offsets of the non-mortar nodes (n1) [L^-1].
    pub offsets1: *mut f64,
    /// By those of the mortar nodes (n2) [L^-1].
    pub offsets2: *mut f64,
}

// SAFETY: repr(C), struct_size first, raw pointers only.
unsafe impl Sized64 for stickslip_gradient {
    const NAME: &'static str = "stickslip_gradient";
    const FIRST: usize = 72;
}

/// A direction in what a residual depends on (`stickslip_interface_sensitivity`): the members of `stickslip_gradient`. A NULL member is
/// zero.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct stickslip_direction {
    /// sizeof(stickslip_direction).
    pub struct_size: u64,
    /// Of the positions at t_n [L].
    pub previous1: *const f64,
    /// Likewise [L].
    pub previous2: *const f64,
    /// Of the positions of now [L].
    pub now1: *const f64,
    /// Likewise [L].
    pub now2: *const f64,
    /// Of the coefficients of friction [-].
    pub friction: *const f64,
    /// Of the largest shear traction [F/L^2].
    pub shear_limit: *const f64,
    /// Of the offsets [L].
    pub offsets1: *const f64,
    /// Likewise [L].
    pub offsets2: *const f64,
}

// SAFETY: repr(C), struct_size first, raw pointers only.
unsafe impl Sized64 for stickslip_direction {
    const NAME: &'static str = "stickslip_direction";
    const FIRST: usize = 72;
}

/// An array of the caller's: where it stands in the core's vector, and how many of a node's numbers there are.
struct Part<P> {
    array: P,
    name: &'static str,
    at: Range<usize>,
    /// (In the core's vector, in the caller's array.)
    of_node: (usize, usize),
}

impl<P> Part<P> {
    /// How many numbers the caller's array has.
    fn len(&self) -> usize {
        self.at.len() / self.of_node.0 * self.of_node.1
    }
}

/// The members of a gradient or of a direction.
fn members<P: Copy>(layout: &Layout, dimension: usize, of: [P; 8]) -> [Part<P>; 8] {
    let (vector, limit) = ((3, dimension), layout.shear_limit());
    let part = |k: usize, name, at, of_node| Part { array: of[k], name, at, of_node };
    [
        part(0, "previous1", layout.previous(0), vector),
        part(1, "previous2", layout.previous(1), vector),
        part(2, "now1", layout.now(0), vector),
        part(3, "now2", layout.now(1), vector),
        part(4, "friction", layout.friction(), (1, 1)),
        part(5, "shear_limit", limit..limit + 1, (1, 1)),
        part(6, "offsets1", layout.offsets(0), (1, 1)),
        part(7, "offsets2", layout.offsets(1), (1, 1)),
    ]
}

/// The parts of a residual.
fn residual<P: Copy>(interface: &Inner, layout: &Layout, names: [&'static str; 3], of: [P; 3]) -> [Part<P>; 3] {
    let vector = (3, dimension(interface));
    let row = if matches!(interface, Inner::One(_)) { (1, 1) } else { vector };
    let part = |k: usize, at, of_node| Part { array: of[k], name: names[k], at, of_node };
    [part(0, layout.now(0), vector), part(1, layout.now(1), vector), part(2, layout.rows(), row)]
}

/// Which of the members are asked for.
fn wanted<P>(parts: &[Part<P>; 8], is_there: impl Fn(&P) -> bool) -> (Wanted, [bool; 2]) {
    let there = |k: usize| is_there(&parts[k].array);
    let wanted = Wanted { previous: there(0) || there(1), parameters: (4..8).any(there) };
    (wanted, [there(2), there(3)])
}

/// Puts the caller's numbers where they stand.
fn gather<const K: usize>(parts: &[Part<*const f64>; K], n: usize, is_needed: bool) -> Result<Vec<f64>> {
    let mut all = memory::filled(0.0, n)?;
    for part in parts.iter().filter(|part| is_needed || !part.array.is_null()) {
        let values = raw::numbers(part.array, part.len(), part.name)?;
        let (width, given) = part.of_node;
        for (to, from) in all[part.at.start..part.at.end].chunks_exact_mut(width).zip(values.chunks_exact(given)) {
            to[..given].copy_from_slice(from);
        }
    }
    Ok(all)
}

/// Gives them to the caller, where they are wanted.
fn scatter<const K: usize>(parts: &[Part<*mut f64>; K], all: &[f64], name: &str) -> Result<()> {
    raw::check_results(name, all)?;
    for part in parts {
        let (width, wanted) = part.of_node;
        let values = all[part.at.start..part.at.end].chunks_exact(width);
        raw::write_each(part.array, values.flat_map(|v| v.iter().copied().take(wanted)));
    }
    Ok(())
}

/// How the residual depends on the positions of t_n, as triplets in the host's equation numbers and index base: rows are the equations of
/// the residual, columns those of the displacements. For gradients of a run (docs/gradients.md, docs/formulation 18): with K_n the
/// tangent of step n and B_n this matrix, both at its end and before its commit (or after `stickslip_interface_set_committed` of t_n),
/// K_n^T a_n = - dj/d(u_n, lambda_n) - B_{n+1}^T a_{n+1}, backwards. Entries that are given twice add up.
///
/// x1 (3 n1), x2 (3 n2), lambda (3 n1): as for `stickslip_interface_states`. Outputs: rows, columns, values (capacity each), count. With all
/// three arrays NULL only count is written, and capacity is not read. Units of an entry: its row's over [L].
///
/// The derivative is that of the nodes' states and of what is covered, carried and searched at t_n as they are. r_A and the row scale, whose
/// derivative is multiplied by a row that is 0, are held.
///
/// Errors: those of `stickslip_interface_residual` without sums; BUFFER_TOO_SMALL; UNSUPPORTED (docs/compose.md; where copies of a node touch as
/// one).
/// Cost: after a residual at the same point, an integration at t_n and the derivatives of all weights there, about twice a tangent. Counting
/// costs the same. Allocates.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_previous_tangent_coo(
    interface: *mut stickslip_interface,
    x1: *const f64,
    x2: *const f64,
    lambda: *const f64,
    capacity: i64,
    rows: *mut i64,
    columns: *mut i64,
    values: *mut f64,
    count: *mut i64,
) -> i32 {
    guard(|| {
        features::needs!(SENSITIVITY);
        let h = handle(interface)?;
        let point = Point::read(&h.inner, x1, x2, lambda, std::ptr::null())?;
        raw::check(count, "count")?;
        raw::only_counts(&[(rows.cast(), "rows"), (columns.cast(), "columns"), (values.cast(), "values")])?;
        let mut triplets = Triplets::default();
        either!(&mut h.inner, c => c.previous_tangent([point.x1(), point.x2()], point.lambda(), &mut triplets)?);
        triplets.check()?;
        triplets.write(h.base, capacity, rows, columns, Some(values), count)
    })
}

/// Products from the left: a^T d residual / d (what the residual depends on besides multipliers), of all members of `gradient` that are not
/// NULL, in one pass. a is an adjoint, in the layout of the residual: a1 (3 n1) and a2 (3 n2) beside the forces, a_rows (3 n1, or n1 without
/// friction) beside the rows of multipliers; 0 where there is no equation.
///
/// x1, x2, lambda: as for `stickslip_interface_previous_tangent_coo`. A node that slips at the threshold follows mu, or the limit if that
/// decides; one whose threshold is 0 in this step (newly covered, or a copy of one in contact) neither.
///
/// Errors: NULL_POINTER, those of `stickslip_interface_previous_tangent_coo`, STRUCT_SIZE, UNSUPPORTED (now2 of a mortar side that does not
/// move).
/// Cost: as there where previous1 or previous2 are wanted, of a tangent where now1 or now2 are, O(pairs) else. Allocates.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_adjoint(
    interface: *mut stickslip_interface,
    x1: *const f64,
    x2: *const f64,
    lambda: *const f64,
    a1: *const f64,
    a2: *const f64,
    a_rows: *const f64,
    gradient: *const stickslip_gradient,
) -> i32 {
    guard(|| {
        features::needs!(SENSITIVITY);
        let h = &mut handle(interface)?.inner;
        let point = Point::read(h, x1, x2, lambda, std::ptr::null())?;
        let g = sized::read(gradient)?;
        let layout = either!(h, c => c.layout());
        let arrays = [g.previous1, g.previous2, g.now1, g.now2, g.friction, g.shear_limit, g.offsets1, g.offsets2];
        let parts = members(&layout, dimension(h), arrays);
        for part in &parts {
            raw::check_optional(part.array, part.name)?;
        }
        let from = residual(h, &layout, ["a1", "a2", "a_rows"], [a1, a2, a_rows]);
        let a = gather(&from, layout.residual(), true)?;
        let wanted = wanted(&parts, |p| !p.is_null());
        let x = [point.x1(), point.x2()];
        let products = either!(h, c => c.adjoint(x, point.lambda(), &a, wanted)?);
        scatter(&parts, &products, "gradient")
    })
}

/// Products from the right: d residual / d (what the residual depends on besides multipliers) along a direction. For tangents of a run,
/// forwards: K_n dy_n = - this, with the motion of step n - 1 in previous1 and previous2.
///
/// x1, x2, lambda: as for `stickslip_interface_previous_tangent_coo`. direction: the members that are not NULL count. Outputs: force1 (3 n1),
/// force2 (3 n2), rows (3 n1, or n1 without friction).
///
/// Errors: NULL_POINTER, STRUCT_SIZE, NOT_FINITE, UNSUPPORTED, as `stickslip_interface_adjoint`.
/// Cost: as there. Allocates.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_sensitivity(
    interface: *mut stickslip_interface,
    x1: *const f64,
    x2: *const f64,
    lambda: *const f64,
    direction: *const stickslip_direction,
    force1: *mut f64,
    force2: *mut f64,
    rows: *mut f64,
) -> i32 {
    guard(|| {
        features::needs!(SENSITIVITY);
        let h = &mut handle(interface)?.inner;
        let point = Point::read(h, x1, x2, lambda, std::ptr::null())?;
        let d = sized::read(direction)?;
        let layout = either!(h, c => c.layout());
        let arrays = [d.previous1, d.previous2, d.now1, d.now2, d.friction, d.shear_limit, d.offsets1, d.offsets2];
        let parts = members(&layout, dimension(h), arrays);
        let along = gather(&parts, layout.arguments(), false)?;
        let to = residual(h, &layout, ["force1", "force2", "rows"], [force1, force2, rows]);
        for part in &to {
            raw::check(part.array, part.name)?;
        }
        let wanted = wanted(&parts, |p| !p.is_null());
        let x = [point.x1(), point.x2()];
        let change = either!(h, c => c.sensitivity(x, point.lambda(), &along, wanted)?);
        scatter(&to, &change, "force1, force2, rows")
    })
}
