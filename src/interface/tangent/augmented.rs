//! What couples all pairs of a node and is no sum over pairs (docs/formulation 5.4): forces of the augmented form use the
//! projected traction, with its derivative n_AB (dp/dsigma) r Dg_A. Of the multiplier form it is n_AB lambda_N Dnu_A where nodes
//! have one multiplier and normals follow the motion.

use super::read::{NodeBlock, ReadTable, Through, matrix};
use crate::error::Result;
use crate::geometry::{Mat3, Vec3};
use crate::interface::data::multiplier::direction;
use crate::interface::data::options::Form;
use crate::interface::pairing::given::Given;
use crate::law::NodeResponse;
use crate::memory::Store;

/// Whether the tangent has what couples all pairs of a node.
pub fn is_coupled<const N: usize>(given: Given<N>) -> bool {
    let options = &given.setup.options;
    options.form == Form::Augmented || (options.follows_normals() && N == 1)
}

/// dp/dg_now, dp/dg_previous and dp/dm of a node.
pub fn dtraction<const N: usize>(given: Given<N>, a: usize, response: &NodeResponse<N>, nu: Vec3) -> Through {
    let direction = direction::<N>(nu) * given.augmentation(a);
    Through {
        now: direction * response.drow_dnow,
        previous: direction * response.drow_dprevious,
        area: direction * response.drow_darea,
    }
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

    /// Adds a node that p_A acts on.
    pub fn add_force(&mut self, node: usize, weight: f64) -> Result<()> {
        let coupling = self.find(node)?;
        coupling.weight += weight;
        coupling.acts = true;
        Ok(())
    }

    /// Adds what p_A depends on: the gap of the k-th node of a facet. `dp`: how; `None`: without numbers.
    pub fn add_gap(
        &mut self,
        (table, k): (&dyn ReadTable, usize),
        dp: Option<Through>,
        row: &mut Vec<NodeBlock>,
    ) -> Result<()> {
        if let Some(through) = &dp {
            table.gap_row(k, through, row)?;
        }
        let of = |column: usize| dp.map_or(Mat3::zeros(), |_| matrix(&row[column]));
        table.nodes().iter().try_for_each(|&(column, node)| self.add_traction(node, of(column)))
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
