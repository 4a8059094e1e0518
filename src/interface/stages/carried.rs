//! Weakly covered nodes: their gaps count in the rows of the nodes that carry them (`weak.rs`). What that adds to the
//! tangent: `carried_tangent.rs`.
//!
//! With F_A the projector on A's free directions, T_AB = F_A; with one multiplier a node, T_AB = nu_B nu_A^T:
//!
//! - gaps and coverage of a carrier: g_B + sum_A w_AB T_AB g_A, for each of its gaps;
//! - A's row: (sum_B w_AB F_A lambda_B - lambda_A) / r_A, linear; with one multiplier without F_A;
//! - A's projected traction: p_A = sum_B w_AB T_AB^T p_B, which the forces of the augmented form use.
//!
//! A node counts as carried while it is covered; uncovered it has the row of any uncovered node.

use super::node::node;
use super::own::OwnAnswers;
use super::sums::NodeSums;
use crate::error::Result;
use crate::geometry::{Mat3, Vec3};
use crate::interface::pairing::given::Given;
use crate::law::NodeResponse;
use crate::memory::{self, Store, Stored};
use nalgebra::{SMatrix, SVector};

/// Which nodes are carried here, at these sums; empty where none is.
pub fn carried<const N: usize>(given: Given<N>, sums: &[NodeSums]) -> Result<Vec<bool>> {
    let mut all = Vec::new();
    find_carried(given, sums, &mut all)?;
    Ok(all)
}

/// The same, in place of what was in `all`.
pub fn find_carried<const N: usize>(given: Given<N>, sums: &[NodeSums], all: &mut Vec<bool>) -> Result<()> {
    let covered = |a: usize| sums[a].coverage > given.least_coverage(a);
    let carried = |a: usize| !given.carriers_of(a).is_empty() && covered(a);
    all.clear();
    let nodes = if given.step.pairing.carriers.is_empty() { 0 } else { sums.len() };
    all.store_all((0..nodes).map(carried))
}

/// T_AB.
pub fn transfer<const N: usize>(given: Given<N>, a: usize, nu_a: Vec3, nu_b: Vec3) -> Mat3 {
    transfer_of(N, &given.setup.nodes.free[a], nu_a, nu_b)
}

/// The same by the components of a multiplier and the free directions of A.
pub fn transfer_of(components: usize, free: &Mat3, nu_a: Vec3, nu_b: Vec3) -> Mat3 {
    if components == 1 { nu_b * nu_a.transpose() } else { *free }
}

/// d (row of A) / d lambda_B, times r_A.
pub fn multiplier_share<const N: usize>(given: Given<N>, a: usize) -> SMatrix<f64, N, N> {
    let share = multiplier_share_of(N, &given.setup.nodes.free[a]);
    SMatrix::from_fn(|i, j| share[(i, j)])
}

/// The same by the components of a multiplier and the free directions of A, in the first rows and columns.
pub fn multiplier_share_of(components: usize, free: &Mat3) -> Mat3 {
    if components == 1 { Mat3::identity() } else { *free }
}

/// The sums of each node that carries others, theirs added.
pub fn carriers_sums<const N: usize>(
    given: Given<N>,
    sums: &[NodeSums],
    carried: &[bool],
    normals: &[Vec3],
) -> Result<Vec<(usize, NodeSums)>> {
    let mut nodes = Vec::new();
    for a in (0..carried.len()).filter(|&a| carried[a]) {
        nodes.store_all(given.carriers_of(a).iter().map(|&(b, _)| b))?;
    }
    memory::sort(&mut nodes)?;
    nodes.dedup();
    let mut all = nodes.iter().map(|&b| (b, sums[b])).stored()?;
    for a in (0..carried.len()).filter(|&a| carried[a]) {
        for &(b, w) in given.carriers_of(a) {
            let (t, own) = (transfer(given, a, normals[a], normals[b]) * w, &sums[a]);
            let at = nodes.binary_search(&b).expect("all carriers are among the nodes");
            let sum = &mut all[at].1;
            sum.coverage += w * own.coverage;
            sum.coverage_previous += w * own.coverage_previous;
            sum.gap_now += t * own.gap_now;
            sum.gap_previous += t * own.gap_previous;
            sum.gap_committed += t * own.gap_committed;
        }
    }
    Ok(all)
}

/// Turns the law's answers to the nodes' own sums into those of carriers and of nodes that are carried. The gap and
/// the slip that are reported stay the nodes' own.
pub fn carry<const N: usize>(
    given: Given<N>,
    lambda: &[SVector<f64, N>],
    (sums, carried): (&[NodeSums], &[bool]),
    responses: &mut [NodeResponse<N>],
    own: &mut OwnAnswers,
) -> Result<()> {
    let normals = given.normals()?;
    for (b, sum) in carriers_sums(given, sums, carried, &normals)? {
        let NodeResponse { gap_normal, slip, .. } = responses[b];
        let node = node(given, b, lambda[b], &sum)?;
        responses[b] = NodeResponse { gap_normal, slip, ..own.respond(given, b, (node, &sum))? };
    }
    for a in (0..carried.len()).filter(|&a| carried[a]) {
        responses[a] = carried_response(given, a, lambda, responses, &normals);
    }
    Ok(())
}

/// The answer of a carried node: its carriers' traction, the state of the one with the largest share.
fn carried_response<const N: usize>(
    given: Given<N>,
    a: usize,
    lambda: &[SVector<f64, N>],
    responses: &[NodeResponse<N>],
    normals: &[Vec3],
) -> NodeResponse<N> {
    let (r, mut largest) = (given.augmentation(a), 0.0);
    let NodeResponse { gap_normal, slip, .. } = responses[a];
    let mut response = NodeResponse { gap_normal, slip, ..NodeResponse::uncovered(&lambda[a], r) };
    for &(b, w) in given.carriers_of(a) {
        response.traction += transfer(given, a, normals[a], normals[b]).transpose() * responses[b].traction * w;
        response.row += multiplier_share(given, a) * lambda[b] * (w / r);
        if w > largest {
            (response.state, largest) = (responses[b].state, w);
        }
    }
    response.sigma = response.traction;
    response
}
