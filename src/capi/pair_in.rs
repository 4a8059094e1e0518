//! What comes in of a pair of facets: the pair, its weights and their derivatives, tractions and responses.

use super::facet::{facet, set_neighbours};
use super::layout::column_major;
use super::method::{element_line, rule};
use super::model::{STICKSLIP_MODEL_SOLID, measure, model};
use super::node::stickslip_node_response;
use super::pair_out::slot;
use super::raw;
use super::sized::{self, Sized64};
use super::space::multiplier_space;
use crate::element::NodeTangent;
use crate::error::{Error, Kind, Result};
use crate::features;
use crate::geometry::{Facet, Mat3};
use crate::mortar::{NonmortarFrame, PAIR_NODES, PairWeights, Segment, WeightDerivatives};
use crate::quadrature::Rule;
use crate::shape::{MAX_CORNERS, MAX_NODES};
use nalgebra::{SMatrix, SVector};

/// A pair of facets, non-mortar first. Node order: right-hand, seen from outside each body. Lines of plane and axisymmetric
/// models: the direction from the first node to the second one, turned by a right angle from the first axis towards the second,
/// points INTO the body. (Weights do not depend on it.)
#[repr(C)]
#[derive(Clone, Copy)]
pub struct stickslip_pair {
    /// sizeof(stickslip_pair).
    pub struct_size: u64,
    /// Nodes of the non-mortar facet: 3 (tri3) or 4 (quad4); 6 (tri6), 8 (quad8) or 9 (quad9) where the function takes
    /// quadratic facets: corners, then mid nodes, k between the corners k and k + 1, then the centre. Of a line 2 (line2) or 3
    /// (line3): the ends, then the middle.
    pub n1: i32,
    /// Nodes of the mortar facet, likewise.
    pub n2: i32,
    /// 3 n1 coordinates of the non-mortar facet, node by node (in Fortran x1(3, n1)) [L]; of a line 2 n1, (x, y) or (r, z).
    pub x1: *const f64,
    /// 3 n2 coordinates of the mortar facet, 2 n2 of a line [L].
    pub x2: *const f64,
    /// STICKSLIP_QUADRATURE_...; of quadratic facets at least that of degree 5, with a quad8 or a quad9 12 points of degree 7.
    /// Lines do not use it: theirs is exact.
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
    /// STICKSLIP_SPACE_..., of a quadratic non-mortar facet or a line3.
    pub multiplier_space: i32,
    /// STICKSLIP_MODEL_...; 0 (default), and an older caller's: facets of a solid. The other models have lines.
    pub model: i32,
    /// Of STICKSLIP_MODEL_PLANE alone: the model's thickness [L]; 0 (default): 1.
    pub thickness: f64,
}

// SAFETY: repr(C), struct_size first, integers and raw pointers only.
unsafe impl Sized64 for stickslip_pair {
    const NAME: &'static str = "stickslip_pair";
    const FIRST: usize = 40;
}

impl stickslip_pair {
    /// Whether its facets are lines.
    pub(super) fn is_line(&self) -> bool {
        features::LINES.built && self.model != STICKSLIP_MODEL_SOLID
    }

    /// Whether a facet has more nodes than corners.
    pub(super) fn is_quadratic(&self) -> bool {
        self.n1.max(self.n2) > MAX_CORNERS as i32
    }
}

/// What a caller gives, with numbers that mean something.
#[inline]
pub(super) fn read(p: *const stickslip_pair) -> Result<stickslip_pair> {
    let raw = sized::read(p)?;
    multiplier_space(raw.multiplier_space, "pair.multiplier_space")?;
    measure(model(raw.model, "pair.model")?, raw.thickness, "pair.thickness")?;
    Ok(raw)
}

pub(super) struct Pair {
    pub one: Facet,
    pub two: Facet,
    raw: stickslip_pair,
}

impl Pair {
    #[inline]
    pub fn read(p: *const stickslip_pair) -> Result<Pair> {
        let raw = read(p)?;
        if raw.is_line() {
            let text =
                text!("pair.model is {}; this function takes pairs of solids alone, STICKSLIP_MODEL_SOLID", raw.model);
            return Err(Error::new(Kind::Unsupported, text));
        }
        Pair::of(raw)
    }

    /// Of linear facets.
    #[inline]
    pub fn of(raw: stickslip_pair) -> Result<Pair> {
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

    pub fn derivatives(&self, ab: *const f64, ac: *const f64) -> Result<WeightDerivatives> {
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
pub(super) type Derivatives = [[[[f64; 3]; PAIR_NODES]; MAX_NODES]; MAX_CORNERS];

pub(super) fn flat(d: &Derivatives) -> &[f64] {
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

/// D n numbers at `p` as vectors of the first n of at most K nodes.
pub(super) fn tractions<const K: usize, const D: usize>(p: *const f64, n: usize) -> Result<[SVector<f64, D>; K]> {
    let mut t = [SVector::zeros(); K];
    for (t, v) in t.iter_mut().zip(raw::numbers(p, D * n, "traction")?.chunks_exact(D)) {
        *t = SVector::from_column_slice(v);
    }
    Ok(t)
}

/// What a facet must know of the responses of its nodes, at most K, at its tractions: the first D rows and columns of each.
pub(super) fn node_tangents<const K: usize, const D: usize>(
    traction: &[SVector<f64, D>],
    responses: *const stickslip_node_response,
    row_scale: *const f64,
) -> Result<[NodeTangent<D, D>; K]> {
    let scale = raw::optional_numbers(row_scale, traction.len(), "row_scale")?;
    let mut nodes = [NodeTangent::default(); K];
    for (a, (node, traction)) in nodes.iter_mut().zip(traction).enumerate() {
        let s = scale.map_or(1.0, |s| s[a]);
        let (now, previous) = super::node::read_response(responses, a)?;
        let first = |m: Mat3| SMatrix::from_fn(|i, j| m[(i, j)] * s);
        *node = NodeTangent {
            traction: *traction,
            drow_dnow: first(now),
            drow_dprevious: first(previous),
            ..NodeTangent::default()
        };
    }
    Ok(nodes)
}
