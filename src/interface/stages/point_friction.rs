//! Stages 2 and 3 with friction where points decide (docs/formulation 16.7), with weights that are frozen in a step:
//!
//! sigma_A = lambda_A + rhat_A (nu_A nu_A . g_A + g_TA) / D_A;   sigma_N(x) = sum_A N_A sigma_NA
//! sigma_T(x) = P_e (sum_A N_A sigma_TA) + z(x),   t the projection of both on the cone of mu(x) = sum_A N_A mu_A
//! rhat_A c_A = nu_A (int N_A t_N - sum_B L_AB lambda_NB) + T_A (int N_A t_T - sum_B L_AB lambda_TB),   L = m + (rhat / rhat^0) K
//! z of the next step = t_T - P_e sum_A N_A lambda_TA,   work of friction in the step = t_T . (sigma_T - t_T) / sum_A N_A rhat_A
//!
//! z is what a point's traction has that the multipliers' field has not. It stays where nothing slips, so that nothing creeps. Where the
//! weights are made anew at a commit, z is carried to the points of the new ones (`point_memory.rs`).

use super::own::OwnAnswers;
use super::residual::Residual;
use super::sums::NodeSums;
use crate::error::Result;
use crate::geometry::{Mat3, Vec3};
use crate::interface::data::multiplier;
use crate::interface::data::point_friction::{FrictionNode, REALS_PER_POINT};
use crate::interface::data::points::{Closed, Points, Push};
use crate::interface::pairing::given::Given;
use crate::law::{NodeResponse, Projected, State, Threshold, project_parts};
use crate::memory::{self, Store};
use crate::mortar::OverlapPoint;
use crate::shape::MAX_CORNERS;
use nalgebra::SVector;

/// The part of v in the plane with this unit normal.
pub(super) fn in_plane(v: Vec3, normal: Vec3) -> Vec3 {
    v - normal * normal.dot(&v)
}

/// What the field of a facet has at its nodes and at a point: sigma_N, P_e sigma_T, P_e lambda_T, mu, rhat.
#[derive(Clone, Copy, Debug, Default)]
struct Told {
    normal: f64,
    along: Vec3,
    field: Vec3,
    mu: f64,
    rhat: f64,
}

impl Told {
    #[inline]
    fn add(&mut self, node: &Told, n: f64) {
        self.normal += n * node.normal;
        self.along += node.along * n;
        self.field += node.field * n;
        // Rough where a rough node has a part in the point; else infinity times 0 is no number.
        if node.mu.is_finite() || n > 0.0 {
            self.mu += n * node.mu;
        }
        self.rhat += n * node.rhat;
    }
}

/// Of a facet's points, by its nodes: int N_A t, int N_A over what is closed and over what slips, and N_A times the work.
#[derive(Default)]
struct Shares {
    force: [Vec3; MAX_CORNERS],
    closed: [f64; MAX_CORNERS],
    slips: [f64; MAX_CORNERS],
    work: [f64; MAX_CORNERS],
}

impl Shares {
    #[inline]
    fn add(&mut self, answer: &Projected, point: &OverlapPoint, work: f64) {
        if answer.state == State::Gap {
            return;
        }
        for (k, n) in point.own.iter().enumerate() {
            let share = point.weight * n;
            self.force[k] += answer.traction * share;
            self.closed[k] += share;
            self.slips[k] += if answer.state == State::Slip { share } else { 0.0 };
            self.work[k] += work * share;
        }
    }
}

/// Adds a force at a point, by the functions of some nodes.
#[inline(never)] // unrolled it is large
fn add_force(sums: &mut [Vec3], n: &[f64], force: Vec3) {
    sums.iter_mut().zip(n).for_each(|(sum, n)| *sum += force * *n);
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
                let [depth, by_lambda] = self.yields(a);
                node.yields = normal * (normal.transpose() * (by_lambda - 1.0));
                node.sigma.0 = node.lambda.0 + node.slope * (normal.dot(&sum.gap_now) + sum.coverage * depth);
                node.sigma.1 = node.lambda.1 + slip * node.slope;
            }
            self.friction.nodes.store(node)?;
        }
        Ok(())
    }

    /// The answers of the points of a facet, and its nodes' shares of them.
    fn ask<const N: usize>(&mut self, given: Given<N>, at: usize) -> Result<Shares> {
        let limit = given.setup.options.shear_limit.unwrap_or(f64::INFINITY);
        let (facet, remembered, mu) = (&self.facets[at], &given.history().states, &given.setup.nodes.mu);
        let (nodes, e, rhat, friction) = (facet.nodes(), facet.normal, &self.rhat, &mut self.friction);
        let is_open = nodes.iter().all(|&a| friction.nodes[a].sigma.0 >= 0.0);
        // What of the others is closed, their points say.
        self.states.store(if is_open { Closed::Nothing } else { Closed::All })?;
        let (mut told, mut all) = ([Told::default(); MAX_CORNERS], Shares::default());
        for (told, &a) in told.iter_mut().zip(nodes) {
            let node = &friction.nodes[a];
            let (along, field) = (in_plane(node.sigma.1, e), in_plane(node.lambda.1, e));
            *told = Told { normal: node.sigma.0, along, field, mu: mu[a], rhat: rhat[a] };
        }
        for place in facet.places() {
            let (mut opposite, mut push) = ([Vec3::zeros(); MAX_CORNERS], Push::default());
            for q in friction.of_pair(place) {
                let (point, mut here) = (&friction.points[q], Told::default());
                told.iter().zip(&point.own).for_each(|(told, n)| here.add(told, *n));
                let trial = here.along + Vec3::from_fn(|i, _| remembered[REALS_PER_POINT * q + i]);
                let answer = match is_open {
                    true => Projected::gap(),
                    false => project_parts(here.normal, trial, e, Threshold::up_to(limit, here.mu, here.normal)),
                };
                all.add(&answer, point, answer.tangential.dot(&(trial - answer.tangential)) / here.rhat);
                let force = answer.traction * point.weight;
                opposite.iter_mut().zip(&point.other).for_each(|(sum, n)| *sum += force * *n);
                if let Some(all) = friction.all.get(q) {
                    push.iter_mut().zip(all).for_each(|(push, n)| add_force(push, n, force));
                }
                friction.answers.store(answer)?;
                friction.states.store_all((answer.tangential - here.field).iter().copied())?;
            }
            friction.opposite.store(opposite)?;
            if self.has_parts {
                self.pushes.store(push)?;
            }
        }
        friction.forces.store(all.force)?;
        Ok(all)
    }

    /// Stage 2: puts the answers of points in place of the law's at every covered node.
    pub fn respond_with_friction<const N: usize>(
        &mut self,
        given: Given<N>,
        lambda: &[SVector<f64, N>],
        (sums, own): (&[NodeSums], &OwnAnswers),
        responses: &mut [NodeResponse<N>],
    ) -> Result<()> {
        self.check_memory(given)?;
        self.give_way(given, own)?;
        self.tell(given, lambda, sums)?;
        memory::refill(&mut self.shares, 0.0, lambda.len())?;
        memory::refill(&mut self.friction.shares, 0.0, lambda.len())?;
        memory::refill(&mut self.friction.dissipation, 0.0, lambda.len())?;
        self.friction.answers.clear();
        self.friction.forces.clear();
        self.friction.opposite.clear();
        self.pushes.clear();
        self.friction.states.clear();
        self.states.clear();
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
            let of = self.ask(given, at)?;
            let (facet, friction) = (&self.facets[at], &mut self.friction);
            for (k, &a) in facet.nodes().iter().enumerate().filter(|(_, a)| self.is_covered[**a]) {
                let (node, rhat) = (friction.nodes[a], given.rhat(a));
                let (mut normal, mut along) = (facet.normal.dot(&of.force[k]), in_plane(of.force[k], facet.normal));
                for (l, &b) in facet.nodes().iter().enumerate() {
                    let left = facet.mass[k][l] + self.factors[a] * facet.stabilisation[k][l];
                    normal -= left * friction.nodes[b].lambda.0;
                    along -= friction.nodes[b].lambda.1 * left;
                }
                let row = (node.normal * normal + node.along * along) / rhat;
                responses[a].row += SVector::<f64, N>::from_fn(|i, _| row[i]);
                responses[a].traction += of.force[k] / sums[a].coverage;
                self.shares[a] += of.closed[k] / sums[a].coverage;
                friction.shares[a] += of.slips[k] / sums[a].coverage;
                friction.dissipation[a] += of.work[k];
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
        if self.has_parts {
            let of = (given.setup.surfaces(), &given.setup.nodes);
            self.add_pushes(of, (&mut r.nonmortar, &mut r.mortar));
            r.take_rows(given, responses);
            return Ok(());
        }
        let here = self.facets.iter().zip(&self.friction.forces).filter(|(facet, _)| facet.is_here(&given.setup.nodes));
        for (facet, forces) in here {
            facet.nodes().iter().zip(forces).for_each(|(&a, force)| r.nonmortar[a] += force);
            for place in facet.places() {
                let other = two.host_nodes(self.pairs[place].two).iter().zip(&self.friction.opposite[place]);
                other.for_each(|(&c, force)| r.mortar[c] -= force);
            }
        }
        r.take_rows(given, responses);
        Ok(())
    }
}
