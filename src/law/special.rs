//! What a law of one's own adds to a node: a threshold that somebody else has found, or an ellipse.

use super::projection::Threshold;
use crate::geometry::Vec3;

/// k of one node at one point, with its derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Told {
    /// k and -dk / dsigma_N.
    pub threshold: Threshold,
    /// dk / dg_T, g_T the weighted slip of the step [F/L^5].
    pub slope: Vec3,
}

impl Told {
    /// No tangential traction at all.
    pub fn nothing() -> Told {
        Told { threshold: Threshold { radius: 0.0, fall: 0.0 }, slope: Vec3::zeros() }
    }
}

/// What orthotropic friction knows beside mu, which is that along the direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipse {
    /// Where mu counts: any length but 0, projected on the surface.
    pub direction: Vec3,
    /// The coefficient across it, > 0.
    pub across: f64,
}

/// Of the direction at least this must be left in the surface.
const LEAST_IN_SURFACE: f64 = 1e-6;

impl Ellipse {
    /// Its axes in the surface with this normal; `None`: the direction lies along the normal.
    pub fn axes(&self, normal: Vec3) -> Option<[Vec3; 2]> {
        let unit = self.direction.normalize();
        let along = unit - normal * normal.dot(&unit);
        let size = along.norm();
        (size >= LEAST_IN_SURFACE).then(|| [along / size, normal.cross(&(along / size))])
    }

    /// How these axes turn as the normal changes by `change`.
    pub fn turned_axes(&self, normal: Vec3, [one, _]: [Vec3; 2], change: Vec3) -> [Vec3; 2] {
        let unit = self.direction.normalize();
        let size = (unit - normal * normal.dot(&unit)).norm();
        let along = -(change * normal.dot(&unit) + normal * change.dot(&unit)) / size;
        let d_one = along - one * one.dot(&along);
        [d_one, change.cross(&one) + normal.cross(&d_one)]
    }
}

/// What a law of one's own adds to a node.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Special {
    /// Nothing: there is no such law.
    #[default]
    Nothing,
    /// Its threshold.
    Told(Told),
    /// Its ellipse.
    Ellipse(Ellipse),
}
