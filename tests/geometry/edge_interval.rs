//! Crossings of nearly parallel edges, anywhere in space, against rational arithmetic; and arithmetic in twice the
//! precision, which they take.

use crate::support::exact;
use crate::support::mesh::Random;
use nalgebra::Rotation3;
use num_rational::BigRational;
use num_traits::{Signed, ToPrimitive, Zero};
use stickslip::geometry::double_double::DoubleDouble;
use stickslip::geometry::edge_interval::{EdgeIntervals, edge_intervals};
use stickslip::geometry::{Facet, Vec3};
use stickslip::mortar::{NonmortarFrame, Segment};
use stickslip::simd::{Kernel, Lanes, Plain, dispatch};

/// What the source claims of every crossing.
const CROSSING: f64 = 1e-11;

struct Intervals<'a>(&'a NonmortarFrame, &'a Segment);

impl Kernel for Intervals<'_> {
    type Output = [EdgeIntervals; 2];
    #[inline(always)]
    fn run<L: Lanes>(self) -> [EdgeIntervals; 2] {
        edge_intervals::<L>(&self.0.projection, &self.1.mortar, &self.0.plane)
    }
}

/// The part of the edge from `ends[0]` to `ends[1]` that is to the left of all lines.
fn part(spanning: [[[f64; 3]; 2]; 2], lines: &[[Vec3; 2]], ends: [Vec3; 2]) -> Option<[f64; 2]> {
    let zero = BigRational::zero();
    let (mut low, mut high) = (zero.clone(), BigRational::from_integer(1.into()));
    for line in lines {
        let [d0, d1] = ends.map(|p| exact::distance(spanning, line.map(Into::into), p.into()));
        match (d0 > zero, d1 > zero) {
            (true, true) => {}
            (false, false) => return None,
            (false, true) => low = low.max(&d0 / (&d0 - &d1)),
            (true, false) => high = high.min(&d0 / (&d0 - &d1)),
        }
    }
    (low < high).then(|| [low, high].map(|v| v.to_f64().unwrap()))
}

/// Pairs of quadrilaterals and triangles, one turned by the angle about an inner point, or smaller and turned about a
/// point of an edge, touching but for rounding, over a gap and tilted: every part of every edge, on every back end.
#[test]
fn crossings_are_right_at_any_angle_anywhere_in_space() {
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let mut random = Random(17);
    let (mut worst, mut crossings) = (0.0_f64, 0);
    for exponent in [3, 7, 11, 13, 15] {
        for round in 0..48 {
            let (n1, n2) = (3 + round % 2, 3 + round / 2 % 2);
            let (about, scale) = if round / 4 % 2 == 0 { ([0.3, 0.25], 1.0) } else { ([0.375, 0.0], 0.75) };
            let (gap, tilt) = ([0.0, 0.01][round / 8 % 2], [0.0, 0.0, 0.2][round / 16]);
            let [a, b, c] = [0; 3].map(|_| 3.0 * random.next());
            let space = Rotation3::from_euler_angles(a, b, c);
            let shift = random.vector(1.0);
            let about = Vec3::new(about[0], about[1], 0.0);
            let turn = Rotation3::from_euler_angles(tilt, 0.0, 10f64.powi(-exponent));
            let corner = |k: usize| Vec3::new(square[k][0], square[k][1], 0.0);
            let x1: Vec<_> = (0..n1).map(|k| space * corner(k) + shift).collect();
            let place = |k: usize| space * (turn * (corner(k) * scale - about) + about - Vec3::z() * gap) + shift;
            let x2: Vec<_> = (0..n2).rev().map(place).collect();
            let (one, two) = (Facet::new(&x1).unwrap(), Facet::new(&x2).unwrap());
            let frame = NonmortarFrame::new(&one).unwrap();
            let segment = Segment::new(&frame, &two).unwrap().unwrap();
            let spanning = one.spanning_signs().map(|(to, from)| [one.nodes[to].into(), one.nodes[from].into()]);
            let lines = |x: &[Vec3; 4], n: usize| (0..n).map(|k| [x[k], x[(k + 1) % n]]).collect::<Vec<_>>();
            let lines = [lines(&frame.projection.x, n1), lines(&segment.mortar.x, n2)];
            let found = [dispatch(Intervals(&frame, &segment)), Intervals(&frame, &segment).run::<Plain>()];
            for (side, k) in (0..2).flat_map(|s| (0..lines[s].len()).map(move |k| (s, k))) {
                let expected = part(spanning, &lines[1 - side], lines[side][k]);
                for found in &found {
                    let found = found[side][k].map(|i| {
                        // The exact part runs along the facet.
                        if i.orientation > 0.0 { [i.low, i.high] } else { [1.0 - i.high, 1.0 - i.low] }
                    });
                    // Where an edge ends on a line, rounding may leave a part of its own size, or none.
                    let error = match (expected, found) {
                        (Some(a), Some(b)) => (a[0] - b[0]).abs().max((a[1] - b[1]).abs()),
                        (Some([low, high]), None) | (None, Some([low, high])) => high - low,
                        (None, None) => 0.0,
                    };
                    assert!(error <= CROSSING, "angle 1e-{exponent}, round {round}, side {side}, edge {k}: {error:e}");
                    worst = worst.max(error);
                    crossings += expected.iter().flatten().filter(|&&v| v > 0.0 && v < 1.0).count();
                }
            }
        }
    }
    println!("{crossings} crossings, worst {worst:.1e}");
    assert!(crossings > 1000);
}

/// Sums, differences and products of numbers with 106 bits against rational ones: a few 2^-106.
#[test]
fn double_doubles_keep_106_bits() {
    let rounding = BigRational::from_float(16.0 * 2f64.powi(-106)).unwrap();
    let exact = |v: f64| BigRational::from_float(v).unwrap();
    let mut random = Random(23);
    for _ in 0..2000 {
        let [a, b, c, d] = [0; 4].map(|_| random.next() * 10f64.powi((random.next() * 6.0) as i32));
        let (x, y) = (DoubleDouble::difference(a, b), DoubleDouble::difference(c, d));
        let (exact_x, exact_y) = (exact(a) - exact(b), exact(c) - exact(d));
        let check = |found: DoubleDouble, expected: BigRational, what: &str| {
            // What is left when the nearest double is taken away, too.
            let rest = (found - DoubleDouble::difference(found.value(), 0.0)).value();
            let error = (exact(found.value()) + exact(rest) - &expected).abs();
            assert!(error <= &rounding * expected.abs(), "{what} of {a:e} - {b:e} and {c:e} - {d:e}");
        };
        check(x, exact_x.clone(), "difference");
        check(x + y, &exact_x + &exact_y, "sum");
        check(x - y, &exact_x - &exact_y, "difference");
        check(x * y, &exact_x * &exact_y, "product");
        check(x * c, &exact_x * exact(c), "product with a double");
    }
    assert_eq!(DoubleDouble::difference(0.1, 0.1).value(), 0.0);
}
