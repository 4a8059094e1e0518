//! Rigid bodies with six unknowns, and with three in the plane: against a body that is meshed and 1000 times stiffer, against
//! statics, and against Hertz (docs/formulation 14). The tangent against differences: `tests/capi/t94_rigid.c`.

use crate::support::host::{self, Host};
use crate::support::mesh::{Cells, Mesh, ball, grid};
use crate::support::rigid::{Contacts, Elastic};
use nalgebra::{DMatrix, DVector, Matrix3, Rotation3, SVector};
use std::f64::consts::{FRAC_PI_2, PI};
use stickslip::geometry::Vec3;
use stickslip::interface::{Friction, Options, Stiffness};
use stickslip::line::Measure;
use stickslip::rigid::rotation;

/// Of the displacement of a body 1000 times stiffer than what it stands on.
const AS_STIFF: f64 = 1e-4;
/// Of the load: what Newton's method leaves of an equilibrium, above rounding.
const STATICS: f64 = 1e-9;
/// Quadratic convergence from where bodies just touch.
const FEW_STEPS: usize = 12;

/// Newton steps of a plate 1000 times stiffer, over its displacement: what its own rounding leaves.
const ROUNDING: f64 = 1e-9;

const YOUNG: f64 = 1000.0;

fn options(friction: Friction) -> Options {
    Options { friction, ..Options::paper(Stiffness::Modulus(YOUNG)) }
}

/// A layer of hexahedra whose far side is held.
fn layer(surface: Mesh, far: Vec3, young: f64) -> Elastic {
    let body = host::Body::new(surface, far, young, 0.3);
    let n = 3 * body.surface.x.len();
    Elastic {
        stiffness: body.stiffness.view((0, 0), (n, n)).into_owned(),
        load: DVector::zeros(n),
        surface: body.surface,
    }
}

/// A tall block tied to a soft layer, pushed aside, pressed and turned by a force and a moment at its upper side. Compared is the
/// motion of its lower side as a whole; the layer's own solution differs by more at the edges, where it is singular.
#[test]
fn a_free_body_moves_as_one_that_is_meshed_and_1000_times_stiffer() {
    let lower = || grid(3, 3, [0.0, 0.0], [1.0, 1.0], 0.0, true, Cells::Quads);
    let upper = || grid(2, 2, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads);
    let down = -Vec3::z();
    // Small: the mesh's strains are those of small rotations.
    let (force, tilt) = (Vec3::new(2e-4, 3e-4, -1e-3), Vec3::new(4e-5, -3e-5, 5e-5));
    let mut errors = Vec::new();
    for stiffer in [1e3, 1e4] {
        let body = host::Body::new(lower(), down, YOUNG, 0.3);
        let plate = host::Body::new(upper(), Vec3::z() * 4.0, stiffer * YOUNG, 0.3);
        let mut meshed = Host::<3>::new(body, Ok(plate), options(Friction::Tied));
        meshed.hold(0, |_| Vec3::zeros());
        // Forces on the plate's upper side, linear in the place: a field t + w x (x - c) has the moment J w about c.
        let range = meshed.far(1);
        let m = range.len() / 3;
        let (x, areas) = (meshed.bodies[1].x[m..].to_vec(), meshed.bodies[1].areas());
        let centre: Vec3 = x.iter().zip(&areas).map(|(x, a)| x * *a).sum();
        let inertia: Matrix3<f64> = x
            .iter()
            .zip(&areas)
            .map(|(x, a)| {
                let arm = x - centre;
                (Matrix3::identity() * arm.norm_squared() - arm * arm.transpose()) * *a
            })
            .sum();
        let turn = inertia.try_inverse().unwrap() * tilt;
        let (mut moment, point) = (Vec3::zeros(), Vec3::new(0.3, 0.6, 0.2));
        for (k, (x, a)) in x.iter().zip(&areas).enumerate() {
            let f = (force + turn.cross(&(x - centre))) * *a;
            moment += (x - point).cross(&f);
            meshed.load.fixed_rows_mut::<3>(range.start + 3 * k).copy_from(&f);
        }
        meshed.solve_to(ROUNDING);
        let (_, found) = meshed.positions();

        let mut rigid = Contacts::<3>::new(
            vec![layer(lower(), down, YOUNG)],
            (vec![upper()], point, [true; 6]),
            true,
            None,
            &options(Friction::Tied),
        );
        rigid.load = SVector::from_iterator(force.iter().chain(&moment).copied());
        rigid.solve();
        let (u, theta): (Vec3, Vec3) = (rigid.q.fixed_rows::<3>(0).into(), rigid.q.fixed_rows::<3>(3).into());
        assert!(theta.amax() > 1e-7, "it turns: {theta}");
        let moved = |x: &Vec3| u + rotation(&theta) * (x - point) + point;
        let largest = upper().x.iter().map(|x| (moved(x) - x).norm()).fold(0.0, f64::max);
        // The motion of the meshed one: the mean of its nodes' and their mean turn.
        let (mut mean, mut spin, mut arms) = (Vec3::zeros(), Vec3::zeros(), Matrix3::zeros());
        let (middle, n) = (Vec3::new(0.5, 0.5, 0.0), upper().x.len() as f64);
        for (x, now) in upper().x.iter().zip(&found) {
            let (arm, off) = (x - middle, now - moved(x));
            mean += off / n;
            spin += arm.cross(&off);
            arms += Matrix3::identity() * arm.norm_squared() - arm * arm.transpose();
        }
        let spin = arms.try_inverse().unwrap() * spin;
        let error = (mean.norm() + spin.norm() * 0.5_f64.sqrt()) / largest;
        println!("{stiffer:.0e} times stiffer: off by {error:.2e} of the displacement");
        errors.push(error);
    }
    assert!(errors[0] <= AS_STIFF, "{errors:?}");
    // What is left goes with the stiffness: the rigid body is the limit.
    assert!(errors[1] <= 0.2 * errors[0], "{errors:?}");
}

/// A layer under a plane with this inward normal at a distance from the origin.
fn wall(normal: Vec3, distance: f64) -> Elastic {
    let turn = Rotation3::rotation_between(&Vec3::z(), &normal).unwrap();
    let mut surface = grid(6, 6, [-0.45, -0.45], [0.45, 0.45], -distance, true, Cells::Quads);
    surface.x.iter_mut().for_each(|x| *x = turn * *x);
    layer(surface, -normal * 0.4, YOUNG)
}

/// A plate on a tied layer that a moment turns by an angle that is not small: six equations, and as many rows and columns
/// whatever its mesh.
#[test]
fn a_plate_turns_far_and_its_rows_do_not_grow_with_its_mesh() {
    let mut counts = Vec::new();
    for n in [2, 8] {
        let lower = grid(3, 3, [0.0, 0.0], [1.0, 1.0], 0.0, true, Cells::Quads);
        let upper = grid(n, n, [-0.5, -0.5], [1.5, 1.5], 0.0, false, Cells::Quads);
        let point = Vec3::new(0.5, 0.5, 0.5);
        let mut scene = Contacts::<3>::new(
            vec![layer(lower, -Vec3::z(), YOUNG)],
            (vec![upper], point, [true; 6]),
            true,
            None,
            &options(Friction::Tied),
        );
        let (mut steps, mut entries) = (0, 0);
        for step in 1..=4 {
            scene.load = SVector::from([4.0, -3.0, -10.0, 15.0, 8.0, 25.0]) * f64::from(step);
            (steps, entries) = scene.solve();
            scene.commit();
        }
        let forces: Vec3 = scene.forces_on_elastic(0).iter().sum();
        let on_plate = scene.load.fixed_rows::<3>(0);
        assert!((forces + on_plate).norm() <= STATICS * on_plate.norm(), "{forces} {on_plate}");
        let angle = scene.turned.trace().mul_add(0.5, -0.5).acos();
        println!("turned by {:.1} degrees, {steps} steps, {entries} entries", angle.to_degrees());
        assert!(angle > 0.3 && steps <= FEW_STEPS);
        counts.push(entries);
    }
    assert_eq!(counts[0], counts[1]);
}

/// Flats of Flamant's half plane, of which a half disc of elements is taken.
mod half_plane {
    use super::*;

    /// Displacement under a line load of 1 along the inward normal y, at (x, y), relative to (0, depth) (K. L. Johnson, Contact
    /// mechanics, 1985, 2.3).
    pub fn flamant([x, y]: [f64; 2], depth: f64, young: f64, poisson: f64) -> [f64; 2] {
        let (r, theta) = (x.hypot(y), x.atan2(y));
        let e = PI * young;
        let (a, b) = ((1.0 - poisson * poisson) / e, (1.0 - 2.0 * poisson) * (1.0 + poisson) / e);
        let (sin, cos) = theta.sin_cos();
        let c = 2.0 * a * depth.ln(); // u_r = 0 at (0, depth)
        let radial = -2.0 * a * cos * r.ln() - b * theta * sin + c * cos;
        let around =
            2.0 * a * sin * r.ln() + 2.0 * poisson * (1.0 + poisson) / e * sin - b * theta * cos + b * sin - c * sin;
        [radial * sin + around * cos, radial * cos - around * sin]
    }

    /// Stiffness of a bilinear cell of thickness 1 in plane strain.
    fn cell(x: &[[f64; 2]; 4], young: f64, poisson: f64) -> SVectorMatrix {
        let (lame, shear) =
            (young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson)), young / (2.0 + 2.0 * poisson));
        let gauss = 1.0 / 3.0_f64.sqrt();
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        let mut k = SVectorMatrix::zeros();
        for (s, t) in [(-gauss, -gauss), (gauss, -gauss), (gauss, gauss), (-gauss, gauss)] {
            let slopes = corners.map(|[a, b]| [a * (1.0 + b * t) / 4.0, b * (1.0 + a * s) / 4.0]);
            let mut j = nalgebra::Matrix2::zeros();
            for (x, d) in x.iter().zip(&slopes) {
                j += nalgebra::Vector2::from(*x) * nalgebra::RowVector2::from(*d);
            }
            let to = j.try_inverse().unwrap().transpose();
            let mut b = nalgebra::SMatrix::<f64, 3, 8>::zeros();
            for (a, d) in slopes.iter().enumerate() {
                let d = to * nalgebra::Vector2::from(*d);
                (b[(0, 2 * a)], b[(1, 2 * a + 1)], b[(2, 2 * a)], b[(2, 2 * a + 1)]) = (d.x, d.y, d.y, d.x);
            }
            let d = Matrix3::new(lame + 2.0 * shear, lame, 0.0, lame, lame + 2.0 * shear, 0.0, 0.0, 0.0, shear);
            k += b.transpose() * d * b * j.determinant().abs();
        }
        k
    }

    type SVectorMatrix = nalgebra::SMatrix<f64, 8, 8>;

    /// A flat of size `reach`, `fine` a facet in the middle, whose outer border moves as Flamant's under `force`; `sign`: -1 below
    /// y = 0, +1 above it. The surface is refined towards the middle.
    pub fn flat(fine: f64, reach: f64, sign: f64, force: f64, (young, poisson): (f64, f64)) -> Elastic {
        // Even in the middle, then growing.
        let mut half = vec![0.0];
        let mut h = fine;
        while *half.last().unwrap() < reach {
            let last = *half.last().unwrap();
            if half.len() > 8 {
                h *= 1.3;
            }
            half.push((last + h).min(reach));
        }
        let mut xs: Vec<f64> = half[1..].iter().rev().map(|v| -v).collect();
        xs.extend(&half);
        let (nx, ny) = (xs.len(), half.len());
        let at = |i: usize, j: usize| [xs[i], half[j]];
        let mut k = DMatrix::<f64>::zeros(2 * nx * ny, 2 * nx * ny);
        for (i, j) in (0..nx - 1).flat_map(|i| (0..ny - 1).map(move |j| (i, j))) {
            let nodes = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
            let of = cell(&nodes.map(|(i, j)| at(i, j)), young, poisson);
            for (p, q) in (0..8).flat_map(|p| (0..8).map(move |q| (p, q))) {
                let number = |p: usize| 2 * (nodes[p / 2].1 * nx + nodes[p / 2].0) + p % 2;
                k[(number(p), number(q))] += of[(p, q)];
            }
        }
        // Surface nodes that move, inner ones, and those of the border.
        let is_border = |n: usize| n.is_multiple_of(nx) || n % nx == nx - 1 || n / nx == ny - 1;
        let scalars = |wanted: &dyn Fn(usize) -> bool| -> Vec<usize> {
            (0..nx * ny).filter(|n| wanted(*n)).flat_map(|n| [2 * n, 2 * n + 1]).collect()
        };
        let (own, inner, border) =
            (scalars(&|n| !is_border(n) && n < nx), scalars(&|n| !is_border(n) && n >= nx), scalars(&|n| is_border(n)));
        let part = |rows: &[usize], columns: &[usize]| k.select_rows(rows).select_columns(columns);
        let prescribed = DVector::from_iterator(
            border.len(),
            border.iter().map(|s| force * flamant(at(s / 2 % nx, s / 2 / nx), reach, young, poisson)[s % 2]),
        );
        // Inner nodes are eliminated: K_oo - K_oi K_ii^-1 K_io, and what the border's motion does.
        let mut right = part(&inner, &own).resize_horizontally(own.len() + 1, 0.0);
        right.set_column(own.len(), &(part(&inner, &border) * &prescribed));
        let solved = part(&inner, &inner).cholesky().unwrap().solve(&right);
        let coupled = part(&own, &inner) * solved;
        let mut stiffness = part(&own, &own) - coupled.columns(0, own.len());
        let mut load = coupled.column(own.len()) - part(&own, &border) * &prescribed;
        // From depth to height.
        for s in (1..own.len()).step_by(2).filter(|_| sign < 0.0) {
            stiffness.row_mut(s).neg_mut();
            stiffness.column_mut(s).neg_mut();
            load[s] = -load[s];
        }
        let x: Vec<_> = own.chunks(2).map(|s| Vec3::new(xs[s[0] / 2 % nx], 0.0, 0.0)).collect();
        let facet = |i: usize| if sign < 0.0 { vec![i as i64 + 1, i as i64] } else { vec![i as i64, i as i64 + 1] };
        let facets = (0..x.len() - 1).map(facet).collect();
        Elastic { surface: Mesh { x, facets }, stiffness, load }
    }
}

/// Half the width of a contact from its nodal forces: over Hertz' ellipse the mean of x^2 is a^2 / 4.
fn half_width_of(x: &[Vec3], forces: &[Vec3]) -> f64 {
    let [sum, second] = [0, 2].map(|power| x.iter().zip(forces).map(|(x, f)| f.y * x.x.powi(power)).sum::<f64>());
    2.0 * (second / sum).sqrt()
}

/// Hertz within 2 % at ten facets.
const HERTZ: f64 = 0.02;

/// Seconds and more: `make test-long`.
mod long {
    use super::*;

    /// Walls at 35 and at 50 degrees, a ball between them under its weight: their forces follow from two equations.
    #[test]
    fn a_ball_settles_into_a_groove_as_statics_say() {
        // A ball in closed form, to which only the other side can have the multipliers; and one of facets.
        let frame = Mesh { x: [Vec3::zeros(), Vec3::x(), Vec3::y(), Vec3::z()].to_vec(), facets: Vec::new() };
        for (elastic_first, ball) in [(true, frame), (true, ball(12)), (false, ball(12))] {
            let [a, b] = [35.0_f64, 50.0].map(f64::to_radians);
            let normals = [Vec3::new(a.sin(), 0.0, a.cos()), Vec3::new(-b.sin(), 0.0, b.cos())];
            let weight = 3.0;
            let mut scene = Contacts::<1>::new(
                normals.map(|normal| wall(normal, 0.97)).into(),
                // Without friction nothing holds it along the groove, nor against turning.
                (vec![ball.clone(); 2], Vec3::new(0.1, -0.2, 0.3), [true, false, true, false, false, false]),
                elastic_first,
                None,
                &options(Friction::None),
            );
            scene.load[2] = -weight;
            for step in 0..2 {
                let (steps, _) = scene.solve();
                assert!(steps <= FEW_STEPS, "{steps} steps");
                let expected = [b.sin(), a.sin()].map(|s| weight * s / (a + b).sin());
                let forces: [Vec3; 2] = [0, 1].map(|c| scene.forces_on_elastic(c).iter().sum());
                let sum = forces[0] + forces[1];
                // The ball's own equations hold whichever side has the normals.
                assert!((sum.z - weight).abs() <= STATICS * weight && sum.x.abs() <= STATICS * weight, "{sum}");
                // With the normals of the flat walls each force is that of statics; those of the ball lean as its facets do.
                for c in (0..2).filter(|_| elastic_first) {
                    let along = forces[c].dot(&normals[c]);
                    assert!(
                        (along - expected[c]).abs() <= STATICS * weight,
                        "wall {c}, step {step}: {along} {expected:?}"
                    );
                }
                scene.commit();
            }
            println!("the ball has moved by {:?}", scene.q.fixed_rows::<3>(0).as_slice());
        }
    }

    /// A rigid cylinder pressed by a force onto a flat, and one that finds its own height between two flats that close.
    #[test]
    fn a_cylinder_between_flats_is_hertz() {
        const FACETS: f64 = 10.0;
        const OF_CIRCLE: usize = 4000;
        let (poisson, radius, half_width) = (0.3, 1.0, 0.05);
        let modulus = YOUNG / (1.0 - poisson * poisson);
        // a^2 = 4 F R / (pi E'), and the approach of a rigid cylinder and a point at a depth (K. L. Johnson, Contact mechanics, 1985,
        // 4.3 and 5.6).
        let force = PI * half_width * half_width * modulus / (4.0 * radius);
        let (reach, fine) = (20.0 * half_width, 2.0 * half_width / FACETS);
        let logarithm = (2.0_f64 * reach / half_width).ln() - poisson / (2.0 * (1.0 - poisson));
        let approach = 2.0 * force / (PI * modulus) * logarithm;
        // A quarter of the circle towards a flat, fine against the flat's facets, its body to the left.
        let quarter = |middle: f64| -> Mesh {
            let angle = |k: usize| middle + FRAC_PI_2 * (k as f64 / OF_CIRCLE as f64 - 0.5);
            let x = (0..=OF_CIRCLE).map(|k| Vec3::new(angle(k).cos(), angle(k).sin(), 0.0) * radius).collect();
            Mesh { x, facets: (0..OF_CIRCLE as i64).map(|k| vec![k, k + 1]).collect() }
        };
        let flat = |sign: f64, descent: f64| {
            let mut flat = half_plane::flat(fine, reach, sign, force, (YOUNG, poisson));
            flat.surface.x.iter_mut().for_each(|x| x.y = sign * radius);
            // Its border comes down, and all of it with the border.
            let all = DVector::from_fn(flat.load.len(), |s, _| if s % 2 == 1 { -descent } else { 0.0 });
            flat.load += &flat.stiffness * all;
            flat
        };
        let free = [false, true, false, false, false, false];
        for two in [false, true] {
            let (flats, circles) = if two {
                (vec![flat(-1.0, 0.0), flat(1.0, 2.0 * approach)], vec![quarter(-FRAC_PI_2), quarter(FRAC_PI_2)])
            } else {
                (vec![flat(-1.0, 0.0)], vec![quarter(-FRAC_PI_2)])
            };
            let mut scene = Contacts::<1>::new(
                flats,
                (circles, Vec3::new(0.3, 0.2, 0.0), free),
                true,
                Some(Measure::Thickness(1.0)),
                &options(Friction::None),
            );
            scene.load[1] = if two { 0.0 } else { -force };
            scene.q[1] = -approach; // a circle touches in a point, which holds nothing
            let (steps, _) = scene.solve();
            let forces: Vec<Vec<Vec3>> = (0..scene.contacts.len()).map(|c| scene.forces_on_elastic(c)).collect();
            let sums: Vec<f64> = forces.iter().map(|f| f.iter().map(|f| f.y).sum()).collect();
            assert!((sums.iter().sum::<f64>() + scene.load[1]).abs() <= STATICS * force, "{sums:?}");
            assert!((sums[0] / force - 1.0).abs() <= if two { HERTZ } else { STATICS }, "{sums:?} {force}");
            let down = -scene.q[1];
            println!("{steps} steps, forces {sums:?} ({force}), approach {down:.6} ({approach:.6})");
            for (body, forces) in scene.elastic.iter().zip(&forces) {
                let found = half_width_of(&body.surface.x, forces);
                println!("half width {found:.5} ({half_width})");
                assert!((found / half_width - 1.0).abs() <= HERTZ);
            }
            assert!((down / approach - 1.0).abs() <= HERTZ);
        }
    }
}
