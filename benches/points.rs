//! What deciding at points costs (docs/formulation 16): residual and values of a plan, over those of dual multipliers at nodes, where
//! all facets are closed, all are open, and a border cuts a row of them. Patches of `patches.rs`, without friction and with it, frozen weights.
//!
//!     cargo bench --bench points

use nalgebra::SVector;
use std::time::Instant;
use stickslip::geometry::Vec3;
use stickslip::interface::{
    Contact, Decision, Extent, Friction, MultiplierBasis, Options, PlanPairs, Stiffness, Surface, Weights,
};

#[allow(dead_code)] // what else the other program needs of it
mod patches;

/// Facets along each side of the patches; the larger one's rim.
const CELLS: [usize; 2] = [16, 19];
const RIM: f64 = 0.3;
/// Of the bodies, so that rhat gh stays far below the multipliers.
const MODULUS: f64 = 1000.0;
const DEPTH: f64 = 1e-5;
/// How far it slides before each evaluation, back and forth: positions are new.
const SLIDE: f64 = 1e-7;
const PASSES: usize = 200;
const MU: f64 = 0.5;
type Sigma = fn(f64) -> f64;

/// What sigma is along the patch, mostly lambda.
const SCENES: [(&str, Sigma); 3] = [("all closed", |_| -1.0), ("all open", |_| 1.0), ("a border", |x| x - 0.51)];
/// The same with friction: what acts along the surface, over the pressure.
const FRICTION: [(&str, Sigma, f64); 4] = [
    ("all stick", |_| -1.0, 0.5 * MU),
    ("all slip", |_| -1.0, 1.5 * MU),
    ("all open, friction", |_| 1.0, 0.0),
    ("a border, slip", |x| x - 0.51, 1.5 * MU),
];

/// Positions of both sides, and the surfaces.
type Model = (Vec<Vec3>, Vec<Vec3>, Surface, Surface);

fn model() -> Model {
    let ((mut x1, one), (x2, two)) =
        (patches::patch(CELLS[0], 0.0, 1.0, false), patches::patch(CELLS[1], -RIM, 1.0 + RIM, true));
    x1.iter_mut().for_each(|x| x.z = -DEPTH * (1.0 + 0.5 * (3.0 * x.y).sin()));
    let (n1, n2) = (x1.len(), x2.len());
    let upper = Surface::new("nonmortar", x1.clone(), &one, patches::equations(n1, 0)).expect("a patch");
    let lower = Surface::new("mortar", x2.clone(), &two, patches::equations(n2, 3 * n1)).expect("a patch");
    (x1, x2, upper, lower)
}

fn options(decision: Decision) -> Options {
    let (basis, weights) = (MultiplierBasis::Dual, Weights::Reference);
    Options { basis, decision, weights, mu: MU, ..Options::paper(Stiffness::Modulus(MODULUS)) }
}

/// Without friction.
fn pressed(decision: Decision, sigma: Sigma, passes: usize) -> Least {
    let (x1, x2, upper, lower) = model();
    let first = 3 * (x1.len() + x2.len());
    let multipliers = (0..x1.len()).map(|a| [(first + a) as i64]).collect();
    let options = Options { friction: Friction::None, ..options(decision) };
    let contact = Contact::<1>::frictionless(upper, lower, multipliers, options).expect("an interface");
    let lambda: Vec<_> = x1.iter().map(|x| SVector::from([sigma(x.x)])).collect();
    least(contact, (x1, x2), &lambda, passes)
}

/// With friction.
fn sheared(decision: Decision, sigma: Sigma, along: f64, passes: usize) -> Least {
    let (x1, x2, upper, lower) = model();
    let multipliers = patches::equations(x1.len(), 3 * (x1.len() + x2.len()));
    let contact = Contact::<3>::new(upper, lower, multipliers, options(decision)).expect("an interface");
    let lambda: Vec<_> = x1.iter().map(|x| SVector::from([along * sigma(x.x), 0.0, sigma(x.x)])).collect();
    least(contact, (x1, x2), &lambda, passes)
}

/// Entries, and the least seconds of a residual and of the values.
type Least = (usize, [f64; 2]);

fn least<const N: usize>(
    mut contact: Contact<N>,
    (mut x1, x2): (Vec<Vec3>, Vec<Vec3>),
    lambda: &[SVector<f64, N>],
    passes: usize,
) -> Least {
    let entries = contact.make_plan((&x1, &x2), PlanPairs::Active(Extent::Whole)).expect("a plan");
    let (mut values, mut least) = (vec![0.0; entries], [f64::INFINITY; 2]);
    for pass in 0..passes {
        let slide = if pass % 2 == 0 { SLIDE } else { -SLIDE };
        x1.iter_mut().for_each(|x| x.x += slide);
        let start = Instant::now();
        contact.kept_residual(&x1, &x2, lambda, None).expect("a residual");
        least[0] = least[0].min(start.elapsed().as_secs_f64());
        let start = Instant::now();
        contact.plan_values((&x1, &x2), lambda, None, &mut values).expect("values");
        least[1] = least[1].min(start.elapsed().as_secs_f64());
    }
    (entries, least)
}

fn report(name: &str, of: impl Fn(Decision) -> Least) {
    let [nodes, points] = [Decision::Nodes, Decision::Points(MODULUS)].map(of);
    let ratios: [f64; 2] = std::array::from_fn(|k| points.1[k] / nodes.1[k]);
    println!("| {name} | {:.1} | {:.2} | {:.2} |", points.0 as f64 / nodes.0 as f64, ratios[0], ratios[1]);
}

fn main() {
    let passes = if std::env::args().any(|argument| argument == "--bench") { PASSES } else { 1 };
    println!("| points over nodes | entries | residual | values |\n|---|---:|---:|---:|");
    for (name, sigma) in SCENES {
        report(name, |decision| pressed(decision, sigma, passes));
    }
    for (name, sigma, along) in FRICTION {
        report(name, |decision| sheared(decision, sigma, along, passes));
    }
}
