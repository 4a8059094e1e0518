//! What the functions of pairs (`pair.rs`) do with a pair whose formulas go node by node (`element/nodal.rs`): with a quadratic
//! facet, or of lines. D components a position, at most W nodes a facet.

use super::layout::{Matrix, column_major};
use super::node::stickslip_node_response;
use super::pair_in::{node_tangents, tractions};
use super::raw::{self, Output};
use crate::element::{NodalPair, NodalWeights, NodeTangent};
use crate::error::Result;
use nalgebra::{SMatrix, SVector};

/// n_ab and n_ac of a call, or their derivatives.
pub(super) type Two<T> = [T; 2];

/// Row A of each.
type Weights<const W: usize> = Two<[[f64; W]; W]>;

/// How many derivatives n_ab and n_ac have.
pub(super) fn derivatives<const D: usize>(pair: &NodalPair<D>) -> [usize; 2] {
    let (n1, n2) = pair.n();
    [n1, n2].map(|columns| D * pair.multipliers * columns * (n1 + n2))
}

/// Writes weights; each pointer may be null.
pub(super) fn write_weights<const D: usize, const W: usize>(
    pair: &NodalPair<D>,
    w: NodalWeights<W>,
    to: Two<*mut f64>,
) {
    for (to, (of, columns)) in to.into_iter().zip([(w[0], pair.one.len()), (w[1], pair.two.len())]) {
        let mut to = Output::new(to);
        of[..pair.multipliers].iter().for_each(|row| to.append(&row[..columns]));
    }
}

fn read_weights<const D: usize, const W: usize>(
    pair: &NodalPair<D>,
    of: Two<*const f64>,
    names: [&str; 2],
) -> Result<Weights<W>> {
    let mut w = [[[0.0; W]; W]; 2];
    let columns = [pair.one.len(), pair.two.len()];
    for side in 0..2 {
        let (n, given) = (columns[side], raw::numbers(of[side], pair.multipliers * columns[side], names[side])?);
        for (row, given) in w[side].iter_mut().zip(given.chunks_exact(n)) {
            row[..n].copy_from_slice(given);
        }
    }
    Ok(w)
}

/// The same, or nothing where both are null.
fn optional_weights<const D: usize, const W: usize>(
    pair: &NodalPair<D>,
    of: Two<*const f64>,
    names: [&str; 2],
) -> Result<Option<Weights<W>>> {
    of.iter().any(|p| !p.is_null()).then(|| read_weights(pair, of, names)).transpose()
}

/// `stickslip_pair_gap`.
pub(super) fn gap<const D: usize, const W: usize>(
    pair: &NodalPair<D>,
    n: Two<*const f64>,
    gap: *mut f64,
) -> Result<()> {
    let [ab, ac] = read_weights::<D, W>(pair, n, ["n_ab", "n_ac"])?;
    raw::check(gap, "gap")?;
    write_vectors("gap", &pair.gap([&ab, &ac])[..pair.multipliers], gap)
}

/// `stickslip_pair_residual`; `force` is room for a vector a node.
pub(super) fn residual<const D: usize, const W: usize>(
    pair: &NodalPair<D>,
    n: Two<*const f64>,
    traction: *const f64,
    to: *mut f64,
    force: &mut [SVector<f64, D>],
) -> Result<()> {
    let ([ab, ac], (n1, n2)) = (read_weights::<D, W>(pair, n, ["n_ab", "n_ac"])?, pair.n());
    let traction = tractions::<W, D>(traction, pair.multipliers)?;
    raw::check(to, "force")?;
    let force = &mut force[..n1 + n2];
    for (k, force) in force.iter_mut().enumerate() {
        *force = pair.force([&ab, &ac], &traction[..pair.multipliers], k);
    }
    write_vectors("force", force, to)
}

/// `stickslip_pair_tangent`; `blocks` is room for the matrix, zeros before.
pub(super) fn tangent<const D: usize, const W: usize>(
    pair: &NodalPair<D>,
    (n, dn): (Two<*const f64>, Two<*const f64>),
    previous: Two<*const f64>,
    (traction, responses, row_scale): (*const f64, *const stickslip_node_response, *const f64),
    (layout, k, ld): (i32, *mut f64, i64),
    blocks: &mut [SMatrix<f64, D, D>],
) -> Result<()> {
    let (size, m) = (pair.size(), pair.multipliers);
    let mut k = Matrix::new(k, D * size, ld, column_major(layout, "pair.layout")?)?;
    let now = optional_weights::<D, W>(pair, n, ["n_ab", "n_ac"])?;
    let slopes = match dn.iter().any(|p| !p.is_null()) {
        true => {
            let [n_ab, n_ac] = derivatives(pair);
            Some([raw::numbers(dn[0], n_ab, "dn_ab")?, raw::numbers(dn[1], n_ac, "dn_ac")?])
        }
        false => None,
    };
    let previous = optional_weights::<D, W>(pair, previous, ["n_ab_previous", "n_ac_previous"])?;
    let traction = tractions::<W, D>(traction, m)?;
    let nodes: [NodeTangent<D, D>; W] = node_tangents(&traction[..m], responses, row_scale)?;
    // Nothing is written where a number is out of range.
    let (now, previous) = (now.as_ref().map(|[ab, ac]| ([ab, ac], slopes)), previous.as_ref().map(|[ab, ac]| [ab, ac]));
    let blocks = &mut blocks[..size * size];
    pair.tangent::<W>(now, previous, &nodes[..m], blocks);
    raw::check_blocks("k", blocks)?;
    for (row, blocks) in blocks.chunks_exact(size).enumerate() {
        blocks.iter().enumerate().for_each(|(column, block)| k.write(row, column, block));
    }
    Ok(())
}

/// Writes vectors, if they are in range.
fn write_vectors<const D: usize>(name: &str, of: &[SVector<f64, D>], to: *mut f64) -> Result<()> {
    raw::check_results(name, of.iter().flat_map(|v| v.iter()))?;
    raw::write_each(to, of.iter().flat_map(|v| v.iter().copied()));
    Ok(())
}
