//! What lies over what: a facet seen along a plane's normal, point by point.

use super::bilinear_map::BilinearMap;
use super::facet::Facet;
use super::plane::Plane;
use super::projection::Projection;
use super::vector::Vec3;
use crate::shape::MAX_CORNERS;

/// A node this far outside a facet, in its functions, still lies on it: at a border by rounding.
pub const OUTSIDE: f64 = 1e-6;

/// A facet seen along a plane's normal.
#[derive(Debug)]
pub struct Over {
    projection: Projection,
    map: BilinearMap,
}

impl Over {
    /// `facet` seen along the normal of `plane`.
    #[inline(never)] // it is met three times
    pub fn new(facet: &Facet, plane: &Plane) -> Over {
        let projection = Projection::new(facet, plane);
        Over { projection, map: BilinearMap::new(&projection) }
    }

    /// How far its corners lie off the plane at most `[L]`.
    pub fn warp(&self) -> f64 {
        self.projection.d.iter().fold(0.0, |most, d| most.max(d.abs()))
    }

    /// How far x lies over it, if it does, and its functions there.
    #[inline(never)]
    pub fn height(&self, x: Vec3, plane: &Plane) -> Option<(f64, [f64; MAX_CORNERS])> {
        let (p, at) = (&self.projection, x - plane.reference - plane.origin);
        let place = self.map.inverse([plane.t1.dot(&at), plane.t2.dot(&at)]);
        let n = p.shape.values(place.xi, place.eta);
        let inside = n.iter().take(p.shape.n).all(|n| *n >= -OUTSIDE);
        inside.then(|| (plane.e.dot(&at) - n.iter().zip(&p.d).map(|(n, d)| n * d).sum::<f64>(), n))
    }

    /// What a field is there that has these values at the facet's corners.
    pub fn mean(&self, n: &[f64; MAX_CORNERS], value: impl Fn(usize) -> f64) -> f64 {
        (0..self.projection.shape.n).map(|k| n[k] * value(self.projection.node[k])).sum()
    }
}
