//! Leaf geometry: the plane's derivative, the inverse map, clipping, edge intervals.

use crate::support::mesh::Random;
use stickslip::error::Kind;
use stickslip::geometry::bilinear_map::BilinearMap;
use stickslip::geometry::edge_interval::{EdgeIntervals, edge_intervals};
use stickslip::geometry::{Facet, Plane, Projection, Vec2, Vec3, clip};
use stickslip::simd::{self, Kernel, Lanes, Plain};

fn facet(points: &[[f64; 3]]) -> Facet {
    Facet::new(&points.iter().map(|p| Vec3::from_column_slice(p)).collect::<Vec<_>>()).unwrap()
}

fn random_facet(random: &mut Random, n: usize) -> Facet {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let x: Vec<_> = corners[..n].iter().map(|p| Vec3::from_column_slice(p) + random.vector(0.15)).collect();
    Facet::new(&x).unwrap()
}

#[test]
fn plane_derivative_equals_differences() {
    // Central differences at 1e-6: 1e-10 of noise, 1e-12 of truncation.
    const TOLERANCE: f64 = 1e-8;
    let mut random = Random(1);
    for n in [3, 4, 3, 4] {
        let f = random_facet(&mut random, n);
        let direction: Vec<Vec3> = (0..n).map(|_| random.vector(1.0)).collect();
        let at = |h: f64| {
            let x: Vec<_> = f.points().iter().zip(&direction).map(|(x, d)| x + d * h).collect();
            Plane::of(&Facet::new(&x).unwrap()).unwrap()
        };
        let (p, plus, minus) = (at(0.0), at(1e-6), at(-1e-6));
        let fd = |get: fn(&Plane) -> Vec3| (get(&plus) - get(&minus)) / 2e-6;
        let spin: f64 = (0..n).map(|c| p.spin[c] * p.t2.dot(&direction[c])).sum();
        assert!((p.t2.dot(&fd(|p| p.t1)) - spin).abs() < TOLERANCE);
        for (t, tilt) in [(p.t1, &p.tilt[0]), (p.t2, &p.tilt[1])] {
            let tilt: f64 = (0..n).map(|c| tilt[c] * p.e.dot(&direction[c])).sum();
            assert!((t.dot(&fd(|p| p.e)) - tilt).abs() < TOLERANCE);
        }
    }
}

#[test]
fn degenerate_facets_are_refused() {
    for (points, what) in [
        (&[[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]][..], "collinear"),
        (&[[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1e-13, 0.0]][..], "a needle"),
        (&[[0.0; 3], [0.0; 3], [0.0; 3], [0.0; 3]][..], "a point"),
        (&[[f64::NAN; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]][..], "not a number"),
    ] {
        assert_eq!(Plane::of(&facet(points)).unwrap_err().kind, Kind::DegenerateFacet, "{what}");
    }
}

#[test]
fn inverse_map_returns_to_the_point() {
    // Some roundings of coordinates of order 1.
    const TOLERANCE: f64 = 1e-13;
    let mut random = Random(2);
    for n in [3, 4, 4, 4, 4] {
        let f = random_facet(&mut random, n);
        let p = Projection::new(&f, &Plane::of(&f).unwrap());
        let map = BilinearMap::new(&p);
        for _ in 0..50 {
            let mut r = || 0.5 * (random.next() + 1.0);
            let (xi, eta) = if n == 3 { (r() * 0.5, r() * 0.5) } else { (2.0 * r() - 1.0, 2.0 * r() - 1.0) };
            let shape = f.shape.values(xi, eta);
            let y: Vec2 = (0..n).map(|k| p.y[k] * shape[k]).sum();
            let found = map.inverse([y.x, y.y]);
            assert!((found.xi - xi).abs() < TOLERANCE && (found.eta - eta).abs() < TOLERANCE);
            let j = map.determinant();
            assert!((found.det - (j[0] + j[1] * xi + j[2] * eta)).abs() < TOLERANCE);
        }
    }
}

/// The parts of a facet cut by the facets of a tiling add up to it.
#[test]
fn clipped_areas_add_up() {
    let one = facet(&[[0.1, 0.2, 0.0], [1.9, 0.1, 0.0], [1.7, 1.8, 0.0], [0.3, 1.6, 0.0]]);
    let plane = Plane::of(&one).unwrap();
    let p = Projection::new(&one, &plane);
    for shift in [0.0, 1e-15, 1e-9, 0.1, 0.37] {
        let mut total = 0.0;
        for i in 0..4 {
            for j in 0..4 {
                let (x, y) = (f64::from(i) * 0.5 - shift * 0.1, f64::from(j) * 0.5 + shift * 0.1);
                let cell = facet(&[[x, y, 0.3], [x, y + 0.5, 0.3], [x + 0.5, y + 0.5, 0.3], [x + 0.5, y, 0.3]]);
                total += clip::overlap::<Plain>(&p, &Projection::new(&cell, &plane)).area();
            }
        }
        assert!((total - p.area2 / 2.0).abs() < 1e-14, "{total}");
    }
}

struct Intervals<'a> {
    one: &'a Projection,
    two: &'a Projection,
    plane: &'a Plane,
}

impl Kernel for Intervals<'_> {
    type Output = [EdgeIntervals; 2];
    fn run<L: Lanes>(self) -> [EdgeIntervals; 2] {
        edge_intervals::<L>(self.one, self.two, self.plane)
    }
}

/// Over a tiling, the parts of a non-mortar edge cover it once, and every mortar edge inside is claimed
/// by both its facets alike, whatever noise there is.
#[test]
fn edge_intervals_tile_edges_at_any_noise() {
    let one = facet(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]]);
    let plane = Plane::of(&one).unwrap();
    let p = Projection::new(&one, &plane);
    let mut random = Random(3);
    for noise in [0.0, 1e-16, 1e-15, 1e-14, 1e-12, 1e-8, 1e-3] {
        // A 4 x 4 mortar tiling of [-0.5, 1.5]^2: edges coincide with those of `one`.
        let nodes: Vec<Vec3> = (0..25)
            .map(|k| Vec3::new(f64::from(k % 5) * 0.5 - 0.5, f64::from(k / 5) * 0.5 - 0.5, 0.0) + random.vector(noise))
            .collect();
        let cells =
            (0..16).map(|c| [c / 4 * 5 + c % 4, c / 4 * 5 + c % 4 + 5, c / 4 * 5 + c % 4 + 6, c / 4 * 5 + c % 4 + 1]);
        let mut covered = [0.0; 4];
        let mut claims = std::collections::BTreeMap::<(usize, usize), Vec<(f64, f64, f64)>>::new();
        for cell in cells {
            let two = Projection::new(&Facet::new(&cell.map(|k| nodes[k])).unwrap(), &plane);
            let [nonmortar, mortar] = simd::dispatch(Intervals { one: &p, two: &two, plane: &plane });
            for k in 0..4 {
                if let Some(i) = nonmortar[k] {
                    covered[k] += i.high - i.low;
                }
                if let Some(i) = mortar[k] {
                    let (from, to) = (cell[two.node[i.from]], cell[two.node[i.to]]);
                    claims.entry((from, to)).or_default().push((i.low, i.high, i.orientation));
                }
            }
        }
        for c in covered {
            assert!((c - 1.0).abs() < 1e-14, "noise {noise:e}: an edge is covered {c} times");
        }
        for (edge, claims) in claims {
            // Bitwise the same interval with opposite orientation: the two edge parts cancel.
            assert_eq!(claims.len(), 2, "noise {noise:e}: edge {edge:?}");
            assert_eq!((claims[0].0, claims[0].1, claims[0].2), (claims[1].0, claims[1].1, -claims[1].2));
        }
    }
}
