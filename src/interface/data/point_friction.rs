//! Friction where points decide: what a step knows of the points of its overlaps, and the answer at them (docs/formulation 16.7).

use crate::error::Result;
use crate::geometry::{Mat3, Vec3};
use crate::law::Projected;
use crate::memory::Store;
use crate::mortar::{OverlapPoint, PartPoint};
use crate::shape::{MAX_CORNERS, MAX_PARENT_NODES};

/// Reals that a point remembers: a vector.
pub const REALS_PER_POINT: usize = 3;

/// What the points of the facets around a node are told by it.
#[derive(Clone, Copy, Debug, Default)]
pub struct FrictionNode {
    /// nu_A.
    pub normal: Vec3,
    /// T_A: onto what is free and along the surface.
    pub along: Mat3,
    /// sigma_N and sigma_T [F/L^2]; 0 where nothing covers the node.
    pub sigma: (f64, Vec3),
    /// lambda_N and lambda_T.
    pub lambda: (f64, Vec3),
    /// d sigma_A / d lambda_A - 1.
    pub yields: Mat3,
    /// rhat_A / D_A: how sigma follows the weighted gap [F/L^5].
    pub slope: f64,
}

/// The points, and what they answer.
#[derive(Debug, Default)]
pub struct PointFriction {
    /// Of all pairs, one after the other; phi is in their weights.
    pub points: Vec<OverlapPoint>,
    /// Where facets have nodes that are no corners, N_B and N_C of all of them at each point.
    pub all: Vec<[[f64; MAX_PARENT_NODES]; 2]>,
    /// Per pair where its points end.
    pub ends: Vec<usize>,
    /// Of every node.
    pub nodes: Vec<FrictionNode>,
    /// Of every point.
    pub answers: Vec<Projected>,
    /// Per facet int N_A t of its nodes, and per pair int N_C t of the mortar facet's [F].
    pub forces: Vec<[Vec3; MAX_CORNERS]>,
    pub opposite: Vec<[Vec3; MAX_CORNERS]>,
    /// What friction takes in the step, with each node's share of the points [F L].
    pub dissipation: Vec<f64>,
    /// Per node how much of what is covered of it slips.
    pub shares: Vec<f64>,
    /// What the points remember if the step ends here: z of each, `REALS_PER_POINT` numbers.
    pub states: Vec<f64>,
}

impl PointFriction {
    /// Stores the points of the next pair, those that `each` shows.
    pub fn keep(&mut self, each: impl FnOnce(&mut dyn FnMut(OverlapPoint) -> Result<()>) -> Result<()>) -> Result<()> {
        each(&mut |point| self.points.store(point))?;
        self.end_pair()
    }

    /// None of any step.
    pub fn clear(&mut self) {
        self.points.clear();
        self.ends.clear();
        self.all.clear();
    }

    /// Stores another point of a pair of facets that have parts.
    pub fn keep_point(&mut self, point: &PartPoint) -> Result<()> {
        self.all.store(point.all)?;
        self.points.store(point.overlap_point())
    }

    /// Ends a pair whose points are stored.
    pub fn end_pair(&mut self) -> Result<()> {
        self.ends.store(self.points.len())
    }

    /// Multiplies the measure of the points from this pair on.
    pub fn fade(&mut self, first: usize, by: f64) {
        let begin = first.checked_sub(1).map_or(0, |before| self.ends.get(before).copied().unwrap_or(0));
        self.points[begin..].iter_mut().for_each(|point| point.weight *= by);
    }

    /// The places of a pair's points.
    pub fn of_pair(&self, pair: usize) -> std::ops::Range<usize> {
        let begin = pair.checked_sub(1).map_or(0, |before| self.ends[before]);
        begin..self.ends[pair]
    }

    /// The functions of all nodes of both facets at a point, and those of the multipliers.
    #[inline]
    pub fn functions(&self, q: usize) -> [&[f64]; 3] {
        let OverlapPoint { own, other, .. } = &self.points[q];
        self.all.get(q).map_or([own, other, own], |all| [&all[0], &all[1], own])
    }

    /// The same of pairs that follow each other.
    pub fn of_pairs(&self, pairs: std::ops::Range<usize>) -> std::ops::Range<usize> {
        if pairs.is_empty() { 0..0 } else { self.of_pair(pairs.start).start..self.ends[pairs.end - 1] }
    }

    /// The points of these places, and what they answer.
    pub fn answered(&self, pairs: std::ops::Range<usize>) -> (&[OverlapPoint], &[Projected]) {
        let of = self.of_pairs(pairs);
        (&self.points[of.start..of.end], &self.answers[of.start..of.end])
    }

    /// On the heap `[bytes]`.
    pub fn bytes(&self) -> usize {
        self.points.capacity() * size_of::<OverlapPoint>()
            + self.ends.capacity() * size_of::<usize>()
            + self.all.capacity() * size_of::<[[f64; MAX_PARENT_NODES]; 2]>()
            + self.nodes.capacity() * size_of::<FrictionNode>()
            + self.answers.capacity() * size_of::<Projected>()
            + (self.forces.capacity() + self.opposite.capacity()) * size_of::<[Vec3; MAX_CORNERS]>()
            + (self.shares.capacity() + self.states.capacity() + self.dissipation.capacity()) * size_of::<f64>()
    }
}
