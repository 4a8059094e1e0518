//! History of an interface: commit, rollback, restart.

use super::guard::guard;
use super::handle::{either, handle, stickslip_interface};
use super::point::Point;
use super::raw;
use crate::error::{Error, Kind};

/// Accepts a converged step: (x1, x2, lambda) becomes t_n; weights, normals, coverage and slip move on.
///
/// Where the mortar surface lies in layers, the nearest facets over each non-mortar facet are its pairs until the next commit
/// (docs/formulation 6.6); the creation, `stickslip_interface_set_previous` and `stickslip_interface_set_committed` settle it, too.
///
/// Inputs x1, x2, lambda, sums as for `stickslip_interface_states`.
///
/// Errors: NULL_POINTER, NOT_FINITE, DEGENERATE_FACET, PROJECTION_NOT_CONVEX, UNDEFINED_NORMAL, INVALID_VALUE
/// (mortar facets on each other, in one place, an analytic surface's frame), TURNED_TOO_FAR (by more than method.turn_max since the last commit;
/// with friction against each other, too), CONTACT_LOST (a closed node would lose a pair that is deeper than one may be, or all
/// that covers it); then nothing has moved.
/// Cost: as `stickslip_interface_states`, then O(n1 + n2) for what the next step needs. Of facets between which there can be
/// contact in the next step alone the weights are integrated; with WEIGHTS_COMMITTED, an analytic mortar side or
/// STICKSLIP_INTEGRATION_HYBRID all are, after one search (WEIGHTS_REFERENCE: none). Allocates. The history before it is
/// kept, for `stickslip_interface_rollback`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_commit(
    interface: *mut stickslip_interface,
    x1: *const f64,
    x2: *const f64,
    lambda: *const f64,
    sums: *const f64,
) -> i32 {
    guard(|| {
        let h = &mut handle(interface)?.inner;
        let point = Point::read(h, x1, x2, lambda, sums)?;
        either!(h, c => c.commit(point.x1(), point.x2(), point.lambda(), point.sums()))
    })
}

/// Whether `stickslip_interface_commit` would accept the step: STICKSLIP_OK, or its refusal; nothing changes. For hosts that commit several
/// interfaces, or parts on several processes, or none: ask all of them, then commit.
///
/// Inputs x1, x2, lambda, sums as for the commit.
///
/// Errors: NULL_POINTER, NOT_FINITE, DEGENERATE_FACET, PROJECTION_NOT_CONVEX, UNDEFINED_NORMAL, INVALID_VALUE, TURNED_TOO_FAR,
/// CONTACT_LOST, each as `stickslip_interface_commit` has it.
/// Cost: as `stickslip_interface_commit`; the evaluation or commit that follows integrates. Allocates.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_commit_check(
    interface: *mut stickslip_interface,
    x1: *const f64,
    x2: *const f64,
    lambda: *const f64,
    sums: *const f64,
) -> i32 {
    guard(|| {
        let h = &mut handle(interface)?.inner;
        let point = Point::read(h, x1, x2, lambda, sums)?;
        either!(h, c => c.check_commit(point.x1(), point.x2(), point.lambda(), point.sums()))
    })
}

/// Undoes the last commit exactly. A step that was never committed needs no rollback: evaluations do not
/// touch the history. Only one commit can be undone.
///
/// Errors: NULL_POINTER, NOTHING_TO_ROLL_BACK.
/// Cost: O(facets); the next evaluation integrates. Allocates.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_rollback(interface: *mut stickslip_interface) -> i32 {
    guard(|| either!(&mut handle(interface)?.inner, c => c.roll_back()))
}

/// Lengths of the flat arrays that hold the history now; they change with each commit.
///
/// n_integers, n_reals, output.
///
/// Errors: NULL_POINTER; where the weights of t_n were left out because the surfaces were apart, those of the commit,
/// INVALID_VALUE (mortar facets on each other) among them.
/// Cost: none, or then one search and one integration.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_history_size(
    interface: *mut stickslip_interface,
    n_integers: *mut i64,
    n_reals: *mut i64,
) -> i32 {
    guard(|| {
        let h = handle(interface)?;
        raw::check(n_integers, "n_integers")?;
        raw::check(n_reals, "n_reals")?;
        let (i, r) = either!(&mut h.inner, c => c.history_size()?);
        raw::write(n_integers, &[i as i64]);
        raw::write(n_reals, &[r as i64]);
        Ok(())
    })
}

/// Writes the history to integers (n_integers) and reals (n_reals), for a restart file. Lengths from
/// `stickslip_interface_history_size`; larger ones are fine. The multipliers are the host's and not in it.
///
/// Errors: NULL_POINTER, BUFFER_TOO_SMALL, and those of `stickslip_interface_history_size`.
/// Cost: a copy, after what `stickslip_interface_history_size` costs; allocates it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_history_export(
    interface: *mut stickslip_interface,
    n_integers: i64,
    integers: *mut i64,
    n_reals: i64,
    reals: *mut f64,
) -> i32 {
    guard(|| {
        let h = handle(interface)?;
        raw::check(integers, "integers")?;
        raw::check(reals, "reals")?;
        let needed = either!(&mut h.inner, c => c.history_size()?);
        for (name, given, needed) in [("n_integers", n_integers, needed.0), ("n_reals", n_reals, needed.1)] {
            if given < needed as i64 {
                return Err(Error::new(Kind::BufferTooSmall, text!("{name} is {given}; the history needs {needed}")));
            }
        }
        let (i, r) = either!(&mut h.inner, c => c.export_history()?);
        raw::write(integers, &i);
        raw::write(reals, &r);
        Ok(())
    })
}

/// Replaces the history by an exported one of the same surfaces, integers (n_integers) and reals (n_reals) of
/// the lengths that it had then; evaluation continues bit for bit. A commit before it can no longer be undone.
/// Friction, augmentation, normals and constraints per node are not in it.
///
/// Errors: NULL_POINTER, INVALID_SIZE, NOT_FINITE, HISTORY_MISMATCH: its checksum does not fit (any single bit that has
/// changed shows), or it is of other facets, of coordinates of the first configuration that differ in any digit, of
/// another kind of law, multiplier basis, decision, weights, slip measure or analytic shape, or of an older layout. mu,
/// augmentation, tolerances and the form may be others.
/// Cost: O(pairs) and a copy; the next evaluation integrates. Allocates.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_history_import(
    interface: *mut stickslip_interface,
    n_integers: i64,
    integers: *const i64,
    n_reals: i64,
    reals: *const f64,
) -> i32 {
    guard(|| {
        let h = handle(interface)?;
        let integers = raw::slice(integers, raw::count(n_integers, 0, "n_integers")?, "integers")?;
        let reals = raw::slice(reals, raw::count(n_reals, 0, "n_reals")?, "reals")?;
        either!(&mut h.inner, c => c.import_history(integers, reals))
    })
}
