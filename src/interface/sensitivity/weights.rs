//! How slip follows the positions of t_n: through the weights n(x_n) of the gap g[n_n, x_{n+1}] that it is measured from, and, as an
//! increment, through the gap g[n_n, x_n] that it is counted from (docs/formulation.md 18.1).

use super::{At, Column, Take};
use crate::error::Result;
use crate::geometry::Mat3;
use crate::interface::data::active::Active;
use crate::interface::heat::motion::each_facet;
use crate::interface::tangent::emission::Place;

/// Gives what every row has of them.
pub fn through_gaps<const N: usize>(at: &At<N>, active: Option<&Active>, take: &mut Take) -> Result<()> {
    if !at.given.setup.effects.law.slips {
        return Ok(());
    }
    let (_, committed) = at.given.setup.options.effective_slip().coefficients();
    if committed != 0.0 {
        for (a, row) in at.rows.iter().enumerate() {
            for column in row.columns.iter().filter(|column| column.before != 0.0) {
                put(at, a, column.node, Mat3::from_diagonal_element(-committed * column.before), take);
            }
        }
    }
    let Some(active) = active else { return Ok(()) };
    let (n1, [x1, x2]) = (at.x[0].len(), at.x);
    let now = |node: usize| if node < n1 { x1[node] } else { x2[node - n1] };
    let before = |node: usize| if node < n1 { active.x1[node] } else { active.x2[node - n1] };
    each_facet((at.given, at.normals), (active, at.responses), &mut |facet| {
        let n = facet.nodes.len();
        for (&a, slopes) in facet.nodes.iter().zip(facet.slopes.chunks_exact(n * n)) {
            // Weights of one row add up to nothing: differences are as good, and do not round where the origin is far away.
            let moved = |node: usize| now(node) - now(a) - (before(node) - before(a)) * committed;
            for (c, &column) in facet.nodes.iter().enumerate() {
                let add = |sum: Mat3, (k, &node): (usize, &usize)| sum + moved(node) * slopes[k * n + c].transpose();
                let by = facet.nodes.iter().enumerate().fold(Mat3::zeros(), add);
                put(at, a, column, by, take);
            }
        }
        Ok(())
    })
}

/// The derivative of A's gap by one node's position, in the rows where it counts.
fn put<const N: usize>(at: &At<N>, a: usize, node: usize, by: Mat3, take: &mut Take) {
    at.by_gap(a, &mut |b, [_, previous]| {
        let block = previous * by;
        if block.iter().any(|v| *v != 0.0) {
            take(Place::Multiplier(b), Column::Previous(node), block.as_slice());
        }
    });
}
