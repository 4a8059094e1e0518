//! Points on the whole non-mortar facet in place of cells of the overlap (`mortar/element_rule.rs`): every point counts
//! once, the derivatives are those of the sums, and what the rule cannot do.

use crate::support::mesh::*;
use stickslip::geometry::{Facet, Vec3};
use stickslip::interface::{Options, Scheme};
use stickslip::mortar::{CellPoints, MORTAR, NonmortarFrame, PairWeights, Segment, WeightDerivatives};
use stickslip::quadrature::{DEGREE_5, cell};

/// Sums of some hundred products.
const ROUNDING: f64 = 1e-14;
/// Against central differences, relative to the largest entry: rounding 1e-16 / 1e-6 and truncation 1e-12.
const DIFFERENCES: f64 = 1e-7;
/// Half the difference's length; facets are 0.5 to 1 long.
const STEP: f64 = 1e-6;

fn line(points: usize) -> &'static [[f64; 2]] {
    cell::line_of(points).unwrap()
}

fn facet(mesh: &Mesh, f: usize) -> Facet {
    Facet::new(&mesh.facets[f].iter().map(|&k| mesh.x[k as usize]).collect::<Vec<_>>()).unwrap()
}

/// Surfaces one of which covers the other, rough or with all edges in common.
fn surfaces(cells: [Cells; 2], matching: bool, seed: u64) -> (Mesh, Mesh) {
    let mut random = Random(seed);
    let mut one = grid(4, 4, [0.0, 0.0], [2.0, 2.0], 0.0, false, cells[0]);
    let (a, b) = if matching { (-0.5, 2.5) } else { (-0.45, 2.4) };
    let mut two = grid(if matching { 6 } else { 7 }, 6, [a, a], [b, b], 0.0, true, cells[1]);
    if !matching {
        one.x.iter_mut().chain(&mut two.x).for_each(|x| *x += random.vector(0.02));
    }
    let frame = nalgebra::Rotation3::from_euler_angles(0.4, -0.9, 1.3);
    one.x.iter_mut().chain(&mut two.x).for_each(|x| *x = frame * *x);
    (one, two)
}

const KINDS: [[Cells; 2]; 4] = [
    [Cells::Quads, Cells::Quads],
    [Cells::Triangles, Cells::Triangles],
    [Cells::Quads, Cells::Triangles],
    [Cells::Triangles, Cells::Quads],
];

/// Also where points lie on mortar edges and nodes, as in meshes that match (odd rules have a point in the middle).
#[test]
fn every_point_counts_exactly_once() {
    for (cells, matching) in KINDS.into_iter().flat_map(|c| [(c, false), (c, true)]) {
        for points in 2..=10 {
            let (one, two) = surfaces(cells, matching, points as u64);
            for f in 0..one.facets.len() {
                let frame = NonmortarFrame::new(&facet(&one, f)).unwrap();
                let (mut seen, mut coverage) = (0_u128, [0.0; 4]);
                for g in 0..two.facets.len() {
                    let Some(segment) = Segment::of_points(&frame, &facet(&two, g), line(points)).unwrap() else {
                        continue;
                    };
                    let inside = segment.points.unwrap().inside;
                    assert_eq!(seen & inside, 0, "a point lies on two facets");
                    seen |= inside;
                    let w = PairWeights::integrate(&frame, &segment, &DEGREE_5);
                    for a in 0..4 {
                        coverage[a] += w.coverage(a);
                        assert!((w.coverage(a) - w.ac[a].iter().sum::<f64>()).abs() < ROUNDING);
                    }
                }
                assert_eq!(seen, CellPoints::all(&frame, line(points)), "{points} points: one lies on no facet");
                for (covered, area) in coverage.into_iter().zip(frame.nodal_areas()) {
                    assert!((covered - area).abs() < ROUNDING, "{points} points: {covered} of {area}");
                }
            }
        }
    }
}

/// Under one facet there is no kink: with enough points the weights are those of the cells.
#[test]
fn equals_cells_under_one_parallelogram() {
    let one = Facet::new(&[Vec3::zeros(), Vec3::y(), Vec3::new(1.0, 1.2, 0.1), Vec3::new(1.0, 0.2, 0.1)]).unwrap();
    let two = [[-1.0, -1.0, 0.1], [2.0, -1.1, 0.1], [2.0, 2.0, 0.2], [-1.0, 2.1, 0.2]].map(Vec3::from);
    let (frame, two) = (NonmortarFrame::new(&one).unwrap(), Facet::new(&two).unwrap());
    let cells = Segment::new(&frame, &two).unwrap().unwrap();
    let points = Segment::of_points(&frame, &two, line(4)).unwrap().unwrap();
    assert!((cells.area - points.area).abs() < ROUNDING);
    let (w, dw) = WeightDerivatives::integrate(&frame, &cells, &DEGREE_5);
    let (v, dv) = WeightDerivatives::integrate(&frame, &points, &DEGREE_5);
    for (a, k) in (0..4).flat_map(|a| (0..4).map(move |k| (a, k))) {
        assert!((w.ab[a][k] - v.ab[a][k]).abs() < ROUNDING && (w.ac[a][k] - v.ac[a][k]).abs() < ROUNDING);
        for (n, i) in (0..MORTAR + 4).flat_map(|n| (0..3).map(move |i| (n, i))) {
            assert!((dw.ab[a][k][n][i] - dv.ab[a][k][n][i]).abs() < ROUNDING);
            assert!((dw.ac[a][k][n][i] - dv.ac[a][k][n][i]).abs() < ROUNDING);
        }
    }
}

fn weights(one: &[Vec3], two: &[Vec3], points: usize) -> (u128, PairWeights, WeightDerivatives) {
    let (one, two) = (Facet::new(one).unwrap(), Facet::new(two).unwrap());
    let frame = NonmortarFrame::new(&one).unwrap();
    match Segment::of_points(&frame, &two, line(points)).unwrap() {
        Some(segment) => {
            let (w, d) = WeightDerivatives::integrate(&frame, &segment, &DEGREE_5);
            assert_eq!(w, PairWeights::integrate(&frame, &segment, &DEGREE_5));
            (segment.points.unwrap().inside, w, d)
        }
        None => (0, PairWeights::default(), WeightDerivatives::default()),
    }
}

#[test]
fn derivatives_are_those_of_the_sums() {
    let mut compared = 0;
    for cells in KINDS {
        for points in [2, 3, 5, 10] {
            let (one, two) = surfaces(cells, false, 3 + points as u64);
            let of = |mesh: &Mesh, f: usize| mesh.facets[f].iter().map(|&k| mesh.x[k as usize]).collect::<Vec<_>>();
            for (f, g) in (0..one.facets.len()).step_by(3).flat_map(|f| (0..two.facets.len()).map(move |g| (f, g))) {
                let (one, two) = (of(&one, f), of(&two, g));
                let (inside, _, d) = weights(&one, &two, points);
                if inside == 0 {
                    continue;
                }
                let scale = d.ab.iter().chain(&d.ac).flatten().flatten().flatten().fold(0.0_f64, |m, v| m.max(v.abs()));
                for k in 0..one.len() + two.len() {
                    let slot = if k < one.len() { k } else { MORTAR + k - one.len() };
                    for i in 0..3 {
                        let at = |h: f64| {
                            let (mut one, mut two) = (one.clone(), two.clone());
                            if k < one.len() {
                                one[k][i] += h
                            } else {
                                two[k - one.len()][i] += h
                            }
                            weights(&one, &two, points)
                        };
                        let ((before, v, _), (after, w, _)) = (at(-STEP), at(STEP));
                        if before != inside || after != inside {
                            continue; // a point passed an edge
                        }
                        compared += 1;
                        for (a, b) in (0..4).flat_map(|a| (0..4).map(move |b| (a, b))) {
                            let ab = (w.ab[a][b] - v.ab[a][b]) / (2.0 * STEP) - d.ab[a][b][slot][i];
                            let ac = (w.ac[a][b] - v.ac[a][b]) / (2.0 * STEP) - d.ac[a][b][slot][i];
                            assert!(ab.abs().max(ac.abs()) <= DIFFERENCES * scale, "node {k}, {i}: {ab:e}, {ac:e}");
                        }
                    }
                }
            }
        }
    }
    assert!(compared > 10_000, "only {compared} columns");
}

#[test]
fn the_tangent_of_an_interface_is_that_of_the_sums() {
    let rough = Roughness { warp: 0.05, jitter: 0.08, slide: 0.02 };
    for cells in KINDS {
        for integration in [Scheme::Elements(line(3)), Scheme::Hybrid(line(4))] {
            let options = Options { scheme: integration, ..options() };
            let Moved { mut interface, x1, x2, lambda } = moved(&options, cells, rough, 7);
            let mut point =
                crate::support::differences::Point { contact: &mut interface, x1: &x1, x2: &x2, lambda: &lambda };
            let error = point.difference_error(1.0);
            assert!(error <= DIFFERENCES, "{integration:?}: off by {error:e}");
        }
    }
}

/// Also after a commit, which forgets overlaps that are found again; and with cells where the mortar surface ends.
#[test]
fn hybrid_takes_cells_where_a_facet_is_partly_covered() {
    let one = grid(4, 4, [0.0, 0.0], [2.0, 2.0], 0.0, false, Cells::Quads);
    let two = grid(3, 3, [-0.1, -0.1], [1.3, 2.1], 0.0, true, Cells::Quads);
    let of = |integration| {
        let mut contact = interface(&one, &two, Options { scheme: integration, mu: 0.0, ..options() });
        let lambda = vec![Vec3::zeros(); one.x.len()];
        contact.commit(&one.x, &two.x, &lambda, None).unwrap();
        contact.tangent(&one.x, &two.x, &lambda, None, &mut |_: i64, _: i64, _: f64| {}).unwrap();
        let coverage: Vec<_> = contact.history().coverage.clone();
        (contact.counters(), coverage)
    };
    let [cells, points, hybrid] = [Scheme::Segments, Scheme::Elements(line(3)), Scheme::Hybrid(line(3))].map(of);
    assert_eq!(points.0.pairs_clipped, 0);
    assert!(0 < hybrid.0.pairs_clipped && hybrid.0.pairs_clipped < cells.0.pairs_clipped);
    let error = |a: &[f64]| a.iter().zip(&cells.1).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    // Nodes at the rim of the mortar surface: a tenth of a facet's area with points alone.
    assert!(error(&hybrid.1) < ROUNDING && error(&points.1) > 0.005, "{:e}", error(&points.1));
}
