//! What carried nodes (`carried.rs`) add to the tangent.

use super::augmented::{NodeCouplings, dtraction};
use super::emission::{Emitter, NodeBlock, Place};
use super::read::{ReadTable, Through, square, vector};
use crate::element::NodeTangent;
use crate::error::Result;
use crate::geometry::{Mat3, Vec3};
use crate::interface::pairing::given::Given;
use crate::interface::stages::carried::{multiplier_share, transfer};
use crate::law::NodeResponse;
use nalgebra::SMatrix;

/// What the gaps of a facet's carried nodes add to their carriers' rows. `carried`: which nodes are; `None` for the pattern
/// alone.
pub fn rows<const N: usize>(
    (f, table): (usize, &dyn ReadTable),
    carried: Option<(&[bool], &[NodeTangent<N>])>,
    row: &mut Vec<NodeBlock>,
    emitter: &mut Emitter<N>,
) -> Result<()> {
    let (given, normals) = (emitter.given, emitter.normals);
    let one = &given.setup.nonmortar;
    for (k, &a) in one.host_nodes(f).iter().enumerate().take(one.multipliers(f)) {
        for &(b, w) in given.carriers_of(a) {
            let share = carried.filter(|(carried, _)| carried[a]).map(|(_, nodes)| {
                let t = transfer(given, a, normals[a], normals[b]) * w;
                let [now, previous] = [nodes[b].drow_dnow * t, nodes[b].drow_dprevious * t].map(|d| square(&d));
                Through { now, previous, area: vector(&nodes[b].drow_darea) * w }
            });
            if let Some(through) = &share {
                table.gap_row(k, through, row)?;
            }
            for &(column, node) in table.nodes() {
                let block = share.map_or_else(NodeBlock::default, |_| row[column]);
                emitter.node_rows(b, &[(0, Place::Displacement(node))], &mut [block]);
            }
        }
    }
    Ok(())
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

/// Which nodes are carried, with the law's answers.
pub type Answers<'a, const N: usize> = (&'a [bool], &'a [NodeResponse<N>]);

/// Augmented form: the gap of the k-th node of a facet, A, if it is carried, in its carriers' tractions.
pub fn couple<const N: usize>(
    (given, normals): (Given<N>, &[Vec3]),
    (a, k, table): (usize, usize, &dyn ReadTable),
    (carried, row): (Option<Answers<N>>, &mut Vec<NodeBlock>),
    couplings: &mut [NodeCouplings],
) -> Result<()> {
    for &(b, w) in given.carriers_of(a) {
        let dp = carried.filter(|(carried, _)| carried[a]).map(|(_, responses)| {
            let t = transfer(given, a, normals[a], normals[b]) * w;
            let Through { now, previous, area } = dtraction(given, b, &responses[b], normals[b]);
            Through { now: now * t, previous: previous * t, area: area * w }
        });
        couplings[b].add_gap((table, k), dp, row)?;
    }
    Ok(())
}

/// Augmented form: forces of A's traction, which is that of its carriers.
#[inline(never)]
pub fn forces<const N: usize>(
    a: usize,
    couplings: &[NodeCouplings],
    carried: Option<Answers<N>>,
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
