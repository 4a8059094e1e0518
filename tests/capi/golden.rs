//! The golden vectors once more, through the C ABI: stateless stages and the interface handle, by raw
//! pointers as a C host gives them. Rows W1, W2, W7, W8, S1, S2, K1 and K6 of the hard tests.

use crate::support::*;
use serde_json::Value;
use std::ffi::CStr;
use std::mem::{size_of, zeroed};
use std::ptr::{null, null_mut};
use stickslip::capi::*;

/// W1: relative part, a few hundred roundings of the sums.
const WEIGHTS_RELATIVE: f64 = 1e-13;
/// W1: absolute part, times the squared facet size: rounding of the projected coordinates.
const WEIGHTS_ABSOLUTE: f64 = 4e-15;
/// W2: the degree-5 rule on warped or distorted quads; the flat kite is the worst.
const RULE_ERROR_DEGREE_5: f64 = 2e-5;
/// The degree-10 rule on the same.
const RULE_ERROR_DEGREE_10: f64 = 1e-8;
/// W7: translation, rotation and Euler's identity, relative to sum |dn| |x|.
const IDENTITIES: f64 = 1e-12;
/// W8: derivatives of affine pairs, relative to the largest one.
const DERIVATIVES: f64 = 1e-12;
/// W8: near-parallel crossings amplify the rounding of the inputs' differences.
const DERIVATIVES_AT_SMALL_ANGLE: f64 = 1e-10;
/// The 7-point rule's derivative on warped quads; the kite is the worst.
const DERIVATIVES_OF_RULE: f64 = 1e-4;
/// S1: residual blocks, relative to the largest entry of the block.
const RESIDUAL: f64 = 1e-12;
/// K1: tangent blocks of affine interfaces.
const TANGENT: f64 = 1e-10;
/// K6: tangents of matching, nested, noisy and near-matching meshes.
const TANGENT_NEAR_MATCHING: f64 = 1e-9;
/// Non-affine interfaces against the exact integral: the rules' own errors, mildly warped.
const RULE_RESIDUAL: f64 = 1e-5;
const RULE_RESIDUAL_DEGREE_10: f64 = 1e-8;
const RULE_TANGENT: f64 = 1e-4;
/// A block smaller than this part of the matrix is rounding of a block that vanishes.
const VANISHING: f64 = 1e-8;
/// The tangent assembled from stages against the handle's: the same sums in another order. Stages take forces from
/// finished derivatives of the weights, the handle before they go to the nodes.
const SAME_SUMS: f64 = 1e-13;
/// A block smaller than this part of the matrix is what pairs' entries of that size leave when they cancel.
const CANCELLING: f64 = 1e-2;

/// Calls an ABI function and asserts success, with the library's message.
macro_rules! ok {
    ($($call:tt)*) => {{
        // SAFETY: all pointers given in this file come from vectors of the documented lengths.
        let status = unsafe { $($call)* };
        // SAFETY: the message is never NULL and zero-terminated.
        let message = unsafe { CStr::from_ptr(stickslip_last_error_message()) };
        assert_eq!(status, STICKSLIP_OK, "{}: {}", stringify!($($call)*), message.to_string_lossy());
    }};
}

/// An ABI struct of zeros with its size set.
macro_rules! sized {
    ($t:ty) => {{
        // SAFETY: the ABI's structs are numbers and pointers; zero is valid for all of them.
        let mut value: $t = unsafe { zeroed() };
        value.struct_size = size_of::<$t>() as u64;
        value
    }};
}

/// Numbers of nested arrays, flat.
pub(super) fn flat(v: &Value) -> Vec<f64> {
    match v.as_array() {
        Some(items) => items.iter().flat_map(flat).collect(),
        None => vec![v.as_f64().unwrap()],
    }
}

pub(super) fn difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    max_abs(a.iter().zip(b).map(|(a, b)| a - b))
}

pub(super) fn relative(error: f64, scale: f64) -> f64 {
    if scale > 0.0 { error / scale } else { error }
}

/// A pair of facets that owns its coordinates.
pub(super) struct Pair {
    pub x1: Vec<f64>,
    pub x2: Vec<f64>,
    pub quadrature: i32,
    pub space: i32,
}

/// Weights of a pair and their derivatives.
pub(super) struct Weights {
    pub ab: Vec<f64>,
    pub ac: Vec<f64>,
    pub dab: Vec<f64>,
    pub dac: Vec<f64>,
}

impl Pair {
    pub fn of(case: &Value, quadrature: i32) -> Pair {
        Pair { x1: flat(&case["x1"]), x2: flat(&case["x2"]), quadrature, space: STICKSLIP_SPACE_CORNER }
    }

    /// Multipliers.
    pub fn m(&self) -> usize {
        match self.n().0 {
            6 if self.space == STICKSLIP_SPACE_CORNER => 3,
            8 | 9 if self.space == STICKSLIP_SPACE_CORNER => 4,
            n => n,
        }
    }

    pub fn n(&self) -> (usize, usize) {
        (self.x1.len() / 3, self.x2.len() / 3)
    }

    pub fn raw(&self) -> stickslip_pair {
        let mut pair = sized!(stickslip_pair);
        (pair.n1, pair.n2) = (self.n().0 as i32, self.n().1 as i32);
        (pair.x1, pair.x2) = (self.x1.as_ptr(), self.x2.as_ptr());
        (pair.quadrature, pair.multiplier_space) = (self.quadrature, self.space);
        pair
    }

    pub fn weights(&self) -> Weights {
        let ((n1, n2), m) = (self.n(), self.m());
        let columns = 3 * (n1 + n2);
        // NaN, so that an entry which is not written shows.
        let fresh = |n: usize| vec![f64::NAN; n];
        let mut w = Weights {
            ab: fresh(m * n1),
            ac: fresh(m * n2),
            dab: fresh(m * n1 * columns),
            dac: fresh(m * n2 * columns),
        };
        ok!(stickslip_pair_weights(
            &self.raw(),
            w.ab.as_mut_ptr(),
            w.ac.as_mut_ptr(),
            w.dab.as_mut_ptr(),
            w.dac.as_mut_ptr()
        ));
        assert!([&w.ab, &w.ac, &w.dab, &w.dac].into_iter().flatten().all(|v| v.is_finite()));
        w
    }

    fn gap(&self, w: &Weights) -> Vec<f64> {
        let mut gap = vec![f64::NAN; 3 * self.m()];
        ok!(stickslip_pair_gap(&self.raw(), w.ab.as_ptr(), w.ac.as_ptr(), gap.as_mut_ptr()));
        gap
    }

    /// The longest extent of the non-mortar facet.
    fn size(&self) -> f64 {
        max_abs(self.x1.iter().enumerate().map(|(i, x)| x - self.x1[i % 3]))
    }
}

#[test]
fn golden_pair_weights() {
    let (mut worst, mut worst_rule) = (0.0_f64, [0.0_f64; 2]);
    for case in golden("golden_pairs.json") {
        let pair = Pair::of(&case, STICKSLIP_QUADRATURE_DEGREE_5);
        let w = pair.weights();
        let (ab, ac) = (flat(&case["nAB"]), flat(&case["nAC"]));
        let largest = max_abs(ab.iter().chain(&ac).copied());
        let error = difference(&w.ab, &ab).max(difference(&w.ac, &ac));
        let bound = WEIGHTS_RELATIVE * largest + WEIGHTS_ABSOLUTE * pair.size().powi(2);
        worst = worst.max(error / bound);
        assert!(error <= bound, "{}: weights off by {error:e}, allowed {bound:e}", name(&case));
        if case["overlap"] == false {
            assert!([&w.ab, &w.ac].into_iter().flatten().all(|v| *v == 0.0), "{}: not exactly zero", name(&case));
        }
        if case["affine"] == false {
            for (rule, allowed) in [(0, RULE_ERROR_DEGREE_5), (1, RULE_ERROR_DEGREE_10)] {
                let w = Pair::of(&case, rule).weights();
                let error =
                    difference(&w.ab, &flat(&case["nAB_exact"])).max(difference(&w.ac, &flat(&case["nAC_exact"])));
                worst_rule[rule as usize] = worst_rule[rule as usize].max(error / largest);
                assert!(error <= allowed * largest, "{}: exact weights off by {:e}", name(&case), error / largest);
            }
        }
    }
    println!("W1 {worst:.2} of its bound; W2 degree 5 {:.1e}, degree 10 {:.1e}", worst_rule[0], worst_rule[1]);
}

#[test]
fn golden_pair_derivatives() {
    let (mut affine, mut angle, mut rule) = (0.0_f64, 0.0_f64, 0.0_f64);
    for case in golden("golden_pairs.json") {
        // P15, P16: a mortar vertex on a non-mortar edge. The tabulated derivative misses that edge's part (see
        // tests/mortar/golden.rs, which has the right one from rational arithmetic).
        if name(&case).contains("corner_sliver") {
            continue;
        }
        let exact = case["affine"] == false;
        let (key_ab, key_ac) = if exact { ("dnAB_exact", "dnAC_exact") } else { ("dnAB", "dnAC") };
        if !case[key_ab].is_array() {
            continue;
        }
        let w = Pair::of(&case, STICKSLIP_QUADRATURE_DEGREE_5).weights();
        let (dab, dac) = (flat(&case[key_ab]), flat(&case[key_ac]));
        let scale = max_abs(dab.iter().chain(&dac).copied());
        let error = relative(difference(&w.dab, &dab).max(difference(&w.dac, &dac)), scale);
        let (worst, bound) = match (exact, name(&case).contains("angle")) {
            (true, _) => (&mut rule, DERIVATIVES_OF_RULE),
            (_, true) => (&mut angle, DERIVATIVES_AT_SMALL_ANGLE),
            _ => (&mut affine, DERIVATIVES),
        };
        // A long facet's gradients know its short side to rounding of the long one.
        let one = facet(&case["x1"]);
        let bound = bound.max(10.0 * f64::EPSILON * one.longest_edge().powi(2) / one.area_vector().norm());
        *worst = worst.max(error);
        assert!(error <= bound, "{}: derivatives off by {error:e}", name(&case));
    }
    println!("W8 affine {affine:.1e}, small angles {angle:.1e}; rule on warped quads {rule:.1e}");
}

#[test]
fn golden_pair_identities() {
    let mut worst = [0.0_f64; 3];
    for case in golden("golden_pairs.json") {
        let pair = Pair::of(&case, STICKSLIP_QUADRATURE_DEGREE_5);
        let w = pair.weights();
        let nodes = pair.n().0 + pair.n().1;
        // Relative to a node of the pair: the identities hold about any point.
        let x: Vec<_> = pair.x1.iter().chain(&pair.x2).enumerate().map(|(i, x)| x - pair.x1[i % 3]).collect();
        let reach = max_abs(x.iter().copied());
        let weights = w.ab.iter().chain(&w.ac);
        let rows = w.dab.chunks_exact(3 * nodes).chain(w.dac.chunks_exact(3 * nodes));
        for (n, row) in weights.zip(rows) {
            let scale = n.abs() + row.iter().zip(&x).map(|(d, x)| (d * x).abs()).sum::<f64>();
            let absolute = WEIGHTS_ABSOLUTE * reach * reach;
            let shift = (0..3).map(|i| row.iter().skip(i).step_by(3).sum::<f64>());
            let shift = max_abs(shift) * reach;
            let turn = (0..3).map(|i| {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                (0..nodes).map(|p| x[3 * p + j] * row[3 * p + k] - x[3 * p + k] * row[3 * p + j]).sum::<f64>()
            });
            let turn = max_abs(turn);
            let euler = (row.iter().zip(&x).map(|(d, x)| d * x).sum::<f64>() - 2.0 * n).abs();
            let euler_bound = if case["affine"] == true { IDENTITIES } else { DERIVATIVES_OF_RULE };
            for (k, (error, bound)) in
                [(shift, IDENTITIES), (turn, IDENTITIES), (euler, euler_bound)].into_iter().enumerate()
            {
                assert!(error <= bound * scale + absolute, "{}: identity {k} off by {error:e}", name(&case));
                worst[k] = worst[k].max(error / (bound * scale + absolute));
            }
        }
    }
    println!("W7 of its bound: translation {:.2}, rotation {:.2}, Euler {:.2}", worst[0], worst[1], worst[2]);
}

/// A golden interface behind a handle, with every golden input set.
pub(super) struct Golden {
    pub handle: *mut stickslip_interface,
    pub x1: Vec<f64>,
    pub x2: Vec<f64>,
    pub lambda: Vec<f64>,
}

impl Drop for Golden {
    fn drop(&mut self) {
        ok!(stickslip_interface_destroy(&mut self.handle));
    }
}

pub(super) fn per_node(v: &Value, n: usize) -> Vec<f64> {
    if v.is_array() { numbers(v) } else { vec![v.as_f64().unwrap(); n] }
}

pub(super) fn slip_option(case: &Value) -> i32 {
    match case["variant"].as_str().unwrap() {
        "seed" => STICKSLIP_SLIP_PAPER,
        "increment" => STICKSLIP_SLIP_INCREMENT,
        _ => STICKSLIP_SLIP_OBJECTIVE,
    }
}

pub(super) fn facets(v: &Value) -> Vec<Vec<i64>> {
    let row = |f: &Value| f.as_array().unwrap().iter().map(|k| k.as_i64().unwrap()).collect();
    v.as_array().unwrap().iter().map(row).collect()
}

/// What golden vectors are computed with, and the method, which the options are to point to: the paper's element, rows as it prints
/// them, where each covered node has a multiplier of its own.
pub fn golden_options(case: &Value) -> (stickslip_options, stickslip_method) {
    let mut options = sized!(stickslip_options);
    ok!(stickslip_options_init(&mut options, size_of::<stickslip_options>() as u64));
    ok!(stickslip_options_paper(&mut options));
    // SAFETY: the library's.
    let mut method = unsafe { *options.method };
    method.augmentation = 1.0;
    method.weak_coverage = STICKSLIP_WEAK_COVERAGE_NONE;
    method.slip = slip_option(case);
    method.row_scale = STICKSLIP_ROW_SCALE_NONE;
    method.new_contact = STICKSLIP_NEW_CONTACT_KEEP;
    (options, method)
}

impl Golden {
    fn new(case: &Value, form: i32, quadrature: i32) -> Golden {
        Golden::with_basis(case, form, quadrature, STICKSLIP_BASIS_STANDARD)
    }

    pub fn with_basis(case: &Value, form: i32, quadrature: i32, basis: i32) -> Golden {
        Golden::with_options(case, |_, method| {
            (method.form, method.quadrature, method.multiplier_basis) = (form, quadrature, basis);
        })
    }

    /// Where each covered node has a multiplier of its own. Normals are the golden ones where they are data; without
    /// friction the multipliers are those along the normal.
    pub fn with_options(case: &Value, choose: impl Fn(&mut stickslip_options, &mut stickslip_method)) -> Golden {
        let (x1, x2) = (flat(&case["x1"]), flat(&case["x2"]));
        let mut equations: Vec<i64> = (0..(2 * x1.len() + x2.len()) as i64).collect();
        let arrays = |v: &Value| {
            let facets = facets(v);
            let offsets = facets.iter().scan(0, |end, f| {
                *end += f.len() as i64;
                Some(*end)
            });
            (std::iter::once(0).chain(offsets).collect::<Vec<i64>>(), facets.concat())
        };
        // Nodes of quadratic facets that have no multiplier.
        let has = case["has_multiplier"].as_array().into_iter().flatten();
        for (a, _) in has.enumerate().filter(|(_, has)| **has == false) {
            equations[x1.len() + x2.len() + 3 * a..][..3].fill(-1);
        }
        let (offsets1, nodes1) = arrays(&case["facets1"]);
        let (offsets2, nodes2) = arrays(&case["facets2"]);
        let mut one = sized!(stickslip_surface);
        (one.n_nodes, one.n_facets) = (x1.len() as i64 / 3, offsets1.len() as i64 - 1);
        // Another first configuration than t_n, so that set_previous has something to do.
        one.coordinates = x1.as_ptr();
        (one.facet_offsets, one.facet_nodes) = (offsets1.as_ptr(), nodes1.as_ptr());
        one.equations = equations.as_ptr();
        one.multiplier_equations = equations[x1.len() + x2.len()..].as_ptr();
        let mut two = sized!(stickslip_surface);
        (two.n_nodes, two.n_facets) = (x2.len() as i64 / 3, offsets2.len() as i64 - 1);
        two.coordinates = x2.as_ptr();
        (two.facet_offsets, two.facet_nodes) = (offsets2.as_ptr(), nodes2.as_ptr());
        two.equations = equations[x1.len()..].as_ptr();
        let (mut options, mut method) = golden_options(case);
        choose(&mut options, &mut method);
        options.method = &raw const method;
        let frictional = options.friction != STICKSLIP_FRICTION_NONE;
        let mut handle = null_mut();
        ok!(stickslip_interface_create(&one, &two, &options, &mut handle));

        let n1 = x1.len() / 3;
        let (x1_prev, x2_prev) = (flat(&case["x1_prev"]), flat(&case["x2_prev"]));
        ok!(stickslip_interface_set_previous(handle, x1_prev.as_ptr(), x2_prev.as_ptr()));
        if frictional {
            ok!(stickslip_interface_set_friction(handle, per_node(&case["mu"], n1).as_ptr()));
        }
        ok!(stickslip_interface_set_augmentation(handle, per_node(&case["r"], n1).as_ptr()));
        if method.normals == STICKSLIP_NORMALS_COMMITTED {
            ok!(stickslip_interface_set_normals(handle, flat(&case["nu"]).as_ptr()));
        }
        Golden { handle, x1, x2, lambda: flat(&case[if frictional { "lambda" } else { "lambda_N" }]) }
    }

    /// Where the blocks x1, x2, lambda end.
    pub fn ends(&self) -> [usize; 4] {
        let (a, b) = (self.x1.len(), self.x1.len() + self.x2.len());
        [0, a, b, b + self.lambda.len()]
    }

    pub fn residual(&self) -> Vec<f64> {
        let [_, a, b, n] = self.ends();
        let mut r = vec![f64::NAN; n];
        let p = r.as_mut_ptr();
        ok!(stickslip_interface_residual(
            self.handle,
            self.x1.as_ptr(),
            self.x2.as_ptr(),
            self.lambda.as_ptr(),
            null(),
            p,
            p.add(a),
            p.add(b)
        ));
        r
    }

    pub fn states(&self) -> Vec<i32> {
        let mut state = vec![-1; self.x1.len() / 3];
        let mut out = sized!(stickslip_states);
        out.state = state.as_mut_ptr();
        self.report(&out);
        state
    }

    pub fn normals(&self) -> Vec<f64> {
        let mut normals = vec![f64::NAN; self.x1.len()];
        let mut out = sized!(stickslip_states);
        out.normal = normals.as_mut_ptr();
        self.report(&out);
        normals
    }

    fn report(&self, out: &stickslip_states) {
        ok!(stickslip_interface_states(
            self.handle,
            self.x1.as_ptr(),
            self.x2.as_ptr(),
            self.lambda.as_ptr(),
            null(),
            out
        ));
    }

    pub fn tangent(&self) -> Vec<f64> {
        dense_tangent(self.handle, [&self.x1, &self.x2, &self.lambda])
    }
}

/// The tangent at these positions and multipliers, whose equations are numbered one after the other.
pub(super) fn dense_tangent(handle: *mut stickslip_interface, at: [&[f64]; 3]) -> Vec<f64> {
    let n = at.iter().map(|of| of.len()).sum::<usize>();
    let [x1, x2, lambda] = at.map(<[f64]>::as_ptr);
    let (mut count, none) = (0, null_mut());
    ok!(stickslip_interface_tangent_coo(handle, x1, x2, lambda, null(), 0, null_mut(), null_mut(), none, &mut count));
    let (mut rows, mut columns) = (vec![-1; count as usize], vec![-1; count as usize]);
    let (mut values, capacity) = (vec![f64::NAN; count as usize], count);
    ok!(stickslip_interface_tangent_coo(
        handle,
        x1,
        x2,
        lambda,
        null(),
        capacity,
        rows.as_mut_ptr(),
        columns.as_mut_ptr(),
        values.as_mut_ptr(),
        &mut count
    ));
    assert_eq!(count, capacity);
    let mut k = vec![0.0; n * n];
    for ((row, column), value) in rows.into_iter().zip(columns).zip(values) {
        k[row as usize * n + column as usize] += value;
    }
    k
}

/// Worst error over the blocks (f1, f2, c), each relative to its largest entry.
pub(super) fn residual_error(ends: [usize; 4], r: &[f64], expected: &[f64]) -> f64 {
    let block = |e: &[usize]| {
        let (r, expected) = (&r[e[0]..e[1]], &expected[e[0]..e[1]]);
        relative(difference(r, expected), max_abs(expected.iter().copied()))
    };
    max_abs(ends.windows(2).map(block))
}

/// Worst error over the blocks (f1, f2, c) x (x1, x2, lambda), each relative to its largest entry.
pub(super) fn tangent_error(ends: [usize; 4], k: &[f64], expected: &[f64], vanishing: f64) -> f64 {
    let n = ends[3];
    let least = vanishing * max_abs(expected.iter().copied());
    let mut worst = 0.0_f64;
    for rows in ends.windows(2) {
        for columns in ends.windows(2) {
            let (mut error, mut scale) = (0.0_f64, least);
            for i in rows[0]..rows[1] {
                let range = i * n + columns[0]..i * n + columns[1];
                error = error.max(difference(&k[range.clone()], &expected[range.clone()]));
                scale = scale.max(max_abs(expected[range].iter().copied()));
            }
            worst = worst.max(relative(error, scale));
        }
    }
    worst
}

pub(super) fn dense(coo: &Value, n: usize) -> Vec<f64> {
    let mut k = vec![0.0; n * n];
    let (i, j, v) = (numbers(&coo["i"]), numbers(&coo["j"]), numbers(&coo["v"]));
    for t in 0..v.len() {
        k[i[t] as usize * n + j[t] as usize] += v[t];
    }
    k
}

/// With mu = 0 and no tangential traction (I06b), stick and slip name the same thing.
pub(super) fn state_matches(case: &Value, found: i32, expected: f64) -> bool {
    found == expected as i32 || (name(case).starts_with("I06b") && found != STICKSLIP_STATE_GAP)
}

#[test]
fn golden_interface_states_and_residuals() {
    let (mut worst, mut worst_rule) = (0.0_f64, [0.0_f64; 2]);
    for case in golden("golden_interfaces.json") {
        let g = Golden::new(&case, STICKSLIP_FORM_AUGMENTED, STICKSLIP_QUADRATURE_DEGREE_5);
        for (a, (found, expected)) in g.states().into_iter().zip(numbers(&case["state"])).enumerate() {
            assert!(state_matches(&case, found, expected), "{}: state of node {a} is {found}", name(&case));
        }
        let error = residual_error(g.ends(), &g.residual(), &numbers(&case["residual"]));
        worst = worst.max(error);
        assert!(error <= RESIDUAL, "{}: residual off by {error:e}", name(&case));
        if case["affine"] == false {
            for (rule, bound) in [(0, RULE_RESIDUAL), (1, RULE_RESIDUAL_DEGREE_10)] {
                let g = Golden::new(&case, STICKSLIP_FORM_AUGMENTED, rule);
                let error = residual_error(g.ends(), &g.residual(), &numbers(&case["residual_exactquad"]));
                worst_rule[rule as usize] = worst_rule[rule as usize].max(error);
                assert!(error <= bound, "{}: exact residual off by {error:e}", name(&case));
            }
        }
    }
    println!("S2 exact; S1 {worst:.1e}; warped: degree 5 {:.1e}, degree 10 {:.1e}", worst_rule[0], worst_rule[1]);
}

#[test]
fn golden_interface_tangents() {
    let mut worst = [0.0_f64; 3];
    for case in golden("golden_interfaces.json") {
        if case["smooth"] == false {
            continue; // a kink: no tangent is tabulated
        }
        let g = Golden::new(&case, STICKSLIP_FORM_AUGMENTED, STICKSLIP_QUADRATURE_DEGREE_5);
        let (row, key, bound) = match case["affine"].as_bool().unwrap() {
            true if name(&case) < "I28" => (0, "tangent", TANGENT),
            true => (1, "tangent", TANGENT_NEAR_MATCHING),
            false => (2, "tangent_exactquad", RULE_TANGENT),
        };
        let error = tangent_error(g.ends(), &g.tangent(), &dense(&case[key], g.ends()[3]), VANISHING);
        worst[row] = worst[row].max(error);
        assert!(error <= bound, "{}: tangent off by {error:e}", name(&case));
    }
    println!("K1 {:.1e}; K6 {:.1e}; rule on warped quads {:.1e}", worst[0], worst[1], worst[2]);
}

/// What a host without the handle does: pairs, nodes, pairs again, node blocks.
pub(super) struct Stages {
    pub responses: Vec<stickslip_node_response>,
    pub gaps: Vec<f64>,
    pub coverage: Vec<f64>,
    /// (forces of the multiplier form, forces of the augmented form); rows in both.
    pub residual: [Vec<f64>; 2],
    pub tangent: Vec<f64>,
}

/// One pair of an interface: its unknowns, and its weights where it overlaps.
struct Element {
    now: Pair,
    weights: [Option<Weights>; 2],
    nodes1: Vec<i64>,
    nodes2: Vec<i64>,
}

fn elements(case: &Value) -> Vec<Element> {
    let space = if case["multiplier_space"] == "sub" { STICKSLIP_SPACE_SUB } else { STICKSLIP_SPACE_CORNER };
    let gather = |x: &Value, nodes: &[i64]| nodes.iter().flat_map(|&k| flat(&x[k as usize])).collect::<Vec<_>>();
    let mut elements = Vec::new();
    for nodes1 in facets(&case["facets1"]) {
        for nodes2 in facets(&case["facets2"]) {
            let pair = |x1: &str, x2: &str| Pair {
                x1: gather(&case[x1], &nodes1),
                x2: gather(&case[x2], &nodes2),
                quadrature: STICKSLIP_QUADRATURE_DEGREE_5,
                space,
            };
            let (now, before) = (pair("x1", "x2"), pair("x1_prev", "x2_prev"));
            // Facets that touch have no area, but a derivative.
            let weights = [&now, &before].map(|p| {
                Some(p.weights()).filter(|w| [&w.ab, &w.dab, &w.dac].into_iter().flatten().any(|v| *v != 0.0))
            });
            elements.push(Element { now, weights, nodes1: nodes1.clone(), nodes2: nodes2.clone() });
        }
    }
    elements
}

fn pointer(values: Option<&Vec<f64>>) -> *const f64 {
    values.map_or(null(), |v| v.as_ptr())
}

/// Stage 4: the nodes' own rows and blocks, from row `first` of n on.
pub(super) fn add_node_blocks(
    responses: &[stickslip_node_response],
    (first, n): (usize, usize),
    residual: &mut [Vec<f64>; 2],
    tangent: &mut [f64],
) {
    for (a, response) in responses.iter().enumerate() {
        let first = first + 3 * a;
        let (mut row, mut block) = ([f64::NAN; 3], [f64::NAN; 9]);
        ok!(stickslip_node_block(response, 1.0, STICKSLIP_LAYOUT_ROW_MAJOR, row.as_mut_ptr(), block.as_mut_ptr()));
        residual.iter_mut().for_each(|r| r[first..first + 3].copy_from_slice(&row));
        block.iter().enumerate().for_each(|(k, v)| tangent[(first + k / 3) * n + first + k % 3] += v);
    }
}

pub(super) fn stages(case: &Value) -> Stages {
    let (n1, n2) = (case["x1"].as_array().unwrap().len(), case["x2"].as_array().unwrap().len());
    let lambda = flat(&case["lambda"]);
    let elements = elements(case);

    // Stage 1: coverage and gaps over all pairs.
    let mut coverage = [vec![0.0; n1], vec![0.0; n1]];
    let mut gaps = [vec![0.0; 3 * n1], vec![0.0; 3 * n1], vec![0.0; 3 * n1]];
    for e in &elements {
        let gather = |x: &Value, nodes: &[i64]| nodes.iter().flat_map(|&k| flat(&x[k as usize])).collect::<Vec<_>>();
        let old = Pair { x1: gather(&case["x1_prev"], &e.nodes1), x2: gather(&case["x2_prev"], &e.nodes2), ..e.now };
        let [now, before] = &e.weights;
        for (k, (weights, pair)) in [(now, &e.now), (before, &e.now), (before, &old)].into_iter().enumerate() {
            let Some(w) = weights else { continue };
            let gap = pair.gap(w);
            for (a, &node) in e.nodes1[..pair.m()].iter().enumerate() {
                (0..3).for_each(|i| gaps[k][3 * node as usize + i] += gap[3 * a + i]);
                if k < 2 {
                    coverage[k][node as usize] += w.ab.chunks_exact(e.nodes1.len()).nth(a).unwrap().iter().sum::<f64>();
                }
            }
        }
    }

    // Stage 2: the law.
    let (mu, r, nu) = (per_node(&case["mu"], n1), per_node(&case["r"], n1), flat(&case["nu"]));
    let largest = max_abs(coverage[0].iter().chain(&coverage[1]).copied());
    let triple = |v: &[f64], a: usize| [v[3 * a], v[3 * a + 1], v[3 * a + 2]];
    let mut responses = Vec::new();
    for a in 0..n1 {
        let mut node = sized!(stickslip_node);
        node.slip = slip_option(case);
        node.lambda = triple(&lambda, a);
        node.normal = triple(&nu, a);
        (node.augmentation, node.mu) = (r[a], mu[a]);
        (node.coverage, node.coverage_previous, node.coverage_min) = (coverage[0][a], coverage[1][a], 1e-8 * largest);
        (node.gap_now, node.gap_previous, node.gap_committed) =
            (triple(&gaps[0], a), triple(&gaps[1], a), triple(&gaps[2], a));
        let mut response = sized!(stickslip_node_response);
        ok!(stickslip_node_respond(&node, &mut response));
        responses.push(response);
    }

    // Stages 3 and 4.
    let n = 3 * (2 * n1 + n2);
    let mut residual = [vec![0.0; n], vec![0.0; n]];
    let mut tangent = vec![0.0; n * n];
    let projected: Vec<f64> = responses.iter().flat_map(|r| r.traction).collect();
    for e in &elements {
        let multipliers = &e.nodes1[..e.now.m()];
        let local = |v: &[f64]| multipliers.iter().flat_map(|&a| triple(v, a as usize)).collect::<Vec<_>>();
        let unknowns: Vec<usize> = (e.nodes1.iter().map(|&a| 3 * a as usize))
            .chain(e.nodes2.iter().map(|&c| 3 * (n1 + c as usize)))
            .chain(multipliers.iter().map(|&a| 3 * (n1 + n2 + a as usize)))
            .flat_map(|first| first..first + 3)
            .collect();
        let [now, before] = &e.weights;
        if let Some(w) = now {
            for (form, traction) in [&lambda, &projected].into_iter().enumerate() {
                let mut force = vec![f64::NAN; e.now.x1.len() + e.now.x2.len()];
                let (pair, t) = (e.now.raw(), local(traction));
                ok!(stickslip_pair_residual(&pair, w.ab.as_ptr(), w.ac.as_ptr(), t.as_ptr(), force.as_mut_ptr()));
                force.iter().zip(&unknowns).for_each(|(f, &i)| residual[form][i] += f);
            }
        }
        if now.is_none() && before.is_none() {
            continue;
        }
        let size = unknowns.len();
        let mut k = vec![f64::NAN; size * size];
        let local_responses: Vec<_> = multipliers.iter().map(|&a| responses[a as usize]).collect();
        let [now, before] = [now.as_ref(), before.as_ref()];
        ok!(stickslip_pair_tangent(
            &e.now.raw(),
            pointer(now.map(|w| &w.ab)),
            pointer(now.map(|w| &w.ac)),
            pointer(now.map(|w| &w.dab)),
            pointer(now.map(|w| &w.dac)),
            pointer(before.map(|w| &w.ab)),
            pointer(before.map(|w| &w.ac)),
            local(&lambda).as_ptr(),
            local_responses.as_ptr(),
            null(),
            k.as_mut_ptr(),
            size as i64
        ));
        for (row, &i) in k.chunks_exact(size).zip(&unknowns) {
            row.iter().zip(&unknowns).for_each(|(v, &j)| tangent[i * n + j] += v);
        }
    }
    add_node_blocks(&responses, (3 * (n1 + n2), n), &mut residual, &mut tangent);
    let [coverage, _] = coverage;
    let [gaps, ..] = gaps;
    Stages { responses, gaps, coverage, residual, tangent }
}

#[test]
fn golden_interfaces_by_stages() {
    let (mut gap, mut residual, mut tangent) = (0.0_f64, 0.0_f64, 0.0_f64);
    for case in golden("golden_interfaces.json") {
        let s = stages(&case);
        let g = Golden::new(&case, STICKSLIP_FORM_MULTIPLIER, STICKSLIP_QUADRATURE_DEGREE_5);
        for (a, (response, expected)) in s.responses.iter().zip(numbers(&case["state"])).enumerate() {
            assert!(state_matches(&case, response.state, expected), "{}: state of node {a}", name(&case));
        }
        // Coverage and gap: sums over pairs, relative to the area and to area times extent.
        let covered = numbers(&case["cover"]);
        let area = max_abs(covered.iter().copied());
        let extent = max_abs(g.x1.iter().enumerate().map(|(i, x)| x - g.x1[i % 3]));
        let error = (difference(&s.coverage, &covered) / area)
            .max(difference(&s.gaps, &flat(&case["gap_vector"])) / (area * extent));
        gap = gap.max(error);
        assert!(error <= RESIDUAL, "{}: coverage or gap off by {error:e}", name(&case));
        // The paper's form, from projected tractions, is the golden residual.
        let error = residual_error(g.ends(), &s.residual[1], &numbers(&case["residual"]));
        residual = residual.max(error);
        assert!(error <= RESIDUAL, "{}: residual by stages off by {error:e}", name(&case));
        // The multiplier form has no golden values of its own: the handle is checked against differences.
        let error = residual_error(g.ends(), &s.residual[0], &g.residual());
        assert!(error <= RESIDUAL, "{}: multiplier form off by {error:e}", name(&case));
        let error = tangent_error(g.ends(), &s.tangent, &g.tangent(), CANCELLING);
        tangent = tangent.max(error);
        assert!(error <= SAME_SUMS, "{}: tangent by stages off by {error:e}", name(&case));
    }
    println!("stages: gaps {gap:.1e}; S1 {residual:.1e}; tangent against the handle's {tangent:.1e}");
}
