//! Weights of pairs of lines and their derivatives against the golden ones (`src/line/weights.rs`, `derivatives.rs`).

use crate::support::*;
use serde_json::Value;
use stickslip::geometry::Vec2;
use stickslip::line::{LineDerivatives, LineFacet, LineWeights, MAX_LINE_NODES, Measure};
use stickslip::mortar::MultiplierSpace;

/// G3: relative to the largest entry.
const WEIGHTS: f64 = 1e-13;
const DERIVATIVES: f64 = 1e-12;

pub fn line(v: &Value) -> LineFacet {
    let nodes: Vec<_> = table(v).iter().map(|p| Vec2::new(p[0], p[1])).collect();
    LineFacet::new(&nodes).unwrap()
}

/// The largest difference over the largest entry; `found(A, B, column)` with the golden file's columns.
fn error(expected: &Value, found: impl Fn(usize, usize, usize) -> f64) -> f64 {
    let (mut worst, mut size) = (0.0_f64, 0.0_f64);
    for (a, row) in expected.as_array().unwrap().iter().enumerate() {
        for (b, entry) in row.as_array().unwrap().iter().enumerate() {
            let of = if entry.is_array() { numbers(entry) } else { vec![entry.as_f64().unwrap()] };
            for (k, v) in of.into_iter().enumerate() {
                (worst, size) = (worst.max((found(a, b, k) - v).abs()), size.max(v.abs()));
            }
        }
    }
    worst / size
}

#[test]
fn weights_and_derivatives_of_lines_are_the_golden_ones() {
    let mut apart = 0;
    for case in golden_part("golden_quadratic.json", "lines") {
        let (one, two) = (line(&case["x1"]), line(&case["x2"]));
        let measure = if case["axisymmetric"] == true { Measure::Axisymmetric } else { Measure::Thickness(1.0) };
        // The file has no places for nodes that a line has not.
        let slot = |k: usize| if k / 2 < one.n { k } else { k + 2 * (MAX_LINE_NODES - one.n) };
        for (name, space) in [("corner", MultiplierSpace::Corner), ("sub", MultiplierSpace::Sub)] {
            let (of, name) = (&case[name], format!("{} {name}", name_of(&case)));
            let weights = LineWeights::new(&one, &two, space, measure);
            let d = LineDerivatives::new(&one, &two, space, measure);
            if of["overlap"] == false {
                assert_eq!(weights, LineWeights::default(), "{name}");
                assert!(d.ab.as_flattened().as_flattened().iter().all(|&v| v == 0.0), "{name}");
                apart += 1;
                continue;
            }
            let errors = [
                error(&of["nAB"], |a, b, _| weights.ab[a][b]) / WEIGHTS,
                error(&of["nAC"], |a, b, _| weights.ac[a][b]) / WEIGHTS,
                error(&of["dnAB"], |a, b, k| d.ab[a][b][slot(k)]) / DERIVATIVES,
                error(&of["dnAC"], |a, b, k| d.ac[a][b][slot(k)]) / DERIVATIVES,
            ];
            println!("{name}: {errors:?} of what is allowed");
            assert!(errors.iter().all(|&e| e <= 1.0), "{name}: {errors:?}");
        }
    }
    assert!(apart > 0, "no case without an overlap");
}

fn name_of(case: &Value) -> &str {
    name(case)
}
