//! Along which axes boxes lie closest around facets. Around facets that are long and thin, or flat, and lie across the axes
//! of space, boxes along these are nearly empty, and tell no facets apart.

use super::boxes::Aabb;
use crate::geometry::{Facet, Vec3};

/// With fewer facets there is little to win.
const FEWEST: usize = 32;
/// So many facets, spread over all, stand for them.
const SAMPLES: usize = 32;
/// The directions of so many of these are tried.
const TRIED: usize = 4;
/// Other axes are taken where boxes along them have less than this of the surface that those along the axes of space have.
/// Around squares that lie across two axes they have half.
const WORTH_IT: f64 = 0.7;

/// Axes at right angles, and from where coordinates along them are measured.
#[derive(Clone, Copy, Debug)]
pub struct Axes {
    origin: Vec3,
    along: [Vec3; 3],
}

impl Axes {
    /// A direction, as coordinates along the axes.
    pub fn direction(&self, v: &Vec3) -> Vec3 {
        Vec3::new(self.along[0].dot(v), self.along[1].dot(v), self.along[2].dot(v))
    }

    /// A point's coordinates.
    pub fn place(&self, x: &Vec3) -> Vec3 {
        self.direction(&(x - self.origin))
    }

    /// Those of a facet: along its longest side and its normal. None of a facet without area.
    fn of(facet: &Facet) -> Option<Axes> {
        let side = |k: usize| facet.nodes[facet.shape.next[k]] - facet.nodes[k];
        let longer = |a: Vec3, b: Vec3| if b.norm_squared() > a.norm_squared() { b } else { a };
        let long = (1..facet.len()).map(side).fold(side(0), longer);
        let normal = facet.area_vector();
        let across = normal.cross(&long);
        let along = [across.cross(&normal), across, normal].map(|v| v / v.norm());
        let is_right = along.iter().all(|v| v.iter().all(|c| c.is_finite()));
        is_right.then_some(Axes { origin: facet.nodes[0], along })
    }
}

/// The box around a facet.
pub fn facet_box(facet: &Facet, axes: Option<&Axes>) -> Aabb {
    let points = facet.points().iter();
    match axes {
        None => Aabb::around(points.copied()),
        Some(axes) => Aabb::around(points.map(|x| axes.place(x))),
    }
}

/// The best axes for `n` facets; `None`: those of space.
pub fn axes(n: usize, facet: &impl Fn(usize) -> Facet) -> Option<Axes> {
    if n < FEWEST {
        return None;
    }
    let samples = || (0..SAMPLES).map(|k| facet(k * n / SAMPLES));
    let surface = |axes: Option<&Axes>| samples().map(|facet| facet_box(&facet, axes).half_surface()).sum::<f64>();
    let mut least = WORTH_IT * surface(None);
    let mut best = None;
    for axes in samples().step_by(SAMPLES / TRIED).filter_map(|facet| Axes::of(&facet)) {
        let surface = surface(Some(&axes));
        if surface < least {
            (least, best) = (surface, Some(axes));
        }
    }
    best
}
