//! What passes through every node, and what the nodes of both sides get of it (docs/formulation 17.1).

use super::rows::Row;
use crate::error::{Error, Kind, Result};
use crate::geometry::Vec3;
use crate::interface::pairing::given::Given;
use crate::interface::stages::sums::NodeSums;
use crate::law::{Conductance, HeatFlow, HeatNode, NodeResponse, heat_flow};
use crate::memory::{self, Stored};

/// Where temperatures and contact are.
#[derive(Clone, Copy)]
pub struct Place<'a, const N: usize> {
    /// The interface and its step.
    pub given: Given<'a, N>,
    /// Positions of both sides.
    pub x: [&'a [Vec3]; 2],
    /// Temperatures of both sides [K].
    pub temperatures: [&'a [f64]; 2],
    /// The law's answers.
    pub responses: &'a [NodeResponse<N>],
    /// What friction takes, where it acts at points; else it follows from the answers.
    pub work: Option<&'a [f64]>,
    /// What the nodes assemble.
    pub sums: &'a [NodeSums],
    /// How heat passes.
    pub conductance: &'a Conductance,
}

impl<const N: usize> Place<'_, N> {
    /// T of a node over both surfaces.
    pub fn temperature(&self, node: usize) -> f64 {
        let n1 = self.x[0].len();
        if node < n1 { self.temperatures[0][node] } else { self.temperatures[1][node - n1] }
    }

    /// x of such a node.
    pub fn position(&self, node: usize) -> Vec3 {
        let n1 = self.x[0].len();
        if node < n1 { self.x[0][node] } else { self.x[1][node - n1] }
    }

    /// Its offset, with the sign that n_AB and - n_AC give it in o_A.
    pub fn offset(&self, node: usize) -> f64 {
        let (one, two) = self.given.setup.surfaces();
        if node < one.len() { one.offset(node) } else { -two.offset(node - one.len()) }
    }

    /// Node A, if anything covers it and its multiplier acts here.
    fn node(&self, a: usize, row: &Row) -> Result<Option<HeatNode>> {
        let (given, response) = (self.given, &self.responses[a]);
        let area = row.area(self.x[0].len());
        if !given.setup.nodes.acts(a) || !(area > given.least_coverage(a)) {
            return Ok(None);
        }
        let (nu, at, own) = (given.normal(a)?, self.x[0][a], self.temperatures[0][a]);
        let gap = row.sum(|node| nu.dot(&(self.position(node) - at)) + self.offset(node));
        Ok(Some(HeatNode {
            jump: row.sum(|node| self.temperature(node) - own),
            pressure: (-nu.dot(&response.traction)).max(0.0),
            gap,
            area,
            work: self.work.map_or_else(|| response.traction.dot(&response.slip), |work| work[a]),
        }))
    }

    /// What passes through every node; nothing through those that do not act here, or that nothing covers.
    pub fn flows(&self, rows: &[Row]) -> Result<Vec<(HeatNode, HeatFlow)>> {
        let flow = |(a, row): (usize, &Row)| {
            let Some(node) = self.node(a, row)? else { return Ok(Default::default()) };
            let flow = heat_flow(self.conductance, &node);
            if flow.sides.iter().chain(flow.slopes.as_flattened()).all(|v| v.is_finite()) {
                return Ok((node, flow));
            }
            let text =
                text!("the heat of non-mortar node {a} overflows; temperatures or conductances are out of range");
            Err(Error::new(Kind::NotFinite, text))
        };
        rows.iter().enumerate().map(flow).stored_if_ok()
    }
}

/// What leaves the nodes of the non-mortar and of the mortar side [F L/T]: sum_A n_AB times what leaves the one body, - sum_A n_AC
/// times what enters the other one.
pub fn sides<const N: usize>(at: &Place<N>, rows: &[Row], flows: &[(HeatNode, HeatFlow)]) -> Result<[Vec<f64>; 2]> {
    let (n1, n2) = (at.x[0].len(), at.x[1].len());
    let (mut one, mut two) = (memory::filled(0.0, n1)?, memory::filled(0.0, n2)?);
    for (row, (_, flow)) in rows.iter().zip(flows) {
        for column in &row.columns {
            match column.node.checked_sub(n1) {
                None => one[column.node] += column.n * flow.sides[0],
                Some(c) => two[c] += column.n * flow.sides[1],
            }
        }
    }
    Ok([one, two])
}
