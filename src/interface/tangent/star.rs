//! Who is around a node, for tangents where points decide (docs/formulation.md 16.4): its facets, the nodes of both sides that they reach,
//! and the multipliers of theirs.

use super::union::{Pairs, Walk};
use crate::error::Result;
use crate::interface::pairing::given::Given;
use crate::memory::{self, Store};

/// The facets around each node, with the mortar nodes of each.
#[derive(Debug, Default)]
pub struct Around {
    pub facets: Vec<usize>,
    first_node: Vec<usize>,
    mortar: Vec<usize>,
    /// Per node where its facets begin among `of_node`.
    first: Vec<usize>,
    of_node: Vec<usize>,
}

impl Around {
    /// Those that have pairs.
    pub fn of<const N: usize>(given: Given<N>, pairs: Pairs) -> Result<Around> {
        let (mut all, mut walk, mut of_facet) = (Around::default(), Walk::through(pairs, 0..usize::MAX), Vec::new());
        let ((one, two), moves) = (given.setup.surfaces(), given.setup.effects.moves());
        all.first_node.store(0)?;
        memory::refill(&mut all.first, 0, one.len() + 2)?;
        while let Some(f) = walk.next(&mut of_facet)? {
            all.facets.store(f)?;
            let first = all.mortar.len();
            for &c in of_facet.iter().filter(|_| moves).flat_map(|pair| two.host_nodes(pair.two)) {
                if !all.mortar[first..].contains(&c) {
                    all.mortar.store(c)?;
                }
            }
            all.first_node.store(all.mortar.len())?;
            one.host_nodes(f).iter().for_each(|&a| all.first[a + 2] += 1);
        }
        for a in 2..all.first.len() {
            all.first[a] += all.first[a - 1];
        }
        memory::refill(&mut all.of_node, 0, all.first[one.len() + 1])?;
        for (k, &f) in all.facets.iter().enumerate() {
            for &a in one.host_nodes(f) {
                all.of_node[all.first[a + 1]] = k;
                all.first[a + 1] += 1;
            }
        }
        Ok(all)
    }

    pub fn around(&self, a: usize) -> &[usize] {
        &self.of_node[self.first[a]..self.first[a + 1]]
    }

    pub fn mortar(&self, k: usize) -> &[usize] {
        &self.mortar[self.first_node[k]..self.first_node[k + 1]]
    }
}

/// One node, with the nodes that its facets reach. Places are in the order in which these were found.
#[derive(Debug, Default)]
pub struct Star {
    /// Over both surfaces.
    pub nodes: Vec<usize>,
    /// Those that have a multiplier.
    pub rows: Vec<usize>,
    /// Per node over both surfaces its place among `nodes`.
    places: Vec<usize>,
    row_places: Vec<usize>,
}

const NOWHERE: usize = usize::MAX;

impl Star {
    /// Of no node yet.
    pub fn of<const N: usize>(given: Given<N>) -> Result<Star> {
        let (n1, n2) = (given.nodes(), given.setup.mortar.len());
        let (places, row_places) = (memory::filled(NOWHERE, n1 + n2)?, memory::filled(NOWHERE, n1)?);
        Ok(Star { places, row_places, ..Star::default() })
    }

    /// Begins anew with node A.
    pub fn begin<const N: usize>(&mut self, given: Given<N>, a: usize, around: &Around) -> Result<()> {
        let one = &given.setup.nonmortar;
        self.nodes.drain(..).for_each(|node| self.places[node] = NOWHERE);
        self.rows.drain(..).for_each(|node| self.row_places[node] = NOWHERE);
        for &k in around.around(a) {
            let own = one.host_nodes(around.facets[k]);
            for &b in own.iter().filter(|&&b| one.has_row(b)) {
                if self.row_places[b] == NOWHERE {
                    self.row_places[b] = self.rows.len();
                    self.rows.store(b)?;
                }
            }
            for node in own.iter().copied().chain(around.mortar(k).iter().map(|c| one.len() + c)) {
                if self.places[node] == NOWHERE {
                    self.places[node] = self.nodes.len();
                    self.nodes.store(node)?;
                }
            }
        }
        Ok(())
    }

    /// The place of a node over both surfaces that is there.
    #[inline]
    pub fn place(&self, node: usize) -> usize {
        self.places[node]
    }

    /// The place of a node's multiplier, where it has one.
    #[inline]
    pub fn row(&self, node: usize) -> Option<usize> {
        Some(self.row_places[node]).filter(|place| *place != NOWHERE)
    }
}
