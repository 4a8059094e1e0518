//! Evaluating an interface: sums, states, residual.

use super::guard::guard;
use super::handle::{components_of, dimension, either, flat, handle, stickslip_interface};
use super::point::Point;
use super::raw;
use super::sized::{self, Sized64};
use crate::error::Result;
use crate::geometry::Vec3;
use crate::interface::{Contact, NodeSums};

/// Stage 1, assembled: this handle's share of every node's coverage and gaps. A parallel host whose
/// handles hold the whole non-mortar surface and disjoint mortar facets adds them over its ranks and
/// passes the total as `sums` to the calls below; others pass NULL there. Paper (11), (13).
///
/// x1 (3 n1), x2 (3 n2): positions, not displacements [L]. sums (STICKSLIP_SUMS_PER_NODE n1), output, per node:
/// covered area now [L^2], g[n_{n+1}, x_{n+1}] (3) [L^3], covered area at t_n [L^2], g[n_n, x_{n+1}] (3) [L^3],
/// g[n_n, x_n] (3) [L^3]. Of tied surfaces the last is the gap that they started with, turned with the non-mortar facets
/// to x1: a host that adds up shares adds these too, and passes them at the same x1. With sums, use the multiplier form. This call, and those with sums, leave nothing out
/// where the handle's own part of the mortar surface is far away; calls with NULL in place of sums do, before and after.
///
/// All handles that are added up must have the same options and the same mu at every node (those of
/// `stickslip_interface_set_friction` too): each decides by its own whether slip counts. An analytic mortar side covers
/// every facet that faces it: it belongs to one handle, and none of the others may hold a mortar facet behind it.
///
/// Errors: NULL_POINTER, NOT_FINITE, DEGENERATE_FACET, PROJECTION_NOT_CONVEX; INVALID_VALUE (mortar facets lay on
/// each other at t_n, and were not looked at because the surfaces were apart then); with an analytic mortar side also
/// INVALID_VALUE (x2 is no rigid motion of the first frame) and UNDEFINED_NORMAL (a facet reaches its centre or axis).
/// Cost: at other positions than those of the last evaluation one search and one integration (frozen weights:
/// none), then O(pairs). Allocates what the handle has not had before: from the third call on, as long as about as many
/// facets meet, nothing.
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
        let values = either!(&mut h.inner, c => c.kept_share_of_sums(point.x1(), point.x2())?);
        let per_node = |s: &NodeSums| {
            let (g, p, c) = (s.gap_now, s.gap_previous, s.gap_committed);
            [s.coverage, g.x, g.y, g.z, s.coverage_previous, p.x, p.y, p.z, c.x, c.y, c.z]
        };
        // A facet is refused where its own numbers overflow; that of a line may not, and its gap may.
        if !values.iter().fold(true, |fine, s| per_node(s).iter().fold(fine, |fine, v| fine & v.is_finite())) {
            return raw::overflow("sums");
        }
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
    /// 3 n1: nu, unit, into the non-mortar body [-].
    pub normal: *mut f64,
    /// 3 n1: projected traction p [F/L^2].
    pub traction: *mut f64,
    /// n1: weighted gap nu . g > 0 open [L^3].
    pub gap: *mut f64,
    /// 3 n1: slip since the first configuration, this step's included [L]; 0 without friction, mu = 0 at every node
    /// included (STICKSLIP_SHORTCUT_FRICTIONLESS).
    pub slip: *mut f64,
    /// n1: covered area [L^2].
    pub coverage: *mut f64,
    /// n1: full tributary area M_A [L^2].
    pub area: *mut f64,
    /// n1: work of friction in this step, p . g_T >= 0 when converged [F L]; where points decide the sum over them, never negative.
    pub dissipation: *mut f64,
    /// n1: r_A [F/L^5].
    pub augmentation: *mut f64,
    /// n1: how much of what is covered of the node is closed [-]: 1 or 0 where nodes decide, between them where points do
    /// (STICKSLIP_DECISION_POINTS; the state is then a gap where it is 0).
    pub share: *mut f64,
    /// n1: depth that is worn off, this step's included [L]; 0 without wear (`stickslip_interface_set_layer`).
    pub worn: *mut f64,
    /// n1: volume that is worn off likewise [L^3]: a sum over the steps of depth times the area of then.
    pub worn_volume: *mut f64,
    /// n1: damage of the bond, 0 to 1, this step's included [-]; 0 without a bond.
    pub damage: *mut f64,
    /// n1: work that the bond has lost a unit of area, likewise [F/L].
    pub bond_loss: *mut f64,
}

// SAFETY: repr(C), struct_size first, integers and raw pointers only.
unsafe impl Sized64 for stickslip_states {
    const NAME: &'static str = "stickslip_states";
    const FIRST: usize = 80;
}

/// Stage 2: state and nodal results at (x1, x2, lambda), for output. Paper (17), (22), (24).
///
/// x1 (3 n1), x2 (3 n2): positions [L]; lambda (3 n1) [F/L^2]; sums: see `stickslip_interface_sums`, or NULL.
/// out: its members point to the caller's arrays, which are filled. Call it before the commit: after it the
/// step belongs to the past.
///
/// Errors: NULL_POINTER, STRUCT_SIZE, NOT_FINITE, DEGENERATE_FACET, PROJECTION_NOT_CONVEX, UNDEFINED_NORMAL,
/// INVALID_VALUE (as `stickslip_interface_sums`), UNSUPPORTED (what sums do not go with:
/// docs/compose.md).
/// Cost: as `stickslip_interface_sums`.
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
        let out = sized::read(out)?;
        check_states(&out)?;
        either!(h, c => write_states(c, &point, &out))
    })
}

/// Checks where states are to be written.
pub(super) fn check_states(out: &stickslip_states) -> Result<()> {
    raw::check_optional(out.state, "stickslip_states.state")?;
    for (p, name) in [
        (out.normal, "stickslip_states.normal"),
        (out.traction, "stickslip_states.traction"),
        (out.gap, "stickslip_states.gap"),
        (out.slip, "stickslip_states.slip"),
        (out.coverage, "stickslip_states.coverage"),
        (out.area, "stickslip_states.area"),
        (out.dissipation, "stickslip_states.dissipation"),
        (out.augmentation, "stickslip_states.augmentation"),
        (out.share, "stickslip_states.share"),
        (out.worn, "stickslip_states.worn"),
        (out.worn_volume, "stickslip_states.worn_volume"),
        (out.damage, "stickslip_states.damage"),
        (out.bond_loss, "stickslip_states.bond_loss"),
    ] {
        raw::check_optional(p, name)?;
    }
    Ok(())
}

fn write_states<const N: usize>(c: &mut Contact<N>, point: &Point, out: &stickslip_states) -> Result<()> {
    c.respond(point.x1(), point.x2(), point.lambda(), point.sums())?;
    let dimension = components_of(c);
    let components = |v: Vec3| <[f64; 3]>::from(v).into_iter().take(dimension);
    let (sums, responses) = c.answers();
    for a in 0..responses.len() {
        c.normal(a)?;
    }
    let nodes = || responses.iter().enumerate();
    let normals = || (0..responses.len()).filter_map(|a| c.normal(a).ok()).flat_map(components);
    let slip = || nodes().map(|(a, r)| c.slip_after(a, r, sums[a].coverage_previous)).flat_map(components);
    let traction = || responses.iter().flat_map(|r| components(r.traction));
    let gap = || responses.iter().map(|r| r.gap_normal);
    let coverage = || sums.iter().map(|s| s.coverage);
    let area = || c.history().areas.iter().copied();
    let dissipation = || (0..responses.len()).map(|a| c.dissipation(a));
    let augmentation = || (0..responses.len()).map(|a| c.augmentation(a));
    check("normal", normals())?;
    check("traction", traction())?;
    check("gap", gap())?;
    check("slip", slip())?;
    check("coverage", coverage())?;
    check("area", area())?;
    check("dissipation", dissipation())?;
    check("augmentation", augmentation())?;
    check("worn, worn_volume", (0..responses.len()).map(|a| c.layer_state_now(a)).map(|of| of.worn + of.volume))?;
    raw::write_each(out.state, responses.iter().map(|r| r.state as i32));
    raw::write_each(out.normal, normals());
    raw::write_each(out.traction, traction());
    raw::write_each(out.gap, gap());
    raw::write_each(out.slip, slip());
    raw::write_each(out.coverage, coverage());
    raw::write_each(out.area, area());
    raw::write_each(out.dissipation, dissipation());
    raw::write_each(out.augmentation, augmentation());
    raw::write_each(out.share, (0..responses.len()).map(|a| c.closed_share(a)));
    let layer = || (0..responses.len()).map(|a| c.layer_state_now(a));
    raw::write_each(out.worn, layer().map(|of| of.worn));
    raw::write_each(out.worn_volume, layer().map(|of| of.volume));
    raw::write_each(out.damage, layer().map(|of| of.damage));
    raw::write_each(out.bond_loss, layer().map(|of| of.lost));
    Ok(())
}

fn check(name: &str, mut values: impl Iterator<Item = f64>) -> Result<()> {
    if values.all(|v| v.is_finite()) { Ok(()) } else { raw::check_results(name, &[f64::INFINITY]) }
}

/// Residual in internal-force sign: what to ADD to the host's internal forces. The force ON the
/// non-mortar body is -force1. A function of the inputs and the committed history alone: the same call gives
/// the same bits. Paper (23), (25)-(27).
///
/// Inputs x1, x2, lambda, sums as for `stickslip_interface_states`. Outputs, overwritten: force1 (3 n1),
/// force2 (3 n2) [F], rows (3 n1): the multiplier rows ([F] with the default row scale, else [L^3]; 0 where the
/// node is not owned).
///
/// Errors: NULL_POINTER, NOT_FINITE, DEGENERATE_FACET, PROJECTION_NOT_CONVEX, UNDEFINED_NORMAL; within
/// Newton treat them as a domain error and take a smaller step. INVALID_VALUE (as `stickslip_interface_sums`),
/// UNSUPPORTED (what sums do not go with:
/// docs/compose.md).
/// Cost: as `stickslip_interface_sums`.
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
        let dimension = dimension(h);
        either!(h, c => {
            let r = c.kept_residual(point.x1(), point.x2(), point.lambda(), point.sums())?;
            let all = r.nonmortar.iter().chain(&r.mortar).flat_map(|v| v.iter());
            raw::check_results("force1, force2, rows", all.chain(r.rows.iter().flat_map(|v| v.iter())))?;
            raw::write_each(force1, flat(&r.nonmortar, dimension));
            raw::write_each(force2, flat(&r.mortar, dimension));
            raw::write_each(rows, flat(&r.rows, dimension));
        });
        Ok(())
    })
}
