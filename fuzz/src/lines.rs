//! The C ABI: the functions of pairs with lines, as `abi.rs` has them with facets of solids.

use super::abi::Struct;
use super::{Bytes, Watched, succeeded};
use stickslip::capi::*;

/// Most nodes of a line.
const NODES: usize = 3;
/// Unknowns of a pair of them and its multipliers.
const UNKNOWNS: usize = 6 * NODES;
/// The same of facets of solids: a pair may be one of those by the size that its caller declares, which ends before the model.
const MOST_NODES: usize = 9;
const MOST_UNKNOWNS: usize = 9 * MOST_NODES;

/// A line, ends and middle, of which anything may be spoilt; and room behind.
fn points(bytes: &mut Bytes, usual: [f64; 2 * NODES]) -> [f64; 3 * MOST_NODES] {
    let mut x = [0.5; 3 * MOST_NODES];
    x[..2 * NODES].copy_from_slice(&usual);
    for _ in 0..bytes.below(2 * NODES) {
        let k = bytes.below(2 * NODES);
        x[k] = if bytes.once_in(8) { bytes.number(x[k]) } else { bytes.coordinate() };
    }
    x
}

fn many(bytes: &mut Bytes, n: usize, usual: f64) -> Vec<f64> {
    let some: Vec<f64> = (0..8).map(|_| bytes.number(usual)).collect();
    some.into_iter().cycle().take(n).collect()
}

/// All four functions of one pair.
pub fn calls(bytes: &mut Bytes) {
    let x1 = points(bytes, [1.0, 0.0, 2.0, 0.0, 1.5, 0.0]);
    let x2 = points(bytes, [2.25, -0.125, 1.25, 0.0, 1.75, 0.0]);
    let nodes = |bytes: &mut Bytes| {
        let usual = if bytes.once_in(2) { 3 } else { 2 };
        bytes.integer(usual) as i32
    };
    let model = 1 + i32::from(bytes.once_in(2));
    let mut pair = Struct::new(stickslip_pair {
        struct_size: 0,
        n1: nodes(bytes),
        n2: nodes(bytes),
        x1: bytes.pointer(x1.as_ptr()),
        x2: bytes.pointer(x2.as_ptr()),
        quadrature: bytes.choice(6),
        layout: bytes.choice(2),
        element_points: 0,
        neighbour_normals: std::ptr::null(),
        multiplier_space: bytes.choice(2),
        model: if bytes.once_in(16) { bytes.choice(3) } else { model },
        thickness: if model == STICKSLIP_MODEL_PLANE && bytes.once_in(2) { bytes.number(0.5) } else { 0.0 },
    });
    pair.declare(bytes);
    let p = bytes.pointer(pair.pointer());
    let [of, d_of] = [MOST_NODES * MOST_NODES, 6 * MOST_NODES * MOST_NODES * MOST_NODES];
    let (ab, ac, dn) = (many(bytes, of, 0.1), many(bytes, of, 0.1), many(bytes, d_of, 0.5));
    let (t, scale) = (many(bytes, 3 * MOST_NODES, -1.0), many(bytes, MOST_NODES, 2.0));
    let mut responses = [stickslip_node_response {
        struct_size: size_of::<stickslip_node_response>() as u64,
        // SAFETY: numbers only.
        ..unsafe { std::mem::zeroed() }
    }; MOST_NODES];
    responses.iter_mut().for_each(|response| response.drow_dnow.copy_from_slice(&dn[..9]));
    let vectors = 3 * MOST_NODES;
    let mut out = [of, of, d_of, d_of, vectors, 2 * vectors, MOST_UNKNOWNS * MOST_UNKNOWNS].map(Watched::<f64>::new);
    let [a, b, c, d, gap, force, k] = out.each_mut().map(Watched::pointer);
    let (ld, [n_ab, n_ac, dn]) = (
        bytes.integer(2 * UNKNOWNS as i64).min(MOST_UNKNOWNS as i64),
        [&ab, &ac, &dn].map(|n| bytes.pointer(n.as_ptr())),
    );
    // SAFETY: pointers lead to as much as the header says of any pair, or are NULL or crooked.
    let fine = unsafe {
        let tangent = || {
            let (t, responses, scale) = (t.as_ptr(), responses.as_ptr(), scale.as_ptr());
            stickslip_pair_tangent(p, n_ab, n_ac, dn, dn, n_ab, n_ac, t, responses, scale, k, ld)
        };
        [
            succeeded(stickslip_pair_weights(p, a, b, bytes.output(c), bytes.output(d))),
            succeeded(stickslip_pair_gap(p, n_ab, n_ac, gap)),
            succeeded(stickslip_pair_residual(p, n_ab, n_ac, t.as_ptr(), force)),
            succeeded(tangent()),
        ]
    };
    let pattern = Watched::<f64>::new(1).values()[0].to_bits();
    for (fine, written) in fine.into_iter().zip([0..4, 4..5, 5..6, 6..7]) {
        for out in &out[written] {
            match fine {
                true => assert!(out.values().iter().all(|v| v.is_finite() || v.to_bits() == pattern)),
                false => out.assert_untouched(),
            }
        }
    }
}
