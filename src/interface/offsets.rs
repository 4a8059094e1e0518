//! Offsets of the nodes through the handle (docs/formulation 15), and what goes into them: nodes that are put onto the other
//! surface, and facets that are given back their shape.

use super::compose::Feature;
use super::contact::Contact;
use super::data::offsets;
use super::data::options::Weights;
use super::data::shape_offsets::shape_offsets;
use super::inspect::adjust::{Adjusted, adjusted};
use super::pairing::settle::Pairing;
use super::stages::commit;
use crate::error::Result;
use crate::features;
use crate::geometry::{AnalyticSurface, Vec3};
use crate::memory;

impl<const N: usize> Contact<N> {
    /// Offsets of the non-mortar and of the mortar nodes `[L]`; `None`: none. They count from the next evaluation on. Where they
    /// open gaps wider than before, pairs may be deeper, and those of the step are sought anew.
    pub fn set_offsets(&mut self, [one, two]: [Option<Vec<f64>>; 2]) -> Result<()> {
        let mut offsets = [offsets::checked(&self.setup.nonmortar, one)?, offsets::checked(&self.setup.mortar, two)?];
        let [_, of_mortar] = offsets.each_ref().map(|h| !h.is_empty());
        let is_there = offsets.iter().any(|h| !h.is_empty());
        if is_there {
            features::needs!(OFFSETS);
        }
        self.setup.refuse(&[(Feature::Offsets, is_there), (Feature::MortarOffsets, of_mortar)])?;
        let before = offsets::reach(self.setup.surfaces());
        self.swap_offsets(&mut offsets);
        if before != offsets::reach(self.setup.surfaces())
            && let Err(error) = self.settle_again()
        {
            self.swap_offsets(&mut offsets);
            return Err(error);
        }
        self.cache.forget();
        Ok(())
    }

    fn swap_offsets(&mut self, [one, two]: &mut [Vec<f64>; 2]) {
        std::mem::swap(&mut self.setup.nonmortar.offsets, one);
        std::mem::swap(&mut self.setup.mortar.offsets, two);
    }

    /// Seeks the pairs of the step again, which may be at other depths than when t_n was settled. Before the first commit t_n is
    /// settled again, too: otherwise nodes whose pairs were too deep count as uncovered then, and their first step would have no
    /// friction. Frozen weights are those of t_n, found then.
    pub(super) fn settle_again(&mut self) -> Result<()> {
        let weights = self.setup.options.effective_weights();
        if self.step.history.commits > 0 {
            if weights == Weights::Current {
                let (surfaces, history) = (self.setup.surfaces(), &self.step.history);
                let filter = commit::filter_again(surfaces, &self.setup.options, history, &mut self.cache.work)?;
                self.step.pairing = Pairing::new(&self.setup, filter, history)?;
                self.linear.forget();
            }
            return Ok(());
        }
        let (x1, x2) = (memory::copied(&self.step.history.x1)?, memory::copied(&self.step.history.x2)?);
        if self.setup.has_point_friction() {
            return self.set_previous(&x1, &x2); // other pairs have other points, none of which has slipped yet
        }
        let states = memory::copied(&self.step.history.states)?;
        if weights == Weights::Reference {
            self.set_previous(&x1, &x2)?;
            return memory::recopy(&mut self.step.history.states, &states);
        }
        let mut slip = memory::filled(Vec3::zeros(), self.setup.nonmortar.len())?;
        slip.iter_mut().zip(&self.step.history.slip).for_each(|(to, of)| *to = *of);
        self.set_committed(&x1, &x2, &slip, 0)?;
        memory::recopy(&mut self.step.history.states, &states)
    }

    /// The non-mortar nodes of the first configuration, those within `tolerance` `[L]` of the mortar surface moved onto it.
    pub fn adjusted(&self, tolerance: f64) -> Result<Vec<Adjusted>> {
        adjusted(&self.setup, tolerance)
    }

    /// Offsets that give the facets of a side (0: non-mortar, 1: mortar) this shape `[L]`.
    pub fn shape_offsets(&self, side: usize, shape: &AnalyticSurface) -> Result<Vec<f64>> {
        let (one, two) = self.setup.surfaces();
        shape_offsets(if side == 0 { one } else { two }, shape)
    }
}
