//! How far the surfaces have turned within a step (docs/formulation 6.6). nu, and which facets oppose each other, are
//! those of t_n: beyond a limit they mean the surfaces of now no longer. After a quarter of a turn nothing opposes
//! anything, and a step converges without any contact. So a commit refuses a step that has turned them by more.
//!
//! Both sides count, each against its own normals of t_n, and a turn of both together too: what is frozen is fixed in
//! space. With weights of the reference it is the whole turn since then, and of the non-mortar side alone, for nothing
//! else is asked. Tied surfaces use no normals, but those with offsets, which act along the normals of the reference. Surfaces
//! that were apart and still are may turn as they like.
//!
//! Normals that follow the motion cure this, and so there is no limit with them, but for what they do not cure: slip whose
//! measure is fixed in space (any but the objective one), and nodes on a knife's edge, which keep nu(t_n).

use crate::error::{Error, Kind, Result, Text};
use crate::geometry::Vec3;
use crate::interface::data::offsets;
use crate::interface::data::options::{Options, Weights};
use crate::interface::data::surface::Surface;
use crate::interface::pairing::analytic;
use crate::interface::pairing::boxes::Aabb;
use crate::interface::pairing::filter::Filter;
use crate::interface::pairing::given::Given;
use crate::law::SlipMeasure;
use crate::memory;
use crate::normal;

/// The larger of `found` and a turn from one unit vector to another, with what has turned.
fn larger(found: (f64, usize), from: &Vec3, to: &Vec3, what: usize) -> (f64, usize) {
    let angle = normal::angle(from, to);
    if angle > found.0 { (angle, what) } else { found }
}

/// Refuses a commit at (x1, x2) where a surface has turned by more than the option allows.
/// `shared`: other handles have other parts of the mortar side, which are not known here. `sums`: room.
pub fn refuse_turn<const N: usize>(
    given: Given<N>,
    (x1, x2): (&[Vec3], &[Vec3]),
    shared: bool,
    sums: &mut Vec<Vec3>,
) -> Result<()> {
    let ((nonmortar, mortar), options) = (given.setup.surfaces(), &given.setup.options);
    let turns_along = match options.friction.law().opens {
        true => !shared && is_apart_at_both(given, x1, x2)?,
        false => !offsets::are_there((nonmortar, mortar)),
    };
    if turns_along {
        return Ok(());
    }
    let follows =
        options.follows_normals() && (!given.setup.effects.law.slips || options.slip == SlipMeasure::Objective);
    let kept = |a: usize| given.setup.nodes.acts(a) && (!follows || given.step.pairing.keeps_normal[a]);
    let mut most = (0.0, 0);
    nonmortar.add_normals(x1, sums)?;
    for (a, sum) in sums.iter().enumerate().filter(|(a, _)| kept(*a)) {
        // One that cannot be averaged is refused in its own words where it is needed.
        if let Some(normal) = memory::if_accepted(normal::nodal_normal(*sum, a))? {
            let committed = &given.history().normals;
            let [from, to] = match given.step.pairing.corners.edge(a) {
                Some(edge) => {
                    [edge.sum(&|b| committed[b]), edge.sum(&|b| -sums[b].normalize())].map(|sum| sum.normalize())
                }
                None => [committed[a], normal],
            };
            most = larger(most, &from, &to, a);
        }
    }
    let (angle, node) = most;
    refuse_angle(options, angle, || text!("the normal of non-mortar node {node}"))?;
    if options.effective_weights() == Weights::Reference || follows {
        return Ok(());
    }
    let (angle, facet) = turn_of_mortar(mortar, &given.history().x2, x2)?;
    refuse_angle(options, angle, || match mortar.analytic {
        Some(shape) => text!("the mortar side, {shape},"),
        None => text!("mortar facet {}", mortar.host_facet(facet)),
    })
}

fn turn_of_mortar(two: &Surface, x2_n: &[Vec3], x2: &[Vec3]) -> Result<(f64, usize)> {
    if two.analytic.is_some() {
        let directions = [two.analytic_at(x2_n)?, two.analytic_at(x2)?].map(|surface| surface.direction());
        let [Some(from), Some(to)] = directions else { return Ok((0.0, 0)) };
        return Ok(larger((0.0, 0), &from, &to, 0));
    }
    let normal = |f: usize, x: &[Vec3]| two.facet(f, x).area_vector().try_normalize(0.0);
    let mut most = (0.0, 0);
    for f in 0..two.facets.len() {
        if let (Some(from), Some(to)) = (normal(f, x2_n), normal(f, x2)) {
            most = larger(most, &from, &to, f);
        }
    }
    Ok(most)
}

/// Whether the sides lie along one axis farther apart than any penetration, at t_n and now and the same way round.
fn is_apart_at_both<const N: usize>(given: Given<N>, x1: &[Vec3], x2: &[Vec3]) -> Result<bool> {
    let ((one, two), h) = (given.setup.surfaces(), given.history());
    let places = [(&h.x1[..], &h.x2[..]), (x1, x2)];
    if two.analytic.is_some() {
        return analytic::are_apart((one, two), &places);
    }
    let around = |x: &[Vec3]| Aabb::around(x.iter().copied());
    let deepest = match &given.step.pairing.filter {
        Some(Filter::Facets(filter)) => filter.deepest(),
        _ => one.longest_edge_at(&h.x1).max(two.longest_edge_at(&h.x2)),
    };
    let [before, now] = places.map(|(x1, x2)| around(x1).sides(&around(x2), deepest + offsets::reach((one, two)).0));
    Ok(before.iter().zip(&now).any(|(before, now)| *before && *now))
}

fn refuse_angle(options: &Options, angle: f64, what: impl Fn() -> Text) -> Result<()> {
    if angle <= options.turn_max {
        return Ok(());
    }
    // Of what has turned since the first configuration no step is a part.
    let (since, remedy) = if !options.friction.law().opens {
        (
            "since the first configuration, along whose normals offsets of tied surfaces act",
            "mesh the interference or the gap, or take a larger method.turn_max if the offsets are small",
        )
    } else if options.effective_weights() == Weights::Reference {
        (
            "since the first configuration, which STICKSLIP_WEIGHTS_REFERENCE are of",
            "take STICKSLIP_WEIGHTS_CURRENT, or a larger method.turn_max if that is meant; smaller steps are of no help",
        )
    } else if options.follows_normals() {
        (
            "since the last commit",
            "take smaller steps; with the normals of now this limit is for slip that is not measured objectively, and for nodes on a knife's edge",
        )
    } else {
        ("since the last commit", "take smaller steps")
    };
    Err(too_far(options, what(), angle, (since, remedy)))
}

/// The refusal of a turn.
#[inline(never)] // it is met three times
pub(super) fn too_far(options: &Options, what: Text, angle: f64, (since, remedy): (&str, &str)) -> Error {
    let text = text!(
        "{what} has turned by {:.1} degrees {since}, more than the {:.1} that are allowed (method.turn_max): {remedy}",
        angle.to_degrees(),
        options.turn_max.to_degrees()
    );
    Error::new(Kind::TurnedTooFar, text)
}
