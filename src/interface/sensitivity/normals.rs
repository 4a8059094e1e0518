//! How answers follow the normals of t_n, nu(x_n), where a step keeps them (docs/formulation.md 18.1): rows of the nodes and of those that
//! carry them, and, with one multiplier, forces lambda_N nu.

use super::{At, Column, Take};
use crate::geometry::Mat3;
use crate::interface::data::host_facets::NormalDerivatives;
use crate::interface::stages::sums::in_previous_gaps;
use crate::interface::tangent::emission::Place;
use crate::interface::tangent::turning::Turns;

/// Gives what every row and force has of them.
pub fn through_normals<const N: usize>(at: &At<N>, turns: &Turns<N>, take: &mut Take) {
    let (given, one) = (at.given, &at.given.setup.nonmortar);
    for f in 0..one.host_facets() {
        for (k, &a) in one.host_nodes(f).iter().enumerate().take(one.multipliers(f)) {
            // Columns of Dnu by the facet's nodes, times what a row or a force has of it.
            let mut put = |row: Place, rows: usize, of: &Mat3, dnu: &NormalDerivatives| {
                for (l, dnu) in dnu.as_slice() {
                    let by = of * dnu;
                    let values: [f64; 9] = std::array::from_fn(|ij| by[(ij % rows, ij / rows % 3)]);
                    take(row, Column::Previous(one.host_nodes(f)[*l]), &values[..3 * rows]);
                }
            };
            put(Place::Multiplier(a), N, &Mat3::identity(), &turns.of_row(given, (f, k)));
            let dnu = turns.of_normal(given, (f, k));
            for &(b, w) in given.carriers_of(a).iter().filter(|_| at.is_carried(a)) {
                let answer = &at.responses.nodes[b];
                let both = N > 1 && in_previous_gaps(given);
                let by_gap = answer.drow_dnow + answer.drow_dprevious * f64::from(both);
                let along = by_gap * at.scale(b) * turns.taken_over(given, at.normals, (a, (b, w)));
                put(Place::Multiplier(b), N, &Mat3::from_fn(|i, j| if i < N { along[(i, j)] } else { 0.0 }), &dnu);
            }
            if N == 1 && given.setup.nodes.acts(a) {
                for column in at.rows[a].columns.iter().filter(|column| column.n != 0.0) {
                    put(
                        Place::Displacement(column.node),
                        3,
                        &Mat3::from_diagonal_element(at.lambda[a][0] * column.n),
                        &dnu,
                    );
                }
            }
        }
    }
}
