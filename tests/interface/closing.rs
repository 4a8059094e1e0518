//! The part of a step that may be taken: round bodies above others come to touch in a few calls, and never pass through.

use crate::support::mesh::*;
use nalgebra::Rotation3;
use stickslip::geometry::Vec3;
use stickslip::interface::{Contact, Options, Stiffness};

/// Calls after which a body that moves far enough touches: the first takes the gap, as far as it is one.
const CALLS: usize = 3;
/// How deep a node may be when it touches, over the facets' longest edge: a tenth of the shortest one is allowed.
const DEEP: f64 = 0.2;

/// Bodies above a crooked floor at any gap, in any attitude: the gap along the facets' normals closes faster than they fall
/// where the floor's facets are not parallel to theirs.
#[test]
fn a_body_that_falls_touches_in_a_few_calls_and_stays_above() {
    for seed in 1..=60 {
        let mut random = Random(seed);
        let n = 3 + (seed % 5) as usize;
        let mut one = ball(n);
        let turn = Rotation3::new(random.vector(3.0));
        let axes = Vec3::from_fn(|_, _| 1.0 + 0.3 * random.next());
        one.x.iter_mut().for_each(|x| *x = turn * x.component_mul(&axes));
        let mut two = grid(5, 4, [-2.1, -2.0], [2.0, 2.2], 0.0, true, Cells::Quads);
        two.x.iter_mut().for_each(|x| x.z += 0.03 * random.next());
        let lowest = one.x.iter().map(|x| x.z).fold(f64::INFINITY, f64::min);
        let gap = [0.05, 0.5, 2.0, 10.0][(seed % 4) as usize];
        one.x.iter_mut().for_each(|x| x.z += gap + 0.2 - lowest);
        let mut contact: Contact<1> = contact(&one, &two, true, Options::paper(Stiffness::Modulus(1.0)));
        let rest = vec![Vec3::zeros(); two.x.len()];
        let (mut x, mut calls, mut left) = (one.x.clone(), 0, gap + 0.7);
        let deepest = loop {
            let dx = vec![Vec3::z() * -left; x.len()];
            let fraction = contact.step_limit((&x, &two.x), (&dx, &rest), None).unwrap();
            x.iter_mut().for_each(|x| x.z -= fraction * left);
            left -= fraction * left;
            calls += 1;
            let sums = contact.sums(&x, &two.x).unwrap();
            let normals = contact.history().normals.clone();
            let mean = |a: usize| normals[a].dot(&sums[a].gap_now) / sums[a].coverage;
            let deepest = (0..x.len()).filter(|&a| sums[a].coverage > 1e-8).map(mean).fold(f64::INFINITY, f64::min);
            if deepest < 0.0 || calls > CALLS {
                break deepest;
            }
        };
        println!("seed {seed}, {n} facets a face, gap {gap}: {calls} calls, {deepest:.3}");
        let edge = 2.0 * 1.3 / n as f64;
        assert!(deepest < 0.0 && deepest > -DEEP * edge, "seed {seed}, gap {gap}: {deepest} after {calls} calls");
    }
}
