//! Where points decide: what a step knows of the facets that have pairs, and the closed part of each pair (docs/formulation 16).

use super::node_data::NodeData;
use super::point_friction::PointFriction;
use crate::geometry::Vec3;
use crate::mortar::{PairWeights, SubWeights};
use crate::shape::{MAX_CORNERS, MAX_PARENT_NODES};
use nalgebra::SVector;
use std::ops::Range;

/// phi int N_B t and phi int N_C t of all nodes of two facets of the host [F].
pub type Push = [[Vec3; MAX_PARENT_NODES]; 2];

/// By two of a facet's nodes.
pub type OfNodes = [[f64; MAX_CORNERS]; MAX_CORNERS];

/// A facet of the host that has pairs.
#[derive(Clone, Copy, Debug)]
pub struct PointFacet {
    /// Its number: that of the surface's facet. Of the host's one it is all, or a part.
    pub one: usize,
    /// Its first pair, and the one after its last.
    pub pairs: [usize; 2],
    /// Its nodes; so many.
    pub nodes: [usize; MAX_CORNERS],
    pub n: usize,
    /// Along which its tractions act: the unit normal of its plane, into the non-mortar body.
    pub normal: Vec3,
    /// phi, which multiplies its measure.
    pub fade: f64,
    /// phi m_AB [L^2].
    pub mass: OfNodes,
    /// K_AB [L^2].
    pub stabilisation: OfNodes,
}

impl PointFacet {
    /// Its nodes.
    pub fn nodes(&self) -> &[usize] {
        &self.nodes[..self.n]
    }

    /// Whether its forces are of this part of the interface: where its first node acts.
    pub fn is_here(&self, nodes: &NodeData) -> bool {
        nodes.acts(self.nodes[0])
    }

    /// The places of its pairs.
    pub fn places(&self) -> Range<usize> {
        self.pairs[0]..self.pairs[1]
    }

    /// The values of a nodal field at its nodes.
    pub fn of(&self, field: &[f64]) -> [f64; MAX_CORNERS] {
        std::array::from_fn(|k| if k < self.n { field[self.nodes[k]] } else { 0.0 })
    }

    /// The same of multipliers along the normal.
    pub fn of_multipliers<const N: usize>(&self, lambda: &[SVector<f64, N>]) -> [f64; MAX_CORNERS] {
        std::array::from_fn(|k| if k < self.n { lambda[self.nodes[k]][0] } else { 0.0 })
    }
}

/// A pair of facets of the host: phi times its weights, and its dual weights.
#[derive(Clone, Copy, Debug)]
pub struct PointPair {
    /// The mortar facet.
    pub two: usize,
    /// Integrated.
    pub whole: PairWeights,
    /// Dual.
    pub dual: PairWeights,
    /// Where facets have parts, the places of the mortar facet's among all of these. Then the weights above are int N_A N_B of
    /// multipliers alone.
    pub parts: [usize; 2],
}

/// Adds n_AB of a pair to those of its facet.
#[inline]
pub fn add_mass(sum: &mut OfNodes, weights: &PairWeights) {
    sum.as_flattened_mut().iter_mut().zip(weights.ab.as_flattened()).for_each(|(sum, n)| *sum += n);
}

/// What a facet is at a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Closed {
    /// sigma < 0 at none of its nodes.
    Nothing,
    /// At all.
    All,
    /// At some; where the weights of its pairs' closed parts begin.
    Part(usize),
}

impl Closed {
    /// phi times n_AB of all pairs of the facet together, of what is closed; `parts`: the weights of the closed parts, `room` for their sum.
    #[inline]
    pub fn mass<'a>(self, facet: &'a PointFacet, parts: &[PairWeights], room: &'a mut OfNodes) -> &'a OfNodes {
        *room = OfNodes::default();
        match self {
            Closed::Nothing => {}
            Closed::All => return &facet.mass,
            Closed::Part(first) => {
                for closed in &parts[first..first + facet.places().len()] {
                    add_mass(room, closed);
                }
            }
        }
        room
    }
}

/// The step, and the answer at a point.
#[derive(Debug, Default)]
pub struct Points {
    /// Whether the members that follow are of the step at hand; with weights of now facets and pairs are of the last positions.
    pub is_settled: bool,
    /// Normals of all planes: with weights of now those of t_n.
    pub planes: Vec<Vec3>,
    /// Facets, ascending.
    pub facets: Vec<PointFacet>,
    /// Their pairs.
    pub pairs: Vec<PointPair>,
    /// What each facet is.
    pub states: Vec<Closed>,
    /// phi times the weights of the closed part of each pair of the facets that are closed in part.
    pub closed: Vec<PairWeights>,
    /// Per node lambda_A and sigma_A [F/L^2], the factor of its K, and how much of what is covered of it is closed.
    pub multipliers: Vec<f64>,
    pub sigma: Vec<f64>,
    pub factors: Vec<f64>,
    pub shares: Vec<f64>,
    /// Per node r_A M_A = rhat_A [F/L^3], of the step; and rhat_A c_A before it is divided by it.
    pub rhat: Vec<f64>,
    pub rows: Vec<f64>,
    /// Per facet int N_A t of its nodes; 0 where it is open.
    pub forces: Vec<[f64; MAX_CORNERS]>,
    /// Per node, where the surfaces give way under pressure, the depth `[L]` and d sigma_A / d lambda_A; else none.
    pub yields: Vec<[f64; 2]>,
    /// Per node int N_A t over its covered area [F/L^2].
    pub tractions: Vec<f64>,
    /// Whether anything covers it.
    pub is_covered: Vec<bool>,
    /// Where facets have nodes that are no corners they come part by part: the mortar facets' parts, pair by pair, and what
    /// multipliers have of all nodes of both facets, of each pair and of each closed part of one, without phi; and what each pair is pushed with.
    pub has_parts: bool,
    pub parts: Vec<usize>,
    pub acts: Vec<SubWeights>,
    pub closed_acts: Vec<SubWeights>,
    pub pushes: Vec<Push>,
    /// With friction.
    pub friction: PointFriction,
}

impl Points {
    /// phi times the weights of the closed part of a pair of the facet that is at this place.
    #[inline]
    pub fn closed(&self, facet: usize, pair: usize) -> Option<&PairWeights> {
        match self.states[facet] {
            Closed::Nothing => None,
            Closed::All => Some(&self.pairs[pair].whole),
            Closed::Part(first) => Some(&self.closed[first + pair - self.facets[facet].pairs[0]]),
        }
    }

    /// The same of what acts on all nodes of both facets, where facets have parts, without phi.
    #[inline]
    pub fn acts(&self, facet: usize, pair: usize) -> Option<&SubWeights> {
        match self.states[facet] {
            _ if !self.has_parts => None,
            Closed::Nothing => None,
            Closed::All => Some(&self.acts[pair]),
            Closed::Part(first) => Some(&self.closed_acts[first + pair - self.facets[facet].pairs[0]]),
        }
    }

    /// The depth by which the surfaces give way at node A, and d sigma_A / d lambda_A.
    #[inline]
    pub fn yields(&self, a: usize) -> [f64; 2] {
        self.yields.get(a).copied().unwrap_or([0.0, 1.0])
    }

    /// On the heap `[bytes]`.
    pub fn bytes(&self) -> usize {
        let reals =
            [&self.multipliers, &self.sigma, &self.factors, &self.shares, &self.rhat, &self.rows, &self.tractions];
        self.planes.capacity() * size_of::<Vec3>()
            + self.facets.capacity() * size_of::<PointFacet>()
            + self.pairs.capacity() * size_of::<PointPair>()
            + self.states.capacity() * size_of::<Closed>()
            + self.closed.capacity() * size_of::<PairWeights>()
            + self.parts.capacity() * size_of::<usize>()
            + (self.acts.capacity() + self.closed_acts.capacity()) * size_of::<SubWeights>()
            + self.pushes.capacity() * size_of::<Push>()
            + reals.iter().map(|v| v.capacity() * size_of::<f64>()).sum::<usize>()
            + self.yields.capacity() * size_of::<[f64; 2]>()
            + self.forces.capacity() * size_of::<[f64; MAX_CORNERS]>()
            + self.is_covered.capacity()
            + self.friction.bytes()
    }
}
