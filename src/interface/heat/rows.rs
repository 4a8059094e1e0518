//! What each non-mortar node assembles over its pairs for heat: its weights, and what their derivatives make of temperatures,
//! areas and gaps.

use crate::error::Result;
use crate::geometry::{Mat3, Vec3};
use crate::interface::data::pairs::Weighted;
use crate::interface::data::surface::Surface;
use crate::interface::weights::each_weight;
use crate::memory::{self, Store};

/// A node that the weights of node A join it with, itself among them.
#[derive(Clone, Copy, Debug)]
pub struct Column {
    /// Index over both surfaces.
    pub node: usize,
    /// n_AB, or - n_AC [L^2].
    pub n: f64,
    /// The same at t_n.
    pub before: f64,
    /// DW_A with respect to the node's position, from here on as far as weights change.
    pub area: Vec3,
    /// DJ_A.
    pub jump: Vec3,
    /// Dg_A.
    pub gap: Mat3,
    /// Do_A of the offsets.
    pub offset: Vec3,
    /// Of tied surfaces what their first gap, which turns with the facets, adds to the gap that tractions are of.
    pub turned: Mat3,
}

/// The columns of one node.
#[derive(Debug, Default)]
pub struct Row {
    /// In the order in which they were met.
    pub columns: Vec<Column>,
}

impl Row {
    /// The place of a node among the columns; it becomes one.
    pub fn place(&mut self, node: usize) -> Result<usize> {
        if let Some(place) = self.columns.iter().position(|column| column.node == node) {
            return Ok(place);
        }
        let (v, m) = (Vec3::zeros(), Mat3::zeros());
        self.columns.store(Column { node, n: 0.0, before: 0.0, area: v, jump: v, gap: m, offset: v, turned: m })?;
        Ok(self.columns.len() - 1)
    }

    /// sum_k n_Ak v_k with v counted from that of node A: sums of n_AB and of n_AC are the same.
    pub fn sum(&self, value: impl Fn(usize) -> f64) -> f64 {
        self.columns.iter().map(|column| column.n * value(column.node)).sum()
    }

    /// W_A, of which the first `n1` nodes have shares [L^2].
    pub fn area(&self, n1: usize) -> f64 {
        self.columns.iter().filter(|column| column.node < n1).map(|column| column.n).sum()
    }
}

/// The rows of all nodes with the weights of now, and of t_n where these are given.
pub fn rows((one, two): (&Surface, &Surface), now: Weighted, previous: Option<Weighted>) -> Result<Vec<Row>> {
    let mut rows: Vec<Row> = memory::defaults(one.len())?;
    each_weight((one, two), now, &mut |a, node, n| {
        let place = rows[a].place(node)?;
        rows[a].columns[place].n += n;
        Ok(())
    })?;
    if let Some(previous) = previous {
        each_weight((one, two), previous, &mut |a, node, n| {
            let place = rows[a].place(node)?;
            rows[a].columns[place].before += n;
            Ok(())
        })?;
    }
    Ok(rows)
}
