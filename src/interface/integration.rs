//! Stage 1 over a whole interface: which pairs are active at a configuration, and their weights.
//!
//! A pair is active when its boxes meet, its facets overlap or touch in the auxiliary plane, and it
//! passed the filters of the last commit (opposing normals, distance). All of that is a function of the
//! positions and the history, so evaluating at A, B, A gives equal bits.

use super::history::{History, PairRecord};
use super::search::{Aabb, Candidates};
use super::{Counters, Interface, Options, Surface};
use crate::error::{Error, Kind, Result};
use crate::geometry::{Plane, Vec3};
use crate::mortar::{NonmortarFrame, PairWeights, Segment};
use crate::normal;
use std::time::Instant;

/// Facets whose normals oppose each other less than this are no pair: beyond 80 degrees the
/// projection degenerates, and back faces must not be found.
const LEAST_OPPOSITION: f64 = 0.17;
/// Boxes are grown by this (over the largest facet of their surface), so that touching facets meet.
const TOUCH_MARGIN: f64 = 1e-6;
/// The skin around boxes, over the mean non-mortar facet size: larger means fewer searches and more
/// candidates.
const SKIN: f64 = 0.25;
/// How much farther than the search distance of the last commit a pair may move within a step.
const REACH: f64 = 2.0;

/// The active pairs at one configuration.
#[derive(Debug)]
pub(super) struct Integration {
    pub x1: Vec<Vec3>,
    pub x2: Vec<Vec3>,
    pub frames: Vec<NonmortarFrame>,
    pub pairs: Vec<PairRecord>,
}

/// Names the facets in a refusal.
fn at_facet(side: &str, facet: usize) -> impl FnOnce(Error) -> Error {
    let place = format!("{side} facet {facet}: ");
    move |e| Error::new(e.kind, place + &e.message)
}

/// The frames of all facets of a surface.
fn frames(surface: &Surface, x: &[Vec3]) -> Result<Vec<NonmortarFrame>> {
    (0..surface.facets.len())
        .map(|f| NonmortarFrame::new(&surface.facet(f, x)).map_err(at_facet(surface.side, f)))
        .collect()
}

/// Refuses a mortar surface with facets that are degenerate, folded or concave in the first configuration,
/// whether they meet a non-mortar facet or not.
pub(super) fn check_mortar_facets(surface: &Surface) -> Result<()> {
    frames(surface, &surface.reference).map(|_| ())
}

/// Boxes of both sides: non-mortar facets reach along their normal.
fn boxes(
    one: &Surface,
    two: &Surface,
    frames: &[NonmortarFrame],
    x1: &[Vec3],
    x2: &[Vec3],
    reach: f64,
) -> [Vec<Aabb>; 2] {
    let facet_box = |s: &Surface, f: usize, x: &[Vec3]| {
        let facet = s.facet(f, x);
        Aabb::around(facet.points().iter().copied()).grown(TOUCH_MARGIN * facet.longest_edge())
    };
    let swept = frames.iter().enumerate().map(|(f, frame)| {
        let facet = one.facet(f, x1);
        // Finite even where the host sets no limit to the distance: infinity times a zero component is NaN.
        let along = frame.plane.e * reach.min(f64::MAX / 4.0);
        Aabb::around(facet.points().iter().flat_map(|p| [p - along, p + along]))
            .grown(TOUCH_MARGIN * facet.longest_edge())
    });
    [swept.collect(), (0..two.facets.len()).map(|f| facet_box(two, f, x2)).collect()]
}

/// The filters of a commit: opposing normals, and a distance along the normal.
fn build_candidates(
    one: &Surface,
    two: &Surface,
    committed: (&[Vec3], &[Vec3]),
    boxes: &[Vec<Aabb>; 2],
    distance: f64,
) -> Result<Candidates> {
    let (x1, x2) = committed;
    let facets1: Vec<_> = (0..one.facets.len()).map(|f| one.facet(f, x1)).collect();
    let facets2: Vec<_> = (0..two.facets.len()).map(|f| two.facet(f, x2)).collect();
    let planes = facets1.iter().map(Plane::of).collect::<Result<Vec<_>>>()?;
    let normals: Vec<_> = facets2.iter().map(|f| f.area_vector().normalize()).collect();
    let size = facets1.iter().map(|f| f.longest_edge()).sum::<f64>() / facets1.len() as f64;
    Ok(Candidates::build(&boxes[0], &boxes[1], SKIN * size, |i, j| {
        let plane = &planes[i];
        let heights = facets2[j].points().iter().map(|x| plane.e.dot(&(x - plane.reference - plane.origin)));
        let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), d| (l.min(d), h.max(d)));
        plane.e.dot(&normals[j]) < -LEAST_OPPOSITION && low <= distance && high >= -distance
    }))
}

/// Weights of all active pairs at (x1, x2), with the filters of the configuration `committed`.
#[allow(clippy::too_many_arguments)]
fn integrate(
    one: &Surface,
    two: &Surface,
    options: &Options,
    distance: f64,
    committed: (&[Vec3], &[Vec3]),
    candidates: &mut Candidates,
    counters: &mut Counters,
    x1: &[Vec3],
    x2: &[Vec3],
) -> Result<Integration> {
    let start = Instant::now();
    let frames = frames(one, x1)?;
    let boxes = boxes(one, two, &frames, x1, x2, REACH * distance);
    if !candidates.covers(&boxes[0], &boxes[1]) {
        *candidates = build_candidates(one, two, committed, &boxes, distance)?;
        counters.searches += 1;
    }
    counters.seconds_search += start.elapsed().as_secs_f64();

    let start = Instant::now();
    let mut pairs = Vec::new();
    for &(i, j) in &candidates.pairs {
        if !boxes[0][i].meets(&boxes[1][j]) {
            continue;
        }
        counters.pairs_tested += 1;
        let segment = Segment::new(&frames[i], &two.facet(j, x2))
            .map_err(at_facet(two.side, j))
            .map_err(at_facet(one.side, i))?;
        let Some(segment) = segment else { continue };
        counters.pairs_clipped += 1;
        counters.pairs_integrated += i64::from(segment.area > 0.0);
        pairs.push(PairRecord { one: i, two: j, weights: PairWeights::integrate(&frames[i], &segment, options.rule) });
    }
    counters.seconds_integration += start.elapsed().as_secs_f64();
    Ok(Integration { x1: x1.to_vec(), x2: x2.to_vec(), frames, pairs })
}

impl Interface {
    /// Makes `self.integration` that of (x1, x2). With frozen weights there is nothing to do.
    pub(super) fn ensure_integration(&mut self, x1: &[Vec3], x2: &[Vec3]) -> Result<()> {
        let done = self.integration.as_ref().is_some_and(|k| k.x1 == x1 && k.x2 == x2);
        if done || self.options.weights != super::Weights::Current {
            return Ok(());
        }
        let committed = (&self.history.x1[..], &self.history.x2[..]);
        self.integration = Some(integrate(
            &self.nonmortar,
            &self.mortar,
            &self.options,
            self.distance,
            committed,
            &mut self.candidates,
            &mut self.counters,
            x1,
            x2,
        )?);
        Ok(())
    }

    /// The history of a commit at (x1, x2), without gaps and slip: weights, normals, areas, coverage.
    pub(super) fn history_at(
        nonmortar: &Surface,
        mortar: &Surface,
        options: &Options,
        distance: f64,
        counters: &mut Counters,
        x1: &[Vec3],
        x2: &[Vec3],
    ) -> Result<History> {
        for f in 0..mortar.facets.len() {
            Plane::of(&mortar.facet(f, x2)).map_err(at_facet(mortar.side, f))?;
        }
        let mut none = Candidates::default();
        let new = integrate(nonmortar, mortar, options, distance, (x1, x2), &mut none, counters, x1, x2)?;
        let n1 = nonmortar.len();
        let mut history = History {
            commits: 0,
            x1: new.x1,
            x2: new.x2,
            normals: Vec::with_capacity(n1),
            areas: vec![0.0; n1],
            coverage: vec![0.0; n1],
            gap: vec![Vec3::zeros(); n1],
            slip: vec![Vec3::zeros(); n1],
            pairs: new.pairs,
        };
        let mut sums = vec![Vec3::zeros(); n1];
        for (f, frame) in new.frames.iter().enumerate() {
            let (facet, areas) = (nonmortar.facet(f, x1), frame.nodal_areas());
            for k in 0..facet.len() {
                let node = nonmortar.facets[f].nodes[k];
                sums[node] += normal::corner_normal(&facet, k);
                history.areas[node] += areas[k];
            }
        }
        for (node, sum) in sums.into_iter().enumerate() {
            history.normals.push(normal::nodal_normal(sum, node)?);
            if !(history.areas[node] > 0.0) {
                let text = format!(
                    "the area of non-mortar node {node} is not positive: the facets around it are too distorted"
                );
                return Err(Error::new(Kind::DegenerateFacet, text));
            }
        }
        Ok(history)
    }

    /// The pairs whose weights act now.
    pub(super) fn current_pairs(&self) -> &[PairRecord] {
        self.integration.as_ref().map_or(&self.history.pairs, |k| &k.pairs)
    }

    /// All pairs that may become active before the next search, and those of t_n, sorted.
    pub(super) fn possible_pairs(&self) -> Vec<(usize, usize)> {
        let mut pairs: Vec<_> = self.history.pairs.iter().map(|p| (p.one, p.two)).collect();
        pairs.extend(&self.candidates.pairs);
        pairs.sort_unstable();
        pairs.dedup();
        pairs
    }
}
