//! The rows of one node after the other where points decide, with friction and without it (docs/formulation 16.4, 16.7): from each facet
//! around it what the node has of the A of that facet, the sum of it times what sigma_A depends on (`row_sums.rs`), and where that goes. What
//! a node has of one A, [`Found`], is what `points.rs` and `point_friction.rs` say.

use super::around::Around;
use super::emission::{Emitter, Place, RowBlock};
use super::point_numbers::PointNumbers;
use super::row_sums::{Acting, RowSums};
use super::slopes::Slopes;
use crate::error::Result;
use crate::interface::data::points::Points;
use crate::interface::pairing::given::Given;
use crate::memory::Store;
use nalgebra::SMatrix;

/// Rows of a force.
pub const FORCES: usize = 3;

/// What a node has of one A.
pub trait Found<const N: usize>: Copy + Default {
    /// Adds what a non-mortar node has of the k-th facet.
    fn add_own(rows: &mut Rows<Self, N>, i: usize, k: usize, numbers: &PointNumbers) -> Result<()>;

    /// Adds what mortar node c has of it.
    fn add_mortar(rows: &mut Rows<Self, N>, c: usize, k: usize, numbers: &PointNumbers) -> Result<()>;

    /// d force / d sigma_A, in each lane what multiplies that of d sigma_A / dx; and d force / d lambda_A.
    fn force(&self, points: Option<&Points>, a: usize) -> (RowBlock, RowBlock);

    /// Gives the rows of a non-mortar node away, of which all is found.
    fn emit_own(rows: &mut Rows<Self, N>, i: usize, emitter: &mut Emitter<N>) -> Result<()>;
}

/// Rows in the making. What they are made of has no numbers where the pattern is asked for alone.
pub struct Rows<'a, T, const N: usize> {
    pub given: Given<'a, N>,
    pub around: &'a Around,
    pub numbers: Option<&'a PointNumbers<'a>>,
    slopes: &'a Slopes,
    pub sums: RowSums,
    /// The A of the row at hand, in the order of their columns, which come before all others; and what is found of each.
    of: Vec<usize>,
    found: Vec<T>,
    acting: Vec<Acting>,
}

impl<T: Found<N>, const N: usize> Rows<'_, T, N> {
    /// What is found of A.
    #[inline]
    pub fn at(&mut self, a: usize) -> Result<&mut T> {
        let place = self.sums.multiplier(a)?;
        if place == self.of.len() {
            self.of.store(a)?;
            self.found.store(T::default())?;
        }
        Ok(&mut self.found[place])
    }

    /// Begins with another node, from these facets.
    fn gather(&mut self, facets: &[u32], add: impl Fn(&mut Self, usize, &PointNumbers) -> Result<()>) -> Result<()> {
        self.sums.begin();
        self.of.clear();
        self.found.clear();
        let one = &self.given.setup.nonmortar;
        for k in facets.iter().map(|&k| k as usize) {
            match self.numbers {
                Some(numbers) => add(self, k, numbers)?,
                None => {
                    let nodes = one.host_nodes(self.around.facets[k]).iter().filter(|b| one.has_row(**b));
                    nodes.copied().try_for_each(|a| self.at(a).map(|_| ()))?;
                }
            }
        }
        Ok(())
    }

    /// Sums the first R rows up, from d R / d sigma_A and d R / d lambda_A of each A; gives whether anything acts.
    pub fn sum_up<const R: usize>(
        &mut self,
        of: impl Fn(&T, Option<&Points>, usize) -> (RowBlock, RowBlock),
    ) -> Result<bool> {
        let points = self.numbers.map(|numbers| numbers.points);
        self.acting.clear();
        self.sums.clear();
        for (&a, found) in self.of.iter().zip(&self.found) {
            let (by_sigma, by_lambda) = of(found, points, a);
            *self.sums.of_multiplier(a)? = by_lambda;
            if by_sigma != RowBlock::default() {
                self.acting.store((a, by_sigma))?;
            }
        }
        if self.numbers.is_none() {
            self.sums.reach(self.of.iter().copied(), self.slopes)?;
            return Ok(true);
        }
        self.sums.add::<R>(&self.acting, self.slopes)?;
        Ok(!self.acting.is_empty())
    }

    /// The rows of a non-mortar node.
    fn emit_own(&mut self, i: usize, emitter: &mut Emitter<N>) -> Result<()> {
        let facets = self.around.around(i);
        if !facets.is_empty() {
            self.gather(facets, |rows, k, numbers| T::add_own(rows, i, k, numbers))?;
            return T::emit_own(self, i, emitter);
        }
        if self.given.setup.nonmortar.has_row(i) {
            let value = if self.numbers.is_some() { -self.per_gap(i) } else { 0.0 };
            let block = SMatrix::<f64, N, N>::identity() * value;
            emitter.taker.node(Place::Multiplier(i), Place::Multiplier(i), block.as_slice());
        }
        Ok(())
    }

    /// The rows of mortar node c.
    fn emit_mortar(&mut self, c: usize, emitter: &mut Emitter<N>) -> Result<()> {
        self.gather(self.around.below(c), |rows, k, numbers| T::add_mortar(rows, c, k, numbers))?;
        if self.sum_up::<FORCES>(T::force)? {
            emitter.taker.sums(Place::Displacement(self.given.nodes() + c), &self.sums.blocks(0));
        }
        Ok(())
    }

    /// What a multiplier's row is scaled by, over its augmentation.
    pub fn per_gap(&self, i: usize) -> f64 {
        self.given.row_scale(i) / self.given.augmentation(i)
    }
}

/// The rows of all nodes.
pub fn emit<T: Found<N>, const N: usize>(
    given: Given<N>,
    (around, slopes): (&Around, &Slopes),
    numbers: Option<&PointNumbers>,
    emitter: &mut Emitter<N>,
) -> Result<()> {
    let (sums, of, found, acting) = (RowSums::of(given.setup.surfaces())?, Vec::new(), Vec::new(), Vec::new());
    let mut rows = Rows::<T, N> { given, around, numbers, slopes, sums, of, found, acting };
    (0..given.nodes()).try_for_each(|i| rows.emit_own(i, emitter))?;
    let mortar = if given.setup.mortar_moves() { given.setup.mortar.len() } else { 0 };
    (0..mortar).try_for_each(|c| rows.emit_mortar(c, emitter))
}
