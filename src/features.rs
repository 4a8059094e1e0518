//! What can be left out of the library when it is built, for a smaller one: cargo's features of the same names, all in by default.
//!
//! All functions and structs of the C ABI are there whatever is built. What needs a feature asks `needs!` first: it compares with
//! a constant, and behind its `return` nothing is compiled. A function that answers with a `Result` would not do: the compiler does not
//! see that what a refusal is made of is never what `Ok` is told by, and keeps all that follows.

use crate::error::{Error, Kind};

/// A part of the library that a build may lack.
#[derive(Clone, Copy, Debug)]
pub struct Feature {
    /// Its name among cargo's features.
    pub name: &'static str,
    /// Whether this build has it.
    pub built: bool,
}

/// Analytic mortar surfaces.
pub const ANALYTIC: Feature = Feature { name: "analytic", built: cfg!(feature = "analytic") };
/// Systems without multipliers.
pub const CONDENSED: Feature = Feature { name: "condensed", built: cfg!(feature = "condensed") };
/// Heat across the interface.
pub const HEAT: Feature = Feature { name: "heat", built: cfg!(feature = "heat") };
/// Laws in place of Coulomb's.
pub const LAWS: Feature = Feature { name: "laws", built: cfg!(feature = "laws") };
/// Lines of plane and axisymmetric models.
pub const LINES: Feature = Feature { name: "lines", built: cfg!(feature = "lines") };
/// Offsets of nodes.
pub const OFFSETS: Feature = Feature { name: "offsets", built: cfg!(feature = "offsets") };
/// Contact that is decided at points.
pub const POINTS: Feature = Feature { name: "points", built: cfg!(feature = "points") };
/// Quadratic facets of solids.
pub const QUADRATIC: Feature = Feature { name: "quadratic", built: cfg!(feature = "quadratic") };
/// Rigid bodies.
pub const RIGID: Feature = Feature { name: "rigid", built: cfg!(feature = "rigid") };
/// Derivatives by positions of t_n and by parameters.
pub const SENSITIVITY: Feature = Feature { name: "sensitivity", built: cfg!(feature = "sensitivity") };
/// General contact.
pub const SKIN: Feature = Feature { name: "skin", built: cfg!(feature = "skin") };
/// Facets of the host that have parts: quadratic ones and lines.
pub const PARTS: Feature = Feature { name: "quadratic or lines", built: QUADRATIC.built || LINES.built };

/// Refuses, in a function that gives a `Result`, what needs a feature that was left out.
macro_rules! needs {
    ($feature:ident) => {
        if !crate::features::$feature.built {
            return Err(crate::features::$feature.left_out());
        }
    };
}
pub(crate) use needs;

impl Feature {
    /// Within what is not reached without the feature, for every way to it is refused: nothing behind this is compiled then.
    #[inline(always)]
    pub fn is_here(self) {
        assert!(self.built, "reached without the feature `{}`", self.name);
    }

    /// The refusal of what needs a feature that was left out: [`Kind::Unsupported`].
    #[cold]
    pub fn left_out(self) -> Error {
        let name = self.name;
        let text = text!(
            "this library was built without {name}: build it with all features, or with `{name}` among cargo's --features or in STICKSLIP_FEATURES of CMake"
        );
        Error::new(Kind::Unsupported, text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_out_is_refused_by_name() {
        let refusal = Feature { name: "heat", built: false }.left_out();
        assert_eq!(refusal.kind, Kind::Unsupported);
        assert!(refusal.message.contains("built without heat") && refusal.message.contains("STICKSLIP_FEATURES"));
    }
}
