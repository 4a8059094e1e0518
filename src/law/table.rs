//! The laws, a row each: what options, the C ABI, texts, counters and histories must know of them. A new law is a file
//! beside this one and a row here.

use super::coulomb::Coulomb;
use super::frictionless::Frictionless;
use super::node::{Law, Node, NodeResponse, Turn};
use super::orthotropic::Orthotropic;
use super::tied::Tied;
use super::told::ToldLaw;
use super::tresca::Tresca;
use super::violation::{Measure, Violation};

/// What happens along the surface. Its number, in the C ABI and in histories, is the place of its row.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Friction {
    /// Coulomb's law with mu.
    #[default]
    Coulomb,
    /// None: one multiplier per node, along the normal.
    None,
    /// Tied: neither opens nor slips.
    Tied,
    /// Rough: opens and closes, never slips.
    Rough,
    /// Coulomb's law with mu up to a limit of the shear traction.
    Tresca,
}

/// Where a law has its coefficient from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Coefficient {
    /// From the host, node by node.
    Given,
    /// It is always this.
    Always(f64),
}

/// What a law remembers of a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Remembers {
    /// Slip, and what it is measured from: gaps and weights of t_n.
    Slip,
    /// The gap of the first configuration.
    FirstGap,
    /// Nothing.
    Nothing,
}

/// A law for nodes with N multipliers.
#[derive(Clone, Copy, Debug)]
pub struct LawFunctions<const N: usize> {
    /// Whether it looks at slip, and so at the weights and gaps of t_n.
    pub slips: bool,
    /// Its answer for one node.
    pub respond: fn(&Node<N>) -> NodeResponse<N>,
    /// How that answer turns with the normal.
    pub turn: fn(&Node<N>) -> Turn<N>,
    /// A covered node's distance from equilibrium.
    pub violation: fn(&Node<N>, &Measure) -> Violation,
}

impl<const N: usize> LawFunctions<N> {
    const fn of<L: Law<N>>() -> LawFunctions<N> {
        LawFunctions { slips: L::SLIPS, respond: L::respond, turn: L::turn, violation: L::violation }
    }
}

impl LawFunctions<1> {
    /// Without friction.
    pub const FRICTIONLESS: LawFunctions<1> = LawFunctions::of::<Frictionless>();
}

impl LawFunctions<3> {
    /// Without friction.
    pub const FRICTIONLESS: LawFunctions<3> = LawFunctions::of::<Frictionless>();
    /// Under a threshold that the node has been told.
    pub const TOLD: LawFunctions<3> = LawFunctions::of::<ToldLaw>();
    /// Under the ellipse that the node has been given.
    pub const ORTHOTROPIC: LawFunctions<3> = LawFunctions::of::<Orthotropic>();
}

/// What the rest of the library knows of a law.
#[derive(Clone, Copy, Debug)]
pub struct LawRow {
    /// Which law it is.
    pub friction: Friction,
    /// Its name in sentences.
    pub name: &'static str,
    /// What it computes, for a host's log; the coefficients follow where they are given.
    pub effect: &'static str,
    /// Whether surfaces come apart. Those that do not keep the weights of the first configuration.
    pub opens: bool,
    /// Multipliers a node.
    pub multipliers: usize,
    /// mu.
    pub mu: Coefficient,
    /// Whether it needs a shear limit; the others refuse one.
    pub limits_shear: bool,
    /// What it remembers.
    pub remembers: Remembers,
    /// With three multipliers a node.
    pub functions: LawFunctions<3>,
}

/// In the order of [`Friction`].
pub static LAWS: [LawRow; 5] = [
    LawRow {
        friction: Friction::Coulomb,
        name: "Coulomb's law",
        effect: "Coulomb's law with mu",
        opens: true,
        multipliers: 3,
        mu: Coefficient::Given,
        limits_shear: false,
        remembers: Remembers::Slip,
        functions: LawFunctions::of::<Coulomb>(),
    },
    LawRow {
        friction: Friction::None,
        name: "no friction",
        effect: "none (asked for), no slip and no slip history",
        opens: true,
        multipliers: 1,
        mu: Coefficient::Always(0.0),
        limits_shear: false,
        remembers: Remembers::Nothing,
        functions: LawFunctions::<3>::FRICTIONLESS,
    },
    LawRow {
        friction: Friction::Tied,
        name: "tied surfaces",
        effect: "tied (asked for), neither opens nor slips, linear where closed, an open gap turns with its facets",
        opens: false,
        multipliers: 3,
        mu: Coefficient::Always(0.0),
        limits_shear: false,
        remembers: Remembers::FirstGap,
        functions: LawFunctions::of::<Tied>(),
    },
    LawRow {
        friction: Friction::Rough,
        name: "rough surfaces",
        effect: "rough (asked for), opens and closes, never slips",
        opens: true,
        multipliers: 3,
        mu: Coefficient::Always(f64::INFINITY),
        limits_shear: false,
        remembers: Remembers::Slip,
        functions: LawFunctions::of::<Coulomb>(),
    },
    LawRow {
        friction: Friction::Tresca,
        name: "Coulomb's law with a shear limit",
        effect: "Coulomb's law up to a shear limit, with mu",
        opens: true,
        multipliers: 3,
        mu: Coefficient::Given,
        limits_shear: true,
        remembers: Remembers::Slip,
        functions: LawFunctions::of::<Tresca>(),
    },
];

impl LawRow {
    /// What a shear limit must be, if this one is not allowed.
    pub fn refuses(&self, shear_limit: Option<f64>) -> Option<&'static str> {
        match (self.limits_shear, shear_limit) {
            (true, Some(limit)) if limit > 0.0 && limit.is_finite() => None,
            (true, _) => Some("positive and finite with this law"),
            (false, Some(_)) => Some("0 with a law that has no such limit"),
            (false, None) => None,
        }
    }
}

impl Friction {
    /// Its row.
    pub fn law(self) -> &'static LawRow {
        &LAWS[self as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_stand_in_the_order_of_the_laws() {
        for (k, row) in LAWS.iter().enumerate() {
            assert_eq!((row.friction as usize, row.friction.law().name), (k, row.name));
            assert_eq!(row.functions.slips, row.remembers == Remembers::Slip, "{}", row.name);
            assert!(row.multipliers == 3 || row.mu == Coefficient::Always(0.0), "{}", row.name);
        }
    }
}
