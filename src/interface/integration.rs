//! Stage 1 over a whole interface: which pairs are active at a configuration, and their weights.
//!
//! A pair is active when its facets overlap or touch in the auxiliary plane and it passed the filters of
//! the last commit (opposing normals, heights). All of that is a function of the positions and the
//! history, so evaluating at A, B, A gives equal bits. An analytic mortar side has its own filter and its own way
//! (`analytic.rs`).

use super::facet_gaps::FacetGaps;
use super::filter::{FacetFilter, Filter};
use super::history::{History, Keeps, PairRecord};
use super::nodes::{NodeSums, assemble};
use super::search::{Aabb, Prism, Tree};
use super::{Contact, Counters, Extent, Options, Scheme, Surface, Weights, analytic, apart, layers};
use crate::error::{Error, Kind, Result};
use crate::geometry::{AnalyticSurface, Facet, Vec3};
use crate::memory::{self, Store, Stored};
use crate::mortar::{ForceDerivatives, GapDerivative, NonmortarFrame, PairWeights, Segment, facet_motion, pair_motion};
use crate::normal;
use crate::quadrature::Rule;
use crate::shape::MAX_NODES;
use std::time::Instant;

/// Prisms are grown by this (over the facet's longest edge), so that touching facets are visited.
const TOUCH_MARGIN: f64 = 1e-6;
/// How far (over the facet's longest edge) surfaces may move within their plane before a tangent needs
/// entries beyond the superset pattern.
const SKIN: f64 = 0.25;

/// The active pairs at one configuration.
#[derive(Debug)]
pub(super) struct Integration {
    pub x1: Vec<Vec3>,
    pub x2: Vec<Vec3>,
    pub frames: Vec<NonmortarFrame>,
    pub pairs: Vec<PairRecord>,
    /// The overlap of each pair, kept for the tangent; none against an analytic mortar side.
    pub segments: Vec<Segment>,
    /// What the nodes assemble over the pairs here, once it was asked for, and for what.
    pub sums: Option<(Extent, Vec<NodeSums>)>,
    /// `Whole`: it was asked first whether the surfaces are apart, here and at t_n.
    pub extent: Extent,
    /// They are: nothing was looked at.
    pub apart: bool,
}

/// Whether positions are the same numbers; 0 and -0 are not, nor are results in every bit.
fn are_same(x: &[Vec3], y: &[Vec3]) -> bool {
    let bits = |x: &Vec3| [x.x, x.y, x.z].map(f64::to_bits);
    x.len() == y.len() && x.iter().zip(y).all(|(x, y)| bits(x) == bits(y))
}

impl Integration {
    /// Whether it is that of these positions.
    fn is_at(&self, x1: &[Vec3], x2: &[Vec3]) -> bool {
        are_same(&self.x1, x1) && are_same(&self.x2, x2)
    }

    /// Adds those of a facet's candidates that have an overlap.
    fn add(
        &mut self,
        (one, two): (&Surface, &Surface),
        candidates: &[(usize, usize)],
        rule: &Rule,
        overlap: impl Fn(&NonmortarFrame, &Facet) -> Result<Option<Segment>>,
    ) -> Result<()> {
        for &(i, j) in candidates {
            let frame = &self.frames[i];
            match overlap(frame, &two.facet(j, &self.x2)) {
                Ok(Some(segment)) => self.segments.store(segment)?,
                Ok(None) => continue,
                Err(e) => return Err(at_facet(one.side, i)(at_facet(two.side, j)(e))),
            }
            let segment = &self.segments[self.segments.len() - 1];
            self.pairs.store(PairRecord { one: i, two: j, weights: PairWeights::integrate(frame, segment, rule) })?;
        }
        Ok(())
    }
}

/// A configuration that becomes t_n, with nothing slipped.
pub(super) struct Start {
    pub history: History,
    /// The filter of the step that follows; `None` where the weights are frozen for good.
    pub filter: Option<Filter>,
    /// The weights, where the history does not keep them: the next evaluation may well be here.
    pub integration: Option<Integration>,
}

/// Names the facets in a refusal.
pub(super) fn at_facet(side: &str, facet: usize) -> impl FnOnce(Error) -> Error {
    move |e| Error::new(e.kind, text!("{side} facet {facet}: {}", e.message))
}

/// The frames of all facets of a surface.
pub(super) fn frames(surface: &Surface, x: &[Vec3]) -> Result<Vec<NonmortarFrame>> {
    // A collected Result knows no length, and frames are large.
    let mut frames = memory::with_room(surface.facets.len())?;
    for f in 0..surface.facets.len() {
        frames.store(NonmortarFrame::new(&surface.facet(f, x)).map_err(at_facet(surface.side, f))?)?;
    }
    for edge in &surface.edges {
        // Each runs the edge from another end.
        for (i, from) in edge.nodes.into_iter().enumerate() {
            let (facet, beyond) = (edge.facets[i], frames[edge.facets[1 - i]].plane.e);
            if let Some(k) = surface.facets[facet].as_slice().iter().position(|&node| node == from) {
                frames[facet].plane.beyond[k] = Some(beyond);
            }
        }
    }
    Ok(frames)
}

/// Refuses a mortar surface with facets that are degenerate, folded or concave in the first configuration,
/// whether they meet a non-mortar facet or not.
pub(super) fn check_mortar_facets(surface: &Surface) -> Result<()> {
    if surface.analytic.is_some() {
        return Ok(());
    }
    frames(surface, &surface.reference).map(|_| ())
}

/// The search tree over a mortar surface, with the positions that it is of: a mortar side at rest needs one alone.
#[derive(Debug, Default)]
pub(super) struct KeptTree {
    pub x2: Vec<Vec3>,
    pub tree: Option<Tree>,
}

impl KeptTree {
    /// The tree of `two` at `x2`.
    pub fn at(&mut self, two: &Surface, x2: &[Vec3]) -> Result<&Tree> {
        if !are_same(&self.x2, x2) {
            *self = KeptTree { x2: memory::copied(x2)?, tree: None };
        }
        let facet_box = |f: usize| Aabb::around(two.facet(f, x2).points().iter().copied());
        if self.tree.is_none() {
            self.tree = Some(Tree::new((0..two.facets.len()).map(facet_box).stored()?)?);
        }
        Ok(self.tree.as_ref().expect("there is one now"))
    }
}

/// Pairs that pass the filter and whose mortar facet may reach into the non-mortar facet's prism, grown by
/// `skin` (over the facet's longest edge). Sorted.
pub(super) fn candidates(
    one: &Surface,
    frames: &[NonmortarFrame],
    x1: &[Vec3],
    (tree, filter): (&Tree, &FacetFilter),
    skin: f64,
    visited: &mut i64,
) -> Result<Vec<(usize, usize)>> {
    let (mut pairs, mut found) = (Vec::new(), Vec::new());
    for (i, frame) in frames.iter().enumerate().filter(|&(i, _)| filter.reached[i]) {
        let facet = one.facet(i, x1);
        let prism = Prism::over(facet.points(), &frame.plane, (TOUCH_MARGIN + skin) * facet.longest_edge());
        *visited += tree.find(&prism, &mut found)? as i64;
        pairs.store_all(found.iter().filter(|&&j| filter.admits(i, j)).map(|&j| (i, j)))?;
    }
    Ok(pairs)
}

/// The points of non-mortar facet `i` where it is integrated by points.
fn by_points(options: &Options, filter: &FacetFilter, i: usize) -> Option<&'static [[f64; 2]]> {
    match options.scheme {
        Scheme::Segments => None,
        Scheme::Elements(line) => Some(line),
        Scheme::Hybrid(line) => (!filter.by_cells[i]).then_some(line),
    }
}

/// Weights of all active pairs at (x1, x2), with the filter of another or the same configuration.
pub(super) fn integrate(
    (one, two): (&Surface, &Surface),
    options: &Options,
    filter: &Filter,
    (counters, tree): (&mut Counters, &mut KeptTree),
    (x1, x2): (&[Vec3], &[Vec3]),
) -> Result<Integration> {
    let filter = match filter {
        Filter::Facets(filter) => filter,
        Filter::Analytic(facing) => return analytic::integrate((one, two), options, facing, counters, (x1, x2)),
    };
    let start = Instant::now();
    let frames = frames(one, x1)?;
    let candidates = candidates(one, &frames, x1, (tree.at(two, x2)?, filter), 0.0, &mut counters.boxes_visited)?;
    counters.searches += 1;
    counters.seconds_search += start.elapsed().as_secs_f64();

    let start = Instant::now();
    let mut active = Integration {
        x1: memory::copied(x1)?,
        x2: memory::copied(x2)?,
        frames,
        // Large, too; candidates that do not overlap are few.
        pairs: memory::with_room(candidates.len())?,
        segments: memory::with_room(candidates.len())?,
        sums: None,
        extent: Extent::Part,
        apart: false,
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

/// The derivatives of one pair of facets that both move, as `Motion` has them.
pub(super) fn motion(
    _: Option<&AnalyticSurface>,
    frame: &NonmortarFrame,
    (pairs, segments): (&[PairRecord], &[Segment]),
    rule: &Rule,
    traction: &[[f64; MAX_NODES]; 3],
    forces: &mut ForceDerivatives,
) -> Result<GapDerivative> {
    Ok(GapDerivative::Facets(pair_motion((frame, &segments[0], rule), &pairs[0].weights, traction, forces)))
}

/// Those of all pairs of a non-mortar facet, the mortar side at rest; of points in place of cells one pair.
pub(super) fn motion_at_rest(
    surface: Option<&AnalyticSurface>,
    frame: &NonmortarFrame,
    (pairs, segments): (&[PairRecord], &[Segment]),
    rule: &Rule,
    traction: &[[f64; MAX_NODES]; 3],
    forces: &mut ForceDerivatives,
) -> Result<GapDerivative> {
    if segments[0].points.is_some() {
        return motion(surface, frame, (pairs, segments), rule, traction, forces);
    }
    let pairs = segments.iter().zip(pairs.iter().map(|pair| &pair.weights));
    Ok(GapDerivative::Facets(facet_motion(frame, pairs, rule, traction, forces)))
}

/// Either of both but for the tilt of the non-mortar facet's plane.
pub(super) fn without_tilt<const MOVES: bool>(
    surface: Option<&AnalyticSurface>,
    frame: &NonmortarFrame,
    pairs: (&[PairRecord], &[Segment]),
    rule: &Rule,
    traction: &[[f64; MAX_NODES]; 3],
    forces: &mut ForceDerivatives,
) -> Result<GapDerivative> {
    let mut frame = frame.clone();
    frame.plane.tilt = Default::default();
    let motion = if MOVES { motion } else { motion_at_rest };
    motion(surface, &frame, pairs, rule, traction, forces)
}

impl<const N: usize> Contact<N> {
    /// Makes `self.integration` that of (x1, x2), as an evaluation of this extent needs it. With frozen weights there is
    /// nothing to do, nor, but for a comparison, where the surfaces are apart.
    pub(super) fn ensure_integration(&mut self, x1: &[Vec3], x2: &[Vec3], extent: Extent) -> Result<()> {
        if self.options.effective_weights() != Weights::Current {
            self.counters.pairs_reused += self.history.pairs.len() as i64;
            self.count_pairs();
            return Ok(());
        }
        let kept = self.integration.as_ref().filter(|k| k.is_at(x1, x2)).map(|k| (k.extent, k.apart));
        let serves = kept.is_some_and(|(of, apart)| of == extent || (of == Extent::Whole && !apart));
        if !serves {
            let apart = extent == Extent::Whole && self.stays_apart(x1, x2)?;
            self.counters.evaluations_apart += i64::from(apart);
            if apart || kept.is_none_or(|(_, apart)| apart) {
                self.integration = Some(self.integrate_at((x1, x2), apart)?);
            }
            if let Some(k) = &mut self.integration {
                k.extent = extent;
            }
        }
        self.count_pairs();
        Ok(())
    }

    /// The pairs at (x1, x2), or none.
    fn integrate_at(&mut self, (x1, x2): (&[Vec3], &[Vec3]), apart: bool) -> Result<Integration> {
        if apart {
            let (x1, x2, extent) = (memory::copied(x1)?, memory::copied(x2)?, Extent::Whole);
            let (frames, pairs, segments) = (Vec::new(), Vec::new(), Vec::new());
            return Ok(Integration { x1, x2, frames, pairs, segments, sums: None, extent, apart });
        }
        self.ensure_history()?;
        let surfaces = (&self.nonmortar, &self.mortar);
        let filter = self.filter.as_ref().expect("current weights have one");
        integrate(surfaces, &self.options, filter, (&mut self.counters, &mut self.tree), (x1, x2))
    }

    /// Notes how many pairs are active here.
    pub(super) fn count_pairs(&mut self) {
        self.counters.pairs_active = self.current_pairs().len();
    }

    /// Makes up for overlaps that a commit did not keep.
    pub(super) fn ensure_segments(&mut self) -> Result<()> {
        let Some(k) = self.integration.as_mut().filter(|k| k.segments.len() < k.pairs.len()) else { return Ok(()) };
        if let Some(Filter::Facets(filter)) = &self.filter {
            let mut segments = memory::with_room(k.pairs.len())?;
            for pair in &k.pairs {
                let (frame, facet) = (&k.frames[pair.one], self.mortar.facet(pair.two, &k.x2));
                let segment = match by_points(&self.options, filter, pair.one) {
                    Some(line) => Segment::of_points(frame, &facet, line)?,
                    None => Segment::new(frame, &facet)?,
                };
                segments.store(segment.expect("an active pair has a segment at the positions it was found at"))?;
            }
            k.segments = segments;
        }
        Ok(())
    }

    /// Whether the last evaluation found the surfaces apart.
    pub(super) fn is_apart(&self) -> bool {
        self.integration.as_ref().is_some_and(|k| k.apart)
    }

    /// Makes up for the weights of t_n where they were left out because the surfaces were apart then. Frozen weights
    /// never are.
    pub(super) fn ensure_history(&mut self) -> Result<()> {
        if self.options.effective_weights() != Weights::Current {
            return Ok(());
        }
        let (surfaces, h) = ((&self.nonmortar, &self.mortar), &self.history);
        if !h.integrated
            && let Some(filter) = &self.filter
        {
            let mut new =
                integrate(surfaces, &self.options, filter, (&mut self.counters, &mut self.tree), (&h.x1, &h.x2))?;
            let sums = assemble(surfaces, &new.pairs, &h.x1, &h.x2)?;
            layers::refuse(&self.mortar, &new)?;
            self.history.fill(&mut new.pairs, &sums)?;
        }
        Ok(())
    }

    /// What a commit at (x1, x2) begins with.
    pub(super) fn start_at(
        (nonmortar, mortar): (&Surface, &Surface),
        options: &Options,
        extent: Extent,
        (counters, tree): (&mut Counters, &mut KeptTree),
        (x1, x2): (&[Vec3], &[Vec3]),
    ) -> Result<Start> {
        let n1 = nonmortar.len();
        let keeps = Keeps::of(options);
        let zeros = |kept: usize| memory::filled(Vec3::zeros(), kept * n1);
        let [gap, slip] = keeps.gaps_and_slips();
        let mut history = History {
            keeps,
            commits: 0,
            x1: memory::copied(x1)?,
            x2: memory::copied(x2)?,
            normals: memory::with_room(n1)?,
            areas: memory::filled(0.0, n1)?,
            coverage: memory::filled(0.0, n1)?,
            gap: zeros(gap)?,
            facet_gaps: FacetGaps::default(),
            slip: zeros(slip)?,
            pairs: Vec::new(),
            integrated: false,
        };
        // Also where the surfaces are apart: a commit refuses degenerate facets of either side.
        let filter = Filter::new(nonmortar, mortar, options, x1, x2)?;
        let mut integration = None;
        // Which nodes carry others follows from what is covered: a step must know it from the start.
        let leaves_out = extent == Extent::Whole && options.weak_coverage == 0.0;
        let frames = if leaves_out && apart::are_apart((nonmortar, mortar), options, &filter, &[(x1, x2)])? {
            counters.commits_apart += 1;
            &frames(nonmortar, x1)?
        } else {
            let mut new = integrate((nonmortar, mortar), options, &filter, (counters, tree), (x1, x2))?;
            layers::refuse(mortar, &new)?;
            let mut sums = assemble((nonmortar, mortar), &new.pairs, x1, x2)?;
            if keeps.facet_gaps() {
                history.facet_gaps = FacetGaps::of((nonmortar, mortar), &new, &mut sums)?;
            }
            history.fill(&mut new.pairs, &sums)?;
            &integration.insert(new).frames
        };
        for (facet, frame) in nonmortar.facets.iter().zip(frames) {
            facet.as_slice().iter().zip(frame.nodal_areas()).for_each(|(&node, area)| history.areas[node] += area);
        }
        for (node, sum) in nonmortar.sums_of_normals(x1)?.into_iter().enumerate() {
            history.normals.store(normal::nodal_normal(sum, node)?)?;
            if !(history.areas[node] > 0.0) {
                let text =
                    text!("the area of non-mortar node {node} is not positive: the facets around it are too distorted");
                return Err(Error::new(Kind::DegenerateFacet, text));
            }
        }
        // The weights alone: many interfaces never ask for a tangent where a step ends.
        let integration = integration.filter(|_| keeps == Keeps::Nothing);
        let integration = integration.map(|k| Integration { segments: Vec::new(), ..k });
        Ok(Start { history, filter: Some(filter), integration })
    }

    /// The pairs whose weights act now.
    pub(super) fn current_pairs(&self) -> &[PairRecord] {
        self.integration.as_ref().map_or(&self.history.pairs, |k| &k.pairs)
    }

    /// The pairs of t_n and all that may be active while the surfaces move by less than the skin, sorted.
    pub(super) fn possible_pairs(&mut self, x1: &[Vec3], x2: &[Vec3]) -> Result<Vec<(usize, usize)>> {
        let h = &self.history;
        let mut pairs: Vec<_> = h.pairs.iter().map(|p| (p.one, p.two)).stored()?;
        if self.options.effective_weights() == Weights::Current {
            match self.filter.as_ref().expect("current weights have one") {
                Filter::Facets(filter) => {
                    // Those of t_n are sought as those of now: whether their weights were left out, because the surfaces
                    // were apart, does not matter then, and nothing is integrated for a pattern.
                    let once = h.keeps == Keeps::Nothing || (x1, x2) == (&h.x1[..], &h.x2[..]);
                    for (x1, x2) in [(x1, x2), (&h.x1[..], &h.x2[..])].into_iter().take(if once { 1 } else { 2 }) {
                        let (frames, tree) = (frames(&self.nonmortar, x1)?, self.tree.at(&self.mortar, x2)?);
                        let found = candidates(&self.nonmortar, &frames, x1, (tree, filter), SKIN, &mut 0)?;
                        pairs.store_all(found.into_iter())?;
                    }
                }
                Filter::Analytic(facing) => {
                    pairs.store_all((0..facing.len()).filter(|&i| facing[i]).map(|i| (i, 0)))?
                }
            }
        }
        pairs.sort_unstable();
        pairs.dedup();
        Ok(pairs)
    }
}
