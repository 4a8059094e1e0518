//! Rows and columns of the points of an analytic surface's frame, where these have equations: those of a rigid body that is put
//! together by `rigid` (docs/formulation 14.5). With t_A the traction of node A's forces, f_C = - sum_A n_AC t_A:
//!
//! - rows of P_C: - n_AC Dt_A, - Dn_AC t_A by the facet's nodes and by the frame; where t_A turns with a normal of now, or is projected,
//!   that part of Dt_A comes with what couples all pairs of a node (`augmented.rs`);
//! - rows of A, columns of P_D: (dc/dg_now) Dg_A / DP_D - (dc/dg_previous) n_AD(t_n).
//!
//! Dual multipliers (10.4) have f_C = - sum_B n_BC q_B with the integrated weights and q = m^-1 (m_A t_A), Dq = m^-1 (t_A Dm_A - (Dm) q),
//! and gaps m_A (m^-1 Dg)_A: an analytic surface covers facets wholly, so that phi does not change.
//!
//! They belong to no facet alone: a frame has rows in common with all of them.

use super::augmented::is_coupled;
use super::emission::{Directions, Emitter, NodeBlock, Place, Weights};
use super::read::square;
use super::task::Numbers;
use super::union::{Pairs, UnionPair, Walk};
use crate::dual::{DualBasis, corner_shares};
use crate::element::NodeTangent;
use crate::error::Result;
use crate::geometry::{AnalyticSurface, FRAME, Mat3, Vec3};
use crate::interface::data::active::Active;
use crate::interface::data::options::{Form, MultiplierBasis};
use crate::interface::data::surface::Surface;
use crate::interface::pairing::given::Given;
use crate::interface::stages::facet::dual_basis;
use crate::mortar::{FrameGaps, FrameMotion, MultiplierSpace, SurfacePair, area_element};
use crate::quadrature::Rule;
use crate::shape::{MAX_PARENT_NODES, Parent};

/// What its numbers are made of.
#[derive(Clone, Copy)]
pub struct FrameNumbers<'a, const N: usize> {
    /// What forces and rows must know of each node.
    pub nodes: &'a [NodeTangent<N>],
    /// The pairs whose weights are differentiated; `None`: no weights are.
    pub active: Option<&'a Active>,
    /// The surface as it is now.
    pub surface: Option<&'a AnalyticSurface>,
    /// The rule of the weights.
    pub rule: &'static Rule,
}

impl<'a, const N: usize> From<&'a Numbers<'a, N>> for FrameNumbers<'a, N> {
    fn from(n: &'a Numbers<'a, N>) -> Self {
        FrameNumbers { nodes: n.nodes, active: n.active, surface: n.motion.surface, rule: n.motion.rule }
    }
}

/// Of a facet of the host; A and k are its nodes.
#[derive(Debug, Default)]
pub struct FrameBlocks {
    /// Df_C / Dx_k at fixed tractions.
    by_nodes: [[Mat3; MAX_PARENT_NODES]; FRAME],
    /// Df_C / DP_D.
    by_frame: [[Mat3; FRAME]; FRAME],
    /// Dg_A / DP_D.
    pub gap: FrameGaps,
}

/// n_AC of a facet's only pair.
fn mortar_weight(all: Pairs, pair: &UnionPair, a: usize, c: usize, is_now: bool) -> f64 {
    let linear = if is_now { all.now(pair) } else { all.previous(pair) };
    let of_parents = if is_now { all.parent_now(pair) } else { all.parent_previous(pair) };
    // Parents that have no weights then have no linear ones either, of fewer multipliers.
    let linear = linear.and_then(|n| n.ac.get(a)).map(|n| n[c]);
    of_parents.map(|n| n.ac[a][c]).or(linear).unwrap_or_default()
}

impl FrameBlocks {
    /// Of the facet with this pair.
    pub fn of<const N: usize>(
        (given, all): (Given<N>, Pairs),
        pair: &UnionPair,
        numbers: &FrameNumbers<N>,
    ) -> Result<FrameBlocks> {
        let one = &given.setup.nonmortar;
        let multipliers = one.multipliers(pair.one);
        let (Some(active), Some(surface)) = (numbers.active.filter(|_| pair.is_active), numbers.surface) else {
            let mut of = FrameBlocks::default();
            for (a, c) in (0..multipliers).flat_map(|a| (0..FRAME).map(move |c| (a, c))) {
                of.gap[a][c] = Mat3::from_diagonal_element(-mortar_weight(all, pair, a, c, true));
            }
            return Ok(of);
        };
        let mut t = [Vec3::zeros(); MAX_PARENT_NODES];
        let own = one.host_nodes(pair.one).iter().zip(&mut t).take(multipliers);
        own.for_each(|(&a, t)| *t = numbers.nodes[a].traction);
        let at = FacetPair { one, basis: given.setup.options.basis, active, pair };
        FrameBlocks::by_weights(at, (surface, numbers.rule), t)
    }

    /// Of an active pair at these tractions of its multipliers.
    fn by_weights(
        at: FacetPair,
        (surface, rule): (&AnalyticSurface, &'static Rule),
        mut t: [Vec3; MAX_PARENT_NODES],
    ) -> Result<FrameBlocks> {
        let (mut of, mut motion) = (FrameBlocks::default(), FrameMotion::default());
        let (own, multipliers) = (at.one.host_nodes(at.pair.one).len(), at.one.multipliers(at.pair.one));
        at.add_motion((surface, rule), &mut motion)?;
        if let Some(basis) = at.basis()? {
            let (coefficients, p) = (basis.coefficients(), [0, 1, 2].map(|i| [0, 1, 2, 3].map(|a| t[a][i])));
            let inverse = |a: usize, b: usize| coefficients[a][b] / basis.areas[a];
            let q = basis.tractions(&p);
            let q = |a: usize| Vec3::new(q[0][a], q[1][a], q[2][a]);
            let shares = corner_shares(at.parent());
            for k in 0..own {
                let of_row = |a: usize| -> Mat3 {
                    (0..multipliers).map(|b| (t[a] - q(b)) * motion.mass((a, b, k), &shares).transpose()).sum()
                };
                for b in 0..multipliers {
                    let change: Mat3 = (0..multipliers).map(|a| of_row(a) * inverse(b, a)).sum();
                    for c in 0..FRAME {
                        of.by_nodes[c][k] += change * at.integrated(b, own + c);
                    }
                }
            }
            let gap = motion.gap;
            for (a, d) in (0..multipliers).flat_map(|a| (0..FRAME).map(move |d| (a, d))) {
                motion.gap[a][d] = (0..multipliers).map(|b| gap[b][d] * coefficients[a][b]).sum();
            }
            (0..multipliers).for_each(|a| t[a] = q(a));
        }
        for (a, c) in (0..multipliers).flat_map(|a| (0..FRAME).map(move |c| (a, c))) {
            (0..own).for_each(|k| of.by_nodes[c][k] -= t[a] * motion.by_nodes[a][c][k].transpose());
            (0..FRAME).for_each(|d| of.by_frame[c][d] -= t[a] * motion.by_frame[a][c][d].transpose());
        }
        of.gap = motion.gap;
        Ok(of)
    }
}

/// A facet of the host with its pair, an analytic surface.
#[derive(Clone, Copy)]
pub struct FacetPair<'a> {
    /// The non-mortar side.
    pub one: &'a Surface,
    /// Of the multipliers.
    pub basis: MultiplierBasis,
    /// The pairs that are active now.
    pub active: &'a Active,
    /// The pair.
    pub pair: &'a UnionPair,
}

impl FacetPair<'_> {
    /// The kind of the facet.
    pub fn parent(&self) -> &'static Parent {
        let (one, f) = (self.one, self.pair.one);
        let linear = || Parent::of(one.facets[f].len).expect("a checked facet has 3 or 4 nodes");
        one.parents.as_ref().map_or_else(linear, |parents| parents.facets[f].parent)
    }

    /// Adds the derivatives of all of its parts.
    pub fn add_motion(&self, (surface, rule): (&AnalyticSurface, &'static Rule), to: &mut FrameMotion) -> Result<()> {
        let FacetPair { one, active, pair, .. } = *self;
        let Some(parents) = &one.parents else {
            let (frame, parent) = (one.frame(pair.one, &active.x1, &active.normals)?, self.parent());
            let (mut x, facet) = ([Vec3::zeros(); MAX_PARENT_NODES], one.facet(pair.one, &active.x1));
            x.iter_mut().zip(&facet.nodes).for_each(|(x, of)| *x = of - surface.origin);
            let (side, space) = ((parent, &parent.subs[0]), MultiplierSpace::Corner);
            return SurfacePair { side, space, area: &area_element(&frame), surface, rule }.frame_motion(&x, to);
        };
        for part in parents.parts(pair.one) {
            let frame = one.frame(part, &active.x1, &active.normals)?;
            parents.over_surface(part, (&frame, &active.x1), (surface, rule), |part, x| part.frame_motion(x, to))?;
        }
        Ok(())
    }

    /// Its dual basis; `None` with standard multipliers.
    pub fn basis(&self) -> Result<Option<DualBasis>> {
        let FacetPair { one, active, pair, .. } = *self;
        if self.basis == MultiplierBasis::Standard {
            return Ok(None);
        }
        if one.parents.is_some() {
            return one.parent_basis(pair.one, &active.x1, &mut std::iter::once(active.integrated_parent(pair.place)));
        }
        let frame = one.frame(pair.one, &active.x1, &active.normals)?;
        Ok(dual_basis(one, pair.one, (&frame, &[]), &active.integrated[pair.place..pair.place + 1])?.1)
    }

    /// n_AB, or - n_AC, of a multiplier and the k-th of the facet's own nodes and then of the frame's points, as it was integrated.
    pub fn integrated(&self, a: usize, k: usize) -> f64 {
        let own = self.one.host_nodes(self.pair.one).len();
        let of = |ab: &[f64], ac: &[f64]| if k < own { ab[k] } else { -ac[k - own] };
        if self.one.parents.is_some() {
            let n = self.active.integrated_parent(self.pair.place);
            return of(&n.ab[a], &n.ac[a]);
        }
        let n = self.active.integrated(self.pair.place);
        of(&n.ab[a], &n.ac[a])
    }
}

/// Whether anything but the frame's own rows and columns reads how gaps depend on the frame: products with projected tractions, rows of
/// those who carry nodes.
pub fn is_read<const N: usize>(given: Given<N>) -> bool {
    given.setup.frame_moves() && (is_coupled(given) || !given.step.pairing.carriers.is_empty())
}

/// All of them, without numbers for the pattern alone; nothing where the frame has no equations.
pub fn blocks<const N: usize>(
    (given, normals, all): (Given<N>, &[Vec3], Pairs),
    numbers: Option<FrameNumbers<N>>,
    pairs: &mut Vec<UnionPair>,
    emitter: &mut Emitter<N>,
) -> Result<()> {
    if !given.setup.frame_moves() {
        return Ok(());
    }
    let (one, two) = given.setup.surfaces();
    let (first, points) = (one.len(), two.len());
    let has_multipliers = emitter.constraints.is_none() && given.setup.options.form == Form::Multiplier;
    let point = |c: usize| Place::Displacement(first + two.facets[0].nodes[c]);
    let mut walk = Walk::through(all, 0..usize::MAX);
    while let Some(f) = walk.next(pairs)? {
        let (nodes, multipliers, pair) = (one.host_nodes(f), one.multipliers(f), &pairs[0]);
        let of = numbers.as_ref().map(|numbers| FrameBlocks::of((given, all), pair, numbers)).transpose()?;
        let acting = || nodes.iter().enumerate().take(multipliers).filter(|(_, a)| given.setup.nodes.acts(**a));
        let mut nu: Directions = Default::default();
        nodes.iter().enumerate().for_each(|(k, &a)| nu[k] = normals[a]);
        for c in 0..points {
            let mut n: Weights = Default::default();
            (0..multipliers).for_each(|k| n[k] = -mortar_weight(all, pair, k, c, true));
            for (k, &a) in acting().filter(|_| has_multipliers) {
                emitter.taker.multiplier_row(point(c), &[(k, Place::Multiplier(a))], &n, &nu);
            }
            let mut force = |column: Place, block: Option<&Mat3>| {
                emitter.taker.node(point(c), column, block.unwrap_or(&Mat3::zeros()).as_slice());
            };
            for (k, &b) in nodes.iter().enumerate() {
                force(Place::Displacement(b), of.as_ref().map(|of| &of.by_nodes[c][k]));
            }
            (0..points).for_each(|d| force(point(d), of.as_ref().map(|of| &of.by_frame[c][d])));
        }
        for ((k, &a), d) in acting().flat_map(|of_node| (0..points).map(move |d| (of_node, d))) {
            let mut block = NodeBlock::default();
            if let (Some(of), Some(numbers)) = (&of, &numbers) {
                let (node, before) = (&numbers.nodes[a], mortar_weight(all, pair, k, d, false));
                let row = square(&(node.drow_dnow * of.gap[k][d] - node.drow_dprevious * before));
                block.iter_mut().enumerate().for_each(|(j, to)| (0..3).for_each(|i| to[i] = row[(i, j)]));
            }
            emitter.node_rows(a, &[(0, point(d))], &mut [block]);
        }
    }
    Ok(())
}
