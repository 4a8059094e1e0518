//! Stages 3 and 4 of the tangent: its blocks, with their numbers or without.
//!
//! The list of pairs (`union.rs`) says which blocks there are. One loop walks through it, whether the blocks have numbers or
//! are asked for alone: a count, a pattern and a fill have the same entries in the same order.

use super::augmented::{NodeCouplings, dtraction, is_coupled};
use super::carried_tangent;
use super::conserving;
use super::emission::{Emitter, MortarBlock, NodeBlock, Span, Takers};
use super::facet_table::FacetTable;
use super::frame::{self, FrameNumbers};
use super::linear_facet::{self, LinearRoom};
use super::parents::{self, ParentRoom};
use super::point_friction;
use super::points::{self, PointNumbers};
use super::read::ReadTable;
use super::task::{Numbers, Task};
use super::turning;
use super::union::{UnionPair, Walk};
use crate::element::{FacetResponse, NodeTangent, Rows};
use crate::error::Result;
use crate::geometry::Vec3;
use crate::interface::data::host_facets::NormalDerivatives;
use crate::interface::data::multiplier::force_traction;
use crate::interface::data::options::{Form, MultiplierBasis};
use crate::interface::pairing::given::Given;
use crate::interface::stages::respond::Responses;
use crate::memory::{self, Store};
use crate::mortar::ForceDerivatives;
use crate::shape::MAX_NODES;
use nalgebra::{SMatrix, SVector};
use std::ops::Range;

/// What a pair must know of every node's response, into `nodes`; `scale`: the factor of a node's rows.
pub fn node_tangents<const N: usize>(
    given: Given<N>,
    lambda: &[SVector<f64, N>],
    responses: &Responses<N>,
    normals: &[Vec3],
    scale: impl Fn(usize) -> f64,
    nodes: &mut Vec<NodeTangent<N>>,
) -> Result<()> {
    let node = |a: usize| {
        let (response, scale) = (&responses.nodes[a], scale(a));
        let traction = force_traction(given.setup.options.form, &lambda[a], response, normals[a]);
        NodeTangent {
            traction: if given.setup.nodes.acts(a) { traction } else { Vec3::zeros() },
            drow_dnow: response.drow_dnow * scale,
            drow_dprevious: response.drow_dprevious * scale,
            drow_darea: response.drow_darea * scale,
        }
    };
    nodes.clear();
    nodes.store_all((0..lambda.len()).map(node))
}

/// Adds a facet to what its nodes' tractions are coupled with; in the multiplier form they act on the nodes of its columns, those of a
/// frame with equations too, and no gap of it moves them.
fn couple<const N: usize>(
    (given, normals): (Given<N>, &[Vec3]),
    (f, table): (usize, &dyn ReadTable),
    (numbers, row): (Option<&Numbers<N>>, &mut Vec<NodeBlock>),
    couplings: &mut [NodeCouplings],
) -> Result<()> {
    let one = &given.setup.nonmortar;
    for (k, &a) in one.host_nodes(f).iter().enumerate().take(one.multipliers(f)) {
        for &(column, node) in table.nodes().iter().filter(|(column, _)| table.acts_on(*column)) {
            couplings[a].add_force(node, table.weight(column, k))?;
        }
        if given.setup.options.form == Form::Multiplier {
            continue;
        }
        let dp = numbers.map(|n| dtraction(given, a, &n.responses.nodes[a], normals[a]));
        couplings[a].add_gap((table, k), dp, row)?;
        carried_tangent::couple((given, normals), (a, k, table), (numbers.map(Numbers::answers), row), couplings)?;
    }
    Ok(())
}

/// What the blocks of a facet are computed in. Large, so that one serves all facets.
#[derive(Debug, Default)]
pub struct Room<const N: usize> {
    table: FacetTable,
    /// Of the multipliers of the facet at hand.
    rows: Vec<Rows<N>>,
    linear: LinearRoom,
    /// The row of a node's answer that is not its own multiplier's.
    row: Vec<NodeBlock>,
    parent: ParentRoom,
    lone: turning::LoneRoom,
    pairs: Vec<UnionPair>,
}

/// All blocks of a tangent. `takers`: see [`Emitter`]. Gives the number of pairs whose weights were differentiated.
pub fn blocks<const N: usize>(task: Task<N>, room: &mut Room<N>, (taker, constraints): Takers<N>) -> Result<i64> {
    let mut emitter = Emitter { given: task.given, normals: task.normals, taker, constraints };
    let mut couplings: Option<Vec<NodeCouplings>> =
        is_coupled(task.given).then(|| memory::defaults(task.given.nodes())).transpose()?;
    let linearised = of_facets(task, 0..usize::MAX, room, couplings.as_deref_mut(), &mut emitter)?;
    of_nodes(task, room, couplings.as_deref_mut(), &mut emitter)?;
    Ok(linearised)
}

/// The blocks of a tangent's pattern but for those of facets with pairs and of these pairs: of carried nodes, of what couples a
/// node's pairs, of the nodes themselves, of facets without pairs. Where either side has quadratic facets all blocks come.
pub fn beyond_facets<const N: usize>(task: Task<N>, room: &mut Room<N>, (taker, constraints): Takers<N>) -> Result<()> {
    let Task { given, normals, pairs: all, .. } = task;
    let mut emitter = Emitter { given, normals, taker, constraints };
    let mut couplings: Option<Vec<NodeCouplings>> =
        is_coupled(given).then(|| memory::defaults(given.nodes())).transpose()?;
    if given.setup.has_parents() || given.setup.has_blocks_of_nodes() {
        of_facets(task, 0..usize::MAX, room, couplings.as_deref_mut(), &mut emitter)?;
    } else {
        let mut walk = Walk::through(all, 0..usize::MAX);
        while let Some(f) = walk.next(&mut room.pairs)? {
            let Room { table, row, pairs, .. } = &mut *room;
            begin(task, pairs, table)?;
            beyond_facet((f, table), None, row, couplings.as_deref_mut(), &mut emitter)?;
        }
    }
    of_nodes(task, room, couplings.as_deref_mut(), &mut emitter)
}

/// Begins a facet's table.
fn begin<const N: usize>(task: Task<N>, pairs: &[UnionPair], table: &mut FacetTable) -> Result<()> {
    let (setup, all) = (task.given.setup, task.pairs);
    let two = (task.moves || setup.frame_moves()).then_some(&setup.mortar);
    table.begin(&setup.nonmortar, two, (all, pairs))
}

/// What a facet adds to the rows of carriers, and to what its nodes are coupled with.
fn beyond_facet<const N: usize>(
    (f, table): (usize, &dyn ReadTable),
    numbers: Option<&Numbers<N>>,
    row: &mut Vec<NodeBlock>,
    couplings: Option<&mut [NodeCouplings]>,
    emitter: &mut Emitter<N>,
) -> Result<()> {
    carried_tangent::rows((f, table), numbers.map(Numbers::carried), row, emitter)?;
    let at = (emitter.given, emitter.normals);
    couplings.map_or(Ok(()), |couplings| couple(at, (f, table), (numbers, row), couplings))
}

/// The blocks of the pairs of these facets.
pub fn of_facets<const N: usize>(
    task: Task<N>,
    facets: Range<usize>,
    room: &mut Room<N>,
    couplings: Option<&mut [NodeCouplings]>,
    emitter: &mut Emitter<N>,
) -> Result<i64> {
    if task.given.setup.has_blocks_of_nodes() {
        return Ok(0);
    }
    of_pairs(task, facets, room, couplings, emitter)
}

/// The same, whatever the tangent is made of.
pub fn of_pairs<const N: usize>(
    task: Task<N>,
    facets: Range<usize>,
    room: &mut Room<N>,
    mut couplings: Option<&mut [NodeCouplings]>,
    emitter: &mut Emitter<N>,
) -> Result<i64> {
    let (mut linearised, mut walk) = (0, Walk::through(task.pairs, facets));
    if task.given.setup.has_parents() {
        while let Some(f) = walk.next(&mut room.pairs)? {
            let Room { parent, pairs, row, .. } = &mut *room;
            linearised += parents::of_parent(task, pairs, parent, emitter)?;
            beyond_facet((f, parent.table()), task.numbers, row, couplings.as_deref_mut(), emitter)?;
        }
        return Ok(linearised);
    }
    let mut pairs = std::mem::take(&mut room.pairs);
    while let Some(f) = walk.next(&mut pairs)? {
        if task.numbers.is_some() {
            task.pairs.fetch(&pairs);
        }
        emitter.begin(f);
        linearised += of_facet(task, &pairs, room, couplings.as_deref_mut(), emitter)?;
    }
    room.pairs = pairs;
    Ok(linearised)
}

/// The blocks of the pairs of a facet.
fn of_facet<const N: usize>(
    task: Task<N>,
    pairs: &[UnionPair],
    Room { table, rows, linear, row, .. }: &mut Room<N>,
    couplings: Option<&mut [NodeCouplings]>,
    emitter: &mut Emitter<N>,
) -> Result<i64> {
    let Task { given, moves, numbers, .. } = task;
    let (options, f, mut linearised) = (&given.setup.options, pairs[0].one, 0);
    let one = &given.setup.nonmortar.facets[f];
    let couples = moves && options.basis == MultiplierBasis::Dual && options.differentiates_weights();
    begin(task, pairs, table)?;
    if let Some(numbers) = numbers {
        let nodes = FacetResponse::new(one.nodes.map(|a| &numbers.nodes[a]));
        linearised = linear_facet::fill(task, (numbers, pairs), &nodes, (table, linear), emitter)?;
        table.rows(Some(&nodes), rows)?;
        if let Some(turns) = &numbers.turns {
            turns.add_rows(given, f, rows);
        }
    } else {
        table.rows(None, rows)?;
        if couples {
            table.begin_coupled()?;
        } else if moves {
            let forces = ForceDerivatives::default();
            pairs.iter().filter(|pair| pair.is_active).for_each(|pair| emitter.pair(pair.two, &forces));
        }
    }
    let weights = table.weights_of(0..MAX_NODES);
    emitter.facet(f, Span::Own, table.acts.then_some((&table.forces[..MAX_NODES], &weights)), &rows[..MAX_NODES]);
    if moves {
        for (columns, nodes, acts) in table.groups() {
            let weights = table.weights_of(columns.start..columns.end);
            let now = acts.then_some((&table.forces[columns.start..columns.end], &weights));
            emitter.facet(f, Span::Group(nodes), now, &rows[columns]);
        }
    }
    if couples {
        let columns = &table.mortar[..table.active];
        for (rows, values) in table.coupled() {
            emitter.taker.mortar(&MortarBlock { rows, own: one.len, columns, values });
        }
    }
    beyond_facet((f, table), numbers, row, couplings, emitter)?;
    Ok(linearised)
}

/// What is not of the pairs of one facet alone: what normals that follow the motion add, and the nodes' own blocks.
pub fn of_nodes<const N: usize>(
    task: Task<N>,
    room: &mut Room<N>,
    mut couplings: Option<&mut [NodeCouplings]>,
    emitter: &mut Emitter<N>,
) -> Result<()> {
    let Task { given, pairs, extent, numbers, .. } = task;
    if given.setup.options.conserves() {
        let of = numbers.and_then(|n| n.conserving);
        return conserving::blocks((given, pairs, extent), (task.moves, numbers.map(|n| n.responses)), of, emitter);
    }
    if given.setup.decides_at_points() {
        let normals = task.normals;
        let turns = numbers.and_then(|n| n.turns.as_ref());
        let turn = |at| turns.map_or_else(NormalDerivatives::default, |turns| turns.of_normal(given, at));
        let turn: &dyn Fn(_) -> _ = &turn;
        let numbers = numbers.map(|n| PointNumbers {
            points: &n.responses.points,
            sums: n.sums,
            parents: &given.history().parents,
            normals,
            active: n.active,
            turns: turns.map(|_| turn),
        });
        // With friction there are three multipliers a node, and only there: known when this is compiled.
        if N == 3 {
            return point_friction::blocks((given, pairs), numbers.as_ref(), emitter);
        }
        return points::blocks((given, pairs), numbers.as_ref(), emitter);
    }
    let turns = numbers.and_then(|n| n.turns.as_ref());
    let answers = numbers.map(Numbers::answers);
    let options = &given.setup.options;
    if options.follows_normals() {
        let drow =
            |b: usize| numbers.map_or([SMatrix::zeros(); 2], |n| [n.nodes[b].drow_dnow, n.nodes[b].drow_dprevious]);
        turning::lone_facets(given, (pairs, extent), &mut room.lone)?;
        let beyond_rows = couplings.is_some() || !given.step.pairing.carriers.is_empty();
        if beyond_rows {
            let mut walk = Walk::through(pairs, 0..usize::MAX);
            while let Some(f) = walk.next(&mut room.pairs)? {
                turning::facet(f, (turns, drow), couplings.as_deref_mut(), emitter)?;
            }
            for &f in &room.lone.lone {
                turning::facet(f, (turns, drow), couplings.as_deref_mut(), emitter)?;
            }
        }
        room.lone.lone.iter().for_each(|&f| turning::lone_rows(f, turns, emitter));
    }
    frame::blocks((given, task.normals, pairs), numbers.map(FrameNumbers::from), &mut room.pairs, emitter)?;
    for a in 0..given.nodes() {
        let response = numbers.map(|n| &n.responses.nodes[a]);
        let is_carried = numbers.is_some_and(|n| n.responses.carried.get(a).is_some_and(|c| *c));
        emitter.node(a, &response.map_or_else(SMatrix::zeros, |r| r.drow_dlambda), extent);
        carried_tangent::multipliers(a, is_carried, emitter);
        if let Some(couplings) = couplings.as_ref().filter(|_| given.setup.nodes.acts(a)) {
            emitter.couplings(a, &couplings[a], &response.map_or_else(SMatrix::zeros, |r| r.dp_dlambda));
            if options.form == Form::Augmented {
                carried_tangent::forces(a, couplings, answers, emitter);
            }
        }
    }
    Ok(())
}
