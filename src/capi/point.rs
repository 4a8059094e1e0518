//! Where an evaluation takes place.

use super::handle::{Inner, either, sizes};
use super::raw;
use crate::error::Result;
use crate::geometry::Vec3;
use crate::interface::NodeSums;
use crate::memory::{self, Stored};
use nalgebra::SVector;

/// Reals per node of `stickslip_interface_sums`.
pub const STICKSLIP_SUMS_PER_NODE: i32 = 11;

/// Where an evaluation takes place, read from the caller's arrays.
pub(super) struct Point {
    pub x1: Vec<Vec3>,
    pub x2: Vec<Vec3>,
    lambda: Vec<f64>,
    sums: Option<Vec<NodeSums>>,
}

impl Point {
    /// Positions alone.
    pub fn positions(interface: &Inner, x1: *const f64, x2: *const f64) -> Result<Point> {
        let (n1, n2) = sizes(interface);
        Ok(Point {
            x1: raw::vectors(raw::numbers(x1, 3 * n1, "x1")?)?,
            x2: raw::vectors(raw::numbers(x2, 3 * n2, "x2")?)?,
            lambda: Vec::new(),
            sums: None,
        })
    }

    /// Positions, multipliers and, if given, sums.
    pub fn read(
        interface: &Inner,
        x1: *const f64,
        x2: *const f64,
        lambda: *const f64,
        sums: *const f64,
    ) -> Result<Point> {
        let n1 = sizes(interface).0;
        let mut point = Point::positions(interface, x1, x2)?;
        let components = either!(interface, c => c.components());
        point.lambda = memory::copied(raw::numbers(lambda, components * n1, "lambda")?)?;
        let per_node = STICKSLIP_SUMS_PER_NODE as usize;
        if let Some(values) = raw::optional_numbers(sums, per_node * n1, "sums")? {
            let read = |s: &[f64]| NodeSums {
                coverage: s[0],
                gap_now: Vec3::from_column_slice(&s[1..4]),
                coverage_previous: s[4],
                gap_previous: Vec3::from_column_slice(&s[5..8]),
                gap_committed: Vec3::from_column_slice(&s[8..11]),
            };
            point.sums = Some(values.chunks_exact(per_node).map(read).stored()?);
        }
        Ok(point)
    }

    /// The multipliers, N a node.
    pub fn lambda<const N: usize>(&self) -> Result<Vec<SVector<f64, N>>> {
        self.lambda.chunks_exact(N).map(SVector::from_column_slice).stored()
    }

    pub fn sums(&self) -> Option<&[NodeSums]> {
        self.sums.as_deref()
    }
}
