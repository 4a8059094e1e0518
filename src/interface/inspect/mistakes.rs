//! Mistakes of a host's that leave surfaces which look sound: the positions of both sides swapped, the node orders of both
//! sides reversed. What speaks for them, and hardly ever without them.

use crate::geometry::Vec3;
use crate::interface::data::surface::Surface;
use crate::interface::pairing::boxes::Aabb;

/// Positions nearer to the other side's first ones than this times the distance to their own are the other side's: bodies do
/// not move so, node by node.
const NEARER: f64 = 0.1;
/// Where every covered node penetrates by this times the facets' longest edge, the open gaps of surfaces that are seen from
/// inside are meant. Interference fits are shallower.
const DEEP: f64 = 0.1;

/// Root of the mean squared distance of the same nodes at two places.
fn distance(x: &[Vec3], y: &[Vec3]) -> f64 {
    let sum: f64 = x.iter().zip(y).map(|(x, y)| (x - y).norm_squared()).sum();
    (sum / x.len() as f64).sqrt()
}

/// Whether x1 and x2 are the other side's. Only sides with as many nodes can be confused.
pub fn are_swapped((one, two): (&Surface, &Surface), (x1, x2): (&[Vec3], &[Vec3])) -> bool {
    if one.len() != two.len() || two.analytic.is_some() {
        return false;
    }
    let own = distance(x1, &one.reference) + distance(x2, &two.reference);
    distance(x1, &two.reference) + distance(x2, &one.reference) < NEARER * own
}

/// Six times the volume within a closed surface: negative where it is seen from inside. `None`: it is open.
fn volume(surface: &Surface, x: &[Vec3]) -> Option<f64> {
    let edges: usize = surface.facets.iter().map(|f| f.len).sum();
    if surface.analytic.is_some() || 2 * surface.edges.len() != edges {
        return None;
    }
    let fans = surface.facets.iter().flat_map(|f| {
        let k = f.as_slice();
        (2..f.len).map(|j| [k[0], k[j - 1], k[j]].map(|k| x[k] - x[0]))
    });
    Some(fans.map(|[a, b, c]| a.dot(&b.cross(&c))).sum())
}

/// Whether a closed surface is that of a cavity and the other side is not in it.
fn is_empty_cavity((surface, x): (&Surface, &[Vec3]), other: &[Vec3]) -> bool {
    let around = |x: &[Vec3]| Aabb::around(x.iter().copied());
    volume(surface, x).is_some_and(|volume| volume < 0.0) && !around(x).contains(&around(other))
}

/// Whether both sides look as if they were seen from inside: every covered node penetrates deeply (`depths` [L]: of the
/// covered nodes), or a closed surface is a cavity without the other side in it. Flat or curved patches that touch do not
/// tell.
pub fn are_inside_out((one, two): (&Surface, &Surface), (x1, x2): (&[Vec3], &[Vec3]), depths: &[f64]) -> bool {
    let edge = one.longest_edge_at(x1);
    let edge = if two.analytic.is_some() { edge } else { edge.min(two.longest_edge_at(x2)) };
    let least = depths.iter().copied().fold(f64::INFINITY, f64::min);
    let deep = !depths.is_empty() && least >= DEEP * edge;
    deep || is_empty_cavity((one, x1), x2) || is_empty_cavity((two, x2), x1)
}
