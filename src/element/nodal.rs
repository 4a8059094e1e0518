//! Gap, forces and tangent of a pair of facets as hosts have them: triangles, quadrilaterals and lines, linear or quadratic (paper
//! (11), (23), (29)-(31); docs/formulation 12.4, 13.4). They are sums over the nodes of both sides, for gaps of a quadratic pair
//! are not along a normal. D is the number of components of a position.

use super::response::NodeTangent;
use nalgebra::{SMatrix, SVector};

/// n_AB and n_AC, row A; W is the most nodes that a facet of the kind has.
pub type NodalWeights<'a, const W: usize> = [&'a [[f64; W]; W]; 2];

/// A pair's nodes and how many multipliers it has.
#[derive(Clone, Copy)]
pub struct NodalPair<'a, const D: usize> {
    /// Of the non-mortar facet.
    pub one: &'a [SVector<f64, D>],
    /// Of the mortar facet.
    pub two: &'a [SVector<f64, D>],
    /// Multipliers, at the first nodes of the non-mortar facet.
    pub multipliers: usize,
}

/// sum_A n_A t_A of the k-th column of n_AB or n_AC: its node's share of the tractions `[F]`.
#[inline]
pub fn column_force<const D: usize, const W: usize>(
    n: &[[f64; W]; W],
    traction: &[SVector<f64, D>],
    k: usize,
) -> SVector<f64, D> {
    traction.iter().zip(n).map(|(t, row)| t * row[k]).sum()
}

impl<const D: usize> NodalPair<'_, D> {
    /// Nodes, non-mortar ones first.
    pub fn n(&self) -> (usize, usize) {
        (self.one.len(), self.two.len())
    }

    /// Rows of blocks of its tangent: nodes and multipliers.
    pub fn size(&self) -> usize {
        self.one.len() + self.two.len() + self.multipliers
    }

    /// n_AB of a non-mortar node and - n_AC of a mortar one: what a traction at A does to the k-th node.
    fn weight<const W: usize>(&self, [ab, ac]: NodalWeights<W>, a: usize, k: usize) -> f64 {
        let n1 = self.one.len();
        if k < n1 { ab[a][k] } else { -ac[a][k - n1] }
    }

    /// The k-th node from the first one: sums of weights vanish, and so does a common offset.
    fn x(&self, k: usize) -> SVector<f64, D> {
        let n1 = self.one.len();
        let x = if k < n1 { self.one[k] } else { self.two[k - n1] };
        x - self.one[0]
    }

    /// g_A = sum_B n_AB x_B - sum_C n_AC x_C of every multiplier [L^3].
    pub fn gap<const W: usize>(&self, w: NodalWeights<W>) -> [SVector<f64, D>; W] {
        let (n1, n2) = self.n();
        let mut gap = [SVector::zeros(); W];
        for (a, gap) in gap.iter_mut().enumerate().take(self.multipliers) {
            *gap = (0..n1 + n2).map(|k| self.x(k) * self.weight(w, a, k)).sum();
        }
        gap
    }

    /// The force at the k-th of the pair's nodes `[F]` from the tractions of the multipliers [F/L^2], internal-force sign.
    pub fn force<const W: usize>(
        &self,
        [ab, ac]: NodalWeights<W>,
        traction: &[SVector<f64, D>],
        k: usize,
    ) -> SVector<f64, D> {
        let n1 = self.one.len();
        if k < n1 { column_force(ab, traction, k) } else { -column_force(ac, traction, k - n1) }
    }

    /// The exact tangent in the multiplier form: rows and columns of blocks are the pair's nodes, then the multipliers; those of
    /// multipliers with each other are left as they are. `now`: the weights of now, and their derivatives unless they are frozen;
    /// `previous`: those of t_n; `nodes`: of every multiplier; `blocks`: row by row, zeros before.
    pub fn tangent<const W: usize>(
        &self,
        now: Option<(NodalWeights<W>, Option<[&[f64]; 2]>)>,
        previous: Option<NodalWeights<W>>,
        nodes: &[NodeTangent<D, D>],
        blocks: &mut [SMatrix<f64, D, D>],
    ) {
        let ((n1, n2), size) = (self.n(), self.size());
        let n = n1 + n2;
        let (forces, gaps) = blocks.split_at_mut(n * size);
        for ((a, node), gaps) in nodes.iter().enumerate().zip(gaps.chunks_exact_mut(size)) {
            // Dg_A as far as the weights change: of node b n_AB, of a mortar one - n_AC.
            if let Some((_, Some([ab, ac]))) = now {
                for (b, forces) in forces.chunks_exact_mut(size).enumerate() {
                    let (of, column, columns, sign) = if b < n1 { (ab, b, n1, 1.0) } else { (ac, b - n1, n2, -1.0) };
                    let (x, traction) = (self.x(b) * sign, node.traction * sign);
                    let slopes = of[D * (a * columns + column) * n..][..D * n].chunks_exact(D);
                    for ((slope, force), gap) in slopes.zip(forces).zip(&mut *gaps) {
                        let slope = SVector::<f64, D>::from_column_slice(slope).transpose();
                        *force += traction * slope;
                        *gap += x * slope;
                    }
                }
            }
            for k in 0..n {
                let weight = |w: NodalWeights<W>| self.weight(w, a, k);
                let (own, before) = (now.map_or(0.0, |now| weight(now.0)), previous.map_or(0.0, weight));
                let diagonal = SMatrix::from_diagonal_element;
                forces[k * size + n + a] = diagonal(own);
                let gap = &mut gaps[k];
                *gap = node.drow_dnow * (*gap + diagonal(own)) + node.drow_dprevious * before;
            }
        }
    }
}
