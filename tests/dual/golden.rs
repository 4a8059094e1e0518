//! Dual weights of one facet, and their derivatives, against those of 51 digits.

use super::facet::{Patch, Scene};
use crate::support::*;
use serde_json::Value;
use stickslip::dual::DualBasis;
use stickslip::quadrature::{DEGREE_5, DEGREE_10};

/// Rounding of the sums of n_AB over pairs, relative to the largest number.
const SUMS: f64 = 1e-13;
/// Of dual weights: sums times coefficients, of which the largest is 4 on a covered facet and near 16 on any that is
/// covered along an edge.
const WEIGHTS: f64 = 1e-12;
/// On the facet under an inner strip, whose matrix has the condition 2e4.
const WEIGHTS_UNDER_A_STRIP: f64 = 1e-10;
/// Of derivatives, relative to the largest: a system more than the weights.
const DERIVATIVES: f64 = 1e-10;
/// Of derivatives under the strip.
const DERIVATIVES_UNDER_A_STRIP: f64 = 1e-8;
/// Error of the rule of degree 5 on the distorted and warped quadrilaterals of the file (measured 4.8e-7), and of its
/// derivatives (measured 4.6e-6).
const RULE: f64 = 1e-6;
const RULE_OF_DERIVATIVES: f64 = 1e-5;
/// The same of the rule of degree 10 (measured 1.1e-14 and 4.0e-13).
const FINE_RULE: f64 = 1e-12;
const FINE_RULE_OF_DERIVATIVES: f64 = 1e-11;

fn cases() -> Vec<Value> {
    golden_part("golden_dual.json", "facets")
}

/// The largest difference to a table of rows A, and the largest number of that.
fn error_of(found: impl Fn(usize, usize) -> f64, expected: &Value) -> (f64, f64) {
    let (mut error, mut largest) = (0.0_f64, 0.0_f64);
    for (a, row) in table(expected).iter().enumerate() {
        for (b, v) in row.iter().enumerate() {
            error = error.max((found(a, b) - v).abs());
            largest = largest.max(v.abs());
        }
    }
    (error, largest)
}

/// The same of a list.
fn error_of_list(found: &[f64], expected: &Value) -> (f64, f64) {
    error_of(|_, a| found[a], &Value::from(vec![expected.clone()]))
}

/// n^d_AC of a facet, `[C][A]`; nothing where it has faded out.
fn dual_weights(patch: &Patch) -> Vec<[f64; 4]> {
    match DualBasis::of(&patch.sums).unwrap() {
        Some(basis) => patch.columns().iter().map(|n| basis.dual(n)).collect(),
        None => vec![[0.0; 4]; patch.mortar],
    }
}

/// The largest difference of the diagonal's derivatives and of the weights', each with the largest number.
fn derivative_errors(patch: &Patch, expected: &Value) -> [(f64, f64); 2] {
    let (diagonal, weights) = patch.full();
    let of_areas = error_of(|a, column| diagonal[column][a], &expected["dD"]);
    let mut of_weights = (0.0_f64, 0.0_f64);
    for (a, rows) in expected["dnd"].as_array().unwrap().iter().enumerate() {
        let (error, largest) = error_of(|c, column| weights[column][c][a], rows);
        of_weights = (of_weights.0.max(error), of_weights.1.max(largest));
    }
    [of_areas, of_weights]
}

/// Prints the error relative to the scale, and compares it.
fn check(what: &str, name: &str, (error, scale): (f64, f64), bound: f64) {
    println!("{name:40} {what:8} {:.1e}", error / scale);
    assert!(error <= bound * scale, "{name}: {what} off by {error:e} of {scale:e}");
}

#[test]
fn values() {
    for case in cases() {
        let patch = Scene::of(&case).patch(&DEGREE_5);
        let (name, sums) = (&patch.name[..], &patch.sums);
        let overlapping = patch.pairs.iter().filter(|p| p.segment.area > 0.0).count();
        // The file's list also has some that only touch.
        assert!(overlapping > 0 && overlapping <= case["pairs"].as_array().unwrap().len(), "{name}");
        // Of slivers the rounding of places within the facet is what counts.
        let scaled = |(error, largest)| (error, if name.contains("sliver") { sums.area } else { largest });
        check("m_AB", name, scaled(error_of(|a, b| sums.mass[a][b], &case["M_e"])), SUMS);
        check("m_A", name, scaled(error_of_list(&sums.areas(), &case["m"])), SUMS);
        check("n_BC", name, scaled(error_of(|a, c| patch.columns()[c][a], &case["nAC"])), SUMS);
        let coverage = sums.coverage();
        check("share", name, ((coverage.share - case["coverage"].as_f64().unwrap()).abs(), 1.0), SUMS);
        check("fade", name, ((coverage.fade - case["fade"].as_f64().unwrap()).abs(), 1.0), SUMS);
        let found = error_of(|a, c| dual_weights(&patch)[c][a], &case["nd"]);
        let Some(basis) = DualBasis::of(sums).unwrap() else {
            assert!(case["A"].is_null() && found == (0.0, 0.0), "{name}: faded out is exactly nothing");
            continue;
        };
        check("phi m_A", name, scaled(error_of_list(&basis.diagonal(), &case["D"])), SUMS);
        if name.contains("strip") {
            check("n^d_AC", name, found, WEIGHTS_UNDER_A_STRIP);
        } else {
            check("n^d_AC", name, scaled(found), WEIGHTS);
        }
        if !name.contains("strip") && !name.contains("sliver") {
            check("a_AB", name, error_of(|a, b| basis.coefficients()[a][b], &case["A"]), WEIGHTS);
        }
    }
}

#[test]
fn derivatives() {
    let mut seen = 0;
    for case in cases().iter().filter(|case| case["affine"] == true && !case["A"].is_null()) {
        let patch = Scene::of(case).patch(&DEGREE_5);
        let [areas, weights] = derivative_errors(&patch, case);
        let bound = if patch.name.contains("strip") { DERIVATIVES_UNDER_A_STRIP } else { DERIVATIVES };
        check("Dm_A", &patch.name, areas, bound);
        check("Dn^d_AC", &patch.name, weights, bound);
        seen += 1;
    }
    assert!(seen >= 5, "{seen}");
}

#[test]
fn distorted_quadrilaterals_have_the_rules_error() {
    let bounds = [(&DEGREE_5, RULE, RULE_OF_DERIVATIVES), (&DEGREE_10, FINE_RULE, FINE_RULE_OF_DERIVATIVES)];
    for case in cases().iter().filter(|case| case["affine"] == false) {
        for (rule, of_values, of_derivatives) in bounds {
            let patch = Scene::of(case).patch(rule);
            let exact = &case["exact"];
            let found = error_of(|a, c| dual_weights(&patch)[c][a], &exact["nd"]);
            check("n^d_AC", &patch.name, found, of_values);
            check("phi m_A", &patch.name, error_of_list(&patch.basis().diagonal(), &exact["D"]), of_values);
            let [areas, weights] = derivative_errors(&patch, exact);
            check("Dm_A", &patch.name, areas, of_derivatives);
            check("Dn^d_AC", &patch.name, weights, of_derivatives);
        }
    }
}
