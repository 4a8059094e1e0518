//! The effects of an interface, resolved once: which law its nodes obey, what the mortar side is. Nothing below asks the
//! options for them again.
//!
//! A new law is a file in `law` and a line here.

use super::options::{Friction, MortarSide, Options};
use super::surface::{NO_EQUATION, Surface};
use crate::law::{Coulomb, Frictionless, Law, Measure, Node, NodeResponse, Tied, Violation};

/// What the mortar side is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Facets with rows and columns in the tangent.
    Moves,
    /// Facets without.
    Rests,
    /// A surface in closed form.
    Analytic,
}

/// The effects of one interface, for N multiplier components a node.
#[derive(Clone, Copy, Debug)]
pub struct Effects<const N: usize> {
    /// Whether the law looks at slip, and so at the weights and gaps of t_n.
    pub slips: bool,
    /// The law.
    pub respond: fn(&Node<N>) -> NodeResponse<N>,
    /// A covered node's distance from equilibrium.
    pub violation: fn(&Node<N>, &Measure) -> Violation,
    /// The mortar side.
    pub side: Side,
}

impl<const N: usize> Effects<N> {
    fn of<L: Law<N>>(side: Side) -> Effects<N> {
        Effects { slips: L::SLIPS, respond: L::respond, violation: L::violation, side }
    }

    /// Whether the mortar side has rows and columns in the tangent.
    pub fn moves(&self) -> bool {
        self.side == Side::Moves
    }
}

/// Facets move when asked for, or because a node has an equation.
fn mortar_side(options: &Options, mortar: &Surface) -> Side {
    let prescribed = || mortar.equations.iter().flatten().all(|&e| e == NO_EQUATION);
    if mortar.analytic.is_some() {
        Side::Analytic
    } else if options.mortar_side == MortarSide::Rigid || (options.shortcuts.rigid && prescribed()) {
        Side::Rests
    } else {
        Side::Moves
    }
}

impl Effects<1> {
    /// One multiplier a node: without friction.
    pub fn of_one(options: &Options, mortar: &Surface) -> Effects<1> {
        Effects::of::<Frictionless>(mortar_side(options, mortar))
    }
}

impl Effects<3> {
    /// Three multipliers a node; `mu` of every node.
    pub fn of_three(options: &Options, mortar: &Surface, mu: &[f64]) -> Effects<3> {
        let side = mortar_side(options, mortar);
        let smooth = options.shortcuts.frictionless && mu.iter().all(|&mu| mu == 0.0);
        match options.friction {
            Friction::Tied => Effects::of::<Tied>(side),
            Friction::None => Effects::of::<Frictionless>(side),
            Friction::Coulomb if smooth => Effects::of::<Frictionless>(side),
            Friction::Coulomb | Friction::Rough => Effects::of::<Coulomb>(side),
        }
    }
}
