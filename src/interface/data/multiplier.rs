//! A node's multiplier: three components, or one along the normal.

use super::options::Form;
use crate::geometry::Vec3;
use crate::law::NodeResponse;
use nalgebra::{SMatrix, SVector};

/// A unit multiplier along the normal: nu, or 1 where the only component is along the normal.
pub fn along_normal<const N: usize>(nu: Vec3) -> SVector<f64, N> {
    SVector::from_fn(|i, _| if N == 1 { 1.0 } else { nu[i] })
}

/// The traction of a multiplier: lambda, or lambda nu where it is the component along the normal.
pub fn traction<const N: usize>(lambda: &SVector<f64, N>, nu: Vec3) -> Vec3 {
    if N == 1 { nu * lambda[0] } else { Vec3::from_fn(|i, _| lambda[i]) }
}

/// d traction / d lambda: I, or nu where there is one component.
pub fn direction<const N: usize>(nu: Vec3) -> SMatrix<f64, 3, N> {
    SMatrix::from_fn(|i, j| if N == 1 { nu[i] } else { f64::from(u8::from(i == j)) })
}

/// The traction that a node's forces use.
pub fn force_traction<const N: usize>(
    form: Form,
    lambda: &SVector<f64, N>,
    response: &NodeResponse<N>,
    nu: Vec3,
) -> Vec3 {
    match form {
        Form::Multiplier => traction(lambda, nu),
        Form::Augmented => response.traction,
    }
}
