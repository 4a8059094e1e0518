//! General contact: steps, history, and what the library has found.

use super::guard::guard;
use super::method::choose_normals;
use super::raw;
use super::sized::{self, Sized64};
use super::skin::{skin_of, stickslip_skin};
use crate::error::{Error, Kind};
use crate::features;
use crate::memory;

/// Side of a skin's facet: it can touch nothing in this step.
pub const STICKSLIP_SKIN_NONE: i32 = 0;
/// Side of a skin's facet: it has the multipliers.
pub const STICKSLIP_SKIN_NONMORTAR: i32 = 1;
/// Side of a skin's facet: it is what they act on.
pub const STICKSLIP_SKIN_MORTAR: i32 = 2;

/// Which normals evaluations of a skin use until the next commit, as `stickslip_interface_use_normals`, for the two phases of a
/// step.
///
/// normals: STICKSLIP_NORMALS_COMMITTED or _CURRENT.
///
/// Errors: NULL_POINTER, INVALID_VALUE.
/// Cost: none; the next evaluation begins anew.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_skin_use_normals(skin: *mut stickslip_skin, normals: i32) -> i32 {
    guard(|| {
        features::needs!(SKIN);
        let h = skin_of(skin)?;
        let Some(normals) = choose_normals(normals, "normals")? else {
            let text = "normals is STICKSLIP_NORMALS_AUTO; STICKSLIP_NORMALS_COMMITTED and _CURRENT are allowed";
            return Err(Error::new(Kind::InvalidValue, text));
        };
        h.inner.use_normals(normals)
    })
}

/// Turns multipliers as the skin turns from t_n to x, as `stickslip_interface_turn_multipliers`.
///
/// x (3 nodes) [L]; lambda (3 copies) [F/L^2]: those of t_n, in and out.
///
/// Errors: NULL_POINTER, NOT_FINITE, UNDEFINED_NORMAL.
/// Cost: O(n); allocates.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_skin_turn_multipliers(
    skin: *mut stickslip_skin,
    x: *const f64,
    lambda: *mut f64,
) -> i32 {
    guard(|| {
        features::needs!(SKIN);
        let h = skin_of(skin)?;
        let (x, mut turned) = (h.positions(x)?, h.multipliers(lambda)?);
        h.inner.turn_multipliers(&x, &mut turned)?;
        h.write(lambda, &turned, "lambda")
    })
}

/// Accepts a converged step: (x, lambda) becomes t_n. The library looks anew which facets may touch; interfaces that serve no more
/// are replaced, slips stay with their nodes. Make the plan again where values are refused with MISSING_ENTRY.
///
/// x (3 nodes) [L]; lambda (3 copies) [F/L^2], in and out: 0 of copies that can touch nothing any more, minus that of the nearest
/// node of the other side where facets in contact exchange their sides.
///
/// Errors: those of `stickslip_interface_commit`; CONTACT_LOST also where facets have met within the step that were out of reach
/// at its start. The skin looks for them then: solve the same step again from t_n, with a new plan, or a smaller one. Without
/// this a body would pass through another one without a word. No commit can be undone after such a refusal; after all others
/// nothing has moved.
/// Cost: two searches over the skin, O(n log n); of interfaces that are replaced those of their creation. Allocates.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_skin_commit(skin: *mut stickslip_skin, x: *const f64, lambda: *mut f64) -> i32 {
    guard(|| {
        features::needs!(SKIN);
        let h = skin_of(skin)?;
        let (x, mut values) = (h.positions(x)?, h.multipliers(lambda)?);
        h.inner.commit(&x, &mut values)?;
        h.write(lambda, &values, "lambda")
    })
}

/// Exchanges the sides of all facets at t_n, for a step that fails however small it is: whether Newton's method converges may
/// depend on the side that has the multipliers. Slips stay. Make the plan again, and solve the step once more from t_n.
///
/// lambda (3 copies) [F/L^2]: those of t_n, in and out: copies that take over have minus that of the nearest node of the other side.
///
/// Errors: NULL_POINTER, NOT_FINITE, and those of `stickslip_skin_create`. No commit can be undone after it.
/// Cost: that of the interfaces' creation. Allocates.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_skin_exchange(skin: *mut stickslip_skin, lambda: *mut f64) -> i32 {
    guard(|| {
        let h = skin_of(skin)?;
        let mut values = h.multipliers(lambda)?;
        h.inner.exchange(&mut values)?;
        h.write(lambda, &values, "lambda")
    })
}

/// Undoes the last commit exactly; the host takes its multipliers of then. Only one can be undone. Make the plan again.
///
/// Errors: NULL_POINTER, NOTHING_TO_ROLL_BACK.
/// Cost: O(facets). Allocates.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_skin_rollback(skin: *mut stickslip_skin) -> i32 {
    guard(|| {
        features::needs!(SKIN);
        skin_of(skin)?.inner.roll_back()
    })
}

/// Lengths of the flat arrays that hold the history now; they change with each commit.
///
/// n_integers, n_reals, output.
///
/// Errors: NULL_POINTER; those of `stickslip_interface_history_size`.
/// Cost: that of the export.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_skin_history_size(
    skin: *mut stickslip_skin,
    n_integers: *mut i64,
    n_reals: *mut i64,
) -> i32 {
    guard(|| {
        features::needs!(SKIN);
        let h = skin_of(skin)?;
        raw::check(n_integers, "n_integers")?;
        raw::check(n_reals, "n_reals")?;
        let (integers, reals) = h.inner.export_history()?;
        raw::write(n_integers, &[integers.len() as i64]);
        raw::write(n_reals, &[reals.len() as i64]);
        Ok(())
    })
}

/// Writes the history to integers (n_integers) and reals (n_reals), for a restart file. The multipliers are the host's, and what
/// `stickslip_skin_set_pair` and `stickslip_skin_set_constraints` said: say it again before the import.
///
/// Errors: NULL_POINTER, BUFFER_TOO_SMALL, and those of `stickslip_skin_history_size`.
/// Cost: a copy; allocates it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_skin_history_export(
    skin: *mut stickslip_skin,
    n_integers: i64,
    integers: *mut i64,
    n_reals: i64,
    reals: *mut f64,
) -> i32 {
    guard(|| {
        features::needs!(SKIN);
        let h = skin_of(skin)?;
        raw::check(integers, "integers")?;
        raw::check(reals, "reals")?;
        let (i, r) = h.inner.export_history()?;
        for (name, given, needed) in [("n_integers", n_integers, i.len()), ("n_reals", n_reals, r.len())] {
            if given < needed as i64 {
                return Err(Error::new(Kind::BufferTooSmall, text!("{name} is {given}; the history needs {needed}")));
            }
        }
        raw::write(integers, &i);
        raw::write(reals, &r);
        Ok(())
    })
}

/// Replaces the history by an exported one of the same skin, integers (n_integers) and reals (n_reals); evaluation continues bit
/// for bit. Make the plan again. No commit can then be undone.
///
/// Errors: NULL_POINTER, INVALID_SIZE, NOT_FINITE, HISTORY_MISMATCH.
/// Cost: that of the interfaces' creation. Allocates.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_skin_history_import(
    skin: *mut stickslip_skin,
    n_integers: i64,
    integers: *const i64,
    n_reals: i64,
    reals: *const f64,
) -> i32 {
    guard(|| {
        features::needs!(SKIN);
        let h = skin_of(skin)?;
        let integers = raw::slice(integers, raw::count(n_integers, 0, "n_integers")?, "integers")?;
        let reals = raw::numbers(reals, raw::count(n_reals, 0, "n_reals")?, "reals")?;
        h.inner.import_history(integers, reals)
    })
}

/// What `stickslip_skin_facets` tells of each facet; a NULL member is not wanted.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct stickslip_skin_sides {
    /// sizeof(stickslip_skin_sides).
    pub struct_size: u64,
    /// n_facets: STICKSLIP_SKIN_NONE, _NONMORTAR, _MORTAR.
    pub side: *mut i32,
    /// n_facets: the piece of a non-mortar facet, from 0; -1 of the others.
    pub piece: *mut i64,
    /// n_facets: the nearest facet that it may touch, in the index base; -1: none.
    pub partner: *mut i64,
    /// n_facets: how far apart the two are at t_n, between their centres along the normals; negative: in each other; 0 without a
    /// partner [L].
    pub distance: *mut f64,
    /// n_facets: the number of its body.
    pub body: *mut i64,
}

// SAFETY: repr(C), struct_size first, raw pointers only.
unsafe impl Sized64 for stickslip_skin_sides {
    const NAME: &'static str = "stickslip_skin_sides";
    const FIRST: usize = 48;
}

/// Who may touch whom in this step, facet by facet: for pictures, and to see what the library has chosen.
///
/// out: its members point to the caller's arrays, which are filled.
///
/// Errors: NULL_POINTER, STRUCT_SIZE.
/// Cost: O(facets + pairs); allocates.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_skin_facets(skin: *mut stickslip_skin, out: *const stickslip_skin_sides) -> i32 {
    guard(|| {
        features::needs!(SKIN);
        let h = skin_of(skin)?;
        let out = sized::read(out)?;
        raw::check_optional(out.side, "stickslip_skin_sides.side")?;
        raw::check_optional(out.piece, "stickslip_skin_sides.piece")?;
        raw::check_optional(out.partner, "stickslip_skin_sides.partner")?;
        raw::check_optional(out.distance, "stickslip_skin_sides.distance")?;
        raw::check_optional(out.body, "stickslip_skin_sides.body")?;
        let (whole, pieces) = (h.inner.whole(), h.inner.piece_of_facets()?);
        let mut nearest = memory::filled((-1_i64, 0.0_f64), whole.facets())?;
        for pair in h.inner.near().iter().filter(|pair| !pair.under) {
            let [f, g] = pair.facets;
            for (own, other) in [(f, g), (g, f)] {
                if nearest[own].0 < 0 || pair.distance < nearest[own].1 {
                    nearest[own] = (other as i64 + h.base, pair.distance);
                }
            }
        }
        raw::write_each(out.side, h.inner.roles().iter().map(|&role| role as i32));
        raw::write_each(out.piece, pieces.iter().map(|piece| piece.map_or(-1, |p| p as i64)));
        raw::write_each(out.partner, nearest.iter().map(|n| n.0));
        raw::write_each(out.distance, nearest.iter().map(|n| n.1));
        raw::write_each(out.body, whole.bodies.iter().map(|&b| whole.body_keys[b]));
        Ok(())
    })
}

/// What a skin has found and done.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct stickslip_skin_summary {
    /// sizeof(stickslip_skin_summary).
    pub struct_size: u64,
    /// Bodies.
    pub bodies: i64,
    /// Pieces: interfaces of this step.
    pub pieces: i64,
    /// Pairs of facets that may touch in this step.
    pub pairs: i64,
    /// Pairs that could not be put on different sides, in odd rings of five facets or more, and are left out: never the nearest of
    /// the ring.
    pub contradictions: i64,
    /// Interfaces made since creation.
    pub made: i64,
    /// Facets in contact that have exchanged their side since creation.
    pub exchanged: i64,
    /// Steps that were refused since creation because facets met that were out of reach.
    pub missed: i64,
}

// SAFETY: repr(C), struct_size first, numbers only.
unsafe impl Sized64 for stickslip_skin_summary {
    const NAME: &'static str = "stickslip_skin_summary";
    const FIRST: usize = 64;
}

/// What a skin has found in this step, and done since its creation.
///
/// out, output.
///
/// Errors: NULL_POINTER, STRUCT_SIZE.
/// Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_skin_report(skin: *mut stickslip_skin, out: *mut stickslip_skin_summary) -> i32 {
    guard(|| {
        features::needs!(SKIN);
        let h = skin_of(skin)?;
        sized::check_output(out)?;
        let counts = h.inner.counts();
        sized::write(
            out,
            stickslip_skin_summary {
                struct_size: 0,
                bodies: h.inner.whole().body_keys.len() as i64,
                pieces: h.inner.pieces() as i64,
                pairs: h.inner.near().len() as i64,
                contradictions: h.inner.contradictions() as i64,
                made: counts.made,
                exchanged: counts.exchanged,
                missed: counts.missed,
            },
        );
        Ok(())
    })
}
