//! General contact: the whole skin of all bodies in one handle. Creation and evaluation.

use super::choice::choose;
use super::equilibrium::{equilibrium_of, read_scales, stickslip_equilibrium};
use super::evaluation::{check_states, stickslip_states};
use super::guard::{guard, refuse_within_a_law};
use super::options::{Choices, read_options, stickslip_options};
use super::plan::Index;
use super::surface::{read_equations, read_facets, refuse_multipliers, stickslip_surface};
use super::{raw, sized};
use crate::error::{Error, Kind, Result};
use crate::features;
use crate::geometry::Vec3;
use crate::interface::NO_EQUATION;
use crate::memory::{self, Store, Stored};
use crate::mortar::MultiplierSpace;
use crate::skin::{Between, Given, OfCopy, Skin};

/// General contact: the skin of all bodies, each of which may touch every other one and itself. Created and destroyed by the
/// library; one thread at a time.
pub struct stickslip_skin {
    pub(super) inner: Skin,
    pub(super) base: i64,
}

/// Of `stickslip_skin_set_pair` in place of mu: the two bodies do not see each other.
pub const STICKSLIP_SKIN_APART: f64 = -1.0;

/// The handle behind a pointer. Who calls it asks for the feature first: behind a `Result` of this one all would be compiled.
pub(super) fn skin_of<'a>(p: *mut stickslip_skin) -> Result<&'a mut stickslip_skin> {
    raw::check(p, "skin")?;
    refuse_within_a_law()?;
    // SAFETY: non-null and aligned; by the caller's contract it came from create, is not destroyed, and
    // is used by this thread alone.
    Ok(unsafe { &mut *p })
}

impl stickslip_skin {
    /// `n` vectors of the caller's.
    pub(super) fn vectors(&self, p: *const f64, n: usize, name: &str) -> Result<Vec<Vec3>> {
        let per = self.inner.whole().components();
        let values = raw::numbers(p, per * n, name)?;
        let vector = |v: &[f64]| Vec3::new(v[0], v[1], v.get(2).copied().unwrap_or(0.0));
        values.chunks_exact(per).map(vector).stored()
    }

    /// Positions of the host's nodes.
    pub(super) fn positions(&self, x: *const f64) -> Result<Vec<Vec3>> {
        self.vectors(x, self.inner.whole().nodes, "x")
    }

    /// Multipliers of the copies.
    pub(super) fn multipliers(&self, lambda: *const f64) -> Result<Vec<Vec3>> {
        self.vectors(lambda, self.inner.whole().copies(), "lambda")
    }

    /// Writes vectors to the caller.
    pub(super) fn write(&self, p: *mut f64, vectors: &[Vec3], name: &str) -> Result<()> {
        let per = self.inner.whole().components();
        check_vectors(vectors, name)?;
        raw::write_each(p, vectors.iter().flat_map(|v| v.iter().copied().take(per)));
        Ok(())
    }
}

/// Refuses results that left the range of doubles.
fn check_vectors(vectors: &[Vec3], name: &str) -> Result<()> {
    if vectors.iter().all(|v| v.iter().all(|v| v.is_finite())) { Ok(()) } else { raw::overflow(name) }
}

/// Creates general contact over a skin, whose coordinates are the first configuration and t_0. No pairs and no sides are named: at
/// each commit the library finds which facets may touch, gives them sides, and makes interfaces of them (docs/general_contact.md).
///
/// surface: all outer facets of all bodies, seen from outside; equations as of an interface (-1 where prescribed);
/// multiplier_equations and owned are NULL. Leave out cuts on planes of symmetry, and faces whose normal is a direction of
/// `stickslip_skin_set_constraints`. bodies (n_facets): the number of each facet's body, whatever numbers; NULL: facets that hang
/// together by nodes are one body, numbered from 0. A body whose skin falls apart, by a cavity or a cut that is left out, needs its number:
/// its walls are told by it. first_multiplier: the equation
/// of the first multiplier, in the index base; all others follow it, so many as `stickslip_skin_copies` says.
/// options: as of an interface; search_distance is how far the skin looks for partners (0: half of a facet, and twice the largest
/// motion of the last step), mortar_side is DEFORMABLE; with FRICTION_NONE multipliers are vectors all the same. Not TIED.
/// out, output: the handle.
///
/// The skin is cut at edges sharper than 40 degrees: nodes there get a copy for each side, with multipliers of its own.
///
/// Errors: NULL_POINTER, STRUCT_SIZE, INVALID_SIZE, NOT_FINITE, INDEX_OUT_OF_RANGE, DUPLICATE_NODE, DEGENERATE_FACET, INVALID_VALUE
/// (as `stickslip_interface_create`; multipliers' equations that are those of displacements), MISSING_STIFFNESS, UNSUPPORTED,
/// UNDEFINED_NORMAL, PROJECTION_NOT_CONVEX.
/// Cost: O(n log n) and those of the interfaces; allocates.
/// Owner: the caller, who ends it with `stickslip_skin_destroy`. All arrays may be freed after the call.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_skin_create(
    surface: *const stickslip_surface,
    bodies: *const i64,
    first_multiplier: i64,
    options: *const stickslip_options,
    out: *mut *mut stickslip_skin,
) -> i32 {
    guard(|| {
        features::needs!(SKIN);
        raw::check(surface, "surface")?;
        raw::check(options, "options")?;
        raw::check(out, "out")?;
        let Choices { options, base, shape, measure } = read_options(options)?;
        let surface = sized::read(surface)?;
        refuse_multipliers(&surface, "surface")?;
        if shape.is_some() {
            let text = "options.mortar_side is STICKSLIP_MORTAR_ANALYTIC; a skin has facets on both sides: STICKSLIP_MORTAR_DEFORMABLE";
            return Err(Error::new(Kind::Unsupported, text));
        }
        let (x, facets) = read_facets(&surface, base, "surface", measure.is_some())?;
        let per = if measure.is_some() { 2 } else { 3 };
        let equations = read_equations(surface.equations, x.len(), (base, per), "surface.equations")?;
        let bodies = match bodies.is_null() {
            true => None,
            false => Some(memory::copied(raw::slice(bodies, facets.len(), "bodies")?)?),
        };
        if first_multiplier < base {
            let text = text!("first_multiplier is {first_multiplier}; at least {base} is allowed");
            return Err(Error::new(Kind::InvalidValue, text));
        }
        let first = first_multiplier - base;
        let all_nodes = options.space == MultiplierSpace::Sub;
        let given = Given { x, facets, equations, bodies, first, measure, all_nodes };
        let inner = Skin::new(given, options)?;
        raw::write(out, &[raw::owned(stickslip_skin { inner, base })?]);
        Ok(())
    })
}

/// Destroys the skin and sets the caller's pointer to NULL. NULL, or a pointer to NULL, is fine.
///
/// Errors: NULL_POINTER (misaligned).
/// Cost: frees memory.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_skin_destroy(skin: *mut *mut stickslip_skin) -> i32 {
    guard(|| {
        if skin.is_null() {
            return Ok(());
        }
        raw::check(skin, "skin")?;
        refuse_within_a_law()?;
        // SAFETY: non-null and aligned.
        let handle = unsafe { skin.read() };
        if handle.is_null() {
            return Ok(());
        }
        raw::check(handle, "skin")?;
        raw::write(skin, &[std::ptr::null_mut()]);
        // SAFETY: non-null and aligned; it came from create and is destroyed once.
        drop(unsafe { Box::from_raw(handle) });
        Ok(())
    })
}

/// The copies of a skin's nodes, which have the multipliers; they stay for good. Node k is copy k; further ones come behind.
///
/// capacity: how many copies there is room for; outputs, both NULL to only count: originals (copies), the node that each is a copy
/// of; equations (3 copies; of lines 2), its multipliers', -1 where it has none (mid nodes of quadratic facets). Both in the index
/// base. count: copies; multipliers: how many equations they have, one after the other from first_multiplier.
///
/// Errors: NULL_POINTER, BUFFER_TOO_SMALL.
/// Cost: a copy.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_skin_copies(
    skin: *mut stickslip_skin,
    capacity: i64,
    originals: *mut i64,
    equations: *mut i64,
    count: *mut i64,
    multipliers: *mut i64,
) -> i32 {
    guard(|| {
        features::needs!(SKIN);
        let h = skin_of(skin)?;
        raw::check(count, "count")?;
        raw::check(multipliers, "multipliers")?;
        let (whole, base) = (h.inner.whole(), h.base);
        let per = whole.components();
        let all = || whole.multipliers.iter().flat_map(|e| e.iter().copied().take(per));
        if !raw::only_counts(&[(originals.cast_const(), "originals"), (equations.cast_const(), "equations")])? {
            raw::room(capacity, whole.copies(), "the copies")?;
            raw::write_each(originals, whole.originals.iter().map(|&a| a as i64 + base));
            raw::write_each(equations, all().map(|e| if e == NO_EQUATION { e } else { e + base }));
        }
        raw::write(count, &[whole.copies() as i64]);
        raw::write(multipliers, &[all().filter(|&e| e != NO_EQUATION).count() as i64]);
        Ok(())
    })
}

/// Says what there is between two bodies, or within one (twice the same number), from now on: friction mu >= 0, or
/// STICKSLIP_SKIN_APART, they do not see each other. The last word of two bodies counts. Not part of the history.
///
/// body1, body2: numbers as the host gave them, or found by the library. Pieces are made anew at t_n: make the plan again.
///
/// Errors: NULL_POINTER, NOT_FINITE, INVALID_VALUE (mu; no such body), and those of `stickslip_skin_commit`.
/// Cost: a search, and new interfaces.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_skin_set_pair(skin: *mut stickslip_skin, body1: i64, body2: i64, mu: f64) -> i32 {
    guard(|| {
        features::needs!(SKIN);
        let h = skin_of(skin)?;
        let place = |body: i64, name: &str| {
            let found = h.inner.whole().body_keys.iter().position(|&key| key == body);
            found.ok_or_else(|| Error::new(Kind::InvalidValue, text!("{name} is {body}; no facet is of this body")))
        };
        let bodies = [place(body1, "body1")?, place(body2, "body2")?];
        let between = if mu == STICKSLIP_SKIN_APART { Between::Nothing } else { Between::Friction(mu) };
        h.inner.set_between(bodies, between)
    })
}

/// Directions in which displacement is prescribed on both sides of a contact (plane strain, symmetry planes), as
/// `stickslip_interface_set_constraints`, for every copy of the nodes. Replaces all earlier ones; n = 0 clears.
///
/// nodes (n): of the host, in the index base, a node up to twice; directions (3 n; of lines 2 n) [-].
///
/// Errors: NULL_POINTER, INVALID_SIZE, NOT_FINITE, INDEX_OUT_OF_RANGE, INVALID_VALUE, UNDEFINED_NORMAL.
/// Cost: O(pieces' nodes times n); allocates.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_skin_set_constraints(
    skin: *mut stickslip_skin,
    n: i64,
    nodes: *const i64,
    directions: *const f64,
) -> i32 {
    guard(|| {
        features::needs!(SKIN);
        let h = skin_of(skin)?;
        let (n, mut list) = (raw::count(n, 0, "n")?, Vec::new());
        if n > 0 {
            let (nodes, directions) = (raw::slice(nodes, n, "nodes")?, h.vectors(directions, n, "directions")?);
            for (k, (&node, direction)) in nodes.iter().zip(directions).enumerate() {
                let place = node.checked_sub(h.base).and_then(|node| usize::try_from(node).ok());
                let Some(place) = place.filter(|&place| place < h.inner.whole().nodes) else {
                    return Err(Error::new(
                        Kind::IndexOutOfRange,
                        text!("nodes[{k}] is {node}; there is no such node"),
                    ));
                };
                list.store((place, direction))?;
            }
        }
        h.inner.set_constraints(list)
    })
}

/// Writes multipliers to start the first step with: a slight compression where facets touch, as
/// `stickslip_interface_initial_multipliers`.
///
/// lambda (3 copies; of lines 2), output [F/L^2]; from then on it is the host's unknown.
///
/// Errors: NULL_POINTER, NOT_FINITE (overflow), INVALID_VALUE (a step is committed).
/// Cost: O(n); allocates.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_skin_initial_multipliers(skin: *mut stickslip_skin, lambda: *mut f64) -> i32 {
    guard(|| {
        features::needs!(SKIN);
        let h = skin_of(skin)?;
        raw::check(lambda, "lambda")?;
        let values = h.inner.initial_multipliers()?;
        h.write(lambda, &values, "lambda")
    })
}

/// Residual in internal-force sign, as `stickslip_interface_residual`, which is what to ADD to the host's internal forces.
///
/// x (3 nodes): positions [L]; lambda (3 copies) [F/L^2]; of lines 2 in place of 3. Outputs, overwritten: force (3 nodes) [F],
/// rows (3 copies): the multipliers' rows; of a copy that touches nothing minus its area times lambda.
///
/// Errors: NULL_POINTER, NOT_FINITE, DEGENERATE_FACET, PROJECTION_NOT_CONVEX, UNDEFINED_NORMAL; within Newton take a smaller step.
/// Cost: that of the interfaces. Allocates.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_skin_residual(
    skin: *mut stickslip_skin,
    x: *const f64,
    lambda: *const f64,
    force: *mut f64,
    rows: *mut f64,
) -> i32 {
    guard(|| {
        features::needs!(SKIN);
        let h = skin_of(skin)?;
        let (x, lambda) = (h.positions(x)?, h.multipliers(lambda)?);
        raw::check(force, "force")?;
        raw::check(rows, "rows")?;
        let found = h.inner.residual(&x, &lambda)?;
        check_vectors(&found.forces, "force")?;
        check_vectors(&found.rows, "rows")?;
        h.write(force, &found.forces, "force")?;
        h.write(rows, &found.rows, "rows")
    })
}

/// Makes the plan of the tangent: its entries and where they go. Make it again when values are refused with MISSING_ENTRY: where
/// what may touch has changed at a commit, and where surfaces have slid.
///
/// x (3 nodes): positions [L]; pairs: STICKSLIP_PLAN_ACTIVE or STICKSLIP_PLAN_SKIN. count, output: entries. Interfaces that meet
/// at a node have entries of the same row and column: add them up, as PETSc's MatSetValuesCOO does.
///
/// Errors: NULL_POINTER, NOT_FINITE, INVALID_VALUE (pairs), DEGENERATE_FACET, PROJECTION_NOT_CONVEX, UNDEFINED_NORMAL.
/// Cost: as `stickslip_interface_plan`. Allocates.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_skin_plan(
    skin: *mut stickslip_skin,
    x: *const f64,
    pairs: i32,
    count: *mut i64,
) -> i32 {
    guard(|| {
        features::needs!(SKIN);
        let h = skin_of(skin)?;
        let x = h.positions(x)?;
        raw::check(count, "count")?;
        // With sums of several handles there is none.
        let Some(possible) = choose(pairs, "pairs", &[Some(false), None, Some(true)], 3)? else {
            let text = "pairs is STICKSLIP_PLAN_ACTIVE_SUMS; STICKSLIP_PLAN_ACTIVE and _SKIN are allowed";
            return Err(Error::new(Kind::InvalidValue, text));
        };
        let entries = h.inner.make_plan(&x, possible)?;
        raw::write(count, &[entries as i64]);
        Ok(())
    })
}

fn coo<I: Index>(skin: *mut stickslip_skin, capacity: i64, rows: *mut I, columns: *mut I) -> Result<()> {
    features::needs!(SKIN);
    let h = skin_of(skin)?;
    raw::check(rows, "rows")?;
    raw::check(columns, "columns")?;
    raw::room(capacity, h.inner.plan_len()?, "the entries")?;
    let number = |e: i64| super::plan::index::<I>(e + h.base);
    h.inner.plan_entries(&mut |row, column| number(row).and(number(column)).map(|_| ()))?;
    let (mut to_rows, mut to_columns) = (raw::Output::new(rows), raw::Output::new(columns));
    h.inner.plan_entries(&mut |row, column| {
        to_rows.append(&[number(row)?]);
        to_columns.append(&[number(column)?]);
        Ok(())
    })
}

/// The entries of the plan as pairs of row and column, in the order of the values.
///
/// capacity: how many entries rows and columns have room for. Outputs, in the host's equations and index base: rows, columns.
///
/// Errors: NULL_POINTER, BUFFER_TOO_SMALL, MISSING_ENTRY (there is no plan of this step).
/// Cost: O(entries).
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_skin_plan_coo(
    skin: *mut stickslip_skin,
    capacity: i64,
    rows: *mut i64,
    columns: *mut i64,
) -> i32 {
    guard(|| coo(skin, capacity, rows, columns))
}

/// As `stickslip_skin_plan_coo`, in 32 bits: capacity; outputs rows, columns.
///
/// Errors: as there, and INDEX_OUT_OF_RANGE where a number does not fit.
/// Cost: O(entries).
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_skin_plan_coo32(
    skin: *mut stickslip_skin,
    capacity: i64,
    rows: *mut i32,
    columns: *mut i32,
) -> i32 {
    guard(|| coo(skin, capacity, rows, columns))
}

/// The exact tangent in the order of the plan's entries.
///
/// x, lambda as for `stickslip_skin_residual`; capacity: how many values there is room for. Output: values, overwritten. After
/// MISSING_ENTRY, OUT_OF_MEMORY and NOT_FINITE they mean nothing.
///
/// Errors: those of `stickslip_skin_residual`, BUFFER_TOO_SMALL, MISSING_ENTRY: make the plan again.
/// Cost: as `stickslip_interface_plan_values`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_skin_plan_values(
    skin: *mut stickslip_skin,
    x: *const f64,
    lambda: *const f64,
    capacity: i64,
    values: *mut f64,
) -> i32 {
    guard(|| {
        features::needs!(SKIN);
        let h = skin_of(skin)?;
        let (x, lambda) = (h.positions(x)?, h.multipliers(lambda)?);
        let n = h.inner.plan_len()?;
        raw::room(capacity, n, "the values")?;
        let values = raw::values(values, n, "values")?;
        h.inner.plan_values(&x, &lambda, values)
    })
}

/// State and results of every copy, as `stickslip_interface_states`; 0 of copies that can touch nothing in this step.
///
/// x (3 nodes) [L]; lambda (3 copies) [F/L^2]. out: its members point to the caller's arrays, with copies in place of n1.
///
/// Errors: as `stickslip_skin_residual`, and STRUCT_SIZE.
/// Cost: as `stickslip_skin_residual`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_skin_states(
    skin: *mut stickslip_skin,
    x: *const f64,
    lambda: *const f64,
    out: *const stickslip_states,
) -> i32 {
    guard(|| {
        features::needs!(SKIN);
        let h = skin_of(skin)?;
        let (x, lambda) = (h.positions(x)?, h.multipliers(lambda)?);
        let out = sized::read(out)?;
        check_states(&out)?;
        let all = h.inner.states(&x, &lambda)?;
        let numbers = [
            (out.gap, (|c| c.gap) as fn(&OfCopy) -> f64, "gap"),
            (out.coverage, |c| c.coverage, "coverage"),
            (out.area, |c| c.area, "area"),
            (out.dissipation, |c| c.dissipation, "dissipation"),
            (out.augmentation, |c| c.augmentation, "augmentation"),
            (out.share, |c| c.share, "share"),
        ];
        let vectors = [
            (out.normal, (|c| c.normal) as fn(&OfCopy) -> Vec3, "normal"),
            (out.traction, |c| c.traction, "traction"),
            (out.slip, |c| c.slip, "slip"),
        ];
        // All is looked at before anything is written.
        for (_, of, name) in numbers {
            if !all.iter().all(|c| of(c).is_finite()) {
                return raw::overflow(name);
            }
        }
        for (_, of, name) in vectors {
            if !all.iter().all(|c| of(c).iter().all(|v| v.is_finite())) {
                return raw::overflow(name);
            }
        }
        let per = h.inner.whole().components();
        numbers.into_iter().for_each(|(p, of, _)| raw::write_each(p, all.iter().map(of)));
        for (p, of, _) in vectors {
            raw::write_each(p, all.iter().map(of).flat_map(|v| <[f64; 3]>::from(v).into_iter().take(per)));
        }
        raw::write_each(out.state, all.iter().map(|c| c.state as i32));
        // A skin has no layer.
        for p in [out.worn, out.worn_volume, out.damage, out.bond_loss] {
            raw::write_each(p, all.iter().map(|_| 0.0));
        }
        Ok(())
    })
}

/// How far (x, lambda) is from contact equilibrium, as `stickslip_interface_equilibrium`; its nodes are copies.
///
/// x (3 nodes) [L]; lambda (3 copies) [F/L^2]. out, input and output: modulus and least_traction are read.
///
/// Errors: as `stickslip_skin_residual`, STRUCT_SIZE, INVALID_VALUE (modulus, least_traction).
/// Cost: as `stickslip_interface_equilibrium`, twice.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_skin_equilibrium(
    skin: *mut stickslip_skin,
    x: *const f64,
    lambda: *const f64,
    out: *mut stickslip_equilibrium,
) -> i32 {
    guard(|| {
        features::needs!(SKIN);
        let h = skin_of(skin)?;
        let (x, lambda) = (h.positions(x)?, h.multipliers(lambda)?);
        let (given, scales) = read_scales(out)?;
        let found = h.inner.equilibrium(&x, &lambda, &scales)?;
        sized::write(out, equilibrium_of(given, &found, h.base)?);
        Ok(())
    })
}

/// How much of a step of Newton's method may be taken, as `stickslip_interface_step_limit`.
///
/// x (3 nodes), dx (3 nodes) [L]; penetration: above 0 and at most 1 [-]; 0: the default. fraction, output.
///
/// Errors: NULL_POINTER, INVALID_VALUE (penetration), NOT_FINITE, and as `stickslip_interface_step_limit`.
/// Cost: as there.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_skin_step_limit(
    skin: *mut stickslip_skin,
    x: *const f64,
    dx: *const f64,
    penetration: f64,
    fraction: *mut f64,
) -> i32 {
    guard(|| {
        features::needs!(SKIN);
        let h = skin_of(skin)?;
        let (x, dx) = (h.positions(x)?, h.vectors(dx, h.inner.whole().nodes, "dx")?);
        raw::check(fraction, "fraction")?;
        let limit = h.inner.step_limit(&x, &dx, (penetration != 0.0).then_some(penetration))?;
        raw::write(fraction, &[limit]);
        Ok(())
    })
}
