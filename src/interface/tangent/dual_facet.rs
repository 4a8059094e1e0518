//! Facets of dual multipliers in the tangent (docs/formulation 10.4): what its basis makes of the derivatives of its pairs, once they
//! are summed up (`facet_table.rs`).

use super::derivatives::PairDerivatives;
use super::union::UnionPair;
use crate::dual::{DualBasis, FacetMotion, FacetSums, WholeFacet, share_of};
use crate::element::Slopes;
use crate::error::Result;
use crate::geometry::{AnalyticSurface, Vec3};
use crate::interface::data::active::Active;
use crate::interface::data::offsets;
use crate::interface::data::options::MultiplierBasis;
use crate::interface::data::surface::Surface;
use crate::interface::pairing::given::Given;
use crate::interface::pairing::overlaps::FacetOverlaps;
use crate::interface::stages::facet::dual_basis;
use crate::mortar::{
    AreaDerivatives, ForceDerivatives, GapBlocks, NonmortarFrame, PairWeights, analytic_motion_raised,
};
use crate::shape::MAX_CORNERS;

/// What a facet's pairs have in common where multipliers are dual.
pub struct DualFacet {
    sums: FacetSums,
    basis: Option<DualBasis>,
    /// eta = m^-1 o of the nodes' offsets `[L]`.
    eta: [f64; MAX_CORNERS],
    /// What its pairs cover of it, over its area.
    kappa: f64,
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
        let integrated = &active.integrated[places.start..places.end];
        let kappa = basis.as_ref().map_or(0.0, |basis| integrated.iter().map(|n| share_of(basis, n)).sum());
        Ok(Some(DualFacet { sums, basis, eta, kappa }))
    }

    /// eta; `None` where the facet has faded out.
    pub fn offsets(&self) -> Option<&[f64; MAX_CORNERS]> {
        self.basis.as_ref().map(|_| &self.eta)
    }

    /// kappa, and phi; 1 where it has faded out.
    pub fn coverage(&self) -> (f64, f64) {
        (self.kappa, self.basis.as_ref().map_or(1.0, |basis| basis.coverage.fade))
    }

    /// Makes of [Do - Dm eta] the derivative of phi m_A eta_A, where `areas` are those of phi m_A.
    pub fn share_offsets(&self, areas: &[Slopes], slopes: &mut [Slopes]) {
        let Some(basis) = &self.basis else { return };
        for (slope, area) in slopes.as_flattened_mut().iter_mut().zip(areas.as_flattened()) {
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
        let own = one.offsets_of(one.facets[pair.one].as_slice());
        add_offsets(&mut sums, n, [&own, &two.offsets_of(two.facets[pair.two].as_slice())]);
    }
    sums
}

/// Adds what a pair with these weights has of o_A, by the offsets of both facets' nodes.
pub fn add_offsets(sums: &mut [f64; MAX_CORNERS], n: &PairWeights, [own, other]: [&[f64; MAX_CORNERS]; 2]) {
    for (a, sum) in sums.iter_mut().enumerate() {
        *sum += own.iter().zip(&n.ab[a]).map(|(h, n)| n * h).sum::<f64>();
        *sum += other.iter().zip(&n.ac[a]).map(|(h, n)| n * h).sum::<f64>();
    }
}

impl DualFacet {
    /// As [`PairDerivatives::of`], of a facet with its gaps, as they were integrated, against an analytic surface.
    pub fn of_analytic(
        &self,
        (motion, surface): (&PairDerivatives, &AnalyticSurface),
        frame: &NonmortarFrame,
        (traction, gaps): (&[[f64; MAX_CORNERS]; 3], &[Vec3; MAX_CORNERS]),
        (forces, areas): (&mut ForceDerivatives, &mut AreaDerivatives),
    ) -> Result<Option<GapBlocks>> {
        let Some(basis) = &self.basis else { return Ok(None) };
        let facet = WholeFacet::new(basis, gaps);
        let mut blocks = analytic_motion_raised(frame, surface, motion.rule, &facet.heights, forces)?;
        for (to, of) in areas.iter_mut().zip(&forces.one) {
            *to = of.map(|of| of[0]); // Dm_A
        }
        facet.share(traction, forces, &mut blocks);
        Ok(Some(blocks))
    }
}
