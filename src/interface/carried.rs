//! Weakly covered nodes in the four stages: their gaps count in the rows of the nodes that carry them (`weak.rs`).
//!
//! With F_A the projector on A's free directions, T_AB = F_A; with one multiplier a node, T_AB = nu_B nu_A^T:
//!
//! - gaps and coverage of a carrier: g_B + sum_A w_AB T_AB g_A, for each of its gaps;
//! - A's row: (sum_B w_AB F_A lambda_B - lambda_A) / r_A, linear; with one multiplier without F_A;
//! - A's projected traction: p_A = sum_B w_AB T_AB^T p_B, which the forces of the augmented form use.
//!
//! A node counts as carried while it is covered; uncovered it has the row of any uncovered node.

use super::assembly::UnionPair;
use super::augmented::NodeCouplings;
use super::emission::{Equations, Sink};
use super::history::History;
use super::nodes::NodeSums;
use super::weak::{self, Carrier};
use super::{Contact, NO_EQUATION};
use crate::element::{FacetResponse, NodeTangent, PairNow, RowColumns, row_columns};
use crate::error::{Error, Kind, Result};
use crate::geometry::{Mat3, Vec3};
use crate::law::NodeResponse;
use crate::memory::{Store, Stored};
use crate::mortar::{MORTAR, PAIR_NODES};
use crate::shape::MAX_NODES;
use nalgebra::{SMatrix, SVector};

impl<const N: usize> Contact<N> {
    /// The carriers of every node, by the history.
    pub(super) fn find_carriers(&self, h: &History, coverable: &[bool]) -> Result<Vec<Vec<Carrier>>> {
        let threshold = self.options.weak_coverage;
        if threshold == 0.0 || !h.integrated {
            return Ok(Vec::new());
        }
        let fraction = |a: usize| {
            let f = h.coverage[a] / h.areas[a];
            if f > self.options.coverage_min { f } else { 0.0 }
        };
        let nodes = weak::Nodes {
            fraction: &(0..self.nonmortar.len()).map(fraction).stored()?,
            coverable,
            has_multiplier: &|a| self.multiplier_equations[a].iter().any(|&e| e != NO_EQUATION),
        };
        weak::carriers(&nodes, &weak::links(&self.nonmortar, h)?, threshold)
    }

    /// The nodes that carry node A; none where it has a multiplier of its own.
    pub(super) fn carriers_of(&self, a: usize) -> &[Carrier] {
        self.carriers.get(a).map_or(&[], |c| c)
    }

    /// Which nodes are carried here, at these sums; empty where none is.
    pub(super) fn carried(&self, sums: &[NodeSums]) -> Result<Vec<bool>> {
        let covered = |a: usize| sums[a].coverage > self.options.coverage_min * self.history.areas[a];
        let carried = |a: usize| !self.carriers_of(a).is_empty() && covered(a);
        if self.carriers.is_empty() { Ok(Vec::new()) } else { (0..sums.len()).map(carried).stored() }
    }

    /// Sums of several handles: a node's carriers would have to be known to all of them.
    pub(super) fn refuse_carrying_over_handles(&self) -> Result<()> {
        if self.options.weak_coverage > 0.0 {
            let text = "sums with weak_coverage > 0: weakly covered nodes are carried within one handle only";
            return Err(Error::new(Kind::Unsupported, text));
        }
        Ok(())
    }

    /// T_AB.
    fn transfer(&self, a: usize, nu_a: Vec3, nu_b: Vec3) -> Mat3 {
        if N == 1 { nu_b * nu_a.transpose() } else { self.free[a] }
    }

    /// d (row of A) / d lambda_B, times r_A.
    pub(super) fn multiplier_share(&self, a: usize) -> SMatrix<f64, N, N> {
        SMatrix::from_fn(|i, j| if N == 1 { 1.0 } else { self.free[a][(i, j)] })
    }

    /// The sums of each node that carries others, theirs added.
    pub(super) fn carriers_sums(
        &self,
        sums: &[NodeSums],
        carried: &[bool],
        normals: &[Vec3],
    ) -> Result<Vec<(usize, NodeSums)>> {
        let mut nodes = Vec::new();
        for a in (0..carried.len()).filter(|&a| carried[a]) {
            nodes.store_all(self.carriers_of(a).iter().map(|&(b, _)| b))?;
        }
        nodes.sort_unstable();
        nodes.dedup();
        let mut all = nodes.iter().map(|&b| (b, sums[b])).stored()?;
        for a in (0..carried.len()).filter(|&a| carried[a]) {
            for &(b, w) in self.carriers_of(a) {
                let (t, own) = (self.transfer(a, normals[a], normals[b]) * w, &sums[a]);
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
    pub(super) fn carry(
        &self,
        lambda: &[SVector<f64, N>],
        sums: &[NodeSums],
        carried: &[bool],
        responses: &mut [NodeResponse<N>],
    ) -> Result<()> {
        let normals = self.all_normals()?;
        for (b, sum) in self.carriers_sums(sums, carried, &normals)? {
            let NodeResponse { gap_normal, slip, .. } = responses[b];
            responses[b] = NodeResponse { gap_normal, slip, ..(self.kernels.respond)(&self.node(b, lambda[b], &sum)?) };
        }
        for a in (0..carried.len()).filter(|&a| carried[a]) {
            responses[a] = self.carried_response(a, lambda, responses, &normals);
        }
        Ok(())
    }

    /// The answer of a carried node: its carriers' traction, the state of the one with the largest share.
    fn carried_response(
        &self,
        a: usize,
        lambda: &[SVector<f64, N>],
        responses: &[NodeResponse<N>],
        normals: &[Vec3],
    ) -> NodeResponse<N> {
        let (r, mut largest) = (self.augmentation(a), 0.0);
        let NodeResponse { gap_normal, slip, .. } = responses[a];
        let mut response = NodeResponse { gap_normal, slip, ..NodeResponse::uncovered(&lambda[a], r) };
        for &(b, w) in self.carriers_of(a) {
            response.traction += self.transfer(a, normals[a], normals[b]).transpose() * responses[b].traction * w;
            response.row += self.multiplier_share(a) * lambda[b] * (w / r);
            if w > largest {
                (response.state, largest) = (responses[b].state, w);
            }
        }
        response.sigma = response.traction;
        response
    }

    /// What the gaps of a pair's carried nodes add to their carriers' rows. `carried`: `None` for the pattern alone.
    pub(super) fn emit_carried<const MOVES: bool>(
        &self,
        pair: &UnionPair,
        now: Option<&PairNow>,
        carried: Option<(&[bool], &[NodeTangent<N>])>,
        normals: &[Vec3],
        sink: &mut dyn Sink,
    ) {
        let (one, two) = (&self.nonmortar.facets[pair.one], &self.mortar.facets[pair.two]);
        for (k, &a) in one.as_slice().iter().enumerate() {
            for &(b, w) in self.carriers_of(a) {
                let mut rows: RowColumns<N> = [[[[0.0; MAX_NODES]; N]; 3]; PAIR_NODES];
                if let Some((_, nodes)) = carried.filter(|(carried, _)| carried[a]) {
                    let t = self.transfer(a, normals[a], normals[b]) * w;
                    let (zero, mut share) = (NodeTangent::default(), NodeTangent::default());
                    share.drow_dnow = nodes[b].drow_dnow * t;
                    share.drow_dprevious = nodes[b].drow_dprevious * t;
                    let slots = std::array::from_fn(|j| if j == k { &share } else { &zero });
                    row_columns::<MOVES, N>(now, pair.previous, &FacetResponse::new(slots), &mut rows);
                }
                let values = rows.map(|columns| columns.map(|rows| rows.map(|nodes| nodes[k])));
                let equations = &self.multiplier_equations[b];
                let (own, other) = values.split_at(MORTAR);
                let columns = Equations::of(one, &self.nonmortar.equations);
                sink.add_block(equations, columns.columns(), own.as_flattened().as_flattened());
                if MOVES {
                    let columns = Equations::of(two, &self.mortar.equations);
                    sink.add_block(equations, columns.columns(), other.as_flattened().as_flattened());
                }
            }
        }
    }

    /// Columns of the carriers' multipliers in A's row.
    pub(super) fn emit_carriers(&self, a: usize, carried: bool, sink: &mut dyn Sink) {
        if !self.owned[a] {
            return;
        }
        let scale = if carried { self.row_scale(a) / self.augmentation(a) } else { 0.0 };
        for &(b, w) in self.carriers_of(a) {
            let block = self.multiplier_share(a) * (scale * w);
            sink.add_block(&self.multiplier_equations[a], &self.multiplier_equations[b], block.as_slice());
        }
    }

    /// Augmented form: the gaps of a pair's carried nodes in their carriers' tractions.
    pub(super) fn couple_carried<const MOVES: bool>(
        &self,
        pair: &UnionPair,
        now: Option<&PairNow>,
        carried: Option<(&[bool], &[NodeResponse<N>])>,
        normals: &[Vec3],
        couplings: &mut [NodeCouplings],
    ) -> Result<()> {
        let slots = self.slots(pair);
        for (k, &a) in self.nonmortar.facets[pair.one].as_slice().iter().enumerate() {
            for &(b, w) in self.carriers_of(a) {
                let mut dp = (Mat3::zeros(), Mat3::zeros());
                if let Some((_, responses)) = carried.filter(|(carried, _)| carried[a]) {
                    let t = self.transfer(a, normals[a], normals[b]) * w;
                    let (on_now, on_previous) = self.dtraction(b, &responses[b], normals[b]);
                    dp = (on_now * t, on_previous * t);
                }
                couplings[b].add_gap::<MOVES>(k, &slots, now, pair.previous, dp)?;
            }
        }
        Ok(())
    }

    /// Augmented form: forces of A's traction, which is that of its carriers.
    pub(super) fn emit_carried_forces(
        &self,
        a: usize,
        couplings: &[NodeCouplings],
        carried: Option<(&[bool], &[NodeResponse<N>])>,
        normals: &[Vec3],
        sink: &mut dyn Sink,
    ) {
        for &(b, w) in self.carriers_of(a) {
            let (mut t, mut dp_dlambda) = (Mat3::zeros(), SMatrix::zeros());
            if let Some((_, responses)) = carried.filter(|(carried, _)| carried[a]) {
                t = self.transfer(a, normals[a], normals[b]).transpose() * w;
                dp_dlambda = responses[b].dp_dlambda;
            }
            for row in couplings[a].forces() {
                let (equations, share) = (self.equations(row.node), t * row.weight);
                for column in &couplings[b].nodes {
                    sink.add_block(equations, self.equations(column.node), (share * column.dtraction).as_slice());
                }
                sink.add_block(equations, &self.multiplier_equations[b], (share * dp_dlambda).as_slice());
            }
        }
    }
}
