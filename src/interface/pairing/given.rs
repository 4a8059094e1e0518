//! All that an evaluation is given besides positions and multipliers: what the interface is, and what t_n has settled.
//! Read only, and the same for every stage.

use super::settle::Pairing;
use super::weak::Carrier;
use crate::error::{Error, Kind, Result};
use crate::geometry::{Mat3, Vec3};
use crate::interface::data::history::History;
use crate::interface::data::node_data::check_length;
use crate::interface::data::options::{Normals, RowScale};
use crate::interface::data::setup::Setup;
use crate::law::{NodeResponse, State};
use crate::memory::{Store, Stored};
use crate::normal::SMALLEST_SUM;
use nalgebra::SVector;

/// The step: t_n, and what follows from it.
#[derive(Debug)]
pub struct Step {
    /// t_n.
    pub history: History,
    /// What it settles.
    pub pairing: Pairing,
    /// Which normals evaluations use: the host may begin a step with those of t_n where the options say current.
    pub normals: Normals,
    /// nu at the last positions; `None`: those of t_n serve.
    pub now: Option<NormalsAt>,
    /// Room for them where there are none.
    pub room: NormalsAt,
}

impl Step {
    /// Those of t_n serve until others are found.
    pub fn forget_normals(&mut self) {
        if let Some(now) = self.now.take() {
            self.room = now;
        }
    }

    /// nu_A(t_n): of copies that touch as one that of their edge.
    pub fn committed_normal(&self, a: usize) -> Vec3 {
        self.pairing.corners.edge(a).map_or(self.history.normals[a], |edge| edge.normal)
    }
}

/// Averaged normals of the non-mortar surface at some positions.
#[derive(Debug, Default)]
pub struct NormalsAt {
    /// The positions.
    pub x1: Vec<Vec3>,
    /// Per node the sum of the corner normals around it.
    pub sums: Vec<Vec3>,
    /// Per node nu, prescribed directions not yet taken out.
    pub nu: Vec<Vec3>,
}

/// What the interface is, and the step.
#[derive(Debug)]
pub struct Given<'a, const N: usize> {
    /// What the interface is.
    pub setup: &'a Setup<N>,
    /// The step.
    pub step: &'a Step,
}

impl<const N: usize> Clone for Given<'_, N> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<const N: usize> Copy for Given<'_, N> {}

impl<'a, const N: usize> Given<'a, N> {
    /// t_n.
    pub fn history(self) -> &'a History {
        &self.step.history
    }

    /// The positions that frozen weights are of.
    pub fn weighted_at(self) -> (&'a [Vec3], &'a [Vec3]) {
        self.history().weighted_at(self.setup.options.effective_weights(), self.setup.surfaces())
    }

    /// Non-mortar nodes.
    pub fn nodes(self) -> usize {
        self.setup.nonmortar.len()
    }

    /// Whether a node acts without friction in this step, since a copy of it may be in contact, too.
    pub fn has_copy_in_contact(self, a: usize) -> bool {
        self.step.pairing.corners.frictionless.get(a).is_some_and(|f| *f)
    }

    /// nu_A: that of now where it follows the motion, else the host's or the committed one; normalised within the free
    /// directions.
    pub fn normal(self, a: usize) -> Result<Vec3> {
        self.step.now.as_ref().map_or_else(|| self.normal_of_step(a), |now| self.free_normal(a, now.nu[a]))
    }

    /// nu_A at t_n: the host's or the committed one, normalised within the free directions.
    pub fn normal_of_step(self, a: usize) -> Result<Vec3> {
        let host = self.setup.nodes.normals.as_ref();
        self.free_normal(a, host.map_or_else(|| self.step.committed_normal(a), |n| n[a]))
    }

    /// A node's normal, normalised within its free directions.
    pub fn free_normal(self, a: usize, normal: Vec3) -> Result<Vec3> {
        let nodes = &self.setup.nodes;
        if nodes.free[a] == Mat3::identity() {
            return Ok(normal);
        }
        let free = nodes.free[a] * normal;
        let norm = free.norm();
        if norm <= SMALLEST_SUM {
            let text =
                text!("the normal of non-mortar node {a} lies in its prescribed directions; it must keep a free part");
            return Err(Error::new(Kind::UndefinedNormal, text));
        }
        Ok(free / norm)
    }

    /// nu of every node.
    pub fn normals(self) -> Result<Vec<Vec3>> {
        (0..self.nodes()).map(|a| self.normal(a)).stored_if_ok()
    }

    /// The same, in place of what was there.
    pub fn normals_into(self, normals: &mut Vec<Vec3>) -> Result<()> {
        normals.clear();
        (0..self.nodes()).try_for_each(|a| normals.store(self.normal(a)?))
    }

    /// r_A [F/L^5]: the host's, or rhat_A / M_A.
    pub fn augmentation(self, a: usize) -> f64 {
        let area = self.history().areas[a];
        let given = self.setup.nodes.augmentations.as_ref();
        given.map_or_else(|| self.setup.options.augmentation(self.size(a)) / area, |r| r[a])
    }

    /// rhat_A = r_A M_A [F/L^3].
    pub fn rhat(self, a: usize) -> f64 {
        self.augmentation(a) * self.history().areas[a]
    }

    /// h_A: the root of M_A, or how long the lines of a plane model are around the node `[L]`; where points decide, that of the
    /// facets around it, of which a node on an edge has fewer.
    pub fn size(self, a: usize) -> f64 {
        // Facets know no size of a node at which they have no multiplier.
        if self.setup.decides_at_points() && self.setup.nonmortar.has_row(a) {
            return self.facet_size(a);
        }
        let history = self.history();
        self.setup.nonmortar.size(history.areas[a], history.x1[a])
    }

    /// The same of the facets around the node, however many they are, where points decide or weights are frozen.
    pub fn facet_size(self, a: usize) -> f64 {
        let size = self.setup.nonmortar.size(self.history().areas[a], self.weighted_at().0[a]);
        self.setup.size_factors[a] * size
    }

    /// Factor of node A's multiplier rows.
    pub fn row_scale(self, a: usize) -> f64 {
        match self.setup.options.row_scale {
            RowScale::Force => self.augmentation(a) * self.history().areas[a],
            RowScale::None => 1.0,
        }
    }

    /// The covered area at and below which a node counts as uncovered [L^2].
    /// Of one that stays open in this step no area is enough.
    pub fn least_coverage(self, a: usize) -> f64 {
        if self.step.pairing.corners.is_open(a) {
            return f64::INFINITY;
        }
        self.setup.options.coverage_min * self.history().areas[a]
    }

    /// The nodes that carry node A; none where it has a multiplier of its own.
    pub fn carriers_of(self, a: usize) -> &'a [Carrier] {
        self.step.pairing.carriers.get(a).map_or(&[], |c| c)
    }

    /// Slip of node A since the first configuration `[L]`, this step's included.
    /// g_T is weighted with n(t_n), so it is a length times `coverage_previous`, the covered area of t_n.
    /// An open node moves without slipping.
    pub fn slip_after(self, a: usize, response: &NodeResponse<N>, coverage_previous: f64) -> Vec3 {
        let closed = response.state != State::Gap;
        let step = if closed && coverage_previous > 0.0 { response.slip / coverage_previous } else { Vec3::zeros() };
        self.history().slip.get(a).map_or(step, |slip| slip + step)
    }

    /// Refuses positions that no evaluation could use.
    pub fn check_positions(self, x1: &[Vec3], x2: &[Vec3]) -> Result<()> {
        let (one, two) = self.setup.surfaces();
        check_length("x1", x1.len(), one.len())?;
        check_length("x2", x2.len(), two.len())?;
        check_finite("x1", x1)?;
        check_finite("x2", x2)?;
        one.check_lines(x1)?;
        two.check_lines(x2)?;
        two.check_rigid(x2)
    }
}

/// Refuses NaN and infinity, naming argument and node.
pub fn check_finite<const N: usize>(name: &str, values: &[SVector<f64, N>]) -> Result<()> {
    match values.iter().position(|v| !v.iter().all(|c| c.is_finite())) {
        None => Ok(()),
        Some(k) => Err(Error::new(Kind::NotFinite, text!("{name} of node {k} is not finite"))),
    }
}
