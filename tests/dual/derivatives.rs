//! The derivatives that a tangent takes: shares of pairs from the kernels' contractions, against those of all weights and
//! against differences.

use super::facet::{Patch, Scene, gap_rows};
use crate::support::*;
use stickslip::dual::{DualBasis, FacetMotion, PairShare};
use stickslip::element::PairNow;
use stickslip::geometry::Vec3;
use stickslip::mortar::{ForceDerivatives, PAIR_NODES, PairWeights, WeightDerivatives, facet_motion_raised};
use stickslip::quadrature::DEGREE_5;

/// Contractions and full derivatives are the same sums in another order, with a system each.
const SAME: f64 = 1e-12;
/// Under the inner strip, where the condition is 2e4.
const SAME_UNDER_A_STRIP: f64 = 1e-9;
/// Central differences at 1e-6 of the facet's size: rounding 1e-16 / 1e-6 times the largest coefficients, truncation 1e-12
/// times third derivatives.
const STEP: f64 = 1e-6;
const DIFFERENCES: f64 = 1e-7;
/// Where Da vanishes (three nodes, all covered): rounding, relative to the largest derivative.
const NOTHING: f64 = 1e-13;
/// What is missed at least where Da is left out.
const MISSED: f64 = 1e-2;

/// Points on a line of a facet that is integrated without cells.
const POINTS: usize = 5;

/// Tractions without symmetry `[i][A]`.
const TRACTIONS: [[f64; 4]; 3] = [[0.3, -0.8, 0.5, 0.9], [-0.2, 0.4, 0.7, -0.6], [-1.0, -1.4, -0.7, -1.2]];

fn patches(with: impl Fn(&str) -> bool) -> Vec<(Scene, Patch)> {
    let scenes = golden_part("golden_dual.json", "facets").iter().map(Scene::of).collect::<Vec<_>>();
    let scenes: Vec<_> = scenes.into_iter().filter(|s| !s.name.contains("below") && with(&s.name)).collect();
    assert!(!scenes.is_empty());
    scenes.into_iter().map(|s| (s.clone(), s.patch(&DEGREE_5))).collect()
}

/// Whether the rule is exact on a golden facet.
fn is_affine(name: &str) -> bool {
    !name.contains("nonaffine") && !name.contains("warped")
}

/// Those of p_A with three nodes.
fn tractions(patch: &Patch) -> [[f64; 4]; 3] {
    TRACTIONS.map(|p| [0, 1, 2, 3].map(|a| if a < patch.nodes { p[a] } else { 0.0 }))
}

fn largest(rows: &[Vec<f64>]) -> f64 {
    max_abs(rows.iter().flatten().copied())
}

fn error(found: &[Vec<f64>], expected: &[Vec<f64>]) -> f64 {
    let rows = found.iter().zip(expected).flat_map(|(f, e)| f.iter().zip(e));
    max_abs(rows.map(|(f, e)| f - e)) / largest(expected).max(f64::MIN_POSITIVE)
}

fn flat(columns: &[Vec<Vec3>]) -> Vec<Vec<f64>> {
    columns.iter().map(|v| v.iter().flat_map(|x| x.iter().copied()).collect()).collect()
}

/// Forces and gaps from the derivatives of all dual weights, in which they are linear: `[column][node]`.
fn of_all_weights(scene: &Scene, patch: &Patch, p: &[[f64; 4]; 3]) -> (Vec<Vec<Vec3>>, Vec<Vec<Vec3>>) {
    let (diagonal, weights) = patch.full();
    let (basis, columns) = (patch.basis(), patch.columns());
    let dual: Vec<_> = columns.iter().map(|n| basis.dual(n)).collect();
    let traction = |a: usize| Vec3::from_fn(|i, _| p[i][a]);
    let reference = scene.x1[0]; // legal because both sides of a row add up to the same
    let (mut forces, mut gaps) = (Vec::new(), Vec::new());
    for column in 0..diagonal.len() {
        let mut force: Vec<_> = (0..patch.nodes).map(|b| traction(b) * diagonal[column][b]).collect();
        for d in &weights[column] {
            force.push((0..patch.nodes).fold(Vec3::zeros(), |f, a| f - traction(a) * d[a]));
        }
        forces.push(force);
        let (node, j) = (column / 3, column % 3);
        let gap = (0..patch.nodes).map(|a| {
            let mut g = (scene.x1[a] - reference) * diagonal[column][a];
            for (c, d) in weights[column].iter().enumerate() {
                g -= (scene.x2[c] - reference) * d[a];
            }
            // Of x_A and x_C themselves.
            g[j] += match node.checked_sub(patch.nodes) {
                Some(c) => -dual[c][a],
                None if node == a => basis.diagonal()[a],
                None => 0.0,
            };
            g
        });
        gaps.push(gap.collect());
    }
    (forces, gaps)
}

fn check_shares(scene: &Scene, patch: &Patch, in_plane_cancels: bool) {
    let p = tractions(patch);
    let (diagonal, weights) = patch.full();
    let (forces, gaps) = of_all_weights(scene, patch, &p);
    let motion = patch.motion(&p);
    let rows = |d: &[[f64; 4]]| d.iter().map(|d| d.to_vec()).collect::<Vec<_>>();
    let of_gaps: Vec<_> = motion.gaps.iter().map(|g| g[..patch.nodes].to_vec()).collect();
    // In-plane parts of gaps, which cancel, are as large as the weights' derivatives times the facet.
    let size = (scene.x1[1] - scene.x1[0]).norm();
    let parts = max_abs(weights.iter().flatten().flatten().copied()) * size;
    let scale = largest(&flat(&gaps)) / (largest(&flat(&gaps)) + parts);
    let errors = [
        error(&rows(&motion.diagonal), &rows(&diagonal)),
        error(&flat(&motion.forces), &flat(&forces)),
        if in_plane_cancels { error(&flat(&of_gaps), &flat(&gaps)) * scale } else { 0.0 },
    ];
    println!("{:40} areas, forces, gaps {:.1e} {:.1e} {:.1e}", patch.name, errors[0], errors[1], errors[2]);
    let bound = if patch.name.contains("strip") { SAME_UNDER_A_STRIP } else { SAME };
    assert!(errors.iter().all(|e| *e <= bound), "{}: {errors:?}", patch.name);
}

#[test]
fn shares_of_pairs_add_up_to_the_derivatives_of_all_weights() {
    for (scene, patch) in patches(|_| true) {
        // In-plane parts of a gap's derivative cancel to the error of the rule.
        check_shares(&scene, &patch, is_affine(&patch.name));
    }
}

/// Their derivatives are those of their own sums, on any facet.
#[test]
fn shares_of_pairs_of_points_do_so_too() {
    for (scene, _) in patches(|name| !name.contains("strip")) {
        let patch = scene.patch_by_points(POINTS);
        match DualBasis::of(&patch.sums) {
            Ok(Some(_)) => check_shares(&scene, &patch, true),
            Ok(None) => {}
            // Fewer points than nodes on the mortar side determine no multipliers.
            Err(error) => assert!(patch.name.contains("tri_corner"), "{}: {error}", patch.name),
        }
    }
}

/// Where the mortar side is at rest one kernel takes all pairs of a facet. It leaves out what vanishes with an exact rule.
#[test]
fn a_facet_over_a_side_at_rest_counts_as_one_pair() {
    for (_, patch) in patches(is_affine) {
        let (p, basis) = (tractions(&patch), patch.basis());
        let expected = patch.motion(&p);
        let facet = FacetMotion::new(&patch.frame, &basis, &patch.sums.gamma, &p);
        let (mut forces, mut areas) = (ForceDerivatives::default(), [[[0.0; 4]; 3]; PAIR_NODES]);
        let mut tractions = [[[[0.0; 4]; 3]; 3]; PAIR_NODES];
        let (pairs, raised) = (patch.pairs.iter().map(|p| (&p.segment, &p.weights)), facet.raised(&mut areas));
        let mut gap = facet_motion_raised(&patch.frame, pairs, patch.rule, &facet.field, &mut forces, raised);
        let total = PairWeights { ab: patch.sums.mass, ..PairWeights::default() };
        let share = PairShare { forces: &mut forces, gap: &mut gap, areas: &mut areas, tractions: &mut tractions };
        facet.share(0, &total, share);
        let n = patch.nodes;
        let now = PairNow { weights: &total, gap: Some(&gap) };
        let columns: Vec<_> = (0..3 * n).map(|column| (column / 3, column % 3)).collect();
        let row = |a: usize| gap_rows(&now, a);
        let gaps = columns.iter().map(|&(k, j)| (0..n).map(|a| row(a)[k].column(j).into()).collect::<Vec<Vec3>>());
        let force = |k: usize, j: usize, b: usize| Vec3::from_fn(|i, _| forces.one[k][j][i][b]);
        let of_one = columns.iter().map(|&(k, j)| (0..n).map(|b| force(k, j, b)).collect::<Vec<_>>());
        let of_areas = columns.iter().map(|&(k, j)| areas[k][j].to_vec());
        let first = |v: &[Vec<Vec3>]| flat(&v[..3 * n].iter().map(|v| v[..n].to_vec()).collect::<Vec<_>>());
        let expected_gaps: Vec<_> = expected.gaps.iter().map(|g| g.to_vec()).collect();
        let expected_areas: Vec<_> = expected.diagonal[..3 * n].iter().map(|d| d.to_vec()).collect();
        let errors = [
            error(&of_areas.collect::<Vec<_>>(), &expected_areas),
            error(&flat(&of_one.collect::<Vec<_>>()), &first(&expected.forces)),
            error(&flat(&gaps.collect::<Vec<_>>()), &first(&expected_gaps)),
        ];
        println!("{:40} areas, forces, gaps {:.1e} {:.1e} {:.1e}", patch.name, errors[0], errors[1], errors[2]);
        let bound = if patch.name.contains("strip") { SAME_UNDER_A_STRIP } else { SAME };
        assert!(errors.iter().all(|e| *e <= bound), "{}: {errors:?}", patch.name);
    }
}

/// The mortar side raised and tilted: gaps that differ from node to node, and no facet that closes.
fn tilted(scene: &Scene) -> Scene {
    let mut tilted = Scene { name: format!("{} tilted", scene.name), ..scene.clone() };
    tilted.x2.iter_mut().for_each(|x| x.z += 0.07 + 0.1 * x.x - 0.05 * x.y);
    tilted
}

#[test]
fn forces_and_gaps_have_the_derivatives_of_differences() {
    let generic = ["D03", "D04", "D05", "D06", "D07", "D11", "D12", "D15"];
    let scenes = patches(|name| generic.iter().any(|g| name.starts_with(g)));
    for scene in scenes.into_iter().flat_map(|(scene, _)| [tilted(&scene), scene]) {
        let patch = scene.patch(&DEGREE_5);
        let p = tractions(&patch);
        let motion = patch.motion(&p);
        let size = (scene.x1[1] - scene.x1[0]).norm();
        let (mut forces, mut gaps) = (Vec::new(), Vec::new());
        for column in 0..motion.forces.len() {
            let at = |h: f64| scene.moved(column / 3, column % 3, h).patch(&DEGREE_5);
            // Within the fade band a step is small against the width of the sliver.
            let h = STEP * size * patch.sums.coverage().share.min(1.0);
            let (plus, minus) = (at(h), at(-h));
            let quotient = |plus: &[Vec3], minus: &[Vec3]| {
                plus.iter().zip(minus).map(|(p, m)| (p - m) / (2.0 * h)).collect::<Vec<_>>()
            };
            forces.push(quotient(&plus.forces(&p), &minus.forces(&p)));
            gaps.push(quotient(&plus.gaps()[..patch.nodes], &minus.gaps()[..patch.nodes]));
        }
        let of_forces = error(&flat(&motion.forces), &flat(&forces));
        let found: Vec<_> = motion.gaps.iter().map(|g| g[..patch.nodes].to_vec()).collect();
        let of_gaps = error(&flat(&found), &flat(&gaps));
        println!("{:45} forces {of_forces:.1e} gaps {of_gaps:.1e}", patch.name);
        let bound = DIFFERENCES / patch.sums.coverage().share.min(1.0);
        assert!(of_forces <= bound && of_gaps <= bound, "{}: {of_forces:e} {of_gaps:e}", patch.name);
    }
}

/// Dn^d without Da: phi a Dn alone, `[column][C][A]` as one row a column.
fn without_the_basis(patch: &Patch) -> Vec<Vec<f64>> {
    let basis = patch.basis();
    let mut found = vec![vec![0.0; 4 * patch.mortar]; 3 * (patch.nodes + patch.mortar)];
    for pair in &patch.pairs {
        let (_, d) = WeightDerivatives::integrate(&patch.frame, &pair.segment, patch.rule);
        let slots = (0..patch.nodes).map(|k| (k, k));
        let slots = slots.chain(pair.places.iter().enumerate().map(|(c, p)| (4 + c, patch.nodes + p)));
        for ((slot, node), j) in slots.flat_map(|s| (0..3).map(move |j| (s, j))) {
            for (c, place) in pair.places.iter().enumerate() {
                let dn = basis.dual(&d.ac.map(|row| row[c][slot][j]));
                (0..4).for_each(|a| found[3 * node + j][4 * place + a] += dn[a]);
            }
        }
    }
    found
}

fn with_the_basis(patch: &Patch) -> Vec<Vec<f64>> {
    patch.full().1.iter().map(|weights| weights.as_flattened().to_vec()).collect()
}

/// A facet of three nodes that is covered everywhere has the same basis wherever it goes.
#[test]
fn the_basis_of_a_covered_triangle_does_not_change() {
    for (_, patch) in patches(|_| true).into_iter().filter(|(_, patch)| patch.nodes == 3) {
        let error = error(&without_the_basis(&patch), &with_the_basis(&patch));
        println!("{:40} {error:.1e}", patch.name);
        assert_eq!(error <= NOTHING, patch.sums.coverage().share > 0.999, "{}: {error:e}", patch.name);
    }
}

/// Where this fails the golden derivatives tell nothing of Da.
#[test]
fn leaving_out_the_bases_derivative_is_noticed() {
    let names = ["D03", "D05", "D06", "D07", "D15"];
    for (_, patch) in patches(|name| names.iter().any(|n| name.starts_with(n))) {
        let error = error(&without_the_basis(&patch), &with_the_basis(&patch));
        println!("{:40} {error:.2}", patch.name);
        assert!(error > MISSED, "{}: {error:e}", patch.name);
    }
}
