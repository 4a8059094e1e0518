//! Who is around a node, for tangents where points decide (docs/formulation.md 16.4): its facets, the nodes of both sides that they reach,
//! and the multipliers of theirs.

use super::union::{Pairs, Walk};
use crate::error::Result;
use crate::interface::data::lists::Lists;
use crate::interface::data::points::Points;
use crate::interface::pairing::given::Given;
use crate::memory::{self, Store};

/// The facets around each node, with the mortar nodes of each.
#[derive(Debug, Default)]
pub struct Around {
    pub facets: Vec<usize>,
    /// Where the points have each facet.
    at: Vec<Option<u32>>,
    mortar: Lists,
    /// By non-mortar nodes, and by mortar nodes.
    of_node: Lists,
    below: Lists,
}

impl Around {
    /// Those that have pairs; `points`: whose facets they are.
    pub fn of<const N: usize>(given: Given<N>, pairs: Pairs, points: Option<&Points>) -> Result<Around> {
        let (mut all, mut walk, mut of_facet) = (Around::default(), Walk::through(pairs, 0..usize::MAX), Vec::new());
        let ((one, two), moves) = (given.setup.surfaces(), given.setup.effects.moves());
        let mut ahead = points.map_or(&[][..], |points| &points.facets).iter().enumerate().peekable();
        all.mortar.first.store(0)?;
        while let Some(f) = walk.next(&mut of_facet)? {
            while ahead.next_if(|(_, facet)| facet.one < f).is_some() {}
            all.facets.store(f)?;
            all.at.store(ahead.peek().filter(|(_, facet)| facet.one == f).map(|(at, _)| *at as u32))?;
            let first = all.mortar.all.len();
            for &c in of_facet.iter().filter(|_| moves).flat_map(|pair| two.host_nodes(pair.two)) {
                if !all.mortar.all[first..].contains(&(c as u32)) {
                    all.mortar.all.store(c as u32)?;
                }
            }
            all.mortar.first.store(all.mortar.all.len())?;
        }
        let facets = &all.facets;
        all.of_node = Lists::of(one.len(), |give| {
            (0..).zip(facets).for_each(|(k, &f)| one.host_nodes(f).iter().for_each(|&a| give(a, k)));
        })?;
        all.below = Lists::of(two.len(), |give| {
            (0..facets.len()).for_each(|k| all.mortar.get(k).iter().for_each(|&c| give(c as usize, k as u32)));
        })?;
        Ok(all)
    }

    pub fn around(&self, a: usize) -> &[u32] {
        self.of_node.get(a)
    }

    /// The facets that have mortar node c.
    pub fn below(&self, c: usize) -> &[u32] {
        self.below.get(c)
    }

    pub fn mortar(&self, k: usize) -> &[u32] {
        self.mortar.get(k)
    }

    /// Where the points have the k-th facet.
    #[inline]
    pub fn at(&self, k: usize) -> Option<usize> {
        self.at[k].map(|at| at as usize)
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
        for k in around.around(a).iter().map(|&k| k as usize) {
            let own = one.host_nodes(around.facets[k]);
            for &b in own.iter().filter(|&&b| one.has_row(b)) {
                if self.row_places[b] == NOWHERE {
                    self.row_places[b] = self.rows.len();
                    self.rows.store(b)?;
                }
            }
            for node in own.iter().copied().chain(around.mortar(k).iter().map(|&c| one.len() + c as usize)) {
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
