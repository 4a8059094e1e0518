//! What offsets of the nodes add to the derivatives of a facet's gaps (docs/formulation.md 15.2): D o_A of its pairs, with
//! o_A = sum_B n_AB h_B + sum_C n_AC h_C. With dual multipliers o_A is phi m_A eta_A, eta = m^-1 o with the integrated weights, and
//! D o_A = D(phi m_A) eta_A + phi m_A (m^-1 [Do - Dm eta])_A, pair by pair (10.4).

use super::derivatives::PairDerivatives;
use super::dual_facet::{DualFacet, ShareRoom};
use super::union::UnionPair;
use crate::element::OffsetDerivative;
use crate::error::Result;
use crate::geometry::Vec3;
use crate::interface::data::active::Active;
use crate::interface::data::offsets;
use crate::interface::data::options::Tangent;
use crate::interface::data::pairs::PairRecord;
use crate::interface::data::surface::Surface;
use crate::interface::pairing::given::Given;
use crate::interface::pairing::overlaps::FacetOverlaps;
use crate::interface::stages::sums::in_previous_gaps;
use crate::mortar::{
    AreaDerivatives, ForceDerivatives, NonmortarFrame, PAIR_NODES, Segment, analytic_motion, offset_motion,
};
use crate::shape::MAX_CORNERS;
use std::borrow::Cow;

/// What offsets of the nodes add to the derivative of the gaps of `pairs` of one facet, whose first one has this place; with
/// dual multipliers after the share of a pair's own gaps, whose areas are in the room.
pub fn of_pairs<const N: usize>(
    (given, normals): (Given<N>, &[Vec3]),
    (active, motion): (Option<&Active>, &PairDerivatives),
    (pairs, place_of_first): (&[UnionPair], usize),
    overlaps: &FacetOverlaps,
    (dual, share): (Option<&DualFacet>, &ShareRoom),
) -> Result<Option<OffsetDerivative>> {
    let (surfaces, places) = (given.setup.surfaces(), UnionPair::places(pairs));
    let Some(active) = active.filter(|_| !places.is_empty() && offsets::are_there(surfaces)) else {
        return Ok(None);
    };
    let normals = surfaces.0.facets[pairs[0].one].nodes.map(|a| normals[a]);
    let of_facet = places.start - place_of_first..places.end - place_of_first;
    let of = (&active.pairs[places], overlaps.segments.get(of_facet).unwrap_or_default());
    let slopes = match dual {
        Some(dual) => motion.of_dual_offsets(surfaces, overlaps.frame(), of, (dual, share))?,
        None => motion.of_offsets(surfaces, overlaps.frame(), of)?,
    };
    Ok(Some(OffsetDerivative { normals, in_previous: in_previous_gaps(given), slopes }))
}

/// The offsets of a facet's nodes; 0 of those that a triangle does not have.
fn of_nodes(side: &Surface, f: usize) -> [f64; MAX_CORNERS] {
    let (nodes, mut h) = (&side.facets[f], [0.0; MAX_CORNERS]);
    nodes.as_slice().iter().zip(&mut h).for_each(|(&a, h)| *h = side.offset(a));
    h
}

impl PairDerivatives<'_> {
    fn frame<'a>(&self, frame: &'a NonmortarFrame) -> Cow<'a, NonmortarFrame> {
        let mut frame = Cow::Borrowed(frame);
        if self.tangent == Tangent::FrozenNormals {
            frame.to_mut().plane.tilt = Default::default();
        }
        frame
    }

    /// `[k][j][A]`: d o_A / d x_k,j of these pairs of a facet with their overlaps (none against an analytic surface), in common
    /// where there are several.
    pub fn of_offsets(
        &self,
        (one, two): (&Surface, &Surface),
        frame: &NonmortarFrame,
        (pairs, segments): (&[PairRecord], &[Segment]),
    ) -> Result<AreaDerivatives> {
        let (h, mut slopes) = (of_nodes(one, pairs[0].one), [[[0.0; MAX_CORNERS]; 3]; PAIR_NODES]);
        if let Some(surface) = self.surface {
            // n_AB is symmetric: the field of offsets as a traction.
            let mut forces = ForceDerivatives::default();
            analytic_motion(frame, surface, self.rule, &[h; 3], &mut forces)?;
            for (to, of) in slopes.iter_mut().zip(&forces.one) {
                *to = of.map(|of| of[0]);
            }
            return Ok(slopes);
        }
        let frame = self.frame(frame);
        for (pair, segment) in pairs.iter().zip(segments) {
            let mut of = [[[0.0; MAX_CORNERS]; 3]; PAIR_NODES];
            offset_motion((&frame, segment, self.rule), (&h, &of_nodes(two, pair.two)), &mut of);
            for (to, of) in
                slopes.as_flattened_mut().as_flattened_mut().iter_mut().zip(of.as_flattened().as_flattened())
            {
                *to += of;
            }
        }
        Ok(slopes)
    }

    /// The same of one pair of a facet with dual multipliers; in `share` is what its own gaps have left.
    pub fn of_dual_offsets(
        &self,
        (one, two): (&Surface, &Surface),
        frame: &NonmortarFrame,
        (pairs, segments): (&[PairRecord], &[Segment]),
        (dual, share): (&DualFacet, &ShareRoom),
    ) -> Result<AreaDerivatives> {
        let mut slopes = [[[0.0; MAX_CORNERS]; 3]; PAIR_NODES];
        let mut h = of_nodes(one, pairs[0].one);
        let Some(eta) = dual.offsets() else { return Ok(slopes) };
        if self.surface.is_none() {
            (0..MAX_CORNERS).for_each(|b| h[b] -= eta[b]);
            offset_motion(
                (&self.frame(frame), &segments[0], self.rule),
                (&h, &of_nodes(two, pairs[0].two)),
                &mut slopes,
            );
        } // else eta are the offsets themselves
        dual.share_offsets(share, &mut slopes);
        Ok(slopes)
    }
}
