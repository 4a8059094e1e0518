//! Weights and their derivatives against the golden pairs.

use crate::support::*;
use serde_json::Value;
use stickslip::error::Kind;
use stickslip::geometry::{Facet, Vec3};
use stickslip::mortar::{MORTAR, NonmortarFrame, PairWeights, Segment, WeightDerivatives};
use stickslip::quadrature::{DEGREE_5, DEGREE_10, Rule};

/// W1: relative part, a few hundred roundings of the sums.
const WEIGHTS_RELATIVE: f64 = 1e-13;
/// W1: absolute part (times the squared facet size): rounding of the projected coordinates.
const WEIGHTS_ABSOLUTE: f64 = 4e-15;
/// W8: derivatives of affine pairs, relative to the largest one.
const DERIVATIVES_RELATIVE: f64 = 1e-12;
/// W8 at near-parallel crossings, whose place is known to 1e-11.
const DERIVATIVES_AT_SMALL_ANGLE: f64 = 1e-10;
/// W2: the degree-5 rule on warped or distorted quads (worst golden case: the flat kite).
const RULE_ERROR_DEGREE_5: f64 = 2e-5;
/// The degree-10 rule on the same.
const RULE_ERROR_DEGREE_10: f64 = 1e-8;
/// The 7-point rule's derivative on warped quads, transport form (measured 3.2e-5 on the kite).
const DERIVATIVE_RULE_ERROR: f64 = 1e-4;

struct Pair {
    one: Facet,
    two: Facet,
    frame: NonmortarFrame,
    segment: Option<Segment>,
}

impl Pair {
    fn new(one: Facet, two: Facet) -> Pair {
        let frame = NonmortarFrame::new(&one).unwrap();
        let segment = Segment::new(&frame, &two).unwrap();
        Pair { one, two, frame, segment }
    }

    fn weights(&self, rule: &Rule) -> PairWeights {
        self.segment.as_ref().map(|s| PairWeights::integrate(&self.frame, s, rule)).unwrap_or_default()
    }

    fn derivatives(&self, rule: &Rule) -> WeightDerivatives {
        self.segment.as_ref().map(|s| WeightDerivatives::integrate(&self.frame, s, rule).1).unwrap_or_default()
    }

    fn slot(&self, k: usize) -> usize {
        if k < self.one.len() { k } else { MORTAR + k - self.one.len() }
    }
}

fn pair(case: &Value) -> Pair {
    Pair::new(facet(&case["x1"]), facet(&case["x2"]))
}

fn weight_error(w: &PairWeights, ab: &Value, ac: &Value) -> (f64, f64) {
    let (ab, ac) = (table(ab), table(ac));
    let mut error = 0.0_f64;
    let mut largest = 0.0_f64;
    for a in 0..ab.len() {
        for b in 0..ab[a].len() {
            error = error.max((w.ab[a][b] - ab[a][b]).abs());
            largest = largest.max(ab[a][b].abs());
        }
        for c in 0..ac[a].len() {
            error = error.max((w.ac[a][c] - ac[a][c]).abs());
            largest = largest.max(ac[a][c].abs());
        }
    }
    (error, largest)
}

fn derivative_error(p: &Pair, d: &WeightDerivatives, ab: &Value, ac: &Value) -> f64 {
    let (mut error, mut largest) = (0.0_f64, 0.0_f64);
    for (blocks, expected) in [(&d.ab, ab), (&d.ac, ac)] {
        for (a, row) in expected.as_array().unwrap().iter().enumerate() {
            for (b, columns) in row.as_array().unwrap().iter().enumerate() {
                for (j, v) in numbers(columns).into_iter().enumerate() {
                    error = error.max((blocks[a][b][p.slot(j / 3)][j % 3] - v).abs());
                    largest = largest.max(v.abs());
                }
            }
        }
    }
    if largest > 0.0 { error / largest } else { error }
}

#[test]
fn golden_weights() {
    for case in golden("golden_pairs.json") {
        let p = pair(&case);
        let size = p.one.longest_edge();
        let w = p.weights(&DEGREE_5);
        let (error, largest) = weight_error(&w, &case["nAB"], &case["nAC"]);
        let bound = WEIGHTS_RELATIVE * largest + WEIGHTS_ABSOLUTE * size * size;
        assert!(error <= bound, "{}: weights off by {error:e}, allowed {bound:e}", name(&case));
        if case["affine"] == false {
            for (rule, allowed) in [(&DEGREE_5, RULE_ERROR_DEGREE_5), (&DEGREE_10, RULE_ERROR_DEGREE_10)] {
                let (error, largest) = weight_error(&p.weights(rule), &case["nAB_exact"], &case["nAC_exact"]);
                assert!(error <= allowed * largest, "{}: exact weights off by {:e}", name(&case), error / largest);
            }
        }
        if case["overlap"] == false {
            assert_eq!(w, PairWeights::default(), "{}: zero overlap is exactly zero", name(&case));
        }
    }
}

#[test]
fn golden_derivatives() {
    let mut seen = 0;
    for case in golden("golden_pairs.json") {
        let p = pair(&case);
        if name(&case).contains("corner_sliver") {
            // A mortar vertex lies on a non-mortar edge: the tabulated derivative misses that edge's
            // part (rational arithmetic says so); see corner_sliver_derivative_is_that_of_the_area.
            continue;
        }
        if case["affine"] == true && case.get("dnAB").is_some_and(Value::is_array) {
            let error = derivative_error(&p, &p.derivatives(&DEGREE_5), &case["dnAB"], &case["dnAC"]);
            let bound = if name(&case).contains("angle") { DERIVATIVES_AT_SMALL_ANGLE } else { DERIVATIVES_RELATIVE };
            println!("{:40} {error:.1e}", name(&case));
            assert!(error <= bound, "{}: derivatives off by {error:e}", name(&case));
            seen += 1;
        } else if case.get("dnAB_exact").is_some_and(Value::is_array) {
            let error = derivative_error(&p, &p.derivatives(&DEGREE_5), &case["dnAB_exact"], &case["dnAC_exact"]);
            println!("{:40} {error:.1e} (rule)", name(&case));
            assert!(error <= DERIVATIVE_RULE_ERROR, "{}: derivatives off by {error:e}", name(&case));
            seen += 1;
        }
    }
    assert!(seen >= 3);
}

/// Pairs in general position, where the projection rounds, with edges that cross at 1e-2 to 1e-15
/// (tests/stability/slanted_pairs.py): the error was eps over the angle, and one side of a kink below 1e-13.
#[test]
fn slanted_pairs_have_exact_derivatives_at_any_angle() {
    let file: Value = serde_json::from_str(include_str!("../data/slanted_pairs.json")).unwrap();
    let cases = file["cases"].as_array().unwrap();
    assert_eq!(cases.len(), 8);
    for case in cases {
        let p = pair(case);
        let error = derivative_error(&p, &p.derivatives(&DEGREE_5), &case["dnAB"], &case["dnAC"]);
        println!("{:40} {error:.1e}", name(case));
        assert!(error <= DERIVATIVES_AT_SMALL_ANGLE, "{}: derivatives off by {error:e}", name(case));
    }
}

#[test]
fn derivative_is_invariant_and_homogeneous() {
    for case in golden("golden_pairs.json") {
        let p = pair(&case);
        let d = p.derivatives(&DEGREE_5);
        let w = p.weights(&DEGREE_5);
        let nodes = p.one.len() + p.two.len();
        let x = |k: usize| {
            let origin = p.one.nodes[0];
            if k < p.one.len() { p.one.nodes[k] - origin } else { p.two.nodes[k - p.one.len()] - origin }
        };
        let omega = Vec3::new(0.3, -0.7, 0.5);
        for a in 0..p.one.len() {
            let rows = (0..p.one.len()).map(|b| (d.ab[a][b], w.ab[a][b]));
            let rows = rows.chain((0..p.two.len()).map(|c| (d.ac[a][c], w.ac[a][c])));
            for (row, n) in rows {
                let row = row.map(Vec3::from);
                let scale = (0..nodes).map(|k| row[p.slot(k)].norm() * x(k).norm()).sum::<f64>() + n.abs();
                let shift: Vec3 = (0..nodes).map(|k| row[p.slot(k)]).sum();
                let reach = (0..nodes).map(|k| x(k).norm()).fold(0.0, f64::max);
                assert!(shift.norm() * reach <= 1e-12 * scale, "{}: translation", name(&case));
                let turn: f64 = (0..nodes).map(|k| row[p.slot(k)].dot(&omega.cross(&x(k)))).sum();
                assert!(turn.abs() <= 1e-12 * scale, "{}: rotation {turn:e} of {scale:e}", name(&case));
                let euler: f64 = (0..nodes).map(|k| row[p.slot(k)].dot(&x(k))).sum();
                let euler_bound = if case["affine"] == true { 1e-12 } else { DERIVATIVE_RULE_ERROR };
                let absolute = WEIGHTS_ABSOLUTE * reach * reach;
                assert!((euler - 2.0 * n).abs() <= euler_bound * scale + absolute, "{}: Euler", name(&case));
            }
        }
    }
}

/// The overlap is a triangle of height 1e-6 at node 2, cut off by a mortar edge whose end lies on the
/// non-mortar edge. d area / d x, computed in rational arithmetic on both sides of the configuration.
#[test]
fn corner_sliver_derivative_is_that_of_the_area() {
    let f = |x: [[f64; 2]; 4]| Facet::new(&x.map(|p| Vec3::new(p[0], p[1], 0.0))).unwrap();
    let p = Pair::new(
        f([[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]]),
        f([
            [1.0, 0.999999],
            [1.7071067811865475, 1.7071057811865473],
            [1.0, 2.414212562373095],
            [0.29289321881345254, 1.7071057811865475],
        ]),
    );
    let d = p.derivatives(&DEGREE_5);
    let area = |k: usize, i: usize| {
        (0..4).flat_map(|a| (0..4).map(move |b| (a, b))).map(|(a, b)| d.ab[a][b][k][i]).sum::<f64>()
    };
    // The sliver's height is a difference of coordinates near 1: 1e-16 / 1e-6 of relative accuracy.
    let accuracy = 1e-9; // of the largest, 1e-6
    for (k, i, exact) in [(2, 0, 9.999995000287507e-07), (2, 1, 9.999995000287507e-07), (3, 0, 5.000000000287556e-13)] {
        assert!((area(k, i) - exact).abs() <= accuracy * 1e-6, "node {k}, component {i}: {:e}", area(k, i));
    }
}

/// A strip of overlap, or four edges that cross at a small angle: the derivative knows no smallest width.
/// d area / d shift is the strip's length; two unit squares turned by t share the area 2 / (1 + cos t + sin t).
#[test]
fn derivative_is_right_down_to_the_thinnest_strip() {
    let square = |x: f64, y: f64, turn: f64, down: bool| {
        let q = nalgebra::Rotation3::from_euler_angles(0.0, 0.0, turn);
        let mut p = [[x, y], [x + 1.0, y], [x + 1.0, y + 1.0], [x, y + 1.0]].map(|p| q * Vec3::new(p[0], p[1], 0.0));
        if down {
            p.reverse();
        }
        Facet::new(&p).unwrap()
    };
    let area = |d: &WeightDerivatives, k: usize, i: usize| -> f64 {
        (0..4).flat_map(|a| (0..4).map(move |b| (a, b))).map(|(a, b)| d.ab[a][b][k][i]).sum()
    };
    for exponent in 1..=12 {
        let width = 10f64.powi(-exponent);
        let p = Pair::new(square(0.0, 0.0, 0.0, false), square(1.0 - width, 0.125, 0.0, true));
        let d = p.derivatives(&DEGREE_5);
        let shift: f64 = (0..4).map(|k| area(&d, MORTAR + k, 0)).sum();
        assert!((shift + 0.875).abs() < 1e-12, "strip of {width:e}: {shift}");

        let p = Pair::new(square(-0.5, -0.5, 0.0, false), square(-0.5, -0.5, width, true));
        let d = p.derivatives(&DEGREE_5);
        let turn: f64 = (0..4)
            .map(|k| {
                let x = p.two.nodes[k];
                area(&d, MORTAR + k, 1) * x.x - area(&d, MORTAR + k, 0) * x.y
            })
            .sum();
        let exact = {
            let (s, c) = width.sin_cos();
            -2.0 * (c - s) / (1.0 + c + s).powi(2)
        };
        // The corners' own rounding moves the crossings by 1e-16 / width.
        assert!((turn - exact).abs() < 1e-12 + 1e-20 / width, "angle {width:e}: {turn} instead of {exact}");
    }
}

/// A kite that is covered in full: its nodal areas are exact, its coverage has the error of the rule, and may be the
/// larger of the two. Random pairs were once held to a bound at rounding there, which some 1e-7 of them break.
#[test]
fn coverage_of_a_whole_kite_exceeds_its_area_by_the_error_of_the_rule() {
    let kite =
        Facet::new(&[[-1.0, 0.0], [0.0, -0.5], [0.625, 0.0], [0.0, 0.875]].map(|[x, y]| Vec3::new(x, y, 0.0))).unwrap();
    let cover =
        Facet::new(&[[-2.0, -2.0], [-2.0, 2.0], [2.0, 2.0], [2.0, -2.0]].map(|[x, y]| Vec3::new(x, y, 0.0))).unwrap();
    let p = Pair::new(kite, cover);
    let (areas, area) = (p.frame.nodal_areas(), 0.5 * p.frame.projection.area2);
    let excess = |rule: &Rule| {
        let w = p.weights(rule);
        (0..4).map(|a| (w.coverage(a) - areas[a]) / area).fold(0.0, f64::max)
    };
    assert!(excess(&DEGREE_5) > 1e3 * WEIGHTS_RELATIVE, "{:e}", excess(&DEGREE_5));
    assert!(excess(&DEGREE_5) <= RULE_ERROR_DEGREE_5 && excess(&DEGREE_10) <= RULE_ERROR_DEGREE_10);
    let total: f64 = (0..4).map(|a| p.weights(&DEGREE_5).coverage(a)).sum();
    assert!((total - area).abs() <= WEIGHTS_RELATIVE * area);
}

/// A mortar facet whose nodes lie in a line, but for rounding: it has no area, covers nothing, and no inverse of its map
/// may tell where on it a point is. It had weights whose sums differed in the fifth digit; others like it, derivatives
/// that were no numbers.
#[test]
fn a_mortar_facet_without_area_covers_nothing() {
    let one = Facet::new(&[
        Vec3::new(0.010000964489624474, -0.0070002641207380775, 0.004),
        Vec3::new(0.01, -0.006999999999999999, 0.004),
        Vec3::new(0.009999186847828617, -0.006999183240327303, 0.004000819565240377),
        Vec3::new(0.010001115827077566, -0.006999711481803459, 0.004000819565240377),
    ]);
    let two = Facet::new(&[
        Vec3::new(0.01, -0.006999999999999999, 0.004),
        Vec3::new(0.010000964489624474, -0.0070002641207380775, 0.004),
        Vec3::new(0.010001928979248946, -0.007000528241476154, 0.004),
    ]);
    let p = Pair::new(one.unwrap(), two.unwrap());
    assert!(p.segment.is_none());
}

/// Of a non-mortar facet a million times as large, rounding made it cover something, with weights that were no numbers.
#[test]
fn a_line_far_from_the_middle_of_a_large_facet_covers_nothing() {
    let corners = [[7.5625, 3.8125, 7.5625], [-625000.0, -4.125, 3.8125], [7.5625, -625000.0, -4.124999999999999]];
    let line = [0.062499046325683594, 2.875, 0.0625, -0.0625].map(|x| Vec3::new(x, -0.0625, -0.0625));
    let frame = NonmortarFrame::new(&Facet::new(&corners.map(Vec3::from)).unwrap()).unwrap();
    assert!(Segment::new(&frame, &Facet::new(&line).unwrap()).unwrap().is_none());
}

/// A quadrilateral with an edge that is seen end-on: at both of its corners the map is singular but for rounding. It had
/// weights that were no numbers at a point of that edge.
/// Of a mortar facet that reaches up from the plane by ever more of its width: weights and derivatives are numbers, or it
/// covers nothing, as one seen edge-on does. Its place in the plane has the rounding of the plane's normal, times height.
#[test]
fn a_facet_far_taller_than_wide_covers_nothing() {
    let turn = nalgebra::Rotation3::new(Vec3::new(0.3, -0.8, 0.5));
    let facet = |x: &[[f64; 3]]| Facet::new(&x.iter().map(|&x| turn * Vec3::from(x)).collect::<Vec<_>>()).unwrap();
    let one = facet(&[[0.0, 0.0, 0.0], [1.0, 0.1, 0.0], [0.9, 1.2, 0.0], [-0.1, 0.8, 0.0]]);
    let frame = NonmortarFrame::new(&one).unwrap();
    let mut covered = 0;
    for power in 0..70 {
        let two = facet(&[[0.2, 0.2, 0.1], [0.3, 0.9, 0.1], [1.4, 0.5, 10_f64.powi(power)]]);
        let Some(segment) = Segment::new(&frame, &two).unwrap() else {
            assert!(power >= 9, "{power}");
            continue;
        };
        assert!(power <= 10, "{power}");
        covered += 1;
        for rule in [&DEGREE_5, &DEGREE_10] {
            let (w, d) = WeightDerivatives::integrate(&frame, &segment, rule);
            assert!(w.ab.iter().chain(&w.ac).flatten().all(|v| v.is_finite()), "{power}");
            assert!(d.ab.iter().chain(&d.ac).flatten().flatten().flatten().all(|v| v.is_finite()), "{power}");
        }
    }
    assert!(covered >= 9, "{covered}");
}

#[test]
fn a_facet_with_a_vanishing_edge_is_refused() {
    let one = [[4.0625, 2.0625, 0.0], [-0.0625, -0.0625, -0.0625], [-0.0625, -0.0625, 1e-5], [4.0625, -4.125, -0.0625]];
    let two = [[-0.0625, -0.0625, 2.5625], [0.6875, 1.0, 1.0], [1.0, 1.0, 1.0]];
    let one = Facet::new(&one.map(Vec3::from)).unwrap();
    let two = Facet::new(&two.map(Vec3::from)).unwrap();
    if let Ok(frame) = NonmortarFrame::new(&one) {
        let segment = Segment::new(&frame, &two).unwrap().unwrap();
        let w = PairWeights::integrate(&frame, &segment, &DEGREE_5);
        panic!("{:?} {:?} {w:?}", frame.map.determinant(), frame.projection.y);
    }
}

/// A quadrilateral with three nodes on a line, seen nearly edge-on: its area is 1e-12 of its squared size, and of that
/// rounding made a corner, at which the map's determinant came out as 0. It had weights, and derivatives that were no
/// numbers with the rule of degree 10. Ten thousand times as wide, its corner is refused.
#[test]
fn a_straight_corner_that_rounding_bends_has_no_weights() {
    let one = [[5.9375, -1.6249999999, -1.625], [-1.625, -7.5, -2.0625], [-1.625, -1.625, -1.625]];
    let two = [[-1.625, -1.625, -1.625], [-1.625, -1.625, -1.875], [-1.625, -1.625, -5.625], [-1.625, 1.0, 1.0]];
    let wide = [[-1.625, -1.625, -1.625], [-1.625, -1.625, -1.875], [-1.625, -1.625, -5.625], [-1.62499999, 1.0, 1.0]];
    let frame = NonmortarFrame::new(&Facet::new(&one.map(Vec3::from)).unwrap()).unwrap();
    assert!(Segment::new(&frame, &Facet::new(&two.map(Vec3::from)).unwrap()).unwrap().is_none());
    let error = Segment::new(&frame, &Facet::new(&wide.map(Vec3::from)).unwrap()).unwrap_err();
    assert_eq!(error.kind, Kind::ProjectionNotConvex, "{error}");
}

/// A corner that is straight but for 1e-4 is one beside a facet of its size, where it holds against rounding, and none
/// under one that is 1e9 times as large: the points of that facet's edges are not known so well.
#[test]
fn how_convex_a_corner_must_be_depends_on_the_sizes() {
    let kite = [[0.0, 0.0], [0.5, -1e-4], [1.0, 0.0], [0.5, 1.0]].map(|[x, y]| Vec3::new(x, y, 0.0));
    let over = |size: f64| {
        let x = [[0.3, 0.3], [-1.0, 0.5], [-1.0, -1.0], [0.4, -1.0]];
        Facet::new(&x.map(|[x, y]| Vec3::new(x * size, y * size, 0.0))).unwrap()
    };
    let kite = Facet::new(&kite).unwrap();
    let overlap = |one: &Facet, two: &Facet| Segment::new(&NonmortarFrame::new(one).unwrap(), two);
    for size in [1.0, 1e3] {
        assert!(overlap(&kite, &over(size)).unwrap().is_some() && overlap(&over(size), &kite).unwrap().is_some());
    }
    for (one, two) in [(kite, over(1e9)), (over(1e9), kite)] {
        assert_eq!(overlap(&one, &two).unwrap_err().kind, Kind::ProjectionNotConvex);
    }
}
