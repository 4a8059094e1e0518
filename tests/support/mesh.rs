//! Small surfaces and interfaces for tests.
#![allow(dead_code)]

use std::collections::HashMap;
use stickslip::error::Result;
use stickslip::geometry::Vec3;
use stickslip::interface::{
    Contact, Form, Friction, Interface, MultiplierBasis, NO_EQUATION, NO_WEAK_COVERAGE, Options, Stiffness, Surface,
    Weights,
};
use stickslip::law::{Coefficient, SlipMeasure};
use stickslip::quadrature::{DEGREE_5, DEGREE_10};

/// Deterministic numbers in -1..1.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 33) as f64 / (1u64 << 30) as f64 - 1.0
    }

    pub fn vector(&mut self, scale: f64) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next()) * scale
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cells {
    Quads,
    Triangles,
}

#[derive(Clone)]
pub struct Mesh {
    pub x: Vec<Vec3>,
    pub facets: Vec<Vec<i64>>,
}

/// An n x m grid on [a, b] (x, y) at height z; normals point up or down.
pub fn grid(n: usize, m: usize, a: [f64; 2], b: [f64; 2], z: f64, up: bool, cells: Cells) -> Mesh {
    let mut x = Vec::new();
    for j in 0..=m {
        for i in 0..=n {
            let (s, t) = (i as f64 / n as f64, j as f64 / m as f64);
            x.push(Vec3::new(a[0] + s * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), z));
        }
    }
    let at = |i: usize, j: usize| (j * (n + 1) + i) as i64;
    let mut facets = Vec::new();
    for j in 0..m {
        for i in 0..n {
            let mut quad = vec![at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            if !up {
                quad.reverse();
            }
            match cells {
                Cells::Quads => facets.push(quad),
                Cells::Triangles => {
                    facets.push(vec![quad[0], quad[1], quad[2]]);
                    facets.push(vec![quad[0], quad[2], quad[3]]);
                }
            }
        }
    }
    Mesh { x, facets }
}

/// Several meshes as one surface, without common nodes.
pub fn together(parts: &[Mesh]) -> Mesh {
    let mut all = Mesh { x: Vec::new(), facets: Vec::new() };
    for part in parts {
        let first = all.x.len() as i64;
        all.facets.extend(part.facets.iter().map(|f| f.iter().map(|k| k + first).collect()));
        all.x.extend(&part.x);
    }
    all
}

/// A ball of radius 1 at the origin, all of its surface: a cube's faces of n x n quads blown up.
pub fn ball(n: usize) -> Mesh {
    let mut mesh = Mesh { x: Vec::new(), facets: Vec::new() };
    let n = n as i64;
    // The cube's points in whole numbers, so that neighbouring faces find each other's.
    let mut points = HashMap::new();
    for (axis, sign) in (0..3).flat_map(|axis| [(axis, 1), (axis, -1)]) {
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            let mut corners = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]];
            if sign < 0 {
                corners.reverse();
            }
            let facet = corners.map(|c| {
                let mut p = [0; 3];
                (p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]) = (sign * n, 2 * c[0] - n, 2 * c[1] - n);
                *points.entry(p).or_insert_with(|| {
                    mesh.x.push(Vec3::from_fn(|i, _| p[i] as f64).normalize());
                    mesh.x.len() as i64 - 1
                })
            });
            mesh.facets.push(facet.to_vec());
        }
    }
    mesh
}

/// `n` nodes with N equations each, numbered from `first` on.
pub fn numbered<const N: usize>(first: usize, n: usize) -> Vec<[i64; N]> {
    (0..n).map(|k| std::array::from_fn(|i| (first + N * k + i) as i64)).collect()
}

/// An interface by its number of multipliers a node: three, or one along the normal.
pub trait Create<const N: usize>: Sized {
    fn create(one: Surface, two: Surface, multipliers: Vec<[i64; N]>, options: Options) -> Result<Self>;
}

impl Create<3> for Contact<3> {
    fn create(one: Surface, two: Surface, multipliers: Vec<[i64; 3]>, options: Options) -> Result<Self> {
        Contact::new(one, two, multipliers, options)
    }
}

impl Create<1> for Contact<1> {
    fn create(one: Surface, two: Surface, multipliers: Vec<[i64; 1]>, options: Options) -> Result<Self> {
        Contact::frictionless(one, two, multipliers, options)
    }
}

/// Equations x1, x2, lambda in this order; x2 has none where the mortar side is prescribed.
pub fn contact<const N: usize>(one: &Mesh, two: &Mesh, prescribed: bool, options: Options) -> Contact<N>
where
    Contact<N>: Create<N>,
{
    let (n1, n2) = (one.x.len(), two.x.len());
    let mortar = if prescribed { vec![[NO_EQUATION; 3]; n2] } else { numbered(3 * n1, n2) };
    let one = Surface::new("nonmortar", one.x.clone(), &one.facets, numbered(0, n1)).unwrap();
    let two = Surface::new("mortar", two.x.clone(), &two.facets, mortar).unwrap();
    Contact::create(one, two, numbered(3 * (n1 + n2), n1), options).unwrap()
}

/// Equations x1, x2, lambda in this order, none prescribed.
pub fn interface(one: &Mesh, two: &Mesh, options: Options) -> Interface {
    contact(one, two, false, options)
}

/// A surface's mesh.
pub fn mesh_of(surface: &Surface) -> Mesh {
    let facets = surface.facets.iter().map(|f| f.nodes[..f.len].iter().map(|&k| k as i64).collect());
    Mesh { x: surface.reference.clone(), facets: facets.collect() }
}

/// An interface moved from its reference, with multipliers that make all three states occur.
pub struct Moved {
    pub interface: Interface,
    pub x1: Vec<Vec3>,
    pub x2: Vec<Vec3>,
    pub lambda: Vec<Vec3>,
}

/// How rough the scene is.
#[derive(Clone, Copy)]
pub struct Roughness {
    /// Out-of-plane noise at t_n and t_{n+1}, over the facet size. Warps quads.
    pub warp: f64,
    /// In-plane noise. Distorts quads.
    pub jitter: f64,
    /// Rigid slide within the step, over the facet size.
    pub slide: f64,
}

pub const FLAT: Roughness = Roughness { warp: 0.0, jitter: 0.0, slide: 0.02 };

/// A 2 x 2 non-mortar grid over a turned 3 x 3 mortar grid in a rotated frame.
pub fn moved(options: &Options, cells: [Cells; 2], rough: Roughness, seed: u64) -> Moved {
    let mut random = Random(seed);
    let mut one = grid(2, 2, [0.0, 0.0], [1.0, 1.0], 0.0, false, cells[0]);
    let mut two = grid(3, 3, [-0.45, -0.4], [1.5, 1.45], 0.0, true, cells[1]);
    let turn = nalgebra::Rotation3::from_euler_angles(0.0, 0.0, 0.3);
    let frame = nalgebra::Rotation3::from_euler_angles(0.4, -0.9, 1.3);
    let h = 0.5;
    let mut noise = |x: &mut Vec<Vec3>| {
        for p in x {
            *p += Vec3::new(random.next() * rough.jitter, random.next() * rough.jitter, random.next() * rough.warp) * h;
        }
    };
    noise(&mut one.x);
    two.x.iter_mut().for_each(|p| *p = turn * *p);
    noise(&mut two.x);
    let slide = Vec3::new(0.8, 0.6, 0.0) * (rough.slide * h);
    // Tilted against each other, so that gaps of both signs occur. A tilt keeps flat facets flat.
    let tilt = nalgebra::Rotation3::from_euler_angles(0.02, -0.03, 0.0);
    let mut x1: Vec<_> = one.x.iter().map(|p| tilt * p + slide + Vec3::new(0.0, 0.0, 0.004)).collect();
    let mut x2 = two.x.clone();
    noise(&mut x1);
    noise(&mut x2);
    for x in [&mut one.x, &mut two.x, &mut x1, &mut x2] {
        x.iter_mut().for_each(|p| *p = frame * *p);
    }
    let lambda = (0..one.x.len())
        .map(|_| frame * Vec3::new(0.3 * random.next(), 0.3 * random.next(), -0.5 + 0.7 * random.next()))
        .collect();
    let interface = interface(&one, &two, *options);
    Moved { interface, x1, x2, lambda }
}

/// Options whose augmentation is of the order of the multipliers over the gaps of [`moved`].
pub fn options() -> Options {
    let mut options = Options::paper(Stiffness::Augmentation(15.0));
    options.mu = 0.7;
    options
}

/// Options with this law and the numbers that it asks for.
pub fn under(friction: Friction, mu: f64, of: Options) -> Options {
    let law = friction.law();
    let mu = if law.mu == Coefficient::Given { mu } else { 0.0 };
    Options { friction, mu, shear_limit: law.limits_shear.then_some(0.2), ..of }
}

/// Rough meshes for [`moved`] on which facets are covered by several pairs; the second is covered in part, at a corner too.
pub fn rough_scenes(warp: f64) -> impl Iterator<Item = (&'static str, Roughness, [Cells; 2])> {
    let cells = [[Cells::Triangles, Cells::Triangles], [Cells::Triangles, Cells::Quads]];
    let rough = Roughness { warp, jitter: 0.08, slide: 0.02 };
    let off = Roughness { slide: 1.3, ..rough };
    cells.into_iter().flat_map(move |cells| [("covered", rough, cells), ("partly covered", off, cells)])
}

/// Every law whose multipliers are vectors, weights and slips of each kind, without carried nodes and with them, on rough scenes that have
/// moved: what derivatives are compared with differences on.
pub fn each_moved(
    forms: impl IntoIterator<Item = (Form, MultiplierBasis)> + Clone,
    options: Options,
    mut check: impl FnMut(&mut Moved, &str),
) {
    for (what, rough, cells) in rough_scenes(0.05) {
        let rule = if cells[1] == Cells::Quads { &DEGREE_10 } else { &DEGREE_5 };
        for (form, basis) in forms.clone() {
            for friction in [Friction::Coulomb, Friction::Tied, Friction::Tresca] {
                for (weights, slip) in [
                    (Weights::Current, SlipMeasure::Objective),
                    (Weights::Current, SlipMeasure::Increment),
                    (Weights::Current, SlipMeasure::Paper),
                    (Weights::Committed, SlipMeasure::Objective),
                ] {
                    for weak_coverage in [NO_WEAK_COVERAGE, 0.2] {
                        let of = Options { form, basis, weights, slip, weak_coverage, rule, ..options };
                        let what =
                            format!("{what} {form:?} {basis:?} {friction:?} {weights:?} {slip:?} {weak_coverage}");
                        check(&mut moved(&under(friction, 0.7, of), cells, rough, 3), &what);
                    }
                }
            }
        }
    }
}
