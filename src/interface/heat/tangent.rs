//! The tangent of the heat that leaves the nodes: by temperatures, by displacements, by multipliers (docs/formulation 17.2).

use super::rows::{Column, Row};
use super::sides::Place;
use crate::error::Result;
use crate::geometry::{Mat3, Vec3};
use crate::interface::data::active::Active;
use crate::interface::data::surface::{NO_EQUATION, Surface, node_equations};
use crate::interface::pairing::given::Given;
use crate::interface::stages::carried::transfer;
use crate::interface::stages::respond::Responses;
use crate::interface::stages::sums::in_previous_gaps;
use crate::interface::tangent::augmented::dtraction;
use crate::interface::tangent::by_equations::Sink;
use crate::interface::tangent::read::Through;
use crate::interface::tangent::turning::Turns;
use crate::interface::weights::facet::each_facet;
use crate::law::{HeatFlow, HeatNode};
use crate::memory::{self, Store, Stored};
use nalgebra::SMatrix;

/// Where columns stand in the host's system.
#[derive(Clone, Copy)]
pub struct Equations<'a> {
    /// Of the temperatures of both sides.
    pub temperatures: [&'a [i64]; 2],
    /// Whether columns of displacements and multipliers are asked for.
    pub with_motion: bool,
}

impl Equations<'_> {
    fn temperature(&self, node: usize) -> i64 {
        let n1 = self.temperatures[0].len();
        if node < n1 { self.temperatures[0][node] } else { self.temperatures[1][node - n1] }
    }
}

/// By how much what passes on either side of node A changes with a node's position.
#[derive(Clone, Copy, Debug)]
struct ByPosition {
    node: usize,
    sides: [Vec3; 2],
}

/// What one node's heat depends on, besides temperatures.
#[derive(Debug, Default)]
struct Node {
    positions: Vec<ByPosition>,
    /// The multipliers of these nodes; of one that has one component the others are 0.
    multipliers: Vec<(usize, [Vec3; 2])>,
}

impl Node {
    fn add(&mut self, node: usize, of: [Vec3; 2]) -> Result<()> {
        match self.positions.iter_mut().find(|known| known.node == node) {
            Some(known) => (0..2).for_each(|side| known.sides[side] += of[side]),
            None => self.positions.store(ByPosition { node, sides: of })?,
        }
        Ok(())
    }
}

/// A facet's share: `[k * nodes + c]`, how the heat of its k-th node changes with the position of its c-th one, through the
/// node's own weights.
#[derive(Debug)]
struct Direct {
    nodes: Vec<usize>,
    slopes: Vec<Vec3>,
}

/// Gives the entries: rows are the temperatures' equations of both sides.
pub fn tangent<const N: usize>(
    at: &Place<N>,
    rows: &mut [Row],
    flows: &[(HeatNode, HeatFlow)],
    (active, responses): (Option<&Active>, &Responses<N>),
    turns: Option<&Turns<N>>,
    equations: Equations,
    sink: &mut dyn Sink,
) -> Result<()> {
    let carried = &responses.carried[..];
    let (mut nodes, mut direct): (Vec<Node>, Vec<Direct>) = (memory::defaults(rows.len())?, Vec::new());
    if equations.with_motion {
        let normals = at.given.normals()?;
        match active {
            Some(active) => direct = differentiate(at, (rows, flows), &normals, (active, responses))?,
            None => turn(at, rows)?,
        }
        let carries = carries(at, carried)?;
        let around = turns.map_or_else(|| Ok(Vec::new()), |_| facets_around(&at.given.setup.nonmortar))?;
        let turning = turns.map(|turns| Turning { turns, around: &around });
        for a in (0..rows.len()).filter(|&a| flows[a].0.area > 0.0) {
            nodes[a] = node(at, a, (rows, flows), &normals, (carried, &carries), turning)?;
        }
    }
    let setup = at.given.setup;
    let columns =
        Columns { equations, surfaces: setup.surfaces(), multipliers: (setup.multiplier_equations.as_flattened(), N) };
    emit((rows, flows), (&nodes, &direct), columns, sink)
}

/// Puts what the derivatives of the weights make of temperatures, areas and gaps into the rows; gives what they do to the heat
/// of the nodes at fixed flows.
#[inline(never)] // likewise
fn differentiate<const N: usize>(
    at: &Place<N>,
    (rows, flows): (&mut [Row], &[(HeatNode, HeatFlow)]),
    normals: &[Vec3],
    of: (&Active, &Responses<N>),
) -> Result<Vec<Direct>> {
    let (n1, mut all) = (at.x[0].len(), Vec::new());
    each_facet((at.given, normals), of, &mut |facet| {
        let n = facet.nodes.len();
        let mut direct = Direct { nodes: memory::copied(&facet.nodes)?, slopes: memory::filled(Vec3::zeros(), n * n)? };
        for (a, slopes) in facet.slopes.chunks_exact(n * n).enumerate() {
            let (own, sides) = (facet.nodes[a], flows[facet.nodes[a]].1.sides);
            let (x, t) = (at.x[0][own], at.temperatures[0][own]);
            for (k, (&node, slopes)) in facet.nodes.iter().zip(slopes.chunks_exact(n)).enumerate() {
                let is_own = node < n1;
                let (x, t, h) = (at.position(node) - x, at.temperature(node) - t, at.offset(node));
                for (c, slope) in slopes.iter().enumerate() {
                    direct.slopes[k * n + c] += slope * sides[usize::from(!is_own)];
                    let place = rows[own].place(facet.nodes[c])?;
                    let column = &mut rows[own].columns[place];
                    if is_own {
                        column.area += slope;
                    }
                    column.jump += slope * t;
                    column.gap += x * slope.transpose();
                    column.offset += slope * h;
                }
            }
        }
        all.store(direct)
    })?;
    Ok(all)
}

/// Puts how the first gaps of tied surfaces turn into the rows.
#[inline(never)] // as for of_facet in motion.rs
fn turn<const N: usize>(at: &Place<N>, rows: &mut [Row]) -> Result<()> {
    let one = &at.given.setup.nonmortar;
    for (part, facet) in one.facets.iter().enumerate() {
        let turned = at.given.history().facet_gaps.motion(one, part, at.x[0])?;
        let Some(blocks) = turned else { continue };
        // A line's two nodes are those of its quadrilateral, each twice; a triangle has zeros for a fourth one.
        let (nodes, columns) = match &one.parents {
            None => (facet, facet.nodes),
            Some(parents) => {
                (parents.rows(part), parents.sub(part).nodes.map(|k| one.host_nodes(one.host_facet(part))[k]))
            }
        };
        for (a, &node) in nodes.as_slice().iter().enumerate() {
            for (k, &column) in columns.iter().enumerate() {
                let place = rows[node].place(column)?;
                rows[node].columns[place].turned += Mat3::from_fn(|i, j| blocks[k][i][j][a]);
            }
        }
    }
    Ok(())
}

/// Who carries whom: (carrier, carried), sorted.
#[inline(never)] // likewise
fn carries<const N: usize>(at: &Place<N>, carried: &[bool]) -> Result<Vec<(usize, usize)>> {
    let mut all = Vec::new();
    for a in (0..carried.len()).filter(|&a| carried[a]) {
        all.store_all(at.given.carriers_of(a).iter().map(|&(b, _)| (b, a)))?;
    }
    memory::sort(&mut all)?;
    Ok(all)
}

/// What the traction of a node depends on.
struct Traction<const N: usize> {
    /// How p depends on the gaps and the areas of these nodes.
    gaps: Vec<(usize, Through)>,
    multipliers: Vec<(usize, SMatrix<f64, 3, N>)>,
    /// dp / dnu of these nodes.
    normals: Vec<(usize, Mat3)>,
}

/// How normals of now turn: with which facets each does.
#[derive(Clone, Copy)]
struct Turning<'a, const N: usize> {
    turns: &'a Turns<'a, N>,
    around: &'a [(usize, usize, usize)],
}

/// The facets of the host around each node, with its place there: sorted.
#[inline(never)] // likewise
fn facets_around(one: &Surface) -> Result<Vec<(usize, usize, usize)>> {
    let of = |f: usize| one.host_nodes(f).iter().enumerate().map(move |(k, &a)| (a, f, k));
    let mut all = (0..one.host_facets()).flat_map(of).stored()?;
    memory::sort(&mut all)?;
    Ok(all)
}

impl<const N: usize> Turning<'_, N> {
    /// Adds what turns with nu_A.
    fn add(&self, given: Given<N>, a: usize, by: [Vec3; 2], to: &mut Node) -> Result<()> {
        let first = self.around.partition_point(|of| of.0 < a);
        for &(_, f, k) in self.around[first..].iter().take_while(|of| of.0 == a) {
            let nodes = given.setup.nonmortar.host_nodes(f);
            for (l, dnu) in self.turns.of_normal(given, (f, k)).as_slice() {
                to.add(nodes[*l], by.map(|by| dnu.transpose() * by))?;
            }
        }
        Ok(())
    }
}

impl<const N: usize> Traction<N> {
    /// Of node A, and of those whose gaps count in its row.
    fn add(
        &mut self,
        (at, a, share): (&Place<N>, usize, Mat3),
        normals: &[Vec3],
        carries: &[(usize, usize)],
        turns: Option<&Turns<N>>,
    ) -> Result<()> {
        let (given, response) = (at.given, &at.responses[a]);
        let Through { now, previous, area } = dtraction(given, a, response, normals[a]);
        let (now, previous, area) = (share * now, share * previous, share * area);
        self.gaps.store((a, Through { now, previous, area }))?;
        self.multipliers.store((a, share * response.dp_dlambda))?;
        if let Some(turns) = turns {
            self.normals.store((a, share * turns.projected(a)))?;
        }
        let first = carries.partition_point(|pair| pair.0 < a);
        for &(_, of) in carries[first..].iter().take_while(|pair| pair.0 == a) {
            let w = given.carriers_of(of).iter().filter(|carrier| carrier.0 == a).map(|carrier| carrier.1).sum::<f64>();
            let t = transfer(given, of, normals[of], normals[a]) * w;
            self.gaps.store((of, Through { now: now * t, previous: previous * t, area: area * w }))?;
            if let Some(turns) = turns {
                let by_gap = if N > 1 && in_previous_gaps(given) { now + previous } else { now };
                self.normals.store((of, by_gap * turns.taken_over(given, normals, (of, (a, w)))))?;
            }
        }
        Ok(())
    }

    fn of(
        at: &Place<N>,
        a: usize,
        normals: &[Vec3],
        (carried, carries): (&[bool], &[(usize, usize)]),
        turns: Option<&Turns<N>>,
    ) -> Result<Traction<N>> {
        let mut traction = Traction { gaps: Vec::new(), multipliers: Vec::new(), normals: Vec::new() };
        if carried.get(a).is_some_and(|is| *is) {
            for &(b, w) in at.given.carriers_of(a) {
                let share = transfer(at.given, a, normals[a], normals[b]).transpose() * w;
                traction.add((at, b, share), normals, carries, turns)?;
                if let (Some(_), 1) = (turns, N) {
                    // T^T p_B = nu_A (nu_B . p_B).
                    let p = at.responses[b].traction;
                    traction.normals.store((a, Mat3::identity() * (normals[b].dot(&p) * w)))?;
                    traction.normals.store((b, normals[a] * p.transpose() * w))?;
                }
            }
        } else {
            traction.add((at, a, Mat3::identity()), normals, carries, turns)?;
        }
        Ok(traction)
    }
}

/// What node A's heat depends on.
#[inline(never)] // likewise
fn node<const N: usize>(
    at: &Place<N>,
    a: usize,
    (rows, flows): (&[Row], &[(HeatNode, HeatFlow)]),
    normals: &[Vec3],
    carrying: (&[bool], &[(usize, usize)]),
    turning: Option<Turning<N>>,
) -> Result<Node> {
    let (given, response, slopes, nu) = (at.given, &at.responses[a], &flows[a].1.slopes, normals[a]);
    let sides = |of: &dyn Fn(&[f64; 5]) -> Vec3| [of(&slopes[0]), of(&slopes[1])];
    let in_previous = in_previous_gaps(given);
    // Dg_A of now and of t_n with respect to a column.
    let gaps = |s: usize, column: &Column| {
        let offset = normals[s] * column.offset.transpose();
        let now = Mat3::from_diagonal_element(column.n) + column.gap + offset;
        let before = Mat3::from_diagonal_element(column.before);
        (now, if in_previous { before + offset } else { before })
    };
    let slips = given.setup.effects.law.slips && given.history().coverage[a] > given.least_coverage(a);
    let (coefficient, committed) = given.setup.options.effective_slip().coefficients();
    let free = given.setup.nodes.free[a];
    let along = free * response.traction;
    let along = if slips { along - nu * nu.dot(&along) } else { Vec3::zeros() };
    let mut node = Node::default();
    for column in &rows[a].columns {
        let (now, before) = gaps(a, column);
        let work = (before - now * coefficient).transpose() * along;
        let gap = now.transpose() * nu;
        node.add(column.node, sides(&|s| column.jump * s[0] + gap * s[2] + column.area * s[3] + work * s[4]))?;
    }
    let traction = Traction::of(at, a, normals, carrying, turning.map(|turning| turning.turns))?;
    // Dp acts through the pressure, and through the work of friction.
    let by = |s: &[f64; 5]| response.slip * s[4] - nu * s[1];
    for (from, through) in &traction.gaps {
        for column in &rows[*from].columns {
            let (now, before) = gaps(*from, column);
            let dp = through.now * (now + column.turned)
                + through.previous * before
                + through.area * column.area.transpose();
            node.add(column.node, sides(&|s| dp.transpose() * by(s)))?;
        }
    }
    if let Some(turning) = turning {
        // Of the gap nu . g, of the pressure - nu . p and of the work p . P s, by nu alone.
        let sum = &at.sums[a];
        let (g, s) =
            (sum.gap_now, free * (sum.gap_previous - sum.gap_now * coefficient - sum.gap_committed * committed));
        let p = response.traction;
        let work = if slips { -(p * nu.dot(&s) + s * nu.dot(&p)) } else { Vec3::zeros() };
        turning.add(given, a, sides(&|slope| g * slope[2] - p * slope[1] + work * slope[4]), &mut node)?;
        for (of, dp) in &traction.normals {
            turning.add(given, *of, sides(&|slope| dp.transpose() * by(slope)), &mut node)?;
        }
    }
    for (b, dp) in &traction.multipliers {
        let of = |side: usize| {
            let by = dp.transpose() * by(&slopes[side]);
            Vec3::from_fn(|i, _| if i < N { by[i] } else { 0.0 })
        };
        node.multipliers.store((*b, [of(0), of(1)]))?;
    }
    Ok(node)
}

/// The equations of columns.
#[derive(Clone, Copy)]
struct Columns<'a> {
    equations: Equations<'a>,
    surfaces: (&'a Surface, &'a Surface),
    /// Those of all multipliers, and how many a node has.
    multipliers: (&'a [i64], usize),
}

/// The sums of one row, column by column.
struct RowSums {
    temperatures: Vec<f64>,
    positions: Vec<Vec3>,
    multipliers: Vec<Vec3>,
    /// Nodes with anything in the first two, and in the last.
    touched: [Vec<usize>; 2],
    is_touched: [Vec<bool>; 2],
}

impl RowSums {
    fn new(n: usize, n1: usize) -> Result<RowSums> {
        Ok(RowSums {
            temperatures: memory::filled(0.0, n)?,
            positions: memory::filled(Vec3::zeros(), n)?,
            multipliers: memory::filled(Vec3::zeros(), n1)?,
            touched: [Vec::new(), Vec::new()],
            is_touched: [memory::filled(false, n)?, memory::filled(false, n1)?],
        })
    }

    fn touch(&mut self, which: usize, node: usize) -> Result<()> {
        if !std::mem::replace(&mut self.is_touched[which][node], true) {
            self.touched[which].store(node)?;
        }
        Ok(())
    }

    /// Gives the sums away and begins anew.
    fn give(&mut self, row: i64, Columns { equations, surfaces, multipliers: (all, n) }: Columns, sink: &mut dyn Sink) {
        for &node in &self.touched[0] {
            sink.add_block(&[row], &[equations.temperature(node)], &[self.temperatures[node]]);
            if equations.with_motion {
                let columns = node_equations(surfaces, node);
                sink.add_block(&[row], columns, self.positions[node].as_slice());
            }
            (self.temperatures[node], self.positions[node]) = (0.0, Vec3::zeros());
            self.is_touched[0][node] = false;
        }
        for &node in &self.touched[1] {
            sink.add_block(&[row], &all[n * node..n * (node + 1)], &self.multipliers[node].as_slice()[..n]);
            self.multipliers[node] = Vec3::zeros();
            self.is_touched[1][node] = false;
        }
        self.touched.iter_mut().for_each(Vec::clear);
    }
}

/// Row by row, each entry once.
fn emit(
    (rows, flows): (&[Row], &[(HeatNode, HeatFlow)]),
    (nodes, direct): (&[Node], &[Direct]),
    columns: Columns,
    sink: &mut dyn Sink,
) -> Result<()> {
    let (n1, n2) = (columns.surfaces.0.len(), columns.surfaces.1.len());
    // Where each node stands: (node, list, place).
    let (mut of_nodes, mut of_facets) = (Vec::new(), Vec::new());
    for (a, row) in rows.iter().enumerate().filter(|(a, _)| flows[*a].0.area > 0.0) {
        of_nodes.store_all(row.columns.iter().enumerate().map(|(k, column)| (column.node, a, k)))?;
    }
    for (f, direct) in direct.iter().enumerate() {
        of_facets.store_all(direct.nodes.iter().enumerate().map(|(k, &node)| (node, f, k)))?;
    }
    memory::sort(&mut of_nodes)?;
    memory::sort(&mut of_facets)?;
    let mut sums = RowSums::new(n1 + n2, n1)?;
    let (mut next_node, mut next_facet) = (0, 0);
    for node in 0..n1 + n2 {
        let (row, side) = (columns.equations.temperature(node), usize::from(node >= n1));
        while let Some(&(_, a, k)) = of_nodes.get(next_node).filter(|of| of.0 == node) {
            next_node += 1;
            if row == NO_EQUATION {
                continue;
            }
            let (n, by_jump) = (rows[a].columns[k].n, flows[a].1.slopes[side][0]);
            for column in &rows[a].columns {
                sums.touch(0, column.node)?;
                sums.temperatures[column.node] += n * by_jump * column.n;
            }
            for of in &nodes[a].positions {
                sums.touch(0, of.node)?;
                sums.positions[of.node] += of.sides[side] * n;
            }
            for (b, of) in &nodes[a].multipliers {
                sums.touch(1, *b)?;
                sums.multipliers[*b] += of[side] * n;
            }
        }
        while let Some(&(_, f, k)) = of_facets.get(next_facet).filter(|of| of.0 == node) {
            next_facet += 1;
            let Direct { nodes, slopes } = &direct[f];
            for (&column, slope) in nodes.iter().zip(&slopes[k * nodes.len()..]) {
                sums.touch(0, column)?;
                sums.positions[column] += slope;
            }
        }
        sums.give(row, columns, sink);
    }
    Ok(())
}
