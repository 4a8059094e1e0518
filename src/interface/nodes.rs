//! Stage 2 over a whole interface: gaps and coverage of every node, assembled over the pairs, and the
//! law's response.

use super::effects;
use super::history::PairRecord;
use super::{Contact, Extent, NewContact, NodeCounts, Options, RowScale, Surface};
use crate::error::{Error, Kind, Result};
use crate::geometry::{Mat3, Vec3};
use crate::law::{Node, NodeResponse};
use crate::memory::{self, Store, Stored};
use crate::mortar::gap;
use nalgebra::SVector;
use std::borrow::Cow;

/// What a node assembles over its pairs. A parallel host adds these over its ranks.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NodeSums {
    /// Covered area now [L^2].
    pub coverage: f64,
    /// g[n_{n+1}, x_{n+1}] [L^3].
    pub gap_now: Vec3,
    /// Covered area at t_n.
    pub coverage_previous: f64,
    /// g[n_n, x_{n+1}].
    pub gap_previous: Vec3,
    /// g[n_n, x_n]; tied: g[n_0, x_0], turned with its facets.
    pub gap_committed: Vec3,
}

/// Coverage and gap of every non-mortar node from a list of pairs.
pub(super) fn assemble(
    (nonmortar, mortar): (&Surface, &Surface),
    pairs: &[PairRecord],
    x1: &[Vec3],
    x2: &[Vec3],
) -> Result<Vec<(f64, Vec3)>> {
    let mut sums = memory::filled((0.0, Vec3::zeros()), nonmortar.len())?;
    for pair in pairs {
        let (one, two) = (nonmortar.facet(pair.one, x1), mortar.facet(pair.two, x2));
        let gaps = gap(&pair.weights, &one, &two);
        for k in 0..one.len() {
            let (coverage, g) = &mut sums[nonmortar.facets[pair.one].nodes[k]];
            *coverage += pair.weights.coverage(k);
            *g += gaps[k];
        }
    }
    Ok(sums)
}

impl<const N: usize> Contact<N> {
    /// Stage 1, assembled: every node's gaps and coverage.
    pub fn sums(&mut self, x1: &[Vec3], x2: &[Vec3]) -> Result<Vec<NodeSums>> {
        self.sums_of(x1, x2, Extent::Whole)
    }

    /// This handle's share of them, of several handles whose shares a host adds up.
    pub fn share_of_sums(&mut self, x1: &[Vec3], x2: &[Vec3]) -> Result<Vec<NodeSums>> {
        self.sums_of(x1, x2, Extent::Part)
    }

    fn sums_of(&mut self, x1: &[Vec3], x2: &[Vec3], extent: Extent) -> Result<Vec<NodeSums>> {
        self.check_positions(x1, x2)?;
        self.ensure_integration(x1, x2, extent)?;
        if self.is_apart() {
            return memory::filled(NodeSums::default(), self.nonmortar.len());
        }
        let slips = self.kernels.slips || extent == Extent::Part;
        self.counters.nodes_slipping += if slips { self.nonmortar.len() as i64 } else { 0 };
        if let Some((of, sums)) = self.integration.as_ref().and_then(|k| k.sums.as_ref())
            && *of == extent
        {
            return memory::copied(sums);
        }
        let (surfaces, h) = ((&self.nonmortar, &self.mortar), &self.history);
        let now = assemble(surfaces, self.current_pairs(), x1, x2)?;
        let committed = h.facet_gaps.turned(&self.nonmortar, x1, &h.gap)?;
        let mut sums: Vec<_> = (0..self.nonmortar.len())
            .map(|a| NodeSums {
                coverage: now[a].0,
                gap_now: now[a].1,
                coverage_previous: h.coverage[a],
                gap_committed: committed.get(a).copied().unwrap_or_default(),
                gap_previous: Vec3::zeros(),
            })
            .stored()?;
        for (sum, away) in sums.iter_mut().zip(self.looking_away()?) {
            if away {
                (sum.coverage, sum.gap_now) = (0.0, Vec3::zeros());
            }
        }
        // The nodes that this handle shares may slip by what another one knows of their friction.
        if slips {
            let previous = self.integration.as_ref().map(|_| assemble(surfaces, &h.pairs, x1, x2)).transpose()?;
            let previous = previous.as_ref().unwrap_or(&now);
            for (sum, (_, gap)) in sums.iter_mut().zip(previous) {
                sum.gap_previous = *gap;
            }
        }
        if let Some(k) = &mut self.integration {
            k.sums = Some((extent, memory::copied(&sums)?));
        }
        Ok(sums)
    }

    /// Stage 2: the law at every node. `sums` overrides this handle's own, for parallel hosts.
    pub fn responses(
        &mut self,
        x1: &[Vec3],
        x2: &[Vec3],
        lambda: &[SVector<f64, N>],
        sums: Option<&[NodeSums]>,
    ) -> Result<Vec<NodeResponse<N>>> {
        self.evaluate(x1, x2, lambda, sums).map(|(_, responses)| responses)
    }

    /// Stages 1 and 2: the sums, `sums` or this handle's own, and the law's answers to them.
    pub fn evaluate<'a>(
        &mut self,
        x1: &[Vec3],
        x2: &[Vec3],
        lambda: &[SVector<f64, N>],
        sums: Option<&'a [NodeSums]>,
    ) -> Result<(Cow<'a, [NodeSums]>, Vec<NodeResponse<N>>)> {
        self.check_length("lambda", lambda.len(), self.nonmortar.len())?;
        check_finite("lambda", lambda)?;
        let extent = Extent::of(sums);
        let sums = match sums {
            Some(sums) => {
                self.check_positions(x1, x2)?;
                self.check_length("sums", sums.len(), self.nonmortar.len())?;
                self.refuse_carrying_over_handles()?;
                self.ensure_integration(x1, x2, extent)?;
                Cow::Borrowed(sums)
            }
            None => Cow::Owned(self.sums(x1, x2)?),
        };
        let carried = self.carried(&sums)?;
        let mut counts = NodeCounts::default();
        let mut responses = memory::with_room(lambda.len())?;
        for a in 0..lambda.len() {
            responses.store(if self.is_left_out(a, extent) {
                counts.left_out += 1;
                NodeResponse::uncovered(&lambda[a], self.augmentation(a))
            } else {
                let node = self.node(a, lambda[a], &sums[a])?;
                let is_carried = carried.get(a).is_some_and(|c| *c);
                *(if is_carried { &mut counts.carried } else { self.count_of(a, &node, &mut counts) }) += 1;
                (self.kernels.respond)(&node)
            })?;
        }
        if carried.contains(&true) {
            self.carry(lambda, &sums, &carried, &mut responses)?;
        }
        for (a, response) in responses.iter().enumerate() {
            if !response.row.iter().chain(response.traction.iter()).all(|v| v.is_finite()) {
                let text =
                    text!("the response of non-mortar node {a} overflows; positions or multiplier are out of range");
                return Err(Error::new(Kind::NotFinite, text));
            }
        }
        self.counters.nodes_evaluated += counts.total() - counts.left_out;
        self.counters.nodes = counts;
        Ok((sums, responses))
    }

    pub(super) fn node(&self, a: usize, lambda: SVector<f64, N>, sums: &NodeSums) -> Result<Node<N>> {
        let threshold = self.options.coverage_min * self.history.areas[a];
        let covered_before = sums.coverage_previous > threshold;
        let frictionless = !covered_before && self.options.new_contact == NewContact::Frictionless;
        Ok(Node {
            lambda,
            normal: self.normal(a)?,
            augmentation: self.augmentation(a),
            mu: if frictionless { 0.0 } else { self.mu[a] },
            gap_now: sums.gap_now,
            gap_previous: sums.gap_previous,
            gap_committed: sums.gap_committed,
            covered: sums.coverage > threshold,
            covered_before,
            slip: self.options.effective_slip(),
            free: self.free[a],
        })
    }

    /// nu_A: the host's or the committed one, normalised within the free directions.
    pub fn normal(&self, a: usize) -> Result<Vec3> {
        let normal = self.normals.as_ref().map_or(self.history.normals[a], |n| n[a]);
        if self.free[a] == Mat3::identity() {
            return Ok(normal);
        }
        let free = self.free[a] * normal;
        let norm = free.norm();
        if norm <= crate::normal::SMALLEST_SUM {
            let text =
                text!("the normal of non-mortar node {a} lies in its prescribed directions; it must keep a free part");
            return Err(Error::new(Kind::UndefinedNormal, text));
        }
        Ok(free / norm)
    }

    /// r_A [F/L^5]: the host's, or rhat_A / M_A.
    pub fn augmentation(&self, a: usize) -> f64 {
        let area = self.history.areas[a];
        self.augmentations.as_ref().map_or_else(|| self.options.augmentation(area) / area, |r| r[a])
    }

    /// Factor of node A's multiplier rows.
    pub fn row_scale(&self, a: usize) -> f64 {
        match self.options.row_scale {
            RowScale::Force => self.augmentation(a) * self.history.areas[a],
            RowScale::None => 1.0,
        }
    }

    pub(super) fn check_positions(&self, x1: &[Vec3], x2: &[Vec3]) -> Result<()> {
        self.check_length("x1", x1.len(), self.nonmortar.len())?;
        self.check_length("x2", x2.len(), self.mortar.len())?;
        check_finite("x1", x1)?;
        check_finite("x2", x2)?;
        self.mortar.check_rigid(x2)
    }

    pub(super) fn check_length(&self, name: &str, found: usize, needed: usize) -> Result<()> {
        if found == needed {
            return Ok(());
        }
        Err(Error::new(Kind::InvalidSize, text!("{name} has {found} nodes; the surface has {needed}")))
    }
}

/// Refuses NaN and infinity, naming argument and node.
pub(super) fn check_finite<const N: usize>(name: &str, values: &[SVector<f64, N>]) -> Result<()> {
    match values.iter().position(|v| !v.iter().all(|c| c.is_finite())) {
        None => Ok(()),
        Some(k) => Err(Error::new(Kind::NotFinite, text!("{name} of node {k} is not finite"))),
    }
}

/// lambda = -tau rhat_A sqrt(M_A) nu_A on covered, closed nodes: see [`Interface::initial_multipliers`].
pub(super) const INITIAL_TRACTION: f64 = 1e-6;
/// A gap (over the square root of the nodal area) below this is closed at the start: rounding of a
/// rotated mesh is 1e-16 of its extent.
pub(super) const CLOSED: f64 = 1e-8;

impl<const N: usize> Contact<N> {
    /// Multipliers for the first step: lambda = 0 at g = 0 is a body without support, so covered nodes
    /// that are closed start with a compression of 1e-6 rhat_A sqrt(M_A).
    ///
    /// # Errors
    /// [`Kind::InvalidValue`] once a step is committed.
    pub fn initial_multipliers(&mut self) -> Result<Vec<SVector<f64, N>>> {
        if self.history.commits > 0 {
            let text =
                text!("initial multipliers belong before the first step; {} are committed", self.history.commits);
            return Err(Error::new(Kind::InvalidValue, text));
        }
        let Options { coverage_min, .. } = self.options;
        // Those of now: the history may keep none, or those of t_n may be left out so far.
        let (x1, x2) = (memory::copied(&self.history.x1)?, memory::copied(&self.history.x2)?);
        let sums = self.sums(&x1, &x2)?;
        let areas = &self.history.areas;
        (0..self.nonmortar.len())
            .map(|a| {
                let nu = self.normal(a)?;
                let NodeSums { coverage, gap_now: gap, .. } = sums[a];
                let size = areas[a].sqrt();
                let covered = coverage > coverage_min * areas[a];
                let closed = nu.dot(&gap) <= CLOSED * size * coverage;
                let rhat = self.augmentation(a) * areas[a];
                let size = if covered && closed { -INITIAL_TRACTION * rhat * size } else { 0.0 };
                Ok(effects::along_normal(nu) * size)
            })
            .stored_if_ok()
    }
}
