//! Friction that weakens with the velocity of slip: from mu, the coefficient of rest, down to another one.
//!
//! k = -sigma_N (after + (mu - after) exp(-v / v_c)),   v = |slip of the step| / dt

use super::projection::Threshold;
use super::question::{Answer, Question};
use crate::geometry::Vec3;

/// The threshold at a node; after: the coefficient of fast slip; critical: v_c dt, a length.
pub fn answer((after, critical): (f64, f64), question: &Question) -> Answer {
    let step = question.slip.norm();
    let left = (question.mu - after) * (-step / critical).exp();
    let slope: Vec3 = question.along() * (question.normal * left / critical);
    Answer { threshold: Threshold::cone(after + left, question.normal), slope }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Central differences with a step of 1e-6 of numbers near 1.
    const DIFFERENCES: f64 = 1e-9;

    fn at(slip: Vec3, normal: f64) -> Answer {
        let (slip_before, direction, states) = (Vec3::zeros(), Vec3::x(), &[][..]);
        answer((0.2, 0.3), &Question { node: 0, normal, slip, slip_before, direction, mu: 0.6, states })
    }

    #[test]
    fn it_goes_from_one_coefficient_to_the_other() {
        assert_eq!(at(Vec3::zeros(), -2.0).threshold.radius, 1.2);
        assert!((at(Vec3::y() * 0.3, -2.0).threshold.radius - 2.0 * (0.2 + 0.4 / 1.0_f64.exp())).abs() < 1e-15);
        assert!((at(Vec3::y() * 90.0, -2.0).threshold.radius - 0.4).abs() < 1e-15);
    }

    #[test]
    fn derivatives_equal_differences() {
        const STEP: f64 = 1e-6;
        let (slip, normal) = (Vec3::new(0.1, -0.05, 0.02), -2.0);
        let k = at(slip, normal);
        let value = |slip: Vec3, normal: f64| at(slip, normal).threshold.radius;
        let along = (value(slip, normal + STEP) - value(slip, normal - STEP)) / (2.0 * STEP);
        assert!((along + k.threshold.fall).abs() <= DIFFERENCES);
        for i in 0..3 {
            let step = Vec3::ith(i, STEP);
            let slope = (value(slip + step, normal) - value(slip - step, normal)) / (2.0 * STEP);
            assert!((slope - k.slope[i]).abs() <= DIFFERENCES, "{slope} {}", k.slope[i]);
        }
    }
}
