//! The tangent with friction where points decide (docs/formulation.md 16.7), as without it (`points.rs`): sums over nodes A of products of
//! what sigma_A acts on and of what it depends on. At a point dt = v N_A dsigma_NA + D N_A dsigma_TA, v = dt / dsigma_N and D what is left
//! of the projection's derivative; dsigma_A = dlambda_A + (rhat_A / D_A) dg_A, taken apart by nu_A and T_A.

use super::emission::{Emitter, NodeBlock, Place};
use super::points::PointNumbers;
use super::star::{Around, Star};
use super::union::Pairs;
use crate::error::Result;
use crate::geometry::{Mat3, Vec3};
use crate::interface::data::points::Points;
use crate::interface::pairing::given::Given;
use crate::memory::{self, Store};
use crate::shape::MAX_CORNERS;

/// By sigma_N and by sigma_T of one node.
#[derive(Clone, Copy, Debug, Default)]
struct Both {
    normal: Vec3,
    along: Mat3,
}

impl Both {
    fn add(&mut self, other: &Both, by: f64) {
        self.normal += other.normal * by;
        self.along += other.along * by;
    }
}

/// A node that sigma_A acts on and depends on.
#[derive(Clone, Copy, Debug, Default)]
struct Neighbour {
    force: Both,
    /// d sigma_A / dx, before it is taken apart.
    slope: f64,
}

/// A multiplier whose row sigma_A or lambda_A is in.
#[derive(Clone, Copy, Debug, Default)]
struct Row {
    /// Of int N_B t_N, by sigma_NA.
    normal: f64,
    /// Of int N_B t_T.
    along: Both,
    left: f64,
}

/// What depends on sigma_A of one node, and what it depends on.
#[derive(Debug, Default)]
struct OfNode {
    star: Star,
    /// Beside the star's.
    neighbours: Vec<Neighbour>,
    rows: Vec<Row>,
    columns: Vec<(usize, Place)>,
    blocks: Vec<NodeBlock>,
}

impl OfNode {
    fn begin<const N: usize>(&mut self, given: Given<N>, a: usize, around: &Around) -> Result<()> {
        self.star.begin(given, a, around)?;
        memory::refill(&mut self.neighbours, Neighbour::default(), self.star.nodes.len())?;
        memory::refill(&mut self.rows, Row::default(), self.star.rows.len())
    }

    /// Adds what a facet has of A.
    fn add<const N: usize>(&mut self, given: Given<N>, a: usize, f: usize, points: &Points) {
        let (one, two) = given.setup.surfaces();
        let Ok(at) = points.facets.binary_search_by_key(&f, |facet| facet.one) else { return };
        let (facet, friction) = (&points.facets[at], &points.friction);
        let Some(l) = facet.nodes().iter().position(|&b| b == a) else { return };
        let (is_covered, slope, moves) = (points.is_covered[a], friction.nodes[a].slope, given.setup.effects.moves());
        for (k, &b) in facet.nodes().iter().enumerate().filter(|(_, b)| points.is_covered[**b]) {
            if let Some(row) = self.star.row(b) {
                self.rows[row].left += facet.mass[k][l] + points.factors[b] * facet.stabilisation[k][l];
            }
        }
        if !is_covered {
            return;
        }
        let mut own = [Both::default(); MAX_CORNERS];
        for place in facet.places() {
            let (pair, mut other) = (&points.pairs[place], [Both::default(); MAX_CORNERS]);
            for q in friction.of_pair(place) {
                let (point, h) = (&friction.points[q], &friction.answers[q].derivative);
                let normal = h * facet.normal;
                let acts = Both { normal, along: h - normal * facet.normal.transpose() };
                let by = point.weight * point.own[l];
                own.iter_mut().zip(&point.own).for_each(|(sum, n)| sum.add(&acts, by * n));
                other.iter_mut().zip(&point.other).for_each(|(sum, n)| sum.add(&acts, by * n));
            }
            for (k, &b) in facet.nodes().iter().enumerate() {
                self.neighbours[self.star.place(b)].slope += slope * pair.dual.ab[l][k];
            }
            for (k, &c) in two.host_nodes(pair.two).iter().enumerate().filter(|_| moves) {
                let neighbour = &mut self.neighbours[self.star.place(one.len() + c)];
                neighbour.force.add(&other[k], -1.0);
                neighbour.slope -= slope * pair.dual.ac[l][k];
            }
        }
        for (k, &b) in facet.nodes().iter().enumerate() {
            self.neighbours[self.star.place(b)].force.add(&own[k], 1.0);
            if let Some(row) = self.star.row(b).filter(|_| points.is_covered[b]) {
                let (row, normal) = (&mut self.rows[row], facet.normal.dot(&own[k].normal));
                row.normal += normal;
                row.along.add(&Both { normal: own[k].normal - facet.normal * normal, along: own[k].along }, 1.0);
            }
        }
    }

    fn emit<const N: usize>(
        &mut self,
        given: Given<N>,
        a: usize,
        points: Option<&Points>,
        emitter: &mut Emitter<N>,
    ) -> Result<()> {
        let areas = &given.history().areas;
        self.columns.clear();
        self.columns.store_all(self.star.nodes.iter().map(|node| Place::Displacement(*node)).enumerate())?;
        self.columns.sort_unstable_by_key(|(k, place)| (emitter.taker.order(*place), *k));
        memory::refill(&mut self.blocks, NodeBlock::default(), self.neighbours.len())?;
        let node = points.map_or_else(Default::default, |points| points.friction.nodes[a]);
        let is_covered = points.is_some_and(|points| points.is_covered[a]);
        let of_sigma = |both: &Both| both.normal * node.normal.transpose() + both.along * node.along;
        for (&node, row) in self.star.nodes.iter().zip(&self.neighbours) {
            let by_sigma = of_sigma(&row.force);
            fill(&mut self.blocks, &self.neighbours, &by_sigma);
            emitter.taker.row(Place::Displacement(node), &self.columns, &self.blocks);
            emitter.taker.node(Place::Displacement(node), Place::Multiplier(a), by_sigma.as_slice());
        }
        for (&b, row) in self.star.rows.iter().zip(&self.rows) {
            let own = points.map_or_else(Default::default, |points| points.friction.nodes[b]);
            let scale = given.row_scale(b) / (given.augmentation(b) * areas[b]);
            let normal = own.normal * node.normal.transpose();
            let by_sigma = (normal * row.normal + own.along * of_sigma(&row.along)) * scale;
            fill(&mut self.blocks, &self.neighbours, &by_sigma);
            emitter.taker.row(Place::Multiplier(b), &self.columns, &self.blocks);
            let mut by_lambda = by_sigma - (normal + own.along * node.along) * (scale * row.left);
            if b == a {
                let held = Mat3::identity() - if is_covered { given.setup.nodes.free[a] } else { Mat3::zeros() };
                by_lambda -= held * (scale * areas[a]);
            }
            emitter.taker.node(Place::Multiplier(b), Place::Multiplier(a), by_lambda.as_slice());
        }
        Ok(())
    }
}

/// The blocks of a row whose derivative by sigma_A is this.
fn fill(blocks: &mut [NodeBlock], columns: &[Neighbour], by_sigma: &Mat3) {
    for (block, column) in blocks.iter_mut().zip(columns) {
        for j in 0..3 {
            let by = by_sigma.column(j) * column.slope;
            block[j] = [by.x, by.y, by.z, 0.0];
        }
    }
}

/// All blocks.
pub fn blocks<const N: usize>(
    (given, pairs): (Given<N>, Pairs),
    numbers: Option<&PointNumbers>,
    emitter: &mut Emitter<N>,
) -> Result<()> {
    let around = Around::of(given, pairs, None)?;
    let points = numbers.map(|numbers| numbers.points);
    let mut of_node = OfNode { star: Star::of(given)?, ..OfNode::default() };
    for a in (0..given.nodes()).filter(|&a| given.setup.nonmortar.has_row(a)) {
        if around.around(a).is_empty() {
            let scale = given.row_scale(a) / given.augmentation(a);
            let value = Mat3::identity() * if numbers.is_some() { -scale } else { 0.0 };
            emitter.taker.node(Place::Multiplier(a), Place::Multiplier(a), value.as_slice());
            continue;
        }
        of_node.begin(given, a, &around)?;
        if let Some(points) = points {
            around.around(a).iter().for_each(|&k| of_node.add(given, a, around.facets[k as usize], points));
        }
        of_node.emit(given, a, points, emitter)?;
    }
    Ok(())
}
