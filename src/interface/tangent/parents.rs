//! The tangent of a facet of the host with all of its pairs, where either side has quadratic facets (docs/formulation.md 12.5).
//! Its parts are linearised one by one; what they add is summed up over the facet's nodes and then leaves node by node.

use super::derivatives::PairDerivatives;
use super::emission::{Emitter, Place};
use super::parent_table::{DualParent, MortarNode, ParentTable, bit};
use super::union::{Pairs, UnionPair};
use crate::element::{NodeTangent, ParentPair};
use crate::error::Result;
use crate::geometry::{Mat3, Vec3};
use crate::interface::data::active::Active;
use crate::interface::data::effects::Opposite;
use crate::interface::data::host_facets::parents_at;
use crate::interface::data::options::{MultiplierBasis, Tangent};
use crate::interface::data::parents::Parents;
use crate::interface::data::surface::Surface;
use crate::interface::pairing::given::Given;
use crate::interface::pairing::overlaps::FacetOverlaps;
use crate::interface::stages::carried::transfer;
use crate::memory::Store;
use crate::mortar::{GapDerivative, MORTAR, SubMotion, rule_for, sub_motion};
use crate::shape::{MAX_CORNERS, MAX_PARENT_NODES};
use nalgebra::SMatrix;

/// Where a facet's tangent is made.
#[derive(Debug, Default)]
pub struct ParentRoom {
    table: ParentTable,
    /// One, once it was needed: too large for the stack of a caller.
    motion: Vec<SubMotion>,
    overlaps: FacetOverlaps,
}

/// What its numbers are made of.
pub struct ParentNumbers<'a, const N: usize> {
    /// Non-mortar positions.
    pub x1: &'a [Vec3],
    /// What the pairs must know of the nodes.
    pub nodes: &'a [NodeTangent<N>],
    /// Which nodes are carried; empty where none is.
    pub carried: &'a [bool],
    /// The pairs whose weights are differentiated; `None`: no weights are.
    pub active: Option<&'a Active>,
    /// How they are.
    pub motion: PairDerivatives<'a>,
}

/// The blocks of facet f of the host with these pairs. Gives the pairs of parts whose weights were differentiated.
pub fn of_parent<const N: usize>(
    (given, normals): (Given<N>, &[Vec3]),
    (f, all, pairs): (usize, Pairs, &[UnionPair]),
    numbers: Option<&ParentNumbers<N>>,
    room: &mut ParentRoom,
    emitter: &mut Emitter<N>,
) -> Result<i64> {
    let ((one, two), moves) = (given.setup.surfaces(), given.setup.effects.moves());
    let (own, multipliers) = (one.host_nodes(f), one.multipliers(f));
    let of_pair = |(k, pair): (usize, &UnionPair)| (two.host_nodes(pair.two), if pair.is_active { bit(k) } else { 0 });
    let mortar = pairs.iter().enumerate().filter(|_| moves).map(of_pair);
    let mortar = mortar.flat_map(|(nodes, pairs)| nodes.iter().map(move |&node| MortarNode { node, pairs }));
    room.table.begin((own.len(), multipliers), mortar, numbers.is_some())?;
    let mut linearised = 0;
    if let Some(numbers) = numbers {
        for pair in pairs {
            let mut places = [None; MAX_PARENT_NODES];
            two.host_nodes(pair.two).iter().zip(&mut places).for_each(|(&c, place)| *place = room.table.column(c));
            let now = all.parent_now(pair);
            let integrated = match numbers.active {
                Some(active) if pair.is_active => Some(active.integrated_parent(pair.place)),
                _ => now,
            };
            room.table.add_weights(&places, [now, integrated, all.parent_previous(pair)]);
        }
        linearised = differentiate(given, f, pairs, numbers, room)?;
    }
    emit((given, normals), (f, pairs, numbers), &room.table, emitter);
    Ok(linearised)
}

/// Adds the derivatives of a facet's weights, and what else its gaps depend on.
fn differentiate<const N: usize>(
    given: Given<N>,
    f: usize,
    pairs: &[UnionPair],
    numbers: &ParentNumbers<N>,
    ParentRoom { table, motion, overlaps }: &mut ParentRoom,
) -> Result<i64> {
    let (one, two) = given.setup.surfaces();
    let (Some(parents), Some(opposite)) = (&one.parents, &two.parents) else { return Ok(0) };
    let Some(active) = numbers.active.filter(|_| pairs.iter().any(|pair| pair.is_active)) else {
        table.carry();
        return add_turned(given, parents, f, numbers.x1, table);
    };
    let (own, at) = (one.host_nodes(f), parents.at(f, &active.x1));
    let mut tractions = [Vec3::zeros(); MAX_PARENT_NODES];
    own.iter().zip(&mut tractions).for_each(|(&a, t)| *t = numbers.nodes[a].traction);
    let base = at.x[0];
    let mut x1 = at.x.map(|x| x - base);
    let mut basis = None;
    if given.setup.options.basis == MultiplierBasis::Dual {
        let of_pairs = pairs.iter().filter(|pair| pair.is_active).map(|pair| active.integrated_parent(pair.place));
        basis = one.parent_basis(f, &active.x1, of_pairs)?;
        if basis.is_none() {
            return Ok(0); // it has faded out
        }
    }
    let dual = basis.as_ref().map(|basis| {
        let gaps = gaps_of((one, two), active, pairs);
        let p = [0, 1, 2, 3].map(|a| tractions[a]);
        DualParent::new(basis, at.parent, p, &gaps, whole_area_derivative(given, parents, f, &active.x1))
    });
    if let Some(dual) = &dual {
        tractions[..MAX_CORNERS].copy_from_slice(&dual.field);
        x1 = dual.lowered(&x1);
    }
    if motion.is_empty() {
        motion.store(SubMotion::default())?;
    }
    let motion = &mut motion[0];
    let (mut linearised, moves) = (0, given.setup.effects.opposite == Opposite::Moves);
    for part in parents.parts(f) {
        let first = active.pairs.partition_point(|pair| pair.one < part);
        let of_part = active.pairs[first..].iter().take_while(|pair| pair.one == part).count();
        if of_part == 0 {
            continue;
        }
        overlaps.of(given, active, first..first + of_part)?;
        if numbers.motion.tangent == Tangent::FrozenNormals {
            overlaps.freeze_normals();
        }
        let sub = parents.sub(part);
        let rows = parents.space.nodes(at.parent, sub);
        let mut p = [[0.0; MAX_CORNERS]; 3];
        for (a, i) in (0..rows.len()).flat_map(|a| (0..3).map(move |i| (a, i))) {
            p[i][a] = tractions[rows[a]][i];
        }
        for (pair, segment) in active.pairs[first..first + of_part].iter().zip(&overlaps.segments) {
            let (g, sides) = (opposite.parent(pair.two), parents.sides(opposite, (part, pair.two)));
            let x2 = opposite.at(g, &active.x2).x.map(|x| x - base);
            let rule = rule_for(numbers.motion.rule, [sides.0.0, sides.1.0]);
            sub_motion((overlaps.frame(), segment, rule), sides, parents.space, &p, (&x1, &x2), motion);
            let mut slots = [None; 2 * MORTAR];
            (0..sub.shape.n).for_each(|k| slots[k] = Some(sub.nodes[k]));
            let mut columns = [None; MAX_PARENT_NODES];
            if moves {
                let nodes = two.host_nodes(g);
                nodes.iter().zip(&mut columns).for_each(|(&c, to)| *to = table.column(c));
                let other = sides.1.1;
                (0..other.shape.n).for_each(|l| slots[MORTAR + l] = columns[other.nodes[l]]);
            }
            table.add_motion(motion, &slots, &columns, rows);
            linearised += 1;
        }
    }
    table.carry();
    if let Some(dual) = &dual {
        table.make_dual(dual);
    }
    Ok(linearised)
}

/// Gaps of a facet as they were integrated, of its active pairs [L^3].
fn gaps_of(surfaces: (&Surface, &Surface), active: &Active, pairs: &[UnionPair]) -> [Vec3; MAX_CORNERS] {
    let mut gaps = [Vec3::zeros(); MAX_CORNERS];
    for pair in pairs.iter().filter(|pair| pair.is_active) {
        let (one, two) = parents_at(surfaces, &active.parents[pair.place], (&active.x1, &active.x2));
        let pair_of = ParentPair { one: &one, two: &two, multipliers: surfaces.0.multipliers(pair.one) };
        let of_pair = pair_of.gap(active.integrated_parent(pair.place));
        gaps.iter_mut().zip(of_pair).for_each(|(gap, add)| *gap += add);
    }
    gaps
}

/// D|e| of a facet with respect to its nodes, the sum over its parts, each in its own plane.
fn whole_area_derivative<const N: usize>(
    given: Given<N>,
    parents: &Parents,
    f: usize,
    x1: &[Vec3],
) -> [Vec3; MAX_PARENT_NODES] {
    let mut d = [Vec3::zeros(); MAX_PARENT_NODES];
    for part in parents.parts(f) {
        let (facet, sub) = (given.setup.nonmortar.facet(part, x1), parents.sub(part));
        let (e, n) = (facet.area_vector().normalize(), sub.shape.n);
        for k in 0..n {
            let between = facet.nodes[(k + 1) % n] - facet.nodes[(k + n - 1) % n];
            d[sub.nodes[k]] += between.cross(&e) * 0.5;
        }
    }
    d
}

/// Adds what the first gap, which turns with the parts of a tied facet, does to the gaps.
fn add_turned<const N: usize>(
    given: Given<N>,
    parents: &Parents,
    f: usize,
    x1: &[Vec3],
    table: &mut ParentTable,
) -> Result<i64> {
    for part in parents.parts(f) {
        let (sub, parent) = (parents.sub(part), parents.facets[f].parent);
        let turned = given.history().facet_gaps.motion(&given.setup.nonmortar, part, x1)?;
        let Some(GapDerivative::Turning(blocks)) = turned else { continue };
        for (a, &row) in parents.space.nodes(parent, sub).iter().enumerate() {
            for k in 0..sub.shape.n {
                table.add_gap(row, sub.nodes[k], &Mat3::from_fn(|i, j| blocks[k][i][j][a]));
            }
        }
    }
    Ok(0)
}

/// Gives the blocks of a facet's table. Which there are depends on its pairs alone.
fn emit<const N: usize>(
    (given, normals): (Given<N>, &[Vec3]),
    (f, pairs, numbers): (usize, &[UnionPair], Option<&ParentNumbers<N>>),
    table: &ParentTable,
    emitter: &mut Emitter<N>,
) {
    let ((one, two), options) = (given.setup.surfaces(), &given.setup.options);
    let own = one.host_nodes(f);
    let node = |column: usize| match column.checked_sub(own.len()) {
        None => own[column],
        Some(k) => one.len() + table.mortar[k].node,
    };
    let acts = |column: usize| match column.checked_sub(own.len()) {
        None => pairs.iter().any(|pair| pair.is_active),
        Some(k) => table.mortar[k].pairs != 0,
    };
    let columns = table.columns();
    let is_dual = options.basis == MultiplierBasis::Dual;
    // Mortar nodes of different facets are coupled by dual multipliers alone.
    let together = |row: usize, column: usize| {
        let (Some(c), Some(d)) = (row.checked_sub(own.len()), column.checked_sub(own.len())) else { return true };
        let [c, d] = [table.mortar[c], table.mortar[d]];
        let common = c.pairs & d.pairs;
        if is_dual || common != bit(usize::MAX) {
            return is_dual || common != 0;
        }
        let both = |pair: &UnionPair| {
            let nodes = two.host_nodes(pair.two);
            pair.is_active && nodes.contains(&c.node) && nodes.contains(&d.node)
        };
        pairs.iter().any(both)
    };
    for row in (0..columns).filter(|&row| acts(row)) {
        let place = Place::Displacement(node(row));
        if options.differentiates_weights() {
            for column in (0..columns).filter(|&column| acts(column) && together(row, column)) {
                let block = numbers.map_or_else(Mat3::zeros, |_| table.force(row, column));
                emitter.taker.node(place, Place::Displacement(node(column)), block.as_slice());
            }
        }
        if emitter.constraints.is_none() {
            for a in 0..table.multipliers {
                let weight = numbers.map_or(0.0, |_| table.now[a * columns + row]);
                emitter.taker.multiplier(place, own[a], weight, &normals[own[a]]);
            }
        }
    }
    for (a, &of) in own.iter().enumerate().take(table.multipliers) {
        for column in 0..columns {
            // (dc/dg_now) Dg and (dc/dg_previous) Dg at t_n's weights, of node `b` through a share T of them.
            let row = |b: usize, t: &Mat3| {
                let mut row = SMatrix::<f64, N, 3>::zeros();
                if let Some(numbers) = numbers {
                    let previous = Mat3::from_diagonal_element(table.previous[a * columns + column]);
                    row = numbers.nodes[b].drow_dnow * (t * table.gap(a, column));
                    row += numbers.nodes[b].drow_dprevious * (t * previous);
                }
                let values: [[f64; N]; 3] = std::array::from_fn(|j| std::array::from_fn(|n| row[(n, j)]));
                values
            };
            emitter.node_row(of, node(column), &row(of, &Mat3::identity()));
            for &(b, w) in given.carriers_of(of) {
                let is_carried = numbers.is_some_and(|n| n.carried.get(of).is_some_and(|c| *c));
                let share = if is_carried { transfer(given, of, normals[of], normals[b]) * w } else { Mat3::zeros() };
                emitter.node_row(b, node(column), &row(b, &share));
            }
        }
    }
}
