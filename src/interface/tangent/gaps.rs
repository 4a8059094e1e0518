//! The gaps of the nodes as functions of all places, with their derivatives (docs/formulation 21): what conserving weights are made of.
//! Read from the tables that tangents are made of, facet by facet.

use super::derivatives::PairDerivatives;
use super::emission::{Blocks, Directions, Emitter, MortarBlock, Place, Span, Weights};
use super::facet_table::FacetTable;
use super::linear_facet::{self, LinearRoom};
use super::parents::{self, ParentRoom};
use super::read::{NodeBlock, ReadTable, Through, matrix};
use super::task::{Numbers, Task};
use super::union::{Pairs, UnionPair, Walk};
use crate::element::{FacetResponse, NodeTangent};
use crate::error::Result;
use crate::geometry::{Mat3, Vec3};
use crate::interface::data::active::Active;
use crate::interface::data::conserving::{NodeGap, renew};
use crate::interface::data::extent::Extent;
use crate::interface::data::options::Tangent;
use crate::interface::data::pairs::Weighted;
use crate::interface::pairing::given::Given;
use crate::interface::stages::respond::Responses;
use crate::interface::stages::sums::NodeSums;
use crate::memory;
use crate::normal::nodal_normal_derivative;
use crate::shape::{MAX_CORNERS, MAX_NODES};

/// Takes no block: tables are read.
pub struct Nobody;

impl<const N: usize> Blocks<N> for Nobody {
    fn begin(&mut self, _f: usize) {}
    fn forces(&mut self, _rows: Span, _columns: Span, _values: &[[[[f64; MAX_NODES]; 3]; 3]]) {}
    fn multipliers(&mut self, _rows: Span, _n: &[[f64; MAX_NODES]; MAX_CORNERS], _nu: &[Vec3; MAX_CORNERS]) {}
    fn rows(&mut self, _columns: Span, _values: &[[[[f64; MAX_CORNERS]; N]; 3]]) {}
    fn mortar(&mut self, _block: &MortarBlock) {}
    fn node(&mut self, _row: Place, _column: Place, _values: &[f64]) {}
    fn multiplier_row(&mut self, _row: Place, _columns: &[(usize, Place)], _n: &Weights, _nu: &Directions) {}
    fn diagonal(&mut self, _a: usize, _values: &[f64]) {}
}

/// Where tables of gaps are made.
#[derive(Debug, Default)]
pub struct GapRoom<const N: usize> {
    table: FacetTable,
    linear: LinearRoom,
    parent: ParentRoom,
    row: Vec<NodeBlock>,
    areas: Vec<NodeBlock>,
    tractions: Vec<NodeTangent<N>>,
    responses: Responses<N>,
    /// nu of every node.
    pub normals: Vec<Vec3>,
}

impl<const N: usize> GapRoom<N> {
    /// Begins with the normals of now.
    pub fn begin(&mut self, given: Given<N>) -> Result<()> {
        given.normals_into(&mut self.normals)?;
        memory::refill(&mut self.tractions, NodeTangent::default(), given.nodes())
    }

    /// Gives, of each multiplier of the facet of these pairs and each node that its gap depends on, over both surfaces, place in the facet,
    /// node, weight, Dg and D of what is covered.
    pub fn each(
        &mut self,
        given: Given<N>,
        (active, pairs): (&Active, &[UnionPair]),
        take: &mut dyn FnMut(usize, (usize, f64), Mat3, Vec3) -> Result<()>,
    ) -> Result<()> {
        let setup = given.setup;
        let surface = setup.mortar.analytic.map(|_| setup.mortar.analytic_at(&active.x2)).transpose()?;
        let motion = PairDerivatives { surface: surface.as_ref(), tangent: Tangent::Exact, rule: setup.options.rule };
        let numbers = Numbers::of_weights(active, &self.responses, &self.tractions, motion);
        let task = Task {
            given,
            normals: &self.normals,
            pairs: all(given, active),
            extent: Extent::Whole,
            moves: setup.mortar.analytic.is_none(),
            numbers: Some(&numbers),
        };
        let f = pairs[0].one;
        let table: &dyn ReadTable = if setup.has_parents() {
            parents::fill(task, pairs, &mut self.parent)?;
            self.parent.table()
        } else {
            let two = task.moves.then_some(&setup.mortar);
            self.table.begin(&setup.nonmortar, two, (task.pairs, pairs))?;
            let nodes = FacetResponse::new(setup.nonmortar.facets[f].nodes.map(|a| &self.tractions[a]));
            let (taker, constraints): (&mut dyn Blocks<N>, _) = (&mut Nobody, None);
            let mut emitter = Emitter { given, normals: &self.normals, taker, constraints };
            linear_facet::fill(task, (&numbers, pairs), &nodes, (&mut self.table, &mut self.linear), &mut emitter)?;
            &self.table
        };
        let through = Through { now: Mat3::identity(), ..Through::default() };
        let of_area = Through { area: Vec3::x(), ..Through::default() };
        for k in 0..setup.nonmortar.multipliers(f) {
            table.gap_row(k, &through, &mut self.row)?;
            table.gap_row(k, &of_area, &mut self.areas)?;
            for &(column, node) in table.nodes() {
                let area = matrix(&self.areas[column]).row(0).transpose();
                take(k, (node, table.weight(column, k)), matrix(&self.row[column]), area)?;
            }
        }
        Ok(())
    }
}

/// The pairs of this configuration alone.
pub fn all<'a, const N: usize>(given: Given<N>, active: &'a Active) -> Pairs<'a> {
    match given.setup.has_parents() {
        true => Pairs::Parents([&active.parents, &[]]),
        false => Pairs::Union([&active.pairs, &[]]),
    }
}

/// The gaps of all nodes at the places of `active`, whose normals the step has: with these sums there.
pub fn gaps<const N: usize>(
    given: Given<N>,
    (active, sums): (&Active, &[NodeSums]),
    room: &mut GapRoom<N>,
    gaps: &mut Vec<NodeGap>,
) -> Result<()> {
    let setup = given.setup;
    renew(gaps, given.nodes())?;
    room.begin(given)?;
    for (a, (gap, sum)) in gaps.iter_mut().zip(sums).enumerate() {
        (gap.normal, gap.gap, gap.coverage) = (room.normals[a], sum.gap_now, sum.coverage);
        let keeps = given.step.pairing.keeps_normal.get(a).is_some_and(|kept| *kept);
        if let Some(now) = given.step.now.as_ref().filter(|_| !keeps && gap.coverage > 0.0) {
            gap.sum = setup.nodes.free[a] * now.sums[a];
            gap.turn = nodal_normal_derivative(now.sums[a], &setup.nodes.free[a]);
        }
    }
    let (mut walk, mut pairs) = (Walk::through(all(given, active), 0..usize::MAX), Vec::new());
    while let Some(f) = walk.next(&mut pairs)? {
        let nodes = setup.nonmortar.host_nodes(f);
        room.each(given, (active, &pairs), &mut |k, (node, weight), gap, area| {
            let of = &mut gaps[nodes[k]];
            if of.coverage > 0.0 {
                let on = of.on(node)?;
                on.weight += weight;
                on.gap += gap;
                on.area += area;
            }
            Ok(())
        })?;
    }
    if setup.mortar.analytic.is_some() {
        opposite(given, active, gaps)?;
    }
    for f in 0..setup.nonmortar.host_facets() {
        let nodes = setup.nonmortar.host_nodes(f);
        for (k, &a) in nodes.iter().enumerate().take(setup.nonmortar.multipliers(f)) {
            if gaps[a].turn != Mat3::zeros() {
                let of = setup.nonmortar.normal_derivatives((f, k), &active.x1, &Mat3::identity());
                of.as_slice().iter().try_for_each(|(l, d)| gaps[a].on(nodes[*l]).map(|on| on.sum += d))?;
            }
        }
    }
    Ok(())
}

/// Adds the weights of the points of an analytic surface's frame, which gaps do not depend on where it rests.
fn opposite<const N: usize>(given: Given<N>, active: &Active, gaps: &mut [NodeGap]) -> Result<()> {
    let (one, two) = given.setup.surfaces();
    let mut add = |f: usize, g: usize, n: &dyn Fn(usize, usize) -> f64| -> Result<()> {
        for (k, &a) in one.host_nodes(f).iter().enumerate().take(one.multipliers(f)) {
            for (c, &node) in two.host_nodes(g).iter().enumerate() {
                gaps[a].on(one.len() + node)?.weight -= n(k, c);
            }
        }
        Ok(())
    };
    match active.weighted((one, two)) {
        Weighted::Facets(pairs) => pairs.iter().try_for_each(|p| add(p.one, p.two, &|k, c| p.weights.ac[k][c])),
        Weighted::Parents(pairs) => pairs.iter().try_for_each(|p| add(p.one, p.two, &|k, c| p.weights.ac[k][c])),
    }
}
