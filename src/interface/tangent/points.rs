//! The tangent where points decide (docs/formulation.md 16.4). Tractions at points depend on sigma_A of
//! a facet's nodes, and sigma_A = lambda_A + rhat_A nu_A . g_A / D_A on all nodes of the facets around A. So blocks are sums over
//! nodes A of products: of what sigma_A acts on, and of what it depends on. Where sigma = 0 the tractions vanish: the border's motion
//! adds nothing. Around nodes whose facets are all open nothing depends on sigma, and the products are left out.

use super::emission::{Dependence, Emitter, Place};
use super::point_motion::{Motions, of_facets};
pub use super::point_numbers::PointNumbers;
use super::star::{Around, Star};
use super::union::Pairs;
use crate::error::Result;
use crate::geometry::Vec3;
use crate::interface::data::points::OfNodes;
use crate::interface::pairing::given::Given;
use crate::memory::{self, Store};

/// A node that sigma_A acts on and depends on.
#[derive(Clone, Copy, Debug, Default)]
struct Neighbour {
    /// d force / d sigma_A.
    force: Vec3,
    /// d sigma_A / dx.
    slope: Vec3,
}

/// A multiplier whose row sigma_A or lambda_A is in.
#[derive(Clone, Copy, Debug, Default)]
struct Row {
    /// d (rhat c) / d sigma_A and, at fixed sigma, d lambda_A.
    closed: f64,
    left: f64,
}

/// What depends on sigma_A of one node, and what it depends on.
#[derive(Debug, Default)]
struct OfNode {
    star: Star,
    /// Beside the star's.
    neighbours: Vec<Neighbour>,
    rows: Vec<Row>,
    /// What sigma_A depends on in its order: which neighbour, or A's multiplier; its column; its slope.
    order: Vec<(u32, usize)>,
    columns: Vec<(u32, Place)>,
    slopes: Vec<[f64; 3]>,
}

impl OfNode {
    fn begin<const N: usize>(&mut self, given: Given<N>, a: usize, around: &Around) -> Result<()> {
        self.star.begin(given, a, around)?;
        memory::refill(&mut self.neighbours, Neighbour::default(), self.star.nodes.len())?;
        memory::refill(&mut self.rows, Row::default(), self.star.rows.len())
    }

    /// Adds what the k-th facet has of A. `motions`: what sigma_A depends on with weights that change.
    fn add<const N: usize>(
        &mut self,
        given: Given<N>,
        a: usize,
        (k, around): (usize, &Around),
        (numbers, motions): (&PointNumbers, Option<&Motions>),
    ) {
        let ((one, two), f) = (given.setup.surfaces(), around.facets[k]);
        let PointNumbers { points, sums, normals, .. } = numbers;
        let Ok(at) = points.facets.binary_search_by_key(&f, |facet| facet.one) else { return };
        let facet = &points.facets[at];
        let Some(l) = facet.nodes().iter().position(|&b| b == a) else { return };
        let is_covered = points.is_covered[a];
        let slope = match motions {
            None if is_covered => normals[a] * (points.rhat[a] / sums[a].coverage),
            _ => Vec3::zeros(),
        };
        for (k, &b) in facet.nodes().iter().enumerate().filter(|(_, b)| points.is_covered[**b]) {
            if let Some(row) = self.star.row(b) {
                self.rows[row].left += facet.mass[k][l] + points.factors[b] * facet.stabilisation[k][l];
            }
        }
        if !is_covered {
            return;
        }
        if let Some(motions) = motions {
            let nodes = || facet.nodes().iter().copied().chain(around.mortar(k).iter().map(|c| one.len() + c));
            for (node, slope) in nodes().zip(motions.slopes(k, l, nodes().count())) {
                self.neighbours[self.star.place(node)].slope += slope;
            }
        }
        let mut room = OfNodes::default();
        let mass = points.states[at].mass(facet, &points.closed, &mut room);
        for (k, &b) in facet.nodes().iter().enumerate() {
            self.neighbours[self.star.place(b)].force += facet.normal * mass[l][k];
            if let Some(row) = self.star.row(b).filter(|_| points.is_covered[b]) {
                self.rows[row].closed += mass[k][l];
            }
        }
        for place in facet.places() {
            let (pair, closed) = (&points.pairs[place], points.closed(at, place));
            for (k, &b) in facet.nodes().iter().enumerate() {
                self.neighbours[self.star.place(b)].slope += slope * pair.dual.ab[l][k];
            }
            if given.setup.effects.moves() {
                for (k, &c) in two.host_nodes(pair.two).iter().enumerate() {
                    let neighbour = &mut self.neighbours[self.star.place(one.len() + c)];
                    neighbour.force -= facet.normal * closed.map_or(0.0, |closed| closed.ac[l][k]);
                    neighbour.slope -= slope * pair.dual.ac[l][k];
                }
            }
        }
    }

    /// Puts what sigma_A depends on in its order.
    fn sort<const N: usize>(&mut self, a: usize, emitter: &Emitter<N>) -> Result<()> {
        let multiplier = self.neighbours.len();
        let place = |k: usize| self.star.nodes.get(k).map_or(Place::Multiplier(a), |node| Place::Displacement(*node));
        self.order.clear();
        self.order.store_all((0..=multiplier).map(|k| (emitter.taker.order(place(k)), k)))?;
        self.order.sort_unstable();
        self.columns.clear();
        self.columns.store_all(self.order.iter().map(|&(key, k)| (key, place(k))))?;
        let slope = |k: usize| self.neighbours.get(k).map_or(Vec3::zeros(), |n| n.slope);
        self.slopes.clear();
        self.slopes.store_all(self.order.iter().map(|&(_, k)| slope(k).into()))
    }

    /// `is_covered`: with numbers, whether A is.
    fn emit<const N: usize>(
        &mut self,
        given: Given<N>,
        (a, is_covered): (usize, Option<bool>),
        emitter: &mut Emitter<N>,
    ) -> Result<()> {
        let areas = &given.history().areas;
        self.sort(a, emitter)?;
        let size = self.slopes.iter().flatten().map(|slope| slope.abs()).sum();
        let of = Dependence { columns: &self.columns, slopes: &self.slopes, size };
        for (&node, row) in self.star.nodes.iter().zip(&self.neighbours) {
            if is_covered.is_some() && row.force == Vec3::zeros() {
                continue;
            }
            let force = row.force.into();
            emitter.taker.products(Place::Displacement(node), &of, &force, &force);
        }
        for (&b, row) in self.star.rows.iter().zip(&self.rows) {
            let place = Place::Multiplier(b);
            let scale = given.row_scale(b) / (given.augmentation(b) * areas[b]);
            let own = scale * if b == a && is_covered == Some(false) { -areas[a] } else { row.closed - row.left };
            if is_covered.is_some() && row.closed == 0.0 {
                emitter.taker.node(place, Place::Multiplier(a), &[own]);
            } else {
                emitter.taker.products(place, &of, &[scale * row.closed, 0.0, 0.0], &[own, 0.0, 0.0]);
            }
        }
        Ok(())
    }
}

/// All blocks.
pub fn blocks<const N: usize>(
    (given, pairs): (Given<N>, Pairs),
    numbers: Option<&PointNumbers>,
    emitter: &mut Emitter<N>,
) -> Result<()> {
    let around = Around::of(given, pairs)?;
    let motions = match numbers.and_then(|numbers| Some((numbers, numbers.active?))) {
        Some(numbers) => Some(of_facets(given, numbers, &around, emitter)?),
        None => None,
    };
    let mut of_node = OfNode { star: Star::of(given)?, ..OfNode::default() };
    for a in (0..given.nodes()).filter(|&a| given.setup.nonmortar.has_row(a)) {
        if around.around(a).is_empty() {
            let scale = given.row_scale(a) / given.augmentation(a);
            let value = if numbers.is_some() { -scale } else { 0.0 };
            emitter.taker.node(Place::Multiplier(a), Place::Multiplier(a), &[value]);
            continue;
        }
        of_node.begin(given, a, &around)?;
        let is_covered = numbers.map(|numbers| numbers.points.is_covered[a]);
        if let Some(numbers) = numbers {
            let numbers = (numbers, motions.as_ref());
            around.around(a).iter().for_each(|&k| of_node.add(given, a, (k, &around), numbers));
        }
        of_node.emit(given, (a, is_covered), emitter)?;
    }
    Ok(())
}
