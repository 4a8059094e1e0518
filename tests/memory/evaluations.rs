//! Evaluations through the C ABI take no memory once the handle has seen its size: positions change with every iterate, and a
//! system that gives large blocks back and takes them anew spends more time on their pages than the library on the contact.

use crate::allocator::{ALLOCATIONS, LIVE};
use crate::support::mesh::{Cells, Mesh, grid, numbered};
use std::mem::zeroed;
use std::ptr::{null, null_mut};
use stickslip::capi::*;
use stickslip::geometry::Vec3;

/// The first call takes what the surfaces need, the second one what their motion needs beyond it.
const FIRST: usize = 2;
/// Histories that take turns: that of t_n, the one before it for a rollback, and memory for the next one. All of them have
/// served once after so many commits.
const HISTORIES: usize = 4;
/// Vectors of a commit: 10 of the filter's two sides, 6 of what each facet reaches, 12 of depths, the rest of normals, nodes and
/// growth.
const MOST_VECTORS: usize = 64;
/// Bytes of a handle per non-mortar facet before any commit, of 4.4 pairs a facet, with friction.
const MOST_BYTES: f64 = 8000.0;

/// A handle and its host's arrays.
struct Host {
    handle: *mut stickslip_interface,
    start: [Vec<f64>; 2],
    x: [Vec<f64>; 2],
    lambda: Vec<f64>,
    forces: [Vec<f64>; 3],
    sums: Vec<f64>,
    states: [Vec<f64>; 4],
    analytic: bool,
    takes_sums: bool,
}

fn flat(x: &[Vec3]) -> Vec<f64> {
    x.iter().flat_map(|x| x.iter().copied()).collect()
}

impl Host {
    /// n x n facets over m x m, or over a plane.
    fn new(n: usize, m: usize, set: impl Fn(&mut stickslip_options, &mut stickslip_method)) -> Host {
        // SAFETY: numbers and null pointers.
        let mut options: stickslip_options = unsafe { zeroed() };
        let size = size_of::<stickslip_options>() as u64;
        // SAFETY: a struct of this size.
        assert_eq!(unsafe { stickslip_options_init(&mut options, size) }, 0);
        // SAFETY: as before.
        assert_eq!(unsafe { stickslip_options_paper(&mut options) }, 0);
        (options.modulus, options.mu) = (1000.0, 0.3);
        // SAFETY: the library's.
        let mut method = unsafe { *options.method };
        set(&mut options, &mut method);
        options.method = &raw const method;
        let (analytic, normal) =
            (options.mortar_side == STICKSLIP_MORTAR_ANALYTIC, options.friction == STICKSLIP_FRICTION_NONE);
        let one = grid(n, n, [0.0, 0.0], [1.0, 1.0], -1e-3, false, Cells::Quads);
        let mut two = grid(m, m, [-0.01, -0.01], [1.01, 1.01], 0.0, true, Cells::Quads);
        if analytic {
            two = Mesh { x: vec![Vec3::zeros(), Vec3::z(), Vec3::x(), Vec3::y()], facets: Vec::new() };
        }
        let rigid = options.mortar_side != STICKSLIP_MORTAR_DEFORMABLE;
        let (n1, n2, components) = (one.x.len(), two.x.len(), if normal { 1 } else { 3 });
        let equations = numbered::<3>(0, n1 + n2).concat();
        let multipliers: Vec<i64> = (0..components * n1).map(|k| (3 * (n1 + n2) + k) as i64).collect();
        let prescribed = vec![-1; 3 * n2];
        let start = [flat(&one.x), flat(&two.x)];
        let surface =
            |mesh: &Mesh, x: &[f64], equations: *const i64, multipliers: *const i64, call: &mut dyn FnMut(_)| {
                let nodes: Vec<i64> = mesh.facets.concat();
                let offsets: Vec<i64> = (0..=mesh.facets.len() as i64).map(|f| 4 * f).collect();
                let facets = !mesh.facets.is_empty();
                call(stickslip_surface {
                    struct_size: size_of::<stickslip_surface>() as u64,
                    n_nodes: mesh.x.len() as i64,
                    n_facets: mesh.facets.len() as i64,
                    coordinates: x.as_ptr(),
                    facet_offsets: if facets { offsets.as_ptr() } else { null() },
                    facet_nodes: if facets { nodes.as_ptr() } else { null() },
                    equations,
                    multiplier_equations: multipliers,
                    owned: null(),
                });
            };
        let mut handle = null_mut();
        let mortar = if rigid { prescribed.as_ptr() } else { equations[3 * n1..].as_ptr() };
        surface(&one, &start[0], equations.as_ptr(), multipliers.as_ptr(), &mut |one| {
            surface(&two, &start[1], mortar, null(), &mut |two| {
                // SAFETY: both surfaces' arrays are there.
                assert_eq!(unsafe { stickslip_interface_create(&one, &two, &options, &mut handle) }, 0);
            });
        });
        Host {
            handle,
            x: [start[0].clone(), start[1].clone()],
            start,
            lambda: (0..components * n1).map(|k| if k % components == components - 1 { -0.5 } else { 0.01 }).collect(),
            forces: [vec![0.0; 3 * n1], vec![0.0; 3 * n2], vec![0.0; components * n1]],
            sums: vec![0.0; STICKSLIP_SUMS_PER_NODE as usize * n1],
            states: [0; 4].map(|_| vec![0.0; 3 * n1]),
            analytic,
            takes_sums: method.multiplier_basis == STICKSLIP_BASIS_STANDARD,
        }
    }

    /// Both sides slide by part of a facet, and the non-mortar one turns a little; other positions in every round.
    fn move_to(&mut self, round: usize) {
        let s = 0.002 * (1.0 + (round % 7) as f64 / 7.0 + round as f64 / 100.0);
        for (x, start) in self.x[0].chunks_exact_mut(3).zip(self.start[0].chunks_exact(3)) {
            x.copy_from_slice(&[start[0] + s, start[1] - 0.5 * s, start[2] + 0.01 * s * start[0]]);
        }
        for (x, start) in self.x[1].chunks_exact_mut(3).zip(self.start[1].chunks_exact(3)) {
            x[1] = start[1] + if self.analytic { 0.0 } else { s };
        }
    }

    /// Allocations of sums, residual, states, equilibrium and a residual with sums at the positions of now.
    fn evaluate(&mut self) -> usize {
        let ([x1, x2], lambda, h) = (self.x.each_ref().map(|x| x.as_ptr()), self.lambda.as_ptr(), self.handle);
        let ([f1, f2, rows], sums) = (self.forces.each_mut().map(|f| f.as_mut_ptr()), self.sums.as_mut_ptr());
        let [normal, traction, slip, gap] = self.states.each_mut().map(|s| s.as_mut_ptr());
        // SAFETY: numbers and null pointers.
        let (mut states, mut equilibrium): (stickslip_states, stickslip_equilibrium) = unsafe { (zeroed(), zeroed()) };
        states.struct_size = size_of::<stickslip_states>() as u64;
        (states.normal, states.traction, states.slip, states.gap) = (normal, traction, slip, gap);
        equilibrium.struct_size = size_of::<stickslip_equilibrium>() as u64;
        let before = ALLOCATIONS.get();
        // SAFETY: all arrays are as long as the interface needs.
        unsafe {
            assert_eq!(stickslip_interface_residual(h, x1, x2, lambda, null(), f1, f2, rows), 0);
            assert_eq!(stickslip_interface_states(h, x1, x2, lambda, null(), &states), 0);
            assert_eq!(stickslip_interface_equilibrium(h, x1, x2, lambda, null(), &mut equilibrium), 0);
            assert_eq!(stickslip_interface_sums(h, x1, x2, sums), 0);
            if self.takes_sums {
                assert_eq!(stickslip_interface_residual(h, x1, x2, lambda, sums, f1, f2, rows), 0);
            }
        }
        ALLOCATIONS.get() - before
    }

    /// Allocations of the values of a plan at the positions of now.
    fn fill(&self, values: &mut [f64]) -> usize {
        let [x1, x2] = self.x.each_ref().map(|x| x.as_ptr());
        let (lambda, n) = (self.lambda.as_ptr(), values.len() as i64);
        let before = ALLOCATIONS.get();
        // SAFETY: all arrays are as long as the interface needs.
        let status =
            unsafe { stickslip_interface_plan_values(self.handle, x1, x2, lambda, null(), n, values.as_mut_ptr()) };
        assert_eq!(status, 0);
        ALLOCATIONS.get() - before
    }

    /// Makes a plan with a skin; room for its values.
    fn plan(&self) -> Vec<f64> {
        let ([x1, x2], mut rows, mut count) = (self.x.each_ref().map(|x| x.as_ptr()), 0, 0);
        // SAFETY: all arrays are as long as the interface needs.
        let status =
            unsafe { stickslip_interface_plan(self.handle, x1, x2, STICKSLIP_PLAN_SKIN, &mut rows, &mut count) };
        assert_eq!(status, 0);
        vec![0.0; count as usize]
    }

    /// Allocations of a commit at the positions of now.
    fn commit(&self) -> usize {
        let before = ALLOCATIONS.get();
        let [x1, x2] = self.x.each_ref().map(|x| x.as_ptr());
        // SAFETY: all arrays are as long as the interface needs.
        let status = unsafe { stickslip_interface_commit(self.handle, x1, x2, self.lambda.as_ptr(), null()) };
        assert_eq!(status, 0);
        ALLOCATIONS.get() - before
    }

    fn bytes(&self) -> f64 {
        // SAFETY: numbers.
        let mut counters: stickslip_counters = unsafe { zeroed() };
        counters.struct_size = size_of::<stickslip_counters>() as u64;
        // SAFETY: a struct of this size.
        assert_eq!(unsafe { stickslip_interface_counters(self.handle, &mut counters) }, 0);
        counters.bytes as f64
    }
}

impl Drop for Host {
    fn drop(&mut self) {
        // SAFETY: it came from create.
        unsafe { stickslip_interface_destroy(&mut self.handle) };
    }
}

/// What an interface is asked for, in all combinations that there are.
fn each_kind(mut test: impl FnMut(&str, &dyn Fn(&mut stickslip_options, &mut stickslip_method))) {
    for friction in [STICKSLIP_FRICTION_COULOMB, STICKSLIP_FRICTION_NONE, STICKSLIP_FRICTION_TIED] {
        for basis in [STICKSLIP_BASIS_STANDARD, STICKSLIP_BASIS_DUAL] {
            for normals in [STICKSLIP_NORMALS_COMMITTED, STICKSLIP_NORMALS_CURRENT] {
                for side in [STICKSLIP_MORTAR_DEFORMABLE, STICKSLIP_MORTAR_RIGID, STICKSLIP_MORTAR_ANALYTIC] {
                    if friction == STICKSLIP_FRICTION_TIED && normals == STICKSLIP_NORMALS_CURRENT {
                        continue; // normals of now go with weights of now
                    }
                    let what = format!("friction {friction}, basis {basis}, normals {normals}, mortar side {side}");
                    test(&what, &|options, method| {
                        (options.friction, method.multiplier_basis) = (friction, basis);
                        (method.normals, options.mortar_side) = (normals, side);
                        if friction != STICKSLIP_FRICTION_COULOMB {
                            options.mu = 0.0;
                        }
                    });
                }
            }
        }
    }
}

#[test]
fn evaluations_take_no_memory_after_the_first_two() {
    each_kind(|what, set| {
        let mut host = Host::new(8, 9, set);
        for round in 0..8 {
            host.move_to(round);
            let count = host.evaluate();
            assert!(round < FIRST || count == 0, "{what}: {count} allocations in round {round}");
        }
    });
}

#[test]
fn values_of_a_plan_take_no_memory_after_the_first_two() {
    each_kind(|what, set| {
        for form in [STICKSLIP_FORM_MULTIPLIER, STICKSLIP_FORM_AUGMENTED] {
            let mut host = Host::new(8, 9, |options, method| {
                set(options, method);
                method.form = form;
            });
            let mut values = host.plan();
            for round in 0..8 {
                host.move_to(round);
                let count = host.fill(&mut values);
                assert!(round < FIRST || count == 0, "{what}, form {form}: {count} allocations in round {round}");
            }
        }
    });
}

#[test]
fn evaluations_between_commits_take_no_memory() {
    each_kind(|what, set| {
        let mut host = Host::new(8, 9, set);
        for round in 0..4 * HISTORIES {
            host.move_to(round);
            let count = host.evaluate();
            assert!(round <= HISTORIES * 2 || count == 0, "{what}: {count} allocations in round {round}");
            if round % 2 == 1 {
                host.commit();
            }
        }
    });
}

/// What a commit settles anew (the filter of the step that follows, which nodes can be covered) has memory of its own: so many
/// vectors, some of which double as they grow, however large the surfaces are. Where weakly covered nodes are carried, each node
/// has a list of its own besides.
#[test]
fn a_commit_takes_a_number_of_vectors_that_does_not_grow_with_the_surfaces() {
    each_kind(|what, set| {
        let mut host = Host::new(16, 18, |options, method| {
            set(options, method);
            method.weak_coverage = STICKSLIP_WEAK_COVERAGE_NONE;
        });
        for round in 0..2 * HISTORIES {
            host.move_to(round);
            host.evaluate();
            let count = host.commit();
            assert!(round < HISTORIES || count <= MOST_VECTORS, "{what}: {count} allocations of a commit");
        }
    });
}

#[test]
fn a_handle_takes_so_many_bytes_a_facet() {
    let n = 40;
    let before = LIVE.get();
    let mut host = Host::new(n, 45, |_, _| {});
    let of_host = {
        let vectors = host.start.iter().chain(&host.x).chain(&host.forces).chain(&host.states);
        8 * vectors.chain([&host.lambda, &host.sums]).map(Vec::capacity).sum::<usize>()
    };
    for round in 0..FIRST + 1 {
        host.move_to(round);
        host.evaluate();
    }
    let (counted, held) = (host.bytes(), (LIVE.get() - before) as f64 - of_host as f64);
    let facets = (n * n) as f64;
    assert!(counted <= MOST_BYTES * facets && held <= MOST_BYTES * facets, "{} {}", counted / facets, held / facets);
}
