//! Which facets are found, what is counted, and what is refused.

use super::*;
use crate::support::mesh::options;
use stickslip::error::Kind;
use stickslip::interface::{Stiffness, Weights};
use stickslip::law::State;

#[test]
fn only_facets_that_face_the_surface_are_found() {
    let at = |height: f64, down: bool, shape: AnalyticShape, search_distance: Option<f64>| {
        let mesh = grid(2, 2, [0.0, 0.0], [1.0, 1.0], height, !down, Cells::Quads);
        let mut options = Options { search_distance, ..options() };
        options.shortcuts.apart = false;
        let contact: Contact<3> = against(&mesh, shape, &frame_of(shape), options).unwrap();
        contact.active_pairs()
    };
    for shape in SHAPES {
        assert_eq!(at(0.1, true, shape, None), 4, "{shape:?}: above");
        assert_eq!(at(1.9, true, shape, None), 4, "{shape:?}: far above");
        assert_eq!(at(-0.4, true, shape, None), 4, "{shape:?}: less deep than a facet");
        assert_eq!(at(-0.9, true, shape, None), 0, "{shape:?}: deeper than a facet");
        assert_eq!(at(0.1, false, shape, None), 0, "{shape:?}: looks away");
        assert_eq!(at(0.5, true, shape, Some(0.3)), 0, "{shape:?}: beyond the search distance");
        assert_eq!(at(-0.4, true, shape, Some(0.1)), 0, "{shape:?}: deeper than the search distance");
    }
}

#[test]
fn counters_tell_what_was_done() {
    let mesh = grid(3, 2, [0.0, 0.0], [1.0, 1.0], 0.001, false, Cells::Quads);
    let lambda = vec![Vec3::zeros(); mesh.x.len()];
    let [lifted, higher] = [0.8, 1.0].map(|h| mesh.x.iter().map(|x| x + Vec3::z() * h).collect::<Vec<_>>());
    for shape in SHAPES {
        let frame = frame_of(shape);
        let mut contact: Contact<3> = against(&mesh, shape, &frame, options()).unwrap();
        dense(&mut contact, &mesh.x, &frame, &lambda);
        let c = contact.counters();
        assert_eq!((c.pairs_tested, c.pairs_clipped, c.pairs_integrated, c.pairs_linearised), (12, 0, 12, 6));
        assert_eq!((c.searches, c.evaluations_apart), (0, 0));
        assert!(
            contact.effects().unwrap().contains(&format!("Mortar side: {shape} (asked for)")),
            "{}",
            contact.effects().unwrap()
        );
        // Apart is one comparison a node, and changes nothing.
        let mut options = options();
        options.shortcuts.apart = false;
        let mut all: Contact<3> = against(&mesh, shape, &frame, options).unwrap();
        let apart = [&mut contact, &mut all].map(|c| {
            c.set_previous(&lifted, &frame).unwrap();
            c.residual(&higher, &frame, &lambda, None).unwrap()
        });
        assert_eq!(apart[0], apart[1]);
        let c = contact.counters();
        assert_eq!((c.pairs_tested, c.commits_apart, c.evaluations_apart), (12, 1, 1), "{shape:?}");
        assert_eq!(all.counters().evaluations_apart, 0);
        // Frozen weights integrate once.
        let frozen = Options { weights: Weights::Reference, ..options };
        let mut frozen: Contact<3> = against(&mesh, shape, &frame, frozen).unwrap();
        dense(&mut frozen, &mesh.x, &frame, &lambda);
        frozen.commit(&mesh.x, &frame, &lambda, None).unwrap();
        let c = frozen.counters();
        assert_eq!((c.pairs_integrated, c.pairs_linearised), (6, 0));
    }
}

fn refused<T: std::fmt::Debug>(result: Result<T>, kind: Kind, word: &str) {
    let error = result.unwrap_err();
    assert!(error.kind == kind && error.message.contains(word), "{word}: {error:?}");
}

#[test]
fn what_is_no_surface_is_refused_by_name() {
    let frame = frame_of(AnalyticShape::Plane);
    let surface = |shape, frame: &[Vec3]| Surface::analytic("mortar", shape, frame.to_vec());
    for radius in [0.0, f64::NAN, f64::INFINITY] {
        refused(surface(AnalyticShape::Sphere(radius), &frame), Kind::InvalidValue, "mortar: the radius");
        refused(surface(AnalyticShape::Cylinder(radius), &frame), Kind::InvalidValue, "mortar: the radius");
    }
    refused(surface(AnalyticShape::Plane, &frame[..3]), Kind::InvalidSize, "3 nodes");
    let flat = [frame[0], frame[1], frame[2], frame[1] + frame[2] - frame[0]];
    refused(surface(AnalyticShape::Plane, &flat), Kind::InvalidValue, "one plane");
    refused(surface(AnalyticShape::Plane, &[frame[0], frame[0], frame[2], frame[3]]), Kind::InvalidValue, "one plane");
    let far = [frame[0], frame[1], frame[2], Vec3::new(f64::NAN, 0.0, 0.0)];
    refused(surface(AnalyticShape::Plane, &far), Kind::NotFinite, "node 3");

    let mesh = grid(2, 2, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads);
    let two = Surface::new("mortar", mesh.x.clone(), &mesh.facets, equations(0, 9)).unwrap();
    let one = surface(AnalyticShape::Plane, &frame).unwrap();
    refused(<Contact<3>>::create(one, two, options()), Kind::InvalidValue, "nonmortar");
}

#[test]
fn what_is_no_rigid_motion_and_the_centre_are_refused() {
    let mesh = grid(2, 2, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads);
    let shape = AnalyticShape::Sphere(0.5);
    let frame = frame_of(shape);
    let mut contact: Contact<3> = against(&mesh, shape, &frame, options()).unwrap();
    let lambda = vec![Vec3::zeros(); 9];
    let history = contact.history().clone();
    let mirrored: Vec<_> = frame.iter().map(|x| Vec3::new(-x.x, x.y, x.z)).collect();
    refused(contact.residual(&mesh.x, &mirrored, &lambda, None), Kind::InvalidValue, "mirrored");
    for k in 0..4 {
        let mut bent = frame.clone();
        bent[k] += Vec3::new(1e-6, 1e-6, 1e-6);
        refused(contact.residual(&mesh.x, &bent, &lambda, None), Kind::InvalidValue, "rigid body");
        refused(contact.commit(&mesh.x, &bent, &lambda, None), Kind::InvalidValue, "rigid body");
    }
    // The middle of facet 0, where a quadrature point is, at the centre of the ball.
    let sunk: Vec<_> = mesh.x.iter().map(|x| x + frame[0] - Vec3::new(0.25, 0.25, 0.0)).collect();
    refused(contact.residual(&sunk, &frame, &lambda, None), Kind::UndefinedNormal, "nonmortar facet 0: ");
    assert_eq!(contact.history(), &history);
}

/// A facet stretched over a ball much smaller than it: its nodes are farther away than any edge was at first, its middle
/// is not.
#[test]
fn a_facet_stretched_over_a_small_ball_is_not_apart() {
    let ball = AnalyticShape::Sphere(0.1);
    let frame = vec![Vec3::zeros(), Vec3::x(), Vec3::y(), Vec3::z()];
    let mesh = grid(1, 1, [-0.1, -0.1], [0.1, 0.1], 2.0, false, Cells::Quads);
    let stretched: Vec<_> = mesh.x.iter().map(|x| Vec3::new(10.0 * x.x, 10.0 * x.y, 0.05)).collect();
    let [mut short, mut full] = [true, false].map(|apart| {
        let mut options = options();
        options.shortcuts.apart = apart;
        against::<Contact<3>>(&mesh, ball, &frame, options).unwrap()
    });
    let [a, b] = [&mut short, &mut full].map(|c| c.sums(&stretched, &frame).unwrap());
    assert_eq!(short.counters().commits_apart, 1);
    assert_eq!(short.counters().evaluations_apart, 0);
    assert!(a == b && a.iter().all(|s| s.coverage > 0.0));
}

/// How much a frame with edges of length `a`, `far` from the origin, moves the gaps of a mesh at its side, over the mesh's
/// longest edge: against the same without the offset, which is exact to the last digits. `None`: refused.
fn lost(shape: AnalyticShape, far: f64, a: f64) -> Option<f64> {
    let (q, shift) = (askew(), Vec3::new(0.7, -0.5, 0.6) * far);
    let mesh = grid(2, 2, [0.6, 0.6], [1.2, 1.2], 0.0, false, Cells::Quads);
    let mut frame = frame_of(shape);
    for k in 1..4 {
        frame[k] = frame[0] + (frame[k] - frame[0]).normalize() * a;
    }
    let sums = |shift: Vec3, frame: &[Vec3]| -> Result<Vec<f64>> {
        let moved = Mesh { x: turned(&q, shift, &mesh.x), ..mesh.clone() };
        let frame = turned(&q, shift, frame);
        let mut contact: Contact<3> = against(&moved, shape, &frame, options())?;
        let sums = contact.share_of_sums(&moved.x, &frame)?; // gaps, be the surface near or not
        assert!(sums.iter().all(|s| s.coverage > 0.0), "{shape}: the facets face the surface");
        Ok(sums.iter().map(|s| (q.inverse() * s.gap_now).z / s.coverage).collect())
    };
    let exact = sums(Vec3::zeros(), &frame_of(shape)).unwrap();
    match sums(shift, &frame) {
        Ok(found) => Some(max_abs(found.iter().zip(&exact).map(|(a, b)| a - b)) / 0.5),
        Err(e) => {
            // Where nothing is left of the edges there is no volume either.
            let said = ["mortar: the frame is too small", "mortar: the frame has no volume"];
            assert!(e.kind == Kind::InvalidValue && said.iter().any(|text| e.message.contains(text)), "{e}");
            None
        }
    }
}

/// A frame much smaller than its distance to the body or the origin turns with the rounding of its points: refused before
/// a gap loses more than 1e-8 of a facet, and not long before.
#[test]
fn a_frame_too_small_for_its_distance_is_refused() {
    for shape in SHAPES {
        let mut most = 0.0_f64;
        for far in [0.0, 10.0, 1e3, 1e5] {
            for exponent in -10..2 {
                let found = lost(shape, far, 10.0_f64.powi(exponent));
                assert!(found.is_none_or(|loss| loss <= 1e-8), "{shape}, {far:e}, 1e{exponent}: {found:?}");
                assert!(found.is_some() || exponent < 0, "{shape}, {far:e}: edges as long as the mesh will do");
                most = most.max(found.unwrap_or(0.0));
            }
            assert!(lost(shape, far, 1e-12).is_none(), "{shape}, {far:e}");
        }
        assert!(most > 1e-11, "{shape}: {most:e}, the limit is no stricter than it must be");
    }
}

/// A whole body in any attitude above a plane or on top of a ball: at its sharp edges a facet may face the surface while
/// the node's averaged normal leans away from it. Nothing touches, so nothing is closed.
#[test]
fn a_body_with_sharp_edges_that_hovers_touches_nothing() {
    for seed in 1..=60 {
        let mut random = Random(seed);
        let mut mesh = crate::support::mesh::ball(1 + (seed % 2) as usize);
        let turn = Rotation3::new(random.vector(3.0));
        mesh.x.iter_mut().for_each(|x| *x = turn * *x);
        let lowest = mesh.x.iter().map(|x| x.z).fold(f64::INFINITY, f64::min);
        mesh.x.iter_mut().for_each(|x| x.z += 0.3 - lowest);
        for (shape, depth) in [(AnalyticShape::Plane, 0.0), (AnalyticShape::Sphere(3.0), 3.0)] {
            let p = Vec3::new(0.1, 0.2, -depth);
            let frame = [p, p + Vec3::z(), p + Vec3::x(), p + Vec3::y()];
            for apart in [true, false] {
                let mut options = Options { mu: 0.3, ..Options::paper(Stiffness::Modulus(1.0)) };
                (options.shortcuts.apart, options.shortcuts.uncovered) = (apart, apart);
                let mut contact: Contact<3> = against(&mesh, shape, &frame, options).unwrap();
                let lambda = vec![Vec3::zeros(); mesh.x.len()];
                let states = contact.responses(&mesh.x, &frame, &lambda, None).unwrap();
                assert!(states.iter().all(|r| r.state == State::Gap), "seed {seed}, {shape:?}");
                // However it falls, it is let down to the surface.
                let (dx, rest) = (vec![Vec3::z() * -0.29; mesh.x.len()], [Vec3::zeros(); 4]);
                let fraction = contact.step_limit((&mesh.x, &frame), (&dx, &rest), None).unwrap();
                assert_eq!(fraction, 1.0, "seed {seed}, {shape:?}");
            }
        }
    }
}
