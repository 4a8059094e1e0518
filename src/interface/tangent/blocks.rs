//! Stages 3 and 4 of the tangent: its blocks, with their numbers or without.
//!
//! The list of pairs (`union.rs`) says which blocks there are. One loop walks through it, whether the blocks have numbers or
//! are asked for alone: a count, a pattern and a fill have the same entries in the same order.

use super::augmented::{NodeCouplings, dtraction};
use super::carried_tangent;
use super::derivatives::PairDerivatives;
use super::dual_facet::{DualFacet, MortarRows, ShareRoom};
use super::emission::{Emitter, Takers};
use super::facet_tangent::{FacetTangent, total};
use super::frame::{self, FrameNumbers};
use super::offsets;
use super::parents::{self, ParentNumbers, ParentRoom};
use super::point_friction;
use super::points::{self, PointNumbers};
use super::turning::{self, Turns};
use super::union::{Pairs, UnionPair, Walk};
use crate::dual::FacetMotion;
use crate::element::{FacetResponse, NodeTangent, PairNow, PairTangent, row_columns};
use crate::error::Result;
use crate::geometry::{Mat3, Vec3};
use crate::interface::data::active::Active;
use crate::interface::data::extent::Extent;
use crate::interface::data::multiplier::force_traction;
use crate::interface::data::options::{Form, MultiplierBasis, Scheme};
use crate::interface::pairing::given::Given;
use crate::interface::pairing::overlaps::FacetOverlaps;
use crate::interface::stages::respond::Responses;
use crate::interface::stages::sums::NodeSums;
use crate::law::NodeResponse;
use crate::memory::{self, Store};
use crate::mortar::{self, ForceDerivatives, GapDerivative, MORTAR, PairWeights, gap};
use nalgebra::{SMatrix, SVector};
use std::ops::Range;

/// What the numbers of a tangent are made of.
pub struct Numbers<'a, const N: usize> {
    /// Non-mortar positions.
    pub x1: &'a [Vec3],
    /// What the nodes assemble.
    pub sums: &'a [NodeSums],
    /// The law's answers.
    pub responses: &'a Responses<N>,
    /// What the pairs must know of them.
    pub nodes: &'a [NodeTangent<N>],
    /// The pairs whose weights are differentiated; `None`: no weights are.
    pub active: Option<&'a Active>,
    /// How they are.
    pub motion: PairDerivatives<'a>,
    /// How answers turn with the normals of now; `None`: the normals are those of t_n.
    pub turns: Option<Turns<'a, N>>,
}

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
        }
    };
    nodes.clear();
    nodes.store_all((0..lambda.len()).map(node))
}

impl<const N: usize> Numbers<'_, N> {
    /// Which nodes are carried, with what the pairs must know of their carriers.
    fn carried(&self) -> (&[bool], &[NodeTangent<N>]) {
        (&self.responses.carried, self.nodes)
    }

    /// Which nodes are carried, with the law's answers.
    fn answers(&self) -> (&[bool], &[NodeResponse<N>]) {
        (&self.responses.carried, &self.responses.nodes)
    }

    /// Those of facets of the host, where either side has quadratic ones.
    fn of_parents(&self) -> ParentNumbers<'_, N> {
        let carried = &self.responses.carried;
        ParentNumbers { x1: self.x1, nodes: self.nodes, carried, active: self.active, motion: self.motion }
    }

    /// What the dual multipliers of a facet have in common over these pairs, all of its own.
    fn dual(&self, given: Given<N>, pairs: &[UnionPair], overlaps: &FacetOverlaps) -> Result<Option<DualFacet>> {
        self.active.map_or(Ok(None), |active| DualFacet::of(given, (active, overlaps), pairs))
    }

    /// As [`Numbers::derivatives`], of one pair of a facet with dual multipliers, which is `None` where it has faded out.
    fn dual_share(
        &self,
        given: Given<N>,
        (pair, dual, facet): (&UnionPair, &DualFacet, Option<&FacetMotion>),
        (overlaps, first): (&FacetOverlaps, usize),
        t: &mut PairTangent<N>,
        room: &mut ShareRoom,
    ) -> Result<Option<GapDerivative>> {
        let (active, facet) = match (self.active.filter(|_| pair.is_active), facet) {
            (Some(active), Some(facet)) => (active, facet),
            _ => {
                t.forces = ForceDerivatives::default();
                return Ok(None);
            }
        };
        if let Some(surface) = self.motion.surface {
            let (one, two) = given.setup.surfaces();
            let (one, two) = (one.facet(pair.one, &active.x1), two.facet(pair.two, &active.x2));
            let gaps = gap(active.integrated(pair.place), &one, &two);
            return dual.of_analytic(
                (&self.motion, surface),
                overlaps.frame(),
                (&facet.tractions, &gaps),
                (&mut t.forces, room),
            );
        }
        let mortar = given.setup.mortar.facets[pair.two].len;
        let share = (active.integrated(pair.place), &overlaps.segments[pair.place - first], mortar);
        Ok(Some(self.motion.of_share(overlaps.frame(), facet, share, &mut t.forces, room)))
    }

    /// Derivatives of `pairs` of one facet, whose first one has this place, its first ones where `is_first`: of
    /// the forces into `t`, of the gap, which are large, into `gap`.
    fn derivatives(
        &self,
        given: Given<N>,
        (pairs, place_of_first): (&[UnionPair], usize),
        (overlaps, is_first): (&FacetOverlaps, bool),
        nodes: &FacetResponse<N>,
        t: &mut PairTangent<N>,
        gap: &mut Option<GapDerivative>,
    ) -> Result<()> {
        let place = UnionPair::places(pairs);
        if let (false, Some(k)) = (place.is_empty(), self.active) {
            let of_facet = place.start - place_of_first..place.end - place_of_first;
            let (frame, segments) = (overlaps.frame(), overlaps.segments.get(of_facet).unwrap_or_default());
            return self.motion.of(frame, (&k.pairs[place], segments), &nodes.traction, &mut t.forces, gap);
        }
        if is_first {
            *gap = given.history().facet_gaps.motion(&given.setup.nonmortar, pairs[0].one, self.x1)?;
        }
        Ok(())
    }
}

/// Adds a pair to what its nodes' tractions are coupled with; in the multiplier form they act on its nodes, those of a frame
/// with equations too, and no gap of it moves them.
fn couple<const N: usize>(
    (given, normals): (Given<N>, &[Vec3]),
    (pair, now, previous): (&UnionPair, Option<&PairNow>, Option<&PairWeights>),
    numbers: Option<&Numbers<N>>,
    couplings: &mut [NodeCouplings],
) -> Result<()> {
    let (slots, moves) = (pair.slots(given.setup), given.setup.effects.moves());
    let mut nodes = given.setup.nonmortar.facets[pair.one].as_slice().iter().enumerate();
    if given.setup.options.form == Form::Multiplier {
        let slots = &slots[..mortar::slots(moves || given.setup.frame_moves())];
        return nodes.try_for_each(|(k, &a)| couplings[a].add_forces(k, slots, now));
    }
    for (k, &a) in nodes {
        let dp = match numbers {
            Some(n) => dtraction(given, a, &n.responses.nodes[a], normals[a]),
            None => (Mat3::zeros(), Mat3::zeros()),
        };
        couplings[a].add_pair(k, &slots[..mortar::slots(moves)], (now, previous), dp)?;
    }
    carried_tangent::couple((given, normals), pair, (now, previous), numbers.map(Numbers::answers), couplings)
}

/// What the blocks of a facet are computed in. Large, so that one serves all facets.
#[derive(Debug, Default)]
pub struct Room<const N: usize> {
    pair: PairTangent<N>,
    facet: FacetTangent<N>,
    share: ShareRoom,
    mortar: MortarRows,
    overlaps: FacetOverlaps,
    parent: ParentRoom,
    lone: turning::LoneRoom,
    /// Weights of several pairs, now and of t_n.
    sums: [PairWeights; 2],
    pairs: Vec<UnionPair>,
}

/// The tangent of some pairs.
#[derive(Clone, Copy)]
pub struct Task<'a, const N: usize> {
    /// The interface and its step.
    pub given: Given<'a, N>,
    /// nu of every node; zeros for the pattern alone.
    pub normals: &'a [Vec3],
    /// The pairs.
    pub pairs: Pairs<'a>,
    /// What the tangent is of.
    pub extent: Extent,
    /// Whether the mortar side has rows and columns.
    pub moves: bool,
    /// `None` for the pattern alone.
    pub numbers: Option<&'a Numbers<'a, N>>,
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
    if given.setup.has_parents() || given.setup.decides_at_points() {
        of_facets(task, 0..usize::MAX, room, couplings.as_deref_mut(), &mut emitter)?;
    } else {
        let mut walk = Walk::through(all, 0..usize::MAX);
        while walk.next(&mut room.pairs)?.is_some() {
            for pair in &room.pairs {
                let (now, previous) =
                    (all.now(pair).map(|weights| PairNow { weights, gap: None, offset: None }), all.previous(pair));
                beyond_pair(
                    (given, normals),
                    (pair, now.as_ref(), previous),
                    None,
                    couplings.as_deref_mut(),
                    &mut emitter,
                )?;
            }
        }
    }
    of_nodes(task, room, couplings.as_deref_mut(), &mut emitter)
}

/// What a pair adds to the rows of carriers, and to what its nodes are coupled with.
fn beyond_pair<const N: usize>(
    at: (Given<N>, &[Vec3]),
    (pair, now, previous): (&UnionPair, Option<&PairNow>, Option<&PairWeights>),
    numbers: Option<&Numbers<N>>,
    couplings: Option<&mut [NodeCouplings]>,
    emitter: &mut Emitter<N>,
) -> Result<()> {
    carried_tangent::rows(pair, (now, previous), numbers.map(Numbers::carried), emitter);
    couplings.map_or(Ok(()), |couplings| couple(at, (pair, now, previous), numbers, couplings))
}

/// Whether the tangent has what couples all pairs of a node.
pub fn is_coupled<const N: usize>(given: Given<N>) -> bool {
    let options = &given.setup.options;
    options.form == Form::Augmented || (options.follows_normals() && N == 1)
}

/// The blocks of the pairs of these facets.
pub fn of_facets<const N: usize>(
    task: Task<N>,
    facets: Range<usize>,
    room: &mut Room<N>,
    mut couplings: Option<&mut [NodeCouplings]>,
    emitter: &mut Emitter<N>,
) -> Result<i64> {
    // Where points decide, all blocks are of nodes.
    if task.given.setup.decides_at_points() {
        return Ok(0);
    }
    let (mut linearised, mut walk) = (0, Walk::through(task.pairs, facets));
    if task.given.setup.has_parents() {
        let numbers = task.numbers.map(Numbers::of_parents);
        while let Some(f) = walk.next(&mut room.pairs)? {
            let pairs = (f, task.pairs, &room.pairs[..]);
            let at = (task.given, task.normals);
            linearised += parents::of_parent(at, pairs, numbers.as_ref(), &mut room.parent, emitter)?;
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
    Task { given, normals, pairs: all, moves, numbers, .. }: Task<N>,
    pairs: &[UnionPair],
    Room { pair: t, facet, share, mortar, overlaps, sums, .. }: &mut Room<N>,
    mut couplings: Option<&mut [NodeCouplings]>,
    emitter: &mut Emitter<N>,
) -> Result<i64> {
    let options = &given.setup.options;
    let mut linearised = 0;
    // With a mortar side at rest all of it is linear in the weights of a facet's pairs; carried nodes and points in place
    // of overlaps take them one by one.
    let is_dual = options.basis == MultiplierBasis::Dual && options.differentiates_weights();
    let together =
        !moves && !is_dual && given.step.pairing.carriers.is_empty() && matches!(options.scheme, Scheme::Segments);
    let turns = numbers.and_then(|n| n.turns.as_ref());
    let f = pairs[0].one;
    let one = &given.setup.nonmortar.facets[f];
    let facet_nodes = numbers.map(|n| FacetResponse::new(one.nodes.map(|a| &n.nodes[a])));
    facet.acts = false;
    let places = UnionPair::places(pairs);
    if let Some(active) = numbers.and_then(|n| n.active).filter(|_| !places.is_empty()) {
        overlaps.of(given, active, UnionPair::places(pairs))?;
    }
    let dual = numbers.map_or(Ok(None), |n| n.dual(given, pairs, overlaps))?;
    let motion = match (&dual, &facet_nodes) {
        (Some(dual), Some(nodes)) => dual.motion(overlaps.frame(), &nodes.traction),
        _ => None,
    };
    if moves && is_dual {
        mortar.begin(one, &given.setup.mortar, pairs)?;
    }
    for (place, pairs) in pairs.chunks(if together { pairs.len() } else { 1 }).enumerate() {
        let [sum_now, sum_previous] = &mut *sums;
        let now = total(sum_now, pairs.iter().map(|p| all.now(p)));
        let previous = total(sum_previous, pairs.iter().map(|p| all.previous(p)));
        let (mut gap, mut offset) = (None, None);
        if let (Some(numbers), Some(nodes)) = (numbers, &facet_nodes) {
            if let Some(dual) = &dual {
                let pair = (&pairs[0], dual, motion.as_ref());
                gap = numbers.dual_share(given, pair, (overlaps, places.start), t, share)?;
                if let (true, true, Some(active)) = (moves, gap.is_some(), numbers.active) {
                    let two = &given.setup.mortar.facets[pairs[0].two];
                    mortar.add(two, active.integrated(pairs[0].place), &share.tractions, &t.forces);
                }
            } else {
                numbers.derivatives(given, (pairs, places.start), (overlaps, place == 0), nodes, t, &mut gap)?;
            }
            let dual = (dual.as_ref(), &*share);
            offset = offsets::of_pairs(
                (given, normals),
                (numbers.active, &numbers.motion),
                (pairs, places.start),
                overlaps,
                dual,
            )?;
            linearised += if numbers.active.is_some() { UnionPair::places(pairs).len() as i64 } else { 0 };
        }
        let now = now.map(|weights| PairNow { weights, gap: gap.as_ref(), offset: offset.as_ref() });
        if let Some(nodes) = &facet_nodes {
            row_columns(moves, (now.as_ref(), previous), nodes, &mut t.rows);
        }
        if together {
            if let Some(turns) = turns {
                turns.add_rows(given, f, &mut t.rows);
            }
            let now = now.as_ref().map(|now| (&t.forces.one[..MORTAR], &now.weights.ab));
            emitter.facet(f, now, &t.rows[..MORTAR]);
        } else {
            facet.add(place == 0, now.as_ref(), t);
        }
        if moves {
            emitter.pair(&pairs[0], all.now(&pairs[0]), t);
        }
        let pair = (&pairs[0], now.as_ref(), previous);
        beyond_pair((given, normals), pair, numbers, couplings.as_deref_mut(), emitter)?;
    }
    if !together {
        if let Some(turns) = turns {
            turns.add_rows(given, f, &mut facet.rows);
        }
        emitter.facet(f, facet.now(), &facet.rows);
    }
    if moves && is_dual {
        if numbers.is_some() {
            mortar.couple();
        }
        mortar.emit(emitter.taker);
    }
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
    if given.setup.decides_at_points() {
        let normals = task.normals;
        let numbers =
            numbers.map(|n| PointNumbers { points: &n.responses.points, sums: n.sums, normals, active: n.active });
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
        let drow_dnow = |b: usize| numbers.map_or_else(SMatrix::zeros, |n| n.nodes[b].drow_dnow);
        turning::lone_facets(given, (pairs, extent), &mut room.lone)?;
        let beyond_rows = couplings.is_some() || (N == 1 && !given.step.pairing.carriers.is_empty());
        if beyond_rows {
            let mut walk = Walk::through(pairs, 0..usize::MAX);
            while let Some(f) = walk.next(&mut room.pairs)? {
                turning::facet(f, (turns, drow_dnow), couplings.as_deref_mut(), emitter)?;
            }
            for &f in &room.lone.lone {
                turning::facet(f, (turns, drow_dnow), couplings.as_deref_mut(), emitter)?;
            }
        }
        room.lone.lone.iter().for_each(|&f| turning::lone_rows(f, turns, emitter));
    }
    let frame_numbers = numbers.map(|n| FrameNumbers {
        nodes: n.nodes,
        active: n.active,
        surface: n.motion.surface,
        rule: n.motion.rule,
    });
    let room = (&mut room.pairs, &mut room.overlaps);
    frame::blocks((given, task.normals, pairs), frame_numbers, room, emitter)?;
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
