//! How the tangent leaves: its blocks as entries in the host's numbering.
//!
//! Entries without an equation are left out and duplicates add up. Which entries appear depends on the active pairs,
//! never on the values, so a count and a fill always agree.

use super::augmented::NodeCouplings;
use super::facet_tangent::{FacetNow, Flat};
use super::union::UnionPair;
use crate::element::PairTangent;
use crate::geometry::Vec3;
use crate::interface::data::extent::Extent;
use crate::interface::data::options::{Form, MultiplierBasis};
use crate::interface::data::surface::{FacetNodes, NO_EQUATION, node_equations};
use crate::interface::pairing::given::Given;
use crate::interface::stages::node::is_out_of_reach;
use crate::mortar::MORTAR;
use crate::shape::{MAX_CORNERS, MAX_NODES};
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

/// Who takes a tangent, and of a condensed system its constraints: see [`Emitter`].
pub type Sinks<'a> = (&'a mut dyn Sink, Option<&'a mut dyn Sink>);

impl<F: FnMut(i64, i64, f64)> Sink for F {
    fn add(&mut self, row: i64, column: i64, value: f64) {
        self(row, column, value);
    }
}

/// At most so many entries has the tangent of these pairs and `nodes` nodes; in the augmented form more.
pub fn entries<const MOVES: bool, const N: usize>(union: &[UnionPair], nodes: usize) -> usize {
    const COMPONENTS: usize = 3 * MAX_NODES;
    // Rows of the forces and of the multipliers, and columns of the multipliers.
    let (forces, multipliers) = (COMPONENTS * COMPONENTS, COMPONENTS * MAX_CORNERS * (N + 1));
    let pair = if MOVES { 3 * forces + multipliers } else { 0 };
    let facets = union.chunk_by(|p, q| p.one == q.one).count();
    union.len() * pair + facets * (forces + multipliers) + nodes * N * N
}

/// Where the blocks of a tangent go.
pub struct Emitter<'a, 's, const N: usize> {
    /// The interface and its step.
    pub given: Given<'a, N>,
    /// nu of every node; zeros for the pattern alone.
    pub normals: &'a [Vec3],
    /// Who takes the entries.
    pub sink: &'s mut dyn Sink,
    /// Of a condensed system: who takes s_A Dc_A / Dx in the rows of node A's displacements. `sink` then takes what the
    /// forces depend on the displacements by, and there are no multipliers.
    pub constraints: Option<&'s mut dyn Sink>,
}

// Not inlined: tangents with and without a moving mortar side share these functions.
impl<'a, const N: usize> Emitter<'a, '_, N> {
    /// Displacement equations of a node over both surfaces.
    pub fn equations(&self, node: usize) -> &'a [i64; 3] {
        node_equations(self.given.setup.surfaces(), node)
    }

    /// Those of a non-mortar facet.
    pub fn facet_equations(&self, f: usize) -> Equations {
        let one = &self.given.setup.nonmortar;
        Equations::of(&one.facets[f], &one.equations)
    }

    /// Those of a mortar facet.
    pub fn mortar_equations(&self, f: usize) -> Equations {
        let two = &self.given.setup.mortar;
        Equations::of(&two.facets[f], &two.equations)
    }

    /// A pair's rows and columns of the mortar side; with dual multipliers forces on it are the facet's (`dual_facet.rs`).
    #[inline(never)]
    pub fn pair(&mut self, pair: &UnionPair, t: &PairTangent<N>) {
        let (one, two) = (self.facet_equations(pair.one), self.mortar_equations(pair.two));
        if pair.now.is_some() && self.given.setup.options.differentiates_weights() {
            self.sink.add_block(one.rows(), two.columns(), t.forces.one[MORTAR..].flat());
            if self.given.setup.options.basis == MultiplierBasis::Standard {
                self.sink.add_block(two.rows(), one.columns(), t.forces.two[..MORTAR].flat());
                self.sink.add_block(two.rows(), two.columns(), t.forces.two[MORTAR..].flat());
            }
        }
        if let (Some(weights), Form::Multiplier) = (pair.now, self.given.setup.options.form) {
            self.multipliers(pair.one, &two, &weights.ac.map(|row| row.map(|n| -n)));
        }
        self.facet_rows(pair.one, two.columns(), t.rows[MORTAR..].flat());
    }

    /// What a facet's pairs have in common: rows and columns of the non-mortar side. `now`: of the pairs active now.
    #[inline(never)]
    pub fn facet(&mut self, f: usize, now: Option<FacetNow>, rows: &[[[[f64; MAX_CORNERS]; N]; 3]]) {
        let one = self.facet_equations(f);
        if let Some((forces, weights)) = now {
            if self.given.setup.options.differentiates_weights() {
                self.sink.add_block(one.rows(), one.columns(), forces.flat());
            }
            if self.given.setup.options.form == Form::Multiplier {
                self.multipliers(f, &one, weights);
            }
        }
        self.facet_rows(f, one.columns(), rows.flat());
    }

    /// Derivatives of the rows of a facet's multipliers, in each column component by component.
    #[inline(never)]
    pub fn facet_rows(&mut self, f: usize, columns: &[i64], values: &[f64]) {
        match &mut self.constraints {
            None => self.sink.add_block(self.facet_multipliers(f).as_flattened(), columns, values),
            Some(sink) => {
                let facet = &self.given.setup.nonmortar.facets[f];
                let equations = Equations::of(facet, &self.given.setup.nonmortar.equations);
                let normals = facet.nodes.map(|a| self.normals[a]);
                in_space::<N, MAX_CORNERS>(&equations.by_component, &normals, columns, values, *sink);
            }
        }
    }

    /// The same of node A alone.
    #[inline(never)]
    pub fn node_rows(&mut self, a: usize, columns: &[i64], values: &[f64]) {
        let setup = self.given.setup;
        match &mut self.constraints {
            None => self.sink.add_block(&setup.multiplier_equations[a], columns, values),
            Some(sink) => {
                let equations = setup.nonmortar.equations[a].map(|e| [e]);
                in_space::<N, 1>(&equations, &[self.normals[a]], columns, values, *sink);
            }
        }
    }

    /// Multiplier equations of a facet's nodes, component by component.
    fn facet_multipliers(&self, f: usize) -> [[i64; MAX_CORNERS]; N] {
        let facet = &self.given.setup.nonmortar.facets[f];
        let mut equations = [[NO_EQUATION; MAX_CORNERS]; N];
        for k in 0..facet.len {
            for n in 0..N {
                equations[n][k] = self.given.setup.multiplier_equations[facet.nodes[k]][n];
            }
        }
        equations
    }

    /// d forces / d multipliers of facet `f`, weights `n[A][row]`: n I, or n nu_A where there is one component.
    #[inline(never)]
    fn multipliers(&mut self, f: usize, forces: &Equations, n: &[[f64; MAX_NODES]; MAX_CORNERS]) {
        if self.constraints.is_some() {
            return;
        }
        let multipliers = self.facet_multipliers(f);
        if N == 1 {
            let nu = self.given.setup.nonmortar.facets[f].nodes.map(|a| self.normals[a]);
            let mut values = [[[0.0; MAX_NODES]; 3]; MAX_CORNERS];
            for (a, i) in (0..MAX_CORNERS).flat_map(|a| (0..3).map(move |i| (a, i))) {
                values[a][i] = n[a].map(|n| n * nu[a][i]);
            }
            return self.sink.add_block(forces.rows(), &multipliers[0], values.as_flattened().as_flattened());
        }
        for i in 0..N {
            self.sink.add_block(&forces.by_component[i], &multipliers[i], n.as_flattened());
        }
    }

    /// Stage 4: the node's own block, once per node, covered or not.
    #[inline(never)]
    pub fn node(&mut self, a: usize, drow_dlambda: &SMatrix<f64, N, N>, extent: Extent) {
        let setup = self.given.setup;
        if !setup.nodes.owned[a] || self.constraints.is_some() {
            return;
        }
        let equations = &setup.multiplier_equations[a];
        if is_out_of_reach(self.given, a, extent) {
            for (i, equation) in equations.iter().enumerate() {
                self.sink.add_block(&[*equation], &[*equation], &[drow_dlambda[(i, i)] * self.given.row_scale(a)]);
            }
        } else {
            self.sink.add_block(equations, equations, (drow_dlambda * self.given.row_scale(a)).as_slice());
        }
    }

    /// Node-wise products n_A. (Dp_A), of the augmented form with the multipliers' columns.
    #[inline(never)]
    pub fn couplings(&mut self, a: usize, couplings: &NodeCouplings, dp_dlambda: &SMatrix<f64, 3, N>) {
        for row in couplings.forces() {
            let equations = self.equations(row.node);
            for column in couplings.places() {
                let columns = self.equations(column.node);
                self.sink.add_block(equations, columns, (column.dtraction * row.weight).as_slice());
            }
            if self.given.setup.options.form == Form::Multiplier {
                continue;
            }
            let multipliers = &self.given.setup.multiplier_equations[a];
            self.sink.add_block(equations, multipliers, (dp_dlambda * row.weight).as_slice());
        }
    }
}

/// Gives rows of multipliers to the displacements of their nodes, `equations[i][A]`: component by component, or along the
/// normal.
fn in_space<const N: usize, const A: usize>(
    equations: &[[i64; A]; 3],
    normals: &[Vec3; A],
    columns: &[i64],
    values: &[f64],
    sink: &mut dyn Sink,
) {
    let rows = equations.as_flattened();
    if N == 3 {
        return sink.add_block(rows, columns, values);
    }
    for (column, values) in columns.iter().zip(values.chunks_exact(A)) {
        let along: [[f64; A]; 3] = std::array::from_fn(|i| std::array::from_fn(|a| values[a] * normals[a][i]));
        sink.add_block(rows, &[*column], along.as_flattened());
    }
}

/// Displacement equations of a facet's nodes in the orders of a tangent's blocks.
pub struct Equations {
    by_node: [[i64; 3]; MAX_NODES],
    by_component: [[i64; MAX_NODES]; 3],
}

impl Equations {
    /// Of a facet.
    #[inline(never)]
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

    /// As rows.
    pub fn rows(&self) -> &[i64] {
        self.by_component.as_flattened()
    }

    /// As columns.
    pub fn columns(&self) -> &[i64] {
        self.by_node.as_flattened()
    }
}
