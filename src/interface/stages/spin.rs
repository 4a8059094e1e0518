//! How far the sides have turned against each other about their normal within a step (docs/formulation 6.6). Slip is the chord of
//! the way that a point has gone. After a spin by theta it is theta / 2 off the direction in which the point moves now, and friction with
//! it: a moment of friction about the normal is cos(theta / 2) of what it must be. So where all slips, a moment below what friction can
//! give has a second equilibrium, in which the body has spun. A commit refuses a step with more than `turn_max`, whose cosine is that of
//! no more than 2 % with the default.
//!
//! What was opposite node A at t_n lies at x_A - s_A now, s_A its slip: where both sides' points have gone tells the spin. The slip of a node
//! is a mean over its facets, so that those at an edge show less, and the largest counts.

use crate::error::Result;
use crate::geometry::{Spin, Vec3};
use crate::interface::pairing::given::Given;
use crate::interface::stages::sums::NodeSums;
use crate::interface::stages::turn::too_far;
use crate::law::{NodeResponse, State};
use crate::shape::MAX_PARENT_NODES;

/// Nodes that tell a spin.
const ENOUGH: usize = 3;

/// Refuses a commit at `x1` where facets that touch with friction have spun by more than the option allows.
pub fn refuse_spin<const N: usize>(
    given: Given<N>,
    x1: &[Vec3],
    (sums, responses): (&[NodeSums], &[NodeResponse<N>]),
) -> Result<()> {
    let one = &given.setup.nonmortar;
    if !given.setup.effects.law.slips {
        return Ok(());
    }
    let touches = |a: &usize| responses[*a].state != State::Gap && sums[*a].coverage_previous > 0.0;
    let mut most = (0.0, 0);
    for f in 0..one.host_facets() {
        let nodes = one.host_nodes(f);
        if nodes.len() < ENOUGH || !nodes.iter().all(touches) {
            continue;
        }
        let (mut now, mut opposite) = ([Vec3::zeros(); MAX_PARENT_NODES], [Vec3::zeros(); MAX_PARENT_NODES]);
        let mut normal = Vec3::zeros();
        for (k, &a) in nodes.iter().enumerate() {
            (now[k], opposite[k]) = (x1[a], x1[a] - responses[a].slip / sums[a].coverage_previous);
            normal += given.normal(a)?;
        }
        let Some(normal) = normal.try_normalize(0.0) else { continue };
        let angle = Spin::of(&opposite[..nodes.len()], normal, &now[..nodes.len()], normal).angle();
        most = if angle > most.0 { (angle, f) } else { most };
    }
    let ((angle, f), options) = (most, &given.setup.options);
    if angle <= options.turn_max {
        return Ok(());
    }
    let what = text!("non-mortar facet {f}, about its normal and against the mortar side,");
    let since = ("since the last commit", "friction would act along the chord of that way; take smaller steps");
    Err(too_far(options, what, angle, since))
}
