//! Nodes that nothing can cover before the next commit: no law is asked about them, and no bit of the answer changes.

use super::*;
use std::f64::consts::PI;
use stickslip::geometry::AnalyticShape;
use stickslip::interface::{Counters, Friction, NO_EQUATION, NodeCounts, Surface};
use stickslip::law::State;

/// Cells along the edge of a cube's face.
const CELLS_A_FACE: usize = 4;
/// How deep the ball of radius 1 has sunk in.
const DEPTH: f64 = 0.15;

/// The ball over a floor of facets or an analytic plane.
fn over_floor<const N: usize>(analytic: bool, options: Options) -> Contact<N>
where
    Contact<N>: Create<N>,
{
    let options = Options { turn_max: PI, ..options }; // with any weights
    let ball = ball(CELLS_A_FACE);
    let x: Vec<_> = shifted(&ball.x, Vec3::z() * (1.0 - DEPTH));
    let (n1, floor) = (x.len(), grid(3, 3, [-2.0, -2.1], [2.1, 2.0], 0.0, true, Cells::Quads));
    let one = Surface::new("nonmortar", x, &ball.facets, numbered(0, n1)).unwrap();
    let two = if analytic {
        let frame = [Vec3::zeros(), Vec3::z(), Vec3::x(), Vec3::y()];
        Surface::analytic("mortar", AnalyticShape::Plane, frame.to_vec()).unwrap()
    } else {
        let equations = vec![[NO_EQUATION; 3]; floor.x.len()];
        Surface::new("mortar", floor.x, &floor.facets, equations).unwrap()
    };
    Contact::create(one, two, numbered(3 * n1, n1), options).unwrap()
}

/// The tangent without its zeros, which the two ways need not store alike.
fn nonzero<const N: usize>(c: &mut Contact<N>, at: (&[Vec3], &[Vec3], &[SVector<f64, N>])) -> Vec<(i64, i64, u64)> {
    entries(c, at).into_iter().filter(|(_, _, bits)| f64::from_bits(*bits) != 0.0).collect()
}

/// Rolls the ball over the floor in three steps with any multipliers at all, with and without the shortcut. Returns what
/// the nodes were at the end, and both counters.
fn roll<const N: usize>(analytic: bool, options: Options) -> (NodeCounts, [Counters; 2])
where
    Contact<N>: Create<N>,
{
    let off = Shortcuts { uncovered: false, ..options.shortcuts };
    let mut short: Contact<N> = over_floor(analytic, options);
    let mut full: Contact<N> = over_floor(analytic, Options { shortcuts: off, ..options });
    let (mut x1, x2) = (short.surfaces().0.reference.clone(), short.surfaces().1.reference.clone());
    let mut random = Random(5);
    for step in 0..3 {
        let lambda: Vec<_> = x1.iter().map(|_| SVector::from_fn(|_, _| random.next())).collect();
        let at = (&x1[..], &x2[..], &lambda[..]);
        let [a, b] = [&mut short, &mut full].map(|c| c.residual(&x1, &x2, &lambda, None).unwrap());
        assert!(bits(&a) == bits(&b), "{options:?}, step {step}");
        assert!(nonzero(&mut short, at) == nonzero(&mut full, at), "{options:?}, step {step}");
        let [a, b] = [&mut short, &mut full].map(|c| c.responses(&x1, &x2, &lambda, None).unwrap());
        for (a, b) in a.iter().zip(&b) {
            assert!(a.state == b.state && a.gap_normal == b.gap_normal && a.slip == b.slip);
        }
        let touching = a.iter().filter(|r| r.state != State::Gap).count();
        assert!(touching > 0 && touching < a.len());
        for c in [&mut short, &mut full] {
            let mut count = 0;
            c.pattern(&x1, &x2, Extent::Whole, &mut |_: i64, _: i64, _: f64| count += 1).unwrap();
            assert_eq!(count, entries(c, at).len(), "pattern and tangent go together");
        }
        short.commit(&x1, &x2, &lambda, None).unwrap();
        full.commit(&x1, &x2, &lambda, None).unwrap();
        assert!(short.history() == full.history());
        let turn = Rotation3::from_axis_angle(&Vec3::y_axis(), 0.3);
        let centre = Vec3::new(0.3 * f64::from(step), 0.0, 1.0 - DEPTH);
        x1.iter_mut().for_each(|x| *x = turn * (*x - centre) + centre + Vec3::x() * 0.3);
    }
    (short.counters().nodes, [short.counters(), full.counters()])
}

fn check(counts: NodeCounts, [short, full]: [Counters; 2]) {
    // Three steps, each with five evaluations at one point: the law is asked once a point.
    let (all, points) = (ball(CELLS_A_FACE).x.len() as i64, 3);
    assert_eq!((counts.total(), full.nodes.total(), full.nodes.left_out), (all, all, 0));
    assert!(counts.left_out > all / 3, "the upper half cannot be covered: {counts:?}");
    assert_eq!(counts.uncovered + counts.left_out, full.nodes.uncovered);
    assert_eq!(full.nodes_evaluated, points * all);
    assert!(short.nodes_evaluated < points * all * 2 / 3);
}

#[test]
fn the_far_side_of_a_ball_is_left_out_and_no_bit_changes() {
    for analytic in [false, true] {
        for options in variants(options()) {
            let (counts, both) = roll::<3>(analytic, options);
            check(counts, both);
            assert!(counts.frictional > 0 && counts.frictionless == 0 && counts.tied == 0);
            let (counts, both) = roll::<3>(analytic, Options { friction: Friction::Rough, mu: 0.0, ..options });
            check(counts, both);
            assert!(counts.frictional > 0);
            let (counts, both) = roll::<1>(analytic, Options { friction: Friction::None, mu: 0.0, ..options });
            check(counts, both);
            assert!(counts.frictionless > 0 && counts.frictional + counts.new == 0);
        }
        let (counts, both) = roll::<3>(analytic, Options { friction: Friction::Tied, mu: 0.0, ..options() });
        check(counts, both);
        assert_eq!(counts.tied + counts.left_out + counts.uncovered, counts.total());
        assert!(counts.tied > 0);
    }
}

/// The ball turns over in steps that a commit takes: what was its far side touches, and is closed from the next
/// evaluation on.
#[test]
fn a_commit_finds_the_nodes_anew() {
    const STEPS: u32 = 15;
    for analytic in [false, true] {
        let mut c: Contact<3> = over_floor(analytic, options());
        let (x1, x2) = (c.surfaces().0.reference.clone(), c.surfaces().1.reference.clone());
        let centre = Vec3::z() * (1.0 - DEPTH);
        let turned = |step: u32| -> Vec<Vec3> {
            let turn = Rotation3::from_axis_angle(&Vec3::x_axis(), PI * f64::from(step) / f64::from(STEPS));
            x1.iter().map(|x| turn * (x - centre) + centre).collect()
        };
        let lambda = vec![Vec3::zeros(); x1.len()];
        // Without the equator's, whose normals run along the plane: their gap is rounding.
        let deep = |r: &stickslip::law::NodeResponse| r.state != State::Gap && r.gap_normal < -1e-6;
        let closed = |c: &mut Contact<3>, x1: &[Vec3]| -> Vec<usize> {
            let states = c.responses(x1, &x2, &lambda, None).unwrap();
            (0..states.len()).filter(|&a| deep(&states[a])).collect()
        };
        let before = closed(&mut c, &x1);
        (1..STEPS).for_each(|step| c.commit(&turned(step), &x2, &lambda, None).unwrap());
        let nearly = closed(&mut c, &turned(STEPS - 1));
        c.commit(&turned(STEPS), &x2, &lambda, None).unwrap();
        let after = closed(&mut c, &turned(STEPS));
        assert!(!before.is_empty() && !after.is_empty() && before.iter().all(|a| !after.contains(a)));
        c.roll_back().unwrap();
        assert_eq!(closed(&mut c, &turned(STEPS - 1)), nearly);
    }
}

/// Off the floor, onto it, and a commit there: uncovered, new, with friction.
#[test]
fn nodes_that_come_over_the_floor_are_new_for_one_step() {
    let mut c: Contact<3> = over_floor(false, options());
    let (x1, x2) = (c.surfaces().0.reference.clone(), c.surfaces().1.reference.clone());
    let lambda = vec![Vec3::zeros(); x1.len()];
    let off = shifted(&x1, Vec3::x() * 4.0);
    let counts = |c: &mut Contact<3>, x1: &[Vec3]| {
        c.responses(x1, &x2, &lambda, None).unwrap();
        c.counters().nodes
    };
    let start = counts(&mut c, &x1);
    assert!(start.frictional > 0 && start.new == 0);
    c.commit(&off, &x2, &lambda, None).unwrap();
    let away = counts(&mut c, &off);
    assert!(away.frictional < start.frictional && away.new == 0, "facets on the ball's side still see the floor");
    let back = counts(&mut c, &x1);
    assert!(back.new > 0 && back.new + back.frictional <= start.frictional);
    c.commit(&x1, &x2, &lambda, None).unwrap();
    assert_eq!(counts(&mut c, &x1), start);
}

/// Sums of other handles may cover any node: none is left out any more.
#[test]
fn sums_of_other_handles_leave_no_node_out() {
    let mut c: Contact<3> = over_floor(false, options());
    let (x1, x2) = (c.surfaces().0.reference.clone(), c.surfaces().1.reference.clone());
    let lambda = vec![Vec3::zeros(); x1.len()];
    let mut sums = c.sums(&x1, &x2).unwrap();
    let top = (0..x1.len()).max_by(|&a, &b| x1[a].z.total_cmp(&x1[b].z)).unwrap();
    sums[top].coverage = c.history().areas[top];
    sums[top].gap_now = c.normal(top).unwrap() * (-0.01 * sums[top].coverage);
    let responses = c.responses(&x1, &x2, &lambda, Some(&sums)).unwrap();
    assert_eq!(responses[top].state, State::Slip);
    assert_eq!(c.counters().nodes.left_out, 0);
}
