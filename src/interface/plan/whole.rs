//! A plan: made of pairs, asked for its entries, filled with values.

use super::fill::{Fill, FillRoom};
use super::numbering::{Nodes, Numbering};
use super::pattern::{FacetPairs, Finder, Lists, System};
use super::places::{Layout, Places, Widths};
use super::scatter::{SKIP, Scatter};
use crate::error::Result;
use crate::interface::data::setup::Setup;
use crate::interface::tangent::union::Pairs;
use crate::memory::{self, Store};

/// A plan.
#[derive(Debug)]
pub struct Plan {
    /// What it is of.
    pub system: System,
    columns: Lists,
    widths: Widths,
    places: Places,
    scatter: Option<Scatter>,
}

impl Plan {
    /// Of these pairs and further blocks; `is_diagonal`: of which nodes the multiplier's block with itself is a diagonal.
    pub fn new<const N: usize>(
        (setup, numbering): (&Setup<N>, &Numbering),
        system: System,
        pairs: Pairs,
        mut extras: Vec<(u32, u32)>,
        is_diagonal: impl Fn(usize) -> bool,
    ) -> Result<Plan> {
        let nodes = Nodes::of(setup);
        extras.sort_unstable();
        extras.dedup();
        let (pairs, mut rest) = (FacetPairs::of(setup, pairs)?, &extras[..]);
        let mut finder = Finder::new(setup, system, numbering, &pairs)?;
        let among = system != System::Constraints && !finder.couples && setup.effects.moves();
        let mut scatter = Some(Scatter::of(setup, &pairs, finder.couples, among)?);
        let widths = Widths::of(setup);
        let mut columns = Lists { first: memory::with_room(nodes.len() + 1)?, all: Vec::new() };
        let (mut keys, mut at) = (Vec::new(), memory::filled(0, nodes.len())?);
        let nobody = Lists { first: Vec::new(), all: Vec::new() };
        let layout = Layout { nodes, numbering, columns: &nobody, widths };
        for node in 0..nodes.len() {
            columns.first.store(columns.all.len())?;
            let (own, others) = rest.split_at(rest.partition_point(|e| e.0 as usize == node));
            rest = others;
            finder.find(node, own, &mut keys)?;
            columns.all.store_all(keys.iter().copied())?;
            let diagonal = nodes.is_multiplier(node) && is_diagonal(node - nodes.multiplier(0));
            if let Some(found) = &mut scatter {
                let mut end = 0;
                layout.each_offset(node, diagonal, &keys, |column, offset, width| {
                    at[column] = offset as u16;
                    end = offset + width;
                });
                if end >= u32::from(SKIP) {
                    scatter = None; // looked up one by one
                } else {
                    found.take(setup, node, numbering, &finder, &at);
                }
            }
        }
        columns.first.store(columns.all.len())?;
        memory::fit(&mut columns.all)?;
        drop(finder);
        let layout = Layout { nodes, numbering, columns: &columns, widths };
        let places = layout.places(is_diagonal)?;
        Ok(Plan { system, widths, places, scatter, columns })
    }

    /// Entries.
    pub fn len(&self) -> usize {
        self.places.offsets[self.places.equations.len()]
    }

    /// The equations that have entries, ascending, and where the entries of each begin, one more at the end.
    pub fn rows(&self) -> (&[i64], &[usize]) {
        (&self.places.equations, &self.places.offsets)
    }

    /// Gives the columns of each of these rows, ascending.
    pub fn each_row<const N: usize>(
        &self,
        (setup, numbering): (&Setup<N>, &Numbering),
        give: impl FnMut(&[i64]) -> Result<()>,
    ) -> Result<()> {
        self.layout((setup, numbering)).each_row(&self.places, give)
    }

    fn layout<'a, const N: usize>(&'a self, (setup, numbering): (&'a Setup<N>, &'a Numbering)) -> Layout<'a, N> {
        Layout { nodes: Nodes::of(setup), numbering, columns: &self.columns, widths: self.widths }
    }

    /// What takes the blocks of a tangent and adds them to `values`, as many as there are entries.
    pub fn fill<'a, const N: usize>(
        &'a self,
        (setup, numbering): (&'a Setup<N>, &'a Numbering),
        values: &'a mut [f64],
        room: &'a mut FillRoom,
    ) -> Result<Fill<'a, N>> {
        room.begin(&self.places)?;
        let layout = self.layout((setup, numbering));
        Ok(Fill::new(setup, layout, (&self.places, self.scatter.as_ref()), values, room))
    }

    /// On the heap `[bytes]`.
    pub fn bytes(&self) -> usize {
        self.columns.bytes() + self.places.bytes() + self.scatter.as_ref().map_or(0, Scatter::bytes)
    }
}
