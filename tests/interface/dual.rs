//! Dual multipliers through all stages of an interface (docs/formulation 10): golden cases, the tangent against
//! differences, its pattern, what is refused.

use super::golden::{dense_tangent, expected_tangent, residual_error, set_up_with, tangent_error};
use crate::support::differences::Point;
use crate::support::mesh::*;
use crate::support::*;
use serde_json::Value;
use std::collections::HashSet;
use stickslip::error::Kind;
use stickslip::geometry::Vec3;
use stickslip::interface::{
    Contact, Extent, Form, Friction, Interface, MultiplierBasis, NO_WEAK_COVERAGE, Options, Stiffness, Weights,
};
use stickslip::quadrature::{DEGREE_5, DEGREE_10};

/// Residual blocks, relative to the largest entry of the block.
pub const RESIDUAL: f64 = 1e-12;
/// Tangent blocks of affine interfaces.
const TANGENT: f64 = 1e-10;
/// A block smaller than this part of the matrix is what is left of pairs that cancel: its rounding is 1e-16 of the matrix.
const VANISHING: f64 = 1e-5;
/// Non-affine facets with the rule of degree 10.
const RULE_RESIDUAL: f64 = 1e-8;
const RULE_TANGENT: f64 = 1e-4;
/// The tangent against differences, relative to the largest entry of a block, on affine facets.
const DIFFERENCES: f64 = 1e-7;

pub fn dual(of: Options) -> Options {
    let weak_coverage = if of.weak_coverage == 0.0 { NO_WEAK_COVERAGE } else { of.weak_coverage };
    Options { basis: MultiplierBasis::Dual, weak_coverage, ..of }
}

pub fn cases() -> Vec<Value> {
    golden_part("golden_dual.json", "interfaces")
}

#[test]
fn golden_states_and_residuals() {
    for case in cases() {
        for (form, key) in [(Form::Multiplier, "residual_mult"), (Form::Augmented, "residual")] {
            let options = dual(Options { form, ..Options::paper(Stiffness::Augmentation(1.0)) });
            let mut g = set_up_with(&case, options);
            let responses = g.interface.responses(&g.x1, &g.x2, &g.lambda, None).unwrap();
            for (a, (response, state)) in responses.iter().zip(numbers(&case["state"])).enumerate() {
                assert!(response.state as i32 == state as i32, "{}: state of node {a}", name(&case));
            }
            let error = residual_error(&mut g, &numbers(&case[key]));
            println!("{:32} {key} {error:.1e}", name(&case));
            assert!(error <= RESIDUAL, "{}: {key} off by {error:e}", name(&case));
        }
    }
}

#[test]
fn golden_tangents() {
    let mut compared = [0; 2];
    for case in cases() {
        for (k, (form, key)) in
            [(Form::Multiplier, "tangent_mult"), (Form::Augmented, "tangent")].into_iter().enumerate()
        {
            let affine = case["affine"].as_bool().unwrap();
            let expected = if affine { &case[key] } else { &case["exactquad"][key] };
            if !expected.is_object() {
                continue;
            }
            let rule = if affine { &DEGREE_5 } else { &DEGREE_10 };
            let mut g =
                set_up_with(&case, dual(Options { form, rule, ..Options::paper(Stiffness::Augmentation(1.0)) }));
            let (n, tangent) = dense_tangent(&mut g);
            let error = tangent_error(g.x1.len(), n, &tangent, &expected_tangent(expected, n), VANISHING);
            println!("{:32} {key} {error:.1e}", name(&case));
            assert!(error <= if affine { TANGENT } else { RULE_TANGENT }, "{}: {key} off by {error:e}", name(&case));
            compared[k] += 1;
            if !affine {
                let key = if k == 0 { "residual_mult" } else { "residual" };
                let error = residual_error(&mut g, &numbers(&case["exactquad"][key]));
                assert!(error <= RULE_RESIDUAL, "{}: {key} off by {error:e}", name(&case));
            }
        }
    }
    assert!(compared[0] >= 4, "{compared:?}");
}

/// Meshes on which facets are covered by several pairs; the second is covered in part, at a corner too.
fn scenes() -> impl Iterator<Item = (&'static str, Roughness, [Cells; 2])> {
    rough_scenes(0.05)
}

#[test]
fn the_tangent_equals_differences_in_every_column() {
    let mut states = [0; 3];
    for (what, rough, cells) in scenes() {
        // Mortar facets are affine where they are triangles; the other facets are affine in the second kind of scene.
        let rule = if cells[1] == Cells::Quads { &DEGREE_10 } else { &DEGREE_5 };
        for form in [Form::Multiplier, Form::Augmented] {
            for friction in [Friction::Coulomb, Friction::Rough, Friction::Tied, Friction::Tresca] {
                for weak_coverage in [NO_WEAK_COVERAGE, 0.2] {
                    let options = dual(under(friction, 0.7, Options { form, weak_coverage, rule, ..mesh::options() }));
                    let mut t = moved(&options, cells, rough, 3);
                    states.iter_mut().zip(t.states()).for_each(|(all, here)| *all += here);
                    let error = t.at().difference_error(0.0);
                    assert!(error <= DIFFERENCES, "{what} {form:?} {friction:?} {weak_coverage}: {error:e}");
                }
            }
        }
    }
    assert!(states.iter().all(|n| *n > 20), "{states:?}");
}

/// Frozen weights.
#[test]
fn the_tangent_of_frozen_weights_equals_differences() {
    let of = dual(options());
    for (what, rough, cells) in scenes().take(2) {
        for options in [
            Options { weights: Weights::Committed, ..of },
            Options { weights: Weights::Reference, ..of },
            Options { weights: Weights::Reference, form: Form::Augmented, ..of },
        ] {
            let mut t = moved(&options, cells, rough, 3);
            let error = t.at().difference_error(0.0);
            assert!(error <= DIFFERENCES, "{what} {options:?}: {error:e}");
        }
    }
}

/// Of a mortar side at rest there are no columns: those of x1 by differences.
#[test]
fn the_tangent_of_a_rigid_side_equals_differences() {
    const STEP: f64 = 1e-6;
    for (what, rough, cells) in scenes() {
        for form in [Form::Multiplier, Form::Augmented] {
            let options = dual(Options { form, ..options() });
            let t = moved(&options, cells, rough, 3);
            let (one, two) = t.interface.surfaces();
            let mut c: Contact<3> = contact(&mesh_of(one), &mesh_of(two), true, options);
            let n = 3 * t.x1.len();
            let mut k = vec![0.0; n * n];
            let mut add = |i: i64, j: i64, v: f64| {
                if i < n as i64 && j < n as i64 {
                    k[i as usize * n + j as usize] += v;
                }
            };
            c.tangent(&t.x1, &t.x2, &t.lambda, None, &mut add).unwrap();
            let largest = max_abs(k.iter().copied());
            for j in 0..n {
                let mut at = |h: f64| {
                    let mut x1 = t.x1.clone();
                    x1[j / 3][j % 3] += h;
                    c.residual(&x1, &t.x2, &t.lambda, None).unwrap().nonmortar
                };
                let (plus, minus) = (at(STEP), at(-STEP));
                for i in 0..n {
                    let slope = (plus[i / 3][i % 3] - minus[i / 3][i % 3]) / (2.0 * STEP);
                    assert!((k[i * n + j] - slope).abs() <= DIFFERENCES * largest, "{what} {form:?}: {i} {j}");
                }
            }
        }
    }
}

#[test]
fn the_pattern_has_the_tangents_entries_and_the_superset_has_them_all() {
    for (_, rough, cells) in scenes() {
        for form in [Form::Multiplier, Form::Augmented] {
            let mut t = moved(&dual(Options { form, ..options() }), cells, rough, 3);
            let (mut tangent, mut pattern, mut superset) = (Vec::new(), Vec::new(), HashSet::new());
            let c = &mut t.interface;
            c.tangent(&t.x1, &t.x2, &t.lambda, None, &mut |i: i64, j: i64, _| tangent.push((i, j))).unwrap();
            c.pattern(&t.x1, &t.x2, Extent::Whole, &mut |i, j, _| pattern.push((i, j))).unwrap();
            c.superset_pattern(&t.x1, &t.x2, &mut |i, j, _| _ = superset.insert((i, j))).unwrap();
            assert_eq!(pattern, tangent);
            assert!(tangent.iter().all(|e| superset.contains(e)));
        }
    }
}

/// One multiplier a node.
#[test]
fn the_tangent_without_friction_equals_differences() {
    for (what, rough, cells) in scenes() {
        for form in [Form::Multiplier, Form::Augmented] {
            let options = dual(Options { form, ..options() });
            let t = moved(&options, cells, rough, 3);
            let (one, two) = t.interface.surfaces();
            let options = Options { friction: Friction::None, mu: 0.0, ..options };
            let mut c: Contact<1> = contact(&mesh_of(one), &mesh_of(two), false, options);
            let lambda: Vec<_> = t.lambda.iter().map(|l| nalgebra::Vector1::new(l.z)).collect();
            let error = Point { contact: &mut c, x1: &t.x1, x2: &t.x2, lambda: &lambda }.difference_error(0.0);
            assert!(error <= DIFFERENCES, "{what} {form:?}: {error:e}");
        }
    }
}

/// Linear momentum, and forces at the nodes: f_A = D_A lambda_A.
#[test]
fn a_nodes_force_is_its_multiplier_times_its_area() {
    const ROUNDING: f64 = 1e-13;
    for (what, rough, cells) in scenes() {
        let mut t = moved(&dual(options()), cells, rough, 3);
        let sums = t.interface.sums(&t.x1, &t.x2).unwrap();
        let r = t.interface.residual(&t.x1, &t.x2, &t.lambda, None).unwrap();
        for ((force, sum), lambda) in r.nonmortar.iter().zip(&sums).zip(&t.lambda) {
            assert!((force - lambda * sum.coverage).amax() <= ROUNDING, "{what}");
        }
        let total: Vec3 = r.nonmortar.iter().chain(&r.mortar).sum();
        assert!(total.amax() <= ROUNDING, "{what}: {total}");
    }
}

#[test]
fn sums_of_several_handles_are_refused_by_name() {
    let one = grid(1, 1, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads);
    let two = grid(1, 1, [-0.5, -0.5], [1.5, 1.5], 0.0, true, Cells::Quads);
    let mut c: Interface = interface(&one, &two, dual(options()));
    let sums = c.sums(&one.x, &two.x).unwrap();
    let error = c.residual(&one.x, &two.x, &[Vec3::zeros(); 4], Some(&sums)).unwrap_err();
    assert!(error.kind == Kind::Unsupported && error.to_string().contains("dual"), "{error}");
}

/// The diagnosis compares a pair's own weights with those of a finer rule, not the ones that act.
#[test]
fn the_error_of_integration_is_that_of_the_standard_basis() {
    let (_, rough, cells) = scenes().nth(3).unwrap();
    let [standard, dual] = [options(), dual(options())].map(|options| {
        let mut t = moved(&options, cells, rough, 3);
        t.interface.diagnose(&t.x1, &t.x2, &t.lambda, None).unwrap().error.unwrap()
    });
    assert_eq!(standard, dual);
}

/// What may be taken of a step is told by the gaps of the weights that act, whether an evaluation has left them or not.
#[test]
fn the_limit_of_a_step_knows_nothing_of_the_calls_before_it() {
    let mut limited = 0;
    for (what, rough, cells) in scenes() {
        let down = |t: &Moved| vec![t.interface.normal(0).unwrap() * -1.5; t.x1.len()];
        let mut fresh = moved(&dual(options()), cells, rough, 3);
        let mut used = moved(&dual(options()), cells, rough, 3);
        used.interface.residual(&used.x1, &used.x2, &used.lambda, None).unwrap();
        let [a, b] = [&mut fresh, &mut used].map(|t| {
            let (dx1, dx2) = (down(t), vec![Vec3::zeros(); t.x2.len()]);
            t.interface.step_limit((&t.x1, &t.x2), (&dx1, &dx2), None).unwrap()
        });
        assert_eq!(a, b, "{what}");
        limited += usize::from(a < 1.0);
    }
    assert!(limited > 0);
}

/// A pair's share of dual weights may be negative: the report counts the mortar facets of a node by overlaps all the same.
#[test]
fn the_report_counts_facets_whatever_the_sign_of_their_weights() {
    for (what, rough, cells) in scenes() {
        let [standard, dual] = [options(), dual(options())].map(|of| {
            let options = Options { weights: Weights::Committed, ..of };
            let mut t = moved(&options, cells, rough, 3);
            t.interface.commit(&t.x1, &t.x2, &t.lambda, None).unwrap();
            let report = t.interface.report(&t.x1, &t.x2).unwrap();
            report.nodes.iter().map(|node| node.facets).collect::<Vec<_>>()
        });
        assert_eq!(standard, dual, "{what}");
        assert!(standard.iter().any(|n| *n > 1), "{what}");
    }
}
