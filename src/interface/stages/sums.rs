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
    each_gap(surfaces, pairs, x, |node, coverage, gap| {
        sums[node].0 += coverage;
        sums[node].1 += gap;
    });
    Ok(())
}

/// What each pair adds to the coverage and the gap of each of its non-mortar nodes.
#[inline]
fn each_gap(
    (nonmortar, mortar): (&Surface, &Surface),
    pairs: Weighted,
    (x1, x2): (&[Vec3], &[Vec3]),
    mut add: impl FnMut(usize, f64, Vec3),
) {
    let pairs = match pairs {
        Weighted::Facets(pairs) => pairs,
        Weighted::Parents(pairs) => return each_gap_of_parents((nonmortar, mortar), pairs, (x1, x2), &mut add),
    };
    for pair in pairs {
        let (one, two) = (nonmortar.facet(pair.one, x1), mortar.facet(pair.two, x2));
        let gaps = gap(&pair.weights, &one, &two);
        for k in 0..one.len() {
            add(nonmortar.facets[pair.one].nodes[k], pair.weights.coverage(k), gaps[k]);
        }
    }
}

/// The same of pairs of parents.
#[inline(never)]
fn each_gap_of_parents(
    surfaces: (&Surface, &Surface),
    pairs: &[ParentRecord],
    x: (&[Vec3], &[Vec3]),
    add: &mut dyn FnMut(usize, f64, Vec3),
) {
    for record in pairs {
        let (one, two) = parents_at(surfaces, record, x);
        let pair = ParentPair { one: &one, two: &two, multipliers: surfaces.0.multipliers(record.one) };
        let gaps = pair.gap(&record.weights);
        for (a, &node) in surfaces.0.host_nodes(record.one).iter().enumerate().take(pair.multipliers) {
            add(node, record.weights.coverage(a), gaps[a]);
        }
    }
}

/// What each pair adds to o_A = sum_B n_AB h_B + sum_C n_AC h_C of each of its non-mortar nodes, h the nodes' offsets [L^3].
pub fn each_offset((one, two): (&Surface, &Surface), pairs: Weighted, mut add: impl FnMut(usize, f64)) {
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
    each_offset(surfaces, pairs, |node, offset| match given.normal(node) {
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
    let pairs = active.map_or(h.weighted(surfaces), |k| k.weighted(surfaces));
    each_gap(surfaces, pairs, x, |node, coverage, gap| {
        sums[node].coverage += coverage;
        sums[node].gap_now += gap;
    });
    for (sum, coverage) in sums.iter_mut().zip(&h.coverage) {
        sum.coverage_previous = *coverage;
    }
    for (sum, gap) in sums.iter_mut().zip(&h.gap) {
        sum.gap_committed = *gap;
    }
    h.facet_gaps.each_turned(surfaces.0, x.0, |node, gap| sums[node].gap_committed += gap)?;
    offset_gaps(given, pairs, slips && active.is_some(), sums)?;
    match active {
        Some(_) if slips => each_gap(surfaces, h.weighted(surfaces), x, |node, _, gap| sums[node].gap_previous += gap),
        None if slips => sums.iter_mut().for_each(|sum| sum.gap_previous = sum.gap_now),
        _ => {}
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
