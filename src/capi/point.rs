//! Where an evaluation takes place.

use super::handle::{Inner, dimension, sizes};
use super::raw;
use crate::error::Result;
use crate::geometry::Vec3;
use crate::interface::NodeSums;
use crate::memory::Stored;
use nalgebra::SVector;
use std::borrow::Cow;

/// Reals per node of `stickslip_interface_sums`.
pub const STICKSLIP_SUMS_PER_NODE: i32 = 11;

/// Where an evaluation takes place: the caller's arrays, checked.
pub(super) struct Point<'a> {
    x1: Cow<'a, [f64]>,
    x2: Cow<'a, [f64]>,
    lambda: Cow<'a, [f64]>,
    sums: Option<&'a [NodeSums]>,
}

impl<'a> Point<'a> {
    /// Positions alone.
    pub fn positions(interface: &Inner, x1: *const f64, x2: *const f64) -> Result<Point<'a>> {
        let (n1, n2) = sizes(interface);
        let (x1, x2) = (vectors(interface, x1, n1, "x1")?, vectors(interface, x2, n2, "x2")?);
        Ok(Point { x1, x2, lambda: Cow::Borrowed(&[]), sums: None })
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
        point.lambda = multipliers(interface, lambda, n1)?;
        let values = raw::optional_numbers(sums, STICKSLIP_SUMS_PER_NODE as usize * n1, "sums")?;
        point.sums = values.map(as_sums);
        Ok(point)
    }

    /// Non-mortar positions.
    pub fn x1(&self) -> &[Vec3] {
        raw::as_vectors(&self.x1)
    }

    /// Mortar positions.
    pub fn x2(&self) -> &[Vec3] {
        raw::as_vectors(&self.x2)
    }

    /// The multipliers, N a node.
    pub fn lambda<const N: usize>(&self) -> &[SVector<f64, N>] {
        raw::as_vectors(&self.lambda)
    }

    pub fn sums(&self) -> Option<&'a [NodeSums]> {
        self.sums
    }
}

/// The vectors of `n` nodes that a caller gives, three numbers each: its own, or with z = 0 where it has two.
pub(super) fn vectors<'a>(interface: &Inner, p: *const f64, n: usize, name: &str) -> Result<Cow<'a, [f64]>> {
    let values = raw::numbers(p, dimension(interface) * n, name)?;
    if dimension(interface) == 3 {
        return Ok(Cow::Borrowed(values));
    }
    values.chunks_exact(2).flat_map(|v| [v[0], v[1], 0.0]).stored().map(Cow::Owned)
}

/// The multipliers of `n` nodes: one number each, or vectors.
pub(super) fn multipliers<'a>(interface: &Inner, p: *const f64, n: usize) -> Result<Cow<'a, [f64]>> {
    match interface {
        Inner::One(_) => raw::numbers(p, n, "lambda").map(Cow::Borrowed),
        Inner::Three(_) => vectors(interface, p, n, "lambda"),
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
