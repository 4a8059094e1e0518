//! Normals of the current configuration (docs/formulation 11): golden cases, the tangent against differences, rigid turns
//! within a step, what is refused.

use super::golden::{dense_tangent, expected_tangent, residual_error, set_up_with, tangent_error};
use super::weak;
use crate::support::differences::Point;
use crate::support::mesh::*;
use crate::support::*;
use nalgebra::{Rotation3, SVector};
use serde_json::Value;
use std::collections::HashSet;
use stickslip::error::Kind;
use stickslip::geometry::{AnalyticShape, Vec3};
use stickslip::interface::{
    Contact, Form, Friction, MultiplierBasis, NO_WEAK_COVERAGE, NewContact, Normals, Options, Owner, RowScale,
    Stiffness, Surface, Weights,
};
use stickslip::law::SlipMeasure;
use stickslip::quadrature::{DEGREE_5, DEGREE_10};

/// Residual blocks and normals, relative to the largest entry of the block.
const RESIDUAL: f64 = 1e-12;
/// Tangent blocks of affine interfaces.
const TANGENT: f64 = 1e-10;
/// A block smaller than this part of the matrix is what is left of terms that cancel.
const VANISHING: f64 = 1e-5;
/// Non-affine facets with the rule of degree 10.
const RULE_RESIDUAL: f64 = 1e-8;
const RULE_TANGENT: f64 = 1e-4;
/// The tangent against differences, relative to the largest entry of a block, on affine facets.
const DIFFERENCES: f64 = 1e-7;
/// Step of the differences (facet size 0.5): rounding 1e-16/1e-6 and truncation 1e-12.
const STEP: f64 = 1e-6;
/// A rigid motion of everything, over the largest of what it is about.
const RIGID: f64 = 1e-12;

fn current(of: Options) -> Options {
    Options { normals: Normals::Current, ..of }
}

fn cases() -> Vec<Value> {
    golden("golden_normals.json")
}

fn golden_options(case: &Value, form: Form) -> Options {
    let basis = if case["basis"] == "dual" { MultiplierBasis::Dual } else { MultiplierBasis::Standard };
    let options =
        Options { form, basis, weak_coverage: NO_WEAK_COVERAGE, ..Options::paper(Stiffness::Augmentation(1.0)) };
    current(options)
}

#[test]
fn golden_normals_states_and_residuals() {
    for case in cases() {
        for (form, key) in [(Form::Multiplier, "residual_mult"), (Form::Augmented, "residual")] {
            let mut g = set_up_with(&case, golden_options(&case, form));
            let responses = g.interface.responses(&g.x1, &g.x2, &g.lambda, None).unwrap();
            for (a, (response, state)) in responses.iter().zip(numbers(&case["state"])).enumerate() {
                assert!(response.state as i32 == state as i32, "{}: state of node {a}", name(&case));
            }
            for (a, nu) in points(&case["nu"]).iter().enumerate() {
                let error = (g.interface.normal(a).unwrap() - nu).amax();
                assert!(error <= RESIDUAL, "{}: nu of node {a} off by {error:e}", name(&case));
            }
            let error = residual_error(&mut g, &numbers(&case[key]));
            println!("{:32} {key} {error:.1e}", name(&case));
            assert!(error <= RESIDUAL, "{}: {key} off by {error:e}", name(&case));
        }
    }
}

#[test]
fn golden_tangents() {
    let mut compared = 0;
    for case in cases() {
        let affine = case["affine"].as_bool().unwrap();
        let expected = if affine { &case } else { &case["exactquad"] };
        for (form, key) in [(Form::Multiplier, "tangent_current_mult"), (Form::Augmented, "tangent_current")] {
            if !expected[key].is_object() {
                continue; // left out of the small copy
            }
            compared += 1;
            let rule = if affine { &DEGREE_5 } else { &DEGREE_10 };
            let mut g = set_up_with(&case, Options { rule, ..golden_options(&case, form) });
            let (n, tangent) = dense_tangent(&mut g);
            let error = tangent_error(g.x1.len(), n, &tangent, &expected_tangent(&expected[key], n), VANISHING);
            println!("{:32} {key} {error:.1e}", name(&case));
            assert!(error <= if affine { TANGENT } else { RULE_TANGENT }, "{}: {key} off by {error:e}", name(&case));
            if !affine {
                let key = if form == Form::Multiplier { "residual_mult" } else { "residual" };
                let error = residual_error(&mut g, &numbers(&expected[key]));
                assert!(error <= RULE_RESIDUAL, "{}: {key} off by {error:e}", name(&case));
            }
        }
    }
    assert!(compared >= 6, "{compared}");
}

#[test]
fn golden_interfaces_with_one_multiplier() {
    let mut compared = 0;
    for case in cases().iter().filter(|case| case["lambda_N"].is_array()) {
        for (form, suffix) in [(Form::Multiplier, "_mult"), (Form::Augmented, "")] {
            let three = set_up_with(case, golden_options(case, form));
            let (one, two) = three.interface.surfaces();
            let options = Options { row_scale: RowScale::None, ..golden_options(case, form) };
            let mut contact: Contact<1> = contact(&mesh_of(one), &mesh_of(two), false, options);
            contact.set_augmentation(Some(numbers(&case["r"]))).unwrap();
            let lambda: Vec<_> = numbers(&case["lambda_N"]).into_iter().map(|l| SVector::from([l])).collect();
            let r = contact.residual(&three.x1, &three.x2, &lambda, None).unwrap();
            let forces = r.nonmortar.iter().chain(&r.mortar).flat_map(|v| v.iter().copied());
            let found: Vec<_> = forces.chain(r.rows.iter().map(|row| row[0])).collect();
            let expected = numbers(&case[format!("one_residual{suffix}").as_str()]);
            let error = max_abs(found.iter().zip(&expected).map(|(a, b)| a - b)) / max_abs(expected.iter().copied());
            assert!(error <= RESIDUAL, "{}: residual off by {error:e}", name(case));
            let mut at = Point { contact: &mut contact, x1: &three.x1, x2: &three.x2, lambda: &lambda };
            let (n, k) = (at.unknowns(), at.tangent());
            let expected = expected_tangent(&case[format!("one_tangent_current{suffix}").as_str()], n);
            let error = max_abs(k.iter().zip(&expected).map(|(a, b)| a - b)) / max_abs(expected.iter().copied());
            println!("{:32} one multiplier{suffix} {error:.1e}", name(case));
            assert!(error <= TANGENT, "{}: tangent off by {error:e}", name(case));
            compared += 1;
        }
    }
    assert!(compared >= 2);
}

/// Curved surfaces, covered and in part; facets without pairs around covered nodes are among the second.
fn scenes() -> impl Iterator<Item = (&'static str, Roughness, [Cells; 2])> {
    rough_scenes(0.12)
}

#[test]
fn the_tangent_equals_differences_in_every_column() {
    let mut states = [0; 3];
    for (what, rough, cells) in scenes() {
        let rule = if cells[1] == Cells::Quads { &DEGREE_10 } else { &DEGREE_5 };
        for form in [Form::Multiplier, Form::Augmented] {
            for friction in [Friction::Coulomb, Friction::Rough, Friction::Tresca, Friction::Tied] {
                for basis in [MultiplierBasis::Standard, MultiplierBasis::Dual] {
                    for (slip, weak_coverage) in [(SlipMeasure::Objective, NO_WEAK_COVERAGE), (SlipMeasure::Paper, 0.4)]
                    {
                        let options = Options { form, weak_coverage, basis, slip, rule, ..options() };
                        let mut t = moved(&current(under(friction, 0.7, options)), cells, rough, 3);
                        states.iter_mut().zip(t.states()).for_each(|(all, here)| *all += here);
                        let error = t.at().difference_error(0.0);
                        assert!(error <= DIFFERENCES, "{what} {form:?} {friction:?} {basis:?} {slip:?}: {error:e}");
                    }
                }
            }
        }
    }
    assert!(states.iter().all(|n| *n > 50), "{states:?}");
}

/// Carried nodes, one multiplier a node and three.
#[test]
fn the_tangent_with_carried_nodes_equals_differences() {
    fn compare<const N: usize>(options: Options)
    where
        Contact<N>: Create<N>,
    {
        let mut s = weak::scene::<N>(&options, Cells::Triangles);
        let mut at = Point { contact: &mut s.contact, x1: &s.x1, x2: &s.x2, lambda: &s.lambda };
        let error = at.difference_error(0.0);
        assert!(error <= DIFFERENCES, "{N} {options:?}: {error:e}");
        assert!(s.contact.counters().nodes.carried > 0);
    }
    for form in [Form::Multiplier, Form::Augmented] {
        for basis in [MultiplierBasis::Standard, MultiplierBasis::Dual] {
            let options = Options { form, basis, weak_coverage: weak::WEAK, ..options() };
            compare::<3>(current(options));
            compare::<3>(current(Options { mu: 0.0, ..options }));
            compare::<1>(current(Options { mu: 0.0, ..options }));
        }
    }
}

/// Prescribed directions: nu has no part along them, and neither has its derivative.
#[test]
fn the_tangent_with_prescribed_directions_equals_differences() {
    for form in [Form::Multiplier, Form::Augmented] {
        let (_, rough, cells) = scenes().next().unwrap();
        let mut t = moved(&current(Options { form, ..options() }), cells, rough, 5);
        let d = Vec3::new(0.3, -0.5, 0.2);
        t.interface.set_constraints(&[(0, d), (1, d), (4, d), (4, Vec3::new(0.1, 0.9, -0.4))]).unwrap();
        let error = t.at().difference_error(0.0);
        assert!(error <= DIFFERENCES, "{form:?}: {error:e}");
    }
}

/// Without the derivative of nu the difference test of curved surfaces must fail.
#[test]
fn the_derivative_of_the_normal_is_no_small_part() {
    let (_, rough, cells) = scenes().next().unwrap();
    let mut now = moved(&current(options()), cells, rough, 3);
    let mut then = moved(&options(), cells, rough, 3);
    now.interface.responses(&now.x1, &now.x2, &now.lambda, None).unwrap();
    let normals = (0..now.x1.len()).map(|a| now.interface.normal(a).unwrap()).collect();
    then.interface.set_normals(Some(normals)).unwrap();
    let (n, k) = dense(&mut now);
    let (_, k0) = dense(&mut then);
    let rows = n - 3 * now.x1.len()..n;
    let part = |k: &dyn Fn(usize) -> f64| max_abs(rows.clone().flat_map(|i| (0..n).map(move |j| i * n + j)).map(k));
    assert!(part(&|t| k[t] - k0[t]) > 1e-2 * part(&|t| k[t]));
}

fn dense(t: &mut Moved) -> (usize, Vec<f64>) {
    let mut at = t.at();
    (at.unknowns(), at.tangent())
}

/// Everything turned by up to 150 degrees within the step, the multipliers with it: the residual turns, the states stay.
#[test]
fn a_rigid_turn_within_a_step_turns_the_residual() {
    for (what, rough, cells) in scenes() {
        for basis in [MultiplierBasis::Standard, MultiplierBasis::Dual] {
            for mu in [0.0, 0.7] {
                let options = current(Options { basis, mu, ..options() });
                let mut t = moved(&options, cells, rough, 4);
                let r = t.interface.residual(&t.x1, &t.x2, &t.lambda, None).unwrap();
                let states = |t: &mut Moved| {
                    let answers = t.interface.responses(&t.x1, &t.x2, &t.lambda, None).unwrap();
                    answers.iter().map(|r| r.state).collect::<Vec<_>>()
                };
                let before = states(&mut t);
                let axis = nalgebra::Unit::new_normalize(Vec3::new(0.5, -0.3, 0.8));
                for degrees in [1.0_f64, 30.0, 90.0, 150.0] {
                    let q = Rotation3::from_axis_angle(&axis, degrees.to_radians());
                    let turned = |v: &[Vec3]| v.iter().map(|v| q * v).collect::<Vec<_>>();
                    let mut now = Moved {
                        interface: moved(&options, cells, rough, 4).interface,
                        x1: turned(&t.x1),
                        x2: turned(&t.x2),
                        lambda: turned(&t.lambda),
                    };
                    let rotated = now.interface.residual(&now.x1, &now.x2, &now.lambda, None).unwrap();
                    assert_eq!(states(&mut now), before, "{what} {degrees}");
                    for (found, was) in
                        [(&rotated.nonmortar, &r.nonmortar), (&rotated.mortar, &r.mortar), (&rotated.rows, &r.rows)]
                    {
                        let scale = max_abs(was.iter().map(|v| v.amax()));
                        let error = max_abs(found.iter().zip(was).map(|(f, w)| (f - q * w).amax()));
                        assert!(error <= RIGID * scale, "{what} {basis:?} {mu} {degrees}: {error:e} of {scale:e}");
                    }
                    now.interface.commit(&now.x1, &now.x2, &now.lambda, None).unwrap();
                }
            }
        }
    }
}

/// The pattern has every entry of the tangent, in both phases.
#[test]
fn the_pattern_is_that_of_the_tangent() {
    for (what, rough, cells) in scenes() {
        for form in [Form::Multiplier, Form::Augmented] {
            let mut t = moved(&current(Options { form, ..options() }), cells, rough, 3);
            for normals in [Normals::Current, Normals::Committed] {
                t.interface.use_normals(normals).unwrap();
                let (mut pattern, mut entries) = (Vec::new(), Vec::new());
                let mut note = |i: i64, j: i64, _: f64| pattern.push((i, j));
                t.interface.pattern(&t.x1, &t.x2, stickslip::interface::Extent::Whole, &mut note).unwrap();
                let mut note = |i: i64, j: i64, _: f64| entries.push((i, j));
                t.interface.tangent(&t.x1, &t.x2, &t.lambda, None, &mut note).unwrap();
                assert_eq!(pattern, entries, "{what} {form:?} {normals:?}");
            }
        }
    }
}

/// Normals of t_n as a phase of the step: the residual is that of committed normals, bit for bit; a commit needs the others.
#[test]
fn a_step_may_begin_with_the_normals_of_its_start() {
    let (_, rough, cells) = scenes().next().unwrap();
    let mut now = moved(&current(options()), cells, rough, 3);
    let mut then = moved(&options(), cells, rough, 3);
    now.interface.use_normals(Normals::Committed).unwrap();
    let residual = |t: &mut Moved| t.interface.residual(&t.x1, &t.x2, &t.lambda, None).unwrap();
    let first = residual(&mut now);
    assert_eq!(first, residual(&mut then));
    let refused = now.interface.commit(&now.x1, &now.x2, &now.lambda, None).unwrap_err();
    assert!(refused.kind == Kind::InvalidValue && format!("{refused}").contains("use_normals"), "{refused}");
    now.interface.use_normals(Normals::Current).unwrap();
    assert_ne!(residual(&mut now), first);
    now.interface.commit(&now.x1, &now.x2, &now.lambda, None).unwrap();
    // The phase ends with the step.
    now.interface.use_normals(Normals::Committed).unwrap();
    now.interface.roll_back().unwrap();
    assert_ne!(residual(&mut now), first);
    assert!(then.interface.use_normals(Normals::Current).is_err());
}

/// Multipliers turn as the normals do; those of committed normals stay.
#[test]
fn multipliers_turn_with_the_surface() {
    let (_, rough, cells) = scenes().next().unwrap();
    let t = moved(&current(options()), cells, rough, 3);
    let reference = t.interface.surfaces().0.reference.clone();
    let normal = t.interface.normal(4).unwrap();
    let axis = nalgebra::Unit::new_normalize(normal.cross(&Vec3::new(0.1, 0.7, 0.3)));
    for degrees in [20.0_f64, 100.0, 179.0] {
        let q = Rotation3::from_axis_angle(&axis, degrees.to_radians());
        let x: Vec<_> = reference.iter().map(|x| q * x).collect();
        let lambda = t.interface.turn_multipliers(&x, &t.lambda).unwrap();
        // About an axis within the surface it is the smallest rotation itself.
        assert!((lambda[4] - q * t.lambda[4]).amax() <= RIGID, "{degrees}");
        assert!(lambda.iter().zip(&t.lambda).all(|(a, b)| (a.norm() - b.norm()).abs() <= RIGID));
    }
    let then = moved(&options(), cells, rough, 3);
    assert_eq!(then.interface.turn_multipliers(&t.x1, &t.lambda).unwrap(), t.lambda);
}

#[test]
fn what_it_cannot_go_with_is_refused_by_name() {
    let one = grid(2, 2, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads);
    let two = grid(2, 2, [0.0, 0.0], [1.0, 1.0], 0.0, true, Cells::Quads);
    for weights in [Weights::Committed, Weights::Reference] {
        let surface = |m: &Mesh, side| Surface::new(side, m.x.clone(), &m.facets, numbered(0, m.x.len())).unwrap();
        let options = current(Options { weights, ..options() });
        let equations = numbered(100, one.x.len());
        let refused = stickslip::interface::Interface::new(
            surface(&one, "nonmortar"),
            surface(&two, "mortar"),
            equations,
            options,
        )
        .unwrap_err();
        assert_eq!(refused.kind, Kind::Unsupported, "{refused}");
    }
    let mut contact = interface(&one, &two, current(options()));
    let normals = vec![Vec3::z(); one.x.len()];
    assert_eq!(contact.set_normals(Some(normals)).unwrap_err().kind, Kind::Unsupported);
    contact.set_normals(None).unwrap();
}

/// With a measure of slip that is fixed in space, the limit of a turn stays.
#[test]
fn the_limit_of_a_turn_is_for_what_current_normals_do_not_cure() {
    for (slip, allowed) in
        [(SlipMeasure::Objective, true), (SlipMeasure::Increment, false), (SlipMeasure::Paper, false)]
    {
        let new_contact = NewContact::KeepFriction;
        let (_, _, cells) = scenes().next().unwrap();
        let mut t = moved(&current(Options { slip, new_contact, ..options() }), cells, FLAT, 3);
        let q = Rotation3::from_euler_angles(0.6, 0.0, 0.0);
        let (one, two) = t.interface.surfaces();
        let turned = |x: &[Vec3]| x.iter().map(|x| q * x).collect::<Vec<_>>();
        let (x1, x2) = (turned(&one.reference), turned(&two.reference));
        let result = t.interface.commit(&x1, &x2, &t.lambda, None);
        match allowed {
            true => result.unwrap(),
            false => {
                let refused = result.unwrap_err();
                assert!(
                    refused.kind == Kind::TurnedTooFar && format!("{refused}").contains("objectively"),
                    "{refused}"
                );
            }
        }
    }
}

/// Of a mortar side at rest there are no columns: those of x1 and of the multipliers by differences.
#[test]
fn the_tangent_of_a_rigid_side_equals_differences() {
    for (what, rough, cells) in scenes() {
        for basis in [MultiplierBasis::Standard, MultiplierBasis::Dual] {
            for form in [Form::Multiplier, Form::Augmented] {
                let options = current(Options { form, basis, weak_coverage: NO_WEAK_COVERAGE, ..options() });
                let t = moved(&options, cells, rough, 3);
                let (one, two) = t.interface.surfaces();
                let mut c: Contact<3> = contact(&mesh_of(one), &mesh_of(two), true, options);
                let (n1, n) = (3 * t.x1.len(), 3 * (2 * t.x1.len() + t.x2.len()));
                let mut k = vec![0.0; n * n];
                let mut add = |i: i64, j: i64, v: f64| k[i as usize * n + j as usize] += v;
                c.tangent(&t.x1, &t.x2, &t.lambda, None, &mut add).unwrap();
                let equations: Vec<_> = (0..n1).chain(n - n1..n).collect();
                let largest = max_abs(k.iter().copied());
                for column in 0..n1 {
                    let mut at = |h: f64| {
                        let mut x1 = t.x1.clone();
                        x1[column / 3][column % 3] += h;
                        let r = c.residual(&x1, &t.x2, &t.lambda, None).unwrap();
                        r.nonmortar.iter().chain(&r.rows).flat_map(|v| v.iter().copied()).collect::<Vec<_>>()
                    };
                    let (plus, minus) = (at(STEP), at(-STEP));
                    for ((&row, plus), minus) in equations.iter().zip(plus).zip(minus) {
                        let off = (k[row * n + column] - (plus - minus) / (2.0 * STEP)).abs();
                        assert!(off <= DIFFERENCES * largest, "{what} {basis:?} {form:?}: {row} {column}: {off:e}");
                    }
                }
            }
        }
    }
}

/// Two handles with a part of the mortar facets each: their residuals and tangents add up to those of one. Facets in turn,
/// and those of one half, where the nodes' owner has no pairs around many of them.
#[test]
fn shares_of_several_handles_add_up() {
    let (_, rough, cells) = scenes().next().unwrap();
    let scene = || moved(&current(options()), cells, rough, 3);
    shares_add_up(scene(), &|f, _| f % 2, &|a| a % 2);
    for owner in 0..2 {
        shares_add_up(scene(), &|_, left| usize::from(!left), &|_| owner);
        shares_add_up(strip(), &|_, left| usize::from(!left), &|_| owner);
    }
}

/// A strip of six curved facets over two facets below its ends.
fn strip() -> Moved {
    let mut one = grid(6, 1, [0.0, 0.0], [6.0, 1.0], 0.0, false, Cells::Quads);
    one.x.iter_mut().for_each(|x| x.z = 0.02 * (x.x - 3.0).powi(2) - 0.2 + 0.01 * x.y * x.x);
    let mut two = grid(1, 1, [-0.1, -0.2], [1.4, 1.3], -0.06, true, Cells::Quads);
    let other = grid(1, 1, [4.7, -0.2], [6.1, 1.3], -0.06, true, Cells::Quads);
    two.facets.extend(other.facets.iter().map(|f| f.iter().map(|k| k + 4).collect::<Vec<_>>()));
    two.x.extend(other.x);
    let x1 = one.x.iter().enumerate().map(|(k, x)| x + Vec3::repeat(0.005 * (3.0 * k as f64).sin())).collect();
    let lambda = vec![Vec3::new(0.05, 0.02, -0.5); one.x.len()];
    let options = Options { search_distance: Some(0.5), ..current(options()) };
    Moved { interface: interface(&one, &two, options), x1, x2: two.x, lambda }
}

/// `part`: whose a mortar facet is, by its number and whether it is in the left half; `owner`: whose a node is.
fn shares_add_up(mut whole: Moved, part_of: &dyn Fn(usize, bool) -> usize, owner: &dyn Fn(usize) -> usize) {
    let (n1, n2) = (whole.x1.len(), whole.x2.len());
    let n = 3 * (2 * n1 + n2);
    let options = *whole.interface.options();
    let (one, two) = whole.interface.surfaces();
    let (one, two) = (mesh_of(one), mesh_of(two));
    let mut parts: Vec<_> = (0..2)
        .map(|part| {
            let middle = two.x.iter().map(|x| x.x).sum::<f64>() / n2 as f64;
            let is_left = |f: &[i64]| f.iter().map(|k| two.x[*k as usize].x).sum::<f64>() < f.len() as f64 * middle;
            let of_part =
                two.facets.iter().enumerate().filter(|(k, f)| part_of(*k, is_left(f)) == part).map(|(_, f)| f);
            let mut used: Vec<_> = of_part.clone().flatten().copied().collect();
            used.sort_unstable();
            used.dedup();
            let facets: Vec<Vec<i64>> =
                of_part.map(|f| f.iter().map(|k| used.iter().position(|u| u == k).unwrap() as i64).collect()).collect();
            let equations = used.iter().map(|k| [0, 1, 2].map(|i| 3 * (n1 as i64 + k) + i)).collect();
            let at = |x: &[Vec3]| used.iter().map(|&k| x[k as usize]).collect::<Vec<_>>();
            let nonmortar = Surface::new("nonmortar", one.x.clone(), &one.facets, numbered(0, n1)).unwrap();
            let mortar = Surface::new("mortar", at(&two.x), &facets, equations).unwrap();
            let multipliers = numbered(3 * (n1 + n2), n1);
            let mut c = Contact::<3>::new(nonmortar, mortar, multipliers, options).unwrap();
            let of = |a: usize| if owner(a) == part { Owner::Here } else { Owner::Shared };
            c.set_owners((0..n1).map(of).collect()).unwrap();
            (c, at(&whole.x2))
        })
        .collect();
    let shares: Vec<_> = parts.iter_mut().map(|(c, x2)| c.share_of_sums(&whole.x1, x2).unwrap()).collect();
    let mut sums = shares[0].clone();
    for (sum, share) in sums.iter_mut().zip(&shares[1]) {
        sum.coverage += share.coverage;
        sum.gap_now += share.gap_now;
        sum.coverage_previous += share.coverage_previous;
        sum.gap_previous += share.gap_previous;
        sum.gap_committed += share.gap_committed;
    }
    let (mut k, mut rows) = (vec![0.0; n * n], vec![Vec3::zeros(); n1]);
    for (c, x2) in &mut parts {
        let mut add = |i: i64, j: i64, v: f64| k[i as usize * n + j as usize] += v;
        c.tangent(&whole.x1, x2, &whole.lambda, Some(&sums), &mut add).unwrap();
        let r = c.residual(&whole.x1, x2, &whole.lambda, Some(&sums)).unwrap();
        rows.iter_mut().zip(r.rows).for_each(|(row, share)| *row += share);
    }
    let (_, expected) = dense(&mut whole);
    let error = max_abs(k.iter().zip(&expected).map(|(a, b)| a - b)) / max_abs(expected.iter().copied());
    assert!(error <= RIGID, "{error:e}");
    let expected = whole.interface.residual(&whole.x1, &whole.x2, &whole.lambda, None).unwrap().rows;
    let scale = max_abs(expected.iter().map(|v| v.amax()));
    assert!(rows.iter().zip(&expected).all(|(a, b)| (a - b).amax() <= RIGID * scale));
}

/// The pattern for a matrix that is to last has every entry of a tangent, one multiplier a node and three.
#[test]
fn the_superset_has_every_entry_of_the_tangent() {
    fn check<const N: usize>(t: &Moved, options: Options, what: &str)
    where
        Contact<N>: Create<N>,
    {
        let (one, two) = t.interface.surfaces();
        let mut c: Contact<N> = contact(&mesh_of(one), &mesh_of(two), false, options);
        let lambda = vec![SVector::<f64, N>::repeat(-0.1); t.x1.len()];
        let (mut tangent, mut superset) = (Vec::new(), HashSet::new());
        c.tangent(&t.x1, &t.x2, &lambda, None, &mut |i: i64, j: i64, _| tangent.push((i, j))).unwrap();
        let at = (c.history().x1.clone(), c.history().x2.clone());
        c.superset_pattern(&at.0, &at.1, &mut |i, j, _| _ = superset.insert((i, j))).unwrap();
        assert!(tangent.iter().all(|e| superset.contains(e)), "{what}");
    }
    // Slid by less than a quarter of a facet.
    for (what, rough, cells) in scenes().filter(|(_, rough, _)| rough.slide < 0.25) {
        for form in [Form::Multiplier, Form::Augmented] {
            let t = moved(&current(Options { form, ..options() }), cells, rough, 3);
            check::<3>(&t, current(Options { form, ..options() }), what);
            check::<1>(&t, current(Options { form, friction: Friction::None, mu: 0.0, ..options() }), what);
        }
    }
}

/// Both faces of a plate of this thickness, the upper one at height 0.
fn both_faces(thickness: f64) -> Mesh {
    let face = |z: f64, up: bool| grid(4, 3, [-0.7, -0.7], [0.7, 0.7], z, up, Cells::Quads);
    joined(face(0.0, true), face(-thickness, false))
}

/// Two meshes as one.
fn joined(mut one: Mesh, mut two: Mesh) -> Mesh {
    let first = one.x.len() as i64;
    two.facets.iter_mut().flatten().for_each(|k| *k += first);
    one.x.append(&mut two.x);
    one.facets.append(&mut two.facets);
    one
}

/// Forces and rows of a step without friction that ends at (x1, x2), from where `c` is at t_n or from (x1, x2) itself.
fn residuals_of(mut c: impl FnMut() -> Contact<1>, x1: &[Vec3], x2: &[Vec3]) -> [stickslip::interface::Residual<1>; 2] {
    let lambda = vec![SVector::from([-0.1]); x1.len()];
    [false, true].map(|idle| {
        let mut c = c();
        if idle {
            c.set_previous(x1, x2).unwrap();
        }
        c.set_augmentation(Some(vec![15.0; x1.len()])).unwrap();
        c.residual(x1, x2, &lambda, None).unwrap()
    })
}

fn without_friction() -> Options {
    current(Options { friction: Friction::None, mu: 0.0, row_scale: RowScale::None, ..options() })
}

/// Pairs of t_n whose facets have turned since may be far sides now: they are none then. Without friction a step has the
/// residual of one that begins where it ends.
#[test]
fn pairs_of_the_start_that_have_turned_away_are_none() {
    let one = grid(3, 3, [-0.4, -0.4], [0.4, 0.4], -0.001, false, Cells::Quads);
    let plate = both_faces(0.05);
    // About the middle of its thickness.
    let turned = |degrees: f64| {
        let (middle, q) = (Vec3::z() * -0.025, Rotation3::new(Vec3::x() * degrees.to_radians()));
        Mesh { x: plate.x.iter().map(|x| q * (x - middle) + middle).collect(), facets: plate.facets.clone() }
    };
    for degrees in [30.0, 60.0, 120.0, 180.0] {
        let start = turned(degrees);
        let c = || contact::<1>(&one, &start, false, without_friction());
        let [step, idle] = residuals_of(c, &one.x, &plate.x);
        assert!(idle.rows.iter().all(|row| row[0] < 0.0), "all are in contact");
        let off = max_abs(step.rows.iter().zip(&idle.rows).map(|(a, b)| a[0] - b[0]));
        assert!(off <= RIGID, "{degrees}: {off:e}");
    }
}

/// The same against an analytic surface: facets that have turned away from it are no pairs any more.
#[test]
fn facets_that_have_turned_away_from_an_analytic_surface_are_no_pairs() {
    // A ball's facets meet at no sharp edge, so all of it follows from which facets are pairs.
    let body = ball(4);
    for shape in [AnalyticShape::Plane, AnalyticShape::Sphere(1.5), AnalyticShape::Cylinder(1.5)] {
        let height = shape.radius() + 0.85;
        // The axis of the cylinder is the first direction.
        let x2 = [Vec3::zeros(), Vec3::z(), Vec3::x(), Vec3::y()].to_vec();
        let x2 = if shape == AnalyticShape::Cylinder(1.5) { vec![x2[0], x2[2], x2[3], x2[1]] } else { x2 };
        let at = |q: Rotation3<f64>| body.x.iter().map(|x| q * x + Vec3::z() * height).collect::<Vec<_>>();
        for degrees in [30.0_f64, 90.0, 170.0] {
            let c = || {
                let start = at(Rotation3::new(Vec3::new(0.8, 0.6, 0.0) * degrees.to_radians()));
                let one = Surface::new("nonmortar", start, &body.facets, numbered(0, body.x.len())).unwrap();
                let two = Surface::analytic("mortar", shape, x2.clone()).unwrap();
                Contact::create(one, two, numbered(3 * body.x.len(), body.x.len()), without_friction()).unwrap()
            };
            let [step, idle] = residuals_of(c, &at(Rotation3::identity()), &x2);
            assert!(idle.rows.iter().any(|row| row[0] < 0.0), "some are in contact");
            let off = max_abs(step.rows.iter().zip(&idle.rows).map(|(a, b)| a[0] - b[0]));
            assert!(off <= RIGID, "{shape} {degrees}: {off:e}");
        }
    }
}

/// The pattern for a matrix that is to last knows the pairs that a small motion lets in, too: here steep facets, which
/// oppose too little to be pairs before a turn of one degree.
#[test]
fn the_superset_knows_the_pairs_that_a_small_motion_lets_in() {
    let one = grid(3, 3, [-0.5, -0.5], [0.5, 0.5], 0.0, false, Cells::Quads);
    let flat = grid(3, 3, [-0.9, -0.9], [0.9, 0.9], -0.5, true, Cells::Quads);
    // The filter asks for 80.2 degrees.
    let at = |degrees: f64| {
        let mut steep = grid(2, 2, [-0.4, -0.3], [0.4, 0.3], 0.0, true, Cells::Quads);
        let q = Rotation3::new(Vec3::x() * degrees.to_radians());
        steep.x.iter_mut().for_each(|x| *x = q * *x);
        joined(flat.clone(), steep)
    };
    let (start, end) = (at(80.6), at(79.6));
    let mut c = interface(&one, &start, current(options()));
    let (mut superset, mut entries) = (HashSet::new(), Vec::new());
    c.superset_pattern(&one.x, &start.x, &mut |i, j, _| _ = superset.insert((i, j))).unwrap();
    let lambda = vec![Vec3::zeros(); one.x.len()];
    let mut pairs_of = |x2: &[Vec3]| {
        c.tangent(&one.x, x2, &lambda, None, &mut |i: i64, j: i64, _| entries.push((i, j))).unwrap();
        c.active_pairs()
    };
    assert!(pairs_of(&end.x) > pairs_of(&start.x), "the turn lets pairs in");
    assert!(entries.iter().all(|e| superset.contains(e)));
}
