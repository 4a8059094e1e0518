//! Where the blocks of facets and pairs begin within the rows of their nodes: 16 bits each, so that nothing is searched for
//! while values are added. Per facet and per mortar node of it, and per mortar facet for what its nodes have among each other.

use super::numbering::{NO_RANK, Nodes, Numbering, Sides};
use super::pattern::{FacetPairs, Finder};
use crate::error::Result;
use crate::memory::{self, Stored};
use crate::shape::MAX_NODES;

/// There is no such block.
pub const LACKS: u16 = u16::MAX;
/// The block's row or its column has no equation: nothing is to be added.
pub const SKIP: u16 = u16::MAX - 1;

/// Offsets by row, then by column.
pub type Offsets = [[u16; MAX_NODES]; MAX_NODES];

/// What a facet's own nodes have: rows of displacements with columns of displacements and of multipliers, rows of multipliers
/// with columns of displacements.
#[derive(Clone, Copy, Debug)]
pub struct OwnOffsets {
    pub forces: Offsets,
    pub multipliers: Offsets,
    pub rows: Offsets,
}

/// What a mortar node has with a facet's nodes.
#[derive(Clone, Copy, Debug)]
pub struct MortarOffsets {
    /// Its columns in the rows of the facet's displacements, and of its multipliers.
    pub column: [u16; MAX_NODES],
    pub row: [u16; MAX_NODES],
    /// The columns of the facet's displacements in its rows, and of its multipliers.
    pub forces: [u16; MAX_NODES],
    pub multipliers: [u16; MAX_NODES],
}

/// All offsets of a plan.
#[derive(Debug, Default)]
pub struct Scatter {
    /// Per facet, whether it has pairs.
    has: Vec<bool>,
    /// Per facet.
    pub own: Vec<OwnOffsets>,
    /// Where the mortar nodes of each facet begin; one more at the end.
    pub first_node: Vec<usize>,
    /// The mortar nodes of each facet, ascending.
    pub nodes: Vec<u32>,
    /// Of each of them.
    pub mortar: Vec<MortarOffsets>,
    /// Per mortar facet, of its nodes with each other: [`LACKS`] where it has no active pairs; nothing where facets of dual
    /// multipliers couple them.
    pub among: Vec<Offsets>,
    /// Where the couplings of each facet begin: of each of its mortar nodes with each.
    pub first_coupling: Vec<usize>,
    pub couplings: Vec<u16>,
}

impl Scatter {
    /// With room for the offsets of these pairs.
    pub fn of(setup: Sides, pairs: &FacetPairs, couples: bool, among: bool) -> Result<Scatter> {
        let nothing = [[SKIP; MAX_NODES]; MAX_NODES];
        let own = OwnOffsets { forces: nothing, multipliers: nothing, rows: nothing };
        let (nothing, lacks) = ([SKIP; MAX_NODES], [LACKS; MAX_NODES]);
        let mortar = MortarOffsets { column: nothing, row: nothing, forces: nothing, multipliers: nothing };
        let mut s = Scatter {
            has: (0..setup.nonmortar.facets.len()).map(|f| !pairs.pairs(f).is_empty()).stored()?,
            own: memory::filled(own, setup.nonmortar.facets.len())?,
            first_node: memory::copied(&pairs.first_node)?,
            nodes: memory::filled(0, pairs.nodes.len())?,
            mortar: memory::filled(mortar, pairs.nodes.len())?,
            among: memory::filled([lacks; MAX_NODES], if among { setup.mortar.facets.len() } else { 0 })?,
            ..Scatter::default()
        };
        if among {
            let active = (0..s.has.len()).flat_map(|f| pairs.pairs(f)).filter(|pair| pair.1);
            active.for_each(|pair| s.among[pair.0 as usize] = [nothing; MAX_NODES]);
        }
        s.nodes.iter_mut().zip(&pairs.nodes).for_each(|(to, node)| *to = node.0);
        if couples {
            s.first_coupling = memory::filled(0, s.first_node.len())?;
            for f in 1..s.first_node.len() {
                let m = s.first_node[f] - s.first_node[f - 1];
                s.first_coupling[f] = s.first_coupling[f - 1] + m * m;
            }
            s.couplings = memory::filled(SKIP, s.first_coupling[s.first_node.len() - 1])?;
        }
        Ok(s)
    }

    /// On the heap `[bytes]`.
    pub fn bytes(&self) -> usize {
        let own = self.own.capacity() * size_of::<OwnOffsets>() + self.among.capacity() * size_of::<Offsets>();
        let lists = (self.first_node.capacity() + self.first_coupling.capacity()) * size_of::<usize>();
        let mortar = self.nodes.capacity() * size_of::<u32>() + self.mortar.capacity() * size_of::<MortarOffsets>();
        own + lists + mortar + self.couplings.capacity() * size_of::<u16>() + self.has.capacity()
    }

    /// Whether a facet has pairs here.
    #[inline]
    pub fn has(&self, f: usize) -> bool {
        self.has[f]
    }

    /// Of two mortar nodes of a facet by their places: row and column.
    #[inline]
    pub fn coupling(&self, f: usize, row: usize, column: usize) -> u16 {
        let (first, m) = (self.first_node[f], self.first_node[f + 1] - self.first_node[f]);
        self.couplings[self.first_coupling[f] + (row - first) * m + column - first]
    }

    /// The mortar nodes of a facet.
    pub fn mortar_nodes(&self, f: usize) -> &[u32] {
        &self.nodes[self.first_node[f]..self.first_node[f + 1]]
    }

    /// The place of one among all facets' mortar nodes.
    #[inline(always)]
    pub fn place(&self, f: usize, node: usize) -> Option<usize> {
        self.mortar_nodes(f).iter().position(|n| *n as usize == node).map(|k| self.first_node[f] + k)
    }

    /// Takes the rows of a node, whose columns were found last; `at`: the offset of each node met.
    pub fn take(&mut self, setup: Sides, node: usize, numbering: &Numbering, finder: &Finder, at: &[u16]) {
        let (nodes, n1) = (Nodes::of(setup), setup.nonmortar.len());
        if !numbering.has_equations(node) || !nodes.has_rows(node) {
            return;
        }
        let found = Found { numbering, finder, at };
        // A force depends on those multipliers of its facets that act here.
        let multiplier = |b: usize| {
            let column = nodes.multiplier(b);
            if nodes.has_rows(column) { found.offset(column) } else { SKIP }
        };
        let neighbours = &finder.neighbours;
        if nodes.is_multiplier(node) || node < n1 {
            let is_multiplier = nodes.is_multiplier(node);
            let a = if is_multiplier { node - nodes.multiplier(0) } else { node };
            for &f in neighbours.around.get(a) {
                let f = f as usize;
                let facet = &setup.nonmortar.facets[f];
                let row = facet.as_slice().iter().position(|&b| b == a).unwrap_or(0);
                let own = &mut self.own[f];
                for (k, &b) in facet.as_slice().iter().enumerate() {
                    if is_multiplier {
                        own.rows[row][k] = found.offset(b);
                    } else {
                        own.forces[row][k] = found.offset(b);
                        own.multipliers[row][k] = multiplier(b);
                    }
                }
                for k in self.first_node[f]..self.first_node[f + 1] {
                    let to = &mut self.mortar[k];
                    let to = if is_multiplier { &mut to.row } else { &mut to.column };
                    to[row] = found.offset(nodes.mortar(self.nodes[k] as usize));
                }
            }
            return;
        }
        let c = node - n1;
        for &f in neighbours.below.get(c) {
            let f = f as usize;
            let Some(place) = self.place(f, c) else { continue };
            for (k, &b) in setup.nonmortar.facets[f].as_slice().iter().enumerate() {
                self.mortar[place].forces[k] = found.offset(b);
                self.mortar[place].multipliers[k] = multiplier(b);
            }
            if let Some(first) = self.first_coupling.get(f) {
                let m = self.first_node[f + 1] - self.first_node[f];
                let row = first + (place - self.first_node[f]) * m;
                for k in 0..m {
                    self.couplings[row + k] = found.offset(nodes.mortar(self.nodes[self.first_node[f] + k] as usize));
                }
            }
        }
        for &j in neighbours.beside.get(c) {
            let facet = &setup.mortar.facets[j as usize];
            let row = facet.as_slice().iter().position(|&d| d == c).unwrap_or(0);
            for (k, &d) in facet.as_slice().iter().enumerate() {
                self.among[j as usize][row][k] = found.offset(nodes.mortar(d));
            }
        }
    }
}

/// What the rows of a node were found to have.
struct Found<'a> {
    numbering: &'a Numbering,
    finder: &'a Finder<'a>,
    /// The offset of each node met.
    at: &'a [u16],
}

impl Found<'_> {
    /// Where the block of a column begins.
    #[inline(always)]
    fn offset(&self, column: usize) -> u16 {
        match (self.numbering.rank[column], self.finder.has_met(column)) {
            (NO_RANK, _) => SKIP,
            (_, false) => LACKS,
            (_, true) => self.at[column],
        }
    }
}
