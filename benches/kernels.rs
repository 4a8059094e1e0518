//! What the kernels cost: `make bench`.
//!
//! Times per pair as ratios to a plain C++ baseline (weights alone, 6 points a triangle, compiled for this machine),
//! pass by pass in turn within one program, for times drift with the machine; the shortest pass of each counts. One
//! thread. The library is compiled as it ships, for any processor of the architecture.
//!
//! Then instructions per call under callgrind, which do not depend on the machine's load: this program runs itself as
//! `--count NAME` under valgrind.
#![allow(unsafe_code)]

mod baseline;
mod calls;
mod patches;
mod sub_facets;
mod work;

use baseline::Baseline;
use patches::Patches;
use std::hint::black_box;
use std::process::Command;
use stickslip::element::PairTangent;
use stickslip::geometry::Vec3;
use stickslip::law::Friction;
use stickslip::mortar::WeightDerivatives;
use work::{Kind, Pair, node};

/// Pairs of the times; the baseline's set.
const PAIRS: usize = 20_000;
/// Pairs of quadratic facets, of which each has about ten of sub-facets.
const SUB_FACET_PARENTS: usize = 40;
/// Passes over them.
const PASSES: usize = 31;
/// Pairs and interfaces under callgrind, which is fifty times slower.
const COUNTED_PAIRS: usize = 500;
const COUNTED_INTERFACES: usize = 3;
/// Pairs where it is only to be seen that all runs.
const QUICK_PAIRS: usize = 50;
/// What the instructions are counted in.
const COUNTED: &str = "stickslip_bench_counted";

type Work = Box<dyn FnMut() -> f64>;

/// A kernel: name, what it was meant to cost over the baseline, calls a pass, a pass.
struct Kernel {
    name: &'static str,
    aim: Option<f64>,
    calls: usize,
    pass: Work,
}

fn over_pairs(name: &'static str, aim: f64, pairs: &[Pair], mut work: impl FnMut(&Pair) -> f64 + 'static) -> Kernel {
    let pairs = pairs.to_vec();
    let (calls, aim) = (pairs.len(), (aim > 0.0).then_some(aim));
    Kernel { name, aim, calls, pass: Box::new(move || pairs.iter().map(|p| work(black_box(p))).sum()) }
}

fn kernels(x: &[f64], interfaces: usize) -> Vec<Kernel> {
    let kinds = [Kind::Quads, Kind::Affine, Kind::Triangles, Kind::Mixed].map(|k| k.pairs(x));
    let [quads, affine, triangles, mixed] = &kinds;
    let tangent = || {
        let mut t = PairTangent::default();
        move |p: &Pair| p.tangent(&mut t)
    };
    let derivatives = || {
        let mut d = WeightDerivatives::default();
        move |p: &Pair| p.derivatives(&mut d)
    };
    let mut k = vec![
        over_pairs("quad4/quad4: weights", 0.20, quads, Pair::weights),
        over_pairs("quad4/quad4: weights, all derivatives", 0.50, quads, derivatives()),
        over_pairs("quad4/quad4: residual, tangent", 0.70, quads, tangent()),
        over_pairs("parallelograms: weights", 0.0, affine, Pair::weights),
        over_pairs("parallelograms: weights, all derivatives", 0.0, affine, derivatives()),
        over_pairs("parallelograms: residual, tangent", 0.55, affine, tangent()),
        over_pairs("tri3/tri3: weights", 0.0, triangles, Pair::weights),
        over_pairs("tri3/tri3: weights, all derivatives", 0.0, triangles, derivatives()),
        over_pairs("tri3/tri3: residual, tangent", 0.40, triangles, tangent()),
        over_pairs("tri3/quad4: residual, tangent", 0.0, mixed, tangent()),
        over_pairs("a node: Coulomb's law", 0.0, quads, |p| {
            Friction::Coulomb.respond(&node(p.one.nodes[1] * 0.01, Vec3::z())).row.x
        }),
    ];
    k.extend(calls::kernels(quads));
    k.extend(sub_facets::kernels(SUB_FACET_PARENTS));
    for (matching, residual, tangent) in [
        (false, "interface: search, residual, a pair", "interface: tangent, a pair"),
        (true, "matching meshes: search, residual, a pair", "matching meshes: tangent, a pair"),
    ] {
        let mut patches = Patches::new(matching);
        patches.residual();
        let calls = interfaces * patches.pairs();
        let pass = Box::new(move || (0..interfaces).map(|_| patches.residual()).sum());
        k.push(Kernel { name: residual, aim: None, calls, pass });
        let mut patches = Patches::new(matching);
        patches.residual();
        let pass = Box::new(move || (0..interfaces).map(|_| patches.tangent()).sum());
        k.push(Kernel { name: tangent, aim: None, calls, pass });
    }
    k
}

/// Coordinates of the pairs where the baseline is absent: squares and what lies askew over them.
fn own_pairs(n: usize) -> Vec<f64> {
    let mut state = 1u64;
    let mut random = move |range: f64| {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        range * ((state >> 33) as f64 / (1u64 << 30) as f64 - 1.0)
    };
    let corners = [[0.5, 0.5], [-0.5, 0.5], [-0.5, -0.5], [0.5, -0.5]];
    let mut x = Vec::with_capacity(24 * n);
    for _ in 0..n {
        for [u, v] in corners {
            x.extend([u + random(0.08), v + random(0.08), random(0.05)]);
        }
        let (turn, shift) = (random(3.0), [random(0.6), random(0.6)]);
        for k in [0, 3, 2, 1] {
            let [u, v] = [corners[k][0] + random(0.08), corners[k][1] + random(0.08)];
            let (s, c) = turn.sin_cos();
            x.extend([c * u - s * v + shift[0], s * u + c * v + shift[1], 0.02 + random(0.05)]);
        }
    }
    x
}

/// Seconds of a call, the shortest of all passes; of the baseline first.
fn times(baseline: Option<&Baseline>, x: &[f64], kernels: &mut [Kernel]) -> (Option<f64>, Vec<f64>) {
    let mut best = vec![f64::INFINITY; kernels.len()];
    let mut of_baseline = f64::INFINITY;
    let timed = |work: &mut dyn FnMut() -> f64| {
        let start = cpu_seconds();
        black_box(work());
        cpu_seconds() - start
    };
    for _ in 0..PASSES {
        for (kernel, best) in kernels.iter_mut().zip(&mut best) {
            if let Some(baseline) = baseline {
                of_baseline = of_baseline.min(timed(&mut || baseline.pass(x)) / (x.len() / 24) as f64);
            }
            *best = best.min(timed(&mut kernel.pass) / kernel.calls as f64);
        }
    }
    (baseline.map(|_| of_baseline), best)
}

/// CPU time of this thread: not disturbed by waiting for a processor.
fn cpu_seconds() -> f64 {
    let mut t = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: writes `t`.
    unsafe { libc::clock_gettime(libc::CLOCK_THREAD_CPUTIME_ID, &mut t) };
    t.tv_sec as f64 + 1e-9 * t.tv_nsec as f64
}

#[inline(never)]
#[unsafe(no_mangle)]
extern "C" fn stickslip_bench_counted(kernel: &mut Kernel) -> f64 {
    black_box((kernel.pass)())
}

/// Instructions of a call; `None` without valgrind.
fn instructions(name: &str, calls: usize) -> Option<f64> {
    let done = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg(format!("--toggle-collect={COUNTED}"))
        .arg(std::env::current_exe().ok()?)
        .args(["--count", name])
        .output()
        .ok()?;
    let text = String::from_utf8_lossy(&done.stderr);
    let collected = text.lines().find_map(|line| line.split_once("Collected : "))?.1.trim().parse::<f64>().ok()?;
    Some(collected / calls as f64)
}

fn counted_kernels() -> Vec<Kernel> {
    kernels(&own_pairs(COUNTED_PAIRS), COUNTED_INTERFACES)
}

fn main() {
    let arguments: Vec<_> = std::env::args().collect();
    if let Some(k) = arguments.iter().position(|a| a == "--count") {
        let mut kernels = counted_kernels();
        let kernel = kernels.iter_mut().find(|kernel| kernel.name == arguments[k + 1]).expect("a kernel's name");
        stickslip_bench_counted(kernel);
        return;
    }
    // Without `cargo bench`, which says so, it is a test.
    if arguments.iter().any(|a| a == "--quick") || !arguments.iter().any(|a| a == "--bench") {
        return try_all();
    }
    let table = measure();
    println!("{table}");
    if let Some(k) = arguments.iter().position(|a| a == "--write") {
        let text = std::fs::read_to_string(&arguments[k + 1]).expect("the document that holds the table");
        let (before, _) = text.split_once(TABLE).expect("the line before the table");
        std::fs::write(&arguments[k + 1], format!("{before}{TABLE}\n\n{table}")).expect("a document to write to");
    }
}

/// One untimed pass of everything that is measured: there is something to do, and numbers come out.
fn try_all() {
    for mut kernel in kernels(&own_pairs(QUICK_PAIRS), 1) {
        let sum = (kernel.pass)();
        assert!(kernel.calls > 0 && sum.is_finite(), "{}: {} calls, sum {sum}", kernel.name, kernel.calls);
    }
    println!("Every kernel ran; times: make bench");
}

/// The line before the table in the document.
const TABLE: &str = "<!-- table -->";

/// All figures, as a table.
fn measure() -> String {
    let baseline = Baseline::load();
    let x = baseline.as_ref().map_or_else(|| own_pairs(PAIRS), |b| b.pairs(PAIRS));
    let mut kernels = kernels(&x, 20);
    let (of_baseline, times) = times(baseline.as_ref(), &x, &mut kernels);
    let counted: Vec<_> = counted_kernels().iter().map(|k| instructions(k.name, k.calls)).collect();
    let mut table = "| | ns | over the baseline | aim | instructions |\n|---|---:|---:|---:|---:|\n".to_string();
    let number = |v: Option<f64>, digits: usize| v.map_or(String::new(), |v| format!("{v:.digits$}"));
    if let Some(t) = of_baseline {
        table += &format!("| baseline: weights in C++ | {:.0} | 1 | | |\n", 1e9 * t);
    }
    for ((kernel, time), counted) in kernels.iter().zip(&times).zip(&counted) {
        let (ratio, counted) = (number(of_baseline.map(|t| time / t), 3), number(*counted, 0));
        let (aim, ns) = (number(kernel.aim, 2), 1e9 * time);
        table += &format!("| {} | {ns:.0} | {ratio} | {aim} | {counted} |\n", kernel.name);
    }
    let mut patches = Patches::new(false);
    (0..10).for_each(|_| _ = black_box(patches.residual()));
    let c = patches.counters();
    let share = 100.0 * c.seconds_search / (c.seconds_search + c.seconds_integration);
    table + &format!("\nOf an interface's search and integration, the search's share: {share:.0} %.\n")
}
