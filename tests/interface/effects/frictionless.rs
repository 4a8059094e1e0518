//! One multiplier a node against three with mu = 0 and every shortcut off.

use super::*;
use crate::support::differences::Point;
use crate::support::host::{Body, Host};
use nalgebra::Vector1;
use stickslip::interface::{Friction, Owner};
use stickslip::law::State;

/// Residuals at one point: rounding of a few operations.
const ROUNDING: f64 = 1e-13;
/// Converged answers: Newton stops at 1e-13.
const CONVERGED: f64 = 1e-12;
/// The tangent against differences, relative to the largest entry of the block.
const DIFFERENCES: f64 = 1e-7;

/// One multiplier a node.
fn one(of: Options) -> Options {
    Options { friction: Friction::None, mu: 0.0, ..of }
}

/// Three with mu = 0, and every shortcut off.
fn full(of: Options) -> Options {
    Options { mu: 0.0, shortcuts: NO_SHORTCUTS, ..of }
}

/// A scene with one and with three multipliers, these along the normal.
struct Twins {
    one: Contact<1>,
    three: Contact<3>,
    x1: Vec<Vec3>,
    x2: Vec<Vec3>,
    lambda: Vec<Vector1<f64>>,
}

impl Twins {
    fn new(options: Options, cells: [Cells; 2], rough: Roughness, seed: u64) -> Twins {
        let scene = moved(&options, cells, rough, seed);
        let (single, three) = (again(&scene, false, one(options)), again(&scene, false, full(options)));
        let lambda = scene.lambda.iter().enumerate().map(|(a, l)| Vector1::new(three_normal(&three, a).dot(l)));
        let lambda = lambda.collect();
        Twins { one: single, three, x1: scene.x1, x2: scene.x2, lambda }
    }

    /// lambda of the three.
    fn vectors(&self) -> Vec<Vec3> {
        self.lambda.iter().enumerate().map(|(a, l)| three_normal(&self.three, a) * l[0]).collect()
    }

    /// The largest relative difference of the residuals; rows along the normal.
    fn difference(&mut self) -> f64 {
        let vectors = self.vectors();
        let r1 = self.one.residual(&self.x1, &self.x2, &self.lambda, None).unwrap();
        let r3 = self.three.residual(&self.x1, &self.x2, &vectors, None).unwrap();
        let normal = |(a, row): (usize, &Vec3)| Vector1::new(three_normal(&self.three, a).dot(row));
        let rows: Vec<_> = r3.rows.iter().enumerate().map(normal).collect();
        let along: Vec<_> =
            rows.iter().enumerate().map(|(a, row)| three_normal(&self.three, a) * row[0]).collect::<Vec<Vec3>>();
        assert!(difference(&r3.rows, &along) <= ROUNDING, "rows along the surface");
        [difference(&r1.nonmortar, &r3.nonmortar), difference(&r1.mortar, &r3.mortar), difference(&r1.rows, &rows)]
            .into_iter()
            .fold(0.0, f64::max)
    }

    fn commit(&mut self) {
        let vectors = self.vectors();
        self.one.commit(&self.x1, &self.x2, &self.lambda, None).unwrap();
        self.three.commit(&self.x1, &self.x2, &vectors, None).unwrap();
    }
}

fn three_normal(c: &Contact<3>, a: usize) -> Vec3 {
    c.normal(a).unwrap()
}

#[test]
fn residuals_are_equal_at_any_point() {
    for options in variants(options()) {
        for cells in CELLS {
            for seed in 1..5 {
                let mut t = Twins::new(options, cells, ROUGH, seed);
                for _ in 0..3 {
                    let error = t.difference();
                    assert!(error <= ROUNDING, "{options:?}: {error:e}");
                    t.commit();
                    t.x1 = shifted(&t.x1, along() * 0.21);
                }
            }
        }
    }
}

#[test]
fn states_and_nodal_results_are_equal() {
    let mut t = Twins::new(options(), CELLS[0], ROUGH, 3);
    let vectors = t.vectors();
    let r1 = t.one.responses(&t.x1, &t.x2, &t.lambda, None).unwrap();
    let r3 = t.three.responses(&t.x1, &t.x2, &vectors, None).unwrap();
    let mut seen = [0; 3];
    for (one, three) in r1.iter().zip(&r3) {
        seen[one.state as usize] += 1;
        assert_eq!(one.state, three.state);
        assert!((one.traction - three.traction).amax() <= ROUNDING && one.slip == Vec3::zeros());
        assert!((one.gap_normal - three.gap_normal).abs() <= ROUNDING);
    }
    assert!(seen[State::Gap as usize] > 0 && seen[State::Slip as usize] > 0 && seen[State::Stick as usize] == 0);
}

#[test]
fn the_tangent_equals_differences_in_every_column() {
    for options in variants(options()) {
        for cells in CELLS {
            // Quads stay parallelograms; triangles may be as rough as they like.
            let rough = if cells == CELLS[2] { Roughness { jitter: 0.1, ..ROUGH } } else { FLAT };
            let mut t = Twins::new(options, cells, rough, 7);
            let directions: Vec<_> = (0..t.x1.len()).step_by(2).map(|a| (a, along())).collect();
            for constraints in [&[], &directions[..]] {
                t.one.set_constraints(constraints).unwrap();
                let mut at = Point { contact: &mut t.one, x1: &t.x1, x2: &t.x2, lambda: &t.lambda };
                let error = at.difference_error(0.0);
                assert!(error <= DIFFERENCES, "{options:?}: off by {error:e}");
            }
        }
    }
}

#[test]
fn pattern_and_tangent_have_the_same_entries_and_the_superset_has_them_all() {
    for options in variants(options()) {
        let mut t = Twins::new(options, CELLS[0], ROUGH, 3);
        let tangent: Vec<_> =
            entries(&mut t.one, (&t.x1, &t.x2, &t.lambda)).into_iter().map(|(i, j, _)| (i, j)).collect();
        let (mut pattern, mut superset) = (Vec::new(), std::collections::HashSet::new());
        t.one.pattern(&t.x1, &t.x2, Extent::Whole, &mut |i, j, _| pattern.push((i, j))).unwrap();
        t.one.superset_pattern(&t.x1, &t.x2, &mut |i, j, _| _ = superset.insert((i, j))).unwrap();
        assert_eq!(pattern, tangent);
        assert!(tangent.iter().all(|e| superset.contains(e)));
    }
}

#[test]
fn initial_multipliers_sums_and_constraints_are_equal() {
    for options in variants(options()) {
        let mut t = Twins::new(options, CELLS[0], Roughness { warp: 0.0, ..ROUGH }, 3);
        t.one.residual(&t.x1, &t.x2, &t.lambda, None).unwrap(); // so that the weights at hand are others
        let (l1, l3) = (t.one.initial_multipliers().unwrap(), t.three.initial_multipliers().unwrap());
        let along_normal: Vec<_> = l1.iter().enumerate().map(|(a, l)| three_normal(&t.three, a) * l[0]).collect();
        assert!(l3.iter().any(|l| l.amax() > 0.0) && difference(&along_normal, &l3) <= ROUNDING);

        let (s1, s3) = (t.one.sums(&t.x1, &t.x2).unwrap(), t.three.sums(&t.x1, &t.x2).unwrap());
        for (s1, s3) in s1.iter().zip(&s3) {
            assert_eq!(
                (s1.coverage, s1.gap_now, s1.coverage_previous),
                (s3.coverage, s3.gap_now, s3.coverage_previous)
            );
            assert_eq!((s1.gap_previous, s1.gap_committed), (Vec3::zeros(), Vec3::zeros()), "no history");
        }

        let directions: Vec<_> = (0..t.x1.len()).step_by(2).map(|a| (a, along())).collect();
        t.one.set_constraints(&directions).unwrap();
        t.three.set_constraints(&directions).unwrap();
        assert!((0..t.x1.len()).all(|a| t.one.normal(a).unwrap() == three_normal(&t.three, a)));
        let error = t.difference();
        assert!(error <= ROUNDING, "{options:?} constrained: {error:e}");
        assert!(t.one.set_constraints(&[(0, three_normal(&t.three, 0)), (0, along())]).is_err(), "no normal left");
    }
}

#[test]
fn nodes_that_are_not_owned_have_no_rows() {
    let mut t = Twins::new(options(), CELLS[0], FLAT, 7);
    let whole = t.one.residual(&t.x1, &t.x2, &t.lambda, None).unwrap();
    t.one.set_owners((0..9).map(|a| if a % 2 == 0 { Owner::Here } else { Owner::Shared }).collect()).unwrap();
    let part = t.one.residual(&t.x1, &t.x2, &t.lambda, None).unwrap();
    assert_eq!((&part.nonmortar, &part.mortar), (&whole.nonmortar, &whole.mortar));
    for a in 0..9 {
        assert_eq!(part.rows[a], if a % 2 == 0 { whole.rows[a] } else { Vector1::zeros() });
    }
    assert_eq!(t.one.multipliers(), 9);
    assert_eq!(t.three.multipliers(), 27);
}

/// What a parallel host passes is what counts; its own sums change no bit.
#[test]
fn sums_that_are_passed_count() {
    let mut t = Twins::new(options(), CELLS[0], FLAT, 7);
    let expected = t.one.residual(&t.x1, &t.x2, &t.lambda, None).unwrap();
    let sums = t.one.sums(&t.x1, &t.x2).unwrap();
    let given = t.one.residual(&t.x1, &t.x2, &t.lambda, Some(&sums)).unwrap();
    assert_eq!(bits(&expected), bits(&given));
    let mut more = sums.clone();
    more.iter_mut().for_each(|s| s.gap_now *= 2.0);
    assert_ne!(bits(&t.one.residual(&t.x1, &t.x2, &t.lambda, Some(&more)).unwrap()), bits(&given));
}

/// A block pressed on another, or on a prescribed surface, tilted so that some nodes open; three steps.
fn press<const N: usize>(options: Options, rigid: bool) -> (Vec<f64>, Vec<f64>, usize)
where
    Contact<N>: Create<N>,
{
    let upper = grid(3, 3, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads);
    let lower = grid(4, 4, [-0.4, -0.3], [1.5, 1.4], 0.0, true, Cells::Quads);
    let upper = Body::new(upper, Vec3::z() * 0.4, 100.0, 0.3);
    let lower = if rigid { Err(lower) } else { Ok(Body::new(lower, -Vec3::z() * 0.5, 150.0, 0.2)) };
    let mut host = Host::<N>::new(upper, lower, options);
    if !rigid {
        host.hold(1, |_| Vec3::zeros());
    }
    let (mut answer, mut tractions, mut open) = (Vec::new(), Vec::new(), 0);
    for step in 1..=3 {
        let s = f64::from(step);
        host.hold(0, |x| Vec3::new(0.06 * s, 0.02 * s, -0.01 * s + 0.03 * s * (x.x - 0.3)));
        host.solve();
        let (x1, x2) = host.positions();
        let responses = host.contact.responses(&x1, &x2, &host.lambda, None).unwrap();
        open += responses.iter().filter(|r| r.state == State::Gap).count();
        answer.extend(host.u.iter());
        tractions.extend(responses.iter().flat_map(|r| [r.traction.x, r.traction.y, r.traction.z]));
        host.commit();
    }
    (answer, tractions, open)
}

#[test]
fn converged_answers_are_equal() {
    for options in variants(options()) {
        for rigid in [false, true] {
            let (u1, p1, open) = press::<1>(one(options), rigid);
            let (u3, p3, _) = press::<3>(full(options), rigid);
            assert!(open > 0 && open < 3 * 16, "some nodes open, some stay closed: {open}");
            for (name, one, three) in [("displacements", u1, u3), ("tractions", p1, p3)] {
                let scale = crate::support::max_abs(three.iter().copied());
                let error = crate::support::max_abs(one.iter().zip(&three).map(|(a, b)| a - b));
                assert!(error <= CONVERGED * scale, "{options:?}: {name} differ by {error:e} of {scale:e}");
            }
        }
    }
}
