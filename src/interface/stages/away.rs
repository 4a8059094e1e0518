//! Nodes whose normal leans away from an analytic mortar side: they touch nothing.

use crate::error::Result;
use crate::geometry::Vec3;
use crate::interface::data::setup::Setup;
use crate::interface::pairing::filter::LEAST_OPPOSITION;
use crate::interface::pairing::given::Given;
use crate::memory::{self, Stored};

/// Per node, whether its normal looks away from an analytic mortar side; none does from a meshed one, nor where all
/// is tied. A gap runs along the surface's normal n. At a sharp edge one facet may face the surface while the averaged
/// nu leans past the horizontal: nu . n < 0, and an open gap would read as a penetration. Such a node touches nothing.
/// Of the positions that nu is of: of t_n alone, or of now.
pub fn looking_away<const N: usize>(given: Given<N>, (x1, x2): (&[Vec3], &[Vec3])) -> Result<Vec<bool>> {
    let Setup { mortar, options, .. } = given.setup;
    if mortar.analytic.is_none() || !options.friction.law().opens {
        return Ok(Vec::new());
    }
    let (h, follows) = (given.history(), given.step.now.is_some());
    let (x1, x2) = if follows { (x1, x2) } else { (&h.x1[..], &h.x2[..]) };
    let surface = mortar.analytic_at(x2)?;
    let away = |a: usize| {
        // A normal that is undefined, or a node on the axis, is refused where it is needed.
        let (Some(nu), Some(closest)) =
            (memory::if_accepted(given.normal(a))?, surface.closest(x1[a] - surface.origin))
        else {
            return Ok(false);
        };
        Ok(nu.dot(&closest.normal) < LEAST_OPPOSITION)
    };
    (0..given.nodes()).map(away).stored_if_ok()
}
