//! Mesh tying of closed surfaces: linear, exact on patches of non-matching blocks, neither opens nor has a history. Open
//! gaps: `tests/interface/tied_gap.rs`.

use super::*;
use crate::support::host::{Body, Host};
use nalgebra::Matrix3;
use stickslip::interface::Friction;
use stickslip::law::State;

/// Rounding of a residual, relative to its largest entry.
const ROUNDING: f64 = 1e-13;
/// Displacements of the patch, relative to the largest (measured 5e-15).
const PATCH: f64 = 1e-13;
/// Its multipliers, likewise (measured 8e-14): rounding of the displacements times the stiffness.
const PATCH_MULTIPLIERS: f64 = 1e-12;

fn tied(form: Form) -> Options {
    Options { friction: Friction::Tied, mu: 0.0, form, ..options() }
}

/// Closed in the first configuration: nothing rough but within the plane.
const CLOSED: Roughness = Roughness { warp: 0.0, ..ROUGH };

fn scene(form: Form, cells: [Cells; 2], rough: Roughness) -> Moved {
    let scene = moved(&options(), cells, rough, 3);
    Moved { interface: again(&scene, false, tied(form)), ..scene }
}

fn residual(c: &mut Contact<3>, x1: &[Vec3], x2: &[Vec3], lambda: &[Vec3]) -> Vec<Vec3> {
    let r = c.residual(x1, x2, lambda, None).unwrap();
    [r.nonmortar, r.mortar, r.rows].concat()
}

/// The residual is affine in (x, lambda), and the tangent is its slope, whatever the point.
#[test]
fn the_residual_is_affine() {
    for (form, cells) in FORMS.into_iter().flat_map(|f| CELLS.map(|c| (f, c))) {
        let Moved { interface: mut c, x1, x2, lambda } = scene(form, cells, CLOSED);
        let mut random = Random(11);
        let mut other = |v: &[Vec3]| v.iter().map(|v| v + random.vector(2.0)).collect::<Vec<_>>();
        let (y1, y2, other_lambda) = (other(&x1), other(&x2), other(&lambda));
        let mix = |a: &[Vec3], b: &[Vec3]| a.iter().zip(b).map(|(a, b)| a * 0.3 + b * 0.7).collect::<Vec<_>>();
        let between = residual(&mut c, &mix(&x1, &y1), &mix(&x2, &y2), &mix(&lambda, &other_lambda));
        let (at, there) = (residual(&mut c, &x1, &x2, &lambda), residual(&mut c, &y1, &y2, &other_lambda));
        let error = difference(&between, &mix(&at, &there));
        assert!(error <= ROUNDING, "{form:?}: {error:e}");

        let tangent = entries(&mut c, (&x1, &x2, &lambda));
        assert!(tangent == entries(&mut c, (&y1, &y2, &other_lambda)), "the tangent is constant");
        let change: Vec<Vec3> = y1
            .iter()
            .chain(&y2)
            .chain(&other_lambda)
            .zip(x1.iter().chain(&x2).chain(&lambda))
            .map(|(b, a)| b - a)
            .collect();
        let mut sum = vec![Vec3::zeros(); at.len()];
        for (i, j, v) in tangent {
            let (i, j) = (i as usize, j as usize);
            sum[i / 3][i % 3] += f64::from_bits(v) * change[j / 3][j % 3];
        }
        let expected: Vec<_> = there.iter().zip(&at).map(|(b, a)| b - a).collect();
        let error = difference(&sum, &expected);
        assert!(error <= ROUNDING, "{form:?}: slope off by {error:e}");
    }
}

#[test]
fn it_never_opens_and_never_slips() {
    let Moved { interface: mut c, x1, x2, lambda } = scene(Form::Multiplier, CELLS[0], CLOSED);
    let nu: Vec<_> = (0..9).map(|a| c.normal(a).unwrap()).collect();
    for (pull, apart) in [(5.0, 0.1), (5.0, 50.0), (-5.0, -0.1), (-5.0, 0.1)] {
        let x1: Vec<_> = x1.iter().zip(&nu).map(|(x, nu)| x + nu * apart + along() * apart).collect();
        let lambda: Vec<_> = lambda.iter().zip(&nu).map(|(l, nu)| l + nu * pull).collect();
        let responses = c.responses(&x1, &x2, &lambda, None).unwrap();
        assert!(responses.iter().all(|r| r.state == State::Stick && r.slip == Vec3::zeros() && r.traction == r.sigma));
    }
}

/// The rows know nothing of where the surfaces are together, and forces depend on lambda alone.
#[test]
fn a_translation_of_both_sides_does_nothing() {
    let Moved { interface: mut c, lambda, .. } = scene(Form::Multiplier, CELLS[0], CLOSED);
    let (x1, x2) = (c.surfaces().0.reference.clone(), c.surfaces().1.reference.clone());
    let here = residual(&mut c, &x1, &x2, &lambda);
    let by = Vec3::new(0.3, -2.0, 0.7);
    let there = residual(&mut c, &shifted(&x1, by), &shifted(&x2, by), &lambda);
    assert!(difference(&here, &there) <= ROUNDING);
    let zero = vec![Vec3::zeros(); lambda.len()];
    let at_rest = residual(&mut c, &shifted(&x1, by), &shifted(&x2, by), &zero);
    assert!(at_rest.iter().all(|r| r.amax() <= ROUNDING * 15.0), "15: the augmentation");
}

/// A step may be committed anywhere, undone, exported: the weights and the gap that count are the first ones, be it open
/// or not.
#[test]
fn a_commit_changes_nothing() {
    for (form, rough) in FORMS.into_iter().flat_map(|form| [(form, CLOSED), (form, ROUGH)]) {
        let Moved { interface: mut c, x1, x2, lambda } = scene(form, CELLS[0], rough);
        let before = (c.residual(&x1, &x2, &lambda, None).unwrap(), entries(&mut c, (&x1, &x2, &lambda)));
        let searches = c.counters().searches;
        for k in 1..4 {
            let away = shifted(&x1, along() * 0.4 * f64::from(k));
            c.commit(&away, &x2, &lambda, None).unwrap();
            assert!(before == (c.residual(&x1, &x2, &lambda, None).unwrap(), entries(&mut c, (&x1, &x2, &lambda))));
        }
        c.roll_back().unwrap();
        let (integers, reals) = c.export_history().unwrap();
        let (n1, n2, pairs) = (x1.len(), x2.len(), c.history().pairs.len());
        assert!(c.history().slip.is_empty() && c.history().gap.len() == n1 && pairs > 0);
        // x1, normals, gaps, areas, coverage; x2; gaps of facets; where weights are of; weights.
        let facets = c.surfaces().0.facets.len();
        assert_eq!(reals.len(), n1 * (3 + 3 + 3 + 1 + 1 + 3) + 6 * n2 + 12 * facets + 32 * pairs);
        let mut restarted: Contact<3> = contact(&mesh_of(c.surfaces().0), &mesh_of(c.surfaces().1), false, tied(form));
        restarted.import_history(&integers, &reals).unwrap();
        assert_eq!(bits(&restarted.residual(&x1, &x2, &lambda, None).unwrap()), bits(&before.0));
        assert_eq!(c.counters().searches, searches, "nothing is searched again");
    }
}

/// Two blocks with 3 x 3 and 4 x 4 facets, tied, under a uniform strain: tension, compression, shear, all at once.
/// Their loads are those of the exact field but for the tractions on the interface, which it must carry itself.
#[test]
fn patches_of_non_matching_blocks_are_exact() {
    let shear = Matrix3::new(0.0, 0.0, 0.04, 0.0, 0.0, -0.02, 0.01, 0.0, 0.0);
    let tension = Matrix3::from_diagonal(&Vec3::new(-0.01, -0.02, 0.05));
    for gradient in [tension, -tension, shear, tension + shear] {
        for (form, n, m) in [(Form::Multiplier, 3, 4), (Form::Multiplier, 4, 3), (Form::Augmented, 3, 4)] {
            let upper = grid(n, n, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads);
            let lower = grid(m, m, [0.0, 0.0], [1.0, 1.0], 0.0, true, Cells::Quads);
            let (young, poisson) = (100.0, 0.3);
            let upper = Body::new(upper, Vec3::z() * 0.5, young, poisson);
            let lower = Body::new(lower, -Vec3::z() * 0.7, young, poisson);
            let strain = (gradient + gradient.transpose()) * 0.5;
            let stress = (strain + Matrix3::identity() * (strain.trace() * poisson / (1.0 - 2.0 * poisson)))
                * (young / (1.0 + poisson));
            // On the upper body, whose surface looks down.
            let traction = stress * -Vec3::z();

            let mut host = Host::<3>::new(upper, Ok(lower), tied(form));
            let mut exact = host.u.clone();
            let mut first = 0;
            for (body, sign) in host.bodies.iter().zip([1.0, -1.0]) {
                for (k, x) in body.x.iter().enumerate() {
                    exact.fixed_rows_mut::<3>(first + 3 * k).copy_from(&(gradient * x));
                }
                let size = body.stiffness.nrows();
                let mut load = &body.stiffness * exact.rows(first, size);
                for (k, area) in body.areas().iter().enumerate() {
                    let mut at_node = load.fixed_rows_mut::<3>(3 * k);
                    at_node -= traction * (sign * area);
                }
                host.load.rows_mut(first, size).copy_from(&load);
                first += size;
            }
            host.hold(1, |x| gradient * x);
            host.solve();
            let error = (&host.u - &exact).amax() / exact.amax();
            assert!(error <= PATCH, "{form:?}, {n} x {n} on {m} x {m}: {error:e}");
            // lambda is minus the traction on the non-mortar body.
            let error = host.lambda.iter().map(|l| (l + traction).amax()).fold(0.0, f64::max) / traction.amax();
            assert!(error <= PATCH_MULTIPLIERS, "multipliers: {error:e}");
        }
    }
}
