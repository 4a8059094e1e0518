//! Against facets: a plane is one large facet, a ball what facets of a ball tend to.

use super::*;
use crate::support::mesh::options;
use stickslip::interface::Weights;
use stickslip::law::{SlipMeasure, State};
use stickslip::quadrature::DEGREE_10;

/// Steps over a plane, analytic and one large facet: the same numbers. `gap`: uniform height over the plane.
fn walk_over_plane<const N: usize>(options: Options, cells: Cells, gap: f64)
where
    Contact<N>: Create,
{
    let (q, shift, mut random) = (askew(), Vec3::new(3.0, -2.0, 1.0), Random(5));
    let mut mesh = grid(3, 2, [0.0, 0.0], [1.0, 1.2], gap, false, cells);
    let flat = mesh.x.clone();
    mesh.x = turned(&q, shift, &flat);
    let big = grid(1, 1, [-9.0, -8.0], [9.0, 10.0], 0.0, true, Cells::Quads);
    let big = Mesh { x: turned(&q, shift, &big.x), ..big };
    let frame = turned(&q, shift, &frame_of(AnalyticShape::Plane));
    let facet = Surface::new("mortar", big.x.clone(), &big.facets, vec![[-1; 3]; 4]).unwrap();
    let mut facets = Contact::create(nonmortar(&mesh), facet, options).unwrap();
    let mut plane: Contact<N> = against(&mesh, AnalyticShape::Plane, &frame, options).unwrap();
    let mut seen = [0; 3];
    for step in 1..=3 {
        // Slides, stretches and shears in the plane; the plane moves as well, along itself.
        let s = f64::from(step);
        let strain = |x: &Vec3| x + Vec3::new(0.003 * x.x - 0.002 * x.y + 0.01, 0.004 * x.y, 0.0) * s;
        let x1 = turned(&q, shift, &flat.iter().map(strain).collect::<Vec<_>>());
        let along = q * Vec3::new(-0.002, 0.003, 0.0) * s;
        let move_all = |x: &[Vec3]| x.iter().map(|x| x + along).collect::<Vec<_>>();
        let (x2, frame2) = (move_all(&big.x), move_all(&frame));
        let lambda = multipliers(x1.len(), &q, &mut random);
        let a = facets.residual(&x1, &x2, &lambda, None).unwrap();
        let b = plane.residual(&x1, &frame2, &lambda, None).unwrap();
        close(&equations_of(&b), &equations_of(&a), ROUNDING, "residual");
        let sum = |f: &[Vec3]| f.iter().sum::<Vec3>().as_slice().to_vec();
        close(&sum(&b.mortar), &sum(&a.mortar), ROUNDING, "mortar resultant");
        if N == 1 || gap == 0.0 {
            // Over a tilting facet the gap of facets turns with its normal; that of the plane does not.
            let (a, b) = (dense(&mut facets, &x1, &x2, &lambda), dense(&mut plane, &x1, &frame2, &lambda));
            close(&b, &a, ROUNDING, "tangent");
        }
        let responses = facets.responses(&x1, &x2, &lambda, None).unwrap();
        for (a, b) in responses.iter().zip(plane.responses(&x1, &frame2, &lambda, None).unwrap()) {
            assert_eq!(a.state, b.state);
            seen[a.state as usize] += 1;
        }
        facets.commit(&x1, &x2, &lambda, None).unwrap();
        plane.commit(&x1, &frame2, &lambda, None).unwrap();
        if !plane.history().slip.is_empty() {
            close(&flatten(&plane.history().slip), &flatten(&facets.history().slip), ROUNDING, "slip");
        }
    }
    let closed = if N == 1 { seen[State::Slip as usize] } else { seen[1].min(seen[2]) };
    assert!(seen[0] > 0 && closed > 0, "states {seen:?}");
}

#[test]
fn plane_equals_a_large_facet() {
    let cells = [Cells::Quads, Cells::Triangles];
    for (cells, basis) in cells.into_iter().flat_map(|cells| BASES.map(|basis| (cells, basis))) {
        let options = || Options { basis, ..options() };
        for slip in [SlipMeasure::Objective, SlipMeasure::Increment, SlipMeasure::Paper] {
            for weights in [Weights::Current, Weights::Committed, Weights::Reference] {
                walk_over_plane::<3>(Options { slip, weights, ..options() }, cells, 0.0);
            }
        }
        walk_over_plane::<3>(Options { rule: &DEGREE_10, ..options() }, cells, 0.0);
        walk_over_plane::<3>(options(), cells, 0.004);
        for gap in [-0.01, 0.0, 0.01] {
            walk_over_plane::<1>(options(), cells, gap);
        }
    }
}

/// The patch of a sphere around the origin over [-a, a]^2, seen from outside (`up`) or from inside.
fn cap(n: usize, a: f64, radius: f64, up: bool) -> Mesh {
    let mut mesh = grid(n, n, [-a, -a], [a, a], 1.0, up, Cells::Quads);
    mesh.x.iter_mut().for_each(|x| *x = x.normalize() * radius);
    mesh
}

/// Facets of both sides refined together: their gaps over a ball tend to those over the ball, with the square of their
/// size.
#[test]
fn facets_of_a_ball_converge_to_the_ball() {
    const DISTANCE: f64 = 0.02;
    let frame = [Vec3::zeros(), Vec3::z(), Vec3::x(), Vec3::y()];
    let mut errors = Vec::new();
    for n in [4, 8, 16] {
        let (one, two) = (cap(n, 0.3, 2.0 + DISTANCE, false), cap(3 * n / 2, 0.45, 2.0, true));
        let mut ball: Contact<3> = against(&one, AnalyticShape::Sphere(2.0), &frame, options()).unwrap();
        let facets = Surface::new("mortar", two.x.clone(), &two.facets, vec![[-1; 3]; two.x.len()]).unwrap();
        let mut faceted = <Contact<3>>::create(nonmortar(&one), facets, options()).unwrap();
        let (a, b) = (faceted.sums(&one.x, &two.x).unwrap(), ball.sums(&one.x, &frame).unwrap());
        let error = |k: usize| (a[k].gap_now / a[k].coverage - b[k].gap_now / b[k].coverage).norm();
        errors.push((0..one.x.len()).map(error).fold(0.0, f64::max) / DISTANCE);
    }
    let orders: Vec<_> = errors.windows(2).map(|e| (e[0] / e[1]).log2()).collect();
    assert!(orders.iter().all(|o| (1.9..2.1).contains(o)), "errors {errors:?}, orders {orders:?}");
}
