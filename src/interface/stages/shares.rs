//! Sums of several handles: what a handle must know of its facets although others have a share of the mortar side.

use super::sums::NodeSums;
use crate::error::{Error, Kind, Result};
use crate::interface::data::options::Weights;
use crate::interface::data::pairs::Weighted;
use crate::interface::pairing::filter::Filter;
use crate::interface::pairing::given::Given;

/// Refuses a facet of a hybrid scheme whose rule depends on what other handles cover of it: one with overlaps, for this handle's
/// mortar facets cover it in part, around whose nodes the sums of all handles have more than this one's `own`. Of frozen weights the
/// rule is not kept: they may be of either.
pub fn refuse_hybrid<const N: usize>(
    given: Given<N>,
    pairs: [Weighted; 2],
    own: &[NodeSums],
    all: &[NodeSums],
) -> Result<()> {
    let one = &given.setup.nonmortar;
    if given.setup.mortar.analytic.is_some() {
        return Ok(());
    }
    let is_current = given.setup.options.effective_weights() == Weights::Current;
    let has_points = |f: usize| match &given.step.pairing.filter {
        Some(Filter::Facets(filter)) => is_current && !filter.by_overlaps[f],
        _ => false,
    };
    let is_shared =
        |&a: &usize| all[a].coverage > own[a].coverage || all[a].coverage_previous > own[a].coverage_previous;
    let found = pairs.into_iter().find_map(|pairs| match pairs {
        Weighted::Facets(pairs) => {
            let mut facets = pairs.iter().map(|pair| pair.one);
            facets.find(|&f| !has_points(f) && one.facets[f].as_slice().iter().any(is_shared))
        }
        Weighted::Parents(pairs) => {
            let mut facets = pairs.iter().map(|pair| pair.one);
            facets.find(|&f| one.host_nodes(f).iter().any(is_shared))
        }
    });
    let Some(f) = found else { return Ok(()) };
    let text = text!(
        "STICKSLIP_INTEGRATION_HYBRID with sums of several handles: non-mortar facet {f} is covered in part by this handle's mortar facets, others cover around it, and by which rule it is integrated depends on all of them; take STICKSLIP_INTEGRATION_SEGMENTS or ELEMENTS, or parts that own nodes"
    );
    Err(Error::new(Kind::Unsupported, text))
}
