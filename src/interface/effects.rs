//! The effects of an interface, resolved once: which law its nodes obey, what the mortar side is. Below this file
//! everything is compiled for one combination; nothing asks again.
//!
//! A new law is a file in `law` and a line here.

use super::emission::Sink;
use super::history::PairRecord;
use super::nodes::NodeSums;
use super::{Contact, Friction, MortarSide, NO_EQUATION, Options, Surface, Tangent, analytic, integration};
use crate::error::Result;
use crate::geometry::{AnalyticSurface, Vec3};
use crate::law::{Coulomb, Frictionless, Law, Measure, Node, NodeResponse, Tied, Violation};
use crate::mortar::{ForceDerivatives, GapDerivative, NonmortarFrame, Segment};
use crate::quadrature::Rule;
use crate::shape::MAX_NODES;
use nalgebra::{SMatrix, SVector};

type Assembly<const N: usize> =
    fn(&mut Contact<N>, &[Vec3], &[Vec3], &[SVector<f64, N>], Option<&[NodeSums]>, &mut dyn Sink) -> Result<()>;

/// Derivatives of pairs with their weights of now: the mortar surface where it is analytic, the non-mortar facet's frame,
/// its pairs and their overlaps (none against an analytic surface), the rule, the tractions `[i][A]` of its forces. One pair where
/// the mortar side moves; all of the facet's together where it rests. The derivatives of the forces go to the last
/// argument, which keeps the slots that have none; those of the gap come back.
pub(super) type Motion = fn(
    Option<&AnalyticSurface>,
    &NonmortarFrame,
    (&[PairRecord], &[Segment]),
    &Rule,
    &[[f64; MAX_NODES]; 3],
    &mut ForceDerivatives,
) -> Result<GapDerivative>;

/// The routines of one combination of effects, for N multiplier components a node.
#[derive(Clone, Copy, Debug)]
pub(super) struct Kernels<const N: usize> {
    /// Whether the law looks at slip, and so at the weights and gaps of t_n.
    pub slips: bool,
    /// Whether the mortar side has rows and columns in the tangent.
    pub moves: bool,
    /// The law.
    pub respond: fn(&Node<N>) -> NodeResponse<N>,
    /// A covered node's distance from equilibrium.
    pub violation: fn(&Node<N>, &Measure) -> Violation,
    /// Stages 3 and 4 of the tangent.
    pub tangent: Assembly<N>,
    /// Derivatives of pairs.
    pub motion: Motion,
}

/// What the mortar side is.
enum Side {
    Moves,
    Rests,
    Analytic,
}

fn kernels<const N: usize, L: Law<N>>((side, derivatives): (Side, Tangent)) -> Kernels<N> {
    let moves = matches!(side, Side::Moves);
    let tangent = if moves { Contact::tangent_with::<true> } else { Contact::tangent_with::<false> };
    let motion = match (side, derivatives == Tangent::FrozenNormals) {
        (Side::Moves, false) => integration::motion,
        (Side::Moves, true) => integration::without_tilt::<true>,
        (Side::Rests, false) => integration::motion_at_rest,
        (Side::Rests, true) => integration::without_tilt::<false>,
        (Side::Analytic, _) => analytic::motion,
    };
    Kernels { slips: L::SLIPS, moves, respond: L::respond, violation: L::violation, tangent, motion }
}

/// Facets move when asked for, or because a node has an equation. With what the tangent is to know.
fn mortar_side(options: &Options, mortar: &Surface) -> (Side, Tangent) {
    let prescribed = || mortar.equations.iter().flatten().all(|&e| e == NO_EQUATION);
    let side = if mortar.analytic.is_some() {
        Side::Analytic
    } else if options.mortar_side == MortarSide::Rigid || (options.shortcuts.rigid && prescribed()) {
        Side::Rests
    } else {
        Side::Moves
    };
    (side, options.tangent)
}

/// One multiplier a node: without friction.
pub(super) fn choose_one(options: &Options, mortar: &Surface) -> Kernels<1> {
    kernels::<1, Frictionless>(mortar_side(options, mortar))
}

/// Three multipliers a node; `mu` of every node.
pub(super) fn choose_three(options: &Options, mortar: &Surface, mu: &[f64]) -> Kernels<3> {
    let side = mortar_side(options, mortar);
    let smooth = options.shortcuts.frictionless && mu.iter().all(|&mu| mu == 0.0);
    match options.friction {
        Friction::Tied => kernels::<3, Tied>(side),
        Friction::None => kernels::<3, Frictionless>(side),
        Friction::Coulomb if smooth => kernels::<3, Frictionless>(side),
        Friction::Coulomb | Friction::Rough => kernels::<3, Coulomb>(side),
    }
}

/// A unit multiplier along the normal: nu, or 1 where the only component is along the normal.
pub(super) fn along_normal<const N: usize>(nu: Vec3) -> SVector<f64, N> {
    SVector::from_fn(|i, _| if N == 1 { 1.0 } else { nu[i] })
}

/// The traction of a multiplier: lambda, or lambda nu where it is the component along the normal.
pub(super) fn traction<const N: usize>(lambda: &SVector<f64, N>, nu: Vec3) -> Vec3 {
    if N == 1 { nu * lambda[0] } else { Vec3::from_fn(|i, _| lambda[i]) }
}

/// d traction / d lambda: I, or nu where there is one component.
pub(super) fn basis<const N: usize>(nu: Vec3) -> SMatrix<f64, 3, N> {
    SMatrix::from_fn(|i, j| if N == 1 { nu[i] } else { f64::from(u8::from(i == j)) })
}
