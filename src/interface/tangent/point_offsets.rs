//! What offsets of the nodes are to the gaps of a facet where points decide, with weights of now (docs/formulation.md 15.2, 16.8).

use crate::dual::DualBasis;
use crate::interface::data::offsets;
use crate::interface::data::points::{PointFacet, Points};
use crate::interface::data::surface::Surface;
use crate::interface::pairing::given::Given;
use crate::shape::MAX_CORNERS;

/// Offsets of a facet's nodes (docs/formulation.md 15.2).
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
        let (own, mut sums) = (of_nodes(one, facet.nodes()), [0.0; MAX_CORNERS]);
        for pair in &points.pairs[facet.places()] {
            let other = of_nodes(two, two.host_nodes(pair.two));
            for (a, sum) in sums.iter_mut().enumerate() {
                let of =
                    |n: &[f64; MAX_CORNERS], h: &[f64; MAX_CORNERS]| n.iter().zip(h).map(|(n, h)| n * h).sum::<f64>();
                *sum += (of(&pair.whole.ab[a], &own) + of(&pair.whole.ac[a], &other)) / facet.fade;
            }
        }
        let eta = basis.heights(&sums);
        Some(RaisedFacet { eta, above: std::array::from_fn(|a| own[a] - eta[a]) })
    }
}

/// The offsets of these nodes.
pub fn of_nodes(side: &Surface, nodes: &[usize]) -> [f64; MAX_CORNERS] {
    std::array::from_fn(|k| nodes.get(k).map_or(0.0, |&a| side.offset(a)))
}
