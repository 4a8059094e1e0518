//! Rigid surfaces in closed form: a plane, a sphere, a cylinder, and the closest point on them; a straight line and a circle
//! of models with two coordinates.
//!
//! A frame of four points P0..P3 is fixed to the surface and moves as a rigid body; lengths are free, the edges
//! P_i - P0 must not lie in one plane. P0: a point of the plane, the centre, a point of the axis; P1 - P0: the plane's
//! normal out of its body, or the direction of the axis. Every point y has coordinates w in the frame, sum w_C = 1,
//! sum w_C P_C = y: the frame's points are to the surface what its nodes are to a facet.
//!
//! A line and a circle lie in the plane z = 0, and so do their three points; the fourth one is above P0 (`in_plane`).
//!
//! Signs: the normal n points out of the surface's body, the distance s `[L]` along it, x - y = s n; s > 0 is outside.

use super::vector::{Mat3, Vec3};
use crate::error::{Error, Kind, Result};
use std::fmt;

/// Points of a frame.
pub const FRAME: usize = 4;

/// A frame whose edges span less than this (volume over the product of their lengths) is refused: its coordinates would
/// lose three digits.
const SMALLEST_VOLUME: f64 = 1e-3;
/// How far a frame may be from a rigid motion of the first one, over its lengths: above the rounding of any rotation,
/// far below what is seen in a gap.
const RIGID: f64 = 1e-8;
/// A point closer than this to the centre or axis (over the radius) has no closest point: its direction is rounding.
const CENTRE: f64 = 1e-12;

/// Which surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AnalyticShape {
    /// A plane; its body lies on the side that the normal looks away from.
    Plane,
    /// A sphere; radius > 0: a ball, < 0: a cavity, the body outside `[L]`.
    Sphere(f64),
    /// A circular cylinder without ends; radius > 0: a bar, < 0: a bore, the body outside `[L]`.
    Cylinder(f64),
    /// A straight line of a model with two coordinates, which is a plane seen from its side.
    Line,
    /// A circle of such a model; radius > 0: a disc, < 0: a hole, the body outside `[L]`.
    Circle(f64),
}

impl AnalyticShape {
    /// The signed radius; 0 of a plane and of a line.
    pub fn radius(self) -> f64 {
        match self {
            AnalyticShape::Plane | AnalyticShape::Line => 0.0,
            AnalyticShape::Sphere(r) | AnalyticShape::Cylinder(r) | AnalyticShape::Circle(r) => r,
        }
    }

    /// Whether it is flat.
    fn is_flat(self) -> bool {
        matches!(self, AnalyticShape::Plane | AnalyticShape::Line)
    }

    /// Whether it is of a model with two coordinates.
    pub fn is_in_plane(self) -> bool {
        matches!(self, AnalyticShape::Line | AnalyticShape::Circle(_))
    }

    /// How many points its frame has.
    pub fn points(self) -> usize {
        if self.is_in_plane() { FRAME - 1 } else { FRAME }
    }

    /// Numbers that tell two shapes apart.
    pub fn words(self) -> [u64; 2] {
        let kind = match self {
            AnalyticShape::Plane => 0,
            AnalyticShape::Sphere(_) => 1,
            AnalyticShape::Cylinder(_) => 2,
            AnalyticShape::Line => 3,
            AnalyticShape::Circle(_) => 4,
        };
        [kind, self.radius().to_bits()]
    }
}

impl fmt::Display for AnalyticShape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (name, radius) = match *self {
            AnalyticShape::Plane => return f.write_str("a plane"),
            AnalyticShape::Line => return f.write_str("a straight line"),
            AnalyticShape::Sphere(r) => (if r < 0.0 { "a spherical cavity" } else { "a ball" }, r),
            AnalyticShape::Cylinder(r) => (if r < 0.0 { "a cylindrical bore" } else { "a round bar" }, r),
            AnalyticShape::Circle(r) => (if r < 0.0 { "a round hole" } else { "a disc" }, r),
        };
        write!(f, "{name} of radius {}", radius.abs())
    }
}

/// A shape in its place.
#[derive(Clone, Copy, Debug)]
pub struct AnalyticSurface {
    /// P0.
    pub origin: Vec3,
    shape: AnalyticShape,
    /// Direction of P1 - P0.
    axis: Vec3,
    /// What the closest point bends about: I of a sphere, I - a a^T of a cylinder, I - e_z e_z^T of a circle, 0 of a plane.
    round: Mat3,
    /// From y - P0 to the coordinates w_1..w_3.
    to_frame: Mat3,
}

/// The closest point to a point x.
#[derive(Clone, Copy, Debug)]
pub struct Closest {
    /// Unit normal n out of the surface's body.
    pub normal: Vec3,
    /// Signed distance s `[L]`.
    pub distance: f64,
    /// Of a step of x along the surface, the part that y does not make: 1 - R / |d|; 0 on a plane.
    pub lag: f64,
}

/// The frame of a line or a circle, with its fourth point: above the first one, as far as the second is.
pub fn in_plane([p0, p1, p2]: [Vec3; FRAME - 1]) -> [Vec3; FRAME] {
    [p0, p1, p2, p0 + Vec3::z() * (p1 - p0).norm()]
}

/// P_i - P0.
fn edges(frame: &[Vec3; FRAME]) -> Mat3 {
    Mat3::from_columns(&[1, 2, 3].map(|i| frame[i] - frame[0]))
}

impl AnalyticSurface {
    /// The shape where the frame says.
    ///
    /// # Errors
    /// [`Kind::InvalidValue`] when the radius or the frame is none.
    pub fn new(shape: AnalyticShape, frame: &[Vec3; FRAME]) -> Result<AnalyticSurface> {
        let radius = shape.radius();
        if !(shape.is_flat() || radius != 0.0 && radius.is_finite()) {
            let text = text!("the radius is {radius}; it must be finite and not 0");
            return Err(Error::new(Kind::InvalidValue, text));
        }
        let edges = edges(frame);
        let lengths: f64 = edges.column_iter().map(|d| d.norm()).product();
        let inverse = edges.try_inverse().filter(|_| edges.determinant().abs() > SMALLEST_VOLUME * lengths);
        let Some(to_frame) = inverse else {
            let text = match shape.is_in_plane() {
                false => {
                    "the frame has no volume: the edges from its first point to the other three must not lie in one plane"
                }
                true => {
                    "the frame has no area: the edges from its first point to the other two must not lie on one line"
                }
            };
            return Err(Error::new(Kind::InvalidValue, text));
        };
        let axis = edges.column(0).normalize();
        let round = match shape {
            AnalyticShape::Plane | AnalyticShape::Line => Mat3::zeros(),
            AnalyticShape::Sphere(_) => Mat3::identity(),
            AnalyticShape::Cylinder(_) => Mat3::identity() - axis * axis.transpose(),
            AnalyticShape::Circle(_) => Mat3::from_diagonal(&Vec3::new(1.0, 1.0, 0.0)),
        };
        Ok(AnalyticSurface { origin: frame[0], shape, axis, round, to_frame })
    }

    /// Whether closest points and distances are affine functions of x.
    pub fn is_flat(&self) -> bool {
        self.shape.is_flat()
    }

    /// What turns with the surface: a plane's normal, a cylinder's axis; nothing of a sphere or a circle.
    pub fn direction(&self) -> Option<Vec3> {
        match self.shape {
            AnalyticShape::Plane | AnalyticShape::Line | AnalyticShape::Cylinder(_) => Some(self.axis),
            AnalyticShape::Sphere(_) | AnalyticShape::Circle(_) => None,
        }
    }

    /// The signed distance of the point x, given as x - P0.
    pub fn distance(&self, x: Vec3) -> f64 {
        match self.shape {
            AnalyticShape::Plane | AnalyticShape::Line => self.axis.dot(&x),
            AnalyticShape::Sphere(r) | AnalyticShape::Cylinder(r) | AnalyticShape::Circle(r) => {
                (self.round * x).norm() * r.signum() - r
            }
        }
    }

    /// The closest point to x, given as x - P0; `None` at the centre or on the axis.
    #[inline]
    pub fn closest(&self, x: Vec3) -> Option<Closest> {
        Some(match self.shape {
            AnalyticShape::Plane | AnalyticShape::Line => {
                Closest { normal: self.axis, distance: self.axis.dot(&x), lag: 0.0 }
            }
            AnalyticShape::Sphere(r) | AnalyticShape::Cylinder(r) | AnalyticShape::Circle(r) => {
                let outward = self.round * x;
                let norm = outward.norm();
                if !(norm > CENTRE * r.abs()) {
                    return None;
                }
                let (normal, distance) = (outward * (r.signum() / norm), norm * r.signum() - r);
                Closest { normal, distance, lag: 1.0 - r.abs() / norm }
            }
        })
    }

    /// Whether the line through the point x, given as x - P0, along `e` meets the body of a ball, a bar or a disc that is
    /// thinner by `margin`. All others have no far side.
    pub fn is_met_along(&self, x: Vec3, e: Vec3, margin: f64) -> bool {
        let (r, x, e) = (self.shape.radius() - margin, self.round * x, self.round * e);
        r > 0.0 && x.cross(&e).norm_squared() < r * r * e.norm_squared()
    }

    /// Whether the surface lies over a facet about the point x, given as x - P0, with this normal: a convex one only where it
    /// is met along the normal.
    pub fn lies_over(&self, x: Vec3, e: Vec3) -> bool {
        !(self.shape.radius() > 0.0) || self.is_met_along(x, e, 0.0)
    }

    /// D(x - y)/Dx = n n^T + s Dn/Dx, symmetric.
    #[inline]
    pub fn gradient(&self, y: &Closest) -> Mat3 {
        self.round * y.lag + y.normal * y.normal.transpose() * (1.0 - y.lag)
    }

    /// The coordinates w of the point y in the frame, given as y - P0.
    #[inline]
    pub fn coordinates(&self, y: Vec3) -> [f64; FRAME] {
        let w = self.to_frame * y;
        [1.0 - w.x - w.y - w.z, w.x, w.y, w.z]
    }

    /// Their gradients, which are the same everywhere.
    pub fn coordinate_gradients(&self) -> [Vec3; FRAME] {
        let [a, b, c] = [0, 1, 2].map(|i| self.to_frame.row(i).transpose());
        [-a - b - c, a, b, c]
    }
}

/// Refuses a frame that is no rigid motion of the first one: that moved a point against the others, or was mirrored.
pub fn check_rigid_motion(first: &[Vec3; FRAME], now: &[Vec3; FRAME]) -> Result<()> {
    let (first, now) = (edges(first), edges(now));
    let lengths = [0, 1, 2].map(|i| first.column(i).norm());
    let change = now.transpose() * now - first.transpose() * first;
    let worst = (0..9).map(|k| change[(k / 3, k % 3)].abs() / (lengths[k / 3] * lengths[k % 3])).fold(0.0, f64::max);
    let mirrored = first.determinant() * now.determinant() < 0.0;
    if worst <= RIGID && !mirrored {
        return Ok(());
    }
    let how = if mirrored { "mirrored".into() } else { text!("deformed by {worst:.1e}") };
    let text = text!("the frame of the analytic surface is {how}; its points must move as a rigid body ({RIGID:.0e})");
    Err(Error::new(Kind::InvalidValue, text))
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME_POINTS: [[f64; 3]; FRAME] = [[1.0, -2.0, 0.5], [2.2, -1.0, 3.5], [0.0, 1.0, 0.0], [-1.0, -2.5, 1.0]];

    fn frame() -> [Vec3; FRAME] {
        FRAME_POINTS.map(Vec3::from)
    }

    /// The closest points, by their defining properties: on the surface, along the normal, at the distance.
    #[test]
    fn closest_points_are_on_the_surface_along_its_normal() {
        let (p, axis) = (frame(), (frame()[1] - frame()[0]).normalize());
        for (shape, body) in [
            (AnalyticShape::Plane, 1.0),
            (AnalyticShape::Sphere(2.0), 1.0),
            (AnalyticShape::Sphere(-3.0), -1.0),
            (AnalyticShape::Cylinder(1.5), 1.0),
            (AnalyticShape::Cylinder(-2.5), -1.0),
        ] {
            let surface = AnalyticSurface::new(shape, &p).unwrap();
            for x in [Vec3::new(3.0, 1.0, -2.0), Vec3::new(0.9, -1.5, 0.4), Vec3::new(-4.0, 0.0, 7.0)] {
                let x = x - p[0];
                let c = surface.closest(x).unwrap();
                let y = x - c.normal * c.distance;
                let (along, off) = (axis * axis.dot(&y), y - axis * axis.dot(&y));
                let (height, outward) = match shape {
                    AnalyticShape::Plane | AnalyticShape::Line => (axis.dot(&y), axis),
                    AnalyticShape::Sphere(r) => (y.norm() - r.abs(), y),
                    AnalyticShape::Cylinder(r) | AnalyticShape::Circle(r) => (off.norm() - r.abs(), y - along),
                };
                assert!(height.abs() < 1e-14, "{shape}: {height:e} off the surface");
                assert!((c.normal - outward.normalize() * body).norm() < 1e-14, "{shape}: normal {}", c.normal);
                assert!((surface.distance(x) - c.distance).abs() < 1e-14, "{shape}: distance");
                let w = surface.coordinates(y);
                let back = (0..FRAME).fold(Vec3::zeros(), |s, k| s + p[k] * w[k]);
                assert!((back - y - p[0]).norm() < 1e-14 && (w.iter().sum::<f64>() - 1.0).abs() < 1e-15, "{shape}");
            }
        }
    }

    /// A line and a circle are a plane and a cylinder across the plane z = 0, whose points they keep there.
    #[test]
    fn lines_and_circles_are_planes_and_cylinders_seen_along_z() {
        let p = [[1.0, -2.0, 0.0], [2.2, -1.0, 0.0], [0.0, 1.0, 0.0]].map(Vec3::from);
        let along_z = [p[0], p[0] + Vec3::z(), p[1], p[2]];
        for (shape, (of, frame)) in [
            (AnalyticShape::Line, (AnalyticShape::Plane, in_plane(p))),
            (AnalyticShape::Circle(1.5), (AnalyticShape::Cylinder(1.5), along_z)),
            (AnalyticShape::Circle(-9.0), (AnalyticShape::Cylinder(-9.0), along_z)),
        ] {
            let [flat, space] =
                [(shape, in_plane(p)), (of, frame)].map(|(shape, frame)| AnalyticSurface::new(shape, &frame).unwrap());
            for x in [Vec3::new(3.0, 1.0, 0.0), Vec3::new(0.9, -1.5, 0.0)] {
                let [c, of_space] = [flat, space].map(|surface| surface.closest(x - p[0]).unwrap());
                assert!((c.normal - of_space.normal).norm() < 1e-15 && c.normal.z == 0.0, "{shape}");
                assert!((c.distance - of_space.distance).abs() < 1e-15, "{shape}");
                let w = flat.coordinates(x - p[0] - c.normal * c.distance);
                assert!(w[3] == 0.0 && (w.iter().sum::<f64>() - 1.0).abs() < 1e-15, "{shape}: {w:?}");
            }
        }
        let on_a_line = in_plane([p[0], p[1], p[0] + (p[1] - p[0]) * 2.0]);
        let error = AnalyticSurface::new(AnalyticShape::Line, &on_a_line).unwrap_err();
        assert!(error.message.contains("the frame has no area"), "{error}");
    }

    #[test]
    fn nearly_flat_frames_are_refused() {
        let mut p = frame();
        for (height, refused) in [(1e-4, true), (1e-1, false)] {
            p[3] = p[1] + p[2] - p[0] + (p[1] - p[0]).cross(&(p[2] - p[0])).normalize() * height;
            assert_eq!(AnalyticSurface::new(AnalyticShape::Plane, &p).is_err(), refused, "height {height}");
        }
    }
}
