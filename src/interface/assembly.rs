//! Stages 3 and 4 over a whole interface: residual and tangent. How the tangent's blocks leave: `emission.rs`.

use super::augmented::NodeCouplings;
use super::emission::{Flat, Sink, entries};
use super::history::PairRecord;
use super::nodes::NodeSums;
use super::{Contact, Extent, Form, Scheme, effects};
use crate::element::{FacetResponse, NodeTangent, PairNow, PairTangent, pair_force, row_columns};
use crate::error::{Error, Kind, Result};
use crate::geometry::{Mat3, Vec3};
use crate::law::NodeResponse;
use crate::memory::{self, Store, Stored};
use crate::mortar::{MORTAR, PairWeights};
use crate::shape::MAX_NODES;
use crate::simd::{self, Kernel, Lanes};
use nalgebra::SVector;
use std::borrow::Cow;
use std::ops::Range;
use std::time::Instant;

/// Residual of an interface.
#[derive(Clone, Debug, PartialEq)]
pub struct Residual<const N: usize = 3> {
    /// Internal forces at the non-mortar nodes `[F]`; the force ON the body is the negative.
    pub nonmortar: Vec<Vec3>,
    /// Internal forces at the mortar nodes `[F]`.
    pub mortar: Vec<Vec3>,
    /// Multiplier rows (`[F]` or [L^3], see the row scale).
    pub rows: Vec<SVector<f64, N>>,
}

/// A pair of the union of those active now and those of t_n.
pub(super) struct UnionPair<'a> {
    pub one: usize,
    pub two: usize,
    pub now: Option<&'a PairWeights>,
    /// Its place among the current pairs, or that of the next one.
    pub place: usize,
    pub previous: Option<&'a PairWeights>,
}

impl<'a> UnionPair<'a> {
    fn now((place, pair): (usize, &'a PairRecord)) -> UnionPair<'a> {
        UnionPair { one: pair.one, two: pair.two, now: Some(&pair.weights), place, previous: None }
    }

    /// The places of those that are active now among the current pairs, of pairs that follow each other.
    fn places(pairs: &[UnionPair]) -> Range<usize> {
        let first = pairs[0].place;
        first..first + pairs.iter().filter(|pair| pair.now.is_some()).count()
    }
}

/// The sum of those weights that there are; n_AC of one pair alone.
fn total<'a>(weights: impl Iterator<Item = Option<&'a PairWeights>>) -> Option<Cow<'a, PairWeights>> {
    weights.flatten().map(Cow::Borrowed).reduce(|mut sum, weights| {
        let ab = &mut sum.to_mut().ab;
        simd::dispatch(Add { first: false, sum: ab.as_flattened_mut(), values: weights.ab.as_flattened() });
        sum
    })
}

impl<const N: usize> Contact<N> {
    /// The union of the pairs active now and, where slip counts, of those of t_n, sorted.
    pub(super) fn union(&self) -> Result<Vec<UnionPair<'_>>> {
        if self.is_apart() {
            return Ok(Vec::new());
        }
        if !self.kernels.slips {
            return self.current_pairs().iter().enumerate().map(UnionPair::now).stored();
        }
        let (mut now, mut previous) = (self.current_pairs().iter().peekable(), self.history.pairs.iter().peekable());
        let mut place = 0;
        let mut union = memory::with_room(now.len().max(previous.len()))?;
        loop {
            let heads = [now.peek(), previous.peek()];
            let Some((one, two)) = heads.into_iter().flatten().map(|p| (p.one, p.two)).min() else { return Ok(union) };
            let n = now.next_if(|p| (p.one, p.two) == (one, two));
            let p = previous.next_if(|p| (p.one, p.two) == (one, two));
            union.store(UnionPair { one, two, now: n.map(|p| &p.weights), place, previous: p.map(|p| &p.weights) })?;
            place += usize::from(n.is_some());
        }
    }

    /// Forces and multiplier rows at (x, lambda).
    pub fn residual(
        &mut self,
        x1: &[Vec3],
        x2: &[Vec3],
        lambda: &[SVector<f64, N>],
        sums: Option<&[NodeSums]>,
    ) -> Result<Residual<N>> {
        let responses = self.responses(x1, x2, lambda, sums)?;
        let mut r = Residual {
            nonmortar: memory::filled(Vec3::zeros(), self.nonmortar.len())?,
            mortar: memory::filled(Vec3::zeros(), self.mortar.len())?,
            rows: memory::filled(SVector::zeros(), self.nonmortar.len())?,
        };
        let normals = self.all_normals()?;
        let traction = |a: usize| self.force_traction(&lambda[a], &responses[a], normals[a]);
        let tractions: Vec<_> = (0..responses.len()).map(traction).stored()?;
        for pair in self.current_pairs() {
            let (one, two) = (&self.nonmortar.facets[pair.one], &self.mortar.facets[pair.two]);
            let f = pair_force(&pair.weights, &one.nodes.map(|a| tractions[a]));
            for k in 0..one.len {
                r.nonmortar[one.nodes[k]] += f[k];
            }
            for k in 0..two.len {
                r.mortar[two.nodes[k]] += f[MORTAR + k];
            }
        }
        for (a, response) in responses.iter().enumerate() {
            if self.owned[a] {
                r.rows[a] = response.row * self.row_scale(a);
            }
        }
        Ok(r)
    }

    pub(super) fn all_normals(&self) -> Result<Vec<Vec3>> {
        (0..self.nonmortar.len()).map(|a| self.normal(a)).stored_if_ok()
    }

    /// The traction that a node's forces use.
    fn force_traction(&self, lambda: &SVector<f64, N>, response: &NodeResponse<N>, nu: Vec3) -> Vec3 {
        match self.options.form {
            Form::Multiplier => effects::traction(lambda, nu),
            Form::Augmented => response.traction,
        }
    }

    /// The exact tangent d residual / d (x1, x2, lambda) at (x, lambda).
    pub fn tangent(
        &mut self,
        x1: &[Vec3],
        x2: &[Vec3],
        lambda: &[SVector<f64, N>],
        sums: Option<&[NodeSums]>,
        sink: &mut impl Sink,
    ) -> Result<()> {
        (self.kernels.tangent)(self, x1, x2, lambda, sums, sink)
    }

    /// The tangent, `MOVES`: with rows and columns of the mortar side.
    pub(super) fn tangent_with<const MOVES: bool>(
        &mut self,
        x1: &[Vec3],
        x2: &[Vec3],
        lambda: &[SVector<f64, N>],
        sums: Option<&[NodeSums]>,
        sink: &mut dyn Sink,
    ) -> Result<()> {
        if sums.is_some() && self.options.form == Form::Augmented {
            let text =
                "sums with the augmented form: its tangent couples pairs of different handles; use the multiplier form";
            return Err(Error::new(Kind::Unsupported, text));
        }
        let extent = Extent::of(sums);
        let (sums, responses) = self.evaluate(x1, x2, lambda, sums)?;
        let differentiates = self.options.differentiates_weights();
        if differentiates {
            self.ensure_segments()?;
        }
        let start = Instant::now();
        let mut linearised = 0;
        let mut couplings = self.augmented_couplings()?;
        let normals = self.all_normals()?;
        let nodes = self.node_tangents(lambda, &responses, &normals)?;
        let carried = self.carried(&sums)?;
        let analytic = self.mortar.analytic.map(|_| self.mortar.analytic_at(x2)).transpose()?;
        // Large, so that one of each serves all pairs.
        let (mut t, mut facet) = (PairTangent::default(), FacetTangent::default());
        // With a mortar side at rest all of it is linear in the weights of a facet's pairs; carried nodes and points in
        // place of cells take them one by one.
        let together = !MOVES && self.carriers.is_empty() && matches!(self.options.scheme, Scheme::Segments);
        let union = self.union()?;
        sink.reserve(entries::<MOVES, N>(&union, responses.len()));
        for pairs in union.chunk_by(|p, q| p.one == q.one) {
            let one = &self.nonmortar.facets[pairs[0].one];
            let facet_nodes = FacetResponse::new(one.nodes.map(|a| &nodes[a]));
            facet.acts = false;
            for (place, pairs) in pairs.chunks(if together { pairs.len() } else { 1 }).enumerate() {
                let (now, previous) = (total(pairs.iter().map(|p| p.now)), total(pairs.iter().map(|p| p.previous)));
                let mut gap = None;
                if let (Some(_), Some(k)) = (&now, self.integration.as_ref().filter(|_| differentiates)) {
                    let active = UnionPair::places(pairs);
                    linearised += active.len() as i64;
                    let overlaps = k.segments.get(active.clone()).unwrap_or_default();
                    let (frame, active) = (&k.frames[pairs[0].one], (&k.pairs[active], overlaps));
                    let (rule, p, f) = (self.options.rule, &facet_nodes.traction, &mut t.forces);
                    gap = Some((self.kernels.motion)(analytic.as_ref(), frame, active, rule, p, f)?);
                } else if place == 0 {
                    gap = self.history.facet_gaps.motion(&self.nonmortar, pairs[0].one, x1)?;
                }
                let now = now.as_deref().map(|weights| PairNow { weights, gap: gap.as_ref() });
                let previous = previous.as_deref();
                row_columns::<MOVES, N>(now.as_ref(), previous, &facet_nodes, &mut t.rows);
                if together {
                    let now = now.as_ref().map(|now| (&t.forces.one[..MORTAR], &now.weights.ab));
                    self.emit_facet(pairs[0].one, now, &t.rows[..MORTAR], &normals, sink);
                } else {
                    facet.add(place == 0, now.as_ref(), &t);
                }
                if MOVES {
                    self.emit_pair(&pairs[0], &t, &normals, sink);
                }
                self.emit_carried::<MOVES>(&pairs[0], now.as_ref(), Some((&carried, &nodes)), &normals, sink);
                if let Some(couplings) = &mut couplings {
                    for k in 0..one.len {
                        let a = one.nodes[k];
                        let dp = self.dtraction(a, &responses[a], normals[a]);
                        couplings[a].add_pair::<MOVES>(k, &self.slots(&pairs[0]), now.as_ref(), previous, dp)?;
                    }
                    let carried = Some((&carried[..], &responses[..]));
                    self.couple_carried::<MOVES>(&pairs[0], now.as_ref(), carried, &normals, couplings)?;
                }
            }
            if !together {
                self.emit_facet(pairs[0].one, facet.now(), &facet.rows, &normals, sink);
            }
        }
        for a in 0..responses.len() {
            self.emit_node(a, &responses[a].drow_dlambda, extent, sink);
            self.emit_carriers(a, carried.get(a).is_some_and(|c| *c), sink);
            if let Some(couplings) = &couplings {
                self.emit_couplings(a, &couplings[a], &responses[a].dp_dlambda, sink);
                self.emit_carried_forces(a, couplings, Some((&carried, &responses)), &normals, sink);
            }
        }
        self.counters.pairs_linearised += linearised;
        self.counters.seconds_assembly += start.elapsed().as_secs_f64();
        Ok(())
    }

    /// dp/dg_now and dp/dg_previous of a node.
    pub(super) fn dtraction(&self, a: usize, response: &NodeResponse<N>, nu: Vec3) -> (Mat3, Mat3) {
        let basis = effects::basis::<N>(nu) * self.augmentation(a);
        (basis * response.drow_dnow, basis * response.drow_dprevious)
    }

    pub(super) fn augmented_couplings(&self) -> Result<Option<Vec<NodeCouplings>>> {
        (self.options.form == Form::Augmented).then(|| memory::defaults(self.nonmortar.len())).transpose()
    }

    fn node_tangents(
        &self,
        lambda: &[SVector<f64, N>],
        responses: &[NodeResponse<N>],
        normals: &[Vec3],
    ) -> Result<Vec<NodeTangent<N>>> {
        let node = |a: usize| {
            let (response, scale) = (&responses[a], self.row_scale(a));
            NodeTangent {
                traction: self.force_traction(&lambda[a], response, normals[a]),
                drow_dnow: response.drow_dnow * scale,
                drow_dprevious: response.drow_dprevious * scale,
            }
        };
        (0..responses.len()).map(node).stored()
    }
}

/// A facet's d force / d x, `[k][j][i][B]`, and its weights n_AB.
pub(super) type FacetNow<'a> = (&'a [[[[f64; MAX_NODES]; 3]; 3]], &'a [[f64; MAX_NODES]; MAX_NODES]);

/// What the pairs of a non-mortar facet add to the same entries of the tangent.
pub(super) struct FacetTangent<const N: usize> {
    pub forces: [[[[f64; MAX_NODES]; 3]; 3]; MAX_NODES],
    pub rows: [[[[f64; MAX_NODES]; N]; 3]; MAX_NODES],
    pub weights: [[f64; MAX_NODES]; MAX_NODES],
    /// Whether a pair is active now.
    pub acts: bool,
}

impl<const N: usize> Default for FacetTangent<N> {
    fn default() -> Self {
        FacetTangent {
            forces: [[[[0.0; MAX_NODES]; 3]; 3]; MAX_NODES],
            rows: [[[[0.0; MAX_NODES]; N]; 3]; MAX_NODES],
            weights: [[0.0; MAX_NODES]; MAX_NODES],
            acts: false,
        }
    }
}

impl<const N: usize> FacetTangent<N> {
    /// What is there of pairs active now: d force / d x, and weights.
    pub fn now(&self) -> Option<FacetNow<'_>> {
        self.acts.then_some((&self.forces, &self.weights))
    }

    /// Adds a pair's share, or begins with the `first` one.
    pub fn add(&mut self, first: bool, now: Option<&PairNow>, t: &PairTangent<N>) {
        simd::dispatch(Add { first, sum: self.rows.flat_mut(), values: t.rows[..MORTAR].flat() });
        if let Some(PairNow { weights, .. }) = now {
            let (first, n) = (!self.acts, &weights.ab);
            self.acts = true;
            simd::dispatch(Add { first, sum: self.forces.flat_mut(), values: t.forces.one[..MORTAR].flat() });
            simd::dispatch(Add { first, sum: self.weights.as_flattened_mut(), values: n.as_flattened() });
        }
    }
}

/// Adds numbers, a multiple of four, to as many; the `first` ones replace what is there.
struct Add<'a> {
    first: bool,
    sum: &'a mut [f64],
    values: &'a [f64],
}

impl Kernel for Add<'_> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        if self.first {
            return self.sum.copy_from_slice(self.values);
        }
        for (sum, v) in self.sum.as_chunks_mut().0.iter_mut().zip(self.values.as_chunks().0) {
            *sum = (L::load(sum) + L::load(v)).store();
        }
    }
}
