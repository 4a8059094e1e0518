//! The pairs that are active at a configuration, with their weights: what stage 1 gives. Overlaps are not among it: they take
//! three times as much memory as the weights, and are found again where they are needed (`pairing/overlaps.rs`).

use super::pairs::{PairRecord, ParentRecord, Weighted};
use super::surface::{Surface, are_same};
use crate::error::{Error, Result};
use crate::geometry::Vec3;
use crate::memory::{self, Store};
use crate::mortar::{PairWeights, ParentWeights, SubWeights};

/// The active pairs at one configuration. Its memory is kept from one configuration to the next.
#[derive(Debug, Default)]
pub struct Active {
    pub x1: Vec<Vec3>,
    pub x2: Vec<Vec3>,
    /// Unit normals of the planes of all non-mortar facets, of which a facet's edges must know those beyond; none without
    /// an integration.
    pub normals: Vec<Vec3>,
    pub pairs: Vec<PairRecord>,
    /// The overlap's area of each pair, 0 where facets only touch [L^2]; none against an analytic mortar side.
    pub areas: Vec<f64>,
    /// The weights as they were integrated, of each pair, where those in `pairs` are of the dual basis; else none.
    pub integrated: Vec<PairWeights>,
    /// The pairs of parents, sorted, where either side has quadratic facets; else none.
    pub parents: Vec<ParentRecord>,
    /// Their weights as they were integrated, where those in `parents` are of the dual basis; else none.
    pub integrated_parents: Vec<ParentWeights>,
    /// Pairs that the search found here and the filter did not admit; none against an analytic mortar side.
    pub excluded: Vec<(u32, u32)>,
    /// Whether these are all that the filter of the step does not admit, of facets that it says can have a pair.
    pub knows_excluded: bool,
    /// What is wrong with the multipliers' basis of a facet: said after what is wrong with any pair.
    pub refused: Option<Error>,
}

impl Active {
    /// Begins anew, without pairs.
    pub fn begin(&mut self, x1: &[Vec3], x2: &[Vec3]) -> Result<()> {
        self.clear();
        memory::recopy(&mut self.x1, x1)?;
        memory::recopy(&mut self.x2, x2)
    }

    /// Takes all pairs away, and what is known of their facets.
    pub fn clear(&mut self) {
        self.normals.clear();
        self.clear_pairs();
    }

    /// Takes all pairs away.
    pub fn clear_pairs(&mut self) {
        self.pairs.clear();
        self.areas.clear();
        self.integrated.clear();
        self.parents.clear();
        self.integrated_parents.clear();
        self.excluded.clear();
        self.knows_excluded = false;
        self.refused = None;
    }

    /// Room for so many pairs more, of which there will probably be so many in all.
    pub fn grow(&mut self, pairs: usize, all: usize) -> Result<()> {
        memory::grow_to(&mut self.pairs, pairs, all)?;
        memory::grow_to(&mut self.areas, pairs, all)
    }

    /// Adds a pair with the area of its overlap.
    pub fn add(&mut self, pair: PairRecord, area: f64) -> Result<()> {
        self.areas.store(area)?;
        self.pairs.store(pair)
    }

    /// Puts the pairs of parents in their order.
    #[inline(never)] // sorting is large
    pub fn order_parents(&mut self) {
        self.parents.sort_unstable_by_key(|pair| (pair.one, pair.two));
    }

    /// Adds what a pair of parts has to the pair of their parents `one` and `two`; those of `one` alone are the last ones.
    /// `rows`: which of the nodes of `one` the rows of the weights are. Gives what is covered of each of them, as a pair of parts
    /// keeps it.
    pub fn add_share(&mut self, (one, two): (usize, usize), rows: &[usize], share: &SubWeights) -> Result<PairWeights> {
        let place = match self.parents.iter().rposition(|p| p.one != one || p.two == two) {
            Some(k) if self.parents[k].one == one => k,
            _ => {
                self.parents.store(ParentRecord { one, two, weights: ParentWeights::default() })?;
                self.parents.len() - 1
            }
        };
        self.parents[place].weights.add(rows, share);
        let mut weights = PairWeights::default();
        for (a, row) in share.ab.iter().enumerate() {
            weights.ab[a][a] = row.iter().sum();
        }
        Ok(weights)
    }

    /// The weights of the pair of parents in this place as they were integrated.
    pub fn integrated_parent(&self, place: usize) -> &ParentWeights {
        self.integrated_parents.get(place).unwrap_or(&self.parents[place].weights)
    }

    /// Adds the pairs of facets that follow, and what is wrong with them.
    pub fn append(&mut self, other: &mut Active) -> Result<()> {
        memory::extend(&mut self.pairs, &other.pairs)?;
        memory::extend(&mut self.areas, &other.areas)?;
        memory::extend(&mut self.integrated, &other.integrated)?;
        memory::extend(&mut self.parents, &other.parents)?;
        memory::extend(&mut self.excluded, &other.excluded)?;
        self.refused = self.refused.take().or(other.refused.take());
        Ok(())
    }

    /// The pairs whose weights act between these surfaces.
    pub fn weighted(&self, surfaces: (&Surface, &Surface)) -> Weighted<'_> {
        match surfaces.0.parents {
            None => Weighted::Facets(&self.pairs),
            Some(_) => Weighted::Parents(&self.parents),
        }
    }

    /// The integrated weights of the pair in this place, whatever the multipliers' basis makes of them.
    pub fn integrated(&self, place: usize) -> &PairWeights {
        self.integrated.get(place).unwrap_or(&self.pairs[place].weights)
    }

    /// Adds those that are not in `after`, as they were integrated, to `dropped`; both are sorted by their facets.
    pub fn find_dropped(&self, after: &[PairRecord], dropped: &mut Vec<PairRecord>) -> Result<()> {
        let mut after = after.iter().peekable();
        for (k, pair) in self.pairs.iter().enumerate() {
            let place = (pair.one, pair.two);
            while after.next_if(|p| (p.one, p.two) < place).is_some() {}
            if after.peek().is_none_or(|p| (p.one, p.two) != place) {
                dropped.store(PairRecord { weights: *self.integrated(k), ..*pair })?;
            }
        }
        Ok(())
    }

    /// Whether it is that of these positions.
    pub fn is_at(&self, x1: &[Vec3], x2: &[Vec3]) -> bool {
        are_same(&self.x1, x1) && are_same(&self.x2, x2)
    }
}
