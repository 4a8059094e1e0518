//! Nodes whose normal leans away from an analytic mortar side: they touch nothing.

use crate::error::Result;
use crate::geometry::{AnalyticSurface, Vec3};
use crate::interface::data::setup::Setup;
use crate::interface::pairing::filter::LEAST_OPPOSITION;
use crate::interface::pairing::given::Given;
use crate::memory;

/// Which nodes have a normal that looks away from an analytic mortar side. A gap runs along the surface's normal n. At a sharp
/// edge one facet may face the surface while the averaged nu leans past the horizontal: nu . n < 0, and an open gap would read
/// as a penetration. Such a node touches nothing. Of the positions that nu is of: of t_n alone, or of now.
pub struct LookingAway<'a, const N: usize> {
    given: Given<'a, N>,
    surface: AnalyticSurface,
    x1: &'a [Vec3],
}

impl<'a, const N: usize> LookingAway<'a, N> {
    /// At x; `None` where no node does: from a meshed mortar side, and where all is tied.
    pub fn at(given: Given<'a, N>, (x1, x2): (&'a [Vec3], &'a [Vec3])) -> Result<Option<LookingAway<'a, N>>> {
        let Setup { mortar, options, .. } = given.setup;
        if mortar.analytic.is_none() || !options.friction.law().opens {
            return Ok(None);
        }
        let (h, follows) = (given.history(), given.step.now.is_some());
        let (x1, x2) = if follows { (x1, x2) } else { (&h.x1[..], &h.x2[..]) };
        Ok(Some(LookingAway { given, surface: mortar.analytic_at(x2)?, x1 }))
    }

    /// Whether node a does.
    pub fn is(&self, a: usize) -> Result<bool> {
        // A normal that is undefined, or a node on the axis, is refused where it is needed.
        let (Some(nu), Some(closest)) =
            (memory::if_accepted(self.given.normal(a))?, self.surface.closest(self.x1[a] - self.surface.origin))
        else {
            return Ok(false);
        };
        Ok(nu.dot(&closest.normal) < LEAST_OPPOSITION)
    }
}
