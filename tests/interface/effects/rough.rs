//! Rough surfaces against Coulomb's with a coefficient that nothing exceeds: the same to the last bit.

use super::*;
use stickslip::interface::{Friction, NewContact};
use stickslip::law::{SlipMeasure, State};

/// Above any ratio of tractions that occurs.
const HUGE: f64 = 1e30;

fn rough(of: Options) -> Options {
    Options { friction: Friction::Rough, mu: 0.0, ..of }
}

#[test]
fn it_equals_friction_without_limit() {
    let mut seen = [0; 3];
    for options in variants(options()) {
        for (slip, cells) in [SlipMeasure::Objective, SlipMeasure::Increment, SlipMeasure::Paper].into_iter().zip(CELLS)
        {
            let scene = moved(&options, cells, ROUGH, 3);
            let mut one: Contact<3> = again(&scene, false, rough(Options { slip, ..options }));
            let mut two: Contact<3> = again(&scene, false, Options { mu: HUGE, slip, ..options });
            let (mut x1, x2, lambda) = (scene.x1, scene.x2, scene.lambda);
            for _ in 0..3 {
                for r in one.responses(&x1, &x2, &lambda, None).unwrap() {
                    seen[r.state as usize] += 1;
                }
                let (a, b) = [&mut one, &mut two].map(|c| c.residual(&x1, &x2, &lambda, None).unwrap()).into();
                assert_eq!(bits(&a), bits(&b), "{options:?}");
                let (a, b) = [&mut one, &mut two].map(|c| entries(c, (&x1, &x2, &lambda))).into();
                assert!(a == b, "{options:?}");
                one.commit(&x1, &x2, &lambda, None).unwrap();
                two.commit(&x1, &x2, &lambda, None).unwrap();
                assert_eq!(one.history(), two.history());
                x1 = shifted(&x1, along() * 0.05);
            }
        }
    }
    assert!(seen[State::Gap as usize] > 50 && seen[State::Stick as usize] > 50, "{seen:?}");
    assert_eq!(seen[State::Slip as usize], 0, "never slips");
}

/// A node that has just been covered has no slip history: it acts without friction for one step, as Coulomb's does.
#[test]
fn a_newly_covered_node_holds_from_the_next_step_on() {
    let one = grid(1, 1, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads);
    let two = grid(1, 1, [1.5, -1.0], [4.0, 2.0], 0.0, true, Cells::Quads);
    let (lambda, slid) = (vec![Vec3::new(9.0, 0.0, -1.0); 4], shifted(&one.x, Vec3::x() * 2.0));
    for (new_contact, state) in [(NewContact::Frictionless, State::Slip), (NewContact::KeepFriction, State::Stick)] {
        let mut c: Contact<3> = contact(&one, &two, false, Options { new_contact, ..rough(options()) });
        let states = |c: &mut Contact<3>, state: State| {
            let responses = c.responses(&slid, &two.x, &lambda, None).unwrap();
            assert!(responses.iter().all(|r| r.state == state));
        };
        states(&mut c, state);
        c.commit(&slid, &two.x, &lambda, None).unwrap();
        states(&mut c, State::Stick);
    }
}
