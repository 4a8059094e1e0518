//! What the tangent with conserving weights is made of (`conserving.rs`).

use crate::geometry::{Mat3, Vec3};
use crate::interface::data::conserving::Conserving;
use crate::interface::stages::sums::NodeSums;
use nalgebra::SVector;

/// How the weights of the slip change, of one node: weight of a node, by the place of another, D.
pub type WeightSlopes = Vec<(usize, usize, Vec3)>;

/// Second derivatives half way (`curvature.rs`).
#[derive(Debug, Default)]
pub struct Curvature {
    /// Blocks of lambda_A D (m_A Dg_A), row and column, each with a node that depends on both.
    pub blocks: Vec<Vec<([usize; 2], Mat3)>>,
    /// D (m_A Dg_A . u) at fixed u, of the nodes that g_A depends on.
    pub along: Vec<Vec<Vec3>>,
}

/// What the numbers are made of.
pub struct ConservingNumbers<'a, const N: usize> {
    pub known: &'a Conserving,
    pub lambda: &'a [SVector<f64, N>],
    pub sums: &'a [NodeSums],
    pub curvature: Curvature,
    /// Of every node; empty without friction.
    pub slopes: Vec<WeightSlopes>,
}
