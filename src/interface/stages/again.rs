//! Pairs that were found at some places with the weights of others close by: for differences of derivatives. Pairs that those places have
//! beside them cover next to nothing.

use super::facet::{dual_parents, facet};
use super::integrate::pair_weights;
use crate::error::Result;
use crate::interface::data::active::Active;
use crate::interface::data::options::{MultiplierBasis, Options};
use crate::interface::data::pairs::PairRecord;
use crate::interface::data::surface::Surface;
use crate::interface::pairing::analytic;
use crate::interface::pairing::candidates::by_points;
use crate::interface::pairing::filter::Filter;
use crate::interface::pairing::overlaps::overlap;
use crate::memory::Store;
use crate::mortar::Segment;

/// Puts these pairs, of facets of one facet of the host, at the places of `active` in place of all pairs that it has; `segments`: room.
pub fn again(
    surfaces: (&Surface, &Surface),
    (options, filter): (&Options, &Filter),
    pairs: &[PairRecord],
    active: &mut Active,
    segments: &mut Vec<Segment>,
) -> Result<()> {
    active.clear_pairs();
    // Taken away while pairs are added.
    let (x1, x2, normals) =
        (std::mem::take(&mut active.x1), std::mem::take(&mut active.x2), std::mem::take(&mut active.normals));
    let (one, two) = surfaces;
    let parents = one.parents.as_ref().zip(two.parents.as_ref());
    let added: Result<()> = pairs.chunk_by(|p, q| p.one == q.one).try_for_each(|pairs| {
        let (i, first) = (pairs[0].one, active.pairs.len());
        let frame = one.frame(i, &x1, &normals)?;
        segments.clear();
        match filter {
            Filter::Analytic(_) => {
                let surface = two.analytic_at(&x2)?;
                let weights = analytic::weigh((one, &surface), options, (i, &frame, &x1), active)?;
                active.add(PairRecord { one: i, two: 0, weights }, 0.0)?;
            }
            Filter::Facets(filter) => {
                for &PairRecord { two: j, .. } in pairs {
                    let found = overlap(&frame, &two.facet(j, &x2), by_points(options, filter, i))?;
                    let Some(segment) = found else { continue };
                    let weights = pair_weights(parents, (i, j), (&frame, &segment, options.rule), (&x1, &x2), active)?;
                    active.add(PairRecord { one: i, two: j, weights }, segment.area)?;
                    segments.store(segment)?;
                }
            }
        }
        if options.basis == MultiplierBasis::Dual && one.parents.is_none() {
            facet(one, active, first, (&frame, &segments[..]))?;
        }
        Ok(())
    });
    (active.x1, active.x2, active.normals) = (x1, x2, normals);
    added?;
    active.order_parents();
    if options.basis == MultiplierBasis::Dual && one.parents.is_some() {
        dual_parents(one, active)?;
    }
    Ok(())
}
