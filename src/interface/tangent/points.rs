//! The tangent where points decide, with weights that are frozen (docs/formulation.md 16.4). Tractions at points depend on sigma_A of
//! a facet's nodes, and sigma_A = lambda_A + rhat_A nu_A . g_A / D_A on all nodes of the facets around A. So blocks are sums over
//! nodes A of products: of what sigma_A acts on, and of what it depends on. Where sigma = 0 the tractions vanish: the border's motion
//! adds nothing. Around nodes whose facets are all open nothing depends on sigma, and the products are left out.

use super::emission::{Dependence, Emitter, Place};
use super::union::{Pairs, Walk};
use crate::error::Result;
use crate::geometry::Vec3;
use crate::interface::data::points::Points;
use crate::interface::pairing::given::Given;
use crate::interface::stages::sums::NodeSums;
use crate::memory::{self, Store};

/// What the numbers are made of.
pub struct PointNumbers<'a> {
    pub points: &'a Points,
    pub sums: &'a [NodeSums],
}

/// A node that sigma_A acts on and depends on.
#[derive(Clone, Copy, Debug, Default)]
struct Neighbour {
    /// Over both surfaces.
    node: usize,
    /// d force / d sigma_A.
    force: Vec3,
    /// d sigma_A / dx over nu_A.
    slope: f64,
}

/// A multiplier whose row sigma_A or lambda_A is in.
#[derive(Clone, Copy, Debug, Default)]
struct Row {
    node: usize,
    /// d (rhat c) / d sigma_A and, at fixed sigma, d lambda_A.
    closed: f64,
    left: f64,
}

/// The facets around each node, with the mortar nodes of each.
#[derive(Debug, Default)]
pub struct Around {
    pub facets: Vec<usize>,
    first_node: Vec<usize>,
    mortar: Vec<usize>,
    /// Per node where its facets begin among `of_node`.
    first: Vec<usize>,
    of_node: Vec<usize>,
}

impl Around {
    /// Those that have pairs.
    pub fn of<const N: usize>(given: Given<N>, pairs: Pairs) -> Result<Around> {
        let (mut all, mut walk, mut of_facet) = (Around::default(), Walk::through(pairs, 0..usize::MAX), Vec::new());
        let ((one, two), moves) = (given.setup.surfaces(), given.setup.effects.moves());
        all.first_node.store(0)?;
        memory::refill(&mut all.first, 0, one.len() + 2)?;
        while let Some(f) = walk.next(&mut of_facet)? {
            all.facets.store(f)?;
            let first = all.mortar.len();
            for &c in of_facet.iter().filter(|_| moves).flat_map(|pair| two.host_nodes(pair.two)) {
                if !all.mortar[first..].contains(&c) {
                    all.mortar.store(c)?;
                }
            }
            all.first_node.store(all.mortar.len())?;
            one.host_nodes(f).iter().for_each(|&a| all.first[a + 2] += 1);
        }
        for a in 2..all.first.len() {
            all.first[a] += all.first[a - 1];
        }
        memory::refill(&mut all.of_node, 0, all.first[one.len() + 1])?;
        for (k, &f) in all.facets.iter().enumerate() {
            for &a in one.host_nodes(f) {
                all.of_node[all.first[a + 1]] = k;
                all.first[a + 1] += 1;
            }
        }
        Ok(all)
    }

    pub fn around(&self, a: usize) -> &[usize] {
        &self.of_node[self.first[a]..self.first[a + 1]]
    }

    pub fn mortar(&self, k: usize) -> &[usize] {
        &self.mortar[self.first_node[k]..self.first_node[k + 1]]
    }
}

/// One node A, its neighbours and its rows.
#[derive(Debug, Default)]
struct Star {
    neighbours: Vec<Neighbour>,
    rows: Vec<Row>,
    /// What sigma_A depends on in its order: which neighbour, or A's multiplier; its column; its slope.
    order: Vec<(u32, usize)>,
    columns: Vec<(u32, Place)>,
    slopes: Vec<[f64; 3]>,
    /// Per node over both surfaces its place among the neighbours.
    places: Vec<usize>,
    row_places: Vec<usize>,
}

const NOWHERE: usize = usize::MAX;

impl Star {
    fn begin<const N: usize>(&mut self, given: Given<N>, a: usize, around: &Around) -> Result<()> {
        let one = &given.setup.nonmortar;
        for neighbour in self.neighbours.drain(..) {
            self.places[neighbour.node] = NOWHERE;
        }
        for row in self.rows.drain(..) {
            self.row_places[row.node] = NOWHERE;
        }
        for &k in around.around(a) {
            let own = one.host_nodes(around.facets[k]);
            for &b in own.iter().filter(|&&b| one.has_row(b)) {
                if self.row_places[b] == NOWHERE {
                    self.row_places[b] = self.rows.len();
                    self.rows.store(Row { node: b, ..Row::default() })?;
                }
            }
            for node in own.iter().copied().chain(around.mortar(k).iter().map(|c| one.len() + c)) {
                if self.places[node] == NOWHERE {
                    self.places[node] = self.neighbours.len();
                    self.neighbours.store(Neighbour { node, ..Neighbour::default() })?;
                }
            }
        }
        Ok(())
    }

    /// Adds what a facet has of A.
    fn add<const N: usize>(&mut self, given: Given<N>, a: usize, f: usize, numbers: &PointNumbers) {
        let ((one, two), PointNumbers { points, sums }) = (given.setup.surfaces(), numbers);
        let Ok(at) = points.facets.binary_search_by_key(&f, |facet| facet.one) else { return };
        let facet = &points.facets[at];
        let Some(l) = facet.nodes().iter().position(|&b| b == a) else { return };
        let (is_covered, areas) = (points.is_covered[a], &given.history().areas);
        let slope = if is_covered { given.augmentation(a) * areas[a] / sums[a].coverage } else { 0.0 };
        for (k, &b) in facet.nodes().iter().enumerate().filter(|(_, b)| points.is_covered[**b]) {
            let row = &mut self.rows[self.row_places[b]];
            row.left += facet.mass[k][l] + points.factors[b] * facet.stabilisation[k][l];
        }
        if !is_covered {
            return;
        }
        let mass = points.closed_mass(at);
        for (k, &b) in facet.nodes().iter().enumerate() {
            self.neighbours[self.places[b]].force += facet.normal * mass[l][k];
            if points.is_covered[b] {
                self.rows[self.row_places[b]].closed += mass[k][l];
            }
        }
        for place in facet.places() {
            let (pair, closed) = (&points.pairs[place], points.closed(at, place));
            for (k, &b) in facet.nodes().iter().enumerate() {
                self.neighbours[self.places[b]].slope += slope * pair.dual.ab[l][k];
            }
            if given.setup.effects.moves() {
                for (k, &c) in two.host_nodes(pair.two).iter().enumerate() {
                    let neighbour = &mut self.neighbours[self.places[one.len() + c]];
                    neighbour.force -= facet.normal * closed.map_or(0.0, |closed| closed.ac[l][k]);
                    neighbour.slope -= slope * pair.dual.ac[l][k];
                }
            }
        }
    }

    /// Puts what sigma_A depends on in its order.
    fn sort<const N: usize>(&mut self, (a, nu): (usize, Vec3), emitter: &Emitter<N>) -> Result<()> {
        let multiplier = self.neighbours.len();
        let place = |k: usize| self.neighbours.get(k).map_or(Place::Multiplier(a), |n| Place::Displacement(n.node));
        self.order.clear();
        self.order.store_all((0..=multiplier).map(|k| (emitter.taker.order(place(k)), k)))?;
        self.order.sort_unstable();
        self.columns.clear();
        self.columns.store_all(self.order.iter().map(|&(key, k)| (key, place(k))))?;
        let slope = |k: usize| self.neighbours.get(k).map_or(Vec3::zeros(), |n| nu * n.slope);
        self.slopes.clear();
        self.slopes.store_all(self.order.iter().map(|&(_, k)| slope(k).into()))
    }

    /// `is_covered`: with numbers, whether A is.
    fn emit<const N: usize>(
        &mut self,
        given: Given<N>,
        (a, nu, is_covered): (usize, Vec3, Option<bool>),
        emitter: &mut Emitter<N>,
    ) -> Result<()> {
        let areas = &given.history().areas;
        self.sort((a, nu), emitter)?;
        let size = self.slopes.iter().flatten().map(|slope| slope.abs()).sum();
        let of = Dependence { columns: &self.columns, slopes: &self.slopes, size };
        for row in self.neighbours.iter().filter(|row| is_covered.is_none() || row.force != Vec3::zeros()) {
            let force = row.force.into();
            emitter.taker.products(Place::Displacement(row.node), &of, &force, &force);
        }
        for row in &self.rows {
            let (b, place) = (row.node, Place::Multiplier(row.node));
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
    (given, normals, pairs): (Given<N>, &[Vec3], Pairs),
    numbers: Option<&PointNumbers>,
    emitter: &mut Emitter<N>,
) -> Result<()> {
    let around = Around::of(given, pairs)?;
    let (n1, n2) = (given.nodes(), given.setup.mortar.len());
    let (places, row_places) = (memory::filled(NOWHERE, n1 + n2)?, memory::filled(NOWHERE, n1)?);
    let mut star = Star { places, row_places, ..Star::default() };
    for a in (0..n1).filter(|&a| given.setup.nonmortar.has_row(a)) {
        if around.around(a).is_empty() {
            let scale = given.row_scale(a) / given.augmentation(a);
            let value = if numbers.is_some() { -scale } else { 0.0 };
            emitter.taker.node(Place::Multiplier(a), Place::Multiplier(a), &[value]);
            continue;
        }
        star.begin(given, a, &around)?;
        let is_covered = numbers.map(|numbers| numbers.points.is_covered[a]);
        if let Some(numbers) = numbers {
            around.around(a).iter().for_each(|&k| star.add(given, a, around.facets[k], numbers));
        }
        star.emit(given, (a, normals[a], is_covered), emitter)?;
    }
    Ok(())
}
