//! Stages 1 and 3 for one pair of facets: stateless, re-entrant, without allocation.

use super::facet::{facet, set_neighbours};
use super::guard::guard;
use super::layout::{Matrix, column_major};
use super::node::stickslip_node_response;
use super::options::{element_line, rule};
use super::pair_out::{check_tangent, slot, write_force, write_gap, write_tangent, write_weights};
use super::parents::Parents;
use super::raw::{self, Output};
use super::sized::{self, Sized64};
use crate::element::{FacetResponse, NodeTangent, PairNow, PairTangent, pair_force, row_columns};
use crate::error::Result;
use crate::geometry::{Facet, Projection, Vec3};
use crate::mortar::{
    self, AlongNormal, GapDerivative, NonmortarFrame, PAIR_NODES, PairWeights, Segment, WeightDerivatives,
};
use crate::quadrature::Rule;
use crate::shape::{MAX_CORNERS, MAX_NODES};

/// A pair of facets, non-mortar first. Node order: right-hand, seen from outside each body.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct stickslip_pair {
    /// sizeof(stickslip_pair).
    pub struct_size: u64,
    /// Nodes of the non-mortar facet: 3 (tri3) or 4 (quad4); 6 (tri6), 8 (quad8) or 9 (quad9) where the function takes
    /// quadratic facets: corners, then mid nodes, k between the corners k and k + 1, then the centre.
    pub n1: i32,
    /// Nodes of the mortar facet, likewise.
    pub n2: i32,
    /// 3 n1 coordinates of the non-mortar facet, node by node (in Fortran x1(3, n1)) [L].
    pub x1: *const f64,
    /// 3 n2 coordinates of the mortar facet [L].
    pub x2: *const f64,
    /// STICKSLIP_QUADRATURE_...
    pub quadrature: i32,
    /// STICKSLIP_LAYOUT_... of the tangent.
    pub layout: i32,
    /// 0 (default): weights over triangles of the overlap; 2 to 10: over so many points squared on the non-mortar facet,
    /// those that fall on the mortar facet (STICKSLIP_INTEGRATION_ELEMENTS; quadrature is not used).
    pub element_points: i64,
    /// 3 n1: for each edge of the non-mortar facet, from its k-th node to the next one, the normal of the facet beyond it
    /// (`stickslip_facet_normal`, of length 1 within 1e-10), or (0, 0, 0) where the surface ends [-]. NULL (default): not
    /// known. Read by `stickslip_pair_weights` alone. With it a pair has the weights that a handle has, to the last bit;
    /// without, a border of the mortar surface that follows the edge may count for both of its facets or for none.
    pub neighbour_normals: *const f64,
    /// STICKSLIP_SPACE_..., of a quadratic non-mortar facet.
    pub multiplier_space: i32,
    /// Not used.
    pub reserved: i32,
}

// SAFETY: repr(C), struct_size first, integers and raw pointers only.
unsafe impl Sized64 for stickslip_pair {
    const NAME: &'static str = "stickslip_pair";
    const FIRST: usize = 40;
}

pub(super) struct Pair {
    pub one: Facet,
    pub two: Facet,
    raw: stickslip_pair,
}

impl Pair {
    #[inline]
    pub fn read(p: *const stickslip_pair) -> Result<Pair> {
        let raw = sized::read(p)?;
        Ok(Pair { one: facet(raw.n1, raw.x1, "pair.x1")?, two: facet(raw.n2, raw.x2, "pair.x2")?, raw })
    }

    /// Numbers of nodes.
    pub fn n(&self) -> (usize, usize) {
        (self.one.len(), self.two.len())
    }

    /// Whether the matrix goes out by columns.
    pub fn column_major(&self) -> Result<bool> {
        column_major(self.raw.layout, "pair.layout")
    }

    /// Planes and overlap of now, and the rule that is asked for; then `work` with them. By reference: they are large.
    #[inline]
    pub fn overlapping<T>(
        &self,
        work: impl FnOnce(&NonmortarFrame, &Option<Segment>, &'static Rule) -> Result<T>,
    ) -> Result<T> {
        let rule = rule(self.raw.quadrature, "pair.quadrature")?;
        let mut frame = NonmortarFrame::new(&self.one);
        let frame = match &mut frame {
            Ok(frame) => frame,
            Err(error) => return Err(raw::named_one("pair.x1", error)),
        };
        set_neighbours(frame, self.raw.neighbour_normals, "pair.neighbour_normals")?;
        let segment = match self.raw.element_points {
            0 => Segment::new(frame, &self.two),
            points => Segment::of_points(frame, &self.two, element_line(points, "pair.element_points")?),
        };
        match &segment {
            Ok(segment) => work(frame, segment, rule),
            Err(error) => Err(raw::named_one("pair.x2", error)),
        }
    }

    pub fn weights(&self, ab: *const f64, ac: *const f64, names: [&str; 2]) -> Result<PairWeights> {
        read_weights(self.n(), ab, ac, names)
    }

    fn derivatives(&self, ab: *const f64, ac: *const f64) -> Result<WeightDerivatives> {
        let (n1, n2) = self.n();
        let n = n1 + n2;
        let (ab, ac) = (raw::numbers(ab, n1 * n1 * 3 * n, "dn_ab")?, raw::numbers(ac, n1 * n2 * 3 * n, "dn_ac")?);
        let mut d = WeightDerivatives::default();
        if n == PAIR_NODES {
            flat_mut(&mut d.ab).copy_from_slice(ab);
            flat_mut(&mut d.ac).copy_from_slice(ac);
            return Ok(d);
        }
        for a in 0..n1 {
            for k in 0..n {
                let at = |row: usize| 3 * (row * n + k);
                for b in 0..n1 {
                    d.ab[a][b][slot(n1, k)].copy_from_slice(&ab[at(a * n1 + b)..][..3]);
                }
                for c in 0..n2 {
                    d.ac[a][c][slot(n1, k)].copy_from_slice(&ac[at(a * n2 + c)..][..3]);
                }
            }
        }
        Ok(d)
    }
}

/// Derivatives of weights, as they lie with a caller whose facets have as many nodes as there are slots.
type Derivatives = [[[[f64; 3]; PAIR_NODES]; MAX_NODES]; MAX_CORNERS];

fn flat(d: &Derivatives) -> &[f64] {
    d.as_flattened().as_flattened().as_flattened()
}

fn flat_mut(d: &mut Derivatives) -> &mut [f64] {
    d.as_flattened_mut().as_flattened_mut().as_flattened_mut()
}

/// The weights that a caller gives to a pair of so many nodes.
pub(super) fn read_weights(
    (n1, n2): (usize, usize),
    ab: *const f64,
    ac: *const f64,
    names: [&str; 2],
) -> Result<PairWeights> {
    Ok(pair_weights(raw::numbers(ab, n1 * n1, names[0])?, raw::numbers(ac, n1 * n2, names[1])?, n1))
}

/// Weights of t_n, or nothing where both are null.
pub(super) fn read_previous(n: (usize, usize), ab: *const f64, ac: *const f64) -> Result<Option<PairWeights>> {
    let is_given = !ab.is_null() || !ac.is_null();
    is_given.then(|| read_weights(n, ab, ac, ["n_ab_previous", "n_ac_previous"])).transpose()
}

/// A pair's weights from a caller's n_ab and n_ac, row A, of so many non-mortar nodes.
pub(super) fn pair_weights(ab: &[f64], ac: &[f64], n1: usize) -> PairWeights {
    let (mut w, n2) = (PairWeights::default(), ac.len() / n1);
    for a in 0..n1 {
        w.ab[a][..n1].copy_from_slice(&ab[a * n1..][..n1]);
        w.ac[a][..n2].copy_from_slice(&ac[a * n2..][..n2]);
    }
    w
}

/// Refuses weights that left the range of doubles.
#[inline]
pub(super) fn check_weights(w: &PairWeights) -> Result<()> {
    raw::check_array("n_ab, n_ac", w.ab.as_flattened())?;
    raw::check_array("n_ab, n_ac", w.ac.as_flattened())
}

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

/// 3 n numbers at `p` as vectors of the facet's nodes.
pub(super) fn tractions(p: *const f64, n: usize) -> Result<[Vec3; MAX_CORNERS]> {
    let mut t = [Vec3::zeros(); MAX_CORNERS];
    for (t, v) in t.iter_mut().zip(raw::numbers(p, 3 * n, "traction")?.chunks_exact(3)) {
        *t = Vec3::from_column_slice(v);
    }
    Ok(t)
}

/// What a facet must know of the responses of its nodes, at its tractions.
pub(super) fn node_tangents(
    traction: &[Vec3],
    responses: *const stickslip_node_response,
    row_scale: *const f64,
) -> Result<[NodeTangent; MAX_CORNERS]> {
    let scale = raw::optional_numbers(row_scale, traction.len(), "row_scale")?;
    let mut nodes = [NodeTangent::default(); MAX_CORNERS];
    for (a, (node, traction)) in nodes.iter_mut().zip(traction).enumerate() {
        let s = scale.map_or(1.0, |s| s[a]);
        let (now, previous) = super::node::read_response(responses, a)?;
        *node = NodeTangent { traction: *traction, drow_dnow: now * s, drow_dprevious: previous * s };
    }
    Ok(nodes)
}

/// Stage 1: the mortar weights of a pair in its current configuration. Paper (13).
///
/// Outputs, each may be NULL: n_ab (m x n1) and n_ac (m x n2) [L^2], row A; dn_ab (m x n1 x 3(n1+n2))
/// and dn_ac (m x n2 x 3(n1+n2)) [L], their exact derivatives with respect to (x1, x2), always row-major
/// in this order (in Fortran: n_ac(n2, m), dn_ac(3 (n1+n2), n2, m)). m: multipliers, at the first m nodes of the non-mortar
/// facet; n1 where it is linear; of a quadratic one 3 or 4 with STICKSLIP_SPACE_CORNER, n1 with STICKSLIP_SPACE_SUB. Facets
/// that do not overlap give zeros, as does a mortar facet seen edge-on: not an error.
///
/// Errors: NULL_POINTER, STRUCT_SIZE, INVALID_SIZE, NOT_FINITE, DUPLICATE_NODE, DEGENERATE_FACET (of a quadratic facet, also
/// where mid nodes do not follow the corners in order), PROJECTION_NOT_CONVEX, INVALID_VALUE, UNSUPPORTED (quadratic facets
/// with element_points or neighbour_normals).
/// Cost: 1 (tri3) to 2 (quad4) microseconds, 1 to 7 with derivatives, 2 to 2.5 times that with QUADRATURE_DEGREE_10;
/// quadratic facets as many pairs of their parts, some ten, each dearer. Allocates nothing, but memory for derivatives of
/// quadratic facets.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_pair_weights(
    pair: *const stickslip_pair,
    n_ab: *mut f64,
    n_ac: *mut f64,
    dn_ab: *mut f64,
    dn_ac: *mut f64,
) -> i32 {
    guard(|| {
        if let Some(pair) = Parents::read(pair)? {
            return pair.weights([n_ab, n_ac], [dn_ab, dn_ac]);
        }
        let pair = &Pair::read(pair)?;
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
/// `stickslip_pair_weights`; gap (3 m), output [L^3].
///
/// Errors: NULL_POINTER, STRUCT_SIZE, INVALID_SIZE, NOT_FINITE, DUPLICATE_NODE, DEGENERATE_FACET, INVALID_VALUE, UNSUPPORTED (as
/// `stickslip_pair_weights`, of quadratic facets).
/// Cost: below a microsecond; allocates nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_pair_gap(
    pair: *const stickslip_pair,
    n_ab: *const f64,
    n_ac: *const f64,
    gap: *mut f64,
) -> i32 {
    guard(|| {
        if let Some(pair) = Parents::read(pair)? {
            return pair.gap([n_ab, n_ac], gap);
        }
        let pair = Pair::read(pair)?;
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
/// `stickslip_node_respond` (augmented form) [F/L^2]; force (3 (n1 + n2)), output [F].
///
/// Errors: NULL_POINTER, STRUCT_SIZE, INVALID_SIZE, NOT_FINITE, DUPLICATE_NODE, DEGENERATE_FACET, INVALID_VALUE, UNSUPPORTED (as
/// `stickslip_pair_weights`, of quadratic facets).
/// Cost: below a microsecond; allocates nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_pair_residual(
    pair: *const stickslip_pair,
    n_ab: *const f64,
    n_ac: *const f64,
    traction: *const f64,
    force: *mut f64,
) -> i32 {
    guard(|| {
        if let Some(pair) = Parents::read(pair)? {
            return pair.residual([n_ab, n_ac], traction, force);
        }
        let pair = Pair::read(pair)?;
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
/// the block (lambda, lambda) with zeros. Units of an entry: its row's over its column's.
///
/// Errors: NULL_POINTER, STRUCT_SIZE, INVALID_SIZE, NOT_FINITE, DUPLICATE_NODE, DEGENERATE_FACET, INVALID_VALUE
/// (layout, multiplier_space), UNSUPPORTED (as `stickslip_pair_weights`, of quadratic facets).
/// Cost: 5 microseconds for two quad4, 100 for two quad9; allocates nothing.
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
        if let Some(pair) = Parents::read(pair)? {
            let now = ([n_ab, n_ac], [dn_ab, dn_ac]);
            return pair.tangent(now, [n_ab_previous, n_ac_previous], (traction, responses, row_scale), (k, ld));
        }
        let pair = Pair::read(pair)?;
        let (n1, n2) = pair.n();
        let size = 6 * n1 + 3 * n2;
        let mut k = Matrix::new(k, size, ld, pair.column_major()?)?;
        let weights =
            (!n_ab.is_null() || !n_ac.is_null()).then(|| pair.weights(n_ab, n_ac, ["n_ab", "n_ac"])).transpose()?;
        let dn = (!dn_ab.is_null() || !dn_ac.is_null()).then(|| pair.derivatives(dn_ab, dn_ac)).transpose()?;
        let before = read_previous((n1, n2), n_ab_previous, n_ac_previous)?;
        let traction = tractions(traction, n1)?;
        let nodes = node_tangents(&traction[..n1], responses, row_scale)?;
        let gap = match (&weights, &dn) {
            (Some(w), Some(dn)) => {
                let frame = NonmortarFrame::new(&pair.one).map_err(raw::named("pair.x1"))?;
                let mortar = Projection::new(&pair.two, &frame.plane);
                Some(GapDerivative::Facets(AlongNormal::from_weights(&frame, &mortar, w, dn)))
            }
            _ => None,
        };
        let nodes = FacetResponse::new(nodes.each_ref());
        let mut t = PairTangent::default();
        if let (Some(_), Some(dn)) = (&weights, &dn) {
            t.forces = dn.of_forces(&nodes.traction);
        }
        let now = weights.as_ref().map(|weights| PairNow { weights, gap: gap.as_ref() });
        row_columns::<true, 3>(now.as_ref(), before.as_ref(), &nodes, &mut t.rows);
        check_tangent(&t)?;
        write_tangent(&t, weights.as_ref(), (n1, n2), &mut k);
        Ok(())
    })
}
