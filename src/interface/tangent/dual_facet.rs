//! Facets of dual multipliers in the tangent (docs/formulation.md 10.4): derivatives of a pair become the pair's share of
//! its facet's, and the rows of the mortar nodes of all pairs of a facet, which it couples, are emitted once a facet.

use super::derivatives::PairDerivatives;
use super::emission::{Blocks, MortarBlock};
use super::union::UnionPair;
use crate::dual::{
    Columns, DualBasis, FacetColumns, FacetMotion, FacetSums, GROUP, PairShare, TractionDerivatives, WholeFacet,
};
use crate::error::Result;
use crate::geometry::{AnalyticSurface, Vec3};
use crate::interface::data::active::Active;
use crate::interface::data::effects::Opposite;
use crate::interface::data::facet_nodes::FacetNodes;
use crate::interface::data::offsets;
use crate::interface::data::options::{MultiplierBasis, Tangent};
use crate::interface::data::surface::Surface;
use crate::interface::pairing::given::Given;
use crate::interface::pairing::overlaps::FacetOverlaps;
use crate::interface::stages::facet::dual_basis;
use crate::memory::{self, Store};
use crate::mortar::{
    AreaDerivatives, ForceDerivatives, GapDerivative, NonmortarFrame, PairWeights, Segment, analytic_motion_raised,
    facet_motion_raised, pair_motion_raised,
};
use crate::shape::{MAX_CORNERS, MAX_NODES};
use std::borrow::Cow;

/// What a facet's pairs have in common where multipliers are dual.
pub struct DualFacet {
    sums: FacetSums,
    basis: Option<DualBasis>,
    /// eta = m^-1 o of the nodes' offsets `[L]`.
    eta: [f64; MAX_CORNERS],
}

impl DualFacet {
    /// Of the pairs of a facet that are active; `None` with the standard basis, or without active pairs.
    pub fn of<const N: usize>(
        given: Given<N>,
        (active, overlaps): (&Active, &FacetOverlaps),
        pairs: &[UnionPair],
    ) -> Result<Option<DualFacet>> {
        let places = UnionPair::places(pairs);
        if given.setup.options.basis == MultiplierBasis::Standard || places.is_empty() {
            return Ok(None);
        }
        let overlaps = (overlaps.frame(), &overlaps.segments[..]);
        let (sums, basis) =
            dual_basis(&given.setup.nonmortar, pairs[0].one, overlaps, &active.integrated[places.start..places.end])?;
        let surfaces = given.setup.surfaces();
        let mut eta = [0.0; MAX_CORNERS];
        if let Some(basis) = basis.as_ref().filter(|_| offsets::are_there(surfaces)) {
            eta = basis.heights(&offset_sums(surfaces, pairs, &active.integrated[places.start..places.end]));
        }
        Ok(Some(DualFacet { sums, basis, eta }))
    }

    /// eta; `None` where the facet has faded out.
    pub fn offsets(&self) -> Option<&[f64; MAX_CORNERS]> {
        self.basis.as_ref().map(|_| &self.eta)
    }

    /// Makes of [Do - Dm eta] of a pair its share of the derivative of phi m_A eta_A.
    pub fn share_offsets(&self, share: &ShareRoom, slopes: &mut AreaDerivatives) {
        let Some(basis) = &self.basis else { return };
        for (slope, area) in slopes.as_flattened_mut().iter_mut().zip(share.areas.as_flattened()) {
            let own = basis.dual(slope);
            *slope = std::array::from_fn(|a| if a < basis.nodes { own[a] + area[a] * self.eta[a] } else { 0.0 });
        }
    }

    /// The facet at these tractions `[i][A]`; `None` where it has faded out: it has no forces and no gap.
    pub fn motion(&self, frame: &NonmortarFrame, tractions: &[[f64; MAX_CORNERS]; 3]) -> Option<FacetMotion<'_>> {
        self.basis.as_ref().map(|basis| FacetMotion::new(frame, basis, &self.sums.gamma, tractions))
    }
}

/// o_A of a facet's nodes with the weights of its active pairs as they were integrated [L^3].
fn offset_sums(
    (one, two): (&Surface, &Surface),
    pairs: &[UnionPair],
    integrated: &[PairWeights],
) -> [f64; MAX_CORNERS] {
    let mut sums = [0.0; MAX_CORNERS];
    for (pair, n) in pairs.iter().filter(|pair| pair.is_active).zip(integrated) {
        let (own, other) = (one.facets[pair.one].as_slice(), two.facets[pair.two].as_slice());
        for (a, sum) in sums.iter_mut().enumerate() {
            *sum += own.iter().zip(&n.ab[a]).map(|(&b, n)| n * one.offset(b)).sum::<f64>();
            *sum += other.iter().zip(&n.ac[a]).map(|(&c, n)| n * two.offset(c)).sum::<f64>();
        }
    }
    sums
}

/// What a pair's share takes place for. Large, so that one serves all pairs.
#[derive(Debug, Default)]
pub struct ShareRoom {
    areas: AreaDerivatives,
    /// D(phi q).
    pub tractions: TractionDerivatives,
}

impl PairDerivatives<'_> {
    /// As [`PairDerivatives::of`], of one pair with its weights as they were integrated and so many mortar nodes:
    /// its share of the facet's derivatives, and D(phi q) into `room`.
    pub fn of_share(
        &self,
        frame: &NonmortarFrame,
        facet: &FacetMotion,
        (weights, segment, mortar): (&PairWeights, &Segment, usize),
        forces: &mut ForceDerivatives,
        ShareRoom { areas, tractions }: &mut ShareRoom,
    ) -> GapDerivative {
        let mut frame = Cow::Borrowed(frame);
        if self.tangent == Tangent::FrozenNormals {
            frame.to_mut().plane.tilt = Default::default();
        }
        let moves = self.opposite == Opposite::Moves;
        let raised = facet.raised(areas);
        let mut gap = if moves || segment.points.is_some() {
            pair_motion_raised((&frame, segment, self.rule), weights, &facet.field, forces, raised)
        } else {
            let pairs = std::iter::once((segment, weights));
            facet_motion_raised(&frame, pairs, self.rule, &facet.field, forces, raised)
        };
        let share = PairShare { forces, gap: &mut gap, areas, tractions };
        facet.share(if moves { mortar } else { 0 }, weights, share);
        GapDerivative::Facets(gap)
    }
}

impl DualFacet {
    /// As [`PairDerivatives::of`], of a facet with its gaps, as they were integrated, against an analytic surface.
    pub fn of_analytic(
        &self,
        (motion, surface): (&PairDerivatives, &AnalyticSurface),
        frame: &NonmortarFrame,
        (traction, gaps): (&[[f64; MAX_CORNERS]; 3], &[Vec3; MAX_CORNERS]),
        (forces, ShareRoom { areas, .. }): (&mut ForceDerivatives, &mut ShareRoom),
    ) -> Result<Option<GapDerivative>> {
        let Some(basis) = &self.basis else { return Ok(None) };
        let facet = WholeFacet::new(basis, gaps);
        let mut blocks = analytic_motion_raised(frame, surface, motion.rule, &facet.heights, forces)?;
        for (to, of) in areas.iter_mut().zip(&forces.one) {
            *to = of.map(|of| of[0]); // Dm_A
        }
        facet.share(traction, forces, &mut blocks);
        Ok(Some(GapDerivative::Blocks(blocks)))
    }
}

/// The rows of the mortar nodes of a facet's active pairs, which are emitted once a facet: what couples its pairs has all
/// of these entries, so no pair has any of its own.
#[derive(Debug, Default)]
pub struct MortarRows {
    /// Nodes of the facet.
    own: usize,
    /// Its mortar nodes, each once, in the order in which they are met.
    nodes: Vec<usize>,
    weights: Vec<[[f64; GROUP]; MAX_CORNERS]>,
    /// D(phi q_B) of each column, then the rows of each group.
    columns: Vec<Columns>,
}

impl MortarRows {
    /// Begins with a facet of these nodes and pairs, in the memory of the one before.
    #[inline(never)]
    pub fn begin(&mut self, one: &FacetNodes, two: &Surface, pairs: &[UnionPair]) -> Result<()> {
        self.own = one.len;
        self.nodes.clear();
        for pair in pairs.iter().filter(|pair| pair.is_active) {
            for &node in two.facets[pair.two].as_slice() {
                if !self.nodes.contains(&node) {
                    self.nodes.store(node)?;
                }
            }
        }
        let (groups, columns) = (self.nodes.len().div_ceil(GROUP), MAX_NODES + self.nodes.len());
        memory::refill(&mut self.weights, Default::default(), groups)?;
        memory::refill(&mut self.columns, Default::default(), columns + groups * columns)
    }

    fn sums(&mut self) -> FacetColumns<'_> {
        let (tractions, rows) = self.columns.split_at_mut(MAX_NODES + self.nodes.len());
        FacetColumns { nodes: self.own, weights: &mut self.weights, tractions, rows }
    }

    /// Adds a pair with its integrated weights and its share of the derivatives.
    #[inline(never)]
    pub fn add(
        &mut self,
        two: &FacetNodes,
        weights: &PairWeights,
        tractions: &TractionDerivatives,
        forces: &ForceDerivatives,
    ) {
        let places = two.nodes.map(|node| self.nodes.iter().position(|n| *n == node).unwrap_or(0));
        let mut sums = self.sums();
        sums.add_weights(weights, &places[..two.len]);
        sums.add_derivatives(tractions, forces, &places[..two.len]);
    }

    /// Adds what couples the pairs, once all have been added.
    #[inline(never)]
    pub fn couple(&mut self) {
        self.sums().couple();
    }

    /// Gives the blocks of these rows, four nodes at a time: columns of the facet's nodes and of these. What was added is used
    /// up.
    #[inline(never)]
    pub fn emit<const N: usize>(&mut self, taker: &mut dyn Blocks<N>) {
        let columns = MAX_NODES + self.nodes.len();
        for (rows, values) in self.nodes.chunks(GROUP).zip(self.columns[columns..].chunks_exact(columns)) {
            taker.mortar(&MortarBlock { rows, own: self.own, columns: &self.nodes, values });
        }
    }
}
