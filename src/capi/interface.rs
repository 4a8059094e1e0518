//! The interface handle: creation, overrides, evaluation, history.

use super::guard::guard;
use super::options::{read_options, stickslip_options};
use super::raw::{self, Sized64};
use super::surface::{read_multipliers, read_surface, stickslip_surface};
use crate::error::{Error, Kind, Result};
use crate::geometry::Vec3;
use crate::interface::{Interface, NodeSums};

/// Reals per node of `stickslip_interface_sums`.
pub const STICKSLIP_SUMS_PER_NODE: i32 = 11;

/// A contact interface. Created and destroyed by the library; one thread at a time.
pub struct stickslip_interface {
    pub(super) inner: Interface,
    pub(super) base: i64,
}

/// The handle behind a pointer.
pub(super) fn handle<'a>(p: *mut stickslip_interface) -> Result<&'a mut stickslip_interface> {
    raw::check(p, "interface")?;
    // SAFETY: non-null and aligned; by the caller's contract it came from create, is not destroyed, and
    // is used by this thread alone.
    Ok(unsafe { &mut *p })
}

/// Where an evaluation takes place, read from the caller's arrays.
pub(super) struct Point {
    pub x1: Vec<Vec3>,
    pub x2: Vec<Vec3>,
    pub lambda: Vec<Vec3>,
    sums: Option<Vec<NodeSums>>,
}

impl Point {
    /// Positions alone.
    pub fn positions(interface: &Interface, x1: *const f64, x2: *const f64) -> Result<Point> {
        let (n1, n2) = sizes(interface);
        Ok(Point {
            x1: raw::vectors(raw::numbers(x1, 3 * n1, "x1")?),
            x2: raw::vectors(raw::numbers(x2, 3 * n2, "x2")?),
            lambda: Vec::new(),
            sums: None,
        })
    }

    /// Positions, multipliers and, if given, sums.
    pub fn read(
        interface: &Interface,
        x1: *const f64,
        x2: *const f64,
        lambda: *const f64,
        sums: *const f64,
    ) -> Result<Point> {
        let n1 = sizes(interface).0;
        let mut point = Point::positions(interface, x1, x2)?;
        point.lambda = raw::vectors(raw::numbers(lambda, 3 * n1, "lambda")?);
        let per_node = STICKSLIP_SUMS_PER_NODE as usize;
        if let Some(values) = raw::optional_numbers(sums, per_node * n1, "sums")? {
            let read = |s: &[f64]| NodeSums {
                coverage: s[0],
                gap_now: Vec3::from_column_slice(&s[1..4]),
                coverage_previous: s[4],
                gap_previous: Vec3::from_column_slice(&s[5..8]),
                gap_committed: Vec3::from_column_slice(&s[8..11]),
            };
            point.sums = Some(values.chunks_exact(per_node).map(read).collect());
        }
        Ok(point)
    }

    pub fn sums(&self) -> Option<&[NodeSums]> {
        self.sums.as_deref()
    }
}

fn sizes(interface: &Interface) -> (usize, usize) {
    let (one, two) = interface.surfaces();
    (one.len(), two.len())
}

fn flat(v: &[Vec3]) -> impl Iterator<Item = f64> {
    v.iter().flat_map(|v| [v.x, v.y, v.z])
}

/// Creates an interface between two surfaces, whose coordinates are the first configuration and t_0.
///
/// out receives the handle; destroy it with `stickslip_interface_destroy`. Both surfaces are copied.
/// Errors: NULL_POINTER, STRUCT_SIZE, INVALID_SIZE, NOT_FINITE, INDEX_OUT_OF_RANGE, DUPLICATE_NODE,
/// DEGENERATE_FACET, INVALID_VALUE, MISSING_STIFFNESS, UNSUPPORTED, UNDEFINED_NORMAL,
/// PROJECTION_NOT_CONVEX. Cost: one search and one integration.
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
        let (options, base) = read_options(options)?;
        let (one, two) = (raw::read(nonmortar)?, raw::read(mortar)?);
        let (multipliers, owned) = read_multipliers(&one, base)?;
        let (one, two) = (read_surface(&one, base, "nonmortar")?, read_surface(&two, base, "mortar")?);
        let mut inner = Interface::new(one, two, multipliers, options)?;
        if let Some(owned) = owned {
            inner.set_owned(owned)?;
        }
        raw::write(out, &[Box::into_raw(Box::new(stickslip_interface { inner, base }))]);
        Ok(())
    })
}

/// Destroys an interface and sets the pointer to NULL. NULL, or a pointer to NULL, is fine.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_destroy(interface: *mut *mut stickslip_interface) -> i32 {
    guard(|| {
        if interface.is_null() {
            return Ok(());
        }
        raw::check(interface, "interface")?;
        // SAFETY: non-null, aligned; the handle in it is NULL or came from create and is destroyed once.
        unsafe {
            let handle = interface.replace(std::ptr::null_mut());
            if !handle.is_null() {
                drop(Box::from_raw(handle));
            }
        }
        Ok(())
    })
}

/// Friction coefficient per non-mortar node, mu (n1), in place of the options' one. Keeps the rule for
/// newly covered nodes. Errors: NULL_POINTER, NOT_FINITE, INVALID_VALUE.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_set_friction(interface: *mut stickslip_interface, mu: *const f64) -> i32 {
    guard(|| {
        let h = handle(interface)?;
        let mu = raw::numbers(mu, sizes(&h.inner).0, "mu")?;
        h.inner.set_friction(mu.to_vec())
    })
}

/// Augmentation r_A > 0 per non-mortar node, r (n1) [F/L^5], in place of rhat_A / M_A; NULL returns to
/// the options. Errors: NULL_POINTER, NOT_FINITE, INVALID_VALUE.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_set_augmentation(
    interface: *mut stickslip_interface,
    r: *const f64,
) -> i32 {
    guard(|| {
        let h = handle(interface)?;
        let r = raw::optional_numbers(r, sizes(&h.inner).0, "r")?;
        h.inner.set_augmentation(r.map(<[f64]>::to_vec))
    })
}

/// Normals per non-mortar node, normals (3 n1), unit and INTO the non-mortar body, in place of the
/// averaged ones of t_n; NULL returns to those. Errors: NULL_POINTER, NOT_FINITE, INVALID_VALUE.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_set_normals(
    interface: *mut stickslip_interface,
    normals: *const f64,
) -> i32 {
    guard(|| {
        let h = handle(interface)?;
        let normals = raw::optional_numbers(normals, 3 * sizes(&h.inner).0, "normals")?;
        h.inner.set_normals(normals.map(raw::vectors))
    })
}

/// Directions in which displacement is prescribed on both sides (plane strain, symmetry plane), or on
/// the non-mortar side against a rigid mortar side: the multiplier component there is removed and the
/// normal gets no part in it. Replaces all earlier ones; n = 0 clears.
///
/// nodes (n): non-mortar node numbers in the index base, a node up to twice; directions (3 n), any
/// length but 0. At a Dirichlet edge over a deformable mortar side do NOT declare the direction.
/// Errors: NULL_POINTER, INVALID_SIZE, NOT_FINITE, INDEX_OUT_OF_RANGE, INVALID_VALUE, UNDEFINED_NORMAL.
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
            return h.inner.set_constraints(&[]);
        }
        let (nodes, directions) = (raw::slice(nodes, n, "nodes")?, raw::numbers(directions, 3 * n, "directions")?);
        let node = |k: &i64| k.checked_sub(h.base).and_then(|k| usize::try_from(k).ok()).unwrap_or(usize::MAX);
        let list: Vec<_> = nodes.iter().map(node).zip(raw::vectors(directions)).collect();
        h.inner.set_constraints(&list)
    })
}

/// Takes (x1, x2), 3 n1 and 3 n2 [L], as the configuration of t_n with nothing slipped yet, in place of
/// the first configuration. Errors: as for create.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_set_previous(
    interface: *mut stickslip_interface,
    x1: *const f64,
    x2: *const f64,
) -> i32 {
    guard(|| {
        let h = handle(interface)?;
        let point = Point::positions(&h.inner, x1, x2)?;
        h.inner.set_previous(&point.x1, &point.x2)
    })
}

/// Writes multipliers to start the first step with, lambda (3 n1), output [F/L^2]: a slight compression,
/// -1e-6 rhat_A sqrt(M_A) nu_A, on covered closed nodes, 0 elsewhere. lambda = 0 at zero gap is a body
/// without support. Errors: NULL_POINTER, UNDEFINED_NORMAL, INVALID_VALUE once a step is committed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_initial_multipliers(
    interface: *mut stickslip_interface,
    lambda: *mut f64,
) -> i32 {
    guard(|| {
        let h = handle(interface)?;
        raw::check(lambda, "lambda")?;
        let values = h.inner.initial_multipliers()?;
        raw::write_each(lambda, flat(&values));
        Ok(())
    })
}

/// Stage 1, assembled: this handle's share of every node's coverage and gaps. A parallel host whose
/// handles hold the whole non-mortar surface and disjoint mortar facets adds them over its ranks and
/// passes the total as `sums` to the calls below; others pass NULL there.
///
/// sums (11 n1), output, per node: covered area now [L^2], g[n_{n+1}, x_{n+1}] (3) [L^3], covered area at
/// t_n, g[n_n, x_{n+1}] (3), g[n_n, x_n] (3). With sums, use the multiplier form.
/// Errors: NULL_POINTER, NOT_FINITE, DEGENERATE_FACET, PROJECTION_NOT_CONVEX.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_sums(
    interface: *mut stickslip_interface,
    x1: *const f64,
    x2: *const f64,
    sums: *mut f64,
) -> i32 {
    guard(|| {
        let h = handle(interface)?;
        let point = Point::positions(&h.inner, x1, x2)?;
        raw::check(sums, "sums")?;
        let values = h.inner.sums(&point.x1, &point.x2)?;
        let per_node = |s: &NodeSums| {
            let (g, p, c) = (s.gap_now, s.gap_previous, s.gap_committed);
            [s.coverage, g.x, g.y, g.z, s.coverage_previous, p.x, p.y, p.z, c.x, c.y, c.z]
        };
        raw::write_each(sums, values.iter().flat_map(per_node));
        Ok(())
    })
}

/// What `stickslip_interface_states` reports per non-mortar node; a NULL member is not wanted.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct stickslip_states {
    /// sizeof(stickslip_states).
    pub struct_size: u64,
    /// n1: STICKSLIP_STATE_...
    pub state: *mut i32,
    /// 3 n1: nu, unit, into the non-mortar body.
    pub normal: *mut f64,
    /// 3 n1: projected traction p [F/L^2].
    pub traction: *mut f64,
    /// n1: weighted gap nu . g > 0 open [L^3].
    pub gap: *mut f64,
    /// 3 n1: slip since the first configuration, this step's included [L].
    pub slip: *mut f64,
    /// n1: covered area [L^2].
    pub coverage: *mut f64,
    /// n1: full tributary area M_A [L^2].
    pub area: *mut f64,
    /// n1: work of friction in this step, p . g_T >= 0 when converged [F L].
    pub dissipation: *mut f64,
    /// n1: r_A [F/L^5].
    pub augmentation: *mut f64,
}

// SAFETY: repr(C), struct_size first, integers and raw pointers only.
unsafe impl Sized64 for stickslip_states {
    const NAME: &'static str = "stickslip_states";
}

/// Stage 2: state and nodal results at (x1, x2, lambda).
///
/// x1 (3 n1), x2 (3 n2) [L], lambda (3 n1) [F/L^2]; sums: see `stickslip_interface_sums`, or NULL.
/// Errors: NULL_POINTER, STRUCT_SIZE, NOT_FINITE, DEGENERATE_FACET, PROJECTION_NOT_CONVEX,
/// UNDEFINED_NORMAL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_states(
    interface: *mut stickslip_interface,
    x1: *const f64,
    x2: *const f64,
    lambda: *const f64,
    sums: *const f64,
    out: *const stickslip_states,
) -> i32 {
    guard(|| {
        let h = &mut handle(interface)?.inner;
        let point = Point::read(h, x1, x2, lambda, sums)?;
        let out = raw::read(out)?;
        raw::check_optional(out.state, "stickslip_states.state")?;
        for p in
            [out.normal, out.traction, out.gap, out.slip, out.coverage, out.area, out.dissipation, out.augmentation]
        {
            raw::check_optional(p, "a member of stickslip_states")?;
        }
        let responses = h.responses(&point.x1, &point.x2, &point.lambda, point.sums())?;
        let own = if point.sums().is_none() { h.sums(&point.x1, &point.x2)? } else { Vec::new() };
        let sums = point.sums().unwrap_or(&own);
        let nodes = || responses.iter().enumerate();
        let normals = (0..responses.len()).map(|a| h.normal(a)).collect::<Result<Vec<_>>>()?;
        let slip: Vec<_> = nodes().map(|(a, r)| h.slip_after(a, r, sums[a].coverage)).collect();
        raw::write_each(out.state, nodes().map(|(_, r)| r.state as i32));
        raw::write_each(out.normal, flat(&normals));
        raw::write_each(out.traction, nodes().flat_map(|(_, r)| [r.traction.x, r.traction.y, r.traction.z]));
        raw::write_each(out.gap, nodes().map(|(_, r)| r.gap_normal));
        raw::write_each(out.slip, flat(&slip));
        raw::write_each(out.coverage, sums.iter().map(|s| s.coverage));
        raw::write_each(out.area, h.history().areas.iter().copied());
        raw::write_each(out.dissipation, nodes().map(|(_, r)| r.traction.dot(&r.slip)));
        raw::write_each(out.augmentation, nodes().map(|(a, _)| h.augmentation(a)));
        Ok(())
    })
}

/// Residual in internal-force sign: what to ADD to the host's internal forces. The force ON the
/// non-mortar body is -force1.
///
/// Inputs as for `stickslip_interface_states`. Outputs, overwritten: force1 (3 n1), force2 (3 n2) [F],
/// rows (3 n1), the multiplier rows ([F] with the default row scale). A function of the inputs and the
/// committed history alone: the same call gives the same bits. Paper (23).
/// Errors: NULL_POINTER, NOT_FINITE, DEGENERATE_FACET, PROJECTION_NOT_CONVEX, UNDEFINED_NORMAL; within
/// Newton treat them as a domain error and take a smaller step.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_residual(
    interface: *mut stickslip_interface,
    x1: *const f64,
    x2: *const f64,
    lambda: *const f64,
    sums: *const f64,
    force1: *mut f64,
    force2: *mut f64,
    rows: *mut f64,
) -> i32 {
    guard(|| {
        let h = &mut handle(interface)?.inner;
        let point = Point::read(h, x1, x2, lambda, sums)?;
        raw::check(force1, "force1")?;
        raw::check(force2, "force2")?;
        raw::check(rows, "rows")?;
        let r = h.residual(&point.x1, &point.x2, &point.lambda, point.sums())?;
        raw::write_each(force1, flat(&r.nonmortar));
        raw::write_each(force2, flat(&r.mortar));
        raw::write_each(rows, flat(&r.rows));
        Ok(())
    })
}

/// Accepts a converged step: (x1, x2, lambda) becomes t_n; weights, normals, coverage and slip move on.
///
/// Inputs as for `stickslip_interface_states`. Errors: as for create; then nothing has moved.
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
        h.commit(&point.x1, &point.x2, &point.lambda, point.sums())
    })
}

/// Undoes the last commit exactly. A step that was never committed needs no rollback: evaluations do not
/// touch the history. Errors: NULL_POINTER, NOTHING_TO_ROLL_BACK (only one commit can be undone).
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_rollback(interface: *mut stickslip_interface) -> i32 {
    guard(|| handle(interface)?.inner.roll_back())
}

/// Lengths of the flat arrays that hold the history now. Errors: NULL_POINTER.
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
        let (i, r) = h.inner.history().flat_size();
        raw::write(n_integers, &[i as i64]);
        raw::write(n_reals, &[r as i64]);
        Ok(())
    })
}

/// Writes the history to integers (n_integers) and reals (n_reals), for a restart file. Lengths from
/// `stickslip_interface_history_size`; larger ones are fine. Errors: NULL_POINTER, BUFFER_TOO_SMALL.
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
        let needed = h.inner.history().flat_size();
        for (name, given, needed) in [("n_integers", n_integers, needed.0), ("n_reals", n_reals, needed.1)] {
            if given < needed as i64 {
                return Err(Error::new(Kind::BufferTooSmall, format!("{name} is {given}; the history needs {needed}")));
            }
        }
        let (i, r) = h.inner.history().export();
        raw::write(integers, &i);
        raw::write(reals, &r);
        Ok(())
    })
}

/// Replaces the history by an exported one of the same surfaces; evaluation then continues bit for bit.
/// Errors: NULL_POINTER, INVALID_SIZE, NOT_FINITE, HISTORY_MISMATCH.
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
        h.inner.import_history(integers, reals)
    })
}

/// What an interface has done since its creation.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct stickslip_counters {
    /// sizeof(stickslip_counters).
    pub struct_size: u64,
    /// Pairs whose boxes met.
    pub pairs_tested: i64,
    /// Pairs that overlapped or touched.
    pub pairs_clipped: i64,
    /// Pairs with an area.
    pub pairs_integrated: i64,
    /// Pairs whose weights were differentiated.
    pub pairs_linearised: i64,
    /// Searches.
    pub searches: i64,
    /// Pairs active at the last evaluation.
    pub pairs_active: i64,
    /// Heap memory in use, roughly.
    pub bytes: i64,
    /// Seconds in search.
    pub seconds_search: f64,
    /// Seconds in clipping and integration.
    pub seconds_integration: f64,
    /// Seconds in derivatives and assembly of the tangent.
    pub seconds_assembly: f64,
}

// SAFETY: repr(C), struct_size first, numbers only.
unsafe impl Sized64 for stickslip_counters {
    const NAME: &'static str = "stickslip_counters";
}

/// Reads the counters. Errors: NULL_POINTER, STRUCT_SIZE.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_counters(
    interface: *mut stickslip_interface,
    out: *mut stickslip_counters,
) -> i32 {
    guard(|| {
        let h = &handle(interface)?.inner;
        raw::check_struct(out)?;
        let c = h.counters();
        raw::write_struct(
            out,
            stickslip_counters {
                struct_size: 0,
                pairs_tested: c.pairs_tested,
                pairs_clipped: c.pairs_clipped,
                pairs_integrated: c.pairs_integrated,
                pairs_linearised: c.pairs_linearised,
                searches: c.searches,
                pairs_active: h.active_pairs() as i64,
                bytes: h.bytes() as i64,
                seconds_search: c.seconds_search,
                seconds_integration: c.seconds_integration,
                seconds_assembly: c.seconds_assembly,
            },
        );
        Ok(())
    })
}
