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
/// have gone past a node within the step: the gap is 0 where nu is across n, however far off the surface is. There a node in the
/// surface's body looks away only where it looks the same way.
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
        let [then, now] = [0, 1].map(|k| {
            let closest = self.surfaces[k].closest(self.x1[k][a] - self.surfaces[k].origin);
            closest.map(|c| (nu.dot(&c.normal), c.distance))
        });
        let is_away = |(along, distance): (f64, f64), in_body: f64| along < if distance > 0.0 { LEAST_OPPOSITION } else { in_body };
        Ok(then.is_some_and(|then| is_away(then, LEAST_OPPOSITION)) || now.is_some_and(|now| is_away(now, 0.0)))
    }
}
