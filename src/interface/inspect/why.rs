//! Why no facet has a pair: what mistake that looks like.

use crate::error::Result;
use crate::geometry::{AnalyticSurface, Plane, Vec3};
use crate::interface::data::options::Options;
use crate::interface::data::surface::{Surface, frames};
use crate::interface::pairing::analytic;
use crate::interface::pairing::boxes::Aabb;
use crate::interface::pairing::filter::LEAST_OPPOSITION;
use crate::interface::pairing::prism::Prism;
use crate::interface::pairing::search::Tree;
use crate::memory::Stored;
use crate::mortar::Segment;

/// How the surfaces lie, where that looks like a mistake.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Finding {
    /// Nothing overlaps, or what does is in front of each other beyond the search distance, and nothing else is wrong.
    NoOverlap,
    /// Facets lie over each other, but all of them look the same way.
    SameWay,
    /// Opposing facets lie over each other, but deeper behind each other than a pair can.
    Behind,
    /// The positions of one side are those that the other side had at first, node by node.
    Swapped,
    /// Both node orders look reversed: see `mistakes.rs`.
    InsideOut,
}

/// Looks at all facets that lie over each other, whichever way they look and however deep. Where some look at each other and
/// are in front of each other, the surfaces are no more than apart.
pub fn why_nothing_overlaps(
    (one, two): (&Surface, &Surface),
    options: &Options,
    (x1, x2): (&[Vec3], &[Vec3]),
) -> Result<Finding> {
    if two.analytic.is_some() {
        return why_none_faces(one, &two.analytic_at(x2)?, options, x1);
    }
    let facet_box = |f: usize| Aabb::around(two.facet(f, x2).points().iter().copied());
    let tree = Tree::new((0..two.facets.len()).map(facet_box).stored()?)?;
    let (mut found, mut finding) = (Vec::new(), Finding::NoOverlap);
    for (i, frame) in frames(one, x1)?.iter().enumerate() {
        tree.find(&Prism::over(one.facet(i, x1).points(), &frame.plane, 0.0), &mut found)?;
        for &j in &found {
            let facet = two.facet(j, x2);
            let opposition = -frame.plane.e.dot(&Plane::of(&facet)?.e);
            // A facet that cannot be projected lies over none.
            let lies_over = || Segment::new(frame, &facet).is_ok_and(|s| s.is_some_and(|s| s.area > 0.0));
            if opposition.abs() > LEAST_OPPOSITION && lies_over() {
                let height = |x: &Vec3| frame.plane.e.dot(&(x - frame.plane.reference - frame.plane.origin));
                if opposition > 0.0 && facet.points().iter().any(|x| height(x) > 0.0) {
                    return Ok(Finding::NoOverlap);
                }
                finding = worse(finding, opposition);
            }
        }
    }
    Ok(finding)
}

/// With two facets more that lie over each other, of such an opposition.
fn worse(finding: Finding, opposition: f64) -> Finding {
    if opposition > 0.0 || finding == Finding::Behind { Finding::Behind } else { Finding::SameWay }
}

/// The same of an analytic side: a facet that looks at it is deeper in it than a pair can be; one that looks the same way is in
/// its body, or no farther from a surface that lies over it than it is long. One that is farther outside may turn.
fn why_none_faces(one: &Surface, surface: &AnalyticSurface, options: &Options, x1: &[Vec3]) -> Result<Finding> {
    let mut finding = Finding::NoOverlap;
    for f in 0..one.facets.len() {
        let facet = one.facet(f, x1);
        let plane = Plane::of(&facet).map_err(one.at(f))?;
        let distances = facet.points().iter().map(|x| surface.distance(x - surface.origin));
        let highest = distances.fold(f64::NEG_INFINITY, f64::max);
        let centre = plane.reference - surface.origin + plane.origin;
        let Some(closest) = surface.closest(centre) else { continue };
        let opposition = -plane.e.dot(&closest.normal);
        let is_near = opposition < 0.0 && surface.lies_over(centre, plane.e);
        let farthest = if is_near { facet.longest_edge() } else { 0.0 };
        if opposition > LEAST_OPPOSITION && highest >= 0.0 || analytic::faces_at(one, surface, options, x1, (f, 0.0))? {
            return Ok(Finding::NoOverlap);
        }
        if opposition.abs() > LEAST_OPPOSITION && highest < farthest {
            finding = worse(finding, opposition);
        }
    }
    Ok(finding)
}
