//! Which blocks the rows of each node have: the nodes of their columns, by rank. Of the pairs of a plan and what else couples
//! nodes (`extras.rs`).

use super::numbering::{NO_RANK, Nodes, Numbering, Sides};
use crate::error::Result;
use crate::interface::data::lists::Lists;
use crate::interface::data::node_data::Owner;
use crate::interface::data::options::{Form, MultiplierBasis};
use crate::interface::tangent::union::{Pairs, UnionPair, Walk};
use crate::memory::{self, Store};

/// What a plan is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum System {
    /// The tangent with multipliers.
    Whole,
    /// Of a condensed system what the forces depend on the displacements by.
    Forces,
    /// Of a condensed system the constraints.
    Constraints,
}

/// A column of a row: twice the rank, and 1 where it is of multipliers. Ordered as the equations are.
pub type Key = u32;

/// The pairs of a plan, facet by facet, with the mortar nodes of each facet.
#[derive(Debug, Default)]
pub struct FacetPairs {
    /// Where the pairs of each facet begin; one more at the end.
    pub first: Vec<usize>,
    /// The mortar facet of each, and whether it is active.
    pub two: Vec<(u32, bool)>,
    /// Where the mortar nodes of each facet begin; one more at the end.
    pub first_node: Vec<usize>,
    /// The mortar nodes of each facet, ascending, and whether any active pair has them.
    pub nodes: Vec<(u32, bool)>,
}

impl FacetPairs {
    /// Those of a walk.
    pub fn of(setup: Sides, pairs: Pairs) -> Result<FacetPairs> {
        let facets = setup.nonmortar.host_facets();
        let mut all = FacetPairs::default();
        let (mut walk, mut of_facet, mut nodes) = (Walk::through(pairs, 0..facets), Vec::new(), Vec::new());
        let moves = setup.moves;
        let close = |all: &mut FacetPairs, facet: usize| -> Result<()> {
            while all.first.len() <= facet {
                all.first.store(all.two.len())?;
                all.first_node.store(all.nodes.len())?;
            }
            Ok(())
        };
        all.first.try_reserve_exact(facets + 1)?;
        all.first_node.try_reserve_exact(facets + 1)?;
        while let Some(f) = walk.next(&mut of_facet)? {
            close(&mut all, f)?;
            nodes.clear();
            for &UnionPair { two, is_active, .. } in &of_facet {
                all.two.store((two as u32, is_active))?;
                let nodes_of_two = setup.mortar.host_nodes(two);
                // Twice the number, and 1 where the pair is idle: active ones come first among equals.
                let of_pair = nodes_of_two.iter().map(|&node| 2 * node as u32 + u32::from(!is_active));
                nodes.store_all(of_pair.take(if moves { nodes_of_two.len() } else { 0 }))?;
            }
            nodes.sort_unstable();
            nodes.dedup_by_key(|node| *node / 2);
            all.nodes.store_all(nodes.iter().map(|&node| (node / 2, node % 2 == 0)))?;
        }
        close(&mut all, facets)?;
        Ok(all)
    }

    /// The mortar facets of a facet's pairs.
    pub fn pairs(&self, f: usize) -> &[(u32, bool)] {
        &self.two[self.first[f]..self.first[f + 1]]
    }

    /// Its mortar nodes.
    pub fn mortar_nodes(&self, f: usize) -> &[(u32, bool)] {
        &self.nodes[self.first_node[f]..self.first_node[f + 1]]
    }
}

/// What lies around nodes: the facets with pairs, and where there are mortar rows, what these are of.
#[derive(Debug)]
pub struct Neighbours {
    /// Per non-mortar node its facets that have pairs.
    pub around: Lists,
    /// Per mortar node the non-mortar facets that have it.
    pub below: Lists,
    /// Per mortar node its mortar facets in active pairs; none where the facets of dual multipliers couple them.
    pub beside: Lists,
}

/// What finds the columns of the rows of each node.
pub struct Finder<'a> {
    setup: Sides<'a>,
    system: System,
    numbering: &'a Numbering,
    pairs: &'a FacetPairs,
    pub neighbours: Neighbours,
    nodes: Nodes<'a>,
    /// Whether a facet of dual multipliers couples its mortar nodes.
    pub couples: bool,
    has_forces: bool,
    has_multipliers: bool,
    /// The number of the last search that met each node, and of the last search.
    met: Vec<u32>,
    search: u32,
}

impl<'a> Finder<'a> {
    /// Of the rows of these pairs.
    pub fn new(setup: Sides<'a>, system: System, numbering: &'a Numbering, pairs: &'a FacetPairs) -> Result<Self> {
        let (nodes, one, two) = (Nodes::of(setup), &setup.nonmortar, &setup.mortar);
        let has_forces = setup.options.differentiates_weights() && system != System::Constraints;
        let has_multipliers = system == System::Whole && setup.options.form == Form::Multiplier;
        let couples = has_forces && setup.options.basis == MultiplierBasis::Dual && setup.moves;
        let facets = one.host_facets();
        let around = Lists::of(one.len(), |give| {
            for f in (0..facets).filter(|&f| !pairs.pairs(f).is_empty()) {
                one.host_nodes(f).iter().for_each(|&a| give(a, f as u32));
            }
        })?;
        let below = Lists::of(two.len(), |give| {
            (0..facets).for_each(|f| pairs.mortar_nodes(f).iter().for_each(|n| give(n.0 as usize, f as u32)));
        })?;
        let mortar = setup.moves && has_forces && !couples;
        let mut paired = memory::filled(false, if mortar { two.host_facets() } else { 0 })?;
        pairs.two.iter().filter(|pair| pair.1 && mortar).for_each(|pair| paired[pair.0 as usize] = true);
        let beside = Lists::of(two.len(), |give| {
            for j in (0..paired.len()).filter(|&j| paired[j]) {
                two.host_nodes(j).iter().for_each(|&c| give(c, j as u32));
            }
        })?;
        let neighbours = Neighbours { around, below, beside };
        let met = memory::filled(0, nodes.len())?;
        Ok(Finder {
            setup,
            system,
            numbering,
            pairs,
            neighbours,
            nodes,
            couples,
            has_forces,
            has_multipliers,
            met,
            search: 0,
        })
    }

    /// The columns of a node's rows, ascending; `extras`: further ones.
    pub fn find(&mut self, node: usize, extras: &[(u32, u32)], keys: &mut Vec<Key>) -> Result<()> {
        keys.clear();
        self.search += 1;
        if !self.numbering.has_equations(node) || !self.nodes.has_rows(node) {
            return Ok(());
        }
        let n1 = self.setup.nonmortar.len();
        let is_constraint = self.system == System::Constraints && node < n1;
        if is_constraint {
            self.row(node, keys)?;
        } else if self.nodes.is_multiplier(node) && self.system == System::Whole {
            let a = node - self.nodes.multiplier(0);
            if self.setup.owners[a] == Owner::Here {
                self.add(node, keys)?;
            }
            self.row(a, keys)?;
        } else if node < n1 {
            for k in self.neighbours.around.range(node) {
                self.forces(self.neighbours.around.all[k] as usize, self.has_forces, keys)?;
            }
        } else if !self.nodes.is_multiplier(node) && (self.has_forces || self.has_multipliers) {
            self.mortar_row(node - n1, keys)?;
        }
        extras.iter().try_for_each(|extra| self.add(extra.1 as usize, keys))?;
        keys.sort_unstable();
        Ok(())
    }

    /// Whether the last search met a node.
    #[inline]
    pub fn has_met(&self, node: usize) -> bool {
        self.met[node] == self.search
    }

    #[inline]
    fn add(&mut self, node: usize, keys: &mut Vec<Key>) -> Result<()> {
        if std::mem::replace(&mut self.met[node], self.search) == self.search {
            return Ok(());
        }
        match self.numbering.rank[node] {
            NO_RANK => Ok(()),
            rank => keys.store(2 * rank + u32::from(self.nodes.is_multiplier(node))),
        }
    }

    fn own(&mut self, f: usize, keys: &mut Vec<Key>) -> Result<()> {
        self.setup.nonmortar.host_nodes(f).iter().try_for_each(|&b| self.add(b, keys))
    }

    /// The mortar nodes of a facet, of active pairs and, if asked for, of others.
    fn mortar(&mut self, f: usize, idle: bool, keys: &mut Vec<Key>) -> Result<()> {
        let pairs = self.pairs;
        let mut nodes = pairs.mortar_nodes(f).iter().filter(|n| n.1 || idle);
        nodes.try_for_each(|n| self.add(self.nodes.mortar(n.0 as usize), keys))
    }

    /// The row of a multiplier.
    fn row(&mut self, a: usize, keys: &mut Vec<Key>) -> Result<()> {
        for k in self.neighbours.around.range(a) {
            let f = self.neighbours.around.all[k] as usize;
            self.own(f, keys)?;
            self.mortar(f, true, keys)?;
        }
        Ok(())
    }

    /// What forces of a facet's active pairs depend on; `mortar`: on mortar nodes too.
    fn forces(&mut self, f: usize, mortar: bool, keys: &mut Vec<Key>) -> Result<()> {
        let (setup, pairs) = (self.setup, self.pairs);
        if !pairs.pairs(f).iter().any(|pair| pair.1) {
            return Ok(());
        }
        if self.has_forces {
            self.own(f, keys)?;
        }
        if mortar {
            self.mortar(f, false, keys)?;
        }
        if self.has_multipliers {
            let nodes = self.nodes;
            let multipliers = setup.nonmortar.host_nodes(f).iter().map(|&b| nodes.multiplier(b));
            multipliers.filter(|b| nodes.has_rows(*b)).try_for_each(|b| self.add(b, keys))?;
        }
        Ok(())
    }

    fn mortar_row(&mut self, c: usize, keys: &mut Vec<Key>) -> Result<()> {
        for k in self.neighbours.below.range(c) {
            let f = self.neighbours.below.all[k] as usize;
            let nodes = self.pairs.mortar_nodes(f);
            if nodes.binary_search_by_key(&(c as u32), |n| n.0).is_ok_and(|k| nodes[k].1) {
                self.forces(f, self.couples, keys)?;
            }
        }
        let setup = self.setup;
        for k in self.neighbours.beside.range(c) {
            let mut nodes = setup.mortar.host_nodes(self.neighbours.beside.all[k] as usize).iter();
            nodes.try_for_each(|&d| self.add(self.nodes.mortar(d), keys))?;
        }
        Ok(())
    }
}
