//! Coulomb's law up to a shear limit: the tangent is exact whether mu or the limit decides, and a block that is dragged
//! over another is held by the lesser of the two at each node.

use super::*;
use crate::support::differences::Point;
use crate::support::host::{Body, Host};
use stickslip::interface::Friction;
use stickslip::law::{NodeResponse, State};

/// The tangent against differences, relative to the largest entry of the block.
const DIFFERENCES: f64 = 1e-7;
/// Shear of a converged answer over its bound: Newton's method stops at 1e-13 of the unknowns.
const CONVERGED: f64 = 1e-9;
/// Of `moved`, whose nodes slip at shears of some tenths.
const LIMIT: f64 = 0.2;
const YOUNG: f64 = 100.0;

fn limited(limit: f64, of: Options) -> Options {
    Options { friction: Friction::Tresca, shear_limit: Some(limit), ..of }
}

/// Pressure and shear of a slipping node.
fn parts(r: &NodeResponse, normal: &Vec3) -> (f64, f64) {
    let n = r.traction.dot(normal);
    (-n, (r.traction - normal * n).norm())
}

#[test]
fn the_tangent_equals_differences_where_mu_decides_and_where_the_limit_does() {
    let mut decides = [0; 2];
    for options in variants(options()) {
        for seed in 1..4 {
            let mut t = moved(&limited(LIMIT, options), CELLS[2], ROUGH, seed);
            let responses = t.interface.responses(&t.x1, &t.x2, &t.lambda, None).unwrap();
            for (a, r) in responses.iter().enumerate().filter(|(_, r)| r.state == State::Slip) {
                let normal = t.interface.normal(a).unwrap();
                decides[usize::from(options.mu * parts(r, &normal).0 > LIMIT)] += 1;
            }
            let mut at = Point { contact: &mut t.interface, x1: &t.x1, x2: &t.x2, lambda: &t.lambda };
            let error = at.difference_error(0.0);
            assert!(error <= DIFFERENCES, "{options:?}: off by {error:e}");
        }
    }
    assert!(decides[0] > 5 && decides[1] > 5, "{decides:?}");
}

#[test]
fn a_limit_that_nothing_reaches_changes_no_bit() {
    for options in variants(options()) {
        let scene = moved(&options, CELLS[1], ROUGH, 3);
        let mut one: Contact<3> = again(&scene, false, limited(1e30, options));
        let mut two: Contact<3> = again(&scene, false, options);
        let at = (&scene.x1[..], &scene.x2[..], &scene.lambda[..]);
        let (a, b) = [&mut one, &mut two].map(|c| c.residual(at.0, at.1, at.2, None).unwrap()).into();
        assert_eq!(bits(&a), bits(&b));
        assert!(entries(&mut one, at) == entries(&mut two, at));
    }
}

/// The end that is pressed harder slips at the limit, the other one at mu times its pressure.
#[test]
fn a_dragged_block_is_held_by_the_lesser_bound_at_each_node() {
    const MU: f64 = 0.5;
    const SHEAR: f64 = 0.6;
    let upper = Body::new(grid(4, 2, [0.0, 0.0], [2.0, 1.0], 0.0, false, Cells::Quads), Vec3::z() * 0.5, YOUNG, 0.3);
    let floor = grid(5, 3, [-0.5, -0.3], [3.0, 1.3], 0.0, true, Cells::Quads);
    let of = Options { mu: MU, ..Options::paper(stickslip::interface::Stiffness::Modulus(YOUNG)) };
    let mut host = Host::<3>::new(upper, Err(floor), limited(SHEAR, of));
    for step in 0..3 {
        let slide = 0.02 * f64::from(step);
        host.hold(0, |x| Vec3::new(slide, 0.0, -0.002 - 0.004 * x.x));
        if step > 0 {
            host.commit();
        }
        host.solve();
    }
    let (x1, x2) = host.positions();
    let responses = host.contact.responses(&x1, &x2, &host.lambda, None).unwrap();
    let mut decides = [0; 2];
    for (a, r) in responses.iter().enumerate() {
        let (pressure, shear) = parts(r, &host.contact.normal(a).unwrap());
        let bound = (MU * pressure).min(SHEAR);
        decides[usize::from(MU * pressure > SHEAR)] += 1;
        assert!((shear - bound).abs() <= CONVERGED * SHEAR, "{shear} at {pressure}");
    }
    assert!(decides[0] >= 3 && decides[1] >= 3, "{decides:?}");
}
