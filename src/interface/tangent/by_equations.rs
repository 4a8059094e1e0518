//! The tangent's blocks entry by entry, in the host's equations. Entries without an equation are left out, and duplicates add
//! up. For those who look at a tangent: what solves with it takes a plan.

use super::emission::{Blocks, Directions, MortarBlock, Place, Span, Weights};
use crate::geometry::Vec3;
use crate::interface::data::facet_nodes::FacetNodes;
use crate::interface::data::setup::Setup;
use crate::interface::data::surface::NO_EQUATION;
use crate::shape::{MAX_CORNERS, MAX_NODES};

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

/// The equations of the displacements of both sides, and of the multipliers.
#[derive(Clone, Copy)]
pub struct Numbers<'a, const N: usize> {
    /// Of the nodes of both sides.
    pub sides: [&'a [[i64; 3]]; 2],
    /// Of the non-mortar nodes.
    pub multipliers: &'a [[i64; N]],
}

impl<'a, const N: usize> Numbers<'a, N> {
    /// The host's.
    pub fn of(setup: &'a Setup<N>) -> Self {
        let (one, two) = setup.surfaces();
        Numbers { sides: [&one.equations, &two.equations], multipliers: &setup.multiplier_equations }
    }

    /// Of a place.
    pub fn place(&self, place: Place) -> &'a [i64] {
        match place {
            Place::Displacement(node) => match node.checked_sub(self.sides[0].len()) {
                None => &self.sides[0][node],
                Some(c) => &self.sides[1][c],
            },
            Place::Multiplier(a) => &self.multipliers[a],
        }
    }
}

/// Gives blocks to a [`Sink`].
pub struct ByEquations<'a, const N: usize> {
    setup: &'a Setup<N>,
    numbers: Numbers<'a, N>,
    sink: &'a mut dyn Sink,
    facet: usize,
    own: Equations,
}

impl<'a, const N: usize> ByEquations<'a, N> {
    /// To this one, by these numbers.
    pub fn new(setup: &'a Setup<N>, numbers: Numbers<'a, N>, sink: &'a mut dyn Sink) -> Self {
        ByEquations { setup, numbers, sink, facet: 0, own: Equations::none() }
    }

    fn span(&self, span: Span) -> Equations {
        let two = self.numbers.sides[1];
        match span {
            Span::Own => self.own,
            Span::Mortar(j) => Equations::of(&self.setup.mortar.facets[j], two),
            Span::Group(nodes) => Equations::of(&nodes, two),
        }
    }

    /// Equations of rows; a multiplier that acts elsewhere has none here.
    fn row_of(&self, place: Place) -> &'a [i64] {
        match place {
            Place::Multiplier(a) if !self.setup.nodes.acts(a) => &[NO_EQUATION; 3][..N],
            _ => self.numbers.place(place),
        }
    }

    /// Multiplier equations of the facet's nodes, component by component, of those that act here.
    fn facet_multipliers(&self) -> [[i64; MAX_CORNERS]; N] {
        let facet = &self.setup.nonmortar.facets[self.facet];
        let mut equations = [[NO_EQUATION; MAX_CORNERS]; N];
        for (k, &a) in facet.as_slice().iter().enumerate().filter(|(_, a)| self.setup.nodes.acts(**a)) {
            for n in 0..N {
                equations[n][k] = self.numbers.multipliers[a][n];
            }
        }
        equations
    }
}

impl<const N: usize> Blocks<N> for ByEquations<'_, N> {
    fn begin(&mut self, f: usize) {
        (self.facet, self.own) = (f, Equations::of(&self.setup.nonmortar.facets[f], self.numbers.sides[0]));
    }

    fn forces(&mut self, rows: Span, columns: Span, values: &[[[[f64; MAX_NODES]; 3]; 3]]) {
        let (rows, columns) = (self.span(rows), self.span(columns));
        let values = values.as_flattened().as_flattened().as_flattened();
        self.sink.add_block(rows.rows(), columns.columns(), values);
    }

    fn multipliers(&mut self, rows: Span, n: &[[f64; MAX_NODES]; MAX_CORNERS], nu: &[Vec3; MAX_CORNERS]) {
        let (rows, multipliers) = (self.span(rows), self.facet_multipliers());
        if N == 1 {
            let mut values = [[[0.0; MAX_NODES]; 3]; MAX_CORNERS];
            for (a, i) in (0..MAX_CORNERS).flat_map(|a| (0..3).map(move |i| (a, i))) {
                values[a][i] = n[a].map(|n| n * nu[a][i]);
            }
            return self.sink.add_block(rows.rows(), &multipliers[0], values.as_flattened().as_flattened());
        }
        for i in 0..N {
            self.sink.add_block(&rows.by_component[i], &multipliers[i], n.as_flattened());
        }
    }

    fn rows(&mut self, columns: Span, values: &[[[[f64; MAX_CORNERS]; N]; 3]]) {
        let columns = self.span(columns);
        let values = values.as_flattened().as_flattened().as_flattened();
        self.sink.add_block(self.facet_multipliers().as_flattened(), columns.columns(), values);
    }

    fn mortar(&mut self, block: &MortarBlock) {
        let (own, two) = (self.own, self.numbers.sides[1]);
        for (c, &node) in block.rows.iter().enumerate() {
            let column = |k: usize, equations: &[i64; 3], sink: &mut dyn Sink| {
                let values = block.values[k].map(|rows| rows.map(|nodes| nodes[c]));
                sink.add_block(&two[node], equations, values.as_flattened());
            };
            (0..block.own).for_each(|k| column(k, &own.by_node[k], self.sink));
            block.columns.iter().enumerate().for_each(|(k, &n)| column(MAX_NODES + k, &two[n], self.sink));
        }
    }

    fn node(&mut self, row: Place, column: Place, values: &[f64]) {
        self.sink.add_block(self.row_of(row), self.numbers.place(column), values);
    }

    fn multiplier_row(&mut self, row: Place, columns: &[(usize, Place)], n: &Weights, nu: &Directions) {
        let rows = self.numbers.place(row);
        for &(k, column) in columns {
            let multipliers = self.numbers.place(column);
            if N == 1 {
                self.sink.add_block(rows, multipliers, (nu[k] * n[k]).as_slice());
            } else {
                rows.iter()
                    .zip(multipliers)
                    .for_each(|(row, column)| self.sink.add_block(&[*row], &[*column], &[n[k]]));
            }
        }
    }

    fn diagonal(&mut self, a: usize, values: &[f64]) {
        for (equation, value) in self.numbers.multipliers[a].iter().zip(values) {
            self.sink.add_block(&[*equation], &[*equation], &[*value]);
        }
    }
}

/// Displacement equations of a facet's nodes in the orders of a tangent's blocks.
#[derive(Clone, Copy)]
struct Equations {
    by_node: [[i64; 3]; MAX_NODES],
    by_component: [[i64; MAX_NODES]; 3],
}

impl Equations {
    fn none() -> Equations {
        Equations { by_node: [[NO_EQUATION; 3]; MAX_NODES], by_component: [[NO_EQUATION; MAX_NODES]; 3] }
    }

    /// Of a facet.
    #[inline(never)]
    fn of(facet: &FacetNodes, equations: &[[i64; 3]]) -> Equations {
        let mut e = Equations::none();
        for k in 0..facet.len {
            e.by_node[k] = equations[facet.nodes[k]];
            for i in 0..3 {
                e.by_component[i][k] = e.by_node[k][i];
            }
        }
        e
    }

    /// As rows.
    fn rows(&self) -> &[i64] {
        self.by_component.as_flattened()
    }

    /// As columns.
    fn columns(&self) -> &[i64] {
        self.by_node.as_flattened()
    }
}
