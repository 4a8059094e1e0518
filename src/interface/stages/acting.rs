//! Stages 1 and 1b in a row: the pairs of a configuration with the weights that act. Who wants integrated weights, whatever
//! the multipliers' basis, asks for stage 1 alone.

use super::facet::facet;
use super::integrate::integrate;
use crate::error::Result;
use crate::geometry::Vec3;
use crate::interface::data::active::Active;
use crate::interface::data::counters::Counters;
use crate::interface::data::options::Options;
use crate::interface::data::surface::Surface;
use crate::interface::pairing::candidates::KeptTree;
use crate::interface::pairing::filter::Filter;

/// All active pairs at x, with the filter of another or the same configuration.
pub fn acting(
    surfaces: (&Surface, &Surface),
    options: &Options,
    filter: &Filter,
    kept: (&mut Counters, &mut KeptTree),
    x: (&[Vec3], &[Vec3]),
) -> Result<Active> {
    let mut active = integrate(surfaces, options, filter, kept, x)?;
    facet(surfaces.0, options.basis, &mut active)?;
    Ok(active)
}
