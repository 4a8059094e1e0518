//! The diagnosis: the worst pairs by figures known beforehand, and rows that vanish for a reason.

use crate::support::mesh::*;
use nalgebra::Rotation3;
use stickslip::error::Kind;
use stickslip::geometry::Vec3;
use stickslip::interface::{Cause, Contact, Diagnosis, Friction, Interface, NO_EQUATION, NewContact, Options, Surface};
use stickslip::law::State;

/// Rounding of a handful of operations on numbers near 1.
const ROUNDING: f64 = 1e-14;

/// A square facet over two facets of a plate that meet at x = `border`, each by `sunk` below the square.
fn over_a_border(border: f64) -> [Mesh; 2] {
    let one = grid(1, 1, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads);
    [one, grid(2, 1, [border - 2.0, -1.0], [border + 2.0, 2.0], 0.0, true, Cells::Quads)]
}

fn diagnose(meshes: &[Mesh; 2], options: Options) -> Diagnosis {
    let mut i = interface(&meshes[0], &meshes[1], options);
    let lambda = vec![Vec3::new(0.0, 0.0, -1.0); meshes[0].x.len()];
    i.diagnose(&meshes[0].x, &meshes[1].x, &lambda, None).unwrap()
}

#[test]
fn the_thinnest_overlap_is_told() {
    let d = diagnose(&over_a_border(0.99), options());
    let thin = d.overlap.unwrap();
    assert!((thin.value - 0.01).abs() < ROUNDING, "{thin:?}");
    assert_eq!(thin.facets, [0, 1]);
    assert!(d.error.unwrap().value < ROUNDING && d.warp.unwrap().value < ROUNDING);
    assert_eq!((d.count(State::Stick), d.suspects.len()), (4, 0));
    assert!(
        d.text(1).unwrap().contains("Smallest overlap: 1.0e-2 of the smaller facet, facets 1 and 2."),
        "{}",
        d.text(1).unwrap()
    );
}

#[test]
fn the_largest_warp_and_the_steepest_angle_are_told() {
    let mut meshes = over_a_border(0.5);
    meshes[0].x[3].z += 0.1;
    let d = diagnose(&meshes, options());
    // Through the mean of the nodes, along both diagonals: all four are a quarter off; the plane is tilted a little.
    let normal = Vec3::new(0.1, 0.1, -2.0).normalize();
    let expected = 0.025 * normal.z.abs() / 1.01f64.sqrt();
    assert!((d.warp.unwrap().value - expected).abs() < ROUNDING, "{:?} {expected}", d.warp);
    assert!(d.error.unwrap().value > 1e-12, "warped and projected it is no parallelogram");

    let mut meshes = over_a_border(0.5);
    let tilt = Rotation3::from_euler_angles(0.2, 0.0, 0.0);
    meshes[1].x.iter_mut().for_each(|x| *x = tilt * *x);
    let d = diagnose(&meshes, options());
    assert!((d.angle.unwrap().value - 0.2).abs() < ROUNDING, "{:?}", d.angle);
}

/// The weights that are in use are judged, not those of now.
#[test]
fn frozen_weights_are_judged_where_they_are_frozen() {
    let meshes = over_a_border(0.99);
    let mut i =
        interface(&meshes[0], &meshes[1], Options { weights: stickslip::interface::Weights::Reference, ..options() });
    let x1: Vec<_> = meshes[0].x.iter().map(|x| x + Vec3::x() * 0.25).collect();
    let d = i.diagnose(&x1, &meshes[1].x, &[Vec3::new(0.0, 0.0, -1.0); 4], None).unwrap();
    assert!((d.overlap.unwrap().value - 0.01).abs() < ROUNDING);
    // Or anew, where `set_previous` says that the first configuration was another one.
    let there: Vec<_> = meshes[0].x.iter().map(|x| x + Vec3::x() * 0.1).collect();
    i.set_previous(&there, &meshes[1].x).unwrap();
    let d = i.diagnose(&x1, &meshes[1].x, &[Vec3::new(0.0, 0.0, -1.0); 4], None).unwrap();
    assert!((d.overlap.unwrap().value - 0.11).abs() < ROUNDING);
}

/// A slice of 1e-6 of a facet: its far nodes are hardly covered, and their rows small, in every direction.
#[test]
fn hardly_covered_nodes_are_suspects() {
    let one = grid(1, 1, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads);
    let two = grid(1, 1, [-1.0, -1.0], [1e-6, 2.0], 0.0, true, Cells::Quads);
    let d = diagnose(&[one, two], options());
    // Those at x = 1 are covered below coverage_min, and open.
    let nodes: Vec<_> = d.suspects.iter().map(|s| s.node).collect();
    assert_eq!(nodes, [0, 0, 0, 2, 2, 2]);
    assert!(d.suspects.iter().all(|s| s.cause == Cause::Coverage && s.ratio < 1e-5), "{:?}", d.suspects);
    assert_eq!(d.least_covered.map(|(a, _)| a), Some(0));
}

/// Plane strain whose multiplier was left in: the row of a sticking node along it is empty.
#[test]
fn a_prescribed_direction_is_a_suspect_where_the_node_sticks() {
    let [one, two] = over_a_border(0.5);
    let create = |multipliers: Vec<[i64; 3]>| {
        let held = |first: i64, n: i64| (0..n).map(|k| [first + 2 * k, NO_EQUATION, first + 2 * k + 1]).collect();
        let upper = Surface::new("nonmortar", one.x.clone(), &one.facets, held(0, 4)).unwrap();
        let lower = Surface::new("mortar", two.x.clone(), &two.facets, held(8, 6)).unwrap();
        Interface::new(upper, lower, multipliers, options()).unwrap()
    };
    let lambda = [Vec3::new(0.0, 0.0, -1.0); 4];
    let d = create(numbered(20, 4)).diagnose(&one.x, &two.x, &lambda, None).unwrap();
    assert_eq!(d.count(State::Stick), 4);
    let mut nodes: Vec<_> = d.suspects.iter().map(|s| s.node).collect();
    nodes.sort_unstable();
    assert_eq!(nodes, [0, 1, 2, 3]);
    for s in &d.suspects {
        assert!((s.direction - Vec3::y()).norm() < ROUNDING && s.ratio < 1e-7 && s.cause == Cause::Prescribed, "{s:?}");
    }
    assert!(
        d.text(0).unwrap().contains("along (0.000, 1.000, 0.000)") && d.text(0).unwrap().contains("So at 1 more."),
        "{}",
        d.text(0).unwrap()
    );
    // Without its equation, or sliding, there is nothing to suspect.
    let removed = (0..4).map(|k| [20 + 2 * k, NO_EQUATION, 21 + 2 * k]).collect();
    assert!(create(removed).diagnose(&one.x, &two.x, &lambda, None).unwrap().suspects.is_empty());
    let sliding = [Vec3::new(0.0, 5.0, -1.0); 4];
    let d = create(numbered(20, 4)).diagnose(&one.x, &two.x, &sliding, None).unwrap();
    assert_eq!((d.count(State::Slip), d.suspects.len()), (4, 0));
}

/// docs/formulation 6.2: without slip history a node that sticks has no tangential rows.
#[test]
fn new_contact_that_keeps_its_friction_is_a_suspect() {
    let one = grid(1, 1, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads);
    let two = grid(1, 1, [2.0, -1.0], [5.0, 2.0], 0.0, true, Cells::Quads);
    for (new_contact, expected) in [(NewContact::KeepFriction, 8), (NewContact::Frictionless, 0)] {
        let mut i = interface(&one, &two, Options { new_contact, ..options() });
        let x1: Vec<_> = one.x.iter().map(|x| x + Vec3::x() * 3.0).collect();
        let d = i.diagnose(&x1, &two.x, &[Vec3::new(0.0, 0.0, -1.0); 4], None).unwrap();
        assert_eq!(d.suspects.len(), expected);
        assert!(d.suspects.iter().all(|s| s.cause == Cause::New && s.direction.z.abs() < ROUNDING), "{:?}", d.suspects);
    }
}

/// One multiplier a node, along the normal.
#[test]
fn a_frictionless_node_over_prescribed_surfaces_is_a_suspect() {
    let [one, two] = over_a_border(0.5);
    let none = |n: usize| vec![[NO_EQUATION; 3]; n];
    let upper = Surface::new("nonmortar", one.x.clone(), &one.facets, none(4)).unwrap();
    let lower = Surface::new("mortar", two.x.clone(), &two.facets, none(6)).unwrap();
    let options = Options { mu: 0.0, friction: Friction::None, ..options() };
    let mut i = Contact::<1>::frictionless(upper, lower, numbered(0, 4), options).unwrap();
    let d = i.diagnose(&one.x, &two.x, &[nalgebra::Vector1::new(-1.0); 4], None).unwrap();
    assert_eq!(d.suspects.len(), 4);
    assert!(d.suspects.iter().all(|s| (s.direction - Vec3::z()).norm() < ROUNDING && s.cause == Cause::Prescribed));
    let open = i.diagnose(&one.x, &two.x, &[nalgebra::Vector1::new(1.0); 4], None).unwrap();
    assert_eq!((open.count(State::Gap), open.suspects.len()), (4, 0));
}

/// An evaluation, not a step: equal bits before and after.
#[test]
fn a_diagnosis_changes_nothing() {
    let mut s = moved(&options(), [Cells::Quads; 2], FLAT, 3);
    let before = s.interface.residual(&s.x1, &s.x2, &s.lambda, None).unwrap();
    let history = s.interface.export_history().unwrap();
    let away: Vec<_> = s.x1.iter().map(|x| x + Vec3::new(0.1, 0.0, 0.0)).collect();
    s.interface.diagnose(&away, &s.x2, &s.lambda, None).unwrap();
    assert!(history == s.interface.export_history().unwrap());
    assert!(before == s.interface.residual(&s.x1, &s.x2, &s.lambda, None).unwrap());
}

/// A handle of several has parts of rows: nothing follows from their size.
#[test]
fn parts_of_rows_are_no_suspects() {
    let [one, _] = over_a_border(0.5);
    let lambda = [Vec3::new(0.0, 0.0, -1.0); 4];
    let half = |x: [f64; 2]| grid(1, 1, [x[0], -1.0], [x[1], 2.0], 0.0, true, Cells::Quads);
    let [left, right] = [half([-1.5, 0.5]), half([0.5, 2.5])];
    let mut i = interface(&one, &left, options());
    assert!(!i.diagnose(&one.x, &left.x, &lambda, None).unwrap().states.is_empty());
    let mut sums = i.sums(&one.x, &left.x).unwrap();
    let other = interface(&one, &right, options()).sums(&one.x, &right.x).unwrap();
    for (s, o) in sums.iter_mut().zip(&other) {
        s.coverage += o.coverage;
        s.coverage_previous += o.coverage_previous;
        s.gap_now += o.gap_now;
        s.gap_previous += o.gap_previous;
        s.gap_committed += o.gap_committed;
    }
    assert!(i.diagnose(&one.x, &left.x, &lambda, Some(&sums)).unwrap().suspects.is_empty());
}

#[test]
fn rows_that_overflow_are_refused() {
    let [one, two] = over_a_border(0.5);
    // A slipping node's row has mu in it: the products of rows overflow before anything else does.
    let mut i = interface(&one, &two, Options { mu: 1e200, ..options() });
    let error = i.diagnose(&one.x, &two.x, &[Vec3::new(1e201, 0.0, -1.0); 4], None).unwrap_err();
    assert_eq!(error.kind, Kind::NotFinite, "{error}");
}
