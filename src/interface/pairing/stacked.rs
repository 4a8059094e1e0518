//! Which mortar facets lie over each other, of a mortar surface in layers: of two that a non-mortar facet comes over within a
//! step, it may be a pair with the nearer one alone. Points of a facet decide, since it is hidden as a whole or not.

use super::filter::{FacetFilter, LEAST_OPPOSITION};
use super::prism::Prism;
use super::search::Tree;
use crate::error::Result;
use crate::geometry::Over;
use crate::interface::data::surface::NO_FACET;
use crate::memory::{self, Store};

/// Facets closer than this, over the size of the smaller one, lie on each other: rounding of a rotated mesh is 1e-16 of
/// its extent.
pub const TOGETHER: f64 = 1e-8;

/// Per mortar facet two others, one in front and one behind: the one that lies over most of it, of those that look the same way,
/// where these lie over more than half of its points; else `NO_FACET`. A point is halfway from the middle to a corner. A search
/// over the surface, and linear in what it finds.
pub fn stacked(filter: &FacetFilter, tree: &Tree) -> Result<Vec<[u32; 2]>> {
    let two = &filter.sides[1];
    let (mut stacked, mut found) = (memory::with_room(two.facets.len())?, Vec::new());
    for (j, (facet, plane)) in two.facets.iter().enumerate() {
        tree.find(&Prism::over(facet.points(), plane, 0.0), &mut found)?;
        let middle = plane.reference + plane.origin;
        let (mut covered, mut most, mut others) = ([0_u32; 2], [0; 2], [NO_FACET; 2]);
        for &k in found.iter().filter(|&&k| k != j && two.facets[k].1.e.dot(&plane.e) > LEAST_OPPOSITION) {
            let (over, least) = (Over::new(&two.facets[k].0, plane), TOGETHER * two.edges[j].min(two.edges[k]));
            let mut points = [0; 2];
            for (place, corner) in facet.points().iter().enumerate() {
                let height = over.height(0.5 * (middle + corner), plane).map_or(0.0, |(height, _)| height);
                points[0] |= u32::from(height < -least) << place;
                points[1] |= u32::from(height > least) << place;
            }
            for side in 0..2 {
                covered[side] |= points[side];
                if points[side].count_ones() > most[side] {
                    (others[side], most[side]) = (k as u32, points[side].count_ones());
                }
            }
        }
        let is_covered = |side: usize| 2 * covered[side].count_ones() as usize > facet.points().len();
        stacked.store([0, 1].map(|side| if is_covered(side) { others[side] } else { NO_FACET }))?;
    }
    Ok(stacked)
}
