//! An interface with what a scene may ask for besides Coulomb's law: decisions at points, laws in its place, those of a host that
//! answers anything, heat, derivatives by what is no unknown, offsets of both sides. The calls of `interface.rs` go on between these.

use super::derivatives::derivatives;
use super::interface::{Scene, shake};
use super::meshes::{N1, N2};
use super::{Bytes, Watched, all_finite, succeeded};
use std::ffi::c_void;
use stickslip::capi::*;

/// More than the entries of any tangent of heat of this size.
const MOST: usize = 100_000;
/// Of all that passes: what leaves one body enters the other.
const LOST: f64 = 1e-6;

/// What the host's law answers.
struct Host {
    kind: usize,
    coefficient: f64,
    states: usize,
}

/// A threshold of mu p, one that weakens with the way, which it remembers, one that is no number, or no answer.
unsafe extern "C" fn threshold(
    user: *mut c_void,
    point: *const stickslip_law_point,
    states: *const f64,
    answer: *mut stickslip_law_answer,
    after: *mut f64,
) -> i32 {
    // SAFETY: the library passes what `set_threshold` got, and as many states as it was told.
    let (host, point, answer) = unsafe { (&*user.cast::<Host>(), &*point, &mut *answer) };
    assert!(point.normal <= 0.0 && point.slip.iter().chain(&point.slip_before).all(|v| v.is_finite()));
    let slip = point.slip.iter().map(|s| s * s).sum::<f64>().sqrt();
    if host.states > 0 {
        // SAFETY: as above.
        unsafe { *after = *states + slip };
    }
    (answer.threshold, answer.dthreshold_dnormal) = (-host.coefficient * point.normal, -host.coefficient);
    match host.kind {
        0 => {}
        1 => {
            let weak = 1.0 / (1.0 + slip);
            answer.threshold *= weak;
            answer.dthreshold_dnormal *= weak;
            let along = |s: f64| if slip > 0.0 { -answer.threshold * weak * s / slip } else { 0.0 };
            answer.dthreshold_dslip = point.slip.map(along);
        }
        2 => answer.threshold = f64::NAN,
        3 => answer.threshold = -1.0,
        4 => answer.dthreshold_dnormal = 1.0,
        _ => return 1,
    }
    0
}

fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|v| v.to_bits()).collect()
}

fn law(bytes: &mut Bytes) -> stickslip_law {
    // SAFETY: numbers alone.
    let mut law: stickslip_law = unsafe { std::mem::zeroed() };
    law.struct_size = size_of::<stickslip_law>() as u64;
    law.kind = bytes.choice(5);
    let own = |kind: i32, usual: f64| if law.kind == kind { usual } else { 0.0 };
    let usual = [
        own(STICKSLIP_LAW_COHESION, 0.1),
        own(STICKSLIP_LAW_WEAKENING, 0.1),
        own(STICKSLIP_LAW_WEAKENING, 0.01),
        own(STICKSLIP_LAW_ORTHOTROPIC, 0.2),
        own(STICKSLIP_LAW_ORTHOTROPIC, 1.0),
    ];
    law.cohesion = bytes.number(usual[0]);
    law.mu_after = bytes.number(usual[1]);
    law.critical_slip = bytes.number(usual[2]);
    law.mu_across = bytes.number(usual[3]);
    law.critical_rate = bytes.number(if law.kind == STICKSLIP_LAW_RATE { 0.1 } else { 0.0 });
    law.time = bytes.number(if law.kind == STICKSLIP_LAW_RATE { 0.1 } else { 0.0 });
    law.direction = [bytes.number(usual[4]), bytes.number(0.0), bytes.number(0.0)];
    law
}

/// A table of three points, wear and a bond; `table`: where its numbers are.
fn layer(bytes: &mut Bytes, table: &mut [f64; 6]) -> stickslip_layer {
    *table = [0.0, 1e-3, 2e-3, 0.0, 1.0, 4.0];
    shake(bytes, table);
    stickslip_layer {
        struct_size: size_of::<stickslip_layer>() as u64,
        n_overclosure: bytes.choice(4) as i64,
        overclosure: table.as_ptr(),
        pressure: table[3..].as_ptr(),
        wear: bytes.number(1e-3),
        bond_stiffness: bytes.number(100.0),
        bond_strength: bytes.number(1.0),
        bond_toughness: bytes.number(0.1),
        bond_shear: bytes.number(0.7),
    }
}

fn heat(bytes: &mut Bytes) -> stickslip_heat {
    stickslip_heat {
        struct_size: size_of::<stickslip_heat>() as u64,
        contact: bytes.number(3.0),
        pressure: bytes.number(1.0),
        exponent: bytes.number(0.95),
        constant: bytes.number(2.0),
        gas: bytes.number(0.1),
        gas_gap: bytes.number(0.01),
        reach: bytes.number(0.5),
        share: bytes.number(0.5),
        time: bytes.number(0.1),
    }
}

/// What the law remembers; none where it remembers nothing.
fn states(scene: &Scene) -> Vec<f64> {
    let mut count = 0;
    // SAFETY: no states are wanted; then as many as there are.
    assert!(succeeded(unsafe { stickslip_interface_law_states(scene.handle, 0, std::ptr::null_mut(), &mut count) }));
    let mut states = Watched::<f64>::new(count as usize);
    if count > 0 {
        assert!(succeeded(unsafe {
            stickslip_interface_law_states(scene.handle, count, states.pointer(), &mut count)
        }));
    }
    states.values().to_vec()
}

/// Heat and its tangent, which change nothing of the contact. What leaves one body enters the other.
fn passes(scene: &Scene, bytes: &mut Bytes) {
    let (heat, mut t1, mut t2) = (heat(bytes), vec![3.0; N1], vec![1.0; N2]);
    shake(bytes, &mut t1);
    shake(bytes, &mut t2);
    let before = scene.residual().map(|r| bits(&r));
    let mut out = [N1, N2, N1, N1, N1].map(Watched::<f64>::new);
    let [heat1, heat2, flux, friction, area] = &mut out;
    let nodes = stickslip_heat_nodes {
        struct_size: size_of::<stickslip_heat_nodes>() as u64,
        conductance: std::ptr::null_mut(),
        flux: flux.pointer(),
        jump: std::ptr::null_mut(),
        friction: friction.pointer(),
        area: area.pointer(),
    };
    let (h, x1, x2, lambda) = (scene.handle, scene.x1.as_ptr(), scene.x2.as_ptr(), scene.lambda.as_ptr());
    let (p1, p2, q1, q2) = (t1.as_ptr(), t2.as_ptr(), heat1.pointer(), heat2.pointer());
    // SAFETY: the arrays are as long as the handle's surfaces ask for; so below.
    if succeeded(unsafe { stickslip_interface_heat(h, x1, x2, lambda, &heat, p1, p2, q1, q2, &nodes) }) {
        out.iter().for_each(|o| all_finite(o.values()));
        let [heat1, heat2, flux, friction, area] = out.each_ref().map(|o| o.values());
        let made: f64 = friction.iter().sum();
        let all = heat1.iter().chain(heat2).sum::<f64>() + made;
        let passed: f64 = flux.iter().zip(area).map(|(f, a)| (f * a).abs()).sum::<f64>()
            + heat1.iter().chain(heat2).chain(friction).map(|q| q.abs()).sum::<f64>();
        assert!(scene.forged || !passed.is_finite() || all.abs() <= LOST * passed, "{all} of {passed} is lost");
    } else {
        out.iter().for_each(Watched::assert_untouched);
    }
    let (e1, e2): (Vec<i64>, Vec<i64>) = ((0..N1 as i64).collect(), (N1 as i64..(N1 + N2) as i64).collect());
    let (mut rows, mut columns, mut values) = (Watched::new(MOST), Watched::new(MOST), Watched::<f64>::new(MOST));
    let (e1, e2, r, c, v) = (e1.as_ptr(), e2.as_ptr(), rows.pointer(), columns.pointer(), values.pointer());
    let (which, most, mut count) = (bytes.choice(2), MOST as i64, 0);
    if succeeded(unsafe {
        stickslip_interface_heat_tangent_coo(h, x1, x2, lambda, &heat, p1, p2, e1, e2, which, most, r, c, v, &mut count)
    }) {
        all_finite(&values.values()[..count as usize]);
    }
    assert!(before == scene.residual().map(|r| bits(&r)), "heat has changed the contact");
}

/// Distances and scales are no less than 0, and weights of now do not slide.
fn equilibrium(scene: &Scene, bytes: &mut Bytes) {
    // SAFETY: numbers alone.
    let mut found: stickslip_equilibrium = unsafe { std::mem::zeroed() };
    found.struct_size = size_of::<stickslip_equilibrium>() as u64;
    (found.modulus, found.least_traction) = (bytes.number(1000.0), bytes.number(0.0));
    let (x1, x2, lambda) = (scene.x1.as_ptr(), scene.x2.as_ptr(), scene.lambda.as_ptr());
    if succeeded(unsafe { stickslip_interface_equilibrium(scene.handle, x1, x2, lambda, std::ptr::null(), &mut found) })
    {
        let values = [found.gap, found.traction, found.slip, found.slide];
        let scales = [found.gap_scale, found.traction_scale, found.slip_scale, found.slide_scale];
        assert!(values.iter().chain(&scales).all(|v| v.is_finite() && *v >= 0.0), "{values:?} {scales:?}");
        assert!(scene.weights != STICKSLIP_WEIGHTS_CURRENT || found.slide == 0.0, "{}", found.slide);
        assert_eq!(found.slide > 0.0, found.slide_node >= 0);
    }
}

/// Takes one input; panics where a law is broken.
pub fn run(data: &[u8]) {
    let mut bytes = Bytes(data);
    let what = bytes.below(3);
    let Some(mut scene) = Scene::with(&mut bytes, |bytes, options, method| match what {
        0 => {
            method.decision = STICKSLIP_DECISION_POINTS;
            options.friction = STICKSLIP_FRICTION_NONE;
            method.multiplier_basis = STICKSLIP_BASIS_DUAL;
            method.weights = 2 + bytes.choice(2);
            (options.mu, options.shear_limit, method.normals) = (0.0, 0.0, 0);
        }
        1 => {
            options.friction = STICKSLIP_FRICTION_COULOMB;
            (options.mu, options.shear_limit) = (bytes.number(0.3), 0.0);
        }
        _ => {}
    }) else {
        return;
    };
    let mut host = Box::new(Host { kind: bytes.below(6), coefficient: bytes.number(0.3), states: bytes.below(3) });
    let user: *mut Host = &mut *host;
    for _ in 0..8 {
        if bytes.is_empty() {
            break;
        }
        let h = scene.handle;
        match bytes.below(9) {
            8 => {
                let mut table = [0.0; 6];
                let layer = layer(&mut bytes, &mut table);
                let before = bits(&states(&scene));
                // SAFETY: the struct is whole, and no more points are asked for than there are.
                if !succeeded(unsafe { stickslip_interface_set_layer(h, &layer) }) {
                    assert!(before == bits(&states(&scene)), "a refused layer has changed the states");
                }
            }
            0 => {
                let law = law(&mut bytes);
                let before = bits(&states(&scene));
                // SAFETY: the struct is whole; so below.
                if !succeeded(unsafe { stickslip_interface_set_law(h, &law) }) {
                    assert!(before == bits(&states(&scene)), "a refused law has changed the states");
                }
            }
            1 => {
                // SAFETY: the host outlives the handle.
                let n = unsafe { (*user).states } as i64;
                succeeded(unsafe { stickslip_interface_set_threshold(h, Some(threshold), user.cast(), n) });
            }
            2 => {
                let mut own = states(&scene);
                if !own.is_empty() {
                    shake(&mut bytes, &mut own);
                }
                let n = bytes.count(own.len() as i64);
                succeeded(unsafe { stickslip_interface_set_law_states(h, n, own.as_ptr()) });
            }
            3 => passes(&scene, &mut bytes),
            4 => {
                let (mut one, mut two) = (vec![0.01; N1], vec![0.005; N2]);
                shake(&mut bytes, &mut one);
                shake(&mut bytes, &mut two);
                let (one, two) = (bytes.pointer(one.as_ptr()), bytes.pointer(two.as_ptr()));
                succeeded(unsafe { stickslip_interface_set_offsets(h, one, two) });
            }
            5 => equilibrium(&scene, &mut bytes),
            6 => derivatives(&scene, &mut bytes),
            _ => scene.call(&mut bytes),
        }
    }
    // SAFETY: it is a handle.
    assert!(succeeded(unsafe { stickslip_interface_destroy(&mut scene.handle) }));
    drop(host);
}
