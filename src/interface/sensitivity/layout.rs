//! Where everything stands in the vectors of residuals and of what they depend on, which products take and give.

use super::Column;
use crate::error::Result;
use crate::interface::tangent::by_equations::Numbers;
use crate::memory::Stored;
use std::ops::Range;

/// Where everything stands in the vectors of residuals and of what they depend on.
#[derive(Clone, Copy, Debug)]
pub struct Layout {
    /// Nodes of both sides.
    pub nodes: [usize; 2],
    /// Components of a multiplier.
    pub components: usize,
}

impl Layout {
    /// What the residual's forces on one side have, three numbers a node; of what it depends on: the positions of now.
    pub fn now(&self, side: usize) -> Range<usize> {
        let first = 3 * self.nodes[0] * side;
        first..first + 3 * self.nodes[side]
    }

    /// The residual's rows of multipliers.
    pub fn rows(&self) -> Range<usize> {
        let first = 3 * (self.nodes[0] + self.nodes[1]);
        first..first + self.components * self.nodes[0]
    }

    /// The positions at t_n.
    pub fn previous(&self, side: usize) -> Range<usize> {
        let (all, now) = (3 * (self.nodes[0] + self.nodes[1]), self.now(side));
        all + now.start..all + now.end
    }

    /// mu of the non-mortar nodes.
    pub fn friction(&self) -> Range<usize> {
        let first = self.previous(1).end;
        first..first + self.nodes[0]
    }

    /// The largest shear traction.
    pub fn shear_limit(&self) -> usize {
        self.friction().end
    }

    /// The offsets.
    pub fn offsets(&self, side: usize) -> Range<usize> {
        let first = self.shear_limit() + 1 + self.nodes[0] * side;
        first..first + self.nodes[side]
    }

    /// The first place of a column.
    pub fn place(&self, column: Column) -> usize {
        match column {
            Column::Previous(node) => self.previous(0).start + 3 * node,
            Column::Friction(a) => self.friction().start + a,
            Column::ShearLimit => self.shear_limit(),
            Column::Offset(node) => self.offsets(0).start + node,
        }
    }

    /// Numbers of a residual.
    pub fn residual(&self) -> usize {
        self.rows().end
    }

    /// Numbers of what it depends on.
    pub fn arguments(&self) -> usize {
        self.offsets(1).end
    }
}

/// The residual's places as equations.
pub struct Natural<const N: usize> {
    sides: [Vec<[i64; 3]>; 2],
    multipliers: Vec<[i64; N]>,
}

impl<const N: usize> Natural<N> {
    /// Of these places.
    pub fn of(layout: &Layout) -> Result<Self> {
        let side = |side: usize| {
            let first = layout.now(side).start;
            (0..layout.nodes[side]).map(move |k| std::array::from_fn(|i| (first + 3 * k + i) as i64)).stored()
        };
        let first = layout.rows().start;
        let multipliers = (0..layout.nodes[0]).map(|a| std::array::from_fn(|i| (first + N * a + i) as i64)).stored()?;
        Ok(Natural { sides: [side(0)?, side(1)?], multipliers })
    }

    /// As numbers of equations.
    pub fn numbers(&self) -> Numbers<'_, N> {
        Numbers { sides: [&self.sides[0], &self.sides[1]], multipliers: &self.multipliers }
    }
}
