//! A part of a non-mortar line and one of a mortar line, projected on the first (docs/formulation 13.1):
//!
//! s_k = (x_k - x0) . t,  d_k = (x_k - x0) . e,  x0 the middle of the non-mortar part, t its direction, e across.
//!
//! Their overlap is an interval of s. Its ends are nodes of one or the other.

use crate::geometry::Vec2;
use nalgebra::SVector;

/// Nodes of a pair of parts: a and b of the non-mortar one, c and d of the mortar one.
pub(super) const NODES: usize = 4;

/// The factor rho of a length: what one of the plane stands for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Measure {
    /// Plane strain or stress of this thickness `[L]`.
    Thickness(f64),
    /// 2 pi r, r the first coordinate, on the chord of the non-mortar part.
    Axisymmetric,
}

impl Measure {
    /// rho where the shares of a and b are these.
    #[inline(always)]
    pub(super) fn at(self, shares: [f64; 2], r: [f64; 2]) -> f64 {
        match self {
            Measure::Thickness(thickness) => thickness,
            Measure::Axisymmetric => std::f64::consts::TAU * (shares[0] * r[0] + shares[1] * r[1]),
        }
    }

    /// The first of these nodes that is at r < 0 in an axisymmetric model.
    #[inline]
    pub fn beyond_axis<const D: usize>(self, x: &[SVector<f64, D>]) -> Option<usize> {
        x.iter().position(|x| self == Measure::Axisymmetric && x[0] < 0.0)
    }

    /// d rho / d r.
    #[inline(always)]
    pub(super) fn slope(self) -> f64 {
        if self == Measure::Axisymmetric { std::f64::consts::TAU } else { 0.0 }
    }
}

/// Two parts that overlap.
#[derive(Clone, Copy, Debug)]
pub(super) struct LineSegment {
    /// Along the non-mortar part.
    pub t: Vec2,
    e: Vec2,
    length: f64,
    /// s of a, b, c, d.
    pub s: [f64; NODES],
    /// d of c, d.
    d: [f64; 2],
    /// 1 / (s_b - s_a), 1 / (s_d - s_c).
    pub per: [f64; 2],
    /// First coordinates of a and b.
    pub r: [f64; 2],
    /// The interval's ends, and the nodes that they are.
    pub ends: [(f64, usize); 2],
}

impl LineSegment {
    /// `None` where they do not overlap, or the mortar part is seen end-on.
    #[inline]
    pub fn new(x: [Vec2; NODES]) -> Option<LineSegment> {
        let along = x[1] - x[0];
        let length = along.norm();
        let (t, middle) = (along / length, x[0] + along * 0.5);
        let e = Vec2::new(-t.y, t.x);
        let (s, d) = (x.map(|x| (x - middle).dot(&t)), [x[2], x[3]].map(|x| (x - middle).dot(&e)));
        let [low, high] = if s[2] < s[3] { [2, 3] } else { [3, 2] };
        // Where nodes coincide the end is the non-mortar one's.
        let from = if s[low] > s[0] { low } else { 0 };
        let to = if s[high] < s[1] { high } else { 1 };
        let ends = [(s[from], from), (s[to], to)];
        if !(s[to] > s[from]) {
            return None;
        }
        let per = [1.0 / (s[1] - s[0]), 1.0 / (s[3] - s[2])];
        Some(LineSegment { t, e, length, s, d, per, r: [x[0].x, x[1].x], ends })
    }

    /// Shares of a and b, or of c and d (`side` 1), at s: those of node k of the side are its linear function.
    #[inline(always)]
    pub fn shares(&self, side: usize, s: f64) -> [f64; 2] {
        let ([from, to], per) = ([self.s[2 * side], self.s[2 * side + 1]], self.per[side]);
        [(to - s) * per, (s - from) * per]
    }

    /// e d_k / L of c and d: how their s_k change with Dx_b - Dx_a.
    #[inline(always)]
    pub fn turn(&self) -> [Vec2; 2] {
        self.d.map(|d| self.e * (d / self.length))
    }

    /// What the frame's motion makes of derivatives f_k by s_k: (- t sum f_k / 2, e sum f_k d_k / L). With Ds_k as in
    /// docs/formulation 13.3, a has their difference, b their sum, and every node besides t f_k.
    #[inline]
    pub fn motion(&self, f: &[f64; NODES]) -> [Vec2; 2] {
        // a and b lie on t: their d is 0.
        let turn = f[2] * self.d[0] + f[3] * self.d[1];
        [self.t * (-0.5 * (f[0] + f[1] + f[2] + f[3])), self.e * (turn / self.length)]
    }
}
