//! One side of an interface: its nodes, facets and equation numbers, checked once.

use crate::error::{Error, Kind, Result};
use crate::geometry::{Facet, Vec3};
use crate::shape::MAX_NODES;

/// No equation: the component is prescribed or absent.
pub const NO_EQUATION: i64 = -1;

/// A facet's nodes as indices into the surface.
#[derive(Clone, Copy, Debug)]
pub struct FacetNodes {
    /// Indices; entries beyond `len` repeat the first one.
    pub nodes: [usize; MAX_NODES],
    /// 3 or 4.
    pub len: usize,
}

/// A checked surface.
#[derive(Clone, Debug)]
pub struct Surface {
    /// Name for messages: "nonmortar" or "mortar".
    pub side: &'static str,
    /// Node positions of the first configuration.
    pub reference: Vec<Vec3>,
    /// Facets.
    pub facets: Vec<FacetNodes>,
    /// Displacement equations per node and component, 0-based, or [`NO_EQUATION`].
    pub equations: Vec<[i64; 3]>,
    /// The longest edge of any facet in the first configuration `[L]`.
    pub longest_edge: f64,
}

impl Surface {
    /// Checks and keeps a surface. `facets` lists 0-based node numbers.
    pub fn new(
        side: &'static str,
        reference: Vec<Vec3>,
        facets: &[Vec<i64>],
        equations: Vec<[i64; 3]>,
    ) -> Result<Surface> {
        let fail = |kind, text: String| Err(Error::new(kind, format!("{side}: {text}")));
        let n = reference.len();
        if n == 0 || facets.is_empty() {
            return fail(
                Kind::InvalidSize,
                "the surface has no nodes or no facets; at least one of each is needed".into(),
            );
        }
        if equations.len() != n {
            return fail(Kind::InvalidSize, format!("{} nodes have equations; there are {n} nodes", equations.len()));
        }
        if let Some(k) = reference.iter().position(|x| !x.iter().all(|v| v.is_finite())) {
            return fail(Kind::NotFinite, format!("coordinates of node {k} are not finite"));
        }
        let mut kept = Vec::with_capacity(facets.len());
        let mut used = vec![false; n];
        for (f, nodes) in facets.iter().enumerate() {
            if !(3..=MAX_NODES).contains(&nodes.len()) {
                return fail(Kind::InvalidSize, format!("facet {f} has {} nodes; 3 or 4 are allowed", nodes.len()));
            }
            let mut indices = [0; MAX_NODES];
            for (k, &node) in nodes.iter().enumerate() {
                let index = usize::try_from(node).ok().filter(|&i| i < n);
                let Some(index) = index else {
                    return fail(
                        Kind::IndexOutOfRange,
                        format!("facet {f} names node {node}; nodes 0 to {} exist", n - 1),
                    );
                };
                if indices[..k].contains(&index) {
                    return fail(Kind::DuplicateNode, format!("facet {f} names node {node} twice"));
                }
                indices[k] = index;
                used[index] = true;
            }
            let first = indices[0];
            indices[nodes.len()..].fill(first);
            kept.push(FacetNodes { nodes: indices, len: nodes.len() });
        }
        if let Some(k) = used.iter().position(|u| !u) {
            return fail(Kind::InvalidValue, format!("node {k} belongs to no facet; leave it out"));
        }
        let mut surface = Surface { side, reference, facets: kept, equations, longest_edge: 0.0 };
        for f in 0..surface.facets.len() {
            surface.longest_edge = surface.longest_edge.max(surface.facet(f, &surface.reference).longest_edge());
        }
        Ok(surface)
    }

    /// Number of nodes.
    pub fn len(&self) -> usize {
        self.reference.len()
    }

    /// Facet `f` at the node positions `x`.
    pub fn facet(&self, f: usize, x: &[Vec3]) -> Facet {
        let nodes = &self.facets[f];
        let points = nodes.nodes.map(|k| x[k]);
        Facet::new(&points[..nodes.len]).expect("a checked facet has 3 or 4 nodes")
    }
}
