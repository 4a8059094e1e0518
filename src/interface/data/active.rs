//! The pairs that are active at a configuration, with their weights: what stage 1 gives.

use super::pairs::PairRecord;
use super::surface::{Surface, are_same, at_facet};
use crate::error::Result;
use crate::geometry::{Facet, Vec3};
use crate::memory::{self, Store};
use crate::mortar::{NonmortarFrame, PairWeights, Segment};
use crate::quadrature::Rule;

/// The active pairs at one configuration.
#[derive(Debug)]
pub struct Active {
    pub x1: Vec<Vec3>,
    pub x2: Vec<Vec3>,
    pub frames: Vec<NonmortarFrame>,
    pub pairs: Vec<PairRecord>,
    /// The overlap of each pair, kept for the tangent; none against an analytic mortar side.
    pub segments: Vec<Segment>,
    /// The weights as they were integrated, of each pair, where those in `pairs` are of the dual basis; else none.
    pub integrated: Vec<PairWeights>,
}

impl Active {
    /// No pairs at a configuration.
    pub fn none(x1: &[Vec3], x2: &[Vec3]) -> Result<Active> {
        let (x1, x2) = (memory::copied(x1)?, memory::copied(x2)?);
        Ok(Active { x1, x2, frames: Vec::new(), pairs: Vec::new(), segments: Vec::new(), integrated: Vec::new() })
    }

    /// The integrated weights of the pair in this place, whatever the multipliers' basis makes of them.
    pub fn integrated(&self, place: usize) -> &PairWeights {
        self.integrated.get(place).unwrap_or(&self.pairs[place].weights)
    }

    /// Whether it is that of these positions.
    pub fn is_at(&self, x1: &[Vec3], x2: &[Vec3]) -> bool {
        are_same(&self.x1, x1) && are_same(&self.x2, x2)
    }

    /// Adds those of a facet's candidates that have an overlap.
    pub fn add(
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
