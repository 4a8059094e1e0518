//! What the C ABI adds to a kernel: its cheapest calls, and what each call pays for a floating-point environment of its own.

use super::{Kernel, Pair, over_pairs};
use std::mem::{size_of, zeroed};
use stickslip::capi::*;

/// The very file that the ABI's entries use.
#[path = "../src/capi/fp_environment.rs"]
mod fp_environment;

/// Calls with the data of a pair each.
pub fn kernels(pairs: &[Pair]) -> [Kernel; 4] {
    [
        over_pairs("C: environment saved, set, given back", 0.0, pairs, |_| {
            let _environment = fp_environment::FpEnvironment::enter();
            0.0
        }),
        over_pairs("C: node_normal, the cheapest call", 0.0, pairs, node_normal),
        over_pairs("C: node_respond", 0.0, pairs, node_respond),
        over_pairs("C: pair_weights", 0.0, pairs, pair_weights),
    ]
}

fn node_normal(pair: &Pair) -> f64 {
    let mut normal = [0.0; 3];
    // SAFETY: three numbers each.
    unsafe { stickslip_node_normal(pair.one.nodes[1].as_ptr(), normal.as_mut_ptr()) };
    normal[0]
}

fn node_respond(pair: &Pair) -> f64 {
    // SAFETY: numbers only.
    let (mut node, mut response): (stickslip_node, stickslip_node_response) = unsafe { (zeroed(), zeroed()) };
    node.struct_size = size_of::<stickslip_node>() as u64;
    response.struct_size = size_of::<stickslip_node_response>() as u64;
    node.lambda = [0.1, 0.2, -1.0];
    node.normal = [0.0, 0.0, 1.0];
    node.gap_now = (pair.one.nodes[1] * 0.01).into();
    (node.augmentation, node.mu, node.coverage, node.coverage_previous) = (3.0, 0.3, 1.0, 1.0);
    // SAFETY: both are as the ABI's documentation says.
    unsafe { stickslip_node_respond(&node, &mut response) };
    response.row[0]
}

fn pair_weights(pair: &Pair) -> f64 {
    let coordinates = |f: &stickslip::geometry::Facet| f.points().as_ptr().cast::<f64>();
    let (mut ab, mut ac) = ([0.0; 16], [0.0; 16]);
    let raw = stickslip_pair {
        struct_size: size_of::<stickslip_pair>() as u64,
        n1: pair.one.len() as i32,
        n2: pair.two.len() as i32,
        x1: coordinates(&pair.one),
        x2: coordinates(&pair.two),
        quadrature: STICKSLIP_QUADRATURE_DEGREE_5,
        layout: STICKSLIP_LAYOUT_ROW_MAJOR,
        element_points: 0,
        neighbour_normals: std::ptr::null(),
        multiplier_space: 0,
        model: STICKSLIP_MODEL_SOLID,
        thickness: 0.0,
    };
    let null = std::ptr::null_mut();
    // SAFETY: points are three numbers each, one after the other; the outputs hold 16.
    unsafe { stickslip_pair_weights(&raw, ab.as_mut_ptr(), ac.as_mut_ptr(), null, null) };
    ab[1]
}
