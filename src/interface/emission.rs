//! How the tangent leaves: its blocks as entries in the host's numbering, and which entries there are.
//!
//! Entries without an equation are left out and duplicates add up. Which entries appear depends on the active pairs,
//! never on the values, so a count and a fill always agree.

use super::assembly::{FacetNow, FacetTangent, UnionPair};
use super::augmented::NodeCouplings;
use super::{Contact, Extent, FacetNodes, Form, NO_EQUATION};
use crate::element::{PairNow, PairTangent};
use crate::error::Result;
use crate::geometry::{Mat3, Vec3};
use crate::memory::{self, Stored};
use crate::mortar::{MORTAR, PAIR_NODES, PairWeights};
use crate::shape::MAX_NODES;
use nalgebra::SMatrix;

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

impl<const N: usize> Contact<N> {
    /// The entries of the tangent at (x1, x2), with value 0: as many as [`Contact::tangent`] writes there, without sums
    /// (`Whole`) or with those of all handles.
    pub fn pattern(&mut self, x1: &[Vec3], x2: &[Vec3], extent: Extent, sink: &mut impl Sink) -> Result<()> {
        self.check_positions(x1, x2)?;
        self.ensure_integration(x1, x2, extent)?;
        let union = self.union()?;
        self.emit_pattern(&union, extent, sink)
    }

    /// The entries of any tangent, with sums or without, while the surfaces slide by less than a quarter of a facet. A
    /// larger motion may need entries beyond these.
    pub fn superset_pattern(&mut self, x1: &[Vec3], x2: &[Vec3], sink: &mut impl Sink) -> Result<()> {
        self.check_positions(x1, x2)?;
        self.ensure_integration(x1, x2, Extent::Whole)?; // refuses what an evaluation here does, and serves the next one
        let weights = PairWeights::default();
        let pairs = self.possible_pairs(x1, x2)?;
        let any = |&(one, two)| UnionPair { one, two, now: Some(&weights), place: 0, previous: Some(&weights) };
        let all = pairs.iter().map(any);
        self.emit_pattern(&all.stored()?, Extent::Part, sink)
    }

    fn emit_pattern(&self, pairs: &[UnionPair], extent: Extent, sink: &mut dyn Sink) -> Result<()> {
        if self.kernels.moves {
            self.emit_pattern_with::<true>(pairs, extent, sink)
        } else {
            self.emit_pattern_with::<false>(pairs, extent, sink)
        }
    }

    fn emit_pattern_with<const MOVES: bool>(
        &self,
        pairs: &[UnionPair],
        extent: Extent,
        sink: &mut dyn Sink,
    ) -> Result<()> {
        let (nothing, normals) = (PairTangent::default(), memory::filled(Vec3::zeros(), self.nonmortar.len())?);
        let mut facet = FacetTangent::default();
        let mut couplings = self.augmented_couplings()?;
        for pairs in pairs.chunk_by(|p, q| p.one == q.one) {
            facet.acts = pairs.iter().any(|pair| pair.now.is_some());
            for pair in pairs {
                if MOVES {
                    self.emit_pair(pair, &nothing, &normals, sink);
                }
                self.emit_carried::<MOVES>(pair, None, None, &normals, sink);
                if let Some(couplings) = &mut couplings {
                    let one = &self.nonmortar.facets[pair.one];
                    let now = pair.now.map(|weights| PairNow { weights, gap: None });
                    for k in 0..one.len {
                        let (slots, zero) = (self.slots(pair), (Mat3::zeros(), Mat3::zeros()));
                        couplings[one.nodes[k]].add_pair::<MOVES>(k, &slots, now.as_ref(), pair.previous, zero)?;
                    }
                    self.couple_carried::<MOVES>(pair, now.as_ref(), None, &normals, couplings)?;
                }
            }
            self.emit_facet(pairs[0].one, facet.now(), &facet.rows, &normals, sink);
        }
        for a in 0..self.nonmortar.len() {
            self.emit_node(a, &SMatrix::zeros(), extent, sink);
            self.emit_carriers(a, false, sink);
            if let Some(couplings) = &couplings {
                self.emit_couplings(a, &couplings[a], &SMatrix::zeros(), sink);
                self.emit_carried_forces(a, couplings, None, &normals, sink);
            }
        }
        Ok(())
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
    pub(super) fn emit_pair(&self, pair: &UnionPair, t: &PairTangent<N>, normals: &[Vec3], sink: &mut dyn Sink) {
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

    /// What a facet's pairs have in common: rows and columns of the non-mortar side. `now`: of the pairs active now.
    pub(super) fn emit_facet(
        &self,
        f: usize,
        now: Option<FacetNow>,
        rows: &[[[[f64; MAX_NODES]; N]; 3]],
        normals: &[Vec3],
        sink: &mut dyn Sink,
    ) {
        let one = Equations::of(&self.nonmortar.facets[f], &self.nonmortar.equations);
        if let Some((forces, weights)) = now {
            if self.options.differentiates_weights() {
                sink.add_block(one.rows(), one.columns(), forces.flat());
            }
            if self.options.form == Form::Multiplier {
                self.emit_multipliers(f, &one, weights, normals, sink);
            }
        }
        sink.add_block(self.facet_multipliers(f).as_flattened(), one.columns(), rows.flat());
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
    pub(super) fn emit_node(&self, a: usize, drow_dlambda: &SMatrix<f64, N, N>, extent: Extent, sink: &mut dyn Sink) {
        if !self.owned[a] {
            return;
        }
        let equations = &self.multiplier_equations[a];
        if self.is_out_of_reach(a, extent) {
            for (i, equation) in equations.iter().enumerate() {
                sink.add_block(&[*equation], &[*equation], &[drow_dlambda[(i, i)] * self.row_scale(a)]);
            }
        } else {
            sink.add_block(equations, equations, (drow_dlambda * self.row_scale(a)).as_slice());
        }
    }

    /// The augmented form's node-wise products n_A. (Dp_A).
    pub(super) fn emit_couplings(
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
pub(super) fn entries<const MOVES: bool, const N: usize>(union: &[UnionPair], nodes: usize) -> usize {
    const COMPONENTS: usize = 3 * MAX_NODES;
    // Rows of the forces and of the multipliers, and columns of the multipliers.
    let (forces, multipliers) = (COMPONENTS * COMPONENTS, COMPONENTS * MAX_NODES * (N + 1));
    let pair = if MOVES { 3 * forces + multipliers } else { 0 };
    let facets = union.chunk_by(|p, q| p.one == q.one).count();
    union.len() * pair + facets * (forces + multipliers) + nodes * N * N
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
pub(super) trait Flat {
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
