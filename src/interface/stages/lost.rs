//! A commit takes no contact away. The pairs of the step that follows are settled anew, by the positions of its start: at
//! these positions a closed node must still have the pairs that it had. The new normals alone may change which facets
//! look at each other, as long as they leave the node covered.

use super::commit::Settled;
use crate::error::{Error, Kind, Result};
use crate::geometry::Vec3;
use crate::interface::data::pairs::PairRecord;
use crate::interface::data::setup::Setup;
use crate::interface::pairing::analytic;
use crate::interface::pairing::filter::{Filter, TOUCHES};
use crate::interface::pairing::given::Given;
use crate::law::{NodeResponse, State};
use crate::memory;

/// A pair with less of a node's area carries none of its traction: the rounding of an overlap.
const NOTHING: f64 = 1e-12;

/// Refuses a commit at (x1, x2) after which a closed node would have lost a pair because it is deep, or all that covers it.
/// `dropped`: the pairs of now that will be none, as they were integrated; of weights of now: frozen ones do not say what the
/// old filter would admit here; with the nodes' areas of t_n.
pub fn refuse_lost_contact<const N: usize>(
    setup: &Setup<N>,
    (dropped, areas): (&[PairRecord], &[f64]),
    new: &Settled,
    (x1, x2): (&[Vec3], &[Vec3]),
    responses: &[NodeResponse<N>],
) -> Result<()> {
    let Some(filter) = new.filter.as_ref().filter(|_| !dropped.is_empty()) else { return Ok(()) };
    let mut lost = memory::filled(0.0, setup.nonmortar.len())?;
    for pair in dropped {
        let (low, deep) = match filter {
            Filter::Facets(filter) => {
                let (low, high) = filter.heights(pair.one, pair.two);
                (low, Some(-high).filter(|depth| *depth > 0.0 && filter.opposes(pair.one, pair.two)))
            }
            Filter::Analytic(_) => (lowest_over_surface(setup, pair.one, x1, x2)?, None),
        };
        let touches = low <= TOUCHES * setup.nonmortar.facet(pair.one, x1).longest_edge();
        for (k, &a) in setup.nonmortar.rows(pair.one).as_slice().iter().enumerate() {
            let coverage = pair.weights.coverage(k);
            let elsewhere = !setup.nodes.acts(a);
            if elsewhere || !touches || coverage <= NOTHING * areas[a] || responses[a].state == State::Gap {
                continue;
            }
            lost[a] += coverage;
            if let Some(depth) = deep {
                let text = text!(
                    "non-mortar node {a} is in contact with mortar facet {}, which lies {depth:.3e} behind non-mortar facet {}: deeper than a pair may be in the next step; give search_distance, more than that, or smaller non-mortar facets",
                    setup.mortar.host_facet(pair.two),
                    setup.nonmortar.host_facet(pair.one)
                );
                return Err(Error::new(Kind::ContactLost, text));
            }
        }
    }
    let least = |a: usize| setup.options.coverage_min * new.history.areas[a];
    match (0..lost.len()).find(|&a| lost[a] > least(a) && new.history.coverage[a] <= least(a)) {
        None => Ok(()),
        Some(a) => {
            let text = text!(
                "non-mortar node {a} is in contact, but nothing that covers it could be its pair in the next step: with the normals of now the facets no longer look at each other, or search_distance is too small; take a smaller step, or give a larger search_distance"
            );
            Err(Error::new(Kind::ContactLost, text))
        }
    }
}

/// Refuses a commit at (x1, x2) of a step in which an analytic mortar side has passed through a facet that faced it.
pub fn refuse_passed<const N: usize>(given: Given<N>, (x1, x2): (&[Vec3], &[Vec3])) -> Result<()> {
    let (Some(Filter::Analytic(facing)), setup) = (&given.step.pairing.filter, given.setup) else { return Ok(()) };
    let surface = setup.mortar.analytic_at(x2)?;
    let Some(f) = analytic::passed(&setup.nonmortar, (&surface, facing), (&given.history().x1, x1))? else {
        return Ok(());
    };
    let text = text!(
        "the analytic mortar surface has passed through non-mortar facet {} within the step, so that the facet no longer looks at it; take a smaller step",
        setup.nonmortar.host_facet(f)
    );
    Err(Error::new(Kind::ContactLost, text))
}

/// The least distance of a facet's nodes to the analytic mortar side `[L]`.
fn lowest_over_surface<const N: usize>(setup: &Setup<N>, facet: usize, x1: &[Vec3], x2: &[Vec3]) -> Result<f64> {
    let surface = setup.mortar.analytic_at(x2)?;
    let nodes = setup.nonmortar.facets[facet].as_slice().iter();
    Ok(nodes.map(|&a| surface.distance(x1[a] - surface.origin)).fold(f64::INFINITY, f64::min))
}
