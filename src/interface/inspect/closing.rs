//! How much of a step of the host's may be taken before the surfaces pass through each other.
//!
//! With the mean gap of a covered node A, d_A = nu_A . g_A over its covered area, and the shortest edge h_A of the facets
//! around it, a fraction s of the displacements dx is allowed where every covered node has
//!
//! ```text
//! d_A(x + s dx) >= min(d_A(x), 0) - c h_A.
//! ```
//!
//! So surfaces that are apart end in a slight penetration, from which Newton's method knows that they touch. The
//! fraction is found by conservative advancement. A gap runs along the normal e of the non-mortar facet to a mortar facet
//! with the normal n, so it closes by at most the motion of the two surfaces over |e . n|: from one allowed fraction to the
//! next the motion is at least what the nearest node has left, times that. Where facets turn on the way and an advance
//! goes too far all the same, it is halved. Sums alone, no derivatives.

use crate::error::{Error, Kind, Result};
use crate::geometry::Vec3;
use crate::interface::data::active::Active;
use crate::interface::data::node_data::check_length;
use crate::interface::data::options::Weights;
use crate::interface::data::pairs::PairRecord;
use crate::interface::data::surface::Surface;
use crate::interface::pairing::boxes::Aabb;
use crate::interface::pairing::given::{Given, check_finite};
use crate::interface::pairing::work::Work;
use crate::interface::stages::acting::acting;
use crate::interface::stages::away::LookingAway;
use crate::interface::stages::sums::{add_offsets, assemble};
use crate::memory::{self, Stored};

/// c where the host gives none: a node may go this part of its shortest edge deeper. From 0.03 to 1 Newton's method
/// converges on round bodies, in fewer iterations where it is larger; near 1 a fine surface may be passed through.
const DEPTH: f64 = 0.1;
/// The most that a host may ask for: a penetration of more than an edge is the far side of a body to the filter.
const MOST_DEPTH: f64 = 1.0;
/// The least advance, over the shortest c h_A: close to the limit, what is left would make smaller and smaller ones.
const LEAST_ADVANCE: f64 = 0.25;
/// How much deeper than its limit a node may be, over the shortest c h_A: an advance that takes all that is left ends on
/// the limit, up to rounding.
const ROUNDING: f64 = 1e-6;
/// Fractions tried in one call. From the gap of a facet on each doubles or so, so that any gap is passed in 60; along
/// surfaces that touch, it is this many times c h / 4 at the least.
const MOST_FRACTIONS: usize = 64;

/// The mean gap of a covered node `[L]`, and by how much it closes at most per length of motion.
#[derive(Clone, Copy, Debug)]
struct Gap {
    mean: f64,
    rate: f64,
}

/// A step of the host's: positions and what is added to them.
struct Motion<'a> {
    x: [&'a [Vec3]; 2],
    dx: [&'a [Vec3]; 2],
}

impl Motion<'_> {
    /// The positions of one side at a fraction of the step.
    fn at(&self, side: usize, fraction: f64) -> Result<Vec<Vec3>> {
        self.x[side].iter().zip(self.dx[side]).map(|(x, dx)| x + fraction * dx).stored()
    }

    /// At most how far two points of different sides move towards each other, with the motion that both have in common
    /// taken away.
    fn motion(&self) -> f64 {
        let common = Aabb::around(self.dx.iter().flat_map(|dx| dx.iter().copied())).centre();
        self.dx.iter().map(|dx| dx.iter().map(|dx| (dx - common).norm()).fold(0.0, f64::max)).sum()
    }
}

/// The shortest edge of the facets around each node `[L]`.
fn shortest_edges(surface: &Surface, x: &[Vec3]) -> Result<Vec<f64>> {
    let mut shortest = memory::filled(f64::INFINITY, surface.len())?;
    for facet in &surface.facets {
        let nodes = facet.as_slice();
        let edge = |k: usize| (x[nodes[(k + 1) % nodes.len()]] - x[nodes[k]]).norm();
        let least = (0..nodes.len()).map(edge).fold(f64::INFINITY, f64::min);
        nodes.iter().for_each(|&a| shortest[a] = shortest[a].min(least));
    }
    Ok(shortest)
}

/// The fraction of the step (dx1, dx2) from (x1, x2) that is allowed, above 0 and at most 1. `depth`: c, or the
/// default. Sides that are tied may move as they like.
#[inline(never)] // then it is compiled once: it asks for nothing that N changes
pub fn step_limit<const N: usize>(
    given: Given<N>,
    (active, work): (Option<&Active>, &mut Work),
    (x1, x2): (&[Vec3], &[Vec3]),
    (dx1, dx2): (&[Vec3], &[Vec3]),
    depth: Option<f64>,
) -> Result<f64> {
    let (nonmortar, mortar) = given.setup.surfaces();
    let depth = depth.unwrap_or(DEPTH);
    if !(depth > 0.0 && depth <= MOST_DEPTH) {
        let text = text!("penetration is {depth}; above 0 and at most {MOST_DEPTH} is allowed, 0 stands for {DEPTH}");
        return Err(Error::new(Kind::InvalidValue, text));
    }
    given.check_positions(x1, x2)?;
    check_length("dx1", dx1.len(), x1.len())?;
    check_length("dx2", dx2.len(), x2.len())?;
    check_finite("dx1", dx1)?;
    check_finite("dx2", dx2)?;
    let step = Motion { x: [x1, x2], dx: [dx1, dx2] };
    check_finite("x1 + dx1", &step.at(0, 1.0)?)?;
    check_finite("x2 + dx2", &step.at(1, 1.0)?)?;
    // An analytic surface's frame that turns is no rigid body on the way; half-way it is least of one.
    mortar.check_rigid(&step.at(1, 0.5)?)?;
    let motion = step.motion();
    if !given.setup.options.friction.law().opens || motion == 0.0 {
        return Ok(1.0);
    }
    let edges = shortest_edges(nonmortar, x1)?;
    let mut mean_gaps = |fraction: f64| mean_gaps(given, (active, &mut *work), &step, fraction);
    let start = mean_gaps(0.0)?;
    let limit = |a: usize| start[a].map_or(0.0, |gap| gap.mean.min(0.0)) - depth * edges[a];
    let limits: Vec<_> = (0..edges.len()).map(limit).stored()?;
    if given.setup.options.effective_weights() != Weights::Current {
        return Ok(linear_fraction(&start, &mean_gaps(1.0)?, &limits));
    }
    let shortest = edges.iter().copied().fold(f64::INFINITY, f64::min);
    let slack = ROUNDING * depth * shortest;
    let left_of =
        |gaps: &[Option<Gap>]| rooms(gaps, &limits).map(|(room, rate)| room / rate).fold(f64::INFINITY, f64::min);
    let allows = |gaps: &[Option<Gap>]| rooms(gaps, &limits).all(|(room, _)| room >= -slack);
    // Where nothing can be evaluated, as between facets that are crushed on the way, the host could not, either.
    if motion <= shortest && memory::if_accepted(mean_gaps(1.0))?.is_some_and(|gaps| allows(&gaps)) {
        return Ok(1.0);
    }
    let advance = LEAST_ADVANCE * depth * shortest;
    let (mut allowed, mut left, mut refused) = (0.0, left_of(&start), f64::INFINITY);
    for _ in 0..MOST_FRACTIONS {
        if left == f64::INFINITY {
            left = shortest.max(distance_of_boxes(mortar, &step, allowed)?);
        }
        let fraction = (allowed + left.max(advance) / motion).min(1.0).min(0.5 * (allowed + refused));
        match memory::if_accepted(mean_gaps(fraction))?.filter(|gaps| allows(gaps)) {
            Some(gaps) => (allowed, left) = (fraction, left_of(&gaps)),
            None => refused = fraction,
        }
        if allowed == 1.0 || (refused - allowed) * motion <= advance {
            break;
        }
    }
    // Some of the step is taken in any case, for a host must get on.
    Ok(if allowed > 0.0 { allowed } else { (advance / motion).min(1.0) })
}

/// The mean gap of each node at a fraction of a step; `None`: it is uncovered.
fn mean_gaps<const N: usize>(
    given: Given<N>,
    (active, work): (Option<&Active>, &mut Work),
    step: &Motion,
    fraction: f64,
) -> Result<Vec<Option<Gap>>> {
    let (x1, x2) = (step.at(0, fraction)?, step.at(1, fraction)?);
    let (surfaces, options) = (given.setup.surfaces(), &given.setup.options);
    let known = active.filter(|k| k.x1 == x1 && k.x2 == x2);
    // Its memory serves all fractions, and commits.
    let mut now = std::mem::take(&mut work.room.anew);
    let is_new = match (&given.step.pairing.filter, options.effective_weights()) {
        (Some(filter), Weights::Current) if known.is_none() => {
            acting(surfaces, options, filter, work, (&x1, &x2), &mut now)?;
            true
        }
        _ => false,
    };
    let known = if is_new { Some(&now) } else { known };
    let weighted = known.map_or(given.history().weighted(surfaces), |k| k.weighted(surfaces));
    let pairs = known.map_or(&given.history().pairs, |k| &k.pairs);
    let sums = &mut work.room.sums;
    assemble(surfaces, weighted, (&x1, &x2), sums)?;
    add_offsets(given, weighted, sums)?;
    let rates = rates(surfaces, pairs, (&x1, &x2))?;
    work.room.anew = now;
    let away = LookingAway::at(given, (&x1, &x2))?;
    let gap = |(a, (coverage, gap)): (usize, &(f64, Vec3))| {
        let looks_away = away.as_ref().map_or(Ok(false), |away| away.is(a))?;
        let covered = !looks_away && *coverage > given.least_coverage(a);
        Ok(if covered { Some(Gap { mean: given.normal(a)?.dot(gap) / coverage, rate: rates[a] }) } else { None })
    };
    sums.iter().enumerate().map(gap).stored_if_ok()
}

/// How far apart the boxes around the two surfaces are, as far as the distance along one axis says `[L]`; 0 of an
/// analytic one, which has no box.
fn distance_of_boxes(mortar: &Surface, step: &Motion, fraction: f64) -> Result<f64> {
    if mortar.analytic.is_some() {
        return Ok(0.0);
    }
    let (one, two) = (Aabb::around(step.at(0, fraction)?), Aabb::around(step.at(1, fraction)?));
    Ok(one.distance(&two))
}
/// By how much each covered node is above its limit `[L]`, and its rate.
fn rooms<'a>(gaps: &'a [Option<Gap>], limits: &'a [f64]) -> impl Iterator<Item = (f64, f64)> + 'a {
    gaps.iter().zip(limits).filter_map(|(gap, limit)| gap.map(|gap| (gap.mean - limit, gap.rate)))
}

/// By how much the gap of each node closes at most per length of motion: 1 / |e . n|, the most of its pairs. An analytic
/// surface is as far as its closest point: 1.
fn rates((one, two): (&Surface, &Surface), pairs: &[PairRecord], (x1, x2): (&[Vec3], &[Vec3])) -> Result<Vec<f64>> {
    let mut rates = memory::filled(1.0_f64, one.len())?;
    for pair in pairs.iter().filter(|_| two.analytic.is_none()) {
        let (e, n) = (one.facet(pair.one, x1).area_vector(), two.facet(pair.two, x2).area_vector());
        let rate = e.norm() * n.norm() / e.dot(&n).abs().max(f64::MIN_POSITIVE);
        one.rows(pair.one).as_slice().iter().for_each(|&a| rates[a] = rates[a].max(rate));
    }
    Ok(rates)
}

/// With frozen weights a gap is linear in the fraction.
fn linear_fraction(start: &[Option<Gap>], end: &[Option<Gap>], limits: &[f64]) -> f64 {
    let mut fraction = 1.0_f64;
    for ((start, end), limit) in start.iter().zip(end).zip(limits) {
        if let (Some(start), Some(end)) = (start.map(|g| g.mean), end.map(|g| g.mean))
            && end < *limit
        {
            fraction = fraction.min((start - limit) / (start - end));
        }
    }
    fraction
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_linear_gap_is_followed_to_its_limit() {
        let gap = |mean| Some(Gap { mean, rate: 1.0 });
        let gaps = |a: f64, b: f64| [gap(a), None, gap(b)];
        assert_eq!(linear_fraction(&gaps(1.0, 2.0), &gaps(0.5, 0.0), &[-0.1; 3]), 1.0);
        let fraction = linear_fraction(&gaps(1.0, 2.0), &gaps(-3.0, -1.0), &[-0.2; 3]);
        assert!((fraction - 0.3).abs() < 1e-15, "{fraction}");
    }

    #[test]
    fn a_common_motion_is_none() {
        let (x, dx) = ([Vec3::zeros(); 2], [Vec3::new(5.0, -7.0, 3.0); 2]);
        assert_eq!(Motion { x: [&x, &x], dx: [&dx, &dx] }.motion(), 0.0);
        let other = [Vec3::new(5.0, -7.0, 2.0); 2];
        assert_eq!(Motion { x: [&x, &x], dx: [&dx, &other] }.motion(), 1.0);
    }
}
