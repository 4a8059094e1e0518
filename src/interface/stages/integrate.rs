//! Stage 1 over a whole interface: which pairs are active at a configuration, and their weights.
//!
//! A pair is active when its facets overlap or touch in the auxiliary plane and it passed the filters of the last commit
//! (opposing normals, heights) or, where the normals follow the motion, passes them now. All of that is a function of the positions and the history, so evaluating at A, B, A gives
//! equal bits. An analytic mortar side has its own filter and its own way (`analytic.rs`).

use crate::error::{Error, Result};
use crate::features;
use crate::geometry::Vec3;
use crate::interface::data::active::Active;
use crate::interface::data::counters::Counters;
use crate::interface::data::options::Options;
use crate::interface::data::pairs::PairRecord;
use crate::interface::data::parents::Parents;
use crate::interface::data::surface::Surface;
use crate::interface::pairing::analytic;
use crate::interface::pairing::candidates::{Search, by_points};
use crate::interface::pairing::filter::{FacetFilter, Filter};
use crate::interface::pairing::overlaps::overlap;
use crate::interface::pairing::work::{Following, ROW, Room, ThreadRoom, Work};
use crate::memory::{self, Store};
use crate::mortar::{NonmortarFrame, PairWeights, Segment};
use crate::quadrature::Rule;
use crate::threads;
use std::ops::Range;
use std::sync::{Mutex, PoisonError};
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

/// Facets of a chunk: what one thread does at a time.
const CHUNK: usize = 1024;

fn by_facets(
    (one, two): (&Surface, &Surface),
    options: &Options,
    filter: &FacetFilter,
    Work { counters, tree, room, threads, chunks }: &mut Work,
    (x1, x2): (&[Vec3], &[Vec3]),
    active: &mut Active,
    following: Following,
) -> Result<()> {
    let start = Instant::now();
    let mut normals = std::mem::take(&mut active.normals);
    one.plane_normals(x1, &mut normals)?;
    let search = Search::new((one, two), options, (x1, x2), (tree.at(two, x2)?, filter), 0.0);
    counters.searches += 1;
    counters.seconds_search += start.elapsed().as_secs_f64();
    let stage = Stage { surfaces: (one, two), options, filter, x: (x1, x2), search, normals: &normals, following };
    let facets = one.facets.len();
    if options.threads == 1 || facets <= CHUNK {
        stage.of_facets(0..facets, (counters, room), active)?;
    } else {
        while threads.len() < options.threads {
            threads.store(ThreadRoom::default())?;
        }
        while chunks.len() < facets.div_ceil(CHUNK) {
            chunks.store(Mutex::default())?;
        }
        threads.iter_mut().for_each(|thread| thread.counters = Counters::default());
        threads::share(chunks.len(), threads, |k, ThreadRoom { counters, room }| {
            let mut chunk = chunks[k].lock().unwrap_or_else(PoisonError::into_inner);
            chunk.clear();
            // No facet of the host is in two chunks.
            let [first, end] = [k, k + 1].map(|k| one.begin_of_host(facets.min(k * CHUNK)));
            stage.of_facets(first..end, (counters, room), &mut chunk)
        })?;
        for chunk in chunks {
            active.append(chunk.get_mut().unwrap_or_else(PoisonError::into_inner))?;
        }
        threads.iter().for_each(|thread| counters.add(&thread.counters));
    }
    active.normals = normals;
    active.knows_excluded = true;
    active.order_parents();
    Ok(())
}

/// What the integration of any facet needs.
struct Stage<'a> {
    surfaces: (&'a Surface, &'a Surface),
    options: &'a Options,
    filter: &'a FacetFilter,
    x: (&'a [Vec3], &'a [Vec3]),
    search: Search<'a>,
    /// Unit normals of the planes of all non-mortar facets.
    normals: &'a [Vec3],
    following: Following<'a>,
}

impl Stage<'_> {
    /// Adds the pairs of these facets.
    fn of_facets(
        &self,
        facets: Range<usize>,
        (counters, room): (&mut Counters, &mut Room),
        active: &mut Active,
    ) -> Result<()> {
        let Stage { surfaces: (one, two), options, filter, x: (x1, x2), ref search, normals, following } = *self;
        let parents = one.parents.as_ref().zip(two.parents.as_ref());
        let mut start = Instant::now();
        for first in (facets.start..facets.end).step_by(ROW) {
            room.frames.clear();
            room.candidates.clear();
            for f in first..facets.end.min(first + ROW) {
                room.frames.store(one.frame(f, x1, normals)?)?;
                let (frame, excluded) = (&room.frames[f - first], Some(&mut active.excluded));
                counters.boxes_visited +=
                    search.of_facet((f, frame), &mut room.found, &mut room.candidates, excluded)?;
            }
            let searched = Instant::now();
            counters.seconds_search += (searched - start).as_secs_f64();
            start = searched;

            // As many a facet as so far.
            let all = (active.pairs.len() * facets.len()).checked_div(first - facets.start).unwrap_or(0);
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
                        Err(_) => {
                            return found.map(|_| ()).map_err(|e| one.at(i)(two.at(j)(e)));
                        }
                    };
                    let weights = pair_weights(parents, (i, j), (frame, segment, options.rule), (x1, x2), active)?;
                    active.add(PairRecord { one: i, two: j, weights }, segment.area)?;
                    if let (true, Ok(Some(segment))) = (following.is_some(), found) {
                        room.segments.store(segment)?;
                    }
                }
                counters.pairs_tested += candidates.len() as i64;
                counters.pairs_clipped += if line.is_none() { (active.pairs.len() - place) as i64 } else { 0 };
                counters.pairs_integrated += active.areas[place..].iter().filter(|area| **area > 0.0).count() as i64;
                if let Some(following) = following {
                    following(active, place, (frame, &room.segments));
                }
            }
            let integrated = Instant::now();
            counters.seconds_integration += (integrated - start).as_secs_f64();
            start = integrated;
        }
        Ok(())
    }
}

/// The weights of a pair over its overlap; of parts what is covered of each row, and the rest is added to the weights of their parents.
pub fn pair_weights(
    parents: Option<(&Parents, &Parents)>,
    pair: (usize, usize),
    over: (&NonmortarFrame, &Segment, &'static Rule),
    x: (&[Vec3], &[Vec3]),
    active: &mut Active,
) -> Result<PairWeights> {
    match parents {
        None => Ok(PairWeights::integrate(over.0, over.1, over.2)),
        Some(parents) => of_parts(parents, pair, over, x, active),
    }
}

#[inline(never)]
fn of_parts(
    (one, two): (&Parents, &Parents),
    (i, j): (usize, usize),
    over: (&NonmortarFrame, &Segment, &'static Rule),
    x: (&[Vec3], &[Vec3]),
    active: &mut Active,
) -> Result<PairWeights> {
    features::PARTS.is_here();
    let share = one.share(two, (i, j), over, x);
    let rows = one.space.nodes(one.facets[one.parent(i)].parent, one.sub(i));
    active.add_share((one.parent(i), two.parent(j)), rows, &share)
}
