//! Quadratic facets of a surface, as hosts have them (docs/formulation 12). Planes, overlaps, search and normals' planes are
//! of the linear facets between their nodes, the parts, which are what a surface calls its facets. Gaps, forces and histories are
//! of the facets of the host, the parents.
//!
//! An interface where either side has a quadratic facet has parents on both: a linear facet is its own part.

use super::facet_nodes::{FacetNodes, ParentNodes};
use super::lines::{Lines, line};
use crate::error::{Error, Result};
use crate::geometry::{AnalyticSurface, Vec3};
use crate::line::{LineFacet, LineWeights, MAX_LINE_NODES, Measure};
use crate::memory::{self, Store, Stored};
use crate::mortar::{
    MultiplierSpace, NonmortarFrame, ParentFacet, Segment, Side, SubWeights, SurfacePair, area_element, rule_for,
    sub_weights,
};
use crate::quadrature::Rule;
use crate::shape::{MAX_PARENT_NODES, Parent, SubFacet};
use std::ops::Range;

/// The parents of a surface.
#[derive(Clone, Debug)]
pub struct Parents {
    /// All of them.
    pub facets: Vec<ParentNodes>,
    /// Where the parts of each begin; one more at the end.
    pub(super) first: Vec<usize>,
    /// Per part its parent.
    pub(super) of: Vec<u32>,
    /// Where multipliers stand.
    pub space: MultiplierSpace,
    /// What they are where all of them are lines, of a plane or axisymmetric model; `None`: of a model in space.
    pub lines: Option<Lines>,
    /// Per part the nodes that have the multipliers over it.
    rows: Vec<FacetNodes>,
    /// Per node, whether any facet has a multiplier there.
    pub has_row: Vec<bool>,
}

impl Parents {
    /// These, and the parts that they consist of.
    pub fn of(facets: Vec<ParentNodes>) -> Result<(Parents, Vec<FacetNodes>)> {
        let parts = facets.iter().map(|facet| facet.parent.subs.len()).sum();
        let (mut first, mut of) = (memory::with_room(facets.len() + 1)?, memory::with_room(parts)?);
        let mut nodes = memory::with_room(parts)?;
        for (f, facet) in facets.iter().enumerate() {
            first.store(of.len())?;
            for sub in facet.parent.subs {
                of.store(f as u32)?;
                nodes.store(facet.part(&sub.nodes[..sub.shape.n]))?;
            }
        }
        first.store(of.len())?;
        let (space, lines) = (MultiplierSpace::Corner, None);
        let mut parents = Parents { facets, first, of, space, lines, rows: Vec::new(), has_row: Vec::new() };
        parents.put(MultiplierSpace::Corner)?;
        Ok((parents, nodes))
    }

    /// Those of a surface of linear facets alone.
    pub fn of_linear(parts: &[FacetNodes]) -> Result<Parents> {
        let parent = |part: &FacetNodes| {
            let mut nodes = [part.nodes[0]; MAX_PARENT_NODES];
            nodes[..part.len].copy_from_slice(part.as_slice());
            ParentNodes { parent: Parent::of(part.len).expect("a checked facet has 3 or 4 nodes"), nodes }
        };
        Ok(Parents::of(parts.iter().map(parent).stored()?)?.0)
    }

    /// Puts multipliers where a space has them.
    pub fn put(&mut self, space: MultiplierSpace) -> Result<()> {
        let row = |part: usize| {
            let facet = &self.facets[self.parent(part)];
            facet.part(space.nodes(facet.parent, self.sub(part)))
        };
        self.rows = (0..self.of.len()).map(row).stored()?;
        let nodes = self.facets.iter().flat_map(|facet| facet.as_slice()).max().map_or(0, |last| last + 1);
        memory::refill(&mut self.has_row, false, nodes)?;
        for row in &self.rows {
            row.as_slice().iter().for_each(|&a| self.has_row[a] = true);
        }
        self.space = space;
        Ok(())
    }

    /// Refuses facets that no evaluation could use at these node positions.
    ///
    /// # Errors
    /// [`crate::error::Kind::DegenerateFacet`]: see [`ParentFacet::new`].
    pub fn check(&self, x: &[Vec3]) -> Result<()> {
        for (f, facet) in self.facets.iter().enumerate() {
            let at = self.at(f, x);
            match self.lines {
                None => ParentFacet::new(&at.x[..facet.parent.n]).map(|_| ()).map_err(self.named(f))?,
                Some(_) => LineFacet::new(&line(&at).x[..facet.parent.n]).map(|_| ()).map_err(self.named(f))?,
            }
        }
        Ok(())
    }

    /// Refuses facets that have no normal to go by at a node.
    ///
    /// # Errors
    /// [`crate::error::Kind::DegenerateFacet`]: see [`ParentFacet::check_normals`].
    pub fn check_normals(&self, x: &[Vec3]) -> Result<()> {
        let count = if self.lines.is_none() { self.facets.len() } else { 0 };
        (0..count).try_for_each(|f| self.at(f, x).check_normals().map_err(self.named(f)))
    }

    /// A facet's refusal, with its name.
    fn named(&self, f: usize) -> impl Fn(Error) -> Error + '_ {
        move |e| Error::new(e.kind, text!("facet {f}, nodes {:?}: {}", self.facets[f].as_slice(), e.message))
    }

    /// The nodes that have the multipliers over a part.
    pub fn rows(&self, part: usize) -> &FacetNodes {
        &self.rows[part]
    }

    /// The parent of a part.
    pub fn parent(&self, part: usize) -> usize {
        self.of[part] as usize
    }

    /// Which part of its parent it is.
    pub fn sub(&self, part: usize) -> &'static SubFacet {
        let f = self.parent(part);
        &self.facets[f].parent.subs[part - self.first[f]]
    }

    /// The parts of a parent.
    pub fn parts(&self, f: usize) -> Range<usize> {
        self.first[f]..self.first[f + 1]
    }

    /// How many multipliers a parent has: at the first so many of its nodes.
    pub fn multipliers(&self, f: usize) -> usize {
        let parent = self.facets[f].parent;
        if self.space == MultiplierSpace::Corner { parent.corners() } else { parent.n }
    }

    /// A parent at these node positions.
    pub fn at(&self, f: usize, x: &[Vec3]) -> ParentFacet {
        let ParentNodes { parent, nodes } = &self.facets[f];
        ParentFacet { parent, x: nodes.map(|k| x[k]) }
    }

    /// The two sides of a pair of parts: part `i` of these and part `j` of `two`.
    pub fn sides(&self, two: &Parents, (i, j): (usize, usize)) -> (Side, Side) {
        let side = |parents: &Parents, part: usize| (parents.facets[parents.parent(part)].parent, parents.sub(part));
        (side(self, i), side(two, j))
    }

    /// int N_A da of the multipliers of a space over a parent, covered or not [L^2].
    pub fn areas(&self, f: usize, x: &[Vec3], space: MultiplierSpace) -> Result<[f64; MAX_PARENT_NODES]> {
        let Some(Lines { measure, .. }) = self.lines else { return self.at(f, x).areas(space) };
        let mut areas = [0.0; MAX_PARENT_NODES];
        areas[..MAX_LINE_NODES].copy_from_slice(&line(&self.at(f, x)).areas(space, measure));
        Ok(areas)
    }

    /// The weights over an overlap of such a pair at these positions of both sides, by a rule that is fine enough for its
    /// functions.
    pub fn share(
        &self,
        two: &Parents,
        parts: (usize, usize),
        (frame, segment, rule): (&NonmortarFrame, &Segment, &'static Rule),
        x: (&[Vec3], &[Vec3]),
    ) -> SubWeights {
        if let Some(Lines { measure, .. }) = self.lines {
            return self.share_of_lines(two, parts, measure, x);
        }
        let sides = self.sides(two, parts);
        let rule = rule_for(rule, [sides.0.0, sides.1.0]);
        sub_weights((frame, segment, rule), sides, self.space, None)
    }

    /// The same of lines, whose overlaps need no frame and no rule.
    fn share_of_lines(
        &self,
        two: &Parents,
        (i, j): (usize, usize),
        measure: Measure,
        (x1, x2): (&[Vec3], &[Vec3]),
    ) -> SubWeights {
        let (f, g) = (self.parent(i), two.parent(j));
        let [one, other] = [line(&self.at(f, x1)), line(&two.at(g, x2))];
        let mut n = LineWeights::default();
        n.add_parts([&one, &other], (i - self.first[f], j - two.first[g]), self.space, measure);
        let mut share = SubWeights::default();
        for (a, &row) in self.space.nodes(self.facets[f].parent, self.sub(i)).iter().enumerate() {
            share.ab[a][..MAX_LINE_NODES].copy_from_slice(&n.ab[row]);
            share.ac[a][..MAX_LINE_NODES].copy_from_slice(&n.ac[row]);
        }
        share
    }

    /// A part at these node positions opposite an analytic surface, with its frame, and its parent's nodes from the surface's
    /// origin.
    pub fn over_surface<R>(
        &self,
        part: usize,
        (frame, x1): (&NonmortarFrame, &[Vec3]),
        (surface, rule): (&AnalyticSurface, &'static Rule),
        of: impl FnOnce(SurfacePair, &[Vec3; MAX_PARENT_NODES]) -> Result<R>,
    ) -> Result<R> {
        let f = self.parent(part);
        let at = self.at(f, x1);
        let area = match self.lines {
            None => area_element(frame),
            Some(Lines { measure, .. }) => line(&at).area_element(part - self.first[f], measure),
        };
        let side = (self.facets[f].parent, self.sub(part));
        of(SurfacePair { side, space: self.space, area: &area, surface, rule }, &at.x.map(|x| x - surface.origin))
    }

    /// On the heap `[bytes]`.
    pub fn bytes(&self) -> usize {
        self.facets.capacity() * size_of::<ParentNodes>()
            + self.first.capacity() * size_of::<usize>()
            + self.of.capacity() * size_of::<u32>()
            + self.rows.capacity() * size_of::<FacetNodes>()
            + self.has_row.capacity()
    }
}
