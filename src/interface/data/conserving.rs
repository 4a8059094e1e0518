//! What a step with conserving weights knows of each node (docs/formulation 21): its gap as a function of the places alone, how that
//! depends on them, and the force that works exactly what it changes by.

use super::active::Active;
use super::surface::Surface;
use crate::error::Result;
use crate::geometry::{Mat3, Vec3};
use crate::line::Measure;
use crate::memory::{self, Store};

/// How the gap of a node depends on the place of another one, or of itself.
#[derive(Clone, Copy, Debug)]
pub struct Dependence {
    /// Over both surfaces, mortar after non-mortar.
    pub node: usize,
    /// n_AB, or - n_AC.
    pub weight: f64,
    /// D of the vector g[n, x]_A.
    pub gap: Mat3,
    /// D of what is covered.
    pub area: Vec3,
    /// D of the sum of the corner normals around A.
    pub sum: Mat3,
}

/// The gap of a node at some places.
#[derive(Clone, Debug, Default)]
pub struct NodeGap {
    /// nu_A.
    pub normal: Vec3,
    /// d nu / d (sum of the corner normals).
    pub turn: Mat3,
    /// (d nu / d sum) as a function of the sum has this sum, within the free directions.
    pub sum: Vec3,
    /// g[n, x]_A.
    pub gap: Vec3,
    /// What is covered [L^2].
    pub coverage: f64,
    /// On what it depends, each node once.
    pub nodes: Vec<Dependence>,
}

impl NodeGap {
    /// nu_A . g_A over what is covered [L]; 0 where nothing is.
    pub fn mean(&self) -> f64 {
        if self.coverage > 0.0 { self.normal.dot(&self.gap) / self.coverage } else { 0.0 }
    }

    /// D nu_A.
    pub fn turned(&self, on: &Dependence) -> Mat3 {
        self.turn * on.sum
    }

    /// D (nu_A . g_A) less a gap times D of what is covered.
    pub fn slope(&self, on: &Dependence, less: f64) -> Vec3 {
        on.gap.tr_mul(&self.normal) + self.turned(on).tr_mul(&self.gap) - on.area * less
    }

    /// The dependence on a node.
    pub fn on(&mut self, node: usize) -> Result<&mut Dependence> {
        let at = self.nodes.iter().position(|on| on.node == node).unwrap_or(self.nodes.len());
        if at == self.nodes.len() {
            let (none, area) = (Mat3::zeros(), Vec3::zeros());
            self.nodes.store(Dependence { node, weight: 0.0, gap: none, area, sum: none })?;
        }
        Ok(&mut self.nodes[at])
    }

    /// Without anything, in the same memory.
    pub fn clear(&mut self) {
        let mut nodes = std::mem::take(&mut self.nodes);
        nodes.clear();
        *self = NodeGap { nodes, ..NodeGap::default() };
    }
}

/// Rigid motions that are taken out of what the nodes around a gap do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rigid {
    /// None: the other side is fixed in closed form.
    Nothing,
    /// Of space.
    Space,
    /// Of a plane model.
    Plane,
    /// Along the axis, which is the second direction.
    Axis,
}

impl Rigid {
    /// Of what lies on both sides.
    pub fn of((one, two): (&Surface, &Surface)) -> Rigid {
        match one.lines() {
            _ if two.analytic.is_some() => Rigid::Nothing,
            Some(lines) if lines.measure == Measure::Axisymmetric => Rigid::Axis,
            Some(_) => Rigid::Plane,
            None => Rigid::Space,
        }
    }

    /// The directions of the translations among them, on the diagonal.
    pub fn translations(self) -> Mat3 {
        match self {
            Rigid::Nothing => Mat3::zeros(),
            Rigid::Axis => Mat3::from_diagonal(&Vec3::y()),
            Rigid::Space | Rigid::Plane => Mat3::identity(),
        }
    }

    /// The inverse of what Sum r x (w x r) makes of a turn w, of these r from their centre; zero for turns that there are not.
    pub fn inverse_inertia(self, arms: impl Iterator<Item = Vec3>) -> Mat3 {
        let inertia: Mat3 = arms.map(|r| Mat3::identity() * r.norm_squared() - r * r.transpose()).sum();
        match self {
            Rigid::Nothing | Rigid::Axis => Mat3::zeros(),
            Rigid::Plane => Mat3::from_diagonal(&Vec3::new(0.0, 0.0, 1.0 / inertia[(2, 2)])),
            Rigid::Space => inertia.try_inverse().unwrap_or_else(Mat3::zeros),
        }
    }
}

/// What a node does in a step: the discrete derivative of its mean gap, times what is covered half way.
#[derive(Clone, Debug, Default)]
pub struct NodeForce {
    /// What its gap at the end of the step is above the bound times what is covered then [L^3].
    pub above: f64,
    /// The bound e of the mean gap [L].
    pub bound: f64,
    /// What its mean gap changes by.
    pub change: f64,
    /// q; 0 where nothing moves, or no gap was known.
    pub quotient: f64,
    /// z . z; 0 where nothing moves.
    pub size: f64,
    /// Of the nodes that its gap depends on at the mean places: D, z, and the motion in the step.
    pub force: Vec<Vec3>,
    pub along: Vec<Vec3>,
    pub moved: Vec<Vec3>,
    /// Their places from their centre, half way.
    pub arms: Vec<Vec3>,
    /// The turn that was taken out of the motion.
    pub spin: Vec3,
    /// [`Rigid::inverse_inertia`] of the arms.
    pub inverse: Mat3,
}

/// What is known of a step at its end.
#[derive(Debug, Default)]
pub struct Conserving {
    /// The pairs at the mean places.
    pub mean: Active,
    /// The gaps at the end and at the mean places.
    pub gaps: [Vec<NodeGap>; 2],
    /// Of every node.
    pub forces: Vec<NodeForce>,
}

impl Conserving {
    /// On the heap `[bytes]`, but for the pairs.
    pub fn bytes(&self) -> usize {
        let of_gap = |gap: &NodeGap| size_of::<NodeGap>() + gap.nodes.capacity() * size_of::<Dependence>();
        let gaps = self.gaps.iter().flatten().map(of_gap).sum::<usize>();
        let of_force = |force: &NodeForce| {
            let vectors = [&force.force, &force.along, &force.moved, &force.arms];
            size_of::<NodeForce>() + vectors.map(|v| v.capacity() * size_of::<Vec3>()).iter().sum::<usize>()
        };
        gaps + self.forces.iter().map(of_force).sum::<usize>()
    }

    /// Of the surfaces that are apart: nothing.
    pub fn clear(&mut self, nodes: usize) -> Result<()> {
        self.mean.clear();
        for gaps in &mut self.gaps {
            renew(gaps, nodes)?;
        }
        self.forces.clear();
        memory::grow(&mut self.forces, nodes)?;
        (0..nodes).try_for_each(|_| self.forces.store(NodeForce::default()))
    }
}

/// So many without anything, in the memory of those that there were.
pub fn renew(gaps: &mut Vec<NodeGap>, nodes: usize) -> Result<()> {
    gaps.truncate(nodes);
    gaps.iter_mut().for_each(NodeGap::clear);
    while gaps.len() < nodes {
        gaps.store(NodeGap::default())?;
    }
    Ok(())
}
