//! Stage 1 against an analytic mortar side (plane, sphere, cylinder; line, circle): no search and no clipping. A facet that faces the
//! surface at t_n (now where the normals follow the motion) and looks at it now is a pair with it, and covered everywhere; one that
//! does not has nothing to do with it. Two facets that pass each other within a step lie over each other no more; here a gap along
//! nu is 0 wherever nu is across x - y, however far off the surface is, and beyond that reads as a penetration. The surface counts as one facet with the frame's four points as its nodes, so that all that
//! follows from the weights (gaps, forces, slip, history) is as for two facets.

use super::filter::{LEAST_OPPOSITION, TOUCHES, least_opposition};
use super::work::{Following, Work};
use crate::error::Result;
use crate::geometry::{AnalyticSurface, Facet, Plane, Vec3};
use crate::interface::data::active::Active;
use crate::interface::data::offsets;
use crate::interface::data::options::Options;
use crate::interface::data::pairs::PairRecord;
use crate::interface::data::surface::Surface;
use crate::memory::{self, Store, Stored};
use crate::mortar::{NonmortarFrame, PairWeights, SurfacePair, analytic_weights};
use std::time::Instant;

/// Per non-mortar facet, whether it faces the surface: opposing normals at its centre, and distances between a
/// penetration and a gap, as between facets. A surface has no far side that a gap could reach: without a search
/// distance any gap will do. `skin`: there, or after a motion of so much (over the facet's longest edge).
pub fn facing(
    one: &Surface,
    surface: &AnalyticSurface,
    options: &Options,
    x1: &[Vec3],
    skin: f64,
) -> Result<Vec<bool>> {
    (0..one.facets.len()).map(|f| faces_at(one, surface, options, x1, (f, skin))).stored_if_ok()
}

/// The same of one facet.
pub fn faces_at(
    one: &Surface,
    surface: &AnalyticSurface,
    options: &Options,
    x1: &[Vec3],
    (f, skin): (usize, f64),
) -> Result<bool> {
    let facet = one.facet(f, x1);
    let plane = Plane::of(&facet).map_err(one.at(f))?;
    Ok(faces(&facet, &plane, surface, (options, offsets::reach_of(one)), skin))
}

/// Whether this facet faces the surface.
fn faces(
    facet: &Facet,
    plane: &Plane,
    surface: &AnalyticSurface,
    (options, (closing, opening)): (&Options, (f64, f64)),
    skin: f64,
) -> bool {
    let gap = options.search_distance.map_or(f64::INFINITY, |distance| distance + closing);
    let centre = centre(plane, surface);
    let points = facet.points().iter().map(|x| x - surface.origin).chain([centre]);
    let distances = points.map(|x| surface.distance(x));
    let (low, high) = distances.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), d| (l.min(d), h.max(d)));
    let penetration = options.search_distance.unwrap_or_else(|| facet.longest_edge()) + opening;
    let slack = skin * facet.longest_edge();
    let opposes = surface.closest(centre).is_some_and(|c| plane.e.dot(&c.normal) < -least_opposition(skin));
    opposes && low - slack <= gap && high + slack >= -penetration
}

/// A plane's centre, from the surface's origin.
fn centre(plane: &Plane, surface: &AnalyticSurface) -> Vec3 {
    plane.reference - surface.origin + plane.origin
}

/// Whether a facet with this plane looks at the surface now, its normals opposing by more than `least`. At the centre or on the axis nothing is nearest, which is refused
/// where it is needed.
fn looks(plane: &Plane, surface: &AnalyticSurface, least: f64) -> bool {
    surface.closest(centre(plane, surface)).is_none_or(|c| plane.e.dot(&c.normal) < -least)
}

/// The first facet that faced the surface at t_n, when the sides were at x1_n, and through which the surface has passed since: what is
/// nearest looks the same way as the facet does, and did, and the facet is in the surface's body, or in front of it or behind it
/// as seen along its normal. Nothing could hold it in the step that follows.
pub fn passed(
    one: &Surface,
    (surface, facing): (&AnalyticSurface, &[bool]),
    (x1_n, x1): (&[Vec3], &[Vec3]),
) -> Result<Option<usize>> {
    let (_, opening) = offsets::reach_of(one);
    for f in (0..facing.len()).filter(|&f| facing[f]) {
        let facet = one.facet(f, x1);
        let plane = |facet| Plane::of(facet).map_err(one.at(f));
        let (now, then) = (plane(&facet)?, plane(&one.facet(f, x1_n))?);
        let (centre, margin) = (centre(&now, surface), opening + TOUCHES * facet.longest_edge());
        let same_way = |n: Vec3| now.e.dot(&n) >= 0.0 && then.e.dot(&n) >= 0.0;
        let is_over = surface.closest(centre).is_none_or(|c| same_way(c.normal));
        if is_over && (surface.distance(centre) < -margin || surface.is_met_along(centre, now.e, margin)) {
            return Ok(Some(f));
        }
    }
    Ok(None)
}

/// Which facets are a pair with the surface at x1: those that faced it at t_n and look at it still, however deep; where the
/// normals follow the motion those, too, that face it there.
pub fn facing_now<'a>(
    one: &'a Surface,
    (surface, facing): (&'a AnalyticSurface, &'a [bool]),
    options: &'a Options,
    x1: &'a [Vec3],
) -> impl Fn((usize, &Plane)) -> bool + 'a {
    let reach = offsets::reach_of(one);
    // With the normals of t_n a gap is 0 where they are across, and nothing jumps there.
    let least = if options.follows_normals() { LEAST_OPPOSITION } else { 0.0 };
    move |(i, plane)| {
        let still = facing[i] && looks(plane, surface, least);
        still || options.follows_normals() && faces(&one.facet(i, x1), plane, surface, (options, reach), 0.0)
    }
}

/// Adds the weights of all facets that face the surface, at (x1, x2), to an empty `active`.
pub fn integrate(
    (one, two): (&Surface, &Surface),
    options: &Options,
    facing: &[bool],
    Work { counters, .. }: &mut Work,
    (x1, x2): (&[Vec3], &[Vec3]),
    active: &mut Active,
    following: Following,
) -> Result<()> {
    let start = Instant::now();
    one.plane_normals(x1, &mut active.normals)?;
    let surface = two.analytic_at(x2)?;
    let faces_now = facing_now(one, (&surface, facing), options, x1);
    memory::grow(&mut active.pairs, one.facets.len())?;
    for i in 0..one.facets.len() {
        let (frame, place) = (one.frame(i, x1, &active.normals)?, active.pairs.len());
        counters.pairs_tested += 1;

        if faces_now((i, &frame.plane)) && !one.is_idle(i) {
            let weights = weigh((one, &surface), options, (i, &frame, x1), active)?;
            active.pairs.store(PairRecord { one: i, two: 0, weights })?;
            if let Some(following) = following {
                following(active, place, (&frame, &[]));
            }
        }
    }
    counters.pairs_integrated += active.pairs.len() as i64;
    counters.seconds_integration += start.elapsed().as_secs_f64();
    Ok(())
}

/// The weights of facet i, which has this frame; of a part of a facet of the host with its share of that one's, which `active` gets.
pub fn weigh(
    (one, surface): (&Surface, &AnalyticSurface),
    options: &Options,
    (i, frame, x1): (usize, &NonmortarFrame, &[Vec3]),
    active: &mut Active,
) -> Result<PairWeights> {
    let Some(parents) = &one.parents else {
        return analytic_weights(frame, surface, options.rule).map_err(one.at(i));
    };
    let over = |part: SurfacePair, x: &_| part.weights(x);
    let share = parents.over_surface(i, (frame, x1), (surface, options.rule), over);
    let (f, share) = (parents.parent(i), share.map_err(one.at(i))?);
    let rows = parents.space.nodes(parents.facets[f].parent, parents.sub(i));
    active.add_share((f, 0), rows, &share)
}

/// Whether every node is outside the surface by more than any facet's edge there, in all of the configurations (x1, x2).
/// A point of a facet is nearer to one of its nodes than its longest edge, so all of it is outside.
pub fn are_apart((one, two): (&Surface, &Surface), places: &[(&[Vec3], &[Vec3])]) -> Result<bool> {
    for (x1, x2) in places {
        let surface = two.analytic_at(x2)?;
        let edge = one.longest_edge_at(x1) + offsets::reach_of(one).0;
        if !x1.iter().all(|x| surface.distance(x - surface.origin) > edge) {
            return Ok(false);
        }
    }
    Ok(true)
}

/// Whether the gap is one, and no penetration, all over a facet that is outside: its vector runs along the surface's
/// normal n, of which nu . n > 0 holds between the nodes if it does at all of them.
pub fn looks_at(
    surface: &AnalyticSurface,
    nodes: &[usize],
    x1: &[Vec3],
    nu: impl Fn(usize) -> Result<Vec3>,
) -> Result<bool> {
    for &k in nodes {
        let Some(closest) = surface.closest(x1[k] - surface.origin) else { return Ok(false) };
        for &a in nodes {
            if !(nu(a)?.dot(&closest.normal) > 0.0) {
                return Ok(false);
            }
        }
    }
    Ok(true)
}
