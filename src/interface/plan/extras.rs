//! Blocks of a tangent that are not those of facets and pairs: of carried nodes, of normals that follow the motion, of forces
//! that use the projected traction. What takes them here notes which there are.

use super::numbering::{Nodes, Sides};
use crate::error::Error;
use crate::geometry::Vec3;
use crate::interface::data::setup::Setup;
use crate::interface::tangent::emission::{Blocks, Directions, MortarBlock, Place, Span, Weights};
use crate::memory::Store;
use crate::shape::{MAX_CORNERS, MAX_NODES};

/// Takes blocks of single nodes, by row and column, and of whole facets the rows of those that have no pairs.
pub struct Extras<'a, const N: usize> {
    setup: &'a Setup<N>,
    facet: usize,
    /// (row, column) of each.
    pub blocks: Vec<(u32, u32)>,
    /// There was no memory for all of them.
    pub refused: Option<Error>,
}

impl<'a, const N: usize> Extras<'a, N> {
    /// Of an interface.
    pub fn new(setup: &'a Setup<N>) -> Self {
        Extras { setup, facet: 0, blocks: Vec::new(), refused: None }
    }

    /// All blocks of the facet at hand: those of facets without pairs come as those of any other.
    fn all(&mut self, row: impl Fn(usize) -> Place) {
        let nodes = &self.setup.nonmortar.facets[self.facet];
        for &a in nodes.as_slice() {
            nodes.as_slice().iter().for_each(|&b| self.node(row(a), Place::Displacement(b), &[]));
        }
    }
}

impl<const N: usize> Blocks<N> for Extras<'_, N> {
    fn begin(&mut self, f: usize) {
        self.facet = f;
    }

    fn forces(&mut self, rows: Span, columns: Span, _values: &[[[[f64; MAX_NODES]; 3]; 3]]) {
        if (rows, columns) == (Span::Own, Span::Own) {
            self.all(Place::Displacement);
        }
    }

    fn multipliers(&mut self, _rows: Span, _n: &[[f64; MAX_NODES]; MAX_CORNERS], _nu: &[Vec3; MAX_CORNERS]) {}

    fn rows(&mut self, columns: Span, _values: &[[[[f64; MAX_CORNERS]; N]; 3]]) {
        if columns == Span::Own {
            self.all(Place::Multiplier);
        }
    }

    fn multiplier_row(&mut self, row: Place, columns: &[(usize, Place)], _n: &Weights, _nu: &Directions) {
        // Forces of pairs are known from these but for those on the frame of an analytic surface.
        if self.setup.frame_moves() {
            columns.iter().for_each(|column| self.node(row, column.1, &[]));
        }
    }

    fn mortar(&mut self, _block: &MortarBlock) {}
    fn diagonal(&mut self, _a: usize, _values: &[f64]) {}

    fn node(&mut self, row: Place, column: Place, _values: &[f64]) {
        let nodes = Nodes::of(Sides::of(self.setup));
        if let Err(error) = self.blocks.store((nodes.number(row) as u32, nodes.number(column) as u32)) {
            self.refused.get_or_insert(error);
        }
    }
}
