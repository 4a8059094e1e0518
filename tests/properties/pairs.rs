//! Laws of one pair: sums, bounds, invariance, derivatives.

use super::exact::shared_area;
use super::geometry::{Pair, RULE_ESTIMATE, Recipe, Relation, recipes, whole_recipes};
use super::{angles, config};
use nalgebra::Rotation3;
use proptest::prelude::*;
use proptest::test_runner::TestCaseResult;
use std::sync::atomic::{AtomicU32, Ordering};
use stickslip::geometry::{Facet, Mat3, Vec3};
use stickslip::mortar::{self, MORTAR, PairWeights, WeightDerivatives};
use stickslip::quadrature::{DEGREE_5, DEGREE_10};

/// W3, W5: rounding of sums over some fifty points, relative to the sum of their weights.
const SUMS: f64 = 1e-13;
/// Triangles of an overlap, whose roundings may all point one way in a single node's coverage.
const FAN: f64 = 8.0;
/// W7: rounding of the derivatives' sums, relative to the sum of the terms' sizes.
const DERIVATIVE_SUMS: f64 = 1e-12;
/// Rounding of a coordinate, times the handful of them that a projected one is made of, times a few.
const ROUNDING: f64 = 64.0 * f64::EPSILON;
/// W9: central differences at 1e-6 of the size (noise 1e-16 / 1e-6, truncation 1e-12).
const DIFFERENCES: f64 = 1e-7;
/// W9: the step.
const STEP: f64 = 1e-6;

/// Counts what is drawn and what the kernel takes: a law that is hardly ever tested holds easily.
struct Taken(AtomicU32, AtomicU32);

impl Taken {
    const fn new() -> Taken {
        Taken(AtomicU32::new(0), AtomicU32::new(0))
    }

    fn pair(&self, recipe: &Recipe) -> Option<Pair> {
        let pair = recipe.pair();
        self.0.fetch_add(1, Ordering::Relaxed);
        self.1.fetch_add(u32::from(pair.as_ref().is_some_and(|p| p.segment.is_some())), Ordering::Relaxed);
        pair
    }

    fn check(&self) {
        let (drawn, met) = (self.0.load(Ordering::Relaxed), self.1.load(Ordering::Relaxed));
        assert!(2 * met > drawn, "only {met} of {drawn} pairs were taken and met");
    }
}

/// W3, W4, W5: finite, as many of either side, not negative, no more than the facets have.
fn sums(p: &Pair) -> TestCaseResult {
    let (w, fine, areas) = (p.weights(&DEGREE_5), p.weights(&DEGREE_10), p.frame.nodal_areas());
    let area = p.area();
    // Overlaps are sums of triangles, each as exact as its edges are long.
    let triangles = f64::EPSILON * p.reach() * p.one.longest_edge().min(p.two.longest_edge());
    let mut total = 0.0;
    for a in 0..4 {
        let (b, c) = (w.coverage(a), w.ac[a].iter().sum::<f64>());
        prop_assert!(w.ab[a].iter().chain(&w.ac[a]).all(|v| v.is_finite()));
        prop_assert!((b - c).abs() <= SUMS * area, "row {a}: {b:e} {c:e}");
        // A node's area is exact, its coverage has the error of the rule on facets that are not affine.
        let rule = if p.is_affine() { 0.0 } else { RULE_ESTIMATE * (b - fine.coverage(a)).abs() };
        prop_assert!(-SUMS * area <= b, "coverage {b:e} of an overlap {area:e}");
        let rounding = SUMS * areas.iter().sum::<f64>() + FAN * triangles;
        prop_assert!(b <= areas[a] + rule + rounding, "coverage {b:e} of {:e}", areas[a]);
        prop_assert!((0..4).all(|b| w.ab[a][b] == w.ab[b][a]), "n_AB is symmetric");
        total += b;
    }
    prop_assert!((total - area).abs() <= SUMS * area + triangles, "{total:e} of an overlap {area:e}");
    let smaller = p.segment.as_ref().map_or(0.0, |s| 0.5 * s.mortar.area2.min(p.frame.projection.area2));
    prop_assert!(area <= smaller * (1.0 + 1e-12), "overlap {area:e} of a facet {smaller:e}");
    prop_assert!(area > 0.0 || w == PairWeights::default(), "no overlap is exactly zero");
    Ok(())
}

/// W7, and W3 differentiated: translation 0, rotation 0, Euler 2 n, as much on either side.
fn derivative_identities(p: &Pair) -> TestCaseResult {
    let (w, d) = (p.weights(&DEGREE_5), p.derivatives(&DEGREE_5));
    let rows = Pair::rows(&w, &d);
    let (reach, omega) = (p.reach(), Vec3::new(0.3, -0.7, 0.5));
    // Slivers: where the overlap itself is rounding of coordinates, so are the sums.
    let floor = p.sensitivity(ROUNDING);
    for (n, d) in &rows {
        prop_assert!(d.iter().all(|d| d.iter().all(|v| v.is_finite())));
        let scale = d.iter().map(|d| d.norm()).sum::<f64>() * reach;
        let bound = DERIVATIVE_SUMS * scale + floor;
        let translation: Vec3 = d.iter().sum();
        prop_assert!(translation.norm() * reach <= bound, "translation {:e} of {scale:e}", translation.norm() * reach);
        let rotation: f64 = p.nodes().map(|(k, x)| d[k].dot(&omega.cross(&x))).sum();
        prop_assert!(rotation.abs() <= bound, "rotation {rotation:e} of {scale:e}");
        if p.is_affine() {
            // A crossing at a small angle lies where rounding puts it, and the edges' parts end there each by itself.
            // The own edges of a facet that is hardly more than a line do, too.
            let thin = f64::EPSILON * scale * p.distortion();
            let bound = bound + ROUNDING * reach * reach / p.smallest_angle() + thin;
            let euler: f64 = p.nodes().map(|(k, x)| d[k].dot(&x)).sum();
            prop_assert!((euler - 2.0 * n).abs() <= bound, "Euler: {euler:e} instead of {:e}", 2.0 * n);
        }
    }
    // Each rounded: the gradients of the shape functions, which add up to zero, and the shape functions along the
    // edges, however small they are there.
    let terms = p.area() / p.smallest_height() + p.overlap_diameter();
    let size = rows.iter().flat_map(|(_, d)| d.iter().map(|d| d.norm())).sum::<f64>() + terms;
    let sum = |rows: &[[[f64; 3]; 8]; 4], k: usize| rows.iter().map(|r| Vec3::from(r[k])).sum::<Vec3>();
    for a in 0..4 {
        for k in 0..8 {
            let apart = (sum(&d.ab[a], k) - sum(&d.ac[a], k)).norm();
            // The ends of the edges' parts are known to a rounding of the coordinates; all is seen by the inverse maps.
            let bound = (DERIVATIVE_SUMS * size + f64::EPSILON * reach) * p.distortion();
            prop_assert!(apart <= bound, "D sum n_AB and D sum n_AC differ by {apart:e} of {size:e}");
        }
    }
    Ok(())
}

/// The gap of a pair with its own weights lies along the plane's normal (docs/formulation 2.4), as far as the inverse maps
/// return the same point.
fn gap_is_normal(p: &Pair) -> TestCaseResult {
    let (w, plane) = (p.weights(&DEGREE_5), &p.frame.plane);
    for g in mortar::gap(&w, &p.one, &p.two) {
        let slid = g - plane.e * plane.e.dot(&g);
        let bound = SUMS * p.area() * p.reach() * p.distortion();
        prop_assert!(slid.norm() <= bound, "in the plane {:e}, allowed {bound:e}", slid.norm());
    }
    Ok(())
}

/// Whether two sets of weights agree to `bound`.
fn same(a: &PairWeights, b: &PairWeights, bound: f64, what: &str) -> TestCaseResult {
    let pairs = a.ab.iter().chain(&a.ac).flatten().zip(b.ab.iter().chain(&b.ac).flatten());
    let apart = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    prop_assert!(apart <= bound, "{what}: {apart:e}, allowed {bound:e}");
    Ok(())
}

/// Rows and columns of weights, node k of the new numbering being `one[k]` and `two[k]` of the old.
fn renumbered(w: &PairWeights, one: &[usize], two: &[usize]) -> PairWeights {
    let mut r = PairWeights::default();
    for (a, &from) in one.iter().enumerate() {
        one.iter().enumerate().for_each(|(b, &k)| r.ab[a][b] = w.ab[from][k]);
        two.iter().enumerate().for_each(|(c, &k)| r.ac[a][c] = w.ac[from][k]);
    }
    r
}

static ANY: Taken = Taken::new();
static WHOLE: Taken = Taken::new();

proptest! {
    #![proptest_config(config(file!(), 1))]

    #[test]
    fn laws_of_any_pair(recipe in recipes()) {
        if let Some(p) = ANY.pair(&recipe) {
            sums(&p)?;
            derivative_identities(&p)?;
            gap_is_normal(&p)?;
        }
    }

    /// W4, W5: what only touches has nothing in common, what overlaps has the area of exact arithmetic.
    #[test]
    fn coincident_pairs_share_the_exact_area(recipe in whole_recipes()) {
        if let Some(p) = WHOLE.pair(&recipe) {
            let outline = |f: &Facet| {
                let mut outline: Vec<_> = f.points().iter().map(|x| [x.x as i64, x.y as i64]).collect();
                if f.area_vector().z < 0.0 {
                    outline.reverse();
                }
                outline
            };
            let exact = shared_area(&outline(&p.one), &outline(&p.two));
            // Relative to the facets: the clipped corners are rounded.
            let bound = SUMS * p.frame.projection.area2;
            prop_assert!((p.area() - exact).abs() <= bound, "{:e} instead of {exact:e}", p.area());
            prop_assert!(exact > 0.0 || p.area() == 0.0);
            sums(&p)?;
            derivative_identities(&p)?;
        }
    }

    /// I4, 7.5: twice as large, four times the weights and twice the derivatives, to the bit.
    #[test]
    fn powers_of_two_change_no_bit(recipe in recipes(), exponent in -200..200i32) {
        let scale = 2f64.powi(exponent);
        let [one, two] = recipe.points();
        let scaled = |x: &[Vec3]| x.iter().map(|x| x * scale).collect::<Vec<_>>();
        match (Pair::at(&one, &two), Pair::at(&scaled(&one), &scaled(&two))) {
            (Some(p), Some(q)) => {
                let rows = |p: &Pair| Pair::rows(&p.weights(&DEGREE_5), &p.derivatives(&DEGREE_5));
                for ((n, d), (m, e)) in rows(&p).into_iter().zip(rows(&q)) {
                    prop_assert_eq!(n * scale * scale, m);
                    prop_assert!(d.iter().zip(&e).all(|(d, e)| d * scale == *e));
                }
            }
            (p, q) => prop_assert_eq!(p.is_none(), q.is_none()),
        }
    }

    /// I2, 8.3: an offset that is exact changes no bit.
    #[test]
    fn exact_offsets_change_no_bit(recipe in recipes(), far in [-2..=2i32, -2..=2, -2..=2]) {
        let grid = f64::from(1 << 20);
        let recipe = Recipe { size: 1.0, offset: 0.0, ..recipe };
        let snapped = |x: &Vec3| x.map(|v| (v * grid).round() / grid);
        let [one, two] = recipe.points().map(|x| x.iter().map(snapped).collect::<Vec<_>>());
        let far = Vec3::from(far.map(|v| f64::from(v) * grid));
        let moved = |x: &[Vec3]| x.iter().map(|x| x + far).collect::<Vec<_>>();
        match (Pair::at(&one, &two), Pair::at(&moved(&one), &moved(&two))) {
            (Some(p), Some(q)) => prop_assert_eq!(p.weights(&DEGREE_5), q.weights(&DEGREE_5)),
            (p, q) => prop_assert_eq!(p.is_none(), q.is_none()),
        }
    }

    /// I1, 7.4: turned and moved as one, a pair keeps its weights.
    #[test]
    fn rigid_motion_keeps_the_weights(recipe in recipes(), angles in angles(), far in 0.0..10.0f64) {
        let [one, two] = recipe.points();
        let q = Rotation3::from_euler_angles(angles[0], angles[1], angles[2]);
        let shift = Vec3::new(far, -far, 0.5 * far) * recipe.size;
        let moved = |x: &[Vec3]| x.iter().map(|x| q * x + shift).collect::<Vec<_>>();
        if let (Some(p), Some(m)) = (Pair::at(&one, &two), Pair::at(&moved(&one), &moved(&two))) {
            let bound = p.sensitivity(ROUNDING).max(m.sensitivity(ROUNDING)) + SUMS * p.area();
            same(&p.weights(&DEGREE_5), &m.weights(&DEGREE_5), bound, "rigid motion")?;
        }
    }

    /// I3: nothing depends on where the numbering begins, nor on which way the mortar facet runs.
    #[test]
    fn numbering_does_not_matter(recipe in recipes(), begin in [0..4usize, 0..4usize], reverse in any::<bool>()) {
        let [one, two] = recipe.points();
        let order = |n: usize, from: usize| (0..n).map(|k| (k + from) % n).collect::<Vec<_>>();
        let (first, mut second) = (order(one.len(), begin[0]), order(two.len(), begin[1]));
        if reverse {
            second.reverse();
        }
        let pick = |x: &[Vec3], order: &[usize]| order.iter().map(|&k| x[k]).collect::<Vec<_>>();
        if let (Some(p), Some(m)) = (Pair::at(&one, &two), Pair::at(&pick(&one, &first), &pick(&two, &second))) {
            let bound = p.sensitivity(ROUNDING).max(m.sensitivity(ROUNDING)) + SUMS * p.area();
            same(&renumbered(&p.weights(&DEGREE_5), &first, &second), &m.weights(&DEGREE_5), bound, "renumbered")?;
        }
    }

    /// W6: the weights with the parts of a mortar facet add up to those with the whole.
    #[test]
    fn parts_of_a_mortar_facet_add_up(recipe in recipes(), s in 0.05..0.95f64) {
        let [one, two] = recipe.points();
        let m = two[0] + (two[1] - two[0]) * s;
        // Two triangles, or two quadrilaterals: in the plane of a warped facet, too, they cover what it covers.
        let parts = if two.len() == 3 {
            [vec![two[0], m, two[2]], vec![m, two[1], two[2]]]
        } else {
            let n = two[3] + (two[2] - two[3]) * s;
            [vec![two[0], m, n, two[3]], vec![m, two[1], two[2], n]]
        };
        let (whole, parts) = (Pair::at(&one, &two), parts.map(|part| Pair::at(&one, &part)));
        if let (Some(whole), [Some(p), Some(q)]) = (whole, parts) {
            let bound = [&whole, &p, &q].iter().map(|p| p.sensitivity(ROUNDING)).sum::<f64>() + SUMS * whole.area();
            let (n, p, q) = (whole.weights(&DEGREE_5), p.weights(&DEGREE_5), q.weights(&DEGREE_5));
            for (a, b) in (0..4).flat_map(|a| (0..4).map(move |b| (a, b))) {
                let apart = (p.ab[a][b] + q.ab[a][b] - n.ab[a][b]).abs();
                prop_assert!(apart <= bound, "{apart:e}, allowed {bound:e}");
            }
        }
    }

    /// W9: of facets that stay affine, under any affine motion of either.
    #[test]
    fn derivatives_equal_differences(recipe in recipes(), speed in proptest::collection::vec(-1.0..1.0f64, 24)) {
        // Nothing thinner than a step can tell.
        let relation = match recipe.relation {
            Relation::Turned(k) => Relation::Turned(k.min(4)),
            Relation::Strip(k) => Relation::Strip(k.min(4)),
            other => other,
        };
        let recipe = Recipe { relation, size: 1.0, offset: 0.0, aspect: 1.0, ..recipe };
        // A quadrilateral's fourth node makes it a parallelogram.
        let [one, two] = recipe.points().map(|mut x| {
            if x.len() == 4 {
                x[3] = x[0] + x[2] - x[1];
            }
            x
        });
        let Some(p) = Pair::at(&one, &two) else { return Ok(()) };
        if !p.is_affine() {
            return Ok(());
        }
        let velocity = |v: &[f64], x: &Vec3| Mat3::from_column_slice(&v[..9]) * x + Vec3::from_column_slice(&v[9..12]);
        let moved = |h: f64| {
            let at = |x: &[Vec3], v: &[f64]| x.iter().map(|x| x + velocity(v, x) * h).collect::<Vec<_>>();
            Pair::at(&at(&one, &speed[..12]), &at(&two, &speed[12..])).map(|p| p.weights(&DEGREE_5))
        };
        let differences = |low: f64, high: f64| {
            let (minus, plus, none) = (moved(low)?, moved(high)?, WeightDerivatives::default());
            let rows = Pair::rows(&plus, &none).into_iter().zip(Pair::rows(&minus, &none));
            Some(rows.map(|((p, _), (m, _))| (p - m) / (high - low)).collect::<Vec<_>>())
        };
        let steps = [(-STEP, STEP), (-0.5 * STEP, 0.5 * STEP), (0.0, STEP), (-STEP, 0.0)];
        let steps = steps.map(|(low, high)| differences(low, high));
        let [Some(central), Some(finer), Some(ahead), Some(behind)] = steps else { return Ok(()) };
        let nodes = |d: &[Vec3; 8]| {
            let one = one.iter().enumerate().map(|(k, x)| d[k].dot(&velocity(&speed[..12], x))).sum::<f64>();
            one + two.iter().enumerate().map(|(k, x)| d[MORTAR + k].dot(&velocity(&speed[12..], x))).sum::<f64>()
        };
        let allowed = DIFFERENCES * p.reach() * p.one.longest_edge().max(p.two.longest_edge());
        let rows = Pair::rows(&p.weights(&DEGREE_5), &p.derivatives(&DEGREE_5));
        for (k, (_, d)) in rows.iter().enumerate() {
            // Where facets coincide there is a derivative to either side, or a second one, and differences see both.
            let kink = (ahead[k] - behind[k]).abs() + 4.0 * (central[k] - finer[k]).abs();
            let apart = (nodes(d) - central[k]).abs();
            prop_assert!(apart <= allowed + kink, "{apart:e}, allowed {allowed:e} and {kink:e}");
        }
    }
}

#[test]
fn most_recipes_make_pairs_that_meet() {
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    for _ in 0..2000 {
        for (taken, whole) in [(&ANY, false), (&WHOLE, true)] {
            let tree = if whole { whole_recipes().boxed() } else { recipes().boxed() }.new_tree(&mut runner).unwrap();
            taken.pair(&proptest::strategy::ValueTree::current(&tree));
        }
    }
    ANY.check();
    WHOLE.check();
}
