//! Stages 3 and 4 over a whole interface: residual and tangent in the host's numbering.
//!
//! The tangent is written to a sink as (row, column, value); entries without an equation are left out
//! and duplicates add up. Which entries appear depends on the active pairs, never on the values, so a
//! count and a fill always agree.

use super::augmented::NodeCouplings;
use super::history::PairRecord;
use super::nodes::NodeSums;
use super::{Contact, Form, NO_EQUATION, Weights, effects};
use crate::element::{NodeTangent, PairNow, PairTangent, pair_force};
use crate::error::{Error, Kind, Result};
use crate::geometry::{Mat3, Vec3};
use crate::law::NodeResponse;
use crate::mortar::{MORTAR, PAIR_NODES, PairWeights, WeightDerivatives, slots};
use nalgebra::{SMatrix, SVector};
use std::time::Instant;

/// Takes a tangent entry: (row equation, column equation, value).
pub trait Sink {
    /// Adds `value` at (row, column), both 0-based equations.
    fn add(&mut self, row: i64, column: i64, value: f64);

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
    pub previous: Option<&'a PairWeights>,
}

impl<'a> UnionPair<'a> {
    fn now(pair: &'a PairRecord) -> UnionPair<'a> {
        UnionPair { one: pair.one, two: pair.two, now: Some(&pair.weights), previous: None }
    }
}

impl<const N: usize> Contact<N> {
    /// The union of the pairs active now and, where slip counts, of those of t_n, sorted.
    fn union(&self) -> Vec<UnionPair<'_>> {
        if self.is_apart() {
            return Vec::new();
        }
        if !self.kernels.slips {
            return self.current_pairs().iter().map(UnionPair::now).collect();
        }
        let (mut now, mut previous) = (self.current_pairs().iter().peekable(), self.history.pairs.iter().peekable());
        let mut union = Vec::with_capacity(now.len().max(previous.len()));
        loop {
            let heads = [now.peek(), previous.peek()];
            let Some((one, two)) = heads.into_iter().flatten().map(|p| (p.one, p.two)).min() else { return union };
            let n = now.next_if(|p| (p.one, p.two) == (one, two));
            let p = previous.next_if(|p| (p.one, p.two) == (one, two));
            union.push(UnionPair { one, two, now: n.map(|p| &p.weights), previous: p.map(|p| &p.weights) });
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
        let responses = self.responses(x1, x2, lambda, sums)?;
        let start = Instant::now();
        let mut linearised = 0;
        let mut couplings = self.augmented_couplings();
        let normals = self.all_normals()?;
        let nodes = self.node_tangents(lambda, &responses, &normals);
        // Large, so that one of each serves all pairs.
        let (mut dn, mut t) = (WeightDerivatives::default(), PairTangent::default());
        for pair in &self.union() {
            let one = &self.nonmortar.facets[pair.one];
            let mut gap = None;
            if let (Some(weights), Some(k)) = (pair.now, &self.integration) {
                let facet = (&k.frames[pair.one], weights);
                gap = Some((self.kernels.motion)((&self.mortar, x2), pair.two, facet, self.options.rule, &mut dn)?);
                linearised += 1;
            }
            let motion = gap.as_ref().map(|gap| (&dn, gap));
            let now = pair.now.map(|weights| PairNow { weights, motion });
            t.update::<MOVES>(now.as_ref(), pair.previous, &one.nodes.map(|a| nodes[a]));
            self.emit_pair::<MOVES>(pair, &t, &normals, sink);
            if let Some(couplings) = &mut couplings {
                for k in 0..one.len {
                    let a = one.nodes[k];
                    couplings[a].add_pair::<MOVES>(
                        k,
                        &self.slots(pair),
                        now.as_ref(),
                        pair.previous,
                        self.dtraction(a, &responses[a], normals[a]),
                    );
                }
            }
        }
        for a in 0..responses.len() {
            self.emit_node(a, &responses[a].drow_dlambda, sink);
            if let Some(couplings) = &couplings {
                self.emit_couplings(a, &couplings[a], &responses[a].dp_dlambda, sink);
            }
        }
        self.counters.pairs_linearised += linearised;
        self.counters.seconds_assembly += start.elapsed().as_secs_f64();
        Ok(())
    }

    /// dp/dg_now and dp/dg_previous of a node.
    fn dtraction(&self, a: usize, response: &NodeResponse<N>, nu: Vec3) -> (Mat3, Mat3) {
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
        let all = pairs.iter().map(|&(one, two)| UnionPair { one, two, now: Some(&weights), previous: Some(&weights) });
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
        let mut couplings = self.augmented_couplings();
        for pair in pairs {
            self.emit_pair::<MOVES>(pair, &nothing, &normals, sink);
            if let Some(couplings) = &mut couplings {
                let one = &self.nonmortar.facets[pair.one];
                let now = pair.now.map(|weights| PairNow { weights, motion: None });
                for k in 0..one.len {
                    let zero = (Mat3::zeros(), Mat3::zeros());
                    couplings[one.nodes[k]].add_pair::<MOVES>(k, &self.slots(pair), now.as_ref(), pair.previous, zero);
                }
            }
        }
        for a in 0..self.nonmortar.len() {
            self.emit_node(a, &SMatrix::zeros(), sink);
            if let Some(couplings) = &couplings {
                self.emit_couplings(a, &couplings[a], &SMatrix::zeros(), sink);
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
    fn slots(&self, pair: &UnionPair) -> [Option<usize>; PAIR_NODES] {
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
    fn equations(&self, node: usize) -> &[i64; 3] {
        let n1 = self.nonmortar.len();
        if node < n1 { &self.nonmortar.equations[node] } else { &self.mortar.equations[node - n1] }
    }

    /// `normals`: those of the nodes.
    fn emit_pair<const MOVES: bool>(
        &self,
        pair: &UnionPair,
        t: &PairTangent<N>,
        normals: &[Vec3],
        sink: &mut dyn Sink,
    ) {
        let nodes = self.slots(pair);
        let one = &self.nonmortar.facets[pair.one];
        let current = self.options.effective_weights() == Weights::Current;
        for (k, node) in nodes[..slots(MOVES)].iter().enumerate() {
            let Some(node) = *node else { continue };
            let equations = self.equations(node);
            if pair.now.is_some() && current {
                for (j, column) in nodes[..slots(MOVES)].iter().enumerate() {
                    let Some(column) = *column else { continue };
                    sink.add_block(equations, self.equations(column), t.force_x[k][j].as_slice());
                }
            }
            for a in 0..one.len {
                let multiplier = &self.multiplier_equations[one.nodes[a]];
                if pair.now.is_some() && self.options.form == Form::Multiplier {
                    emit_multiplier(multiplier, equations, t.force_lambda[k][a], normals[one.nodes[a]], sink);
                }
                sink.add_block(multiplier, equations, t.row_x[a][k].as_slice());
            }
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

/// A node's force by a multiplier: `weight` I, or `weight` nu where there is one component.
fn emit_multiplier<const N: usize>(
    multiplier: &[i64; N],
    equations: &[i64; 3],
    weight: f64,
    nu: Vec3,
    sink: &mut dyn Sink,
) {
    if N == 1 {
        return sink.add_block(equations, multiplier, (nu * weight).as_slice());
    }
    for i in 0..3 {
        if equations[i] != NO_EQUATION && multiplier[i] != NO_EQUATION {
            sink.add(equations[i], multiplier[i], weight);
        }
    }
}
