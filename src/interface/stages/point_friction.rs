//! Stages 2 and 3 with friction where points decide (docs/formulation.md 16.7), with weights that are frozen in a step:
//!
//! sigma_A = lambda_A + rhat_A (nu_A nu_A . g_A + g_TA) / D_A;   sigma_N(x) = sum_A N_A sigma_NA
//! sigma_T(x) = P_e (sum_A N_A sigma_TA) + z(x),   t the projection of both on the cone of mu(x) = sum_A N_A mu_A
//! rhat_A c_A = nu_A (int N_A t_N - sum_B L_AB lambda_NB) + T_A (int N_A t_T - sum_B L_AB lambda_TB),   L = m + (rhat / rhat^0) K
//! z of the next step = t_T - P_e sum_A N_A lambda_TA,   work of friction in the step = t_T . (sigma_T - t_T) / sum_A N_A rhat_A
//!
//! z is what a point's traction has that the multipliers' field has not. It stays where nothing slips, so that nothing creeps. Where the
//! weights are made anew at a commit, z is carried to the points of the new ones (`point_memory.rs`).

use super::residual::Residual;
use super::sums::NodeSums;
use crate::error::Result;
use crate::geometry::{Mat3, Vec3};
use crate::interface::data::multiplier;
use crate::interface::data::point_friction::{FrictionNode, REALS_PER_POINT};
use crate::interface::data::points::Points;
use crate::interface::pairing::given::Given;
use crate::law::{NodeResponse, Projected, State, Threshold, project_parts};
use crate::memory::{self, Store};
use nalgebra::SVector;

/// The part of v in the plane with this unit normal.
pub(super) fn in_plane(v: Vec3, normal: Vec3) -> Vec3 {
    v - normal * normal.dot(&v)
}

impl Points {
    /// Points of the step, each of which remembers a vector.
    pub fn count<const N: usize>(&mut self, given: Given<N>) -> Result<usize> {
        self.settle(given)?;
        Ok(self.friction.points.len())
    }

    /// What the nodes tell the points.
    fn tell<const N: usize>(&mut self, given: Given<N>, lambda: &[SVector<f64, N>], sums: &[NodeSums]) -> Result<()> {
        let (_, committed) = given.setup.options.effective_slip().coefficients();
        self.friction.nodes.clear();
        memory::refill(&mut self.is_covered, false, lambda.len())?;
        for (a, (lambda, sum)) in lambda.iter().zip(sums).enumerate() {
            let normal = given.normal(a)?;
            let lambda = multiplier::traction(lambda, normal);
            let along = given.setup.nodes.free[a] - normal * normal.transpose();
            let mut node = FrictionNode { normal, along, ..FrictionNode::default() };
            node.lambda = (normal.dot(&lambda), along * lambda);
            if sum.coverage > given.least_coverage(a) {
                self.is_covered[a] = true;
                node.slope = self.rhat[a] / sum.coverage;
                let slip = along * (sum.gap_now - sum.gap_committed * committed);
                node.sigma.0 = node.lambda.0 + node.slope * normal.dot(&sum.gap_now);
                node.sigma.1 = node.lambda.1 + slip * node.slope;
            }
            self.friction.nodes.store(node)?;
        }
        Ok(())
    }

    /// The answers of the points of a facet.
    fn ask<const N: usize>(&mut self, given: Given<N>, at: usize) -> Result<()> {
        let (facet, states, mu) = (&self.facets[at], &given.history().states, &given.setup.nodes.mu);
        let (nodes, e, rhat, friction) = (facet.nodes(), facet.normal, &self.rhat, &mut self.friction);
        let is_open = nodes.iter().all(|&a| friction.nodes[a].sigma.0 >= 0.0);
        for place in facet.places() {
            for q in friction.of_pair(place) {
                let point = &friction.points[q];
                let (mut n, mut t, mut coefficient, mut field) = (0.0, Vec3::zeros(), 0.0, Vec3::zeros());
                let mut stiffness = 0.0;
                for (&a, own) in nodes.iter().zip(&point.own) {
                    let node = &friction.nodes[a];
                    n += own * node.sigma.0;
                    t += node.sigma.1 * *own;
                    coefficient += own * mu[a];
                    field += node.lambda.1 * *own;
                    stiffness += own * rhat[a];
                }
                let z = Vec3::from_fn(|i, _| states[REALS_PER_POINT * q + i]);
                let trial = in_plane(t, e) + z;
                let answer = match is_open {
                    true => Projected::gap(),
                    false => project_parts(n, trial, e, Threshold::cone(coefficient, n)),
                };
                let left = answer.tangential - in_plane(field, e);
                let cut = answer.tangential.dot(&(trial - answer.tangential));
                friction.work.store(cut / stiffness)?;
                friction.answers.store(answer)?;
                friction.states.store_all(left.iter().copied())?;
            }
        }
        Ok(())
    }

    /// Stage 2: puts the answers of points in place of the law's at every covered node.
    pub fn respond_with_friction<const N: usize>(
        &mut self,
        given: Given<N>,
        lambda: &[SVector<f64, N>],
        sums: &[NodeSums],
        responses: &mut [NodeResponse<N>],
    ) -> Result<()> {
        self.check_memory(given)?;
        self.tell(given, lambda, sums)?;
        memory::refill(&mut self.shares, 0.0, lambda.len())?;
        memory::refill(&mut self.friction.shares, 0.0, lambda.len())?;
        memory::refill(&mut self.friction.dissipation, 0.0, lambda.len())?;
        self.friction.answers.clear();
        self.friction.work.clear();
        self.friction.states.clear();
        for (a, response) in responses.iter_mut().enumerate().filter(|(a, _)| self.is_covered[*a]) {
            let node = &self.friction.nodes[a];
            (response.state, response.traction, response.gap_normal) =
                (State::Gap, Vec3::zeros(), node.normal.dot(&sums[a].gap_now));
            // What is not free stays 0, by a row of its own.
            let free = given.setup.nodes.free[a];
            let held =
                (Mat3::identity() - free) * multiplier::traction(&lambda[a], node.normal) / -given.augmentation(a);
            response.row = SVector::from_fn(|i, _| held[i]);
            response.sigma = node.normal * node.sigma.0 + node.sigma.1;
        }
        for at in 0..self.facets.len() {
            self.ask(given, at)?;
            let (facet, friction) = (&self.facets[at], &mut self.friction);
            for (k, &a) in facet.nodes().iter().enumerate().filter(|(_, a)| self.is_covered[**a]) {
                let (node, rhat) = (friction.nodes[a], self.rhat[a]);
                let (mut force, mut closed, mut slips) = (Vec3::zeros(), 0.0, 0.0);
                let mut work = 0.0;
                for q in facet.places().flat_map(|place| friction.of_pair(place)) {
                    let (answer, share) = (&friction.answers[q], friction.points[q].weight * friction.points[q].own[k]);
                    force += answer.traction * share;
                    closed += if answer.state == State::Gap { 0.0 } else { share };
                    slips += if answer.state == State::Slip { share } else { 0.0 };
                    work += friction.work[q] * share;
                }
                let (mut normal, mut along) = (facet.normal.dot(&force), in_plane(force, facet.normal));
                for (l, &b) in facet.nodes().iter().enumerate() {
                    let left = facet.mass[k][l] + self.factors[a] * facet.stabilisation[k][l];
                    normal -= left * friction.nodes[b].lambda.0;
                    along -= friction.nodes[b].lambda.1 * left;
                }
                let row = (node.normal * normal + node.along * along) / rhat;
                responses[a].row += SVector::<f64, N>::from_fn(|i, _| row[i]);
                responses[a].traction += force / sums[a].coverage;
                self.shares[a] += closed / sums[a].coverage;
                friction.shares[a] += slips / sums[a].coverage;
                friction.dissipation[a] += work;
            }
        }
        for (a, response) in responses.iter_mut().enumerate().filter(|(a, _)| self.shares[*a] > 0.0) {
            response.state = if self.friction.shares[a] > 0.0 { State::Slip } else { State::Stick };
        }
        Ok(())
    }

    /// Stage 3: forces and rows.
    pub fn residual_with_friction<const N: usize>(
        &self,
        given: Given<N>,
        responses: &[NodeResponse<N>],
        r: &mut Residual<N>,
    ) -> Result<()> {
        let two = &given.setup.mortar;
        r.clear(given.setup.surfaces())?;
        for facet in &self.facets {
            for place in facet.places() {
                let other = two.host_nodes(self.pairs[place].two);
                for q in self.friction.of_pair(place) {
                    let point = &self.friction.points[q];
                    let t = self.friction.answers[q].traction * point.weight;
                    facet.nodes().iter().zip(&point.own).for_each(|(&a, n)| r.nonmortar[a] += t * *n);
                    other.iter().zip(&point.other).for_each(|(&c, n)| r.mortar[c] -= t * *n);
                }
            }
        }
        r.take_rows(given, responses);
        Ok(())
    }
}
