//! Facets added up to interfaces: weights, gaps, forces at fixed multipliers and their derivatives, against those of 51
//! digits. What the law adds is not here.

use super::facet::{Patch, Scene};
use crate::support::*;
use serde_json::Value;
use stickslip::dual::DualBasis;
use stickslip::geometry::Vec3;
use stickslip::quadrature::DEGREE_5;

/// Rounding of sums over facets, relative to the largest number of a kind.
const VALUES: f64 = 1e-12;
/// Derivatives, likewise.
const DERIVATIVES: f64 = 1e-10;
/// Room for the error of the rule of degree 5 on warped quadrilaterals; on those of the file it is 1.5e-15.
const RULE_OF_DERIVATIVES: f64 = 1e-6;

/// A non-mortar facet of an interface: its nodes, and the facet with all mortar facets.
struct Part {
    nodes: Vec<usize>,
    patch: Patch,
}

/// Those that are covered.
fn parts(case: &Value) -> Vec<Part> {
    let list = |key: &str| -> Vec<Vec<usize>> {
        let facets = case[key].as_array().unwrap().iter();
        facets.map(|f| numbers(f).into_iter().map(|k| k as usize).collect()).collect()
    };
    let (x1, x2, facets2) = (points(&case["x1"]), points(&case["x2"]), list("facets2"));
    let part = |nodes: Vec<usize>| {
        let x1 = nodes.iter().map(|&a| x1[a]).collect();
        let scene = Scene { name: name(case).to_owned(), x1, x2: x2.clone(), facets2: facets2.clone() };
        Part { nodes, patch: scene.patch(&DEGREE_5) }
    };
    list("facets1").into_iter().map(part).filter(|p| DualBasis::of(&p.patch.sums).unwrap().is_some()).collect()
}

fn check(what: &str, name: &str, found: &[f64], expected: &[f64], bound: f64) {
    assert_eq!(found.len(), expected.len(), "{name}: {what}");
    let error = max_abs(found.iter().zip(expected).map(|(f, e)| f - e)) / max_abs(expected.iter().copied());
    println!("{name:30} {what:12} {error:.1e}");
    assert!(error <= bound, "{name}: {what} off by {error:e}");
}

#[test]
fn weights_gaps_and_forces() {
    for case in golden_part("golden_dual.json", "interfaces") {
        let (name, lambda) = (name(&case), points(&case["lambda"]));
        let (n1, n2) = (lambda.len(), points(&case["x2"]).len());
        let (mut diagonal, mut mortar) = (vec![0.0; n1], vec![0.0; n1 * n2]);
        let (mut gaps, mut forces) = (vec![Vec3::zeros(); n1], vec![Vec3::zeros(); n1 + n2]);
        for Part { nodes, patch } in parts(&case) {
            let basis = patch.basis();
            let (d, g, f) = (basis.diagonal(), patch.gaps(), patch.forces(&tractions(&nodes, &lambda)));
            for (k, &a) in nodes.iter().enumerate() {
                diagonal[a] += d[k];
                gaps[a] += g[k];
                forces[a] += f[k];
                for (c, n) in patch.columns().iter().enumerate() {
                    mortar[a * n2 + c] += basis.dual(n)[k];
                }
            }
            (0..n2).for_each(|c| forces[n1 + c] += f[nodes.len() + c]);
        }
        let flat = |v: &[Vec3]| v.iter().flat_map(|x| x.iter().copied()).collect::<Vec<_>>();
        check("phi m_A", name, &diagonal, &numbers(&case["D"]), VALUES);
        check("n^d_AC", name, &mortar, &table(&case["M"]).concat(), VALUES);
        check("gaps", name, &flat(&gaps), &table(&case["gap_vector"]).concat(), VALUES);
        let expected = &numbers(&case["residual_mult"])[..3 * (n1 + n2)];
        if max_abs(expected.iter().copied()) > 0.0 {
            check("forces", name, &flat(&forces), expected, VALUES);
        }
    }
}

/// `[i][A]` of a facet's nodes.
fn tractions(nodes: &[usize], lambda: &[Vec3]) -> [[f64; 4]; 3] {
    [0, 1, 2].map(|i| [0, 1, 2, 3].map(|k| nodes.get(k).map_or(0.0, |&a| lambda[a][i])))
}

#[test]
fn derivatives_of_forces_at_fixed_multipliers() {
    for case in golden_part("golden_dual.json", "interfaces") {
        let (name, lambda) = (name(&case), points(&case["lambda"]));
        let (n1, n2) = (lambda.len(), points(&case["x2"]).len());
        let n = 3 * (n1 + n2);
        let mut found = vec![0.0; n * n];
        for Part { nodes, patch } in parts(&case) {
            let place = |k: usize| nodes.get(k).copied().unwrap_or_else(|| n1 + k - nodes.len());
            for (column, forces) in patch.motion(&tractions(&nodes, &lambda)).forces.iter().enumerate() {
                let j = 3 * place(column / 3) + column % 3;
                for (k, f) in forces.iter().enumerate() {
                    (0..3).for_each(|i| found[(3 * place(k) + i) * n + j] += f[i]);
                }
            }
        }
        let tangent = if case["affine"] == true { &case["tangent_mult"] } else { &case["exactquad"]["tangent_mult"] };
        let [i, j, v] = ["i", "j", "v"].map(|part| numbers(&tangent[part]));
        let mut expected = vec![0.0; n * n];
        for ((i, j), v) in i.iter().zip(&j).zip(v).filter(|((i, j), _)| **i < n as f64 && **j < n as f64) {
            expected[*i as usize * n + *j as usize] += v;
        }
        if max_abs(expected.iter().copied()) > 0.0 {
            let bound = if case["affine"] == true { DERIVATIVES } else { RULE_OF_DERIVATIVES };
            check("derivatives", name, &found, &expected, bound);
        }
    }
}
