//! Stage 1 over a whole interface: which pairs are active at a configuration, and their weights.
//!
//! A pair is active when its facets overlap or touch in the auxiliary plane and it passed the filters of the last commit
//! (opposing normals, heights) or, where the normals follow the motion, passes them now. All of that is a function of the positions and the history, so evaluating at A, B, A gives
//! equal bits. An analytic mortar side has its own filter and its own way (`analytic.rs`).

use crate::error::Result;
use crate::geometry::Vec3;
use crate::interface::data::active::Active;
use crate::interface::data::counters::Counters;
use crate::interface::data::options::Options;
use crate::interface::data::surface::{Surface, frames};
use crate::interface::pairing::analytic;
use crate::interface::pairing::candidates::{KeptTree, by_points, candidates};
use crate::interface::pairing::filter::Filter;
use crate::memory::{self, Store};
use crate::mortar::Segment;
use std::time::Instant;

/// Weights of all active pairs at (x1, x2), with the filter of another or the same configuration.
pub fn integrate(
    (one, two): (&Surface, &Surface),
    options: &Options,
    filter: &Filter,
    (counters, tree): (&mut Counters, &mut KeptTree),
    (x1, x2): (&[Vec3], &[Vec3]),
) -> Result<Active> {
    let filter = match filter {
        Filter::Facets(filter) => filter,
        Filter::Analytic(facing) => return analytic::integrate((one, two), options, facing, counters, (x1, x2)),
    };
    let start = Instant::now();
    let frames = frames(one, x1)?;
    let tree = (tree.at(two, x2)?, filter);
    let candidates = candidates((one, two), options, &frames, (x1, x2), tree, 0.0, &mut counters.boxes_visited)?;
    counters.searches += 1;
    counters.seconds_search += start.elapsed().as_secs_f64();

    let start = Instant::now();
    let mut active = Active {
        x1: memory::copied(x1)?,
        x2: memory::copied(x2)?,
        frames,
        // Large, too; candidates that do not overlap are few.
        pairs: memory::with_room(candidates.len())?,
        segments: memory::with_room(candidates.len())?,
        integrated: Vec::new(),
    };
    for candidates in candidates.chunk_by(|p, q| p.0 == q.0) {
        let first = active.pairs.len();
        counters.pairs_tested += candidates.len() as i64;
        let by_points = by_points(options, filter, candidates[0].0);
        match by_points {
            Some(line) => active
                .add((one, two), candidates, options.rule, |frame, facet| Segment::of_points(frame, facet, line))?,
            None => active.add((one, two), candidates, options.rule, Segment::new)?,
        }
        let new = &active.segments[first..];
        counters.pairs_clipped += if by_points.is_none() { new.len() as i64 } else { 0 };
        counters.pairs_integrated += new.iter().filter(|s| s.area > 0.0).count() as i64;
    }
    counters.seconds_integration += start.elapsed().as_secs_f64();
    Ok(active)
}

/// The overlaps of active pairs that were kept without them.
pub fn segments(mortar: &Surface, options: &Options, filter: &Filter, active: &Active) -> Result<Vec<Segment>> {
    let Filter::Facets(filter) = filter else { return Ok(Vec::new()) };
    let mut segments = memory::with_room(active.pairs.len())?;
    for pair in &active.pairs {
        let (frame, facet) = (&active.frames[pair.one], mortar.facet(pair.two, &active.x2));
        let segment = match by_points(options, filter, pair.one) {
            Some(line) => Segment::of_points(frame, &facet, line)?,
            None => Segment::new(frame, &facet)?,
        };
        segments.store(segment.expect("an active pair has a segment at the positions it was found at"))?;
    }
    Ok(segments)
}
