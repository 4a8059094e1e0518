//! Stages 3 and 4 over a whole interface: residual and tangent in the host's numbering.
//!
//! The tangent is written to a sink as (row, column, value); entries without an equation are left out
//! and duplicates add up. Which entries appear depends on the active pairs, never on the values, so a
//! count and a fill always agree.

use super::augmented::NodeCouplings;
use super::nodes::NodeSums;
use super::{Form, Interface, NO_EQUATION, Weights};
use crate::element::{NodeTangent, PairNow, PairTangent, pair_force};
use crate::error::{Error, Kind, Result};
use crate::geometry::{Mat3, Vec3};
use crate::law::NodeResponse;
use crate::mortar::{GapDerivative, MORTAR, PAIR_NODES, PairWeights, Segment, WeightDerivatives};
use crate::shape::MAX_NODES;
use std::time::Instant;

/// Takes a tangent entry: (row equation, column equation, value).
pub trait Sink {
    /// Adds `value` at (row, column), both 0-based equations.
    fn add(&mut self, row: i64, column: i64, value: f64);

    /// Adds a 3 x 3 block.
    fn add_block(&mut self, rows: &[i64; 3], columns: &[i64; 3], block: &Mat3) {
        for i in 0..3 {
            for j in 0..3 {
                if rows[i] != NO_EQUATION && columns[j] != NO_EQUATION {
                    self.add(rows[i], columns[j], block[(i, j)]);
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
pub struct Residual {
    /// Internal forces at the non-mortar nodes `[F]`; the force ON the body is the negative.
    pub nonmortar: Vec<Vec3>,
    /// Internal forces at the mortar nodes `[F]`.
    pub mortar: Vec<Vec3>,
    /// Multiplier rows (`[F]` or [L^3], see the row scale).
    pub rows: Vec<Vec3>,
}

/// A pair of the union of those active now and those of t_n.
pub(super) struct UnionPair<'a> {
    pub one: usize,
    pub two: usize,
    pub now: Option<&'a PairWeights>,
    pub previous: Option<&'a PairWeights>,
}

impl Interface {
    /// The union of the pairs active now and of those of t_n, sorted.
    fn union(&self) -> Vec<UnionPair<'_>> {
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
        lambda: &[Vec3],
        sums: Option<&[NodeSums]>,
    ) -> Result<Residual> {
        let responses = self.responses(x1, x2, lambda, sums)?;
        let mut r = Residual {
            nonmortar: vec![Vec3::zeros(); self.nonmortar.len()],
            mortar: vec![Vec3::zeros(); self.mortar.len()],
            rows: vec![Vec3::zeros(); self.nonmortar.len()],
        };
        for pair in self.current_pairs() {
            let (one, two) = (&self.nonmortar.facets[pair.one], &self.mortar.facets[pair.two]);
            let f = pair_force(&pair.weights, &one.nodes.map(|a| self.force_traction(lambda[a], &responses[a])));
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

    /// The traction that a node's forces use.
    fn force_traction(&self, lambda: Vec3, response: &NodeResponse) -> Vec3 {
        match self.options.form {
            Form::Multiplier => lambda,
            Form::Augmented => response.traction,
        }
    }

    /// The exact tangent d residual / d (x1, x2, lambda) at (x, lambda).
    pub fn tangent(
        &mut self,
        x1: &[Vec3],
        x2: &[Vec3],
        lambda: &[Vec3],
        sums: Option<&[NodeSums]>,
        sink: &mut impl Sink,
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
        for pair in &self.union() {
            let one = &self.nonmortar.facets[pair.one];
            let nodes = self.node_tangents(pair.one, lambda, &responses);
            let mut derivatives = WeightDerivatives::default();
            let gap = match (pair.now, &self.integration) {
                (Some(weights), Some(k)) => {
                    let frame = &k.frames[pair.one];
                    let segment = Segment::new(frame, &self.mortar.facet(pair.two, x2))?
                        .expect("an active pair has a segment at the positions it was found at");
                    derivatives = WeightDerivatives::integrate(frame, &segment, self.options.rule);
                    linearised += 1;
                    Some(GapDerivative::current(frame, &segment.mortar, weights, &derivatives))
                }
                (now, _) => now.map(GapDerivative::frozen),
            };
            let dn = self.integration.is_some().then_some(&derivatives);
            let now = pair.now.zip(gap.as_ref()).map(|(weights, gap)| PairNow { weights, derivatives: dn, gap });
            self.emit_pair(pair, &PairTangent::new(now.as_ref(), pair.previous, &nodes), sink);
            if let Some(couplings) = &mut couplings {
                for k in 0..one.len {
                    let a = one.nodes[k];
                    let r = self.augmentation(a);
                    let scaled = (responses[a].drow_dnow * r, responses[a].drow_dprevious * r);
                    couplings[a].add_pair(k, &self.slots(pair), now.as_ref(), pair.previous, scaled);
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

    /// The entries of the tangent at (x1, x2), with value 0: as many as [`Interface::tangent`] writes there.
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

    fn emit_pattern(&self, pairs: &[UnionPair], sink: &mut impl Sink) {
        let mut couplings = self.augmented_couplings();
        for pair in pairs {
            self.emit_pair(pair, &PairTangent::default(), sink);
            if let Some(couplings) = &mut couplings {
                let one = &self.nonmortar.facets[pair.one];
                let gap = pair.now.map(GapDerivative::frozen);
                let now = pair.now.zip(gap.as_ref()).map(|(weights, gap)| PairNow { weights, derivatives: None, gap });
                for k in 0..one.len {
                    let zero = (Mat3::zeros(), Mat3::zeros());
                    couplings[one.nodes[k]].add_pair(k, &self.slots(pair), now.as_ref(), pair.previous, zero);
                }
            }
        }
        for a in 0..self.nonmortar.len() {
            self.emit_node(a, &Mat3::zeros(), sink);
            if let Some(couplings) = &couplings {
                self.emit_couplings(a, &couplings[a], &Mat3::zeros(), sink);
            }
        }
    }

    fn augmented_couplings(&self) -> Option<Vec<NodeCouplings>> {
        (self.options.form == Form::Augmented).then(|| vec![NodeCouplings::default(); self.nonmortar.len()])
    }

    fn node_tangents(&self, facet: usize, lambda: &[Vec3], responses: &[NodeResponse]) -> [NodeTangent; MAX_NODES] {
        self.nonmortar.facets[facet].nodes.map(|a| {
            let (response, scale) = (&responses[a], self.row_scale(a));
            NodeTangent {
                traction: self.force_traction(lambda[a], response),
                drow_dnow: response.drow_dnow * scale,
                drow_dprevious: response.drow_dprevious * scale,
            }
        })
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

    fn emit_pair(&self, pair: &UnionPair, t: &PairTangent, sink: &mut impl Sink) {
        let slots = self.slots(pair);
        let one = &self.nonmortar.facets[pair.one];
        let moves = self.options.weights == Weights::Current;
        for (k, node) in slots.iter().enumerate() {
            let Some(node) = *node else { continue };
            let equations = self.equations(node);
            if pair.now.is_some() && moves {
                for (j, column) in slots.iter().enumerate() {
                    let Some(column) = *column else { continue };
                    sink.add_block(equations, self.equations(column), &t.force_x[k][j]);
                }
            }
            for a in 0..one.len {
                let multiplier = &self.multiplier_equations[one.nodes[a]];
                if pair.now.is_some() && self.options.form == Form::Multiplier {
                    for i in 0..3 {
                        if equations[i] != NO_EQUATION && multiplier[i] != NO_EQUATION {
                            sink.add(equations[i], multiplier[i], t.force_lambda[k][a]);
                        }
                    }
                }
                sink.add_block(multiplier, equations, &t.row_x[a][k]);
            }
        }
    }

    /// Stage 4: the node's own block, once per node, covered or not.
    fn emit_node(&self, a: usize, drow_dlambda: &Mat3, sink: &mut impl Sink) {
        if self.owned[a] {
            let equations = &self.multiplier_equations[a];
            sink.add_block(equations, equations, &(drow_dlambda * self.row_scale(a)));
        }
    }

    /// The augmented form's node-wise products n_A. (Dp_A).
    fn emit_couplings(&self, a: usize, couplings: &NodeCouplings, dp_dlambda: &Mat3, sink: &mut impl Sink) {
        for row in couplings.forces() {
            let equations = self.equations(row.node);
            for column in &couplings.nodes {
                sink.add_block(equations, self.equations(column.node), &(column.dtraction * row.weight));
            }
            sink.add_block(equations, &self.multiplier_equations[a], &(dp_dlambda * row.weight));
        }
    }
}
