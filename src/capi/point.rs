//! Where an evaluation takes place.

use super::handle::{Inner, either, sizes};
use super::raw;
use crate::error::Result;
use crate::geometry::Vec3;
use crate::interface::NodeSums;
use nalgebra::SVector;

/// Reals per node of `stickslip_interface_sums`.
pub const STICKSLIP_SUMS_PER_NODE: i32 = 11;

/// Where an evaluation takes place: the caller's arrays, checked.
pub(super) struct Point<'a> {
    pub x1: &'a [Vec3],
    pub x2: &'a [Vec3],
    lambda: &'a [f64],
    sums: Option<&'a [NodeSums]>,
}

impl<'a> Point<'a> {
    /// Positions alone.
    pub fn positions(interface: &Inner, x1: *const f64, x2: *const f64) -> Result<Point<'a>> {
        let (n1, n2) = sizes(interface);
        let x1 = raw::as_vectors(raw::numbers(x1, 3 * n1, "x1")?);
        let x2 = raw::as_vectors(raw::numbers(x2, 3 * n2, "x2")?);
        Ok(Point { x1, x2, lambda: &[], sums: None })
    }

    /// Positions, multipliers and, if given, sums.
    pub fn read(
        interface: &Inner,
        x1: *const f64,
        x2: *const f64,
        lambda: *const f64,
        sums: *const f64,
    ) -> Result<Point<'a>> {
        let n1 = sizes(interface).0;
        let mut point = Point::positions(interface, x1, x2)?;
        let components = either!(interface, c => c.components());
        point.lambda = raw::numbers(lambda, components * n1, "lambda")?;
        let values = raw::optional_numbers(sums, STICKSLIP_SUMS_PER_NODE as usize * n1, "sums")?;
        point.sums = values.map(as_sums);
        Ok(point)
    }

    /// The multipliers, N a node.
    pub fn lambda<const N: usize>(&self) -> Result<&'a [SVector<f64, N>]> {
        Ok(raw::as_vectors(self.lambda))
    }

    pub fn sums(&self) -> Option<&'a [NodeSums]> {
        self.sums
    }
}

/// Numbers as nodes' sums, in their place.
fn as_sums(values: &[f64]) -> &[NodeSums] {
    const NUMBERS: usize = STICKSLIP_SUMS_PER_NODE as usize;
    const { assert!(size_of::<NodeSums>() == NUMBERS * size_of::<f64>()) }
    const { assert!(align_of::<NodeSums>() == align_of::<f64>()) }
    // SAFETY: `NodeSums` is repr(C) and holds this many numbers, in the order of the ABI, and nothing else.
    unsafe { std::slice::from_raw_parts(values.as_ptr().cast(), values.len() / NUMBERS) }
}
