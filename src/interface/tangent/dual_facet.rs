//! Facets of dual multipliers in the tangent (docs/formulation.md 10.4): derivatives of a pair become the pair's share of
//! its facet's, and what couples the mortar nodes of all pairs of a facet is emitted once a facet.

use super::derivatives::PairDerivatives;
use super::emission::Emitter;
use super::union::UnionPair;
use crate::dual::{DualBasis, FacetColumns, FacetMotion, FacetSums, PairShare, TractionDerivatives, WholeFacet};
use crate::error::Result;
use crate::geometry::{AnalyticSurface, Mat3, Vec3};
use crate::interface::data::active::Active;
use crate::interface::data::effects::Opposite;
use crate::interface::data::options::{MultiplierBasis, Tangent};
use crate::interface::data::surface::FacetNodes;
use crate::interface::pairing::given::Given;
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
}

impl DualFacet {
    /// Of the pairs of a facet that are active; `None` with the standard basis, or without active pairs.
    pub fn of<const N: usize>(given: Given<N>, active: &Active, pairs: &[UnionPair]) -> Result<Option<DualFacet>> {
        let places = UnionPair::places(pairs);
        if given.setup.options.basis == MultiplierBasis::Standard || places.is_empty() {
            return Ok(None);
        }
        let (sums, basis) = dual_basis(&given.setup.nonmortar, active, places)?;
        Ok(Some(DualFacet { sums, basis }))
    }

    /// The facet at these tractions `[i][A]`; `None` where it has faded out: it has no forces and no gap.
    pub fn motion(&self, frame: &NonmortarFrame, tractions: &[[f64; MAX_CORNERS]; 3]) -> Option<FacetMotion<'_>> {
        self.basis.as_ref().map(|basis| FacetMotion::new(frame, basis, &self.sums.gamma, tractions))
    }
}

impl PairDerivatives<'_> {
    /// As [`PairDerivatives::of`], of one pair with its weights as they were integrated and so many mortar nodes:
    /// its share of the facet's derivatives, and D(phi q) into `tractions`.
    pub fn of_share(
        &self,
        frame: &NonmortarFrame,
        facet: &FacetMotion,
        (weights, segment, mortar): (&PairWeights, &Segment, usize),
        forces: &mut ForceDerivatives,
        tractions: &mut TractionDerivatives,
    ) -> GapDerivative {
        let mut frame = Cow::Borrowed(frame);
        if self.tangent == Tangent::FrozenNormals {
            frame.to_mut().plane.tilt = Default::default();
        }
        let moves = self.opposite == Opposite::Moves;
        let mut areas = AreaDerivatives::default();
        let raised = facet.raised(&mut areas);
        let mut gap = if moves || segment.points.is_some() {
            pair_motion_raised((&frame, segment, self.rule), weights, &facet.field, forces, raised)
        } else {
            let pairs = std::iter::once((segment, weights));
            facet_motion_raised(&frame, pairs, self.rule, &facet.field, forces, raised)
        };
        let share = PairShare { forces, gap: &mut gap, areas: &mut areas, tractions };
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
        forces: &mut ForceDerivatives,
    ) -> Result<Option<GapDerivative>> {
        let Some(basis) = &self.basis else { return Ok(None) };
        let facet = WholeFacet::new(basis, gaps);
        let mut blocks = analytic_motion_raised(frame, surface, motion.rule, &facet.heights, forces)?;
        facet.share(traction, forces, &mut blocks);
        Ok(Some(GapDerivative::Blocks(blocks)))
    }
}

/// The mortar nodes of a facet's active pairs, each once, in the order in which they are met.
pub fn mortar_nodes<const N: usize>(given: Given<N>, pairs: &[UnionPair]) -> Result<Vec<usize>> {
    let mut nodes = Vec::new();
    for pair in pairs.iter().filter(|pair| pair.now.is_some()) {
        for &node in given.setup.mortar.facets[pair.two].as_slice() {
            if !nodes.contains(&node) {
                nodes.store(node)?;
            }
        }
    }
    Ok(nodes)
}

/// Memory for what couples the mortar nodes of a facet's pairs; none where there are none.
pub struct Coupled {
    weights: Vec<[f64; MAX_CORNERS]>,
    tractions: Vec<[[[f64; MAX_CORNERS]; 3]; 3]>,
}

impl Coupled {
    /// For so many mortar nodes.
    pub fn new(nodes: &[usize]) -> Result<Coupled> {
        let (rows, columns) = if nodes.is_empty() { (0, 0) } else { (nodes.len(), MAX_NODES + nodes.len()) };
        Ok(Coupled {
            weights: memory::filled([0.0; MAX_CORNERS], rows)?,
            tractions: memory::filled([[[0.0; MAX_CORNERS]; 3]; 3], columns)?,
        })
    }

    /// The factors of the coupling of a facet with so many nodes, to which nothing has been added yet.
    pub fn columns(&mut self, nodes: usize) -> Option<FacetColumns<'_>> {
        (!self.weights.is_empty()).then(|| FacetColumns::new(nodes, &mut self.weights, &mut self.tractions))
    }
}

/// Adds a pair with its integrated weights and its D(phi q); `nodes` are all mortar nodes of its facet, `two` its own.
pub fn add(
    columns: &mut FacetColumns,
    (two, nodes): (&FacetNodes, &[usize]),
    weights: &PairWeights,
    tractions: &TractionDerivatives,
) {
    let places = two.nodes.map(|node| nodes.iter().position(|n| *n == node).unwrap_or(0));
    columns.add_weights(weights, &places[..two.len]);
    columns.add_tractions(tractions, &places[..two.len]);
}

/// The blocks of the coupling: rows of the facet's mortar nodes, columns of its own and of these.
pub fn emit<const N: usize>(f: usize, nodes: &[usize], columns: Option<&FacetColumns>, emitter: &mut Emitter<N>) {
    let (one, two) = emitter.given.setup.surfaces();
    let own = one.facets[f].as_slice().iter().enumerate().map(|(k, &a)| (k, &one.equations[a]));
    let all = own.chain(nodes.iter().enumerate().map(|(c, &node)| (MAX_NODES + c, &two.equations[node])));
    for (column, equations) in all {
        for (place, &node) in nodes.iter().enumerate() {
            let block = columns.map_or_else(Mat3::zeros, |columns| columns.coupling(place, column));
            emitter.sink.add_block(&two.equations[node], equations, block.as_slice());
        }
    }
}
