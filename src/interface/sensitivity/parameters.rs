//! How rows follow parameters (docs/formulation 18.2): mu and the limit through the threshold of a node that slips, offsets through gaps.

use super::{At, Column, Take};
use crate::error::Result;
use crate::geometry::Vec3;
use crate::interface::pairing::given::Given;
use crate::interface::stages::node::node;
use crate::interface::stages::own::is_new;
use crate::interface::stages::sums::NodeSums;
use crate::interface::tangent::emission::Place;
use crate::law::{NodeResponse, State};
use nalgebra::SVector;

/// A node that slips: what it was asked, and what it answered.
pub struct Slipping<'a, const N: usize> {
    /// Its multiplier.
    pub lambda: &'a SVector<f64, N>,
    /// What it assembles, with those that it carries.
    pub sums: &'a NodeSums,
    /// The answer.
    pub response: &'a NodeResponse<N>,
}

/// Dp of node A along its slip by mu and by the limit; `None`: its threshold follows neither.
pub fn by_threshold<const N: usize>(given: Given<N>, a: usize, slipping: Slipping<N>) -> Result<Option<[Vec3; 2]>> {
    let Slipping { lambda, sums, response } = slipping;
    let node = node(given, a, *lambda, sums)?;
    // What slips without friction whatever mu is.
    if response.state != State::Slip || is_new(given, &node) || given.has_copy_in_contact(a) {
        return Ok(None);
    }
    let normal = node.normal.dot(&response.sigma);
    let tangential = response.sigma - node.normal * normal;
    let (size, pressure) = (tangential.norm(), (-normal).max(0.0));
    let by = if node.mu * pressure < node.shear_limit { [pressure, 0.0] } else { [0.0, 1.0] };
    Ok((size > 0.0).then(|| by.map(|by| tangential * (by / size))))
}

/// Gives what the row of node A has of these.
pub fn through_threshold(at: &At, a: usize, by: [Vec3; 2], take: &mut Take) {
    for (column, by) in [Column::Friction(a), Column::ShearLimit].into_iter().zip(by) {
        let row = by * (at.answers[a].scale / at.answers[a].augmentation);
        take(Place::Multiplier(a), column, &row.as_slice()[..at.components]);
    }
}

/// Gives what every row has of offsets. `both`: they are in the gap that slip is measured from, too.
pub fn through_offsets(at: &At, both: bool, take: &mut Take) {
    let n1 = at.x[0].len();
    for (a, weights) in at.weights.iter().enumerate() {
        at.by_gap(a, &mut |b, [now, previous]| {
            let by = (now + previous * f64::from(both)) * at.normals[a];
            for weight in weights {
                let n = if weight.node < n1 { weight.now } else { -weight.now };
                take(Place::Multiplier(b), Column::Offset(weight.node), &(by * n).as_slice()[..at.components]);
            }
        });
    }
}
