//! What offsets of the nodes are to the gaps of a facet where points decide, with weights of now (docs/formulation 15.2, 16.8).

use super::dual_facet::add_offsets;
use crate::dual::DualBasis;
use crate::interface::data::offsets;
use crate::interface::data::points::{PointFacet, Points};
use crate::interface::pairing::given::Given;
use crate::shape::MAX_CORNERS;

/// Offsets of a facet's nodes (docs/formulation 15.2).
pub struct RaisedFacet {
    /// eta_A.
    pub eta: [f64; MAX_CORNERS],
    /// h_A - eta_A.
    pub above: [f64; MAX_CORNERS],
}

impl RaisedFacet {
    /// `None`: there are none.
    pub fn of<const N: usize>(
        given: Given<N>,
        points: &Points,
        facet: &PointFacet,
        basis: &DualBasis,
    ) -> Option<RaisedFacet> {
        let (one, two) = given.setup.surfaces();
        if !offsets::are_there((one, two)) {
            return None;
        }
        let (own, mut sums) = (one.offsets_of(facet.nodes()), [0.0; MAX_CORNERS]);
        for pair in &points.pairs[facet.places()] {
            let other = two.offsets_of(two.host_nodes(pair.two));
            add_offsets(&mut sums, &pair.whole, [&own, &other]);
        }
        let eta = basis.heights(&sums.map(|sum| sum / facet.fade));
        Some(RaisedFacet { eta, above: std::array::from_fn(|a| own[a] - eta[a]) })
    }
}
