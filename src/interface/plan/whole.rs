//! A plan: made of pairs, asked for its entries, filled with values.

use super::fill::Fill;
use super::numbering::{Nodes, Numbering, Sides};
use super::pattern::{FacetPairs, Finder, System};
use super::phases;
use super::places::{Layout, Places, Widths};
use super::scatter::{SKIP, Scatter};
use super::table::{Hand, Parted, Table, TableRoom};
use crate::error::{Error, Kind, Result};
use crate::interface::data::lists::Lists;
use crate::interface::tangent::union::Pairs;
use crate::memory::{self, Store, Stored};
use std::ops::Range;

/// A plan.
#[derive(Debug)]
pub struct Plan {
    columns: Lists,
    widths: Widths,
    places: Places,
    scatter: Option<Scatter>,
    /// The mortar nodes of each facet, where `scatter` does not have them.
    mortar: Option<Lists>,
    phases: Vec<Vec<Range<usize>>>,
}

impl Plan {
    /// Of these pairs and of further blocks. `alone`: whether the blocks of facets are in rows of their own nodes alone;
    /// `is_diagonal`: of which nodes the multiplier's block with itself is a diagonal.
    pub fn new(
        (setup, numbering): (Sides, &Numbering),
        system: System,
        pairs: Pairs,
        (mut extras, alone): (Vec<(u32, u32)>, bool),
        is_diagonal: &dyn Fn(usize) -> bool,
    ) -> Result<Plan> {
        let nodes = Nodes::of(setup);
        memory::sort(&mut extras)?;
        extras.dedup();
        let (pairs, mut rest) = (FacetPairs::of(setup, pairs)?, &extras[..]);
        let mut finder = Finder::new(setup, system, numbering, &pairs)?;
        let among = system != System::Constraints && !finder.couples && setup.moves;
        // Its tables are of facets of four nodes at most: the blocks of larger ones are looked up row by row.
        let has_tables = setup.nonmortar.parents.is_none();
        let mut scatter = has_tables.then(|| Scatter::of(setup, &pairs, finder.couples, among)).transpose()?;
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
        let phases = phases::of(setup, &pairs, alone)?;
        let nodes = pairs.nodes.iter().map(|node| node.0);
        let mortar = match scatter {
            Some(_) => None,
            None => Some(Lists { first: memory::copied(&pairs.first_node)?, all: nodes.stored()? }),
        };
        Ok(Plan { widths, places, scatter, mortar, columns, phases })
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
    pub fn each_row(
        &self,
        (setup, numbering): (Sides, &Numbering),
        give: &mut dyn FnMut(&[i64]) -> Result<()>,
    ) -> Result<()> {
        self.layout((setup, numbering)).each_row(&self.places, give)
    }

    fn layout<'a>(&'a self, (setup, numbering): (Sides<'a>, &'a Numbering)) -> Layout<'a> {
        Layout { nodes: Nodes::of(setup), numbering, columns: &self.columns, widths: self.widths }
    }

    /// The chunks of facets whose blocks are added at the same time: no two of a phase have rows in common.
    pub fn phases(&self) -> &[Vec<Range<usize>>] {
        &self.phases
    }

    /// The table of the entries with their values.
    pub fn table<'a>(&'a self, values: &'a mut [f64], room: &'a mut TableRoom) -> Result<Table<'a>> {
        if values.len() != self.len() {
            let text = text!("values has {} entries; the plan has {}", values.len(), self.len());
            return Err(Error::new(Kind::InvalidSize, text));
        }
        room.table(&self.places, values)
    }

    /// The table in parts, for the chunks of a phase at the same time.
    pub fn parted<'a>(
        &self,
        (setup, numbering): (Sides, &Numbering),
        chunks: &[Range<usize>],
        table: &'a mut Table<'_>,
    ) -> Result<Parted<'a>> {
        let nodes = Nodes::of(setup);
        let own = |facets: &Range<usize>, give: &mut dyn FnMut(usize)| {
            for f in facets.start..facets.end {
                for &a in setup.nonmortar.host_nodes(f) {
                    give(a);
                    give(nodes.multiplier(a));
                }
                let of_table = self.scatter.iter().flat_map(|scatter| scatter.mortar_nodes(f));
                let mortar = of_table.chain(self.mortar.iter().flat_map(|nodes| nodes.get(f)));
                mortar.for_each(|&node| give(nodes.mortar(node as usize)));
            }
        };
        table.parted(chunks, own, &numbering.node)
    }

    /// What takes the blocks of a chunk and adds them to what the hand is of.
    pub fn fill<'a, 'p, const N: usize>(
        &'a self,
        (setup, numbering): (Sides<'a>, &'a Numbering),
        hand: Hand<'a, 'p>,
    ) -> Fill<'a, 'p, N> {
        Fill::new(setup, self.layout((setup, numbering)), (&self.places, self.scatter.as_ref()), hand)
    }

    /// On the heap `[bytes]`.
    pub fn bytes(&self) -> usize {
        let of_facets = self.scatter.as_ref().map_or(0, Scatter::bytes) + self.mortar.as_ref().map_or(0, Lists::bytes);
        self.columns.bytes() + self.places.bytes() + of_facets
    }
}
