//! What holds exactly of dual weights, whatever covers a facet (docs/formulation 10.3).

use super::facet::{Patch, Scene};
use crate::support::max_abs;
use crate::support::random;
use nalgebra::Rotation3;
use proptest::prelude::*;
use proptest::test_runner::TestCaseResult;
use std::sync::atomic::{AtomicU32, Ordering};
use stickslip::dual::DualBasis;
use stickslip::element::pair_force;
use stickslip::error::Kind;
use stickslip::geometry::Vec3;
use stickslip::mortar::{self, MORTAR};
use stickslip::quadrature::DEGREE_5;

/// Rounding of sums of weights, times the largest coefficient a_AB that they are multiplied with.
const ROUNDING: f64 = 1e-14;
/// The same where positions are multiplied with them, whose rounding, and that of the plane, counts, too.
const PLACES: f64 = 1e-13;

/// All identities; `size` bounds the positions of a flat closed facet.
fn identities(patch: &Patch, flat: Option<(&Scene, f64)>) -> TestCaseResult {
    let Some(basis) = DualBasis::of(&patch.sums).unwrap() else { return Ok(()) };
    let (n, m, a) = (patch.nodes, basis.areas, basis.coefficients());
    let largest = max_abs(a.as_flattened().iter().copied());
    let (sums, areas) = (ROUNDING * largest, ROUNDING * largest * patch.sums.area);
    for i in 0..n {
        let column: f64 = (0..n).map(|k| a[k][i]).sum();
        prop_assert!((column - 1.0).abs() <= sums, "{}: functions add up to {column}", patch.name);
        let row: f64 = (0..n).map(|k| a[i][k] * m[k]).sum();
        prop_assert!((row - m[i]).abs() <= areas, "{}: a m is {row:e}, m {:e}", patch.name, m[i]);
    }
    let (columns, diagonal) = (patch.columns(), basis.diagonal());
    let dual: Vec<_> = columns.iter().map(|n| basis.dual(n)).collect();
    for i in 0..n {
        let row: f64 = dual.iter().map(|d| d[i]).sum();
        prop_assert!((row - diagonal[i]).abs() <= areas, "{}: {row:e} {:e}", patch.name, diagonal[i]);
        prop_assert!(diagonal[i] > 0.0);
        if let Some((scene, size)) = flat {
            let gap = scene.x2.iter().zip(&dual).fold(scene.x1[i] * diagonal[i], |g, (x, d)| g - x * d[i]);
            let bound = PLACES * largest * patch.sums.area * size;
            prop_assert!(gap.norm() <= bound, "{}: a gap of {:e}, {bound:e}", patch.name, gap.norm());
        }
    }
    // The constant traction loads the mortar side as with the standard basis.
    for (n, d) in columns.iter().zip(&dual) {
        let (standard, dual): (f64, f64) = (n.iter().sum(), d.iter().sum());
        prop_assert!((dual - basis.coverage.fade * standard).abs() <= areas, "{}", patch.name);
    }
    // Shares of pairs: momentum is that of each, and weights, gaps and forces add up to the facet's.
    let (mut total, mut gaps) = ([[0.0; 4]; 4], [Vec3::zeros(); 4]);
    let mut forces = vec![Vec3::zeros(); n + patch.mortar];
    let p = [0, 1, 2, 3].map(|a| Vec3::new(0.3 - a as f64, 0.5, 1.0 + 0.2 * a as f64));
    for pair in &patch.pairs {
        let share = basis.weights(&pair.weights);
        let (g, f) = (mortar::gap(&share, &patch.facet, &pair.facet), pair_force(&share, &p));
        for i in 0..n {
            gaps[i] += g[i];
            forces[i] += f[i];
        }
        pair.places.iter().enumerate().for_each(|(c, place)| forces[n + place] += f[MORTAR + c]);
        for i in 0..n {
            let (ab, ac): (f64, f64) = (share.ab[i].iter().sum(), share.ac[i].iter().sum());
            prop_assert!((ab - ac).abs() <= areas, "{}: {ab:e} {ac:e}", patch.name);
            (0..n).for_each(|k| total[i][k] += share.ab[i][k]);
        }
    }
    for i in 0..n {
        for k in 0..n {
            let expected = if i == k { diagonal[i] } else { 0.0 };
            prop_assert!((total[i][k] - expected).abs() <= areas, "{}: {:e}", patch.name, total[i][k]);
        }
        let off = (gaps[i] - patch.gaps()[i]).norm();
        prop_assert!(off <= PLACES * largest * patch.sums.area * patch.sums.area.sqrt(), "{}: {off:e}", patch.name);
    }
    let fields = [0, 1, 2].map(|i| [0, 1, 2, 3].map(|a| p[a][i]));
    for (found, expected) in forces.iter().zip(patch.forces(&fields)) {
        let off = (found - expected).norm();
        prop_assert!(off <= PLACES * largest * patch.sums.area, "{}: a force off by {off:e}", patch.name);
    }
    Ok(())
}

#[test]
fn of_the_golden_facets() {
    for case in crate::support::golden_part("golden_dual.json", "facets") {
        identities(&Scene::of(&case).patch(&DEGREE_5), None).unwrap();
    }
}

/// A facet with mild noise and a patch of mortar facets in its plane, placed and turned at random beside or over it.
fn flat_scene() -> impl Strategy<Value = Scene> {
    let numbers = proptest::collection::vec(-1.0..1.0f64, 40);
    (3usize..=4, 1usize..=3, any::<bool>(), numbers).prop_map(|(corners, cells, triangles, r)| {
        let tau = std::f64::consts::TAU;
        let corner = |k: usize| {
            let angle = tau * (k as f64 + 0.15 * r[k]) / corners as f64;
            Vec3::new(angle.cos(), angle.sin(), 0.0)
        };
        let (turn, width) = (tau * r[4], 0.2 + 0.7 * (r[5] + 1.0));
        let side = cells + 1;
        let node = |k: usize| {
            let noise = [0.2 * r[8 + 2 * k], 0.2 * r[9 + 2 * k]];
            let [s, t] = [k % side, k / side].map(|i| i as f64 / cells as f64 - 0.5);
            let [s, t] = [s + noise[0] / cells as f64, t + noise[1] / cells as f64];
            let at = Vec3::new(turn.cos() * s - turn.sin() * t, turn.sin() * s + turn.cos() * t, 0.0);
            at * width + Vec3::new(r[6], r[7], 0.0)
        };
        let mut facets2 = Vec::new();
        for k in (0..cells * cells).map(|c| c / cells * side + c % cells) {
            let [a, b, c, d] = [k, k + side, k + side + 1, k + 1];
            if triangles {
                facets2.extend([vec![a, b, c], vec![a, c, d]]);
            } else {
                facets2.push(vec![a, b, c, d]);
            }
        }
        let in_space = Rotation3::new(Vec3::new(r[0], 2.0 * r[1], r[2]));
        let x1 = (0..corners).map(|k| in_space * corner(k)).collect();
        let x2 = (0..side * side).map(|k| in_space * node(k)).collect();
        Scene { name: format!("{corners} corners, {cells} cells"), x1, x2, facets2 }
    })
}

/// Drawn, partly covered.
static DRAWN: [AtomicU32; 2] = [AtomicU32::new(0), AtomicU32::new(0)];
const CASES: u32 = 2000;

proptest! {
    #![proptest_config(random::cases(CASES))]

    #[test]
    fn of_flat_closed_facets_under_any_coverage(scene in flat_scene()) {
        let patch = scene.patch(&DEGREE_5);
        identities(&patch, Some((&scene, 2.0)))?;
        let share = patch.sums.coverage().share;
        DRAWN[0].fetch_add(1, Ordering::Relaxed);
        DRAWN[1].fetch_add(u32::from(share > 1e-4 && share < 0.999), Ordering::Relaxed);
        let [drawn, partly] = [DRAWN[0].load(Ordering::Relaxed), DRAWN[1].load(Ordering::Relaxed)];
        // A law that is hardly ever tested holds easily.
        prop_assert!(drawn < CASES || 2 * partly > drawn, "only {} of {} partly covered", partly, drawn);
    }
}

#[test]
fn a_facet_covered_in_a_point_is_refused_unless_it_has_faded_out() {
    let scene = Scene::of(&crate::support::golden_part("golden_dual.json", "facets")[0]);
    let mut sums = scene.patch(&DEGREE_5).sums;
    sums.mass = [[0.0625 * sums.area; 4]; 4];
    let error = DualBasis::of(&sums).unwrap_err();
    assert_eq!(error.kind, Kind::DegenerateFacet);
    assert!(error.message.contains("exchange the two sides"), "{error}");
    sums.mass = [[1e-6 * sums.area; 4]; 4];
    assert!(DualBasis::of(&sums).unwrap().is_none());
}
