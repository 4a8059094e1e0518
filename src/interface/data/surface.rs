//! One side of an interface: its nodes, facets and equation numbers, checked once.

use super::facet_nodes::{FacetNodes, ParentNodes};
use super::lines::{Lines, shared_ends};
use super::parents::Parents;
use crate::adjacency::{SharedEdge, shared_edges};
use crate::error::{Error, Kind, Result, Text};
use crate::features;
use crate::geometry::{AnalyticShape, AnalyticSurface, FRAME, Facet, Plane, Vec3, check_rigid_motion, in_plane};
use crate::line::Measure;
use crate::memory::{self, Store, Stored};
use crate::mortar::NonmortarFrame;
use crate::normal;
use crate::shape::{MAX_NODES, MAX_PARENT_NODES, Parent, Shape};
use nalgebra::SVector;

/// Neighbouring facets whose normals have a scalar product below this lie on each other: a wedge thinner than a tenth
/// of a degree. The thinnest blade that anyone meshes has several degrees.
const FOLDED: f64 = -1.0 + 1e-6;

/// No equation: the component is prescribed or absent.
pub const NO_EQUATION: i64 = -1;

/// No facet: the edge is on the rim.
pub const NO_FACET: u32 = u32::MAX;

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
    /// The longest edge of any facet in the first configuration `[L]`; 0 of an analytic surface.
    pub longest_edge: f64,
    /// Edges between neighbouring facets.
    pub edges: Vec<SharedEdge>,
    /// Per facet the one beyond each edge, or `NO_FACET`.
    pub neighbours: Vec<[u32; MAX_NODES]>,
    /// Facets as the host has them, where a side of the interface has quadratic ones or lines; `facets` are their parts then.
    pub parents: Option<Parents>,
    /// Per facet whether it is there for what its neighbours look like alone, and has no pairs; empty: none is.
    pub idle: Vec<bool>,
    /// Per node by how much it is offset, see `offsets.rs` `[L]`; empty: no node is.
    pub offsets: Vec<f64>,
    /// How far what lies between the surfaces acts across a gap, and how deep surfaces may overlap in it `[L]`; 0 without.
    pub layer: [f64; 2],
    /// Per facet the one on the other side of its body, or `NO_FACET`, see `pairing/walls.rs`; empty: no facet has one.
    pub backs: Vec<u32>,
    /// The shape of an analytic surface, whose one facet are the four points of its frame; `None`: real facets.
    pub analytic: Option<AnalyticShape>,
}

/// Displacement equations of a node over both surfaces, mortar after non-mortar.
pub fn node_equations<'a>((one, two): (&'a Surface, &'a Surface), node: usize) -> &'a [i64; 3] {
    if node < one.len() { &one.equations[node] } else { &two.equations[node - one.len()] }
}

impl Surface {
    /// Checks and keeps a surface. `facets` lists 0-based node numbers.
    pub fn new(
        side: &'static str,
        reference: Vec<Vec3>,
        facets: &[Vec<i64>],
        equations: Vec<[i64; 3]>,
    ) -> Result<Surface> {
        Surface::build(side, (reference, facets), equations, None)
    }

    /// The same of lines: nodes with z = 0 and without an equation there.
    pub fn of_lines(
        side: &'static str,
        reference: Vec<Vec3>,
        facets: &[Vec<i64>],
        equations: Vec<[i64; 3]>,
        measure: Measure,
    ) -> Result<Surface> {
        features::needs!(LINES);
        Surface::build(side, (reference, facets), equations, Some(measure))
    }

    fn build(
        side: &'static str,
        (reference, facets): (Vec<Vec3>, &[Vec<i64>]),
        equations: Vec<[i64; 3]>,
        measure: Option<Measure>,
    ) -> Result<Surface> {
        let fail = |kind, text: Text| Err(Error::new(kind, text!("{side}: {text}")));
        let n = reference.len();
        if n == 0 || facets.is_empty() {
            return fail(
                Kind::InvalidSize,
                "the surface has no nodes or no facets; at least one of each is needed".into(),
            );
        }
        if equations.len() != n {
            return fail(Kind::InvalidSize, text!("{} nodes have equations; there are {n} nodes", equations.len()));
        }
        if let Some(k) = reference.iter().position(|x| !x.iter().all(|v| v.is_finite())) {
            return fail(Kind::NotFinite, text!("coordinates of node {k} are not finite"));
        }
        let mut given = memory::with_room(facets.len())?;
        let mut used = memory::filled(false, n)?;
        for (f, nodes) in facets.iter().enumerate() {
            let (parent, allowed) = match measure {
                None => (Parent::of(nodes.len()), "3, 4, 6, 8 or 9 are allowed"),
                Some(_) => (Parent::of_line(nodes.len()), "a line has 2 or 3"),
            };
            let Some(parent) = parent else {
                return fail(Kind::InvalidSize, text!("facet {f} has {} nodes; {allowed}", nodes.len()));
            };
            let mut indices = [0; MAX_PARENT_NODES];
            for (k, &node) in nodes.iter().enumerate() {
                let index = usize::try_from(node).ok().filter(|&i| i < n);
                let Some(index) = index else {
                    return fail(
                        Kind::IndexOutOfRange,
                        text!("facet {f} names node {node}; nodes 0 to {} exist", n - 1),
                    );
                };
                if indices[..k].contains(&index) {
                    return fail(Kind::DuplicateNode, text!("facet {f} names node {node} twice"));
                }
                indices[k] = index;
                used[index] = true;
            }
            let first = indices[0];
            indices[nodes.len()..].fill(first);
            given.store(ParentNodes { parent, nodes: indices })?;
        }
        if let Some(k) = used.iter().position(|u| !u) {
            return fail(Kind::InvalidValue, text!("node {k} belongs to no facet; leave it out"));
        }
        if measure.is_none() && given.iter().any(|facet| facet.parent.n > MAX_NODES) {
            features::needs!(QUADRATIC);
        }
        let (parents, kept) = match measure.is_some() || given.iter().any(|facet| facet.parent.n > MAX_NODES) {
            false => {
                let linear = |f: &ParentNodes| FacetNodes { nodes: [0, 1, 2, 3].map(|k| f.nodes[k]), len: f.parent.n };
                (None, given.iter().map(linear).stored()?)
            }
            true => {
                let (mut parents, parts) = Parents::of(given)?;
                parents.lines = measure.map(|measure| Lines::of(measure, &reference, &parts));
                if let Err(e) = parents.check(&reference) {
                    return fail(e.kind, e.message);
                }
                (Some(parents), parts)
            }
        };
        let edges = match measure {
            None => shared_edges(kept.len(), |f| kept[f].as_slice()),
            Some(_) => shared_ends(kept.len(), |f| kept[f].as_slice()),
        };
        let edges = match edges {
            Ok(edges) => edges,
            Err(e) => return fail(e.kind, e.message),
        };
        if kept.len() >= NO_FACET as usize {
            return fail(Kind::InvalidSize, text!("{} facets; fewer than {NO_FACET} are allowed", kept.len()));
        }
        let neighbours = neighbours(&kept, &edges)?;
        let mut surface = Surface {
            side,
            reference,
            facets: kept,
            equations,
            longest_edge: 0.0,
            edges,
            neighbours,
            parents,
            idle: Vec::new(),
            offsets: Vec::new(),
            layer: [0.0; 2],
            backs: Vec::new(),
            analytic: None,
        };
        surface.check_lines(&surface.reference)?;
        surface.longest_edge = surface.longest_edge_at(&surface.reference);
        match surface.folded_edge() {
            None => Ok(surface),
            Some(SharedEdge { nodes: [a, b], facets: [f, g] }) => fail(
                Kind::InvalidValue,
                text!(
                    "facets {} and {} lie on each other: the surface is folded along the edge of nodes {a} and {b}",
                    surface.host_facet(f),
                    surface.host_facet(g)
                ),
            ),
        }
    }

    /// An edge whose facets lie on each other in the first configuration. Facets that are degenerate or folded
    /// themselves are refused elsewhere, each by its own number.
    fn folded_edge(&self) -> Option<SharedEdge> {
        let normal = |f: usize| NonmortarFrame::new(&self.facet(f, &self.reference)).map(|frame| frame.plane.e);
        let folded = |e: &&SharedEdge| match e.facets.map(normal) {
            [Ok(m), Ok(n)] => m.dot(&n) < FOLDED,
            _ => false,
        };
        self.edges.iter().find(folded).copied()
    }

    /// A rigid surface in closed form, placed by the points of its frame (see [`AnalyticSurface`]), which have no equations: four,
    /// of a line and a circle three with z = 0.
    pub fn analytic(side: &'static str, shape: AnalyticShape, frame: Vec<Vec3>) -> Result<Surface> {
        features::needs!(ANALYTIC);
        let fail = |kind, text: Text| Err(Error::new(kind, text!("{side}: {text}")));
        let points = shape.points();
        if frame.len() != points {
            return fail(Kind::InvalidSize, text!("{} nodes; the frame of {shape} has {points}", frame.len()));
        }
        if let Some(k) = frame.iter().position(|x| !x.iter().all(|v| v.is_finite())) {
            return fail(Kind::NotFinite, text!("coordinates of node {k} are not finite"));
        }
        let surface = Surface {
            side,
            reference: frame,
            facets: memory::filled(FacetNodes { nodes: [0, 1, 2, points - 1], len: points }, 1)?,
            equations: memory::filled([NO_EQUATION; 3], points)?,
            longest_edge: 0.0,
            edges: Vec::new(),
            neighbours: memory::filled([NO_FACET; MAX_NODES], 1)?,
            parents: None,
            idle: Vec::new(),
            offsets: Vec::new(),
            layer: [0.0; 2],
            backs: Vec::new(),
            analytic: Some(shape),
        };
        if let Err(e) = surface.analytic_at(&surface.reference) {
            return fail(e.kind, e.message);
        }
        surface.check_rigid(&surface.reference)?;
        Ok(surface)
    }

    /// An analytic surface where the points `x` of its frame are.
    pub fn analytic_at(&self, x: &[Vec3]) -> Result<AnalyticSurface> {
        let shape = self.analytic.expect("asked of analytic surfaces only");
        AnalyticSurface::new(shape, &self.frame_at(shape, x))
    }

    /// The four points of an analytic surface's frame.
    fn frame_at(&self, shape: AnalyticShape, x: &[Vec3]) -> [Vec3; FRAME] {
        let at = self.facets[0].nodes.map(|k| x[k]);
        if shape.is_in_plane() { in_plane([at[0], at[1], at[2]]) } else { at }
    }

    /// Refuses positions of an analytic surface's frame that are no rigid motion of the first ones.
    pub fn check_rigid(&self, x: &[Vec3]) -> Result<()> {
        let Some(shape) = self.analytic else { return Ok(()) };
        let refuse = |e: Error| Error::new(e.kind, text!("{}: {}", self.side, e.message));
        if let Some(k) = x.iter().position(|x| shape.is_in_plane() && x.z != 0.0) {
            let text = text!("node {k} has z = {:e}; nodes of plane models have z = 0", x[k].z);
            return Err(refuse(Error::new(Kind::InvalidValue, text)));
        }
        let [first, now] = [&self.reference[..], x].map(|x| self.frame_at(shape, x));
        check_rigid_motion(&first, &now).map_err(refuse)
    }

    /// What the lines of a plane or axisymmetric model are; `None`: the model is in space.
    pub fn lines(&self) -> Option<&Lines> {
        self.parents.as_ref().filter(|_| features::LINES.built).and_then(|parents| parents.lines.as_ref())
    }

    /// h_A, about as long as the facets around a node at `x` with this area M_A are wide `[L]`.
    pub fn size(&self, area: f64, x: Vec3) -> f64 {
        self.lines().map_or_else(|| area.sqrt(), |lines| lines.size(area, x))
    }

    /// Refuses positions of lines that lie out of their plane, or beyond the axis of their model.
    pub fn check_lines(&self, x: &[Vec3]) -> Result<()> {
        self.lines().map_or(Ok(()), |lines| lines.check(self.side, x))
    }

    /// The longest edge of any facet at the node positions `x` `[L]`.
    pub fn longest_edge_at(&self, x: &[Vec3]) -> f64 {
        (0..self.facets.len()).map(|f| self.facet(f, x).longest_edge()).fold(0.0, f64::max)
    }

    /// Per node the sum of the unit normals of its facets' corners, which gives nu (docs/formulation 4.1).
    pub(crate) fn sums_of_normals(&self, x: &[Vec3]) -> Result<Vec<Vec3>> {
        let mut sums = Vec::new();
        self.add_normals(x, &mut sums)?;
        Ok(sums)
    }

    /// The same, in place of what was in `sums`.
    pub(crate) fn add_normals(&self, x: &[Vec3], sums: &mut Vec<Vec3>) -> Result<()> {
        memory::refill(sums, Vec3::zeros(), self.len())?;
        if let Some(parents) = &self.parents {
            for (f, facet) in parents.facets.iter().enumerate() {
                let at = parents.at(f, x);
                facet.as_slice().iter().enumerate().for_each(|(k, &a)| sums[a] += at.normal(k));
            }
            return Ok(());
        }
        for (f, nodes) in self.facets.iter().enumerate() {
            let facet = self.facet(f, x);
            nodes.as_slice().iter().enumerate().for_each(|(k, &a)| sums[a] += normal::corner_normal(&facet, k));
        }
        Ok(())
    }

    /// Unit normals of the planes of all facets, in place of what was in `normals`; zeros of degenerate ones, of which
    /// [`Surface::frame`] says more.
    pub(crate) fn plane_normals(&self, x: &[Vec3], normals: &mut Vec<Vec3>) -> Result<()> {
        normals.clear();
        normals.store_all((0..self.facets.len()).map(|f| Plane::of(&self.facet(f, x)).map_or(Vec3::zeros(), |p| p.e)))
    }

    /// The frame of a facet; `normals`: those of all planes.
    pub(crate) fn frame(&self, f: usize, x: &[Vec3], normals: &[Vec3]) -> Result<NonmortarFrame> {
        let mut frame = NonmortarFrame::new(&self.facet(f, x)).map_err(self.at(f))?;
        for (beyond, &g) in frame.plane.beyond.iter_mut().zip(&self.neighbours[f]) {
            if g != NO_FACET {
                *beyond = Some(normals[g as usize]);
            }
        }
        Ok(frame)
    }

    /// The first refusal of any facet's frame at `x`, if there is one.
    #[cold]
    pub(crate) fn refused_frame(&self, x: &[Vec3]) -> Option<Error> {
        let refusal = |f: usize| NonmortarFrame::new(&self.facet(f, x)).map_err(self.at(f)).err();
        (0..self.facets.len()).find_map(refusal)
    }

    /// Number of nodes.
    pub fn len(&self) -> usize {
        self.reference.len()
    }

    /// Facet `f` at the node positions `x`.
    pub fn facet(&self, f: usize, x: &[Vec3]) -> Facet {
        let nodes = &self.facets[f];
        if let Some(lines) = self.lines() {
            return lines.facet([x[nodes.nodes[0]], x[nodes.nodes[1]]]);
        }
        let shape = Shape::of(nodes.len).expect("a checked facet has 3 or 4 nodes");
        Facet { nodes: nodes.nodes.map(|k| x[k]), shape }
    }
}

/// The frames of all facets of a surface.
pub fn frames(surface: &Surface, x: &[Vec3]) -> Result<Vec<NonmortarFrame>> {
    let mut normals = Vec::new();
    surface.plane_normals(x, &mut normals)?;
    // A collected Result knows no length, and frames are large.
    let mut frames = memory::with_room(surface.facets.len())?;
    for f in 0..surface.facets.len() {
        frames.store(surface.frame(f, x, &normals)?)?;
    }
    Ok(frames)
}

/// Per facet the one beyond each edge.
fn neighbours(facets: &[FacetNodes], edges: &[SharedEdge]) -> Result<Vec<[u32; MAX_NODES]>> {
    let mut neighbours = memory::filled([NO_FACET; MAX_NODES], facets.len())?;
    for edge in edges {
        // Each runs the edge from another end.
        for (i, from) in edge.nodes.into_iter().enumerate() {
            let (facet, beyond) = (edge.facets[i], edge.facets[1 - i]);
            if let Some(k) = facets[facet].as_slice().iter().position(|&node| node == from) {
                // The quadrilateral of a line has its neighbours beyond its second edge and its last one.
                let edge = if facets[facet].len == 2 { [3, 1][k] } else { k };
                neighbours[facet][edge] = beyond as u32;
            }
        }
    }
    Ok(neighbours)
}

/// Whether vectors are the same numbers; 0 and -0 are not, nor are results in every bit.
pub fn are_same<const K: usize>(x: &[SVector<f64, K>], y: &[SVector<f64, K>]) -> bool {
    let is_same =
        |(x, y): (&SVector<f64, K>, &SVector<f64, K>)| x.iter().zip(y).all(|(a, b)| a.to_bits() == b.to_bits());
    x.len() == y.len() && x.iter().zip(y).all(is_same)
}
