//! A node's multiplier: three components, or one along the normal.

use crate::geometry::Vec3;
use nalgebra::{SMatrix, SVector};

/// A unit multiplier along the normal: nu, or 1 where the only component is along the normal.
pub(super) fn along_normal<const N: usize>(nu: Vec3) -> SVector<f64, N> {
    SVector::from_fn(|i, _| if N == 1 { 1.0 } else { nu[i] })
}

/// The traction of a multiplier: lambda, or lambda nu where it is the component along the normal.
pub(super) fn traction<const N: usize>(lambda: &SVector<f64, N>, nu: Vec3) -> Vec3 {
    if N == 1 { nu * lambda[0] } else { Vec3::from_fn(|i, _| lambda[i]) }
}

/// d traction / d lambda: I, or nu where there is one component.
pub(super) fn basis<const N: usize>(nu: Vec3) -> SMatrix<f64, 3, N> {
    SMatrix::from_fn(|i, j| if N == 1 { nu[i] } else { f64::from(u8::from(i == j)) })
}
