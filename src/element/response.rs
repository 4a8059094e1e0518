//! What pairs and facets must know of the answers of their nodes: N multipliers a node, D components of a position.

use crate::shape::MAX_CORNERS;
use nalgebra::{SMatrix, SVector};

/// What a pair must know of a node's response: N multipliers at the node, D components of a position.
#[derive(Clone, Copy, Debug)]
pub struct NodeTangent<const N: usize = 3, const D: usize = 3> {
    /// The traction its forces use [F/L^2].
    pub traction: SVector<f64, D>,
    /// dc/dg_now times the row scale.
    pub drow_dnow: SMatrix<f64, N, D>,
    /// dc/dg_previous times the row scale.
    pub drow_dprevious: SMatrix<f64, N, D>,
    /// dc/dm by the covered area, times the row scale.
    pub drow_darea: SVector<f64, N>,
}

impl<const N: usize, const D: usize> Default for NodeTangent<N, D> {
    fn default() -> Self {
        NodeTangent {
            traction: SVector::zeros(),
            drow_dnow: SMatrix::zeros(),
            drow_dprevious: SMatrix::zeros(),
            drow_darea: SVector::zeros(),
        }
    }
}

/// drow / dg of the four multipliers of a facet: component of the row, component of the gap, node.
type Rows<const N: usize> = [[[f64; MAX_CORNERS]; 3]; N];

/// The responses of a facet's nodes, component by component.
#[derive(Clone, Debug)]
pub struct FacetResponse<const N: usize = 3> {
    /// `traction[i][A]`.
    pub traction: [[f64; MAX_CORNERS]; 3],
    pub(super) now: Rows<N>,
    pub(super) previous: Rows<N>,
    /// `area[n][A]`.
    pub(super) area: [[f64; MAX_CORNERS]; N],
}

impl<const N: usize> FacetResponse<N> {
    /// Of these nodes; what a facet has no node for has no effect.
    pub fn new(nodes: [&NodeTangent<N>; MAX_CORNERS]) -> FacetResponse<N> {
        let mut f = FacetResponse {
            traction: [[0.0; MAX_CORNERS]; 3],
            now: [[[0.0; MAX_CORNERS]; 3]; N],
            previous: [[[0.0; MAX_CORNERS]; 3]; N],
            area: [[0.0; MAX_CORNERS]; N],
        };
        for (a, node) in nodes.into_iter().enumerate() {
            (0..N).for_each(|n| f.area[n][a] = node.drow_darea[n]);
            for j in 0..3 {
                f.traction[j][a] = node.traction[j];
                for n in 0..N {
                    f.now[n][j][a] = node.drow_dnow[(n, j)];
                    f.previous[n][j][a] = node.drow_dprevious[(n, j)];
                }
            }
        }
        f
    }
}
