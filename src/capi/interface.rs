//! The interface handle: creation and overrides.

use super::guard::{guard, refuse_within_a_law};
use super::handle::{Inner, components_of, either, flat, handle, sizes, stickslip_interface};
use super::options::{Choices, read_options, stickslip_options};
use super::point::{Point, vectors};
use super::surface::{
    read_analytic, read_multipliers, read_owners, read_surface, refuse_multipliers, stickslip_surface,
};
use super::{raw, sized};
use crate::error::{Error, Kind, Result};
use crate::geometry::Vec3;
use crate::interface::Contact;
use crate::memory::{self, Store, Stored};

/// Creates an interface between two surfaces, whose coordinates are the first configuration and t_0.
///
/// nonmortar has the multipliers, mortar is the other one. Take as nonmortar the side that stays covered, the smaller
/// one or the one that slides on the other; of two that do the softer, of equally soft ones the finer. Where that cannot
/// be, set `weak_coverage`.
/// options: see `stickslip_options`. out, output: the handle. Surfaces that do not face each other are no error; look
/// at `stickslip_interface_report` once, a facet order seen from inside the body is found that way. Nodes may share
/// displacement equations: see `stickslip_surface_split_creases`.
///
/// Errors: NULL_POINTER, STRUCT_SIZE, INVALID_SIZE, NOT_FINITE, INDEX_OUT_OF_RANGE, DUPLICATE_NODE,
/// DEGENERATE_FACET, INVALID_VALUE (an option; a node without a facet; neighbouring facets with opposite node
/// orders, a surface that branches or is folded; a mortar side given multipliers; a multiplier's equation that is that
/// of a displacement or of another multiplier; a frame that is too small for where
/// it is; mortar facets on each other, in one place), MISSING_STIFFNESS, UNSUPPORTED, UNDEFINED_NORMAL, PROJECTION_NOT_CONVEX.
/// Cost: one search, O((n1 + n2) log n2), and one integration of the pairs found; allocates.
/// Owner: the caller, who ends it with `stickslip_interface_destroy`. Both surfaces and the options are
/// copied: all arrays may be freed after the call.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_create(
    nonmortar: *const stickslip_surface,
    mortar: *const stickslip_surface,
    options: *const stickslip_options,
    out: *mut *mut stickslip_interface,
) -> i32 {
    guard(|| {
        raw::check(nonmortar, "nonmortar")?;
        raw::check(mortar, "mortar")?;
        raw::check(options, "options")?;
        raw::check(out, "out")?;
        let choices = read_options(options)?;
        let (one, two) = (sized::read(nonmortar)?, sized::read(mortar)?);
        refuse_multipliers(&two, "mortar")?;
        let owners = read_owners(&one)?;
        let base = choices.base;
        let mut inner = create_inner(&one, &two, choices)?;
        if let Some(owners) = owners {
            either!(&mut inner, c => c.set_owners(owners)?);
        }
        raw::write(out, &[raw::owned(stickslip_interface { inner, base })?]);
        Ok(())
    })
}

fn create_inner(one: &stickslip_surface, two: &stickslip_surface, choices: Choices) -> Result<Inner> {
    let Choices { options, base, shape, measure } = choices;
    let mortar = || match shape {
        Some(shape) => read_analytic(two, shape, base),
        None => read_surface(two, base, "mortar", measure),
    };
    let nonmortar = || read_surface(one, base, "nonmortar", measure);
    // The multipliers first: what is wrong with them is said first.
    if options.friction.law().multipliers == 1 {
        let equations = read_multipliers(one, base, 1)?;
        return Contact::frictionless(nonmortar()?, mortar()?, equations, options).map(Inner::One);
    }
    let equations = read_multipliers(one, base, if measure.is_some() { 2 } else { 3 })?;
    Contact::new(nonmortar()?, mortar()?, equations, options).map(Inner::Three)
}

/// Destroys the interface and sets the caller's pointer to NULL. NULL, or a pointer to NULL, is fine.
///
/// Errors: NULL_POINTER (misaligned).
/// Cost: frees memory.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_destroy(interface: *mut *mut stickslip_interface) -> i32 {
    guard(|| {
        if interface.is_null() {
            return Ok(());
        }
        raw::check(interface, "interface")?;
        refuse_within_a_law()?;
        // SAFETY: non-null and aligned.
        let handle = unsafe { interface.read() };
        if handle.is_null() {
            return Ok(());
        }
        raw::check(handle, "interface")?;
        raw::write(interface, &[std::ptr::null_mut()]);
        // SAFETY: non-null and aligned; it came from create and is destroyed once.
        drop(unsafe { Box::from_raw(handle) });
        Ok(())
    })
}

/// Coulomb coefficient >= 0 per non-mortar node, mu (n1) [-], in place of the options' one, from the next
/// evaluation on. Keeps the rule for newly covered nodes. Not part of the history: set it again after a restart.
///
/// Errors: NULL_POINTER, NOT_FINITE, INVALID_VALUE.
/// Cost: a copy; allocates it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_set_friction(interface: *mut stickslip_interface, mu: *const f64) -> i32 {
    guard(|| {
        let h = handle(interface)?;
        let mu = raw::numbers(mu, sizes(&h.inner).0, "mu")?;
        match &mut h.inner {
            Inner::Three(c) => c.set_friction(memory::copied(mu)?),
            Inner::One(_) => {
                let text = "interface has no friction: it was created with STICKSLIP_FRICTION_NONE";
                Err(Error::new(Kind::InvalidValue, text))
            }
        }
    })
}

/// Augmentation r_A > 0 per non-mortar node, r (n1) [F/L^5], in place of rhat_A / M_A; NULL returns to the
/// options. Not part of the history. The answer does not depend on it, except with STICKSLIP_DECISION_POINTS: r is then part of
/// the answer, by what vanishes with the facets' size.
///
/// Errors: NULL_POINTER, NOT_FINITE, INVALID_VALUE.
/// Cost: a copy; allocates it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_set_augmentation(
    interface: *mut stickslip_interface,
    r: *const f64,
) -> i32 {
    guard(|| {
        let h = handle(interface)?;
        let r = raw::optional_numbers(r, sizes(&h.inner).0, "r")?;
        either!(&mut h.inner, c => c.set_augmentation(r.map(memory::copied).transpose()?))
    })
}

/// Normals per non-mortar node, normals (3 n1), INTO the non-mortar body, of length 1 within 1e-10, in place of
/// the averaged ones of t_n, until set again; NULL returns to those. Not part of the history.
///
/// Errors: NULL_POINTER, NOT_FINITE, INVALID_VALUE, UNSUPPORTED (normals, where the options ask for those of now).
/// Cost: a copy; allocates it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_set_normals(
    interface: *mut stickslip_interface,
    normals: *const f64,
) -> i32 {
    guard(|| {
        let h = handle(interface)?;
        let n1 = sizes(&h.inner).0;
        let normals = match normals.is_null() {
            true => None,
            false => Some(raw::vectors(&vectors(&h.inner, normals, n1, "normals")?)?),
        };
        either!(&mut h.inner, c => c.set_normals(normals))
    })
}

/// Directions in which displacement is prescribed on both sides (plane strain, symmetry plane), or on
/// the non-mortar side against a rigid mortar side: the multiplier component there is removed and the
/// normal gets no part in it. Replaces all earlier ones; n = 0 clears. Not part of the history.
///
/// nodes (n): non-mortar node numbers in the index base, a node up to twice; directions (3 n) [-], any
/// length but 0. At a Dirichlet edge over a deformable mortar side do NOT declare the direction.
///
/// Errors: NULL_POINTER, INVALID_SIZE, NOT_FINITE, INDEX_OUT_OF_RANGE, INVALID_VALUE (no length, or a direction
/// given twice), UNDEFINED_NORMAL (nothing is left of a normal).
/// Cost: O(n1 + n); allocates.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_set_constraints(
    interface: *mut stickslip_interface,
    n: i64,
    nodes: *const i64,
    directions: *const f64,
) -> i32 {
    guard(|| {
        let h = handle(interface)?;
        let n = raw::count(n, 0, "n")?;
        if n == 0 {
            return either!(&mut h.inner, c => c.set_constraints(&[]));
        }
        let (nodes, directions) = (raw::slice(nodes, n, "nodes")?, vectors(&h.inner, directions, n, "directions")?);
        let n1 = sizes(&h.inner).0;
        let index = |k: i64| k.checked_sub(h.base).and_then(|k| usize::try_from(k).ok()).filter(|&k| k < n1);
        let mut list = memory::with_room(n)?;
        for (k, (&node, direction)) in nodes.iter().zip(raw::vectors(&directions)?).enumerate() {
            let Some(node) = index(node) else {
                let text = text!("nodes[{k}] is {node}; {} to {} are allowed", h.base, n1 as i64 - 1 + h.base);
                return Err(Error::new(Kind::IndexOutOfRange, text));
            };
            list.store((node, direction))?;
        }
        either!(&mut h.inner, c => c.set_constraints(&list))
    })
}

/// Takes (x1, x2), 3 n1 and 3 n2 [L], as the configuration of t_n with nothing slipped yet, in place of
/// the first configuration. A commit before it can no longer be undone.
///
/// Errors: NULL_POINTER, NOT_FINITE, DEGENERATE_FACET, PROJECTION_NOT_CONVEX, UNDEFINED_NORMAL, INVALID_VALUE
/// (mortar facets on each other, an analytic surface's frame).
/// Cost: one search and one integration; allocates.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_set_previous(
    interface: *mut stickslip_interface,
    x1: *const f64,
    x2: *const f64,
) -> i32 {
    guard(|| {
        let h = handle(interface)?;
        let point = Point::positions(&h.inner, x1, x2)?;
        either!(&mut h.inner, c => c.set_previous(point.x1(), point.x2()))
    })
}

/// Takes (x1, x2), 3 n1 and 3 n2 [L], as t_n, after `commits` commits, with the slip of every non-mortar node since the first
/// configuration: what other handles, of other parts of the interface, had committed there. For parallel hosts that share an
/// interface out anew: create handles of the new parts with the first configuration, then call this. Weights of the reference
/// and the first gaps of tied nodes are those of the creation. No commit can then be undone.
///
/// slip (3 n1) [L]: what `stickslip_interface_states` had after the commit; NULL: none. Interfaces that remember no slip
/// (tied, rough, without friction) ignore it. What a law remembers becomes 0; `stickslip_interface_set_law_states` afterwards.
///
/// Not with (UNSUPPORTED): points that decide (STICKSLIP_DECISION_POINTS) and friction.
///
/// Errors: NULL_POINTER, NOT_FINITE, DEGENERATE_FACET, PROJECTION_NOT_CONVEX, UNDEFINED_NORMAL, INVALID_VALUE (commits < 0,
/// mortar facets on each other, an analytic surface's frame), UNSUPPORTED.
/// Cost: one search and one integration; allocates.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_set_committed(
    interface: *mut stickslip_interface,
    x1: *const f64,
    x2: *const f64,
    slip: *const f64,
    commits: i64,
) -> i32 {
    guard(|| {
        let h = handle(interface)?;
        let point = Point::positions(&h.inner, x1, x2)?;
        let n1 = sizes(&h.inner).0;
        let slip = match slip.is_null() {
            true => memory::filled(Vec3::zeros(), n1)?,
            false => raw::vectors(&vectors(&h.inner, slip, n1, "slip")?)?,
        };
        either!(&mut h.inner, c => c.set_committed(point.x1(), point.x2(), &slip, commits))
    })
}

/// Writes multipliers to start the first step with: a slight compression, -1e-6 rhat_A h_A nu_A (h_A: see `modulus` of `stickslip_options`), on
/// covered closed nodes, 0 elsewhere. lambda = 0 at zero gap is a body without support.
///
/// lambda (3 n1), output [F/L^2]; from then on it is the host's unknown, the library keeps no copy.
///
/// Errors: NULL_POINTER, NOT_FINITE (overflow), UNDEFINED_NORMAL, INVALID_VALUE (a step is committed; or as
/// `stickslip_interface_sums`).
/// Cost: O(n1); allocates.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_initial_multipliers(
    interface: *mut stickslip_interface,
    lambda: *mut f64,
) -> i32 {
    guard(|| {
        let h = handle(interface)?;
        raw::check(lambda, "lambda")?;
        let values: Vec<f64> =
            either!(&mut h.inner, c => { let d = components_of(c); flat(&c.initial_multipliers()?, d).stored()? });
        raw::check_results("lambda", &values)?;
        raw::write(lambda, &values);
        Ok(())
    })
}
