//! The golden interfaces cut into parts: handles that each own some of the nodes add up to the golden residuals and tangents of
//! the whole (docs/host_parallel.md, "Parts that own nodes").

use super::dual::{self, dual};
use super::golden::*;
use crate::support::*;
use serde_json::Value;
use stickslip::interface::{Form, Options, Owner, Stiffness};
use stickslip::quadrature::DEGREE_5;

/// Sums of the same numbers in another order, over the largest of their kind.
const ROUNDING: f64 = 1e-13;

/// Residual (f1, f2, rows), tangent, and the states of the nodes that are its own.
struct Share {
    residual: Vec<f64>,
    tangent: Vec<f64>,
    states: Vec<Option<i32>>,
}

/// What the handle that owns the nodes a with owner(a) has of the whole.
fn share(case: &Value, options: Options, owner: impl Fn(usize) -> bool) -> Share {
    let mut g = set_up_with(case, options);
    let owners = (0..g.x1.len()).map(|a| if owner(a) { Owner::Here } else { Owner::Elsewhere });
    g.interface.set_owners(owners.collect()).unwrap();
    let r = g.interface.residual(&g.x1, &g.x2, &g.lambda, None).unwrap();
    let residual = [r.nonmortar, r.mortar, r.rows].into_iter().flatten().flat_map(|v| [v.x, v.y, v.z]).collect();
    let responses = g.interface.responses(&g.x1, &g.x2, &g.lambda, None).unwrap();
    let states = responses.iter().enumerate().map(|(a, r)| owner(a).then_some(r.state as i32)).collect();
    Share { residual, tangent: dense_tangent(&mut g).1, states }
}

/// By how much the sum over the parts differs from the whole, over the whole's largest.
fn error_of_sum(parts: &[Share], whole: &[f64], of: impl Fn(&Share) -> &[f64]) -> f64 {
    let sum = |i: usize| parts.iter().map(|part| of(part)[i]).sum::<f64>();
    max_abs((0..whole.len()).map(|i| sum(i) - whole[i])) / max_abs(whole.iter().copied()).max(f64::MIN_POSITIVE)
}

/// Cuts an interface into as many parts as there are nodes, and into every other node and the rest.
fn cut(case: &Value, options: Options, key: &str) {
    let whole = share(case, options, |_| true);
    let golden = residual_error(&mut set_up_with(case, options), &numbers(&case[key]));
    assert!(golden <= dual::RESIDUAL, "{}: {key} off by {golden:e}", name(case));
    let nodes = whole.states.len();
    for count in [2, nodes] {
        let parts: Vec<_> = (0..count).map(|p| share(case, options, |a| a % count == p)).collect();
        let residual = error_of_sum(&parts, &whole.residual, |share| &share.residual);
        let tangent = error_of_sum(&parts, &whole.tangent, |share| &share.tangent);
        println!("{:32} {key} in {count} parts: {residual:.1e}, {tangent:.1e}", name(case));
        assert!(residual <= ROUNDING && tangent <= ROUNDING, "{} {count}: {residual:e} {tangent:e}", name(case));
        for a in 0..nodes {
            assert_eq!(parts[a % count].states[a], whole.states[a], "{}: state of node {a}", name(case));
        }
    }
}

#[test]
fn golden_dual_interfaces_add_up() {
    for case in dual::cases() {
        for (form, key) in [(Form::Multiplier, "residual_mult"), (Form::Augmented, "residual")] {
            cut(&case, dual(Options { form, ..Options::paper(Stiffness::Augmentation(1.0)) }), key);
        }
    }
}

#[test]
fn golden_interfaces_add_up() {
    for case in golden("golden_interfaces.json") {
        let form = Form::Augmented;
        cut(&case, Options { form, rule: &DEGREE_5, ..Options::paper(Stiffness::Augmentation(1.0)) }, "residual");
    }
}
