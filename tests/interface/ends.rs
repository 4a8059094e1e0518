//! Where searches end (`src/interface/pairing/ends.rs`): layers beyond a search distance cost next to nothing.

use crate::support::mesh::*;
use nalgebra::Rotation3;
use stickslip::geometry::Vec3;
use stickslip::interface::{Interface, Normals, Options};

const LAYERS: usize = 20;
/// Boxes compared a facet, over those of the uppermost layer alone.
const MOST: f64 = 1.3;
/// Beside layers that a turn has moved against each other by less than the distance between them.
const MOST_TURNED: f64 = 2.0;

/// Plates of n x n facets below each other, this far apart, in one surface.
fn layers(count: usize, n: usize, apart: f64) -> Mesh {
    let mut all = Mesh { x: Vec::new(), facets: Vec::new() };
    for layer in 0..count {
        let plate = grid(n, n, [-0.05, -0.02], [1.04, 1.06], -apart * layer as f64, true, Cells::Quads);
        let first = all.x.len() as i64;
        all.facets.extend(plate.facets.iter().map(|f| f.iter().map(|k| k + first).collect()));
        all.x.extend(&plate.x);
    }
    all
}

fn moved(x: &[Vec3], motion: impl Fn(&Vec3) -> Vec3) -> Vec<Vec3> {
    x.iter().map(motion).collect()
}

/// Boxes compared a facet of the plate over the layers: at the creation, after a large common motion, and after the layers
/// have moved against the plate.
fn visited(count: usize, n: usize, apart: f64, frame: &Rotation3<f64>, follows: bool) -> [f64; 3] {
    let mut one = grid(n, n, [0.0, 0.0], [1.0, 1.0], 0.1 * apart, false, Cells::Quads);
    let mut two = layers(count, n + 3, apart);
    [&mut one, &mut two].into_iter().for_each(|m| m.x.iter_mut().for_each(|x| *x = frame * *x));
    let normals = if follows { Normals::Current } else { options().normals };
    let options = Options { search_distance: Some(0.5 * apart), normals, ..options() };
    let mut i: Interface = interface(&one, &two, options);
    let lambda = vec![Vec3::zeros(); one.x.len()];
    let mut seen = i.counters().boxes_visited;
    let created = seen as f64 / one.facets.len() as f64;
    let mut at = |x1: &[Vec3], x2: &[Vec3]| {
        i.residual(x1, x2, &lambda, None).unwrap();
        assert!(i.active_pairs() > 0);
        let visited = i.counters().boxes_visited - std::mem::replace(&mut seen, i.counters().boxes_visited);
        visited as f64 / one.facets.len() as f64
    };
    let far = Vec3::new(300.0, -200.0, 500.0);
    let together = at(&moved(&one.x, |x| x + far), &moved(&two.x, |x| x + far));
    let turn = Rotation3::from_euler_angles(0.0, 0.1 * apart, 0.05 * apart);
    let turned = at(&one.x, &moved(&two.x, |x| turn * x));
    [created, together, turned]
}

#[test]
fn layers_beyond_the_search_distance_are_hardly_looked_at() {
    for angles in [[0.0; 3], [0.4, -0.9, 1.3]] {
        let frame = Rotation3::from_euler_angles(angles[0], angles[1], angles[2]);
        for (n, apart) in [(16, 0.1), (32, 0.1), (32, 0.02), (16, 1.0), (16, 0.005)] {
            for follows in [false, true] {
                let [one, all] = [1, LAYERS].map(|count| visited(count, n, apart, &frame, follows));
                println!(
                    "{n} x {n} facets, {apart} apart, turned by {angles:?}: {one:.1?} and {all:.1?} boxes a facet"
                );
                for (k, most) in [MOST, MOST, MOST_TURNED].into_iter().enumerate() {
                    assert!(all[k] <= most * one[k], "{all:?} of {LAYERS} layers, {one:?} of one");
                }
            }
        }
    }
}
