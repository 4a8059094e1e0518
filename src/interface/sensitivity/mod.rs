//! What a residual depends on besides the unknowns (docs/formulation.md 18): the positions of t_n, through the weights and the normals
//! that slip is measured with and through who carries whom, and parameters. Beside the stages of forces, whose answers it takes; none of
//! them knows it.

mod carriers;
mod normals;
mod parameters;
mod weights;

use crate::error::Result;
use crate::geometry::Vec3;
use crate::interface::data::active::Active;
use crate::interface::heat::rows::Row;
use crate::interface::pairing::given::Given;
use crate::interface::stages::carried::transfer;
use crate::interface::stages::respond::Responses;
use crate::interface::stages::sums::NodeSums;
use crate::interface::tangent::emission::Place;
use crate::interface::tangent::turning::Turns;
use nalgebra::{SMatrix, SVector};

/// What a derivative is by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Column {
    /// The position at t_n of a node over both surfaces: three columns.
    Previous(usize),
    /// mu of a non-mortar node.
    Friction(usize),
    /// The largest shear traction.
    ShearLimit,
    /// The offset of a node over both surfaces.
    Offset(usize),
}

/// What is asked for.
#[derive(Clone, Copy, Debug, Default)]
pub struct Wanted {
    /// Columns of the positions at t_n.
    pub previous: bool,
    /// Those of parameters.
    pub parameters: bool,
}

/// Takes derivatives, column by column: of a node's force three rows, of its multiplier's row as many as it has components. What is given
/// twice adds up.
pub type Take<'a> = dyn FnMut(Place, Column, &[f64]) + 'a;

/// A point at which a residual was evaluated.
pub struct At<'a, const N: usize> {
    /// The interface and its step.
    pub given: Given<'a, N>,
    /// Positions of both sides.
    pub x: [&'a [Vec3]; 2],
    /// Multipliers.
    pub lambda: &'a [SVector<f64, N>],
    /// What the nodes assemble.
    pub sums: &'a [NodeSums],
    /// The law's answers.
    pub responses: &'a Responses<N>,
    /// nu of every node.
    pub normals: &'a [Vec3],
    /// The weights of now, and those of t_n.
    pub rows: &'a [Row],
}

impl<const N: usize> At<'_, N> {
    /// Whether A's gap counts in the rows of others.
    fn is_carried(&self, a: usize) -> bool {
        self.responses.carried.get(a).is_some_and(|is| *is)
    }

    /// What the rows of residual have of a node's answer.
    fn scale(&self, a: usize) -> f64 {
        if self.given.setup.nodes.is_own(a) { self.given.row_scale(a) } else { 0.0 }
    }

    /// d row / d (gap of now, gap that slip is measured from) of A, of the node itself or of each that carries it.
    fn by_gap(&self, a: usize, give: &mut dyn FnMut(usize, [SMatrix<f64, N, 3>; 2])) {
        let of = |b: usize| {
            let answer = &self.responses.nodes[b];
            [answer.drow_dnow, answer.drow_dprevious].map(|by| by * self.scale(b))
        };
        if !self.is_carried(a) {
            return give(a, of(a));
        }
        for &(b, w) in self.given.carriers_of(a) {
            let share = transfer(self.given, a, self.normals[a], self.normals[b]) * w;
            give(b, of(b).map(|by| by * share));
        }
    }
}

/// All that is asked for. `active`: the pairs at t_n whose weights move with its positions; `None`: weights are frozen. `turns`: how
/// answers turn with the normals of t_n; `None`: the step has none of them.
pub fn derivatives<const N: usize>(
    at: &At<N>,
    wanted: Wanted,
    (active, turns): (Option<&Active>, Option<&Turns<N>>),
    take: &mut Take,
) -> Result<()> {
    if wanted.previous {
        weights::through_gaps(at, active, take)?;
        carriers::through_shares(at, take)?;
        if let Some(turns) = turns {
            normals::through_normals(at, turns, take);
        }
    }
    if wanted.parameters {
        parameters::parameters(at, take)?;
    }
    Ok(())
}
