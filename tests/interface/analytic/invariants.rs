//! What holds whatever the shape: rigid motions, balance, slip, restart.

use super::*;
use crate::support::mesh::options;
use stickslip::error::Kind;
use stickslip::interface::{Friction, seal_history};
use stickslip::law::State;

/// Dual functions are up to 4 on a quadrilateral, and gaps are differences of what they are multiplied with.
const OF_DUAL: f64 = 10.0;

/// Every shape with either basis.
fn cases() -> impl Iterator<Item = (AnalyticShape, Options)> {
    SHAPES.into_iter().flat_map(|shape| BASES.map(|basis| (shape, Options { basis, ..options() })))
}

/// A rigid motion of everything, its history included, turns the forces and changes nothing else.
#[test]
fn rigid_motion_of_everything_turns_the_forces() {
    let (q, shift) = (Rotation3::from_euler_angles(-1.0, 0.7, 2.0), Vec3::new(-4.0, 5.0, 2.0));
    for (shape, options) in cases() {
        let mut a = Rough::<3>::new(shape, Cells::Quads, options);
        let mut b = Rough::<3>::new(shape, Cells::Quads, options);
        let start = a.contact.history().clone();
        let start = [&start.x1, &start.x2].map(|x| turned(&q, shift, x));
        // The first frame is where the surface was created; its motion to here is rigid.
        b.contact.set_previous(&start[0], &start[1]).unwrap();
        (b.x1, b.x2) = (turned(&q, shift, &a.x1), turned(&q, shift, &a.x2));
        b.lambda = turned(&q, Vec3::zeros(), &a.lambda);
        let at_a = a.contact.residual(&a.x1, &a.x2, &a.lambda, None).unwrap();
        let at_b = b.contact.residual(&b.x1, &b.x2, &b.lambda, None).unwrap();
        let of_basis = if options.basis == MultiplierBasis::Dual { OF_DUAL } else { 1.0 };
        for (a, b) in [(&at_a.nonmortar, &at_b.nonmortar), (&at_a.mortar, &at_b.mortar), (&at_a.rows, &at_b.rows)] {
            close(&flatten(b), &flatten(&turned(&q, Vec3::zeros(), a)), of_basis * ROUNDING, "forces");
        }
    }
}

/// Within a step, the objective measure sees no slip when both sides turn together.
#[test]
fn a_common_rotation_within_a_step_is_no_slip() {
    let q = Rotation3::from_euler_angles(0.2, -0.3, 0.5);
    for (shape, options) in cases() {
        let mut rough = Rough::<3>::new(shape, Cells::Triangles, options);
        let start = rough.contact.history().clone();
        let [x1, x2] = [&start.x1, &start.x2].map(|x| turned(&q, Vec3::x(), x));
        for response in rough.contact.responses(&x1, &x2, &rough.lambda, None).unwrap() {
            assert!(response.slip.norm() <= ROUNDING, "{shape:?}: {:e}", response.slip.norm());
        }
    }
}

/// Forces on both sides cancel; their moments leave that of the tractions across the gap, sum g_A x t_A.
#[test]
fn forces_and_moments_balance() {
    for (shape, options) in cases() {
        let mut rough = Rough::<3>::new(shape, Cells::Quads, options);
        let sums = rough.contact.sums(&rough.x1, &rough.x2).unwrap();
        let r = rough.contact.residual(&rough.x1, &rough.x2, &rough.lambda, None).unwrap();
        let total: Vec3 = r.nonmortar.iter().chain(&r.mortar).sum();
        let moment = |x: &[Vec3], f: &[Vec3]| x.iter().zip(f).map(|(x, f)| x.cross(f)).sum::<Vec3>();
        let moments = moment(&rough.x1, &r.nonmortar) + moment(&rough.x2, &r.mortar);
        let across: Vec3 = sums.iter().zip(&rough.lambda).map(|(s, t)| s.gap_now.cross(t)).sum();
        let scale = max_abs(r.nonmortar.iter().chain(&r.mortar).map(|f| f.norm()));
        assert!(total.norm() <= ROUNDING * scale, "{shape:?}: force {total}");
        assert!((moments - across).norm() <= 10.0 * ROUNDING * scale, "{shape:?}: moment {}", moments - across);
        if options.basis == MultiplierBasis::Dual {
            for ((force, sum), lambda) in r.nonmortar.iter().zip(&sums).zip(&rough.lambda) {
                assert!((force - lambda * sum.coverage).norm() <= ROUNDING * scale, "{shape:?}: {force}");
            }
        }
    }
}

/// A ball that turns under a small stuck patch drags its surface along by R dtheta.
#[test]
fn turning_ball_slips_by_the_arc() {
    const RADIUS: f64 = 2.0;
    const ANGLE: f64 = 1e-3;
    /// Half the patch's width over the radius, squared: how far its points are from the pole.
    const PATCH: f64 = 1e-4;
    let width = 2.0 * RADIUS * PATCH.sqrt();
    let mut mesh = grid(2, 2, [-0.5 * width; 2], [0.5 * width; 2], RADIUS, false, Cells::Quads);
    mesh.x.iter_mut().for_each(|x| x.z -= 1e-9);
    let frame = vec![Vec3::zeros(), Vec3::x(), Vec3::y(), Vec3::z()];
    let mut contact: Contact<3> = against(
        &mesh,
        AnalyticShape::Sphere(RADIUS),
        &frame,
        Options { friction: Friction::Rough, mu: 0.0, ..options() },
    )
    .unwrap();
    let x2 = turned(&Rotation3::from_axis_angle(&Vec3::y_axis(), ANGLE), Vec3::zeros(), &frame);
    let sums = contact.sums(&mesh.x, &x2).unwrap();
    let lambda = vec![Vec3::new(0.0, 0.0, -1.0); mesh.x.len()];
    for (response, sums) in contact.responses(&mesh.x, &x2, &lambda, None).unwrap().iter().zip(sums) {
        assert_eq!(response.state, State::Stick);
        // The ball's points moved by +R dtheta along x; the patch slips the other way.
        let slip = response.slip / sums.coverage_previous;
        assert!((slip + Vec3::x() * (RADIUS * ANGLE)).norm() <= 2.0 * PATCH * RADIUS * ANGLE, "{slip}");
    }
}

/// History goes out and in, and back, bit for bit.
#[test]
fn restart_and_rollback() {
    for (shape, options) in cases() {
        let mut a = Rough::<3>::new(shape, Cells::Quads, options);
        let before = a.contact.residual(&a.x1, &a.x2, &a.lambda, None).unwrap();
        a.contact.commit(&a.x1, &a.x2, &a.lambda, None).unwrap();
        let (integers, reals) = a.contact.export_history().unwrap();
        let after = a.contact.residual(&a.x1, &a.x2, &a.lambda, None).unwrap();
        let mut b = Rough::<3>::new(shape, Cells::Quads, options);
        b.contact.import_history(&integers, &reals).unwrap();
        assert_eq!(b.contact.residual(&a.x1, &a.x2, &a.lambda, None).unwrap(), after);
        a.contact.roll_back().unwrap();
        assert_eq!(a.contact.residual(&a.x1, &a.x2, &a.lambda, None).unwrap(), before);
        let mut other = Rough::<3>::new(AnalyticShape::Sphere(3.5), Cells::Quads, options);
        assert_eq!(other.contact.import_history(&integers, &reals).unwrap_err().kind, Kind::HistoryMismatch);
        let mut reals = reals;
        reals[3 * a.x1.len()] += 0.1; // P0
        let mut integers = integers;
        seal_history(&mut integers, &reals);
        let error = b.contact.import_history(&integers, &reals).unwrap_err();
        assert_eq!(error.kind, Kind::HistoryMismatch);
        assert!(error.message.contains("rigid body"), "{}", error.message);
    }
}
