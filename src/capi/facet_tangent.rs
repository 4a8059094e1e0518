//! Stage 3 with dual multipliers, for one non-mortar facet with its pairs: stateless, re-entrant, without allocation.

use super::dual::basis;
use super::facet::{facet, set_neighbours};
use super::guard::guard;
use super::layout::{Matrix, column_major};
use super::method::{element_line, rule};
use super::node::stickslip_node_response;
use super::pair_in::{node_tangents, pair_weights, tractions};
use super::raw;
use super::sized::{self, Sized64};
use crate::element::{DualFacet, FacetPairs, FacetResponse, facet_sums};
use crate::error::{Error, Kind, Result};
use crate::mortar::{NonmortarFrame, PairWeights, Segment};
use crate::shape::MAX_CORNERS;

/// A non-mortar facet with all the mortar facets that it overlaps, or overlapped at t_n. Node order: right-hand, seen from
/// outside each body.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct stickslip_facet {
    /// sizeof(stickslip_facet).
    pub struct_size: u64,
    /// Nodes of the non-mortar facet: 3 (tri3) or 4 (quad4).
    pub n1: i32,
    /// STICKSLIP_QUADRATURE_...
    pub quadrature: i32,
    /// STICKSLIP_LAYOUT_... of the tangent.
    pub layout: i32,
    /// Must be 0.
    pub reserved: i32,
    /// Number of mortar facets, at least 1.
    pub n_pairs: i64,
    /// 3 n1 coordinates of the non-mortar facet, node by node (in Fortran x1(3, n1)) [L].
    pub x1: *const f64,
    /// n_pairs: nodes of each mortar facet, 3 or 4.
    pub n2: *const i32,
    /// Coordinates of the mortar facets' nodes, facet after facet, 3 for each of all their nodes [L].
    pub x2: *const f64,
    /// As in `stickslip_pair`.
    pub element_points: i64,
    /// 3 n1, as in `stickslip_pair` [-], or NULL.
    pub neighbour_normals: *const f64,
}

// SAFETY: repr(C), struct_size first, integers and raw pointers only.
unsafe impl Sized64 for stickslip_facet {
    const NAME: &'static str = "stickslip_facet";
    const FIRST: usize = 72;
}

/// A facet's pairs, as a caller gives them.
struct Pairs<'a> {
    raw: stickslip_facet,
    frame: NonmortarFrame,
    line: Option<&'static [[f64; 2]]>,
    n2: &'a [i32],
    x2: &'a [f64],
    now: [&'a [f64]; 2],
    previous: Option<[&'a [f64]; 2]>,
}

impl Pairs<'_> {
    fn read<'a>(p: *const stickslip_facet, now: [*const f64; 2], previous: [*const f64; 2]) -> Result<Pairs<'a>> {
        let raw = sized::read(p)?;
        let one = facet(raw.n1, raw.x1, "facet.x1")?;
        if raw.reserved != 0 {
            return Err(Error::new(Kind::InvalidValue, text!("facet.reserved is {}; it must be 0", raw.reserved)));
        }
        let mut frame = NonmortarFrame::new(&one).map_err(raw::named("facet.x1"))?;
        set_neighbours(&mut frame, raw.neighbour_normals, "facet.neighbour_normals")?;
        let line = match raw.element_points {
            0 => None,
            points => Some(element_line(points, "facet.element_points")?),
        };
        let count = raw::count(raw.n_pairs, 1, "facet.n_pairs")?;
        let n2 = raw::slice(raw.n2, count, "facet.n2")?;
        if let Some(p) = n2.iter().position(|n| !matches!(n, 3 | 4)) {
            let text = text!("facet.n2[{p}] is {}; 3 (tri3) or 4 (quad4) are allowed", n2[p]);
            return Err(Error::new(Kind::InvalidSize, text));
        }
        let (n1, nodes) = (one.len(), nodes_of(n2));
        let x2 = raw::numbers(raw.x2, 3 * nodes, "facet.x2")?;
        let weights = |[ab, ac]: [*const f64; 2], names: [&str; 2]| -> Result<[&[f64]; 2]> {
            Ok([raw::numbers(ab, n1 * n1 * count, names[0])?, raw::numbers(ac, n1 * nodes, names[1])?])
        };
        let is_given = previous.iter().any(|p| !p.is_null());
        let previous = is_given.then(|| weights(previous, ["n_ab_previous", "n_ac_previous"])).transpose()?;
        Ok(Pairs { raw, frame, line, n2, x2, now: weights(now, ["n_ab", "n_ac"])?, previous })
    }

    fn n1(&self) -> usize {
        self.raw.n1 as usize
    }

    fn of(&self, [ab, ac]: &[&[f64]; 2], pair: usize) -> PairWeights {
        let (n1, first) = (self.n1(), nodes_of(&self.n2[..pair]));
        let (ab, ac) = (&ab[pair * n1 * n1..][..n1 * n1], &ac[first * n1..][..n1 * self.nodes(pair)]);
        pair_weights(ab, ac, n1)
    }
}

fn nodes_of(n2: &[i32]) -> usize {
    n2.iter().map(|n| *n as usize).sum()
}

impl FacetPairs for Pairs<'_> {
    fn count(&self) -> usize {
        self.n2.len()
    }

    fn nodes(&self, pair: usize) -> usize {
        self.n2[pair] as usize
    }

    fn overlap(&self, pair: usize) -> Result<Option<Segment>> {
        let x = self.x2[3 * nodes_of(&self.n2[..pair])..].as_ptr();
        let overlap = facet(self.n2[pair], x, "it").and_then(|two| match self.line {
            None => Segment::new(&self.frame, &two),
            Some(line) => Segment::of_points(&self.frame, &two, line),
        });
        overlap.map_err(|e| Error::new(e.kind, text!("facet.x2 of pair {pair}: {}", e.message)))
    }

    fn weights(&self, pair: usize) -> PairWeights {
        self.of(&self.now, pair)
    }

    fn previous(&self, pair: usize) -> Option<PairWeights> {
        self.previous.as_ref().map(|weights| self.of(weights, pair))
    }
}

/// Stage 3 with dual multipliers: the share of a facet and all its pairs of the exact tangent, in the multiplier form. With
/// the node blocks of `stickslip_node_block` the sum over all facets is the whole tangent. It takes the place of
/// `stickslip_pair_tangent`, which knows one pair: dual weights of a pair depend on all pairs of the facet. (Where weights
/// are frozen, that function with dual weights and without derivatives is right. The augmented form couples all facets of a
/// node; the interface handle assembles it.) docs/formulation 10.4.
///
/// facet: rows and columns are x1 (3 n1), x2 of one mortar facet after the other, lambda (3 n1). A node of several mortar
/// facets has rows and columns with each: add them up. n_ab (n_pairs x n1 x n1), n_ac (n1 x n2 of each pair, one pair
/// after the other): weights of now as `stickslip_pair_weights` gives them, not the dual ones [L^2]; 0 of a pair that
/// overlapped only at t_n. n_ab_previous, n_ac_previous: likewise the dual weights of t_n [L^2], 0 of a pair that did not
/// overlap then; both NULL where none did. traction (3 n1): lambda [F/L^2]. responses: n1 results of
/// `stickslip_node_respond`, from the gaps of dual weights assembled over all pairs. row_scale (n1) multiplies the
/// multiplier rows, NULL: 1; r M_A [F/L^3] makes them forces. k: output, square in the facet's layout, leading dimension
/// ld >= its size; overwritten, the block (lambda, lambda) with zeros. Units of an entry: its row's over its column's.
///
/// Errors: NULL_POINTER, STRUCT_SIZE, INVALID_SIZE, NOT_FINITE, DUPLICATE_NODE, DEGENERATE_FACET, PROJECTION_NOT_CONVEX,
/// INVALID_VALUE (layout, quadrature, element_points, neighbour_normals, reserved; weights that are not those of now).
/// Cost: 3 microseconds a pair of two quad4, 4.5 from the fifth on, and 0.1 for every two pairs; allocates nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_facet_tangent(
    facet: *const stickslip_facet,
    n_ab: *const f64,
    n_ac: *const f64,
    n_ab_previous: *const f64,
    n_ac_previous: *const f64,
    traction: *const f64,
    responses: *const stickslip_node_response,
    row_scale: *const f64,
    k: *mut f64,
    ld: i64,
) -> i32 {
    guard(|| {
        let pairs = Pairs::read(facet, [n_ab, n_ac], [n_ab_previous, n_ac_previous])?;
        let n1 = pairs.n1();
        let rule = rule(pairs.raw.quadrature, "facet.quadrature")?;
        let size = 6 * n1 + 3 * nodes_of(pairs.n2);
        let mut k = Matrix::new(k, size, ld, column_major(pairs.raw.layout, "facet.layout")?)?;
        let traction = tractions::<MAX_CORNERS, 3>(traction, n1)?;
        let nodes = node_tangents(&traction[..n1], responses, row_scale)?;
        let sums = facet_sums(&pairs.frame, &pairs)?;
        raw::check_results("k", sums.mass.iter().flatten().chain(&sums.gamma))?;
        let basis = basis(&sums, "n_ab")?;
        let nodes = FacetResponse::new(nodes.each_ref());
        let facet = DualFacet::new((&pairs.frame, rule), &pairs, (&sums, basis.as_ref()), &nodes);
        facet.blocks(|rows, column, block| k.write_rows(rows, column, block))
    })
}
