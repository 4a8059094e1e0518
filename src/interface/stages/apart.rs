//! Surfaces that are apart: nothing is searched, integrated or linearised, and no node is covered.
//!
//! The answer must be that of a full evaluation: no node is closed. Let a plane lie between the sides. A gap vector runs
//! along the facet's normal e from one side to the other, so the gap is open where e points across the plane. Therefore
//! every facet that can have a pair must look at the other side now, and nu(t_n) of its nodes must point away from it.

use crate::error::Result;
use crate::geometry::Vec3;
use crate::interface::data::history::History;
use crate::interface::data::offsets;
use crate::interface::data::options::{Options, Weights};
use crate::interface::data::surface::Surface;
use crate::interface::pairing::analytic;
use crate::interface::pairing::boxes::Aabb;
use crate::interface::pairing::filter::Filter;
use crate::interface::pairing::given::Given;
use crate::memory;

/// Whether the surfaces are apart in all of the configurations (x1, x2), by more than the deepest penetration that is a
/// pair. Only where the weights follow the motion, so that they can be made up for later.
pub fn are_apart(
    surfaces: (&Surface, &Surface),
    options: &Options,
    filter: &Filter,
    places: &[(&[Vec3], &[Vec3])],
) -> Result<bool> {
    if !options.shortcuts.apart || options.effective_weights() != Weights::Current {
        return Ok(false);
    }
    match filter {
        Filter::Analytic(_) => analytic::are_apart(surfaces, places),
        Filter::Facets(filter) => {
            let distance = filter.deepest() + offsets::reach(surfaces).0;
            Ok(directions(distance, places).iter().any(Option::is_some))
        }
    }
}

/// The axes, one way or the other, along which the non-mortar side must go to reach the other one, in all of the
/// configurations: between two of them on different sides it passes through it.
fn directions(distance: f64, places: &[(&[Vec3], &[Vec3])]) -> [Option<Vec3>; 6] {
    let around = |x: &[Vec3]| Aabb::around(x.iter().copied());
    let mut directions = [-Vec3::x(), -Vec3::y(), -Vec3::z(), Vec3::x(), Vec3::y(), Vec3::z()].map(Some);
    for (x1, x2) in places {
        let sides = around(x1).sides(&around(x2), distance);
        directions.iter_mut().zip(sides).filter(|(_, side)| !side).for_each(|(direction, _)| *direction = None);
    }
    directions
}

/// Whether the surfaces are apart at (x1, x2), were so at t_n, and look at each other.
pub fn stays_apart<const N: usize>(given: Given<N>, x1: &[Vec3], x2: &[Vec3]) -> Result<bool> {
    let History { x1: x1_n, x2: x2_n, .. } = given.history();
    let (surfaces, places) = (given.setup.surfaces(), [(&x1_n[..], &x2_n[..]), (x1, x2)]);
    let Some(filter) = &given.step.pairing.filter else { return Ok(false) };
    if !are_apart(surfaces, &given.setup.options, filter, &places)? {
        return Ok(false);
    }
    // Beyond that turn any facet may look at any other one.
    if let (true, Filter::Facets(filter)) = (given.setup.options.follows_normals(), filter)
        && filter.has_turned(surfaces, (x1, x2))
    {
        return Ok(false);
    }
    // A normal that is undefined is refused where it is needed.
    for a in 0..given.nodes() {
        if memory::if_accepted(given.normal(a))?.is_none() {
            return Ok(false);
        }
    }
    let (one, reached) = (surfaces.0, filter.reached());
    let nodes = |f: usize| one.facets[f].as_slice();
    let filter = match filter {
        Filter::Facets(filter) => filter,
        Filter::Analytic(facing) => {
            let surface = surfaces.1.analytic_at(x2)?;
            // Where the normals follow the motion, so does which facets face the surface.
            let follows = given.setup.options.follows_normals();
            for f in 0..reached.len() {
                let faces = if follows {
                    analytic::faces_at(one, &surface, &given.setup.options, x1, (f, 0.0))?
                } else {
                    facing[f]
                };
                if faces && !analytic::looks_at(&surface, nodes(f), x1, |a| given.normal(a))? {
                    return Ok(false);
                }
            }
            return Ok(true);
        }
    };
    // Those that all facets look along.
    let mut directions = directions(filter.deepest() + offsets::reach(surfaces).0, &places);
    for f in (0..reached.len()).filter(|&f| reached[f]) {
        let out = one.facet(f, x1).area_vector();
        for &a in nodes(f) {
            if !(given.normal(a)?.dot(&out) < 0.0) {
                return Ok(false);
            }
        }
        for direction in &mut directions {
            *direction = direction.filter(|direction| out.dot(direction) > 0.0);
        }
    }
    Ok(directions.iter().any(Option::is_some))
}
