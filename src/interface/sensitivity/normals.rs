//! How answers follow the normals of t_n, nu(x_n), where a step keeps them (docs/formulation 18.1): rows of the nodes and of those that
//! carry them, and, with one multiplier, forces lambda_N nu.

use super::{At, Column, Take, put};
use crate::geometry::Mat3;
use crate::interface::data::host_facets::NormalDerivatives;
use crate::interface::pairing::given::Given;
use crate::interface::stages::sums::in_previous_gaps;
use crate::interface::tangent::emission::Place;
use crate::interface::tangent::turning::Turns;

/// Gives what every row and force has of them.
pub fn through_normals<const N: usize>(at: &At, given: Given<N>, turns: &Turns<N>, take: &mut Take) {
    let one = at.surfaces.0;
    for f in 0..one.host_facets() {
        for (k, &a) in one.host_nodes(f).iter().enumerate().take(one.multipliers(f)) {
            // Columns of Dnu by the facet's nodes, times what a row or a force has of it.
            let mut give = |row: (Place, usize), of: &Mat3, dnu: &NormalDerivatives| {
                for (l, dnu) in dnu.as_slice() {
                    put(row, Column::Previous(one.host_nodes(f)[*l]), &(of * dnu), take);
                }
            };
            give((Place::Multiplier(a), N), &Mat3::identity(), &turns.of_row(given, (f, k)));
            let dnu = turns.of_normal(given, (f, k));
            for &(b, w) in at.carriers_of(a).iter().filter(|_| at.is_carried(a)) {
                let [now, previous] = at.answers[b].by_gap;
                let both = f64::from(N > 1 && in_previous_gaps(given));
                let along = (now + previous * both) * turns.taken_over(given, at.normals, (a, (b, w)));
                give((Place::Multiplier(b), N), &along, &dnu);
            }
            if N == 1 && at.nodes.acts(a) {
                for weight in &at.weights[a] {
                    let force = Mat3::from_diagonal_element(at.answers[a].lambda[0] * weight.now);
                    give((Place::Displacement(weight.node), 3), &force, &dnu);
                }
            }
        }
    }
}
