//! Quadratic facets (`src/mortar/sub_pair.rs`, `parent_pair.rs`) against the golden pairs of `golden_quadratic.json`, and the
//! identities that hold at any rule.

use crate::support::random::*;
use crate::support::*;
use nalgebra::{Rotation3, Vector3};
use proptest::prelude::*;
use serde_json::Value;
use stickslip::error::Kind;
use stickslip::geometry::Vec3;
use stickslip::mortar::{
    MORTAR, MultiplierSpace, NonmortarFrame, PairWeights, ParentFacet, ParentWeights, Segment, WeightDerivatives,
    parent_weights,
};
use stickslip::quadrature::{DEGREE_5, DEGREE_10, Rule};

/// G1: weights of affine sub-facets, relative to the largest.
const WEIGHTS: f64 = 1e-13;
/// G1: derivatives of the same.
const DERIVATIVES: f64 = 1e-10;
/// G2: the error of the rule on curved quadrilateral sub-facets, of 12 points (measured: curved 5e-12, bilinear 7e-10)
/// and of degree 10.
const RULE_ERROR: [f64; 2] = [2e-9, 1e-12];
/// The same of derivatives (measured 1.5e-8).
const DERIVATIVE_RULE_ERROR: [f64; 2] = [1e-6, 1e-10];

const SPACES: [(&str, MultiplierSpace); 2] = [("corner", MultiplierSpace::Corner), ("sub", MultiplierSpace::Sub)];

fn parent(v: &Value) -> ParentFacet {
    ParentFacet::new(&points(v)).unwrap()
}

fn weights(one: &ParentFacet, two: &ParentFacet, space: MultiplierSpace, rule: &'static Rule) -> ParentWeights {
    parent_weights((one, two), space, rule, None).unwrap()
}

/// Derivatives of n_AB and n_AC, `[A][B][k][j]` one after the other.
struct Derivatives {
    of: [Vec<f64>; 2],
    columns: [usize; 2],
}

impl Derivatives {
    /// Of n_AB (which = 0) or n_AC, with respect to component j of the pair's k-th node.
    fn at(&self, which: usize, a: usize, b: usize, k: usize, j: usize) -> f64 {
        let n = self.columns[0] + self.columns[1];
        self.of[which][3 * ((a * self.columns[which] + b) * n + k) + j]
    }
}

fn with_derivatives(
    one: &ParentFacet,
    two: &ParentFacet,
    space: MultiplierSpace,
    rule: &'static Rule,
) -> (ParentWeights, Derivatives) {
    let (m, columns) = (one.multipliers(space), [one.parent.n, two.parent.n]);
    let [mut ab, mut ac] = columns.map(|c| vec![0.0; 3 * m * c * (columns[0] + columns[1])]);
    let w = parent_weights((one, two), space, rule, Some([&mut ab, &mut ac])).unwrap();
    (w, Derivatives { of: [ab, ac], columns })
}

/// The largest difference from golden weights, relative to the largest of them.
fn weight_error(w: &ParentWeights, ab: &Value, ac: &Value) -> f64 {
    let (ab, ac) = (table(ab), table(ac));
    let largest = max_abs(ab.iter().chain(&ac).flatten().copied());
    let row = |of: &[[f64; 9]; 9], golden: &[Vec<f64>]| {
        max_abs(golden.iter().enumerate().flat_map(|(a, row)| row.iter().enumerate().map(move |(b, v)| of[a][b] - v)))
    };
    row(&w.ab, &ab).max(row(&w.ac, &ac)) / largest
}

#[test]
fn golden_weights() {
    let mut compared = 0;
    for case in golden_part("golden_quadratic.json", "pairs") {
        let (one, two) = (parent(&case["x1"]), parent(&case["x2"]));
        for (key, space) in SPACES {
            let expected = &case[key];
            let found = weights(&one, &two, space, &DEGREE_5);
            if expected["overlap"] == false {
                assert!(max_abs(found.ab.into_iter().flatten()) == 0.0, "{}", name(&case));
                continue;
            }
            let area = expected["area"].as_f64().unwrap();
            let covered: f64 = found.ab.as_flattened().iter().sum();
            assert!((covered - area).abs() < WEIGHTS * area, "{}: area {covered} for {area}", name(&case));
            let error = weight_error(&found, &expected["nAB"], &expected["nAC"]);
            let fine = weight_error(&weights(&one, &two, space, &DEGREE_10), &expected["nAB"], &expected["nAC"]);
            println!("{} {key}: {error:.1e}, degree 10 {fine:.1e}", name(&case));
            let [bound, fine_bound] = if case["affine"] == true { [WEIGHTS; 2] } else { RULE_ERROR };
            assert!(error < bound && fine < fine_bound, "{} {key}: {error:.1e}, {fine:.1e}", name(&case));
            compared += 1;
        }
    }
    assert!(compared >= 6);
}

#[test]
fn golden_derivatives() {
    let mut compared = 0;
    for case in golden_part("golden_quadratic.json", "pairs") {
        let (one, two) = (parent(&case["x1"]), parent(&case["x2"]));
        let n = one.parent.n + two.parent.n;
        for (key, space) in SPACES {
            let expected = &case[key];
            if expected["dnAB"].is_null() {
                continue;
            }
            for (rule, which) in [(&DEGREE_5, 0), (&DEGREE_10, 1)] {
                let (found, d) = with_derivatives(&one, &two, space, rule);
                assert_eq!(found, weights(&one, &two, space, rule), "{}", name(&case));
                let (mut error, mut largest) = (0.0_f64, 0.0_f64);
                for (of, golden) in [&expected["dnAB"], &expected["dnAC"]].into_iter().enumerate() {
                    for (a, row) in golden.as_array().unwrap().iter().enumerate() {
                        for (b, entry) in table(row).iter().enumerate() {
                            assert_eq!(entry.len(), 3 * n);
                            if a >= one.multipliers(space) {
                                assert!(max_abs(entry.iter().copied()) == 0.0, "a node without a multiplier");
                                continue;
                            }
                            for (k, v) in entry.iter().enumerate() {
                                error = error.max((d.at(of, a, b, k / 3, k % 3) - v).abs());
                                largest = largest.max(v.abs());
                            }
                        }
                    }
                }
                println!("{} {key}, degree {}: {:.1e}", name(&case), rule.degree, error / largest);
                let bound = if case["affine"] == true { DERIVATIVES } else { DERIVATIVE_RULE_ERROR[which] };
                assert!(error < bound * largest, "{} {key}: {:.1e}", name(&case), error / largest);
                compared += 1;
            }
        }
    }
    assert!(compared >= 4);
}

/// A linear facet is its own sub-facet: the weights and derivatives of the linear kernel, to the rounding of their sums.
#[test]
fn linear_facets_are_their_own_parents() {
    for case in golden_part("golden_pairs.json", "cases") {
        let (x1, x2) = (points(&case["x1"]), points(&case["x2"]));
        let (one, two) = (facet(&case["x1"]), facet(&case["x2"]));
        let frame = NonmortarFrame::new(&one).unwrap();
        let Some(segment) = Segment::new(&frame, &two).unwrap() else { continue };
        let expected = PairWeights::integrate(&frame, &segment, &DEGREE_5);
        let derivatives = WeightDerivatives::integrate(&frame, &segment, &DEGREE_5).1;
        let (p1, p2) = (ParentFacet::new(&x1).unwrap(), ParentFacet::new(&x2).unwrap());
        let scale = max_abs(derivatives.ab.iter().chain(&derivatives.ac).flatten().flatten().flatten().copied());
        let size = max_abs(x1.iter().flat_map(|x| (x - x1[0]).iter().copied().collect::<Vec<_>>()));
        for (_, space) in SPACES {
            let (found, d) = with_derivatives(&p1, &p2, space, &DEGREE_5);
            let n = [one.len(), two.len()];
            for (a, which) in (0..n[0]).flat_map(|a| [(a, 0), (a, 1)]) {
                for b in 0..n[which] {
                    let (v, w) = match which {
                        0 => (found.ab[a][b], expected.ab[a][b]),
                        _ => (found.ac[a][b], expected.ac[a][b]),
                    };
                    assert!((v - w).abs() < WEIGHTS * size * size, "{}", name(&case));
                    let derivatives = if which == 0 { &derivatives.ab } else { &derivatives.ac };
                    for (k, j) in (0..n[0] + n[1]).flat_map(|k| (0..3).map(move |j| (k, j))) {
                        let slot = if k < n[0] { k } else { MORTAR + k - n[0] };
                        let (v, w) = (d.at(which, a, b, k, j), derivatives[a][b][slot][j]);
                        assert!((v - w).abs() < DERIVATIVES * (scale + size), "{}: {v} {w}", name(&case));
                    }
                }
            }
        }
    }
}

/// Sums of a few hundred terms.
const ROUNDING: f64 = 1e-13;
/// Differences in double: their step's error and rounding's together.
const DIFFERENCES: f64 = 1e-8;

/// Rows of nodes, corners first, of a parent with mid nodes off the middle and off the plane; seen from above, counter-clockwise.
fn random_parent(n: usize, scale: f64, turn: f64, noise: &[f64], up: bool) -> ParentFacet {
    let kind = stickslip::shape::Parent::of(n).unwrap();
    let rotation = Rotation3::from_euler_angles(0.0, 0.0, turn);
    let mut x: Vec<Vec3> = (0..n)
        .map(|k| {
            let [u, v] = kind.at[k];
            let at = if kind.corners() == 3 { [2.0 * u - 0.7, 2.0 * v - 0.7] } else { [u, v] };
            let d = Vector3::new(noise[3 * k], noise[3 * k + 1], noise[3 * k + 2]) * 0.08;
            rotation * (Vec3::new(at[0], at[1], 0.0) + d) * scale
        })
        .collect();
    if !up {
        x.iter_mut().for_each(|x| x.y = -x.y);
    }
    ParentFacet::new(&x).unwrap()
}

fn kinds() -> impl Strategy<Value = usize> {
    prop::sample::select(vec![3_usize, 4, 6, 8, 9])
}

fn scene() -> impl Strategy<Value = (ParentFacet, ParentFacet)> {
    let noise = || prop::collection::vec(-1.0..1.0_f64, 27);
    (kinds(), kinds(), noise(), noise(), -3.0..3.0_f64, -0.4..0.4_f64, -0.4..0.4_f64).prop_map(
        |(n1, n2, one, two, turn, u, v)| {
            let one = random_parent(n1, 1.0, 0.0, &one, false);
            let mut two = random_parent(n2, 1.2, turn, &two, true);
            two.x.iter_mut().for_each(|x| *x += Vec3::new(u, v, -0.05));
            (one, two)
        },
    )
}

/// g_A of the weights.
fn gaps(w: &ParentWeights, one: &ParentFacet, two: &ParentFacet, m: usize) -> Vec<Vec3> {
    let part = |of: &[f64; 9], facet: &ParentFacet| -> Vec3 {
        (0..facet.parent.n).map(|b| (facet.x[b] - one.x[0]) * of[b]).sum()
    };
    (0..m).map(|a| part(&w.ab[a], one) - part(&w.ac[a], two)).collect()
}

proptest! {
    #![proptest_config(cases(60))]

    /// sum_B n_AB = sum_C n_AC: momentum, at any rule and any shape.
    #[test]
    fn row_sums_of_both_sides_are_equal((one, two) in scene()) {
        for (_, space) in SPACES {
            let w = weights(&one, &two, space, &DEGREE_5);
            for a in 0..one.multipliers(space) {
                let (ab, ac) = (w.ab[a].iter().sum::<f64>(), w.ac[a].iter().sum::<f64>());
                prop_assert!((ab - ac).abs() < ROUNDING, "{ab} {ac}");
            }
        }
    }

    /// The moment of the forces about any point is sum_A g_A x p_A.
    #[test]
    fn the_moment_is_that_of_gaps_and_tractions((one, two) in scene()) {
        for (_, space) in SPACES {
            let (m, w) = (one.multipliers(space), weights(&one, &two, space, &DEGREE_5));
            let p: Vec<Vec3> = (0..m).map(|a| Vec3::new(0.3 * a as f64, 1.0 - 0.1 * a as f64, -0.7)).collect();
            let force = |of: &[[f64; 9]; 9], b: usize| -> Vec3 { (0..m).map(|a| p[a] * of[a][b]).sum() };
            let moment = |facet: &ParentFacet, of| -> Vec3 {
                (0..facet.parent.n).map(|b| (facet.x[b] - one.x[0]).cross(&force(of, b))).sum()
            };
            let expected: Vec3 = gaps(&w, &one, &two, m).iter().zip(&p).map(|(g, p)| g.cross(p)).sum();
            prop_assert!((moment(&one, &w.ab) - moment(&two, &w.ac) - expected).norm() < ROUNDING);
        }
    }

    /// Translations and rotations of everything leave the weights.
    #[test]
    fn derivatives_vanish_along_rigid_motions((one, two) in scene(), axis in prop::array::uniform3(-1.0..1.0_f64)) {
        for (_, space) in SPACES {
            let (_, d) = with_derivatives(&one, &two, space, &DEGREE_5);
            let n = [one.parent.n, two.parent.n];
            let nodes: Vec<Vec3> = one.x[..n[0]].iter().chain(&two.x[..n[1]]).copied().collect();
            for which in 0..2 {
                for (a, b) in (0..one.multipliers(space)).flat_map(|a| (0..n[which]).map(move |b| (a, b))) {
                    let along = |motion: &dyn Fn(&Vec3) -> Vec3| -> f64 {
                        let at = |k: usize| Vec3::from_fn(|j, _| d.at(which, a, b, k, j));
                        nodes.iter().enumerate().map(|(k, x)| at(k).dot(&motion(x))).sum()
                    };
                    let axis = Vec3::from(axis);
                    prop_assert!(along(&|_| axis).abs() < 10.0 * ROUNDING);
                    prop_assert!(along(&|x| axis.cross(x)).abs() < 10.0 * ROUNDING);
                }
            }
        }
    }

    /// On affine sub-facets, against differences of the weights: triangles of any shape, flat parallelograms.
    #[test]
    fn derivatives_are_those_of_differences((n1, n2) in (kinds(), kinds()),
        noise in prop::collection::vec(-1.0..1.0_f64, 27), turn in -3.0..3.0_f64, direction in prop::collection::vec(-1.0..1.0_f64, 54)) {
        let flat = vec![0.0; 27];
        // A plane that is tilted projects the other side's parallelograms on parallelograms.
        let of = |n: usize| if n == 3 || n == 6 { &noise } else { &flat };
        let one = random_parent(n1, 1.0, 0.0, of(n1), false);
        let mut two = random_parent(n2, 1.2, turn, of(n2), true);
        two.x.iter_mut().for_each(|x| *x += Vec3::new(0.21, -0.13, -0.05));
        for (_, space) in SPACES {
            let (_, d) = with_derivatives(&one, &two, space, &DEGREE_10);
            let n = [n1, n2];
            let at = |t: f64| {
                let (mut p, mut q) = (one, two);
                for (k, x) in p.x[..n1].iter_mut().chain(&mut q.x[..n2]).enumerate() {
                    *x += Vec3::from_column_slice(&direction[3 * k..3 * k + 3]) * t;
                }
                weights(&p, &q, space, &DEGREE_10)
            };
            let t = 1e-5;
            let (plus, minus) = (at(t), at(-t));
            for which in 0..2 {
                let of = |w: &ParentWeights| if which == 0 { w.ab } else { w.ac };
                for (a, b) in (0..one.multipliers(space)).flat_map(|a| (0..n[which]).map(move |b| (a, b))) {
                    let difference = (of(&plus)[a][b] - of(&minus)[a][b]) / (2.0 * t);
                    let along: f64 = (0..3 * (n1 + n2)).map(|k| d.at(which, a, b, k / 3, k % 3) * direction[k]).sum();
                    prop_assert!((difference - along).abs() < DIFFERENCES, "{n1} {n2} {which} {a} {b}: {difference} {along}");
                }
            }
        }
    }
}

/// G6: with `sub` the row sums are those of the linear mesh of the sub-facets.
#[test]
fn row_sums_of_sub_are_those_of_the_linear_mesh() {
    for case in golden_part("golden_quadratic.json", "pairs") {
        let (one, two) = (parent(&case["x1"]), parent(&case["x2"]));
        let found = weights(&one, &two, MultiplierSpace::Sub, &DEGREE_10);
        let mut expected = [0.0; 9];
        for s in 0..one.parent.subs.len() {
            let frame = NonmortarFrame::new(&one.sub(s)).unwrap();
            for t in 0..two.parent.subs.len() {
                let Some(segment) = Segment::new(&frame, &two.sub(t)).unwrap() else { continue };
                let linear = PairWeights::integrate(&frame, &segment, &DEGREE_10);
                let sub = &one.parent.subs[s];
                (0..sub.shape.n).for_each(|a| expected[sub.nodes[a]] += linear.ab[a].iter().sum::<f64>());
            }
        }
        let error = max_abs((0..9).map(|a| found.ab[a].iter().sum::<f64>() - expected[a]));
        assert!(error <= ROUNDING * max_abs(expected), "{}: {error:e}", name(&case));
    }
}

#[test]
fn facets_that_are_none_are_refused_by_name() {
    let kind = stickslip::shape::Parent::of(8).unwrap();
    let x: Vec<Vec3> = kind.at[..8].iter().map(|[u, v]| Vec3::new(*u, *v, 0.0)).collect();
    assert!(ParentFacet::new(&x).is_ok());
    let refused = ParentFacet::new(&x[..5]).unwrap_err();
    assert!(refused.kind == Kind::InvalidSize && refused.message.contains("5 nodes; 3, 4, 6, 8 or 9"), "{refused}");
    // A corner between two mid nodes, as other programs have them.
    let around: Vec<Vec3> = [0, 4, 1, 5, 2, 6, 3, 7].iter().map(|k| x[*k]).collect();
    // Mid nodes that begin one edge later.
    let shifted: Vec<Vec3> = [0, 1, 2, 3, 5, 6, 7, 4].iter().map(|k| x[*k]).collect();
    for wrong in [around, shifted] {
        let refused = ParentFacet::new(&wrong).unwrap_err();
        assert!(refused.kind == Kind::DegenerateFacet && refused.message.contains("mid node"), "{refused}");
    }
}

/// A mid node a quarter of its edge from a corner leaves that corner without a normal, and a nearer one turns it over: such
/// facets were taken, and a normal that points into the body went out.
#[test]
fn mid_nodes_at_a_quarter_are_refused() {
    for (n, mid) in [(6, 3), (8, 4), (9, 7)] {
        let kind = stickslip::shape::Parent::of(n).unwrap();
        let (from, to) = (mid - kind.corners(), (mid - kind.corners() + 1) % kind.corners());
        for (s, fine) in
            [(0.5, true), (0.3, true), (0.26, true), (0.25, false), (0.2, false), (0.02, false), (0.8, false)]
        {
            let mut x: Vec<Vec3> = kind.at[..n].iter().map(|[u, v]| Vec3::new(*u, *v, 0.0)).collect();
            x[mid] = x[from] + (x[to] - x[from]) * s;
            let facet = ParentFacet::new(&x);
            assert_eq!(facet.is_ok(), fine, "{n} nodes, at {s}");
            match facet {
                Ok(facet) => {
                    assert!((0..n).all(|k| (facet.normal(k) - Vec3::z()).norm() < ROUNDING), "{n} nodes, at {s}")
                }
                Err(e) => {
                    assert!(e.kind == Kind::DegenerateFacet && e.message.contains("farther than a quarter"), "{e}")
                }
            }
        }
    }
}

/// On a paraboloid over a square or a triangle the facets are exact: their normals are those of z = (x^2 + 2 y^2) / 5.
#[test]
fn normals_of_curved_facets_are_those_of_the_surface() {
    for n in [6, 8, 9] {
        let kind = stickslip::shape::Parent::of(n).unwrap();
        let at = |k: usize| (kind.at[k][0], kind.at[k][1]);
        let x: Vec<Vec3> = (0..n).map(at).map(|(u, v)| Vec3::new(u, v, 0.2 * (u * u + 2.0 * v * v))).collect();
        let facet = ParentFacet::new(&x).unwrap();
        for k in 0..n {
            let (u, v) = at(k);
            let expected = Vec3::new(-0.4 * u, -0.8 * v, 1.0).normalize();
            assert!((facet.normal(k) - expected).norm() < ROUNDING, "{n} nodes, node {k}: {}", facet.normal(k));
        }
        // Areas are of the sub-facets: their sum is that of the facets of the linear mesh.
        for (_, space) in SPACES {
            let areas = facet.areas(space).unwrap();
            let frame = |s| NonmortarFrame::new(&facet.sub(s)).unwrap().nodal_areas().iter().sum::<f64>();
            let expected: f64 = (0..kind.subs.len()).map(frame).sum();
            assert!((areas.iter().sum::<f64>() - expected).abs() < ROUNDING && areas.iter().all(|a| *a >= 0.0));
        }
    }
}
