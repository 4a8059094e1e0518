//! An interface by its C functions: any sequence of calls, with positions, multipliers, histories that are mostly sound.
//! The handle answers or refuses, its history moves by commits alone, equal points give equal bits, and after a refusal
//! it is as good as before.

use super::meshes::{Facets, KINDS, N1, N2, grid, mortar, nonmortar, row};
use super::{Bytes, Watched, all_finite, message, succeeded};
use stickslip::capi::*;
use stickslip::interface::seal_history;

/// More than the entries of any tangent of this size.
const MOST: usize = 100_000;

pub(super) struct Scene {
    pub(super) handle: *mut stickslip_interface,
    /// STICKSLIP_WEIGHTS_...
    pub(super) weights: i32,
    /// A history was accepted that nothing has committed: its weights may be any.
    pub(super) forged: bool,
    /// Numbers a node of every vector: 3, of lines 2.
    dimension: usize,
    /// Multiplier components a node.
    components: usize,
    /// Nodes at which facets have multipliers.
    counted: usize,
    pub(super) x1: Vec<f64>,
    pub(super) x2: Vec<f64>,
    pub(super) lambda: Vec<f64>,
}

/// Moves a few coordinates.
pub(super) fn shake(bytes: &mut Bytes, x: &mut [f64]) {
    for _ in 0..bytes.below(4) {
        let k = bytes.below(x.len());
        x[k] = if bytes.once_in(4) { bytes.number(x[k]) } else { x[k] + bytes.coordinate() / 64.0 };
    }
}

impl Scene {
    /// A scene of any options, which are then changed.
    pub(super) fn with(
        bytes: &mut Bytes,
        change: impl FnOnce(&mut Bytes, &mut stickslip_options, &mut stickslip_method),
    ) -> Option<Scene> {
        let (mut x1, mut x2) = (grid(3, 0.0, 2.0, -0.01), grid(4, -0.5, 3.0, 0.0));
        if bytes.once_in(2) {
            shake(bytes, &mut x1);
            shake(bytes, &mut x2);
        }
        // SAFETY: numbers alone; then as large as it says.
        let mut options: stickslip_options = unsafe { std::mem::zeroed() };
        assert!(succeeded(unsafe { stickslip_options_init(&mut options, size_of::<stickslip_options>() as u64) }));
        let mut method: stickslip_method = unsafe { std::mem::zeroed() };
        method.struct_size = size_of::<stickslip_method>() as u64;
        method.form = bytes.choice(2);
        method.slip = bytes.choice(3);
        method.weights = bytes.choice(5);
        options.friction = bytes.choice(5);
        options.mortar_side = bytes.choice(2);
        method.quadrature = bytes.choice(6);
        method.row_scale = bytes.choice(2);
        method.new_contact = bytes.choice(2);
        method.no_shortcuts = bytes.choice(16);
        let limited = options.friction == STICKSLIP_FRICTION_TRESCA;
        options.mu = bytes.number(if limited || options.friction == STICKSLIP_FRICTION_COULOMB { 0.3 } else { 0.0 });
        options.shear_limit = if limited { bytes.number(0.5) } else { 0.0 };
        options.modulus = bytes.number(1000.0);
        method.augmentation = if options.modulus == 0.0 { bytes.number(15.0) } else { 0.0 };
        method.multiplier_basis = bytes.choice(3);
        method.normals = if method.weights <= STICKSLIP_WEIGHTS_CURRENT { bytes.choice(3) } else { bytes.choice(2) };
        method.coverage_min = bytes.number(1e-8);
        options.search_distance = bytes.number(0.0);
        method.multiplier_space = bytes.choice(2);
        change(bytes, &mut options, &mut method);
        options.method = &raw const method;
        let kind = bytes.below(KINDS);
        let dimension = if kind < 3 { 3 } else { 2 };
        if dimension == 2 {
            (x1, x2) = (row(N1, 0.0, 2.0, -0.01), row(N2, 0.0, 3.0, 0.0));
            options.model = if kind == 3 { STICKSLIP_MODEL_PLANE } else { bytes.choice(3) };
            options.thickness = bytes.number(if options.model == STICKSLIP_MODEL_PLANE { 0.5 } else { 0.0 });
            if bytes.once_in(2) {
                shake(bytes, &mut x1);
                shake(bytes, &mut x2);
            }
        }
        if options.model == STICKSLIP_MODEL_SOLID && dimension == 2 {
            return None; // arrays of two numbers a node where three are read
        }
        let components = if options.friction == STICKSLIP_FRICTION_NONE { 1 } else { dimension };
        let ((f1, corners), f2) = (nonmortar(kind), mortar(kind));
        let numbers = |first: usize, n: usize| (first as i64..(first + n) as i64).collect::<Vec<_>>();
        let (e1, mut e2) = (numbers(0, dimension * N1), numbers(dimension * N1, dimension * N2));
        let mut e3 = numbers(dimension * (N1 + N2), components * N1);
        if bytes.once_in(3) {
            e2.fill(-1);
        }
        for _ in 0..bytes.below(3) {
            let k = bytes.below(e3.len());
            e3[k] = -1;
        }
        let counted = if method.multiplier_space == STICKSLIP_SPACE_CORNER { corners.len() } else { N1 };
        // Multipliers at the corners alone; now and then at all nodes, which is refused.
        if method.multiplier_space == STICKSLIP_SPACE_CORNER && !bytes.once_in(8) {
            for a in (0..N1).filter(|a| !corners.contains(a)) {
                e3[components * a..components * (a + 1)].fill(-1);
            }
        }
        let surface = |x: &[f64], facets: &Facets, equations: &[i64], multipliers: Option<&[i64]>| stickslip_surface {
            struct_size: size_of::<stickslip_surface>() as u64,
            n_nodes: (x.len() / dimension) as i64,
            n_facets: facets.offsets.len() as i64 - 1,
            coordinates: x.as_ptr(),
            facet_offsets: facets.offsets.as_ptr(),
            facet_nodes: facets.nodes.as_ptr(),
            equations: equations.as_ptr(),
            multiplier_equations: multipliers.map_or(std::ptr::null(), <[i64]>::as_ptr),
            owned: std::ptr::null(),
        };
        let (one, two) = (surface(&x1, &f1, &e1, Some(&e3)), surface(&x2, &f2, &e2, None));
        let mut handle = std::ptr::null_mut();
        // SAFETY: the arrays are as long as the surfaces say.
        let status = unsafe { stickslip_interface_create(&one, &two, &options, &mut handle) };
        assert_eq!(succeeded(status), !handle.is_null());
        let lambda = (0..components * N1).map(|k| if (k + 1) % components == 0 { -1.0 } else { 0.1 }).collect();
        (!handle.is_null()).then_some(Scene {
            handle,
            weights: method.weights,
            forged: false,
            dimension,
            components,
            counted,
            x1,
            x2,
            lambda,
        })
    }

    pub(super) fn residual(&self) -> Option<Vec<f64>> {
        let mut out = [self.dimension * N1, self.dimension * N2, self.components * N1].map(Watched::<f64>::new);
        let [f1, f2, rows] = &mut out;
        let (f1, f2, rows) = (f1.pointer(), f2.pointer(), rows.pointer());
        let (x1, x2, lambda) = (self.x1.as_ptr(), self.x2.as_ptr(), self.lambda.as_ptr());
        // SAFETY: the arrays are as long as the handle's surfaces ask for; so below.
        let status =
            unsafe { stickslip_interface_residual(self.handle, x1, x2, lambda, std::ptr::null(), f1, f2, rows) };
        if !succeeded(status) {
            out.iter().for_each(Watched::assert_untouched);
            return None;
        }
        let values: Vec<f64> = out.iter().flat_map(|o| o.values().to_vec()).collect();
        all_finite(&values);
        Some(values)
    }

    fn tangent(&self) -> Option<Vec<(i64, i64, u64)>> {
        let (mut rows, mut columns, mut values) = (Watched::new(MOST), Watched::new(MOST), Watched::new(MOST));
        let (r, c, v) = (rows.pointer(), columns.pointer(), values.pointer());
        let (x1, x2, lambda, mut count) = (self.x1.as_ptr(), self.x2.as_ptr(), self.lambda.as_ptr(), 0);
        let no_sums = std::ptr::null();
        let status = unsafe {
            stickslip_interface_tangent_coo(self.handle, x1, x2, lambda, no_sums, MOST as i64, r, c, v, &mut count)
        };
        if !succeeded(status) {
            rows.assert_untouched();
            if status != STICKSLIP_NOT_FINITE {
                values.assert_untouched(); // they mean nothing where one overflows
            }
            return None;
        }
        let n = count as usize;
        all_finite(&values.values()[..n]);
        let entry = |k: usize| (rows.values()[k], columns.values()[k], values.values()[k].to_bits());
        Some((0..n).map(entry).collect())
    }

    /// The same by a plan.
    fn tangent_by_plan(&self) -> Option<Vec<(i64, i64, u64)>> {
        let (x1, x2, lambda) = (self.x1.as_ptr(), self.x2.as_ptr(), self.lambda.as_ptr());
        let (h, mut n, mut count) = (self.handle, 0, 0);
        if !succeeded(unsafe { stickslip_interface_plan(h, x1, x2, STICKSLIP_PLAN_ACTIVE, &mut n, &mut count) }) {
            return None;
        }
        assert!(n <= count);
        let m = count as usize;
        let (mut rows, mut columns, mut values) = (Watched::new(m), Watched::new(m), Watched::new(m));
        let (r, c, v) = (rows.pointer(), columns.pointer(), values.pointer());
        assert!(succeeded(unsafe { stickslip_interface_plan_coo(h, STICKSLIP_ENTRIES_TANGENT, count, r, c) }));
        if !succeeded(unsafe { stickslip_interface_plan_values(h, x1, x2, lambda, std::ptr::null(), count, v) }) {
            return None;
        }
        all_finite(values.values());
        let entry = |k: usize| (rows.values()[k], columns.values()[k], values.values()[k].to_bits());
        Some((0..m).map(entry).collect())
    }

    /// The system without multipliers, where there are dual ones: residual and elimination, with the multipliers that
    /// balance some forces.
    fn condensed(&self) -> Option<Vec<u64>> {
        let host: Vec<f64> = self.x1.iter().map(|x| 0.1 * x).collect();
        let mut out = [self.components * N1, self.dimension * N1, self.dimension * N2].map(Watched::<f64>::new);
        let [lambda, rows1, force2] = &mut out;
        let (lambda, rows1, force2) = (lambda.pointer(), rows1.pointer(), force2.pointer());
        let (x1, x2, host) = (self.x1.as_ptr(), self.x2.as_ptr(), host.as_ptr());
        let status = unsafe { stickslip_interface_condensed_multipliers(self.handle, x1, x2, host, lambda) };
        if !succeeded(status) {
            out.iter().for_each(Watched::assert_untouched);
            return None;
        }
        let status =
            unsafe { stickslip_interface_condensed_residual(self.handle, x1, x2, lambda, host, rows1, force2) };
        if !succeeded(status) {
            out[1..].iter().for_each(Watched::assert_untouched);
            return None;
        }
        let (mut rows, mut columns, mut values) = (Watched::new(MOST), Watched::new(MOST), Watched::new(MOST));
        let (r, c, v) = (rows.pointer(), columns.pointer(), values.pointer());
        let (piece, most, mut count) = (STICKSLIP_CONDENSED_ELIMINATION, MOST as i64, 0);
        let status =
            unsafe { stickslip_interface_condensed_coo(self.handle, x1, x2, lambda, piece, most, r, c, v, &mut count) };
        if !succeeded(status) {
            rows.assert_untouched();
            values.assert_untouched();
            return None;
        }
        let mut all: Vec<f64> = out.iter().flat_map(|o| o.values().to_vec()).collect();
        all.extend(&values.values()[..count as usize]);
        all_finite(&all);
        Some(all.into_iter().map(f64::to_bits).collect())
    }

    fn history(&self) -> Option<(Vec<i64>, Vec<u64>)> {
        let (mut n, mut m) = (0, 0);
        if !succeeded(unsafe { stickslip_interface_history_size(self.handle, &mut n, &mut m) }) {
            return None;
        }
        let (mut integers, mut reals) = (Watched::new(n as usize), Watched::<f64>::new(m as usize));
        let status =
            unsafe { stickslip_interface_history_export(self.handle, n, integers.pointer(), m, reals.pointer()) };
        assert!(succeeded(status), "a history whose size is known can be exported");
        Some((integers.values().to_vec(), reals.values().iter().map(|v| v.to_bits()).collect()))
    }

    fn import(&self, integers: &[i64], reals: &[f64]) -> bool {
        let (n, m) = (integers.len() as i64, reals.len() as i64);
        succeeded(unsafe { stickslip_interface_history_import(self.handle, n, integers.as_ptr(), m, reals.as_ptr()) })
    }

    fn commit(&self) -> bool {
        let (x1, x2, lambda) = (self.x1.as_ptr(), self.x2.as_ptr(), self.lambda.as_ptr());
        succeeded(unsafe { stickslip_interface_commit(self.handle, x1, x2, lambda, std::ptr::null()) })
    }

    pub(super) fn call(&mut self, bytes: &mut Bytes) {
        if bytes.once_in(2) {
            shake(bytes, &mut self.x1);
            shake(bytes, &mut self.x2);
            shake(bytes, &mut self.lambda);
        }
        let h = self.handle;
        match bytes.below(15) {
            0 => {
                // The history moves on success alone, and comes back.
                let before = self.history();
                if !self.commit() {
                    assert!(before == self.history(), "a refused commit has moved the history");
                } else if bytes.once_in(3) {
                    assert!(succeeded(unsafe { stickslip_interface_rollback(h) }));
                    assert!(before == self.history() || before.is_none(), "a step taken back");
                }
            }
            1 => {
                succeeded(unsafe { stickslip_interface_rollback(h) });
            }
            2 => {
                let mut values = vec![0.5; N1];
                shake(bytes, &mut values);
                succeeded(unsafe { stickslip_interface_set_friction(h, bytes.pointer(values.as_ptr())) });
            }
            3 => {
                let mut values = vec![20.0; N1];
                shake(bytes, &mut values);
                succeeded(unsafe { stickslip_interface_set_augmentation(h, bytes.pointer(values.as_ptr())) });
            }
            4 if bytes.once_in(2) => {
                let mut values = vec![0.01; N1];
                shake(bytes, &mut values);
                let offsets = bytes.pointer(values.as_ptr());
                succeeded(unsafe { stickslip_interface_set_offsets(h, offsets, std::ptr::null()) });
            }
            4 => {
                let mut values: Vec<f64> = {
                    let d = self.dimension;
                    (0..d * N1).map(|k| if k % d == d - 1 { 1.0 } else { 0.0 }).collect()
                };
                shake(bytes, &mut values);
                succeeded(unsafe { stickslip_interface_set_normals(h, bytes.pointer(values.as_ptr())) });
            }
            5 => {
                let nodes = [bytes.integer(4), bytes.integer(5)];
                let mut values = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
                shake(bytes, &mut values);
                let n = bytes.count(2);
                succeeded(unsafe { stickslip_interface_set_constraints(h, n, nodes.as_ptr(), values.as_ptr()) });
            }
            6 => {
                succeeded(unsafe { stickslip_interface_set_previous(h, self.x1.as_ptr(), self.x2.as_ptr()) });
            }
            7 => {
                // A history that was sound, and is no longer.
                let Some((mut integers, reals)) = self.history() else { return };
                let mut reals: Vec<f64> = reals.into_iter().map(f64::from_bits).collect();
                shake(bytes, &mut reals);
                for _ in 0..bytes.below(3) {
                    let k = bytes.below(integers.len());
                    integers[k] = bytes.integer(integers[k]);
                }
                // With a checksum that fits, to try what lies behind it; now and then without.
                if !bytes.once_in(8) {
                    seal_history(&mut integers, &reals);
                }
                if self.import(&integers, &reals) {
                    self.forged = true;
                } else {
                    let (i, r) = self.history().expect("it was exported before");
                    let r: Vec<f64> = r.into_iter().map(f64::from_bits).collect();
                    assert!(self.import(&i, &r), "its own history: {}", message());
                }
            }
            8 => {
                let mut out = Watched::new(STICKSLIP_SUMS_PER_NODE as usize * N1);
                let (x1, x2) = (self.x1.as_ptr(), self.x2.as_ptr());
                if succeeded(unsafe { stickslip_interface_sums(h, x1, x2, out.pointer()) }) {
                    all_finite(out.values());
                } else {
                    out.assert_untouched();
                }
            }
            9 => {
                let mut fraction = Watched::<f64>::new(N1);
                let mut text = Watched::<i8>::new(64);
                let mut report: stickslip_report = unsafe { std::mem::zeroed() };
                report.struct_size = size_of::<stickslip_report>() as u64;
                (report.fraction, report.text, report.text_capacity) = (fraction.pointer(), text.pointer().cast(), 64);
                let (x1, x2) = (self.x1.as_ptr(), self.x2.as_ptr());
                if succeeded(unsafe { stickslip_interface_report(h, x1, x2, &mut report) }) {
                    all_finite(fraction.values());
                    assert!(text.values().contains(&0));
                    let nodes = report.nodes_none + report.nodes_part + report.nodes_full + report.nodes_several;
                    assert_eq!(nodes, self.counted as i64);
                } else {
                    fraction.assert_untouched();
                    text.assert_untouched();
                }
            }
            10 => {
                let mut lambda = Watched::new(self.components * N1);
                if succeeded(unsafe { stickslip_interface_initial_multipliers(h, lambda.pointer()) }) {
                    all_finite(lambda.values());
                } else {
                    lambda.assert_untouched();
                }
            }
            11 => {
                // A phase of the step, whose residual is finite too.
                succeeded(unsafe { stickslip_interface_use_normals(h, bytes.choice(3)) });
                self.residual();
            }
            12 => {
                let mut lambda = Watched::holding(&self.lambda);
                if succeeded(unsafe { stickslip_interface_turn_multipliers(h, self.x1.as_ptr(), lambda.pointer()) }) {
                    all_finite(lambda.values());
                } else {
                    let bits = |v: &[f64]| v.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
                    assert!(bits(lambda.values()) == bits(&self.lambda), "a refused call has written");
                }
            }
            13 => {
                let mut slip = vec![0.0; self.dimension * N1];
                shake(bytes, &mut slip);
                let (x1, x2, commits) = (self.x1.as_ptr(), self.x2.as_ptr(), bytes.integer(2));
                let slip = bytes.pointer(slip.as_ptr());
                succeeded(unsafe { stickslip_interface_set_committed(h, x1, x2, slip, commits) });
            }
            _ => {
                // A, B, A.
                let here = (self.residual(), self.tangent(), self.condensed());
                assert!(here.1 == self.tangent_by_plan(), "another answer by a plan");
                let x2 = self.x2.clone();
                shake(bytes, &mut self.x2);
                let history = self.history();
                self.residual();
                self.tangent();
                self.condensed();
                assert!(history == self.history(), "an evaluation has moved the history");
                self.x2 = x2;
                let again = (self.residual(), self.tangent(), self.condensed());
                assert!(here == again, "another answer at the same point");
            }
        }
    }
}

/// Takes one input; panics where a law is broken.
pub fn run(data: &[u8]) {
    let mut bytes = Bytes(data);
    let Some(mut scene) = Scene::with(&mut bytes, |_, _, _| ()) else { return };
    for _ in 0..8 {
        if bytes.is_empty() {
            break;
        }
        scene.call(&mut bytes);
    }
    // Whatever came before: at a sound place of its own the handle answers as a new one with its history does.
    assert!(succeeded(unsafe { stickslip_interface_destroy(&mut scene.handle) }));
    assert!(scene.handle.is_null());
}
