//! One non-mortar node: gaps and multiplier in, state, projected traction and multiplier row out
//! (stage 2). The row is c = -(lambda - p) / r [L^3] (paper (26), (30), third row).

use super::projection::State;
use super::slip::SlipMeasure;
use super::special::Special;
use super::violation::{Measure, Violation};
use crate::geometry::{Mat3, Vec3};
use nalgebra::{SMatrix, SVector};

/// A contact law for nodes with N multiplier components.
pub trait Law<const N: usize> {
    /// Whether it looks at slip, and so at the weights and gaps of t_n.
    const SLIPS: bool;

    /// The law's answer for one node.
    fn respond(node: &Node<N>) -> NodeResponse<N>;

    /// What traction and row depend on the normal by, its gaps and its multiplier held fixed.
    fn turn(node: &Node<N>) -> Turn<N>;

    /// How far a covered node is from equilibrium. The augmentation has no part in it.
    fn violation(node: &Node<N>, measure: &Measure) -> Violation;
}

/// Everything a law may need of one node. N = 3: the multiplier is a vector; N = 1: its component along the normal.
#[derive(Clone, Copy, Debug)]
pub struct Node<const N: usize = 3> {
    /// Multiplier: minus the Cauchy traction on the non-mortar body [F/L^2].
    pub lambda: SVector<f64, N>,
    /// Unit normal into the non-mortar body, of t_n or of now.
    pub normal: Vec3,
    /// Augmentation r_A > 0 [F/L^5].
    pub augmentation: f64,
    /// Coulomb coefficient >= 0.
    pub mu: f64,
    /// The largest shear traction that [`Tresca`](super::Tresca) allows [F/L^2]; others do not look at it.
    pub shear_limit: f64,
    /// g[n_{n+1}, x_{n+1}], assembled over all pairs [L^3].
    pub gap_now: Vec3,
    /// g[n_n, x_{n+1}].
    pub gap_previous: Vec3,
    /// g[n_n, x_n]; read by the increment measure. Tied nodes: the first gap, turned with the surface.
    pub gap_committed: Vec3,
    /// Whether the node is covered now; an uncovered node is in gap whatever its multiplier.
    pub covered: bool,
    /// Whether it was covered at t_n; if not it has no slip history and g_T = 0.
    pub covered_before: bool,
    /// How slip is measured.
    pub slip: SlipMeasure,
    /// Projector on the directions in which the node is free: I, or I - d d^T - ... for prescribed
    /// directions d. The normal must lie in its range.
    pub free: Mat3,
    /// What a law of one's own adds.
    pub special: Special,
}

/// How a law's answer for one node turns with its normal (docs/formulation 11.2).
#[derive(Clone, Copy, Debug)]
pub struct Turn<const N: usize = 3> {
    /// dp/dnu [F/L^2].
    pub dp_dnormal: Mat3,
    /// dc/dnu [L^3].
    pub drow_dnormal: SMatrix<f64, N, 3>,
}

impl<const N: usize> Default for Turn<N> {
    fn default() -> Self {
        Turn { dp_dnormal: Mat3::zeros(), drow_dnormal: SMatrix::zeros() }
    }
}

/// A law's answer for one node.
#[derive(Clone, Copy, Debug)]
pub struct NodeResponse<const N: usize = 3> {
    /// Gap, stick or slip.
    pub state: State,
    /// Projected traction p [F/L^2].
    pub traction: Vec3,
    /// Multiplier row c [L^3].
    pub row: SVector<f64, N>,
    /// Normal gap g_N = nu . g [L^3].
    pub gap_normal: f64,
    /// Slip increment g_T [L^3].
    pub slip: Vec3,
    /// Augmented traction sigma [F/L^2].
    pub sigma: Vec3,
    /// dp/dlambda [-].
    pub dp_dlambda: SMatrix<f64, 3, N>,
    /// dc/dlambda [L^5/F].
    pub drow_dlambda: SMatrix<f64, N, N>,
    /// dc/dg_now [-]; dp/dg_now is r times this, along the normal where N = 1.
    pub drow_dnow: SMatrix<f64, N, 3>,
    /// dc/dg_previous [-]; dp/dg_previous likewise.
    pub drow_dprevious: SMatrix<f64, N, 3>,
    /// dc/dm by the covered area `[L]`: what lies between the surfaces knows of it (`layer.rs`), no law does.
    pub drow_darea: SVector<f64, N>,
}

impl<const N: usize> NodeResponse<N> {
    /// The answer of any law for a node that nothing covers: p = 0, c = -lambda / r. Without sigma.
    pub fn uncovered(lambda: &SVector<f64, N>, r: f64) -> NodeResponse<N> {
        NodeResponse {
            state: State::Gap,
            traction: Vec3::zeros(),
            row: -lambda / r,
            gap_normal: 0.0,
            slip: Vec3::zeros(),
            sigma: Vec3::zeros(),
            dp_dlambda: SMatrix::zeros(),
            drow_dlambda: -SMatrix::identity() / r,
            drow_dnow: SMatrix::zeros(),
            drow_dprevious: SMatrix::zeros(),
            drow_darea: SVector::zeros(),
        }
    }
}
