//! Needles across the axes of space (`src/interface/pairing/orientation.rs`).

use crate::support::mesh::*;
use nalgebra::Rotation3;
use stickslip::interface::Interface;

/// Pairs tested a facet.
const MOST: f64 = 12.0;
/// Boxes compared a facet; needles along the axes of space take up to 43.
const MOST_BOXES: f64 = 64.0;

#[test]
fn needles_across_the_axes_test_few_pairs() {
    for cells in [Cells::Quads, Cells::Triangles] {
        for angles in [[0.0, 0.0, 0.0], [0.0, 0.0, 0.785], [0.5, -0.6, 0.785]] {
            let turn = Rotation3::from_euler_angles(angles[0], angles[1], angles[2]);
            let needles = |n: usize, m: usize, z: f64, up: bool, shift: f64| {
                let mut mesh =
                    grid(n, m, [-shift, -shift], [1000.0 * n as f64 - shift, m as f64 - shift], z, up, cells);
                mesh.x.iter_mut().for_each(|x| *x = turn * *x);
                mesh
            };
            let (one, two) = (needles(2, 1000, 0.0, false, 0.0), needles(3, 1002, 0.0, true, 0.3));
            let i: Interface = interface(&one, &two, options());
            let c = i.counters();
            let of = |count: i64| count as f64 / one.facets.len() as f64;
            let [tested, visited, touch] = [c.pairs_tested, c.boxes_visited, c.pairs_clipped].map(of);
            println!("turned by {angles:?}: {tested:.2} pairs tested, {touch:.2} overlap or touch, {visited:.1} boxes");
            assert!(tested <= MOST, "{tested} pairs a facet");
            assert!(visited <= MOST_BOXES, "{visited} boxes a facet");
        }
    }
}
