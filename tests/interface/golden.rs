//! The assembled interface against the golden interfaces (rows S1, S2, K1, K6 of the hard tests).

use crate::support::*;
use serde_json::Value;
use stickslip::geometry::Vec3;
use stickslip::interface::Form;
use stickslip::interface::{Interface, NewContact, Options, RowScale, Stiffness, Surface};
use stickslip::law::{SlipMeasure, State};
use stickslip::quadrature::{DEGREE_5, DEGREE_10, Rule};

/// S1: residual blocks, relative to the largest entry of the block.
const RESIDUAL: f64 = 1e-12;
/// K1: tangent blocks of affine interfaces.
const TANGENT: f64 = 1e-10;
/// K6: tangents of matching, nested, noisy and near-matching meshes.
const TANGENT_NEAR_MATCHING: f64 = 1e-9;
/// Non-affine facets with the degree-5 rule: its own quadrature error on the mildly warped cases.
const RULE_RESIDUAL: f64 = 1e-5;
const RULE_TANGENT: f64 = 1e-4;
/// The same with the degree-10 rule (measured 1e-15 on the mildest case).
const RULE_RESIDUAL_DEGREE_10: f64 = 1e-8;
/// A block smaller than this part of the matrix is rounding of a block that vanishes.
const VANISHING: f64 = 1e-8;

pub struct Golden {
    pub interface: Interface,
    pub x1: Vec<Vec3>,
    pub x2: Vec<Vec3>,
    pub lambda: Vec<Vec3>,
}

/// An interface with equations numbered x1, x2, lambda and every golden input set.
pub fn set_up(case: &Value, form: Form, rule: &'static Rule) -> Golden {
    set_up_with(case, Options { form, rule, ..Options::paper(Stiffness::Augmentation(1.0)) })
}

/// The same with more options than form and rule.
pub fn set_up_with(case: &Value, mut options: Options) -> Golden {
    let (x1, x2) = (points(&case["x1"]), points(&case["x2"]));
    let (n1, n2) = (x1.len() as i64, x2.len() as i64);
    let equations = |first: i64, n: i64| (0..n).map(|k| [0, 1, 2].map(|i| first + 3 * k + i)).collect::<Vec<_>>();
    let facets = |v: &Value| {
        let rows = v.as_array().unwrap().iter();
        rows.map(|f| f.as_array().unwrap().iter().map(|k| k.as_i64().unwrap()).collect()).collect::<Vec<Vec<i64>>>()
    };
    let one = Surface::new("nonmortar", points(&case["x1_prev"]), &facets(&case["facets1"]), equations(0, n1)).unwrap();
    let two =
        Surface::new("mortar", points(&case["x2_prev"]), &facets(&case["facets2"]), equations(3 * n1, n2)).unwrap();
    options.row_scale = RowScale::None;
    options.new_contact = NewContact::KeepFriction;
    options.slip = match case["variant"].as_str().unwrap() {
        "seed" => SlipMeasure::Paper,
        "increment" => SlipMeasure::Increment,
        _ => SlipMeasure::Objective,
    };
    let mut interface = Interface::new(one, two, equations(3 * (n1 + n2), n1), options).unwrap();
    let per_node = |v: &Value| if v.is_array() { numbers(v) } else { vec![v.as_f64().unwrap(); n1 as usize] };
    interface.set_friction(per_node(&case["mu"])).unwrap();
    interface.set_augmentation(Some(per_node(&case["r"]))).unwrap();
    if !options.follows_normals() {
        interface.set_normals(Some(points(&case["nu"]))).unwrap();
    }
    Golden { interface, x1, x2, lambda: points(&case["lambda"]) }
}

/// Worst error over the blocks (f1, f2, c), each relative to its largest entry.
pub fn residual_error(g: &mut Golden, expected: &[f64]) -> f64 {
    let r = g.interface.residual(&g.x1, &g.x2, &g.lambda, None).unwrap();
    let blocks = [r.nonmortar, r.mortar, r.rows].map(|b| b.iter().flat_map(|v| v.iter().copied()).collect::<Vec<_>>());
    let mut first = 0;
    let mut worst = 0.0_f64;
    for block in blocks {
        let e = &expected[first..first + block.len()];
        first += block.len();
        let scale = max_abs(e.iter().copied());
        let error = max_abs(block.iter().zip(e).map(|(a, b)| a - b));
        worst = worst.max(if scale > 0.0 { error / scale } else { error });
    }
    assert_eq!(first, expected.len());
    worst
}

pub fn dense_tangent(g: &mut Golden) -> (usize, Vec<f64>) {
    let n = 3 * (2 * g.x1.len() + g.x2.len());
    let mut k = vec![0.0; n * n];
    let mut add = |i: i64, j: i64, v: f64| k[i as usize * n + j as usize] += v;
    g.interface.tangent(&g.x1, &g.x2, &g.lambda, None, &mut add).unwrap();
    (n, k)
}

pub fn expected_tangent(coo: &Value, n: usize) -> Vec<f64> {
    let mut k = vec![0.0; n * n];
    let (i, j, v) = (numbers(&coo["i"]), numbers(&coo["j"]), numbers(&coo["v"]));
    for t in 0..v.len() {
        k[i[t] as usize * n + j[t] as usize] += v[t];
    }
    k
}

/// Worst error over the 3 x 3 blocks (f1, f2, c) x (x1, x2, lambda), relative to the block's largest, or to the part
/// `vanishing` of the matrix's largest where that is more.
pub fn tangent_error(n1: usize, n: usize, k: &[f64], expected: &[f64], vanishing: f64) -> f64 {
    let ends = [0, 3 * n1, n - 3 * n1, n];
    let mut worst = 0.0_f64;
    let least = vanishing * max_abs(expected.iter().copied());
    for rows in ends.windows(2) {
        for columns in ends.windows(2) {
            let (mut error, mut scale) = (0.0_f64, 0.0_f64);
            for i in rows[0]..rows[1] {
                for j in columns[0]..columns[1] {
                    error = error.max((k[i * n + j] - expected[i * n + j]).abs());
                    scale = scale.max(expected[i * n + j].abs());
                }
            }
            let scale = scale.max(least);
            worst = worst.max(if scale > 0.0 { error / scale } else { error });
        }
    }
    worst
}

#[test]
fn golden_states_and_residuals() {
    for case in golden("golden_interfaces.json") {
        let mut g = set_up(&case, Form::Augmented, &DEGREE_5);
        let responses = g.interface.responses(&g.x1, &g.x2, &g.lambda, None).unwrap();
        for (a, (response, state)) in responses.iter().zip(numbers(&case["state"])).enumerate() {
            let either = name(&case).starts_with("I06b") && response.state != State::Gap;
            assert!(response.state as i32 == state as i32 || either, "{}: state of node {a}", name(&case));
        }
        let error = residual_error(&mut g, &numbers(&case["residual"]));
        println!("{:32} residual {error:.1e}", name(&case));
        assert!(error <= RESIDUAL, "{}: residual off by {error:e}", name(&case));
        if case["affine"] == false {
            for (rule, bound) in [(&DEGREE_5, RULE_RESIDUAL), (&DEGREE_10, RULE_RESIDUAL_DEGREE_10)] {
                let error =
                    residual_error(&mut set_up(&case, Form::Augmented, rule), &numbers(&case["residual_exactquad"]));
                println!("{:32} exact residual, degree {}: {error:.1e}", name(&case), rule.degree);
                assert!(error <= bound, "{}: exact residual off by {error:e}", name(&case));
            }
        }
    }
}

#[test]
fn golden_tangents() {
    for case in golden("golden_interfaces.json") {
        if case["smooth"] == false {
            continue; // a kink: no tangent is tabulated
        }
        let mut g = set_up(&case, Form::Augmented, &DEGREE_5);
        let (n, k) = dense_tangent(&mut g);
        let (key, bound) = match case["affine"].as_bool().unwrap() {
            true if name(&case) < "I28" => ("tangent", TANGENT),
            true => ("tangent", TANGENT_NEAR_MATCHING),
            false => ("tangent_exactquad", RULE_TANGENT),
        };
        let error = tangent_error(g.x1.len(), n, &k, &expected_tangent(&case[key], n), VANISHING);
        println!("{:32} tangent {error:.1e}", name(&case));
        assert!(error <= bound, "{}: tangent off by {error:e}", name(&case));
    }
}

#[test]
fn golden_gaps_coverage_and_weights() {
    for case in golden("golden_interfaces.json") {
        let mut g = set_up(&case, Form::Multiplier, &DEGREE_5);
        let sums = g.interface.sums(&g.x1, &g.x2).unwrap();
        let (cover, gap) = (numbers(&case["cover"]), points(&case["gap_vector"]));
        let scale = max_abs(cover.iter().copied());
        let reach = g.x1.iter().map(|x| (x - g.x1[0]).norm()).fold(0.0, f64::max);
        for a in 0..sums.len() {
            assert!((sums[a].coverage - cover[a]).abs() <= 1e-12 * scale, "{}: coverage", name(&case));
            assert!((sums[a].gap_now - gap[a]).amax() <= 1e-12 * scale * reach, "{}: gap", name(&case));
        }
    }
}
