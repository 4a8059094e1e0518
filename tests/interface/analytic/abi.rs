//! The analytic mortar side through the C ABI: the same numbers as the core, and every wrong input refused by name.
#![allow(unsafe_code)]

use std::ffi::CStr;
use std::mem::{size_of, zeroed};
use std::ptr::{null, null_mut};
use stickslip::capi::*;
use stickslip::geometry::{AnalyticShape, Vec3};
use stickslip::interface::{Interface, Options, Stiffness, Surface};

/// A facet with its normal down, tilted, over what touches the plane z = 0 from below.
const X1: [f64; 12] = [0.0, 0.0, 0.01, 0.0, 1.0, 0.0, 1.0, 1.0, -0.02, 1.0, 0.0, -0.01];
const LAMBDA: [f64; 12] = [0.1, 0.0, -1.0, 0.2, 0.1, -0.8, 0.0, 0.3, -0.5, -0.1, 0.0, -0.9];
const SHAPES: [(i32, f64, AnalyticShape); 5] = [
    (STICKSLIP_SHAPE_PLANE, 0.0, AnalyticShape::Plane),
    (STICKSLIP_SHAPE_SPHERE, 3.0, AnalyticShape::Sphere(3.0)),
    (STICKSLIP_SHAPE_SPHERE, -4.0, AnalyticShape::Sphere(-4.0)),
    (STICKSLIP_SHAPE_CYLINDER, 2.0, AnalyticShape::Cylinder(2.0)),
    (STICKSLIP_SHAPE_CYLINDER, -5.0, AnalyticShape::Cylinder(-5.0)),
];

/// The frame's points: edges x, y, z, the first of them z, or x where it is an axis.
fn frame(shape: i32, radius: f64) -> [f64; 12] {
    let z = -radius;
    let turned = if shape == STICKSLIP_SHAPE_CYLINDER { [1, 2, 0] } else { [2, 0, 1] };
    let mut x = [0.5, 0.5, z].repeat(4);
    for (k, i) in turned.into_iter().enumerate() {
        x[3 * (k + 1) + i] += 1.0;
    }
    x.try_into().unwrap()
}

/// All that a creation needs; members may be spoilt before it.
struct Input {
    x2: [f64; 12],
    equations2: [i64; 12],
    one: stickslip_surface,
    two: stickslip_surface,
    options: stickslip_options,
    method: stickslip_method,
}

const OFFSETS: [i64; 2] = [0, 4];
const NODES: [i64; 4] = [0, 1, 2, 3];
const U: [i64; 12] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11];
const L: [i64; 12] = [12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23];

impl Input {
    fn new(shape: i32, radius: f64) -> Box<Input> {
        // SAFETY: numbers and pointers only.
        let mut input: Box<Input> = unsafe { Box::new(zeroed()) };
        (input.x2, input.equations2) = (frame(shape, radius), [-1; 12]);
        let size = size_of::<stickslip_surface>() as u64;
        input.one = stickslip_surface {
            struct_size: size,
            n_nodes: 4,
            n_facets: 1,
            coordinates: X1.as_ptr(),
            facet_offsets: OFFSETS.as_ptr(),
            facet_nodes: NODES.as_ptr(),
            equations: U.as_ptr(),
            multiplier_equations: L.as_ptr(),
            owned: null(),
        };
        input.two.struct_size = size;
        input.two.n_nodes = 4;
        input.two.coordinates = input.x2.as_ptr();
        // SAFETY: a struct of its size.
        assert_eq!(unsafe { stickslip_options_init(&mut input.options, size_of::<stickslip_options>() as u64) }, 0);
        // SAFETY: as before.
        assert_eq!(unsafe { stickslip_options_paper(&mut input.options) }, 0);
        // SAFETY: the library's.
        input.method = stickslip_method { augmentation: 15.0, ..unsafe { *input.options.method } };
        input.options.method = &raw const input.method;
        input.options.mu = 0.3;
        (input.options.mortar_side, input.options.shape, input.options.radius) =
            (STICKSLIP_MORTAR_ANALYTIC, shape, radius);
        input
    }

    fn create(&self) -> Result<*mut stickslip_interface, (i32, String)> {
        let mut out = null_mut();
        // SAFETY: all pointers are to live arrays of the lengths stated.
        let status = unsafe { stickslip_interface_create(&self.one, &self.two, &self.options, &mut out) };
        if status == 0 { Ok(out) } else { Err((status, message())) }
    }
}

fn message() -> String {
    // SAFETY: zero-terminated, valid until the next call.
    unsafe { CStr::from_ptr(stickslip_last_error_message()) }.to_string_lossy().into_owned()
}

/// Status, forces and rows.
fn residual(handle: *mut stickslip_interface, x2: &[f64; 12]) -> (i32, [[f64; 12]; 3]) {
    let mut r = [[0.0; 12]; 3];
    let [f1, f2, rows] = &mut r;
    let outputs = [f1, f2, rows].map(|v| v.as_mut_ptr());
    // SAFETY: arrays of 3 times 4 nodes.
    let status = unsafe {
        let (x1, x2, l) = (X1.as_ptr(), x2.as_ptr(), LAMBDA.as_ptr());
        stickslip_interface_residual(handle, x1, x2, l, null(), outputs[0], outputs[1], outputs[2])
    };
    (status, r)
}

#[test]
fn same_numbers_as_the_core() {
    let points = |v: &[f64]| v.chunks_exact(3).map(Vec3::from_column_slice).collect::<Vec<_>>();
    for (number, radius, shape) in SHAPES {
        let mut input = Input::new(number, radius);
        for given in [false, true] {
            input.two.equations = if given { input.equations2.as_ptr() } else { null() };
            let mut handle = input.create().unwrap();
            let (status, c) = residual(handle, &input.x2);
            assert_eq!(status, 0);
            let equations = |first: i64| (0..4).map(|k| [0, 1, 2].map(|i| first + 3 * k + i)).collect::<Vec<_>>();
            let one = Surface::new("nonmortar", points(&X1), &[NODES.to_vec()], equations(0)).unwrap();
            let two = Surface::analytic("mortar", shape, points(&input.x2)).unwrap();
            let mut options = Options::paper(Stiffness::Augmentation(15.0));
            options.mu = 0.3;
            let mut core = Interface::new(one, two, equations(12), options).unwrap();
            let r = core.residual(&points(&X1), &points(&input.x2), &points(&LAMBDA), None).unwrap();
            for (c, core) in c.iter().zip([r.nonmortar, r.mortar, r.rows]) {
                assert_eq!(points(c), core);
                assert!(core.iter().any(|v| v.norm() > 0.0));
            }
            // SAFETY: created above, destroyed once.
            assert_eq!(unsafe { stickslip_interface_destroy(&mut handle) }, 0);
        }
    }
}

/// Moving the surface means moving its frame, and only as a rigid body.
#[test]
fn the_frame_moves_the_surface() {
    let input = Input::new(STICKSLIP_SHAPE_PLANE, 0.0);
    let mut handle = input.create().unwrap();
    let (raised, mut bent) = (std::array::from_fn(|i| input.x2[i] + f64::from(u8::from(i % 3 == 2))), input.x2);
    let (at_rest, moved) = (residual(handle, &input.x2).1, residual(handle, &raised).1);
    assert!(moved[2][2] < at_rest[2][2] - 1.0, "the row of a node that is a unit deeper: {}", moved[2][2]);
    bent[9] += 1e-3;
    assert_eq!(residual(handle, &bent).0, STICKSLIP_INVALID_VALUE);
    assert!(message().contains("mortar: ") && message().contains("rigid body"), "{}", message());
    // SAFETY: created above, destroyed once.
    assert_eq!(unsafe { stickslip_interface_destroy(&mut handle) }, 0);
}

#[test]
fn wrong_inputs_are_refused_by_name() {
    type Spoil = fn(&mut Input);
    let refusals: [(Spoil, i32, &str); 16] = [
        (|i| i.options.shape = 3, STICKSLIP_INVALID_VALUE, "options.shape is 3"),
        (|i| i.options.shape = -1, STICKSLIP_INVALID_VALUE, "options.shape is -1"),
        (|i| i.options.radius = 0.0, STICKSLIP_INVALID_VALUE, "options.radius is 0"),
        (|i| i.options.radius = f64::NAN, STICKSLIP_NOT_FINITE, "options.radius"),
        (|i| i.options.shape = STICKSLIP_SHAPE_PLANE, STICKSLIP_INVALID_VALUE, "options.radius is 3"),
        (|i| i.options.mortar_side = STICKSLIP_MORTAR_RIGID, STICKSLIP_INVALID_VALUE, "options.shape is 1"),
        (
            |i| (i.options.mortar_side, i.options.shape) = (STICKSLIP_MORTAR_DEFORMABLE, 0),
            STICKSLIP_INVALID_VALUE,
            "options.radius 3",
        ),
        (|i| i.options.mortar_side = 3, STICKSLIP_INVALID_VALUE, "options.mortar_side is 3"),
        (|i| i.two.n_nodes = 3, STICKSLIP_INVALID_SIZE, "n_nodes = 3"),
        (|i| i.two.n_facets = 1, STICKSLIP_INVALID_SIZE, "n_facets = 1"),
        (|i| i.two.facet_nodes = NODES.as_ptr(), STICKSLIP_INVALID_VALUE, "mortar.facet_nodes"),
        (|i| i.two.facet_offsets = OFFSETS.as_ptr(), STICKSLIP_INVALID_VALUE, "mortar.facet_offsets"),
        (|i| i.two.coordinates = null(), STICKSLIP_NULL_POINTER, "mortar.coordinates"),
        (|i| i.x2[4] = f64::INFINITY, STICKSLIP_NOT_FINITE, "mortar.coordinates[4]"),
        (|i| i.x2.copy_within(6..9, 9), STICKSLIP_INVALID_VALUE, "mortar: the frame has no volume"),
        (|i| i.two.multiplier_equations = L.as_ptr(), STICKSLIP_INVALID_VALUE, "mortar.multiplier_equations"),
    ];
    for (spoil, kind, words) in refusals {
        let mut input = Input::new(STICKSLIP_SHAPE_SPHERE, 3.0);
        spoil(&mut input);
        let (status, text) = input.create().expect_err(words);
        assert!(status == kind && text.contains(words), "{words}: {status}, {text}");
    }
}
