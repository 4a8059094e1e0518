//! Derivatives of pairs with their weights of now: how.

use crate::geometry::AnalyticSurface;
use crate::interface::data::options::Tangent;
use crate::mortar::NonmortarFrame;
use crate::quadrature::Rule;
use std::borrow::Cow;

/// What the derivatives of one tangent have in common.
#[derive(Clone, Copy, Debug)]
pub struct PairDerivatives<'a> {
    /// The mortar surface where it is analytic.
    pub surface: Option<&'a AnalyticSurface>,
    /// What the tangent is to know.
    pub tangent: Tangent,
    /// The rule of the weights.
    pub rule: &'static Rule,
}

impl PairDerivatives<'_> {
    /// The frame of a facet as it moves for these.
    pub fn frame<'a>(&self, frame: &'a NonmortarFrame) -> Cow<'a, NonmortarFrame> {
        let mut frame = Cow::Borrowed(frame);
        if self.tangent == Tangent::FrozenNormals {
            frame.to_mut().plane.tilt = Default::default();
        }
        frame
    }
}
