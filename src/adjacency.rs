//! Which facets of a surface are neighbours: those that run one edge, in opposite directions.
//!
//! Knows node numbers only. A surface seen from outside throughout, and without branches, has at most two facets at an
//! edge, and they run it in opposite directions.

use crate::error::{Error, Kind, Result};
use crate::memory::{self, Store};

/// An edge that two facets share.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SharedEdge {
    /// Its ends, the smaller node number first.
    pub nodes: [usize; 2],
    /// The facet that runs it from the first end to the second one, then the other one.
    pub facets: [usize; 2],
}

/// The shared edges of a surface whose facets have the nodes that `nodes` gives, sorted by their ends.
///
/// # Errors
/// [`Kind::InvalidValue`] where two facets run an edge in the same direction, naming both.
pub fn shared_edges<'a>(n_facets: usize, nodes: impl Fn(usize) -> &'a [usize]) -> Result<Vec<SharedEdge>> {
    let mut edges = memory::with_room(4 * n_facets)?;
    for f in 0..n_facets {
        let nodes = nodes(f);
        for k in 0..nodes.len() {
            let (a, b) = (nodes[k], nodes[(k + 1) % nodes.len()]);
            edges.store((a.min(b), a.max(b), a > b, f))?;
        }
    }
    memory::sort(&mut edges)?;
    let mut shared = memory::with_room(edges.len() / 2)?;
    for pair in edges.windows(2) {
        let ((a, b, against, f), (c, d, other, g)) = (pair[0], pair[1]);
        if (a, b) != (c, d) {
            continue;
        }
        if against == other {
            let text = text!(
                "facets {f} and {g} run the edge between nodes {a} and {b} in the same direction: the node order of one of them is reversed, or the surface branches there"
            );
            return Err(Error::new(Kind::InvalidValue, text));
        }
        shared.store(SharedEdge { nodes: [a, b], facets: [f, g] })?;
    }
    Ok(shared)
}

/// Lists, one after the other: one vector for all of them.
#[derive(Debug)]
pub struct Lists<T> {
    /// All items.
    pub items: Vec<T>,
    /// Where each list ends, after a 0.
    ends: Vec<usize>,
}

impl<T> Lists<T> {
    /// No lists, with room for so many.
    pub fn with_room(lists: usize) -> Result<Lists<T>> {
        let mut ends = memory::with_room(lists + 1)?;
        ends.store(0)?;
        Ok(Lists { items: Vec::new(), ends })
    }

    /// The list that items were added to is complete.
    pub fn end(&mut self) -> Result<()> {
        self.ends.store(self.items.len())
    }

    /// One of them.
    pub fn of(&self, k: usize) -> &[T] {
        &self.items[self.ends[k]..self.ends[k + 1]]
    }
}

impl Lists<usize> {
    /// Per node the facets around it, in their order; `nodes` gives those of a facet.
    pub fn around<'a>(n_nodes: usize, n_facets: usize, nodes: impl Fn(usize) -> &'a [usize]) -> Result<Lists<usize>> {
        let mut ends = memory::filled(0, n_nodes + 1)?;
        let pairs = || (0..n_facets).flat_map(|f| nodes(f).iter().map(move |&a| (f, a)));
        pairs().for_each(|(_, a)| ends[a + 1] += 1);
        for a in 0..n_nodes {
            ends[a + 1] += ends[a];
        }
        let (mut next, mut items) = (memory::copied(&ends)?, memory::filled(0, ends[n_nodes])?);
        for (f, a) in pairs() {
            items[next[a]] = f;
            next[a] += 1;
        }
        Ok(Lists { items, ends })
    }
}

/// The item that stands for the group of `item`, where `parent` gives each item another one of its group, or itself where
/// it stands for it. The way to it is halved.
pub fn root(parent: &mut [usize], mut item: usize) -> usize {
    while parent[item] != item {
        parent[item] = parent[parent[item]];
        item = parent[item];
    }
    item
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shared(facets: &[&[usize]]) -> Result<Vec<SharedEdge>> {
        shared_edges(facets.len(), |f| facets[f])
    }

    #[test]
    fn neighbours_run_their_edge_in_opposite_directions() {
        let edge = |nodes, facets| SharedEdge { nodes, facets };
        assert_eq!(shared(&[&[0, 1, 2]]), Ok(vec![]));
        assert_eq!(shared(&[&[0, 1, 4, 3], &[1, 2, 4]]), Ok(vec![edge([1, 4], [0, 1])]));
        assert_eq!(shared(&[&[4, 1, 2], &[0, 1, 4, 3]]), Ok(vec![edge([1, 4], [1, 0])]));
        let tetrahedron = shared(&[&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[2, 0, 3]]).unwrap();
        assert_eq!(tetrahedron.len(), 6);
    }

    #[test]
    fn reversed_and_branching_facets_are_named() {
        for facets in [[&[0_usize, 1, 4, 3][..], &[4, 2, 1]], [&[0, 1, 2], &[0, 1, 3]], [&[0, 1, 2], &[1, 2, 0]]] {
            let error = shared(&facets).unwrap_err();
            assert_eq!(error.kind, Kind::InvalidValue);
            assert!(error.message.starts_with("facets 0 and 1 run the edge"), "{}", error.message);
        }
        let branch = shared(&[&[0, 1, 2], &[1, 0, 3], &[0, 1, 4]]).unwrap_err();
        assert!(branch.message.starts_with("facets 0 and 2"), "{}", branch.message);
    }
}
