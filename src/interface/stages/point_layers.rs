//! A layer that yields under pressure where points decide (docs/formulation 16.12).

use super::own::OwnAnswers;
use crate::error::Result;
use crate::interface::data::points::Points;
use crate::interface::pairing::given::Given;
use crate::memory::Store;

impl Points {
    /// What a layer that yields makes of the nodes' sigma: it adds the depth to the gap, and rhat acts in line with it.
    #[inline(never)]
    pub(super) fn give_way<const N: usize>(&mut self, given: Given<N>, own: &OwnAnswers) -> Result<()> {
        self.yields.clear();
        if given.setup.layer.is_none() {
            return Ok(());
        }
        self.settle_factors(given)?;
        for a in 0..given.nodes() {
            let [depth, slope, share] = own.yields(a).unwrap_or([0.0, 0.0, 1.0]);
            self.rhat[a] *= share;
            self.factors[a] *= share;
            self.yields.store([depth, 1.0 + self.rhat[a] * slope])?;
        }
        Ok(())
    }
}
