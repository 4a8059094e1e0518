//! What features read of a facet's table, whichever kernels have filled it.

use crate::error::Result;
use crate::geometry::{Mat3, Vec3};
use nalgebra::{SMatrix, SVector};

/// `[j][i]`: component i of a row with respect to component j of a column's node, and a fourth number that nobody takes.
pub type NodeBlock = [[f64; 4]; 3];

/// How an answer depends on a node's gaps of now and of t_n, and on its covered area.
#[derive(Clone, Copy, Debug, Default)]
pub struct Through {
    /// By g of now.
    pub now: Mat3,
    /// By g of t_n's weights.
    pub previous: Mat3,
    /// By m.
    pub area: Vec3,
}

/// A facet's table, once it is filled.
pub trait ReadTable {
    /// Its columns, each with its node over both surfaces: mortar after non-mortar.
    fn nodes(&self) -> &[(usize, usize)];

    /// Whether forces depend on a column, and act on its node.
    fn acts_on(&self, column: usize) -> bool;

    /// n_AB, or - n_AC, of the k-th node's multiplier and a column, as they act now.
    fn weight(&self, column: usize, k: usize) -> f64;

    /// Of the k-th node, through how an answer depends on its gaps and its area: D of the answer, column by column, in place
    /// of what is in `row`.
    fn gap_row(&self, k: usize, through: &Through, row: &mut Vec<NodeBlock>) -> Result<()>;
}

/// A node's rows, of N components, in the first rows of a square.
pub fn square<const N: usize>(d: &SMatrix<f64, N, 3>) -> Mat3 {
    let mut square = Mat3::zeros();
    (0..3 * N).for_each(|ij| square[(ij % N, ij / N)] = d[(ij % N, ij / N)]);
    square
}

/// A node's numbers, of N components, as three.
pub fn vector<const N: usize>(v: &SVector<f64, N>) -> Vec3 {
    Vec3::from_fn(|i, _| v.get(i).copied().unwrap_or(0.0))
}

/// `[j][i]` as a matrix.
pub fn matrix(block: &NodeBlock) -> Mat3 {
    Mat3::from_fn(|i, j| block[j][i])
}
