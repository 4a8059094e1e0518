//! Stage 3: the forces of both sides, and the multiplier rows.

use crate::element::{pair_force, parent_force};
use crate::error::Result;
use crate::geometry::Vec3;
use crate::interface::data::multiplier::force_traction;
use crate::interface::data::pairs::{ParentRecord, Weighted};
use crate::interface::data::setup::Setup;
use crate::interface::data::surface::Surface;
use crate::interface::pairing::given::Given;
use crate::law::NodeResponse;
use crate::memory::{self, Store};
use crate::mortar::MORTAR;
use crate::shape::MAX_PARENT_NODES;
use crate::threads::{self, Part};
use nalgebra::SVector;

/// Residual of an interface.
#[derive(Clone, Debug, PartialEq)]
pub struct Residual<const N: usize = 3> {
    /// Internal forces at the non-mortar nodes `[F]`; the force ON the body is the negative.
    pub nonmortar: Vec<Vec3>,
    /// Internal forces at the mortar nodes `[F]`.
    pub mortar: Vec<Vec3>,
    /// Multiplier rows (`[F]` or [L^3], see the row scale).
    pub rows: Vec<SVector<f64, N>>,
}

impl<const N: usize> Default for Residual<N> {
    fn default() -> Self {
        Residual { nonmortar: Vec::new(), mortar: Vec::new(), rows: Vec::new() }
    }
}

impl<const N: usize> Residual<N> {
    /// Zeros of every node, in place of what was there.
    pub fn clear(&mut self, (nonmortar, mortar): (&Surface, &Surface)) -> Result<()> {
        memory::refill(&mut self.nonmortar, Vec3::zeros(), nonmortar.len())?;
        memory::refill(&mut self.mortar, Vec3::zeros(), mortar.len())?;
        memory::refill(&mut self.rows, SVector::zeros(), nonmortar.len())
    }

    /// Takes the law's rows of the nodes whose multipliers act here.
    pub fn take_rows(&mut self, given: Given<N>, responses: &[NodeResponse<N>]) {
        let Setup { nodes, nonmortar, .. } = given.setup;
        for (a, response) in responses.iter().enumerate().filter(|(a, _)| nodes.is_own(*a) && nonmortar.has_row(*a)) {
            self.rows[a] = response.row * given.row_scale(a);
        }
    }
}

/// Of the pairs whose weights act, at the law's answers.
pub fn residual<const N: usize>(
    given: Given<N>,
    pairs: Weighted,
    lambda: &[SVector<f64, N>],
    responses: &[NodeResponse<N>],
) -> Result<Residual<N>> {
    let mut r = Residual::default();
    refresh(given, pairs, lambda, responses, &mut Vec::new(), &mut r)?;
    Ok(r)
}

/// The same in place of what was in `r`; `tractions`: room.
pub fn refresh<const N: usize>(
    given: Given<N>,
    pairs: Weighted,
    lambda: &[SVector<f64, N>],
    responses: &[NodeResponse<N>],
    tractions: &mut Vec<Vec3>,
    r: &mut Residual<N>,
) -> Result<()> {
    let ((nonmortar, mortar), nodes) = (given.setup.surfaces(), &given.setup.nodes);
    r.clear((nonmortar, mortar))?;
    tractions.clear();
    memory::grow(tractions, nonmortar.len())?;
    for (a, response) in responses.iter().enumerate() {
        let traction = force_traction(given.setup.options.form, &lambda[a], response, given.normal(a)?);
        tractions.store(if nodes.acts(a) { traction } else { Vec3::zeros() })?;
    }
    let tractions = &tractions[..];
    threads::in_parts(given.setup.options.threads, (&mut r.nonmortar, &mut r.mortar), |mut of_one, mut of_two| {
        let pairs = match pairs {
            Weighted::Facets(pairs) => pairs,
            Weighted::Parents(pairs) => {
                of_parents((nonmortar, mortar), pairs, tractions, (&mut of_one, &mut of_two));
                &[]
            }
        };
        for pair in pairs {
            let (one, two) = (&nonmortar.facets[pair.one], &mortar.facets[pair.two]);
            if !of_one.has_any(one.as_slice()) && !of_two.has_any(two.as_slice()) {
                continue;
            }
            let f = pair_force(&pair.weights, &one.nodes.map(|a| tractions[a]));
            for k in 0..one.len {
                of_one.at(one.nodes[k]).into_iter().for_each(|force| *force += f[k]);
            }
            for k in 0..two.len {
                of_two.at(two.nodes[k]).into_iter().for_each(|force| *force += f[MORTAR + k]);
            }
        }
    })?;
    r.take_rows(given, responses);
    Ok(())
}

/// Adds the forces of pairs of parents at the nodes' tractions.
#[inline(never)]
fn of_parents(
    (nonmortar, mortar): (&Surface, &Surface),
    pairs: &[ParentRecord],
    tractions: &[Vec3],
    (of_one, of_two): (&mut Part<Vec3>, &mut Part<Vec3>),
) {
    for pair in pairs {
        let (one, two) = (nonmortar.host_nodes(pair.one), mortar.host_nodes(pair.two));
        let mut t = [Vec3::zeros(); MAX_PARENT_NODES];
        one.iter().zip(&mut t).for_each(|(&a, t)| *t = tractions[a]);
        let t = &t[..nonmortar.multipliers(pair.one)];
        for (b, &node) in one.iter().enumerate() {
            of_one.at(node).into_iter().for_each(|force| *force += parent_force(&pair.weights.ab, t, b));
        }
        for (c, &node) in two.iter().enumerate() {
            of_two.at(node).into_iter().for_each(|force| *force -= parent_force(&pair.weights.ac, t, c));
        }
    }
}
