//! Nodes whose normal leans away from an analytic mortar side: they touch nothing.

use crate::error::Result;
use crate::geometry::{AnalyticSurface, Vec3};
use crate::interface::data::setup::Setup;
use crate::interface::pairing::filter::LEAST_OPPOSITION;
use crate::interface::pairing::given::Given;
use crate::memory;

/// Which nodes have a normal that looks away from an analytic mortar side. A gap runs along the surface's normal n. At a sharp
/// edge one facet may face the surface while the averaged nu leans past the horizontal: nu . n < 0, and an open gap would read
/// as a penetration. Such a node touches nothing. At the positions that nu is of, of t_n or of now; and now, for the surface may
/// have gone past a node within the step, and where nu and n look the same way its gap reads as a penetration, however far off it is.
pub struct LookingAway<'a, const N: usize> {
    given: Given<'a, N>,
    surfaces: [AnalyticSurface; 2],
    x1: [&'a [Vec3]; 2],
}

impl<'a, const N: usize> LookingAway<'a, N> {
    /// At x; `None` where no node does: from a meshed mortar side, and where all is tied.
    pub fn at(given: Given<'a, N>, (x1, x2): (&'a [Vec3], &'a [Vec3])) -> Result<Option<LookingAway<'a, N>>> {
        let Setup { mortar, options, .. } = given.setup;
        if mortar.analytic.is_none() || !options.friction.law().opens {
            return Ok(None);
        }
        let (h, follows) = (given.history(), given.step.now.is_some());
        let of_normals = if follows { (x1, x2) } else { (&h.x1[..], &h.x2[..]) };
        let surfaces = [mortar.analytic_at(of_normals.1)?, mortar.analytic_at(x2)?];
        Ok(Some(LookingAway { given, surfaces, x1: [of_normals.0, x1] }))
    }

    /// Whether node a does.
    pub fn is(&self, a: usize) -> Result<bool> {
        // A normal that is undefined, or a node on the axis, is refused where it is needed.
        let Some(nu) = memory::if_accepted(self.given.normal(a))? else { return Ok(false) };
        // Now it is enough that the gap is none: facets that are longer than the surface is round touch it beside their nodes.
        for (k, least) in [LEAST_OPPOSITION, 0.0].into_iter().enumerate() {
            let closest = self.surfaces[k].closest(self.x1[k][a] - self.surfaces[k].origin);
            if closest.is_some_and(|c| nu.dot(&c.normal) < least) {
                return Ok(true);
            }
        }
        Ok(false)
    }
}
