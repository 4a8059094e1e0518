//! How rows follow parameters (docs/formulation.md 18.2): mu and the limit through the threshold of a node that slips, offsets through gaps.

use super::{At, Column, Take};
use crate::error::Result;
use crate::geometry::Vec3;
use crate::interface::pairing::given::Given;
use crate::interface::stages::carried::carriers_sums;
use crate::interface::stages::node::node;
use crate::interface::stages::own::is_new;
use crate::interface::stages::sums::{NodeSums, in_previous_gaps};
use crate::interface::tangent::emission::Place;
use crate::law::{NodeResponse, State};
use crate::memory;
use nalgebra::SVector;

/// dk / d (mu, limit) of a node that slips.
fn of_threshold<const N: usize>(
    given: Given<N>,
    a: usize,
    (lambda, sums, response): (&SVector<f64, N>, &NodeSums, &NodeResponse<N>),
) -> Result<[f64; 2]> {
    let node = node(given, a, *lambda, sums)?;
    // What slips without friction whatever mu is.
    if is_new(given, &node) || given.has_copy_in_contact(a) {
        return Ok([0.0; 2]);
    }
    let pressure = (-node.normal.dot(&response.sigma)).max(0.0);
    Ok(if node.mu * pressure < node.shear_limit { [pressure, 0.0] } else { [0.0, 1.0] })
}

/// Gives what every row has of them.
pub fn parameters<const N: usize>(at: &At<N>, take: &mut Take) -> Result<()> {
    let (given, n1) = (at.given, at.x[0].len());
    let carried = &at.responses.carried;
    let shared = if carried.contains(&true) {
        carriers_sums(given, at.sums, carried, at.normals)?
    } else {
        memory::with_room(0)?
    };
    for (a, response) in at.responses.nodes.iter().enumerate().filter(|(a, _)| !at.is_carried(*a)) {
        if response.state != State::Slip || N == 1 {
            continue;
        }
        let nu = at.normals[a];
        let tangential = response.sigma - nu * nu.dot(&response.sigma);
        let size = tangential.norm();
        if size == 0.0 {
            continue;
        }
        let sums = shared.binary_search_by_key(&a, |(b, _)| *b).map_or(&at.sums[a], |k| &shared[k].1);
        let by = of_threshold(given, a, (&at.lambda[a], sums, response))?;
        for (column, by) in [Column::Friction(a), Column::ShearLimit].into_iter().zip(by) {
            let row = tangential * (by * at.scale(a) / (size * given.augmentation(a)));
            take(Place::Multiplier(a), column, &row.as_slice()[..N]);
        }
    }
    // The offsets of now are in both gaps where slip is a difference of the two, and where weights are frozen.
    let both =
        given.setup.effects.law.slips && (in_previous_gaps(given) || !given.setup.options.differentiates_weights());
    for (a, row) in at.rows.iter().enumerate() {
        let nu: Vec3 = at.normals[a];
        at.by_gap(a, &mut |b, [now, previous]| {
            let by: SVector<f64, N> = (now + previous * f64::from(both)) * nu;
            for column in &row.columns {
                let n = if column.node < n1 { column.n } else { -column.n };
                take(Place::Multiplier(b), Column::Offset(column.node), (by * n).as_slice());
            }
        });
    }
    Ok(())
}
