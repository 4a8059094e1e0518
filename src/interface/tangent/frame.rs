//! Rows and columns of the points of an analytic surface's frame, where these have equations: those of a rigid body that is put
//! together by `rigid` (docs/formulation.md 14.5). With t_A the traction of node A's forces, f_C = - sum_A n_AC t_A:
//!
//! - rows of P_C: - n_AC Dt_A, - Dn_AC t_A by the facet's nodes and by the frame; where t_A turns with a normal of now, that part
//!   of Dt_A comes with what couples all pairs of a node (`augmented.rs`);
//! - rows of A, columns of P_D: (dc/dg_now) Dg_A / DP_D - (dc/dg_previous) n_AD(t_n).
//!
//! They belong to no facet alone: a frame has rows in common with all of them.

use super::emission::{Directions, Emitter, Place, Weights};
use super::union::{Pairs, UnionPair, Walk};
use crate::element::NodeTangent;
use crate::error::Result;
use crate::geometry::{AnalyticSurface, FRAME, Mat3, Vec3};
use crate::interface::data::active::Active;
use crate::interface::pairing::given::Given;
use crate::interface::pairing::overlaps::FacetOverlaps;
use crate::mortar::{FrameMotion, frame_motion};
use crate::quadrature::Rule;
use nalgebra::SMatrix;

/// What their numbers are made of.
#[derive(Clone, Copy)]
pub struct FrameNumbers<'a, const N: usize> {
    /// What forces and rows must know of each node.
    pub nodes: &'a [NodeTangent<N>],
    /// The pairs whose weights are differentiated; `None`: no weights are.
    pub active: Option<&'a Active>,
    /// The surface as it is now.
    pub surface: Option<&'a AnalyticSurface>,
    /// The rule of the weights.
    pub rule: &'static Rule,
}

/// All of them, without numbers for the pattern alone; nothing where the frame has no equations.
pub fn blocks<const N: usize>(
    (given, normals, all): (Given<N>, &[Vec3], Pairs),
    numbers: Option<FrameNumbers<N>>,
    (pairs, overlaps): (&mut Vec<UnionPair>, &mut FacetOverlaps),
    emitter: &mut Emitter<N>,
) -> Result<()> {
    if !given.setup.frame_moves() {
        return Ok(());
    }
    let first = given.setup.nonmortar.len();
    let point = |c: usize| Place::Displacement(first + given.setup.mortar.facets[0].nodes[c]);
    let mut walk = Walk::through(all, 0..usize::MAX);
    while let Some(f) = walk.next(pairs)? {
        let nodes = given.setup.nonmortar.facets[f].as_slice();
        let (now, previous) = (all.now(&pairs[0]), all.previous(&pairs[0]));
        let mut motion = FrameMotion::default();
        if let (Some(active), Some(numbers), true) =
            (numbers.and_then(|n| n.active), numbers, !UnionPair::places(pairs).is_empty())
        {
            overlaps.of(given, active, UnionPair::places(pairs))?;
            if let Some(surface) = numbers.surface {
                motion = frame_motion(overlaps.frame(), surface, numbers.rule)?;
            }
        } else if let Some(weights) = now {
            for (of_node, n) in motion.gap.iter_mut().zip(&weights.ac) {
                of_node.iter_mut().zip(n).for_each(|(gap, n)| *gap = Mat3::from_diagonal_element(-n));
            }
        }
        let mut nu: Directions = Default::default();
        nodes.iter().enumerate().for_each(|(k, &a)| nu[k] = normals[a]);
        let traction = |k: usize| numbers.map_or(Vec3::zeros(), |n| n.nodes[nodes[k]].traction);
        for c in 0..FRAME {
            let mut n: Weights = Default::default();
            (0..nodes.len()).for_each(|k| n[k] = now.map_or(0.0, |weights| -weights.ac[k][c]));
            for (k, &a) in nodes.iter().enumerate().filter(|(_, a)| given.setup.nodes.acts(**a)) {
                emitter.taker.multiplier_row(point(c), &[(k, Place::Multiplier(a))], &n, &nu);
            }
            let sum = |of: &dyn Fn(usize) -> Vec3| -> Mat3 {
                (0..nodes.len()).map(|k| traction(k) * -of(k).transpose()).sum()
            };
            for (k, &b) in nodes.iter().enumerate() {
                let block = sum(&|a| motion.by_nodes[a][c][k]);
                emitter.taker.node(point(c), Place::Displacement(b), block.as_slice());
            }
            for d in 0..FRAME {
                let block = sum(&|a| motion.by_frame[a][c][d]);
                emitter.taker.node(point(c), point(d), block.as_slice());
            }
        }
        for (k, &a) in nodes.iter().enumerate().filter(|(_, a)| given.setup.nodes.acts(**a)) {
            for d in 0..FRAME {
                let mut row = SMatrix::<f64, N, 3>::zeros();
                if let Some(numbers) = numbers {
                    let before = previous.map_or(0.0, |weights| weights.ac[k][d]);
                    row = numbers.nodes[a].drow_dnow * motion.gap[k][d] - numbers.nodes[a].drow_dprevious * before;
                }
                emitter.taker.node(Place::Multiplier(a), point(d), row.as_slice());
            }
        }
    }
    Ok(())
}
