//! A node as the law sees it, and whether the law need be asked about it at all.

use super::own::is_new;
use super::sums::NodeSums;
use crate::error::Result;
use crate::interface::data::counters::NodeCounts;
use crate::interface::data::extent::{Extent, Scope};
use crate::interface::data::options::NewContact;
use crate::interface::pairing::given::Given;
use crate::law::{Node, Special};
use nalgebra::SVector;

/// What the law is asked about node A.
pub fn node<const N: usize>(given: Given<N>, a: usize, lambda: SVector<f64, N>, sums: &NodeSums) -> Result<Node<N>> {
    let (options, nodes, least) = (&given.setup.options, &given.setup.nodes, given.least_coverage(a));
    let covered_before = sums.coverage_previous > least;
    let is_new = !covered_before && options.new_contact == NewContact::Frictionless;
    let frictionless = is_new || given.has_copy_in_contact(a);
    let normal = given.normal(a)?;
    Ok(Node {
        lambda,
        normal,
        augmentation: given.augmentation(a),
        mu: if frictionless { 0.0 } else { nodes.mu[a] },
        shear_limit: options.shear_limit.unwrap_or(f64::INFINITY),
        gap_now: sums.gap_now,
        gap_previous: sums.gap_previous,
        gap_committed: sums.gap_committed,
        covered: sums.coverage > least,
        covered_before,
        slip: options.effective_slip(),
        free: nodes.free[a],
        special: Special::Nothing,
    })
}

/// The count that a node which the law is asked about belongs to.
pub fn count_of<'c, const N: usize>(
    given: Given<N>,
    a: usize,
    node: &Node<N>,
    counts: &'c mut NodeCounts,
) -> &'c mut i64 {
    if !node.covered {
        &mut counts.uncovered
    } else if !given.setup.options.friction.law().opens {
        &mut counts.tied
    } else if !given.setup.effects.law.slips
        || (given.setup.nodes.mu[a] == 0.0 && given.setup.own.is_none() && given.setup.layer.is_none())
    {
        &mut counts.frictionless
    } else if is_new(given, node) {
        &mut counts.new
    } else {
        &mut counts.frictional
    }
}

/// Whether nothing can cover a node before the next commit. Of a part of an interface other handles may know better.
pub fn is_out_of_reach<const N: usize>(given: Given<N>, a: usize, extent: Extent) -> bool {
    given.setup.options.shortcuts.uncovered && extent == Extent::Whole && !given.step.pairing.coverable[a]
}

/// Whether the law need not be asked about a node: out of reach, or the surfaces are apart.
pub fn is_left_out<const N: usize>(given: Given<N>, a: usize, scope: Scope) -> bool {
    is_out_of_reach(given, a, scope.extent) || (given.setup.options.shortcuts.uncovered && scope.apart)
}
