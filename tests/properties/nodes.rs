//! Laws of one node: the projection on the cone, and the multiplier row at and off the solution.

use super::{angles, config};
use nalgebra::Rotation3;
use proptest::prelude::*;
use stickslip::geometry::{Mat3, Vec3};
use stickslip::law::{Friction, Node, SlipMeasure, Special, State, TIE, project};

/// Rounding of a dozen operations, relative to the trial traction; times 1 + mu where the rounding of the normal part
/// moves the cone.
const ROUNDING: f64 = 1e-14;
/// S3: the projection's steepest slope is that of slip at mu, 1 + mu; a step of 1e-9 moves it by no more than this
/// times that.
const CONTINUITY: f64 = 4e-9;
/// K2: step of the differences, over |sigma|.
const STEP: f64 = 1e-6;
/// K2: rounding 1e-16 / 1e-6, truncation 1e-12 times a third derivative of 1e3 at a tenth of |sigma| from the axis;
/// both times 1 + mu.
const DIFFERENCES: f64 = 1e-8;

#[derive(Clone, Debug)]
struct Case {
    normal: Vec3,
    sigma: Vec3,
    mu: f64,
}

fn unit() -> impl Strategy<Value = Vec3> {
    [-1.0..1.0f64, -1.0..1.0, -1.0..1.0].prop_filter_map("a direction", |v| {
        let v = Vec3::from(v);
        (v.norm() > 0.1).then(|| v.normalize())
    })
}

/// sigma over many decades, some of it near the borders; mu from 0 over 1e-12 to 1e6.
fn cases() -> impl Strategy<Value = Case> {
    let mu = prop_oneof![Just(0.0), 0.0..2.0f64, (-12..=6i32).prop_map(|k| 10f64.powi(k))];
    let margin = prop_oneof![
        Just(0.0),
        (1..=16i32, any::<bool>()).prop_map(|(k, s)| 10f64.powi(-k) * if s { 1.0 } else { -1.0 })
    ];
    (unit(), unit(), unit(), mu, margin, 0..4, -70..70i32).prop_map(|(normal, s, t, mu, margin, place, size)| {
        let t = (t - normal * normal.dot(&t)).try_normalize(1e-3).unwrap_or(Vec3::zeros());
        let sigma = match place {
            // Near the border of the cone, near the border to gap, at the tip.
            1 => t * (mu * (1.0 + margin)) - normal,
            2 => t + normal * margin,
            3 => (t + s) * margin,
            _ => s,
        };
        Case { normal, sigma: sigma * 10f64.powi(size), mu }
    })
}

fn node(c: &Case, lambda: Vec3, r: f64, now: Vec3, previous: Vec3) -> Node {
    Node {
        lambda,
        normal: c.normal,
        augmentation: r,
        mu: c.mu,
        shear_limit: f64::INFINITY,
        gap_now: now,
        gap_previous: previous,
        gap_committed: Vec3::zeros(),
        covered: true,
        covered_before: true,
        slip: SlipMeasure::Paper,
        free: Mat3::identity(),
        special: Special::Nothing,
    }
}

proptest! {
    #![proptest_config(config(file!(), 1))]

    /// 4.4, 4.6: compressive, inside the cone, along the trial traction; what is inside stays.
    #[test]
    fn projection_lies_on_the_cone(c in cases()) {
        let p = project(c.sigma, c.normal, c.mu);
        let (scale, n) = (c.sigma.norm(), p.traction.dot(&c.normal));
        let tangential = p.traction - c.normal * n;
        prop_assert!(p.traction.iter().chain(p.derivative.iter()).all(|v| v.is_finite()));
        let sigma_n = c.sigma.dot(&c.normal);
        prop_assert!((n - sigma_n.min(0.0)).abs() <= ROUNDING * scale);
        prop_assert!(tangential.norm() <= -c.mu * n * (1.0 + 1e-14) + ROUNDING * scale * (1.0 + c.mu));
        let trial = c.sigma - c.normal * sigma_n;
        prop_assert!(tangential.cross(&trial).norm() <= 4.0 * ROUNDING * scale * scale, "not along the trial traction");
        prop_assert!(tangential.dot(&trial) >= -ROUNDING * scale * scale);
        // Once more changes nothing but the rounding.
        let again = project(p.traction, c.normal, c.mu);
        prop_assert!((again.traction - p.traction).norm() <= 4.0 * ROUNDING * scale * (1.0 + c.mu));
        if c.mu == 0.0 {
            prop_assert!(tangential.norm() <= ROUNDING * scale);
        }
    }

    /// 7.4, 7.5: with the frame and with the unit of stress.
    #[test]
    fn projection_is_homogeneous_and_turns_with_the_frame(c in cases(), k in -200..200i32, angles in angles()) {
        let p = project(c.sigma, c.normal, c.mu);
        let scale = 2f64.powi(k);
        let s = project(c.sigma * scale, c.normal, c.mu);
        prop_assert_eq!(p.state, s.state);
        prop_assert_eq!(p.traction * scale, s.traction);
        prop_assert_eq!(p.derivative, s.derivative);
        let q = Rotation3::from_euler_angles(angles[0], angles[1], angles[2]);
        let turned = project(q * c.sigma, q * c.normal, c.mu);
        // Beyond the borders the states may differ, the tractions not.
        prop_assert!((turned.traction - q * p.traction).norm() <= 8.0 * ROUNDING * c.sigma.norm() * (1.0 + c.mu));
    }

    /// S3, K2: continuous everywhere; its derivative is that of differences, off the borders.
    #[test]
    fn projection_is_continuous_and_differentiated(c in cases(), d in unit()) {
        let scale = c.sigma.norm();
        prop_assume!(scale > 0.0);
        let at = |h: f64| project(c.sigma + d * (h * scale), c.normal, c.mu);
        let jump = (at(1e-9).traction - at(-1e-9).traction).norm();
        prop_assert!(jump <= CONTINUITY * scale * (1.0 + c.mu), "{jump:e}");
        // Away from the axis, around which the direction of slip turns fast.
        let distance = (c.sigma - c.normal * c.sigma.dot(&c.normal)).norm();
        let (minus, plus) = (at(-STEP), at(STEP));
        if minus.state == plus.state && distance > 0.1 * scale {
            let slope = (plus.traction - minus.traction) / (2.0 * STEP * scale);
            let error = (at(0.0).derivative * d - slope).norm();
            prop_assert!(error <= DIFFERENCES * (1.0 + c.mu), "{:?} {error:e}", plus.state);
        }
    }

    /// S4, 4.4: the row vanishes exactly at Coulomb's conditions, whatever the augmentation; and nowhere else.
    #[test]
    fn row_vanishes_at_the_solution_whatever_r(c in cases(), k in -6..=6, slid in 1e-3..1.0, off in unit()) {
        let r = 10f64.powi(k);
        let c = Case { sigma: c.sigma / c.sigma.norm().max(f64::MIN_POSITIVE), ..c };
        let p = project(c.sigma, c.normal, c.mu);
        let lambda = p.traction;
        let (n, tangential) = (lambda.dot(&c.normal), p.tangential);
        let (now, previous) = match p.state {
            State::Gap => (c.normal * slid, Vec3::zeros()),
            State::Stick => (Vec3::zeros(), Vec3::zeros()),
            State::Slip => (Vec3::zeros(), tangential.try_normalize(1e-300).unwrap_or(Vec3::zeros()) * slid),
        };
        let response = Friction::Coulomb.respond(&node(&c, lambda, r, now, previous));
        // A multiplier within the tie of the cone counts as on it.
        let rounding = (8.0 * ROUNDING * (1.0 + c.mu) + TIE) * (lambda.norm() / r + slid);
        prop_assert!(response.row.norm() <= rounding, "{:?} {:e}", p.state, response.row.norm());
        prop_assert!((response.traction - lambda).norm() <= rounding * r);
        // c = (p - lambda) / r always, and it tells every other multiplier.
        let wrong = Friction::Coulomb.respond(&node(&c, lambda + off * 0.5, r, now, previous));
        let row = (wrong.traction - lambda - off * 0.5) / r;
        prop_assert!((wrong.row - row).norm() <= 8.0 * ROUNDING * ((1.0 + lambda.norm()) / r + slid) * (1.0 + c.mu));
        // At a gap and in slip beyond it the multiplier is determined by the law; in stick by the displacements.
        if p.state == State::Gap {
            prop_assert!(wrong.row.norm() > 0.0);
        }
        prop_assert!(n <= ROUNDING);
    }

    /// docs/formulation 6.3: an uncovered node is in gap whatever its multiplier.
    #[test]
    fn uncovered_nodes_are_open(c in cases(), g in unit()) {
        let n = Node { covered: false, ..node(&c, c.sigma, 2.0, g, g) };
        let response = Friction::Coulomb.respond(&n);
        prop_assert_eq!(response.state, State::Gap);
        prop_assert_eq!(response.traction, Vec3::zeros());
        prop_assert_eq!(response.row, -c.sigma / 2.0);
    }
}
