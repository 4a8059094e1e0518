//! What deciding at points costs (docs/formulation.md 16): residual and values of a plan, over those of dual multipliers at nodes, where
//! all facets are closed, all are open, and a border cuts a row of them. Patches of `patches.rs`, without friction, frozen weights.
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
type Sigma = fn(f64) -> f64;

/// What sigma is along the patch, mostly lambda.
const SCENES: [(&str, Sigma); 3] = [("all closed", |_| -1.0), ("all open", |_| 1.0), ("a border", |x| x - 0.51)];

/// Entries, and the least seconds of a residual and of the values.
fn least(decision: Decision, sigma: Sigma, passes: usize) -> (usize, [f64; 2]) {
    let ((mut x1, one), (x2, two)) =
        (patches::patch(CELLS[0], 0.0, 1.0, false), patches::patch(CELLS[1], -RIM, 1.0 + RIM, true));
    x1.iter_mut().for_each(|x| x.z = -DEPTH * (1.0 + 0.5 * (3.0 * x.y).sin()));
    let (n1, n2) = (x1.len(), x2.len());
    let upper = Surface::new("nonmortar", x1.clone(), &one, patches::equations(n1, 0)).expect("a patch");
    let lower = Surface::new("mortar", x2.clone(), &two, patches::equations(n2, 3 * n1)).expect("a patch");
    let (basis, weights, friction) = (MultiplierBasis::Dual, Weights::Reference, Friction::None);
    let options = Options { basis, decision, weights, friction, ..Options::new(Stiffness::Modulus(MODULUS)) };
    let multipliers = (0..n1).map(|a| [(3 * (n1 + n2) + a) as i64]).collect();
    let mut contact = Contact::<1>::frictionless(upper, lower, multipliers, options).expect("an interface");
    let lambda: Vec<_> = x1.iter().map(|x: &Vec3| SVector::from([sigma(x.x)])).collect();
    let entries = contact.make_plan((&x1, &x2), PlanPairs::Active(Extent::Whole)).expect("a plan");
    let (mut values, mut least) = (vec![0.0; entries], [f64::INFINITY; 2]);
    for pass in 0..passes {
        let slide = if pass % 2 == 0 { SLIDE } else { -SLIDE };
        x1.iter_mut().for_each(|x| x.x += slide);
        let start = Instant::now();
        contact.kept_residual(&x1, &x2, &lambda, None).expect("a residual");
        least[0] = least[0].min(start.elapsed().as_secs_f64());
        let start = Instant::now();
        contact.plan_values((&x1, &x2), &lambda, None, &mut values).expect("values");
        least[1] = least[1].min(start.elapsed().as_secs_f64());
    }
    (entries, least)
}

fn main() {
    let passes = if std::env::args().any(|argument| argument == "--bench") { PASSES } else { 1 };
    println!("| points over nodes | entries | residual | values |\n|---|---:|---:|---:|");
    for (name, sigma) in SCENES {
        let [nodes, points] = [Decision::Nodes, Decision::Points(MODULUS)].map(|d| least(d, sigma, passes));
        let ratios: [f64; 2] = std::array::from_fn(|k| points.1[k] / nodes.1[k]);
        println!("| {name} | {:.1} | {:.2} | {:.2} |", points.0 as f64 / nodes.0 as f64, ratios[0], ratios[1]);
    }
}
