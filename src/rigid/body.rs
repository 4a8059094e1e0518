//! A rigid body: where a motion puts its nodes, and what their forces are at the reference point (docs/formulation 14.1,
//! 14.3).

use super::rotation::{check_rotation, cross, rotation, spin};
use crate::error::{Error, Kind, Result};
use crate::geometry::Vec3;
use nalgebra::Matrix3;
use std::f64::consts::PI;

/// Which arms forces have about the reference point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Levers {
    /// Those of the motion, rho (R4).
    #[default]
    End,
    /// The means of those at t_n and of the motion, (R (X - P) + rho) / 2 (R8).
    Middle,
}

/// A motion since the first configuration: x = P + u + exp `[theta]` R (X - P) (R1).
#[derive(Clone, Copy, Debug)]
pub struct Motion {
    /// u, of the reference point `[L]`.
    displacement: Vec3,
    /// exp `[theta]` R.
    rotation: Matrix3<f64>,
    /// H(theta).
    spin: Matrix3<f64>,
    /// What takes X - P to the arm that a force has; how much of it turns with theta.
    lever: Matrix3<f64>,
    turning: f64,
}

impl Motion {
    /// Of these. `turned`: R; zeros alone: the identity.
    pub fn new(displacement: Vec3, theta: Vec3, turned: Matrix3<f64>, levers: Levers) -> Result<Motion> {
        if theta.norm() > PI {
            let text = text!(
                "motion.rotation has the length {:.3}; at most pi is allowed: within Newton's method the iterate has run away, so take a smaller step; between steps take what the body has turned by into turned (stickslip_rigid_turn)",
                theta.norm()
            );
            return Err(Error::new(Kind::InvalidValue, text));
        }
        let turned = if turned == Matrix3::zeros() { Matrix3::identity() } else { turned };
        check_rotation(&turned, "motion.turned")?;
        let rotation = rotation(&theta) * turned;
        Ok(Motion { displacement, rotation, spin: spin(&theta), lever: rotation, turning: 1.0 }.with(levers, &turned))
    }

    fn with(self, levers: Levers, turned: &Matrix3<f64>) -> Motion {
        match levers {
            Levers::End => self,
            Levers::Middle => Motion { lever: (turned + self.rotation) * 0.5, turning: 0.5, ..self },
        }
    }

    /// H: the spin of the body is H d theta.
    pub fn spin(&self) -> &Matrix3<f64> {
        &self.spin
    }

    /// rho = exp `[theta]` R (X - P), the arm of a node.
    #[inline]
    pub fn arm(&self, arm: &Vec3) -> Vec3 {
        self.rotation * arm
    }

    /// The arm that a force at a node has.
    #[inline]
    pub fn lever(&self, arm: &Vec3) -> Vec3 {
        self.lever * arm
    }

    /// What of the lever of a node turns with the body: its derivative is w x this, with the spin w.
    #[inline]
    pub fn turning(&self, arm: &Vec3) -> Vec3 {
        self.rotation * arm * self.turning
    }
}

/// A body's nodes from its reference point in the first configuration, X - P.
#[derive(Debug)]
pub struct Body<'a> {
    /// P.
    pub point: Vec3,
    /// X, node by node, `dimension` numbers each.
    pub coordinates: &'a [f64],
    /// 3, or 2 of plane and axisymmetric models.
    pub dimension: usize,
}

impl Body<'_> {
    /// X - P of each node.
    pub fn arms(&self) -> impl Iterator<Item = Vec3> {
        self.coordinates.chunks_exact(self.dimension).map(|x| in_space(x) - self.point)
    }

    /// x of each node (R1).
    pub fn positions(&self, motion: &Motion) -> impl Iterator<Item = Vec3> {
        self.arms().map(|arm| self.point + motion.displacement + motion.arm(&arm))
    }

    /// Force and moment about the reference point of nodal forces (R4), by the arms that the motion gives them (R8).
    pub fn resultant(&self, motion: &Motion, forces: &[f64]) -> [Vec3; 2] {
        let forces = forces.chunks_exact(self.dimension).map(in_space);
        self.arms()
            .zip(forces)
            .fold([Vec3::zeros(); 2], |[force, moment], (arm, f)| [force + f, moment + motion.lever(&arm).cross(&f)])
    }
}

/// A vector of two or three numbers.
pub fn in_space(v: &[f64]) -> Vec3 {
    Vec3::new(v[0], v[1], v.get(2).copied().unwrap_or(0.0))
}

/// What the moment of a force f on an arm rho gains where the body turns by a small rotation w: (w x rho) x f = `[f]` `[rho]` w
/// (R6).
#[inline]
pub fn turn_of_moment(arm: &Vec3, force: &Vec3) -> Matrix3<f64> {
    cross(force) * cross(arm)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn motion(theta: Vec3) -> Motion {
        with_levers(theta, Levers::End)
    }

    fn with_levers(theta: Vec3, levers: Levers) -> Motion {
        Motion::new(Vec3::new(0.1, 0.2, 0.3), theta, rotation(&Vec3::new(0.5, -1.0, 0.2)), levers).unwrap()
    }

    #[test]
    fn the_moment_turns_as_its_derivative_says() {
        let (body, f) = (Body { point: Vec3::x(), coordinates: &[1.0, 2.0, -3.0], dimension: 3 }, [0.3, -2.0, 0.7]);
        let theta = Vec3::new(-0.4, 0.9, 0.3);
        for levers in [Levers::End, Levers::Middle] {
            let moment = |theta: Vec3| body.resultant(&with_levers(theta, levers), &f)[1];
            let here = with_levers(theta, levers);
            let arm = here.turning(&body.arms().next().unwrap());
            let expected = turn_of_moment(&arm, &in_space(&f)) * here.spin();
            for j in 0..3 {
                let h = 1e-3;
                let at = |k: f64| moment(theta + Vec3::ith(j, k * h));
                let d = (at(-2.0) - at(2.0) + (at(1.0) - at(-1.0)) * 8.0) / (12.0 * h);
                assert!((d - expected.column(j)).amax() < 1e-11);
            }
        }
    }

    /// (R9): what the dynamics of a rigid body rest on.
    #[test]
    fn with_arms_of_the_middle_the_resultant_does_the_work_of_the_forces() {
        let x = [1.0, 2.0, -3.0, 0.5, 0.25, 4.0];
        let (body, forces) =
            (Body { point: Vec3::x(), coordinates: &x, dimension: 3 }, [0.3, -2.0, 0.7, 1.1, 0.4, -0.9]);
        for length in [1e-3, 0.5, 2.0, 3.0] {
            let theta = Vec3::new(0.36, -0.48, 0.8) * length;
            let (start, end) = (motion(Vec3::zeros()), with_levers(theta, Levers::Middle));
            let moved = body.positions(&end).zip(body.positions(&start)).map(|(x, x_n)| x - x_n);
            let work: f64 = moved.zip(forces.chunks_exact(3)).map(|(u, f)| u.dot(&in_space(f))).sum();
            let [_, moment] = body.resultant(&end, &forces);
            let way = theta * (2.0 * (0.5 * length).tan() / length);
            assert!((way.dot(&moment) - work).abs() < 1e-14 * (1.0 + way.norm() * moment.norm()), "{length}");
        }
    }

    #[test]
    fn a_body_at_rest_is_where_it_was_and_a_turned_one_keeps_its_shape() {
        let x = [1.0, 2.0, -3.0, 0.5, 0.25, 4.0];
        let body = Body { point: Vec3::zeros(), coordinates: &x, dimension: 3 };
        let rest = Motion::new(Vec3::zeros(), Vec3::zeros(), Matrix3::zeros(), Levers::Middle).unwrap();
        assert!(body.positions(&rest).flat_map(|x| [x.x, x.y, x.z]).eq(x));
        let now: Vec<_> = body.positions(&motion(Vec3::new(1.0, 1.0, -2.0))).collect();
        let length = |a: Vec3, b: Vec3| (a - b).norm();
        assert!((length(now[0], now[1]) - length(in_space(&x[..3]), in_space(&x[3..]))).abs() < 1e-14);
    }

    #[test]
    fn more_than_half_a_turn_at_once_is_refused() {
        let refused = Motion::new(Vec3::zeros(), Vec3::new(0.0, 3.2, 0.0), Matrix3::zeros(), Levers::End);
        assert_eq!(refused.unwrap_err().kind, Kind::InvalidValue);
    }
}
