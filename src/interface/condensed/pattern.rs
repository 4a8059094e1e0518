//! Which entries a condensed matrix has beyond the host's own: a mortar node's rows gain the columns of the rows of the
//! non-mortar nodes above it.

use super::hats::Hats;
use crate::error::Result;
use crate::interface::data::csr::Csr;
use crate::interface::data::surface::{NO_EQUATION, Surface, node_equations};
use crate::interface::pairing::weak::Carrier;
use crate::interface::tangent::by_equations::Sink;
use crate::memory::{self, Store, Stored};

/// The node of a displacement equation on the non-mortar side.
type NodeOf = (i64, usize);

/// The columns that the rows of every non-mortar node have in the host's matrix and by the contact forces.
pub struct Columns {
    nodes: Vec<NodeOf>,
    of_node: Vec<Vec<i64>>,
}

impl Columns {
    /// Those of the host's matrix.
    pub fn of(equations: &[[i64; 3]], csr: &Csr) -> Result<Columns> {
        let mut columns = Columns { nodes: Vec::new(), of_node: memory::defaults(equations.len())? };
        for (a, &e) in equations.iter().enumerate().flat_map(|(a, e)| e.iter().map(move |e| (a, e))) {
            if e != NO_EQUATION {
                columns.nodes.store((e, a))?;
                columns.of_node[a].store_all(csr.row(e)?.map(|place| csr.column(place)))?;
            }
        }
        memory::sort(&mut columns.nodes)?;
        Ok(columns)
    }

    /// Adds an entry of the contact forces.
    pub fn add(&mut self, row: i64, column: i64) -> Result<()> {
        match self.nodes.binary_search_by_key(&row, |n| n.0) {
            Ok(k) => self.of_node[self.nodes[k].1].store(column),
            Err(_) => Ok(()),
        }
    }

    /// Each column once.
    pub fn settle(&mut self) -> Result<()> {
        for columns in &mut self.of_node {
            memory::sort(columns)?;
            columns.dedup();
        }
        Ok(())
    }

    /// Gives the entries of all rows that these pairs of facets of the host, over a mortar side that moves or not, and the nodes
    /// that are carried can change.
    pub fn entries(
        &self,
        (one, two): (&Surface, &Surface),
        carriers: &[Vec<Carrier>],
        (pairs, moves): (&[(usize, usize)], bool),
        sink: &mut dyn Sink,
    ) -> Result<()> {
        let mut gains: Vec<(usize, usize)> = (0..one.len()).map(|a| (a, a)).stored()?;
        let hats = Hats::of(one)?;
        for b in 0..one.len() {
            gains.store_all(hats.get(b).iter().map(|share| (b, share.0)))?;
        }
        for &(f, g) in pairs {
            let own: &[usize] = if one.parents.is_some() { one.host_nodes(f) } else { &[] };
            let mortar: &[usize] = if moves { two.host_nodes(g) } else { &[] };
            for &a in one.host_nodes(f).iter().take(one.multipliers(f)) {
                for b in std::iter::once(a).chain(carriers.get(a).into_iter().flatten().map(|carrier| carrier.0)) {
                    for s in std::iter::once(b).chain(hats.get(b).iter().map(|share| share.0)) {
                        gains.store_all(own.iter().map(|&row| (row, s)))?;
                        gains.store_all(mortar.iter().map(|c| (one.len() + c, s)))?;
                    }
                }
            }
        }
        for (a, carriers) in carriers.iter().enumerate() {
            gains.store_all(carriers.iter().map(|&(b, _)| (a, b)))?;
        }
        memory::sort(&mut gains)?;
        gains.dedup();
        for of_row in gains.chunk_by(|p, q| p.0 == q.0) {
            let mut columns = Vec::new();
            for (_, a) in of_row {
                columns.store_all(self.of_node[*a].iter().copied())?;
            }
            memory::sort(&mut columns)?;
            columns.dedup();
            let row = of_row[0].0;
            for &equation in node_equations((one, two), row).iter().filter(|e| **e != NO_EQUATION) {
                columns.iter().for_each(|&column| sink.add(equation, column, 0.0));
            }
        }
        Ok(())
    }
}
