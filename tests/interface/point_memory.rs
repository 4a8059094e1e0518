//! Friction where points decide, with weights that are made anew at each commit (docs/formulation 16.9): what points remember turns with
//! the facets, goes on while surfaces slide over facets, takes work and never gives any back, and is refused where it does not fit.

use crate::support::lines::*;
use crate::support::max_abs;
use crate::support::mesh::*;
use nalgebra::{Rotation3, Unit};
use stickslip::error::Kind;
use stickslip::geometry::Vec3;
use stickslip::interface::{
    Decision, Friction, Interface, MultiplierBasis, NO_WEAK_COVERAGE, Options, Residual, Stiffness, Weights,
    seal_history,
};
use stickslip::law::State;
use stickslip::line::Measure;

const MODULUS: f64 = 30.0;
/// Sums of some dozen products over the largest, once a step.
const ROUNDING: f64 = 1e-12;
/// A turn by a quarter: what a step does wrong is of the second order of its angle, so that all of them are of the first.
const QUARTER: f64 = std::f64::consts::FRAC_PI_2;
/// Of forces after a quarter in steps of five degrees, over the largest. A step by theta leaves out 3/2 theta^2 z, all of them a fifth of
/// z, and with multipliers and gaps at random z is half of the tractions.
const TURNED: f64 = 0.1;
/// Of the same after twice as many steps over that before: a half, and what is of higher order.
const HALVED: f64 = 0.6;
/// What is left in steps of any size: surfaces whose heights are random have normals that differ by up to 0.016 from one facet to the
/// next, and the tangential parts by nodes and by facets differ by its square.
const ROUGH: f64 = 3e-4;
const CELLS: [[Cells; 2]; 3] =
    [[Cells::Quads, Cells::Quads], [Cells::Triangles, Cells::Quads], [Cells::Quads, Cells::Triangles]];

fn committed(mu: f64) -> Options {
    let of = Options::paper(Stiffness::Modulus(MODULUS));
    let (basis, decision, weights) = (MultiplierBasis::Dual, Decision::Points(MODULUS), Weights::Committed);
    Options { basis, decision, weights, friction: Friction::Coulomb, mu, ..of }
}

/// A square with the multipliers over a longer strip, both flat.
fn strip(cells: [Cells; 2]) -> [Mesh; 2] {
    let one = grid(2, 2, [0.0, 0.0], [1.0, 1.0], 0.0, false, cells[0]);
    [one, grid(9, 5, [-1.0, -0.7], [3.0, 1.8], 0.0, true, cells[1])]
}

fn largest(v: &[Vec3]) -> f64 {
    max_abs(v.iter().flat_map(|f| f.iter().copied()))
}

/// Worst difference of the forces, over the largest.
fn difference(one: &Residual<3>, two: &Residual<3>) -> f64 {
    let of = |r: &Residual<3>| -> Vec<Vec3> { r.nonmortar.iter().chain(&r.mortar).copied().collect() };
    let (one, two) = (of(one), of(two));
    let apart: Vec<_> = one.iter().zip(&two).map(|(a, b)| a - b).collect();
    largest(&apart) / largest(&two)
}

fn dissipation(contact: &Interface, nodes: usize) -> f64 {
    (0..nodes).map(|a| contact.dissipation(a)).sum()
}

/// Over three facets, with constant tractions on the cone: forces are those of nodes that decide, mu p in each step, and the work is
/// mu p times the way. Then half of the traction sticks and takes nothing.
#[test]
fn surfaces_slide_over_facets_at_the_limit() {
    for cells in CELLS {
        let [one, two] = strip(cells);
        let of = committed(0.4);
        let mut points = interface(&one, &two, of);
        let nodes = Options { decision: Decision::Nodes, weak_coverage: NO_WEAK_COVERAGE, ..of };
        let mut nodes = interface(&one, &two, nodes);
        let nu = points.normal(0).unwrap();
        let (along, way, pressure) = (Vec3::new(0.96, 0.28, 0.0), 0.15, 0.7);
        let lambda = vec![nu * -pressure + along * (0.4 * pressure); one.x.len()];
        let mut x1 = one.x.clone();
        for step in 0..10 {
            x1.iter_mut().for_each(|x| *x += along * way);
            let [p, n] = [&mut points, &mut nodes].map(|c| c.residual(&x1, &two.x, &lambda, None).unwrap());
            let (error, rows) = (difference(&p, &n), largest(&p.rows) / largest(&p.nonmortar));
            assert!(error <= ROUNDING && rows <= ROUNDING, "{step}: {error:e} {rows:e}");
            let work = dissipation(&points, x1.len()) / (0.4 * pressure * way) - 1.0;
            assert!(work.abs() <= ROUNDING, "{step}: {work:e}");
            let responses = points.responses(&x1, &two.x, &lambda, None).unwrap();
            assert!(responses.iter().all(|r| r.state == State::Slip), "{step}");
            [&mut points, &mut nodes].into_iter().for_each(|c| c.commit(&x1, &two.x, &lambda, None).unwrap());
        }
        let half = vec![nu * -pressure + along * (0.2 * pressure); one.x.len()];
        let r = points.residual(&x1, &two.x, &half, None).unwrap();
        assert!(largest(&r.rows) <= ROUNDING * largest(&r.nonmortar), "{}", largest(&r.rows));
        assert!(dissipation(&points, x1.len()) == 0.0);
        let responses = points.responses(&x1, &two.x, &half, None).unwrap();
        assert!(responses.iter().all(|r| r.state == State::Stick));
    }
}

/// Everything turns by a quarter in so many steps, with tractions of all directions that stick: how far the forces are then from those
/// before, turned.
fn turned(cells: [Cells; 2], axis: Vec3, steps: usize) -> f64 {
    let mut random = Random(7);
    let [one, two] = strip(cells);
    let mut contact = interface(&one, &two, committed(9.0));
    let (mut x1, mut x2) = (one.x.clone(), two.x.clone());
    x1.iter_mut().for_each(|x| *x += Vec3::new(0.3, 0.1, -0.004) + random.vector(0.002));
    let mut lambda: Vec<_> = x1.iter().map(|_| Vec3::new(0.1, 0.2, -0.6) + random.vector(0.15)).collect();
    contact.commit(&x1, &x2, &lambda, None).unwrap();
    let before = contact.residual(&x1, &x2, &lambda, None).unwrap();
    let turn = Rotation3::from_axis_angle(&Unit::new_normalize(axis), QUARTER / steps as f64);
    for _ in 0..steps {
        [&mut x1, &mut x2, &mut lambda].into_iter().flatten().for_each(|v| *v = turn * *v);
        contact.commit(&x1, &x2, &lambda, None).unwrap();
    }
    let after = contact.residual(&x1, &x2, &lambda, None).unwrap();
    let all = Rotation3::from_axis_angle(&Unit::new_normalize(axis), QUARTER);
    let of = |v: &[Vec3]| v.iter().map(|f| all * f).collect();
    difference(
        &after,
        &Residual { nonmortar: of(&before.nonmortar), mortar: of(&before.mortar), rows: of(&before.rows) },
    )
}

#[test]
fn tractions_turn_with_the_bodies() {
    for cells in CELLS {
        for axis in [Vec3::x(), Vec3::new(0.6, 0.8, 0.0), Vec3::z(), Vec3::new(0.5, -0.3, 0.8)] {
            let [coarse, fine] = [18, 36].map(|steps| turned(cells, axis, steps));
            assert!(coarse <= TURNED && fine <= HALVED * coarse + ROUGH, "{axis}: {coarse:e} {fine:e}");
        }
    }
}

/// A step in which nothing moves takes no work; every step takes some or none, at each node.
#[test]
fn friction_gives_nothing_back() {
    for (cells, seed) in CELLS.into_iter().flat_map(|c| [(c, 3), (c, 8)]) {
        let Moved { mut interface, x1, x2, lambda } =
            moved(&committed(0.4), cells, Roughness { warp: 0.03, jitter: 0.08, slide: 0.3 }, seed);
        let mut some = 0.0;
        for factor in [1.0, 0.6, 1.3, -0.2, 1.0] {
            let lambda: Vec<_> = lambda.iter().map(|l| l * factor).collect();
            interface.residual(&x1, &x2, &lambda, None).unwrap();
            for a in 0..x1.len() {
                let work = interface.dissipation(a);
                assert!(work >= 0.0, "{seed} {factor} {a}: {work:e}");
                some += work;
            }
            interface.commit(&x1, &x2, &lambda, None).unwrap();
        }
        assert!(some > 0.0);
    }
}

/// Found by sealing a history whose list of what points remember was shortened: every evaluation after the import was refused.
#[test]
fn a_history_with_other_points_is_refused_and_leaves_the_interface_as_it_is() {
    for weights in [Weights::Committed, Weights::Reference] {
        let of = Options { weights, ..committed(0.4) };
        let Moved { mut interface, x1, x2, lambda } = moved(&of, CELLS[0], FLAT, 3);
        interface.commit(&x1, &x2, &lambda, None).unwrap();
        let (integers, reals) = interface.export_history().unwrap();
        let first = interface.residual(&x1, &x2, &lambda, None).unwrap();
        let mut refuse = |mut integers: Vec<i64>, reals: &[f64]| {
            seal_history(&mut integers, reals);
            let error = interface.import_history(&integers, reals).unwrap_err();
            assert!(error.kind == Kind::HistoryMismatch && error.message.contains("points"), "{error}");
            assert!(interface.residual(&x1, &x2, &lambda, None).unwrap() == first);
        };
        for shorter in [1, 3, 30] {
            refuse(integers.clone(), &reals[..reals.len() - shorter]);
        }
        let longer: Vec<_> = reals.iter().copied().chain([0.0; 3]).collect();
        refuse(integers.clone(), &longer);
        // The last pair has another mortar facet, over which there are other points or none.
        let mut other = integers.clone();
        *other.last_mut().unwrap() = 8;
        refuse(other, &reals);
        interface.import_history(&integers, &reals).unwrap();
        assert!(interface.residual(&x1, &x2, &lambda, None).unwrap() == first);
        interface.roll_back().unwrap_err();
    }
}

/// Lines of a plane and of an axisymmetric model remember as facets do.
#[test]
fn lines_at_rest_change_nothing() {
    for (measure, seed) in [(Measure::Thickness(0.7), 1), (Measure::Axisymmetric, 2)] {
        let mut s = moved_lines::<3>(&committed(0.4), [2, 2], measure, seed);
        (0..2).for_each(|_| s.contact.commit(&s.x1, &s.x2, &s.lambda, None).unwrap());
        let first = s.contact.residual(&s.x1, &s.x2, &s.lambda, None).unwrap();
        (0..100).for_each(|_| s.contact.commit(&s.x1, &s.x2, &s.lambda, None).unwrap());
        let error = difference(&s.contact.residual(&s.x1, &s.x2, &s.lambda, None).unwrap(), &first);
        assert!(error <= ROUNDING, "{measure:?}: {error:e}");
    }
}
