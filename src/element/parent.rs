//! Gap, forces and tangent of a pair of facets as hosts have them, linear or quadratic (paper (11), (23), (29)-(31);
//! docs/formulation.md 12.4): with sums over the nodes of both sides, for gaps of a quadratic pair are not along a normal.

use super::tangent::NodeTangent;
use crate::geometry::{Mat3, Vec3};
use crate::mortar::{ParentFacet, ParentWeights};
use crate::shape::MAX_PARENT_NODES;

/// A pair's two facets and how many multipliers it has.
#[derive(Clone, Copy)]
pub struct ParentPair<'a> {
    /// Non-mortar facet.
    pub one: &'a ParentFacet,
    /// Mortar facet.
    pub two: &'a ParentFacet,
    /// Multipliers, at the first nodes of the non-mortar facet.
    pub multipliers: usize,
}

/// sum_A n_A t_A of the k-th column of n_AB or n_AC: its node's share of the tractions `[F]`.
pub fn parent_force(n: &[[f64; MAX_PARENT_NODES]; MAX_PARENT_NODES], traction: &[Vec3], k: usize) -> Vec3 {
    traction.iter().zip(n).map(|(t, row)| t * row[k]).sum()
}

impl ParentPair<'_> {
    /// Nodes, non-mortar ones first.
    pub fn n(&self) -> (usize, usize) {
        (self.one.parent.n, self.two.parent.n)
    }

    /// n_AB of a non-mortar node and - n_AC of a mortar one: what a traction at A does to the k-th node.
    fn weight(&self, w: &ParentWeights, a: usize, k: usize) -> f64 {
        let n1 = self.one.parent.n;
        if k < n1 { w.ab[a][k] } else { -w.ac[a][k - n1] }
    }

    /// The k-th node from the first one: sums of weights vanish, and so does a common offset.
    fn x(&self, k: usize) -> Vec3 {
        let n1 = self.one.parent.n;
        let x = if k < n1 { self.one.x[k] } else { self.two.x[k - n1] };
        x - self.one.x[0]
    }

    /// g_A = sum_B n_AB x_B - sum_C n_AC x_C of every multiplier [L^3].
    pub fn gap(&self, w: &ParentWeights) -> [Vec3; MAX_PARENT_NODES] {
        let (n1, n2) = self.n();
        let mut gap = [Vec3::zeros(); MAX_PARENT_NODES];
        for a in 0..self.multipliers {
            gap[a] = (0..n1 + n2).map(|k| self.x(k) * self.weight(w, a, k)).sum();
        }
        gap
    }

    /// Forces at the pair's nodes `[F]` from the tractions of the multipliers [F/L^2], internal-force sign.
    pub fn force(&self, w: &ParentWeights, traction: &[Vec3]) -> [Vec3; 2 * MAX_PARENT_NODES] {
        let (n1, n2) = self.n();
        let mut force = [Vec3::zeros(); 2 * MAX_PARENT_NODES];
        for (k, force) in force.iter_mut().enumerate().take(n1 + n2) {
            let n1 = self.one.parent.n;
            *force = if k < n1 { parent_force(&w.ab, traction, k) } else { -parent_force(&w.ac, traction, k - n1) };
        }
        force
    }

    /// Of the weights' derivative: + that of n_AB and - that of n_AC, for what a traction does to the b-th node, with respect
    /// to the k-th.
    fn slope(&self, [ab, ac]: [&[f64]; 2], a: usize, b: usize, k: usize) -> Vec3 {
        let (n1, n2) = self.n();
        let (of, column, columns, sign) = if b < n1 { (ab, b, n1, 1.0) } else { (ac, b - n1, n2, -1.0) };
        Vec3::from_column_slice(&of[3 * ((a * columns + column) * (n1 + n2) + k)..][..3]) * sign
    }

    /// The exact tangent in the multiplier form, block by block but those of multipliers with each other, which are zero: rows
    /// and columns are the pair's nodes, then the multipliers. `now`: the weights of now, and their derivatives unless they are
    /// frozen; `previous`: those of t_n; `nodes`: of every multiplier.
    pub fn tangent(
        &self,
        now: Option<(&ParentWeights, Option<[&[f64]; 2]>)>,
        previous: Option<&ParentWeights>,
        nodes: &[NodeTangent],
        mut give: impl FnMut(usize, usize, Mat3),
    ) {
        let n = self.one.parent.n + self.two.parent.n;
        let (weights, slopes) = (now.map(|now| now.0), now.and_then(|now| now.1));
        for (row, column) in (0..n).flat_map(|row| (0..n).map(move |column| (row, column))) {
            let mut block = Mat3::zeros();
            if let Some(slopes) = slopes {
                for (a, node) in nodes.iter().enumerate() {
                    block += node.traction * self.slope(slopes, a, row, column).transpose();
                }
            }
            give(row, column, block);
        }
        for (a, node) in nodes.iter().enumerate() {
            for k in 0..n {
                let weight = |w: &ParentWeights| Mat3::from_diagonal_element(self.weight(w, a, k));
                give(k, n + a, weights.map_or(Mat3::zeros(), weight));
                // Dg_A: the nodes carried along, and the weights' change.
                let mut gap = weights.map_or(Mat3::zeros(), weight);
                if let Some(slopes) = slopes {
                    gap += (0..n).map(|b| self.x(b) * self.slope(slopes, a, b, k).transpose()).sum::<Mat3>();
                }
                let before = previous.map_or(Mat3::zeros(), weight);
                give(n + a, k, node.drow_dnow * gap + node.drow_dprevious * before);
            }
        }
    }
}
