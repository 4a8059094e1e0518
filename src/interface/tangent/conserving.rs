//! The tangent with conserving weights (docs/formulation 21), node by node: what a multiplier's forces and its row depend on are all nodes
//! that its gap depends on at the end of the step or half way.

use super::conserving_numbers::ConservingNumbers;
use super::emission::{Emitter, Place};
use super::turning::{LoneRoom, lone_facets};
use super::union::{Pairs, Walk};
use crate::error::Result;
use crate::geometry::{Mat3, Vec3};
use crate::interface::data::conserving::{NodeForce, NodeGap, Rigid};
use crate::interface::data::extent::Extent;
use crate::interface::data::multiplier::direction;
use crate::interface::pairing::given::Given;
use crate::interface::stages::conserving::parts;
use crate::interface::stages::node::node;
use crate::interface::stages::respond::Responses;
use crate::memory::{self, Store};
use nalgebra::SMatrix;

/// The nodes that each multiplier is coupled with, sorted, of these pairs.
fn coupled<const N: usize>(given: Given<N>, pairs: Pairs, extent: Extent, moves: bool) -> Result<Vec<Vec<usize>>> {
    let (one, two) = given.setup.surfaces();
    let mut all: Vec<Vec<usize>> = memory::defaults(one.len())?;
    let mut add = |f: usize, mortar: &[usize]| -> Result<()> {
        let own = one.host_nodes(f);
        for &a in own.iter().take(one.multipliers(f)) {
            all[a].store_all(own.iter().copied())?;
            all[a].store_all(mortar.iter().copied())?;
        }
        Ok(())
    };
    let (mut walk, mut of_facet, mut mortar) = (Walk::through(pairs, 0..usize::MAX), Vec::new(), Vec::new());
    while let Some(f) = walk.next(&mut of_facet)? {
        mortar.clear();
        for pair in of_facet.iter().filter(|_| moves) {
            mortar.store_all(two.host_nodes(pair.two).iter().map(|c| one.len() + c))?;
        }
        add(f, &mortar)?;
    }
    let mut room = LoneRoom::default();
    lone_facets(given, (pairs, extent), &mut room)?;
    room.lone.iter().try_for_each(|&f| add(f, &[]))?;
    for nodes in &mut all {
        memory::sort(nodes)?;
        nodes.dedup();
    }
    Ok(all)
}

/// All blocks, with numbers or without.
pub fn blocks<const N: usize>(
    (given, pairs, extent): (Given<N>, Pairs, Extent),
    (moves, responses): (bool, Option<&Responses<N>>),
    numbers: Option<&ConservingNumbers<N>>,
    emitter: &mut Emitter<N>,
) -> Result<()> {
    let mut room = NodeBlocks::default();
    for (a, nodes) in coupled(given, pairs, extent, moves)?.iter().enumerate() {
        if !nodes.is_empty() && given.setup.nodes.acts(a) && given.setup.nonmortar.has_row(a) {
            room.begin(nodes)?;
            if let (Some(numbers), Some(responses)) = (numbers, responses) {
                room.fill(given, a, (numbers, responses))?;
            }
            room.emit(a, emitter);
        }
        let own = responses.map_or_else(SMatrix::zeros, |r| r.nodes[a].drow_dlambda);
        emitter.node(a, &own, extent);
    }
    Ok(())
}

/// The blocks of one multiplier.
struct NodeBlocks<const N: usize> {
    nodes: Vec<usize>,
    /// D forces, `[row * nodes + column]`.
    forces: Vec<Mat3>,
    /// D forces by the multiplier, and of its row.
    multiplier: Vec<SMatrix<f64, 3, N>>,
    row: Vec<SMatrix<f64, N, 3>>,
}

impl<const N: usize> Default for NodeBlocks<N> {
    fn default() -> Self {
        NodeBlocks { nodes: Vec::new(), forces: Vec::new(), multiplier: Vec::new(), row: Vec::new() }
    }
}

impl<const N: usize> NodeBlocks<N> {
    fn begin(&mut self, nodes: &[usize]) -> Result<()> {
        let n = nodes.len();
        memory::recopy(&mut self.nodes, nodes)?;
        memory::refill(&mut self.forces, Mat3::zeros(), n * n)?;
        memory::refill(&mut self.multiplier, SMatrix::zeros(), n)?;
        memory::refill(&mut self.row, SMatrix::zeros(), n)
    }

    /// The place of a node; none of those that have no columns.
    fn at(&self, node: usize) -> Option<usize> {
        self.nodes.binary_search(&node).ok()
    }

    fn add(&mut self, [row, column]: [usize; 2], block: Mat3) {
        if let (Some(row), Some(column)) = (self.at(row), self.at(column)) {
            let n = self.nodes.len();
            self.forces[row * n + column] += block;
        }
    }

    fn add_row(&mut self, column: usize, block: SMatrix<f64, N, 3>) {
        if let Some(column) = self.at(column) {
            self.row[column] += block;
        }
    }

    /// Adds all that node A has.
    fn fill(
        &mut self,
        given: Given<N>,
        a: usize,
        (numbers, responses): (&ConservingNumbers<N>, &Responses<N>),
    ) -> Result<()> {
        let known = numbers.known;
        let (now, mean, force) = (&known.gaps[0][a], &known.gaps[1][a], &known.forces[a]);
        let lambda = &numbers.lambda[a];
        let (normal, tangential) = parts(lambda, mean.normal);
        self.forces_of((normal, tangential), (now, mean, force), (a, numbers), Rigid::of(given.setup.surfaces()));
        let traction = direction::<N>(mean.normal) * lambda;
        for (on, d) in mean.nodes.iter().zip(&force.force) {
            let along = mean.normal * mean.normal.transpose();
            if let Some(k) = self.at(on.node) {
                self.multiplier[k] += match N {
                    1 => SMatrix::from_fn(|i, _| d[i]),
                    _ => {
                        (d * mean.normal.transpose() + (Mat3::identity() - along) * on.weight)
                            * direction::<N>(mean.normal)
                    }
                };
            }
            if N == 1 {
                continue;
            }
            // lambda_N and lambda_T turn with nu.
            for by in mean.nodes.iter().filter(|by| by.sum != Mat3::zeros()) {
                let turned = mean.turned(by) * 0.5;
                let normal_by = turned.tr_mul(&traction);
                let tangential_by = turned * -normal - mean.normal * normal_by.transpose();
                self.add([on.node, by.node], d * normal_by.transpose() + tangential_by * on.weight);
            }
        }
        let response = &responses.nodes[a];
        let scale = if given.setup.nodes.is_own(a) { given.row_scale(a) } else { 0.0 };
        let by_gap = response.drow_dnow * scale;
        for on in &now.nodes {
            self.add_row(on.node, by_gap * mean.normal * now.slope(on, force.bound).transpose());
        }
        if N == 1 {
            return Ok(());
        }
        let by_slip = response.drow_dprevious * scale;
        let asked = node(given, a, *lambda, &numbers.sums[a])?;
        let by_area = responses.own.drow_darea(given, (a, asked), (response, mean.coverage)) * scale;
        let by_normal = responses.own.turn(given, a, asked).drow_dnormal * scale + by_gap * force.above;
        for on in &mean.nodes {
            let by_place = by_normal * mean.turned(on) + by_area * on.area.transpose();
            self.add_row(on.node, by_place * 0.5 + by_slip * on.weight);
        }
        for &(k, by, slope) in numbers.slopes.get(a).map_or(&[][..], |slopes| slopes) {
            if let Some(at) = mean.nodes.iter().position(|on| on.node == k) {
                self.add([k, by], tangential * slope.transpose() * 0.5);
                self.add_row(by, by_slip * (force.moved[at] * slope.transpose()) * 0.5);
            }
        }
        Ok(())
    }

    /// lambda_N dD, of the quotient and what it goes along.
    fn forces_of(
        &mut self,
        (normal, _): (f64, Vec3),
        (now, mean, force): (&NodeGap, &NodeGap, &NodeForce),
        (a, numbers): (usize, &ConservingNumbers<N>),
        rigid: Rigid,
    ) {
        for (at, block) in &numbers.curvature.blocks[a] {
            self.add(*at, block * 0.5);
        }
        if force.size == 0.0 || normal == 0.0 {
            return;
        }
        // z turns with the arms of what is taken out.
        let half_spin = force.spin.cross_matrix() * 0.5;
        let own = Mat3::identity() - half_spin;
        let (shift, count) = (rigid.translations(), mean.nodes.len() as f64);
        let q = force.quotient;
        for (k, on) in mean.nodes.iter().enumerate() {
            let arm = force.arms[k].cross_matrix() * force.inverse;
            for (l, by) in mean.nodes.iter().enumerate() {
                let mut dz = arm * (force.arms[l].cross_matrix() * own - force.along[l].cross_matrix() * 0.5);
                dz -= shift * own / count;
                if k == l {
                    dz += own;
                }
                self.add([on.node, by.node], dz * (normal * q));
            }
            let z = force.along[k] * (normal / force.size);
            let part = mean.coverage / now.coverage;
            for by in &now.nodes {
                self.add([on.node, by.node], z * (now.slope(by, now.mean()) * part).transpose());
            }
            for (l, by) in mean.nodes.iter().enumerate() {
                let curved = numbers.curvature.along[a][l] * 0.5;
                let less = mean.slope(by, mean.mean()) + curved - by.area * (0.5 * force.change)
                    + own.tr_mul(&force.along[l]) * (2.0 * q);
                self.add([on.node, by.node], z * -less.transpose());
            }
        }
    }

    fn emit(&self, a: usize, emitter: &mut Emitter<N>) {
        let (n, multiplier) = (self.nodes.len(), Place::Multiplier(a));
        for (k, &row) in self.nodes.iter().enumerate() {
            let place = Place::Displacement(row);
            for (l, &column) in self.nodes.iter().enumerate() {
                emitter.taker.node(place, Place::Displacement(column), self.forces[k * n + l].as_slice());
            }
            emitter.taker.node(place, multiplier, self.multiplier[k].as_slice());
            if emitter.given.setup.nodes.is_own(a) {
                emitter.taker.node(multiplier, place, self.row[k].as_slice());
            }
        }
    }
}
