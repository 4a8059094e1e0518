//! The effects of an interface, resolved once: which law its nodes obey, whether the mortar side moves. Below this file
//! everything is compiled for one combination; nothing asks again.
//!
//! A new law is a file in `law` and a line here.

use super::assembly::Sink;
use super::nodes::NodeSums;
use super::{Contact, Friction, MortarSide, NO_EQUATION, Options, Surface};
use crate::error::Result;
use crate::geometry::Vec3;
use crate::law::{Coulomb, Frictionless, Law, Node, NodeResponse, Tied};
use nalgebra::{SMatrix, SVector};

type Tangent<const N: usize> =
    fn(&mut Contact<N>, &[Vec3], &[Vec3], &[SVector<f64, N>], Option<&[NodeSums]>, &mut dyn Sink) -> Result<()>;

/// The routines of one combination of effects, for N multiplier components a node.
#[derive(Clone, Copy, Debug)]
pub(super) struct Kernels<const N: usize> {
    /// Whether the law looks at slip, and so at the weights and gaps of t_n.
    pub slips: bool,
    /// Whether the mortar side has rows and columns in the tangent.
    pub moves: bool,
    /// The law.
    pub respond: fn(&Node<N>) -> NodeResponse<N>,
    /// Stages 3 and 4 of the tangent.
    pub tangent: Tangent<N>,
}

fn kernels<const N: usize, L: Law<N>>(moves: bool) -> Kernels<N> {
    let tangent = if moves { Contact::tangent_with::<true> } else { Contact::tangent_with::<false> };
    Kernels { slips: L::SLIPS, moves, respond: L::respond, tangent }
}

/// Whether the mortar side moves: asked for, or because one of its nodes has an equation.
fn mortar_moves(options: &Options, mortar: &Surface) -> bool {
    let prescribed = || mortar.equations.iter().flatten().all(|&e| e == NO_EQUATION);
    options.mortar_side == MortarSide::Deformable && !(options.shortcuts.rigid && prescribed())
}

/// One multiplier a node: without friction.
pub(super) fn choose_one(options: &Options, mortar: &Surface) -> Kernels<1> {
    kernels::<1, Frictionless>(mortar_moves(options, mortar))
}

/// Three multipliers a node; `mu` of every node.
pub(super) fn choose_three(options: &Options, mortar: &Surface, mu: &[f64]) -> Kernels<3> {
    let moves = mortar_moves(options, mortar);
    let smooth = options.shortcuts.frictionless && mu.iter().all(|&mu| mu == 0.0);
    match options.friction {
        Friction::Tied => kernels::<3, Tied>(moves),
        Friction::None => kernels::<3, Frictionless>(moves),
        Friction::Coulomb if smooth => kernels::<3, Frictionless>(moves),
        Friction::Coulomb | Friction::Rough => kernels::<3, Coulomb>(moves),
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
