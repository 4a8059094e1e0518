//! Friction that follows the rate of slip (docs/formulation 4.8): steady sliding, and a mass on a spring that sticks and slips.

use super::layer::{Springs, face, with};
use stickslip::geometry::Vec3;
use stickslip::interface::{MultiplierBasis, Options};
use stickslip::law::{Own, State};

const REST: f64 = 0.5;
const FAST: f64 = 0.2;
const PRESSURE: f64 = 3.0;
/// Of the velocity, in the fourth step: the springs give way as their force falls.
const STEADY: f64 = 0.05;
/// Sums of a dozen products.
const ROUNDING: f64 = 1e-11;

/// A face that is pressed by soft springs, so that it stays under the pressure, without a layer.
fn pressed(options: Options) -> Springs {
    let mut s = Springs::new(&face(0.0), Vec3::repeat(1.0), options, super::layer::worn());
    s.contact.set_layer(None).unwrap();
    s.held.iter_mut().for_each(|x| x.z = -PRESSURE);
    s
}

#[test]
fn steady_sliding_bears_the_coefficient_of_its_velocity() {
    let (rate, time) = (0.4, 0.05);
    for velocity in [0.1, 0.4, 2.0] {
        let mut s = pressed(with(MultiplierBasis::Dual, REST));
        s.stiffness = Vec3::new(1e3, 1e3, 1.0);
        s.contact.set_law(Some(Own::Rate { after: FAST, rate, time })).unwrap();
        s.solve();
        s.commit();
        s.held.iter_mut().for_each(|x| x.x += REST * PRESSURE / s.stiffness.x);
        for step in 0..4 {
            s.held.iter_mut().for_each(|x| x.x += velocity * time);
            s.solve();
            let sums = s.contact.evaluate(&s.x1, &s.x2, &s.lambda, None).unwrap();
            for (a, lambda) in s.lambda.iter().enumerate() {
                let v = sums.1[a].slip.norm() / sums.0[a].coverage_previous / time;
                let mu = FAST + (REST - FAST) * (-v / rate).exp();
                if sums.1[a].state == State::Slip {
                    assert!((lambda.x + mu * lambda.z).abs() <= ROUNDING, "{velocity} {v} {lambda}");
                }
                assert!(step < 3 || (v / velocity - 1.0).abs() <= STEADY, "{velocity} {v}");
            }
            s.commit();
        }
    }
}

/// A mass on a spring whose end is drawn slowly: it sticks until the spring bears the friction of rest, and then slips by
/// 2 (mu - mu_after) N / k within half a period. With a rate that is small beside those of the slip, and a step in which inertia holds the fall.
#[test]
fn a_mass_on_a_spring_sticks_and_slips() {
    const PART: f64 = 0.01;
    /// Of 1.8: begun a twentieth of a second before.
    const BEGUN: f64 = 1e-3;
    let (stiffness, mass, drawn) = (1.0, 1.0, 5e-4);
    let (rate, time) = (0.03, 0.05);
    let mut s = pressed(with(MultiplierBasis::Dual, REST));
    s.contact.set_law(Some(Own::Rate { after: FAST, rate, time })).unwrap();
    let inertia = 4.0 * mass / (time * time);
    s.stiffness = Vec3::new(stiffness + inertia, 1.0, 1.0);
    let rest = s.held.clone();
    // The spring is stretched to just below the friction of rest.
    let mut end = REST * PRESSURE / stiffness - 2.0 * drawn * time;
    let (mut u, mut v, mut a) = (0.0, 0.0, 0.0);
    let (mut first, mut slipped, mut ended) = (None, 0.0, None);
    for step in 0..150 {
        end += drawn * time;
        let ahead = u + time * v + 0.25 * time * time * a;
        let held = (stiffness * end + inertia * ahead) / (stiffness + inertia);
        s.held.iter_mut().zip(&rest).for_each(|(x, rest)| x.x = rest.x + held);
        s.solve();
        let now = s.x1[4].x - rest[4].x;
        let acceleration = 4.0 / (time * time) * (now - ahead);
        v += 0.5 * time * (a + acceleration);
        (u, a) = (now, acceleration);
        s.commit();
        if first.is_none() && u > BEGUN {
            first = Some(step);
        }
        if let (Some(first), None) = (first, ended) {
            slipped = u;
            if step > first + 20 && v <= 0.0 {
                ended = Some(step);
            }
        }
    }
    let expected = 2.0 * (REST - FAST) * PRESSURE / stiffness;
    assert!((slipped / expected - 1.0).abs() <= PART, "{slipped} {expected}");
    let half = (ended.unwrap() - first.unwrap()) as f64 * time;
    let period = std::f64::consts::PI * (mass / stiffness).sqrt();
    assert!((half / period - 1.0).abs() <= 2.0 * PART, "{half} {period}");
}
