//! What of an interface's surfaces does not go with everything.

use super::surface::{NO_EQUATION, Surface};
use crate::interface::compose::{Feature, Features};
use crate::mortar::MultiplierSpace;

/// The features of both sides, non-mortar first, with multipliers where the options say.
#[inline(never)]
pub fn of_surfaces([one, two]: [&Surface; 2], space: MultiplierSpace) -> Features {
    let has_lines = one.lines().is_some();
    let has_parents = one.parents.is_some() || two.parents.is_some();
    let (mid1, mid2) = (one.has_mid_nodes(), two.has_mid_nodes());
    Features::which(&[
        (Feature::Lines, has_lines),
        (Feature::Quadratic, has_parents && !has_lines),
        (Feature::MidNodes, mid1 || mid2),
        (Feature::AllNodes, space == MultiplierSpace::Sub && (has_lines || mid1)),
        (Feature::Analytic, two.analytic.is_some()),
        (Feature::MovingFrame, frame_moves(two)),
    ])
}

/// Whether it is an analytic surface whose frame has equations.
pub fn frame_moves(mortar: &Surface) -> bool {
    mortar.analytic.is_some() && mortar.equations.iter().flatten().any(|&e| e != NO_EQUATION)
}

impl Surface {
    /// Whether it has facets with nodes that are no corners.
    pub fn has_mid_nodes(&self) -> bool {
        let is_line = self.lines().is_some();
        self.parents.iter().flat_map(|parents| &parents.facets).any(|facet| {
            let corners = if is_line { 2 } else { facet.parent.cell.n };
            facet.parent.n > corners
        })
    }
}
