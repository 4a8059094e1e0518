//! The C ABI: every function with arbitrary bytes for arguments. Pointers lead to as much as the header says, or are
//! NULL or crooked; structs, counts, choices and all contents are anything.

use super::{Bytes, Watched, all_finite, succeeded};
use std::ptr::null;
use stickslip::capi::*;

/// The longest struct that is read, in words, and one more.
const WORDS: usize = 4096 / 8 + 1;

/// A struct in as much room as its declared size may claim.
pub(super) struct Struct<T>(Box<[u64; WORDS]>, std::marker::PhantomData<T>);

impl<T: Copy> Struct<T> {
    pub(super) fn new(value: T) -> Struct<T> {
        let mut words = Box::new([0; WORDS]);
        // SAFETY: the ABI's structs are shorter and need no more than a word's alignment.
        unsafe { words.as_mut_ptr().cast::<T>().write(value) }
        Struct(words, std::marker::PhantomData)
    }

    pub(super) fn pointer(&mut self) -> *mut T {
        self.0.as_mut_ptr().cast()
    }

    /// Its size as declared: right, another word's, or anything.
    pub(super) fn declare(&mut self, bytes: &mut Bytes) {
        self.0[0] = bytes.integer(size_of::<T>() as i64) as u64;
        if bytes.once_in(8) {
            self.0[0] = 8 * u64::from(bytes.byte());
        }
        if bytes.once_in(8) {
            self.0[bytes.below(255)] = 1;
        }
    }
}

/// How many nodes a facet has.
fn nodes(bytes: &mut Bytes) -> i32 {
    match bytes.integer(4) as i32 {
        4 if bytes.once_in(4) => 8,
        4 if bytes.once_in(4) => 9,
        n => n,
    }
}

fn numbers(bytes: &mut Bytes, n: usize, usual: f64) -> Vec<f64> {
    (0..n).map(|_| if bytes.once_in(2) { bytes.coordinate() } else { bytes.number(usual) }).collect()
}

fn points(bytes: &mut Bytes, n: usize) -> Vec<f64> {
    let square = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0];
    let mut x: Vec<f64> = square.iter().copied().cycle().take(n).collect();
    for _ in 0..bytes.below(2 * n) {
        let k = bytes.below(n);
        x[k] = if bytes.once_in(8) { bytes.number(x[k]) } else { bytes.coordinate() };
    }
    x
}

/// Mid nodes and centre of the square of [`points`]: with them it is a quad8 or a quad9.
const MIDS: [f64; 15] = [0.5, 0.0, 0.0, 1.0, 0.5, 0.0, 0.5, 1.0, 0.0, 0.0, 0.5, 0.0, 0.5, 0.5, 0.0];

fn pair_calls(bytes: &mut Bytes) {
    let [x1, x2] = [0, 1].map(|_| [points(bytes, 12), MIDS.to_vec()].concat());
    let mut beyond = [0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.6, 0.8];
    if bytes.once_in(8) {
        beyond[bytes.below(12)] = bytes.number(1.0);
    }
    let mut pair = Struct::new(stickslip_pair {
        struct_size: 0,
        n1: nodes(bytes),
        n2: nodes(bytes),
        x1: bytes.pointer(x1.as_ptr()),
        x2: bytes.pointer(x2.as_ptr()),
        quadrature: bytes.choice(6),
        layout: bytes.choice(2),
        element_points: bytes.integer(0),
        neighbour_normals: if bytes.once_in(2) { bytes.pointer(beyond.as_ptr()) } else { null() },
        multiplier_space: i32::from(bytes.once_in(2)),
        model: STICKSLIP_MODEL_SOLID,
        thickness: 0.0,
    });
    pair.declare(bytes);
    let p = bytes.pointer(pair.pointer());
    let (ab, ac, dn) = (numbers(bytes, 16, 0.1), numbers(bytes, 16, 0.1), numbers(bytes, 16, 0.1));
    let many = |of: &[f64], n: usize| -> Vec<f64> { of.iter().copied().cycle().take(n).collect() };
    let (ab, ac, derivatives) = (many(&ab, 81), many(&ac, 81), many(&dn, 81 * 54));
    let traction = many(&numbers(bytes, 12, -1.0), 27);
    let mut out = [81, 81, 81 * 54, 81 * 54].map(Watched::<f64>::new);
    let [a, b, c, d] = &mut out;
    let [a, b, c, d] = [a, b, c, d].map(|o| bytes.output(o.pointer()));
    // SAFETY: by the head of this file; so below.
    let status = unsafe {
        match bytes.below(5) {
            0 => stickslip_pair_weights(p, a, b, c, d),
            4 => return state_calls(bytes, p, [&ab, &ac, &traction]),
            1 => stickslip_pair_gap(p, bytes.pointer(ab.as_ptr()), bytes.pointer(ac.as_ptr()), a),
            2 => stickslip_pair_residual(p, ab.as_ptr(), ac.as_ptr(), bytes.pointer(traction.as_ptr()), d),
            _ => {
                let mut response = Struct::new(std::mem::zeroed::<stickslip_node_response>());
                response.declare(bytes);
                let mut responses = vec![0u64; 10 * WORDS]; // nine, as far apart as the first one says
                let stride = (response.0[0] as usize / 8).min(WORDS);
                for k in 0..9 {
                    responses[k * stride..k * stride + stride.min(WORDS)].copy_from_slice(&response.0[..stride]);
                }
                let mut k = Watched::<f64>::new(81 * 81);
                let moving = [0, 1].map(|_| bytes.pointer(derivatives.as_ptr()));
                let [now, before] = [ab.as_ptr(), ac.as_ptr()].map(|n| bytes.pointer(n));
                let scale = bytes.pointer(traction.as_ptr());
                let ld = match bytes.integer(81) {
                    ld if ld > 81 => 81,
                    ld => ld,
                };
                let status = stickslip_pair_tangent(
                    p,
                    now,
                    now,
                    moving[0],
                    moving[1],
                    before,
                    before,
                    traction.as_ptr(),
                    bytes.pointer(responses.as_ptr().cast()),
                    scale,
                    k.pointer(),
                    ld,
                );
                if succeeded(status) {
                    let written = k.values().iter().filter(|v| !v.is_nan());
                    assert!(written.into_iter().all(|v| v.is_finite()));
                } else {
                    k.assert_untouched();
                }
                return;
            }
        }
    };
    if succeeded(status) {
        // What is not written keeps its pattern, a NaN of its own.
        let pattern = Watched::<f64>::new(1).values()[0].to_bits();
        let written = out.iter().flat_map(|o| o.values().iter()).filter(|v| v.to_bits() != pattern);
        written.for_each(|v| all_finite(&[*v]));
    } else {
        out.iter().for_each(Watched::assert_untouched);
    }
}

/// A pair's stages with a state.
fn state_calls(bytes: &mut Bytes, pair: *const stickslip_pair, [ab, ac, traction]: [&[f64]; 3]) {
    let mut state = Watched::<f64>::new(stickslip_pair_state_size() as usize);
    let mut out = [16, 16, 12, 24, 36 * 36].map(Watched::<f64>::new);
    let [a, b, g, force, k] = &mut out;
    let capacity = if bytes.once_in(8) { bytes.below(8) as i64 } else { stickslip_pair_state_size() };
    let (a, b, gap) = (bytes.output(a.pointer()), bytes.output(b.pointer()), bytes.output(g.pointer()));
    // SAFETY: by the head of this file; so below.
    let status = unsafe { stickslip_pair_begin(pair, capacity, state.pointer(), a, b, gap) };
    if !succeeded(status) {
        state.assert_untouched();
        return out.iter().for_each(Watched::assert_untouched);
    }
    let state = state.pointer();
    // SAFETY: a response is numbers alone.
    let mut responses: [stickslip_node_response; 4] = unsafe { std::mem::zeroed() };
    for response in &mut responses {
        response.struct_size = std::mem::size_of::<stickslip_node_response>() as u64;
        response.drow_dnow.copy_from_slice(&ab[..9]);
        response.drow_dprevious.copy_from_slice(&ac[..9]);
    }
    let [old_ab, old_ac] = [ab, ac].map(|n| bytes.pointer(n.as_ptr()));
    let (t, scale) = (traction.as_ptr(), bytes.pointer(traction.as_ptr()));
    // SAFETY: as above.
    unsafe {
        succeeded(stickslip_pair_state_gap(state, old_ab, old_ac, g.pointer()));
        succeeded(stickslip_pair_state_residual(state, t, force.pointer()));
        let tangent =
            stickslip_pair_state_tangent(state, old_ab, old_ac, t, responses.as_ptr(), scale, k.pointer(), 36);
        if !succeeded(tangent) {
            k.assert_untouched();
        }
    }
}

fn node_calls(bytes: &mut Bytes) {
    // SAFETY: numbers alone.
    let mut node: stickslip_node = unsafe { std::mem::zeroed() };
    node.lambda = [bytes.number(0.1), bytes.number(0.0), bytes.number(-1.0)];
    node.normal = [bytes.number(0.0), bytes.number(0.0), bytes.number(1.0)];
    node.augmentation = bytes.number(3.0);
    node.mu = bytes.number(0.5);
    node.coverage = bytes.number(1.0);
    node.coverage_previous = bytes.number(1.0);
    node.slip = bytes.choice(3);
    node.n_directions = bytes.choice(3);
    for v in node.gap_now.iter_mut().chain(&mut node.gap_previous).chain(&mut node.gap_committed) {
        *v = bytes.number(0.01);
    }
    for v in &mut node.directions {
        *v = bytes.number(0.0);
    }
    node.directions[0] = bytes.number(1.0);
    // Mostly a sum of which the normal is.
    let sum = node.normal.map(|v| if bytes.once_in(8) { bytes.number(-v) } else { -2.0 * v });
    let mut node = Struct::new(node);
    node.declare(bytes);
    let mut turn = [(); 3].map(|()| Watched::<f64>::new(9));
    let status = unsafe {
        let [a, b, c] = &mut turn;
        let [a, b, c] = [a, b, c].map(|o| bytes.output(o.pointer()));
        stickslip_node_turn(bytes.pointer(node.pointer()), bytes.pointer(sum.as_ptr()), bytes.choice(2), a, b, c)
    };
    succeeded(status);
    for out in &turn {
        let pattern = Watched::<f64>::new(1).values()[0].to_bits();
        let written = out.values().iter().filter(|v| v.to_bits() != pattern);
        written.for_each(|v| all_finite(&[*v]));
        if status != 0 {
            out.assert_untouched();
        }
    }
    // SAFETY: as above.
    let mut response = Struct::new(unsafe { std::mem::zeroed::<stickslip_node_response>() });
    response.declare(bytes);
    response.0[1..].fill(0x5eed_5eed);
    let before = *response.0;
    let status = unsafe { stickslip_node_respond(bytes.pointer(node.pointer()), bytes.output(response.pointer())) };
    let size = (response.0[0] as usize).div_ceil(8).min(WORDS);
    assert_eq!(before[0], response.0[0], "the size is the caller's");
    if !succeeded(status) {
        assert!(before == *response.0, "a refused call has written");
        return;
    }
    assert!(before[size..] == response.0[size..], "written beyond the struct");
    let (mut row, mut block) = (Watched::<f64>::new(3), Watched::<f64>::new(9));
    let (scale, layout) = (bytes.number(1.0), bytes.choice(2));
    let (r, b) = (bytes.output(row.pointer()), bytes.output(block.pointer()));
    if !succeeded(unsafe { stickslip_node_block(response.pointer(), scale, layout, r, b) }) {
        row.assert_untouched();
        block.assert_untouched();
    }
}

fn facet_calls(bytes: &mut Bytes) {
    let x = points(bytes, 12);
    let (mut normals, mut areas, mut normal) =
        (Watched::<f64>::new(12), Watched::<f64>::new(4), Watched::<f64>::new(3));
    let n = bytes.integer(4) as i32;
    let status = unsafe {
        let (normals, areas) = (bytes.output(normals.pointer()), bytes.output(areas.pointer()));
        stickslip_facet_geometry(n, bytes.pointer(x.as_ptr()), normals, areas)
    };
    if !succeeded(status) {
        normals.assert_untouched();
        areas.assert_untouched();
    }
    normals.values();
    areas.values();
    let sum = numbers(bytes, 3, 1.0);
    if succeeded(unsafe { stickslip_node_normal(bytes.pointer(sum.as_ptr()), normal.pointer()) }) {
        let length = normal.values().iter().map(|v| v * v).sum::<f64>();
        assert!((length - 1.0).abs() < 1e-14, "{length}");
    } else {
        normal.assert_untouched();
    }
    let mut derivatives = Watched::<f64>::new(144);
    let status = unsafe {
        let (n, x) = (bytes.integer(4) as i32, bytes.pointer(x.as_ptr()));
        stickslip_facet_normal_derivatives(n, x, bytes.output(derivatives.pointer()))
    };
    if succeeded(status) {
        all_finite(&derivatives.values()[..81]);
    } else {
        derivatives.assert_untouched();
    }
    dual_calls(bytes);
}

/// A facet with up to two pairs.
fn dual_calls(bytes: &mut Bytes) {
    let (x1, x2, mass) = (points(bytes, 12), points(bytes, 24), numbers(bytes, 16, 0.1));
    let (ab, ac, traction) = (numbers(bytes, 32, 0.1), numbers(bytes, 32, 0.1), numbers(bytes, 12, -1.0));
    let n2 = [bytes.integer(4) as i32, bytes.integer(4) as i32];
    let mut facet = Struct::new(stickslip_facet {
        struct_size: 0,
        n1: bytes.integer(4) as i32,
        quadrature: bytes.choice(6),
        layout: bytes.choice(2),
        reserved: bytes.choice(2),
        n_pairs: bytes.count(1).min(2),
        x1: bytes.pointer(x1.as_ptr()),
        n2: bytes.pointer(n2.as_ptr()),
        x2: bytes.pointer(x2.as_ptr()),
        element_points: bytes.integer(0),
        neighbour_normals: null(),
    });
    facet.declare(bytes);
    let (mut fade, mut areas) = (Watched::<f64>::new(1), Watched::<f64>::new(4));
    let (mut turn, mut k) = (Watched::<f64>::new(16), Watched::<f64>::new(48 * 48));
    let n = bytes.integer(4) as i32;
    // SAFETY: by the head of this file; so below.
    let status = unsafe {
        let (fade, areas) = (bytes.output(fade.pointer()), bytes.output(areas.pointer()));
        let (x1, mass) = (bytes.pointer(x1.as_ptr()), bytes.pointer(mass.as_ptr()));
        stickslip_facet_dual(n, x1, mass, fade, areas, bytes.output(turn.pointer()))
    };
    let pattern = Watched::<f64>::new(1).values()[0].to_bits();
    let written = |o: &mut Watched<f64>| o.values().iter().all(|v| v.is_finite() || v.to_bits() == pattern);
    for out in [&mut fade, &mut areas, &mut turn] {
        if succeeded(status) { assert!(written(out)) } else { out.assert_untouched() }
    }
    let response = stickslip_node_response {
        struct_size: size_of::<stickslip_node_response>() as u64,
        drow_dnow: [1.0, 0.5, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
        // SAFETY: numbers only.
        ..unsafe { std::mem::zeroed() }
    };
    let responses = [response; 4];
    let status = unsafe {
        let (f, ab, ac) = (bytes.pointer(facet.pointer()), bytes.pointer(ab.as_ptr()), bytes.pointer(ac.as_ptr()));
        let (t, ld) = (bytes.pointer(traction.as_ptr()), bytes.integer(48).min(48));
        stickslip_facet_tangent(f, ab, ac, ab, ac, t, responses.as_ptr(), null(), k.pointer(), ld)
    };
    if succeeded(status) { assert!(written(&mut k)) } else { k.assert_untouched() }
}

/// A surface with up to so many facets and nodes.
const FACETS: usize = 6;
const NODES: usize = 12;

struct Arrays {
    coordinates: Vec<f64>,
    offsets: Vec<i64>,
    nodes: Vec<i64>,
    equations: Vec<i64>,
    multipliers: Vec<i64>,
    owned: Vec<i32>,
}

impl Arrays {
    fn new(bytes: &mut Bytes, base: i64, up: bool) -> Arrays {
        let ends: Vec<i64> = (0..=FACETS as i64).map(|k| 4 * k).collect();
        // A strip of two rows of nodes.
        let strip = |k: usize| {
            let a = k.min(NODES / 2 - 2);
            let q = [a, a + 1, a + 1 + NODES / 2, a + NODES / 2];
            if up { q } else { [q[0], q[3], q[2], q[1]] }
        };
        let node = |k: usize| strip(k / 4)[k % 4] as i64 + base;
        let place = |k: usize| [(k / 3 % (NODES / 2)) as f64, (k / 3 / (NODES / 2)) as f64, 0.0][k % 3];
        let mut arrays = Arrays {
            coordinates: (0..3 * NODES).map(place).collect(),
            offsets: ends,
            nodes: (0..4 * FACETS).map(node).collect(),
            equations: (0..3 * NODES as i64).map(|k| k + base).collect(),
            multipliers: (0..3 * NODES as i64).map(|k| 100 + k + base).collect(),
            owned: vec![1; NODES],
        };
        for _ in 0..bytes.below(4) {
            let k = bytes.below(255);
            match bytes.below(8) {
                0 => arrays.offsets[k % (FACETS + 1)] = bytes.integer(4),
                1 => arrays.nodes[k % (4 * FACETS)] = bytes.integer(2),
                2 => arrays.equations[k % (3 * NODES)] = bytes.integer(-1),
                3 => arrays.multipliers[k % (3 * NODES)] = bytes.integer(-1),
                4 => arrays.owned[k % NODES] = bytes.integer(0) as i32,
                5 => arrays.coordinates[k % (3 * NODES)] = bytes.number(0.5),
                _ => arrays.coordinates[k % (3 * NODES)] = bytes.coordinate(),
            }
        }
        arrays
    }

    fn surface(&self, bytes: &mut Bytes, multipliers: bool) -> Struct<stickslip_surface> {
        let facets = if bytes.once_in(8) { bytes.count(FACETS as i64) } else { (NODES / 2 - 1) as i64 };
        let nodes = if bytes.once_in(8) { bytes.count(NODES as i64) } else { NODES as i64 };
        let optional = |bytes: &mut Bytes, p: *const i64| if multipliers { bytes.pointer(p) } else { null() };
        let mut surface = Struct::new(stickslip_surface {
            struct_size: 0,
            n_nodes: nodes,
            n_facets: facets,
            coordinates: bytes.pointer(self.coordinates.as_ptr()),
            facet_offsets: bytes.pointer(self.offsets.as_ptr()),
            facet_nodes: bytes.pointer(self.nodes.as_ptr()),
            equations: bytes.pointer(self.equations.as_ptr()),
            multiplier_equations: optional(bytes, self.multipliers.as_ptr()),
            owned: if multipliers && bytes.once_in(4) { self.owned.as_ptr() } else { null() },
        });
        surface.declare(bytes);
        surface
    }
}

fn options(bytes: &mut Bytes, base: i64) -> (Struct<stickslip_options>, Box<stickslip_method>) {
    // SAFETY: numbers alone.
    let mut options = Struct::new(unsafe { std::mem::zeroed::<stickslip_options>() });
    let size = bytes.integer(size_of::<stickslip_options>() as i64) as u64;
    if !succeeded(unsafe { stickslip_options_init(bytes.output(options.pointer()), size) }) {
        assert!(options.0.iter().all(|w| *w == 0));
    }
    // SAFETY: as above, in its own room.
    let o = unsafe { &mut *options.pointer() };
    o.index_base = base as i32;
    o.modulus = bytes.number(1000.0);
    o.friction = bytes.choice(4);
    let mut m = Box::new(unsafe { std::mem::zeroed::<stickslip_method>() });
    m.struct_size = size_of::<stickslip_method>() as u64;
    m.form = bytes.choice(2);
    m.weights = bytes.choice(4);
    for _ in 0..bytes.below(4) {
        match bytes.below(13) {
            0 => m.slip = bytes.choice(3),
            1 => o.mortar_side = bytes.choice(3),
            2 => m.multiplier_basis = bytes.choice(3),
            3 => m.quadrature = bytes.choice(6),
            4 => m.row_scale = bytes.choice(2),
            5 => m.new_contact = bytes.choice(2),
            6 => o.index_base = bytes.choice(2),
            7 => o.mu = bytes.number(0.3),
            8 => m.augmentation = bytes.number(1.0),
            9 => m.coverage_min = bytes.number(1e-4),
            10 => m.no_shortcuts = bytes.choice(16),
            11 => (m.normals, m.threads) = (bytes.choice(3), bytes.choice(4)),
            _ => (o.shape, o.radius) = (bytes.choice(4), bytes.number(1.0)),
        }
    }
    o.method = if bytes.once_in(4) { null() } else { &raw const *m };
    options.declare(bytes);
    (options, m)
}

fn create_calls(bytes: &mut Bytes) {
    let base = bytes.below(2) as i64;
    let (a1, a2) = (Arrays::new(bytes, base, false), Arrays::new(bytes, base, true));
    let (mut one, mut two) = (a1.surface(bytes, true), a2.surface(bytes, false));
    let (mut options, _method) = options(bytes, base);
    let mut handle = std::ptr::dangling_mut::<stickslip_interface>();
    let [p, q] = [one.pointer(), two.pointer()].map(|p| bytes.pointer(p));
    let status = unsafe { stickslip_interface_create(p, q, bytes.pointer(options.pointer()), &mut handle) };
    if !succeeded(status) {
        assert!(handle.is_null() || handle == std::ptr::dangling_mut(), "a handle from a refused call");
        return;
    }
    // As large as any of these surfaces needs.
    let mut out = [3 * NODES, 3 * NODES, 3 * NODES].map(Watched::<f64>::new);
    let [f, g, r] = &mut out;
    let (f, g, r) = (bytes.output(f.pointer()), bytes.output(g.pointer()), bytes.output(r.pointer()));
    let (x1, x2, lambda) = (&a1.coordinates, &a2.coordinates, numbers(bytes, 3 * NODES, -1.0));
    let status = unsafe {
        let [x1, x2, lambda] = [x1, x2, &lambda].map(|v| bytes.pointer(v.as_ptr()));
        stickslip_interface_residual(handle, x1, x2, lambda, null(), f, g, r)
    };
    if !succeeded(status) {
        out.iter().for_each(Watched::assert_untouched);
    }
    for o in &out {
        o.values();
    }
    // Triplets into too little room, into a matrix with anything for a pattern.
    let (mut rows, mut columns, mut values) = (Watched::new(64), Watched::new(64), Watched::<f64>::new(64));
    let (x1, x2, lambda, mut count) = (x1.as_ptr(), x2.as_ptr(), lambda.as_ptr(), 0);
    let capacity = bytes.count(64).min(64);
    let status = unsafe {
        let (i, j, v) = (rows.pointer(), columns.pointer(), values.pointer());
        stickslip_interface_tangent_coo(handle, x1, x2, lambda, null(), capacity, i, j, v, &mut count)
    };
    if !succeeded(status) {
        rows.assert_untouched();
        columns.assert_untouched();
        if status != STICKSLIP_NOT_FINITE {
            values.assert_untouched(); // they mean nothing where one overflows
        }
    }
    rows.values();
    columns.values();
    values.values();
    let n = 3 * NODES as i64;
    let mut offsets: Vec<i64> = (0..=n).map(|k| k.min(60) + base).collect();
    let mut columns: Vec<i64> = (0..64).map(|k| k + base).collect();
    for _ in 0..bytes.below(3) {
        columns[bytes.below(64)] = bytes.integer(3);
        let k = bytes.below(offsets.len());
        offsets[k] = bytes.integer(offsets[k]).min(60);
    }
    let mut values = Watched::<f64>::new(64);
    let status = unsafe {
        let (o, c, n) = (offsets.as_ptr(), columns.as_ptr(), bytes.count(n));
        stickslip_interface_tangent_csr(handle, x1, x2, lambda, null(), n, o, c, values.pointer())
    };
    if !succeeded(status) {
        values.assert_untouched();
    }
    values.values();
    let (mut text, capacity) = (Watched::<i8>::new(80), bytes.count(80).min(80));
    succeeded(unsafe { stickslip_interface_effects(handle, bytes.text(text.pointer()).cast(), capacity) });
    text.values();
    // SAFETY: numbers alone.
    let mut counters = Struct::new(unsafe { std::mem::zeroed::<stickslip_counters>() });
    counters.declare(bytes);
    succeeded(unsafe { stickslip_interface_counters(handle, bytes.output(counters.pointer())) });
    let mut states = Struct::new(unsafe { std::mem::zeroed::<stickslip_states>() });
    let (mut state, mut gap) = (Watched::<i32>::new(NODES), Watched::<f64>::new(NODES));
    // SAFETY: in its own room.
    unsafe { ((*states.pointer()).state, (*states.pointer()).gap) = (state.pointer(), bytes.output(gap.pointer())) };
    states.0[0] = bytes.integer(size_of::<stickslip_states>() as i64) as u64;
    if !succeeded(unsafe { stickslip_interface_states(handle, x1, x2, lambda, null(), states.pointer()) }) {
        state.assert_untouched();
    }
    state.values();
    gap.values();
    plan_calls(bytes, handle, [x1, x2, lambda]);
    assert!(succeeded(unsafe { stickslip_interface_destroy(&mut handle) }) && handle.is_null());
    assert!(succeeded(unsafe { stickslip_interface_destroy(&mut handle) }), "once more does nothing");
}

/// Any plan, its entries and values into too little room.
fn plan_calls(bytes: &mut Bytes, handle: *mut stickslip_interface, [x1, x2, lambda]: [*const f64; 3]) {
    let (mut n, mut counts) = (Watched::new(2), Watched::new(2));
    let (pairs, to, count) = (bytes.choice(3), bytes.output(n.pointer()), bytes.output(counts.pointer()));
    let status = unsafe {
        if bytes.once_in(4) {
            stickslip_interface_condensed_plan(handle, x1, x2, pairs, to, count)
        } else {
            stickslip_interface_plan(handle, x1, x2, pairs, to, count)
        }
    };
    if !succeeded(status) {
        n.assert_untouched();
        counts.assert_untouched();
    }
    let (mut rows, mut offsets, mut columns) = (Watched::<i32>::new(400), Watched::new(400), Watched::new(400));
    let (entries, capacity) = (bytes.choice(3), bytes.count(400).min(400));
    let (r, o, c) = (rows.pointer(), offsets.pointer(), bytes.output(columns.pointer()));
    if !succeeded(unsafe { stickslip_interface_plan_csr32(handle, entries, capacity, r, o, c) }) {
        rows.assert_untouched();
        offsets.assert_untouched();
        columns.assert_untouched();
    }
    let mut values = Watched::<f64>::new(400);
    let v = bytes.output(values.pointer());
    let status = unsafe { stickslip_interface_plan_values(handle, x1, x2, lambda, null(), capacity, v) };
    if !succeeded(status) && ![STICKSLIP_NOT_FINITE, STICKSLIP_MISSING_ENTRY].contains(&status) {
        values.assert_untouched();
    }
    rows.values();
    offsets.values();
    columns.values();
    values.values();
}

fn preparation_calls(bytes: &mut Bytes) {
    let base = bytes.below(2) as i64;
    let arrays = Arrays::new(bytes, base, true);
    let mut surface = arrays.surface(bytes, false);
    let (mut nodes, mut originals, mut count) = (Watched::new(4 * FACETS), Watched::new(4 * FACETS), 0);
    let status = unsafe {
        let (angle, capacity) = (bytes.number(0.5), bytes.count(4 * FACETS as i64).min(4 * FACETS as i64));
        let (f, o) = (bytes.output(nodes.pointer()), bytes.output(originals.pointer()));
        let p = bytes.pointer(surface.pointer());
        stickslip_surface_split_creases(p, angle, bytes.choice(2), capacity, f, o, &mut count)
    };
    if !succeeded(status) {
        nodes.assert_untouched();
        originals.assert_untouched();
    }
    nodes.values();
    originals.values();
    // Two interfaces with up to eight nodes a side.
    let ends = |bytes: &mut Bytes| [0, 4, 8].map(|k| bytes.integer(k).min(8));
    let names = |bytes: &mut Bytes| (0..8).map(|k| bytes.integer(k % 5)).collect::<Vec<i64>>();
    let (o1, n1, o2, n2) = (ends(bytes), names(bytes), ends(bytes), names(bytes));
    let (mut found, mut kinds, mut claims) = (Watched::new(16), Watched::<i32>::new(16), Watched::new(16));
    let status = unsafe {
        let (f, k, c) = (found.pointer(), bytes.output(kinds.pointer()), bytes.output(claims.pointer()));
        let (n, capacity) = (bytes.count(2).min(2), bytes.count(16).min(16));
        let [o1, n1, o2, n2] = [o1.as_ptr(), n1.as_ptr(), o2.as_ptr(), n2.as_ptr()].map(|p| bytes.pointer(p));
        stickslip_crosspoints_find(n, o1, n1, o2, n2, capacity, f, k, c, &mut count)
    };
    if !succeeded(status) {
        found.assert_untouched();
        kinds.assert_untouched();
        claims.assert_untouched();
    }
    found.values();
    kinds.values();
    claims.values();
    let (mut text, length) = (Watched::<i8>::new(40), bytes.count(40).min(40));
    unsafe { stickslip_last_error_padded(bytes.text(text.pointer()).cast(), length) };
    text.values();
    stickslip_status_string(bytes.integer(0) as i32);
}

/// Takes one input; panics where a law is broken.
pub fn run(data: &[u8]) {
    let mut bytes = Bytes(data);
    while !bytes.is_empty() {
        match bytes.below(8) {
            0 | 1 => pair_calls(&mut bytes),
            2 => node_calls(&mut bytes),
            3 => facet_calls(&mut bytes),
            4 => preparation_calls(&mut bytes),
            _ => create_calls(&mut bytes),
        }
    }
    // Of the same bytes, which are read from the beginning: kept inputs go on meaning what they did.
    super::lines::calls(&mut Bytes(data));
}
