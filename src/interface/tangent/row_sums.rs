//! The rows of one node where points decide (docs/formulation 16.4): d R / dx = sum_A (d R / d sigma_A) (d sigma_A / dx), over the nodes
//! A of the facets that reach it. The sum is in place before any of it leaves: an entry of the tangent is written once,
//! however many A it has.

use super::emission::{RowBlock, RowBlocks};
use super::slopes::Slopes;
use crate::error::Result;
use crate::interface::data::surface::Surface;
use crate::memory::{self, Store};
use crate::simd::{self, Kernel, Lanes};

/// Where a node is that is no column.
const NOWHERE: u32 = u32::MAX;

/// What d R / d sigma_A is of one A: by row, in each lane what multiplies that of d sigma_A / dx.
pub type Acting = (usize, RowBlock);

/// The rows of a node; columns have the numbers of [`RowBlocks`].
#[derive(Debug, Default)]
pub struct RowSums {
    columns: Vec<usize>,
    places: Vec<u32>,
    blocks: Vec<RowBlock>,
    nodes: usize,
}

impl RowSums {
    /// Of no node yet.
    pub fn of((one, two): (&Surface, &Surface)) -> Result<RowSums> {
        let (n1, nodes) = (one.len(), one.len() + two.len());
        Ok(RowSums { places: memory::filled(NOWHERE, nodes + n1)?, nodes, ..RowSums::default() })
    }

    /// Begins with another node.
    pub fn begin(&mut self) {
        self.columns.drain(..).for_each(|column| self.places[column] = NOWHERE);
        self.blocks.clear();
    }

    /// Zeros in all columns so far, which stay.
    pub fn clear(&mut self) {
        self.blocks.fill(RowBlock::default());
    }

    /// The place of this column, which it gets if it has none.
    #[inline]
    fn place(&mut self, column: usize) -> Result<usize> {
        if self.places[column] == NOWHERE {
            self.places[column] = self.columns.len() as u32;
            self.columns.store(column)?;
        }
        Ok(self.places[column] as usize)
    }

    /// The place of the multiplier of A.
    #[inline]
    pub fn multiplier(&mut self, a: usize) -> Result<usize> {
        self.place(self.nodes + a)
    }

    /// The columns so far: with zeros for those that are new.
    fn fill(&mut self) -> Result<()> {
        let more = self.columns.len() - self.blocks.len();
        self.blocks.store_all(std::iter::repeat_n(RowBlock::default(), more))
    }

    /// The block of the multiplier of A.
    pub fn of_multiplier(&mut self, a: usize) -> Result<&mut RowBlock> {
        let place = self.multiplier(a)?;
        self.fill()?;
        Ok(&mut self.blocks[place])
    }

    /// The columns of what these sigma_A depend on.
    pub fn reach(&mut self, of: impl Iterator<Item = usize>, slopes: &Slopes) -> Result<()> {
        for a in of {
            slopes.nodes(a).iter().try_for_each(|&node| self.place(node as usize).map(|_| ()))?;
        }
        self.fill()
    }

    /// Adds what acts, in the first R rows of the blocks, times what it depends on.
    pub fn add<const R: usize>(&mut self, acting: &[Acting], slopes: &Slopes) -> Result<()> {
        self.reach(acting.iter().map(|acting| acting.0), slopes)?;
        simd::dispatch(Products::<R> { acting, slopes, places: &self.places, blocks: &mut self.blocks });
        Ok(())
    }

    /// The blocks; of the rows that begin with this one.
    pub fn blocks(&self, first: usize) -> RowBlocks<'_> {
        RowBlocks { columns: &self.columns, blocks: &self.blocks, places: &self.places, nodes: self.nodes, first }
    }
}

struct Products<'a, const R: usize> {
    acting: &'a [Acting],
    slopes: &'a Slopes,
    places: &'a [u32],
    blocks: &'a mut [RowBlock],
}

impl<const R: usize> Kernel for Products<'_, R> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        for (a, rows) in self.acting {
            let mut by = [L::splat(0.0); R];
            for i in 0..R {
                by[i] = L::load(&rows[i]);
            }
            for (node, slope) in self.slopes.nodes(*a).iter().zip(self.slopes.slopes(*a)) {
                let (block, slope) = (&mut self.blocks[self.places[*node as usize] as usize], L::load(slope));
                for i in 0..R {
                    block[i] = by[i].mul_add(slope, L::load(&block[i])).store();
                }
            }
        }
    }
}
