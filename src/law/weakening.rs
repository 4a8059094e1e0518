//! Friction that weakens with slip: from mu, the coefficient of rest, the coefficient goes down in proportion to the way D that
//! the node has slipped, to another one at the critical slip, and stays there (Ida 1972).
//!
//! k = -sigma_N (after + (mu - after) max(0, 1 - D / critical)),   D = D(t_n) + |slip of the step|

use super::projection::Threshold;
use super::question::{Answer, Question};
use crate::geometry::Vec3;

/// The threshold at a node, which remembers D; after: the coefficient from the critical slip on.
pub fn answer((after, critical): (f64, f64), question: &Question, states: &mut [f64]) -> Answer {
    let step = question.slip.norm();
    let way = question.states[0] + step;
    states[0] = way;
    let (left, falls) = (1.0 - way / critical, way < critical);
    let mu = after + (question.mu - after) * if falls { left } else { 0.0 };
    let slope =
        if falls { question.along() * (question.normal * (question.mu - after) / critical) } else { Vec3::zeros() };
    Answer { threshold: Threshold::cone(mu, question.normal), slope }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Central differences with a step of 1e-6 of numbers near 1.
    const DIFFERENCES: f64 = 1e-9;
    const LAW: (f64, f64) = (0.2, 0.5);

    fn at(slip: Vec3, normal: f64, way: f64) -> (Answer, f64) {
        let states = [way];
        let direction = Vec3::x();
        let (slip_before, mu) = (Vec3::zeros(), 0.6);
        let mut after = [0.0];
        let question = Question { node: 0, normal, slip, slip_before, direction, mu, states: &states };
        (answer(LAW, &question, &mut after), after[0])
    }

    #[test]
    fn it_goes_from_one_coefficient_to_the_other() {
        let k = |slip: f64, way: f64| at(Vec3::y() * slip, -2.0, way).0.threshold.radius;
        assert_eq!(k(0.0, 0.0), 1.2);
        assert!((k(0.125, 0.125) - 2.0 * 0.4).abs() < 1e-15);
        assert_eq!((k(0.4, 0.1), k(9.0, 0.0), k(0.0, 0.6)), (0.4, 0.4, 0.4));
        assert_eq!(at(Vec3::y() * -0.3, -1.0, 0.1).1, 0.4);
    }

    #[test]
    fn derivatives_equal_differences() {
        const STEP: f64 = 1e-6;
        for (slip, normal, way) in [
            (Vec3::new(0.1, -0.05, 0.02), -2.0, 0.1),
            (Vec3::new(0.1, -0.05, 0.02), -0.7, 0.0),
            (Vec3::new(0.4, -0.5, 0.2), -2.0, 0.1),
        ] {
            let (k, _) = at(slip, normal, way);
            let value = |slip: Vec3, normal: f64| at(slip, normal, way).0.threshold.radius;
            let along = (value(slip, normal + STEP) - value(slip, normal - STEP)) / (2.0 * STEP);
            assert!((along + k.threshold.fall).abs() <= DIFFERENCES);
            for i in 0..3 {
                let step = Vec3::ith(i, STEP);
                let slope = (value(slip + step, normal) - value(slip - step, normal)) / (2.0 * STEP);
                assert!((slope - k.slope[i]).abs() <= DIFFERENCES, "{slope} {}", k.slope[i]);
            }
        }
    }
}
