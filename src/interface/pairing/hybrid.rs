//! Which non-mortar facets are integrated over overlaps and which by points, where a host asks for both. Settled at a
//! commit: a facet at the rim of the mortar surface would change its rule with every rounding, and Newton's method not
//! converge.

use super::candidates::candidates;
use super::filter::FacetFilter;
use super::search::Tree;
use crate::error::Result;
use crate::geometry::Vec3;
use crate::interface::data::options::{Options, Scheme};
use crate::interface::data::surface::{Surface, frames};
use crate::memory::{self, Stored};
use crate::mortar::{CellPoints, Segment};

/// Per non-mortar facet whether a point or a corner of it lies on no mortar facet at (x1, x2); nothing where the scheme
/// is one and the same for all facets.
pub fn partly_covered(
    (one, two): (&Surface, &Surface),
    options: &Options,
    filter: &FacetFilter,
    (x1, x2): (&[Vec3], &[Vec3]),
    tree: &Tree,
) -> Result<Vec<bool>> {
    let Scheme::Hybrid(line) = options.scheme else { return Ok(Vec::new()) };
    let frames = frames(one, x1)?;
    let pairs = candidates((one, two), options, &frames, (x1, x2), (tree, filter), 0.0, &mut 0)?;
    let mut covered = memory::filled(0, frames.len())?;
    for (i, j) in pairs {
        let segment = Segment::of_points(&frames[i], &two.facet(j, x2), line).map_err(two.at(j))?;
        covered[i] |= segment.and_then(|s| s.points).map_or(0, |points| points.inside);
    }
    covered.iter().zip(&frames).map(|(covered, frame)| *covered != CellPoints::all(frame, line)).stored()
}
