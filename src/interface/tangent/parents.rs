//! The tangent of a facet of the host with all of its pairs, where either side has quadratic facets (docs/formulation 12.5).
//! Its parts are linearised one by one; what they add is summed up over the facet's nodes and then leaves node by node.

use super::derivatives::PairDerivatives;
use super::emission::{Blocks, Emitter, NodeBlock, Place, put_in_order};
use super::fields::Fields;
use super::frame::{self, FrameBlocks};
use super::lines::add_lines;
use super::parent_table::{DualParent, MortarNode, ParentTable, bit};
use super::read::{ReadTable, Through, square, vector};
use super::task::Task;
use super::union::UnionPair;
use crate::element::ParentPair;
use crate::error::Result;
use crate::features;
use crate::geometry::{Mat3, Vec3};
use crate::interface::data::active::Active;
use crate::interface::data::facet_gaps::FacetGaps;
use crate::interface::data::host_facets::parents_at;
use crate::interface::data::lines::{Lines, line};
use crate::interface::data::offsets;
use crate::interface::data::options::{Form, MultiplierBasis, Options, Tangent};
use crate::interface::data::parents::Parents;
use crate::interface::data::surface::Surface;
use crate::interface::pairing::filter::Filter;
use crate::interface::pairing::overlaps::FacetOverlaps;
use crate::interface::stages::sums::in_previous_gaps;
use crate::memory::{self, Store};
use crate::mortar::{MORTAR, SubMotion, rule_for, sub_motion};
use crate::quadrature::Rule;
use crate::shape::{MAX_CORNERS, MAX_PARENT_NODES};
use std::ops::Range;

/// Where a facet's tangent is made.
#[derive(Debug, Default)]
pub struct ParentRoom {
    table: ParentTable,
    columns: Columns,
    /// One, once it was needed: too large for the stack of a caller.
    motion: Vec<SubMotion>,
    overlaps: FacetOverlaps,
}

impl ParentRoom {
    /// What was filled last.
    pub fn table(&self) -> &ParentTable {
        &self.table
    }
}

/// Adds up what a facet of the host has with these pairs.
#[inline(never)] // two callers, one of them seldom
pub fn fill<const N: usize>(task: Task<N>, pairs: &[UnionPair], room: &mut ParentRoom) -> Result<i64> {
    features::PARTS.is_here();
    let (one, two) = task.given.setup.surfaces();
    let f = pairs[0].one;
    let of_pair = |(k, pair): (usize, &UnionPair)| (two.host_nodes(pair.two), if pair.is_active { bit(k) } else { 0 });
    let has_columns = task.moves || task.given.setup.frame_moves();
    let mortar = pairs.iter().enumerate().filter(|_| has_columns).map(of_pair);
    let mortar = mortar.flat_map(|(nodes, pairs)| nodes.iter().map(move |&node| MortarNode { node, pairs }));
    room.table.begin((one, f), mortar, task.numbers.is_some())?;
    room.table.acts = pairs.iter().any(|pair| pair.is_active);
    let Some(numbers) = task.numbers else { return Ok(0) };
    for pair in pairs {
        let mut places = [None; MAX_PARENT_NODES];
        two.host_nodes(pair.two).iter().zip(&mut places).for_each(|(&c, place)| *place = room.table.column(c));
        let now = task.pairs.parent_now(pair);
        let integrated = match numbers.active {
            Some(active) if pair.is_active => Some(active.integrated_parent(pair.place)),
            _ => now,
        };
        room.table.add_weights(&places, [now, integrated, task.pairs.parent_previous(pair)]);
    }
    let mut tractions = [Vec3::zeros(); MAX_PARENT_NODES];
    one.host_nodes(f).iter().zip(&mut tractions).for_each(|(&a, t)| *t = numbers.nodes[a].traction);
    let at = Sides {
        surfaces: (one, two),
        options: &task.given.setup.options,
        filter: task.given.step.pairing.filter.as_ref(),
        facet_gaps: &task.given.history().facet_gaps,
        normals: task.normals,
        x1: numbers.x1,
        moves: task.moves,
        how: numbers.motion,
        in_previous: in_previous_gaps(task.given),
        has_layer: task.given.setup.reads_areas(),
    };
    let linearised = at.differentiate((f, pairs), (numbers.active, tractions), room)?;
    if numbers.active.is_some() && frame::is_read(task.given) {
        room.table.put_frame(&FrameBlocks::of((task.given, task.pairs), &pairs[0], &numbers.into())?.gap);
    }
    Ok(linearised)
}

/// The blocks of a facet of the host with these pairs. Gives the pairs of parts whose weights were differentiated.
pub fn of_parent<const N: usize>(
    task: Task<N>,
    pairs: &[UnionPair],
    room: &mut ParentRoom,
    emitter: &mut Emitter<N>,
) -> Result<i64> {
    let (given, f) = (task.given, pairs[0].one);
    let one = &given.setup.nonmortar;
    let linearised = fill(task, pairs, room)?;
    // Those of a frame have rows in common with all facets (`frame.rs`).
    let leave = room.table.nodes().iter().filter(|(column, _)| task.moves || *column < room.table.own);
    let displacements = leave.map(|&(column, node)| (column, node, room.table.acts_on(column)));
    let acting = one.host_nodes(f).iter().take(one.multipliers(f)).enumerate();
    let acting = acting.filter(|(_, a)| given.setup.nodes.acts(**a));
    room.columns.begin(displacements, acting, &*emitter.taker)?;
    emit(task, (f, pairs), &room.table, &mut room.columns, emitter)?;
    Ok(linearised)
}

/// What the facets of one tangent have in common, however many multipliers a node has.
#[derive(Clone, Copy)]
struct Sides<'a> {
    surfaces: (&'a Surface, &'a Surface),
    options: &'a Options,
    filter: Option<&'a Filter>,
    /// Of tied surfaces the first gaps that turn with their facets.
    facet_gaps: &'a FacetGaps,
    normals: &'a [Vec3],
    /// Non-mortar positions.
    x1: &'a [Vec3],
    /// Whether the mortar side has rows and columns.
    moves: bool,
    how: PairDerivatives<'a>,
    /// Whether offsets count in the gaps that slip is measured from.
    in_previous: bool,
    /// Whether rows depend on covered areas.
    has_layer: bool,
}

impl Sides<'_> {
    /// Adds the derivatives of a facet's weights at these tractions, and what else its gaps depend on.
    fn differentiate(
        &self,
        (f, pairs): (usize, &[UnionPair]),
        (active, mut tractions): (Option<&Active>, [Vec3; MAX_PARENT_NODES]),
        ParentRoom { table, motion, overlaps, .. }: &mut ParentRoom,
    ) -> Result<i64> {
        let (one, two) = self.surfaces;
        let (Some(parents), Some(opposite)) = (&one.parents, &two.parents) else { return Ok(0) };
        let Some(active) = active.filter(|_| pairs.iter().any(|pair| pair.is_active)) else {
            table.carry();
            return self.add_turned(parents, f, table);
        };
        let (own, at) = (one.host_nodes(f), parents.at(f, &active.x1));
        let base = at.x[0];
        let mut x1 = at.x.map(|x| x - base);
        let mut basis = None;
        if self.options.basis == MultiplierBasis::Dual {
            let mut of_pairs =
                pairs.iter().filter(|pair| pair.is_active).map(|pair| active.integrated_parent(pair.place));
            basis = one.parent_basis(f, &active.x1, &mut of_pairs)?;
            if basis.is_none() {
                return Ok(0); // it has faded out
            }
        }
        let dual = basis.as_ref().map(|basis| {
            let gaps = gaps_of((one, two), active, pairs);
            let p = [0, 1, 2, 3].map(|a| tractions[a]);
            DualParent::new(basis, at.parent, p, &gaps, whole_area_derivative(one, parents, f, &active.x1))
        });
        if let Some(dual) = &dual {
            tractions[..MAX_CORNERS].copy_from_slice(&dual.field);
            x1 = dual.lowered(&x1);
        }
        if motion.is_empty() {
            motion.store(SubMotion::default())?;
        }
        let motion = &mut motion[0];
        let mut add = |tractions: &[Vec3], fields: Fields, table: &mut ParentTable| match parents.lines {
            _ if two.analytic.is_some() => {
                let [first, end] = [parents.parts(f).start, parents.parts(f).end]
                    .map(|part| active.pairs.partition_point(|pair| pair.one < part));
                let of = (self.how.rule, tractions, fields);
                over_surface((one, two), (f, base), (active, first..end), of, table, motion)
            }
            Some(Lines { measure, .. }) => {
                let [first, end] = [parents.parts(f).start, parents.parts(f).end]
                    .map(|part| active.pairs.partition_point(|pair| pair.one < part));
                let sides = (parents, opposite, self.moves.then_some(two));
                Ok(add_lines(sides, (f, measure), (active, first..end), (tractions, fields), table, motion))
            }
            None => self.add_parts((f, active), (tractions, fields), (table, motion, overlaps)),
        };
        let linearised = add(&tractions, Fields::Positions { one: &x1, base }, table)?;
        table.carry();
        if let Some(dual) = &dual {
            table.make_dual(dual);
        }
        if offsets::are_there((one, two)) {
            let eta = dual.as_ref().map(|dual| {
                let sums = offset_sums((one, two), active, pairs);
                dual.basis.heights(&sums)
            });
            let mut h = [Vec3::zeros(); MAX_PARENT_NODES];
            own.iter().zip(&mut h).for_each(|(&a, h)| h.x = one.offset(a));
            if let (Some(dual), Some(eta)) = (&dual, &eta) {
                h = dual.lowered_by(&h, &eta.map(|eta| Vec3::new(eta, 0.0, 0.0)));
            }
            table.begin_offsets()?;
            add(&[Vec3::zeros(); MAX_PARENT_NODES], Fields::Offsets { one: &h, two }, table)?;
            let mut nu = [Vec3::zeros(); MAX_PARENT_NODES];
            own.iter().zip(&mut nu).for_each(|(&a, nu)| *nu = self.normals[a]);
            table.put_offsets((nu, self.in_previous), dual.as_ref().zip(eta.as_ref()));
        }
        if let Some(dual) = dual.as_ref().filter(|_| self.has_layer) {
            table.fade_areas(dual);
        }
        Ok(linearised)
    }

    /// Adds the derivatives of facet f with its pairs part by part, at these tractions of its multipliers and fields; gives the number
    /// of pairs of parts.
    fn add_parts(
        &self,
        (f, active): (usize, &Active),
        (tractions, fields): (&[Vec3], Fields),
        (table, motion, overlaps): (&mut ParentTable, &mut SubMotion, &mut FacetOverlaps),
    ) -> Result<i64> {
        let Sides { surfaces: (one, two), how, moves, .. } = *self;
        let filter = self.filter.expect("weights that are differentiated are of now");
        let (Some(parents), Some(opposite)) = (&one.parents, &two.parents) else { return Ok(0) };
        let mut linearised = 0;
        for part in parents.parts(f) {
            let first = active.pairs.partition_point(|pair| pair.one < part);
            let of_part = active.pairs[first..].iter().take_while(|pair| pair.one == part).count();
            if of_part == 0 {
                continue;
            }
            overlaps.find((one, two), (self.options, filter), active, first..first + of_part)?;
            if how.tangent == Tangent::FrozenNormals {
                overlaps.freeze_normals();
            }
            let sub = parents.sub(part);
            let rows = parents.space.nodes(parents.facets[f].parent, sub);
            let mut p = [[0.0; MAX_CORNERS]; 3];
            for (a, i) in (0..rows.len()).flat_map(|a| (0..3).map(move |i| (a, i))) {
                p[i][a] = tractions[rows[a]][i];
            }
            for (pair, segment) in active.pairs[first..first + of_part].iter().zip(&overlaps.segments) {
                let (g, sides) = (opposite.parent(pair.two), parents.sides(opposite, (part, pair.two)));
                let x2 = fields.two(g, &opposite.at(g, &active.x2).x);
                let rule = rule_for(how.rule, [sides.0.0, sides.1.0]);
                sub_motion((overlaps.frame(), segment, rule), sides, parents.space, &p, (fields.one(), &x2), motion);
                let mut slots = [None; 2 * MORTAR];
                (0..sub.shape.n).for_each(|k| slots[k] = Some(sub.nodes[k]));
                let mut columns = [None; MAX_PARENT_NODES];
                if moves {
                    let nodes = two.host_nodes(g);
                    nodes.iter().zip(&mut columns).for_each(|(&c, to)| *to = table.column(c));
                    let other = sides.1.1;
                    (0..other.shape.n).for_each(|l| slots[MORTAR + l] = columns[other.nodes[l]]);
                }
                fields.add(table, motion, (&slots, &columns), rows);
                linearised += 1;
            }
        }
        Ok(linearised)
    }

    /// Adds what the first gap, which turns with the parts of a tied facet, does to the gaps.
    fn add_turned(&self, parents: &Parents, f: usize, table: &mut ParentTable) -> Result<i64> {
        for part in parents.parts(f) {
            let (sub, parent) = (parents.sub(part), parents.facets[f].parent);
            let turned = self.facet_gaps.motion(self.surfaces.0, part, self.x1)?;
            let Some(blocks) = turned else { continue };
            for (a, &row) in parents.space.nodes(parent, sub).iter().enumerate() {
                // A line's two nodes are those of its quadrilateral, each twice; a triangle has zeros for a fourth one.
                for (k, &node) in sub.nodes.iter().enumerate() {
                    table.add_gap(row, node, &Mat3::from_fn(|i, j| blocks[k][i][j][a]));
                }
            }
        }
        Ok(0)
    }
}

/// Of facet f against an analytic surface, with these places of active pairs: as `add_parts`.
fn over_surface(
    (one, two): (&Surface, &Surface),
    (f, base): (usize, Vec3),
    (active, places): (&Active, Range<usize>),
    (rule, tractions, fields): (&'static Rule, &[Vec3], Fields),
    table: &mut ParentTable,
    motion: &mut SubMotion,
) -> Result<i64> {
    let Some(parents) = &one.parents else { return Ok(0) };
    let surface = two.analytic_at(&active.x2)?;
    let mut lowered = fields.one().map(|x| x + (base - surface.origin));
    if let Fields::Offsets { one, .. } = fields {
        // Of int N_A h alone: what the nodes raised by h have more than the nodes.
        let x = parents.at(f, &active.x1).x.map(|x| x - surface.origin);
        lowered = std::array::from_fn(|k| x[k] + one[k]);
    }
    for pair in &active.pairs[places.start..places.end] {
        let (frame, sub) = (one.frame(pair.one, &active.x1, &active.normals)?, parents.sub(pair.one));
        let rows = parents.space.nodes(parents.facets[f].parent, sub);
        let mut p = [[0.0; MAX_CORNERS]; 3];
        for (a, i) in (0..rows.len()).flat_map(|a| (0..3).map(move |i| (a, i))) {
            p[i][a] = tractions[rows[a]][i];
        }
        let turned = parents.over_surface(pair.one, (&frame, &active.x1), (&surface, rule), |part, x| {
            part.motion((x, &lowered), &p, motion)
        })?;
        let mut slots = [None; 2 * MORTAR];
        (0..sub.shape.n).for_each(|k| slots[k] = Some(sub.nodes[k]));
        if let Fields::Offsets { .. } = fields {
            table.add_offsets((motion, 1.0), &slots, rows);
            parents.over_surface(pair.one, (&frame, &active.x1), (&surface, rule), |part, x| {
                part.motion((x, x), &p, motion)
            })?;
            table.add_offsets((motion, -1.0), &slots, rows);
            continue;
        }
        table.add_motion(motion, &slots, &[], rows);
        for (a, k) in (0..rows.len()).flat_map(|a| (0..one.host_nodes(f).len()).map(move |k| (a, k))) {
            table.add_gap(rows[a], k, &turned[a][k]);
        }
    }
    Ok(places.len() as i64)
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

/// o_A of a facet's multipliers with its weights as they were integrated, of its active pairs [L^3].
fn offset_sums((one, two): (&Surface, &Surface), active: &Active, pairs: &[UnionPair]) -> [f64; MAX_CORNERS] {
    let mut sums = [0.0; MAX_CORNERS];
    for pair in pairs.iter().filter(|pair| pair.is_active) {
        let n = active.integrated_parent(pair.place);
        for (a, sum) in sums.iter_mut().enumerate() {
            *sum += one.host_nodes(pair.one).iter().zip(&n.ab[a]).map(|(&b, n)| n * one.offset(b)).sum::<f64>();
            *sum += two.host_nodes(pair.two).iter().zip(&n.ac[a]).map(|(&c, n)| n * two.offset(c)).sum::<f64>();
        }
    }
    sums
}

/// D|e| of a facet with respect to its nodes, the sum over its parts, each in its own plane.
fn whole_area_derivative(one: &Surface, parents: &Parents, f: usize, x1: &[Vec3]) -> [Vec3; MAX_PARENT_NODES] {
    let mut d = [Vec3::zeros(); MAX_PARENT_NODES];
    if let Some(Lines { measure, .. }) = parents.lines {
        let of_line = line(&parents.at(f, x1)).area_derivative(measure);
        of_line.iter().zip(&mut d).for_each(|(of, d)| *d = Vec3::new(of.x, of.y, 0.0));
        return d;
    }
    for part in parents.parts(f) {
        let (facet, sub) = (one.facet(part, x1), parents.sub(part));
        let (e, n) = (facet.area_vector().normalize(), sub.shape.n);
        for k in 0..n {
            let between = facet.nodes[(k + 1) % n] - facet.nodes[(k + n - 1) % n];
            d[sub.nodes[k]] += between.cross(&e) * 0.5;
        }
    }
    d
}

/// The columns of a facet's blocks, each with its index in the table, in the order in which they are taken.
#[derive(Debug, Default)]
struct Columns {
    all: Vec<(usize, Place)>,
    /// Those that act: of active pairs.
    active: Vec<(usize, Place)>,
    /// Those with blocks in the row at hand.
    of_row: Vec<(usize, Place)>,
    multipliers: Vec<(usize, Place)>,
    /// The row of a multiplier.
    row: Vec<NodeBlock>,
}

impl Columns {
    fn begin<'a, const N: usize>(
        &mut self,
        displacements: impl Iterator<Item = (usize, usize, bool)>,
        multipliers: impl Iterator<Item = (usize, &'a usize)>,
        taker: &dyn Blocks<N>,
    ) -> Result<()> {
        [&mut self.all, &mut self.active, &mut self.multipliers].into_iter().for_each(Vec::clear);
        let order = |columns: &mut [(usize, Place)]| put_in_order(columns, &|place| taker.order(place));
        self.multipliers.store_all(multipliers.map(|(k, &a)| (k, Place::Multiplier(a))))?;
        order(&mut self.multipliers);
        for (k, node, acts) in displacements {
            let column = (k, Place::Displacement(node));
            self.all.store(column)?;
            if acts {
                self.active.store(column)?;
            }
        }
        order(&mut self.all);
        order(&mut self.active);
        Ok(())
    }
}

/// Gives the blocks of a facet's table. Which there are depends on its pairs alone.
fn emit<const N: usize>(
    Task { given, normals, numbers, .. }: Task<N>,
    (f, pairs): (usize, &[UnionPair]),
    table: &ParentTable,
    Columns { all, active, of_row, multipliers, row: values }: &mut Columns,
    emitter: &mut Emitter<N>,
) -> Result<()> {
    let ((one, two), options) = (given.setup.surfaces(), &given.setup.options);
    let own = one.host_nodes(f);
    let is_dual = options.basis == MultiplierBasis::Dual;
    let mut nu = [Vec3::zeros(); MAX_PARENT_NODES];
    own.iter().zip(&mut nu).for_each(|(&a, nu)| *nu = normals[a]);
    for &(row, place) in &*active {
        if options.differentiates_weights() {
            let of = match row.checked_sub(own.len()).filter(|_| !is_dual) {
                None => &*active,
                Some(row) => {
                    // Mortar nodes of different facets are coupled by dual multipliers alone.
                    let coupled = |(column, _): &(usize, Place)| {
                        column.checked_sub(own.len()).is_none_or(|column| table.share_a_pair([row, column], pairs, two))
                    };
                    of_row.clear();
                    of_row.store_all(active.iter().copied().filter(coupled))?;
                    &*of_row
                }
            };
            emitter.taker.row(place, of, table.force_row(row));
        }
        if emitter.constraints.is_none() && options.form == Form::Multiplier {
            let mut n = [0.0; MAX_PARENT_NODES];
            (0..table.multipliers).for_each(|a| n[a] = numbers.map_or(0.0, |_| table.now[a * table.columns() + row]));
            emitter.taker.multiplier_row(place, multipliers, &n, &nu);
        }
    }
    for (k, &a) in own.iter().enumerate().take(table.multipliers) {
        memory::refill(values, NodeBlock::default(), if numbers.is_some() { all.len() } else { 0 })?;
        if let Some(numbers) = numbers {
            let node = &numbers.nodes[a];
            let (now, previous) = (square(&node.drow_dnow), square(&node.drow_dprevious));
            table.gap_row(k, &Through { now, previous, area: vector(&node.drow_darea) }, values)?;
            if let Some(turns) = &numbers.turns {
                turns.add_row(given, (f, k), values);
            }
        }
        emitter.node_rows(a, all, values);
    }
    Ok(())
}
