//! The force of a fine tip in coarse facets against the ratio of the facets and the number of steps: a table, and its
//! bounds. Long: `make ratios`. A short part is in `commits.rs`.

use crate::support::host::Body;
use crate::support::mesh::*;
use crate::support::press::{Place, Press};
use nalgebra::Isometry3;
use stickslip::geometry::{AnalyticShape, Vec3};
use stickslip::interface::{Friction, NO_EQUATION, Options, Stiffness, Surface};
use stickslip::law::State;

const RATIOS: [usize; 5] = [1, 4, 16, 50, 200];
const STEPS: [usize; 4] = [1, 5, 20, 60];
/// Against the same run with a generous search distance: what the steps do to normals and areas.
const SAME_FORCE: f64 = 0.01;
/// Against the analytic surface, where the layer's facets resolve the contact: half the facets' sagitta over the depth.
const ANALYTIC: f64 = 0.03;
/// A generous search distance: more than the bodies are thick.
const GENEROUS: f64 = 3.0;
/// How far the tool is pressed in; its radius is 1.
const DEPTH: f64 = 0.2;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Tool {
    Ball,
    Cylinder,
    Analytic(AnalyticShape),
}

/// Which side is round.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Round {
    Mortar,
    Nonmortar,
}

fn height(x: &Vec3, cylinder: bool) -> f64 {
    1.0 - (1.0 - x.x * x.x - if cylinder { 0.0 } else { x.y * x.y }).sqrt()
}

/// The forces after each of the steps, and how many nodes a commit took away.
fn forces(
    (tool, cylinder, round, cells, ratio): (Tool, bool, Round, usize, usize),
    steps: usize,
    distance: Option<f64>,
) -> (Vec<f64>, usize) {
    let half = if round == Round::Mortar { 1.0 } else { 0.6 };
    // A layer under a cylinder ends within the cylinder's mesh, which has ends, as the analytic one has none.
    let (across, wide) = if cylinder { (half / 2.0, cells.div_ceil(2)) } else { (half, cells) };
    let mut layer = grid(cells, wide, [-half, -across], [half, across], 0.0, true, Cells::Quads);
    let lift = Vec3::z() * DEPTH;
    if round == Round::Nonmortar {
        layer.x.iter_mut().for_each(|x| x.z = -height(x, cylinder));
    }
    // A flat tool ends outside the round layer; a round one is as wide as it is steep. Its facets: the layer's over the ratio.
    let reach = if round == Round::Mortar { 0.6 } else { 0.8 };
    let facets = ((reach / (half / cells as f64)).ceil() as usize * ratio).max(1);
    let mortar = match tool {
        Tool::Analytic(shape) => {
            let p0 = if round == Round::Mortar { Vec3::z() } else { Vec3::zeros() };
            let lies = matches!(shape, AnalyticShape::Cylinder(_));
            let axis = if lies { Vec3::y() } else { -Vec3::z() };
            let (a, b) = if lies { (Vec3::z(), Vec3::x()) } else { (Vec3::x(), Vec3::y()) };
            Surface::analytic("mortar", shape, vec![p0, p0 + axis, p0 + a, p0 + b]).unwrap()
        }
        _ => {
            let mut mesh =
                grid(facets, facets, [-reach - 0.01, -reach], [reach - 0.01, reach], 0.0, false, Cells::Quads);
            if round == Round::Mortar {
                mesh.x.iter_mut().for_each(|x| x.z = height(x, cylinder));
            }
            let equations = vec![[NO_EQUATION; 3]; mesh.x.len()];
            Surface::new("mortar", mesh.x, &mesh.facets, equations).unwrap()
        }
    };
    let x2 = mortar.reference.clone();
    let options =
        Options { friction: Friction::None, search_distance: distance, ..Options::paper(Stiffness::Modulus(100.0)) };
    let mut press: Press<1> = Press::new(Body::new(layer, Vec3::z() * -1.0, 100.0, 0.3), mortar, options);
    let place = |s: f64| Place { plate: Isometry3::translation(0.0, 0.0, lift.z * s), mortar: x2.clone() };
    let (mut found, mut lost) = (Vec::new(), 0);
    for k in 0..steps {
        let [from, to] = [k, k + 1].map(|k| k as f64 / steps as f64);
        press.go((from, to), 1, &place);
        let (force, states) = press.force(&place(to));
        found.push(force.norm());
        let sums = press.contact.sums(&press.positions(&place(to)), &x2).unwrap();
        lost += states.iter().zip(&sums).filter(|(state, s)| **state != State::Gap && !(s.coverage > 0.0)).count();
        lost += (0..states.len())
            .filter(|&a| press.lambda[a].norm() > 0.0 && states[a] == State::Gap && sums[a].coverage == 0.0)
            .count();
    }
    (found, lost)
}

/// The table of one tool, either role.
fn table(tool: Tool, round: Round) {
    let mut wrong = Vec::new();
    let shape = match (round, tool) {
        (Round::Nonmortar, _) => AnalyticShape::Plane,
        (_, Tool::Ball) => AnalyticShape::Sphere(1.0),
        _ => AnalyticShape::Cylinder(1.0),
    };
    for (cells, resolved) in [(12, true), (3, false)] {
        for ratio in RATIOS.into_iter().filter(|r| cells * r <= 600) {
            for steps in STEPS.into_iter().filter(|s| !(resolved && *s > 20)) {
                let scene = (tool, tool == Tool::Cylinder, round, cells, ratio);
                // In as many steps: normals and areas are those of the step before.
                let analytic = resolved.then(|| {
                    let analytic = Tool::Analytic(shape);
                    let (f, _) = forces((analytic, tool == Tool::Cylinder, round, cells, ratio), steps, None);
                    *f.last().unwrap()
                });
                let (wanted, _) = forces(scene, steps, Some(GENEROUS));
                let (found, lost) = forces(scene, steps, None);
                let (wanted, last) = (wanted.last().unwrap(), found.last().unwrap());
                let error = (last / wanted - 1.0).abs();
                let far = analytic.map_or(0.0, |a| (last / a - 1.0).abs());
                let monotone = found.is_sorted();
                let name = format!("{tool:?} {round:?} round, {cells} cells, ratio {ratio}, {steps} steps");
                println!("{name}: {last:.4}, {error:.1e} off search_distance, {far:.1e} off the analytic surface");
                let bound = if ratio == 1 { f64::INFINITY } else { ANALYTIC };
                if !(error < SAME_FORCE && far < bound && monotone && lost == 0) {
                    wrong.push(format!("{name}: {error:.1e} {far:.1e} monotone {monotone}, {lost} nodes lost"));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
#[ignore = "a quarter of an hour: make ratios"]
fn a_ball_in_a_layer() {
    table(Tool::Ball, Round::Mortar);
}

#[test]
#[ignore = "a quarter of an hour: make ratios"]
fn a_cylinder_in_a_layer() {
    table(Tool::Cylinder, Round::Mortar);
}

#[test]
#[ignore = "a quarter of an hour: make ratios"]
fn a_layer_like_a_ball_on_a_plate() {
    table(Tool::Ball, Round::Nonmortar);
}

#[test]
#[ignore = "a quarter of an hour: make ratios"]
fn a_layer_like_a_cylinder_on_a_plate() {
    table(Tool::Cylinder, Round::Nonmortar);
}
