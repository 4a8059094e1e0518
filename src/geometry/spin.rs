//! How far the nodes of a facet have turned about its normal: what is left of their motion when the shortest turn has taken the old
//! normal onto the new one, best in the sense of least squares. It is an angle, kept as its cosine and its sine.

use super::vector::Vec3;

/// Below this 1 + e . e' the two normals are opposite, and there is no shortest turn between them.
const OPPOSITE: f64 = 1e-6;

/// A turn about a unit normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spin {
    normal: Vec3,
    cosine: f64,
    sine: f64,
}

impl Spin {
    /// That of nodes which were at `before`, on a facet with the unit normal e, and are at `now`, on one with e'. None where the normals
    /// are opposite or the nodes are at one place.
    #[inline(never)] // tractions of points and the limit of a step ask for it
    pub fn of(before: &[Vec3], e: Vec3, now: &[Vec3], normal: Vec3) -> Spin {
        let none = Spin { normal, cosine: 1.0, sine: 0.0 };
        let (axis, c) = (e.cross(&normal), e.dot(&normal));
        if before.is_empty() || 1.0 + c < OPPOSITE {
            return none;
        }
        let onto = |v: Vec3| v * c + axis.cross(&v) + axis * (axis.dot(&v) / (1.0 + c));
        let mean = |x: &[Vec3]| x.iter().sum::<Vec3>() / x.len() as f64;
        let (middle, center) = (mean(before), mean(now));
        let (mut cosine, mut sine) = (0.0, 0.0);
        for (x, y) in before.iter().zip(now) {
            let (from, to) = (onto(x - middle), y - center);
            let from = from - normal * normal.dot(&from);
            cosine += from.dot(&to);
            sine += normal.dot(&from.cross(&to));
        }
        let length = cosine.hypot(sine);
        if length > 0.0 { Spin { normal, cosine: cosine / length, sine: sine / length } } else { none }
    }

    /// By how much, in radians, without its sign.
    pub fn angle(&self) -> f64 {
        self.sine.abs().atan2(self.cosine)
    }

    /// A vector in the plane of the new normal, turned.
    pub fn turn(&self, v: Vec3) -> Vec3 {
        v * self.cosine + self.normal.cross(&v) * self.sine
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Rotation3, Unit};

    /// Rounding of some dozen products of numbers of size 1.
    const ROUNDING: f64 = 1e-14;
    const SQUARE: [[f64; 3]; 4] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]];

    #[test]
    fn a_rigid_turn_is_taken_apart_into_tilt_and_spin() {
        let x = SQUARE.map(Vec3::from);
        for (angle, about) in
            [(0.0, [0.0, 0.0, 1.0]), (0.7, [0.0, 0.0, 1.0]), (2.5, [0.0, 0.0, 1.0]), (0.4, [0.6, 0.8, 0.0])]
        {
            for tilt in [0.0, 0.3] {
                let spin = Rotation3::from_axis_angle(&Unit::new_normalize(Vec3::from(about)), angle);
                let tilted = Rotation3::from_axis_angle(&Unit::new_normalize(Vec3::new(0.3, -0.5, 0.0)), tilt);
                let turn = tilted * spin;
                let (now, normal) = (x.map(|x| turn * x + Vec3::new(3.0, 1.0, 2.0)), turn * Vec3::z());
                // Any vector fixed to the facet goes where the shortest turn and the spin take it.
                let (e, v) = (Vec3::z(), Vec3::new(0.2, -0.9, 0.0));
                let shortest = Rotation3::rotation_between(&e, &normal).unwrap();
                let found = Spin::of(&x, e, &now, normal).turn(shortest * v);
                assert!((found - turn * v).amax() <= ROUNDING, "{angle} {about:?} {tilt}: {found}");
            }
        }
    }

    #[test]
    fn what_is_at_rest_keeps_its_bits() {
        let x = SQUARE.map(|x| Vec3::from(x) * 0.37 + Vec3::new(0.1, 0.7, -0.3));
        let v = Vec3::new(0.1, 0.3, 0.0);
        assert_eq!(Spin::of(&x, Vec3::z(), &x, Vec3::z()).turn(v), v);
        // Lines of a plane model turn about the third axis alone, never about their own normals.
        let (one, two) = ([[0.0; 3], [1.0, 0.0, 0.0]].map(Vec3::from), [[0.0; 3], [0.8, 0.6, 0.0]].map(Vec3::from));
        let normal = Vec3::new(-0.6, 0.8, 0.0);
        let v = Vec3::new(0.8, 0.6, 0.0);
        assert!((Spin::of(&one, Vec3::y(), &two, normal).turn(v) - v).amax() <= ROUNDING);
        assert_eq!(Spin::of(&x, Vec3::z(), &x, -Vec3::z()).turn(v), v, "opposite normals");
    }
}
