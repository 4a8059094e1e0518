//! How much of a step a host may take before surfaces that close pass through each other.

use super::guard::guard;
use super::handle::{either, handle, sizes, stickslip_interface};
use super::point::{Point, vectors};
use super::raw;

/// How much of a step of Newton's method may be taken before the surfaces pass through each other: where contact alone
/// holds a body that does not touch yet, Newton's step is far too long. Every covered node may go deeper by
/// `penetration` times the shortest edge of the facets around it, from where it is or from a gap of 0: enough for
/// Newton's method to know that the surfaces touch.
///
/// x1 (3 n1), x2 (3 n2): positions [L]; dx1 (3 n1), dx2 (3 n2): what the step would add to them [L]. penetration: above
/// 0 and at most 1 [-]; 0: the default, 0.1. fraction, output: above 0 and at most 1 [-]; 1 where the step is allowed.
/// Scale the whole step by it, multipliers too; of several interfaces take the least. No gap is known between the
/// fractions that are tried, which advance by what the nearest node has left and by a quarter of the penetration at
/// least. A motion along surfaces that touch is therefore cut, too, beyond some facets. Of an analytic mortar side
/// dx2 is a translation, or 0. Sides that are tied may move as they like: 1.
///
/// On several processes each handle answers for its own part of the mortar surface, without `sums`; the least of the
/// answers is allowed for all, since a node's gap is a mean of its handles'.
///
/// Errors: NULL_POINTER, NOT_FINITE, DEGENERATE_FACET, PROJECTION_NOT_CONVEX, UNDEFINED_NORMAL (at the positions
/// themselves; what the library would refuse on the way is not allowed), INVALID_VALUE (penetration; an analytic
/// surface's frame).
/// Cost: one search and one integration for each fraction tried, none of it linearised: two where the step is shorter
/// than an edge, 10 to 30 where a gap of many facets closes, 65 at most; frozen weights: none. Allocates. History and
/// later results stay as they are. Source: conservative advancement (B. Mirtich, Impulse-based dynamic simulation of
/// rigid body systems, 1996).
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_step_limit(
    interface: *mut stickslip_interface,
    x1: *const f64,
    x2: *const f64,
    dx1: *const f64,
    dx2: *const f64,
    penetration: f64,
    fraction: *mut f64,
) -> i32 {
    guard(|| {
        let h = &mut handle(interface)?.inner;
        let (n1, n2) = sizes(h);
        let point = Point::positions(h, x1, x2)?;
        let (dx1, dx2) = (vectors(h, dx1, n1, "dx1")?, vectors(h, dx2, n2, "dx2")?);
        let (dx1, dx2) = (raw::as_vectors(&dx1), raw::as_vectors(&dx2));
        let depth = (penetration != 0.0).then_some(penetration);
        raw::check(fraction, "fraction")?;
        let limit = either!(h, c => c.step_limit((point.x1(), point.x2()), (dx1, dx2), depth)?);
        raw::write(fraction, &[limit]);
        Ok(())
    })
}
