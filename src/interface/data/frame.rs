//! The frame of an analytic surface must be long enough for where it is: its points are rounded.

use super::surface::Surface;
use crate::error::{Error, Kind, Result};
use crate::geometry::Vec3;

/// What a gap may lose to the frame's rounding, over the longest facet edge: beyond it a Newton method that works to 1e-10
/// would not converge.
const MOST_LOSS: f64 = 1e-8;

/// What a gap loses to the rounding of the frame's points, over the longest edge of the facets. A point of a frame with
/// coordinates of size S and edges of length a turns the frame by eps S / a, which moves the surface by that times the
/// distance D to the farthest node. The frame may come to move as far as the body is away: S is at least D.
fn loss(one: &Surface, frame: &[Vec3]) -> f64 {
    let farthest = |x: &[Vec3], from: Vec3| x.iter().map(|x| (x - from).norm()).fold(0.0, f64::max);
    let shortest = frame[1..].iter().map(|x| (x - frame[0]).norm()).fold(f64::INFINITY, f64::min);
    let distance = farthest(&one.reference, frame[0]);
    let size = farthest(frame, Vec3::zeros()).max(distance);
    f64::EPSILON * size * distance / (shortest * one.longest_edge)
}

/// Refuses a frame that is too small for where it is.
pub fn check_frame(one: &Surface, two: &Surface) -> Result<()> {
    let loss = if two.analytic.is_some() { loss(one, &two.reference) } else { 0.0 };
    if loss <= MOST_LOSS {
        return Ok(());
    }
    let text = text!(
        "{}: the frame is too small for its distance to the non-mortar side or the origin: rounding moves the surface by {loss:.0e} of a facet, {MOST_LOSS:.0e} is allowed; give it longer edges",
        two.side
    );
    Err(Error::new(Kind::InvalidValue, text))
}
