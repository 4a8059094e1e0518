//! The effects of an interface, resolved once: which law its nodes obey, what the mortar side is. Nothing below asks the
//! options for them again. The laws are rows of a table: `law/table.rs`.

use super::options::{MortarSide, Options};
use super::surface::{NO_EQUATION, Surface};
use crate::features;
use crate::law::{Coefficient, LawFunctions, Own};

/// What is opposite the non-mortar side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Opposite {
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
    /// The law.
    pub law: LawFunctions<N>,
    /// The mortar side.
    pub opposite: Opposite,
}

impl<const N: usize> Effects<N> {
    /// Whether the mortar side has rows and columns in the tangent.
    pub fn moves(&self) -> bool {
        self.opposite == Opposite::Moves
    }
}

/// Facets move when asked for, or because a node has an equation.
fn opposite(options: &Options, mortar: &Surface) -> Opposite {
    let prescribed = || mortar.equations.iter().flatten().all(|&e| e == NO_EQUATION);
    if mortar.analytic.is_some() {
        Opposite::Analytic
    } else if options.mortar_side == MortarSide::Rigid || (options.shortcuts.rigid && prescribed()) {
        Opposite::Rests
    } else {
        Opposite::Moves
    }
}

impl Effects<1> {
    /// One multiplier a node: without friction.
    pub fn of_one(options: &Options, mortar: &Surface) -> Effects<1> {
        Effects { law: LawFunctions::<1>::FRICTIONLESS, opposite: opposite(options, mortar) }
    }
}

impl Effects<3> {
    /// Three multipliers a node; `mu` of every node; `own`: the host's law; `slips`: whether anything else asks for slip.
    pub fn of_three(options: &Options, mortar: &Surface, mu: &[f64], own: Option<&Own>, slips: bool) -> Effects<3> {
        let row = options.friction.law();
        let smooth =
            !slips && row.mu == Coefficient::Given && options.shortcuts.frictionless && mu.iter().all(|&mu| mu == 0.0);
        let law = match own.filter(|_| features::LAWS.built) {
            Some(Own::Orthotropic(_)) if !smooth => LawFunctions::ORTHOTROPIC,
            None | Some(Own::Orthotropic(_)) if smooth => LawFunctions::<3>::FRICTIONLESS,
            Some(Own::Cohesion { .. } | Own::Weakening { .. } | Own::Rate { .. } | Own::Host(_)) => LawFunctions::TOLD,
            None | Some(Own::Orthotropic(_)) => row.functions,
        };
        Effects { law, opposite: opposite(options, mortar) }
    }
}
