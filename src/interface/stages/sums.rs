//! What the nodes assemble over their pairs: gaps and coverage.

use super::away::LookingAway;
use crate::element::ParentPair;
use crate::error::Result;
use crate::geometry::Vec3;
use crate::interface::data::active::Active;
use crate::interface::data::host_facets::parents_at;
use crate::interface::data::offsets;
use crate::interface::data::pairs::{ParentRecord, Weighted};
use crate::interface::data::surface::Surface;
use crate::interface::pairing::given::Given;
use crate::law::SlipMeasure;
use crate::memory;
use crate::mortar::gap;
use crate::threads::{self, Part};

/// What a node assembles over its pairs. A parallel host adds these over its ranks.
/// In the order of the ABI, whose arrays are read as these.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
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

/// Coverage and gap of every non-mortar node from a list of pairs, in place of what was in `sums`.
pub fn assemble(
    surfaces: (&Surface, &Surface),
    pairs: Weighted,
    x: (&[Vec3], &[Vec3]),
    sums: &mut Vec<(f64, Vec3)>,
) -> Result<()> {
    memory::refill(sums, (0.0, Vec3::zeros()), surfaces.0.len())?;
    threads::in_parts(1, (sums, &mut [(); 0]), |mut sums, _| {
        each_gap(surfaces, pairs, x, &mut sums, |sum, coverage, gap| {
            sum.0 += coverage;
            sum.1 += gap;
        });
    })
}

/// What each pair adds to the coverage and the gap of each of its non-mortar nodes that are in this part.
#[inline]
fn each_gap<T>(
    (nonmortar, mortar): (&Surface, &Surface),
    pairs: Weighted,
    (x1, x2): (&[Vec3], &[Vec3]),
    sums: &mut Part<T>,
    add: impl Fn(&mut T, f64, Vec3),
) {
    let pairs = match pairs {
        Weighted::Facets(pairs) => pairs,
        Weighted::Parents(pairs) => {
            for pair in pairs {
                if sums.has_any(nonmortar.host_nodes(pair.one)) {
                    each_gap_of_parents((nonmortar, mortar), pair, (x1, x2), &mut |node, coverage, gap| {
                        sums.at(node).into_iter().for_each(|sum| add(sum, coverage, gap));
                    });
                }
            }
            return;
        }
    };
    for pair in pairs {
        let nodes = nonmortar.facets[pair.one].as_slice();
        if sums.has_any(nodes) {
            let (one, two) = (nonmortar.facet(pair.one, x1), mortar.facet(pair.two, x2));
            let gaps = gap(&pair.weights, &one, &two);
            for (k, &node) in nodes.iter().enumerate() {
                sums.at(node).into_iter().for_each(|sum| add(sum, pair.weights.coverage(k), gaps[k]));
            }
        }
    }
}

/// The same of a pair of parents and all of its nodes.
#[inline(never)]
fn each_gap_of_parents(
    surfaces: (&Surface, &Surface),
    record: &ParentRecord,
    x: (&[Vec3], &[Vec3]),
    add: &mut dyn FnMut(usize, f64, Vec3),
) {
    let (one, two) = parents_at(surfaces, record, x);
    let pair = ParentPair { one: &one, two: &two, multipliers: surfaces.0.multipliers(record.one) };
    let gaps = pair.gap(&record.weights);
    for (a, &node) in surfaces.0.host_nodes(record.one).iter().enumerate().take(pair.multipliers) {
        add(node, record.weights.coverage(a), gaps[a]);
    }
}

/// What each pair adds to o_A = sum_B n_AB h_B + sum_C n_AC h_C of each of its non-mortar nodes, h the nodes' offsets [L^3].
#[inline(never)] // many callers
pub fn each_offset((one, two): (&Surface, &Surface), pairs: Weighted, add: &mut dyn FnMut(usize, f64)) {
    let field = |side: &Surface, nodes: &[usize], row: &[f64]| -> f64 {
        nodes.iter().zip(row).map(|(&node, n)| n * side.offset(node)).sum()
    };
    match pairs {
        Weighted::Facets(pairs) => {
            for pair in pairs {
                let (nodes, others) = (one.facets[pair.one].as_slice(), two.facets[pair.two].as_slice());
                for (k, &node) in nodes.iter().enumerate() {
                    let weights = &pair.weights;
                    add(node, field(one, nodes, &weights.ab[k]) + field(two, others, &weights.ac[k]));
                }
            }
        }
        Weighted::Parents(pairs) => {
            for pair in pairs {
                let (nodes, others) = (one.host_nodes(pair.one), two.host_nodes(pair.two));
                for (a, &node) in nodes.iter().enumerate().take(one.multipliers(pair.one)) {
                    add(node, field(one, nodes, &pair.weights.ab[a]) + field(two, others, &pair.weights.ac[a]));
                }
            }
        }
    }
}

/// Whether the offsets of now count in the gaps that slip is measured from as in those of now: where slip is a difference of the
/// two.
pub fn in_previous_gaps<const N: usize>(given: Given<N>) -> bool {
    given.setup.options.effective_slip() == SlipMeasure::Objective
}

/// The gaps of surfaces that are offset: g_A + nu_A o_A. They count in the gap of now; where slip is a difference of two gaps, in
/// both, so that it has none of them, nor of how nu turns.
fn offset_gaps<const N: usize>(given: Given<N>, pairs: Weighted, slips: bool, sums: &mut [NodeSums]) -> Result<()> {
    let both = slips && in_previous_gaps(given);
    each_along(given, pairs, |node, gap| {
        sums[node].gap_now += gap;
        if both {
            sums[node].gap_previous += gap;
        }
    })
}

/// Adds nu_A o_A to the gaps of now that were assembled over these pairs.
pub fn add_offsets<const N: usize>(given: Given<N>, pairs: Weighted, sums: &mut [(f64, Vec3)]) -> Result<()> {
    each_along(given, pairs, |node, gap| sums[node].1 += gap)
}

/// What each pair adds to nu_A o_A of each of its nodes.
fn each_along<const N: usize>(given: Given<N>, pairs: Weighted, mut add: impl FnMut(usize, Vec3)) -> Result<()> {
    let surfaces = given.setup.surfaces();
    if !offsets::are_there(surfaces) {
        return Ok(());
    }
    let mut refused = Ok(());
    each_offset(surfaces, pairs, &mut |node, offset| match given.normal(node) {
        Ok(nu) => add(node, nu * offset),
        Err(error) => refused = Err(error),
    });
    refused
}

/// The sums of every node at x, in place of what was in `sums`. `active`: the pairs there; `None`: the weights are frozen.
/// `slips`: with what slip is measured from.
pub fn sums<const N: usize>(
    given: Given<N>,
    active: Option<&Active>,
    slips: bool,
    x: (&[Vec3], &[Vec3]),
    sums: &mut Vec<NodeSums>,
) -> Result<()> {
    let (surfaces, h) = (given.setup.surfaces(), given.history());
    memory::refill(sums, NodeSums::default(), given.nodes())?;
    threads::in_parts(given.setup.options.threads, (sums, &mut [(); 0]), |mut sums, _| {
        let now = active.map_or(h.weighted(surfaces), |k| k.weighted(surfaces));
        each_gap(surfaces, now, x, &mut sums, |sum, coverage, gap| {
            sum.coverage += coverage;
            sum.gap_now += gap;
        });
        if active.is_some() && slips {
            each_gap(surfaces, h.weighted(surfaces), x, &mut sums, |sum, _, gap| sum.gap_previous += gap);
        }
    })?;
    for (sum, coverage) in sums.iter_mut().zip(&h.coverage) {
        sum.coverage_previous = *coverage;
    }
    for (sum, gap) in sums.iter_mut().zip(&h.gap) {
        sum.gap_committed = *gap;
    }
    h.facet_gaps.each_turned(surfaces.0, x.0, |node, gap| sums[node].gap_committed += gap)?;
    let pairs = active.map_or(h.weighted(surfaces), |k| k.weighted(surfaces));
    offset_gaps(given, pairs, slips && active.is_some(), sums)?;
    if active.is_none() && slips {
        sums.iter_mut().for_each(|sum| sum.gap_previous = sum.gap_now);
    }
    if let Some(away) = LookingAway::at(given, x)? {
        for (a, sum) in sums.iter_mut().enumerate() {
            if away.is(a)? {
                (sum.coverage, sum.gap_now) = (0.0, Vec3::zeros());
            }
        }
    }
    Ok(())
}
