//! Stages 3 and 4 of the tangent: its blocks, with their numbers or without.
//!
//! The list of pairs (`union.rs`) says which blocks there are. One loop walks through it, whether the blocks have numbers or
//! are asked for alone: a count, a pattern and a fill have the same entries in the same order.

use super::augmented::{NodeCouplings, dtraction};
use super::carried_tangent;
use super::derivatives::PairDerivatives;
use super::dual_facet::{DualFacet, MortarRows, ShareRoom};
use super::emission::{Emitter, Sinks, entries};
use super::facet_tangent::{FacetTangent, total};
use super::turning::{self, Turns};
use super::union::UnionPair;
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
use crate::law::NodeResponse;
use crate::memory::{self, Stored};
use crate::mortar::{ForceDerivatives, GapDerivative, MORTAR, PairWeights, gap};
use nalgebra::{SMatrix, SVector};

/// What the numbers of a tangent are made of.
pub struct Numbers<'a, const N: usize> {
    /// Non-mortar positions.
    pub x1: &'a [Vec3],
    /// The law's answers.
    pub responses: &'a Responses<N>,
    /// What the pairs must know of them.
    pub nodes: Vec<NodeTangent<N>>,
    /// The pairs whose weights are differentiated; `None`: no weights are.
    pub active: Option<&'a Active>,
    /// How they are.
    pub motion: PairDerivatives<'a>,
    /// How answers turn with the normals of now; `None`: the normals are those of t_n.
    pub turns: Option<Turns<'a, N>>,
}

/// What a pair must know of every node's response; `scale`: the factor of a node's rows.
pub fn node_tangents<const N: usize>(
    given: Given<N>,
    lambda: &[SVector<f64, N>],
    responses: &Responses<N>,
    normals: &[Vec3],
    scale: impl Fn(usize) -> f64,
) -> Result<Vec<NodeTangent<N>>> {
    let node = |a: usize| {
        let (response, scale) = (&responses.nodes[a], scale(a));
        NodeTangent {
            traction: force_traction(given.setup.options.form, &lambda[a], response, normals[a]),
            drow_dnow: response.drow_dnow * scale,
            drow_dprevious: response.drow_dprevious * scale,
        }
    };
    (0..lambda.len()).map(node).stored()
}

impl<const N: usize> Numbers<'_, N> {
    /// Which nodes are carried, with what the pairs must know of their carriers.
    fn carried(&self) -> (&[bool], &[NodeTangent<N>]) {
        (&self.responses.carried, &self.nodes)
    }

    /// Which nodes are carried, with the law's answers.
    fn answers(&self) -> (&[bool], &[NodeResponse<N>]) {
        (&self.responses.carried, &self.responses.nodes)
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
        let (active, facet) = match (self.active.filter(|_| pair.now.is_some()), facet) {
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
                &mut t.forces,
            );
        }
        let mortar = given.setup.mortar.facets[pair.two].len;
        let share = (active.integrated(pair.place), &overlaps.segments[pair.place - first], mortar);
        Ok(Some(self.motion.of_share(overlaps.frame(), facet, share, &mut t.forces, room)))
    }

    /// Derivatives of `pairs` of one facet, whose first one has this place, its first ones where `is_first`: of the gap, and of
    /// the forces into `t`.
    fn derivatives(
        &self,
        given: Given<N>,
        (pairs, place_of_first): (&[UnionPair], usize),
        (overlaps, is_first): (&FacetOverlaps, bool),
        nodes: &FacetResponse<N>,
        t: &mut PairTangent<N>,
    ) -> Result<Option<GapDerivative>> {
        let place = UnionPair::places(pairs);
        if let (false, Some(k)) = (place.is_empty(), self.active) {
            let of_facet = place.start - place_of_first..place.end - place_of_first;
            let (frame, segments) = (overlaps.frame(), overlaps.segments.get(of_facet).unwrap_or_default());
            return self.motion.of(frame, (&k.pairs[place], segments), &nodes.traction, &mut t.forces).map(Some);
        }
        if is_first {
            given.history().facet_gaps.motion(&given.setup.nonmortar, pairs[0].one, self.x1)
        } else {
            Ok(None)
        }
    }
}

/// Adds a pair to what its nodes' tractions are coupled with; in the multiplier form they act on its nodes, and no gap of
/// it moves them.
fn couple<const MOVES: bool, const N: usize>(
    (given, normals): (Given<N>, &[Vec3]),
    (pair, now, previous): (&UnionPair, Option<&PairNow>, Option<&PairWeights>),
    numbers: Option<&Numbers<N>>,
    couplings: &mut [NodeCouplings],
) -> Result<()> {
    let slots = pair.slots(given.setup);
    let mut nodes = given.setup.nonmortar.facets[pair.one].as_slice().iter().enumerate();
    if given.setup.options.form == Form::Multiplier {
        return nodes.try_for_each(|(k, &a)| couplings[a].add_forces::<MOVES>(k, &slots, now));
    }
    for (k, &a) in nodes {
        let dp = match numbers {
            Some(n) => dtraction(given, a, &n.responses.nodes[a], normals[a]),
            None => (Mat3::zeros(), Mat3::zeros()),
        };
        couplings[a].add_pair::<MOVES>(k, &slots, now, previous, dp)?;
    }
    carried_tangent::couple::<MOVES, N>((given, normals), pair, now, numbers.map(Numbers::answers), couplings)
}

/// The blocks of a tangent of these pairs, `MOVES`: with rows and columns of the mortar side. `numbers`: `None` for the
/// pattern alone. `constraints`: of a condensed system, see [`Emitter::constraints`]. Gives the number of pairs whose weights
/// were differentiated.
pub fn blocks<const MOVES: bool, const N: usize>(
    (given, normals): (Given<N>, &[Vec3]),
    union: &[UnionPair],
    extent: Extent,
    numbers: Option<&Numbers<N>>,
    (sink, constraints): Sinks,
) -> Result<i64> {
    let options = &given.setup.options;
    let mut linearised = 0;
    let augmented = options.form == Form::Augmented;
    let follows = options.follows_normals();
    let coupled = augmented || (follows && N == 1);
    let mut couplings: Option<Vec<NodeCouplings>> = coupled.then(|| memory::defaults(given.nodes())).transpose()?;
    // Large, so that one of each serves all pairs.
    let (mut t, mut facet) = (PairTangent::default(), FacetTangent::default());
    let (mut room, mut mortar) = (ShareRoom::default(), MortarRows::default());
    let mut overlaps = FacetOverlaps::default();
    // With a mortar side at rest all of it is linear in the weights of a facet's pairs; carried nodes and points in place
    // of overlaps take them one by one.
    let is_dual = options.basis == MultiplierBasis::Dual && options.differentiates_weights();
    let together =
        !MOVES && !is_dual && given.step.pairing.carriers.is_empty() && matches!(options.scheme, Scheme::Segments);
    sink.reserve(entries::<MOVES, N>(union, given.nodes()));
    let mut emitter = Emitter { given, normals, sink, constraints };
    let carried_nodes = numbers.map(Numbers::carried);
    let turns = numbers.and_then(|n| n.turns.as_ref());
    let answers = numbers.map(Numbers::answers);
    for pairs in union.chunk_by(|p, q| p.one == q.one) {
        let f = pairs[0].one;
        let one = &given.setup.nonmortar.facets[f];
        let facet_nodes = numbers.map(|n| FacetResponse::new(one.nodes.map(|a| &n.nodes[a])));
        facet.acts = false;
        let places = UnionPair::places(pairs);
        if let Some(active) = numbers.and_then(|n| n.active).filter(|_| !places.is_empty()) {
            overlaps.of(given, active, UnionPair::places(pairs))?;
        }
        let dual = numbers.map_or(Ok(None), |n| n.dual(given, pairs, &overlaps))?;
        let motion = match (&dual, &facet_nodes) {
            (Some(dual), Some(nodes)) => dual.motion(overlaps.frame(), &nodes.traction),
            _ => None,
        };
        if MOVES && is_dual {
            mortar.begin(one, &given.setup.mortar, pairs)?;
        }
        for (place, pairs) in pairs.chunks(if together { pairs.len() } else { 1 }).enumerate() {
            let (now, previous) = (total(pairs.iter().map(|p| p.now)), total(pairs.iter().map(|p| p.previous)));
            let (previous, mut gap) = (previous.as_deref(), None);
            if let (Some(numbers), Some(nodes)) = (numbers, &facet_nodes) {
                gap = if let Some(dual) = &dual {
                    let pair = (&pairs[0], dual, motion.as_ref());
                    let gap = numbers.dual_share(given, pair, (&overlaps, places.start), &mut t, &mut room)?;
                    if let (true, true, Some(active)) = (MOVES, gap.is_some(), numbers.active) {
                        let two = &given.setup.mortar.facets[pairs[0].two];
                        mortar.add(two, active.integrated(pairs[0].place), &room.tractions, &t.forces);
                    }
                    gap
                } else {
                    numbers.derivatives(given, (pairs, places.start), (&overlaps, place == 0), nodes, &mut t)?
                };
                linearised += if numbers.active.is_some() { UnionPair::places(pairs).len() as i64 } else { 0 };
            }
            let now = now.as_deref().map(|weights| PairNow { weights, gap: gap.as_ref() });
            if let Some(nodes) = &facet_nodes {
                row_columns::<MOVES, N>(now.as_ref(), previous, nodes, &mut t.rows);
            }
            if together {
                if let Some(turns) = turns {
                    turns.add_rows(given, f, &mut t.rows);
                }
                let now = now.as_ref().map(|now| (&t.forces.one[..MORTAR], &now.weights.ab));
                emitter.facet(f, now, &t.rows[..MORTAR]);
            } else {
                facet.add(place == 0, now.as_ref(), &t);
            }
            if MOVES {
                emitter.pair(&pairs[0], &t);
            }
            carried_tangent::rows::<MOVES, N>(&pairs[0], now.as_ref(), carried_nodes, &mut emitter);
            if let Some(couplings) = &mut couplings {
                couple::<MOVES, N>((given, normals), (&pairs[0], now.as_ref(), previous), numbers, couplings)?;
            }
        }
        if !together {
            if let Some(turns) = turns {
                turns.add_rows(given, f, &mut facet.rows);
            }
            emitter.facet(f, facet.now(), &facet.rows);
        }
        if MOVES && is_dual {
            if numbers.is_some() {
                mortar.couple();
            }
            mortar.emit(&emitter.facet_equations(f), emitter.sink);
        }
    }
    if follows {
        let drow_dnow = |b: usize| numbers.map_or_else(SMatrix::zeros, |n| n.nodes[b].drow_dnow);
        let lone = turning::lone_facets(given, union)?;
        let paired = union.chunk_by(|p, q| p.one == q.one).map(|pairs| pairs[0].one);
        let beyond_rows = couplings.is_some() || (N == 1 && !given.step.pairing.carriers.is_empty());
        for f in paired.chain(lone.iter().copied()).filter(|_| beyond_rows) {
            turning::facet(f, (turns, drow_dnow), couplings.as_deref_mut(), &mut emitter)?;
        }
        lone.iter().for_each(|&f| turning::lone_rows(f, turns, &mut emitter));
    }
    for a in 0..given.nodes() {
        let response = numbers.map(|n| &n.responses.nodes[a]);
        let is_carried = numbers.is_some_and(|n| n.responses.carried.get(a).is_some_and(|c| *c));
        emitter.node(a, &response.map_or_else(SMatrix::zeros, |r| r.drow_dlambda), extent);
        carried_tangent::multipliers(a, is_carried, &mut emitter);
        if let Some(couplings) = &couplings {
            emitter.couplings(a, &couplings[a], &response.map_or_else(SMatrix::zeros, |r| r.dp_dlambda));
            if augmented {
                carried_tangent::forces(a, couplings, answers, &mut emitter);
            }
        }
    }
    Ok(linearised)
}
