//! The stages of a pair with a state give what the separate calls give: for triangles and quadrilaterals, all laws, all rules,
//! both layouts, pairs that overlap and pairs that do not. And a state is known by what it begins with.

use proptest::prelude::*;
use std::mem::{size_of, zeroed};
use std::ptr::{null, null_mut};
use stickslip::capi::*;

/// Contractions in another order, relative to the largest entry (measured below 1e-15).
const ROUNDING: f64 = 2e-15;
/// The largest leading dimension that is tried.
const LD: usize = 40;
/// Doubles that a state is given, more than it takes.
const ROOM: usize = 512;

#[derive(Clone, Debug)]
struct Scene {
    n: [i32; 2],
    x1: [f64; 12],
    x2: [f64; 12],
    quadrature: i32,
    element_points: i64,
    layout: i32,
    friction: i32,
    has_previous: bool,
    is_scaled: bool,
    ld: usize,
}

fn scenes() -> impl Strategy<Value = Scene> {
    let jitter = || prop::array::uniform12(-0.08..0.08_f64);
    let facets = (3..=4_i32, 3..=4_i32, jitter(), jitter(), -3.0..3.0_f64, -1.5..1.5_f64, -1.5..1.5_f64);
    let how = (0..6_i32, prop_oneof![Just(0_i64), Just(4)], 0..2_i32, 0..5_i32);
    (facets, how, any::<bool>(), any::<bool>(), 36..=LD).prop_map(|(facets, how, has_previous, is_scaled, ld)| {
        let (n1, n2, j1, j2, turn, right, up) = facets;
        let (mut x1, mut x2) = (j1, j2);
        for (k, [u, v]) in [[0.5, 0.5], [-0.5, 0.5], [-0.5, -0.5], [0.5, -0.5]].into_iter().enumerate() {
            (x1[3 * k], x1[3 * k + 1]) = (x1[3 * k] + u, x1[3 * k + 1] + v);
            // The other way round, seen from the other side.
            let (k, (s, c)) = (3 - k, f64::sin_cos(turn));
            let (a, b) = (x2[3 * k] + u, x2[3 * k + 1] + v);
            (x2[3 * k], x2[3 * k + 1]) = (c * a - s * b + right, s * a + c * b + up);
        }
        let (quadrature, element_points, layout, friction) = how;
        Scene { n: [n1, n2], x1, x2, quadrature, element_points, layout, friction, has_previous, is_scaled, ld }
    })
}

impl Scene {
    fn raw(&self) -> stickslip_pair {
        stickslip_pair {
            struct_size: size_of::<stickslip_pair>() as u64,
            n1: self.n[0],
            n2: self.n[1],
            x1: self.x1.as_ptr(),
            x2: self.x2.as_ptr(),
            quadrature: self.quadrature,
            layout: self.layout,
            element_points: self.element_points,
            neighbour_normals: null(),
            multiplier_space: 0,
            model: STICKSLIP_MODEL_SOLID,
            thickness: 0.0,
        }
    }

    /// A closed node with these gaps.
    fn respond(&self, gap: &[f64], previous: &[f64]) -> stickslip_node_response {
        let (mut normal, tresca) = ([0.0; 3], self.friction == STICKSLIP_FRICTION_TRESCA);
        // SAFETY: numbers alone, and arrays as long as two quadrilaterals need; so below.
        unsafe {
            let (mut node, mut response): (stickslip_node, stickslip_node_response) = (zeroed(), zeroed());
            assert_eq!(stickslip_facet_normal(self.n[0], self.x1.as_ptr(), normal.as_mut_ptr()), 0);
            node.struct_size = size_of::<stickslip_node>() as u64;
            response.struct_size = size_of::<stickslip_node_response>() as u64;
            node.lambda = [0.1, 0.2, -1.0];
            node.normal = normal.map(|v| -v);
            (node.augmentation, node.coverage, node.coverage_previous) = (3.0, 1.0, 1.0);
            node.friction = self.friction;
            (node.mu, node.shear_limit) = match self.friction {
                STICKSLIP_FRICTION_COULOMB => (0.3, 0.0),
                _ if tresca => (0.0, 0.1),
                _ => (0.0, 0.0),
            };
            node.gap_now.copy_from_slice(gap);
            node.gap_previous.copy_from_slice(previous);
            assert_eq!(stickslip_node_respond(&node, &mut response), 0, "{:?}", stickslip_last_error());
            response
        }
    }
}

fn stickslip_last_error() -> String {
    // SAFETY: the message ends with a zero.
    unsafe { std::ffi::CStr::from_ptr(stickslip_last_error_message()) }.to_string_lossy().into_owned()
}

fn near(a: &[f64], b: &[f64]) -> Result<(), TestCaseError> {
    let largest = a.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    for (a, b) in a.iter().zip(b) {
        prop_assert!((a - b).abs() <= ROUNDING * largest, "{a:e} {b:e}: {:e} of {largest:e}", (a - b).abs() / largest);
    }
    Ok(())
}

fn agree(s: &Scene) -> Result<(), TestCaseError> {
    let (pair, [n1, n2]) = (s.raw(), s.n.map(|n| n as usize));
    let (mut ab, mut ac, mut dab, mut dac) = ([0.0; 16], [0.0; 16], [0.0; 384], [0.0; 384]);
    let (mut state, mut ab2, mut ac2) = ([0.0; ROOM], [0.0; 16], [0.0; 16]);
    let mut gaps = [[0.0; 12]; 4];
    let mut forces = [[0.0; 24]; 2];
    let mut k = [[7.0; 36 * LD]; 2];
    let size = (6 * n1 + 3 * n2) as i64;
    let ld = size + s.ld as i64 - 36;
    // SAFETY: arrays as long as two quadrilaterals need.
    unsafe {
        let weights = |ab: *mut f64, ac: *mut f64, dab, dac| stickslip_pair_weights(&pair, ab, ac, dab, dac);
        let status = weights(ab.as_mut_ptr(), ac.as_mut_ptr(), dab.as_mut_ptr(), dac.as_mut_ptr());
        let (a, c, g) = (ab2.as_mut_ptr(), ac2.as_mut_ptr(), gaps[1].as_mut_ptr());
        let with_state = stickslip_pair_begin(&pair, ROOM as i64, state.as_mut_ptr(), a, c, g);
        prop_assert_eq!(status, with_state);
        prop_assume!(status == 0);
        prop_assert_eq!((ab, ac), (ab2, ac2), "the same bits");
        // Where the state lies does not matter.
        let mut moved = [0.0; ROOM];
        moved.copy_from_slice(&state);
        state.fill(f64::NAN);
        let state = moved.as_ptr();

        let (before_ab, before_ac) = (ab.map(|n| 1.1 * n), ac.map(|n| 1.1 * n));
        prop_assert_eq!(stickslip_pair_gap(&pair, ab.as_ptr(), ac.as_ptr(), gaps[0].as_mut_ptr()), 0);
        prop_assert_eq!(gaps[0], gaps[1]);
        prop_assert_eq!(stickslip_pair_state_gap(state, null(), null(), gaps[1].as_mut_ptr()), 0);
        prop_assert_eq!(gaps[0], gaps[1]);
        prop_assert_eq!(stickslip_pair_gap(&pair, before_ab.as_ptr(), before_ac.as_ptr(), gaps[2].as_mut_ptr()), 0);
        let gap = gaps[3].as_mut_ptr();
        prop_assert_eq!(stickslip_pair_state_gap(state, before_ab.as_ptr(), before_ac.as_ptr(), gap), 0);
        prop_assert_eq!(gaps[2], gaps[3]);

        let responses = [0, 1, 2, 3].map(|a| s.respond(&gaps[0][3 * a..][..3], &gaps[2][3 * a..][..3]));
        let traction = [0, 1, 2, 3].map(|a| [0.1, 0.2, -1.0 - 0.1 * f64::from(a)]);
        let (traction, scale) = (traction.as_flattened().as_ptr(), [2.0, 3.0, 4.0, 5.0]);
        let force = forces[0].as_mut_ptr();
        prop_assert_eq!(stickslip_pair_residual(&pair, ab.as_ptr(), ac.as_ptr(), traction, force), 0);
        prop_assert_eq!(stickslip_pair_state_residual(state, traction, forces[1].as_mut_ptr()), 0);
        prop_assert_eq!(forces[0], forces[1]);

        let scale = if s.is_scaled { scale.as_ptr() } else { null() };
        let [old_ab, old_ac] = if s.has_previous { [before_ab.as_ptr(), before_ac.as_ptr()] } else { [null(), null()] };
        let (a, c, da, dc) = (ab.as_ptr(), ac.as_ptr(), dab.as_ptr(), dac.as_ptr());
        let (responses, k0, k1) = (responses.as_ptr(), k[0].as_mut_ptr(), k[1].as_mut_ptr());
        let status = stickslip_pair_tangent(&pair, a, c, da, dc, old_ab, old_ac, traction, responses, scale, k0, ld);
        prop_assert_eq!(status, 0);
        let status = stickslip_pair_state_tangent(state, old_ab, old_ac, traction, responses, scale, k1, ld);
        prop_assert_eq!(status, 0);
    }
    // What lies beyond the matrix keeps its number in both.
    let beyond = |k: &[f64]| k.iter().map(|v| *v == 7.0).collect::<Vec<_>>();
    prop_assert_eq!(beyond(&k[0]), beyond(&k[1]));
    let inside = |k: &[f64]| k.iter().map(|v| if *v == 7.0 { 0.0 } else { *v }).collect::<Vec<_>>();
    near(&inside(&k[0]), &inside(&k[1]))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, max_global_rejects: 20000, failure_persistence: None, ..ProptestConfig::default() })]
    #[test]
    fn a_state_gives_what_the_separate_calls_give(scene in scenes()) {
        agree(&scene)?;
    }
}

#[test]
fn a_state_is_known_by_what_it_begins_with() {
    let x = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0];
    let y = [0.0, 0.0, 0.1, 0.0, 1.0, 0.1, 1.0, 1.0, 0.1, 1.0, 0.0, 0.1];
    let pair = stickslip_pair {
        struct_size: size_of::<stickslip_pair>() as u64,
        n1: 4,
        n2: 4,
        x1: x.as_ptr(),
        x2: y.as_ptr(),
        quadrature: 0,
        layout: 0,
        element_points: 0,
        neighbour_normals: null(),
        multiplier_space: 0,
        model: STICKSLIP_MODEL_SOLID,
        thickness: 0.0,
    };
    let (needed, mut state, mut gap) = (stickslip_pair_state_size(), [0.0; ROOM], [5.0; 12]);
    assert!(needed <= ROOM as i64 / 2 + 32, "{needed} doubles are more than the header says");
    // SAFETY: arrays as long as two quadrilaterals need.
    unsafe {
        let none = null_mut();
        let p = state.as_mut_ptr();
        assert_eq!(stickslip_pair_state_gap(p, null(), null(), gap.as_mut_ptr()), STICKSLIP_INVALID_VALUE);
        assert_eq!(stickslip_pair_begin(&pair, needed - 1, p, none, none, none), STICKSLIP_BUFFER_TOO_SMALL);
        assert_eq!(state, [0.0; ROOM]);
        let p = state.as_mut_ptr();
        assert_eq!(stickslip_pair_begin(&pair, needed, p, none, none, none), 0);
        assert!(state[needed as usize..].iter().all(|v| *v == 0.0));
        assert_eq!(gap, [5.0; 12]);
        assert_eq!(stickslip_pair_state_gap(state.as_ptr(), null(), null(), gap.as_mut_ptr()), 0);
        assert!((gap[2].abs() - 0.025).abs() < 1e-16, "{gap:?}"); // a quarter of the area, 0.1 apart
        let begun = std::mem::replace(&mut state[0], 1.0);
        assert_eq!(stickslip_pair_state_gap(state.as_ptr(), null(), null(), gap.as_mut_ptr()), STICKSLIP_INVALID_VALUE);
        state[0] = begun;
        assert_eq!(stickslip_pair_state_residual(state.as_ptr(), gap.as_ptr(), [0.0; 24].as_mut_ptr()), 0);
    }
}
