//! Stages 1 and 3 for one pair of facets or lines: stateless, re-entrant, without allocation but for derivatives of quadratic facets.

use super::guard::guard;
use super::layout::Matrix;
use super::lines;
use super::node::stickslip_node_response;
use super::pair_in::{self, Pair, flat, node_tangents, read_previous, stickslip_pair, tractions};
use super::pair_out::{check_tangent, check_weights, slot, write_force, write_gap, write_tangent, write_weights};
use super::parents;
use super::raw::{self, Output};
use crate::element::{FacetResponse, PairNow, PairTangent, pair_force, row_columns};
use crate::error::Result;
use crate::geometry::Projection;
use crate::mortar::{self, AlongNormal, NonmortarFrame, PAIR_NODES, PairWeights, Segment, WeightDerivatives};
use crate::quadrature::Rule;
use crate::shape::MAX_CORNERS;

/// Weights and their derivatives; each may be null. Apart from the rest: they are large.
#[inline(never)]
fn with_derivatives(
    (n1, n2): (usize, usize),
    (frame, segment, rule): (&NonmortarFrame, &Option<Segment>, &Rule),
    [n_ab, n_ac]: [*mut f64; 2],
    [dn_ab, dn_ac]: [*mut f64; 2],
) -> Result<()> {
    let (mut d, n) = (WeightDerivatives::default(), n1 + n2);
    let weights = match segment {
        Some(segment) => d.update(frame, segment, rule),
        None => PairWeights::default(),
    };
    check_weights(&weights)?;
    raw::check_array("dn_ab, dn_ac", flat(&d.ab))?;
    raw::check_array("dn_ab, dn_ac", flat(&d.ac))?;
    write_weights(&weights, (n1, n2), n_ab, n_ac);
    let (mut ab, mut ac) = (Output::new(dn_ab), Output::new(dn_ac));
    if n == PAIR_NODES {
        ab.append(flat(&d.ab));
        ac.append(flat(&d.ac));
        return Ok(());
    }
    for a in 0..n1 {
        for k in 0..n1 * n {
            ab.append(&d.ab[a][k / n][slot(n1, k % n)]);
        }
        for k in 0..n2 * n {
            ac.append(&d.ac[a][k / n][slot(n1, k % n)]);
        }
    }
    Ok(())
}

/// Stage 1: the mortar weights of a pair in its current configuration. Paper (13).
///
/// Outputs, each may be NULL: n_ab (m x n1) and n_ac (m x n2) [L^2], row A; dn_ab (m x n1 x 3(n1+n2))
/// and dn_ac (m x n2 x 3(n1+n2)) [L], their exact derivatives with respect to (x1, x2), always row-major
/// in this order (in Fortran: n_ac(n2, m), dn_ac(3 (n1+n2), n2, m)). m: multipliers, at the first m nodes of the non-mortar
/// facet; n1 where it is linear; of a quadratic one 3 or 4 with STICKSLIP_SPACE_CORNER, n1 with STICKSLIP_SPACE_SUB. Facets
/// that do not overlap give zeros, as does a mortar facet seen edge-on: not an error.
/// Lines (model): dn_ab (m x n1 x 2(n1+n2)), dn_ac (m x n2 x 2(n1+n2)), for positions have two components; m is 2 with
/// STICKSLIP_SPACE_CORNER, n1 with STICKSLIP_SPACE_SUB. Weights hold the thickness or, axisymmetric, 2 pi r. A line over itself has
/// the areas of its multipliers: the sums of the rows of its n_ab.
///
/// Errors: NULL_POINTER, STRUCT_SIZE, INVALID_SIZE, NOT_FINITE, DUPLICATE_NODE, DEGENERATE_FACET (of a quadratic facet, also
/// where mid nodes do not follow the corners in order, or lie more than a quarter of the edge off its middle),
/// PROJECTION_NOT_CONVEX, INVALID_VALUE (also a node at r < 0),
/// UNSUPPORTED (quadratic facets or lines with element_points or neighbour_normals).
/// Cost: 1 (tri3) to 2 (quad4) microseconds, 1 to 7 with derivatives, 2 to 2.5 times that with QUADRATURE_DEGREE_10;
/// two quadratic facets 7 (tri6) to 14 (quad8), 50 to 140 with derivatives; lines 0.5, up to 2 with derivatives. Allocates nothing, but memory for
/// derivatives of quadratic facets.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_pair_weights(
    pair: *const stickslip_pair,
    n_ab: *mut f64,
    n_ac: *mut f64,
    dn_ab: *mut f64,
    dn_ac: *mut f64,
) -> i32 {
    guard(|| {
        let given = pair_in::read(pair)?;
        if given.is_line() {
            return lines::weights(&given, [n_ab, n_ac], [dn_ab, dn_ac]);
        }
        if given.is_quadratic() {
            return parents::weights(&given, [n_ab, n_ac], [dn_ab, dn_ac]);
        }
        let pair = &Pair::of(given)?;
        for (p, name) in [(n_ab, "n_ab"), (n_ac, "n_ac"), (dn_ab, "dn_ab"), (dn_ac, "dn_ac")] {
            raw::check_optional(p, name)?;
        }
        pair.overlapping(|frame, segment, rule| match segment {
            // The weights have the same bits, whatever else is wanted.
            _ if !(dn_ab.is_null() && dn_ac.is_null()) => {
                with_derivatives(pair.n(), (frame, segment, rule), [n_ab, n_ac], [dn_ab, dn_ac])
            }
            Some(segment) => {
                let weights = PairWeights::integrate(frame, segment, rule);
                check_weights(&weights)?;
                write_weights(&weights, pair.n(), n_ab, n_ac);
                Ok(())
            }
            None => {
                write_weights(&PairWeights::default(), pair.n(), n_ab, n_ac);
                Ok(())
            }
        })
    })
}

/// The weighted gap g[n, x] of a pair with any weights, those of now or those of t_n; to be summed over
/// the pairs of a node. Paper (11).
///
/// pair: quadrature and layout are not read. n_ab (m x n1), n_ac (m x n2) [L^2], row A, of m multipliers as for
/// `stickslip_pair_weights`; gap (3 m), of lines (2 m), output [L^3].
///
/// Errors: NULL_POINTER, STRUCT_SIZE, INVALID_SIZE, NOT_FINITE, DUPLICATE_NODE, DEGENERATE_FACET, INVALID_VALUE, UNSUPPORTED (as
/// `stickslip_pair_weights`, of quadratic facets and lines).
/// Cost: below a microsecond, of two quad9 1.4; allocates nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_pair_gap(
    pair: *const stickslip_pair,
    n_ab: *const f64,
    n_ac: *const f64,
    gap: *mut f64,
) -> i32 {
    guard(|| {
        let given = pair_in::read(pair)?;
        if given.is_line() {
            return lines::gap(&given, [n_ab, n_ac], gap);
        }
        if given.is_quadratic() {
            return parents::gap(&given, [n_ab, n_ac], gap);
        }
        let pair = Pair::of(given)?;
        let weights = pair.weights(n_ab, n_ac, ["n_ab", "n_ac"])?;
        raw::check(gap, "gap")?;
        write_gap(&mortar::gap(&weights, &pair.one, &pair.two), pair.one.len(), gap)
    })
}

/// Stage 3: a pair's nodal forces in internal-force sign; the force ON the non-mortar body is minus the
/// first 3 n1. Paper (23).
///
/// pair: quadrature and layout are not read. n_ab (m x n1), n_ac (m x n2): weights of now [L^2], row A, of m multipliers as
/// for `stickslip_pair_weights`; traction (3 m): the multipliers lambda (multiplier form) or the projected tractions p of
/// `stickslip_node_respond` (augmented form) [F/L^2]; force (3 (n1 + n2)), output [F]. Of lines traction (2 m) and force
/// (2 (n1 + n2)), in an axisymmetric model that of the whole ring.
///
/// Errors: NULL_POINTER, STRUCT_SIZE, INVALID_SIZE, NOT_FINITE, DUPLICATE_NODE, DEGENERATE_FACET, INVALID_VALUE, UNSUPPORTED (as
/// `stickslip_pair_weights`, of quadratic facets and lines).
/// Cost: below a microsecond, of two quad9 1.4; allocates nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_pair_residual(
    pair: *const stickslip_pair,
    n_ab: *const f64,
    n_ac: *const f64,
    traction: *const f64,
    force: *mut f64,
) -> i32 {
    guard(|| {
        let given = pair_in::read(pair)?;
        if given.is_line() {
            return lines::residual(&given, [n_ab, n_ac], traction, force);
        }
        if given.is_quadratic() {
            return parents::residual(&given, [n_ab, n_ac], traction, force);
        }
        let pair = Pair::of(given)?;
        let weights = pair.weights(n_ab, n_ac, ["n_ab", "n_ac"])?;
        let traction = tractions(traction, pair.one.len())?;
        raw::check(force, "force")?;
        write_force(&pair_force(&weights, &traction), pair.n(), force)
    })
}

/// Stage 3: a pair's share of the exact tangent in the multiplier form. With the node blocks of
/// `stickslip_node_block` the sum over all pairs is the whole tangent. (The augmented form couples all
/// pairs of a node; the interface handle assembles it.) Paper (29)-(31).
///
/// pair: quadrature is not read. Rows and columns: x1 (3 n1), x2 (3 n2), lambda (3 m), of m multipliers as for
/// `stickslip_pair_weights`. n_ab, n_ac: weights of now
/// [L^2], both NULL for a pair that overlapped only at t_n. dn_ab, dn_ac: their derivatives [L], both NULL where
/// the weights are frozen. n_ab_previous, n_ac_previous: weights of t_n [L^2], both NULL for a pair that did not
/// overlap then. traction (3 m): lambda [F/L^2]. responses: m results of `stickslip_node_respond`, from the gaps
/// assembled over all pairs. row_scale (m) multiplies the multiplier rows, NULL: 1; r M_A [F/L^3] makes them
/// forces. k: output, 3 (n1 + n2 + m) squared in the pair's layout, leading dimension ld >= that; overwritten,
/// the block (lambda, lambda) with zeros. Units of an entry: its row's over its column's. Of lines k is 2 (n1 + n2 + m) squared
/// and traction (2 m): of each response the first two rows and columns are read (`stickslip_node_respond`).
///
/// Errors: NULL_POINTER, STRUCT_SIZE, INVALID_SIZE, NOT_FINITE, DUPLICATE_NODE, DEGENERATE_FACET, INVALID_VALUE
/// (layout, multiplier_space, model, thickness, r < 0), UNSUPPORTED (as `stickslip_pair_weights`, of quadratic facets and lines).
/// Cost: 5 microseconds for two quad4, 11 for two quad9, 1 for two lines. Allocates nothing, but memory for the matrix of
/// quadratic facets.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_pair_tangent(
    pair: *const stickslip_pair,
    n_ab: *const f64,
    n_ac: *const f64,
    dn_ab: *const f64,
    dn_ac: *const f64,
    n_ab_previous: *const f64,
    n_ac_previous: *const f64,
    traction: *const f64,
    responses: *const stickslip_node_response,
    row_scale: *const f64,
    k: *mut f64,
    ld: i64,
) -> i32 {
    guard(|| {
        let given = pair_in::read(pair)?;
        if given.is_line() || given.is_quadratic() {
            let (now, at) = (([n_ab, n_ac], [dn_ab, dn_ac]), (traction, responses, row_scale));
            let tangent = if given.is_line() { lines::tangent } else { parents::tangent };
            return tangent(&given, now, [n_ab_previous, n_ac_previous], at, (k, ld));
        }
        let pair = Pair::of(given)?;
        let (n1, n2) = pair.n();
        let size = 6 * n1 + 3 * n2;
        let mut k = Matrix::new(k, size, ld, pair.column_major()?)?;
        let weights =
            (!n_ab.is_null() || !n_ac.is_null()).then(|| pair.weights(n_ab, n_ac, ["n_ab", "n_ac"])).transpose()?;
        let dn = (!dn_ab.is_null() || !dn_ac.is_null()).then(|| pair.derivatives(dn_ab, dn_ac)).transpose()?;
        let before = read_previous((n1, n2), n_ab_previous, n_ac_previous)?;
        let traction = tractions::<MAX_CORNERS, 3>(traction, n1)?;
        let nodes = node_tangents(&traction[..n1], responses, row_scale)?;
        let gap = match (&weights, &dn) {
            (Some(w), Some(dn)) => {
                let frame = NonmortarFrame::new(&pair.one).map_err(raw::named("pair.x1"))?;
                let mortar = Projection::new(&pair.two, &frame.plane);
                Some(AlongNormal::from_weights(&frame, &mortar, w, dn))
            }
            _ => None,
        };
        let nodes = FacetResponse::new(nodes.each_ref());
        let mut t = PairTangent::default();
        if let (Some(_), Some(dn)) = (&weights, &dn) {
            t.forces = dn.of_forces(&nodes.traction);
        }
        let now = weights.as_ref().map(|weights| PairNow { weights, gap: gap.as_ref() });
        row_columns::<3>((now.as_ref(), before.as_ref()), &nodes, &mut t.rows);
        check_tangent(&t)?;
        write_tangent(&t, weights.as_ref(), (n1, n2), &mut k);
        Ok(())
    })
}
