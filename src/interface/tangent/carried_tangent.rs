//! What carried nodes (`carried.rs`) add to the tangent.

use super::augmented::{NodeCouplings, dtraction};
use super::emission::{Emitter, Place};
use super::union::UnionPair;
use crate::element::{FacetResponse, NodeTangent, PairNow, RowColumns, row_columns};
use crate::error::Result;
use crate::geometry::{Mat3, Vec3};
use crate::interface::pairing::given::Given;
use crate::interface::stages::carried::{multiplier_share, transfer};
use crate::law::NodeResponse;
use crate::mortar::{PAIR_NODES, PairWeights, slots};
use crate::shape::MAX_CORNERS;
use nalgebra::SMatrix;

/// What the gaps of a pair's carried nodes add to their carriers' rows. `carried`: which nodes are; `None` for the pattern
/// alone.
pub fn rows<const N: usize>(
    pair: &UnionPair,
    (now, previous): (Option<&PairNow>, Option<&PairWeights>),
    carried: Option<(&[bool], &[NodeTangent<N>])>,
    emitter: &mut Emitter<N>,
) {
    let (given, normals) = (emitter.given, emitter.normals);
    let moves = given.setup.effects.moves();
    for (k, &a) in given.setup.nonmortar.facets[pair.one].as_slice().iter().enumerate() {
        for &(b, w) in given.carriers_of(a) {
            let mut rows: RowColumns<N> = [[[[0.0; MAX_CORNERS]; N]; 3]; PAIR_NODES];
            if let Some((_, nodes)) = carried.filter(|(carried, _)| carried[a]) {
                let t = transfer(given, a, normals[a], normals[b]) * w;
                let (zero, mut share) = (NodeTangent::default(), NodeTangent::default());
                share.drow_dnow = nodes[b].drow_dnow * t;
                share.drow_dprevious = nodes[b].drow_dprevious * t;
                let slots = std::array::from_fn(|j| if j == k { &share } else { &zero });
                row_columns(moves, (now, previous), &FacetResponse::new(slots), &mut rows);
            }
            let values = rows.map(|columns| columns.map(|rows| rows.map(|nodes| nodes[k])));
            for (node, values) in pair.slots(given.setup).iter().zip(&values).take(slots(moves)) {
                if let Some(node) = *node {
                    emitter.node_row(b, node, values);
                }
            }
        }
    }
}

/// Columns of the carriers' multipliers in A's row.
#[inline(never)]
pub fn multipliers<const N: usize>(a: usize, carried: bool, emitter: &mut Emitter<N>) {
    let given = emitter.given;
    if !given.setup.nodes.is_own(a) || emitter.constraints.is_some() {
        return;
    }
    let scale = if carried { given.row_scale(a) / given.augmentation(a) } else { 0.0 };
    for &(b, w) in given.carriers_of(a) {
        let block = multiplier_share(given, a) * (scale * w);
        emitter.taker.node(Place::Multiplier(a), Place::Multiplier(b), block.as_slice());
    }
}

/// Augmented form: the gaps of a pair's carried nodes in their carriers' tractions.
pub fn couple<const N: usize>(
    (given, normals): (Given<N>, &[Vec3]),
    pair: &UnionPair,
    (now, previous): (Option<&PairNow>, Option<&PairWeights>),
    carried: Option<(&[bool], &[NodeResponse<N>])>,
    couplings: &mut [NodeCouplings],
) -> Result<()> {
    let nodes = pair.slots(given.setup);
    let nodes = &nodes[..slots(given.setup.effects.moves())];
    for (k, &a) in given.setup.nonmortar.facets[pair.one].as_slice().iter().enumerate() {
        for &(b, w) in given.carriers_of(a) {
            let mut dp = (Mat3::zeros(), Mat3::zeros());
            if let Some((_, responses)) = carried.filter(|(carried, _)| carried[a]) {
                let t = transfer(given, a, normals[a], normals[b]) * w;
                let (on_now, on_previous) = dtraction(given, b, &responses[b], normals[b]);
                dp = (on_now * t, on_previous * t);
            }
            couplings[b].add_gap(k, nodes, (now, previous), dp)?;
        }
    }
    Ok(())
}

/// Augmented form: forces of A's traction, which is that of its carriers.
#[inline(never)]
pub fn forces<const N: usize>(
    a: usize,
    couplings: &[NodeCouplings],
    carried: Option<(&[bool], &[NodeResponse<N>])>,
    emitter: &mut Emitter<N>,
) {
    let (given, normals) = (emitter.given, emitter.normals);
    for &(b, w) in given.carriers_of(a) {
        let (mut t, mut dp_dlambda) = (Mat3::zeros(), SMatrix::zeros());
        if let Some((_, responses)) = carried.filter(|(carried, _)| carried[a]) {
            t = transfer(given, a, normals[a], normals[b]).transpose() * w;
            dp_dlambda = responses[b].dp_dlambda;
        }
        for row in couplings[a].forces() {
            let (place, share) = (Place::Displacement(row.node), t * row.weight);
            for column in couplings[b].places() {
                let block = share * column.dtraction;
                emitter.taker.node(place, Place::Displacement(column.node), block.as_slice());
            }
            emitter.taker.node(place, Place::Multiplier(b), (share * dp_dlambda).as_slice());
        }
    }
}
