//! How slip follows the positions of t_n: through the weights n(x_n) of the gap g[n_n, x_{n+1}] that it is measured from, and, as an
//! increment, through the gap g[n_n, x_n] that it is counted from (docs/formulation 18.1).

use super::{At, Column, Take};
use crate::geometry::Mat3;
use crate::interface::data::active::Active;
use crate::interface::weights::facet::FacetWeights;

/// Gives what the row of every node has of a gap that is counted from that at t_n.
pub fn through_gaps(at: &At, take: &mut Take) {
    let Some(committed) = at.slip.filter(|committed| *committed != 0.0) else { return };
    for (a, weights) in at.weights.iter().enumerate() {
        for weight in weights {
            gap(at, a, weight.node, Mat3::from_diagonal_element(-committed * weight.before), take);
        }
    }
}

/// What rows have of the weights of one facet, of these pairs at t_n.
pub fn through_weights(at: &At, (active, facet): (&Active, &FacetWeights), take: &mut Take) {
    let Some(committed) = at.slip else { return };
    let (n1, [x1, x2], n) = (at.x[0].len(), at.x, facet.nodes.len());
    let now = |node: usize| if node < n1 { x1[node] } else { x2[node - n1] };
    let before = |node: usize| if node < n1 { active.x1[node] } else { active.x2[node - n1] };
    for (&a, slopes) in facet.nodes.iter().zip(facet.slopes.chunks_exact(n * n)) {
        // Weights of one row add up to nothing: differences are as good, and do not round where the origin is far away.
        let moved = |node: usize| now(node) - now(a) - (before(node) - before(a)) * committed;
        for (c, &column) in facet.nodes.iter().enumerate() {
            let add = |sum: Mat3, (k, &node): (usize, &usize)| sum + moved(node) * slopes[k * n + c].transpose();
            let by = facet.nodes.iter().enumerate().fold(Mat3::zeros(), add);
            gap(at, a, column, by, take);
        }
    }
}

/// The derivative of A's gap by one node's position, in the rows where it counts.
fn gap(at: &At, a: usize, node: usize, by: Mat3, take: &mut Take) {
    at.by_gap(a, &mut |b, [_, previous]| at.put(b, Column::Previous(node), &(previous * by), take));
}
