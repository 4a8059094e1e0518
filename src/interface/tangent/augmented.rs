//! What couples all pairs of a node and is no sum over pairs (docs/formulation.md 5.4): forces of the augmented form use the
//! projected traction, with its derivative n_AB (dp/dsigma) r Dg_A. Of the multiplier form it is n_AB lambda_N Dnu_A where nodes
//! have one multiplier and normals follow the motion.

use crate::element::{PairNow, frozen_rows, gap_rows};
use crate::error::Result;
use crate::geometry::{Mat3, Vec3};
use crate::interface::data::multiplier::direction;
use crate::interface::pairing::given::Given;
use crate::law::NodeResponse;
use crate::memory::Store;
use crate::mortar::{MORTAR, PAIR_NODES, PairWeights};

/// dp/dg_now and dp/dg_previous of a node.
pub fn dtraction<const N: usize>(given: Given<N>, a: usize, response: &NodeResponse<N>, nu: Vec3) -> (Mat3, Mat3) {
    let direction = direction::<N>(nu) * given.augmentation(a);
    (direction * response.drow_dnow, direction * response.drow_dprevious)
}

/// One node that a non-mortar node A is coupled with.
#[derive(Clone, Debug)]
pub struct Coupling {
    /// Index over both surfaces.
    pub node: usize,
    /// Assembled n_AB, or -n_AC: the share of p_A in the node's force [L^2].
    pub weight: f64,
    /// Whether p_A acts on the node now.
    pub acts: bool,
    /// Whether p_A depends on it.
    pub depends: bool,
    /// dp_A / dx of the node.
    pub dtraction: Mat3,
}

/// Everything node A is coupled with, assembled over its pairs.
#[derive(Clone, Debug, Default)]
pub struct NodeCouplings {
    /// In the order in which they were met.
    pub nodes: Vec<Coupling>,
}

impl NodeCouplings {
    /// So many without couplings, in the memory of those that there were.
    pub fn renew(all: &mut Vec<NodeCouplings>, n: usize) -> Result<()> {
        all.truncate(n);
        all.iter_mut().for_each(|node| node.nodes.clear());
        while all.len() < n {
            all.store(NodeCouplings::default())?;
        }
        Ok(())
    }

    /// On the heap `[bytes]`.
    pub fn bytes(&self) -> usize {
        self.nodes.capacity() * size_of::<Coupling>()
    }

    /// Adds a pair in which A is the k-th non-mortar node: these first slots of it. `dp` = (dp/dg_now, dp/dg_previous).
    pub fn add_pair(
        &mut self,
        k: usize,
        nodes: &[Option<usize>],
        (now, previous): (Option<&PairNow>, Option<&PairWeights>),
        dp: (Mat3, Mat3),
    ) -> Result<()> {
        self.add_gap(k, nodes, (now, previous), dp)?;
        self.add_forces(k, nodes, now)
    }

    /// Adds what p_A acts on, of such a pair: these first slots of it.
    pub fn add_forces(&mut self, k: usize, nodes: &[Option<usize>], now: Option<&PairNow>) -> Result<()> {
        let Some(PairNow { weights: w, .. }) = now else { return Ok(()) };
        for (j, node) in nodes.iter().enumerate() {
            let Some(node) = *node else { continue };
            let coupling = self.find(node)?;
            coupling.weight += if j < MORTAR { w.ab[k][j] } else { -w.ac[k][j - MORTAR] };
            coupling.acts = true;
        }
        Ok(())
    }

    /// Adds what p_A depends on: the gap of the k-th non-mortar node of a pair.
    pub fn add_gap(
        &mut self,
        k: usize,
        nodes: &[Option<usize>],
        (now, previous): (Option<&PairNow>, Option<&PairWeights>),
        dp: (Mat3, Mat3),
    ) -> Result<()> {
        let moves = nodes.len() == PAIR_NODES;
        let by_now = now.map(|now| gap_rows(moves, now, k, (&dp.0, &dp.1)));
        let by_previous = previous.map(|weights| frozen_rows(moves, weights, k, &dp.1));
        for (j, node) in nodes.iter().enumerate() {
            let Some(node) = *node else { continue };
            let coupling = self.find(node)?;
            coupling.depends = true;
            for rows in [&by_now, &by_previous].into_iter().flatten() {
                coupling.dtraction += rows[j];
            }
        }
        Ok(())
    }

    /// Adds what p_A depends on a node by.
    pub fn add_traction(&mut self, node: usize, dtraction: Mat3) -> Result<()> {
        let coupling = self.find(node)?;
        coupling.depends = true;
        coupling.dtraction += dtraction;
        Ok(())
    }

    fn find(&mut self, node: usize) -> Result<&mut Coupling> {
        let at = self.nodes.iter().position(|c| c.node == node).unwrap_or(self.nodes.len());
        if at == self.nodes.len() {
            self.nodes.store(Coupling { node, weight: 0.0, acts: false, depends: false, dtraction: Mat3::zeros() })?;
        }
        Ok(&mut self.nodes[at])
    }

    /// The nodes that p_A depends on.
    pub fn places(&self) -> impl Iterator<Item = &Coupling> {
        self.nodes.iter().filter(|c| c.depends)
    }

    /// The nodes that p_A acts on.
    pub fn forces(&self) -> impl Iterator<Item = &Coupling> {
        self.nodes.iter().filter(|c| c.acts)
    }
}
