//! Analytic mortar sides: against facets, against differences, and what must hold by itself.

mod abi;
mod facets;
mod frames;
mod invariants;
mod limits;
mod parents;
mod passing;
mod tangent;

use crate::support::max_abs;
use crate::support::mesh::{Cells, Mesh, Random, grid};
use nalgebra::{Rotation3, SVector};
use stickslip::error::Result;
use stickslip::geometry::{AnalyticShape, Vec3};
use stickslip::interface::{Contact, MultiplierBasis, Options, Residual, Surface};

/// Equal but for rounding, relative to the largest entry.
const ROUNDING: f64 = 1e-12;

const SHAPES: [AnalyticShape; 5] = [
    AnalyticShape::Plane,
    AnalyticShape::Sphere(3.0),
    AnalyticShape::Sphere(-4.0),
    AnalyticShape::Cylinder(2.0),
    AnalyticShape::Cylinder(-5.0),
];

const BASES: [MultiplierBasis; 2] = [MultiplierBasis::Standard, MultiplierBasis::Dual];

/// Three multipliers a node, or one.
trait Create: Sized {
    fn create(one: Surface, two: Surface, options: Options) -> Result<Self>;
}

/// Equations of n nodes with M each, from `first` on.
fn equations<const M: usize>(first: usize, n: usize) -> Vec<[i64; M]> {
    (0..n).map(|k| std::array::from_fn(|i| (first + M * k + i) as i64)).collect()
}

impl Create for Contact<3> {
    fn create(one: Surface, two: Surface, options: Options) -> Result<Self> {
        let n = one.len();
        Contact::new(one, two, equations(3 * n, n), options)
    }
}

impl Create for Contact<1> {
    fn create(one: Surface, two: Surface, options: Options) -> Result<Self> {
        let n = one.len();
        Contact::frictionless(one, two, equations(3 * n, n), options)
    }
}

fn nonmortar(mesh: &Mesh) -> Surface {
    Surface::new("nonmortar", mesh.x.clone(), &mesh.facets, equations(0, mesh.x.len())).unwrap()
}

fn against<C: Create>(mesh: &Mesh, shape: AnalyticShape, frame: &[Vec3], options: Options) -> Result<C> {
    C::create(nonmortar(mesh), Surface::analytic("mortar", shape, frame.to_vec())?, options)
}

/// A frame for a surface that touches the plane z = 0 from below at (1/2, 1/2), its normal there +z.
fn frame_of(shape: AnalyticShape) -> Vec<Vec3> {
    let p0 = Vec3::new(0.5, 0.5, -shape.radius());
    let edges = match shape {
        AnalyticShape::Cylinder(_) => [Vec3::new(0.6, 1.2, 0.0), Vec3::new(1.0, 0.0, 0.3), Vec3::new(0.0, 0.2, 1.5)],
        _ => [Vec3::new(0.0, 0.0, 0.7), Vec3::new(1.0, 0.2, 0.3), Vec3::new(0.1, -1.5, 0.0)],
    };
    std::iter::once(p0).chain(edges.map(|e| p0 + e)).collect()
}

fn turned(q: &Rotation3<f64>, shift: Vec3, x: &[Vec3]) -> Vec<Vec3> {
    x.iter().map(|x| q * x + shift).collect()
}

/// A frame that is no axis's friend.
fn askew() -> Rotation3<f64> {
    Rotation3::from_euler_angles(0.4, -0.9, 1.3)
}

fn flatten<const N: usize>(v: &[SVector<f64, N>]) -> Vec<f64> {
    v.iter().flatten().copied().collect()
}

/// Forces on the non-mortar side and multiplier rows.
fn equations_of<const N: usize>(r: &Residual<N>) -> Vec<f64> {
    [flatten(&r.nonmortar), flatten(&r.rows)].concat()
}

/// The tangent of (x1, lambda), row by row.
fn dense<const N: usize>(c: &mut Contact<N>, x1: &[Vec3], x2: &[Vec3], lambda: &[SVector<f64, N>]) -> Vec<f64> {
    let n = (3 + N) * x1.len();
    let mut k = vec![0.0; n * n];
    c.tangent(x1, x2, lambda, None, &mut |i: i64, j: i64, v: f64| k[i as usize * n + j as usize] += v).unwrap();
    k
}

fn close(a: &[f64], b: &[f64], bound: f64, what: &str) {
    let error = max_abs(a.iter().zip(b).map(|(a, b)| a - b));
    let scale = max_abs(b.iter().copied());
    assert!(a.len() == b.len() && error <= bound * scale, "{what}: off by {error:.1e} of {scale:.1e}");
}

/// Compressed nodes that stick and slip, and open ones, in axes that `q` turns.
fn multipliers<const N: usize>(n: usize, q: &Rotation3<f64>, random: &mut Random) -> Vec<SVector<f64, N>> {
    let vector = |v: Vec3| if N == 1 { SVector::from_fn(|_, _| v.z) } else { SVector::from_fn(|i, _| (q * v)[i]) };
    (0..n).map(|_| vector(Vec3::new(0.3 * random.next(), 0.3 * random.next(), -0.3 + 0.7 * random.next()))).collect()
}

/// A rough patch that touches the surface, moved since t_n, and the surface moved as a rigid body.
struct Rough<const N: usize> {
    contact: Contact<N>,
    x1: Vec<Vec3>,
    x2: Vec<Vec3>,
    lambda: Vec<SVector<f64, N>>,
}

impl<const N: usize> Rough<N>
where
    Contact<N>: Create,
{
    fn new(shape: AnalyticShape, cells: Cells, options: Options) -> Rough<N> {
        Rough::with(shape, cells, options, false)
    }

    /// `moves`: whether the frame has equations, after those of the patch and of the multipliers.
    fn with(shape: AnalyticShape, cells: Cells, options: Options, moves: bool) -> Rough<N> {
        let (q, shift, mut random) = (askew(), Vec3::new(3.0, -2.0, 1.0), Random(11));
        let mut mesh = grid(2, 2, [0.0, 0.0], [1.0, 1.0], 0.01, false, cells);
        let mut noise = |x: &Vec3| x + random.vector(0.01);
        let (before, now): (Vec<_>, Vec<_>) =
            (mesh.x.iter().map(&mut noise).collect(), mesh.x.iter().map(noise).collect());
        mesh.x = turned(&q, shift, &before);
        let frame = turned(&q, shift, &frame_of(shape));
        let mut surface = Surface::analytic("mortar", shape, frame.to_vec()).unwrap();
        if moves {
            surface.equations = equations((3 + N) * mesh.x.len(), frame.len());
        }
        let contact = Create::create(nonmortar(&mesh), surface, options).unwrap();
        let step = Rotation3::from_euler_angles(0.001, -0.002, 0.003);
        let x2 = frame.iter().map(|x| frame[0] + step * (x - frame[0]) + Vec3::new(0.002, 0.0, -0.001)).collect();
        let lambda = multipliers(before.len(), &q, &mut random);
        Rough { contact, x1: turned(&q, shift, &now), x2, lambda }
    }
}
