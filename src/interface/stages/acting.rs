//! Stages 1 and 1b in a row: the pairs of a configuration with the weights that act. Who wants integrated weights, whatever
//! the multipliers' basis, asks for stage 1 alone.

use super::facet::{dual_parents, facet};
use super::integrate::integrate;
use super::part_weights::dual_parts;
use crate::error::Result;
use crate::geometry::Vec3;
use crate::interface::data::active::Active;
use crate::interface::data::options::{MultiplierBasis, Options};
use crate::interface::data::surface::Surface;
use crate::interface::pairing::filter::Filter;
use crate::interface::pairing::work::Work;
use crate::mortar::{MultiplierSpace, NonmortarFrame, Segment};

/// All active pairs at x, with the filter of another or the same configuration, in the memory of `active`. What is there
/// after a refusal means nothing.
#[inline(never)] // it is met several times
pub fn acting(
    surfaces: (&Surface, &Surface),
    options: &Options,
    filter: &Filter,
    work: &mut Work,
    x: (&[Vec3], &[Vec3]),
    active: &mut Active,
) -> Result<()> {
    if options.basis == MultiplierBasis::Standard {
        return integrate(surfaces, options, filter, work, x, active, None);
    }
    if surfaces.0.parents.is_some() {
        integrate(surfaces, options, filter, work, x, active, None)?;
        return match options.space {
            MultiplierSpace::Sub if surfaces.0.has_mid_nodes() => dual_parts(surfaces, options, active),
            _ => dual_parents(surfaces.0, active),
        };
    }
    // That pairs cannot be integrated is said before what their facets lack.
    let following = |active: &mut Active, first: usize, overlaps: (&NonmortarFrame, &[Segment])| {
        if active.refused.is_none() {
            active.refused = facet(surfaces.0, active, first, overlaps).err();
        }
    };
    integrate(surfaces, options, filter, work, x, active, Some(&following))?;
    active.refused.take().map_or(Ok(()), Err)
}
