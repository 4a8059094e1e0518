//! Quadratic facets (`src/mortar/sub_pair.rs`, `parent_pair.rs`) against the golden pairs of `golden_quadratic.json`, and the
//! identities that hold at any rule.

use crate::support::random::*;
use crate::support::*;
use nalgebra::{Rotation3, Vector3};
use proptest::prelude::*;
use serde_json::Value;
use stickslip::error::Kind;
use stickslip::geometry::Vec3;
use stickslip::mortar::{
    MultiplierSpace, NonmortarFrame, PairWeights, ParentDerivatives, ParentFacet, ParentWeights, Segment,
    WeightDerivatives, parent_weights,
};
use stickslip::quadrature::{DEGREE_5, DEGREE_10, Rule};

/// G1: weights of affine sub-facets, relative to the largest.
const WEIGHTS: f64 = 1e-13;
/// G1: derivatives of the same.
const DERIVATIVES: f64 = 1e-10;
/// G2: the error of the rule on curved facets (7 points: 2e-6 and 1e-7 there), and of the degree-10 rule.
const RULE_ERROR: [f64; 2] = [5e-6, 1e-9];
/// The same of derivatives; the reference's own error is 2e-12.
const DERIVATIVE_RULE_ERROR: [f64; 2] = [1e-4, 1e-7];

const SPACES: [(&str, MultiplierSpace); 2] = [("corner", MultiplierSpace::Corner), ("sub", MultiplierSpace::Sub)];

fn parent(v: &Value) -> ParentFacet {
    ParentFacet::new(&points(v)).unwrap()
}

fn weights(one: &ParentFacet, two: &ParentFacet, space: MultiplierSpace, rule: &'static Rule) -> ParentWeights {
    parent_weights((one, two), space, rule, None).unwrap()
}

fn with_derivatives(
    one: &ParentFacet,
    two: &ParentFacet,
    space: MultiplierSpace,
    rule: &'static Rule,
) -> (ParentWeights, Box<ParentDerivatives>) {
    let mut d = Box::new(ParentDerivatives::ZERO);
    (parent_weights((one, two), space, rule, Some(&mut d)).unwrap(), d)
}

/// The largest difference from golden weights, relative to the largest of them.
fn weight_error(w: &ParentWeights, ab: &Value, ac: &Value) -> f64 {
    let (ab, ac) = (table(ab), table(ac));
    let largest = max_abs(ab.iter().chain(&ac).flatten().copied());
    let row = |of: &[[f64; 9]; 9], golden: &[Vec<f64>]| {
        max_abs(golden.iter().enumerate().flat_map(|(a, row)| row.iter().enumerate().map(move |(b, v)| of[a][b] - v)))
    };
    row(&w.ab, &ab).max(row(&w.ac, &ac)) / largest
}

#[test]
fn golden_weights() {
    let mut compared = 0;
    for case in golden_part("golden_quadratic.json", "pairs") {
        let (one, two) = (parent(&case["x1"]), parent(&case["x2"]));
        for (key, space) in SPACES {
            let expected = &case[key];
            let found = weights(&one, &two, space, &DEGREE_5);
            if expected["overlap"] == false {
                assert!(found.area == 0.0 && max_abs(found.ab.into_iter().flatten()) == 0.0, "{}", name(&case));
                continue;
            }
            let area = expected["area"].as_f64().unwrap();
            assert!((found.area - area).abs() < WEIGHTS * area, "{}: area {} for {area}", name(&case), found.area);
            let error = weight_error(&found, &expected["nAB"], &expected["nAC"]);
            let fine = weight_error(&weights(&one, &two, space, &DEGREE_10), &expected["nAB"], &expected["nAC"]);
            println!("{} {key}: {error:.1e}, degree 10 {fine:.1e}", name(&case));
            let [bound, fine_bound] = if case["affine"] == true { [WEIGHTS; 2] } else { RULE_ERROR };
            assert!(error < bound && fine < fine_bound, "{} {key}: {error:.1e}, {fine:.1e}", name(&case));
            compared += 1;
        }
    }
    assert!(compared >= 6);
}

#[test]
fn golden_derivatives() {
    let mut compared = 0;
    for case in golden_part("golden_quadratic.json", "pairs") {
        let (one, two) = (parent(&case["x1"]), parent(&case["x2"]));
        let (n1, n) = (one.parent.n, one.parent.n + two.parent.n);
        for (key, space) in SPACES {
            let expected = &case[key];
            if expected["dnAB"].is_null() {
                continue;
            }
            for (rule, which) in [(&DEGREE_5, 0), (&DEGREE_10, 1)] {
                let (found, d) = with_derivatives(&one, &two, space, rule);
                assert_eq!(found, weights(&one, &two, space, rule), "{}", name(&case));
                let (mut error, mut largest) = (0.0_f64, 0.0_f64);
                for (of, golden) in [(&d.ab, &expected["dnAB"]), (&d.ac, &expected["dnAC"])] {
                    for (a, row) in golden.as_array().unwrap().iter().enumerate() {
                        for (b, entry) in table(row).iter().enumerate() {
                            assert_eq!(entry.len(), 3 * n);
                            for (k, v) in entry.iter().enumerate() {
                                let slot = if k / 3 < n1 { k / 3 } else { 9 + k / 3 - n1 };
                                error = error.max((of[a][b][slot][k % 3] - v).abs());
                                largest = largest.max(v.abs());
                            }
                        }
                    }
                }
                println!("{} {key}, degree {}: {:.1e}", name(&case), rule.degree, error / largest);
                let bound = if case["affine"] == true { DERIVATIVES } else { DERIVATIVE_RULE_ERROR[which] };
                assert!(error < bound * largest, "{} {key}: {:.1e}", name(&case), error / largest);
                compared += 1;
            }
        }
    }
    assert!(compared >= 4);
}

/// A linear facet is its own sub-facet: the weights and derivatives of the linear kernel, to the rounding of their sums.
#[test]
fn linear_facets_are_their_own_parents() {
    for case in golden_part("golden_pairs.json", "cases") {
        let (x1, x2) = (points(&case["x1"]), points(&case["x2"]));
        let (one, two) = (facet(&case["x1"]), facet(&case["x2"]));
        let frame = NonmortarFrame::new(&one).unwrap();
        let Some(segment) = Segment::new(&frame, &two).unwrap() else { continue };
        let expected = PairWeights::integrate(&frame, &segment, &DEGREE_5);
        let derivatives = WeightDerivatives::integrate(&frame, &segment, &DEGREE_5).1;
        let (p1, p2) = (ParentFacet::new(&x1).unwrap(), ParentFacet::new(&x2).unwrap());
        let scale = max_abs(derivatives.ab.iter().chain(&derivatives.ac).flatten().flatten().flatten().copied());
        let size = max_abs(x1.iter().flat_map(|x| (x - x1[0]).iter().copied().collect::<Vec<_>>()));
        for (_, space) in SPACES {
            let (found, d) = with_derivatives(&p1, &p2, space, &DEGREE_5);
            for (a, b) in (0..4).flat_map(|a| (0..4).map(move |b| (a, b))) {
                let pairs = [(found.ab[a][b], expected.ab[a][b]), (found.ac[a][b], expected.ac[a][b])];
                assert!(pairs.iter().all(|(v, w)| (v - w).abs() < WEIGHTS * size * size), "{}", name(&case));
                for (k, j) in (0..8).flat_map(|k| (0..3).map(move |j| (k, j))) {
                    let slot = if k < 4 { k } else { 9 + k - 4 };
                    let pairs = [
                        (d.ab[a][b][slot][j], derivatives.ab[a][b][k][j]),
                        (d.ac[a][b][slot][j], derivatives.ac[a][b][k][j]),
                    ];
                    let same = pairs.iter().all(|(v, w)| (v - w).abs() < DERIVATIVES * (scale + size));
                    assert!(same, "{} {pairs:?}", name(&case));
                }
            }
        }
    }
}
