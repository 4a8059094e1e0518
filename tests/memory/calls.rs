//! The element calls allocate nothing: pairs, nodes and facets, through the C ABI and in Rust. A host may
//! call them from any thread in its innermost loop.

use crate::allocator::ALLOCATIONS;
use std::mem::{size_of, zeroed};
use std::ptr::null;
use stickslip::capi::*;
use stickslip::element::{FacetResponse, NodeTangent, PairNow, PairTangent, pair_force, row_columns};
use stickslip::geometry::{Facet, Mat3, Vec3};
use stickslip::law::{Friction, Node, SlipMeasure, Special};
use stickslip::mortar::{self, AlongNormal, NonmortarFrame, PairWeights, Segment, WeightDerivatives, pair_motion};
use stickslip::quadrature::{DEGREE_5, DEGREE_10};

/// Asserts that the second call of `work` allocates nothing; the first one may set up what lasts (the ABI's
/// panic hook).
fn allocates_nothing<T>(what: &str, mut work: impl FnMut() -> T) {
    let warm = work();
    let before = ALLOCATIONS.get();
    let result = work();
    let count = ALLOCATIONS.get() - before;
    assert_eq!(count, 0, "{what} allocates {count} times");
    drop((warm, result));
}

const QUAD1: [f64; 12] = [0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0, 0.0, 0.0];
/// Distorted and warped.
const QUAD2: [f64; 12] = [0.3, -0.4, -0.02, 1.4, 0.1, 0.01, 1.1, 1.2, 0.04, 0.0, 0.7, 0.01];

/// Quads and triangles, near and apart: (nodes of the first facet, of the second, shift of the second).
const KINDS: [(usize, usize, f64); 5] = [(4, 4, 0.0), (4, 3, 0.0), (3, 4, 0.0), (3, 3, 0.0), (4, 4, 9.0)];

#[test]
fn the_counter_counts() {
    let before = ALLOCATIONS.get();
    drop(std::hint::black_box(vec![1.0; 10]));
    assert!(ALLOCATIONS.get() > before);
}

#[test]
fn heat_of_a_node_allocates_nothing() {
    let heat = stickslip_heat {
        struct_size: size_of::<stickslip_heat>() as u64,
        contact: 2.0,
        pressure: 0.5,
        exponent: 0.95,
        constant: 0.3,
        gas: 0.1,
        gas_gap: 0.2,
        reach: 1.0,
        share: 0.5,
        time: 0.1,
    };
    let (mut sides, mut slopes, mut h) = ([0.0; 2], [0.0; 2 * STICKSLIP_HEAT_SLOPES as usize], 0.0);
    allocates_nothing("stickslip_node_heat", || {
        // SAFETY: all arrays are as long as the header says.
        let status = unsafe {
            stickslip_node_heat(&heat, 1.0, 0.4, 0.01, 0.5, 0.2, sides.as_mut_ptr(), slopes.as_mut_ptr(), &mut h)
        };
        assert_eq!(status, 0);
    });
}

#[test]
fn calls_of_a_rigid_body_allocate_nothing() {
    let (x, point, forces) = ([1.0, 2.0, 3.0], [0.0; 3], [1.0, -2.0, 0.5]);
    let (nodes, equations, rows, columns) = ([10, 11, 12], [0, 1, 2, 3, 4, 5], [10, 7], [7, 12]);
    let body = stickslip_rigid_body {
        struct_size: size_of::<stickslip_rigid_body>() as u64,
        dimension: 3,
        reserved: 0,
        n_nodes: 1,
        coordinates: x.as_ptr(),
        point: point.as_ptr(),
        node_equations: nodes.as_ptr(),
        equations: equations.as_ptr(),
    };
    let mut motion = stickslip_rigid_motion {
        struct_size: size_of::<stickslip_rigid_motion>() as u64,
        displacement: [0.1; 3],
        rotation: [0.2; 3],
        turned: [0.0; 9],
        arms: 0,
        reserved: 0,
    };
    let (mut rigid, mut count) = (std::ptr::null_mut(), 0);
    let (mut now, mut resultant, mut places) = ([0.0; 3], [0.0; 6], [[0; 64]; 2]);
    // SAFETY: all arrays are as long as the header says.
    unsafe {
        allocates_nothing("stickslip_rigid_positions", || {
            assert_eq!(stickslip_rigid_positions(&body, &motion, now.as_mut_ptr()), 0);
        });
        allocates_nothing("stickslip_rigid_resultant", || {
            assert_eq!(stickslip_rigid_resultant(&body, &motion, forces.as_ptr(), resultant.as_mut_ptr()), 0);
        });
        allocates_nothing("stickslip_rigid_turn", || assert_eq!(stickslip_rigid_turn(&mut motion), 0));
        let (rows, columns) = (rows.as_ptr(), columns.as_ptr());
        assert_eq!(stickslip_rigid_create(1, &body, 0, 2, rows, columns, &mut rigid, &mut count), 0);
        allocates_nothing("stickslip_rigid_coo", || {
            let [rows, columns] = &mut places;
            assert_eq!(stickslip_rigid_coo(rigid, 64, rows.as_mut_ptr(), columns.as_mut_ptr()), 0);
        });
        assert_eq!(stickslip_rigid_destroy(&mut rigid), 0);
    }
}

#[test]
fn c_element_calls_allocate_nothing() {
    for (n1, n2, shift) in KINDS {
        let x2 = QUAD2.map(|x| x + shift);
        for quadrature in [STICKSLIP_QUADRATURE_DEGREE_5, STICKSLIP_QUADRATURE_DEGREE_10] {
            let pair = stickslip_pair {
                struct_size: size_of::<stickslip_pair>() as u64,
                n1: n1 as i32,
                n2: n2 as i32,
                x1: QUAD1.as_ptr(),
                x2: x2.as_ptr(),
                quadrature,
                layout: STICKSLIP_LAYOUT_COLUMN_MAJOR,
                element_points: 0,
                neighbour_normals: std::ptr::null(),
                multiplier_space: 0,
                model: STICKSLIP_MODEL_SOLID,
                thickness: 0.0,
            };
            c_calls(&pair);
        }
    }
}

#[test]
fn c_calls_with_lines_allocate_nothing() {
    let (x1, x2) = ([1.0, 0.0, 2.0, 0.0, 1.5, 0.1], [2.2, 0.0, 1.2, 0.1, 1.7, 0.0]);
    for (n1, n2, model) in [(2, 2, STICKSLIP_MODEL_PLANE), (3, 3, STICKSLIP_MODEL_AXISYMMETRIC)] {
        let pair = stickslip_pair {
            struct_size: size_of::<stickslip_pair>() as u64,
            n1,
            n2,
            x1: x1.as_ptr(),
            x2: x2.as_ptr(),
            model,
            multiplier_space: STICKSLIP_SPACE_SUB,
            // SAFETY: numbers and pointers, of which NULL is one that is not given.
            ..unsafe { zeroed() }
        };
        let (mut ab, mut ac, mut dab, mut dac) = ([0.0; 9], [0.0; 9], [0.0; 108], [0.0; 108]);
        let (mut gap, mut force, mut tangent) = ([0.0; 6], [0.0; 12], [0.0; 18 * 18]);
        let (traction, size) = ([-1.0; 6], 2 * i64::from(2 * n1 + n2));
        let response = stickslip_node_response {
            struct_size: size_of::<stickslip_node_response>() as u64,
            // SAFETY: numbers only.
            ..unsafe { zeroed() }
        };
        let responses = [response; 3];
        let (a, b, c, d) = (ab.as_mut_ptr(), ac.as_mut_ptr(), dab.as_mut_ptr(), dac.as_mut_ptr());
        let (t, r, k) = (traction.as_ptr(), responses.as_ptr(), tangent.as_mut_ptr());
        // SAFETY: arrays as long as two line3 need.
        unsafe {
            allocates_nothing("pair_weights", || assert_eq!(stickslip_pair_weights(&pair, a, b, c, d), 0));
            allocates_nothing("pair_gap", || assert_eq!(stickslip_pair_gap(&pair, a, b, gap.as_mut_ptr()), 0));
            allocates_nothing("pair_residual", || {
                assert_eq!(stickslip_pair_residual(&pair, a, b, t, force.as_mut_ptr()), 0);
            });
            allocates_nothing("pair_tangent", || {
                assert_eq!(stickslip_pair_tangent(&pair, a, b, c, d, null(), null(), t, r, null(), k, size), 0);
            });
        }
    }
}

fn c_calls(pair: &stickslip_pair) {
    let (mut ab, mut ac, mut dab, mut dac) = ([0.0; 16], [0.0; 16], [0.0; 384], [0.0; 384]);
    let (mut gap, mut force, mut tangent) = ([0.0; 12], [0.0; 24], [0.0; 36 * 36]);
    let (mut normals, mut areas, mut nu) = ([0.0; 12], [0.0; 4], [0.0; 3]);
    let (mut row, mut block) = ([0.0; 3], [0.0; 9]);
    let (traction, scale) = ([-1.0; 12], [2.0; 4]);
    // SAFETY: numbers only.
    let (mut node, mut response): (stickslip_node, stickslip_node_response) = unsafe { (zeroed(), zeroed()) };
    node.struct_size = size_of::<stickslip_node>() as u64;
    response.struct_size = size_of::<stickslip_node_response>() as u64;
    node.normal = [0.0, 0.0, 1.0];
    (node.augmentation, node.mu, node.coverage, node.coverage_previous) = (3.0, 0.5, 1.0, 1.0);
    node.lambda = [0.1, 0.2, -1.0];

    // SAFETY: all arrays are as long as two quadrilaterals need.
    unsafe {
        allocates_nothing("pair_weights", || {
            assert_eq!(
                stickslip_pair_weights(pair, ab.as_mut_ptr(), ac.as_mut_ptr(), dab.as_mut_ptr(), dac.as_mut_ptr()),
                0
            );
        });
        allocates_nothing("pair_gap", || {
            assert_eq!(stickslip_pair_gap(pair, ab.as_ptr(), ac.as_ptr(), gap.as_mut_ptr()), 0);
        });
        allocates_nothing("node_respond", || assert_eq!(stickslip_node_respond(&node, &mut response), 0));
        allocates_nothing("node_equilibrium", || {
            let [g, t, s] = gap.first_chunk_mut::<3>().unwrap().each_mut().map(std::ptr::from_mut);
            assert_eq!(stickslip_node_equilibrium(&node, 1.0, 0.0, g, t, s), 0);
        });
        allocates_nothing("node_block", || {
            assert_eq!(stickslip_node_block(&response, 1.0, 0, row.as_mut_ptr(), block.as_mut_ptr()), 0);
        });
        allocates_nothing("node_condense", || {
            let (w, s) = (block.as_mut_ptr(), &raw mut gap[0]);
            assert_eq!(stickslip_node_condense(&node, &response, 0, w, row.as_mut_ptr(), s), 0);
        });
        allocates_nothing("pair_residual", || {
            let status = stickslip_pair_residual(pair, ab.as_ptr(), ac.as_ptr(), traction.as_ptr(), force.as_mut_ptr());
            assert_eq!(status, 0);
        });
        let responses = [response; 4];
        for previous in [ab.as_ptr(), null()] {
            let previous_ac = if previous.is_null() { null() } else { ac.as_ptr() };
            allocates_nothing("pair_tangent", || {
                let status = stickslip_pair_tangent(
                    pair,
                    ab.as_ptr(),
                    ac.as_ptr(),
                    dab.as_ptr(),
                    dac.as_ptr(),
                    previous,
                    previous_ac,
                    traction.as_ptr(),
                    responses.as_ptr(),
                    scale.as_ptr(),
                    tangent.as_mut_ptr(),
                    36,
                );
                assert_eq!(status, 0);
            });
        }
        let mut state = [0.0; 512];
        allocates_nothing("pair_begin", || {
            let (ab, ac, capacity) = (dab.as_mut_ptr(), dac.as_mut_ptr(), state.len() as i64);
            assert!(stickslip_pair_state_size() <= capacity);
            assert_eq!(stickslip_pair_begin(pair, capacity, state.as_mut_ptr(), ab, ac, gap.as_mut_ptr()), 0);
        });
        allocates_nothing("pair_state_gap", || {
            assert_eq!(stickslip_pair_state_gap(state.as_ptr(), ab.as_ptr(), ac.as_ptr(), gap.as_mut_ptr()), 0);
        });
        allocates_nothing("pair_state_residual", || {
            assert_eq!(stickslip_pair_state_residual(state.as_ptr(), traction.as_ptr(), force.as_mut_ptr()), 0);
        });
        allocates_nothing("pair_state_tangent", || {
            let (state, t, responses) = (state.as_ptr(), traction.as_ptr(), responses.as_ptr());
            let (scale, k) = (scale.as_ptr(), tangent.as_mut_ptr());
            let status = stickslip_pair_state_tangent(state, ab.as_ptr(), ac.as_ptr(), t, responses, scale, k, 36);
            assert_eq!(status, 0);
        });
        let mass = ab;
        allocates_nothing("stickslip_facet_dual", || {
            let (fade, areas) = (row.as_mut_ptr(), areas.as_mut_ptr());
            assert_eq!(stickslip_facet_dual(pair.n1, pair.x1, mass.as_ptr(), fade, areas, dab.as_mut_ptr()), 0);
        });
        allocates_nothing("stickslip_pair_dual", || {
            let (ab, ac) = (ab.as_ptr(), ac.as_ptr());
            assert_eq!(stickslip_pair_dual(pair, mass.as_ptr(), ab, ac, dab.as_mut_ptr(), dac.as_mut_ptr()), 0);
        });
        let facet = stickslip_facet {
            struct_size: size_of::<stickslip_facet>() as u64,
            n1: pair.n1,
            quadrature: pair.quadrature,
            layout: pair.layout,
            reserved: 0,
            n_pairs: 1,
            x1: pair.x1,
            n2: &pair.n2,
            x2: pair.x2,
            element_points: 0,
            neighbour_normals: null(),
        };
        allocates_nothing("stickslip_facet_tangent", || {
            let (ab, ac, t) = (ab.as_ptr(), ac.as_ptr(), traction.as_ptr());
            let (responses, scale, k) = (responses.as_ptr(), scale.as_ptr(), tangent.as_mut_ptr());
            assert_eq!(stickslip_facet_tangent(&facet, ab, ac, ab, ac, t, responses, scale, k, 36), 0);
        });
        allocates_nothing("facet_geometry", || {
            assert_eq!(stickslip_facet_geometry(pair.n1, pair.x1, normals.as_mut_ptr(), areas.as_mut_ptr()), 0);
        });
        allocates_nothing("facet_normal", || {
            assert_eq!(stickslip_facet_normal(pair.n1, pair.x1, nu.as_mut_ptr()), 0);
        });
        allocates_nothing("node_normal", || {
            assert_eq!(stickslip_node_normal(normals.as_ptr(), nu.as_mut_ptr()), 0);
        });
        allocates_nothing("facet_normal_derivatives", || {
            assert_eq!(stickslip_facet_normal_derivatives(pair.n1, pair.x1, dab.as_mut_ptr()), 0);
        });
        allocates_nothing("node_turn", || {
            let ([dnu, dp], sum) = ([&mut dab, &mut dac].map(|m| m.as_mut_ptr()), [0.0, 0.0, -2.0]);
            assert_eq!(stickslip_node_turn(&node, sum.as_ptr(), 0, dnu, dp, block.as_mut_ptr()), 0);
        });
        allocates_nothing("texts", || {
            (stickslip_version(), stickslip_build(), stickslip_status_string(3), stickslip_last_error_message())
        });
    }
}

#[test]
fn rust_element_calls_allocate_nothing() {
    let point = |v: &[f64]| Vec3::from_column_slice(v);
    for (n1, n2, shift) in KINDS {
        let one: Vec<_> = QUAD1.chunks_exact(3).map(point).take(n1).collect();
        let two: Vec<_> = QUAD2.chunks_exact(3).map(|v| point(v).add_scalar(shift)).take(n2).collect();
        for rule in [&DEGREE_5, &DEGREE_10] {
            allocates_nothing("a pair in Rust", || {
                let (one, two) = (Facet::new(&one).unwrap(), Facet::new(&two).unwrap());
                let frame = NonmortarFrame::new(&one).unwrap();
                let Some(segment) = Segment::new(&frame, &two).unwrap() else { return 0.0 };
                let weights = PairWeights::integrate(&frame, &segment, rule);
                let (_, derivatives) = WeightDerivatives::integrate(&frame, &segment, rule);
                let gap = AlongNormal::from_weights(&frame, &segment.mortar, &weights, &derivatives);
                let nodes = FacetResponse::<3>::new([&NodeTangent::default(); 4]);
                let mut t = PairTangent::default();
                let motion = pair_motion((&frame, &segment, rule), &weights, &nodes.traction, &mut t.forces);
                for gap in [gap, motion] {
                    let now = PairNow { weights: &weights, gap: Some(&gap) };
                    row_columns::<3>((Some(&now), Some(&weights)), &nodes, &mut t.rows);
                }
                let g = mortar::gap(&weights, &one, &two);
                pair_force(&weights, &g)[0].x + t.row_x(0, 0)[(0, 0)]
            });
        }
    }
    let node = Node {
        lambda: Vec3::new(0.1, 0.2, -1.0),
        normal: Vec3::z(),
        augmentation: 3.0,
        mu: 0.5,
        shear_limit: f64::INFINITY,
        gap_now: Vec3::zeros(),
        gap_previous: Vec3::x(),
        gap_committed: Vec3::zeros(),
        covered: true,
        covered_before: true,
        slip: SlipMeasure::Objective,
        free: Mat3::identity(),
        special: Special::Nothing,
    };
    allocates_nothing("a node in Rust", || Friction::Coulomb.respond(&node).row.x);
}
