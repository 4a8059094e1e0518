//! A surface that goes past facets, through them, or is the wrong way round.

use super::*;
use crate::support::mesh::options;
use stickslip::error::Kind;
use stickslip::interface::{Finding, Normals};
use stickslip::law::State;

/// Frames of a ball and of a bar along y, of radius 1, about a place; of a plane through it that looks along z.
fn frame_at(shape: AnalyticShape, p: Vec3) -> Vec<Vec3> {
    let along = if matches!(shape, AnalyticShape::Cylinder(_)) { Vec3::y() } else { Vec3::z() };
    let across = if along == Vec3::y() { Vec3::z() } else { Vec3::y() };
    vec![p, p + along, p + Vec3::x(), p + across]
}

const CONVEX: [AnalyticShape; 2] = [AnalyticShape::Sphere(1.0), AnalyticShape::Cylinder(1.0)];

/// Two facets a side, in the plane z = 0, that look down.
fn plate() -> Mesh {
    grid(2, 2, [0.0, -0.5], [1.0, 0.5], 0.0, false, Cells::Quads)
}

/// All of them, at t_n below the middle of a plate.
fn below(shape: AnalyticShape, options: Options) -> Contact<3> {
    against(&plate(), shape, &frame_at(shape, Vec3::new(0.5, 0.0, -1.05)), options).unwrap()
}

fn all_options() -> impl Iterator<Item = Options> {
    let all = BASES.into_iter().flat_map(|basis| [Normals::Committed, Normals::Current].map(|n| (basis, n)));
    all.map(|(basis, normals)| Options { basis, normals, ..options() })
}

#[test]
fn a_surface_beside_a_facet_touches_nothing_however_high_it_stands() {
    let (x, lambda) = (plate().x, vec![Vec3::zeros(); 9]);
    for options in all_options() {
        for shape in CONVEX {
            // At 0 nu is across x - y, above it the surface looks the same way.
            for height in [-0.3, -1e-3, 0.0, 1e-3, 0.3, 2.0] {
                let mut contact = below(shape, options);
                let frame = frame_at(shape, Vec3::new(4.0, 0.0, height));
                let states = contact.responses(&x, &frame, &lambda, None).unwrap();
                assert!(states.iter().all(|r| r.state == State::Gap), "{shape:?} {height}");
                contact.commit(&x, &frame, &lambda, None).unwrap();
            }
        }
    }
}

#[test]
fn a_step_in_which_the_surface_has_passed_through_a_facet_is_refused() {
    let (x, lambda) = (plate().x, vec![Vec3::zeros(); 9]);
    for options in all_options() {
        for shape in CONVEX {
            for height in [0.3, 1.2, 3.0] {
                let mut contact = below(shape, options);
                let error =
                    contact.commit(&x, &frame_at(shape, Vec3::new(0.5, 0.0, height)), &lambda, None).unwrap_err();
                assert_eq!(error.kind, Kind::ContactLost, "{shape:?} {height}: {error}");
                assert!(error.message.contains("has passed through non-mortar facet"), "{error}");
            }
        }
    }
}

/// A body in a bore may go from one side to the other in a step: its near side then looks away from what is nearest.
#[test]
fn a_body_crosses_a_bore() {
    let (mesh, lambda) = (plate(), vec![Vec3::zeros(); 9]);
    let shape = AnalyticShape::Cylinder(-3.0);
    let mut contact: Contact<3> = against(&mesh, shape, &frame_at(shape, Vec3::new(0.5, 0.0, 2.0)), options()).unwrap();
    let frame = frame_at(shape, Vec3::new(0.5, 0.0, -2.0));
    let states = contact.responses(&mesh.x, &frame, &lambda, None).unwrap();
    assert!(states.iter().all(|r| r.state == State::Gap));
    contact.commit(&mesh.x, &frame, &lambda, None).unwrap();
}

#[test]
fn a_surface_the_wrong_way_round_is_told() {
    let finding = |shape: AnalyticShape, frame: &[Vec3], up: bool| {
        let mesh = grid(2, 2, [0.0, -0.5], [1.0, 0.5], 0.0, up, Cells::Quads);
        let mut contact: Contact<3> = against(&mesh, shape, frame, options()).unwrap();
        contact.report(&mesh.x, frame).unwrap().finding
    };
    // The surface is at this height; its normal points along z; the facets' body is below them.
    for (height, expected) in [
        (-3.0, Finding::NoOverlap), // far outside: it may turn
        (-0.3, Finding::SameWay),
        (0.0, Finding::SameWay),
        (0.3, Finding::SameWay),
        (5.0, Finding::SameWay),
    ] {
        let p = Vec3::new(0.5, 0.0, height);
        assert_eq!(finding(AnalyticShape::Plane, &frame_at(AnalyticShape::Plane, p), true), Some(expected), "{height}");
    }
    // Bores of radius 3, in place of a ball and a bar that lie on the facets.
    for shape in [AnalyticShape::Sphere(-3.0), AnalyticShape::Cylinder(-3.0)] {
        for height in [2.9, 3.0, 3.1, 4.0] {
            let frame = frame_at(shape, Vec3::new(0.5, 0.0, height));
            assert_eq!(finding(shape, &frame, true), Some(Finding::SameWay), "{shape:?} {height}");
        }
    }
    // The right way, deeper than a pair can be; a ball beside the facets that stands a little lower than they do.
    let deep = frame_at(AnalyticShape::Plane, Vec3::new(0.5, 0.0, 2.0));
    assert_eq!(finding(AnalyticShape::Plane, &deep, false), Some(Finding::Behind));
    let beside = frame_at(AnalyticShape::Sphere(1.0), Vec3::new(2.2, 0.0, -0.3));
    assert_eq!(finding(AnalyticShape::Sphere(1.0), &beside, true), Some(Finding::NoOverlap));
}
