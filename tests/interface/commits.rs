//! What a commit leaves as it is: at its positions states, gaps and coverage are those of before, but for what the new
//! normals change; and the force does not depend on how fine the other side is, nor on the number of steps.

use crate::support::host::Body;
use crate::support::mesh::*;
use crate::support::press::{Place, Press};
use nalgebra::{Isometry3, Rotation3};
use stickslip::error::Kind;
use stickslip::geometry::Vec3;
use stickslip::interface::{Contact, Friction, MultiplierBasis, NO_EQUATION, Options, Stiffness, Surface, Weights};
use stickslip::law::State;

/// Gaps and coverage of the same pairs, which another tree may bring in another order: rounding.
const SAME: f64 = 1e-12;
/// How far a body turns at most from one commit to the next, about each axis: 8 degrees.
const TURN: f64 = 0.08;

/// An ellipsoid of n x n facets a face of the cube it was made of, turned at random.
fn convex(random: &mut Random, n: usize) -> Mesh {
    let mut mesh = ball(n);
    let axes = Vec3::from_fn(|_, _| 1.0 + 0.4 * random.next());
    let turn = Rotation3::new(random.vector(3.0));
    mesh.x.iter_mut().for_each(|x| *x = turn * x.component_mul(&axes));
    mesh
}

/// The node that lies farthest in a direction.
fn farthest(mesh: &Mesh, direction: &Vec3) -> Vec3 {
    *mesh.x.iter().max_by(|x, y| x.dot(direction).total_cmp(&y.dot(direction))).unwrap()
}

/// Random convex bodies, a few facets thick or many, moved into each other: nothing changes at a commit, and where they
/// turned nothing that touches is uncovered.
#[test]
fn convex_bodies_pressed_keep_states_and_gaps_at_a_commit() {
    let (mut refused, mut taken, mut closed) = (0, 0, 0);
    let first = std::env::var("PROPTEST_RNG_SEED").map_or(0, |seed| 1000 * seed.parse::<u64>().unwrap());
    for seed in first + 1..=first + 120 {
        let mut random = Random(seed);
        let (sizes, turned) = ([4, 5, 7, 9, 17, 33], seed % 3 == 0);
        let mut size = || sizes[((random.next() + 1.0) * 3.0) as usize % 6];
        let (n1, n2) = (size(), size());
        let (one, two) = (convex(&mut random, n1), convex(&mut random, n2));
        let direction = random.vector(1.0).normalize();
        let touching = farthest(&two, &direction) - farthest(&one, &-direction);
        // As deep as the coarser body's facets bulge.
        let depth = (1.0 + random.next()) * 0.5 / (n1.min(n2) as f64).powi(2);
        let mut contact: Contact<1> = contact(&one, &two, true, Options::paper(Stiffness::Modulus(1.0)));
        let at = |gap: f64| -> Vec<Vec3> { one.x.iter().map(|x| x + touching + direction * gap).collect() };
        let turn = Rotation3::new(random.vector(TURN));
        let lambda = vec![Default::default(); one.x.len()];
        contact.set_previous(&at(0.1), &two.x).unwrap();
        let mut pressed = at(-depth);
        if turned {
            pressed.iter_mut().for_each(|x| *x = turn * (*x - touching) + touching);
        }
        let look = |c: &mut Contact<1>| {
            let responses = c.responses(&pressed, &two.x, &lambda, None).unwrap();
            let sums = c.sums(&pressed, &two.x).unwrap();
            let node = |a: usize| (responses[a].state, responses[a].gap_normal, sums[a].coverage);
            (0..lambda.len()).map(node).collect::<Vec<_>>()
        };
        let before = look(&mut contact);
        closed += before.iter().filter(|n| n.0 != State::Gap).count();
        match contact.commit(&pressed, &two.x, &lambda, None) {
            Ok(()) => taken += 1,
            Err(error) => {
                assert_eq!(error.kind, Kind::ContactLost, "{}", error.message);
                refused += 1;
                continue;
            }
        }
        let after = look(&mut contact);
        for (a, (before, after)) in before.iter().zip(&after).enumerate() {
            let text = format!("seed {seed}, {n1} on {n2}, node {a}: {before:?}, {after:?}");
            // Turned, a node may be at the border between the states; covered it stays.
            if turned {
                assert!(before.0 == State::Gap || after.2 > 0.0, "{text}");
            } else {
                assert_eq!(before.0, after.0, "{text}");
                let same = |v: f64, w: f64| (v - w).abs() <= SAME * v.abs();
                assert!(before.0 == State::Gap || same(before.1, after.1) && same(before.2, after.2), "{text}");
            }
        }
    }
    println!("{taken} taken, {refused} refused, {closed} closed nodes");
    assert!(taken > 10 * refused && closed > 60, "of 120 bodies half touch with a node at least");
}

/// A cap of a ball of radius 1, or of a cylinder along y, of n x n quads over [-0.6, 0.6]^2, its lowest point at 0.
fn cap(n: usize, cylinder: bool) -> Mesh {
    let mut mesh = grid(n, n, [-0.6, -0.6], [0.6, 0.6], 0.0, false, Cells::Quads);
    for x in &mut mesh.x {
        x.z = 1.0 - (1.0 - x.x * x.x - if cylinder { 0.0 } else { x.y * x.y }).sqrt();
    }
    mesh
}

/// The force with which the cap is pressed by 0.2 into an elastic layer of n1 x n1 facets, in so many steps.
fn pressed(cells: [usize; 2], cylinder: bool, steps: usize, distance: Option<f64>) -> f64 {
    let mut layer = grid(cells[0], cells[0], [-1.0, -1.0], [1.0, 1.0], 0.0, true, Cells::Quads);
    layer.x.iter_mut().for_each(|x| x.x += 0.07); // the tip is on no edge
    let tool = cap(cells[1], cylinder);
    let (x, equations) = (tool.x.clone(), vec![[NO_EQUATION; 3]; tool.x.len()]);
    let mortar = Surface::new("mortar", tool.x, &tool.facets, equations).unwrap();
    let options =
        Options { friction: Friction::None, search_distance: distance, ..Options::paper(Stiffness::Modulus(100.0)) };
    let mut press: Press<1> = Press::new(Body::new(layer, Vec3::z() * -1.0, 100.0, 0.3), mortar, options);
    let place = |s: f64| Place { plate: Isometry3::translation(0.0, 0.0, 0.2 * s), mortar: x.clone() };
    press.go((0.0, 1.0), steps, &place);
    press.force(&place(1.0)).0.norm()
}

/// In how many steps a fine tip is pressed into a coarse layer changes the force by what the path does to it, not more;
/// with any distance allowed it is the same.
const SAME_FORCE: f64 = 0.01;

#[test]
fn a_fine_tip_in_coarse_facets_is_not_lost_at_commits() {
    for cylinder in [false, true] {
        let wanted = pressed([3, 64], cylinder, 2, Some(3.0));
        assert!(wanted > 1.0, "it is pressed: {wanted}");
        for steps in [1, 6, 20] {
            let found = pressed([3, 64], cylinder, steps, None);
            let error = (found / wanted - 1.0).abs();
            println!("cylinder {cylinder}, {steps} steps: {found:.4}, {wanted:.4} with search_distance");
            assert!(error < SAME_FORCE, "{steps} steps: {found} for {wanted}");
        }
    }
}

/// Two sheets over each other, of which now one and now the other is in reach: a commit, which keeps the pairs of the
/// evaluation before it, settles what is settled where there was none, also where that evaluation's search had an end
/// (`src/interface/stages/keep.rs`, `pairing/ends.rs`).
#[test]
fn a_commit_settles_the_pairs_that_a_search_of_its_own_finds() {
    let (mut refused, mut changed, mut compared) = (0, 0, 0);
    for seed in 0..60 {
        let mut random = Random(seed);
        let basis = if seed % 2 == 0 { MultiplierBasis::Standard } else { MultiplierBasis::Dual };
        let one = grid(7, 7, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads);
        let sheet = grid(9, 9, [-0.2, -0.2], [1.2, 1.2], 0.0, true, Cells::Quads);
        let first = sheet.x.len();
        let two = Mesh {
            x: sheet
                .x
                .iter()
                .chain(&sheet.x)
                .enumerate()
                .map(|(k, x)| x - Vec3::z() * if k < first { 0.1 } else { 2.0 })
                .collect(),
            facets: sheet
                .facets
                .iter()
                .cloned()
                .chain(sheet.facets.iter().map(|f| f.iter().map(|k| k + first as i64).collect()))
                .collect(),
        };
        let options = Options { basis, search_distance: Some(0.5), ..options() };
        let make = || -> Contact<3> { contact(&one, &two, false, options) };
        let (mut stepping, mut pairs) = (make(), make().history().pairs.len());
        let lambda = vec![Vec3::zeros(); one.x.len()];
        for _ in 0..6 {
            // One sheet in reach, the other beyond it on this side, or far behind.
            let (near, far) =
                (0.2 + 0.25 * random.next(), [0.7, 2.0, 40.0, -3.0][(2.0 * random.next() + 2.0) as usize % 4]);
            let heights = if random.next() < 0.0 { [near, far] } else { [far, near] };
            let (slide, bend) = (random.vector(0.1), 0.05 * random.next());
            let x1: Vec<_> = one.x.iter().map(|x| x + slide.xy().push(bend * (3.0 * x.x).sin())).collect();
            let turn = Rotation3::new(random.vector(0.02));
            let x2: Vec<_> = two
                .x
                .iter()
                .enumerate()
                .map(|(k, x)| turn * Vec3::new(x.x, x.y, -heights[usize::from(k >= first)]))
                .collect();
            stepping.residual(&x1, &x2, &lambda, None).unwrap();
            let mut anew = make();
            let outcome = (stepping.commit(&x1, &x2, &lambda, None), anew.set_previous(&x1, &x2));
            let (Ok(()), Ok(())) = outcome else {
                assert!(
                    outcome.0.is_err() && outcome.1.is_err() || outcome.0.is_err_and(|e| e.kind == Kind::ContactLost),
                    "seed {seed}"
                );
                refused += 1;
                break;
            };
            let flat = |c: &Contact<3>| {
                c.history().pairs.iter().map(|p| (p.one, p.two, p.weights.ab, p.weights.ac)).collect::<Vec<_>>()
            };
            assert!(flat(&stepping) == flat(&anew), "seed {seed}");
            // The filters of the step that follows are the same, too.
            let next: Vec<_> = x2.iter().map(|x| x - Vec3::z() * 0.1 * random.next()).collect();
            assert!(stepping.sums(&x1, &next).unwrap() == anew.sums(&x1, &next).unwrap(), "seed {seed}");
            compared += 1;
            changed += usize::from(flat(&anew).len() != std::mem::replace(&mut pairs, flat(&anew).len()));
        }
    }
    println!("{compared} commits compared, {changed} with other pairs than before, {refused} refused");
    assert!(compared > 150 && changed > 60);
}

/// A check has the commit's refusals, and neither it nor they change anything: what follows has the same bits.
#[test]
fn a_commit_that_is_checked_is_the_same_commit() {
    let mut seen = 0;
    for options in [options(), Options { weights: Weights::Committed, ..options() }] {
        for seed in 1..5 {
            let [mut t, mut other] = [(); 2].map(|()| moved(&options, [Cells::Quads, Cells::Triangles], FLAT, seed));
            let first = t.interface.residual(&t.x1, &t.x2, &t.lambda, None).unwrap();
            let answer = t.interface.check_commit(&t.x1, &t.x2, &t.lambda, None);
            assert_eq!(t.interface.residual(&t.x1, &t.x2, &t.lambda, None).unwrap(), first);
            let committed = other.interface.commit(&other.x1, &other.x2, &other.lambda, None);
            assert_eq!(format!("{answer:?}"), format!("{committed:?}"));
            assert_eq!(format!("{:?}", t.interface.commit(&t.x1, &t.x2, &t.lambda, None)), format!("{committed:?}"));
            assert_eq!(t.interface.export_history().unwrap(), other.interface.export_history().unwrap());
            // After a commit the check leaves what can be rolled back.
            if committed.is_ok() {
                t.interface.check_commit(&t.x1, &t.x2, &t.lambda, None).unwrap();
                t.interface.roll_back().unwrap();
                assert_eq!(t.interface.residual(&t.x1, &t.x2, &t.lambda, None).unwrap(), first);
                seen += 1;
            }
            let turn = Rotation3::from_axis_angle(&Vec3::y_axis(), 1.0);
            let x1: Vec<_> = t.x1.iter().map(|x| turn * x).collect();
            let refused = t.interface.check_commit(&x1, &t.x2, &t.lambda, None).unwrap_err();
            assert_eq!(refused.kind, t.interface.commit(&x1, &t.x2, &t.lambda, None).unwrap_err().kind);
        }
    }
    assert!(seen > 4, "{seen}");
}
