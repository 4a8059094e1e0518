//! How the shares of carried nodes follow the positions of t_n (docs/formulation 18.1): w_AB are ratios of facet areas there. With L_AJ
//! the areas that A shares with its neighbours J, each with shares v_JB,
//!
//! w_AB = sum_J L_AJ v_JB / sum_J L_AJ,   Dw_AB = sum_J (DL_AJ (v_JB - w_AB) + L_AJ Dv_JB) / sum_J L_AJ

use super::{At, Column, Take};
use crate::error::Result;
use crate::geometry::Vec3;
use crate::interface::data::surface::Surface;
use crate::interface::pairing::weak::{self, Carrier};
use crate::interface::stages::carried::multiplier_share_of;
use crate::memory::{self, Store};
use crate::shape::MAX_CORNERS;

/// Dw_AB by the position of one node.
#[derive(Clone, Copy, Debug)]
struct Slope {
    carrier: usize,
    node: usize,
    by: Vec3,
}

/// The derivatives of twice a facet's area by its nodes.
fn of_area(surface: &Surface, f: usize, x: &[Vec3]) -> [Vec3; MAX_CORNERS] {
    let (facet, nodes) = (surface.facet(f, x), &surface.facets[f]);
    let (area, mut by) = (facet.area_vector().norm(), [Vec3::zeros(); MAX_CORNERS]);
    if surface.lines().is_some() {
        let along = x[nodes.nodes[1]] - x[nodes.nodes[0]];
        (by[0], by[1]) = (along * (-area / along.norm_squared()), along * (area / along.norm_squared()));
        return by;
    }
    let (x, normal) = (facet.points(), facet.area_vector() / area);
    let n = x.len();
    for (k, by) in by.iter_mut().enumerate().take(n) {
        *by = (x[(k + 1) % n] - x[(k + n - 1) % n]).cross(&normal);
    }
    by
}

/// How many neighbours away from a node with a multiplier of its own each carried node is; 0: it has one, `None`: nothing is opposite.
fn levels(at: &At, links: &[Vec<Carrier>]) -> Result<Vec<Option<usize>>> {
    let (one, step) = (at.surfaces.0, at.step);
    let mut levels = memory::filled(None, links.len())?;
    for (a, level) in levels.iter_mut().enumerate() {
        let takes_part = step.pairing.coverable[a] && one.has_row(a);
        let is_strong = takes_part && at.carriers_of(a).is_empty() && step.history.coverage[a] > 0.0;
        *level = is_strong.then_some(0);
    }
    for round in 1.. {
        let next = |a: &usize| {
            let is_near = |&(b, _): &Carrier| levels[b].is_some_and(|level| level < round);
            levels[*a].is_none() && !at.carriers_of(*a).is_empty() && links[*a].iter().any(is_near)
        };
        let mut found = Vec::new();
        found.store_all((0..links.len()).filter(next))?;
        if found.is_empty() {
            break;
        }
        found.iter().for_each(|&a| levels[a] = Some(round));
    }
    Ok(levels)
}

/// Gives what rows have of them: the carriers' through the gaps of those that they carry, these nodes' own through the carriers'
/// multipliers.
pub fn through_shares(at: &At, take: &mut Take) -> Result<()> {
    if !at.carried.contains(&true) {
        return Ok(());
    }
    let slopes = slopes(at)?;
    for (a, slopes) in slopes.iter().enumerate().filter(|(a, _)| at.is_carried(*a)) {
        let (answer, sums) = (&at.answers[a], &at.sums[a]);
        let share = multiplier_share_of(at.components, &at.nodes.free[a]);
        for &Slope { carrier: b, node, by } in slopes {
            let (t, [now, previous]) = (at.transfer(a, b), at.answers[b].by_gap);
            let from = sums.gap_previous - sums.gap_committed * at.slip.unwrap_or(0.0);
            let gap = sums.gap_now - sums.gap_committed * at.first_gap;
            let row = now * (t * gap) + previous * (t * from);
            let own = share * at.answers[b].lambda * (answer.scale / answer.augmentation);
            at.put(b, Column::Previous(node), &(row * by.transpose()), take);
            at.put(a, Column::Previous(node), &(own * by.transpose()), take);
        }
    }
    Ok(())
}

/// Dw of all carried nodes.
fn slopes(at: &At) -> Result<Vec<Vec<Slope>>> {
    let (one, history) = (at.surfaces.0, &at.step.history);
    let (x, n) = (&history.x1, one.len());
    let links = weak::links(one, history)?;
    let levels = levels(at, &links)?;
    // sum_J L_AJ of the nodes whose shares are known.
    let (mut slopes, mut totals) = (memory::defaults::<Vec<Slope>>(n)?, memory::filled(0.0, n)?);
    // v_JB of a neighbour that A has its shares from.
    let own = |j: usize| [(j, 1.0)];
    let farthest = levels.iter().flatten().copied().max().unwrap_or(0);
    for level in 1..=farthest {
        let is_here = |a: usize| levels[a] == Some(level);
        let counts = |j: usize| levels[j].is_some_and(|of| of < level);
        for a in (0..n).filter(|&a| is_here(a)) {
            totals[a] = links[a].iter().filter(|link| counts(link.0)).map(|link| link.1).sum();
            let mut of_neighbours = Vec::new();
            for &(j, area) in links[a].iter().filter(|link| counts(link.0)) {
                of_neighbours.store_all(slopes[j].iter().map(|s| Slope { by: s.by * (area / totals[a]), ..*s }))?;
            }
            slopes[a] = of_neighbours;
        }
        for f in 0..one.facets.len() {
            let nodes = one.rows(f).as_slice();
            let (by, corners) = (of_area(one, f, x), &one.facets[f]);
            for (i, &a) in nodes.iter().enumerate().filter(|(_, a)| is_here(**a)) {
                for (l, &j) in nodes.iter().enumerate().filter(|(l, j)| *l != i && counts(**j)) {
                    let Some(factor) = weak::share(one, history, (f, i, l)) else { continue };
                    let shares = if levels[j] == Some(0) { &own(j)[..] } else { at.carriers_of(j) };
                    for &(b, w) in at.carriers_of(a) {
                        let v: f64 = shares.iter().filter(|share| share.0 == b).map(|share| share.1).sum();
                        for (k, by) in by.iter().enumerate().take(corners.len) {
                            let by = by * (factor * (v - w) / totals[a]);
                            slopes[a].store(Slope { carrier: b, node: corners.nodes[k], by })?;
                        }
                    }
                }
            }
        }
    }
    Ok(slopes)
}
