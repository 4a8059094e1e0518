//! Lines of plane and axisymmetric models through the C ABI (`src/capi/lines.rs`): golden pairs, the tangent of stages against
//! differences, what a node of such a model has for an answer, and what is refused.

use super::golden::{difference, flat};
use crate::support::*;
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use serde_json::Value;
use std::ffi::CStr;
use std::mem::{size_of, zeroed};
use std::ptr::{null, null_mut};
use stickslip::capi::*;

/// G3: relative to the largest entry.
const WEIGHTS: f64 = 1e-13;
const DERIVATIVES: f64 = 1e-12;
/// Central differences with this step of a line of length 1, relative to the largest entry of the row: rounding of numbers
/// of some tens, 1e-15 / 1e-6, and the step's square times a third derivative.
const STEP: f64 = 1e-6;
const DIFFERENCES: f64 = 1e-7;
/// Sums of some products.
const ROUNDING: f64 = 1e-14;

/// A pair of lines that owns its coordinates, two for each node.
#[derive(Clone, Debug)]
struct Lines {
    x1: Vec<f64>,
    x2: Vec<f64>,
    model: i32,
    thickness: f64,
    space: i32,
}

/// n_ab, n_ac, dn_ab, dn_ac.
type Weights = [Vec<f64>; 4];

impl Lines {
    fn of(case: &Value, space: i32) -> Lines {
        let model = match case["axisymmetric"] == true {
            true => STICKSLIP_MODEL_AXISYMMETRIC,
            false => STICKSLIP_MODEL_PLANE,
        };
        Lines { x1: flat(&case["x1"]), x2: flat(&case["x2"]), model, thickness: 0.0, space }
    }

    /// Multipliers, and nodes of both lines.
    fn counts(&self) -> (usize, usize, usize) {
        let (n1, n2) = (self.x1.len() / 2, self.x2.len() / 2);
        (if self.space == STICKSLIP_SPACE_CORNER { 2 } else { n1 }, n1, n2)
    }

    fn raw(&self) -> stickslip_pair {
        let (mut pair, (_, n1, n2)) = (sized!(stickslip_pair), self.counts());
        (pair.n1, pair.n2, pair.x1, pair.x2) = (n1 as i32, n2 as i32, self.x1.as_ptr(), self.x2.as_ptr());
        (pair.model, pair.thickness, pair.multiplier_space) = (self.model, self.thickness, self.space);
        pair
    }

    fn weights(&self) -> Weights {
        let (m, n1, n2) = self.counts();
        let d = 2 * (n1 + n2);
        let mut w = [m * n1, m * n2, m * n1 * d, m * n2 * d].map(|n| vec![f64::NAN; n]);
        let [a, b, c, d] = w.each_mut().map(|v| v.as_mut_ptr());
        ok!(stickslip_pair_weights(&self.raw(), a, b, c, d));
        w
    }

    fn gap(&self, w: &Weights) -> Vec<f64> {
        let mut gap = vec![f64::NAN; 2 * self.counts().0];
        ok!(stickslip_pair_gap(&self.raw(), w[0].as_ptr(), w[1].as_ptr(), gap.as_mut_ptr()));
        gap
    }
}

#[test]
fn golden_pairs_of_lines() {
    let (mut worst, mut apart) = ([0.0_f64; 2], 0);
    for case in golden_part("golden_quadratic.json", "lines") {
        for (key, space) in [("corner", STICKSLIP_SPACE_CORNER), ("sub", STICKSLIP_SPACE_SUB)] {
            let (of, w) = (&case[key], Lines::of(&case, space).weights());
            if of["overlap"] == false {
                assert!(w.iter().flatten().all(|v| *v == 0.0), "{} {key}", name(&case));
                apart += 1;
                continue;
            }
            let names = ["nAB", "nAC", "dnAB", "dnAC"];
            for (k, two) in [[0, 1], [2, 3]].into_iter().enumerate() {
                let (mut error, mut scale) = (0.0_f64, 0.0_f64);
                for at in two {
                    // Rows of nodes without a multiplier are not handed out.
                    let all = flat(&of[names[at]]);
                    let (given, rest) = all.split_at(w[at].len());
                    assert!(rest.iter().all(|v| *v == 0.0));
                    (error, scale) = (error.max(difference(&w[at], given)), scale.max(max_abs(all.iter().copied())));
                }
                worst[k] = worst[k].max(error / scale);
                assert!(error <= [WEIGHTS, DERIVATIVES][k] * scale, "{} {key}: {:e}", name(&case), error / scale);
            }
        }
    }
    assert!(apart > 0, "no case without an overlap");
    println!("G3 weights {:.1e}, derivatives {:.1e}", worst[0], worst[1]);
}

/// A pair with what its residual depends on besides its unknowns.
#[derive(Clone, Debug)]
struct Stage {
    lines: Lines,
    previous: Weights,
    lambda: Vec<f64>,
    normal: [f64; 3],
}

/// The law's data of every node.
const MU: f64 = 0.4;
const AUGMENTATION: f64 = 20.0;
const ROW_SCALE: f64 = 3.0;

fn node(lambda: &[f64], normal: [f64; 3], gaps: [&[f64]; 2]) -> stickslip_node {
    let mut node = sized!(stickslip_node);
    let third = |v: &[f64]| [v[0], v[1], 0.0];
    (node.lambda, node.normal, node.mu, node.augmentation) = (third(lambda), normal, MU, AUGMENTATION);
    (node.coverage, node.coverage_previous) = (1.0, 1.0);
    (node.gap_now, node.gap_previous) = (third(gaps[0]), third(gaps[1]));
    (node.n_directions, node.directions[2]) = (1, 1.0);
    node
}

fn respond(node: &stickslip_node) -> stickslip_node_response {
    let mut response = sized!(stickslip_node_response);
    ok!(stickslip_node_respond(node, &mut response));
    response
}

impl Stage {
    /// Unknowns: x1, x2, lambda.
    fn unknowns(&self) -> usize {
        self.lines.x1.len() + self.lines.x2.len() + self.lambda.len()
    }

    fn moved(&self, k: usize, h: f64) -> Stage {
        let mut s = self.clone();
        *s.lines.x1.iter_mut().chain(&mut s.lines.x2).chain(&mut s.lambda).nth(k).unwrap() += h;
        s
    }

    fn responses(&self, w: &Weights) -> Vec<stickslip_node_response> {
        let gaps = [self.lines.gap(w), self.lines.gap(&self.previous)];
        let of = |a: usize| respond(&node(&self.lambda[2 * a..], self.normal, [&gaps[0][2 * a..], &gaps[1][2 * a..]]));
        (0..self.lambda.len() / 2).map(of).collect()
    }

    /// Forces of the multiplier form, then rows; and the states.
    fn residual(&self) -> (Vec<f64>, Vec<i32>) {
        let w = self.lines.weights();
        let mut r = vec![f64::NAN; self.lines.x1.len() + self.lines.x2.len()];
        let [ab, ac] = [&w[0], &w[1]].map(|n| n.as_ptr());
        ok!(stickslip_pair_residual(&self.lines.raw(), ab, ac, self.lambda.as_ptr(), r.as_mut_ptr()));
        let responses = self.responses(&w);
        r.extend(responses.iter().flat_map(|of| [of.row[0], of.row[1]]).map(|row| row * ROW_SCALE));
        (r, responses.iter().map(|of| of.state).collect())
    }

    fn tangent(&self, layout: i32) -> Vec<f64> {
        let (w, n, m) = (self.lines.weights(), self.unknowns(), self.lambda.len() / 2);
        let (responses, scale) = (self.responses(&w), vec![ROW_SCALE; m]);
        let mut k = vec![f64::NAN; n * n];
        let [ab, ac, dab, dac] = w.each_ref().map(|n| n.as_ptr());
        let (before, pair) = (&self.previous, stickslip_pair { layout, ..self.lines.raw() });
        ok!(stickslip_pair_tangent(
            &pair,
            ab,
            ac,
            dab,
            dac,
            before[0].as_ptr(),
            before[1].as_ptr(),
            self.lambda.as_ptr(),
            responses.as_ptr(),
            scale.as_ptr(),
            k.as_mut_ptr(),
            n as i64
        ));
        for (a, response) in responses.iter().enumerate() {
            let (first, mut block) = (n - 2 * (m - a), [f64::NAN; 9]);
            ok!(stickslip_node_block(response, ROW_SCALE, layout, null_mut(), block.as_mut_ptr()));
            (0..4).for_each(|e| k[(first + e / 2) * n + first + e % 2] += block[3 * (e / 2) + e % 2]);
        }
        k
    }
}

/// A line along x and one below it, of either kind, with nodes off their places, away from the axis.
fn stages() -> impl Strategy<Value = Stage> {
    let jitter = prop::array::uniform12(-0.08..0.08_f64);
    let choices = (2..4_usize, 2..4_usize, any::<bool>(), any::<bool>(), prop::array::uniform2(-0.8..0.1_f64));
    (choices, jitter, -0.5..0.5_f64, -0.3..0.3_f64).prop_map(|((n1, n2, sub, axis, press), j, shift, lean)| {
        let at = |x: f64, y: f64, k: usize| [2.0 + x + j[2 * k], y + j[2 * k + 1]];
        let one = [at(0.0, 0.0, 0), at(1.0, 0.0, 1), at(0.5, 0.0, 2)];
        let two = [at(1.0 + shift, -0.05, 3), at(shift, -0.05, 4), at(0.5 + shift, -0.05, 5)];
        let lines = Lines {
            x1: one[..n1].concat(),
            x2: two[..n2].concat(),
            model: if axis { STICKSLIP_MODEL_AXISYMMETRIC } else { STICKSLIP_MODEL_PLANE },
            thickness: if axis { 0.0 } else { 0.7 },
            space: if sub { STICKSLIP_SPACE_SUB } else { STICKSLIP_SPACE_CORNER },
        };
        let slid =
            Lines { x2: lines.x2.iter().enumerate().map(|(k, x)| x + [0.02, 0.01][k % 2]).collect(), ..lines.clone() };
        let lambda =
            (0..2 * lines.counts().0).map(|k| if k % 2 == 0 { 0.1 * lean } else { press[k / 2 % 2] }).collect();
        let length = (1.0 + lean * lean).sqrt();
        Stage { previous: slid.weights(), lines, lambda, normal: [lean / length, 1.0 / length, 0.0] }
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    /// In every state, and in both layouts.
    #[test]
    fn the_tangent_is_that_of_differences(s in stages()) {
        let (n, k, (_, states)) = (s.unknowns(), s.tangent(STICKSLIP_LAYOUT_ROW_MAJOR), s.residual());
        let by_columns = s.tangent(STICKSLIP_LAYOUT_COLUMN_MAJOR);
        for column in 0..n {
            let [(plus, up), (less, down)] = [STEP, -STEP].map(|h| s.moved(column, h).residual());
            // A node that changes its state has two derivatives.
            prop_assume!(up == states && down == states);
            for row in 0..n {
                let (exact, found) = (k[row * n + column], (plus[row] - less[row]) / (2.0 * STEP));
                let scale = max_abs(k[row * n..][..n].iter().copied()).max(1.0);
                prop_assert!((exact - found).abs() <= DIFFERENCES * scale, "{row} {column}: {exact} {found} {states:?}");
                prop_assert_eq!(exact, by_columns[column * n + row]);
            }
        }
    }

    /// Forces balance; of an axisymmetric model those along the radius, too, for both sides have the same sums.
    #[test]
    fn forces_balance(s in stages()) {
        let (r, _) = s.residual();
        let forces = &r[..r.len() - s.lambda.len()];
        for i in 0..2 {
            let sum: f64 = forces.iter().skip(i).step_by(2).sum();
            prop_assert!(sum.abs() <= 100.0 * ROUNDING, "{i}: {sum:e}");
        }
    }

    /// The third component of a node of such a model stays apart, whether its direction is prescribed or not.
    #[test]
    fn a_node_of_two_dimensions_has_an_answer_of_two(s in stages()) {
        let w = s.lines.weights();
        let gaps = [s.lines.gap(&w), s.lines.gap(&s.previous)];
        for a in 0..s.lambda.len() / 2 {
            let free = node(&s.lambda[2 * a..], s.normal, [&gaps[0][2 * a..], &gaps[1][2 * a..]]);
            let [of, other] = [free, stickslip_node { n_directions: 0, ..free }].map(|node| respond(&node));
            for (v, u) in [(of.traction, other.traction), (of.row, other.row), (of.slip, other.slip)] {
                prop_assert_eq!(v[2], 0.0);
                prop_assert!(difference(&v, &u) <= ROUNDING);
            }
            for m in [of.dp_dlambda, of.drow_dlambda, of.drow_dnow, of.drow_dprevious] {
                prop_assert!([m[2], m[5], m[6], m[7]].iter().all(|v| *v == 0.0), "{m:?}");
            }
            for (m, k) in [(of.drow_dnow, other.drow_dnow), (of.drow_dprevious, other.drow_dprevious)] {
                prop_assert!([0, 1, 3, 4].iter().all(|&e| (m[e] - k[e]).abs() <= 10.0 * ROUNDING * max_abs(k)), "{m:?} {k:?}");
            }
        }
    }
}

/// The stages meet all three states, or the tests above would show less than they say.
#[test]
fn all_states_occur() {
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let mut seen = [0; 3];
    for _ in 0..100 {
        let s = stages().new_tree(&mut runner).unwrap().current();
        s.residual().1.iter().for_each(|&state| seen[state as usize] += 1);
    }
    assert!(seen.iter().all(|&n| n > 10), "{seen:?}");
}

/// Two line2 of an axisymmetric model.
fn two_linear() -> Lines {
    let cases = golden_part("golden_quadratic.json", "lines");
    Lines::of(cases.iter().find(|case| name(case) == "L02_line2_line2_axi").unwrap(), STICKSLIP_SPACE_CORNER)
}

#[test]
fn thickness_scales_and_is_one_by_default() {
    let of = |thickness: f64| Lines { thickness, model: STICKSLIP_MODEL_PLANE, ..two_linear() }.weights();
    let (default, one, two) = (of(0.0), of(1.0), of(2.0));
    assert_eq!(default, one);
    assert_eq!(two, default.map(|w| w.iter().map(|v| 2.0 * v).collect::<Vec<_>>()));
}

/// A facet over itself: the areas of a ring are those of its truncated cone; a node on the axis has a positive one.
#[test]
fn a_line_over_itself_has_its_areas() {
    let (x, pi) = ([0.0, 0.2, 3.0, 4.2], std::f64::consts::PI); // r from 0 to 3, 5 long
    let line = Lines { x1: x.to_vec(), x2: x.to_vec(), model: STICKSLIP_MODEL_AXISYMMETRIC, thickness: 0.0, space: 0 };
    let w = line.weights();
    // int 2 pi r L_A ds, r = 3 L_b: 2 pi 5 (3 / 6) and 2 pi 5 (3 / 3).
    for (row, area) in w[0].chunks_exact(2).zip([5.0 * pi, 10.0 * pi]) {
        assert!((row.iter().sum::<f64>() - area).abs() <= 10.0 * ROUNDING * area, "{row:?} {area}");
    }
}

#[test]
fn what_lines_do_not_take_is_refused_by_name() {
    let lines = two_linear();
    let check = |change: &dyn Fn(&mut stickslip_pair), status: i32, said: &str| {
        let (mut raw, mut n) = (lines.raw(), [0.0; 81]);
        change(&mut raw);
        // SAFETY: `n` has room for the weights of any pair; the message is never NULL and zero-terminated.
        let (found, message) = unsafe {
            let status = stickslip_pair_weights(&raw, n.as_mut_ptr(), null_mut(), null_mut(), null_mut());
            (status, CStr::from_ptr(stickslip_last_error_message()).to_string_lossy().into_owned())
        };
        assert!(found == status && message.contains(said), "{found}: {message}");
    };
    let x = |k: usize, v: f64| {
        let mut x = lines.x1.clone();
        x[k] = v;
        x
    };
    let below = x(2, -0.25);
    check(&|p| p.n1 = 4, STICKSLIP_INVALID_SIZE, "pair.x1 has 4 nodes; 2 (line2) or 3 (line3) are allowed");
    check(&|p| p.model = 3, STICKSLIP_INVALID_VALUE, "pair.model is 3; the header names 0 to 2");
    check(&|p| p.thickness = 2.0, STICKSLIP_INVALID_VALUE, "pair.thickness is 2; it is of plane models");
    check(&|p| p.element_points = 4, STICKSLIP_UNSUPPORTED, "pair.element_points and pair.neighbour_normals");
    check(&|p| p.neighbour_normals = p.x1, STICKSLIP_UNSUPPORTED, "pair.element_points and pair.neighbour_normals");
    check(&|p| p.multiplier_space = 2, STICKSLIP_INVALID_VALUE, "pair.multiplier_space is 2");
    check(
        &|p| p.x1 = below.as_ptr(),
        STICKSLIP_INVALID_VALUE,
        "pair.x1: node 1 has r = -0.25; no node lies beyond the axis",
    );
    check(
        &|p| p.x2 = below.as_ptr(),
        STICKSLIP_INVALID_VALUE,
        "pair.x2: node 1 has r = -0.25; no node lies beyond the axis",
    );
    let same = [1.0, 0.5, 1.0, 0.5];
    check(&|p| p.x2 = same.as_ptr(), STICKSLIP_DUPLICATE_NODE, "pair.x2 has two nodes at the same place (node 1)");
    check(&|p| p.x1 = null(), STICKSLIP_NULL_POINTER, "pair.x1");
    // x beyond 0 means nothing in a plane model, and a caller from before the thickness had a thickness of 1.
    let plane = Lines { model: STICKSLIP_MODEL_PLANE, ..lines.clone() };
    let (mut raw, mut n) = (plane.raw(), [f64::NAN; 4]);
    (raw.x1, raw.struct_size, raw.thickness) = (below.as_ptr(), 64, f64::NAN);
    ok!(stickslip_pair_weights(&raw, n.as_mut_ptr(), null_mut(), null_mut(), null_mut()));
    // Functions that take pairs of solids alone.
    let (raw, mut state) = (lines.raw(), vec![0.0; stickslip_pair_state_size() as usize]);
    // SAFETY: `state` is as long as the library says.
    let status = unsafe {
        let none = null_mut();
        stickslip_pair_begin(&raw, state.len() as i64, state.as_mut_ptr(), none, none, none)
    };
    assert_eq!(status, STICKSLIP_UNSUPPORTED);
}
