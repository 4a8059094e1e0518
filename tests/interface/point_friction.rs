//! Friction where points decide (docs/formulation 16.7): the tangent against differences, momentum, the law without friction as its
//! limit, patches that stick and slide, rest, history, what is refused.

use crate::support::differences::Point;
use crate::support::lines::*;
use crate::support::max_abs;
use crate::support::mesh::*;
use stickslip::error::Kind;
use stickslip::geometry::Vec3;
use stickslip::interface::{
    Contact, Decision, Friction, Interface, MultiplierBasis, Options, Residual, Stiffness, Weights,
};
use stickslip::law::{Own, SlipMeasure, State};
use stickslip::line::Measure;

const MODULUS: f64 = 30.0;
/// Differences: truncation 1e-12 and rounding 1e-10 of a step of 1e-6.
const DIFFERENCES: f64 = 1e-7;
/// Sums of some dozen products, over the largest.
const ROUNDING: f64 = 1e-13;
/// The same of a traction on the cone, that is divided by its length once a step.
const REST: f64 = 1e-12;
const STEPS_OF_REST: usize = 400;
const CELLS: [[Cells; 2]; 4] = [
    [Cells::Quads, Cells::Quads],
    [Cells::Triangles, Cells::Triangles],
    [Cells::Quads, Cells::Triangles],
    [Cells::Triangles, Cells::Quads],
];

fn by_points(mu: f64) -> Options {
    let of = Options::paper(Stiffness::Modulus(MODULUS));
    let (basis, decision, weights) = (MultiplierBasis::Dual, Decision::Points(MODULUS), Weights::Reference);
    Options { basis, decision, weights, friction: Friction::Coulomb, mu, ..of }
}

/// With the weights of the first configuration and with those of the last commit.
fn both(mu: f64) -> [Options; 2] {
    [Weights::Reference, Weights::Committed].map(|weights| Options { weights, ..by_points(mu) })
}

struct Scene {
    contact: Interface,
    x1: Vec<Vec3>,
    x2: Vec<Vec3>,
    lambda: Vec<Vec3>,
}

/// Multipliers that make points of all states occur.
fn scene(options: Options, cells: [Cells; 2], rough: Roughness, seed: u64) -> Scene {
    let Moved { interface, x1, x2, lambda } = moved(&options, cells, rough, seed);
    Scene { contact: interface, x1, x2, lambda }
}

impl Scene {
    fn residual(&mut self) -> Residual<3> {
        self.contact.residual(&self.x1, &self.x2, &self.lambda, None).unwrap()
    }

    fn commit(&mut self) {
        self.contact.commit(&self.x1, &self.x2, &self.lambda, None).unwrap();
    }

    fn error(&mut self) -> f64 {
        let Scene { contact, x1, x2, lambda } = self;
        Point { contact, x1, x2, lambda }.difference_error(0.0)
    }
}

/// Worst difference of two residuals, over the largest entry of the second.
fn difference(one: &Residual<3>, two: &Residual<3>) -> f64 {
    let all = |r: &Residual<3>| -> Vec<f64> {
        r.nonmortar.iter().chain(&r.mortar).chain(&r.rows).flat_map(|v| v.iter().copied()).collect()
    };
    let (one, two) = (all(one), all(two));
    max_abs(one.iter().zip(&two).map(|(a, b)| a - b)) / max_abs(two.iter().copied())
}

#[test]
fn tangents_are_those_of_differences_for_every_kind_on_every_kind() {
    let mut seen = [0; 3];
    for (cells, (slide, seed)) in CELLS.into_iter().flat_map(|c| [(0.02, 3), (0.02, 8), (1.3, 5)].map(|s| (c, s))) {
        let kinds = [(FLAT, 0.7), (Roughness { warp: 0.03, jitter: 0.08, slide }, 0.3)];
        for (rough, options) in kinds.into_iter().flat_map(|(rough, mu)| both(mu).map(|of| (rough, of))) {
            let mut s = scene(options, cells, rough, seed);
            let responses = s.contact.responses(&s.x1, &s.x2, &s.lambda, None).unwrap();
            responses.iter().for_each(|r| seen[r.state as usize] += 1);
            let error = s.error();
            assert!(error <= DIFFERENCES, "{seed}: {error:e}");
            // What points remember shifts the cone, and is no unknown.
            s.commit();
            // No point is so near to another state that a difference reaches it.
            s.lambda.iter_mut().for_each(|v| *v += Vec3::new(0.0632, -0.02, 0.03));
            s.x1.iter_mut().enumerate().for_each(|(k, x)| x.y += 0.003 * (k % 3) as f64);
            let error = s.error();
            assert!(error <= DIFFERENCES, "after a commit {seed}: {error:e}");
        }
    }
    assert!(seen[State::Gap as usize] > 10 && seen[State::Slip as usize] > 10, "open, sticking, slipping: {seen:?}");
}

#[test]
fn tangents_of_lines_are_those_of_differences() {
    for (measure, seed) in [Measure::Thickness(0.7), Measure::Axisymmetric].into_iter().flat_map(|m| [(m, 1), (m, 2)]) {
        for options in both(0.4) {
            let mut s = moved_lines::<3>(&options, [2, 2], measure, seed);
            let error = s.difference_error();
            assert!(error <= DIFFERENCES, "{measure:?} {seed}: {error:e}");
            s.contact.commit(&s.x1, &s.x2, &s.lambda, None).unwrap();
            s.lambda.iter_mut().for_each(|v| *v *= 1.1);
            let error = s.difference_error();
            assert!(error <= DIFFERENCES, "after a commit {measure:?} {seed}: {error:e}");
        }
    }
}

/// Newton's matrix of a plan, in two numbers of threads, is that of entries one by one.
#[test]
fn shear_has_a_limit_and_rough_points_stick() {
    const LIMIT: f64 = 0.15;
    // The frame of `moved`.
    let nu = nalgebra::Rotation3::from_euler_angles(0.4, -0.9, 1.3) * Vec3::z();
    let (mut limited, mut stuck) = (0, 0);
    for (of, seed) in both(0.7).into_iter().flat_map(|of| [3, 8].map(|seed| (of, seed))) {
        let tresca = |limit| Options { friction: Friction::Tresca, shear_limit: Some(limit), ..of };
        let mut cone = scene(of, CELLS[0], FLAT, seed);
        let far_off = scene(tresca(1e9), CELLS[0], FLAT, seed).residual();
        assert_eq!(difference(&far_off, &cone.residual()), 0.0, "no point reaches it");
        let mut s = scene(tresca(LIMIT), CELLS[0], FLAT, seed);
        assert!(s.error() <= DIFFERENCES);
        limited += i32::from(difference(&s.residual(), &cone.residual()) > 0.01);
        for r in s.contact.responses(&s.x1, &s.x2, &s.lambda, None).unwrap() {
            // Means of points' tractions, all of them along flat facets.
            let shear = r.traction - nu * nu.dot(&r.traction);
            assert!(shear.norm() <= LIMIT * (1.0 + ROUNDING), "{shear}");
        }
        let mut rough = scene(Options { friction: Friction::Rough, mu: 0.0, ..of }, CELLS[0], FLAT, seed);
        assert!(rough.error() <= DIFFERENCES);
        let responses = rough.contact.responses(&rough.x1, &rough.x2, &rough.lambda, None).unwrap();
        assert!(responses.iter().all(|r| r.state != State::Slip));
        stuck += responses.iter().filter(|r| r.state == State::Stick).count();
    }
    assert!(limited > 0 && stuck > 10, "{limited} {stuck}");
}

#[test]
fn a_plan_has_the_same_tangent() {
    for (threads, cells) in [(1, CELLS[0]), (3, CELLS[2])] {
        let mut s = scene(Options { threads, ..by_points(0.4) }, cells, FLAT, 3);
        let Scene { contact, x1, x2, lambda } = &mut s;
        let error = Point { contact, x1, x2, lambda }.plan_error();
        assert!(error <= ROUNDING, "{error:e}");
    }
}

#[test]
fn forces_add_up_to_nothing() {
    for (cells, seed, options) in
        CELLS.into_iter().flat_map(|c| [3, 8].map(|s| (c, s))).flat_map(|(c, s)| both(0.5).map(|of| (c, s, of)))
    {
        let mut s = scene(options, cells, Roughness { warp: 0.03, jitter: 0.08, slide: 0.3 }, seed);
        s.commit();
        let r = s.residual();
        let largest = max_abs(r.nonmortar.iter().flat_map(|f| f.iter().copied()));
        let sum: Vec3 = r.nonmortar.iter().chain(&r.mortar).sum();
        assert!(largest > 1e-3 && sum.amax() <= ROUNDING * largest, "{sum} of {largest:e}");
    }
}

/// With mu = 0 everywhere forces and rows along the normals are those without friction, and rows along the surface pull what is left
/// of a multiplier there to nothing.
#[test]
fn without_friction_it_is_the_law_of_one_multiplier() {
    for cells in CELLS {
        let mut s = scene(by_points(0.0), cells, Roughness { warp: 0.02, jitter: 0.05, slide: 0.1 }, 3);
        let normals: Vec<_> = (0..s.x1.len()).map(|a| s.contact.normal(a).unwrap()).collect();
        let (one, two) = s.contact.surfaces();
        let of = Options { friction: Friction::None, mu: 0.0, ..by_points(0.0) };
        let mut smooth: Contact<1> = contact(&mesh_of(one), &mesh_of(two), false, of);
        let lambda: Vec<_> = s.lambda.iter().zip(&normals).map(|(l, nu)| nalgebra::Vector1::new(nu.dot(l))).collect();
        s.lambda = normals.iter().zip(&lambda).map(|(nu, l)| nu * l[0]).collect();
        let (r, expected) = (s.residual(), smooth.residual(&s.x1, &s.x2, &lambda, None).unwrap());
        let largest = max_abs(expected.nonmortar.iter().flat_map(|f| f.iter().copied()));
        for (f, e) in r.nonmortar.iter().zip(&expected.nonmortar).chain(r.mortar.iter().zip(&expected.mortar)) {
            assert!((f - e).amax() <= ROUNDING * largest, "{f} {e}");
        }
        for ((row, e), nu) in r.rows.iter().zip(&expected.rows).zip(&normals) {
            assert!((row - nu * e[0]).amax() <= ROUNDING * largest, "{row} {e}");
        }
    }
}

/// A flat interface, all closed, constant tractions: those within the cone stick without slip and those on it slide by any slip. The
/// rows vanish, and the forces are those of nodes with dual multipliers.
#[test]
fn patches_stick_and_slide_as_nodes_do() {
    let flat = Roughness { warp: 0.0, jitter: 0.1, slide: 0.0 };
    for (cells, share, state) in CELLS.into_iter().flat_map(|c| [(c, 0.9, State::Stick), (c, 1.0, State::Slip)]) {
        let m = moved(&by_points(0.4), cells, flat, 4);
        let (one, two) = m.interface.surfaces();
        let (one, two) = (mesh_of(one), mesh_of(two));
        let of = by_points(0.4);
        let mut points = interface(&one, &two, of);
        let mut nodes = interface(&one, &two, Options { decision: Decision::Nodes, ..of });
        let nu = points.normal(0).unwrap();
        let along = nu.cross(&Vec3::new(1.0, 0.3, 0.2)).normalize();
        let lambda = vec![nu * -0.7 + along * (0.4 * 0.7 * share); one.x.len()];
        let slip = along * if state == State::Slip { 0.01 } else { 0.0 };
        let x1: Vec<_> = one.x.iter().map(|x| x + slip).collect();
        let [p, n] = [&mut points, &mut nodes].map(|c| c.residual(&x1, &two.x, &lambda, None).unwrap());
        let error = difference(&p, &n);
        assert!(error <= ROUNDING, "{state:?}: {error:e}");
        let (rows, largest) =
            (max_abs(p.rows.iter().map(|row| row.amax())), max_abs(p.nonmortar.iter().map(|f| f.amax())));
        assert!(rows <= ROUNDING * largest, "{state:?}: {rows:e}");
        let responses = points.responses(&x1, &two.x, &lambda, None).unwrap();
        assert!(responses.iter().all(|r| r.state == state), "{state:?}");
    }
}

/// Nothing creeps: after a commit the same point has the same forces and rows, whatever it was.
#[test]
fn rest_changes_nothing() {
    for options in both(0.4) {
        let mut s = scene(options, CELLS[0], Roughness { warp: 0.02, jitter: 0.05, slide: 0.1 }, 8);
        // The first commit makes new weights, the second one brings tractions onto the cone of these.
        s.commit();
        s.commit();
        let first = s.residual();
        for _ in 0..STEPS_OF_REST {
            s.commit();
        }
        let error = difference(&s.residual(), &first);
        assert!(error <= REST, "{error:e}");
    }
}

#[test]
fn histories_go_on_with_the_same_bits() {
    for options in both(0.4) {
        let rough = Roughness { warp: 0.02, jitter: 0.05, slide: 0.3 };
        let mut s = scene(options, CELLS[2], rough, 3);
        let first = s.residual();
        s.commit();
        s.lambda.iter_mut().for_each(|v| *v *= 0.8);
        let second = s.residual();
        let (integers, reals) = s.contact.export_history().unwrap();
        let mut other = scene(options, CELLS[2], rough, 3);
        other.lambda.clone_from(&s.lambda);
        assert!(second != other.residual(), "points remember something");
        other.contact.import_history(&integers, &reals).unwrap();
        assert!(second == other.residual());
        s.contact.roll_back().unwrap();
        s.lambda.iter_mut().for_each(|v| *v /= 0.8);
        assert!(difference(&first, &s.residual()) <= ROUNDING);
        let mut nodes = moved(&Options { decision: Decision::Nodes, ..options }, CELLS[2], rough, 3).interface;
        let error = nodes.import_history(&integers, &reals).unwrap_err();
        assert!(error.kind == Kind::HistoryMismatch, "{error}");
    }
}

/// Points were those of the creation, though `set_previous` had made another configuration the first.
#[test]
fn points_after_set_previous_are_of_its_positions() {
    for cells in CELLS {
        let of = by_points(0.4);
        let mut s = scene(of, cells, Roughness { warp: 0.03, jitter: 0.08, slide: 0.4 }, 3);
        s.contact.set_previous(&s.x1, &s.x2).unwrap();
        let (one, two) = s.contact.surfaces();
        let at = |mesh: Mesh, x: &[Vec3]| Mesh { x: x.to_vec(), ..mesh };
        let mut there = interface(&at(mesh_of(one), &s.x1), &at(mesh_of(two), &s.x2), of);
        let after = |c: &mut Interface| {
            c.commit(&s.x1, &s.x2, &s.lambda, None).unwrap();
            let away: Vec<_> = s.x1.iter().map(|x| x + Vec3::new(0.01, 0.02, -0.01)).collect();
            c.residual(&away, &s.x2, &s.lambda, None).unwrap()
        };
        assert!(after(&mut s.contact) == after(&mut there));
    }
}

#[test]
fn what_friction_at_points_does_not_go_with_is_refused_by_name() {
    let refused = |options: Options, word: &str| {
        let error = options.validate().unwrap_err();
        assert!(error.kind == Kind::Unsupported && error.message.contains(word), "{error}");
    };
    let of = by_points(0.4);
    refused(Options { weights: Weights::Current, ..of }, "WEIGHTS_COMMITTED");
    refused(Options { slip: SlipMeasure::Paper, ..of }, "paper's slip measure");
    refused(Options { friction: Friction::Tied, mu: 0.0, ..of }, "tied");
    let limited = Options { friction: Friction::Tresca, shear_limit: Some(0.2), weights: Weights::Current, ..of };
    refused(limited, "WEIGHTS_COMMITTED");
    let mut s = scene(by_points(0.4), CELLS[0], FLAT, 3);
    let slip = vec![Vec3::zeros(); s.x1.len()];
    let error = s.contact.set_committed(&s.x1, &s.x2, &slip, 1).unwrap_err();
    assert!(error.kind == Kind::Unsupported && error.message.contains("history"), "{error}");
    let own = Own::Cohesion { cohesion: 0.1 };
    let error = s.contact.set_law(Some(own)).unwrap_err();
    assert!(error.kind == Kind::Unsupported && error.message.contains("law of one's own"), "{error}");
}

/// Offsets that reach farther than those before have pairs sought anew, whose points have not slipped: it was refused, or every
/// evaluation after it.
#[test]
fn offsets_before_the_first_commit_are_taken() {
    for options in both(0.4) {
        let mut s = scene(options, CELLS[0], FLAT, 3);
        let (n, without) = (s.x1.len(), s.residual());
        for offset in [-0.02, 0.01] {
            s.contact.set_offsets([Some(vec![offset; n]), None]).unwrap();
            let with = s.residual();
            assert!(difference(&with, &without) > 0.0, "{offset}");
        }
    }
}
