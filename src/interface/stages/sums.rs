//! What the nodes assemble over their pairs: gaps and coverage.

use super::away::looking_away;
use crate::error::Result;
use crate::geometry::Vec3;
use crate::interface::data::active::Active;
use crate::interface::data::pairs::PairRecord;
use crate::interface::data::surface::Surface;
use crate::interface::pairing::given::Given;
use crate::memory::{self, Stored};
use crate::mortar::gap;

/// What a node assembles over its pairs. A parallel host adds these over its ranks.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NodeSums {
    /// Covered area now [L^2].
    pub coverage: f64,
    /// g[n_{n+1}, x_{n+1}] [L^3].
    pub gap_now: Vec3,
    /// Covered area at t_n.
    pub coverage_previous: f64,
    /// g[n_n, x_{n+1}].
    pub gap_previous: Vec3,
    /// g[n_n, x_n]; tied: g[n_0, x_0], turned with its facets.
    pub gap_committed: Vec3,
}

/// Coverage and gap of every non-mortar node from a list of pairs.
pub fn assemble(
    (nonmortar, mortar): (&Surface, &Surface),
    pairs: &[PairRecord],
    x1: &[Vec3],
    x2: &[Vec3],
) -> Result<Vec<(f64, Vec3)>> {
    let mut sums = memory::filled((0.0, Vec3::zeros()), nonmortar.len())?;
    for pair in pairs {
        let (one, two) = (nonmortar.facet(pair.one, x1), mortar.facet(pair.two, x2));
        let gaps = gap(&pair.weights, &one, &two);
        for k in 0..one.len() {
            let (coverage, g) = &mut sums[nonmortar.facets[pair.one].nodes[k]];
            *coverage += pair.weights.coverage(k);
            *g += gaps[k];
        }
    }
    Ok(sums)
}

/// The sums of every node at (x1, x2). `active`: the pairs there; `None`: the weights are frozen. `slips`: with what slip is
/// measured from.
pub fn sums<const N: usize>(
    given: Given<N>,
    active: Option<&Active>,
    slips: bool,
    (x1, x2): (&[Vec3], &[Vec3]),
) -> Result<Vec<NodeSums>> {
    let (surfaces, h) = (given.setup.surfaces(), given.history());
    let now = assemble(surfaces, active.map_or(&h.pairs, |k| &k.pairs), x1, x2)?;
    let committed = h.facet_gaps.turned(surfaces.0, x1, &h.gap)?;
    let mut sums: Vec<_> = (0..given.nodes())
        .map(|a| NodeSums {
            coverage: now[a].0,
            gap_now: now[a].1,
            coverage_previous: h.coverage[a],
            gap_committed: committed.get(a).copied().unwrap_or_default(),
            gap_previous: Vec3::zeros(),
        })
        .stored()?;
    for (sum, away) in sums.iter_mut().zip(looking_away(given, (x1, x2))?) {
        if away {
            (sum.coverage, sum.gap_now) = (0.0, Vec3::zeros());
        }
    }
    if slips {
        let previous = active.map(|_| assemble(surfaces, &h.pairs, x1, x2)).transpose()?;
        let previous = previous.as_ref().unwrap_or(&now);
        for (sum, (_, gap)) in sums.iter_mut().zip(previous) {
            sum.gap_previous = *gap;
        }
    }
    Ok(sums)
}
