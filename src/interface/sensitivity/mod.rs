//! What a residual depends on besides the unknowns (docs/formulation 18): the positions of t_n, through the weights and the normals
//! that slip is measured with and through who carries whom, and parameters. Beside the stages of forces, whose answers it takes; none of
//! them knows it.

mod carriers;
pub mod derivatives;
pub mod layout;
mod normals;
mod parameters;
mod weights;

use crate::error::Result;
use crate::geometry::{Mat3, Vec3};
use crate::interface::data::node_data::NodeData;
use crate::interface::data::pairs::Weighted;
use crate::interface::data::surface::Surface;
use crate::interface::pairing::given::Step;
use crate::interface::pairing::weak::Carrier;
use crate::interface::stages::carried::transfer_of;
use crate::interface::stages::sums::NodeSums;
use crate::interface::tangent::emission::Place;
use crate::interface::weights::each_weight;
use crate::memory::{self, Store};

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

/// A weight of a node.
#[derive(Clone, Copy, Debug)]
pub struct Weight {
    /// The other node, over both surfaces.
    pub node: usize,
    /// n_AB, or - n_AC [L^2].
    pub now: f64,
    /// The same at t_n.
    pub before: f64,
}

/// Those of every node, by pairs of now and of t_n.
pub fn weights_of((one, two): (&Surface, &Surface), [now, before]: [Weighted; 2]) -> Result<Vec<Vec<Weight>>> {
    let mut all = memory::defaults::<Vec<Weight>>(one.len())?;
    for (pairs, is_now) in [(now, 1.0), (before, 0.0)] {
        each_weight((one, two), pairs, &mut |a, node, n| {
            let (now, before) = (is_now * n, (1.0 - is_now) * n);
            match all[a].iter_mut().find(|weight| weight.node == node) {
                Some(weight) => (weight.now, weight.before) = (weight.now + now, weight.before + before),
                None => all[a].store(Weight { node, now, before })?,
            }
            Ok(())
        })?;
    }
    Ok(all)
}

/// A node's answer at a point, of as many components as its multiplier has.
#[derive(Clone, Copy, Debug)]
pub struct Answer {
    /// d row / d (gap of now, gap that slip is measured from), in the first rows, with the row's scale.
    pub by_gap: [Mat3; 2],
    /// The multiplier.
    pub lambda: Vec3,
    /// The scale of its rows; 0 where another handle has them.
    pub scale: f64,
    /// r_A.
    pub augmentation: f64,
}

/// A point at which a residual was evaluated.
pub struct At<'a> {
    /// Both sides.
    pub surfaces: (&'a Surface, &'a Surface),
    /// The step.
    pub step: &'a Step,
    /// What the host says of the nodes.
    pub nodes: &'a NodeData,
    /// Components of a multiplier.
    pub components: usize,
    /// Whether anything follows slip, and how much of the gap of t_n is taken off it.
    pub slip: Option<f64>,
    /// How much of the first gap is taken off the gap of now: 1 of tied surfaces, else 0.
    pub first_gap: f64,
    /// Positions of both sides.
    pub x: [&'a [Vec3]; 2],
    /// What the nodes assemble.
    pub sums: &'a [NodeSums],
    /// The law's answers.
    pub answers: &'a [Answer],
    /// Whose gaps count in the rows of others; empty: nobody's.
    pub carried: &'a [bool],
    /// nu of every node.
    pub normals: &'a [Vec3],
    /// The weights of now, and those of t_n, of every node.
    pub weights: &'a [Vec<Weight>],
}

impl At<'_> {
    fn is_carried(&self, a: usize) -> bool {
        self.carried.get(a).is_some_and(|is| *is)
    }

    /// Those who carry A.
    fn carriers_of(&self, a: usize) -> &[Carrier] {
        self.step.pairing.carriers.get(a).map_or(&[], |c| c)
    }

    /// T_AB.
    fn transfer(&self, a: usize, b: usize) -> Mat3 {
        transfer_of(self.components, &self.nodes.free[a], self.normals[a], self.normals[b])
    }

    /// d row / d (gap of now, gap that slip is measured from) of A, of the node itself or of each that carries it.
    fn by_gap(&self, a: usize, give: &mut dyn FnMut(usize, [Mat3; 2])) {
        if !self.is_carried(a) {
            return give(a, self.answers[a].by_gap);
        }
        for &(b, w) in self.carriers_of(a) {
            let share = self.transfer(a, b) * w;
            give(b, self.answers[b].by_gap.map(|by| by * share));
        }
    }

    /// Gives three columns of a multiplier's row away.
    fn put(&self, a: usize, column: Column, by: &Mat3, take: &mut Take) {
        put((Place::Multiplier(a), self.components), column, by, take);
    }
}

/// Gives three columns of the first rows of a square away.
fn put((row, rows): (Place, usize), column: Column, by: &Mat3, take: &mut Take) {
    let values: [f64; 9] = std::array::from_fn(|ij| by[(ij % rows, ij / rows % 3)]);
    if values.iter().any(|v| *v != 0.0) {
        take(row, column, &values[..3 * rows]);
    }
}
