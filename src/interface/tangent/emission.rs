//! How the tangent leaves: block by block, by the nodes of their rows and columns. Who takes the blocks puts them in places:
//! a plan's (`plan/fill.rs`), or one by one by the host's equations (`by_equations.rs`).
//!
//! Which blocks there are depends on the pairs, never on the values, so a pattern and a fill always agree.

use super::augmented::NodeCouplings;
pub use super::read::NodeBlock;
use crate::dual::Columns;
use crate::geometry::Vec3;
use crate::interface::data::extent::Extent;
use crate::interface::data::facet_nodes::FacetNodes;
use crate::interface::data::options::{Form, MultiplierBasis};
use crate::interface::pairing::given::Given;
use crate::interface::stages::node::is_out_of_reach;
use crate::mortar::{ForceDerivatives, MORTAR};
use crate::shape::{MAX_CORNERS, MAX_NODES, MAX_PARENT_NODES};
use nalgebra::SMatrix;

/// Nodes of the rows or columns of a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Span {
    /// Those of the non-mortar facet that was begun.
    Own,
    /// Those of this mortar facet.
    Mortar(usize),
    /// These mortar nodes of several facets.
    Group(FacetNodes),
}

/// A node of the rows or columns of a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// The displacements of a node, over both surfaces, mortar after non-mortar.
    Displacement(usize),
    /// The multiplier of a non-mortar node.
    Multiplier(usize),
}

/// Rows of mortar nodes that a facet of dual multipliers couples, [`crate::dual::GROUP`] nodes at a time.
pub struct MortarBlock<'a> {
    /// Mortar nodes of the rows.
    pub rows: &'a [usize],
    /// Nodes of the facet.
    pub own: usize,
    /// Mortar nodes of the columns.
    pub columns: &'a [usize],
    /// `[column][j][i][C]`, the facet's own nodes first, in [`MAX_NODES`] places.
    pub values: &'a [Columns],
}

/// d force / d x of columns, `[k][j][i][B]`, and the weights of the facet's multipliers there, `[A][k]`.
pub type FacetNow<'a> = (&'a [[[[f64; MAX_NODES]; 3]; 3]], &'a [[f64; MAX_NODES]; MAX_CORNERS]);

/// `[i][j]`: component i of a row with respect to component j of a column's node, each with a fourth number that nobody takes; the
/// fourth row is that of a multiplier beside three of displacements.
pub type RowBlock = [[f64; 4]; 4];

/// Blocks of the rows of one node, each column once and in any order. Numbers are those of displacements over both surfaces, then those of
/// multipliers.
pub struct RowBlocks<'a> {
    /// The numbers of the columns.
    pub columns: &'a [usize],
    pub blocks: &'a [RowBlock],
    /// Per number its place among them; larger than any where it is none of them.
    pub places: &'a [u32],
    /// Nodes of both surfaces.
    pub nodes: usize,
    /// Which row of each block is that of the node's first component.
    pub first: usize,
}

/// Weights of the multipliers of a facet, and their normals.
pub type Weights = [f64; MAX_PARENT_NODES];
pub type Directions = [Vec3; MAX_PARENT_NODES];

/// Puts columns, each with the index of its block, in the order of [`Blocks::row`].
#[inline(never)] // sorting is large
pub fn put_in_order(columns: &mut [(usize, Place)], order: &dyn Fn(Place) -> u32) {
    columns.sort_unstable_by_key(|(k, place)| (order(*place), *k));
}

/// Takes the blocks of a tangent. Blocks of the same rows and columns add up.
pub trait Blocks<const N: usize> {
    /// The blocks of this non-mortar facet follow.
    fn begin(&mut self, f: usize);

    /// d forces / d x, `[k][j][i][B]`: component j of node k of the columns, component i of node B of the rows.
    fn forces(&mut self, rows: Span, columns: Span, values: &[[[[f64; MAX_NODES]; 3]; 3]]);

    /// d forces / d multipliers of the facet, weights `n[A][B]`: n I, or n nu_A where there is one component.
    fn multipliers(&mut self, rows: Span, n: &[[f64; MAX_NODES]; MAX_CORNERS], nu: &[Vec3; MAX_CORNERS]);

    /// d (rows of the facet's multipliers) / d x, `[k][j][n][A]`.
    fn rows(&mut self, columns: Span, values: &[[[[f64; MAX_CORNERS]; N]; 3]]);

    /// d forces / d x of mortar nodes that a facet couples.
    fn mortar(&mut self, block: &MortarBlock);

    /// One block of two nodes, column by column.
    fn node(&mut self, row: Place, column: Place, values: &[f64]);

    /// Where this column comes among those of [`Blocks::row`].
    fn order(&self, _column: Place) -> u32 {
        0
    }

    /// Blocks of one node's row with displacements, in their order, each with the index of its block; zeros where it has none.
    fn row(&mut self, row: Place, columns: &[(usize, Place)], blocks: &[NodeBlock]) {
        let components = if matches!(row, Place::Displacement(_)) { 3 } else { N };
        for &(k, column) in columns {
            let (block, mut values) = (blocks.get(k).copied().unwrap_or_default(), [0.0; 9]);
            (0..3 * components).for_each(|ij| values[ij] = block[ij / components][ij % components]);
            self.node(row, column, &values[..3 * components]);
        }
    }

    /// Blocks of one node's rows; with them come all that these columns have.
    fn sums(&mut self, row: Place, of: &RowBlocks) {
        let components = if matches!(row, Place::Displacement(_)) { 3 } else { N };
        for (&number, block) in of.columns.iter().zip(of.blocks) {
            let (column, width) = match number.checked_sub(of.nodes) {
                Some(a) => (Place::Multiplier(a), N),
                None => (Place::Displacement(number), 3),
            };
            let mut values = [0.0; 9];
            (0..width * components).for_each(|ij| values[ij] = block[of.first + ij % components][ij / components]);
            self.node(row, column, &values[..width * components]);
        }
    }

    /// d force of one node / d multipliers of these nodes, in the multiplier form and in the order of [`Blocks::order`], each with
    /// the index of its weight n and of its nu_A: n I, or n nu_A where there is one component.
    fn multiplier_row(&mut self, row: Place, columns: &[(usize, Place)], n: &Weights, nu: &Directions);

    /// The diagonal of the block of a multiplier with itself, which has nothing else.
    fn diagonal(&mut self, a: usize, values: &[f64]);
}

/// Who takes a tangent, and of a condensed system its constraints: see [`Emitter`].
pub type Takers<'a, const N: usize> = (&'a mut dyn Blocks<N>, Option<&'a mut dyn Blocks<N>>);

/// Where the blocks of a tangent go.
pub struct Emitter<'a, 's, const N: usize> {
    /// The interface and its step.
    pub given: Given<'a, N>,
    /// nu of every node; zeros for the pattern alone.
    pub normals: &'a [Vec3],
    /// Who takes the blocks.
    pub taker: &'s mut dyn Blocks<N>,
    /// Of a condensed system: who takes s_A Dc_A / Dx in the rows of node A's displacements. `taker` then takes what the
    /// forces depend on the displacements by, and there are no multipliers.
    pub constraints: Option<&'s mut dyn Blocks<N>>,
}

// Not inlined: tangents with and without a moving mortar side share these functions.
impl<const N: usize> Emitter<'_, '_, N> {
    /// The blocks of a non-mortar facet follow.
    pub fn begin(&mut self, f: usize) {
        self.taker.begin(f);
        if let Some(constraints) = &mut self.constraints {
            constraints.begin(f);
        }
    }

    /// Rows of a mortar facet that its pair with a facet has; with dual multipliers they are of all pairs together.
    #[inline(never)]
    pub fn pair(&mut self, two: usize, forces: &ForceDerivatives) {
        let (options, mortar) = (&self.given.setup.options, Span::Mortar(two));
        if options.differentiates_weights() && options.basis == MultiplierBasis::Standard {
            self.taker.forces(mortar, Span::Own, &forces.two[..MORTAR]);
            self.taker.forces(mortar, mortar, &forces.two[MORTAR..]);
        }
    }

    /// Columns of a facet with all of its pairs, in its own rows; multipliers act on the columns' nodes. `now`: of nodes of pairs
    /// active now, the forces and the weights.
    #[inline(never)]
    pub fn facet(&mut self, f: usize, columns: Span, now: Option<FacetNow>, rows: &[[[[f64; MAX_CORNERS]; N]; 3]]) {
        if let Some((forces, weights)) = now {
            if self.given.setup.options.differentiates_weights() {
                self.taker.forces(Span::Own, columns, forces);
            }
            if self.given.setup.options.form == Form::Multiplier {
                self.multipliers(f, columns, weights);
            }
        }
        self.facet_rows(f, columns, rows);
    }

    /// Derivatives of the rows of a facet's multipliers, in each column component by component.
    #[inline(never)]
    pub fn facet_rows(&mut self, f: usize, columns: Span, values: &[[[[f64; MAX_CORNERS]; N]; 3]]) {
        let Some(constraints) = &mut self.constraints else { return self.taker.rows(columns, values) };
        let nu = self.given.setup.nonmortar.facets[f].nodes.map(|a| self.normals[a]);
        let mut forces = [[[[0.0; MAX_NODES]; 3]; 3]; MAX_NODES];
        for (k, j) in (0..values.len()).flat_map(|k| (0..3).map(move |j| (k, j))) {
            for (i, a) in (0..3).flat_map(|i| (0..MAX_CORNERS).map(move |a| (i, a))) {
                let rows = &values[k][j];
                forces[k][j][i][a] = if N == 1 { rows[0][a] * nu[a][i] } else { rows[i][a] };
            }
        }
        constraints.forces(Span::Own, columns, &forces[..values.len()]);
    }

    /// The same of node A alone with respect to one node, column by column.
    #[inline(never)]
    pub fn node_row(&mut self, a: usize, column: usize, values: &[[f64; N]; 3]) {
        let mut block = NodeBlock::default();
        block.iter_mut().zip(values).for_each(|(to, of)| to[..N].copy_from_slice(of));
        self.node_rows(a, &[(0, Place::Displacement(column))], &mut [block]);
    }

    /// The same with respect to several nodes, in their order; `blocks` are made those of forces where there are
    /// constraints.
    pub fn node_rows(&mut self, a: usize, columns: &[(usize, Place)], blocks: &mut [NodeBlock]) {
        let Some(constraints) = &mut self.constraints else {
            return self.taker.row(Place::Multiplier(a), columns, blocks);
        };
        let nu = self.normals[a];
        if N == 1 {
            blocks.as_flattened_mut().iter_mut().for_each(|c| *c = [c[0] * nu.x, c[0] * nu.y, c[0] * nu.z, 0.0]);
        }
        constraints.row(Place::Displacement(a), columns, blocks);
    }

    /// d forces / d multipliers of facet `f`, weights `n[A][row]`: n I, or n nu_A where there is one component.
    #[inline(never)]
    fn multipliers(&mut self, f: usize, rows: Span, n: &[[f64; MAX_NODES]; MAX_CORNERS]) {
        if self.constraints.is_none() {
            let nu = self.given.setup.nonmortar.facets[f].nodes.map(|a| self.normals[a]);
            self.taker.multipliers(rows, n, &nu);
        }
    }

    /// Stage 4: the node's own block, once per node, covered or not.
    #[inline(never)]
    pub fn node(&mut self, a: usize, drow_dlambda: &SMatrix<f64, N, N>, extent: Extent) {
        if !self.given.setup.nodes.is_own(a) || self.constraints.is_some() {
            return;
        }
        let block = drow_dlambda * self.given.row_scale(a);
        if is_out_of_reach(self.given, a, extent) {
            self.taker.diagonal(a, block.diagonal().as_slice());
        } else {
            self.taker.node(Place::Multiplier(a), Place::Multiplier(a), block.as_slice());
        }
    }

    /// Node-wise products n_A. (Dp_A), of the augmented form with the multipliers' columns.
    #[inline(never)]
    pub fn couplings(&mut self, a: usize, couplings: &NodeCouplings, dp_dlambda: &SMatrix<f64, 3, N>) {
        for row in couplings.forces() {
            let place = Place::Displacement(row.node);
            for column in couplings.places() {
                let block = column.dtraction * row.weight;
                self.taker.node(place, Place::Displacement(column.node), block.as_slice());
            }
            if self.given.setup.options.form == Form::Augmented {
                self.taker.node(place, Place::Multiplier(a), (dp_dlambda * row.weight).as_slice());
            }
        }
    }
}
