//! Skins to test with: bricks of quadrilaterals or triangles, and their outlines as lines of a plane model.

pub use crate::support::mesh::{Mesh, together};
use std::collections::HashMap;
use stickslip::geometry::Vec3;
use stickslip::interface::{Options, Stiffness};
use stickslip::line::Measure;
use stickslip::skin::{Given, Skin};

/// The modulus of all bodies.
pub const MODULUS: f64 = 1000.0;

/// The outer facets of a brick with corner `low`, of this size and so many cells along each axis.
pub fn brick(cells: [usize; 3], low: [f64; 3], size: [f64; 3], triangles: bool) -> Mesh {
    let mut mesh = Mesh { x: Vec::new(), facets: Vec::new() };
    let mut numbers = HashMap::new();
    let mut node = |place: [usize; 3], x: &mut Vec<Vec3>| -> i64 {
        *numbers.entry(place).or_insert_with(|| {
            x.push(Vec3::from_fn(|i, _| low[i] + size[i] * place[i] as f64 / cells[i] as f64));
            x.len() as i64 - 1
        })
    };
    for axis in 0..3 {
        let [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
        for is_high in [false, true] {
            for (i, j) in (0..cells[u]).flat_map(|i| (0..cells[v]).map(move |j| (i, j))) {
                let mut corners = [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[a, b]| {
                    let mut place = [0; 3];
                    (place[axis], place[u], place[v]) = (if is_high { cells[axis] } else { 0 }, i + a, j + b);
                    node(place, &mut mesh.x)
                });
                if !is_high {
                    corners.reverse();
                }
                match triangles {
                    false => mesh.facets.push(corners.to_vec()),
                    true => mesh.facets.extend([[0, 1, 2], [0, 2, 3]].map(|t| t.map(|k| corners[k]).to_vec())),
                }
            }
        }
    }
    mesh
}

/// The outline of a polygon, each side in so many lines, seen from outside: the body is on the left.
pub fn outline(corners: &[[f64; 2]], lines: usize) -> Mesh {
    let n = corners.len() * lines;
    let point = |k: usize| {
        let ([a, b], t) = ([k / lines, k / lines + 1], (k % lines) as f64 / lines as f64);
        let [a, b] = [corners[a % corners.len()], corners[b % corners.len()]];
        Vec3::new(a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t, 0.0)
    };
    Mesh { x: (0..n).map(point).collect(), facets: (0..n as i64).map(|k| vec![k, (k + 1) % n as i64]).collect() }
}

pub fn options(mu: f64) -> Options {
    Options { mu, ..Options::new(Stiffness::Modulus(MODULUS)) }
}

/// A skin in space, or with lines in a plane, whose displacements have the first equations.
pub fn given(mesh: &Mesh, in_plane: bool) -> Given {
    let per = if in_plane { 2 } else { 3 };
    let equation = |a: usize| [0, 1, 2].map(|i| if i < per { (per * a + i) as i64 } else { -1 });
    Given {
        x: mesh.x.clone(),
        facets: mesh.facets.clone(),
        equations: (0..mesh.x.len()).map(equation).collect(),
        bodies: None,
        first: (per * mesh.x.len()) as i64,
        measure: in_plane.then_some(Measure::Thickness(1.0)),
        all_nodes: false,
    }
}

pub fn skin(mesh: &Mesh, options: Options) -> Skin {
    Skin::new(given(mesh, mesh.facets[0].len() == 2), options).unwrap()
}

/// Two bricks, the smaller one over the larger one, pressed into each other by `deep` and aside.
pub fn stack(deep: f64, triangles: bool) -> Mesh {
    let below = brick([4, 4, 2], [0.0, 0.0, 0.0], [1.0, 1.0, 0.5], triangles);
    let above = brick([3, 3, 2], [0.23, 0.17, 0.5 - deep], [0.6, 0.6, 0.4], triangles);
    together(&[below, above])
}
