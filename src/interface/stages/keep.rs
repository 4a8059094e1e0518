//! What is left of the pairs of now where the filter becomes another one at the same positions: a commit need not integrate
//! again. Weights are functions of two facets alone, so that those kept are what an integration would give, in every bit.

use super::facet::dual_basis;
use crate::error::Result;
use crate::interface::data::active::Active;
use crate::interface::data::options::{MultiplierBasis, Options};
use crate::interface::data::pairs::PairRecord;
use crate::interface::data::surface::Surface;
use crate::interface::pairing::candidates::{Search, by_points};
use crate::interface::pairing::filter::{FacetFilter, Filter};
use crate::interface::pairing::overlaps::{FacetOverlaps, overlap};
use crate::interface::pairing::work::Work;
use crate::memory::Store;
use crate::mortar::{NonmortarFrame, PairWeights};

/// Turns the pairs that the filter `old` admitted into those that `new` admits: what it does not goes to the room's `dropped`,
/// and what `old` had not admitted is integrated. What is there after a refusal means nothing. Only where both filters
/// integrate a facet in the same way.
pub fn keep(
    (one, two): (&Surface, &Surface),
    options: &Options,
    (old, new): (&FacetFilter, &Filter),
    work: &mut Work,
    active: &mut Active,
) -> Result<()> {
    let Filter::Facets(filter) = new else { unreachable!("facets stay facets") };
    let Work { counters, tree, room, .. } = work;
    room.added.clear();
    let Active { x1, x2, normals, pairs, areas, integrated, excluded, .. } = active;
    let tree = tree.at(two, x2)?;
    let before = Search::new((one, two), options, (x1, x2), (tree, old), 0.0);
    let after = Search::new((one, two), options, (x1, x2), (tree, filter), 0.0);
    let (mut next, mut kept, mut beyond, mut same_reach, mut all_known) = (0, 0, 0, true, true);
    for f in 0..one.facets.len() {
        let (first, first_beyond) = (next, beyond);
        next += pairs[next..].iter().take_while(|pair| pair.one == f).count();
        beyond += excluded[beyond..].iter().take_while(|pair| pair.0 as usize == f).count();
        let (reached, reaches) = (before.reaches(f), after.reaches(f));
        same_reach &= reached == reaches;
        let excluded = &excluded[first_beyond..beyond];
        // Where the search looked at heights up to the filter's ends alone, it may not have found what the new one admits.
        let has_ends = reaches && reached && before.may_end(f, normals[f]);
        let needs_frame = reaches && (after.follows || !reached || !excluded.is_empty() || has_ends);
        let frame = needs_frame.then(|| one.frame(f, x1, normals)).transpose()?;
        let admits = |j: usize| match &frame {
            Some(frame) => after.admits((f, frame), j),
            None => filter.admits(f, j),
        };
        room.known.clear();
        room.known.store_all(pairs[first..next].iter().map(|pair| pair.two))?;
        for place in first..next {
            if reaches && admits(pairs[place].two) {
                if kept < place {
                    (pairs[kept], areas[kept]) = (pairs[place], areas[place]);
                    if !integrated.is_empty() {
                        integrated[kept] = integrated[place];
                    }
                }
                kept += 1;
            } else {
                let weights = *integrated.get(place).unwrap_or(&pairs[place].weights);
                room.dropped.store(PairRecord { weights, ..pairs[place] })?;
            }
        }
        let Some(frame) = &frame else { continue };
        room.candidates.clear();
        let is_known = reached && (!has_ends || before.is_endless((f, frame)));
        all_known &= is_known || !reached;
        if is_known {
            room.candidates.store_all(excluded.iter().map(|pair| (f, pair.1 as usize)).filter(|&(_, j)| admits(j)))?;
        } else {
            counters.boxes_visited += after.of_facet((f, frame), &mut room.found, &mut room.candidates, None)?;
            let known = &room.known;
            room.candidates.retain(|&(_, j)| !known.contains(&j));
        }
        counters.pairs_tested += room.candidates.len() as i64;
        let line = by_points(options, filter, f);
        for &(_, j) in &room.candidates {
            let found = overlap(frame, &two.facet(j, x2), line);
            if let Some(segment) = found.map_err(|e| one.at(f)(two.at(j)(e)))? {
                let weights = PairWeights::integrate(frame, &segment, options.rule);
                room.added.store((PairRecord { one: f, two: j, weights }, segment.area))?;
            }
        }
    }
    pairs.truncate(kept);
    areas.truncate(kept);
    integrated.truncate(kept);
    active.knows_excluded &= same_reach && all_known && room.dropped.is_empty() && room.added.is_empty();
    let is_dual = options.basis == MultiplierBasis::Dual;
    insert(active, &room.added, is_dual)?;
    if is_dual {
        let changed = room.dropped.iter().map(|pair| pair.one).chain(room.added.iter().map(|(pair, _)| pair.one));
        dual_weights((one, two), (options, new), active, changed)?;
    }
    Ok(())
}

/// Puts pairs in their places among those that there are; both are sorted.
fn insert(active: &mut Active, added: &[(PairRecord, f64)], is_dual: bool) -> Result<()> {
    let mut from = active.pairs.len();
    active.grow(added.len(), 0)?;
    for (pair, area) in added {
        active.add(*pair, *area)?;
    }
    if is_dual {
        active.integrated.store_all(added.iter().map(|(pair, _)| pair.weights))?;
    }
    let place = |pair: &PairRecord| (pair.one, pair.two);
    let mut to = active.pairs.len();
    for (pair, area) in added.iter().rev() {
        while from > 0 && place(&active.pairs[from - 1]) > place(pair) {
            (from, to) = (from - 1, to - 1);
            (active.pairs[to], active.areas[to]) = (active.pairs[from], active.areas[from]);
            if is_dual {
                active.integrated[to] = active.integrated[from];
            }
        }
        to -= 1;
        (active.pairs[to], active.areas[to]) = (*pair, *area);
        if is_dual {
            active.integrated[to] = pair.weights;
        }
    }
    Ok(())
}

/// The dual weights of facets whose pairs have changed.
fn dual_weights(
    (one, two): (&Surface, &Surface),
    by: (&Options, &Filter),
    active: &mut Active,
    changed: impl Iterator<Item = usize>,
) -> Result<()> {
    let mut overlaps = FacetOverlaps::default();
    for f in changed {
        let first = active.pairs.partition_point(|pair| pair.one < f);
        let end = active.pairs.partition_point(|pair| pair.one <= f);
        if first == end {
            continue;
        }
        overlaps.find((one, two), by, active, first..end)?;
        let frame: (&NonmortarFrame, _) = (overlaps.frame(), &overlaps.segments[..]);
        let (_, basis) = dual_basis(one, f, frame, &active.integrated[first..end])?;
        for (pair, weights) in active.pairs[first..end].iter_mut().zip(&active.integrated[first..end]) {
            pair.weights = basis.as_ref().map_or_else(PairWeights::default, |basis| basis.weights(weights));
        }
    }
    Ok(())
}
