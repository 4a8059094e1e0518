//! Quadratic facets through the C ABI (`src/capi/parents.rs`): golden pairs, and golden interfaces by the stages of pairs and
//! nodes.

use super::golden::*;
use crate::support::*;
use serde_json::Value;
use std::ffi::CStr;
use std::ptr::{null, null_mut};
use stickslip::capi::*;

/// G1: weights of affine sub-facets, relative to the largest.
const WEIGHTS: f64 = 1e-13;
/// G1: derivatives of the same.
const DERIVATIVES: f64 = 1e-10;
/// G4: residual, relative to the largest entry of the block.
const RESIDUAL: f64 = 1e-12;
/// G4: tangent, likewise.
const TANGENT: f64 = 1e-10;
/// A block smaller than this part of the matrix vanishes but for rounding, of which TANGENT must not be made: n_AB where the
/// mortar facet covers all.
const VANISHING: f64 = 1e-5;

#[test]
fn golden_pairs_of_quadratic_facets() {
    let mut compared = 0;
    for case in golden_part("golden_quadratic.json", "pairs") {
        if case["affine"] == false || case["corner"]["overlap"] == false {
            continue;
        }
        for (key, space) in [("corner", STICKSLIP_SPACE_CORNER), ("sub", STICKSLIP_SPACE_SUB)] {
            let expected = &case[key];
            let pair = Pair { space, ..Pair::of(&case, STICKSLIP_QUADRATURE_DEGREE_5) };
            let w = pair.weights();
            // Rows of nodes without a multiplier are not handed out.
            let cut = |v: &Value, len: usize| -> Vec<f64> {
                let all = flat(v);
                assert!(all[len..].iter().all(|v| *v == 0.0));
                all[..len].to_vec()
            };
            let of = |found: &[f64], v: &Value| difference(found, &cut(v, found.len()));
            let scale = |v: [&Value; 2]| max_abs(v.into_iter().flat_map(flat));
            let error = of(&w.ab, &expected["nAB"]).max(of(&w.ac, &expected["nAC"]));
            assert!(error <= WEIGHTS * scale([&expected["nAB"], &expected["nAC"]]), "{} {key}: {error:e}", name(&case));
            if expected["dnAB"].is_array() {
                let error = of(&w.dab, &expected["dnAB"]).max(of(&w.dac, &expected["dnAC"]));
                let scale = scale([&expected["dnAB"], &expected["dnAC"]]);
                assert!(error <= DERIVATIVES * scale, "{} {key}: derivatives {error:e}", name(&case));
                compared += 1;
            }
        }
    }
    assert!(compared > 3);
}

#[test]
fn golden_interfaces_of_quadratic_facets_by_stages() {
    let mut worst = [0.0_f64; 2];
    for case in golden_part("golden_quadratic.json", "interfaces") {
        let s = stages(&case);
        for (a, (response, expected)) in s.responses.iter().zip(numbers(&case["state"])).enumerate() {
            assert_eq!(f64::from(response.state), expected, "{}: state of node {a}", name(&case));
        }
        let gaps = flat(&case["gap_vector"]);
        let error = difference(&s.gaps, &gaps) / max_abs(gaps.iter().copied());
        assert!(error <= RESIDUAL, "{}: gaps off by {error:e}", name(&case));
        let (n1, n2) = (case["x1"].as_array().unwrap().len(), case["x2"].as_array().unwrap().len());
        let ends = [0, 3 * n1, 3 * (n1 + n2), 3 * (2 * n1 + n2)];
        let error = residual_error(ends, &s.residual[0], &numbers(&case["residual_mult"]));
        assert!(error <= RESIDUAL, "{}: residual off by {error:e}", name(&case));
        worst[0] = worst[0].max(error);
        let error = tangent_error(ends, &s.tangent, &dense(&case["tangent_mult"], ends[3]), VANISHING);
        assert!(error <= TANGENT, "{}: tangent off by {error:e}", name(&case));
        worst[1] = worst[1].max(error);
    }
    println!("G4 residual {:.1e}, tangent {:.1e}", worst[0], worst[1]);
}

/// The same by a handle.
#[test]
fn golden_interfaces_of_quadratic_facets_by_a_handle() {
    for case in golden_part("golden_quadratic.json", "interfaces") {
        let space = if case["multiplier_space"] == "sub" { STICKSLIP_SPACE_SUB } else { STICKSLIP_SPACE_CORNER };
        let g = Golden::with_options(&case, |_, method| method.multiplier_space = space);
        let has: Vec<bool> = case["has_multiplier"].as_array().unwrap().iter().map(|h| h == true).collect();
        let states = g.states().into_iter().zip(numbers(&case["state"])).zip(&has);
        for (a, ((found, state), _)) in states.enumerate().filter(|(_, (_, has))| **has) {
            assert_eq!(found as f64, state, "{}: state of node {a}", name(&case));
        }
        let ends = g.ends();
        let error = residual_error(ends, &g.residual(), &numbers(&case["residual_mult"]));
        assert!(error <= RESIDUAL, "{}: residual off by {error:e}", name(&case));
        let (n, mut expected) = (ends[3], dense(&case["tangent_mult"], ends[3]));
        // Nodes without multipliers have no equations for them; the data have -1 / r on the diagonal there.
        (ends[2]..n).filter(|i| !has[(i - ends[2]) / 3]).for_each(|i| expected[i * n + i] = 0.0);
        let error = tangent_error(ends, &g.tangent(), &expected, VANISHING);
        assert!(error <= TANGENT, "{}: tangent off by {error:e}", name(&case));
    }
}

/// Areas of multipliers at corners: those of the weights where all is covered. Normals of a flat facet: its own.
#[test]
fn geometry_of_quadratic_facets() {
    let mut compared = 0;
    for case in golden_part("golden_quadratic.json", "pairs") {
        if !name(&case).contains("fully_covered") {
            continue;
        }
        let pair = Pair::of(&case, STICKSLIP_QUADRATURE_DEGREE_5);
        let (w, n1) = (pair.weights(), pair.n().0);
        let (mut normals, mut areas) = (vec![f64::NAN; 3 * n1], vec![f64::NAN; pair.m()]);
        ok!(stickslip_facet_geometry(n1 as i32, pair.x1.as_ptr(), normals.as_mut_ptr(), areas.as_mut_ptr()));
        for (row, area) in w.ab.chunks_exact(n1).zip(&areas) {
            assert!((row.iter().sum::<f64>() - area).abs() <= WEIGHTS * area, "{}: {area}", name(&case));
        }
        let x = |k: usize| [0, 1, 2].map(|i| pair.x1[3 * k + i] - pair.x1[i]);
        let ([a, b], n) = ([x(1), x(2)], &normals[..3]);
        assert!([a, b].iter().all(|v| (0..3).map(|i| v[i] * n[i]).sum::<f64>().abs() < WEIGHTS), "{n:?}");
        assert!(normals.chunks_exact(3).all(|m| difference(m, n) < WEIGHTS));
        compared += 1;
    }
    assert!(compared > 0);
}

fn refused(pair: &stickslip_pair) -> (i32, String) {
    let mut n = vec![0.0; 200];
    // SAFETY: `n` has room for the weights of any pair; the message is never NULL and zero-terminated.
    unsafe {
        let status = stickslip_pair_weights(pair, n.as_mut_ptr(), null_mut(), null_mut(), null_mut());
        (status, CStr::from_ptr(stickslip_last_error_message()).to_string_lossy().into_owned())
    }
}

#[test]
fn what_quadratic_pairs_do_not_take_is_refused_by_name() {
    let case = golden_part("golden_quadratic.json", "pairs").swap_remove(0);
    let pair = Pair::of(&case, STICKSLIP_QUADRATURE_DEGREE_5);
    let check = |change: &dyn Fn(&mut stickslip_pair), status: i32, said: &str| {
        let mut raw = pair.raw();
        change(&mut raw);
        let (found, message) = refused(&raw);
        assert!(found == status && message.contains(said), "{found}: {message}");
    };
    check(
        &|p| p.n1 = 7,
        STICKSLIP_INVALID_SIZE,
        "pair.x1 has 7 nodes; 3 (tri3), 4 (quad4), 6 (tri6), 8 (quad8) or 9 (quad9)",
    );
    check(&|p| p.n2 = 10, STICKSLIP_INVALID_SIZE, "pair.x2 has 10 nodes");
    check(&|p| p.multiplier_space = 2, STICKSLIP_INVALID_VALUE, "pair.multiplier_space is 2; the header names 0 to 1");
    check(&|p| p.element_points = 4, STICKSLIP_UNSUPPORTED, "pair.element_points and pair.neighbour_normals");
    check(&|p| p.neighbour_normals = p.x1, STICKSLIP_UNSUPPORTED, "pair.element_points and pair.neighbour_normals");
    check(&|p| p.model = 3, STICKSLIP_INVALID_VALUE, "pair.model is 3; the header names 0 to 2");
    check(&|p| p.thickness = 0.5, STICKSLIP_INVALID_VALUE, "pair.thickness is 0.5");
    check(&|p| p.x1 = null(), STICKSLIP_NULL_POINTER, "pair.x1");
    // An older caller, whose struct has no space of multipliers, has them at the corners.
    let (mut raw, w) = (pair.raw(), pair.weights());
    (raw.struct_size, raw.multiplier_space) = (40, 77);
    let mut n_ab = vec![f64::NAN; w.ab.len()];
    ok!(stickslip_pair_weights(&raw, n_ab.as_mut_ptr(), null_mut(), null_mut(), null_mut()));
    assert_eq!(n_ab, w.ab);
    // Mid nodes that begin one edge later.
    let mut x = pair.x1.clone();
    x[9..].rotate_left(3);
    check(&|p| p.x1 = x.as_ptr(), STICKSLIP_DEGENERATE_FACET, "mid node");
    // A mid node on a corner's place.
    let mut x = pair.x1.clone();
    x.copy_within(0..3, 9);
    check(&|p| p.x1 = x.as_ptr(), STICKSLIP_DUPLICATE_NODE, "node 3");
}
