//! Small surfaces of any kind of facet for tests.
#![allow(dead_code)]

use super::mesh::{Create, Mesh, Random, Roughness, numbered};
use std::collections::HashMap;
use stickslip::geometry::Vec3;
use stickslip::interface::{Contact, NO_EQUATION, Options, Surface};
use stickslip::mortar::MultiplierSpace;

/// A kind by its nodes: 3, 4, 6, 8 or 9.
pub type Kind = usize;
pub const KINDS: [Kind; 5] = [3, 4, 6, 8, 9];

/// An n x m grid on [a, b] (x, y) at height 0 of facets of these kinds, one after the other; normals point up or down.
pub fn grid_of(n: i64, m: i64, a: [f64; 2], b: [f64; 2], up: bool, kinds: &[Kind]) -> Mesh {
    let mut mesh = Mesh { x: Vec::new(), facets: Vec::new() };
    let (mut points, mut next) = (HashMap::new(), 0);
    for (i, j) in (0..m).flat_map(|j| (0..n).map(move |i| (i, j))) {
        let kind = kinds[next % kinds.len()];
        next += 1;
        let mut quad = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]].map(|c| c.map(|k| 4 * k));
        if !up {
            quad.reverse();
        }
        let parts: Vec<Vec<[i64; 2]>> = match kind {
            3 | 6 => vec![vec![quad[0], quad[1], quad[2]], vec![quad[0], quad[2], quad[3]]],
            _ => vec![quad.to_vec()],
        };
        for corners in parts {
            let middle = |k: usize| {
                let (p, q) = (corners[k], corners[(k + 1) % corners.len()]);
                [0, 1].map(|i| (p[i] + q[i]) / 2)
            };
            let mut all = corners.clone();
            if kind > 4 {
                all.extend((0..corners.len()).map(middle));
            }
            if kind == 9 {
                all.push([4 * i + 2, 4 * j + 2]);
            }
            let facet = all.into_iter().map(|p| {
                *points.entry(p).or_insert_with(|| {
                    let at = |k: usize, n: i64| a[k] + p[k] as f64 / (4 * n) as f64 * (b[k] - a[k]);
                    mesh.x.push(Vec3::new(at(0, n), at(1, m), 0.0));
                    mesh.x.len() as i64 - 1
                })
            });
            mesh.facets.push(facet.collect());
        }
    }
    mesh
}

/// Which nodes have multipliers.
pub fn has_row(mesh: &Mesh, space: MultiplierSpace) -> Vec<bool> {
    let mut has = vec![false; mesh.x.len()];
    for facet in &mesh.facets {
        let corners = if matches!(facet.len(), 3 | 6) { 3 } else { 4 };
        let n = if space == MultiplierSpace::Corner { corners } else { facet.len() };
        facet[..n].iter().for_each(|&k| has[k as usize] = true);
    }
    has
}

/// Equations x1, x2, lambda in this order; nodes without multipliers have none of these.
pub fn contact_of<const N: usize>(one: &Mesh, two: &Mesh, prescribed: bool, options: Options) -> Contact<N>
where
    Contact<N>: Create<N>,
{
    let (n1, n2) = (one.x.len(), two.x.len());
    let mortar = if prescribed { vec![[NO_EQUATION; 3]; n2] } else { numbered(3 * n1, n2) };
    let mut multipliers = numbered::<N>(3 * (n1 + n2), n1);
    for (equations, has) in multipliers.iter_mut().zip(has_row(one, options.space)) {
        if !has {
            *equations = [NO_EQUATION; N];
        }
    }
    let one = Surface::new("nonmortar", one.x.clone(), &one.facets, numbered(0, n1)).unwrap();
    let two = Surface::new("mortar", two.x.clone(), &two.facets, mortar).unwrap();
    Contact::create(one, two, multipliers, options).unwrap()
}

/// As `mesh::Moved`.
pub struct MovedParents<const N: usize> {
    pub contact: Contact<N>,
    pub meshes: [Mesh; 2],
    pub x1: Vec<Vec3>,
    pub x2: Vec<Vec3>,
    pub lambda: Vec<nalgebra::SVector<f64, N>>,
}

/// As `mesh::moved`: a 2 x 2 non-mortar grid over a turned 3 x 3 mortar grid in a rotated frame. `bend`: curvature, common to both
/// sides.
pub fn moved_parents<const N: usize>(
    options: &Options,
    kinds: [&[Kind]; 2],
    rough: Roughness,
    bend: f64,
    prescribed: bool,
    seed: u64,
) -> MovedParents<N>
where
    Contact<N>: Create<N>,
{
    let mut random = Random(seed);
    let mut one = grid_of(2, 2, [0.0, 0.0], [1.0, 1.0], false, kinds[0]);
    let mut two = grid_of(3, 3, [-0.45, -0.4], [1.5, 1.45], true, kinds[1]);
    let turn = nalgebra::Rotation3::from_euler_angles(0.0, 0.0, 0.3);
    let frame = nalgebra::Rotation3::from_euler_angles(0.4, -0.9, 1.3);
    let h = 0.25;
    let mut noise = |x: &mut Vec<Vec3>| {
        for p in x {
            *p += Vec3::new(random.next() * rough.jitter, random.next() * rough.jitter, random.next() * rough.warp) * h;
        }
    };
    two.x.iter_mut().for_each(|p| *p = turn * *p);
    for x in [&mut one.x, &mut two.x] {
        x.iter_mut().for_each(|p| p.z += bend * (p.x * p.x - 0.7 * p.x * p.y + 0.5 * p.y * p.y));
        noise(x);
    }
    let slide = Vec3::new(0.8, 0.6, 0.0) * (rough.slide * h);
    let tilt = nalgebra::Rotation3::from_euler_angles(0.02, -0.03, 0.0);
    let mut x1: Vec<_> = one.x.iter().map(|p| tilt * p + slide + Vec3::new(0.0, 0.0, 0.004)).collect();
    let mut x2 = two.x.clone();
    noise(&mut x1);
    noise(&mut x2);
    for x in [&mut one.x, &mut two.x, &mut x1, &mut x2] {
        x.iter_mut().for_each(|p| *p = frame * *p);
    }
    let has = has_row(&one, options.space);
    let mut vector = |has: &bool| {
        let v = frame * Vec3::new(0.3 * random.next(), 0.3 * random.next(), -0.5 + 0.7 * random.next());
        let v = if N == 1 { Vec3::new(0.5 - 0.7 * random.next(), 0.0, 0.0) } else { v };
        if *has { nalgebra::SVector::from_fn(|i, _| v[i]) } else { nalgebra::SVector::zeros() }
    };
    let lambda = has.iter().map(&mut vector).collect();
    let contact = contact_of(&one, &two, prescribed, *options);
    MovedParents { contact, meshes: [one, two], x1, x2, lambda }
}
