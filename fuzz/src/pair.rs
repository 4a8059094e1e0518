//! The pair kernel: any two facets are refused or have weights that keep to the laws, with finite derivatives.

use super::{Bytes, all_finite};
use stickslip::geometry::bilinear_map::BilinearMap;
use stickslip::geometry::{Facet, Vec3};
use stickslip::mortar::{NonmortarFrame, PairWeights, Segment, WeightDerivatives, gap};
use stickslip::quadrature::{DEGREE_5, DEGREE_10};

/// Rounding of a sum over the points, relative to the overlap.
const SUMS: f64 = 1e-12;

fn facet(bytes: &mut Bytes, other: Option<&Facet>) -> Facet {
    let n = 3 + bytes.below(2);
    let mut x: Vec<Vec3> = (0..n).map(|_| [0; 3].map(|_| bytes.coordinate()).into()).collect();
    // Nodes in common with the other facet.
    if let Some(other) = other {
        for node in &mut x {
            if bytes.once_in(3) {
                *node = other.nodes[bytes.below(other.len())];
            }
        }
    }
    Facet::new(&x).expect("three or four nodes")
}

/// Takes one input; panics where a law is broken.
pub fn run(data: &[u8]) {
    let mut bytes = Bytes(data);
    let one = facet(&mut bytes, None);
    let two = facet(&mut bytes, Some(&one));
    let Ok(frame) = NonmortarFrame::new(&one) else { return };
    let Ok(Some(segment)) = Segment::new(&frame, &two) else { return };
    // Squares of areas are formed: beyond this they leave the range, and the callers refuse what is not finite.
    let largest = one.points().iter().chain(two.points()).map(|x| x.amax()).fold(0.0, f64::max);
    if largest > 1e70 || one.longest_edge() < 1e-70 {
        return;
    }
    let areas = frame.nodal_areas();
    // Where a map is nearly singular at a corner, the weights that come out of the derivatives' integrals lose digits.
    let spread = |map: &BilinearMap| {
        let [j, xi, eta] = map.determinant();
        let change = xi.abs() + eta.abs();
        (j + change) / (j - change).max(1e-12 * j)
    };
    let sums = SUMS * spread(&frame.map).max(spread(&segment.mortar_map));
    for rule in [&DEGREE_5, &DEGREE_10] {
        let (w, d) = WeightDerivatives::integrate(&frame, &segment, rule);
        let alone = PairWeights::integrate(&frame, &segment, rule);
        let mut total = 0.0;
        for a in 0..4 {
            for n in [&w, &alone] {
                all_finite(&n.ab[a]);
                all_finite(&n.ac[a]);
                let (b, c) = (n.coverage(a), n.ac[a].iter().sum::<f64>());
                assert!((b - c).abs() <= sums * segment.area, "{b:e} {c:e} of {:e}", segment.area);
            }
            total += alone.coverage(a);
            d.ab[a].iter().chain(&d.ac[a]).flatten().for_each(|d| all_finite(d));
        }
        let rounding = 1e-15 * one.longest_edge().max(two.longest_edge()) * one.longest_edge();
        assert!((total - segment.area).abs() <= SUMS * segment.area + rounding, "{total:e} of {:e}", segment.area);
        let whole: f64 = areas.iter().sum();
        assert!(segment.area <= whole * (1.0 + 1e-12) + rounding, "{:e} of {whole:e}", segment.area);
        gap(&w, &one, &two).iter().for_each(|g| all_finite(g.as_slice()));
    }
}
