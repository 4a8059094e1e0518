//! Derivatives of pairs with their weights of now: of the forces of some tractions, and of the gaps.

use crate::error::Result;
use crate::geometry::AnalyticSurface;
use crate::interface::data::effects::Opposite;
use crate::interface::data::options::Tangent;
use crate::interface::data::pairs::PairRecord;
use crate::mortar::{
    ForceDerivatives, GapDerivative, NonmortarFrame, Segment, analytic_motion, facet_motion, pair_motion,
};
use crate::quadrature::Rule;
use crate::shape::MAX_CORNERS;
use std::borrow::Cow;

/// What the derivatives of one tangent have in common.
#[derive(Clone, Copy, Debug)]
pub struct PairDerivatives<'a> {
    /// The mortar side.
    pub opposite: Opposite,
    /// The mortar surface where it is analytic.
    pub surface: Option<&'a AnalyticSurface>,
    /// What the tangent is to know.
    pub tangent: Tangent,
    /// The rule of the weights.
    pub rule: &'static Rule,
}

impl PairDerivatives<'_> {
    /// Of a non-mortar facet with its pairs and their overlaps (none against an analytic surface): one pair where the
    /// mortar side moves, all of the facet's where it rests. `traction[i][A]` is that of the forces, whose derivatives go to
    /// `forces`, which keeps the slots that have none. Those of the gap, which are large, go to `gap`.
    pub fn of(
        &self,
        frame: &NonmortarFrame,
        (pairs, segments): (&[PairRecord], &[Segment]),
        traction: &[[f64; MAX_CORNERS]; 3],
        forces: &mut ForceDerivatives,
        gap: &mut Option<GapDerivative>,
    ) -> Result<()> {
        if let Some(surface) = self.surface {
            *gap = Some(analytic_motion(frame, surface, self.rule, traction, forces)?);
            return Ok(());
        }
        let mut frame = Cow::Borrowed(frame);
        if self.tangent == Tangent::FrozenNormals {
            frame.to_mut().plane.tilt = Default::default();
        }
        let by_points = segments[0].points.is_some();
        *gap = Some(GapDerivative::Facets(if self.opposite == Opposite::Moves || by_points {
            pair_motion((&frame, &segments[0], self.rule), &pairs[0].weights, traction, forces)
        } else {
            let pairs = segments.iter().zip(pairs.iter().map(|pair| &pair.weights));
            facet_motion(&frame, pairs, self.rule, traction, forces)
        }));
        Ok(())
    }
}
