//! Stage 1 over a whole interface: which pairs are active at a configuration, and their weights.
//!
//! A pair is active when its facets overlap or touch in the auxiliary plane and it passed the filters of the last commit
//! (opposing normals, heights) or, where the normals follow the motion, passes them now. All of that is a function of the positions and the history, so evaluating at A, B, A gives
//! equal bits. An analytic mortar side has its own filter and its own way (`analytic.rs`).

use crate::error::{Error, Result};
use crate::geometry::Vec3;
use crate::interface::data::active::Active;
use crate::interface::data::options::Options;
use crate::interface::data::pairs::PairRecord;
use crate::interface::data::surface::{Surface, at_facet};
use crate::interface::pairing::analytic;
use crate::interface::pairing::candidates::{Search, by_points};
use crate::interface::pairing::filter::{FacetFilter, Filter};
use crate::interface::pairing::overlaps::overlap;
use crate::interface::pairing::work::{Following, ROW, Work};
use crate::memory::{self, Store};
use crate::mortar::PairWeights;
use std::time::Instant;

/// Weights of all active pairs at (x1, x2), with the filter of another or the same configuration, in the memory of `active`.
/// What is there after a refusal means nothing.
pub fn integrate(
    (one, two): (&Surface, &Surface),
    options: &Options,
    filter: &Filter,
    work: &mut Work,
    x: (&[Vec3], &[Vec3]),
    active: &mut Active,
    following: Following,
) -> Result<()> {
    active.begin(x.0, x.1)?;
    let outcome = match filter {
        Filter::Facets(filter) => by_facets((one, two), options, filter, work, x, active, following),
        Filter::Analytic(facing) => analytic::integrate((one, two), options, facing, work, x, active, following),
    };
    // A facet that has no frame is named before any pair.
    outcome.map_err(|error: Error| one.refused_frame(x.0).unwrap_or(error))
}

fn by_facets(
    (one, two): (&Surface, &Surface),
    options: &Options,
    filter: &FacetFilter,
    Work { counters, tree, room }: &mut Work,
    (x1, x2): (&[Vec3], &[Vec3]),
    active: &mut Active,
    mut following: Following,
) -> Result<()> {
    let mut start = Instant::now();
    one.plane_normals(x1, &mut active.normals)?;
    let search = Search::new((one, two), options, (x1, x2), (tree.at(two, x2)?, filter), 0.0);
    counters.searches += 1;
    for first in (0..one.facets.len()).step_by(ROW) {
        room.frames.clear();
        room.candidates.clear();
        for f in first..one.facets.len().min(first + ROW) {
            room.frames.store(one.frame(f, x1, &active.normals)?)?;
            let (frame, excluded) = (&room.frames[f - first], Some(&mut active.excluded));
            counters.boxes_visited += search.of_facet((f, frame), &mut room.found, &mut room.candidates, excluded)?;
        }
        let searched = Instant::now();
        counters.seconds_search += (searched - start).as_secs_f64();
        start = searched;

        // As many a facet as so far.
        let all = (active.pairs.len() * one.facets.len()).checked_div(first).unwrap_or(0);
        active.grow(room.candidates.len(), all)?;
        for candidates in room.candidates.chunk_by(|p, q| p.0 == q.0) {
            let (i, place) = (candidates[0].0, active.pairs.len());
            let (frame, line) = (&room.frames[i - first], by_points(options, filter, i));
            room.segments.clear();
            memory::grow(&mut room.segments, if following.is_some() { candidates.len() } else { 0 })?;
            for &(_, j) in candidates {
                // Large: looked at where it is, and kept only where something follows.
                let found = overlap(frame, &two.facet(j, x2), line);
                let segment = match &found {
                    Ok(Some(segment)) => segment,
                    Ok(None) => continue,
                    Err(_) => return found.map(|_| ()).map_err(|e| at_facet(one.side, i)(at_facet(two.side, j)(e))),
                };
                let weights = PairWeights::integrate(frame, segment, options.rule);
                active.add(PairRecord { one: i, two: j, weights }, segment.area)?;
                if let (true, Ok(Some(segment))) = (following.is_some(), found) {
                    room.segments.store(segment)?;
                }
            }
            counters.pairs_tested += candidates.len() as i64;
            counters.pairs_clipped += if line.is_none() { (active.pairs.len() - place) as i64 } else { 0 };
            counters.pairs_integrated += active.areas[place..].iter().filter(|area| **area > 0.0).count() as i64;
            if let Some(following) = &mut following {
                following(active, place, (frame, &room.segments))?;
            }
        }
        let integrated = Instant::now();
        counters.seconds_integration += (integrated - start).as_secs_f64();
        start = integrated;
    }
    active.knows_excluded = true;
    Ok(())
}
