//! Lines of plane and axisymmetric models: meshes, interfaces, and their tangents against differences in two components a node.
#![allow(dead_code)]

use super::differences::worst_difference;
use super::mesh::{Create, Mesh, Random};
use nalgebra::SVector;
use stickslip::geometry::Vec3;
use stickslip::interface::{Contact, NO_EQUATION, Options, Surface};
use stickslip::line::Measure;
use stickslip::mortar::MultiplierSpace;

/// `n` lines with `nodes` nodes each from x = a to b: of a body above them (`up` false) or below them.
pub fn lines(n: usize, nodes: usize, [a, b]: [f64; 2], up: bool) -> Mesh {
    let [a, b] = if up { [b, a] } else { [a, b] };
    let per = nodes - 1;
    let x = (0..=n * per).map(|k| Vec3::new(a + (b - a) * k as f64 / (n * per) as f64, 0.0, 0.0)).collect();
    let facet = |f: usize| {
        let first = (f * per) as i64;
        if nodes == 2 { vec![first, first + 1] } else { vec![first, first + 2, first + 1] }
    };
    Mesh { x, facets: (0..n).map(facet).collect() }
}

/// Whether nodes have a multiplier.
pub fn has_row(mesh: &Mesh, space: MultiplierSpace) -> Vec<bool> {
    let mut has = vec![space == MultiplierSpace::Sub; mesh.x.len()];
    mesh.facets.iter().for_each(|facet| facet[..2].iter().for_each(|&k| has[k as usize] = true));
    has
}

/// Two equations a node from `first` on, none along z.
pub fn plane_equations(first: usize, n: usize) -> Vec<[i64; 3]> {
    (0..n).map(|k| [(first + 2 * k) as i64, (first + 2 * k + 1) as i64, NO_EQUATION]).collect()
}

/// Multipliers of a node: two, or one along the normal.
pub const fn components(n: usize) -> usize {
    if n == 1 { 1 } else { 2 }
}

/// Equations x1, x2, lambda in this order; nodes without multipliers have none of these.
pub fn contact_of_lines<const N: usize>(one: &Mesh, two: &Mesh, measure: Measure, options: Options) -> Contact<N>
where
    Contact<N>: Create<N>,
{
    let (n1, n2) = (one.x.len(), two.x.len());
    let mut multipliers = vec![[NO_EQUATION; N]; n1];
    for (a, has) in has_row(one, options.space).into_iter().enumerate().filter(|(_, has)| *has) {
        assert!(has);
        let per = components(N);
        (0..per).for_each(|i| multipliers[a][i] = (2 * (n1 + n2) + per * a + i) as i64);
    }
    let one = Surface::of_lines("nonmortar", one.x.clone(), &one.facets, plane_equations(0, n1), measure).unwrap();
    let two = Surface::of_lines("mortar", two.x.clone(), &two.facets, plane_equations(2 * n1, n2), measure).unwrap();
    Contact::create(one, two, multipliers, options).unwrap()
}

/// A configuration.
pub struct MovedLines<const N: usize> {
    pub contact: Contact<N>,
    pub meshes: [Mesh; 2],
    pub x1: Vec<Vec3>,
    pub x2: Vec<Vec3>,
    pub lambda: Vec<SVector<f64, N>>,
}

/// Four lines over five, both bent and rough, which then slide and turn; in a rotated frame, or at r > 0.
pub fn moved_lines<const N: usize>(options: &Options, nodes: [usize; 2], measure: Measure, seed: u64) -> MovedLines<N>
where
    Contact<N>: Create<N>,
{
    let mut random = Random(seed);
    let (mut one, mut two) = (lines(4, nodes[0], [0.0, 2.0], false), lines(5, nodes[1], [-0.3, 2.2], true));
    let frame = nalgebra::Rotation3::from_euler_angles(0.0, 0.0, 0.7);
    let mut rough = |x: &mut Vec<Vec3>| {
        x.iter_mut().for_each(|p| *p += Vec3::new(random.next() * 0.03, random.next() * 0.004, 0.0));
    };
    for x in [&mut one.x, &mut two.x] {
        x.iter_mut().for_each(|p| p.y += 0.1 * p.x * p.x);
        rough(x);
    }
    let slide = Vec3::new(0.13, 0.006, 0.0);
    let (mut x1, mut x2) = (one.x.iter().map(|p| p + slide).collect::<Vec<_>>(), two.x.clone());
    rough(&mut x1);
    rough(&mut x2);
    for x in [&mut one.x, &mut two.x, &mut x1, &mut x2] {
        x.iter_mut().for_each(|p| *p = frame * *p + Vec3::new(3.0, 0.2, 0.0));
    }
    let has = has_row(&one, options.space);
    let mut vector = |has: &bool| {
        let v = frame * Vec3::new(0.3 * random.next(), -0.5 + 0.7 * random.next(), 0.0);
        let v = if N == 1 { Vec3::new(0.5 - 0.7 * random.next(), 0.0, 0.0) } else { v };
        if *has { SVector::from_fn(|i, _| v[i]) } else { SVector::zeros() }
    };
    let lambda = has.iter().map(&mut vector).collect();
    let contact = contact_of_lines(&one, &two, measure, *options);
    MovedLines { contact, meshes: [one, two], x1, x2, lambda }
}

impl<const N: usize> MovedLines<N> {
    fn ends(&self) -> [usize; 4] {
        let (a, b) = (2 * self.x1.len(), 2 * (self.x1.len() + self.x2.len()));
        [0, a, b, b + components(N) * self.lambda.len()]
    }

    /// The tangent as a full matrix, row by row.
    pub fn tangent(&mut self) -> Vec<f64> {
        let n = self.ends()[3];
        let mut k = vec![0.0; n * n];
        let mut add = |i: i64, j: i64, v: f64| k[i as usize * n + j as usize] += v;
        self.contact.tangent(&self.x1, &self.x2, &self.lambda, None, &mut add).unwrap();
        k
    }

    /// x1, x2, lambda, one after the other.
    pub fn unknowns(&self) -> Vec<f64> {
        let x = self.x1.iter().chain(&self.x2).flat_map(|x| [x.x, x.y]);
        x.chain(self.lambda.iter().flat_map(|l| l.iter().copied().take(components(N)))).collect()
    }

    /// The residual there, in the same order; nothing may happen along z.
    pub fn residual(&mut self, z: &[f64]) -> Vec<f64> {
        let [_, a, b, _] = self.ends();
        let points = |z: &[f64]| z.chunks_exact(2).map(|x| Vec3::new(x[0], x[1], 0.0)).collect::<Vec<_>>();
        let of = |l: &[f64]| SVector::<f64, N>::from_fn(|i, _| l.get(i).copied().unwrap_or(0.0));
        let lambda: Vec<_> = z[b..].chunks_exact(components(N)).map(of).collect();
        let r = self.contact.residual(&points(&z[..a]), &points(&z[a..b]), &lambda, None).unwrap();
        assert!(r.nonmortar.iter().chain(&r.mortar).all(|f| f.z == 0.0));
        assert!(N == 1 || r.rows.iter().all(|row| row[N - 1] == 0.0));
        let forces = r.nonmortar.iter().chain(&r.mortar).flat_map(|f| [f.x, f.y]);
        forces.chain(r.rows.iter().flat_map(|row| row.iter().copied().take(components(N)))).collect()
    }

    /// See [`worst_difference`]; relative to each block's largest.
    pub fn difference_error(&mut self) -> f64 {
        let (k, x, ends) = (self.tangent(), self.unknowns(), self.ends());
        worst_difference(&k, ends, &x, 0.0, |z| self.residual(z))
    }
}
