//! Golden interfaces with dual multipliers behind a handle of the C ABI: residuals, tangents, and systems without multipliers.

use super::golden::*;
use crate::support::*;
use nalgebra::{DMatrix, DVector};
use std::ffi::CStr;
use stickslip::capi::*;

/// Residuals, L, R_cond, relative to the largest entry.
const VALUES: f64 = 1e-12;
/// Tangents and J_cond of affine interfaces, and where the golden ones are those of the rule.
const TANGENT: f64 = 1e-10;
const RULE_TANGENT: f64 = 1e-4;
/// A block smaller than this part of the matrix is what is left of pairs that cancel.
const VANISHING: f64 = 1e-5;
/// Steps and multipliers: the condition of the system times rounding.
const SOLUTION: f64 = 1e-9;

fn open(case: &serde_json::Value) -> Golden {
    let multiplier = STICKSLIP_FORM_MULTIPLIER;
    Golden::with_basis(case, multiplier, STICKSLIP_QUADRATURE_DEGREE_5, STICKSLIP_BASIS_DUAL)
}

fn error(found: &[f64], expected: &[f64]) -> f64 {
    difference(found, expected) / max_abs(expected.iter().copied())
}

#[test]
fn golden_dual_interfaces() {
    for case in &golden_part("golden_dual.json", "interfaces") {
        let g = open(case);
        let states: Vec<f64> = g.states().into_iter().map(f64::from).collect();
        assert_eq!(states, numbers(&case["state"]), "{}", name(case));
        let found = residual_error(g.ends(), &g.residual(), &numbers(&case["residual_mult"]));
        assert!(found <= VALUES, "{}: residual off by {found:e}", name(case));
        if case["affine"] == true && case["tangent_mult"].is_object() {
            let expected = dense(&case["tangent_mult"], g.ends()[3]);
            let found = tangent_error(g.ends(), &g.tangent(), &expected, VANISHING);
            assert!(found <= TANGENT, "{}: tangent off by {found:e}", name(case));
        }
    }
}

/// A piece of the condensed matrix, full.
fn piece(g: &Golden, n: usize, piece: i32) -> DMatrix<f64> {
    let (x1, x2, lambda) = (g.x1.as_ptr(), g.x2.as_ptr(), g.lambda.as_ptr());
    let mut count = 0;
    let none = std::ptr::null_mut();
    ok!(stickslip_interface_condensed_coo(g.handle, x1, x2, lambda, piece, 0, none, none, none.cast(), &mut count));
    let (mut rows, mut columns, mut values) =
        (vec![0; count as usize], vec![0; count as usize], vec![0.0; count as usize]);
    let (r, c, v) = (rows.as_mut_ptr(), columns.as_mut_ptr(), values.as_mut_ptr());
    ok!(stickslip_interface_condensed_coo(g.handle, x1, x2, lambda, piece, count, r, c, v, &mut count));
    let mut m = DMatrix::zeros(n, n);
    for ((i, j), v) in rows.into_iter().zip(columns).zip(values) {
        m[(i as usize, j as usize)] += v;
    }
    m
}

#[test]
fn golden_condensed_systems() {
    let mut compared = 0;
    for case in golden_part("golden_dual.json", "interfaces").iter().filter(|c| c["condensed"].is_object()) {
        let (g, expected) = (open(case), &case["condensed"]);
        let (n1, n) = (g.x1.len(), g.x1.len() + g.x2.len());
        let (j_host, r_host) = golden_host(n);
        let (x1, x2, lambda) = (g.x1.as_ptr(), g.x2.as_ptr(), g.lambda.as_ptr());
        let offsets: Vec<i64> = (0..=n).map(|k| (k * n) as i64).collect();
        let columns: Vec<i64> = (0..n * n).map(|k| (k % n) as i64).collect();
        let mut entries: Vec<f64> = j_host.transpose().iter().copied().collect();
        let (o, c, v) = (offsets.as_ptr(), columns.as_ptr(), entries.as_mut_ptr());
        ok!(stickslip_interface_condensed_csr(g.handle, x1, x2, lambda, n as i64, o, c, v));
        let (mut rows, mut gains) = (r_host.as_slice()[..n1].to_vec(), vec![f64::NAN; n - n1]);
        let p = rows.as_mut_ptr(); // in place of the host's
        ok!(stickslip_interface_condensed_residual(g.handle, x1, x2, lambda, p, p, gains.as_mut_ptr()));
        let gained = gains.iter().zip(&r_host.as_slice()[n1..]).map(|(gain, own)| own + gain);
        let r: Vec<f64> = rows.iter().copied().chain(gained).collect();

        let l = piece(&g, n, STICKSLIP_CONDENSED_ELIMINATION) + DMatrix::identity(n, n);
        let (w, p) = (flat(&expected["W"]), table(&expected["P"]));
        for a in 0..n1 / 3 {
            let found: Vec<f64> = l.view((3 * a, 3 * a), (3, 3)).transpose().iter().copied().collect();
            assert!(difference(&found, &w[9 * a..9 * a + 9]) <= VALUES, "{}: W of {a}", name(case));
            for (k, p) in p[a].iter().enumerate() {
                let found = l.view((n1 + 3 * k, 3 * a), (3, 3)) - DMatrix::identity(3, 3) * *p;
                assert!(found.amax() <= VALUES, "{}: P of {a}, {k}", name(case));
            }
        }
        let (tangent, solution) =
            if case["affine"] == true { (VALUES, SOLUTION) } else { (RULE_TANGENT, RULE_TANGENT) };
        let errors = [error(&entries, &flat(&expected["J_cond"])), error(&r, &flat(&expected["R_cond"]))];
        assert!(errors[0] <= tangent && errors[1] <= VALUES, "{}: {errors:?}", name(case));

        let j = DMatrix::from_row_slice(n, n, &entries);
        let du = -j.lu().solve(&DVector::from_vec(r)).unwrap();
        assert!(error(du.as_slice(), &flat(&expected["du"])) <= solution, "{}: du", name(case));
        let linear = &r_host + (j_host + piece(&g, n, STICKSLIP_CONDENSED_FORCES)) * du;
        let mut new = vec![f64::NAN; n1];
        let p = linear.as_slice().as_ptr();
        ok!(stickslip_interface_condensed_multipliers(g.handle, x1, x2, p, new.as_mut_ptr()));
        assert!(error(&new, &flat(&expected["lambda_new"])) <= solution, "{}: multipliers", name(case));
        compared += 1;
    }
    assert!(compared > 0);
}
