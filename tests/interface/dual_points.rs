//! Dual multipliers where facets are integrated by points in place of overlaps (docs/formulation 10.9): the tangent
//! against differences, what holds exactly, and which facets are refused by name.

use crate::support::differences::Point;
use crate::support::max_abs;
use crate::support::mesh::*;
use stickslip::error::{Error, Kind};
use stickslip::geometry::Vec3;
use stickslip::interface::{
    Contact, Form, Friction, Interface, MultiplierBasis, NO_WEAK_COVERAGE, Options, Scheme, Surface, Weights,
};
use stickslip::quadrature::{DEGREE_10, cell};

/// The tangent against differences, relative to the largest entry of a block.
const DIFFERENCES: f64 = 1e-7;
/// Sums of some hundred products of numbers up to 1, times functions psi_A below a hundred.
const ROUNDING: f64 = 1e-12;

fn line(points: usize) -> &'static [[f64; 2]] {
    cell::line_of(points).unwrap()
}

/// Of the degree 10: facets with overlaps are warped, too.
fn dual(scheme: Scheme) -> Options {
    let weak_coverage = NO_WEAK_COVERAGE;
    Options { basis: MultiplierBasis::Dual, scheme, weak_coverage, rule: &DEGREE_10, ..options() }
}

fn schemes() -> [Scheme; 4] {
    [Scheme::Elements(line(2)), Scheme::Elements(line(5)), Scheme::Hybrid(line(3)), Scheme::Hybrid(line(4))]
}

const KINDS: [[Cells; 2]; 3] =
    [[Cells::Triangles, Cells::Triangles], [Cells::Triangles, Cells::Quads], [Cells::Quads, Cells::Quads]];

/// Whether a refusal is that of a facet whose points do not determine its multipliers.
fn is_of_points(error: &Error) -> bool {
    error.kind == Kind::DegenerateFacet && error.to_string().contains("STICKSLIP_INTEGRATION_HYBRID")
}

/// Facets that are covered by several pairs, in full and in part, at the end of a step; in the last kind the step has
/// ended and another begun there. Without those that are refused.
fn scenes(of: Options) -> impl Iterator<Item = (&'static str, Moved)> {
    let covered = Roughness { warp: 0.05, jitter: 0.08, slide: 0.02 };
    let off = Roughness { slide: 1.3, ..covered };
    let what = [("covered", covered), ("partly covered", off), ("partly covered at t_n", off)];
    KINDS.into_iter().flat_map(move |cells| what.map(|what| (cells, what))).filter_map(move |(cells, (what, rough))| {
        let mut t = moved(&of, cells, rough, 3);
        if what.contains("t_n")
            && let Err(error) = t.interface.set_previous(&t.x1, &t.x2)
        {
            assert!(matches!(of.scheme, Scheme::Elements(_)) && is_of_points(&error), "{what}: {error}");
            return None;
        }
        match t.interface.residual(&t.x1, &t.x2, &t.lambda, None) {
            Ok(_) => Some((what, t)),
            Err(error) => {
                assert!(!what.contains("t_n") && is_of_points(&error), "{what}: {error}");
                None
            }
        }
    })
}

#[test]
fn the_tangent_equals_differences_in_every_column() {
    let (mut states, mut partly) = ([0; 3], 0);
    for scheme in schemes() {
        for form in [Form::Multiplier, Form::Augmented] {
            for (friction, weak_coverage) in [
                (Friction::Coulomb, NO_WEAK_COVERAGE),
                (Friction::Coulomb, 0.2),
                (Friction::Rough, NO_WEAK_COVERAGE),
                (Friction::Tied, NO_WEAK_COVERAGE),
            ] {
                let mu = if friction == Friction::Coulomb { 0.7 } else { 0.0 };
                for (what, mut t) in scenes(Options { form, friction, mu, weak_coverage, ..dual(scheme) }) {
                    for r in t.interface.responses(&t.x1, &t.x2, &t.lambda, None).unwrap() {
                        states[r.state as usize] += 1;
                    }
                    partly += i32::from(what != "covered");
                    let mut at = Point { contact: &mut t.interface, x1: &t.x1, x2: &t.x2, lambda: &t.lambda };
                    let error = at.difference_error(0.0);
                    assert!(error <= DIFFERENCES, "{what} {scheme:?} {form:?} {friction:?}: {error:e}");
                }
            }
        }
    }
    assert!(states.iter().all(|n| *n > 20) && partly > 40, "{states:?} {partly}");
}

#[test]
fn the_tangent_of_frozen_weights_equals_differences() {
    for scheme in schemes() {
        for weights in [Weights::Committed, Weights::Reference] {
            for (what, mut t) in scenes(Options { weights, ..dual(scheme) }) {
                let mut at = Point { contact: &mut t.interface, x1: &t.x1, x2: &t.x2, lambda: &t.lambda };
                let error = at.difference_error(0.0);
                assert!(error <= DIFFERENCES, "{what} {scheme:?} {weights:?}: {error:e}");
            }
        }
    }
}

/// Of a mortar side at rest there are no columns: those of x1 by differences. One multiplier a node.
#[test]
fn the_tangent_of_a_rigid_side_equals_differences() {
    const STEP: f64 = 1e-6;
    for scheme in schemes() {
        let options = Options { friction: Friction::None, mu: 0.0, ..dual(scheme) };
        for (what, t) in scenes(dual(scheme)).filter(|(what, _)| !what.contains("t_n")) {
            let (one, two) = t.interface.surfaces();
            let mut c: Contact<1> = contact(&mesh_of(one), &mesh_of(two), true, options);
            let lambda: Vec<_> = t.lambda.iter().map(|l| nalgebra::Vector1::new(l.z)).collect();
            let n = 3 * t.x1.len();
            let mut k = vec![0.0; n * n];
            let mut add = |i: i64, j: i64, v: f64| {
                if i < n as i64 && j < n as i64 {
                    k[i as usize * n + j as usize] += v;
                }
            };
            c.tangent(&t.x1, &t.x2, &lambda, None, &mut add).unwrap();
            let largest = max_abs(k.iter().copied());
            for j in 0..n {
                let mut at = |h: f64| {
                    let mut x1 = t.x1.clone();
                    x1[j / 3][j % 3] += h;
                    c.residual(&x1, &t.x2, &lambda, None).unwrap().nonmortar
                };
                let (plus, minus) = (at(STEP), at(-STEP));
                for i in 0..n {
                    let slope = (plus[i / 3][i % 3] - minus[i / 3][i % 3]) / (2.0 * STEP);
                    assert!((k[i * n + j] - slope).abs() <= DIFFERENCES * largest, "{what} {scheme:?}: {i} {j}");
                }
            }
        }
    }
}

/// Forces at the nodes, f_A = D_A lambda_A; linear momentum; the moment of the gaps.
#[test]
fn forces_and_moments_balance_to_rounding() {
    for scheme in schemes() {
        for (what, mut t) in scenes(dual(scheme)) {
            let sums = t.interface.sums(&t.x1, &t.x2).unwrap();
            let r = t.interface.residual(&t.x1, &t.x2, &t.lambda, None).unwrap();
            for ((force, sum), lambda) in r.nonmortar.iter().zip(&sums).zip(&t.lambda) {
                assert!((force - lambda * sum.coverage).amax() <= ROUNDING, "{what} {scheme:?}");
            }
            let total: Vec3 = r.nonmortar.iter().chain(&r.mortar).sum();
            assert!(total.amax() <= ROUNDING, "{what} {scheme:?}: {total}");
            let forces = r.nonmortar.iter().chain(&r.mortar);
            let moments: Vec3 = t.x1.iter().chain(&t.x2).zip(forces).map(|(x, f)| x.cross(f)).sum();
            let gaps: Vec3 = sums.iter().zip(&t.lambda).map(|(s, l)| s.gap_now.cross(l)).sum();
            assert!((moments - gaps).amax() <= ROUNDING, "{what} {scheme:?}: {}", moments - gaps);
        }
    }
}

/// What a patch test asks of the interface: flat closed surfaces have no gap, and a constant traction loads both sides as with
/// the standard basis, however facets are covered.
#[test]
fn constant_tractions_load_as_with_the_standard_basis() {
    let two = grid(3, 3, [-0.13, -0.2], [0.87, 1.2], 0.0, true, Cells::Quads);
    for (cells, scheme) in [Cells::Quads, Cells::Triangles].into_iter().flat_map(|c| schemes().map(|s| (c, s))) {
        // The last column of facets is covered by a part of its points where there are five or where there are overlaps.
        let one = grid(4, 3, [0.0, 0.0], [1.0, 1.0], 0.0, false, cells);
        let lambda = vec![Vec3::new(0.2, -0.1, -1.0); one.x.len()];
        let of = |basis| {
            let surface = |side, mesh: &Mesh, first| {
                Surface::new(side, mesh.x.clone(), &mesh.facets, numbered(first, mesh.x.len())).unwrap()
            };
            let (n1, n2) = (one.x.len(), two.x.len());
            let (a, b) = (surface("nonmortar", &one, 0), surface("mortar", &two, 3 * n1));
            let options = Options { basis, ..dual(scheme) };
            let mut c = Interface::new(a, b, numbered(3 * (n1 + n2), n1), options)?;
            let gaps = c.sums(&one.x, &two.x)?;
            assert!(gaps.iter().all(|s| s.gap_now.amax() <= ROUNDING), "{scheme:?}");
            c.residual(&one.x, &two.x, &lambda, None)
        };
        let standard = of(MultiplierBasis::Standard).unwrap();
        match of(MultiplierBasis::Dual) {
            Ok(dual) => {
                let all = |r: &stickslip::interface::Residual| [&r.nonmortar[..], &r.mortar[..]].concat();
                for (a, b) in all(&dual).iter().zip(all(&standard)) {
                    assert!((a - b).amax() <= ROUNDING, "{scheme:?}: {a} {b}");
                }
            }
            Err(error) => assert!(matches!(scheme, Scheme::Elements(_)) && is_of_points(&error), "{scheme:?} {error}"),
        }
    }
}

/// One column of a facet's points is covered: no field of the facet's functions is determined by it. Overlaps are.
#[test]
fn facets_whose_points_determine_nothing_are_refused_by_name() {
    for (cells, points) in [Cells::Quads, Cells::Triangles].into_iter().flat_map(|c| [2, 3, 5].map(|n| (c, n))) {
        let one = grid(1, 1, [0.0, 0.0], [1.0, 1.0], 0.0, false, cells);
        // Between the first and the second Gauss point of the line.
        let [[s, _], [t, _]] = [line(points)[0], line(points)[1]];
        let end = 0.5 * (s.min(t) + s.max(t));
        let two = grid(1, 1, [-0.5, -0.5], [end.min(0.49), 1.5], 0.0, true, Cells::Quads);
        let of = |scheme| {
            let surface = |side, mesh: &Mesh, first| {
                Surface::new(side, mesh.x.clone(), &mesh.facets, numbered(first, mesh.x.len())).unwrap()
            };
            let (a, b) = (surface("nonmortar", &one, 0), surface("mortar", &two, 12));
            Interface::new(a, b, numbered(24, one.x.len()), dual(scheme))
        };
        assert!(of(Scheme::Hybrid(line(points))).is_ok());
        // A triangle has points of several rows there, which may do.
        if cells == Cells::Quads {
            let error = of(Scheme::Elements(line(points))).err().unwrap();
            let words = format!("nonmortar facet 0: {points} of its {} points lie on the mortar side", points * points);
            assert!(is_of_points(&error) && error.to_string().contains(&words), "{error}");
        }
    }
}

/// Strips across a facet at any angle, with points in rows and clusters: the weights are right, or the facet is refused. The
/// pivots of a singular matrix are no rounding where those before them are small: its determinant is.
#[test]
fn no_set_of_points_gives_wrong_weights() {
    /// Of a solution with half of the digits lost.
    const RIGHT: f64 = 1e-8;
    let (mut random, mut taken, mut refused) = (Random(17), 0, 0);
    for k in 0..3000 {
        let cells = [Cells::Quads, Cells::Triangles][k % 2];
        let scheme = Scheme::Elements(line([3, 5, 7, 10][k / 2 % 4]));
        let one = grid(1, 1, [0.0, 0.0], [1.0, 1.0], 0.0, false, cells);
        let mut two = grid(1, 1, [-2.0, -1.0], [2.0, 1.0], 0.0, true, Cells::Quads);
        let (angle, length, width) = (3.2 * random.next(), random.next().abs(), 10f64.powf(1.2 * random.next() - 1.3));
        let turn = nalgebra::Rotation3::from_euler_angles(0.0, 0.0, angle);
        let at = Vec3::new(0.5 + 0.5 * random.next(), 0.5 + 0.5 * random.next(), 0.0);
        two.x.iter_mut().for_each(|x| *x = at + turn * Vec3::new(x.x * length, x.y * width, 0.0));
        let lambda: Vec<_> = one.x.iter().map(|_| random.vector(1.0)).collect();
        let surface = |side, mesh: &Mesh, first| {
            Surface::new(side, mesh.x.clone(), &mesh.facets, numbered(first, mesh.x.len())).unwrap()
        };
        let (a, b) = (surface("nonmortar", &one, 0), surface("mortar", &two, 12));
        match Interface::new(a, b, numbered(24, one.x.len()), dual(scheme)) {
            Ok(mut c) => {
                let sums = c.sums(&one.x, &two.x).unwrap();
                taken += i32::from(sums.iter().any(|s| s.coverage > 0.0));
                let r = c.residual(&one.x, &two.x, &lambda, None).unwrap();
                for ((force, sum), lambda) in r.nonmortar.iter().zip(&sums).zip(&lambda) {
                    assert!((force - lambda * sum.coverage).amax() <= RIGHT, "{scheme:?} {two:?}", two = two.x);
                    assert!(sum.gap_now.amax() <= RIGHT);
                }
            }
            Err(error) => {
                assert!(is_of_points(&error), "{error}");
                refused += 1;
            }
        }
    }
    assert!(taken > 500 && refused > 500, "{taken} {refused}");
}

/// The diagnosis compares a pair's own weights with those of a finer rule, not the ones that act.
#[test]
fn the_error_of_integration_is_that_of_the_standard_basis() {
    for scheme in schemes() {
        let rough = Roughness { warp: 0.05, jitter: 0.08, slide: 0.02 };
        let [standard, dual] = [MultiplierBasis::Standard, MultiplierBasis::Dual].map(|basis| {
            let mut t = moved(&Options { basis, ..dual(scheme) }, KINDS[2], rough, 3);
            t.interface.diagnose(&t.x1, &t.x2, &t.lambda, None).unwrap().error.unwrap()
        });
        assert_eq!(standard, dual);
    }
}
