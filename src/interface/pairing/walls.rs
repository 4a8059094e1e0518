//! Which facets of a surface are the two sides of one wall. Where all faces of a thin plate are in the contact, the far side of
//! the plate lies behind the other body's far side by both thicknesses, which may be less than a facet is long: a pair may be
//! no deeper than a part of the thinner wall (`filter.rs`).
//!
//! Who is whose back is found once, in the first configuration: later what lies closest behind a facet may be the other body.

use super::filter::{TOUCHES, thickness};
use super::orientation::facet_box;
use super::prism::{Prism, Slab};
use super::search::Tree;
use crate::error::Result;
use crate::geometry::Plane;
use crate::interface::data::surface::{NO_FACET, Surface};
use crate::memory::{self, Stored};

/// The back of a facet looks the other way to within 45 degrees.
const OPPOSED: f64 = 0.7;

/// Per facet the nearest one of the surface that lies behind it and looks the other way, or `NO_FACET`; empty where the surface
/// has no such facets. `are_one`: whether two facets are of one body, where that is known. A search over the surface unless all
/// of it looks one way.
pub fn backs(surface: &Surface, are_one: &dyn Fn(usize, usize) -> bool) -> Result<Vec<u32>> {
    let x = &surface.reference;
    if surface.analytic.is_some() {
        return Ok(Vec::new());
    }
    let facet = |f: usize| surface.facet(f, x);
    // A facet that has no plane is refused where it is needed.
    let planes = (0..surface.facets.len()).map(|f| Plane::of(&facet(f))).stored_if_ok();
    let Some(planes) = memory::if_accepted(planes)? else { return Ok(Vec::new()) };
    let normals: Vec<_> = planes.iter().map(|plane| plane.e).stored()?;
    if !Tree::parts(&normals) {
        return Ok(Vec::new());
    }
    let tree = Tree::parted((0..planes.len()).map(|f| facet_box(&facet(f), None)).stored()?, &normals)?;
    let (mut backs, mut found) = (memory::filled(NO_FACET, planes.len())?, Vec::new());
    for (f, plane) in planes.iter().enumerate() {
        let high = plane.e.dot(&plane.origin);
        let behind = Slab { direction: plane.e, low: f64::NEG_INFINITY, high };
        let prism = Prism::over(facet(f).points(), plane, 0.0).within([behind]);
        tree.find(&prism, &mut found)?;
        prism.keep_near(surface, x, &mut found);
        let least = TOUCHES * facet(f).longest_edge();
        let opposed = found.iter().filter(|&&g| normals[g].dot(&plane.e) < -OPPOSED && are_one(f, g));
        let thick = opposed.map(|&g| (thickness(plane, &planes[g]), g)).filter(|(thickness, _)| *thickness > least);
        if let Some((_, g)) = thick.min_by(|a, b| a.0.total_cmp(&b.0)) {
            backs[f] = g as u32;
        }
    }
    Ok(if backs.iter().all(|back| *back == NO_FACET) { Vec::new() } else { backs })
}
