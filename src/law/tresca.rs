//! Coulomb's law up to a limit of the shear traction: k = min(-mu sigma_N, limit). Metal that is pressed hard yields below
//! its surface before the surface slips; Tresca's friction is the part where the limit decides.

use super::cone::Cone;
use super::node::Node;
use super::projection::Threshold;

/// Slips at mu times the pressure, or at the limit if that is less.
#[derive(Clone, Copy, Debug)]
pub struct Tresca;

impl Cone for Tresca {
    fn threshold(node: &Node, sigma_n: f64) -> Threshold {
        Threshold::up_to(node.shear_limit, node.mu, sigma_n)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Mat3, Vec3};
    use crate::law::{Coulomb, Law, Measure, NodeResponse, SlipMeasure, Special, State};

    const MU: f64 = 0.5;
    const LIMIT: f64 = 2.0;
    /// Central differences with a step of 1e-6 of numbers near 1.
    const DIFFERENCES: f64 = 1e-9;
    /// Rounding of a handful of operations.
    const ROUNDING: f64 = 1e-14;

    /// A covered node with these multiplier and gaps.
    fn node(lambda: Vec3, gap_now: Vec3, gap_previous: Vec3) -> Node {
        Node {
            lambda,
            normal: Vec3::new(0.6, 0.0, 0.8),
            augmentation: 3.0,
            mu: MU,
            shear_limit: LIMIT,
            gap_now,
            gap_previous,
            gap_committed: Vec3::zeros(),
            covered: true,
            covered_before: true,
            slip: SlipMeasure::Objective,
            free: Mat3::identity(),
            special: Special::Nothing,
        }
    }

    /// With this normal and tangential traction, the latter along a fixed direction, and small gaps.
    fn loaded(normal: f64, tangential: f64) -> Node {
        let (nu, t) = (Vec3::new(0.6, 0.0, 0.8), Vec3::new(-0.64, 0.6, 0.48));
        node(nu * normal + t * tangential, Vec3::new(0.01, -0.02, 0.003), Vec3::new(-0.004, 0.01, 0.02))
    }

    /// Above, at and below the pressure at which the limit takes over (4), sticking and slipping.
    const LOADS: [(f64, f64, State); 5] = [
        (-2.0, 0.5, State::Stick),
        (-2.0, 3.0, State::Slip),
        (-9.0, 1.5, State::Stick),
        (-9.0, 3.0, State::Slip),
        (1.0, 3.0, State::Gap),
    ];

    #[test]
    fn the_shear_is_the_lesser_of_both_bounds() {
        for (normal, tangential, state) in LOADS {
            let node = loaded(normal, tangential);
            let r = Tresca::respond(&node);
            assert_eq!(r.state, state, "{normal} {tangential}");
            let (shear, p) =
                ((r.traction - node.normal * r.traction.dot(&node.normal)).norm(), -r.traction.dot(&node.normal));
            let bound = (MU * p).min(LIMIT);
            match state {
                State::Slip => assert!((shear - bound).abs() <= ROUNDING * 10.0, "{shear} {bound}"),
                _ => assert!(shear <= bound),
            }
        }
    }

    #[test]
    fn every_derivative_equals_differences() {
        const STEP: f64 = 1e-6;
        for (normal, tangential, _) in LOADS {
            let at = loaded(normal, tangential);
            let r = Tresca::respond(&at);
            for k in 0..3 {
                let step = Vec3::ith(k, STEP);
                let slope = |change: &dyn Fn(&mut Node, Vec3)| {
                    let [ahead, behind] = [step, -step].map(|h| {
                        let mut node = at;
                        change(&mut node, h);
                        Tresca::respond(&node)
                    });
                    let of = |f: fn(&NodeResponse) -> Vec3| (f(&ahead) - f(&behind)) / (2.0 * STEP);
                    (of(|r| r.traction), of(|r| r.row))
                };
                let near = |a: Vec3, b: Vec3| assert!((a - b).amax() <= DIFFERENCES, "{normal} {tangential}: {a} {b}");
                let (traction, row) = slope(&|n, h| n.lambda += h);
                near(traction, r.dp_dlambda.column(k).into());
                near(row, r.drow_dlambda.column(k).into());
                let (traction, row) = slope(&|n, h| n.gap_now += h);
                near(traction, r.drow_dnow.column(k) * at.augmentation);
                near(row, r.drow_dnow.column(k).into());
                let (traction, row) = slope(&|n, h| n.gap_previous += h);
                near(traction, r.drow_dprevious.column(k) * at.augmentation);
                near(row, r.drow_dprevious.column(k).into());
            }
        }
    }

    #[test]
    fn with_a_limit_that_nothing_exceeds_it_is_coulombs_law() {
        for (normal, tangential, _) in LOADS {
            let node = Node { shear_limit: f64::INFINITY, ..loaded(normal, tangential) };
            let (a, b) = (Tresca::respond(&node), Coulomb::respond(&node));
            assert_eq!((a.state, a.traction, a.row), (b.state, b.traction, b.row));
            assert_eq!((a.dp_dlambda, a.drow_dnow, a.drow_dprevious), (b.dp_dlambda, b.drow_dnow, b.drow_dprevious));
        }
    }

    #[test]
    fn a_node_on_the_limit_is_in_equilibrium_and_one_beyond_it_is_not() {
        let measure = Measure {
            coverage: 1.0,
            coverage_previous: 1.0,
            stiffness: 1.0,
            rounding: 1e-14,
            traction_rounding: 1e-14,
        };
        let (nu, t) = (Vec3::new(0.6, 0.0, 0.8), Vec3::y());
        let beyond =
            |shear: f64| Tresca::violation(&node(nu * -9.0 + t * shear, Vec3::zeros(), Vec3::zeros()), &measure);
        assert_eq!(beyond(LIMIT).traction, 0.0);
        assert!((beyond(LIMIT + 0.25).traction - 0.25).abs() <= ROUNDING);
    }
}
