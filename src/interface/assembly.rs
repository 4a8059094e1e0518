//! Stages 3 and 4 over a whole interface: residual and tangent in the host's numbering.
//!
//! The tangent is written to a sink as (row, column, value); entries without an equation are left out
//! and duplicates add up. Which entries appear depends on the active pairs, never on the values, so a
//! count and a fill always agree.

use super::augmented::NodeCouplings;
use super::history::PairRecord;
use super::nodes::NodeSums;
use super::{Contact, FacetNodes, Form, NO_EQUATION, effects};
use crate::element::{FacetResponse, NodeTangent, PairNow, PairTangent, pair_force, row_columns};
use crate::error::{Error, Kind, Result};
use crate::geometry::{Mat3, Vec3};
use crate::law::NodeResponse;
use crate::mortar::{MORTAR, PAIR_NODES, PairWeights};
use crate::shape::MAX_NODES;
use crate::simd::{self, Kernel, Lanes};
use nalgebra::{SMatrix, SVector};
use std::time::Instant;

/// Takes a tangent entry: (row equation, column equation, value).
pub trait Sink {
    /// Adds `value` at (row, column), both 0-based equations.
    fn add(&mut self, row: i64, column: i64, value: f64);

    /// Hears that about so many entries follow.
    fn reserve(&mut self, _entries: usize) {}

    /// Adds a block, its values column by column.
    fn add_block(&mut self, rows: &[i64], columns: &[i64], values: &[f64]) {
        for (&column, values) in columns.iter().zip(values.chunks_exact(rows.len())) {
            if column != NO_EQUATION {
                for (&row, &value) in rows.iter().zip(values) {
                    if row != NO_EQUATION {
                        self.add(row, column, value);
                    }
                }
            }
        }
    }
}

impl<F: FnMut(i64, i64, f64)> Sink for F {
    fn add(&mut self, row: i64, column: i64, value: f64) {
        self(row, column, value);
    }
}

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
    /// Its place among the current pairs.
    pub place: usize,
    pub previous: Option<&'a PairWeights>,
}

impl<'a> UnionPair<'a> {
    fn now((place, pair): (usize, &'a PairRecord)) -> UnionPair<'a> {
        UnionPair { one: pair.one, two: pair.two, now: Some(&pair.weights), place, previous: None }
    }
}

impl<const N: usize> Contact<N> {
    /// The union of the pairs active now and, where slip counts, of those of t_n, sorted.
    fn union(&self) -> Vec<UnionPair<'_>> {
        if self.is_apart() {
            return Vec::new();
        }
        if !self.kernels.slips {
            return self.current_pairs().iter().enumerate().map(UnionPair::now).collect();
        }
        let (mut now, mut previous) = (self.current_pairs().iter().peekable(), self.history.pairs.iter().peekable());
        let mut place = 0;
        let mut union = Vec::with_capacity(now.len().max(previous.len()));
        loop {
            let heads = [now.peek(), previous.peek()];
            let Some((one, two)) = heads.into_iter().flatten().map(|p| (p.one, p.two)).min() else { return union };
            let n = now.next_if(|p| (p.one, p.two) == (one, two));
            let p = previous.next_if(|p| (p.one, p.two) == (one, two));
            union.push(UnionPair { one, two, now: n.map(|p| &p.weights), place, previous: p.map(|p| &p.weights) });
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
            nonmortar: vec![Vec3::zeros(); self.nonmortar.len()],
            mortar: vec![Vec3::zeros(); self.mortar.len()],
            rows: vec![SVector::zeros(); self.nonmortar.len()],
        };
        let normals = self.all_normals()?;
        let traction = |a: usize| self.force_traction(&lambda[a], &responses[a], normals[a]);
        let tractions: Vec<_> = (0..responses.len()).map(traction).collect();
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
        (0..self.nonmortar.len()).map(|a| self.normal(a)).collect()
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
        let (sums, responses) = self.evaluate(x1, x2, lambda, sums)?;
        let differentiates = self.options.differentiates_weights();
        if differentiates {
            self.ensure_segments()?;
        }
        let start = Instant::now();
        let mut linearised = 0;
        let mut couplings = self.augmented_couplings();
        let normals = self.all_normals()?;
        let nodes = self.node_tangents(lambda, &responses, &normals);
        let carried = self.carried(&sums);
        // Large, so that one of each serves all pairs.
        let (mut t, mut facet) = (PairTangent::default(), FacetTangent::default());
        let union = self.union();
        sink.reserve(entries::<MOVES, N>(&union, responses.len()));
        for pairs in union.chunk_by(|p, q| p.one == q.one) {
            let one = &self.nonmortar.facets[pairs[0].one];
            let facet_nodes = FacetResponse::new(one.nodes.map(|a| &nodes[a]));
            facet.acts = false;
            for (place, pair) in pairs.iter().enumerate() {
                let mut gap = None;
                if let (Some(weights), Some(k)) = (pair.now, self.integration.as_ref().filter(|_| differentiates)) {
                    let overlap = (&k.frames[pair.one], k.segments.get(pair.place));
                    let (rule, p, f) = (self.options.rule, &facet_nodes.traction, &mut t.forces);
                    gap = Some((self.kernels.motion)((&self.mortar, x2), overlap, weights, rule, p, f)?);
                    linearised += 1;
                }
                let now = pair.now.map(|weights| PairNow { weights, gap: gap.as_ref() });
                row_columns::<MOVES, N>(now.as_ref(), pair.previous, &facet_nodes, &mut t.rows);
                facet.add(place == 0, pair, &t);
                self.emit_pair::<MOVES>(pair, &t, &normals, sink);
                self.emit_carried::<MOVES>(pair, now.as_ref(), Some((&carried, &nodes)), &normals, sink);
                if let Some(couplings) = &mut couplings {
                    for k in 0..one.len {
                        let a = one.nodes[k];
                        let dp = self.dtraction(a, &responses[a], normals[a]);
                        couplings[a].add_pair::<MOVES>(k, &self.slots(pair), now.as_ref(), pair.previous, dp);
                    }
                    let carried = Some((&carried[..], &responses[..]));
                    self.couple_carried::<MOVES>(pair, now.as_ref(), carried, &normals, couplings);
                }
            }
            self.emit_facet(pairs[0].one, &facet, &normals, sink);
        }
        for a in 0..responses.len() {
            self.emit_node(a, &responses[a].drow_dlambda, sink);
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

    /// The entries of the tangent at (x1, x2), with value 0: as many as [`Contact::tangent`] writes there.
    pub fn pattern(&mut self, x1: &[Vec3], x2: &[Vec3], sink: &mut impl Sink) -> Result<()> {
        self.check_positions(x1, x2)?;
        self.ensure_integration(x1, x2)?;
        let union = self.union();
        self.emit_pattern(&union, sink);
        Ok(())
    }

    /// The entries of any tangent while the surfaces slide by less than a quarter of a facet. A larger motion
    /// may need entries beyond these.
    pub fn superset_pattern(&mut self, x1: &[Vec3], x2: &[Vec3], sink: &mut impl Sink) -> Result<()> {
        self.check_positions(x1, x2)?;
        self.ensure_integration(x1, x2)?;
        let weights = PairWeights::default();
        let pairs = self.possible_pairs(x1, x2)?;
        let any = |&(one, two)| UnionPair { one, two, now: Some(&weights), place: 0, previous: Some(&weights) };
        let all = pairs.iter().map(any);
        self.emit_pattern(&all.collect::<Vec<_>>(), sink);
        Ok(())
    }

    fn emit_pattern(&self, pairs: &[UnionPair], sink: &mut dyn Sink) {
        if self.kernels.moves {
            self.emit_pattern_with::<true>(pairs, sink);
        } else {
            self.emit_pattern_with::<false>(pairs, sink);
        }
    }

    fn emit_pattern_with<const MOVES: bool>(&self, pairs: &[UnionPair], sink: &mut dyn Sink) {
        let (nothing, normals) = (PairTangent::default(), vec![Vec3::zeros(); self.nonmortar.len()]);
        let mut facet = FacetTangent::default();
        let mut couplings = self.augmented_couplings();
        for pairs in pairs.chunk_by(|p, q| p.one == q.one) {
            facet.acts = false;
            for (place, pair) in pairs.iter().enumerate() {
                facet.add(place == 0, pair, &nothing);
                self.emit_pair::<MOVES>(pair, &nothing, &normals, sink);
                self.emit_carried::<MOVES>(pair, None, None, &normals, sink);
                if let Some(couplings) = &mut couplings {
                    let one = &self.nonmortar.facets[pair.one];
                    let now = pair.now.map(|weights| PairNow { weights, gap: None });
                    for k in 0..one.len {
                        let (slots, zero) = (self.slots(pair), (Mat3::zeros(), Mat3::zeros()));
                        couplings[one.nodes[k]].add_pair::<MOVES>(k, &slots, now.as_ref(), pair.previous, zero);
                    }
                    self.couple_carried::<MOVES>(pair, now.as_ref(), None, &normals, couplings);
                }
            }
            self.emit_facet(pairs[0].one, &facet, &normals, sink);
        }
        for a in 0..self.nonmortar.len() {
            self.emit_node(a, &SMatrix::zeros(), sink);
            self.emit_carriers(a, false, sink);
            if let Some(couplings) = &couplings {
                self.emit_couplings(a, &couplings[a], &SMatrix::zeros(), sink);
                self.emit_carried_forces(a, couplings, None, &normals, sink);
            }
        }
    }

    fn augmented_couplings(&self) -> Option<Vec<NodeCouplings>> {
        (self.options.form == Form::Augmented).then(|| vec![NodeCouplings::default(); self.nonmortar.len()])
    }

    fn node_tangents(
        &self,
        lambda: &[SVector<f64, N>],
        responses: &[NodeResponse<N>],
        normals: &[Vec3],
    ) -> Vec<NodeTangent<N>> {
        let node = |a: usize| {
            let (response, scale) = (&responses[a], self.row_scale(a));
            NodeTangent {
                traction: self.force_traction(&lambda[a], response, normals[a]),
                drow_dnow: response.drow_dnow * scale,
                drow_dprevious: response.drow_dprevious * scale,
            }
        };
        (0..responses.len()).map(node).collect()
    }

    /// The nodes in a pair's slots, as indices over both surfaces (mortar after non-mortar).
    pub(super) fn slots(&self, pair: &UnionPair) -> [Option<usize>; PAIR_NODES] {
        let (one, two) = (&self.nonmortar.facets[pair.one], &self.mortar.facets[pair.two]);
        std::array::from_fn(|k| {
            if k < MORTAR {
                (k < one.len).then(|| one.nodes[k])
            } else {
                (k - MORTAR < two.len).then(|| self.nonmortar.len() + two.nodes[k - MORTAR])
            }
        })
    }

    /// Displacement equations of a node over both surfaces.
    pub(super) fn equations(&self, node: usize) -> &[i64; 3] {
        let n1 = self.nonmortar.len();
        if node < n1 { &self.nonmortar.equations[node] } else { &self.mortar.equations[node - n1] }
    }

    /// A pair's rows and columns of the mortar side. `normals`: those of the nodes.
    fn emit_pair<const MOVES: bool>(
        &self,
        pair: &UnionPair,
        t: &PairTangent<N>,
        normals: &[Vec3],
        sink: &mut dyn Sink,
    ) {
        if !MOVES {
            return;
        }
        let (one, two) = (&self.nonmortar.facets[pair.one], &self.mortar.facets[pair.two]);
        let (one, two) = (Equations::of(one, &self.nonmortar.equations), Equations::of(two, &self.mortar.equations));
        let multipliers = self.facet_multipliers(pair.one);
        if pair.now.is_some() && self.options.differentiates_weights() {
            sink.add_block(one.rows(), two.columns(), t.forces.one[MORTAR..].flat());
            sink.add_block(two.rows(), one.columns(), t.forces.two[..MORTAR].flat());
            sink.add_block(two.rows(), two.columns(), t.forces.two[MORTAR..].flat());
        }
        if let (Some(weights), Form::Multiplier) = (pair.now, self.options.form) {
            self.emit_multipliers(pair.one, &two, &weights.ac.map(|row| row.map(|n| -n)), normals, sink);
        }
        sink.add_block(multipliers.as_flattened(), two.columns(), t.rows[MORTAR..].flat());
    }

    /// What a facet's pairs have in common: rows and columns of the non-mortar side.
    fn emit_facet(&self, f: usize, t: &FacetTangent<N>, normals: &[Vec3], sink: &mut dyn Sink) {
        let one = Equations::of(&self.nonmortar.facets[f], &self.nonmortar.equations);
        if t.acts && self.options.differentiates_weights() {
            sink.add_block(one.rows(), one.columns(), t.forces.flat());
        }
        if t.acts && self.options.form == Form::Multiplier {
            self.emit_multipliers(f, &one, &t.weights, normals, sink);
        }
        sink.add_block(self.facet_multipliers(f).as_flattened(), one.columns(), t.rows.flat());
    }

    /// Multiplier equations of a facet's nodes, component by component.
    fn facet_multipliers(&self, f: usize) -> [[i64; MAX_NODES]; N] {
        let facet = &self.nonmortar.facets[f];
        let mut equations = [[NO_EQUATION; MAX_NODES]; N];
        for k in 0..facet.len {
            for n in 0..N {
                equations[n][k] = self.multiplier_equations[facet.nodes[k]][n];
            }
        }
        equations
    }

    /// d forces / d multipliers of facet `f`, weights `n[A][row]`: n I, or n nu_A where there is one component.
    fn emit_multipliers(
        &self,
        f: usize,
        forces: &Equations,
        n: &[[f64; MAX_NODES]; MAX_NODES],
        normals: &[Vec3],
        sink: &mut dyn Sink,
    ) {
        let multipliers = self.facet_multipliers(f);
        if N == 1 {
            let nu = self.nonmortar.facets[f].nodes.map(|a| normals[a]);
            let mut values = [[[0.0; MAX_NODES]; 3]; MAX_NODES];
            for (a, i) in (0..MAX_NODES).flat_map(|a| (0..3).map(move |i| (a, i))) {
                values[a][i] = n[a].map(|n| n * nu[a][i]);
            }
            return sink.add_block(forces.rows(), &multipliers[0], values.as_flattened().as_flattened());
        }
        for i in 0..N {
            sink.add_block(&forces.by_component[i], &multipliers[i], n.as_flattened());
        }
    }

    /// Stage 4: the node's own block, once per node, covered or not.
    fn emit_node(&self, a: usize, drow_dlambda: &SMatrix<f64, N, N>, sink: &mut dyn Sink) {
        if !self.owned[a] {
            return;
        }
        let equations = &self.multiplier_equations[a];
        if self.is_out_of_reach(a) {
            for (i, equation) in equations.iter().enumerate() {
                sink.add_block(&[*equation], &[*equation], &[drow_dlambda[(i, i)] * self.row_scale(a)]);
            }
        } else {
            sink.add_block(equations, equations, (drow_dlambda * self.row_scale(a)).as_slice());
        }
    }

    /// The augmented form's node-wise products n_A. (Dp_A).
    fn emit_couplings(
        &self,
        a: usize,
        couplings: &NodeCouplings,
        dp_dlambda: &SMatrix<f64, 3, N>,
        sink: &mut dyn Sink,
    ) {
        for row in couplings.forces() {
            let equations = self.equations(row.node);
            for column in &couplings.nodes {
                sink.add_block(equations, self.equations(column.node), (column.dtraction * row.weight).as_slice());
            }
            sink.add_block(equations, &self.multiplier_equations[a], (dp_dlambda * row.weight).as_slice());
        }
    }
}

/// At most so many entries has the tangent of these pairs and `nodes` nodes; in the augmented form more.
fn entries<const MOVES: bool, const N: usize>(union: &[UnionPair], nodes: usize) -> usize {
    const COMPONENTS: usize = 3 * MAX_NODES;
    // Rows of the forces and of the multipliers, and columns of the multipliers.
    let (forces, multipliers) = (COMPONENTS * COMPONENTS, COMPONENTS * MAX_NODES * (N + 1));
    let pair = if MOVES { 3 * forces + multipliers } else { 0 };
    let facets = union.chunk_by(|p, q| p.one == q.one).count();
    union.len() * pair + facets * (forces + multipliers) + nodes * N * N
}

/// What the pairs of a non-mortar facet add to the same entries of the tangent.
struct FacetTangent<const N: usize> {
    forces: [[[[f64; MAX_NODES]; 3]; 3]; MAX_NODES],
    rows: [[[[f64; MAX_NODES]; N]; 3]; MAX_NODES],
    weights: [[f64; MAX_NODES]; MAX_NODES],
    /// Whether a pair is active now.
    acts: bool,
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
    /// Adds a pair's share, or begins with the `first` one.
    fn add(&mut self, first: bool, pair: &UnionPair, t: &PairTangent<N>) {
        simd::dispatch(Add { first, sum: self.rows.flat_mut(), values: t.rows[..MORTAR].flat() });
        if let Some(weights) = pair.now {
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

/// Displacement equations of a facet's nodes in the orders of a tangent's blocks.
pub(super) struct Equations {
    by_node: [[i64; 3]; MAX_NODES],
    by_component: [[i64; MAX_NODES]; 3],
}

impl Equations {
    pub fn of(facet: &FacetNodes, equations: &[[i64; 3]]) -> Equations {
        let mut e = Equations { by_node: [[NO_EQUATION; 3]; MAX_NODES], by_component: [[NO_EQUATION; MAX_NODES]; 3] };
        for k in 0..facet.len {
            e.by_node[k] = equations[facet.nodes[k]];
            for i in 0..3 {
                e.by_component[i][k] = e.by_node[k][i];
            }
        }
        e
    }

    fn rows(&self) -> &[i64] {
        self.by_component.as_flattened()
    }

    pub fn columns(&self) -> &[i64] {
        self.by_node.as_flattened()
    }
}

/// The values of nested arrays, one after the other.
trait Flat {
    fn flat(&self) -> &[f64];
    fn flat_mut(&mut self) -> &mut [f64];
}

impl<const I: usize, const J: usize, const K: usize> Flat for [[[[f64; I]; J]; K]] {
    fn flat(&self) -> &[f64] {
        self.as_flattened().as_flattened().as_flattened()
    }
    fn flat_mut(&mut self) -> &mut [f64] {
        self.as_flattened_mut().as_flattened_mut().as_flattened_mut()
    }
}
