//! Nodes of facets: of the linear ones that geometry is made of, and of facets as hosts have them, which may be quadratic.

use crate::shape::{MAX_NODES, MAX_PARENT_NODES, Parent};

/// A facet's nodes as indices into the surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FacetNodes {
    /// Indices; entries beyond `len` repeat the first one.
    pub nodes: [usize; MAX_NODES],
    /// 3 or 4; 2 of a part of a line.
    pub len: usize,
}

impl FacetNodes {
    /// The nodes in use.
    pub fn as_slice(&self) -> &[usize] {
        &self.nodes[..self.len]
    }

    /// The node at a corner of what geometry takes it for: the quadrilateral of a line has each node twice.
    pub fn of_corner(&self, k: usize) -> usize {
        self.nodes[if self.len == 2 { [0, 1, 1, 0][k] } else { k }]
    }
}

/// A facet of the host: its nodes as indices into the surface.
#[derive(Clone, Copy, Debug)]
pub struct ParentNodes {
    /// Its kind.
    pub parent: &'static Parent,
    /// Indices; entries beyond the kind's nodes repeat the first one.
    pub nodes: [usize; MAX_PARENT_NODES],
}

impl ParentNodes {
    /// The nodes in use.
    pub fn as_slice(&self) -> &[usize] {
        &self.nodes[..self.parent.n]
    }

    /// Those with these places.
    pub fn part(&self, places: &[usize]) -> FacetNodes {
        let mut nodes = [self.nodes[places[0]]; MAX_NODES];
        places.iter().zip(&mut nodes).for_each(|(&k, node)| *node = self.nodes[k]);
        FacetNodes { nodes, len: places.len() }
    }
}
