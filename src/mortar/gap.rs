//! The weighted gap of a pair (paper (11)), g_A = sum_B n_AB x_B - sum_C n_AC x_C [L^3], and its
//! derivative.
//!
//! With the pair's own current weights g_A lies along the plane's normal, g_A = gamma_A e, because both
//! inverse maps return the same in-plane point; so Dg_A = e Dgamma_A + gamma_A De: one scalar row a
//! node, without cancellation of in-plane coordinates (docs/formulation 2.4).

use super::chain::{AreaDerivatives, Chain, Columns, WeightDerivatives};
use super::pair_weights::PairWeights;
use super::segment::NonmortarFrame;
use super::slots::{MORTAR, PAIR_NODES};
use super::transport::PlaneDerivatives;
use crate::geometry::{Facet, Projection, Vec3};
use crate::shape::{FacetKind, MAX_CORNERS, MAX_NODES, StandardMultipliers};
use crate::simd::{self, Kernel, Lanes, Plain};

/// Weighted gap of the pair's non-mortar nodes with any weights: those of now or those of t_n.
pub fn gap(weights: &PairWeights, one: &Facet, two: &Facet) -> [Vec3; MAX_CORNERS] {
    let g = simd::dispatch(Gap { weights, one, two });
    [0, 1, 2, 3].map(|a| Vec3::new(g[0][a], g[1][a], g[2][a]))
}

struct Gap<'a> {
    weights: &'a PairWeights,
    one: &'a Facet,
    two: &'a Facet,
}

impl Kernel for Gap<'_> {
    type Output = [[f64; MAX_CORNERS]; 3];
    #[inline(always)]
    fn run<L: Lanes>(self) -> [[f64; MAX_CORNERS]; 3] {
        const { assert!(MAX_NODES == MAX_CORNERS) }; // positions of the corners are those of the nodes B and C
        let Gap { weights, one, two } = self;
        // Relative to one node of the pair: legal because sum_B n_AB = sum_C n_AC, and exact under offsets.
        let reference = one.nodes[0];
        let (ab, ac) = (columns::<L>(&weights.ab), columns::<L>(&weights.ac));
        let mut g = [L::splat(0.0); 3];
        for k in 0..MAX_NODES {
            let (x1, x2) = (one.nodes[k] - reference, two.nodes[k] - reference);
            for i in 0..3 {
                g[i] = ab[k].mul_add(L::splat(x1[i]), g[i]) - ac[k] * L::splat(x2[i]);
            }
        }
        [g[0].store(), g[1].store(), g[2].store()]
    }
}

/// The columns of weights, lanes A.
#[inline(always)]
fn columns<L: Lanes>([a, b, c, d]: &[[f64; MAX_NODES]; MAX_CORNERS]) -> [L; MAX_NODES] {
    L::transpose([L::load(a), L::load(b), L::load(c), L::load(d)])
}

/// `[k][i][j]`, lanes A: d g_A,i / d x_k,j, k over the nodes of the non-mortar facet alone [L^2].
pub type GapBlocks = [[[[f64; MAX_CORNERS]; 3]; 3]; MAX_NODES];

/// Dg_A of two facets in factors: Dg_A = e Dgamma_A + gamma_A De.
#[derive(Clone, Debug)]
pub struct AlongNormal {
    /// e, the plane's normal, and its other two axes.
    pub e: Vec3,
    /// t1, t2.
    pub axes: [Vec3; 2],
    /// t_j . De = sum_k `tilt[j][k]` e . Dx_k [1/L].
    pub tilt: [[f64; MAX_CORNERS]; 2],
    /// gamma_A [L^3].
    pub gamma: [f64; MAX_CORNERS],
    /// `dgamma[k][j][A]` = d gamma_A / d x_k,j [L^2]; zero in mortar slots where that side does not move.
    pub dgamma: [[[f64; MAX_CORNERS]; 3]; PAIR_NODES],
}

impl AlongNormal {
    /// From Dn: with the pair's current weights and their derivatives; `two` is the mortar facet projected on the
    /// frame's plane.
    pub fn from_weights(
        frame: &NonmortarFrame,
        two: &Projection,
        weights: &PairWeights,
        derivatives: &WeightDerivatives,
    ) -> AlongNormal {
        let (plane, one) = (&frame.plane, &frame.projection);
        let mut dgamma = [[[0.0; MAX_CORNERS]; 3]; PAIR_NODES];
        for (k, j) in (0..PAIR_NODES).flat_map(|k| (0..3).map(move |j| (k, j))) {
            for a in 0..one.shape.n {
                for b in 0..one.shape.n {
                    dgamma[k][j][a] += derivatives.ab[a][b][k][j] * one.d[b];
                }
                for l in 0..two.shape.n {
                    dgamma[k][j][a] -= derivatives.ac[a][two.node[l]][k][j] * two.d[l];
                }
                let n = if k < MORTAR { weights.ab[a][k] } else { -weights.ac[a][k - MORTAR] };
                dgamma[k][j][a] += plane.e[j] * n;
            }
        }
        let (e, axes, tilt) = (plane.e, [plane.t1, plane.t2], plane.tilt);
        AlongNormal { e, axes, tilt, gamma: gamma::<Plain>(frame, two, weights), dgamma }
    }

    /// From `plane`, the derivatives of gamma_A at fixed heights.
    #[inline(always)]
    pub(super) fn new<L: Lanes, One: StandardMultipliers, Two: FacetKind>(
        chain: &Chain<L>,
        plane: &PlaneDerivatives<L>,
        weights: &PairWeights,
    ) -> AlongNormal {
        let frame_plane = &chain.frame.plane;
        let mut along = AlongNormal {
            e: frame_plane.e,
            axes: [frame_plane.t1, frame_plane.t2],
            tilt: frame_plane.tilt,
            gamma: gamma::<L>(chain.frame, &chain.segment.mortar, weights),
            dgamma: [[[0.0; MAX_CORNERS]; 3]; PAIR_NODES],
        };
        let mut to = Gaps {
            dgamma: &mut along.dgamma,
            heights: [L::splat(0.0); PAIR_NODES],
            e: [chain.axes[0][2], chain.axes[1][2], chain.axes[2][2]],
        };
        let ac = columns::<L>(&weights.ac);
        for k in 0..MAX_NODES {
            to.heights[k] = L::load(&weights.ab[k]); // n_AB is symmetric
            to.heights[MORTAR + k] = -ac[k];
        }
        chain.nodes::<One::Cell, Two::Cell>(plane, &mut to);
        along
    }
}

/// A mortar surface that is raised by the field sum_B N_B h_B, with h_B held fixed. Over it the gaps are
/// gamma_A - sum_B n_AB h_B, and their derivatives Dgamma_A - sum_B Dn_AB h_B. The stage of a facet with dual multipliers
/// asks for these, and for the derivatives of the covered areas (docs/formulation 10.4).
#[derive(Debug)]
pub struct Raised<'a> {
    /// h_B `[L]`.
    pub heights: &'a [f64; MAX_CORNERS],
    /// Takes Dm_A. Nodes that a triangle does not have are left as they are.
    pub areas: &'a mut AreaDerivatives,
}

/// The heights d_B of the facet's nodes, over a surface that is raised or not.
#[inline(always)]
pub(super) fn heights_over(frame: &NonmortarFrame, raised: &Option<Raised>) -> [f64; MAX_CORNERS] {
    let mut heights = frame.projection.d;
    if let Some(raised) = raised {
        for b in 0..MAX_CORNERS {
            heights[b] -= raised.heights[b];
        }
    }
    heights
}

/// gamma_A of a pair with its current weights (docs/formulation 2.4) [L^3]; `two` is the mortar facet projected on the
/// frame's plane.
pub fn height_gap(frame: &NonmortarFrame, two: &Projection, weights: &PairWeights) -> [f64; MAX_CORNERS] {
    simd::dispatch(HeightGap { frame, two, weights })
}

struct HeightGap<'a> {
    frame: &'a NonmortarFrame,
    two: &'a Projection,
    weights: &'a PairWeights,
}

impl Kernel for HeightGap<'_> {
    type Output = [f64; MAX_CORNERS];
    #[inline(always)]
    fn run<L: Lanes>(self) -> [f64; MAX_CORNERS] {
        gamma::<L>(self.frame, self.two, self.weights)
    }
}

struct Gaps<'a, L> {
    dgamma: &'a mut [[[f64; MAX_CORNERS]; 3]; PAIR_NODES],
    /// d gamma_A / d d_k, lanes A: n_AB, -n_AC.
    heights: [L; PAIR_NODES],
    e: [L; 3],
}

impl<L: Lanes> Columns<L> for Gaps<'_, L> {
    #[inline(always)]
    fn set(&mut self, k: usize, columns: [L; 3]) {
        for j in 0..3 {
            self.dgamma[k][j] = self.e[j].mul_add(self.heights[k], columns[j]).store();
        }
    }
}

/// gamma_A = sum_B n_AB d_B - sum_C n_AC d_C; the heights of nodes are those of corners.
#[inline(always)]
pub(super) fn gamma<L: Lanes>(frame: &NonmortarFrame, two: &Projection, weights: &PairWeights) -> [f64; MAX_CORNERS] {
    const { assert!(MAX_NODES == MAX_CORNERS) };
    let one = &frame.projection;
    let (ab, ac) = (columns::<L>(&weights.ab), columns::<L>(&weights.ac));
    let mut gamma = L::splat(0.0);
    for k in 0..MAX_NODES {
        gamma = ac[two.node[k] & 3].neg_mul_add(L::splat(two.d[k]), gamma); // so that no bounds are checked
        gamma = ab[k].mul_add(L::splat(one.d[k]), gamma);
    }
    gamma.store()
}
