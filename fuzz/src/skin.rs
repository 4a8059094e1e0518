//! General contact by its C functions: two boxes as one skin, in space or of lines, and any sequence of calls, with positions,
//! multipliers and histories that are mostly sound. The handle answers or refuses, its history moves by commits alone, equal points
//! give equal bits, and after a refusal it is as good as before, but where it has looked for contact that a step had missed.

use super::interface::shake;
use super::{Bytes, Watched, all_finite, message, succeeded};
use stickslip::capi::*;
use stickslip::interface::seal_history;

/// Corners of a box, as bits of x, y, z, and its facets as seen from outside: quadrilaterals in space, lines in a plane.
const QUADS: [[i64; 4]; 6] = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
const LINES: [[i64; 2]; 4] = [[0, 1], [1, 3], [3, 2], [2, 0]];
/// The sum of all forces, over the sum of their sizes; with multipliers and coordinates of any size.
const BALANCE: f64 = 1e-9;

struct Scene {
    handle: *mut stickslip_skin,
    dimension: usize,
    nodes: usize,
    facets: usize,
    copies: usize,
    /// A history was accepted that nothing has committed: its weights may be any.
    forged: bool,
    /// Positions before they are spoilt.
    reference: Vec<f64>,
    x: Vec<f64>,
    lambda: Vec<f64>,
}

impl Scene {
    fn with(bytes: &mut Bytes) -> Option<Scene> {
        let dimension = if bytes.once_in(4) { 2 } else { 3 };
        let corners = 1_usize << dimension;
        let mut x: Vec<f64> =
            (0..2 * corners).flat_map(|a| (0..dimension).map(move |i| (((a % corners) >> i) & 1) as f64)).collect();
        let up = [bytes.number(0.3), bytes.number(if dimension == 2 { 0.99 } else { 0.2 }), bytes.number(0.99)];
        for (k, v) in x[corners * dimension..].iter_mut().enumerate() {
            *v += up[k % dimension];
        }
        if bytes.once_in(4) {
            shake(bytes, &mut x);
        }
        let of_box: Vec<Vec<i64>> = if dimension == 3 {
            let cut = bytes.once_in(3);
            let parts = |q: &[i64; 4]| vec![vec![q[0], q[1], q[2]], vec![q[0], q[2], q[3]]];
            QUADS.iter().flat_map(|q| if cut { parts(q) } else { vec![q.to_vec()] }).collect()
        } else {
            LINES.iter().map(|l| l.to_vec()).collect()
        };
        let raised = |facet: &Vec<i64>| facet.iter().map(|a| a + corners as i64).collect();
        let facets: Vec<Vec<i64>> = of_box.iter().cloned().chain(of_box.iter().map(raised)).collect();
        let mut offsets = vec![0];
        facets.iter().for_each(|f| offsets.push(offsets[offsets.len() - 1] + f.len() as i64));
        let numbers: Vec<i64> = facets.concat();
        let mut equations: Vec<i64> = (0..x.len() as i64).collect();
        for _ in 0..bytes.below(4) {
            let k = bytes.below(equations.len());
            equations[k] = bytes.integer(-1);
        }
        let bodies: Vec<i64> = (0..facets.len()).map(|f| i64::from(f >= of_box.len())).collect();
        // SAFETY: numbers alone; then as large as it says; so below.
        let mut options: stickslip_options = unsafe { std::mem::zeroed() };
        assert!(succeeded(unsafe { stickslip_options_init(&mut options, size_of::<stickslip_options>() as u64) }));
        let mut method: stickslip_method = unsafe { std::mem::zeroed() };
        method.struct_size = size_of::<stickslip_method>() as u64;
        method.weights = if bytes.once_in(2) { bytes.choice(5) } else { 0 };
        method.multiplier_basis = bytes.choice(3);
        options.friction = if bytes.once_in(4) { bytes.choice(5) } else { 0 };
        let limited = options.friction == STICKSLIP_FRICTION_TRESCA;
        options.mu = bytes.number(if limited || options.friction == STICKSLIP_FRICTION_COULOMB { 0.3 } else { 0.0 });
        options.shear_limit = if limited { bytes.number(0.5) } else { 0.0 };
        options.modulus = bytes.number(1000.0);
        options.search_distance = bytes.number(0.0);
        options.model = if dimension == 2 { STICKSLIP_MODEL_PLANE } else { STICKSLIP_MODEL_SOLID };
        options.method = &raw const method;
        let surface = stickslip_surface {
            struct_size: size_of::<stickslip_surface>() as u64,
            n_nodes: (x.len() / dimension) as i64,
            n_facets: facets.len() as i64,
            coordinates: x.as_ptr(),
            facet_offsets: offsets.as_ptr(),
            facet_nodes: numbers.as_ptr(),
            equations: equations.as_ptr(),
            multiplier_equations: std::ptr::null(),
            owned: std::ptr::null(),
        };
        let bodies = bytes.pointer(bodies.as_ptr());
        let (first, mut handle) = (bytes.integer(x.len() as i64), std::ptr::null_mut());
        let status = unsafe { stickslip_skin_create(&surface, bodies, first, &options, &mut handle) };
        assert_eq!(succeeded(status), !handle.is_null());
        if handle.is_null() {
            return None;
        }
        let (mut copies, mut multipliers) = (0, 0);
        let none = std::ptr::null_mut();
        assert!(succeeded(unsafe { stickslip_skin_copies(handle, 0, none, none, &mut copies, &mut multipliers) }));
        let (nodes, copies) = (x.len() / dimension, copies as usize);
        assert!(copies >= nodes && multipliers <= (dimension * copies) as i64);
        let (mut originals, mut numbers) = (Watched::<i64>::new(copies), Watched::<i64>::new(dimension * copies));
        let (o, e, n) = (originals.pointer(), numbers.pointer(), copies as i64);
        assert!(succeeded(unsafe { stickslip_skin_copies(handle, n, o, e, &mut { 0 }, &mut { 0 }) }));
        assert!(originals.values().iter().all(|&a| 0 <= a && a < nodes as i64));
        assert!(numbers.values().iter().all(|&e| e == -1 || (first <= e && e < first + multipliers)));
        let lambda = (0..dimension * copies).map(|k| if k % dimension == dimension - 1 { 1.0 } else { 0.1 }).collect();
        let reference = x.clone();
        Some(Scene { handle, dimension, nodes, facets: facets.len(), copies, forged: false, reference, x, lambda })
    }

    /// Forces and rows. What pushes one body pushes the other one back.
    fn residual(&self) -> Option<Vec<f64>> {
        let mut out = [self.dimension * self.nodes, self.dimension * self.copies].map(Watched::<f64>::new);
        let [force, rows] = out.each_mut().map(Watched::pointer);
        // SAFETY: the arrays are as long as the handle asks for; so below.
        let status =
            unsafe { stickslip_skin_residual(self.handle, self.x.as_ptr(), self.lambda.as_ptr(), force, rows) };
        if !succeeded(status) {
            out.iter().for_each(Watched::assert_untouched);
            return None;
        }
        let force = out[0].values();
        let size: f64 = force.iter().map(|f| f.abs()).sum();
        for i in 0..self.dimension {
            let sum: f64 = force.iter().skip(i).step_by(self.dimension).sum();
            assert!(self.forged || !size.is_finite() || sum.abs() <= BALANCE * size, "{sum} of {size} is lost");
        }
        let values: Vec<f64> = out.iter().flat_map(|o| o.values().to_vec()).collect();
        all_finite(&values);
        Some(values)
    }

    fn bits(&self) -> Option<Vec<u64>> {
        self.residual().map(|r| r.iter().map(|v| v.to_bits()).collect())
    }

    /// The history, reals by their bits.
    fn history(&self) -> (Vec<i64>, Vec<u64>) {
        let (mut n, mut m) = (0, 0);
        assert!(succeeded(unsafe { stickslip_skin_history_size(self.handle, &mut n, &mut m) }), "{}", message());
        let (mut integers, mut reals) = (Watched::<i64>::new(n as usize), Watched::<f64>::new(m as usize));
        let (i, r) = (integers.pointer(), reals.pointer());
        assert!(succeeded(unsafe { stickslip_skin_history_export(self.handle, n, i, m, r) }), "{}", message());
        (integers.values().to_vec(), reals.values().iter().map(|v| v.to_bits()).collect())
    }

    fn import(&self, integers: &[i64], reals: &[f64]) -> bool {
        let (n, m) = (integers.len() as i64, reals.len() as i64);
        succeeded(unsafe { stickslip_skin_history_import(self.handle, n, integers.as_ptr(), m, reals.as_ptr()) })
    }

    /// Values by a plan; entries are those of unknowns.
    fn tangent(&self, bytes: &mut Bytes) {
        let (h, x, lambda, mut count) = (self.handle, self.x.as_ptr(), self.lambda.as_ptr(), 0);
        if !succeeded(unsafe { stickslip_skin_plan(h, x, bytes.choice(3), &mut count) }) {
            return;
        }
        let n = count as usize;
        let (mut rows, mut columns, mut values) = (Watched::<i64>::new(n), Watched::<i64>::new(n), Watched::new(n));
        let (mut rows32, mut columns32) = (Watched::<i32>::new(n), Watched::<i32>::new(n));
        let (r, c, v) = (rows.pointer(), columns.pointer(), values.pointer());
        assert!(succeeded(unsafe { stickslip_skin_plan_coo(h, count, r, c) }));
        assert!(rows.values().iter().chain(columns.values()).all(|&e| e >= 0));
        if succeeded(unsafe { stickslip_skin_plan_coo32(h, count, rows32.pointer(), columns32.pointer()) }) {
            assert!(rows.values().iter().zip(rows32.values()).all(|(a, b)| *a == i64::from(*b)));
        } else {
            rows32.assert_untouched();
        }
        if succeeded(unsafe { stickslip_skin_plan_values(h, x, lambda, count, v) }) {
            all_finite(values.values());
        }
    }

    /// What is told of copies and of facets.
    fn told(&self, bytes: &mut Bytes) {
        let (h, x, lambda, n) = (self.handle, self.x.as_ptr(), self.lambda.as_ptr(), self.copies);
        // SAFETY: numbers and null pointers; so below.
        let mut states: stickslip_states = unsafe { std::mem::zeroed() };
        let mut out = [n, n, self.dimension * n, self.dimension * n].map(Watched::<f64>::new);
        let [gap, area, normal, slip] = out.each_mut().map(Watched::pointer);
        states.struct_size = size_of::<stickslip_states>() as u64;
        (states.gap, states.area, states.normal, states.slip) = (gap, area, normal, slip);
        if succeeded(unsafe { stickslip_skin_states(h, x, lambda, &states) }) {
            out.iter().for_each(|o| all_finite(o.values()));
        } else {
            out.iter().for_each(Watched::assert_untouched);
        }
        let mut found: stickslip_equilibrium = unsafe { std::mem::zeroed() };
        found.struct_size = size_of::<stickslip_equilibrium>() as u64;
        found.modulus = bytes.number(1000.0);
        if succeeded(unsafe { stickslip_skin_equilibrium(h, x, lambda, &mut found) }) {
            assert!([found.gap, found.traction, found.slip].iter().all(|v| v.is_finite() && *v >= 0.0));
            assert!(found.gap_node < n as i64);
        }
        let (mut side, mut partner) = (Watched::<i32>::new(self.facets), Watched::<i64>::new(self.facets));
        let mut sides: stickslip_skin_sides = unsafe { std::mem::zeroed() };
        sides.struct_size = size_of::<stickslip_skin_sides>() as u64;
        (sides.side, sides.partner) = (side.pointer(), partner.pointer());
        assert!(succeeded(unsafe { stickslip_skin_facets(h, &sides) }));
        for (f, (&side, &partner)) in side.values().iter().zip(partner.values()).enumerate() {
            assert!((0..3).contains(&side) && partner != f as i64 && partner < self.facets as i64);
        }
        let mut summary: stickslip_skin_summary = unsafe { std::mem::zeroed() };
        summary.struct_size = size_of::<stickslip_skin_summary>() as u64;
        assert!(succeeded(unsafe { stickslip_skin_report(h, &mut summary) }));
        assert!(summary.pieces >= 0 && summary.pieces <= self.facets as i64);
    }

    /// One call, or a few that belong together.
    fn call(&mut self, bytes: &mut Bytes) {
        let h = self.handle;
        match bytes.below(12) {
            0 => {
                let (first, kept) = (self.bits(), self.x.clone());
                shake(bytes, &mut self.x);
                self.residual();
                self.x = kept;
                assert!(first == self.bits(), "A, B, A");
            }
            1 => self.tangent(bytes),
            2 => {
                let (before, mut lambda) = (self.history(), Watched::holding(&self.lambda));
                let status = unsafe { stickslip_skin_commit(h, self.x.as_ptr(), lambda.pointer()) };
                if succeeded(status) {
                    all_finite(lambda.values());
                    self.lambda = lambda.values().to_vec();
                } else {
                    assert!(status == STICKSLIP_CONTACT_LOST || before == self.history(), "{}", message());
                }
            }
            3 => {
                let before = self.history();
                let commit = unsafe { stickslip_skin_commit(h, self.x.as_ptr(), self.lambda.clone().as_mut_ptr()) };
                if succeeded(commit) {
                    assert!(succeeded(unsafe { stickslip_skin_rollback(h) }), "{}", message());
                    assert!(before == self.history(), "a commit is undone");
                }
            }
            4 => {
                if bytes.choice(2) == 0 {
                    succeeded(unsafe { stickslip_skin_rollback(h) });
                } else {
                    let mut taken = Watched::holding(&self.lambda);
                    if succeeded(unsafe { stickslip_skin_exchange(h, taken.pointer()) }) {
                        all_finite(taken.values());
                    } else {
                        assert_eq!(taken.values(), self.lambda);
                    }
                }
            }
            5 => {
                let (mut integers, reals) = self.history();
                let mut reals: Vec<f64> = reals.into_iter().map(f64::from_bits).collect();
                for _ in 0..bytes.below(3) {
                    let k = bytes.below(integers.len());
                    integers[k] = bytes.integer(integers[k]);
                }
                if bytes.once_in(2) {
                    shake(bytes, &mut reals);
                }
                // With a checksum that fits, to try what lies behind it; now and then without.
                if !bytes.once_in(8) {
                    seal_history(&mut integers, &reals);
                }
                let before = self.history();
                if self.import(&integers, &reals) {
                    self.forged = true;
                } else {
                    assert!(before == self.history(), "a refused history has changed it");
                    let own: Vec<f64> = before.1.iter().copied().map(f64::from_bits).collect();
                    assert!(self.import(&before.0, &own), "its own history: {}", message());
                }
            }
            6 => {
                let (one, two, mu) = (bytes.integer(0), bytes.integer(1), bytes.number(0.5));
                let before = self.bits();
                if !succeeded(unsafe { stickslip_skin_set_pair(h, one, two, mu) }) {
                    assert!(before == self.bits(), "a refused pair has changed the contact");
                }
            }
            7 => {
                let nodes = [bytes.integer(3), bytes.integer(self.nodes as i64 - 1)];
                let mut directions = vec![0.0; 2 * self.dimension];
                (directions[0], directions[self.dimension]) = (bytes.number(1.0), bytes.number(1.0));
                let (before, n) = (self.bits(), bytes.count(2));
                let status = unsafe { stickslip_skin_set_constraints(h, n, nodes.as_ptr(), directions.as_ptr()) };
                if !succeeded(status) {
                    assert!(before == self.bits(), "refused directions have changed the contact");
                }
            }
            8 => self.told(bytes),
            9 => {
                let (mut dx, mut fraction) = (vec![0.0; self.x.len()], Watched::<f64>::new(1));
                shake(bytes, &mut dx);
                let (x, penetration) = (self.x.as_ptr(), bytes.number(0.0));
                if succeeded(unsafe { stickslip_skin_step_limit(h, x, dx.as_ptr(), penetration, fraction.pointer()) }) {
                    // 0 of a motion whose length is beyond all numbers, as of an interface.
                    assert!((0.0..=1.0).contains(&fraction.values()[0]), "{:?}", fraction.values());
                } else {
                    fraction.assert_untouched();
                }
            }
            10 => {
                succeeded(unsafe { stickslip_skin_use_normals(h, bytes.choice(3)) });
                let mut turned = Watched::holding(&self.lambda);
                if succeeded(unsafe { stickslip_skin_turn_multipliers(h, self.x.as_ptr(), turned.pointer()) }) {
                    all_finite(turned.values());
                } else {
                    assert_eq!(turned.values(), self.lambda);
                }
            }
            _ => {
                let mut lambda = Watched::<f64>::new(self.lambda.len());
                if succeeded(unsafe { stickslip_skin_initial_multipliers(h, lambda.pointer()) }) {
                    all_finite(lambda.values());
                    self.lambda = lambda.values().to_vec();
                } else {
                    lambda.assert_untouched();
                }
            }
        }
    }
}

/// Takes one input; panics where a law is broken.
pub fn run(data: &[u8]) {
    let mut bytes = Bytes(data);
    let Some(mut scene) = Scene::with(&mut bytes) else { return };
    for _ in 0..8 {
        if bytes.is_empty() {
            break;
        }
        // Mostly near where all began.
        if bytes.once_in(4) {
            scene.x.clone_from(&scene.reference);
        }
        if bytes.once_in(2) {
            shake(&mut bytes, &mut scene.x);
        }
        if bytes.once_in(4) {
            shake(&mut bytes, &mut scene.lambda);
        }
        scene.call(&mut bytes);
    }
    // SAFETY: it is a handle.
    assert!(succeeded(unsafe { stickslip_skin_destroy(&mut scene.handle) }));
    assert!(scene.handle.is_null());
}
