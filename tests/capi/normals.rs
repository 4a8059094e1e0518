//! Golden interfaces with normals of the current configuration behind a handle of the C ABI.

use super::golden::*;
use crate::support::*;
use serde_json::Value;
use stickslip::capi::*;

/// Normals and residual blocks, relative to the largest entry of the block.
const VALUES: f64 = 1e-12;
/// Tangent blocks of affine interfaces.
const TANGENT: f64 = 1e-10;
/// Non-affine facets against the exact integral, with the rule of degree 10.
const RULE_RESIDUAL: f64 = 1e-8;
const RULE_TANGENT: f64 = 1e-4;
/// A block smaller than this part of the matrix is what is left of terms that cancel.
const VANISHING: f64 = 1e-5;

/// Forms, with the golden names of their residuals and tangents.
const FORMS: [(i32, &str, &str); 2] = [
    (STICKSLIP_FORM_MULTIPLIER, "residual_mult", "tangent_current_mult"),
    (STICKSLIP_FORM_AUGMENTED, "residual", "tangent_current"),
];

fn open(case: &Value, choose: impl Fn(&mut stickslip_options, &mut stickslip_method)) -> Golden {
    Golden::with_options(case, |options, method| {
        method.normals = STICKSLIP_NORMALS_CURRENT;
        let dual = case["basis"] == "dual";
        method.multiplier_basis = if dual { STICKSLIP_BASIS_DUAL } else { STICKSLIP_BASIS_STANDARD };
        choose(options, method);
    })
}

fn residual_off(g: &Golden, expected: &Value) -> f64 {
    residual_error(g.ends(), &g.residual(), &numbers(expected))
}

#[test]
fn golden_normals_and_residuals() {
    let mut worst = [0.0_f64; 2];
    for case in golden("golden_normals.json") {
        for (form, residual, _) in FORMS {
            let g = open(&case, |_, method| method.form = form);
            let states: Vec<f64> = g.states().into_iter().map(f64::from).collect();
            assert_eq!(states, numbers(&case["state"]), "{}", name(&case));
            let errors = [difference(&g.normals(), &flat(&case["nu"])), residual_off(&g, &case[residual])];
            for (worst, error) in worst.iter_mut().zip(errors) {
                *worst = worst.max(error);
                assert!(error <= VALUES, "{}: {residual} {errors:?}", name(&case));
            }
        }
    }
    println!("states exactly; nu {:.1e}, residual {:.1e}", worst[0], worst[1]);
}

#[test]
fn golden_tangents_with_current_normals() {
    let (mut worst, mut compared) = ([0.0_f64; 3], 0);
    for case in golden("golden_normals.json") {
        let affine = case["affine"] == true;
        let expected = if affine { &case } else { &case["exactquad"] };
        for (form, residual, tangent) in FORMS {
            if !expected[tangent].is_object() {
                continue; // left out of the small copy
            }
            let quadrature = if affine { STICKSLIP_QUADRATURE_DEGREE_5 } else { STICKSLIP_QUADRATURE_DEGREE_10 };
            let g = open(&case, |_, method| (method.form, method.quadrature) = (form, quadrature));
            let matrix = dense(&expected[tangent], g.ends()[3]);
            let error = tangent_error(g.ends(), &g.tangent(), &matrix, VANISHING);
            assert!(
                error <= if affine { TANGENT } else { RULE_TANGENT },
                "{}: {tangent} off by {error:e}",
                name(&case)
            );
            worst[usize::from(!affine)] = worst[usize::from(!affine)].max(error);
            if !affine {
                let error = residual_off(&g, &expected[residual]);
                assert!(error <= RULE_RESIDUAL, "{}: {residual} off by {error:e}", name(&case));
                worst[2] = worst[2].max(error);
            }
            compared += 1;
        }
    }
    println!("tangent {:.1e}; warped, degree 10: tangent {:.1e}, residual {:.1e}", worst[0], worst[1], worst[2]);
    assert!(compared >= 6, "{compared}");
}

/// A tangent is compared as a whole: its rows along the normal have no blocks of vectors.
#[test]
fn golden_interfaces_with_one_multiplier() {
    let (mut worst, mut compared) = ([0.0_f64; 2], 0);
    let whole = |found: &[f64], expected: &[f64]| difference(found, expected) / max_abs(expected.iter().copied());
    for case in golden("golden_normals.json").iter().filter(|case| case["lambda_N"].is_array()) {
        for (form, residual, tangent) in FORMS {
            let g = open(case, |options, method| (method.form, options.friction) = (form, STICKSLIP_FRICTION_NONE));
            // Closed nodes are told from open ones; stick is no state of theirs.
            let states: Vec<f64> = g.states().into_iter().map(f64::from).collect();
            assert_eq!(states, numbers(&case["one_state"]), "{}", name(case));
            let residual = residual_off(&g, &case[format!("one_{residual}").as_str()]);
            let expected = dense(&case[format!("one_{tangent}").as_str()], g.ends()[3]);
            let tangent = whole(&g.tangent(), &expected);
            assert!(residual <= VALUES && tangent <= TANGENT, "{}: {residual:e} {tangent:e}", name(case));
            worst = [worst[0].max(residual), worst[1].max(tangent)];
            compared += 1;
        }
    }
    println!("one multiplier: residual {:.1e}, tangent {:.1e}", worst[0], worst[1]);
    assert!(compared >= 2);
}
