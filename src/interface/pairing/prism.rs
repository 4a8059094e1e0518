//! What a non-mortar facet sweeps along its normal, and which boxes and facets may reach into it.

use super::boxes::{Aabb, Four};
use super::orientation::Axes;
use crate::geometry::{Plane, Vec3};
use crate::interface::data::surface::Surface;
use crate::shape::MAX_CORNERS;
use crate::simd::{self, Kernel, Lanes};

/// Rounding of a scalar product of three terms and of the interval's ends, over the terms' size: a facet that is huge
/// beside the prism must not be lost to it.
pub const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Between two ends along a direction: heights over the prism's origin `[L]`.
#[derive(Clone, Copy, Debug)]
pub struct Slab {
    pub direction: Vec3,
    pub low: f64,
    pub high: f64,
}

/// No slab.
const NONE: Slab = Slab { direction: Vec3::new(0.0, 0.0, 0.0), low: 0.0, high: 0.0 };

/// What a facet sweeps along its normal: intervals along the plane's two axes. It has no ends, or it is what of it lies in
/// any of its slabs.
#[derive(Clone, Copy, Debug)]
pub struct Prism {
    pub origin: Vec3,
    axes: [Vec3; 2],
    low: [f64; 2],
    high: [f64; 2],
    slabs: [Slab; 2],
    /// How many slabs there are; 0: the prism has no ends.
    ends: usize,
    /// By how much the intervals are larger than the facet, on either side `[L]`.
    margin: f64,
    /// The facet's corners along the axes; a triangle's fourth one is its first one.
    corners: [[f64; MAX_CORNERS]; 2],
}

impl Prism {
    /// The prism over `points` in the directions of `plane`, grown by `margin` on every side, without ends.
    pub fn over(points: &[Vec3], plane: &Plane, margin: f64) -> Prism {
        let (origin, axes) = (plane.reference, [plane.t1, plane.t2]);
        let point = |c: usize| points.get(c).unwrap_or(&points[0]) - origin;
        let corners = axes.map(|axis| std::array::from_fn(|c| axis.dot(&point(c))));
        Prism {
            origin,
            axes,
            low: corners.map(|c| smallest(&c) - margin),
            high: corners.map(|c| largest(&c) + margin),
            slabs: [NONE; 2],
            ends: 0,
            margin,
            corners,
        }
    }

    /// The same prism with these ends; two slabs at most.
    pub fn within(mut self, slabs: impl IntoIterator<Item = Slab>) -> Prism {
        for slab in slabs {
            self.slabs[self.ends] = slab;
            self.ends += 1;
        }
        self
    }

    /// Whether it has no ends.
    pub fn is_endless(&self) -> bool {
        self.ends == 0
    }

    /// The prism for a search among boxes that lie in `root`, along these axes if they are not those of space. It loses
    /// its ends where none of them can tell any boxes apart.
    pub fn among(&self, root: &Aabb, axes: Option<&Axes>) -> Prism {
        let mut prism = *self;
        if let Some(axes) = axes {
            prism.origin = axes.place(&self.origin);
            prism.axes = self.axes.map(|axis| axes.direction(&axis));
            // Coordinates along the axes are rounded where they are large, and differences of them come later.
            let rounding = ROUNDING * (prism.origin.abs().sum() + root.farthest().sum());
            (prism.low, prism.high) = (self.low.map(|low| low - rounding), self.high.map(|high| high + rounding));
            for slab in &mut prism.slabs[..self.ends] {
                let direction = axes.direction(&slab.direction);
                *slab = Slab { direction, low: slab.low - rounding, high: slab.high + rounding };
            }
        }
        let holds_all = |slab: &Slab| {
            let (low, high) = root.along(slab.direction, prism.origin);
            !(low < slab.low || high > slab.high)
        };
        if prism.slabs[..prism.ends].iter().any(holds_all) {
            prism.ends = 0;
        }
        prism
    }

    /// Of four boxes, how far the two overlap along the prism's axes and between its ends: at least 0 when the box may reach
    /// into the prism; never less when it does.
    #[inline(always)]
    pub fn overlaps<L: Lanes>(&self, b: &Four) -> [f64; 4] {
        let half = L::splat(0.5);
        let mut most = L::splat(f64::INFINITY);
        // Differences of coordinates first: a common offset costs no digits.
        let (mut centre, mut extent) = ([half; 3], [half; 3]);
        for i in 0..3 {
            let origin = L::splat(self.origin[i]);
            let (low, high) = (L::load(&b.low[i]) - origin, L::load(&b.high[i]) - origin);
            let farthest = high.max(-low).max(low.max(-high));
            (centre[i], extent[i]) = ((low + high) * half, L::splat(ROUNDING).mul_add(farthest, (high - low) * half));
        }
        for k in 0..2 {
            most = most.min(between::<L>(&self.axes[k], self.low[k], self.high[k], &centre, &extent));
        }
        if self.ends > 0 {
            let mut best = L::splat(f64::NEG_INFINITY);
            for slab in &self.slabs[..self.ends] {
                best = best.max(between::<L>(&slab.direction, slab.low, slab.high, &centre, &extent));
            }
            most = most.min(best);
        }
        most.store()
    }

    /// Of the facets `found`, keeps those that may overlap with the prism's facet or touch it, seen along the prism: by
    /// what their nodes, not their boxes, reach over along the axes of the prism and across two of their own sides.
    pub fn keep_near(&self, two: &Surface, x2: &[Vec3], found: &mut Vec<usize>) {
        simd::dispatch(Near { prism: self, two, x2, found });
    }

    /// Of four facets, how far each is from the prism's facet, beyond the margin, along some direction in its plane: above 0
    /// where they are apart. `x`: component by component the places of their nodes.
    #[inline(always)]
    fn apart<L: Lanes>(&self, x: &[[[f64; 4]; 3]; MAX_CORNERS]) -> [f64; 4] {
        let zero = L::splat(0.0);
        let (mut y, mut far) = ([[zero; 2]; MAX_CORNERS], zero);
        for c in 0..MAX_CORNERS {
            let mut size = zero;
            for i in 0..3 {
                let z = L::load(&x[c][i]) - L::splat(self.origin[i]);
                y[c][0] = L::splat(self.axes[0][i]).mul_add(z, y[c][0]);
                y[c][1] = L::splat(self.axes[1][i]).mul_add(z, y[c][1]);
                size = size + z.max(-z);
            }
            far = far.max(size);
        }
        let rounding = L::splat(ROUNDING) * far;
        let mut apart = L::splat(f64::NEG_INFINITY);
        for k in 0..2 {
            let low = y[0][k].min(y[1][k]).min(y[2][k].min(y[3][k]));
            let high = y[0][k].max(y[1][k]).max(y[2][k].max(y[3][k]));
            apart = apart.max(low - L::splat(self.high[k])).max(L::splat(self.low[k]) - high);
        }
        apart = apart - rounding;
        // Across two of their own sides.
        for k in 0..2 {
            let [u, v] = [y[k + 1][0] - y[k][0], y[k + 1][1] - y[k][1]];
            let (mut low, mut high) = (zero, zero);
            for c in [k + 2, (k + 3) & 3] {
                let d = u.mul_sub(y[c][1] - y[k][1], v * (y[c][0] - y[k][0]));
                (low, high) = (low.min(d), high.max(d));
            }
            let (mut least, mut most, mut length) = (L::splat(f64::INFINITY), L::splat(f64::NEG_INFINITY), zero);
            for c in 0..MAX_CORNERS {
                let across = L::splat(self.corners[0][c]) - y[k][0];
                let up = L::splat(self.corners[1][c]) - y[k][1];
                let d = u.mul_sub(up, v * across);
                (least, most) = (least.min(d), most.max(d));
                length = length.max(across.max(-across)).max(up.max(-up));
            }
            // The side's own rounding turns it, by which what is far along it moves.
            let room = (L::splat(self.margin) + rounding).mul_add(u.max(-u) + v.max(-v), rounding * length);
            apart = apart.max(low - most - room).max(least - high - room);
        }
        apart.store()
    }
}

/// By how much boxes with these middles and half extents overlap with an interval along a direction.
#[inline(always)]
fn between<L: Lanes>(direction: &Vec3, low: f64, high: f64, centre: &[L; 3], extent: &[L; 3]) -> L {
    let (mut c, mut r) = (L::splat(0.0), L::splat(0.0));
    for i in 0..3 {
        c = L::splat(direction[i]).mul_add(centre[i], c);
        r = L::splat(direction[i].abs()).mul_add(extent[i], r);
    }
    (c + r - L::splat(low)).min(L::splat(high) - (c - r))
}

#[inline(always)]
fn smallest(v: &[f64; 4]) -> f64 {
    v[0].min(v[1]).min(v[2].min(v[3]))
}

#[inline(always)]
fn largest(v: &[f64; 4]) -> f64 {
    v[0].max(v[1]).max(v[2].max(v[3]))
}

/// See [`Prism::keep_near`].
struct Near<'a> {
    prism: &'a Prism,
    two: &'a Surface,
    x2: &'a [Vec3],
    found: &'a mut Vec<usize>,
}

impl Kernel for Near<'_> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let (mut kept, mut first) = (0, 0);
        while first < self.found.len() {
            let count = (self.found.len() - first).min(4);
            let (mut facets, mut x) = ([0; 4], [[[0.0; 4]; 3]; MAX_CORNERS]);
            for place in 0..4 {
                facets[place] = self.found[first + place.min(count - 1)];
                let nodes = &self.two.facets[facets[place]].nodes;
                for c in 0..MAX_CORNERS {
                    let node = &self.x2[nodes[c]];
                    (x[c][0][place], x[c][1][place], x[c][2][place]) = (node.x, node.y, node.z);
                }
            }
            let apart = self.prism.apart::<L>(&x);
            for place in 0..count {
                self.found[kept] = facets[place];
                kept += usize::from(!(apart[place] > 0.0));
            }
            first += count;
        }
        self.found.truncate(kept);
    }
}
