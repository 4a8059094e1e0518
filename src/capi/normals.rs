//! Normals of the current configuration: of an interface, and stage by stage (docs/formulation 11).

use super::facet::facet;
use super::guard::guard;
use super::handle::{dimension, either, flat, handle, sizes, stickslip_interface};
use super::layout::column_major;
use super::method::choose_normals;
use super::node::{read_node, rows, stickslip_node};
use super::point::{multipliers, vectors};
use super::raw;
use crate::error::{Error, Kind};
use crate::geometry::{Mat3, Plane, Vec3};
use crate::memory::Stored;
use crate::normal::{SMALLEST_SUM, corner_normal_derivatives, nodal_normal, nodal_normal_derivative};
use crate::shape::MAX_CORNERS;

/// Which normals evaluations of an interface with STICKSLIP_NORMALS_CURRENT use until the next commit, rollback or import:
/// STICKSLIP_NORMALS_CURRENT, as after each of these, or STICKSLIP_NORMALS_COMMITTED, those of t_n.
///
/// A step that presses surfaces far into each other may not converge with normals that turn from one iterate to the next.
/// Solve it with those of t_n first, and from there with the current ones: two solutions, so that a line search sees one
/// function. A commit refuses (INVALID_VALUE) where those of t_n are in use. The pattern of the tangent is that of the current
/// ones in either phase.
///
/// normals: STICKSLIP_NORMALS_... Of an interface with committed normals COMMITTED alone is allowed, and changes nothing.
///
/// Errors: NULL_POINTER, INVALID_VALUE.
/// Cost: none; the next evaluation begins anew.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_use_normals(interface: *mut stickslip_interface, normals: i32) -> i32 {
    guard(|| {
        let h = handle(interface)?;
        let Some(normals) = choose_normals(normals, "normals")? else {
            let text = "normals is STICKSLIP_NORMALS_AUTO; STICKSLIP_NORMALS_COMMITTED and _CURRENT are allowed";
            return Err(Error::new(Kind::InvalidValue, text));
        };
        either!(&mut h.inner, c => c.use_normals(normals))
    })
}

/// Turns multipliers as the surface turns from t_n to x1: each by the smallest rotation that takes nu_A(t_n) to nu_A(x1). A
/// start for Newton's method where a step turns the non-mortar body, for a multiplier is a vector in space; a host that knows
/// the body's rotation may use that instead. The answer does not depend on it. Multipliers along the normal, and those of
/// an interface with STICKSLIP_NORMALS_COMMITTED in its options, stay as they are; which normals evaluations use does not matter.
///
/// x1 (3 n1) [L]: the positions that Newton's method starts from; lambda (3 n1, without friction n1) [F/L^2]: those of t_n,
/// in and out.
///
/// Errors: NULL_POINTER, NOT_FINITE, UNDEFINED_NORMAL (the normals around a node cancel at x1).
/// Cost: O(n1); allocates.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_turn_multipliers(
    interface: *mut stickslip_interface,
    x1: *const f64,
    lambda: *mut f64,
) -> i32 {
    guard(|| {
        let h = handle(interface)?;
        let n1 = sizes(&h.inner).0;
        let (x1, dimension) = (vectors(&h.inner, x1, n1, "x1")?, dimension(&h.inner));
        let values = multipliers(&h.inner, lambda, n1)?;
        let turned: Vec<f64> = either!(&mut h.inner, c => {
            flat(&c.turn_multipliers(raw::as_vectors(&x1), raw::as_vectors(&values))?, dimension).stored()?
        });
        raw::check_results("lambda", &turned)?;
        raw::write(lambda, &turned);
        Ok(())
    })
}

/// Derivatives of a facet's unit corner normals m_k (`stickslip_facet_geometry`) with respect to its nodes, to be summed over
/// the facets around a node like the normals themselves: D nu_A = (dnu/ds)_A sum Dm, with dnu/ds of `stickslip_node_turn`.
///
/// n: 3 or 4; x: 3 n coordinates [L]. derivatives (n x 3 x n x 3) [1/L], output: of component i of m_k with respect to
/// component j of node l at ((3 k + i) n + l) 3 + j; in Fortran derivatives(j, l, i, k). Zero unless l is k or next to it.
///
/// Errors: NULL_POINTER, INVALID_SIZE, NOT_FINITE (also the result), DUPLICATE_NODE, DEGENERATE_FACET.
/// Cost: below a microsecond; allocates nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_facet_normal_derivatives(n: i32, x: *const f64, derivatives: *mut f64) -> i32 {
    guard(|| {
        let facet = facet(n, x, "x")?;
        raw::check(derivatives, "derivatives")?;
        Plane::of(&facet).map_err(raw::named("x"))?;
        let (n, mut values) = (facet.len(), [0.0; 9 * MAX_CORNERS * MAX_CORNERS]);
        for k in 0..n {
            for (l, dm) in corner_normal_derivatives(&facet, k, &Mat3::identity()) {
                for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
                    values[((3 * k + i) * n + l) * 3 + j] = dm[(i, j)];
                }
            }
        }
        raw::check_results("derivatives", &values)?;
        raw::write(derivatives, &values[..9 * n * n]);
        Ok(())
    })
}

/// What a node's answer depends on its normal by, where normals are those of now: with the matrices below, D nu_A of the sum of
/// `stickslip_facet_normal_derivatives` around A, and weights assembled over all pairs of A,
///
/// - the multiplier rows of A gain row_scale drow_dnormal Dnu_A (row_scale of `stickslip_node_block`);
/// - with forces of p (the augmented form) those of node B gain n_AB dp_dnormal Dnu_A, of C -n_AC dp_dnormal Dnu_A;
/// - in the multiplier form forces gain nothing.
///
/// node: as for `stickslip_node_respond`, its normal being that of now; sum (3): of the corner normals around it
/// (`stickslip_facet_geometry`), from which normal follows with the node's directions taken out. layout:
/// STICKSLIP_LAYOUT_... Outputs (3 x 3 each), each may be NULL: dnu_dsum [-]; dp_dnormal [F/L^2]; drow_dnormal [L^3].
///
/// Errors: those of `stickslip_node_respond`; UNDEFINED_NORMAL (the sum cancels), INVALID_VALUE (layout; a normal that is not
/// that of the sum).
/// Cost: nanoseconds; allocates nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_node_turn(
    node: *const stickslip_node,
    sum: *const f64,
    layout: i32,
    dnu_dsum: *mut f64,
    dp_dnormal: *mut f64,
    drow_dnormal: *mut f64,
) -> i32 {
    // Rounding of a sum of some unit vectors that all but cancel to SMALLEST_SUM, in single precision at worst.
    const SAME: f64 = 1e-6;
    guard(|| {
        let (friction, node) = read_node(node)?;
        let sum = Vec3::from_column_slice(raw::numbers(sum, 3, "sum")?);
        let column_major = column_major(layout, "layout")?;
        for (p, name) in [(dnu_dsum, "dnu_dsum"), (dp_dnormal, "dp_dnormal"), (drow_dnormal, "drow_dnormal")] {
            raw::check_optional(p, name)?;
        }
        let nu = node.free * nodal_normal(sum, 0)?;
        let length = nu.norm();
        if !((nu - node.normal * length).norm() <= SAME * length) || length <= SMALLEST_SUM {
            let text = "node.normal is not that of sum: minus the sum, without its part along the node's directions, over its length";
            return Err(Error::new(Kind::InvalidValue, text));
        }
        let (dnu, turn) = (nodal_normal_derivative(sum, &node.free), friction.turn(&node));
        let matrices = [&dnu, &turn.dp_dnormal, &turn.drow_dnormal];
        raw::check_results("dnu_dsum, dp_dnormal, drow_dnormal", matrices.into_iter().flatten())?;
        for (p, m) in [dnu_dsum, dp_dnormal, drow_dnormal].into_iter().zip(matrices) {
            raw::write(p, &rows(&if column_major { m.transpose() } else { *m }));
        }
        Ok(())
    })
}
